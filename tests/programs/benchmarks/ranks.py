# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Strong and weak scaling of a job on ranks, on a machine that has nothing else to do.

A double cantilever beam of bricks with U7 runs a few increments in one process and on two ranks (strong), and one of
half the width in one process (weak). With --nlgeom all entries of the matrix change in each iteration, and not those of
the process zone alone. All times are those of the wall clock and include Python, deck and files.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import NamedTuple

from mpiexec import MPIEXEC, variables
from rich.console import Console
from rich.table import Table

from uel.output import Result
from uel.paper.bricks import STANDARD, dcb_of_bricks

BRICKS = (240, 16, 3)
RANKS = 2
END = 0.03
"""Opening at which the run ends: three increments."""
SMALLEST_GAIN = 1.4
"""Of two ranks over one process."""


class Run(NamedTuple):
    """Time of a run in seconds, its linear solver and its iterations."""

    seconds: float
    solver: str
    iterations: int


def measure(ranks: int, bricks: tuple[int, int, int], solver: str, *, nlgeom: bool) -> Run:
    """Run a deck."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        deck = re.sub(r"(\*STATIC\n.*?), 2\.5,", rf"\1, {END},", dcb_of_bricks("C3D8", STANDARD, bricks))
        if nlgeom:
            deck = deck.replace("*STEP, ", "*STEP, NLGEOM=YES, ")
        (folder / "dcb.inp").write_text(deck)
        launcher = [str(MPIEXEC), "-n", str(ranks)] if ranks > 1 else []
        words = [*launcher, sys.executable, "-m", "uel", "run", "dcb.inp", "--quiet", "--solver", solver]
        start = time.perf_counter()
        subprocess.run(words, cwd=folder, env=variables(), check=True)
        taken, result = time.perf_counter() - start, Result(folder / "dcb")
        solvers = re.findall(r"LINEAR SOLVER (\w+):", result.file(".msg").read_text())
        return Run(taken, solvers[0].lower(), sum(row.iterations for row in result.status))


def main() -> int:
    """Print the table; exit code 1 if two ranks gain too little."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bricks", type=int, nargs=3, default=BRICKS, metavar="N", help="of an arm: along, across, up")
    parser.add_argument("--solver", default="auto", help="of the runs in one process (auto)")
    parser.add_argument("--nlgeom", action="store_true", help="large displacements")
    options = parser.parse_args()
    along, across, up = options.bricks
    whole, narrow = (along, across, up), (along, across // RANKS, up)
    measured = partial(measure, nlgeom=options.nlgeom)
    one, two = measured(1, whole, options.solver), measured(RANKS, whole, "auto")
    half = measured(1, narrow, options.solver)
    gain = one.seconds / two.seconds
    notes = "", f"strong: {gain:.2f} times as fast", f"weak: {half.seconds / two.seconds:.2f} of the speed"
    title = f"{one.iterations} iterations"
    table = Table("bricks", "ranks", "solver", "seconds", "", title=title, title_justify="left")
    for run, ranks, bricks, note in zip((one, two, half), (1, RANKS, 1), (whole, whole, narrow), notes, strict=True):
        words = f"{bricks[0]} x {bricks[1]} x {2 * bricks[2]}"
        table.add_row(words, str(ranks), run.solver, f"{run.seconds:.1f}", note)
    Console().print(table)
    return 0 if gain >= SMALLEST_GAIN else 1


if __name__ == "__main__":
    sys.exit(main())
