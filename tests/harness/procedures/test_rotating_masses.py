# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Masses that follow a reference node through large rotations in *DYNAMIC: a rotor and a pendulum.

The average acceleration method turns a rotor of angular velocity w by D with tan(D/2) = w h/2 in each increment h, and
keeps its energy: the chord of the circle is h times the mean of the velocities at its ends, both of them tangents.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import ellipk

MASS, LENGTH, GRAVITY = 2.0, 0.8, 10.0
CONSTRAINTS = {
    "coupling": "*SURFACE, NAME=S, TYPE=NODE\nENDS\n*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=S\n*KINEMATIC",
    "kinematic coupling": "*KINEMATIC COUPLING, REF NODE=9\nENDS, 1, 6",
    "rigid body": "*RIGID BODY, REF NODE=9, PIN NSET=ENDS",
    "beams": "*MPC\nBEAM, ENDS, AXIS",
}
DECK = """*NODE
{nodes}
*NSET, NSET=ENDS
{ends}
*NODE, NSET=AXIS
9, 0., 0., 0.
*ELEMENT, TYPE=MASS, ELSET=MASSES
{masses}
*MASS, ELSET=MASSES
{mass}
{constraint}
*BOUNDARY
9, 1, 3
{boundary}
*INITIAL CONDITIONS, TYPE=VELOCITY
{velocities}
*AMPLITUDE, NAME=NOW
0., 1., 1000., 1.
*STEP, NLGEOM, INC=1000
*DYNAMIC, DIRECT, NOHAF, {how}
{size}, {end}
{loads}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ENDS
U, V, A
*NODE OUTPUT, NSET=AXIS
UR
*ENERGY OUTPUT
ETOTAL, ALLKE
*END STEP
"""


@pytest.fixture
def turn(run_deck):
    def turn(places, size, count, *, loads="", velocities="", boundary="", how="ALPHA=0.", constraint="coupling"):
        values = {
            "nodes": "\n".join(f"{k}, {', '.join(map(repr, map(float, x)))}" for k, x in enumerate(places, start=1)),
            "ends": "\n".join(str(k + 1) for k in range(len(places))),
            "masses": "\n".join(f"{k + 1}, {k + 1}" for k in range(len(places))),
            "constraint": CONSTRAINTS[constraint],
            "end": size * count,
        }
        values |= {"size": size, "loads": loads, "velocities": velocities, "boundary": boundary, "how": how}
        text = DECK.format(mass=MASS, **values)
        if not velocities:
            text = text.replace("*INITIAL CONDITIONS, TYPE=VELOCITY\n", "")
        return run_deck(text.replace("\n\n", "\n"))

    return turn


def vectors(result, quantity, node):
    """(increments, 3) of a node."""
    history = result.history
    name = f"[ENDS:{node}]" if f"{quantity}1[ENDS:{node}]" in history else "[ENDS]"
    components = [history.get(f"{quantity}{k}{name}", np.zeros(len(history["time"]))) for k in (1, 2, 3)]
    return np.stack(components, axis=1)


AXIS = np.array([0.36, 0.48, 0.8])
ACROSS = np.cross(AXIS, [0.0, 0.0, 1.0]) / np.linalg.norm(np.cross(AXIS, [0.0, 0.0, 1.0]))
ROTOR = np.array([LENGTH * ACROSS, -2 * LENGTH * ACROSS, LENGTH * np.cross(AXIS, ACROSS)])
SPIN, SIZE, COUNT = 3.0, 0.1, 42


@pytest.mark.parametrize("constraint", CONSTRAINTS)
def test_rotor(turn, constraint):
    """About a skew axis that is held, given by the velocity of the reference node alone: two turns."""
    velocities = "\n".join(f"9, {k}, {SPIN * one!r}" for k, one in enumerate(AXIS.tolist(), start=4))
    result = turn(ROTOR, SIZE, COUNT, velocities=velocities, constraint=constraint)
    each = 2 * np.arctan(SPIN * SIZE / 2)
    steps = np.arange(1, COUNT + 1)
    # no element has moments, so that a correction of a thousandth ends the iterations: its square is left
    for number, arm in enumerate(ROTOR, start=1):
        turned = np.array([Rotation.from_rotvec(each * k * AXIS).apply(arm) for k in steps])
        np.testing.assert_allclose(vectors(result, "U", number), turned - arm, atol=1e-7)
        np.testing.assert_allclose(vectors(result, "V", number), SPIN * np.cross(AXIS, turned), atol=1e-5)
        # towards the axis from the start on
        np.testing.assert_allclose(vectors(result, "A", number), -(SPIN**2) * turned, atol=1e-3)
    energy = 0.5 * MASS * SPIN**2 * sum(arm @ arm for arm in ROTOR)
    np.testing.assert_allclose(result.history["ETOTAL"], energy, rtol=1e-6)
    said = " ".join(result.file(".msg").read_text().split())
    assert "INITIAL VELOCITIES OF NODES THAT FOLLOW OTHERS BY CONSTRAINTS ARE NOT THEIRS AND ARE REPLACED" in said


