# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.length`: what interface elements cost that are too long for the process zone.

The double cantilever beam [0/0] with the consistent element of infinite stiffness: length of the elements along the
crack's way, height of the quads, integration rule. The process zone is measured on the finest mesh.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from uel.delamination.specimens import ARM_HEIGHT
from uel.output import Result
from uel.paper import measures
from uel.paper.study.cases import KINDS, deck_files, interface_of
from uel.paper.study.options import study_parser
from uel.running.job import run
from uel.solver.options import SolverOptions

CASES = {
    **{f"{size:g} mm": (size, 4, False) for size in (0.125, 0.25, 0.5, 1.0, 2.0)},
    **{f"0.25 mm, {rows} quads" + " over the height" * (rows == 2): (0.25, rows, False) for rows in (2, 8)},
    "1 mm, points at the nodes": (1.0, 4, True),
    "2 mm, points at the nodes": (2.0, 4, True),
}
"""Length of the elements (mm), quads over the height of an arm, integration points at the nodes."""


@dataclass(frozen=True, slots=True)
class LengthResult:
    """A run: largest load (N), length of the process zone at the end (mm), iterations, whether it warns."""

    peak: float
    zone: float
    iterations: int
    warned: bool


def beam(
    size: float, rows: int, folder: Path, *, at_nodes: bool = False, displacement: float | None = None
) -> LengthResult:
    """Write the double cantilever beam [0/0], 100 increments, the fall-back.

    Parameters
    ----------
    size
        Length of the elements (mm).
    rows
        Quads over the height of an arm.
    folder
        Gets a folder with the files of the run.
    at_nodes
        Integration points at the nodes, in place of Gauss points.
    displacement
        Of each arm at the end (mm); None: that of the study.
    """
    kind = KINDS["dcb"]
    heights = np.linspace(0.0, ARM_HEIGHT, rows + 1)
    mesh = replace(kind.mesh(size, 0.0), lower=heights, upper=ARM_HEIGHT + heights)
    interface = replace(interface_of("consistent", "inf"), beta=-1.0, newton_cotes=at_nodes)
    name = f"length_{size:g}_{rows}_{int(at_nodes)}".replace(".", "p")
    place = folder / name
    place.mkdir(parents=True, exist_ok=True)
    files = deck_files(name, f"elements of {size:g} mm", kind, "0/0", mesh, interface, displacement=displacement)
    for file, content in files.items():
        (place / file).write_text(content, encoding="ascii")
    result = run(place / f"{name}.inp", output_dir=place, solver=SolverOptions(fallback=True))
    return LengthResult(measures.peak_load(result), zone_length(result), measures.iterations(result), warned(result))


def zone_length(result: Result) -> float:
    """Return the length of the interface that is damaged and not yet broken, at the end (mm)."""
    profile = result.interface()
    between = profile["X"][(profile["DAMAGE"] > 0.0) & (profile["DAMAGE"] < 1.0)]
    return float(np.ptp(between)) if len(between) else 0.0


def warned(result: Result) -> bool:
    """Report whether the job says that an element that failed is too long."""
    return any("the process zone" in text for text in result.warnings)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all cases, print a table; returns the exit code."""
    description = "Peak load of the double cantilever beam by the length of its interface elements."
    folder: Path = study_parser("uel.paper.study.length", description, "study/length").parse_args(arguments).output_dir
    table = Table("elements", "peak (N)", "above the first", "zone (mm)", "iterations", "warning")
    first = 0.0
    for name, (size, rows, at_nodes) in CASES.items():
        found = beam(size, rows, folder, at_nodes=at_nodes)
        first = first or found.peak
        cells: tuple[str, ...] = (
            f"{found.peak:.2f}",
            f"{found.peak / first - 1.0:.1%}",
            f"{found.zone:.2f}",
            str(found.iterations),
        )
        cells = *cells, "yes" if found.warned else "no"
        table.add_row(name, *cells)
    Console().print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
