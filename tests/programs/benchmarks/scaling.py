# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of double cantilever beams over their size: `python tests/programs/benchmarks/scaling.py`.

Each beam runs in a process of its own, with the solver that `auto` takes, on one thread: DCB-ref and refinements of it
in the plane (the standard element), Krueger's specimen in space (U8 of infinite stiffness). In space ten increments go
through the onset of the crack. An iteration is judged against a factorisation in full and a solution of its own matrix
with the same solver. Times are those of the processor.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from functools import partial
from pathlib import Path

import bench
import numpy as np
from rich.console import Console
from rich.table import Table
from solvers import in_plane

from harness import usersub
from harness.assembly import Constraints, System, TolerantSystem
from harness.deck import read_deck
from harness.delamination import literature
from harness.elements import Call, Flags
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.solver.linear import choose
from harness.solver.threads import one_blas_thread

LARGEST_RATIO = 1.3
"""Bound of an iteration over factorisation and solution."""

OPENING, INCREMENTS = 0.9, 10
"""Of each arm in space (mm): the crack begins to grow in the eighth increment."""


def in_space(size: float, across: int, layers: int, folder: Path) -> Path:
    """Krueger's specimen to `OPENING`."""
    deck = folder / "beam.inp"
    found = literature.dcb_benchmark(size, across, layers, (29.0, 39.0), OPENING, 1.0 / INCREMENTS, INCREMENTS)
    deck.write_text(found, encoding="ascii")
    return deck


CASES: dict[str, tuple[int, Callable[[Path], Path]]] = {
    "2D, 12 k": (30, partial(in_plane, 1, "U2")),
    "2D, 43 k": (30, partial(in_plane, 2, "U2")),
    "2D, 163 k": (28, partial(in_plane, 4, "U2")),
    "2D, 640 k": (28, partial(in_plane, 8, "U2")),
    "3D, 30 k": (INCREMENTS, partial(in_space, 0.25, 18, 2)),
    "3D, 100 k": (INCREMENTS, partial(in_space, 0.25, 40, 4)),
    "3D, 300 k": (INCREMENTS, partial(in_space, 0.125, 60, 6)),
    "3D, 1 M": (INCREMENTS, partial(in_space, 0.07, 100, 8)),
}
"""Increments, and what writes the deck."""


@dataclass(frozen=True, slots=True)
class Row:
    """A beam.

    unknowns, iterations  how many
    solver       that auto takes
    before       seconds until the first increment begins: deck, numbering, scatter maps
    memory_before, memory  largest resident set until then, and of the whole run (MiB)
    iteration    seconds, median over the increments
    in_full      seconds of a factorisation in full and a solution of the last matrix
    """

    unknowns: int
    iterations: int
    solver: str
    before: float
    memory_before: float
    memory: float
    iteration: float
    in_full: float


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
        done = bench.run(system, model, library, increments, lambda: None)
        memory = resident()
        solver, in_full = full_solution(system, model, done.displacement)
        library.close()
    counts = len(system), done.iterations
    return Row(*counts, solver, before, memory_before, memory, done.milliseconds / 1e3, in_full)


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
    start = time.process_time()
    solver.factorise((1.0 + 2.0**-20) * data)
    solver.solve(rhs)
    return solver.name, time.process_time() - start


def resident() -> float:
    """Largest resident set of this process (MiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def exponent(rows: list[Row], name: str) -> str:
    """Of a quantity over the number of unknowns, by least squares."""
    if len(rows) < 2:
        return ""
    sizes, values = ([float(getattr(row, each)) for row in rows] for each in ("unknowns", name))
    return f"{np.polyfit(np.log(sizes), np.log(values), 1)[0]:.2f}"


def main() -> int:
    """Run the benchmark; returns 1 if an iteration is slower than its bound."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES), metavar="CASE")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.here:
        print(json.dumps(asdict(measure(options.cases[0]))))
        return 0
    console, rows = Console(width=140), {}
    for name in options.cases:
        ended = subprocess.run(
            [sys.executable, __file__, "--here", "--cases", name], stdout=subprocess.PIPE, check=True
        )
        rows[name] = Row(**json.loads(ended.stdout))
        console.print(name, *(getattr(rows[name], field.name) for field in fields(Row)), soft_wrap=True)
    heads = (
        "unknowns",
        "iterations",
        "solver",
        "before (s)",
        "MiB",
        "MiB in all",
        "iteration (s)",
        "in full (s)",
        "ratio",
    )
    table = Table("", *heads)
    for name, row in rows.items():
        table.add_row(
            name,
            f"{row.unknowns:,}",
            str(row.iterations),
            row.solver,
            f"{row.before:.1f}",
            f"{row.memory_before:,.0f}",
            f"{row.memory:,.0f}",
            f"{row.iteration:.3g}",
            f"{row.in_full:.3g}",
            bench.judged(row.iteration / row.in_full, LARGEST_RATIO),
        )
    for dimension in ("2D", "3D"):
        found = [row for name, row in rows.items() if name.startswith(dimension)]
        powers = [exponent(found, name) for name in ("before", "memory_before", "memory", "iteration", "in_full")]
        table.add_row(f"{dimension}: exponent", "", "", "", *powers, "")
    console.print(table)
    return 0 if all(row.iteration <= LARGEST_RATIO * row.in_full for row in rows.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
