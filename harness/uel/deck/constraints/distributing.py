# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DISTRIBUTING: the reference node follows the average motion of the coupled nodes.

With the weights w of the nodes, whose sum is 1, their centre x_c = sum w x, the arms r = x - x_c and the inertia
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
"""WEIGHTING METHOD: factor of the weights as a function of the distance ratio to the reference node."""

NO_INERTIA = 1e-12
"""Largest principal inertia that is rounding, over the square of the largest coordinate."""


@dataclass(frozen=True, slots=True)
class AverageMotion:
    """Motion of the reference node as sums over the displacements of n coupled nodes.

    displacement, rotation  coefficients (3, n, 3) of u_R and theta
    axes                    number of axes with inertia: 3; 2 for nodes on a line; 0 for coincident nodes
    """

    displacement: FloatArray
    rotation: FloatArray
    axes: int


def average_motion(points: FloatArray, weights: FloatArray, reference: FloatArray) -> AverageMotion:
    """Compute the average motion of nodes; along a direction without inertia theta is zero.

    Parameters
    ----------
    points
        (n, 3) coordinates of the coupled nodes; in the plane all z are equal.
    weights
        (n,) not negative, with a positive sum.
    reference
        (3,) coordinates of the reference node.
    """
    weight = weights / weights.sum()
    centre = weight @ points
    arms = points - centre
    inertia = np.einsum("n,nk,nk->", weight, arms, arms) * np.eye(3) - np.einsum("n,ni,nj->ij", weight, arms, arms)
    principal, directions = np.linalg.eigh(inertia)
    inertial = principal > NO_INERTIA * np.max(points**2, initial=principal[-1])
    inverse = (directions[:, inertial] / principal[inertial]) @ directions[:, inertial].T
    # theta_i = sum over n and j of inverse_ik w_n (r_n x e_j)_k u_nj
    moments = np.cross(arms[:, None, :], np.eye(3)[None, :, :])
    rotation = np.einsum("ik,n,njk->inj", inverse, weight, moments)
    displacement = np.einsum("n,ij->inj", weight, np.eye(3))
    # column j of the matrix of a cross product is a x e_j
    displacement -= np.einsum("ki,knj->inj", np.cross(reference - centre, np.eye(3)), rotation)
    return AverageMotion(displacement, rotation, int(np.count_nonzero(inertial)))
