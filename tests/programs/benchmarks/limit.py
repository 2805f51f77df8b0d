# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DCB-ref to its end against the least that its iterations need: part of `make bench`.

The least is a plain Fortran loop over the interface elements, a band matrix that is copied and factorised by LAPACK,
and a solution, measured after each increment on the elastic matrix. Everything else is left out: the bulk, whose matrix
is constant, assembly, the search along a line, checks of convergence. The whole run is judged against the iterations
that another code needed for the same problem; the ratio for each iteration is shown beside it. Times are those of the
processor in this thread, without reading the deck and writing files.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from bench import DECK, in_turns, judged
from rich.console import Console
from scipy.linalg.lapack import dgbtrf, dgbtrs

from uel import usersub
from uel.assembly import Constraints, TolerantSystem, system_of
from uel.deck import read_deck
from uel.elements import Call, Flags
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.model.records import IncrementDone, IterationDone
from uel.procedures import run_steps
from uel.solver.linear.linear_solver import Pattern
from uel.solver.linear.ordering import narrowest
from uel.solver.threads import one_blas_thread

ITERATIONS = 673
"""Of a prototype in numpy: Newton's method with a search along a line, viscosity 3e-6, 4 cutbacks."""

LARGEST_RATIO = 1.25
"""Bound of the run over the least."""


def band_of(constraints: Constraints, data: FloatArray) -> tuple[FloatArray, int]:
    """The matrix in the storage of LAPACK, and its half bandwidth."""
    pattern = Pattern(constraints.reduced_indptr, constraints.reduced_indices, constraints.coordinates)
    ordering = narrowest(pattern)
    row, column, width = ordering.position[pattern.rows], ordering.position[pattern.indices], ordering.width
    band = np.zeros((3 * width + 1, pattern.size), order="F")
    band[2 * width + row - column, column] = data
    return band, width


def least_iteration(model: Model, library: usersub.Library) -> Callable[[], None]:
    """What an iteration needs at least, on the elastic matrix."""
    system = system_of(model, library)
    call, u = Call(Flags(1), 1, 1, 1.0, 1.0, 0.01, 1.0), np.zeros(len(system))
    boundaries = [*model.boundaries, *model.steps[0].boundaries]
    prescribed = np.unique(np.concatenate([system.dofs.find(entry.nodes, entry.dof) for entry in boundaries]))
    constraints = Constraints(system, prescribed, model.equations)
    evaluation = system.evaluate(call, u, u)
    assert evaluation.data is not None
    band, width = band_of(constraints, constraints.reduce(evaluation.data))
    rhs, copy, residual = np.ones(band.shape[1]), band.copy(order="F"), np.zeros_like(u)
    interface = next(block for block in system.blocks if block.group.type == "U2")

    def iteration() -> None:
        interface.bare_loop(call, u, u, residual)
        copy[:] = band
        factors, pivots, _ = dgbtrf(copy, width, width, overwrite_ab=1)
        dgbtrs(factors, width, width, rhs, pivots)

    return iteration


class Run(NamedTuple):
    """DCB-ref, increment by increment.

    seconds     of the processor, without reading the deck and writing files
    iterations  how many
    openings    distance of the loaded corners at its end (mm)
    loads       at its end (N)
    least       what an iteration needs at least (ms), a mean over the iterations: for each increment it is measured
                before and after, for a machine that becomes slower or faster on the way does so for both
    """

    seconds: FloatArray
    iterations: list[int]
    openings: FloatArray
    loads: FloatArray
    least: float


def run() -> Run:
    """DCB-ref to its end, the least measured in turns with its increments."""
    with tempfile.TemporaryDirectory() as folder, one_blas_thread():
        model = read_deck(DECK)
        library = usersub.load(None, job="limit", output_dir=Path(folder), deck=DECK)
        iteration = least_iteration(model, library)
        system = TolerantSystem(model, library)
        loaded = int(system.dofs.find(model.nsets["LOAD_TOP"], 2)[0])
        rows: list[tuple[float, int, float, float]] = []

        def measured() -> float:
            return float(in_turns(iteration, repetitions=3).min())

        least = [measured()]
        iterations, start = 0, time.thread_time()
        for record in run_steps(system, model, library):
            iterations += isinstance(record, IterationDone)
            if isinstance(record, IncrementDone):
                seconds, state = time.thread_time() - start, record.solution
                rows.append((seconds, iterations, 2 * state.displacement[loaded], state.reaction[loaded]))
                least.append(measured())
                iterations, start = 0, time.thread_time()
        library.close()
    seconds, counts, openings, loads = zip(*rows, strict=True)
    beside = (np.array(least[:-1]) + least[1:]) / 2
    mean = float(np.average(beside, weights=counts))
    return Run(np.array(seconds), list(counts), np.array(openings), np.array(loads), mean)


def main() -> int:
    """Run the benchmark; returns 1 if the run takes more than its bound."""
    console = Console(width=120)
    done = run()
    seconds, iterations = float(done.seconds.sum()), sum(done.iterations)
    ratio = 1e3 * seconds / (ITERATIONS * done.least)
    console.print(
        f"DCB-ref: {seconds:.2f} s of processor time for {len(done.seconds)} increments, {iterations} iterations. "
        f"The least is {done.least:.2f} ms an iteration: {judged(ratio, LARGEST_RATIO)} times that of {ITERATIONS}, "
        f"{1e3 * seconds / iterations / done.least:.2f} times that of its own",
        soft_wrap=True,
    )
    return 0 if ratio <= LARGEST_RATIO else 1


if __name__ == "__main__":
    sys.exit(main())
