# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Complex systems, against dense ones of numpy."""

import numpy as np
import pytest
from scipy import sparse

from uel.errors import SingularMatrixError
from uel.solver.harmonic import ComplexSolver
from uel.solver.linear import available

SOLVERS = [row.name for row in available() if row.installed]


def chain(n, rng):
    """A complex matrix with three diagonals, not symmetric, and its pattern."""
    bands = [rng.standard_normal(n) + 1j * rng.standard_normal(n) for _ in range(3)]
    matrix = sparse.diags_array([bands[0][:-1], 4 + bands[1], bands[2][:-1]], offsets=[-1, 0, 1]).tocsr()
    matrix.sort_indices()
    return matrix


@pytest.mark.parametrize("name", SOLVERS)
def test_against_numpy(name):
    rng = np.random.default_rng(3)
    first, second = chain(30, rng), chain(30, rng)
    pattern = first.indptr.astype(np.int32), first.indices.astype(np.int32)
    solver = ComplexSolver(name, *pattern, coordinates=np.zeros((30, 3)), name_of=lambda k: (str(k), 1))
    for matrix in (first, second):
        rhs = rng.standard_normal(30) + 1j * rng.standard_normal(30)
        np.testing.assert_allclose(solver.solve(matrix.data, rhs), np.linalg.solve(matrix.toarray(), rhs), rtol=1e-10)


def test_a_singular_matrix_names_the_unknown():
    matrix = sparse.csr_array(np.diag([1 + 1j, 0, 2]))
    pattern = np.arange(4, dtype=np.int32), np.arange(3, dtype=np.int32)
    solver = ComplexSolver("band", *pattern, coordinates=np.zeros((3, 3)), name_of=lambda k: (str(k + 1), 4))
    with pytest.raises(SingularMatrixError, match="node 2, dof 4"):
        solver.solve(matrix.diagonal(), np.ones(3, dtype=complex))
