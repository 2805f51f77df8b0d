# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in elements that turn inside out in an iteration: the attempt is given up, as in Abaqus."""

from types import SimpleNamespace

import numpy as np
import pytest

from uel.elements.array_mistakes import distortion
from uel.errors import ConvergenceError, KernelError

YOUNG, PRESSURE = 1000.0, 1500.0
"""A first solve shortens the element by 1.5 of its length."""
PLANE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
CUBE = np.array([[*x, z] for z in (0.0, 1.0) for x in PLANE])


def deck(element_type, nodes, *, options=", NLGEOM", order=1):
    """An element of side 1 with its sides held, whose right side is pushed and stays straight; nu = 0."""
    dimension = nodes.shape[1]
    lines = ["*NODE, NSET=ALL"]
    lines += [", ".join([str(k), *map(str, x)]) for k, x in enumerate(nodes, start=1)]
    numbers = range(1, len(nodes) + 1)[::order]
    lines += [f"*ELEMENT, TYPE={element_type}, ELSET=BODY", ", ".join(map(str, [101, *numbers]))]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, 0."]
    right = [k for k, x in enumerate(nodes, start=1) if x[0] == 1.0]
    lines += [f"*EQUATION\n2\n{k}, 1, 1., {right[0]}, 1, -1." for k in right[1:]]
    lines += [f"*STEP{options}", "*STATIC", "1., 1.", "*BOUNDARY", f"ALL, 2, {dimension}"]
    lines += [f"{k}, 1" for k, x in enumerate(nodes, start=1) if x[0] == 0.0]
    lines += ["*CLOAD", f"{right[0]}, 1, {-PRESSURE}"]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U", "*END STEP", ""]
    return "\n".join(lines)


@pytest.mark.parametrize(("element_type", "nodes"), [("CPE4", PLANE), ("CPS4R", PLANE), ("C3D8", CUBE)])
def test_an_attempt_in_which_an_element_turns_inside_out_is_made_again(run_deck, tmp_path, element_type, nodes):
    """With a quarter of the increment (D_H), to the end, where the logarithm of the length is -p/E."""
    result = run_deck(deck(element_type, nodes))
    first, second = result.status[:2]
    assert (first.attempt, first.cutback, second.attempt) == (1, True, 2)
    message = " ".join((tmp_path / "deck.msg").read_text().split())
    place = rf"element 101 (type {element_type}): turns inside out at its integration point"
    assert f"***WARNING: EXCESSIVE DISTORTION IN SOLID (CONTINUUM) ELEMENTS: {place}" in message
    assert "***NOTE: ELEMENTS ARE DISTORTING EXCESSIVELY. CONVERGENCE IS JUDGED UNLIKELY." in message
    assert "ATTEMPT NUMBER 2, TIME INCREMENT 0.250" in message
    length = 1 + result.history["U1[ALL:2]"][-1]
    assert np.log(length) == pytest.approx(-PRESSURE / YOUNG, rel=0.02)


def test_a_fixed_increment_ends_with_the_element(run_deck):
    text = deck("CPE4", PLANE).replace("*STATIC", "*STATIC, DIRECT")
    message = (
        r"FIXED TIME INCREMENT IS TOO LARGE \(step 1, increment 1, attempt 1\): "
        r"element 101 \(type CPE4\): turns inside out at its integration point \d \(step 1, increment 1, iteration \d"
    )
    with pytest.raises(ConvergenceError, match=message):
        run_deck(text)


def thrown(dynamic):
    """The same element, free of forces, whose right side moves with a speed of -4: a mass of 10 on a spring of 1000.

    An increment of 1 ends at -0.14, for it damps a period of 0.6; the middle of the cubic between its ends is at -1.5.
    """
    velocity = "*INITIAL CONDITIONS, TYPE=VELOCITY\n2, 1, -4.\n3, 1, -4.\n*STEP"
    text = deck("CPE4", PLANE).replace("*STEP", velocity).replace("*STATIC\n1., 1.", f"*DYNAMIC, {dynamic}")
    return text.replace("*ELASTIC", "*DENSITY\n20.\n*ELASTIC").replace(f"*CLOAD\n2, 1, {-PRESSURE}\n", "")


def test_an_element_that_turns_inside_out_in_the_middle_of_an_increment_cuts_it_back(run_deck, tmp_path):
    """The pass for the half-increment residual fails; the smaller increment goes on as if it were the first."""
    result = run_deck(thrown("HAFTOL=1E9\n1., 2., , 1."))
    first, second = result.status[:2]
    assert (first.attempt, first.cutback, second.attempt, second.time_increment) == (1, True, 2, 0.25)
    message = " ".join((tmp_path / "deck.msg").read_text().split())
    assert "***WARNING: EXCESSIVE DISTORTION IN SOLID (CONTINUUM) ELEMENTS: element 101 (type CPE4): turns" in message
    assert first.iterations == message.split("ATTEMPT NUMBER 2")[0].count("CONVERGENCE CHECKS FOR")
    alike = run_deck(thrown("HAFTOL=1E9\n0.25, 2., , 1."))
    np.testing.assert_array_equal(result.history["U1[ALL:2]"], alike.history["U1[ALL:2]"])


def test_fixed_increments_do_not_depend_on_the_state_in_their_middle(run_deck):
    """Their half-increment residual decides nothing, so it need not exist."""
    fixed = run_deck(thrown("DIRECT, HAFTOL=1E9\n1., 2."))
    unmeasured = run_deck(thrown("DIRECT, NOHAF\n1., 2."))
    np.testing.assert_array_equal(fixed.history["U1[ALL:2]"], unmeasured.history["U1[ALL:2]"])


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
def test_a_mesh_that_is_inside_out_stays_an_error_of_the_mesh(run_deck, options):
    with pytest.raises(KernelError, match=r"element 101 .* nodes must run counter-clockwise"):
        run_deck(deck("CPE4", PLANE, options=options, order=-1))


def test_a_point_that_the_element_does_not_have_is_not_named():
    """C3D8R has one point; its volume, by which it is inside out, comes from eight."""
    assert distortion(SimpleNamespace(item=7), 1) == "turns inside out"
    assert distortion(SimpleNamespace(item=7), 8) == "turns inside out at its integration point 7"
    assert distortion(SimpleNamespace(item=-1), 1) == "crosses the axis at its integration point 1"
