# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements with incompatible modes: exact bending, published beams, nearly incompressible material, plasticity."""

import numpy as np
import pytest

from uel.model.element_types import CONTINUUM
from uel.usersub import _binding

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
CUBE = np.vstack([np.pad(SQUARE, ((0, 0), (0, 1))), np.pad(SQUARE, ((0, 0), (0, 1)), constant_values=1)])
CORNERS = {2: SQUARE, 3: CUBE}


def grid(*axes):
    """Nodes and elements of rectangles or bricks between these coordinates."""
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    sizes = [len(axis) for axis in axes]
    step = np.array([np.prod(sizes[k + 1 :], dtype=int) for k in range(len(axes))])
    first = np.stack(np.meshgrid(*[np.arange(n - 1) for n in sizes], indexing="ij"), axis=-1).reshape(-1, len(axes))
    elements = first @ step
    return np.pad(nodes, ((0, 0), (0, 3 - len(axes)))), elements[:, None] + CORNERS[len(axes)] @ step


def test_as_many_modes_as_abaqus_has():
    """Internal variables that the Abaqus Elements Guide lists: four, five and thirteen.

    Without a pressure for them, the four of the volume would be singular in C3D8IH.
    """
    found = {name: kind.modes for name, kind in CONTINUUM.items() if kind.modes}
    assert found == {"CPS4I": 4, "CPE4I": 5, "C3D8I": 13, "CPE4IH": 5, "C3D8IH": 9}


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize("element_type", ["CPS4I", "CPE4I", "CPE4IH"])
def test_rectangles_bend_exactly(forces_of, element_type, nu):
    """u = (xy, -x^2/2 - m y^2/2) is bending by E11 = y alone, with m = nu and E, in plane strain nu/(1 - nu) and
    E/(1 - nu^2): no force within, and the energy of the beam."""
    young = 1000.0
    ratio, modulus = (nu, young) if element_type == "CPS4I" else (nu / (1 - nu), young / (1 - nu**2))
    nodes, elements = grid(np.array([0.0, 1.0, 4.0]), np.array([-0.3, 0.1, 0.4]))
    x, y, _ = nodes.T
    u = np.column_stack([x * y, -(x**2 + ratio * y**2) / 2])
    force, _, energy = forces_of(element_type, nodes, elements=elements, young=young, nu=nu)(u)
    assert energy[1] == pytest.approx(modulus / 2 * 4 * (0.4**3 + 0.3**3) / 3, rel=1e-9)
    np.testing.assert_allclose(force[(x > 0) & (x < 4)], 0.0, atol=1e-7)
    np.testing.assert_allclose(force[:, 1], 0.0, atol=1e-7)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize(("axis", "element_type"), [(0, "C3D8I"), (1, "C3D8I"), (2, "C3D8I"), (0, "C3D8IH")])
def test_bricks_bend_exactly(forces_of, axis, element_type, nu):
    """Bending by E11 = y alone, the section bent as well: u = (xy, -x^2/2 - nu (y^2 - z^2)/2, -nu y z)."""
    young = 1000.0
    nodes, elements = grid(np.array([0.0, 1.0, 4.0]), np.array([-0.3, 0.1, 0.4]), np.array([-0.2, 0.3, 0.5]))
    x, y, z = nodes[:, np.roll([0, 1, 2], -axis)].T
    u = np.column_stack([x * y, -(x**2 + nu * (y**2 - z**2)) / 2, -nu * y * z])[:, np.roll([0, 1, 2], axis)]
    force, _, energy = forces_of(element_type, nodes, elements=elements, young=young, nu=nu)(u)
    second_moment = np.ptp(z) * (y.max() ** 3 - y.min() ** 3) / 3
    assert energy[1] == pytest.approx(young / 2 * np.ptp(x) * second_moment, rel=1e-8)
    inside = (x > x.min()) & (x < x.max())
    np.testing.assert_allclose(force[inside], 0.0, atol=1e-6)


