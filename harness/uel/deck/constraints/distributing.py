# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DISTRIBUTING: the reference node moves as the coupled nodes do on average.

With the weights w of the nodes, whose sum is 1, their centre x_c = sum w x, the places r = x - x_c and the inertia
T = sum w (r.r I - r r^T), the rotation and the displacement of the reference node at x_R are

    theta = T^-1 sum w r x u,    u_R = sum w u + theta x (x_R - x_c).

(Abaqus Theory Guide, Distributing coupling constraints.) Rotations are small.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uel.model.arrays import FloatArray

METHODS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "UNIFORM": np.ones_like,
    "LINEAR": lambda ratio: 1.0 - ratio,
    "QUADRATIC": lambda ratio: 1.0 - ratio**2,
    "CUBIC": lambda ratio: 1.0 - 3.0 * ratio**2 + 2.0 * ratio**3,
}
"""WEIGHTING METHOD: factor of the weights by the distance from the reference node over the largest one."""

NO_INERTIA = 1e-12
"""Principal inertia below which there is none, over the square of the largest coordinate, whose rounding it is."""


@dataclass(frozen=True, slots=True)
class AverageMotion:
    """Motion of the reference node as sums over the displacements of n coupled nodes.

    displacement, rotation  coefficients (3, n, 3) of u_R and theta
    axes                    directions about which the nodes have inertia: 3; on a line 2; in one place 0
    """

    displacement: FloatArray
    rotation: FloatArray
    axes: int


def average_motion(places: FloatArray, weights: FloatArray, reference: FloatArray) -> AverageMotion:
    """Compute the average motion of nodes; along a direction without inertia theta is zero.

    Parameters
    ----------
    places
        (n, 3) coordinates of the coupled nodes; all third ones are equal in the plane.
    weights
        (n,) not negative, with a positive sum.
    reference
        (3,) coordinates of the reference node.
    """
    shares = weights / weights.sum()
    centre = shares @ places
    arms = places - centre
    inertia = np.einsum("n,nk,nk->", shares, arms, arms) * np.eye(3) - np.einsum("n,ni,nj->ij", shares, arms, arms)
    principal, directions = np.linalg.eigh(inertia)
    kept = principal > NO_INERTIA * np.max(places**2, initial=principal[-1])
    inverse = (directions[:, kept] / principal[kept]) @ directions[:, kept].T
    # theta_i = sum over n and j of inverse_ik w_n (r_n x e_j)_k u_nj
    turned = np.cross(arms[:, None, :], np.eye(3)[None, :, :])
    rotation = np.einsum("ik,n,njk->inj", inverse, shares, turned)
    displacement = np.einsum("n,ij->inj", shares, np.eye(3))
    displacement -= np.einsum("ik,knj->inj", _cross_matrix(reference - centre), rotation)
    return AverageMotion(displacement, rotation, int(np.count_nonzero(kept)))


def _cross_matrix(vector: FloatArray) -> FloatArray:
    """Return the matrix (3, 3) of the cross product v x."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
