# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DYNAMIC: implicit integration by the operator of Hilber, Hughes and Taylor, or by backward Euler.

Abaqus Theory Guide, "Implicit dynamic analysis": M a + (1 + alpha) (I - P) at the end - alpha (I - P) at the start = 0.
Elements return M a and I with these weights in RHS; the step weights its loads P. Nodes on arms transfer these forces
in the directions of (1 + alpha) u at the end - alpha u at the start: the directions at the end damp a spin to first
order.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from uel.assembly import Evaluation
from uel.elements import Motion, Request
from uel.model.arrays import FloatArray
from uel.model.procedures import Dynamic, Integrator
from uel.model.records import Warned
from uel.model.restart import Saved
from uel.procedures.context import StepContext
from uel.procedures.general.incrementation import Accuracy
from uel.procedures.general.step_parts import InitialMotion, Part, PartEnd, PartStart
from uel.solver.newton import Increment, Iterate

HALF_INCREMENT = "THE HALF-INCREMENT RESIDUAL IS LARGER THAN ITS TOLERANCE."


REPLACED = "INITIAL VELOCITIES OF NODES THAT FOLLOW OTHERS BY CONSTRAINTS ARE NOT THEIRS AND ARE REPLACED"

CONSISTENT = 1e-6
"""Relative difference up to which initial velocities fulfil the constraints: decks have six digits."""

MOVED = 1e-6
"""Displacement along the velocities, over the size of the model, for differences of volumes."""


@dataclass(frozen=True, slots=True)
class VolumeConstraint:
    """Equations of incompressible hybrid elements for the initial accelerations.

    rows    (n,) mask of their pressures
    data    (nnz,) CSR values that couple the pressures with accelerations
    forces  (n,) right-hand side of the pressures
    """

    rows: NDArray[np.bool_]
    data: FloatArray
    forces: FloatArray


def advance(procedure: Dynamic, before: Motion, size: float, increment: FloatArray) -> Motion:
    """Compute velocities and accelerations at the end of an increment of displacement (n,) from those at its start."""
    velocity, acceleration = before.velocity, before.acceleration
    if procedure.integrator is Integrator.BACKWARD_EULER:
        new = increment / size
        return Motion(new, (new - velocity) / size)
    beta, gamma = procedure.beta, procedure.gamma
    after = (increment - size * velocity - (0.5 - beta) * size**2 * acceleration) / (beta * size**2)
    return Motion(velocity + size * ((1.0 - gamma) * acceleration + gamma * after), after)


