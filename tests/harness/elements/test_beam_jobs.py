# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of beams against closed forms: cantilevers, frames, a ring, vibration, the beams of MacNeal and Harder; output.

MacNeal, Harder: R.H. MacNeal, R.L. Harder, A proposed standard set of problems to test finite element accuracy, Finite
Elements in Analysis and Design 1 (1985) 3-20.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import meshio
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import uel
from uel.elements.families.beam_profiles import SHEAR_FACTORS, profile_of, rectangle_torsion
from uel.errors import Source
from uel.model.element_types import BEAM
from uel.model.properties import BeamSection

TYPES = tuple(BEAM)
SPACE = tuple(name for name, kind in BEAM.items() if kind.dimension == 3)
STEP = """*STEP
*STATIC
{data}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, RF
*OUTPUT, FIELD
*NODE OUTPUT
U
*ELEMENT OUTPUT
S, SF
*END STEP
"""


@dataclass
class Line:
    """Beams along a polygon or curve: (points, 3), with a middle node in each element of three nodes."""

    kind: str
    places: np.ndarray
    section: str
    material: str = "*ELASTIC\n1000., 0.25\n*DENSITY\n2."
    before: str = ""

    @classmethod
    def straight(cls, kind: str, count: int, end: Sequence[float], section: str, **more: str) -> "Line":
        """A number of elements from the origin to a place."""
        per = BEAM[kind].nodes - 1
        return cls(kind, np.linspace(0, 1, per * count + 1)[:, None] * np.array(end, dtype=float), section, **more)

    @property
    def last(self) -> int:
        """Number of the last node."""
        return len(self.places)

    def text(self, step: str) -> str:
        """The deck; sets ALL, ROOT and END."""
        per = BEAM[self.kind].nodes - 1
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(self.places.tolist(), 1)]
        lines += [f"*ELEMENT, TYPE={self.kind}, ELSET=BEAM"]
        for k, first in enumerate(range(1, self.last, per), 1):
            lines.append(", ".join(map(str, (k, *range(first, first + per + 1)))))
        lines += ["*NSET, NSET=ROOT", "1", "*NSET, NSET=END", str(self.last)]
        lines += [f"*MATERIAL, NAME=M\n{self.material}", self.section]
        return "\n".join([*lines, self.before + step])


@pytest.fixture
def run_beam(run_deck):
    def run_beam(line: Line, data: str, *, step: str = STEP, text: str = ""):
        return run_deck(text or line.text(step.format(data=data)))

    return run_beam


def rect(a: float, b: float, n1: str = "0., 0., -1.", more: str = "") -> str:
    return f"*BEAM SECTION, ELSET=BEAM, MATERIAL=M, SECTION=RECT\n{a}, {b}\n{n1}{more}"


