# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lowest eigenvalues of K x = lambda M x, both symmetric, M positive semidefinite: some unknowns may have no mass."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, sparse
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray
from uel.solver.newton import Factoriser

DENSE = 200
"""Unknowns up to which all eigenvalues are computed by dense matrices."""

SHIFT = 1e-6
"""First shift, as a fraction of the mean of K over that of M."""

RANK = 1e-12
"""Inverse eigenvalue over the largest one below which it belongs to unknowns without mass."""


class UnstableError(Exception):
    """K is far from positive semidefinite, or singular on unknowns without mass; there are no eigenvalues."""


@dataclass(frozen=True, slots=True)
class Pair:
    """K and M by their values (nnz,) on one symmetric CSR pattern."""

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    stiffness: FloatArray
    mass: FloatArray

    def __len__(self) -> int:
        return len(self.indptr) - 1

    def matrix(self, data: FloatArray) -> sparse.csr_array:
        """Build the matrix (n, n) of values on the pattern."""
        return sparse.csr_array((data, self.indices, self.indptr), shape=(len(self), len(self)))


def lowest_eigenvalues(pair: Pair, count: int, solver: Factoriser) -> tuple[FloatArray, FloatArray]:
    """Return the eigenvalues (k,) ascending and vectors (n, k); k is `count`, or less if there are fewer.

    The vectors have x^T M x = 1. `solver` is for matrices of the pattern. Raises UnstableError.
    """
    for shift in _shifts(pair):
        shifted = pair.stiffness - shift * pair.mass
        try:
            if len(pair) <= DENSE:
                return _dense(pair.matrix(shifted).toarray(), pair.matrix(pair.mass).toarray(), shift, count)
            solver.factorise(shifted)
            return _sparse(pair, shift, min(count, len(pair) - 2), solver)
        except (SingularMatrixError, linalg.LinAlgError, ArpackError):
            continue
    raise UnstableError


def _shifts(pair: Pair) -> Iterator[float]:
    """Yield negative shifts of growing magnitude: K is singular if a body is free, or indefinite if it is unstable."""
    stiffness, mass = (pair.matrix(data).diagonal() for data in (pair.stiffness, pair.mass))
    for power in range(4):
        yield -SHIFT * 100**power * float(np.abs(stiffness[mass > 0]).sum() / mass.sum())


def _dense(shifted: FloatArray, mass: FloatArray, shift: float, count: int) -> tuple[FloatArray, FloatArray]:
    own, axes = linalg.eigh(mass)
    # M = G G^T; unknowns without mass, such as the pressures of hybrid elements, may make K indefinite
    factor = axes[:, own > RANK * own[-1]] * np.sqrt(own[own > RANK * own[-1]])
    moved = np.linalg.solve(shifted, factor)
    inverse, vectors = linalg.eigh(factor.T @ moved)
    if inverse[0] < -RANK * inverse[-1]:
        raise linalg.LinAlgError("an eigenvalue is below the shift")
    chosen = np.flatnonzero(inverse > RANK * inverse[-1])[::-1][:count]
    # z^T z = 1 of G^T (K - shift M)^-1 G z = z/(lambda - shift), and x = (K - shift M)^-1 G z (lambda - shift)
    return shift + 1.0 / inverse[chosen], moved @ vectors[:, chosen] / inverse[chosen]


def _sparse(pair: Pair, shift: float, count: int, solver: Factoriser) -> tuple[FloatArray, FloatArray]:
    stiffness, mass = pair.matrix(pair.stiffness), pair.matrix(pair.mass)
    operator = LinearOperator(stiffness.shape, matvec=solver.solve, dtype=np.float64)
    # the same start vector in every run
    start = np.random.default_rng(0).standard_normal(len(pair))
    values, vectors = eigsh(stiffness, count, mass, sigma=shift, OPinv=operator, v0=start)
    order = np.argsort(values)
    return values[order], vectors[:, order]