class ImplicitIntegration(Part):
    """Velocities and accelerations of a dynamic step, and its half-increment residual."""

    def __init__(self, context: StepContext, procedure: Dynamic) -> None:
        self._context = context
        self._procedure = procedure
        self._previous_load = context.load_at(0.0)
        self._previous = np.zeros(len(context.system))
        self._inertia: sparse.csr_array | None = None

    def start(self) -> PartStart:
        """Make initial velocities consistent, and compute the initial accelerations, unless they are zero."""
        state, constraints = self._context.state, self._context.constraints
        constraints.update(state.displacement, np.zeros_like(state.displacement))
        following = constraints.project(state.velocity)
        largest = np.abs(state.velocity).max(initial=0.0)
        # as in Abaqus, constraints take precedence; in later steps the difference is the error of integration
        replaced = len(state.begun) == 1 and np.abs(following - state.velocity).max(initial=0.0) > CONSISTENT * largest
        velocity = following if replaced else state.velocity
        initial = InitialMotion(velocity, state.acceleration, state.displacement, state.external, state.energy)
        if constraints.arms and self._procedure.integrator is Integrator.HHT:
            mass = self._at_rest(initial, Request.MASS).data
            assert mass is not None
            self._inertia = constraints.inertia(self._context.system.matrix(mass))
        if self._procedure.initial_acceleration:
            initial = self._accelerated(initial)
        return PartStart([Warned(REPLACED)] if replaced else [], initial)

    def _accelerated(self, initial: InitialMotion) -> InitialMotion:
        """Solve M a = P - I for the initial accelerations, zero for unknowns without mass."""
        context, constraints = self._context, self._context.constraints
        of_nodes = context.system.dofs.of_nodes
        incompressible = None if of_nodes.all() else self._incompressible(initial)
        evaluation = self._at_rest(initial, Request.INITIAL_ACCELERATION)
        load = context.load_at(0.0)
        assert evaluation.data is not None
        convective = constraints.convective(initial.displacement, initial.velocity)
        data = evaluation.data
        rhs = evaluation.residual + load - context.system.product(data, convective)
        if incompressible is not None:
            data, rhs = data + incompressible.data, np.where(incompressible.rows, incompressible.forces, rhs)
        mass = constraints.reduce(data)
        reduced = constraints.reduce_vector(rhs)
        indptr, indices = constraints.reduced_indptr, constraints.reduced_indices
        row = np.repeat(np.arange(len(reduced)), np.diff(indptr))
        massless = context.system.sum(np.bincount(row, np.abs(mass), len(reduced)).astype(np.float64)) == 0.0
        mass[(row == indices) & massless[row]] = 1.0
        reduced[massless] = 0.0
        context.solver.factorise(mass)
        solution = convective + constraints.expand(context.solver.solve(reduced), np.zeros(len(constraints.prescribed)))
        initial = replace(initial, acceleration=np.where(of_nodes, solution, 0.0))
        if incompressible is not None:
            initial = replace(initial, displacement=initial.displacement + np.where(of_nodes, 0.0, solution))
            evaluation = self._at_rest(initial, Request.INITIAL_ACCELERATION)
        context.system.commit()
        return replace(initial, external=load + context.state.reaction, energy=evaluation.energy)

    def _at_rest(self, initial: InitialMotion, request: Request, moved: FloatArray | float = 0.0) -> Evaluation:
        """Make a pass at the start of the step, without accelerations."""
        context, zero = self._context, np.zeros_like(initial.displacement)
        call = context.call(0.0, 0.0, context.start, initial.displacement).asking(request)
        motion = Motion(initial.velocity, np.zeros_like(initial.velocity))
        return context.system.evaluate(call, initial.displacement + moved, zero, motion=motion)

    def _incompressible(self, initial: InitialMotion) -> VolumeConstraint | None:
        """Build the volume constraint of incompressible hybrid elements, None without them.

        The rows B of their pressures in the stiffness demand B v = 0, so that B a = - dB/dt v.
        """
        context, velocity = self._context, initial.velocity
        system = context.system
        data = self._stiffness(initial)
        rows = ~system.dofs.of_nodes & (system.sum(system.matrix(data).diagonal()) == 0.0)
        if not rows.any():
            return None
        row = np.repeat(np.arange(len(system)), np.diff(system.indptr))
        coupling = np.where(rows[row] != rows[system.indices], data, 0.0)
        forces = np.zeros(len(system))
        if context.step.nlgeom and velocity.any():
            # central differences are exact: volumes are cubic in displacements
            distance = MOVED * np.ptp(system.dofs.coordinates, axis=0).max() / np.abs(velocity).max()
            ahead, behind = (self._stiffness(initial, sign * distance * velocity) for sign in (1.0, -1.0))
            forces = -system.product((ahead - behind) / (2.0 * distance), velocity)
        return VolumeConstraint(rows, coupling, forces)

    def _stiffness(self, initial: InitialMotion, moved: FloatArray | float = 0.0) -> FloatArray:
        """Return CSR values (nnz,) at the start of the step, of this rank."""
        evaluation = self._at_rest(initial, Request.STIFFNESS, moved)
        assert evaluation.data is not None
        return evaluation.data.copy()

    def _motion(self, size: float, increment: FloatArray) -> Motion:
        """Return the motion at the end of an increment; unknowns of elements have none."""
        before = Motion(self._context.state.velocity, self._context.state.acceleration)
        after, of_nodes = advance(self._procedure, before, size, increment), self._context.system.dofs.of_nodes
        return Motion(np.where(of_nodes, after.velocity, 0.0), np.where(of_nodes, after.acceleration, 0.0))

    def add_to(self, increment: Increment, size: float) -> Increment:
        """Weight the loads of the end and the start, and add the motion as a function of displacements."""
        alpha, state, context = self._procedure.alpha, self._context.state, self._context
        f_ext = (1.0 + alpha) * increment.f_ext - alpha * context.load_at(context.step_time)
        guess = increment.guess
        if context.step.extrapolation == "VELOCITY PARABOLIC":
            guess = size * state.velocity + 0.5 * size**2 * state.acceleration
        return replace(increment, guess=guess, f_ext=f_ext, weight=1.0 + alpha, motion=partial(self._motion, size))

    def accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """Return the half-increment residual, the unbalanced forces in the middle of the increment."""
        procedure, context = self._procedure, self._context
        if not (procedure.half_force or np.isfinite(procedure.half_increment)):
            return None
        increment = self._middle_increment(last, size)
        evaluation = self._pass_at_middle(last, size, increment)
        middle = context.step_time + 0.5 * size
        alpha = procedure.alpha
        start = context.load_at(context.step_time)
        at_middle = context.load_at(middle, context.state.displacement + increment)
        load = (1.0 + alpha) * at_middle - 0.5 * alpha * (start + self._previous_load)
        residual = evaluation.residual + load
        constraints, before = context.constraints, context.state.displacement
        # forces at the start are means of the last two increments, as the loads are
        constraints.update(before + increment, residual, increment + 0.5 * self._previous, 1.0 + alpha)
        ratio = context.checker.largest_ratio(residual, self._tolerances())
        constraints.update(before + last.du, last.r, last.du, 1.0 + alpha)
        return Accuracy(ratio, HALF_INCREMENT)

    def _tolerances(self) -> dict[str, float]:
        """Return the tolerance of the half-increment residual by field; only forces and moments have one."""
        procedure = self._procedure
        means = self._context.checker.time_averages().items()
        forces = {name: mean for name, mean in means if name in ("force", "moment")}
        if procedure.half_force:
            return dict.fromkeys(forces, procedure.half_force)
        return {name: procedure.half_increment * mean for name, mean in forces.items()}

    def _middle_increment(self, last: Iterate, size: float) -> FloatArray:
        """Interpolate the increment at its middle, by a cubic from the state at the start to the end."""
        state = self._context.state
        increment = last.du / 8 + 0.375 * size * state.velocity + size**2 / 16 * state.acceleration
        increment = np.where(self._context.system.dofs.of_nodes, increment, 0.5 * last.du)
        return self._context.constraints.satisfy(state.displacement, increment)

    def _pass_at_middle(self, last: Iterate, size: float, increment: FloatArray) -> Evaluation:
        """Make a pass at half the increment, over which accelerations are linear."""
        context, state, half = self._context, self._context.state, 0.5 * size
        end = self._motion(size, last.du)
        velocity = 0.75 / size * last.du + 0.25 * state.velocity - size / 8 * state.acceleration
        acceleration = 0.5 * (state.acceleration + end.acceleration)
        motion, at = Motion(velocity, acceleration), state.displacement + increment
        call = context.call(size, context.step_time + half, context.start + context.step_time + half, at)
        return context.system.evaluate(call.asking(Request.RESIDUAL), at, increment, matrix=False, motion=motion)

    def kept(self) -> Saved:
        """Return the load at the start of the last increment, this increment, and the inertia of dependent nodes."""
        matrix = self._inertia
        inertia = {} if matrix is None else {name: getattr(matrix, name) for name in ("data", "indices", "indptr")}
        return {"load": self._previous_load, "increment": self._previous, "inertia": inertia}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        self._previous_load, self._previous = saved["load"], saved["increment"]
        if saved["inertia"]:
            values = tuple(saved["inertia"][name] for name in ("data", "indices", "indptr"))
            self._inertia = sparse.csr_array(values, shape=2 * (len(self._context.system),))

    def converged(self, last: Iterate, size: float) -> PartEnd:
        """Return velocities and accelerations at the end.

        The integration violates the constraints of nodes on arms by O(h^2) in the increment h. Without the projection,
        errors of a spin omega grow in each increment by (1 + omega h)(1 + alpha)/(1 - alpha).
        """
        context = self._context
        self._previous_load, self._previous = context.load_at(context.step_time), last.du
        motion = self._motion(size, last.du)
        velocity = motion.velocity
        if self._inertia is not None:
            velocity = context.constraints.project_velocity(velocity, self._inertia)
        return PartEnd(motion=Motion(velocity, motion.acceleration))