def test_pendulum(turn):
    """It falls from rest at 90 degrees and is below its axis after a quarter of its period, 4 sqrt(l/g) K(sin^2 45).

    (L. Landau, E. Lifshitz, Mechanics, section 11.) Errors of the angle and of the energy fall with the square of the
    increment.
    """
    quarter = np.sqrt(LENGTH / GRAVITY) * ellipk(0.5)
    errors = []
    for count in (20, 40, 80):
        loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
        result = turn([[LENGTH, 0.0, 0.0]], quarter / count, count, loads=loads)
        u = vectors(result, "U", 1)[-1]
        np.testing.assert_allclose(np.linalg.norm(u + np.array([LENGTH, 0.0, 0.0])), LENGTH, rtol=1e-12)
        errors.append((u[0] + LENGTH, np.abs(result.history["ETOTAL"]).max()))
    errors = np.abs(errors)
    assert errors[-1, 0] < 1e-3 * LENGTH
    assert errors[-1, 1] < 1e-3 * MASS * GRAVITY * LENGTH
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4, rtol=0.2)


def test_initial_accelerations_of_a_body_that_turns(turn):
    """Weight alone turns a pendulum at 90 degrees that is at rest: a = -g, and with NLGEOM nothing towards the axis."""
    loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
    result = turn([[LENGTH, 0.0, 0.0]], 1e-6, 1, loads=loads)
    np.testing.assert_allclose(vectors(result, "A", 1)[0], [0.0, -GRAVITY, 0.0], atol=1e-4)


def test_backward_euler_damps_a_pendulum(turn):
    """Backward Euler takes energy from a pendulum that swings, and never gives it any: it hangs nearly still."""
    loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
    result = turn([[LENGTH, 0.0, 0.0]], 0.1, 200, loads=loads, how="APPLICATION=QUASI-STATIC")
    energy = result.history["ETOTAL"]
    assert energy[-1] < -0.2 * MASS * GRAVITY * LENGTH
    assert np.diff(energy).max() < 1e-2 * MASS * GRAVITY * LENGTH


def test_damping_of_a_pendulum(turn):
    """Its swings lose energy by alpha, one after the other, about half of it in ten."""
    loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
    result = turn([[LENGTH, 0.0, 0.0]], 0.1, 200, loads=loads, how="ALPHA=-0.2")
    swings = result.history["ETOTAL"].reshape(8, 25).max(axis=1)
    assert np.diff(swings).max() < 0.0
    assert -0.6 < swings[-1] / (MASS * GRAVITY * LENGTH) < -0.2


BODY = """*NODE
{nodes}
*NSET, NSET=ENDS
{ends}
*NODE, NSET=AXIS
90, {reference}
*ELEMENT, TYPE={type}, ELSET=SOLID
{element}
*SOLID SECTION, ELSET=SOLID, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
{modulus}, 0.3
*DENSITY
{density}
{constraint}
{boundary}
*INITIAL CONDITIONS, TYPE=VELOCITY
{velocities}
*STEP, NLGEOM, INC=10000
*DYNAMIC, {control}, {how}
{size}, {end}
{loads}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=AXIS
UR, VR
*ENERGY OUTPUT
ETOTAL, ALLKE, ALLWK, ALLIE
*END STEP
"""
CORNERS = np.array([[i, j, k] for k in (-0.5, 0.5) for i, j in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))])
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
MIDDLES = np.array([CORNERS[list(edge)].mean(axis=0) for edge in EDGES])
SOLIDS = {"C3D8": CORNERS, "C3D20": np.vstack([CORNERS, MIDDLES])}
HOW = ["ALPHA=-0.05", "ALPHA=-0.2", "APPLICATION=MODERATE DISSIPATION"]
"""The default is the first."""


