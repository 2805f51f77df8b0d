# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bonded interfaces have no negative eigenvalue beside any solid: `python tests/programs/stability/stability.py`.

A case is an interface element that owns its solids, in the complete form (CLOSURE 3) with beta from the local
eigenvalues, between two built-in elements of the host: K = K_below + K_above + K_interface before onset. Plies, shapes,
SAMPLING, INTEGRATION and GAMMABOT are random; the stiffness of the law is infinite (ALPHAN 0), next to nothing, and
anything between, in turns. The energy Phi of fortran/laws.md grows with it: next to nothing is the worst.

An element between two interfaces has half of its energy for each. The command works out which multiple of beta suffices
with half of the solids' energy: at most 1, by the proof of fortran/laws.md. Then the sum over a mesh has no negative
eigenvalue either if no solid has more than two interfaces. Some assembled laminates show it.

The exit code is 1 if a matrix has a negative eigenvalue or is unsymmetric, or if more than beta is needed.
"""

import argparse
import sys
import tempfile
import zlib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

ROOT = Path(__file__).parents[3]
sys.path.extend(str(ROOT / "tests" / folder) for folder in ("harness", "harness/insertion", "kernels"))

from bonded_pairs import BATCH, BETWEEN, RIGID, run_batch  # noqa: E402
from layered_meshes import matrix_of_laminate  # noqa: E402
from random_pairs import NAMES, Kind, kinds  # noqa: E402

from uel import usersub  # noqa: E402
from uel.delamination.markdown import head, line  # noqa: E402
from uel.solver.threads import one_blas_thread  # noqa: E402

CASES, LAMINATES, SEED = 10_000, 20, 1
"""Cases of a pair, assembled laminates of an element, and the seed of the page."""

ROUNDING = 1e-12
"""Smallest eigenvalue over the largest one that is rounding: 1e-16 of the largest entry, times hundreds of unknowns."""

BETTI = 1e-10
"""Largest difference of u1.K u2 and u2.K u1, over the sum of their terms' sizes."""

LARGEST = 1.0 + 1e-6
"""Needed multiple of beta that is 1 but for rounding: that of the energy, with moduli that differ by 1e5."""

COLUMNS = ("element", "below", "above", "cases", "rigid", "any stiffness", "worst")
FURTHER = ("eigenvalue", "Betti")
"""Columns with numbers that are rounding; they are not on the page."""

BEGIN = "<!-- table of python tests/programs/stability/stability.py -->\n"
END = "<!-- end of that table -->\n"


@dataclass
class Row:
    """Worst values among the cases of a pair.

    lowest   smallest eigenvalue over the largest one
    betti    difference of u1.K u2 and u2.K u1, over the sum of their terms' sizes
    rigid    needed multiple of beta with an infinite stiffness
    soft     needed multiple of beta with any stiffness
    worst    batch and case that need most
    """

    kind: Kind
    cases: int = 0
    lowest: float = np.inf
    betti: float = 0.0
    rigid: float = 0.0
    soft: float = 0.0
    worst: str = ""

    @property
    def failed(self):
        """Whether one of the cases is unstable or unsymmetric."""
        return self.lowest < -ROUNDING or self.betti > BETTI or self.soft > LARGEST

    def add(self, number, law, measures):
        """Take the numbers of a batch."""
        self.cases += len(measures.lowest)
        self.lowest = min(self.lowest, float(measures.lowest.min()))
        self.betti = max(self.betti, float(measures.betti.max()))
        if law == BETWEEN:
            return
        needed = float(measures.needed.max())
        if needed > self.soft:
            self.soft, self.worst = needed, f"{number}.{int(measures.needed.argmax())}"
        if law == RIGID:
            self.rigid = max(self.rigid, needed)

    @property
    def cells(self):
        """Cells of COLUMNS."""
        kind = self.kind
        return [
            f"U{kind.jtype}",
            kind.below,
            kind.above,
            f"{self.cases}",
            f"{self.rigid:.3f}",
            f"{self.soft:.3f}",
            self.worst,
        ]

    @property
    def further(self):
        """Cells of FURTHER."""
        return [f"{self.lowest:.0e}", f"{self.betti:.0e}"]


