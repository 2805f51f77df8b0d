# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""fortran/core: the scalar solver, small matrices, shape functions, against numpy and against their definition."""

import ctypes
import itertools

import numpy as np
import pytest

SOURCES = ("kinds", "root", "small_matrix", "shape_functions", "serendipity", "symmetric")
RNG = np.random.default_rng(11)


@pytest.fixture(scope="module")
def core(compiled):
    """Call a procedure of `core_procedures`: numbers by value, arrays by address."""
    loaded = compiled("core_procedures", [f"core/{name}" for name in SOURCES])

    def converted(value):
        if isinstance(value, float):
            return ctypes.c_double(value)
        return value if isinstance(value, int) else value.ctypes.data_as(ctypes.c_void_p)

    def call(name, *arguments):
        getattr(loaded, f"c_{name}")(*map(converted, arguments))

    return call


def cube_root(core, target):
    """Root, whether it was found, and the steps."""
    x, found, steps = np.zeros(1), np.zeros(1, np.int32), np.zeros(1, np.int32)
    core("cube_root", target, x, found, steps)
    return x[0], bool(found[0]), int(steps[0])


@pytest.mark.parametrize("target", [1.0, 8.0, 999.0, 1e-9])
def test_a_root_is_found_in_few_steps(core, target):
    x, found, steps = cube_root(core, target)
    assert found
    assert x == pytest.approx(np.cbrt(target), rel=1e-15)
    assert steps < 25


@pytest.mark.nan
def test_a_function_that_is_nan_has_no_root(core):
    _, found, steps = cube_root(core, np.nan)
    assert not found
    assert steps == 1


@pytest.mark.parametrize("n", [1, 5, 8, 12, 16, 24, 37, 48, 60])
@pytest.mark.parametrize("terms", [0, 1, 2, 3, 4, 6, 9, 12])
def test_products_are_added_to_a_matrix(core, n, terms):
    m = 7
    a, b, matrix = (np.asfortranarray(RNG.normal(size=size)) for size in ((n, terms), (m, terms), (n, m)))
    expected = matrix + a @ b.T
    core("add_product", n, m, terms, a, b, matrix)
    np.testing.assert_allclose(matrix, expected, rtol=0, atol=1e-14 * (1 + terms))


def test_columns_are_added_to_a_vector(core):
    a, x, vector = np.asfortranarray(RNG.normal(size=(5, 3))), RNG.normal(size=3), RNG.normal(size=5)
    expected = vector + a @ x
    core("add_combination", 5, 3, a, x, vector)
    np.testing.assert_allclose(vector, expected, rtol=0, atol=1e-14)


def test_determinant(core):
    a, value = np.asfortranarray(RNG.normal(size=(3, 3))), np.zeros(1)
    core("determinant", a, value)
    assert value[0] == pytest.approx(np.linalg.det(a), rel=1e-13)


@pytest.mark.parametrize("n", [2, 3])
def test_inverse(core, n):
    a, inverse, value = np.asfortranarray(RNG.normal(size=(n, n))), np.zeros((n, n), order="F"), np.zeros(1)
    core("invert", n, a, inverse, value)
    np.testing.assert_allclose(inverse, np.linalg.inv(a), rtol=1e-12)
    assert value[0] == pytest.approx(np.linalg.det(a), rel=1e-13)


@pytest.mark.parametrize("n", [2, 3])
def test_inverse_of_a_singular_matrix(core, n):
    inverse, value = np.ones((n, n), order="F"), np.ones(1)
    core("invert", n, np.ones((n, n), order="F"), inverse, value)
    assert not inverse.any()
    assert value[0] == 0


def spread(n, least):
    """A symmetric matrix with eigenvalues from `least` to 1."""
    q = np.linalg.qr(RNG.normal(size=(n, n)))[0]
    return np.asfortranarray(q @ np.diag(np.linspace(least, 1, n)) @ q.T)


@pytest.mark.parametrize("n", [1, 2, 3, 6])
@pytest.mark.parametrize("least", [-1.0, 0.0, 1.0])
def test_eigenvalues(core, n, least):
    a = spread(n, least)
    values, vectors, good = np.zeros(n), np.zeros((n, n), order="F"), np.zeros(1, np.int32)
    core("eigenvalues", n, a, values, vectors, good)
    assert good[0]
    np.testing.assert_allclose(np.sort(values), np.linalg.eigvalsh(a), atol=1e-14)
    np.testing.assert_allclose(vectors @ a @ vectors.T, np.diag(values), atol=1e-14)


@pytest.mark.parametrize("bad", [pytest.param(np.nan, marks=pytest.mark.nan), np.inf])
def test_a_matrix_that_is_not_finite_has_no_eigenvalues(core, bad):
    a = np.asfortranarray(np.diag([1.0, bad, 2.0]))
    good = np.ones(1, np.int32)
    core("eigenvalues", 3, a, np.zeros(3), np.zeros((3, 3), order="F"), good)
    assert not good[0]


@pytest.mark.parametrize("n", [1, 3, 6])
def test_inverse_and_factor_of_a_definite_matrix(core, n):
    a = spread(n, 0.01)
    inverse, factor, good = np.zeros((n, n), order="F"), a.copy(order="F"), np.zeros(1, np.int32)
    core("invert_definite", n, a, inverse, good)
    assert good[0]
    np.testing.assert_allclose(inverse @ a, np.eye(n), atol=1e-12)
    core("lower_factor", n, factor, good)
    assert good[0]
    np.testing.assert_allclose(factor, np.linalg.cholesky(a), atol=1e-14)


@pytest.mark.parametrize("diagonal", [(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0), (1.0, -1.0, 1.0)])
def test_a_matrix_with_a_zero_or_less_on_its_diagonal_is_refused(core, diagonal):
    a = np.asfortranarray(np.diag(diagonal))
    inverse, good = np.ones((3, 3), order="F"), np.ones(1, np.int32)
    core("invert_definite", 3, a, inverse, good)
    assert not good[0]
    assert not inverse.any()
    good[:] = 1
    core("lower_factor", 3, a, good)
    assert not good[0]


def places(dim, middles):
    """Corners, and middles of the edges, of the cube from -1 to 1."""
    grid = itertools.product((-1, 0, 1), repeat=dim)
    return np.asfortranarray(np.array([p for p in grid if p.count(0) <= middles], dtype=np.int32).T)


@pytest.mark.parametrize("dim, middles", [(1, 0), (1, 1), (2, 0), (2, 1), (3, 0), (3, 1)])
def test_serendipity_functions(core, dim, middles):
    """One at their node and zero at the others; derivatives by differences, which are exact up to the second degree."""
    nodes = places(dim, middles)
    count = nodes.shape[1]

    def functions(point):
        n, dn = np.zeros(count), np.zeros((count, dim), order="F")
        core("serendipity", dim, count, nodes, np.array(point, dtype=float), n, dn)
        return n, dn

    np.testing.assert_allclose([functions(node)[0] for node in nodes.T], np.eye(count), atol=1e-15)
    point, step = RNG.uniform(-1, 1, dim), 0.5
    for i, along in enumerate(step * np.eye(dim)):
        first = (functions(point + along)[0] - functions(point - along)[0]) / (2 * step)
        np.testing.assert_allclose(functions(point)[1][:, i], first, atol=1e-14)
