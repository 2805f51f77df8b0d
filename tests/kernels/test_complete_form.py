# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The complete form (CLOSURE 3): its forces are derivatives of an energy.

With the potential psi of the law, p = <sigma>.n + beta g and t(w) + beta w = p, that energy is
psi + (T^2 - <sigma>.n^2)/(2 beta): Nitsche's symmetric form.
"""

from itertools import pairwise, product

import numpy as np
import pytest
from lines import TABLE
from reference_cells import SQUARE_EDGES, with_middles
from space import nodes_of

from uel.errors import KernelError

ELASTIC, DAMAGE = 1, 3
LINEAR, NLGEOM = (1, 0, 0, 0), (1, 1, 0, 0)
BETA = {"BETAN": 3.0e5, "BETAT": 2.0e5, "GAMMABOT": 0.3}
INFINITE = {"ALPHAN": 0.0, "ALPHAT": 0.0}
STRONG = {"SIGMAMAX": 3e4, "TAUMAX": 6e4, "GIC": 1e6, "GIIC": 1e6}
TYPES = (4, 6, 8, 12)
LAWS = {
    "bilinear": {},
    "bridging": {"LAW": 5, "SIGMABRIDGE": 6.0, "GIBRIDGE": 0.1},
    "table": TABLE,
}


@pytest.fixture
def complete(element, interface):
    """Make an element of the complete form and give its nodes: complete(jtype, NAME=value, ...)."""
    quad = interface.eight
    middles = np.vstack([with_middles(half, SQUARE_EDGES) for half in (quad[:4], quad[4:])])
    nodes = {4: quad, 6: middles, 8: nodes_of(8, "warped"), 12: nodes_of(12, "warped")}

    def make(jtype, **values):
        return element(jtype, nodes[jtype], **{"CLOSURE": 3, "BETAN": -1, "BETAT": -1, **values}), nodes[jtype]

    return make


def random_displacements(coordinates, seed, size):
    return size * np.random.default_rng(seed).normal(size=coordinates.shape)


def turned(coordinates, u, angle):
    """Displacements u, and then a rotation by an angle about an axis that is no direction of anything."""
    dim = coordinates.shape[1]
    axis = np.array([0.6, -0.48, 0.64]) if dim == 3 else np.array([0.0, 0.0, 1.0])
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    q = (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)[:dim, :dim]
    return (coordinates + u) @ q.T - coordinates


@pytest.mark.parametrize("flags", [LINEAR, NLGEOM])
@pytest.mark.parametrize("stiffness", [{}, INFINITE, BETA], ids=["finite", "infinite", "given beta"])
@pytest.mark.parametrize("jtype", TYPES)
def test_forces_are_the_derivatives_of_the_energy(complete, jtype, stiffness, flags):
    item, coordinates = complete(jtype, **STRONG, **stiffness)
    u = random_displacements(coordinates, 3, 0.01)
    if flags == NLGEOM:
        u = turned(coordinates, u, 0.7)
    force, _ = item.evaluate(u, flags=flags)
    step, slopes = 1e-5, np.empty(u.size)
    for i in range(u.size):
        change = np.zeros(u.size)
        change[i] = step
        energies = []
        for sign in (1, -1):
            item.advance(u.ravel() + sign * change, flags=flags)
            energies.append(item.energy[ELASTIC])
        slopes[i] = (energies[0] - energies[1]) / (2 * step)
    assert not item.state["DAMAGE"].any()
    np.testing.assert_allclose(-slopes, force, rtol=0, atol=2e-7 * abs(force).max())


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("flags", [LINEAR, NLGEOM])
@pytest.mark.parametrize("opened", [0.0, 0.01], ids=["bonded", "softening"])
@pytest.mark.parametrize("jtype", TYPES)
def test_matrix_is_symmetric(complete, jtype, opened, flags, law):
    """While bonded, and softening: the law has one strength and energy in all directions here, thus a potential."""
    alike = {"ALPHAN": 2e4, "ALPHAT": 2e4, "SIGMAMAX": 30.0, "TAUMAX": 30.0, "GIC": 0.26, "GIIC": 0.26}
    item, coordinates = complete(jtype, **alike, **LAWS[law])
    u = random_displacements(coordinates, 5, 1e-5)
    half = len(coordinates) // 2
    if opened:
        u[half:] += opened * np.eye(coordinates.shape[1])[-1]
    _, matrix = item.evaluate(turned(coordinates, u, 0.4) if flags == NLGEOM else u, flags=flags)
    item.advance(turned(coordinates, u, 0.4) if flags == NLGEOM else u, flags=flags)
    assert ((item.state["DAMAGE"] > 0) == (opened > 0)).all()
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-12 * abs(matrix).max())


def work_on_closed_path(item, coordinates, flags, steps=400):
    """Trapezoidal work of the nodal forces: the solids are strained, the interface fails, and all goes back."""
    half = len(coordinates) // 2
    apart = np.zeros(coordinates.shape)
    apart[half:] = 0.08 * np.eye(coordinates.shape[1])[-1]
    strained = random_displacements(coordinates, 11, 1e-3)
    u, rhs, work = np.zeros(apart.size), np.zeros(apart.size), 0.0
    for start, end in pairwise([np.zeros_like(apart), strained, strained + apart, apart, np.zeros_like(apart)]):
        for share in np.linspace(0, 1, steps + 1)[1:]:
            new = ((1 - share) * start + share * end).ravel()
            new_rhs, _ = item.advance(new, flags=flags)
            work -= 0.5 * (rhs + new_rhs) @ (new - u)
            u, rhs = new, new_rhs
    return work


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("flags", [LINEAR, NLGEOM])
@pytest.mark.parametrize("jtype", [4, 8])
def test_a_closed_path_costs_what_is_dissipated(complete, jtype, flags, law):
    """The trapezoidal rule errs by 5e-4 in 400 increments and by 8e-5 in 1600."""
    item, coordinates = complete(jtype, **INFINITE, **LAWS[law])
    work = work_on_closed_path(item, coordinates, flags)
    assert (item.state["DAMAGE"] == 1).all()
    assert item.energy[ELASTIC] == pytest.approx(0, abs=1e-9)
    assert work == pytest.approx(item.energy[DAMAGE], rel=1e-3)


def test_the_incomplete_form_makes_energy_on_that_path(complete):
    """By 1.4 %, in 400 increments as in 1600: the path of the test above shows what it looks for."""
    item, coordinates = complete(4, CLOSURE=1, **INFINITE)
    work = work_on_closed_path(item, coordinates, LINEAR)
    assert abs(work / item.energy[DAMAGE] - 1) > 0.01


def test_elements_without_solids_have_no_complete_form(element, interface):
    with pytest.raises(KernelError, match=r"CLOSURE = 3, the complete form, requires an element that has the nodes"):
        element(3, interface.four, CLOSURE=3).evaluate(np.zeros(8))


SIZES = (0.25, 0.5, 1.0, 2.0, 3.0)


@pytest.mark.parametrize("formulation", range(4))
@pytest.mark.parametrize("jtype", [4, 8])
def test_regular_elements_have_a_bound(element, jtype, formulation):
    """Rectangles and boxes of an isotropic solid have eigenvalues that differ by the digits of a deck alone."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    box = np.vstack([np.column_stack([square, np.full(4, z)]) for z in (-1.0, 0.0, 0.0, 1.0)])
    unit = box if jtype == 8 else np.vstack([square - np.array([0.0, 1.0]), square])
    plies = {f"{name} {side}": 7e4 for name in ("E1", "E2", "E3") for side in ("BOTTOM", "TOP")}
    plies |= {f"{name} {side}": 0.3 for name in ("NU12", "NU13", "NU23") for side in ("BOTTOM", "TOP")}
    shears = ("G12", "G13", "G23") if jtype == 8 else ("G12",)
    plies |= {f"{name} {side}": 26923.0769231 for name in shears for side in ("BOTTOM", "TOP")}
    options = {
        "FORMULATION BOTTOM": formulation,
        "FORMULATION TOP": formulation,
        "CLOSURE": 3,
        "BETAN": -1,
        "BETAT": -1,
    }
    # mean volume strain is plane strain's
    options |= {"PLANE": int(formulation == 2), "THICKNESS": 1.0} if jtype == 4 else {}
    for sizes in product(SIZES, repeat=unit.shape[1]):
        for place in ((0.0, 0.0, 0.0), (51.5, 2.0, 0.0)):
            item = element(jtype, place[: len(sizes)] + unit * sizes, **plies, **options, **INFINITE)
            item.advance(np.zeros(item.n))
            # the first two of the variables of the element, behind those of its points
            assert (item.block.state(0).svars[0, item.points * len(item.names) :][:2] > 0).all()
