# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Quadratic elements: polynomials and modes without energy; and a stack of quads with U5 or U6 in between."""

import meshio
import numpy as np
import pytest

import uel
from uel.delamination.kernels import formulations, uel_property, user_element
from uel.elements import Request
from uel.errors import KernelError
from uel.output import read_interface

E, NU, ALPHA = 1000.0, 0.3, 2.0e4
PLANE_STRESS = E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
LAW = {
    "SIGMAMAX": 30.0,
    "TAUMAX": 60.0,
    # a softening that beta of the soft quads in shear exceeds
    "GIC": 0.52,
    "GIIC": 2.004,
    "VISCOSITY": 0.0,
    "BLEND": 0.0,
    "GAMMABOT": 0.0,
    "FRICTION": 0.0,
    "ETA": 0.0,
    "POWER": 0.0,
    "SHAPEN": 0.0,
    "SHAPET": 0.0,
}
LAW |= {"THICKNESS": 2.0, "ALPHAN": ALPHA, "ALPHAT": ALPHA, "BETAN": -1, "BETAT": -1}
LAW |= {"LAW": 1, "INTEGRATION": 0, "TANGENT": 0, "SAMPLING": 0, "PLANE": 0, "CLOSURE": 1}
ISOTROPIC = {"E1": E, "E2": E, "E3": 0.0, "NU12": NU, "NU13": 0.0, "NU23": 0.0, "G12": E / 2 / (1 + NU), "ANGLE": 0.0}
LAW |= {f"{name} {side}": value for name, value in ISOTROPIC.items() for side in ("BOTTOM", "TOP")}


def with_middles(corners):
    return np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])


PARALLELOGRAM = with_middles(np.array([[0.0, 0.0], [1.0, 0.2], [1.3, 1.1], [0.3, 0.9]]))


@pytest.fixture
def quad(solid_group, bound, load):
    def quad(element_type, xy):
        group = solid_group(element_type, np.arange(8)[None], 2.0)
        return bound(group, np.column_stack([xy, np.zeros(8)]), load(None))

    return quad


