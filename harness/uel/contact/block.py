# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact of nodes with a surface: a block of the points of one contact pair.

With g the clearance of a point and f its contact force, a Lagrange multiplier enforces g = 0 where the point is closed
and f = 0 where it is open; with a stiffness f follows from g. Friction is that of Coulomb with an elastic slip: the
friction force is mu f gamma / gamma_crit up to the largest elastic slip gamma_crit, and mu f beyond it (Abaqus Analysis
User's Guide, "Frictional behavior"). Bonds (`contact_cohesion`) are in parallel. See contact.md.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.contact.cohesion import Bonding, Bonds
from uel.contact.finite_sliding import FiniteSliding
from uel.contact.friction import Friction
from uel.contact.kinematics import Clearances, Motion, Slips, SmallSliding
from uel.contact.surface_finite_sliding import SurfaceSliding
from uel.elements.call import NOTHING, BlockReport, Call, CurrentPass
from uel.elements.contributor import Contributor, Find
from uel.elements.lflags import Request
from uel.elements.multipliers import scale_of_multipliers
from uel.model.arrays import FloatArray, IntArray, first_largest
from uel.model.contact import STIFFENED, STIFFENING, ContactChanges, ContactPair, SlidingPair, SurfacePair
from uel.model.dofs import MULTIPLIER
from uel.model.model import Model
from uel.model.restart import Saved
from uel.usersub import _binding, _contact
from uel.usersub._contact import SparseValues

OPEN, STICKING, SLIPPING = 0, 1, 2
"""Status of a point; without friction a closed one counts as sticking."""

ROUNDING: Final = 1e-12
"""Relative error of clearances and contact forces that is rounding."""


class ContactBlock(Contributor):
    """The points of a contact pair: their committed and trial status and elastic slip.

    unknowns  at the start: displacements, then the multiplier of the point, if any
    secondary (m,) secondary nodes
    direct    a multiplier enforces the constraints, else a stiffness
    """

    def __init__(self, model: Model, pair: ContactPair | SlidingPair) -> None:
        self.pair, self.first = pair, 0
        self._motion: Motion
        if isinstance(pair, SurfacePair):
            self._motion = SurfaceSliding(pair, model.mesh.coordinates)
        elif isinstance(pair, SlidingPair):
            self._motion = FiniteSliding(pair, model.mesh.coordinates)
        else:
            self._motion = SmallSliding(pair, model.mesh.coordinates)
        self.secondary = self._motion.nodes[:, 0]
        m = len(self.secondary)
        self.rows = np.arange(m)
        self._mesh = model.mesh
        self.direct = pair.property.stiffness is None
        count = self._motion.nodes.shape[1]
        self.unknowns = self._motion.unknowns_of(count) + (((count, MULTIPLIER),) if self.direct else ())
        start = self._motion.start()
        self._status = np.where((start <= pair.property.clearance) & self._motion.above, STICKING, OPEN)
        self._slip = np.zeros((m, self._motion.components))
        self._status_trial, self._slip_trial = self._status, self._slip
        self._before, self._iteration = self._status, 0
        self._bonds: Bonds | None = None
        if pair.property.cohesion is not None:
            self._bonds = Bonds(pair, self._status != OPEN, self._motion.components)
        self._scale = 0.0
        self._output = (start, np.zeros(m), np.zeros((m, pair.dimension - 1)))
        self._penetration = self._force = self._stiffness = np.zeros(m)
        self._equations = self._own_positions = np.zeros((m, 0), dtype=np.int32)
        self._find: Find | None = None
        # nodes of the points and of their slips when they were numbered
        self._numbered: tuple[IntArray | None, IntArray | None] = None, None
        self._slip_equations = self._equations
        self._multipliers = np.zeros(m, dtype=np.int32)
        self._pattern = (self._equations, self._equations)

    @property
    def nodes(self) -> IntArray:
        """Nodes (m, k) of the points: the secondary node, then those that move it."""
        return self._motion.nodes

    @property
    def names(self) -> list[str]:
        """Names (m,) of the secondary nodes."""
        return [self._mesh.name(node) for node in self.secondary.tolist()]

    def number(self, find: Find, equations: NDArray[np.int32]) -> None:
        """Set the numbers of the unknowns, of which the last is the multiplier of a point, if it has one."""
        self._find, self._multipliers, self._numbered = find, equations[:, -1], (None, None)
        self._number()

    def _number(self) -> None:
        """Set the unknowns of the points and of their slips for their current nodes."""
        nodes, slip_nodes = self._motion.nodes, self._motion.slip_nodes
        if self._numbered[0] is not nodes:
            self._equations = self._equations_of(self.rows, nodes)
        if slip_nodes is nodes:
            self._slip_equations = self._equations[:, : self._equations.shape[1] - self.direct]
        elif self._numbered[1] is not slip_nodes:
            self._slip_equations = self._unknowns_of(slip_nodes)
        self._numbered = nodes, slip_nodes

    def track(self, now: CurrentPass) -> bool:
        """Project the contact points before a pass; return whether the matrix, if any, has the entries for them."""
        assert self._find is not None
        if not now.has_forces:
            return True
        self._motion.track(now.u, now.du, self._find, first=now.call.iteration == 0)
        self._number()
        if self._motion.known or now.data is None:
            return True
        self._motion.reach()
        return False

    def couplings(self) -> NDArray[np.int32]:
        """Return (r, unknowns) coupled unknowns of the points, those of neighbouring pieces included."""
        return self._equations_of(*self._motion.links())

    def _equations_of(self, points: IntArray, nodes: IntArray) -> NDArray[np.int32]:
        multipliers = [self._multipliers[points, None]] if self.direct else []
        return np.concatenate([self._unknowns_of(nodes), *multipliers], axis=1)

    def _unknowns_of(self, nodes: IntArray) -> NDArray[np.int32]:
        """Return the unknowns (r, u) of the nodes (r, n) of points."""
        assert self._find is not None
        columns = [self._find(nodes[:, local], dof) for local, dof in self._motion.unknowns_of(nodes.shape[1])]
        return np.stack(columns, axis=1).astype(np.int32)

    def locate(self, indptr: NDArray[np.int32], indices: NDArray[np.int32]) -> None:
        """Set the CSR pattern of the matrix."""
        self._pattern = indptr, indices
        equations = np.concatenate([self._equations[:, : self.pair.dimension], self._equations[:, -1:]], axis=1)
        self._own_positions = _binding.scatter_map(equations, indptr, indices)

    def contribute(self, now: CurrentPass) -> BlockReport:
        """Run one pass, and report its changes and the energies of bonds."""
        if now.has_forces and len(self.rows):
            self._respond(now)
        energy, damage = (np.zeros(8), 0.0) if self._bonds is None else self._bonds.energies
        return NOTHING._replace(energy=energy, damage=damage, contact=self._changes())

    def _respond(self, now: CurrentPass) -> None:
        """Add the contact forces and their derivatives.

        The status of a point changes at most once in an iteration: it depends on that at the end of the previous one.
        """
        call, residual, data = now.call, now.columns[0], now.data
        if data is not None and not self._scale:
            self._scale = scale_of_multipliers(data, self._own_positions, self.pair.dimension)
        count = self._equations.shape[1] - self.direct
        displacement, change = now.u[self._equations[:, :count]], now.du[self._equations[:, :count]]
        clearances = self._motion.clearances(displacement, nlgeom=call.flags.nlgeom)
        clearance, before = clearances.value, self._status_before(call)
        small = ROUNDING * float(np.abs(displacement).max()) + 8.0 * clearances.rounding
        if self.direct:
            multiplier = now.u[self._equations[:, count]] * self._scale
            closed = self._closed(before, clearance, multiplier, small)
        else:
            multiplier, self._stiffness = self._penalty(clearance)
            closed = multiplier > 0.0
        if call.iteration == 0:
            closed = before != OPEN
        closed &= self._motion.above
        force = np.where(closed, multiplier, 0.0)
        slips = self._motion.slips(displacement, change, self._slip)
        sticks = np.ones(len(force)) if self._bonds is None else self._bonds.damage
        friction = Friction(self.pair, force, np.where(closed[:, None], slips.value, 0.0), closed, sticks, small)
        matrix = None if data is None else SparseValues(*self._pattern, data)
        self._add(residual, matrix, (clearances, slips), (multiplier, force, closed), friction)
        normal, shear, loaded = force, friction.force, closed
        if self._bonds is not None:
            since = self._motion.slips(displacement, change, self._bonds.slip)
            pulled = self._bonds.bonded & self._motion.above & (~closed if self.direct else clearance >= 0.0)
            bonding = self._bonds.respond(call.time_increment, clearance, since, self._motion.areas, pulled)
            self._add_bonds(residual, matrix, clearances, bonding)
            normal, shear, loaded = normal - bonding.normal, shear + bonding.shear, closed | self._bonds.bonded
        if matrix is not None:
            points = np.flatnonzero(loaded & self._motion.above)
            self._motion.add_stiffness(points, normal[points], shear[points], self._equations[points, :count], matrix)
        if call.flags.request is Request.NORMAL:
            after = np.where(closed, np.where(friction.slips, SLIPPING, STICKING), OPEN)
            self._status_trial = before if call.iteration == 0 else after
            self._slip_trial, self._force = friction.elastic, multiplier
            self._output = (clearance, normal, np.einsum("mat,mt->ma", slips.axes, shear))
            violated = closed & self.direct & (np.abs(clearance) > small)
            self._penetration = np.where(violated, clearance, 0.0)

    def _penalty(self, clearance: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return penalty forces (m,), negative without contact, and their derivatives by the overclosure.

        PENALTY=NONLINEAR: the stiffness grows linearly with the overclosure between two of its values (Abaqus Analysis
        User's Guide, "Contact constraint enforcement methods in Abaqus/Standard").
        """
        contact = self.pair.property
        assert contact.stiffness is not None
        depth = contact.clearance - clearance
        upper = contact.clearance + STIFFENED * self.pair.length
        width = (1.0 - STIFFENING) * upper
        fraction = np.clip((depth - STIFFENING * upper) / width, 0.0, 1.0)
        integral = 0.5 * width * fraction**2 + np.maximum(depth - upper, 0.0)
        stiffness, growth = contact.stiffness * self._motion.areas, 1.0 - contact.initial
        return stiffness * (contact.initial * depth + growth * integral), stiffness * (
            contact.initial + growth * fraction
        )

    def _status_before(self, call: Call) -> IntArray:
        """Return the status at the end of the previous iteration, in the first pass at the start of the increment."""
        if call.iteration == 0:
            self._before = self._status
        elif call.iteration != self._iteration:
            self._before = self._status_trial
        self._iteration = call.iteration
        return self._before

    def _closed(self, before: IntArray, clearance: FloatArray, force: FloatArray, small: float) -> NDArray[np.bool_]:
        """Return the mask of closed points: points open under tension, and close at a penetration above rounding."""
        tension = ROUNDING * np.abs(force).max() + small * self._scale
        return np.where(before == OPEN, clearance < -small, force >= -tension)

    def _add(
        self,
        residual: FloatArray,
        matrix: SparseValues | None,
        motion: tuple[Clearances, Slips],
        state: tuple[FloatArray, FloatArray, NDArray[np.bool_]],
        friction: Friction,
    ) -> None:
        """Add the contributions of contact and friction; state: multipliers or penalty forces, forces, closed."""
        multiplier, force, closed = state
        clearances, slips = motion
        normal, conjugate = clearances.gradient, clearances.conjugate
        tangents, scale = slips.conjugate, self._scale
        count = normal.shape[1]
        forces = np.zeros(self._equations.shape)
        forces[:, :count] = force[:, None] * conjugate - np.einsum("mt,mtu->mu", friction.force, tangents)
        if self.direct:
            forces[:, count] = np.where(closed, scale * clearances.value, -multiplier)
        np.add.at(residual, self._equations, forces)
        if matrix is None:
            return
        if self.direct:
            matrix.values[self._own_positions[~closed, -1, -1]] += scale
        # open points have no other entries
        points = np.flatnonzero(closed)
        along, unknowns = tangents[points], self._equations[points, :count]
        by_slip = np.einsum("mts,msv->mtv", friction.by_slip[points], slips.by[points])
        _contact.add_products(along, unknowns, by_slip, self._slip_equations[points], matrix)
        # derivative of the nodal forces by the contact force
        by_force = (np.einsum("mt,mtu->mu", friction.by_force[points], along) - conjugate[points])[:, None]
        by_motion = -normal[points, None]
        if self.direct:
            multipliers, factor = self._equations[points, count:], np.full((len(points), 1, 1), scale)
            _contact.add_products(by_force, unknowns, factor, multipliers, matrix)
            _contact.add_products(factor, multipliers, by_motion, unknowns, matrix)
        else:
            by_force *= self._stiffness[points, None, None]
            _contact.add_products(by_force, unknowns, by_motion, unknowns, matrix)

    def _add_bonds(
        self, residual: FloatArray, matrix: SparseValues | None, clearances: Clearances, bonding: Bonding
    ) -> None:
        """Add the contributions of bonds."""
        assert self._bonds is not None
        points = np.flatnonzero(self._bonds.bonded & self._motion.above)
        normal, shear, slips = bonding.normal[points], bonding.shear[points], bonding.slips
        directions = np.concatenate([clearances.conjugate[points, None], slips.conjugate[points]], axis=1)
        forces = np.concatenate([normal[:, None], shear], axis=1)
        equations = self._equations[points, : directions.shape[2]]
        np.add.at(residual, equations, -np.einsum("mt,mtu->mu", forces, directions))
        if matrix is None:
            return
        by_motion = bonding.by[points, :, :1] * clearances.gradient[points, None]
        by_slip = np.einsum("mts,msv->mtv", bonding.by[points, :, 1:], slips.by[points])
        _contact.add_products(directions, equations, by_motion, equations, matrix)
        _contact.add_products(directions, equations, by_slip, self._slip_equations[points], matrix)

    def _changes(self) -> ContactChanges:
        """Return the status changes in the last iteration, and the constraint errors at its end."""
        before, after = self._before, self._status_trial
        switched = (before == OPEN) != (after == OPEN)
        return ContactChanges(
            self.pair.name,
            opened=int(np.count_nonzero((before != OPEN) & (after == OPEN))),
            closed=int(np.count_nonzero((before == OPEN) & (after != OPEN))),
            sticking=int(np.count_nonzero((before == SLIPPING) & (after == STICKING))),
            slipping=int(np.count_nonzero((before == STICKING) & (after == SLIPPING))),
            penetration=self._largest(self._penetration),
            force=self._largest(np.where(switched, self._force, 0.0)),
        )

    def _largest(self, values: FloatArray) -> tuple[float, int]:
        worst = int(first_largest(np.abs(values)))
        return float(values[worst]), int(self.secondary[worst])

    @property
    def output(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Clearances (m,), pressures (m,), negative where a bond is pulled, and shear stresses (m, directions), after
        the last iteration.
        """
        clearance, force, shear = self._output
        areas = self._motion.areas
        return clearance, force / areas, shear / areas[:, None]

    @property
    def bonds(self) -> dict[str, FloatArray]:
        """Variables of the bonds (m,), by their names in Abaqus."""
        return {} if self._bonds is None else self._bonds.output

    def commit(self) -> None:
        """Commit the trial state at the end of a converged increment."""
        self._status, self._slip = self._status_trial, self._slip_trial
        self._motion.commit()
        if self._bonds is not None:
            self._bonds.commit()

    def kept(self) -> Saved:
        """Return the committed state, not copied."""
        saved: Saved = {"status": self._status, "slip": self._slip, "scale": self._scale, "motion": self._motion.kept()}
        return saved if self._bonds is None else {**saved, "bonds": self._bonds.kept()}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned. Raises ValueError if it is not of these points."""
        if np.shape(saved["status"]) != self._status.shape or np.shape(saved["slip"]) != self._slip.shape:
            raise ValueError(f"contact pair {self.pair.name}")
        self._status, self._slip, self._scale = saved["status"], saved["slip"], saved["scale"]
        self._motion.resume(saved["motion"])
        if self._bonds is not None:
            self._bonds.resume(saved["bonds"])
        self._number()
        self._status_trial, self._slip_trial = self._status, self._slip
