# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear steps about the state at the end of the last general step (Abaqus Analysis User's Guide, "General and linear
perturbation procedures"), including *STATIC.

Elements get LFLAGS(4) = 1, and the base state in U. No time passes, and the state does not change.

With NLGEOM, rotations of a linear step are spins: small rotations about the global axes on top of the finite rotations
of the base state. Moments and rotary inertia are conjugate to them, whereas elements return their stiffness with
respect to changes of rotation vectors (`harness/uel/elements/rotations.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.assembly import Constraints, Evaluation
from uel.elements import Call, Flags, Request, spin_matrices
from uel.errors import DeckError
from uel.model.arrays import FloatArray, first_largest
from uel.model.dofs import ROTATIONS
from uel.model.records import AttemptStarted, ElementState, IncrementDone, Noted, Record, Solution, StepDone, Warned
from uel.model.steps import Step
from uel.procedures.general.overconstraints import warn_overconstrained
from uel.procedures.linear.modes import Modes
from uel.procedures.step_setting import Setting, SolverTimes, call_disp, choose_solver
from uel.solver.linear import LinearSolver

BASE_FORCES = (
    "USER ELEMENTS RETURN FORCES OF THE BASE STATE IN RHS OF A LINEAR STEP (LFLAGS(4) = 1), WHERE ABAQUS EXPECTS ONLY "
    "WHAT THE LOADS OF THE STEP ADD. THEY ACT AS LOADS OF THE STEP; SEE uel check."
)

LAST_DISPLACEMENT = 3
"""Last dof of a displacement."""

_ROTATIONS = np.array(ROTATIONS)
"""Dofs of rotations in space."""

ROUNDING = 1e-8
"""Rounding relative to the average force of the elements."""


class PerturbationStep:
    """Linear step; subclasses define the solution."""

    def __init__(self, setting: Setting) -> None:
        self._system, self._step, self._state, self._user = setting.system, setting.step, setting.state, setting.user
        self._constraints = self._constrain(setting)
        self._times = SolverTimes(self._state.effort)
        self._solver_name = setting.solver.linear_solver
        self._increment = 1
        self._modes_for_later: Modes | None = None

    @property
    def reached(self) -> tuple[tuple[float, float], float, int, int]:
        """Step and total time, no time increment, step and increment, as for a general step."""
        return (0.0, self._state.total_time), 0.0, self._step.number, self._increment

    def run(self) -> Generator[Record, None, Modes | None]:
        """Run the step, yield its records, and return its modes. Raises KernelError, SingularMatrixError, DeckError."""
        yield Noted(f"LINEAR SOLVER {self._solver.name.upper()}: {self._solver.reason}")
        yield from warn_overconstrained(self._constraints)
        yield from self._increments()
        yield self._times.note()
        yield StepDone(self._step.number, self._increment, 0, self._increment)
        return self._modes_for_later

    def _constrain(self, setting: Setting) -> Constraints:
        """Return the constraints of the step."""
        boundaries = setting.state.boundaries
        unknowns = boundaries.in_perturbation(setting.step)
        return Constraints(setting.system, unknowns, setting.model.equations, boundaries.sources)

    @cached_property
    def _solver(self) -> LinearSolver:
        """Linear solver of the step."""
        return self._choose_solver(self._solver_name)

    def _choose_solver(self, name: str) -> LinearSolver:
        """Choose the linear solver of this name."""
        return choose_solver(name, self._constraints, self._state.effort)

    def _increments(self) -> Iterator[Record]:
        """Yield the records of all increments."""
        yield from self._increment_by(self._solve)

    def _increment_by(self, solve: Callable[[], list[Record]]) -> Iterator[Record]:
        """Yield the records of the next increment; solve: computes it and returns its records."""
        step, total, size = self._step, self._state.total_time, self._step.procedure.period
        yield AttemptStarted(step.number, self._increment, 1, 0.0, total, size)
        self._user.external_database(1, 0, (0.0, total), size, step.number, self._increment)
        yield from solve()
        self._user.external_database(2, 0, (0.0, total), size, step.number, self._increment)

    def _solve(self) -> list[Record]:
        """Compute the response to the step's loads and prescribed values."""
        evaluation = self._pass(Request.NORMAL)
        assert evaluation.data is not None
        constraints, step = self._constraints, self._step
        load = self._loads(step)
        stiffness = self._system.matrix(evaluation.data)
        external = load + evaluation.residual
        change = self._response(evaluation.data, constraints.reduce(evaluation.data), external)
        constraints.refuse_contradictions(change, f"step {step.number}")
        internal = stiffness @ change
        self._pass(Request.PERTURBATION, change)
        work = 0.5 * float(change @ (self._state.signs * internal))
        solution = self._solution(change, {"ALLSE": work, "ALLWK": work})
        reaction = constraints.reactions(external - internal)
        in_global = self._system.dofs.in_global
        elements = self._elements(change)
        solution = replace(solution, reaction=in_global(reaction), load=in_global(load), elements=elements)
        period = step.procedure.period
        done = IncrementDone(step.number, 1, 1, 1, period, self._state.total_time, period, solution)
        return [Warned(BASE_FORCES), done] if self._unloaded(evaluation) else [done]

    def _response(self, data: FloatArray, reduced: FloatArray, external: FloatArray) -> FloatArray:
        """Solve for the change (n,) due to forces (n,) and the prescribed values of the step.

        data, reduced: CSR values of the stiffness of all unknowns, and of the free ones.
        """
        constraints = self._constraints
        prescribed = self._prescribed()[constraints.prescribed]
        r = external - constraints.prescribed_residual(data, prescribed)
        self._solver.factorise(reduced)
        return constraints.expand(self._solver.solve(constraints.reduce_vector(r)), prescribed)

    def _loads(self, step: Step) -> FloatArray:
        """Return the forces (n,) of the loads of a step, or of a part of it."""
        time, state = (self._step_time, self._state.total_time), self._state
        return state.loads.in_perturbation(step, self._user, self._increment, time, state.displacement)

    @property
    def _step_time(self) -> float:
        """Step time for user routines: 0, or a frequency."""
        return 0.0

    def _prescribed(self) -> FloatArray:
        """Return the prescribed changes (n,), including those by DISP. Raises DeckError without DISP."""
        step, state, user, dofs = self._step, self._state, self._user, self._system.dofs
        values, by_user = state.boundaries.perturbations(step), state.boundaries.perturbed_by_user(step)
        if len(by_user):
            if user.disp is None:
                source = next(entry.source for entry in step.boundaries if entry.user)
                raise DeckError(source, "*BOUNDARY, USER needs DISP, which the job does not have")
            moment = step.number, self._increment, (self._step_time, state.total_time)
            u = state.displacement if step.nlgeom else None
            values[by_user] = call_disp(user, dofs, by_user, values[by_user], moment, step.procedure.period, u)
        return values

    def _symmetric(self, data: FloatArray) -> FloatArray:
        """Return CSR values of the symmetric part of a matrix of the free unknowns."""
        reduced = self._constraints.reduce(data)
        symmetric: FloatArray = 0.5 * (reduced + reduced[self._solver.pattern.transposed])
        return symmetric

    def _modes_of(self, vectors: FloatArray) -> FloatArray:
        """Expand modes from the free unknowns to all unknowns (n, k)."""
        none = np.zeros(len(self._constraints.prescribed))
        return np.array([self._constraints.expand(vector, none) for vector in vectors.T]).T

    def _largest(self, vectors: FloatArray) -> FloatArray:
        """Return the largest displacement (k,) of modes (n, k), or the largest unknown without displacements."""
        displacements = self._system.dofs.dof <= LAST_DISPLACEMENT
        largest = []
        for vector in vectors.T:
            measured = vector[displacements] if np.any(vector[displacements]) else vector
            largest.append(measured[first_largest(np.abs(measured))])
        return np.array(largest)

    def _refuse_single_rotations(self, matrix: sparse.coo_array, lost: NDArray[np.bool_]) -> None:
        """Raise DeckError if entries of a matrix with respect to spins are `lost`, outside the pattern."""
        sizes = np.where(lost, np.abs(matrix.data), 0.0)
        if sizes.max(initial=0.0) <= ROUNDING * np.abs(matrix.data).max(initial=0.0):
            return
        node, dof = self._system.dofs.name(int(matrix.col[sizes.argmax()]))
        message = f"an element acts on rotations of node {node}, which has turned, but not on dof {dof}"
        keyword = self._step.procedure.keyword
        raise DeckError(self._step.source, f"*{keyword}: {message}; expected elements that act on dofs 4 to 6 of it")

    def _unloaded(self, evaluation: Evaluation) -> bool:
        """Return whether user elements return forces in a step without loads on them."""
        count = max(int(evaluation.flux_count.sum()), 1)
        largest = float(np.abs(evaluation.residual).max(initial=0.0))
        return not self._step.distributed and largest > ROUNDING * float(evaluation.flux.sum()) / count

    def _pass(self, request: Request, change: FloatArray | None = None) -> Evaluation:
        """Make a pass over the elements in the base state, for residual and matrix or for a change (n,)."""
        at = self._state.displacement
        du = np.zeros_like(at) if change is None else self._by_vectors(change)
        evaluation = self._system.evaluate(self._call(request), at, du, matrix=change is None)
        if evaluation.data is None or request is Request.MASS:
            return evaluation
        return replace(evaluation, data=self._by_spins(evaluation.data))

    def _stress_matrix(self, change: FloatArray | None = None) -> FloatArray:
        """Return CSR values (nnz,) of the initial stress matrix of a perturbation (n,), or of the base state."""
        added = None if change is None else self._by_vectors(change)
        return self._by_spins(self._system.stress_matrix(self._call(Request.NORMAL), self._state.displacement, added))

    @cached_property
    def _vectors_by_spins(self) -> sparse.csr_array | None:
        """Matrix (n, n) from changes with spins to changes with rotation vectors; None: identity."""
        dofs, u = self._system.dofs, self._state.displacement
        nodes = np.unique(dofs.node[np.isin(dofs.dof, _ROTATIONS)])
        unknowns = dofs.find(nodes[:, None], _ROTATIONS)
        unknowns = unknowns[(unknowns >= 0).all(axis=1)]
        unknowns = unknowns[np.any(u[unknowns], axis=1)]
        if not self._step.nlgeom or not len(unknowns):
            return None
        others = np.setdiff1d(np.arange(len(u)), unknowns)
        inverse = np.linalg.inv(spin_matrices(u[unknowns]))
        rows = np.concatenate([others, np.repeat(unknowns, 3, axis=1).ravel()])
        columns = np.concatenate([others, np.tile(unknowns, (1, 3)).ravel()])
        values = np.concatenate([np.ones(len(others)), inverse.ravel()])
        return sparse.coo_array((values, (rows, columns)), shape=(len(u), len(u))).tocsr()

    def _by_vectors(self, change: FloatArray) -> FloatArray:
        """Convert changes (n,) of all unknowns from spins to rotation vectors."""
        return change if self._vectors_by_spins is None else np.asarray(self._vectors_by_spins @ change)

    def _by_spins(self, data: FloatArray) -> FloatArray:
        """Convert CSR values of a matrix from derivatives by rotation vectors to derivatives by spins."""
        if self._vectors_by_spins is None:
            return data
        system, n = self._system, len(self._system)
        product = (system.matrix(data) @ self._vectors_by_spins).tocoo()
        own = np.repeat(np.arange(n), np.diff(system.indptr)) * n + system.indices
        entries = product.row.astype(np.int64) * n + product.col
        positions = np.minimum(np.searchsorted(own, entries), len(own) - 1)
        inside = own[positions] == entries
        system.agree(partial(self._refuse_single_rotations, product, ~inside & (product.data != 0.0)))
        by_spins = np.zeros_like(data)
        by_spins[positions[inside]] = product.data[inside]
        return by_spins

    def _call(self, request: Request) -> Call:
        step, period = self._step, self._step.procedure.period
        return Call(
            flags=Flags.of(step, request),
            step=step.number,
            increment=self._increment,
            step_time=self._step_time,
            total_time=self._state.total_time,
            time_increment=period,
            period=period,
            distributed=self._state.conditions.in_perturbation(step, self._state.total_time),
            predefined=self._state.predefined,
        )

    def _solution(self, change: FloatArray, measures: dict[str, float]) -> Solution:
        dofs, zero = self._system.dofs, np.zeros_like(change)
        return Solution(
            node=dofs.node,
            dof=dofs.dof,
            displacement=change,
            reaction=zero,
            load=zero,
            velocity=zero,
            acceleration=zero,
            energies=measures,
        )

    def _elements(self, change: FloatArray) -> tuple[ElementState, ...]:
        """Return the changes of strain and stress of elastic built-in elements; none with NLGEOM."""
        if self._step.nlgeom:
            return ()
        call = self._call(Request.NORMAL)
        end, scratch = self._state.displacement + change, np.zeros_like(change)
        changes = []
        before = self._system.states()[:]
        for k, block in enumerate(self._system.blocks):
            if block.elastic:
                block.evaluate(call, end, change, scratch, None)
                trial, base = block.trial(k), before[k]
                changes.append(replace(trial, svars=trial.svars - base.svars, energy=trial.energy - base.energy))
        return tuple(changes)
