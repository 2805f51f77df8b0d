# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributing couplings in large displacements: a block of pairs of a coupled node and its reference node.

A coupled node with the weight w at p from the reference node has the force f = w (a + b x p), the reference node -f and
-p x f: they balance in the current configuration. a and b are multipliers. With the increment dp of p, p_m = p at its
middle, and the increment of rotation omega of the reference node, 2 tan(t/2) along the axis, they enforce

    sum w q = 0,    sum w p_m x q = 0,    q = dp - omega x p_m.

With the positions r from the centre of the coupled nodes and T = sum w (r.r I - r r^T), the first equation says that
the centre rotates with the reference node, and then the second that omega = T_m^-1 sum w r_m x du, the midpoint
increment of J. Hughes and J. Winget; the forces are those of b = T^-1 times the moment about the centre (Abaqus Theory
Guide, Distributing coupling elements: Load distribution, Finite motion). Moments are about the global axes, and are not
derivatives by rotation vectors, so that the matrix is unsymmetric. Without NLGEOM p is that of the mesh, and omega the
increment of dofs 4 to 6.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uel.elements.call import NOTHING, BlockReport, CurrentPass
from uel.elements.contributor import Contributor
from uel.elements.lflags import Request
from uel.elements.multipliers import scale_of_multipliers
from uel.elements.rotations import PERMUTATION, cross_matrices, rotation_matrices, spin_matrices
from uel.model.arrays import FloatArray, IntArray, first_largest
from uel.model.couplings import CouplingErrors
from uel.model.dofs import COUPLED
from uel.model.model import Model
from uel.model.restart import Saved
from uel.usersub import _binding

# unknowns of a pair: displacements of both nodes, rotations of the reference node, a and b
_COUPLED, _REFERENCE, _ROTATION, _A, _B = (slice(start, start + 3) for start in range(0, 15, 3))
_COUNT = 15
_EXISTING = {2: [0, 1, 3, 4, 8, 9, 10, 14], 3: list(range(_COUNT))}
"""Unknowns of a pair that exist in a model in the plane, and in space."""