def run_kind(kind, batches, seed=SEED, count=BATCH):
    """Run batches of a pair, by their numbers."""
    row = Row(kind)
    with tempfile.TemporaryDirectory() as folder, one_blas_thread():
        library = usersub.load(None, job="stability", output_dir=Path(folder))
        try:
            for number in batches:
                row.add(number, *run_batch(library, kind, number, seed, count))
        finally:
            library.close()
    return row


def run_laminates(name, numbers, seed=SEED):
    """Compute the smallest eigenvalue over the largest one of laminates of a solid, the smallest of all."""
    lowest = np.inf
    for number in numbers:
        rng = np.random.default_rng([seed, zlib.crc32(name.encode()), number])
        with tempfile.TemporaryDirectory() as folder, one_blas_thread():
            matrix = matrix_of_laminate(name, rng, Path(folder))
            values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
        lowest = min(lowest, float(values[0] / values[-1]))
    return lowest


def markdown(rows, laminates, lowest, seed):
    """Write the page's lines from the rows and the smallest ratio of the laminates, so many of each solid."""
    smallest, betti = min(lowest, *(row.lowest for row in rows)), max(row.betti for row in rows)
    return [
        f"{sum(row.cases for row in rows):,} cases of {len(rows)} pairs and {laminates * len(NAMES):,} laminates, seed "
        f"{seed}. Smallest over largest eigenvalue:",
        f"{smallest:.0e} or more; u1.K u2 less u2.K u1, over the sizes of its terms: {betti:.0e} or less.",
        "",
        *head(COLUMNS),
        *(line(row.cells) for row in rows),
    ]


def write_page(page, lines):
    """Replace what is between the marks of a page."""
    above, begin, rest = page.read_text("utf-8").partition(BEGIN)
    below = rest.partition(END)[2]
    page.write_text(f"{above}{begin}\n" + "\n".join(lines) + f"\n\n{END}{below}", encoding="utf-8")


def main(arguments=None):
    """Run the cases and print the table; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--cases", type=int, default=CASES, help=f"of each pair, in batches of {BATCH} (default {CASES})"
    )
    parser.add_argument("--laminates", type=int, default=LAMINATES, help=f"of each solid (default {LAMINATES})")
    parser.add_argument("--seed", type=int, default=SEED, help=f"(default {SEED})")
    parser.add_argument("--first", type=int, default=0, help="first batch: with --cases 1 it repeats one of the table")
    parser.add_argument("--only", default="", help="the pairs with this in their name, such as U8 or 'U806 C3D8R C3D6'")
    parser.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    parser.add_argument("--page", type=Path, help="file whose table is written again, that below its mark")
    options = parser.parse_args(arguments)
    chosen = [kind for kind in kinds() if options.only in kind.name]
    if not chosen:
        parser.error(f"--only {options.only}: no pair has that in its name, such as {kinds()[0].name}")
    if options.page and options.only:
        parser.error("--page: expected all pairs, without --only")
    console = Console()
    batches = range(options.first, options.first + max(1, options.cases // BATCH))
    names = [name for name in NAMES if any(name in (kind.below, kind.above) for kind in chosen)]
    with ProcessPoolExecutor(options.workers) as pool:
        found = pool.map(partial(run_kind, batches=batches, seed=options.seed), chosen)
        rows = list(track(found, "pairs", len(chosen), console=console, transient=True))
        found = pool.map(partial(run_laminates, numbers=range(options.laminates), seed=options.seed), names)
        lowest = min(track(found, "laminates", len(names), console=console, transient=True))
    table = Table(*COLUMNS, *FURTHER, title="Multiple of beta that is needed, and rounding")
    for row in rows:
        table.add_row(*row.cells, *row.further, style="red" if row.failed else None)
    console.print(table)
    console.print(f"{options.laminates * len(names)} laminates: smallest eigenvalue over the largest {lowest:.0e}")
    if options.page:
        write_page(options.page, markdown(rows, options.laminates, lowest, options.seed))
    return int(lowest < -ROUNDING or any(row.failed for row in rows))


if __name__ == "__main__":
    sys.exit(main())
