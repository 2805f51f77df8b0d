# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Times of the linear solvers on matrices of double cantilever beams: `python tests/programs/benchmarks/solvers.py`.

CPU times of one process, so that other load counts little, with the threads that the environment allows. The solvers
take turns, and each figure is the median of three: a machine that is slow for a second does not favour one of them. A
matrix is that of the first pass. In part: the stiffness of the first elements of the interface is halved, and restored.
In full: all entries change. With --write the rows replace those of harness/uel/solver/linear/measured.json, and
harness/uel/solver/linear/solvers.md is written again; --kept writes the page of the rows that are there.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from statistics import median

import numpy as np
from rich.console import Console
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, cg, gmres

from uel import usersub
from uel.assembly import Constraints, System, TolerantSystem
from uel.deck import read_deck
from uel.delamination import specimens
from uel.delamination.blocks import BY_EQUATION_21, Interface
from uel.delamination.materials import TABLE_2
from uel.delamination.mesh import refined
from uel.elements import Call, Flags
from uel.model.arrays import FloatArray
from uel.paper import literature
from uel.paper.decks import DCB_REF_INCREMENTS
from uel.solver.linear import LinearSolver, available, choose
from uel.solver.linear.choice import LARGEST_BAND
from uel.solver.linear.linear_solver import Pattern
from uel.solver.linear.measured import Measured, machine, read, write
from uel.solver.linear.ordering import narrowest
from uel.solver.threads import one_blas_thread

ZONE = 1.5
"""Length (mm) of the process zone, behind the tip of the crack, in which the interface changes."""

TOLERANCE = 1e-10
"""Of the residual of an iterative solution, over the right-hand side."""

MOST = 200
"""Iterations."""

LARGEST_SUPERLU = 50_000
"""Unknowns in space: 98,738 take more than four minutes."""

ROUNDS = 3
"""In which all solvers are measured on a matrix."""

GMRES = partial(gmres, restart=MOST, maxiter=1, callback_type="pr_norm")


@dataclass(frozen=True)
class Case:
    """A deck by its builder; symmetric: the symmetric part of its matrix in place of it."""

    name: str
    write: Callable[[Path], Path]
    symmetric: bool = False


def in_plane(factor: int, kind: str, folder: Path) -> Path:
    """DCB-ref on quads cut into factor x factor ones."""
    mesh = specimens.dcb_ref_mesh()
    mesh = refined(mesh, factor) if factor > 1 else mesh
    specimen = specimens.dcb_specimen(
        "beam", mesh, Interface(kind, TABLE_2.with_stiffness(1e6), BY_EQUATION_21, consistent=False)
    )
    for name, content in specimens.mesh_files("beam", mesh, (4, 8)).items():
        (folder / name).write_text(content, encoding="ascii")
    deck = folder / "beam.inp"
    deck.write_text(specimens.dcb_deck("beam", specimen, 5.0, DCB_REF_INCREMENTS, 10), encoding="ascii")
    return deck


def in_space(size: float, across: int, layers: int, folder: Path) -> Path:
    """Half of Krueger's double cantilever beam, with U8 of infinite stiffness."""
    deck = folder / "beam.inp"
    deck.write_text(literature.dcb_benchmark(size, across, layers, (29.0, 39.0)), encoding="ascii")
    return deck


CASES = [
    Case("2D, U2", partial(in_plane, 1, "U2")),
    Case("2D, U4", partial(in_plane, 1, "U4")),
    Case("2D, U4", partial(in_plane, 2, "U4")),
    Case("2D, U2", partial(in_plane, 4, "U2")),
    Case("2D, U4", partial(in_plane, 4, "U4")),
    Case("3D, U8", partial(in_space, 0.4, 12, 2)),
    Case("3D, U8", partial(in_space, 0.25, 18, 2)),
    Case("3D, symmetric part", partial(in_space, 0.25, 18, 2), symmetric=True),
    Case("3D, U8", partial(in_space, 0.25, 40, 4)),
    Case("3D, symmetric part", partial(in_space, 0.25, 40, 4), symmetric=True),
]


