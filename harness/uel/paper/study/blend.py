# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.blend`: what a share of the secant matrix in AMATRX (BLEND) does for Abaqus.

With Abaqus' own iterations an increment is cut back where several points fail at once. Some of the matrix at fixed
damage makes the corrections shorter, which helps there, at the price of linear convergence everywhere.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

from rich.console import Console
from rich.table import Table

from uel.paper.measures import iterations, peak_load
from uel.paper.run_deck import RunOutcome, run_deck
from uel.paper.study.cases import KINDS, MESHES, deck_files, interface_of, mesh_of
from uel.paper.study.options import study_parser

KIND = KINDS["dcb"]
SHARES = (0.0, 0.05, 0.1, 0.25)
CHOSEN = tuple(product(("1e6", "inf"), MESHES))


@dataclass(frozen=True, slots=True)
class Beam:
    """Double cantilever beam [0/0] of the study, with the consistent element.

    stiffness, mesh  their names in the study
    share            BLEND
    """

    stiffness: str
    mesh: str
    share: float

    @property
    def name(self) -> str:
        """Name of the deck."""
        return f"blend_{self.stiffness}_{self.mesh}_{self.share:g}".replace(".", "")

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        interface = replace(interface_of("consistent", self.stiffness), blend=self.share)
        return deck_files(self.name, f"BLEND {self.share:g}", KIND, "0/0", mesh_of(KIND, self.mesh), interface)


def described(outcome: RunOutcome) -> str:
    """Return the increments / cutbacks / iterations, peak load (N), and where it stopped."""
    result = outcome.result
    increments, cutbacks = len(result.history["time"]), sum(line.cutback for line in result.status)
    counts = f"{increments} / {cutbacks} / {iterations(result)}, {peak_load(result):.2f}"
    return f"{counts}, stops at {result.history['time'][-1]:.0%}" if outcome.stopped else counts


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all shares, print a table; returns the exit code."""
    description = "A double cantilever beam by BLEND: increments / cutbacks / iterations, peak load in N."
    parser = study_parser("uel.paper.study.blend", description, "study/blend")
    folder: Path = parser.parse_args(arguments).output_dir
    table = Table("BLEND", *map(", ".join, CHOSEN))
    for share in SHARES:
        runs = (run_deck(Beam(*chosen, share), folder, fallback=False) for chosen in CHOSEN)
        table.add_row(f"{share:g}", *map(described, runs))
    Console().print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
