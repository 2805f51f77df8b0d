# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finite rotations as rotation vectors (dofs 4 to 6)."""

from __future__ import annotations

from typing import Final, TypeVar

import numpy as np

from uel.model.arrays import ComplexArray, FloatArray

Vectors = TypeVar("Vectors", FloatArray, ComplexArray)

SMALL: Final = 1e-3
"""Square of an angle below which series are used."""

PERMUTATION: Final = np.zeros((3, 3, 3))
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    PERMUTATION[_i, _j, _k], PERMUTATION[_i, _k, _j] = 1.0, -1.0
"""(a x b)_i = sum over j and k of PERMUTATION[i, j, k] a_j b_k."""


def _factors(angles: Vectors) -> tuple[Vectors, ...]:
    """Return sin t/t, (1 - cos t)/t^2 and (t - sin t)/t^3 of angles (m, 3), each (m, 1, 1)."""
    square = np.sum(angles * angles, axis=1)[:, None, None]
    small = np.abs(square) < SMALL
    t = np.sqrt(np.where(small, 1.0, square))
    series = [1 - square / 6 * (1 - square / 20 * (1 - square / 42))]
    series.append(0.5 - square / 24 * (1 - square / 30 * (1 - square / 56)))
    series.append(1 / 6 - square / 120 * (1 - square / 42 * (1 - square / 72)))
    closed = np.sin(t) / t, (1 - np.cos(t)) / t**2, (t - np.sin(t)) / t**3
    return tuple(np.where(small, one, other) for one, other in zip(series, closed, strict=True))


def cross_matrices(vectors: Vectors) -> Vectors:
    """Return (m, 3, 3) matrices of the cross product with vectors (m, 3)."""
    matrices: Vectors = np.einsum("iaj,ma->mij", PERMUTATION, vectors)
    return matrices


def rotation_matrices(angles: Vectors) -> Vectors:
    """Return rotation matrices R (m, 3, 3) of rotation vectors (m, 3)."""
    first, second, _ = _factors(angles)
    skew = cross_matrices(angles)
    rotations: Vectors = np.eye(3) + first * skew + second * (skew @ skew)
    return rotations


def spin_matrices(angles: Vectors) -> Vectors:
    """Return H (m, 3, 3) of rotation vectors (m, 3): H dtheta is the spin of the change dtheta."""
    _, second, third = _factors(angles)
    skew = cross_matrices(angles)
    matrices: Vectors = np.eye(3) + second * skew + third * (skew @ skew)
    return matrices
