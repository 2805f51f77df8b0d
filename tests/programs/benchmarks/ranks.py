# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Strong and weak scaling of a job on ranks, on a machine that has nothing else to do.

A double cantilever beam of bricks with U7 runs a few increments in one process and on two ranks (strong), and one of
half the width in one process (weak). All times are those of the wall clock and include Python, deck and files.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from mpiexec import MPIEXEC, variables
from rich.console import Console
from rich.table import Table

from harness.delamination.bricks import STANDARD, dcb_of_bricks
from harness.output import Result

BRICKS = (240, 16, 3)
RANKS = 2
END = 0.03
"""Opening at which the run ends: three increments."""
SMALLEST_GAIN = 1.4
"""Of two ranks over one process."""


def seconds(ranks: int, bricks: tuple[int, int, int], solver: str) -> tuple[float, int]:
    """Time of a run, and its iterations."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        deck = re.sub(r"(\*STATIC\n.*?), 2\.5,", rf"\1, {END},", dcb_of_bricks("C3D8", STANDARD, bricks))
        (folder / "dcb.inp").write_text(deck)
        launcher = [str(MPIEXEC), "-n", str(ranks)] if ranks > 1 else []
        words = [*launcher, sys.executable, "-m", "harness", "run", "dcb.inp", "--quiet", "--solver", solver]
        start = time.perf_counter()
        subprocess.run(words, cwd=folder, env=variables(), check=True)
        return time.perf_counter() - start, sum(row.iterations for row in Result(folder / "dcb").status)


def main() -> int:
    """Print the table; exit code 1 if two ranks gain too little."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bricks", type=int, nargs=3, default=BRICKS, metavar="N", help="of an arm: along, across, up")
    parser.add_argument("--solver", default="auto", help="of the runs in one process (auto)")
    options = parser.parse_args()
    along, across, up = options.bricks
    one, iterations = seconds(1, (along, across, up), options.solver)
    two, _ = seconds(RANKS, (along, across, up), "cluster")
    half, _ = seconds(1, (along, across // RANKS, up), options.solver)
    table = Table("bricks", "ranks", "seconds", "", title=f"{iterations} iterations", title_justify="left")
    table.add_row(f"{along} x {across} x {2 * up}", "1", f"{one:.1f}", "")
    table.add_row(f"{along} x {across} x {2 * up}", f"{RANKS}", f"{two:.1f}", f"strong: {one / two:.2f} times as fast")
    table.add_row(f"{along} x {across // RANKS} x {2 * up}", "1", f"{half:.1f}", f"weak: {half / two:.2f} of the speed")
    Console().print(table)
    return 0 if one / two >= SMALLEST_GAIN else 1


if __name__ == "__main__":
    sys.exit(main())
