# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*BOUNDARY, USER: DISP gives the displacements of a square; its arguments come back in what it gives."""

import numpy as np
import pytest

from uel.errors import DeckError, UelError

NODES = np.array([[0, 0], [2, 0], [2, 1], [0, 1.0]])
DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=BODY
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=BODY, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*STEP
*STATIC, DIRECT
0.25, 0.5
*BOUNDARY, USER
ALL, 1, 2, {magnitude}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, RF
*END STEP
{more}"""
SECOND = """*STEP
*STATIC, DIRECT
1., 1.
{boundary}
*END STEP
"""
DISP = """      SUBROUTINE DISP(U,KSTEP,KINC,TIME,NODE,NOEL,JDOF,COORDS)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION U(3),TIME(3),COORDS(3)
%s
      END
"""
STRETCH = "      U(1) = U(1) + 0.01*TIME(1)*JDOF*COORDS(JDOF)"
ORIGINAL = """      X = 0
      IF (JDOF .EQ. 1 .AND. (NODE .EQ. 2 .OR. NODE .EQ. 3)) X = 2
      IF (JDOF .EQ. 2 .AND. NODE .GE. 3) X = 1"""
ARGUMENTS = "      U(1) = NODE + 0.1*JDOF + 10*KINC + 100*KSTEP + 1000*TIME(1)\n     1  + 10000*TIME(2)"


@pytest.fixture
def run_square(run_deck):
    def run_square(body, magnitude="0.", more="", user=DISP):
        return run_deck(DECK.format(magnitude=magnitude, more=more), user.replace("%s", body)).history

    return run_square


def displacements(history, row=-1):
    return np.array([[history[f"U{dof}[ALL:{k}]"][row] for dof in (1, 2)] for k in range(1, 5)])


def test_displacements_are_those_of_disp(run_square):
    """Uniform strains 0.01 t and 0.02 t: stresses 10 t and 20 t on the sides of lengths 1 and 2."""
    history = run_square(STRETCH)
    np.testing.assert_allclose(displacements(history, 0), 0.01 * 0.25 * NODES * [1, 2], atol=1e-15)
    np.testing.assert_allclose(displacements(history), 0.01 * 0.5 * NODES * [1, 2], atol=1e-15)
    assert history["RF1[ALL:2]"][-1] + history["RF1[ALL:3]"][-1] == pytest.approx(10 * 0.5 * 1)
    assert history["RF2[ALL:3]"][-1] + history["RF2[ALL:4]"][-1] == pytest.approx(20 * 0.5 * 2)


def test_disp_starts_from_the_magnitude(run_square):
    """It ramps to 3 in two increments."""
    history = run_square(STRETCH, magnitude="3.")
    np.testing.assert_allclose(displacements(history, 0), 1.5 + 0.01 * 0.25 * NODES * [1, 2])


def test_arguments(run_square):
    history = run_square(ARGUMENTS, more=SECOND.format(boundary="*BOUNDARY\n4, 1, 2, 7."))
    labels, dofs = np.arange(1, 5)[:, None], np.array([1, 2])
    second = labels + 0.1 * dofs + 20 + 100 + 1000 * 0.5 + 10000 * 0.5
    np.testing.assert_allclose(displacements(history, 1), second)
    # they go on in the next step, but for the node that has a value of its own there
    third = labels + 0.1 * dofs + 10 + 200 + 1000 * 1 + 10000 * 1.5
    third[3] = 7.0
    np.testing.assert_allclose(displacements(history, 2), third)


def test_time_increment(run_square):
    """TIME(3) is the time increment (Abaqus User Subroutines Guide, DISP): which is 0.25 and then 1."""
    history = run_square("      U(1) = TIME(3)", more=SECOND.format(boundary="**"))
    np.testing.assert_allclose(displacements(history, 1), 0.25)
    np.testing.assert_allclose(displacements(history, 2), 1.0)


def test_coordinates_with_nlgeom(run_square, monkeypatch):
    """Those at the start of the increment: twice a stretch by 1.1 gives 1.21."""
    monkeypatch.setattr(f"{__name__}.DECK", DECK.replace("*STEP", "*STEP, NLGEOM", 1))
    history = run_square(f"{ORIGINAL}\n      U(1) = 1.1D0*COORDS(JDOF) - X")
    np.testing.assert_allclose(displacements(history, 0), 0.1 * NODES)
    np.testing.assert_allclose(displacements(history), 0.21 * NODES)


def test_disp_may_end_the_analysis(run_square):
    with pytest.raises(UelError, match=r"DISP stopped the analysis.* \(node 3, dof 2, step 1\)"):
        run_square("      IF (NODE .EQ. 3 .AND. JDOF .EQ. 2) CALL XIT")


@pytest.mark.parametrize(
    ("boundary", "message"),
    [
        ("*BOUNDARY, USER, TYPE=VELOCITY\nALL, 1, 2, 0.", r"deck.inp:\d+: \*BOUNDARY: USER is supported for displ"),
        ("*BOUNDARY, SUBMODEL\nALL, 1, 2", "option SUBMODEL is not supported"),
    ],
)
def test_what_is_not_supported_is_named(run_square, boundary, message):
    with pytest.raises(DeckError, match=message):
        run_square(STRETCH, more=SECOND.format(boundary=boundary))


def test_values_of_disp_need_disp(run_square):
    with pytest.raises(DeckError, match=r"deck.inp:\d+: \*BOUNDARY, USER needs DISP, which the job does not have"):
        run_square("", user="      SUBROUTINE OTHER\n      END\n")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "*STEP\n",
            "*BOUNDARY, USER\n1, 1\n*STEP\n",
            r"USER before the first \*STEP, where only zero can be prescribed",
        ),
        ("*STATIC, DIRECT", "*STATIC, RIKS", r"deck.inp:13: DISP has no meaning in a step whose load"),
    ],
)
def test_values_of_disp_need_a_step_and_a_known_load_factor(run_square, monkeypatch, old, new, message):
    monkeypatch.setattr(f"{__name__}.DECK", DECK.replace(old, new, 1))
    with pytest.raises(DeckError, match=message):
        run_square(STRETCH)
