# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What Abaqus may ask of an element: every LFLAGS(3), calls without time, several right-hand sides."""

import ctypes

import numpy as np
import pytest

from uel.usersub.layout import element_layouts

QUAD = [[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]]


BRICK = [[0, 0, 0], [1, 0, 0.1], [1.1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 0.8, 1], [0, 1, 0.9]]


@pytest.fixture(params=[1, 2, 4, 9], ids=lambda jtype: f"U{jtype}")
def case(request, element, interface):
    """An element with a history, and displacements."""
    jtype = request.param
    coordinates = {1: QUAD, 2: interface.four, 4: interface.eight, 9: BRICK}[jtype]
    item = element(jtype, coordinates, **({"FORMULATION": 1} if jtype == 9 else {}))
    if jtype == 9:
        u = 1e-3 * np.random.default_rng(0).normal(size=(8, 3))
    else:
        u = interface.displacements(len(coordinates), *interface.states["softening"], seed=0)
    item.advance(0.8 * u)
    return item, u


def test_requests(case):
    item, u = case
    rhs, tangent = item.evaluate(u, request=1)
    for request, residual, matrix in (
        (2, 0 * rhs, tangent),
        (3, 0 * rhs, 0 * tangent),
        (4, 0 * rhs, 0 * tangent),
        (5, rhs, 0 * tangent),
        (6, rhs, 0 * tangent),
        (100, rhs, tangent),
    ):
        found = item.evaluate(u, request=request)
        np.testing.assert_array_equal(found[1], matrix, err_msg=f"LFLAGS(3) = {request}")
        np.testing.assert_array_equal(found[0], residual, err_msg=f"LFLAGS(3) = {request}")


def test_linear_steps(case):
    """RHS is what a perturbation changes; the state stays that of the base."""
    item, u = case
    before = item.block.state(0)
    tangent = item.evaluate(u)[1]
    change = np.linspace(-1e-3, 1e-3, u.size)
    for request, residual in ((1, 0 * change), (100, -tangent @ change)):
        found = item.evaluate(u, du=change, request=request, flags=(1, 0, 1, 0))
        np.testing.assert_array_equal(found[1], tangent)
        np.testing.assert_allclose(found[0], residual, rtol=1e-12, atol=1e-12 * np.abs(residual).max())
    item.block.commit()
    np.testing.assert_array_equal(item.block.state(0).svars, before.svars)


def test_no_inertia_whatever_the_procedure(case):
    item, u = case
    expected = item.evaluate(u)
    for procedure in (1, 2, 11, 12, 21, 41, 61, 71, 91):
        found = item.evaluate(u, flags=(procedure, 0, 0, 1))
        for one, other in zip(found, expected, strict=True):
            np.testing.assert_array_equal(one, other, err_msg=f"LFLAGS(1) = {procedure}")


def test_calls_without_time(case):
    """KINC = 0 and DTIME = 0."""
    item, u = case
    expected = item.evaluate(u)
    found = item.evaluate(u, dtime=0.0, increment=0)
    np.testing.assert_array_equal(found[0], expected[0])
    np.testing.assert_array_equal(found[1], expected[1])


def test_state_starts_from_the_increment_in_every_iteration(case):
    item, u = case
    first = item.evaluate(u)
    item.evaluate(3 * u)
    second = item.evaluate(u)
    np.testing.assert_array_equal(first[0], second[0])
    item.block.commit()
    once = item.state
    item.evaluate(0.5 * u, request=5)
    item.evaluate(0.5 * u, request=2)
    for name, values in item.state.items():
        np.testing.assert_array_equal(values, once[name])


def test_increment_of_strain_comes_from_the_state(element):
    """The quad's stress depends on U, whatever DU says: a cutback repeats with the same U and another DU."""
    item = element(1, QUAD)
    u = 1e-3 * np.random.default_rng(0).normal(size=8)
    item.advance(u)
    np.testing.assert_allclose(item.evaluate(2 * u, du=0 * u)[0], item.evaluate(2 * u, du=u)[0], rtol=1e-15)


class Arguments:
    """A raw UEL call of U2 with more room than needed, poisoned, to see what is written where."""

    def __init__(self, library, interface, *, columns, request):
        self.rhs = np.full((columns, 11), np.nan)
        self.amatrx = np.full((8, 8), np.nan)
        needed = element_layouts()[2].svars
        self.svars, self.energy = np.zeros(needed + 2), np.full(8, 7.0)
        u = interface.displacements(4, *interface.states["softening"], seed=0).ravel()
        props = np.array([2.0, 2e4, 3e4, 30.0, 60.0, 0.26, 1.002, *np.zeros(len(element_layouts()[2].reals) - 7)])
        jprops = np.array([1, *np.zeros(len(element_layouts()[2].integers) - 1)], dtype=np.int32)
        zeros, pnewdt = np.zeros(64), np.array([1e36])
        arguments = [
            *(
                self.rhs,
                self.amatrx,
                self.svars,
                self.energy,
                8,
                columns,
                needed + 2,
                props,
                len(props),
                interface.four.copy(),
                2,
                4,
            ),
            *(u, zeros, zeros, zeros, 2, zeros, np.array([1.0]), 1, 1, 77, zeros, 0, 0, zeros, zeros, 0),
            *(np.array([1, 0, request, 0, 0], dtype=np.int32), 11, zeros, 1, pnewdt),
            *(jprops, len(jprops), np.array([1.0])),
        ]
        self.kept = [np.array([x], dtype=np.int32) if isinstance(x, int) else x for x in arguments]
        assert len(self.kept) == 36
        routine = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 36)(library.uel)
        routine(*[x.ctypes.data for x in self.kept])


def test_every_entry_is_filled_and_nothing_else(library, interface):
    """Riks: NRHS = 2, its second column is zero; MLVARX above NDOFEL, SVARS above what is needed stay untouched."""
    one, two = (Arguments(library, interface, columns=n, request=1) for n in (1, 2))
    np.testing.assert_array_equal(two.rhs[0, :8], one.rhs[0, :8])
    np.testing.assert_array_equal(two.rhs[1, :8], 0)
    assert np.isnan(two.rhs[:, 8:]).all()
    assert np.isfinite(two.amatrx).all()
    assert (two.svars[:-2] != 0).any()
    np.testing.assert_array_equal(two.svars[-2:], 0)
    np.testing.assert_array_equal(two.energy[[0, 2, 4, 5, 6, 7]], 0)


@pytest.mark.parametrize("request_", [2, 3, 4, 5, 6])
def test_state_changes_only_in_calls_that_keep_it(library, interface, request_):
    call = Arguments(library, interface, columns=1, request=request_)
    np.testing.assert_array_equal(call.svars, 0)
    np.testing.assert_array_equal(call.energy, 7.0)
    assert np.isfinite(call.rhs[0, :8]).all() and np.isfinite(call.amatrx).all()