CLAMPED = "*BOUNDARY\nROOT, ENCASTRE\n"
THIN = "\n*TRANSVERSE SHEAR STIFFNESS\n0., 0., 0."


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("element_type", TYPES)
def test_cantilever(run_beam, element_type, count):
    """P L^3/(3 EI) + P L/K, with Abaqus' K; the trapezoidal rule of first-order elements takes P L h^2/(12 EI)."""
    length, a, b = 10.0, 1.0, 2.0
    found = run_beam(Line.straight(element_type, count, (length, 0, 0), rect(a, b)), CLAMPED + "*CLOAD\nEND, 2, 1.")
    young, shear, h = 1000.0, SHEAR_FACTORS["RECT"] * 400.0 * a * b, length / count
    bending, linear = young * a * b**3 / 12, BEAM[element_type].nodes == 2
    flexible = (1 + (1.0 if linear else 1e-4) * 0.25 * h**2 * 12 / b**2 / 12) / shear
    expected = length**3 / (3 * bending) - linear * length * h**2 / (12 * bending) + length * flexible
    node = 1 + count * (BEAM[element_type].nodes - 1)
    assert found.history[f"U2[ALL:{node}]"][-1] == pytest.approx(expected, rel=1e-9)
    assert found.history[f"UR3[ALL:{node}]"][-1] == pytest.approx(length**2 / (2 * bending), rel=1e-9)
    assert found.history["RM3[ALL:1]"][-1] == pytest.approx(-length, rel=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
def test_end_moment_on_uneven_elements(run_beam, element_type):
    """Constant curvature is exact: M L/EI and M L^2/(2 EI)."""
    line = Line.straight(element_type, 3, (10.0, 0, 0), rect(1.0, 2.0))
    # middle nodes stay in the middle
    ends = np.array([0.0, 2.1, 7.7, 10.0])
    places = ends if BEAM[element_type].nodes == 2 else np.sort([*ends, *(ends[1:] + ends[:-1]) / 2])
    line.places = places[:, None] * [1.0, 0, 0]
    found = run_beam(line, CLAMPED + "*CLOAD\nEND, 6, 3.").history
    curvature = 3 / (1000 * 8 / 12)
    assert found[f"UR3[ALL:{line.last}]"][-1] == pytest.approx(10 * curvature, rel=1e-9)
    assert found[f"U2[ALL:{line.last}]"][-1] == pytest.approx(50 * curvature, rel=1e-9)


@pytest.mark.parametrize("element_type", SPACE)
def test_frame_in_space(run_beam, element_type):
    """A bent, inclined cantilever, loaded out of its plane: bending of both arms, torsion of the first."""
    first, second, count, per = 6.0, 4.0, 24, BEAM[element_type].nodes - 1
    axes = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    axes *= np.linalg.det(axes)
    s = np.linspace(0, 1, per * count + 1)[:, None]
    corner = first * axes[0]
    places = np.vstack([s * corner, (corner + s * second * axes[1])[1:]])
    # direction 1 of both arms is in the plane of the frame, direction 2 is normal to it
    n1 = ", ".join(map(str, axes[1] - 0.5 * axes[0]))
    a, b = 0.3, 0.5
    line = Line(element_type, places, rect(a, b, n1, THIN))
    force = "\n".join(f"END, {k}, {float(value)!r}" for k, value in enumerate(axes[2], 1))
    history = run_beam(line, f"{CLAMPED}*CLOAD\n{force}").history
    moved = np.array([history[f"U{k}[ALL:{line.last}]"][-1] for k in (1, 2, 3)])
    bending, torsion = 1000 * a * b**3 / 12, 400 * rectangle_torsion(a, b)
    shear = SHEAR_FACTORS["RECT"] * 400 * a * b
    expected = (first**3 + second**3) / (3 * bending) + first * second**2 / torsion + (first + second) / shear
    # of first-order elements, by the square of their length over that of the arm
    assert moved @ axes[2] == pytest.approx(expected, rel=2e-4 if per == 1 else 1e-9)
    np.testing.assert_allclose(moved - (moved @ axes[2]) * axes[2], 0, atol=1e-9 * expected)


@pytest.mark.parametrize(("element_type", "tolerance"), [("B21", 2e-3), ("B22", 1e-5), ("B31", 2e-3), ("B32", 1e-5)])
def test_pinched_ring(run_beam, element_type, tolerance):
    """A quarter of a ring under P: shortening of the radius P R^3/(2 EI) (pi/4 - 2/pi) + pi P R/8 (1/EA + 1/kGA).

    S. Timoshenko, Strength of Materials II, 1956, section 15, with straight-beam theory for the section.
    """
    radius, a, b, count = 10.0, 1.0, 0.5, 40
    angle = np.linspace(0, np.pi / 2, count * (BEAM[element_type].nodes - 1) + 1)
    places = radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    held = "*BOUNDARY\nROOT, 2\nROOT, 6\nEND, 1\nEND, 6\n"
    if BEAM[element_type].dimension == 3:
        held += "ALL, 3, 5\n"
    line = Line(element_type, places, rect(a, b, more=THIN))
    found = run_beam(line, held + "*CLOAD\nEND, 2, -0.5")
    area, second = a * b, a * b**3 / 12
    small = 1 / (1000 * area) + 1 / (SHEAR_FACTORS["RECT"] * 400 * area)
    expected = radius**3 / (2000 * second) * (np.pi / 4 - 2 / np.pi) + np.pi * radius / 8 * small
    assert -found.history[f"U2[ALL:{line.last}]"][-1] == pytest.approx(expected, rel=tolerance)


HARDER = "*ELASTIC\n1.E7, 0.3"


@pytest.mark.parametrize(
    ("load", "dof", "published"),
    [("END, 1, 1.", "U1", 3.0e-5), ("END, 2, 1.", "U2", 0.1081), ("END, 3, 1.", "U3", 0.4321)],
    ids=["extension", "in-plane shear", "out-of-plane shear"],
)
@pytest.mark.parametrize("element_type", SPACE)
def test_straight_beam_of_macneal_and_harder(run_beam, element_type, load, dof, published):
    """6 elements, 6 x 0.2 x 0.1."""
    line = Line.straight(element_type, 6, (6, 0, 0), rect(0.1, 0.2), material=HARDER)
    found = run_beam(line, f"{CLAMPED}*CLOAD\n{load}").history[f"{dof}[ALL:{line.last}]"][-1]
    # first-order elements miss 1/(4 n^2) = 0.7 %, of which their compensated shear gives three quarters back
    assert found == pytest.approx(published, rel=3e-3)


@pytest.mark.parametrize(("dof", "published"), [(2, 0.08734), (3, 0.5022)], ids=["in-plane", "out-of-plane"])
@pytest.mark.parametrize(("element_type", "tolerance"), [("B31", 0.02), ("B32", 2e-4)])
def test_curved_beam_of_macneal_and_harder(run_beam, element_type, tolerance, dof, published):
    """6 elements over 90 degrees; inner radius 4.12, outer 4.32, thickness 0.1; clamped at y = 0, loaded at x = 0.

    Straight-beam theory for the section, of bending, torsion, axial force and shear, is 1.4 and 0.8 % from their
    figures.
    """
    radius, (a, b), young, shear = 4.22, (0.1, 0.2), 1e7, 1e7 / 2.6
    angle = np.linspace(0, np.pi / 2, 6 * (BEAM[element_type].nodes - 1) + 1)
    places = radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    line = Line(element_type, places, rect(a, b), material=HARDER)
    found = run_beam(line, f"{CLAMPED}*CLOAD\nEND, {dof}, 1.").history[f"U{dof}[ALL:{line.last}]"][-1]
    area, slid = a * b, SHEAR_FACTORS["RECT"] * shear * a * b
    bent, twisted = young * a * b * (b**2 if dof == 2 else a**2) / 12, shear * rectangle_torsion(a, b)
    if dof == 2:
        theory = np.pi / 4 * radius * (radius**2 / bent + 1 / (young * area) + 1 / slid)
    else:
        theory = radius**3 * (np.pi / 4 / bent + (3 * np.pi / 4 - 2) / twisted) + np.pi / 2 * radius / slid
    # first-order elements are facets
    assert found == pytest.approx(theory, rel=tolerance)
    assert found == pytest.approx(published, rel=0.015)


@pytest.mark.parametrize("element_type", SPACE)
def test_twist(run_beam, element_type):
    """T L/(G J), with the J of the rectangle; MacNeal and Harder print 0.03208 for it, which is not that."""
    line = Line.straight(element_type, 6, (6, 0, 0), rect(0.1, 0.2), material=HARDER)
    found = run_beam(line, CLAMPED + "*CLOAD\nEND, 4, 1.").history[f"UR1[ALL:{line.last}]"][-1]
    # 0.229: S. Timoshenko, J. Goodier, Theory of Elasticity, 1951, article 94
    assert found == pytest.approx(6 / (1e7 / 2.6 * 0.229 * 0.2 * 0.1**3), rel=2e-3)


@pytest.mark.parametrize("element_type", TYPES)
def test_vibration_of_a_supported_beam(run_beam, element_type):
    """Timoshenko's equation of a supported beam: EI k^4 - m w^2 - (rho I + m EI/(kGA)) k^2 w^2 + m rho I/(kGA) w^4 = 0.

    S. Timoshenko, Vibration Problems in Engineering, 1937, section 54.
    """
    length, a, b, density, count = 10.0, 1.0, 1.0, 2.0, 20
    line = Line.straight(element_type, count, (length, 0, 0), rect(a, b, more=THIN))
    plane = BEAM[element_type].dimension == 2
    held = "*BOUNDARY\nROOT, 1, 2\nEND, 2\n" + ("" if plane else "ALL, 3, 5\n")
    found = run_beam(line, "", step=f"*STEP\n*FREQUENCY\n2\n{held}*END STEP").history["EIGFREQ"]
    mass, bending, rotary = density * a * b, 1000 * a * b**3 / 12, density * a * b**3 / 12
    shear = SHEAR_FACTORS["RECT"] * 400 * a * b
    for mode, frequency in enumerate(found, 1):
        k = mode * np.pi / length
        squares = np.roots([mass * rotary / shear, -mass - (rotary + mass * bending / shear) * k**2, bending * k**4])
        exact = np.sqrt(squares.min()) / (2 * np.pi)
        # discretisation: (k h)^2/12 of first-order elements, its square of second-order ones
        h = length / count
        error = (k * h) ** 2 / 12 if BEAM[element_type].nodes == 2 else (k * h) ** 4
        assert frequency == pytest.approx(exact, rel=2 * error)


NONLINEAR = STEP.replace("*STEP", "*STEP, NLGEOM").replace("*STATIC\n", "*STATIC\n0.1, 1.\n")


@pytest.mark.parametrize("element_type", ["B21", "B22", "B31"])
def test_cantilever_rolls_up(run_beam, element_type):
    """An end moment makes a circle, or half of one in space: the same moment everywhere, the end on the circle."""
    line = Line.straight(element_type, 12, (10, 0, 0), rect(1.0, 0.1))
    # rotation vectors are unique up to 180 degrees
    angle = 2 * np.pi if BEAM[element_type].dimension == 2 else 0.9 * np.pi
    moment = angle / 10 * 1000 * 0.1**3 / 12
    result = run_beam(line, f"{CLAMPED}*CLOAD\nEND, 6, {moment!r}", step=NONLINEAR)
    end = [result.history[f"{name}[ALL:{line.last}]"][-1] for name in ("U1", "U2", "UR3")]
    # the polygon of the chords of first-order elements, on whose circumference the elements are
    side = angle / 12
    radius = 10 / angle * (side / 2 / np.sin(side / 2) if BEAM[element_type].nodes == 2 else 1)
    expected = [radius * np.sin(angle) - 10, radius * (1 - np.cos(angle)), angle]
    # exact but for what Newton's method leaves
    np.testing.assert_allclose(end, expected, atol=1e-3)
    np.testing.assert_allclose(result.field("SM1"), -moment, rtol=1e-3)


def test_area_that_would_change(run_beam):
    """POISSON, which CAE writes, has an effect in large strains alone: a warning with NLGEOM, none without."""
    section = rect(1.0, 0.1).replace("SECTION=RECT", "SECTION=RECT, POISSON=0.3")
    for step, warnings in ((NONLINEAR, 1), (STEP, 0)):
        result = run_beam(Line.straight("B21", 2, (10, 0, 0), section), CLAMPED + "*CLOAD\nEND, 1, 1.", step=step)
        message = "POISSON=0.3: the area of beams does not change with their strain"
        assert result.file(".msg").read_text().count(message) == warnings


def elastica(load: float) -> tuple[float, float]:
    """Displacements along and across of the end of a cantilever of length and EI of one under an end force across."""

    def shot(curvature: float):
        slope = lambda s, y: [y[1], -load * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]  # noqa: E731
        return solve_ivp(slope, (0, 1), [0, curvature, 0, 0], rtol=1e-10, atol=1e-12).y[:, -1]

    _, _, x, y = shot(brentq(lambda curvature: shot(curvature)[1], 0, load))
    return x - 1, y


@pytest.mark.parametrize(
    ("element_type", "count", "tolerance"), [("B21", 40, 1e-3), ("B22", 10, 1e-3), ("B31", 40, 1e-3), ("B32", 10, 1e-3)]
)
def test_elastica(run_beam, element_type, count, tolerance):
    """P L^2/EI = 5: the elastica, with an axial and shear flexibility of EI/(EA L^2) = 8e-6."""
    length, b = 10.0, 0.1
    bending = 1000 * b**3 / 12
    line = Line.straight(element_type, count, (length, 0, 0), rect(1.0, b, more=THIN))
    load = f"{CLAMPED}*CLOAD\nEND, 2, {5 * bending / length**2!r}\n*CONTROLS, PARAMETERS=FIELD\n1e-7, 1e-5"
    history = run_beam(line, load, step=NONLINEAR).history
    found = [history[f"U{k}[ALL:{line.last}]"][-1] / length for k in (1, 2)]
    np.testing.assert_allclose(found, elastica(5.0), rtol=tolerance)
    # K. Mattiasson, International Journal for Numerical Methods in Engineering 17 (1981) 145-153
    np.testing.assert_allclose(elastica(5.0), (-0.38763, 0.71379), atol=1e-5)


@pytest.mark.parametrize(("load", "published"), [(300, (22.14, 58.64, 40.35)), (600, (15.55, 47.04, 53.50))])
@pytest.mark.parametrize(("element_type", "nodes"), [("B31", 9), ("B32", 9)])
def test_bend_of_45_degrees(run_beam, element_type, nodes, load, published):
    """The end of a beam with a radius of 100 and a square section of 1 under a force out of its plane.

    K.J. Bathe, S. Bolourchi, Int. J. for Numerical Methods in Engineering 14 (1979) 961; the figures are those of
    A. Cardona, M. Geradin, the same 26 (1988) 2403.
    """
    angle = np.linspace(0, np.pi / 4, nodes)
    places = 100 * np.column_stack([1 - np.cos(angle), np.sin(angle), 0 * angle])
    line = Line(element_type, places, rect(1.0, 1.0), material="*ELASTIC\n1e7, 0.")
    history = run_beam(line, f"{CLAMPED}*CLOAD\nEND, 3, {load}.", step=NONLINEAR).history
    end = places[-1] + [history[f"U{k}[ALL:{line.last}]"][-1] for k in (1, 2, 3)]
    # published figures differ by up to 2 %
    np.testing.assert_allclose(end, published, rtol=5e-3)


@pytest.mark.parametrize("element_type", ["B31", "B32"])
def test_frame_turns_with_its_root(run_beam, element_type):
    """Rotations of the root by 150 degrees about an inclined axis move a bent beam in space without a force."""
    corner = np.array([[0.0, 0, 0], [2, 0, 0], [4, 0, 0], [4, 1, 1], [4, 2, 2]])
    line = Line(element_type, corner, rect(0.3, 0.5, "0.3, 0.2, -1."))
    vector = np.radians(150) * np.array([2.0, -1.0, 2.0]) / 3
    rows = "\n".join(f"ROOT, {k}, {k}, {value!r}" for k, value in enumerate(vector.tolist(), 4))
    history = run_beam(line, f"*BOUNDARY\nROOT, 1, 3\n{rows}", step=NONLINEAR).history
    turned = Rotation.from_rotvec(vector).apply(corner)
    for node, (place, before) in enumerate(zip(turned, corner, strict=True), 1):
        moved = [history[f"U{k}[ALL:{node}]"][-1] for k in (1, 2, 3)]
        np.testing.assert_allclose(moved, place - before, atol=1e-5)
        np.testing.assert_allclose([history[f"UR{k}[ALL:{node}]"][-1] for k in (1, 2, 3)], vector, atol=1e-5)


def test_general_section_is_the_profile_it_describes(run_beam):
    """*BEAM GENERAL SECTION with the constants of a rectangle; *TRANSVERSE SHEAR STIFFNESS that of its shear factor."""
    a, b = 0.3, 0.5
    torsion, k = rectangle_torsion(a, b), SHEAR_FACTORS["RECT"] * 400 * a * b
    n1 = "0.3, 0.2, -1."
    texts = {
        "profile": rect(a, b, n1),
        "general profile": f"*BEAM GENERAL SECTION, ELSET=BEAM, SECTION=RECT\n{a}, {b}\n{n1}\n1000., 400.",
        "constants": f"*BEAM GENERAL SECTION, ELSET=BEAM, DENSITY=2.\n{a * b}, {a * b**3 / 12}, 0., {a**3 * b / 12}, "
        f"{torsion}\n{n1}\n1000., 400.\n*TRANSVERSE SHEAR STIFFNESS\n{k}",
    }
    found = {}
    for name, text in texts.items():
        line = Line.straight("B31", 2, (3, 2, 1), text)
        history = run_beam(line, CLAMPED + "*CLOAD\nEND, 1, 0.1\nEND, 2, 0.2\nEND, 4, 0.3").history
        found[name] = [history[f"U{'R' * (k > 3)}{(k - 1) % 3 + 1}[ALL:3]"][-1] for k in range(1, 7)]
    np.testing.assert_allclose(found["general profile"], found["profile"], rtol=1e-9)
    np.testing.assert_allclose(found["constants"], found["profile"], rtol=1e-9)


def test_a_load_beside_the_shear_centre_twists(run_beam):
    """An I-section with unequal flanges: the moment of the load about the shear centre over G J."""
    dimensions = 0.3, 1.2, 0.8, 0.5, 0.06, 0.05, 0.04
    text = "*BEAM SECTION, ELSET=BEAM, MATERIAL=M, SECTION=I\n" + ", ".join(map(str, dimensions)) + "\n0., 0., -1."
    line = Line.straight("B31", 4, (10, 0, 0), text)
    # direction 1 is -z, 2 is y
    history = run_beam(line, CLAMPED + "*CLOAD\nEND, 3, -1.").history
    profile = profile_of(BeamSection("", "I", dimensions, 1000.0, 400.0, 2.0, Source("", 0)), 3)
    assert profile.shear_centre[1] < profile.centroid[1]
    # a force along 1 below the shear centre (x2 = 0 - x2s) turns about t by -x2s
    expected = -profile.shear_centre[1] * -1.0 * 10 / (400 * profile.torsion)
    assert abs(history["UR1[ALL:5]"][-1]) == pytest.approx(abs(expected), rel=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
def test_distributed_loads(run_beam, element_type):
    """Reactions and their moments are those of the whole load, along global and local directions."""
    end = np.array([3.0, 4.0, 0.0 if BEAM[element_type].dimension == 2 else 12.0])
    length, area = np.linalg.norm(end), 0.3 * 0.5
    line = Line.straight(element_type, 3, end, rect(0.3, 0.5))
    t = end / length
    n2 = np.cross(t, [0, 0, -1])
    n2 /= np.linalg.norm(n2)
    n1 = np.cross(n2, t)
    loads = {
        "BEAM, PX, 2.": 2 * np.array([1, 0, 0]),
        "BEAM, PY, 2.": 2 * np.array([0, 1, 0]),
        "BEAM, P2, 3.": 3 * n2,
        "BEAM, BY, 5.": 5 * area * np.array([0, 1, 0]),
        "BEAM, GRAV, 9., 0., -2., 0.": 9 * 2 * area * np.array([0, -1, 0]),
    }
    if BEAM[element_type].dimension == 3:
        loads |= {
            "BEAM, PZ, 2.": 2 * np.array([0, 0, 1]),
            "BEAM, P1, 3.": 3 * n1,
            "BEAM, BZ, 5.": 5 * area * np.eye(3)[2],
        }
    for load, per_length in loads.items():
        history = run_beam(line, f"{CLAMPED}*DLOAD\n{load}").history
        dimension = BEAM[element_type].dimension
        force = [history[f"RF{k + 1}[ALL:1]"][-1] for k in range(dimension)]
        np.testing.assert_allclose(force, -length * per_length[:dimension], atol=1e-9, err_msg=load)
        moment = -np.cross(end / 2, length * per_length)
        assert history["RM3[ALL:1]"][-1] == pytest.approx(moment[2], abs=1e-9), load


@pytest.mark.parametrize("element_type", TYPES)
def test_vtu(run_beam, tmp_path, element_type):
    """Cells are lines along the nodes, with section forces and stresses at the section points of the default output."""
    line = Line.straight(element_type, 2, (4, 0, 0), rect(0.3, 0.5))
    result = run_beam(line, CLAMPED + "*CLOAD\nEND, 2, 1.\nEND, 1, 3.")
    numbers = (1, 5) if BEAM[element_type].dimension == 2 else (1, 5, 21, 25)
    (file,) = (tmp_path / "deck_vtu").iterdir()
    mesh = meshio.read(file)
    (block,) = mesh.cells
    x = mesh.points[block.data][:, :, 0]
    expected = [[0, 2], [2, 4]] if BEAM[element_type].nodes == 2 else [[0, 2, 1], [2, 4, 3]]
    assert block.type == ("line" if BEAM[element_type].nodes == 2 else "line3")
    np.testing.assert_allclose(x, expected)
    for number in numbers:
        assert f"S11_SP{number}" in mesh.cell_data
    np.testing.assert_allclose(result.field("SF1"), 3.0)
    # mean over the integration points of moments that grow towards the root: 3 and 1; positive ones pull the left side
    np.testing.assert_allclose(result.field("SM1"), [-3.0, -1.0])
    np.testing.assert_allclose(result.field(f"S11_SP{numbers[-1]}"), 3 / 0.15 - np.array([3, 1]) / (0.3 * 0.5**2 / 6))


def test_print(run_beam):
    """*EL PRINT: stresses at section points by their numbers, forces and strains of the section once for each point."""
    line = Line.straight("B32", 1, (4, 0, 0), rect(0.3, 0.5))
    step = STEP.replace("*OUTPUT, FIELD", "*EL PRINT\nS\n*EL PRINT\nSF\n*EL PRINT\nSE\n*OUTPUT, FIELD")
    result = run_beam(line, CLAMPED + "*CLOAD\nEND, 1, 3.", step=step)
    lines = [line.split() for line in result.file(".dat").read_text().splitlines()]
    for head in (
        ["ELEMENT", "PT", "SEC", "FOOT-", "S11"],
        ["ELEMENT", "PT", "FOOT-", "SF1", "SF2", "SF3", "SM1", "SM2", "SM3"],
        ["ELEMENT", "PT", "FOOT-", "SE1", "SE2", "SE3", "SK1", "SK2", "SK3"],
    ):
        assert head in lines
    rows = [line for line in lines if len(line) == 4 and line[0] == "1"]
    assert [(row[1], row[2]) for row in rows] == [(p, s) for p in "12" for s in ("1", "5", "21", "25")]
    assert {row[3] for row in rows} == {"20.00"}


JOINED = """*NODE, NSET=ALL
1, 0., 0., 0.
2, 5., 0., 0.
3, 5., {offset}, 0.
4, 10., {offset}, 0.
*ELEMENT, TYPE=B31, ELSET=BEAM
1, 1, 2
2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.25
{section}
{joint}
*NSET, NSET=ROOT
1
*NSET, NSET=END
4
"""


@pytest.mark.parametrize(
    ("joint", "offset"),
    [
        ("*MPC\nTIE, 3, 2", 0.0),
        ("*MPC\nBEAM, 3, 2", 0.7),
        ("*NSET, NSET=JOINT\n3\n*KINEMATIC COUPLING, REF NODE=2\nJOINT, 1, 6", 0.7),
    ],
    ids=["TIE", "BEAM", "KINEMATIC COUPLING"],
)
def test_joints(tmp_path, joint, offset):
    """Two beams with a rigid joint are one beam, with a jog that the torsion and bending of the root feel."""
    file = tmp_path / "joined.inp"
    text = JOINED.format(offset=offset, joint=joint, section=rect(1.0, 2.0))
    file.write_text(text + STEP.format(data=CLAMPED + "*CLOAD\nEND, 1, 1.\nEND, 2, 1.\nEND, 3, 1."))
    found = uel.run(file, output_dir=tmp_path / "out").history
    moments = np.cross([10.0, offset, 0.0], [1.0, 1.0, 1.0])
    for k in (1, 2, 3):
        assert found[f"RF{k}[ALL:1]"][-1] == pytest.approx(-1.0, abs=1e-9)
        assert found[f"RM{k}[ALL:1]"][-1] == pytest.approx(-moments[k - 1], abs=1e-9)
    # rotation about x: twist of the root under the moment of the jog
    twist = offset * 1.0 * 5 / (400 * rectangle_torsion(1.0, 2.0))
    assert found["UR1[ALL:4]"][-1] == pytest.approx(twist, rel=1e-9, abs=1e-12)


def test_beam_at_a_shell(tmp_path):
    """A stiffener at an edge of a strip that is clamped: both bend alike, and share the force by their stiffness."""
    n = 4
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{1 + i + j * (n + 1)}, {10.0 * i / n}, {0.5 * j}, 0." for j in range(2) for i in range(n + 1)]
    lines += ["*ELEMENT, TYPE=S4, ELSET=SHELL"]
    lines += [f"{1 + i}, {1 + i}, {2 + i}, {n + 3 + i}, {n + 2 + i}" for i in range(n)]
    for j in range(2):
        lines += ["*ELEMENT, TYPE=B31, ELSET=BEAM"]
        lines += [f"{100 * (j + 1) + i}, {1 + i + j * (n + 1)}, {2 + i + j * (n + 1)}" for i in range(n)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1000., 0.", "*SHELL SECTION, ELSET=SHELL, MATERIAL=M", "0.3"]
    lines += [
        rect(0.2, 0.3, "0., 1., 0."),
        "*NSET, NSET=ROOT",
        f"1, {n + 2}",
        "*NSET, NSET=END",
        f"{n + 1}, {2 * n + 2}",
    ]
    file = tmp_path / "stiffened.inp"
    file.write_text("\n".join(lines) + "\n" + STEP.format(data=CLAMPED + "*CLOAD\nEND, 5, 0.5"))
    found = uel.run(file, output_dir=tmp_path / "out").history
    bending = 1000 * (0.5 + 2 * 0.2) * 0.3**3 / 12
    assert found[f"UR2[ALL:{n + 1}]"][-1] == pytest.approx(10 / bending, rel=1e-9)
    assert found[f"U3[ALL:{n + 1}]"][-1] == pytest.approx(-50 / bending, rel=1e-9)


SHAFTS = {
    # places along x, U2, U3
    "shaft 1, B31": (
        "B31",
        "3, 3, -500.\n5, 2, 1198.5\n5, 3, 3292.86\n1, 4, -65.86\n5, 4, 65.86",
        [
            (0, -0.01480316, -0.034948468),
            (10, 0, 0),
            (60, 0.066647381, 0.158937976),
            (92.5, 0.088532053, 0.215002924),
            (100, 0.089543879, 0.218215913),
            (107.5, 0.08834473, 0.21578677),
            (183, 0.010701573, 0.02637369),
            (190, 0, 0),
            (197, -0.010537046, -0.02595979),
            (200, -0.015052924, -0.037085414),
        ],
    ),
    "shaft 2, B31": (
        "B31",
        "4, 2, -1198.5\n4, 3, 3292.86\n6, 3, -500.\n4, 4, -131.71\n10, 4, 131.71",
        [
            (0, 0.015133891, -0.037281401),
            (10, 0, 0),
            (92.5, -0.087929271, 0.214678019),
            (100, -0.089189149, 0.217254162),
            (107.5, -0.088238046, 0.214188159),
            (140, -0.066616513, 0.158760175),
            (183, -0.010470061, 0.024679625),
            (190, 0, 0),
            (197, 0.010305534, -0.024326736),
            (200, 0.014722192, -0.034752481),
        ],
    ),
    "shaft 1 without the radial force, B31H": (
        "B31H",
        "4, 2, 1198.5\n4, 3, 3292.86\n7, 1, 2000.\n1, 4, -65.86\n4, 4, 65.86",
        [
            (0, -0.014988233, -0.041179936),
            (10, 0, 0),
            (92.5, 0.086727574, 0.238282651),
            (100, 0.087878212, 0.241444007),
            (107.5, 0.086817861, 0.238530725),
            (183, 0.010572021, 0.029046461),
            (190, 0, 0),
            (197, -0.010407495, -0.028594431),
            (200, -0.01486785, -0.040849186),
        ],
    ),
}


@pytest.mark.parametrize("shaft", SHAFTS)
def test_shafts_of_abaqus_2025(run_beam, shaft):
    """Displacements of Abaqus 2025 on coarse, uneven meshes, with its shear factor and slenderness compensation.

    The decks and results are those of a public repository, JRaposo-m/AxisForge-Design-Studies: uniform shafts, cases
    'radial single position' and 'axial and moment'. Abaqus goes on where nothing holds the rotation about the axis; it
    is held here.
    """
    element_type, loads, expected = SHAFTS[shaft]
    places = np.array([(x, 0.0, 0.0) for x, *_ in expected], dtype=float)
    section = "*BEAM SECTION, ELSET=BEAM, MATERIAL=M, TEMPERATURE=GRADIENTS, SECTION=CIRC\n10.\n0., 0., -1."
    line = Line(element_type, places, section, material="*ELASTIC\n207000., 0.3")
    roller = [x for x, *_ in expected].index(190) + 1
    history = run_beam(line, f"*BOUNDARY\n2, PINNED\n2, 4\n{roller}, 2, 3\n*CLOAD\n{loads}").history
    found = [[history[f"U{k}[ALL:{node}]"][-1] for k in (2, 3)] for node in range(1, line.last + 1)]
    # the results come from an output database in single precision; a penalty eliminates the forces of hybrid elements
    tolerance = 3e-7 if element_type.endswith("H") else 1.2e-7
    np.testing.assert_allclose(found, np.array(expected)[:, 1:], rtol=tolerance, atol=1e-12)


def test_mass_at_a_beam_in_the_plane_of_the_model(run_beam):
    """A point mass at the end of a beam without weight along x swings out of the plane z = 0: w^2 = k/m."""
    line = Line.straight(
        "B31",
        1,
        (10, 0, 0),
        rect(1.0, 2.0),
        material="*ELASTIC\n1000., 0.25\n*DENSITY\n1e-9",
        before="*ELEMENT, TYPE=MASS, ELSET=POINT\n9, 2\n*MASS, ELSET=POINT\n3.\n",
    )
    found = run_beam(line, "", step=f"*STEP\n*FREQUENCY\n2\n{CLAMPED}*END STEP").history["EIGFREQ"]
    stiffness = []
    for dof in (3, 2):
        history = run_beam(line, f"{CLAMPED}*CLOAD\nEND, {dof}, 1.").history
        stiffness.append(1 / history[f"U{dof}[ALL:2]"][-1])
    np.testing.assert_allclose(2 * np.pi * np.array(found), np.sqrt(np.array(stiffness) / 3), rtol=1e-6)


def test_transient_keeps_the_energy(run_beam):
    """A cantilever let go in *DYNAMIC without numerical damping: what was stored moves, none is lost."""
    line = Line.straight("B31", 4, (10, 0, 0), rect(1.0, 1.0))
    energies = "*OUTPUT, HISTORY\n*ENERGY OUTPUT\nALLSE, ALLKE\n*END STEP\n"
    step = f"*STEP\n*STATIC\n{CLAMPED}*CLOAD\nEND, 2, 1.\n{energies}"
    step += f"*STEP\n*DYNAMIC, ALPHA=0., DIRECT\n0.2, 4.\n*CLOAD, OP=NEW\n{energies}"
    history = run_beam(line, "", step=step).history
    stored, moving = np.array(history["ALLSE"]), np.array(history["ALLKE"])
    assert moving.max() > 0.5 * stored[0]
    np.testing.assert_allclose((stored + moving)[1:], stored[0], rtol=1e-6)


BUCKLE = """*STEP
*BUCKLE
2
{data}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""


def eigenvalues(run_beam, line, data, step=BUCKLE):
    return np.array(run_beam(line, data, step=step).history["EIGVAL"])


@pytest.mark.sample(4)
@pytest.mark.parametrize(("element_type", "count"), [("B21", 6), ("B22", 8), ("B31", 6), ("B32", 8)])
@pytest.mark.parametrize(
    ("held", "factor"),
    [("ROOT, ENCASTRE", 0.5), ("ROOT, 1, 4\nEND, 2, 4", 1.0), ("ROOT, ENCASTRE\nEND, 2, 6", 2.0)],
    ids=["cantilever", "pinned", "clamped"],
)
def test_euler_columns(run_beam, element_type, count, held, factor):
    """P (1 + P/K) = EI (factor pi/L)^2 about the weak axis: of a slender column Euler's load.

    Z.P. Bazant, L. Cedolin, Stability of Structures, 1991, section 1.7: Haringx, for forces normal to the section.
    """
    length, a, b = 10.0, 1.0, 0.2
    line = Line.straight(
        element_type, count, (length, 0, 0), rect(a, b, more="\n*TRANSVERSE SHEAR STIFFNESS\n66.1, , 0.")
    )
    if BEAM[element_type].dimension == 2:
        held = held.replace("1, 4", "1, 2").replace("2, 4", "2, 2")
    found = eigenvalues(run_beam, line, f"*BOUNDARY\n{held}\n*CLOAD\nEND, 1, -1.")[0]
    wave = factor * np.pi / length
    if BEAM[element_type].nodes == 2:
        # rotations sin(wave x) at the nodes: those of the middles, and their differences
        wave = 2 * np.tan(wave * length / count / 2) / (length / count)
    euler = 1000 * a * b**3 / 12 * wave**2
    expected = 66.1 / 2 * (np.sqrt(1 + 4 * euler / 66.1) - 1)
    # quadratic elements converge with the fourth power of their length
    assert found == pytest.approx(expected, rel=1e-6 if BEAM[element_type].nodes == 2 else 2e-3)


@pytest.mark.parametrize(("element_type", "count"), [("B31", 20), ("B32", 5)])
def test_lateral_buckling_of_a_cantilever(run_beam, element_type, count):
    """A narrow rectangle under an end force along its longer side: P = 4.013 sqrt(EI GJ)/L^2.

    S.P. Timoshenko, Theory of Elastic Stability, lateral buckling of beams with narrow rectangular sections.
    """
    length, a, b = 10.0, 0.05, 1.0
    line = Line.straight(element_type, count, (length, 0, 0), rect(a, b, more=THIN))
    found = eigenvalues(run_beam, line, f"{CLAMPED}*CLOAD\nEND, 2, -1.").min()
    stiffness = np.sqrt(1000 * a**3 * b / 12 * 400 * rectangle_torsion(a, b))
    assert abs(found) == pytest.approx(4.013 * stiffness / length**2, rel=1e-2)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("element_type", "count"), [("B21", 10), ("B22", 4), ("B31", 10), ("B32", 4)])
def test_preload(run_beam, element_type, count):
    """Under a part of the load, with NLGEOM, the rest is missing, but for the shortening of the column."""
    line = Line.straight(element_type, count, (10, 0, 0), rect(1.0, 0.2))
    whole = eigenvalues(run_beam, line, f"{CLAMPED}*CLOAD\nEND, 1, -1.")[0]
    load = float(0.4 * whole)
    first = f"*STEP, NLGEOM\n*STATIC\n{CLAMPED}*CLOAD\nEND, 1, {-load!r}\n*END STEP\n"
    found = eigenvalues(run_beam, line, "*CLOAD\nEND, 1, -1.", step=first + BUCKLE)
    # the first step has none
    more = found[~np.isnan(found)][0]
    # the axial strain of the preload is 3e-4
    assert more == pytest.approx(whole - load, rel=2e-3)


@pytest.mark.parametrize(("element_type", "count"), [("B31", 12), ("B32", 6)])
def test_twisted_beam(run_beam, element_type, count):
    """MacNeal and Harder: normals of *NODE twist a cantilever by 90 degrees; 5.424e-3 and 1.754e-3 at its end."""
    last = count * (BEAM[element_type].nodes - 1) + 1
    line = Line.straight(element_type, count, (12.0, 0, 0), rect(0.32, 1.1), material="*ELASTIC\n29e6, 0.22")
    text = line.text(STEP.format(data=f"{CLAMPED}*CLOAD\nEND, {{dof}}, 1."))
    for k, angle in enumerate(np.linspace(0, np.pi / 2, last), 1):
        plain = f"\n{k}, {line.places[k - 1, 0]}, 0.0, 0.0"
        assert plain in text
        text = text.replace(plain, f"{plain}, 0., {np.cos(angle)}, {np.sin(angle)}", 1)
    for dof, expected in ((3, 5.424e-3), (2, 1.754e-3)):
        history = run_beam(line, "", text=text.replace("{dof}", str(dof))).history
        # the figures are those of beam theory
        assert history[f"U{dof}[ALL:{last}]"][-1] == pytest.approx(expected, rel=1e-2)
