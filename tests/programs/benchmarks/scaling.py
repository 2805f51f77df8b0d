# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of double cantilever beams over their size: `python tests/programs/benchmarks/scaling.py`.

Each beam runs in a process of its own, with the solver that `auto` takes, on one thread: DCB-ref and refinements of it
in the plane (the standard element), Krueger's specimen in space (U8 of infinite stiffness), fine around the front
("3D") or along the whole path of the crack ("3D, path"). In space ten increments go through the onset of the crack. An
iteration is judged against a factorisation in full and a solution of its own matrix with the same solver. Times are
those of the processor. With --write the rows replace those of scaling.json, and harness/uel/solver/linear/solvers.md is
written again.
"""

from __future__ import annotations

import argparse
import gc
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import bench
import numpy as np
import rich.table
from rich.console import Console
from solvers import in_plane

from uel import usersub
from uel.assembly import Constraints, System, TolerantSystem
from uel.deck import read_deck
from uel.delamination import markdown
from uel.elements import Call, Flags
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.paper import literature
from uel.solver.linear import LinearSolver, choose, measured
from uel.solver.threads import one_blas_thread

ROWS = Path(__file__).with_name("scaling.json")
BEGIN = "<!-- rows of tests/programs/benchmarks/scaling.py -->"

LARGEST_RATIO = 1.3
"""Bound of an iteration over factorisation and solution."""

OPENING, INCREMENTS = 0.9, 10
"""Of each arm in space (mm): the crack begins to grow in the eighth increment."""


FRONT, PATH = (29.0, 39.0), (29.0, 139.0)
"""Where the mesh is fine along the beam (mm): the crack's tip is at 30, the beam ends at 150."""


def in_space(fine: tuple[float, float], size: float, across: int, layers: int, folder: Path) -> Path:
    """Krueger's specimen to `OPENING`."""
    deck = folder / "beam.inp"
    found = literature.dcb_benchmark(size, across, layers, fine, OPENING, 1.0 / INCREMENTS, INCREMENTS)
    deck.write_text(found, encoding="ascii")
    return deck


CASES: dict[str, tuple[int, Callable[[Path], Path]]] = {
    "2D, 12 k": (30, partial(in_plane, 1, "U2")),
    "2D, 43 k": (30, partial(in_plane, 2, "U2")),
    "2D, 163 k": (28, partial(in_plane, 4, "U2")),
    "2D, 640 k": (28, partial(in_plane, 8, "U2")),
    "3D, 30 k": (INCREMENTS, partial(in_space, FRONT, 0.25, 18, 2)),
    "3D, 100 k": (INCREMENTS, partial(in_space, FRONT, 0.25, 40, 4)),
    "3D, path, 100 k": (INCREMENTS, partial(in_space, PATH, 0.23, 8, 3)),
    "3D, path, 300 k": (INCREMENTS, partial(in_space, PATH, 0.073, 8, 3)),
    "3D, path, 1 M": (INCREMENTS, partial(in_space, PATH, 0.0239, 8, 3)),
}
"""Increments, and what writes the deck."""


@dataclass(frozen=True, slots=True)
class Row:
    """A beam. Seconds are those of the processor, memory is the largest resident set (MiB).

    unknowns, iterations  how many
    solver       that auto takes
    before, memory_before  until the first increment begins: deck, numbering, scatter maps
    memory       of the whole run
    iteration    median over the increments, without passes over the elements that start an increment or search
    in_full      a factorisation in full and a solution of the last matrix
    seconds      all increments
    elements, factorising, solving  of them, in passes over the elements and in the linear solver
    """

    unknowns: int
    iterations: int
    solver: str
    before: float
    memory_before: float
    memory: float
    iteration: float
    in_full: float
    seconds: float
    elements: float
    factorising: float
    solving: float

    @property
    def ratio(self) -> float:
        """An iteration over a factorisation in full and a solution."""
        return self.iteration / self.in_full

    @property
    def cells(self) -> list[str]:
        """Cells of the table behind the name, as `HEADER` names them."""
        shares = (self.elements, self.factorising, self.solving)
        return [
            f"{self.unknowns:,}",
            self.solver,
            f"{self.before:.1f}",
            f"{self.memory_before:,.0f}",
            f"{self.memory:,.0f}",
            str(self.iterations),
            f"{self.iteration:.3g}",
            f"{self.in_full:.3g}",
            f"{self.ratio:.2f}",
            *(f"{100.0 * share / self.seconds:.0f} %" for share in (*shares, self.seconds - sum(shares))),
        ]


HEADER = (
    "beam",
    "unknowns",
    "solver",
    "before (s)",
    "MiB then",
    "MiB in all",
    "iterations",
    "iteration (s)",
    "in full (s)",
    "ratio",
    "elements",
    "factorisation",
    "solution",
    "rest",
)
POWERS = {"before (s)": "before", "MiB then": "memory_before", "MiB in all": "memory", "iteration (s)": "iteration"}
POWERS |= {"in full (s)": "in_full"}
"""Columns that have an exponent over the unknowns."""

Table = tuple[str, dict[str, Row]]
"""Machine and date, and the rows by the names of their cases."""


class Watched:
    """Seconds of the processor within calls of a function, which is replaced in its owner."""

    def __init__(self, owner: object, name: str) -> None:
        self.seconds = 0.0
        function = getattr(owner, name)

        def timed(*arguments: object, **options: object) -> object:
            start = time.process_time()
            result = function(*arguments, **options)
            self.seconds += time.process_time() - start
            return result

        setattr(owner, name, timed)