def slender_beam(shift):
    """Six elements along 6 x 0.2; the lines between them lean by so much."""
    nodes, elements = grid(np.arange(7.0), np.array([0.0, 0.2]))
    x, y, _ = nodes.T
    inner = (x > 0) & (x < 6)
    moved = x + np.where(inner, np.sign(y - 0.1) * 0.1 * shift(x), 0.0)
    return np.column_stack([moved, y, 0 * x]), elements


def solve(forces_of, element_type, nodes, elements, fixed, load, **material):
    """Displacements (nodes, directions) under nodal loads."""
    dimension = CONTINUUM[element_type].dimension
    _, stiffness, _ = forces_of(element_type, nodes, elements=elements, **material)(np.zeros((len(nodes), dimension)))
    free = np.repeat(~fixed, dimension)
    u = np.zeros(free.size)
    u[free] = np.linalg.solve(stiffness[np.ix_(free, free)], load[:, :dimension].ravel()[free])
    return u.reshape(-1, dimension)


def shared(nodes, chosen, total, direction):
    """A force in equal parts at some nodes."""
    load = np.zeros((len(nodes), 3))
    load[chosen, direction] = total / chosen.sum()
    return load


SHAPES = {"rectangles": lambda x: 0 * x, "parallelograms": lambda x: 0 * x + 1, "trapezoids": lambda x: (-1) ** x}


@pytest.mark.parametrize(
    ("shape", "published"), [("rectangles", 0.993), ("parallelograms", 0.632), ("trapezoids", 0.052)]
)
def test_slender_cantilever(forces_of, shape, published):
    """The thin beam of R.H. MacNeal, R.L. Harder, Finite Elements in Analysis and Design 1 (1985) 3, under a shear
    force, over 0.1081. Values of T.H.H. Pian and K. Sumihara's element, which is the same in parallelograms,
    in X.-M. Chen, S. Cen, Y.-Q. Long, Z.-H. Yao, Computers and Structures 82 (2004) 35."""
    nodes, elements = slender_beam(SHAPES[shape])
    tip = nodes[:, 0] == 6
    # the beam is 0.1 thick, the section 1
    load = shared(nodes, tip, 10.0, 1)
    u = solve(forces_of, "CPS4I", nodes, elements, nodes[:, 0] == 0, load, young=1e7)
    assert u[tip, 1].mean() / 0.1081 == pytest.approx(published, abs=6e-4)


def test_cook_membrane(forces_of):
    """R.D. Cook, J. of the Structural Division 100 (1974) 1851: 23.96 in the limit at the middle of the end;
    within 0.5 % on 16 x 16 elements."""
    parent, elements = grid(*[np.linspace(0, 1, 17)] * 2)
    xi, eta, _ = parent.T
    nodes = np.column_stack([48 * xi, 44 * xi + eta * (44 - 28 * xi), 0 * xi])
    end = xi == 1
    load = shared(nodes, end, 1.0, 1)
    ends = end & ((eta == 0) | (eta == 1))
    load[end] *= 17 / 16
    load[ends] /= 2
    u = solve(forces_of, "CPS4I", nodes, elements, xi == 0, load, young=1.0, nu=1 / 3)
    assert u[end & (eta == 0.5), 1].item() == pytest.approx(23.96, rel=5e-3)


@pytest.mark.parametrize(("direction", "theory"), [(1, 0.001754), (2, 0.005424)])
def test_twisted_beam(forces_of, direction, theory):
    """MacNeal and Harder's beam, turned by 90 degrees along its length: 12 x 1.1 x 0.32 in 12 x 2 x 1 bricks; within
    1.5 % of their values by beam theory, for a force along the thickness and along the width of the end."""
    nodes, elements = grid(np.linspace(0, 12, 13), np.array([-0.55, 0.0, 0.55]), np.array([-0.16, 0.16]))
    x, y, z = nodes.T
    angle = np.pi / 2 * x / 12
    # the end lies with its width along z
    turned = np.column_stack([x, y * np.cos(angle) - z * np.sin(angle), y * np.sin(angle) + z * np.cos(angle)])
    tip = x == 12
    load = shared(nodes, tip, 1.0, direction)
    u = solve(forces_of, "C3D8I", turned, elements, x == 0, load, young=29e6, nu=0.22)
    assert u[tip, direction].mean() == pytest.approx(theory, rel=1.5e-2)


