# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Eigenvalues of smallest magnitude of K x = lambda G x, both symmetric, K positive definite and G any.

Unknowns with zero rows in G, such as the pressures of hybrid elements, may make K indefinite.
"""

from __future__ import annotations

import numpy as np
from scipy import linalg
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray
from uel.solver.eigen import DENSE, RANK, Pair, UnstableError
from uel.solver.newton import Factoriser

NEGATIVE = 1e-6
"""Negative flexibility over the largest one that counts as rounding."""

RESIDUAL = 1e-6
"""Largest residual of an eigenpair over |K x|."""


def smallest_factors(pair: Pair, count: int, solver: Factoriser) -> tuple[FloatArray, FloatArray]:
    """Return the eigenvalues (k,) of either sign in ascending order of magnitude, and vectors (n, k).

    Parameters
    ----------
    pair
        K as its stiffness, G as its mass.
    count
        Largest k; there may be fewer.
    solver
        Solver that has factorised K.

    Returns
    -------
    tuple[FloatArray, FloatArray]
        Empty if G is zero.

    Raises
    ------
    UnstableError
        K is not positive definite on the unknowns of G.
    """
    if len(pair) <= DENSE:
        return _dense(pair, count)
    stiffness, stress = pair.matrix(pair.stiffness), pair.matrix(pair.mass)
    flexibility = LinearOperator(stiffness.shape, matvec=solver.solve, dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(len(pair))
    try:
        inverse, vectors = eigsh(stress, min(count, len(pair) - 1), stiffness, which="LM", Minv=flexibility, v0=start)
    except (ArpackError, SingularMatrixError):
        raise UnstableError from None
    order = np.argsort(-np.abs(inverse), kind="stable")
    order = order[np.abs(inverse[order]) > RANK * np.abs(inverse).max()]
    values, vectors = 1.0 / inverse[order], vectors[:, order]
    # for an indefinite K the iteration ends with meaningless vectors
    elastic = stiffness @ vectors
    r = np.linalg.norm(elastic - values * (stress @ vectors), axis=0)
    if np.any(r > RESIDUAL * np.linalg.norm(elastic, axis=0)) or np.any(np.sum(vectors * elastic, axis=0) <= 0.0):
        raise UnstableError
    return values, vectors


def _dense(pair: Pair, count: int) -> tuple[FloatArray, FloatArray]:
    stress = pair.matrix(pair.mass).toarray()
    stressed = np.flatnonzero(np.any(stress != 0.0, axis=0))
    stress = stress[np.ix_(stressed, stressed)]
    units = np.zeros((len(pair), len(stressed)))
    units[stressed, np.arange(len(stressed))] = 1.0
    flexibility = np.linalg.solve(pair.matrix(pair.stiffness).toarray(), units)
    # with the flexibility L L^T of the stressed unknowns, L^T G L z = z/lambda and x = L z there
    own, axes = linalg.eigh(flexibility[stressed])
    if own[0] < -NEGATIVE * own[-1]:
        raise UnstableError
    factor = axes[:, own > RANK * own[-1]] * np.sqrt(own[own > RANK * own[-1]])
    inverse, vectors = linalg.eigh(factor.T @ stress @ factor)
    order = np.argsort(-np.abs(inverse), kind="stable")[:count]
    order = order[np.abs(inverse[order]) > RANK * np.abs(inverse).max()]
    return 1.0 / inverse[order], flexibility @ (stress @ (factor @ vectors[:, order])) / inverse[order]