def measure(name: str) -> Row:
    """Run a case, in this process."""
    increments, write = CASES[name]
    with tempfile.TemporaryDirectory() as folder, one_blas_thread():
        deck = write(Path(folder))
        start = time.process_time()
        model = read_deck(deck)
        library = usersub.load(None, job="scaling", output_dir=Path(folder), deck=deck)
        system = TolerantSystem(model, library)
        before, memory_before = time.process_time() - start, resident()
        parts = [(system, "evaluate"), (LinearSolver, "factorise"), (LinearSolver, "solve")]
        watched = [Watched(*part) for part in parts]
        start = time.process_time()
        done = bench.run(system, model, library, increments, lambda: None)
        seconds, memory = time.process_time() - start, resident()
        shares = [part.seconds for part in watched]
        # the solver of the run, before another one takes as much memory
        gc.collect()
        solver, in_full = full_solution(system, model, done.displacement)
        library.close()
    counts = len(system), done.iterations
    return Row(*counts, solver, before, memory_before, memory, done.milliseconds / 1e3, in_full, seconds, *shares)


def full_solution(system: System, model: Model, u: FloatArray) -> tuple[str, float]:
    """Name of the solver, and seconds of a factorisation in full, without its analysis, and a solution."""
    boundaries = [*model.boundaries, *model.steps[0].boundaries]
    prescribed = np.unique(np.concatenate([system.dofs.find(entry.nodes, entry.dof) for entry in boundaries]))
    constraints = Constraints(system, prescribed, model.equations)
    data = system.evaluate(Call(Flags(1), 1, 1, 1.0, 1.0, 0.01, 1.0), u, np.zeros_like(u)).data
    assert data is not None
    data = constraints.reduce(data)
    pattern = constraints.reduced_indptr, constraints.reduced_indices
    solver = choose("auto", *pattern, coordinates=constraints.coordinates)
    solver.factorise(data)
    rhs = np.ones(constraints.free.size)
    # whatever is examined in the first solution
    solver.solve(rhs)
    start = time.process_time()
    solver.factorise((1.0 + 2.0**-20) * data)
    solver.solve(rhs)
    return solver.name, time.process_time() - start


def resident() -> float:
    """Largest resident set of this process (MiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def family(name: str) -> str:
    """What cases have in common that differ in size alone."""
    return name.rpartition(",")[0]


def exponents(rows: dict[str, Row]) -> list[list[str]]:
    """A line of the table for each family: exponents over the number of unknowns, by least squares."""
    lines = []
    for kind in dict.fromkeys(map(family, CASES)):
        found = [row for name, row in rows.items() if family(name) == kind]
        if len(found) < 2:
            continue
        sizes = np.log([row.unknowns for row in found])
        powers = {
            column: f"{np.polyfit(sizes, np.log([getattr(row, name) for row in found]), 1)[0]:.2f}"
            for column, name in POWERS.items()
        }
        lines.append([f"{kind}: exponent", *(powers.get(column, "") for column in HEADER[1:])])
    return lines


def lines_of(rows: dict[str, Row]) -> list[list[str]]:
    """Cells of the table."""
    return [*([name, *row.cells] for name, row in rows.items()), *exponents(rows)]


def read() -> Table:
    """The rows kept."""
    kept = json.loads(ROWS.read_text(encoding="utf-8"))
    return kept["machine"], {name: Row(**row) for name, row in kept["rows"].items()}


def page(text: str, table: Table) -> str:
    """The page with these rows in place of those in it."""
    name, rows = table
    body = "\n".join([*markdown.head(HEADER), *map(markdown.line, lines_of(rows))])
    return measured.replaced(text, BEGIN, f"{name}:\n\n{body}")


def write(rows: dict[str, Row]) -> None:
    """Keep rows, with those kept of other cases, and write them into the page."""
    found = (read()[1] if ROWS.exists() else {}) | rows
    table = measured.machine(), {name: found[name] for name in CASES if name in found}
    kept = {"machine": table[0], "rows": {name: asdict(row) for name, row in table[1].items()}}
    ROWS.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    measured.PAGE.write_text(page(measured.PAGE.read_text(encoding="utf-8"), table), encoding="utf-8")


def main() -> int:
    """Run the benchmark; returns 1 if an iteration is slower than its bound."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES), metavar="CASE")
    parser.add_argument("--write", action="store_true", help=f"keep the rows, and write them into {measured.PAGE.name}")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.here:
        print(json.dumps(asdict(measure(options.cases[0]))))
        return 0
    console, rows = Console(width=180), {}
    for name in options.cases:
        ended = subprocess.run(
            [sys.executable, __file__, "--here", "--cases", name], stdout=subprocess.PIPE, check=True
        )
        rows[name] = Row(**json.loads(ended.stdout))
        console.print(name, *rows[name].cells, sep="  ", soft_wrap=True)
        if options.write:
            write(rows)
    shown = rich.table.Table(*HEADER)
    for cells in lines_of(rows):
        shown.add_row(*cells)
    console.print(shown)
    slow = [
        f"{name}: {bench.judged(row.ratio, LARGEST_RATIO)}" for name, row in rows.items() if row.ratio > LARGEST_RATIO
    ]
    for line in slow:
        console.print(line)
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