def curved_beam(pieces, *across):
    """MacNeal and Harder's curved beam: a quarter of a circle, radii 4.12 to 4.32; angles, nodes and elements."""
    parent, elements = grid(np.linspace(0, np.pi / 2, pieces + 1), np.array([4.12, 4.32]), *across)
    angle, radius, z = parent.T
    return angle, np.column_stack([-radius * np.cos(angle), radius * np.sin(angle), z]), elements


# value of the element with incompatible modes of OptiStruct on this mesh (its verification manual, problem OS-V 0710,
# "HEX8") over that of beam theory. Out of the plane the beam twists too, and elements differ in the modes that warp
@pytest.mark.parametrize(
    ("direction", "theory", "published", "near"), [(1, 0.08734, 0.880, 2e-3), (2, 0.5022, 0.820, 1.5e-2)]
)
def test_curved_beam_of_bricks(forces_of, direction, theory, published, near):
    """Six bricks 0.1 wide, clamped at one end, under a unit force at the other, in the plane and out of it."""
    angle, nodes, elements = curved_beam(6, np.array([0.0, 0.1]))
    tip = angle == angle.max()
    u = solve(forces_of, "C3D8I", nodes, elements, angle == 0, shared(nodes, tip, 1.0, direction), young=1e7, nu=0.25)
    assert u[tip, direction].mean() / theory == pytest.approx(published, rel=near)


def test_curved_beam_of_rectangles(forces_of):
    """On 24 elements within 1.5 % of beam theory, 0.08734, which has neither shear nor the curvature of the section."""
    angle, nodes, elements = curved_beam(24)
    tip = angle == angle.max()
    # the beam is 0.1 thick, the section 1
    u = solve(forces_of, "CPS4I", nodes, elements, angle == 0, shared(nodes, tip, 10.0, 1), young=1e7, nu=0.25)
    assert u[tip, 1].mean() == pytest.approx(0.08734, rel=1.5e-2)


PLATE = """*HEADING
beam of CPS4I
*NODE
1, 0., 0.
2, 2., 0.
3, 4., 0.
11, 0., 1.
12, 2., 1.
13, 4., 1.
*NSET, NSET=END
13
*ELEMENT, TYPE={type}, ELSET=ALL
1, 1, 2, 12, 11
2, 2, 3, 13, 12
*SOLID SECTION, ELSET=ALL, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*PLASTIC
5., 0.
25., 1.
*STEP, INC=20{nlgeom}
*STATIC
0.1, 1., 1e-5, 0.1
*BOUNDARY
1, 1, 2
11, 1
13, 1, 1, -0.1
3, 1, 1, 0.1
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
RF1
*END STEP
"""


@pytest.mark.parametrize("element_type", ["CPS4I", "CPE4I"])
def test_plastic_bending(run_deck, element_type):
    """A beam bent by its ends far beyond yield: Newton's method converges fast, as the modes are in equilibrium in each
    pass, and the moment lies between the elastic limit and the largest plastic moment."""
    result = run_deck(
        PLATE.format(type=element_type, nlgeom="").replace("*ELEMENT,", "*NSET, NSET=END\n13\n*ELEMENT,", 1)
    )
    assert result.completed
    assert max(line.total_iterations for line in result.status) <= 5
    moment = abs(result.history["RF1[END]"][-1])
    # of a rectangle of height 1: sigma_y/6 and sigma_y/4; plane strain hardens it by 2/sqrt(3)
    assert 5.0 / 6 < moment < 2 / np.sqrt(3) * 25.0 / 4