class DistributingBlock(Contributor):
    """All distributing couplings of a model.

    unknowns  those of a pair: the second node is the reference node; the coupling follows, which has the multipliers
    rows      (m,) number of the coupling of each pair
    """

    def __init__(self, model: Model) -> None:
        """Prepare the couplings of a model, which has at least one."""
        couplings = model.couplings
        counts = [len(coupling.nodes) for coupling in couplings]
        self.first, self.rows = 0, np.repeat(np.arange(len(couplings)), counts)
        self._references = np.array([coupling.reference for coupling in couplings])
        self._starts = np.cumsum([0, *counts[:-1]])
        nodes = np.concatenate([coupling.nodes for coupling in couplings])
        self._weights = np.concatenate([coupling.weights for coupling in couplings])[:, None]
        coordinates = model.mesh.coordinates
        self._p = coordinates[nodes] - coordinates[self._references[self.rows]]
        self._length = np.sqrt(self._sum(self._weights * self._p**2).sum(axis=1))
        self._mesh = model.mesh
        self._nodes = np.stack([nodes, self._references[self.rows]], axis=1)
        dofs = range(1, 4), range(4, 7), range(COUPLED, COUPLED + 3), range(COUPLED + 3, COUPLED + 6)
        every = [(node, dof) for node, own in zip((0, 1, 1, 2, 2), (dofs[0], *dofs), strict=True) for dof in own]
        self._dimension = couplings[0].dimension
        self._existing = np.array(_EXISTING[self._dimension])
        self.unknowns = tuple(every[k] for k in self._existing)
        self._scale = 0.0
        self._last = CouplingErrors((0.0, -1), (0.0, -1))

    @property
    def nodes(self) -> IntArray:
        """Nodes (m, 2) of the pairs: the coupled node and the reference node."""
        return self._nodes

    @property
    def names(self) -> list[str]:
        """Names (m,) of the reference nodes."""
        return [self._mesh.name(node) for node in self._nodes[:, 1].tolist()]

    def locate(self, indptr: NDArray[np.int32], indices: NDArray[np.int32]) -> None:
        """Locate the matrices of the pairs in a CSR pattern."""
        self._scatter = _binding.scatter_map(self._equations, indptr, indices)

    def contribute(self, now: CurrentPass) -> BlockReport:
        """Run one pass, and report the errors of the couplings."""
        if now.has_forces:
            self._add(now)
        return NOTHING._replace(coupling=self._last)

    def _add(self, now: CurrentPass) -> None:
        """Add the forces of the couplings and their derivatives."""
        call, data = now.call, now.data
        if data is not None and not self._scale:
            self._scale = scale_of_multipliers(data, self._scatter, self._dimension)
        end, change = (self._values(values) for values in (now.u, now.du))
        nlgeom, p = call.flags.nlgeom, self._p
        omega, omega_by = _increment(end[self._starts, _ROTATION], change[self._starts, _ROTATION], nlgeom=nlgeom)
        omega, omega_by = omega[self.rows], omega_by[self.rows]
        dp = change[:, _COUPLED] - change[:, _REFERENCE]
        p_m = p
        if nlgeom:
            p = p + end[:, _COUPLED] - end[:, _REFERENCE]
            p_m = p - 0.5 * dp
        q = dp - np.cross(omega, p_m)
        length = self._length[self.rows][:, None]
        weight = self._scale * self._weights
        force = weight * (end[:, _A] + np.cross(end[:, _B], p) / length)
        rows = np.concatenate(
            [force, -force, -np.cross(p, force), weight * q, weight * np.cross(p_m, q) / length], axis=1
        )
        np.add.at(now.columns[0], self._equations, rows[:, self._existing])
        if call.flags.request is Request.NORMAL:
            self._last = self._errors(p_m, q)
        if data is None:
            return
        weight, length = weight[:, None], length[:, None]
        p_cross, p_m_cross, b_cross = (cross_matrices(vectors) for vectors in (p, p_m, end[:, _B]))
        force_by = np.zeros((len(rows), 3, _COUNT))
        force_by[:, :, _A], force_by[:, :, _B] = weight * np.eye(3), -weight * p_cross / length
        q_by = np.zeros_like(force_by)
        q_by[:, :, _COUPLED] = np.eye(3)
        q_by[:, :, _ROTATION] = p_m_cross @ omega_by
        moment_by, moment_q_by = np.zeros_like(force_by), np.zeros_like(force_by)
        if nlgeom:
            # p follows the displacements
            force_by[:, :, _COUPLED] = weight * b_cross / length
            q_by[:, :, _COUPLED] -= 0.5 * cross_matrices(omega)
            moment_by[:, :, _COUPLED], moment_q_by[:, :, _COUPLED] = -cross_matrices(force), -0.5 * cross_matrices(q)
        for derivatives in (force_by, q_by, moment_by, moment_q_by):
            derivatives[:, :, _REFERENCE] = -derivatives[:, :, _COUPLED]
        moment_by += p_cross @ force_by
        moment_q_by = weight * (moment_q_by + p_m_cross @ q_by) / length
        matrix = -np.concatenate([force_by, -force_by, -moment_by, weight * q_by, moment_q_by], axis=1)
        np.add.at(data, self._scatter, matrix[:, self._existing[:, None], self._existing])

    def _values(self, values: FloatArray) -> FloatArray:
        """Return (m, 15) values of the unknowns of the pairs; zero for those that do not exist in the plane."""
        of_pairs = np.zeros((len(self.rows), _COUNT))
        of_pairs[:, self._existing] = values[self._equations]
        return of_pairs

    def _sum(self, values: FloatArray) -> FloatArray:
        """Return sums (couplings, ...) over the pairs of each coupling."""
        return np.asarray(np.add.reduceat(values, self._starts, axis=0))

    def _errors(self, p_m: FloatArray, q: FloatArray) -> CouplingErrors:
        """Return the largest violations of the constraints, each with its reference node."""
        weighted = self._weights * q
        r_m = p_m - self._sum(self._weights * p_m)[self.rows]
        square = np.einsum("mi,mj->mij", r_m, self._weights * r_m)
        inertia = self._sum(np.trace(square, axis1=1, axis2=2)[:, None, None] * np.eye(3) - square)
        axes = slice(2, 3) if self._dimension == 2 else slice(0, 3)
        moment = self._sum(np.cross(r_m, weighted))[:, axes, None]
        turned = np.linalg.solve(inertia[:, axes, axes], moment)[..., 0]
        errors = np.linalg.norm(self._sum(weighted), axis=1) / self._length, np.linalg.norm(turned, axis=1)
        worst = [int(first_largest(values)) for values in errors]
        displacement, rotation = (
            (float(values[k]), int(self._references[k])) for values, k in zip(errors, worst, strict=True)
        )
        return CouplingErrors(displacement, rotation)

    def commit(self) -> None:
        """Do nothing: the couplings have no history."""

    def kept(self) -> Saved:
        """Return the state to be saved: the scale of the multipliers."""
        return {"scale": self._scale}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""
        self._scale = saved["scale"]


def _increment(angles: FloatArray, change: FloatArray, *, nlgeom: bool) -> tuple[FloatArray, FloatArray]:
    """Return omega (k, 3) of an increment that ends at these rotation vectors (k, 3), and its derivatives by them."""
    if not nlgeom:
        return change, np.broadcast_to(np.eye(3), (len(angles), 3, 3))
    rotation = rotation_matrices(angles) @ rotation_matrices(angles - change).transpose(0, 2, 1)
    omega = (
        -2.0 * np.einsum("ijk,mjk->mi", PERMUTATION, rotation) / (1.0 + np.trace(rotation, axis1=1, axis2=2))[:, None]
    )
    by_spin = np.eye(3) - 0.5 * cross_matrices(omega) + 0.25 * omega[:, :, None] * omega[:, None, :]
    return np.asarray(omega, dtype=np.float64), np.asarray(by_spin @ spin_matrices(angles), dtype=np.float64)
