# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Speed of a Newton iteration on DCB-ref (abaqus_inputs/dcb_ref): `make bench`.

Times depend on the machine, so the benchmark judges ratios of times measured in one run. Every time is the shortest of
several repetitions; only the iteration of the whole run is an average. The element loops are those of a pass that
calls all elements; in an iteration matrices stand for the linear ones, as in `uel run`.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy import sparse
from scipy.sparse.linalg import splu

from harness import usersub
from harness.assembly import Constraints, System, TolerantSystem
from harness.deck import read_deck
from harness.elements import Call, ElementBlock, Flags
from harness.model.arrays import FloatArray
from harness.model.model import Model
from harness.model.records import IncrementDone, IterationDone
from harness.procedures import run_steps
from harness.solver.linear import available, choose
from harness.solver.threads import one_blas_thread

DECK = Path(__file__).parents[3] / "abaqus_inputs" / "dcb_ref" / "dcb_ref.inp"
LARGEST_ITERATION = 1.5
"""Bound of a Newton iteration over one SuperLU factorisation and solution of its own matrix."""
LARGEST_DRIVER = 1.15
"""Bound of the block driver without scatter of AMATRX over a plain Fortran loop of the same calls."""


def least_of(*functions: Callable[[], object], repetitions: int = 30) -> list[float]:
    """Shortest time of a call of each function in ms; they take turns, so that other load affects all alike."""
    times = np.empty((repetitions, len(functions)))
    for row in times:
        for k, function in enumerate(functions):
            start = time.perf_counter()
            function()
            row[k] = time.perf_counter() - start
    return (1e3 * times.min(axis=0)).tolist()


def least(function: Callable[[], object], repetitions: int = 30) -> float:
    """Shortest time of a call in ms."""
    return least_of(function, repetitions=repetitions)[0]


@dataclass(frozen=True)
class Run:
    """Part of the deck, run. passes: over the elements; milliseconds: of everything from the first step on."""

    displacement: FloatArray
    milliseconds: float
    passes: int
    iterations: int
    increments: int


def run(system: System, model: Model, library: usersub.Library, increments: int) -> Run:
    """Run the deck up to an increment."""
    passes = iterations = 0
    evaluate = system.evaluate

    def counted(*arguments: object, **options: object) -> object:
        nonlocal passes
        passes += 1
        return evaluate(*arguments, **options)

    system.evaluate = counted
    start = time.perf_counter()
    for record in run_steps(system, model, library):
        iterations += isinstance(record, IterationDone)
        if isinstance(record, IncrementDone) and record.increment == increments:
            displacement = record.solution.displacement
            break
    milliseconds = 1e3 * (time.perf_counter() - start)
    system.evaluate = evaluate
    return Run(displacement, milliseconds, passes, iterations, increments)


class Elements:
    """Time of the element loops: with scatter, without it, and of a plain Fortran loop."""

    def __init__(self, system: System, call: Call, u: FloatArray) -> None:
        self._system, self._call, self._u = system, call, u
        self._data, self._residual = np.zeros(len(system.indices)), np.zeros_like(u)
        self.rows = [(block, *self._measure(block)) for block in system.blocks]
        self.assembled = least(lambda: system.evaluate(call, u, np.zeros_like(u)))

    def _measure(self, block: ElementBlock) -> list[float]:
        u, zero, call = self._u, np.zeros_like(self._u), self._call
        return least_of(
            lambda: block.evaluate(call, u, zero, self._residual, self._data),
            lambda: block.evaluate(call, u, zero, self._residual, None),
            lambda: block.bare_loop(call, u, zero, self._residual),
            repetitions=100,
        )

    def report(self, console: Console) -> bool:
        """Print the table; False if the driver is slower than its bound."""
        table = Table("elements", title="Element loops, ns per element", title_justify="left")
        for name in ("with scatter", "without", "plain loop", "ratio"):
            table.add_column(name, justify="right")
        for block, *times in self.rows:
            count = len(block.group.labels)
            per_element = [f"{1e6 * milliseconds / count:.0f}" for milliseconds in times]
            table.add_row(f"{count} x {block.group.type}", *per_element, f"{times[1] / times[2]:.2f}")
        ratio = sum(row[2] for row in self.rows) / sum(row[3] for row in self.rows)
        table.add_row("all", "", "", "", judged(ratio, LARGEST_DRIVER))
        console.print(table)
        console.print("ratio: driver without scatter of AMATRX to a plain Fortran loop of the same calls")
        return ratio <= LARGEST_DRIVER