BENT = """*HEADING
beam that is bent at once
*NODE
{nodes}
*ELEMENT, TYPE={type}, ELSET=ALL
{elements}
*NSET, NSET=HELD
{held}
*NSET, NSET=LOWER
{lower}
*NSET, NSET=UPPER
{upper}
*SOLID SECTION, ELSET=ALL, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*PLASTIC
{hardening}
*STEP, INC=1000
*STATIC, DIRECT
{increment}, 1.
*BOUNDARY
HELD, 1
1, 2, 3
{edge}, 2
UPPER, 1, 1, -{turned}
LOWER, 1, 1, {turned}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=UPPER
RF1
*END STEP
"""


@pytest.mark.sample(3)
@pytest.mark.parametrize("turned", [0.1, 1.0])
@pytest.mark.parametrize("hardening", ["5., 0.\n25., 1.", "5., 0.\n5.02, 1.", "5., 0.\n8., 0.002\n9., 1."])
@pytest.mark.parametrize("element_type", ["CPS4I", "CPE4I", "C3D8I"])
def test_bending_far_beyond_yield_at_once(run_deck, element_type, hardening, turned):
    """The modes are found where Newton's method alone would oscillate: strains of 5 and 50 times the one at yield.

    No fibre unloads, so that one increment gives the force of fifty, in plane strain to 0.3 %.
    """
    axes = [np.linspace(0, 4, 3), np.array([0, 1.0]), np.array([0.0, 1.0])]
    nodes, elements = grid(*axes[: CONTINUUM[element_type].dimension])
    sets = {
        "held": nodes[:, 0] == 0,
        "lower": (nodes[:, 0] == 4) & (nodes[:, 1] == 0),
        "upper": (nodes[:, 0] == 4) & (nodes[:, 1] == 1),
    }
    lines = {name: ", ".join(map(str, np.flatnonzero(chosen) + 1)) for name, chosen in sets.items()}
    lines["nodes"] = "\n".join(f"{k + 1}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(nodes.tolist()))
    lines["elements"] = "\n".join(f"{k + 1}, " + ", ".join(map(str, row + 1)) for k, row in enumerate(elements))
    # both ends of a brick's lower edge: it could turn about the axis of the beam
    edge = np.flatnonzero(sets["held"] & (nodes[:, 1] == 0))[-1] + 1
    forces = []
    for increment in (1.0, 0.02):
        values = {"type": element_type, "hardening": hardening, "turned": turned, "increment": increment, "edge": edge}
        result = run_deck(BENT.format(**values, **lines))
        assert result.completed
        forces.append(sum(values[-1] for name, values in result.history.items() if name.startswith("RF1")))
    assert forces[0] == pytest.approx(forces[1], rel=5e-3)


ELASTICA = """*HEADING
cantilever of {type}
*NODE
{nodes}
*ELEMENT, TYPE={type}, ELSET=ALL
{elements}
*NSET, NSET=FIXED
{fixed}
*NSET, NSET=TIP
{tip}
*SOLID SECTION, ELSET=ALL, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1e6, 0.
*STEP, NLGEOM, INC=100
*STATIC
0.1, 1., 1e-5, 0.2
*BOUNDARY
FIXED, 1, 3
*CLOAD
TIP, 2, {load}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=TIP
U1, U2
*END STEP
"""


@pytest.mark.parametrize(("load", "deflection", "shortening"), [(1.0, 0.30172, 0.05643), (5.0, 0.71379, 0.38763)])
@pytest.mark.parametrize("element_type", ["CPS4I", "CPE4I", "C3D8I"])
def test_elastica(run_deck, element_type, load, deflection, shortening):
    """A slender cantilever under a load P at its end, P L^2/(E I) = 1 and 5: deflection and shortening over its length.

    K. Mattiasson, Int. J. for Numerical Methods in Engineering 17 (1981) 145, by elliptic integrals. Twenty elements;
    the shear of a beam of 40 times its height adds 0.04 % to the deflection.
    """
    length, height = 20.0, 0.5
    axes = [np.linspace(0, length, 21), np.array([0, height]), np.array([0.0, 1.0])]
    nodes, elements = grid(*axes[: CONTINUUM[element_type].dimension])
    tip, fixed = (np.flatnonzero(nodes[:, 0] == x) + 1 for x in (length, 0))
    force = load * 1e6 * height**3 / 12 / length**2 / len(tip)
    lines = {
        "nodes": "\n".join(f"{k + 1}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(nodes.tolist())),
        "elements": "\n".join(f"{k + 1}, " + ", ".join(map(str, row + 1)) for k, row in enumerate(elements)),
        "fixed": ", ".join(map(str, fixed)),
        "tip": ", ".join(map(str, tip)),
    }
    result = run_deck(ELASTICA.format(type=element_type, load=force, **lines))
    assert result.completed
    found = {u: np.mean([v[-1] for name, v in result.history.items() if name.startswith(u)]) for u in ("U1", "U2")}
    assert found["U2"] / length == pytest.approx(deflection, rel=2e-3)
    assert -found["U1"] / length == pytest.approx(shortening, rel=4e-3)


@pytest.mark.parametrize("element_type", ["CPE4IH", "C3D8IH"])
def test_pressure_beside_the_modes(forces_of, element_type):
    """The mixed matrix of displacements, modes and a linear pressure, the last two eliminated: in parallelograms, where
    the modes are xi_a grad xi_a along each direction, and in plane strain xi eta of the volume."""
    kind, bulk, shear = CONTINUUM[element_type], 800.0, 300.0
    d = kind.dimension
    slopes = np.array([[1.0, 0.2, 0.1], [-0.3, 0.8, 0.1], [0.2, 0.1, 1.2]])[:d, :d] / 2
    parent = 2.0 * CORNERS[d] - 1
    nodes = parent @ slopes.T
    gradient = np.linalg.inv(slopes)
    weights, shapes, by_parent = _binding.integration_rule(kind.family.number, kind.points, kind.nodes, d)
    unit = np.eye(3)[:d]
    stiffness, across, compliance = 0.0, 0.0, 0.0
    for weight, shape, slope in zip(weights * np.linalg.det(slopes), shapes, by_parent, strict=True):
        xi = shape @ parent
        found = [np.outer(e, np.pad(row @ gradient, (0, 3 - d))) for row in slope for e in unit]
        found += [np.outer(e, xi[a] * np.pad(gradient[a], (0, 3 - d))) for a in range(d) for e in unit]
        found += [xi.prod() / 2 * np.diag([1.0, 1.0, 0.0])] if d == 2 else []
        strains = np.array([(h + h.T) / 2 for h in found])
        volume = np.trace(strains, axis1=1, axis2=2)
        shapely = strains - volume[:, None, None] * np.eye(3) / 3
        functions = np.array([1.0, *(shape @ nodes)])
        stiffness = stiffness + 2 * shear * weight * np.einsum("iab,jab->ij", shapely, shapely)
        across = across + weight * np.outer(volume, functions)
        compliance = compliance + weight / bulk * np.outer(functions, functions)
    mixed = stiffness + across @ np.linalg.solve(compliance, across.T)
    n = nodes.size
    expected = mixed[:n, :n] - mixed[:n, n:] @ np.linalg.solve(mixed[n:, n:], mixed[n:, :n])
    young = 9 * bulk * shear / (3 * bulk + shear)
    places = np.pad(nodes, ((0, 0), (0, 3 - d)))
    _, matrix, _ = forces_of(element_type, places, young=young, nu=young / (2 * shear) - 1)(np.zeros_like(places))
    np.testing.assert_allclose(matrix, expected, atol=1e-10 * abs(expected).max())
