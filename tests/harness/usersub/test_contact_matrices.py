# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Matrices of contact points in a sparse matrix, against dense sums."""

import numpy as np
from scipy import sparse

from uel.usersub._contact import SparseValues, add_products


def test_products_of_factors():
    """Unknowns of a node are neighbours, in rows of unlike columns; a point may repeat a node, with zero factors."""
    rng = np.random.default_rng(1)
    size, points = 60, 7
    nodes = np.stack([rng.permutation(size // 3)[:5] for _ in range(points)])
    nodes[2, 4] = nodes[2, 0]
    rows = (3 * nodes[..., None] + np.arange(3)).reshape(points, 15).astype(np.int32)
    columns = np.concatenate([rows[:, :6], rng.integers(0, 3, (points, 1)) + 57], axis=1).astype(np.int32)
    left, right = rng.normal(size=(points, 2, 15)), rng.normal(size=(points, 2, 7))
    left[2, :, 12:] = 0.0
    left[:, 1, 4] = 0.0
    wanted, used = np.zeros((size, size)), np.eye(size, dtype=bool)
    for k in range(points):
        np.add.at(wanted, np.ix_(rows[k], columns[k]), left[k].T @ right[k])
        used[np.ix_(rows[k], columns[k])] = True
    pattern = sparse.csr_array(used | (rng.uniform(size=used.shape) < 0.3))
    pattern.sort_indices()
    start = rng.normal(size=pattern.nnz)
    matrix = SparseValues(pattern.indptr.astype(np.int32), pattern.indices.astype(np.int32), start.copy())
    add_products(left, rows, right, columns, matrix)
    added = sparse.csr_array((matrix.values - start, pattern.indices, pattern.indptr), pattern.shape)
    np.testing.assert_allclose(added.toarray(), wanted, atol=1e-13)


def test_no_points():
    """Nothing is added, and nothing is read."""
    none = np.zeros((0, 3), dtype=np.int32)
    matrix = SparseValues(np.array([0, 1], dtype=np.int32), np.zeros(1, dtype=np.int32), np.ones(1))
    add_products(np.zeros((0, 1, 3)), none, np.zeros((0, 1, 3)), none, matrix)
    assert matrix.values[0] == 1.0