class Iterations:
    """Time of an iteration with every installed solver, and of SuperLU on the same matrix."""

    def __init__(self, system: System, model: Model, call: Call, u: FloatArray) -> None:
        boundaries = [*model.boundaries, *model.steps[0].boundaries]
        prescribed = np.unique(np.concatenate([system.dofs.find(entry.nodes, entry.dof) for entry in boundaries]))
        self._constraints = constraints = Constraints(system, prescribed, model.equations)
        evaluation = system.evaluate(call, u, np.zeros_like(u))
        dp = np.zeros(len(prescribed))
        self._rhs = constraints.reduce_vector(evaluation.residual)
        self._matrix = constraints.reduce(evaluation.data)
        self.reduction = least(lambda: (constraints.reduce(evaluation.data), constraints.expand(self._rhs, dp)))
        self.superlu = self._superlu()

    def _superlu(self) -> float:
        pattern = self._constraints.reduced_indices, self._constraints.reduced_indptr
        matrix = sparse.csr_array((self._matrix, *pattern)).tocsc()
        options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        factors = splu(matrix, **options)
        return least(lambda: splu(matrix, **options), 10) + least(lambda: factors.solve(self._rhs), 10)

    def report(self, console: Console, elements: Elements, done: Run) -> bool:
        """Print the table; False if an iteration is slower than its bound."""
        table = Table("solver", title="Newton iteration, ms", title_justify="left")
        for name in ("elements", "reduction", "factorisation", "solution", "iteration", "/ SuperLU"):
            table.add_column(name, justify="right")
        good = True
        for name in [row.name for row in available() if row.installed]:
            times = elements.assembled, self.reduction, *self._measure(name)
            good &= self._add(table, name, [f"{value:.2f}" for value in times], sum(times))
        further = done.passes - done.iterations
        iteration = (done.milliseconds - further * elements.assembled) / done.iterations
        good &= self._add(table, "run, auto", [""] * 4, iteration)
        console.print(table)
        solver = self._choose("auto")
        for line in (
            f"SuperLU: {self.superlu:.2f} ms, symmetric ordering, factorisation and solution of the same matrix",
            f"run: {done.iterations} iterations in {done.increments} increments, without {further} passes over the "
            "elements that start an increment or search along a line",
            f"auto takes {solver.name}: {solver.reason}",
        ):
            console.print(line, soft_wrap=True)
        return good

    def _choose(self, name: str):
        constraints = self._constraints
        pattern = constraints.reduced_indptr, constraints.reduced_indices
        return choose(name, *pattern, coordinates=constraints.coordinates, name_of=constraints.name_of)

    def _measure(self, name: str) -> tuple[float, float]:
        solver = self._choose(name)
        solver.factorise(self._matrix)
        return least(lambda: solver.factorise(self._matrix), 15), least(lambda: solver.solve(self._rhs), 15)

    def _add(self, table: Table, name: str, times: list[str], iteration: float) -> bool:
        ratio = iteration / self.superlu
        table.add_row(name, *times, f"{iteration:.2f}", judged(ratio, LARGEST_ITERATION))
        return ratio <= LARGEST_ITERATION


def judged(ratio: float, bound: float) -> str:
    """A ratio, with its bound where it is exceeded."""
    return f"{ratio:.2f}" if ratio <= bound else f"[bold red]{ratio:.2f} > {bound}[/]"


def main() -> int:
    """Run the benchmark; returns 1 if a ratio exceeds its bound."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--increments", type=int, default=30, help="of the run; the load peaks in the 26th (30)")
    options = parser.parse_args()
    console = Console(width=120)
    with tempfile.TemporaryDirectory() as folder, one_blas_thread():
        start = time.perf_counter()
        model = read_deck(DECK)
        library = usersub.load(None, job="bench", output_dir=Path(folder), deck=DECK)
        system = TolerantSystem(model, library)
        seconds = time.perf_counter() - start
        console.print(f"DCB-ref: deck read and system built in {seconds:.2f} s, {len(system)} unknowns")
        done = run(system, model, library, options.increments)
        call = Call(Flags(1), 1, options.increments + 1, 1.0, 1.0, 0.01, 1.0)
        elements = Elements(system, call, done.displacement)
        good = elements.report(console)
        good &= Iterations(system, model, call, done.displacement).report(console, elements, done)
        library.close()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
