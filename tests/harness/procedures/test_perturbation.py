# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STATIC in a step with PERTURBATION: a user spring that stiffens, f = 2 u + u^3, and a square."""

from pathlib import Path

import numpy as np
import pytest

from uel.check.recording import Pass, record
from uel.errors import DeckError

SPRING = """*NODE, NSET=ALL
1, 0.
2, 1.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, VARIABLES=1
1
*ELEMENT, TYPE=U1, ELSET=E
1, 1, 2
*UEL PROPERTY, ELSET=E
*BOUNDARY
1, 1
"""
UEL = f"""      INCLUDE '{Path(__file__).parents[1] / "uel.inc"}'
      IF (LFLAGS(4) .EQ. 1) THEN
        WRITE(7,'(A,5I4,2F8.4)') 'FLAGS', LFLAGS(1:5), U(2), DU(2,1)
      END IF
      E = U(2) - U(1)
      S = 2 + 3*E**2
      AMATRX = -S
      AMATRX(1,1) = S
      AMATRX(2,2) = S
      F = 2*E + E**3
      IF (LFLAGS(4) .EQ. 1) F = S*(DU(2,1) - DU(1,1))
      RHS(1,1) = F
      RHS(2,1) = -F
      SVARS(1) = E
      END
"""
CLOSE = 1e-4
"""Where Newton's method stops in the general steps."""

PULL = "*STEP, INC=50\n*STATIC\n1., 1.\n*CLOAD\n2, 1, 3.\n{}*END STEP\n"
LINEAR = "*STEP{}, PERTURBATION\n*STATIC\n{}\n*END STEP\n"
OUTPUT = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU, RF, CF\n"


@pytest.fixture
def run_springs(run_deck):
    def run_springs(*parts, user=UEL):
        return run_deck("".join(parts), user)

    return run_springs


def test_about_a_base_state(run_springs):
    """f = 3 at u = 1, where the stiffness is 5; the next general step goes on from there to f = 12 at u = 2."""
    more = PULL.format("").replace("2, 1, 3.", "2, 1, 12.")
    result = run_springs(SPRING, PULL.format(OUTPUT), LINEAR.format("", "*CLOAD\n2, 1, 0.5"), more)
    history = result.history
    rows = [np.flatnonzero(history["step"] == number)[-1] for number in (1, 2, 3)]
    np.testing.assert_allclose(history["U1[ALL:2]"][rows], [1, 0.1, 2], rtol=CLOSE)
    np.testing.assert_allclose(history["CF1[ALL:2]"][rows], [3, 0.5, 12])
    np.testing.assert_allclose(history["RF1[ALL:1]"][rows], [-3, -0.5, -12], rtol=1e-2)
    np.testing.assert_allclose(history["time"][rows], [1, 1, 2])
    assert history["ALLSE"][rows[1]] == pytest.approx(0.5 * 0.5 * 0.1, rel=CLOSE)
    assert [(row.step, row.increment, row.iterations) for row in result.status if row.step == 2] == [(2, 1, 1)]
    lines = result.file(".msg").read_text().splitlines()
    flags = [line.split()[1:] for line in lines if line.startswith("FLAGS")]
    assert flags == [["1", "0", "1", "1", "0", "1.0000", "0.0000"], ["1", "0", "100", "1", "0", "1.0000", "0.1000"]]


def test_loads_on_user_elements(run_springs):
    """U1 pulls node 2 by 3 in the base state (ADLMAG) and by 0.5 more in the linear step (DDLMAG), where S = 5."""
    user = UEL.replace(
        "      SVARS(1) = E\n",
        "      PULL = ADLMAG(1,1)\n"
        "      IF (LFLAGS(4) .EQ. 1) PULL = DDLMAG(1,1)\n"
        "      IF (LFLAGS(4) .EQ. 1) WRITE(7,'(A,2F8.4)') 'LOAD', ADLMAG(1,1), DDLMAG(1,1)\n"
        "      RHS(2,1) = RHS(2,1) + PULL\n      SVARS(1) = E\n",
    )
    pull = PULL.format(OUTPUT).replace("*CLOAD\n2, 1, 3.", "*DLOAD\nE, U1, 3.")
    result = run_springs(SPRING, pull, LINEAR.format("", "*DLOAD\nE, U1, 0.5"), pull, user=user)
    history = result.history
    rows = [np.flatnonzero(history["step"] == number)[-1] for number in (1, 2, 3)]
    np.testing.assert_allclose(history["U1[ALL:2]"][rows], [1, 0.1, 1], rtol=CLOSE)
    np.testing.assert_allclose(history["RF1[ALL:1]"][rows], [-3, -0.5, -3], rtol=1e-2)
    lines = result.file(".msg").read_text().splitlines()
    assert {tuple(line.split()[1:]) for line in lines if line.startswith("LOAD")} == {("3.0000", "0.5000")}


def test_forces_of_the_base_state_are_taken_for_loads(run_springs):
    """An element that does not look at LFLAGS(4) returns -3 at node 2, which acts beside the load of 0.5: a warning."""
    user = UEL.replace("IF (LFLAGS(4) .EQ. 1) F = S*(DU(2,1) - DU(1,1))", "CONTINUE")
    result = run_springs(SPRING, PULL.format(OUTPUT), LINEAR.format("", "*CLOAD\n2, 1, 0.5"), user=user)
    assert result.history["U1[ALL:2]"][-1] == pytest.approx((0.5 - 3) / 5, rel=CLOSE)
    message = " ".join(result.file(".msg").read_text().split())
    assert "***WARNING: USER ELEMENTS RETURN FORCES OF THE BASE STATE IN RHS OF A LINEAR STEP" in message