@pytest.fixture
def spin(run_deck):
    """Run a block of side 1, or with the given sides, whose nodes follow, from a spin about its centre or a point."""

    def spin(
        velocity, size, end, *, constraint="rigid body", kind="C3D8", sides=1.0, reference=(0.0,) * 3, about=0.0, **has
    ):
        places, velocity = np.asarray(sides) * SOLIDS[kind], np.asarray(velocity)
        numbers = list(range(1, len(places) + 1))
        moving = [*zip(numbers, places, strict=True), (90, np.array(reference))]
        initial = [
            (k, axis, one) for k, x in moving for axis, one in enumerate(np.cross(velocity, x - about).tolist(), 1)
        ]
        initial += [(90, axis, one) for axis, one in enumerate(velocity.tolist(), start=4)]
        values = {
            "nodes": "\n".join(f"{k}, {', '.join(map(repr, x.tolist()))}" for k, x in moving[:-1]),
            "ends": "\n".join(map(str, numbers)),
            "reference": ", ".join(map(repr, reference)),
            "element": "1, " + ",\n".join(", ".join(map(str, part)) for part in (numbers[:8], numbers[8:]) if part),
            "constraint": CONSTRAINTS[constraint].replace("9", "90"),
            "velocities": "\n".join(f"{k}, {axis}, {one!r}" for k, axis, one in initial),
        }
        values |= {
            "type": kind,
            "density": 1.0,
            "modulus": 1000.0,
            "how": HOW[0],
            "size": size,
            "end": end,
            "loads": "",
        }
        values |= {"control": "DIRECT, NOHAF", "boundary": ""}
        return run_deck(BODY.format(**(values | has)).replace("\n\n", "\n")).history

    return spin


def inertia(sides):
    """Principal moments of inertia of masses of 1/8 of the volume in the corners, of density 1."""
    squares = (0.5 * np.asarray(sides)) ** 2
    return np.prod(sides) * (squares.sum() - squares)


@pytest.mark.parametrize("how", HOW)
@pytest.mark.parametrize("constraint", ["rigid body", "beams", "kinematic coupling"])
def test_free_spin_keeps_its_energy(spin, constraint, how):
    """Errors fall with the square of the increment or faster, and loads and strains have no part in the balance."""
    energy, errors = 0.5 * inertia([1.0, 1.0, 1.0])[2] * SPIN**2, []
    for size in (0.1, 0.05, 0.025):
        history = spin([0.0, 0.0, SPIN], size, 1.0, constraint=constraint, how=how)
        errors.append(np.abs(history["ALLKE"] - energy).max() / energy)
        np.testing.assert_allclose(history["ETOTAL"], history["ALLKE"], rtol=1e-12)
        np.testing.assert_allclose(history["ALLWK"], 0.0, atol=1e-12 * energy)
    assert errors[1] < 0.01
    assert errors[0] / errors[1] > 3.4
    assert errors[1] / errors[2] > 3.6


def test_spin_without_damping_keeps_its_energy(spin):
    """For five turns: ALPHA=0 leaves what the iterations leave, the square of a correction below a thousandth."""
    history = spin([0.0, 0.0, SPIN], 0.05, 10.0, how="ALPHA=0.")
    np.testing.assert_allclose(history["ALLKE"], 0.5 * inertia([1.0, 1.0, 1.0])[2] * SPIN**2, rtol=1e-6)


def test_long_spin_is_stable(spin):
    """Ten turns with the default integrator."""
    energy = 0.5 * inertia([1.0, 1.0, 1.0])[2] * SPIN**2
    history = spin([0.0, 0.0, SPIN], 0.05, 20.0)
    np.testing.assert_allclose(history["ALLKE"], energy, rtol=0.02)
    np.testing.assert_allclose(history["VR3[AXIS]"], SPIN, rtol=0.02)
    assert np.diff(history["ALLKE"])[40:].max() < 1e-6 * energy


@pytest.mark.parametrize("reference", [(0.0, 0.0, 0.0), (0.5, 1.0, 1.5)])
def test_body_that_tumbles(spin, reference):
    """About its middle axis, where it does not stay, whatever its reference node."""
    sides, velocity, errors = [1.0, 2.0, 3.0], np.array([0.3, 2.0, 0.1]), []
    energy = 0.5 * inertia(sides) @ velocity**2
    for size in (0.05, 0.025, 0.0125):
        history = spin(velocity, size, 2.0, constraint="kinematic coupling", sides=sides, reference=reference)
        errors.append(np.abs(history["ALLKE"] - energy).max() / energy)
    np.testing.assert_allclose(np.array(errors[:-1]) / errors[1:], 4.0, rtol=0.2)


