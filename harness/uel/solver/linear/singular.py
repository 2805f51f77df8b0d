# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Test of a matrix for singularity, and the unknown that is free.

A small pivot alone is no proof: the tip of a slender beam on an interface stiffness of 1e12 has a pivot of 1e-13 of the
largest diagonal entry in a regular matrix, while that of an unconstrained body can be 1e-10 by accumulated rounding. So
inverse iteration finds the vector v that a suspicious matrix stretches least: the matrix is singular if v^T A v is at
most the rounding error of its own terms. Measured on 12,000 unknowns of a double cantilever beam, v^T A v is 0.0003 to
0.3 times that error if a body is free (interface stiffness 1e6 to 1e12), and 1e7 (1e6) to 25 (1e12) times if the beam
is clamped.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray

EPS = float(np.finfo(np.float64).eps)

UNCONSTRAINED: Final = "the model or a part of it is unconstrained; check *BOUNDARY and elements without stiffness"


def refuse_singular(
    matrix: sparse.csr_array, name_of: Callable[[int], tuple[str, int]], *, certain: bool = False
) -> None:
    """Raise SingularMatrixError, with the free unknown, if the matrix is singular; `certain` as in `free_unknown`."""
    unknown = free_unknown(matrix, certain=certain)
    if unknown is not None:
        node, dof = name_of(unknown)
        raise SingularMatrixError(node, dof, UNCONSTRAINED)


def free_unknown(matrix: sparse.csr_array, *, certain: bool = False) -> int | None:
    """Return the unknown that moves most in the null vector of the matrix, None if the matrix is regular.

    With `certain`, after a zero pivot, the matrix counts as singular in any case.
    """
    largest = abs(matrix).max(axis=1).toarray().ravel()
    empty = np.flatnonzero(largest == 0.0)
    if len(empty):
        return int(empty[0])
    factors = _shifted_factors(matrix, largest)
    vector = np.where(np.random.default_rng(0).random(matrix.shape[0]) < 0.5, -1.0, 1.0)
    for _ in range(3):
        vector = factors.solve(vector)
        vector /= np.abs(vector).max()
    if not certain and not _is_null(matrix, vector):
        return None
    # the first of those that move equally, so that rounding does not choose the node of the message
    return int(np.flatnonzero(np.abs(vector) > 0.99)[0])


def _shifted_factors(matrix: sparse.csr_array, largest: FloatArray) -> SuperLU:
    """Factorise A + a diagonal of rounding size, grown until no pivot is exactly zero.

    COLAMD bounds the fill for any choice of pivots, an ordering by A + A^T only for pivots on the diagonal, which
    Lagrange multipliers and unsymmetric elements do not have: with it, 5,324 unknowns of bricks with a multiplier at
    each node take 10 times as long. For pivots on the diagonal COLAMD takes up to three times as long.
    """
    shift = EPS / 16
    while True:
        shifted = (matrix + sparse.diags_array(shift * largest)).tocsc()
        try:
            return splu(shifted, permc_spec="COLAMD")
        except RuntimeError:
            shift *= 16


def _is_null(matrix: sparse.csr_array, vector: FloatArray) -> bool:
    image = matrix @ vector
    rounding = EPS * float(np.abs(vector) @ (abs(matrix) @ np.abs(vector)))
    # the second condition excludes a vector that an unsymmetric A turns by a right angle
    return abs(float(vector @ image)) <= rounding and float(np.abs(vector) @ np.abs(image)) <= 32 * rounding
