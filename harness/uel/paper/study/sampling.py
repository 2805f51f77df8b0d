# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.sampling`: the effect of where the bulk stress is sampled (SAMPLING).

In a four-node quad the stress varies spuriously along the face of the interface. The end-notched flexure shows it: the
tangential traction of a delamination that grows rises to the strength and falls once, so its total variation is little
more than twice the strength; a zig-zag within every element adds to it.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rich.console import Console
from rich.table import Table

from uel.delamination.oscillation import total_variation
from uel.paper.measures import iterations
from uel.paper.study.cases import KINDS, deck_files, interface_of
from uel.paper.study.options import study_parser
from uel.running.job import run

SAMPLINGS = ("middle of the face", "face, xi of the point", "Gauss point")


@dataclass(frozen=True, slots=True)
class SamplingResult:
    """A run: total variation of the tangential traction (MPa) and load (N) at the end, iterations."""

    variation: float
    load: float
    iterations: int


def flexure(sampling: int, displacement: float, folder: Path, size: float | None = None) -> SamplingResult:
    """Run the end-notched flexure [0/0]: stiffness 1e8 N/mm^3, consistent element, 100 increments, default controls.

    Parameters
    ----------
    sampling
        SAMPLING of the elements.
    displacement
        At midspan, at the end (mm).
    folder
        Gets the files of the run.
    size
        Length of the elements (mm); None: that of the study.
    """
    kind = KINDS["enf"]
    mesh = kind.mesh(size or kind.size, 0.0)
    interface = replace(interface_of("consistent", "1e8"), sampling=sampling)
    name, title = f"sampling_{sampling}", f"SAMPLING {sampling}"
    folder.mkdir(parents=True, exist_ok=True)
    files = deck_files(name, title, kind, "0/0", mesh, interface, displacement=displacement)
    for file, content in files.items():
        (folder / file).write_text(content, encoding="ascii")
    result = run(folder / f"{name}.inp", output_dir=folder)
    profile, load = result.interface(), result.history[f"RF2[{kind.load}]"]
    return SamplingResult(total_variation(profile["TT"]), kind.sign * float(load[-1]), iterations(result))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the three samplings, print a table; returns the exit code."""
    description = "Oscillation of the end-notched flexure by the place where the bulk stress is sampled."
    parser = study_parser("uel.paper.study.sampling", description, "study/sampling")
    folder: Path = parser.parse_args(arguments).output_dir
    displacement = KINDS["enf"].displacement["0/0"]
    table = Table("SAMPLING", "stress from", "TV of TT (MPa)", "load (N)", "iterations")
    for sampling, place in enumerate(SAMPLINGS):
        found = flexure(sampling, displacement, folder)
        table.add_row(str(sampling), place, f"{found.variation:.1f}", f"{found.load:.1f}", str(found.iterations))
    Console().print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