def test_consistent_masses_that_turn(spin):
    """Those of quadratic elements: the moment of inertia of a cube of side and mass 1 is 1/6."""
    energy = 0.5 * SPIN**2 / 6.0
    errors = [np.abs(spin([0.0, 0.0, SPIN], size, 2.0, kind="C3D20")["ALLKE"] - energy).max() for size in (0.05, 0.025)]
    assert errors[0] < 0.01 * energy
    assert errors[0] / errors[1] > 3.6


def test_moment_turns_a_body(spin):
    """A moment M gives it the angle M t^2/(2 J), and all of its work M times the angle is kinetic energy.

    The errors are those of chords for arcs, with any ALPHA.
    """
    moment, inertia_about = 2.0, inertia([1.0, 1.0, 1.0])[2]
    errors = []
    for size in (0.05, 0.025):
        history = spin([0.0, 0.0, 1e-12], size, 2.0, loads=f"*CLOAD\n90, 6, {moment}")
        angle = 0.5 * moment / inertia_about * 2.0**2
        np.testing.assert_allclose(history["ALLWK"], moment * history["UR3[AXIS]"], rtol=1e-9)
        errors.append([history["UR3[AXIS]"][-1] / angle - 1.0, np.abs(history["ETOTAL"]).max() / (moment * angle)])
    errors = np.abs(errors)
    assert errors.max() < 0.05
    assert (errors[0] / errors[1]).min() > 3.4


def test_elastic_body_on_a_turning_face(spin):
    """One face follows, so that the other four nodes swing; stiff, it keeps its energy as one that follows whole."""
    places = {"ends": "1\n2\n3\n4", "modulus": 1e5}
    energy = 0.5 * inertia([1.0, 1.0, 1.0])[2] * SPIN**2
    errors = []
    for size in (0.05, 0.025):
        history = spin([0.0, 0.0, SPIN], size, 2.0, constraint="kinematic coupling", **places)
        np.testing.assert_allclose(history["ALLWK"], 0.0, atol=1e-12 * energy)
        errors.append(np.abs(history["ETOTAL"][-1] - energy) / energy)
    assert errors[0] < 0.01
    assert errors[0] / errors[1] > 3.4


def test_half_increment_residual_of_a_body_that_turns(spin):
    """Nothing is out of balance in a free spin, so that increments stay as large as they may be.

    Of the centripetal forces in the directions of another time the part J omega^2 sin(alpha omega h), 0.034, would be.
    """
    history = spin([0.0, 0.0, SPIN], 0.05, "1., 1e-6, 0.05", control="HAFTOL=2e-3")
    assert len(history["time"]) == 20


def test_pinned_body_keeps_its_energy(spin):
    """A corner does not move, so that the displacements of the reference node follow from its rotations."""
    centre = np.array([0.5, 0.5, 0.5])
    about = np.diag(inertia([1.0, 1.0, 1.0])) + centre @ centre * np.eye(3) - np.outer(centre, centre)
    energy, errors = 0.5 * SPIN**2 * about[2, 2], []
    for size in (0.1, 0.05, 0.025):
        pinned = {"boundary": "*BOUNDARY\n1, 1, 3", "about": CORNERS[0], "reference": (0.0, 0.0, 0.5)}
        history = spin([0.0, 0.0, SPIN], size, 2.0, **pinned)
        errors.append(np.abs(history["ALLKE"] - energy).max() / energy)
        np.testing.assert_allclose(history["ALLWK"], 0.0, atol=1e-12 * energy)
    assert errors[1] < 0.01
    np.testing.assert_allclose(np.array(errors[:-1]) / errors[1:], 4.0, rtol=0.2)


@pytest.mark.parametrize("how", ["ALPHA=-0.05", "ALPHA=0."])
def test_body_that_is_turned_at_a_constant_rate(spin, how):
    """It takes no moment, and no work: those of chords for arcs fall with the square of the increment."""
    energy, errors = 0.5 * inertia([1.0, 1.0, 1.0])[2] * SPIN**2, []
    held = f"*AMPLITUDE, NAME=TURN\n0., 0., 2., {2 * SPIN}\n*BOUNDARY\n90, 1, 5"
    for size in (0.05, 0.025):
        turned = {"loads": "*BOUNDARY, AMPLITUDE=TURN\n90, 6, 6, 1.", "boundary": held}
        history = spin([0.0, 0.0, SPIN], size, 2.0, how=how, **turned)
        errors.append(
            [np.abs(history[name] - one).max() / energy for name, one in (("ETOTAL", energy), ("ALLWK", 0.0))]
        )
    errors = np.array(errors)
    assert errors[0].max() < 0.02
    assert (errors[0] / errors[1]).min() > 3.4