class Problem:
    """Matrices of a case.

    data      (nnz,) values of the first pass, and with half of the stiffness in the process zone
    modes     (n, 3 or 6) rigid-body motions of the free unknowns
    """

    def __init__(self, case: Case) -> None:
        with tempfile.TemporaryDirectory() as folder:
            deck = case.write(Path(folder))
            model = read_deck(deck)
            library = usersub.load(None, job="solvers", output_dir=Path(folder), deck=deck)
            system = TolerantSystem(model, library)
            boundaries = [*model.boundaries, *model.steps[0].boundaries]
            prescribed = np.unique(np.concatenate([system.dofs.find(entry.nodes, entry.dof) for entry in boundaries]))
            constraints = Constraints(system, prescribed, model.equations)
            first, softer = self._matrices(system)
            library.close()
        self.pattern = Pattern(constraints.reduced_indptr, constraints.reduced_indices, constraints.coordinates)
        self.data = [constraints.reduce(values).copy() for values in (first, softer)]
        if case.symmetric:
            self.data = [0.5 * (values + values[self.pattern.transposed]) for values in self.data]
        self.rhs = np.random.default_rng(0).standard_normal(self.pattern.size)
        self.modes = _rigid_body_modes(constraints.coordinates, system.dofs.dof[constraints.free])

    @staticmethod
    def _matrices(system: System) -> tuple[FloatArray, FloatArray]:
        call, zero = Call(Flags(1), 1, 1, 1.0, 1.0, 0.01, 1.0), np.zeros(len(system))
        first = system.evaluate(call, zero, zero).data.copy()
        interface = next(b for b in system.blocks if b.group.type in ("U2", "U4", "U8"))
        _, matrices = interface.evaluate_unassembled(call, zero, zero, np.zeros(len(system)))
        x = system.dofs.mesh.coordinates[interface.group.nodes, 0].mean(axis=1)
        matrices[x > x.min() + ZONE] = 0.0
        softer = first.copy()
        interface.add_matrices(-0.5 * matrices, softer)
        return first, softer

    def matrix(self, which: int) -> sparse.csr_array:
        """The matrix of the first pass (0), or the one that is softer (1)."""
        return self.pattern.matrix(self.data[which])


def _rigid_body_modes(coordinates: FloatArray, dof: np.ndarray) -> FloatArray:
    """(n, k) motions of unknowns: translations, then rotations."""
    space = int(dof.max())
    modes = [np.where(dof == axis + 1, 1.0, 0.0) for axis in range(space)]
    for first, second in ((0, 1), (1, 2), (2, 0))[: 1 if space == 2 else 3]:
        turn = np.where(dof == second + 1, coordinates[:, first], 0.0)
        modes.append(turn - np.where(dof == first + 1, coordinates[:, second], 0.0))
    return np.column_stack(modes)


def cpu(function: Callable[[], object]) -> float:
    """CPU time of a call in ms."""
    start = time.process_time()
    function()
    return 1e3 * (time.process_time() - start)


def direct(case: Case, problem: Problem, name: str) -> Measured:
    """The row of a solver."""
    pattern = problem.pattern
    solver = choose(name, pattern.indptr, pattern.indices, coordinates=pattern.coordinates)
    first = cpu(lambda: solver.factorise(problem.data[0]))
    repetitions = 7 if first < 300.0 else 3 if first < 5000.0 else 1
    solution = median(cpu(lambda: solver.solve(problem.rhs)) for _ in range(repetitions))

    def changed(which: int) -> None:
        solver.factorise(problem.data[which])
        solver.solve(problem.rhs)

    before = solver.effort.in_part
    # with the solution, into which GMRES puts all of its time
    part = [cpu(lambda k=k: changed((k + 1) % 2)) - solution for k in range(2 * repetitions)]
    renewed = solver.effort.in_part > before
    full = [cpu(lambda k=k: solver.factorise((1.0 + 1e-3 * (k + 1)) * problem.data[0])) for k in range(repetitions)]
    iterations = on_last_factors(problem, solver)
    return Measured(
        case.name,
        pattern.size,
        narrowest(pattern).width,
        name,
        first,
        median(full),
        median(part) if renewed else None,
        solution,
        iterations,
    )