@pytest.mark.parametrize("element_type", ["CPS8", "CPS8R", "CPE8", "CPE8R"])
def test_quadratic_displacements(quad, call, element_type):
    """Stress, position by position, of u = (x y, x^2 - y^2) on a parallelogram; energy to the rule of the points."""
    block, matrix = quad(element_type, PARALLELOGRAM)
    x, y = PARALLELOGRAM.T
    u = 1e-3 * np.column_stack([x * y, x**2 - y**2]).ravel()
    residual = np.zeros(16)
    report = block.evaluate(call, u, u, residual, matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(-1, 8)
    n = 2 if element_type.endswith("R") else 3
    places, weights = np.polynomial.legendre.leggauss(n)
    work = 0.0
    for p, values in enumerate(points):
        xi, eta = places[p % n], places[p // n]
        corner = PARALLELOGRAM[0]
        px, py = corner + (1 + xi) / 2 * np.array([1.0, 0.2]) + (1 + eta) / 2 * np.array([0.3, 0.9])
        strain = 1e-3 * np.array([py, -2 * py, px + 2 * px])
        np.testing.assert_allclose(values[[0, 1, 3]], strain, rtol=1e-12, atol=1e-17)
        if element_type.startswith("CPS"):
            np.testing.assert_allclose(values[[4, 5, 7]], PLANE_STRESS @ strain, rtol=1e-12, atol=1e-14)
        area = weights[p % n] * weights[p // n] * (1.0 * 0.9 - 0.2 * 0.3) / 4
        work += 0.5 * 2.0 * area * strain @ values[[4, 5, 7]]
    assert len(points) == n * n
    assert report.energy[1] == pytest.approx(work, rel=1e-12)
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-13)


TRIANGLE = with_middles(np.array([[0.0, 0.0], [1.0, 0.2], [0.3, 0.9]]))


@pytest.mark.parametrize("element_type", ["CPS6", "CPE6"])
def test_quadratic_displacements_of_a_triangle(solid_group, bound, load, call, element_type):
    """Strain at the three points of u = (x y, x^2 - y^2); rank; masses and forces by theory."""
    group = solid_group(element_type, np.arange(6)[None], 2.0)
    block, matrix = bound(group, np.column_stack([TRIANGLE, np.zeros(6)]), load(None))
    x, y = TRIANGLE.T
    u = 1e-3 * np.column_stack([x * y, x**2 - y**2]).ravel()
    residual = np.zeros(12)
    report = block.evaluate(call, u, u, residual, matrix.data)
    block.commit()
    points = block.state(0).svars.reshape(3, 8)
    work = 0.0
    for values, (g, h) in zip(points, [(1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)], strict=True):
        px, py = g * np.array([1.0, 0.2]) + h * np.array([0.3, 0.9])
        strain = 1e-3 * np.array([py, -2 * py, px + 2 * px])
        np.testing.assert_allclose(values[[0, 1, 3]], strain, rtol=1e-12, atol=1e-17)
        if element_type == "CPS6":
            np.testing.assert_allclose(values[[4, 5, 7]], PLANE_STRESS @ strain, rtol=1e-12, atol=1e-14)
        # a third of the volume: thickness 2, area (1.0 x 0.9 - 0.2 x 0.3)/2
        work += 0.5 * 2.0 * 0.42 / 3 * strain @ values[[4, 5, 7]]
    assert report.energy[1] == pytest.approx(work, rel=1e-12)
    np.testing.assert_allclose(matrix @ u, -residual, atol=1e-13)
    # three points of three strains: no mode without energy but the rigid ones
    assert np.linalg.matrix_rank(matrix.toarray(), tol=1e-9 * abs(matrix.toarray()).max()) == 9


def test_mass_of_a_triangle(solid_group, bound, load, call):
    """Consistent mass, thickness x density x area/180 times the integers of theory (O.C. Zienkiewicz, R.L. Taylor)."""
    group = solid_group("CPS6", np.arange(6)[None], 2.0)
    block, matrix = bound(group, np.column_stack([TRIANGLE, np.zeros(6)]), load(None))
    block.artificial_mass(call, 12, matrix.data)
    a = np.array([[6, -1, -1], [-1, 6, -1], [-1, -1, 6]])
    b = np.array([[0, -4, 0], [0, 0, -4], [-4, 0, 0]])
    c = np.array([[32, 16, 16], [16, 32, 16], [16, 16, 32]])
    expected = 2.0 * 0.42 / 180 * np.block([[a, b], [b.T, c]])
    np.testing.assert_allclose(matrix.toarray()[::2, ::2], expected, rtol=1e-9, atol=1e-12)


def test_mass_that_fails_leaves_the_properties(solid_group, bound, load, call, monkeypatch):
    """The mass of unit density is asked for with a density of one, which no later call must see."""
    block, matrix = bound(
        solid_group("CPS6", np.arange(6)[None], 2.0), np.column_stack([TRIANGLE, np.zeros(6)]), load(None)
    )
    with monkeypatch.context() as broken:
        broken.setattr("uel.usersub._binding.evaluate", _fail)
        with pytest.raises(KernelError, match="fails"):
            block.artificial_mass(call, 12, matrix.data)
    block.evaluate(call.asking(Request.MASS), np.zeros(12), np.zeros(12), np.zeros(12), matrix.data)
    assert not matrix.data.any()


def _fail(*_):
    raise KernelError(101, "CPS6", "fails")


@pytest.mark.parametrize(("element_type", "rank"), [("CPS8", 13), ("CPS8R", 12), ("CPE8", 13), ("CPE8R", 12)])
def test_rank(quad, call, element_type, rank):
    """Three rigid motions; reduced integration leaves one more mode without energy, which two elements do not share."""
    curved = PARALLELOGRAM + 0.02 * np.random.default_rng(1).normal(size=(8, 2))
    block, matrix = quad(element_type, curved)
    block.evaluate(call, np.zeros(16), np.zeros(16), np.zeros(16), matrix.data)
    k = matrix.toarray()
    x, y = curved.T
    rigid = np.array([np.tile([1, 0], 8), np.tile([0, 1], 8), np.column_stack([-y, x]).ravel()])
    np.testing.assert_allclose(k @ rigid.T, 0, atol=1e-10)
    assert np.linalg.matrix_rank(k, tol=1e-9 * abs(k).max()) == rank


def stack(jtype, quads):
    """Deck: two columns of distorted quads, an interface at y = 1 across, the top pulled by 0.01."""
    nodes, labels = [], {}

    def label(place, side):
        key = (*np.round(place, 9), side)
        if key not in labels:
            labels[key] = len(labels) + 1
            nodes.append(f"{labels[key]}, {place[0]!r}, {place[1]!r}".replace("np.float64(", "").replace(")", ""))
        return labels[key]

    outer, inner = (0.0, 0.6, 1.0), (0.0, 0.45, 1.0)
    elements, interfaces = [], []
    for k in (0, 1):
        low = np.array([[outer[k], 0.0], [outer[k + 1], 0.0], [inner[k + 1], 1.0], [inner[k], 1.0]])
        high = np.array([[inner[k], 1.0], [inner[k + 1], 1.0], [outer[k + 1], 2.0], [outer[k], 2.0]])
        bottom = [label(place, 0) for place in with_middles(low)]
        top = [label(place, 1) for place in with_middles(high)]
        elements += [f"{2 * k + 1}, " + ", ".join(map(str, bottom)), f"{2 * k + 2}, " + ", ".join(map(str, top))]
        both = [*bottom, *top]
        if jtype == 5:
            both = [bottom[3], bottom[2], top[1], top[0], bottom[6], top[4]]
        text = ", ".join(map(str, both)).split(", ")
        interfaces.append(f"{11 + k}, " + ", ".join(text[:12]) + (",\n" + ", ".join(text[12:]) if text[12:] else ""))
    ends = {y: [str(n) for (_, place, _), n in labels.items() if place == y] for y in (0.0, 2.0)}
    return "\n".join(
        [
            *("*NODE", *nodes, f"*ELEMENT, TYPE={quads}, ELSET=QUADS", *elements),
            *user_element(jtype),
            *(f"*ELEMENT, TYPE=U{jtype}, ELSET=COHESIVE", *interfaces),
            *("*NSET, NSET=LOW", ", ".join(ends[0.0]), "*NSET, NSET=HIGH", ", ".join(ends[2.0])),
            *("*MATERIAL, NAME=M", "*ELASTIC", f"{E}, {NU}", "*SOLID SECTION, ELSET=QUADS, MATERIAL=M", "2.0"),
            *uel_property(jtype, "COHESIVE", LAW | formulations(quads)),
            *("*BOUNDARY", "LOW, 2, 2", f"{labels[0.0, 0.0, 0]}, 1, 1", f"{labels[0.0, 2.0, 1]}, 1, 1"),
            *("*STEP", "*STATIC", "1.0, 1.0", "*BOUNDARY", "HIGH, 2, 2, 0.01"),
            *("*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*ELEMENT OUTPUT", "S", "*END STEP", ""),
        ]
    )


@pytest.mark.parametrize("quads", ["CPS8", "CPS8R"])
@pytest.mark.parametrize("jtype", [5, 6])
def test_patch(tmp_path, jtype, quads):
    """Bar with a spring in series: the stress is 0.01/(2/E + 1/alpha) everywhere, and what is written says so."""
    deck = tmp_path / "stack.inp"
    deck.write_text(stack(jtype, quads))
    result = uel.run(deck, output_dir=tmp_path / "out")
    stress = 0.01 / (2 / E + 1 / ALPHA)
    profile = read_interface(tmp_path / "out/stack_interface.csv")
    np.testing.assert_allclose(profile["TN"], stress, rtol=1e-9)
    np.testing.assert_allclose(profile["TT"], 0, atol=1e-9 * stress)
    np.testing.assert_allclose(profile["SEPN"], stress / ALPHA, rtol=1e-7)
    np.testing.assert_array_equal(profile["point"], [1, 2, 3, 1, 2, 3])
    s = np.sqrt(0.6)
    expected = [0.225 * (1 - s), 0.225, 0.225 * (1 + s), 0.725 - 0.275 * s, 0.725, 0.725 + 0.275 * s]
    np.testing.assert_allclose(profile["X"], expected, rtol=1e-12)
    assert result is not None
    (*_, last) = sorted((tmp_path / "out").rglob("*.vtu"))
    field = meshio.read(last)
    kinds = {block.type: block.data.shape for block in field.cells}
    assert kinds == {"quad8": (4, 8), "line3": (2, 3)}
    lines = next(block.data for block in field.cells if block.type == "line3")
    np.testing.assert_allclose(field.points[lines][:, :, 0], [[0, 0.45, 0.225], [0.45, 1, 0.725]], rtol=1e-12)
