# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m harness.delamination.study.beta`: what the stabilisation parameter beta costs, and what it brings.

The bulk's traction <sigma>.n of (18) is not in equilibrium with the traction of the interface; the gap beta g takes up
the difference. A small beta makes the interface compliant, and below the bound of the element unstable; a large one
makes <sigma>.n count for nothing, and the element the standard one with a penalty beta, which oscillates. The
consistent element with an infinite stiffness shows both: the load tells of the compliance, the oscillation index of the
tractions.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

from harness.delamination.batch import run_deck
from harness.delamination.blocks import Interface
from harness.delamination.materials import TABLE_2
from harness.delamination.measures import iterations
from harness.delamination.oscillation import raw_index
from harness.delamination.study.cases import KINDS, LAYUPS, MESHES, deck_files

BETAS = {
    "-1": -1.0,
    "(21)": 0.0,
    "2e3": 2.0e3,
    "2e4": 2.0e4,
    "2e5": 2.0e5,
    "2e6": 2.0e6,
    "2e7": 2.0e7,
    "2e8": 2.0e8,
}
"""BETAN = BETAT (N/mm^3) by name: local eigenvalues, equation (21), five decades above the softening slope."""

STRENGTHS = {"TN": TABLE_2.strength_normal, "TT": TABLE_2.strength_shear}


@dataclass(frozen=True, slots=True)
class BetaResult:
    """A run: load (N) halfway and at the end, raw oscillation index of the traction at the end, iterations.

    reached  share of the displacement; less than 1 where the run ends early
    """

    half: float
    load: float
    index: float
    iterations: int
    reached: float


@dataclass(frozen=True, slots=True)
class BetaCase:
    """A specimen of the study with the consistent element and an infinite stiffness.

    specimen, layup, mesh  as in the tables of the study: 'dcb025', '0/90', 'perturbed'
    beta                   a key of BETAS
    """

    specimen: str
    layup: str
    mesh: str
    beta: str

    @property
    def name(self) -> str:
        """Name of the deck and of its folder."""
        return f"{self.specimen}_{self.layup.replace('/', '-')}_{self.mesh}_beta_{self.beta.strip('()')}"

    def files(self) -> dict[str, str]:
        """Deck `NAME.inp` and the files that it includes."""
        kind = KINDS[self.specimen]
        interface = Interface("U4", TABLE_2.with_stiffness(0.0), beta=BETAS[self.beta], consistent=True)
        mesh = kind.mesh(kind.size, MESHES[self.mesh] * kind.size)
        return deck_files(self.name, self.name, kind, self.layup, mesh, interface)


def run_case(case: BetaCase, folder: Path) -> BetaResult:
    """Run a case with the fall-back; the folder gets its files."""
    kind, outcome = KINDS[case.specimen], run_deck(case, folder, fallback=True)
    profile, history = outcome.result.interface(), outcome.result.history
    load = kind.sign * history[f"RF2[{kind.load}]"]
    half = int(abs(history["time"] - 0.5).argmin())
    index = max(raw_index(profile[mode], STRENGTHS[mode]) for mode in kind.modes)
    spent = iterations(outcome.result)
    return BetaResult(float(load[half]), float(load[-1]), index, spent, float(history["time"][-1]))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run every beta on every specimen asked for, print a table; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m harness.delamination.study.beta",
        description="Load and oscillation of the consistent element against the stabilisation parameter beta.",
    )
    parser.add_argument("--output-dir", type=Path, default=Path("study/beta"), help="folder of all files written")
    parser.add_argument("specimens", nargs="*", default=["dcb025", "enf"], help="of the study (dcb025 enf)")
    options = parser.parse_args(arguments)
    console = Console()
    for specimen in options.specimens:
        for layup in LAYUPS:
            for mesh in MESHES:
                title = f"{KINDS[specimen].title}, [{layup}], {mesh}"
                table = Table(
                    "beta", "load halfway (N)", "at the end (N)", "index", "iterations", "reached", title=title
                )
                for name in BETAS:
                    found = run_case(BetaCase(specimen, layup, mesh, name), options.output_dir)
                    cells = (f"{found.half:.2f}", f"{found.load:.2f}", f"{found.index:.3f}", str(found.iterations))
                    table.add_row(name, *cells, f"{found.reached:.0%}")
                console.print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
