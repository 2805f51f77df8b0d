# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shape functions of the faces of main surfaces, as polynomials of natural coordinates."""

from __future__ import annotations

import numpy as np

from uel.model.arrays import FloatArray


def weights_of(shapes: FloatArray, natural: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Evaluate N (m, k) of coefficients (m, k, p), and their first (m, k, a) and second derivatives (m, k, a, a)."""
    values, first, second = monomials(natural, shapes.shape[2])
    return (
        np.einsum("mkp,mp->mk", shapes, values),
        np.einsum("mkp,mpa->mka", shapes, first),
        np.einsum("mkp,mpab->mkab", shapes, second),
    )


def monomials(natural: FloatArray, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Evaluate the first ones of 1, xi, xi^2 or 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2,
    and their derivatives.

    Parameters
    ----------
    natural
        (m, 1 or 2) natural coordinates.
    count
        p of them: 3 on a line, 4 or 8 on an area.

    Returns
    -------
    tuple[FloatArray, FloatArray, FloatArray]
        (m, p), with first (m, p, a) and second derivatives (m, p, a, a).
    """
    m, along = natural.shape
    first, second = np.zeros((m, count, along)), np.zeros((m, count, along, along))
    values = np.ones((m, count))
    values[:, 1 : along + 1] = natural
    if along == 1:
        values[:, 2] = natural[:, 0] ** 2
        first[:, 1, 0], first[:, 2, 0], second[:, 2, 0, 0] = 1.0, 2.0 * natural[:, 0], 2.0
        return values, first, second
    xi, eta = natural.T
    values[:, 3] = xi * eta
    first[:, 1, 0] = first[:, 2, 1] = 1.0
    first[:, 3] = natural[:, ::-1]
    second[:, 3, 0, 1] = second[:, 3, 1, 0] = 1.0
    if count > 4:
        values[:, 4:] = np.stack([xi**2, eta**2, xi**2 * eta, xi * eta**2], axis=1)
        first[:, 4, 0], first[:, 5, 1] = 2.0 * xi, 2.0 * eta
        first[:, 6], first[:, 7] = np.stack([2.0 * xi * eta, xi**2], axis=1), np.stack([eta**2, 2.0 * xi * eta], axis=1)
        second[:, 4, 0, 0] = second[:, 5, 1, 1] = 2.0
        second[:, 6, 0, 0], second[:, 7, 1, 1] = 2.0 * eta, 2.0 * xi
        second[:, 6, 0, 1] = second[:, 6, 1, 0] = 2.0 * xi
        second[:, 7, 0, 1] = second[:, 7, 1, 0] = 2.0 * eta
    return values, first, second