def test_prescribed_values_are_changes(run_springs):
    history = run_springs(SPRING, PULL.format(OUTPUT), LINEAR.format("", "*BOUNDARY\n2, 1, 1, 0.2")).history
    assert history["U1[ALL:2]"][-1] == pytest.approx(0.2)
    assert history["RF1[ALL:2]"][-1] == pytest.approx(5 * 0.2, rel=CLOSE)


def test_disp_gives_changes(run_springs):
    """It adds 0.1 to the 0.2 of the deck."""
    disp = """      SUBROUTINE DISP(U,KSTEP,KINC,TIME,NODE,NOEL,JDOF,COORDS)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION U(3),TIME(3),COORDS(3)
      U(1) = U(1) + 0.1D0
      END
"""
    given = PULL.format(OUTPUT), LINEAR.format("", "*BOUNDARY, USER\n2, 1, 1, 0.2")
    assert run_springs(SPRING, *given, user=UEL + disp).history["U1[ALL:2]"][-1] == pytest.approx(0.3)
    with pytest.raises(DeckError, match=r"deck.inp:\d+: \*BOUNDARY, USER needs DISP, which the job does not have"):
        run_springs(SPRING, *given)


def test_checks_are_made_at_states_of_general_steps(run_springs, tmp_path):
    """In the linear step RHS is none of U, and AMATRX not its derivative."""
    run_springs(SPRING, PULL.format(OUTPUT), LINEAR.format("", "*CLOAD\n2, 1, 0.5"))
    recording = record(tmp_path / "deck.inp", [tmp_path / "user.f"], 2)
    passes = [event for event in recording.events if isinstance(event, Pass)]
    assert recording.increments == 2
    assert {event.call.step for event in passes} == {1, 2}
    assert {event.call.step for event in passes if event.normal} == {1}


SQUARE = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=BODY
1, 1, 2, 3, 4
*SURFACE, NAME=SIDE
BODY, S2
*SOLID SECTION, ELSET=BODY, MATERIAL=M
2.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.25
*BOUNDARY
1, 1, 2
4, 1
"""
FIELD = "*OUTPUT, FIELD\n" + OUTPUT.replace("HISTORY", "HISTORY, OP=ADD")


def test_stresses_are_changes(run_springs):
    """After 3 in the general step 7 along and 5 across in the first, the linear one."""
    pull = "*STEP\n*STATIC\n*DSLOAD\nSIDE, TRVEC, 3., 1.\n*END STEP\n"
    linear = LINEAR.format("", "*DSLOAD\nSIDE, TRVEC, 7., 1.\n*DLOAD\nBODY, P3, -5.\n" + FIELD)
    for before in ("", pull):
        result = run_springs(SQUARE, before, linear)
        np.testing.assert_allclose(result.field("S11"), 7, rtol=1e-9)
        np.testing.assert_allclose(result.field("S22"), 5, rtol=1e-9)
        np.testing.assert_allclose(result.field("E11"), (7 - 0.25 * 5) / 1000, rtol=1e-9)
        # thickness 2
        assert result.history["RF1[ALL:1]"][-1] + result.history["RF1[ALL:4]"][-1] == pytest.approx(-2 * 7)


def test_energies_of_general_steps_after_it_are_there(run_springs):
    history = run_springs(SPRING, LINEAR.format("", "*CLOAD\n2, 1, 0.5"), PULL.format("")).history
    assert history["ALLWK"][-1] > 0 and np.isfinite(history["ETOTAL"][-1])


@pytest.mark.parametrize(
    ("step", "message"),
    [
        ("*STEP, PERTURBATION\n*DYNAMIC\n0.1, 1.", r":12: \*DYNAMIC: not supported in a step with PERTURBATION"),
        ("*STEP, PERTURBATION\n*STATIC, RIKS", r":12: \*STATIC: DIRECT, RIKS and STABILIZE have no meaning in a step"),
        ("*STEP, PERTURBATION\n*STATIC\n*TEMPERATURE\nALL, 1.", ":14: predefined fields are not supported in a linear"),
        ("*STEP, PERTURBATION\n*STATIC\n*BOUNDARY, TYPE=VELOCITY\n2, 1, 1, 1.", ":14: TYPE=VELOCITY has no"),
        (
            "*STEP, PERTURBATION\n*STATIC\n*CLOAD, AMPLITUDE=A\n2, 1, 1.\n*AMPLITUDE, NAME=A\n0., 1.",
            ":14: an amplitude has no meaning in a step with PERTURBATION",
        ),
    ],
)
def test_what_has_no_meaning_is_named(run_springs, step, message):
    with pytest.raises(DeckError, match=message):
        run_springs(SPRING, step, "\n*END STEP\n")


def test_loads_of_dload_in_steps_by_modes_are_named(run_springs):
    modes = "*STEP\n*FREQUENCY\n1,\n*END STEP\n*STEP\n*MODAL DYNAMIC\n0.1, 1.\n*DLOAD\nBODY, P2NU\n*END STEP\n"
    with pytest.raises(DeckError, match=r"deck.inp:\d+: loads by DLOAD are not supported in a step by modes"):
        run_springs(SQUARE, modes)
