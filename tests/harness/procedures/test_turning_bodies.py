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

import harness

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
def run(tmp_path):
    def run(places, size, count, *, loads="", velocities="", boundary="", how="ALPHA=0.", constraint="coupling"):
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
        (tmp_path / "turn.inp").write_text(text.replace("\n\n", "\n"))
        result = harness.run(tmp_path / "turn.inp", output_dir=tmp_path)
        result.message = (tmp_path / "turn.msg").read_text()
        return result

    return run


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
def test_rotor(run, constraint):
    """About a skew axis that is held, given by the velocity of the reference node alone: two turns."""
    velocities = "\n".join(f"9, {k}, {SPIN * one!r}" for k, one in enumerate(AXIS.tolist(), start=4))
    result = run(ROTOR, SIZE, COUNT, velocities=velocities, constraint=constraint)
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
    said = " ".join(result.message.split())
    assert "INITIAL VELOCITIES OF NODES THAT FOLLOW OTHERS BY CONSTRAINTS ARE NOT THEIRS AND ARE REPLACED" in said


def test_pendulum(run):
    """It falls from rest at 90 degrees and is below its axis after a quarter of its period, 4 sqrt(l/g) K(sin^2 45).

    (L. Landau, E. Lifshitz, Mechanics, section 11.) Errors of the angle and of the energy fall with the square of the
    increment.
    """
    quarter = np.sqrt(LENGTH / GRAVITY) * ellipk(0.5)
    errors = []
    for count in (20, 40, 80):
        loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
        result = run([[LENGTH, 0.0, 0.0]], quarter / count, count, loads=loads)
        u = vectors(result, "U", 1)[-1]
        np.testing.assert_allclose(np.linalg.norm(u + np.array([LENGTH, 0.0, 0.0])), LENGTH, rtol=1e-12)
        errors.append((u[0] + LENGTH, np.abs(result.history["ETOTAL"]).max()))
    errors = np.abs(errors)
    assert errors[-1, 0] < 1e-3 * LENGTH
    assert errors[-1, 1] < 1e-3 * MASS * GRAVITY * LENGTH
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4, rtol=0.2)


def test_initial_accelerations_of_a_body_that_turns(run):
    """Weight alone turns a pendulum at 90 degrees that is at rest: a = -g, and with NLGEOM nothing towards the axis."""
    loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
    result = run([[LENGTH, 0.0, 0.0]], 1e-6, 1, loads=loads)
    np.testing.assert_allclose(vectors(result, "A", 1)[0], [0.0, -GRAVITY, 0.0], atol=1e-4)


@pytest.mark.parametrize("how", ["ALPHA=-0.2", "APPLICATION=QUASI-STATIC"])
def test_damping_integrators(run, how):
    """They take energy from a pendulum that swings, and never give it any: it comes to hang still, or nearly so."""
    loads = f"*CLOAD, AMPLITUDE=NOW\n1, 2, {-MASS * GRAVITY}"
    result = run([[LENGTH, 0.0, 0.0]], 0.1, 200, loads=loads, how=how)
    energy = result.history["ETOTAL"]
    assert energy[-1] < -0.2 * MASS * GRAVITY * LENGTH
    assert np.diff(energy).max() < 1e-2 * MASS * GRAVITY * LENGTH
