# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear steps about a base state that has turned as a rigid body: all they find is that of the unturned one, and turns
with it.
"""

import numpy as np
import pytest

from uel.elements import rotation_matrices
from uel.errors import DeckError
from uel.model.element_types import SHELL

AXIS = np.array([1.0, 2.0, -2.0]) / 3
UNKNOWNS = ("U1", "U2", "U3", "UR1", "UR2", "UR3")
TURNED = 1e-6
"""Relative: the turn ends with four increments at rest, whose iterations leave little of the stress that the tolerances
of earlier ones do."""


def quadrilateral(a):
    """Places of its corners."""
    return [(a, 0.0), (a + 1, 0.0), (a + 1, 1.0), (a, 1.0)]


def strip(kind, angle, step, more=""):
    """A strip of two by one, or a line of two beams, held at node 1, which turns without stress; then a linear step."""
    columns = [0.0, 0.5, 1.0, 1.5, 2.0] if kind in ("S8R", "B32") else [0.0, 1.0, 2.0]
    numbers = {}
    for a in columns:
        for b in (0.0, 1.0) if kind.startswith("S") else (0.0,):
            numbers[a, b] = len(numbers) + 1
    if kind == "S8R":
        for a in (0.0, 1.0, 2.0):
            numbers[a, 0.5] = len(numbers) + 1
    nodes = "".join(f"{number}, {a}, {b}, 0.\n" for (a, b), number in numbers.items())
    cells = []
    for a in (0.0, 1.0):
        places = {
            "S3R": [[(a, 0.0), (a + 1, 0.0), (a + 1, 1.0)], [(a, 0.0), (a + 1, 1.0), (a, 1.0)]],
            "S8R": [[*quadrilateral(a), (a + 0.5, 0.0), (a + 1, 0.5), (a + 0.5, 1.0), (a, 0.5)]],
            "B31": [[(a, 0.0), (a + 1, 0.0)]],
            "B32": [[(a, 0.0), (a + 0.5, 0.0), (a + 1, 0.0)]],
        }
        cells += places.get("S3R" if kind == "S3" else kind, [quadrilateral(a)])
    elements = "".join(
        f"{label}, {', '.join(str(numbers[place]) for place in cell)}\n" for label, cell in enumerate(cells, start=1)
    )
    section = "*SHELL SECTION, ELSET=E, MATERIAL=M\n0.1"
    if kind.startswith("B"):
        section = "*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=CIRC, ROTARY INERTIA=ISOTROPIC\n0.1\n0., 1., 0."
    turns = "\n".join(f"1, {dof}, {dof}, {angle * part!r}" for dof, part in zip((4, 5, 6), AXIS.tolist(), strict=True))
    return f"""*NODE, NSET=ALL
{nodes}*ELEMENT, TYPE={kind}, ELSET=E
{elements}{section}
*MATERIAL, NAME=M
*ELASTIC
1000., 0.25
*DENSITY
2.
*AMPLITUDE, NAME=TURN
0., 0., 0.6, 1., 1., 1.
*NSET, NSET=P
{numbers[2.0, 0.0]}
*BOUNDARY
1, 1, 6
{more}*STEP, NLGEOM
*STATIC
0.1, 1., 1e-5, 0.1
*BOUNDARY, AMPLITUDE=TURN
{turns}
*END STEP
{step.replace("TIP", "P")}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=P
U
*ENERGY OUTPUT
ALLSE
*END STEP
"""


def loads(angle, *, force, moment):
    """Data lines of *CLOAD with a force and a moment that have turned by the angle."""
    turn = rotation_matrices(angle * AXIS[None])[0]
    values = np.concatenate([turn @ force, turn @ moment]).tolist()
    return "\n".join(f"TIP, {dof}, {value!r}" for dof, value in enumerate(values, start=1))


@pytest.fixture
def histories(run_deck):
    def histories(text):
        result = run_deck(text)
        assert result.completed
        return {name.split("[")[0]: np.array(values) for name, values in result.history.items()}

    return histories


KINDS = (*SHELL, "B31", "B32")
ANGLES = (0.1, 0.3, 1.0, 3.0)
each = pytest.mark.parametrize("kind", KINDS)


@pytest.mark.sample(6)
@each
@pytest.mark.parametrize("angle", ANGLES)
def test_frequencies(histories, kind, angle):
    """A body that turns without stress keeps its natural frequencies."""
    still, turned = (histories(strip(kind, at, "*STEP\n*FREQUENCY\n6"))["EIGFREQ"][-6:] for at in (0.0, angle))
    np.testing.assert_allclose(turned, still, rtol=TURNED)


@pytest.mark.sample(6)
@each
@pytest.mark.parametrize("angle", ANGLES)
def test_buckling(histories, kind, angle):
    """So it does its buckling loads, if the loads turn along."""

    def factors(at):
        given = loads(at, force=[-1e-3, 0.0, 0.0], moment=[0.0, 0.0, 0.0])
        return histories(strip(kind, at, f"*STEP\n*BUCKLE\n2\n*CLOAD\n{given}"))["EIGVAL"][-2:]

    np.testing.assert_allclose(factors(angle), factors(0.0), rtol=TURNED)


@pytest.mark.sample(6)
@each
@pytest.mark.parametrize(("procedure", "angle"), [("STATIC", 1.0), ("STEADY", 2.0)])
def test_response(histories, kind, procedure, angle):
    """Displacements and small rotations turn with the body, and their energy stays."""
    lines = {
        "STATIC": "*STEP, PERTURBATION\n*STATIC\n*CLOAD",
        "STEADY": "*STEP\n*STEADY STATE DYNAMICS, DIRECT\n0.01\n*CLOAD",
    }[procedure]

    def found(at):
        given = loads(at, force=[1e-4, 2e-4, 3e-4], moment=[2e-4, 3e-4, 1e-4])
        history = histories(strip(kind, at, f"{lines}\n{given}"))
        phases = {name: history.get(f"P{name}", np.zeros(1))[-1] for name in UNKNOWNS}
        values = np.array([history[name][-1] * np.cos(np.radians(phase)) for name, phase in phases.items()])
        return values.reshape(2, 3), history["ALLSE"][-1]

    (still, energy), (turned, energy_turned) = found(0.0), found(angle)
    turn = rotation_matrices(angle * AXIS[None])[0]
    np.testing.assert_allclose(turned, still @ turn.T, rtol=0, atol=TURNED * np.abs(still).max())
    if procedure == "STATIC":
        assert energy_turned == pytest.approx(energy, rel=TURNED)


def test_a_spring_on_one_rotation_of_a_node_that_has_turned(histories):
    """Its moment is about one axis and its rotation no spin about it: the matrix would lack places for the others."""
    spring = "*ELEMENT, TYPE=SPRING2, ELSET=S\n9, 2, 99\n*SPRING, ELSET=S\n4, 4\n1.\n"
    text = strip("B31", 0.3, "*STEP\n*FREQUENCY\n2", spring).replace(
        "*ELEMENT, TYPE=B31", "99, 9., 9., 9.\n*ELEMENT, TYPE=B31"
    )
    message = r"an element acts on rotations of node 2, which has turned, but not on dof [56]; expected"
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: \*FREQUENCY: {message}"):
        histories(text)