def on_last_factors(problem: Problem, solver: LinearSolver) -> int:
    """Iterations of GMRES on the softer matrix, preconditioned by the factors of the first one."""
    last = LinearOperator((problem.pattern.size,) * 2, matvec=solver.solve, dtype=np.float64)
    return _iterations(GMRES, problem.matrix(1), problem.rhs, last)


def _iterations(method: Callable[..., object], matrix: sparse.csr_array, rhs: FloatArray, inverse: object) -> int:
    """Iterations of a Krylov method."""
    count = 0

    def counted(_: object) -> None:
        nonlocal count
        count += 1

    method(matrix, rhs, M=inverse, rtol=TOLERANCE, callback=counted)
    return count


def multigrid(case: Case, problem: Problem) -> Measured:
    """The row of smoothed aggregation with rigid-body modes, as the preconditioner of CG or GMRES."""
    import pyamg  # noqa: PLC0415 (need not be installed)

    pattern, matrix = problem.pattern, sparse.csr_matrix(problem.matrix(0))
    symmetric = pattern.is_symmetric(problem.data[0])
    found = []

    def set_up() -> None:
        found.append(
            pyamg.smoothed_aggregation_solver(
                matrix, B=problem.modes, symmetry="symmetric" if symmetric else "nonsymmetric"
            ).aspreconditioner()
        )

    first = cpu(set_up)
    method = partial(cg, maxiter=MOST) if symmetric else GMRES
    counts = []
    solution = cpu(lambda: counts.append(_iterations(method, matrix, problem.rhs, found[0])))
    name = f"pyamg, {'CG' if symmetric else 'GMRES'}"
    return Measured(case.name, pattern.size, narrowest(pattern).width, name, first, None, None, solution, counts[0])


def rows(cases: list[Case], console: Console) -> Iterator[Measured]:
    """Measure all solvers that are installed."""
    for case in cases:
        problem = Problem(case)
        measurements = [partial(direct, case, problem, name) for name in _serving(problem.pattern)]
        if find_spec("pyamg"):
            measurements.append(partial(multigrid, case, problem))
        rounds = [[measure() for measure in measurements] for _ in range(ROUNDS)]
        for row in map(_median, zip(*rounds, strict=True)):
            console.print(*row.cells, sep="  ", soft_wrap=True)
            yield row


def _serving(pattern: Pattern) -> list[str]:
    """The direct solvers that are installed and not hopeless for a pattern."""
    names = [row.name for row in available() if row.installed]
    # 24 bytes for each of the unknowns and each of the half bandwidth
    if 24 * narrowest(pattern).width * pattern.size > LARGEST_BAND:
        names.remove("band")
    if pattern.in_space and pattern.size > LARGEST_SUPERLU:
        names.remove("superlu")
    return names


def _median(rows: tuple[Measured, ...]) -> Measured:
    """Of each time of one solver on one matrix."""
    times = {name: [getattr(row, name) for row in rows] for name in ("first", "full", "part", "solution")}
    return replace(rows[0], **{name: median(found) for name, found in times.items() if None not in found})


def main() -> int:
    """Run the command; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--largest", type=int, default=200_000, help="unknowns of the largest matrix (200000)")
    parser.add_argument(
        "--write", action="store_true", help="replace the rows and the page in harness/uel/solver/linear"
    )
    parser.add_argument("--kept", action="store_true", help="measure nothing: write the page of the rows kept")
    options = parser.parse_args()
    if options.kept:
        write(read())
        return 0
    sizes = dict(zip(CASES, (12, 12, 43, 163, 163, 10, 30, 30, 100, 100), strict=True))
    cases = [case for case in CASES if 1000 * sizes[case] <= options.largest]
    with one_blas_thread():
        found = list(rows(cases, Console()))
    if options.write:
        write((machine(), found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
