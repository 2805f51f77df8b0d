# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tangents by central differences."""

import numpy as np


def differences(block, call, u, du, used, step=1e-3):
    """Of the forces of a block: as it should return K, for the unknowns at these positions."""
    n, found = len(u), np.zeros((len(used), len(used)))
    for k, unknown in enumerate(used):
        for sign in (1, -1):
            moved, residual = np.zeros(n), np.zeros(n)
            moved[unknown] = sign * step
            block.evaluate(call, u + moved, du + moved, residual, None)
            found[:, k] -= sign * residual[used] / (2 * step)
    return found


def check_uniform_tangent(solid, *, about):
    """Along x -> A x the differences of the forces are the tangent's and what it leaves out, forces times tr A.

    The stress is uniform; about an axis for A without A12, whose strain is not, and with A11 around the axis.
    """
    forces, _ = solid.evaluate(solid.u)
    tangent = solid.matrix.toarray()
    now, step = solid.nodes[:, : solid.dimension] + solid.u.reshape(-1, solid.dimension), 1e-6
    for a in np.eye(solid.dimension**2).reshape(-1, solid.dimension, solid.dimension):
        if about and a[0, 1]:
            continue
        trace = np.trace(a) + about * a[0, 0]
        d = (now @ a.T).ravel()
        slope = (solid.evaluate(solid.u - step * d)[0] - solid.evaluate(solid.u + step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, tangent @ d - forces * trace, atol=1e-6 * abs(tangent).max())
