# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DASHPOT1, DASHPOT2 and DASHPOTA, by theory: forces proportional to a relative velocity."""

import numpy as np
import pytest

from uel.errors import DeckError

K, C, M, FORCE = 5.0, 3.0, 2.0, 7.0
DASHPOTS = {
    "DASHPOT1": f"*ELEMENT, TYPE=DASHPOT1, ELSET=D\n2, 2\n*DASHPOT, ELSET=D\n1\n{C}\n",
    "DASHPOT2": f"*ELEMENT, TYPE=DASHPOT2, ELSET=D\n2, 1, 2\n*DASHPOT, ELSET=D\n1, 1\n{C}\n",
    "DASHPOTA": f"*ELEMENT, TYPE=DASHPOTA, ELSET=D\n2, 1, 2\n*DASHPOT, ELSET=D\n\n{C}\n",
}
SPRING = f"*ELEMENT, TYPE=SPRING1, ELSET=S\n1, 2\n*SPRING, ELSET=S\n1\n{K}\n"
MASS = f"*ELEMENT, TYPE=MASS, ELSET=M\n3, 2\n*MASS, ELSET=M\n{M}\n"


def deck(model, step, *, place="1., 0."):
    held = "*BOUNDARY\n1, 1, 2\n2, 2\n"
    output = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=END\nU, RF, V\n*ENERGY OUTPUT\nALLVD, ALLKE, ALLSE\n"
    return f"*NODE\n1, 0., 0.\n2, {place}\n*NSET, NSET=END\n2\n{model}{held}*STEP, INC=1000{step}{output}*END STEP\n"


@pytest.mark.parametrize("name", DASHPOTS)
def test_beside_a_spring_in_a_static_step(run_deck, name):
    """c (u - u_0)/h + k u = F in each increment (Kelvin and Voigt)."""
    h, count = 0.1, 6
    step = f", AMPLITUDE=STEP\n*STATIC, DIRECT\n{h}, {count * h}\n*CLOAD\n2, 1, {FORCE}\n"
    history = run_deck(deck(SPRING + DASHPOTS[name], step)).history
    expected = FORCE / K * (1 - (1 + K * h / C) ** -np.arange(count + 1))
    found = np.array(history["U1[END]"])[-count:]
    np.testing.assert_allclose(found, expected[1:], rtol=1e-9)
    # the work of the force of the dashpot, by the trapezoidal rule
    force = np.array([0.0, *(FORCE - K * expected[1:])])
    work = float((0.5 * (force[1:] + force[:-1]) * np.diff(expected)).sum())
    assert history["ALLVD"][-1] == pytest.approx(work, rel=1e-9)


@pytest.mark.parametrize("name", DASHPOTS)
def test_a_mass_that_is_slowed_down(run_deck, name):
    """m dv/dt + c v = 0 by the trapezoidal rule (alpha 0): v falls by (1 - c h/(2 m))/(1 + c h/(2 m)) each time,
    and what it loses is dissipated."""
    h, count, speed = 0.1, 8, 4.0
    model = MASS + DASHPOTS[name] + f"*INITIAL CONDITIONS, TYPE=VELOCITY\n2, 1, {speed}\n"
    step = f"\n*DYNAMIC, DIRECT, ALPHA=0., NOHAF\n{h}, {count * h}\n"
    history = run_deck(deck(model, step)).history
    ratio = (1 - C * h / (2 * M)) / (1 + C * h / (2 * M))
    expected = speed * ratio ** np.arange(1, count + 1)
    np.testing.assert_allclose(np.array(history["V1[END]"])[-count:], expected, rtol=1e-9)
    total = np.array(history["ALLVD"])[-count:] + np.array(history["ALLKE"])[-count:]
    np.testing.assert_allclose(total, 0.5 * M * speed**2, rtol=1e-9)


@pytest.mark.parametrize("name", DASHPOTS)
def test_a_harmonic_response(run_deck, name):
    """u = F/(k - w^2 m + i w c)."""
    frequency = 0.3
    step = f"\n*STEADY STATE DYNAMICS, DIRECT\n{frequency}\n*CLOAD\n2, 1, {FORCE}\n"
    text = (
        deck(MASS + SPRING + DASHPOTS[name], step)
        .replace("U, RF, V", "U")
        .replace("*ENERGY OUTPUT\nALLVD, ALLKE, ALLSE\n", "")
    )
    history = run_deck(text).history
    w = 2 * np.pi * frequency
    expected = FORCE / (K - w**2 * M + 1j * w * C)
    assert history["U1[END]"][-1] == pytest.approx(abs(expected), rel=1e-9)
    assert history["PU1[END]"][-1] == pytest.approx(np.degrees(np.angle(expected)), rel=1e-9)


def test_force_over_velocity_by_a_table(run_deck):
    """Of 4 at a velocity of 1 and 6 at 3; constant beyond."""
    table = "*DASHPOT, ELSET=D, NONLINEAR\n1\n-6., -3.\n-4., -1.\n4., 1.\n6., 3.\n"
    model = SPRING + DASHPOTS["DASHPOT1"].split("*DASHPOT", maxsplit=1)[0] + table
    for velocity, force in ((0.5, 2.0), (2.0, 5.0), (10.0, 6.0), (-2.0, -5.0)):
        step = f"\n*STATIC, DIRECT\n0.5, 1.\n*BOUNDARY\n2, 1, 1, {velocity}\n"
        history = run_deck(deck(model, step)).history
        assert history["RF1[END]"][-1] == pytest.approx(force + K * velocity, rel=1e-9)


def test_along_a_line_that_turns(run_deck):
    """From (3, 0) to (3, 4) in two increments: c times the increment along the line of the end over that of
    the time."""
    step = ", NLGEOM\n*STATIC, DIRECT\n0.5, 1.\n*BOUNDARY\n2, 1\n2, 2, 2, 4.\n"
    history = run_deck(deck(DASHPOTS["DASHPOTA"], step, place="3., 0.").replace("1, 1, 2\n2, 2\n", "1, 1, 2\n")).history
    pull = C * (2.0 * 0.8) / 0.5
    assert history["RF1[END]"][-1] == pytest.approx(0.6 * pull, rel=1e-9)
    assert history["RF2[END]"][-1] == pytest.approx(0.8 * pull, rel=1e-9)


STATIC = f"\n*STATIC\n1., 1.\n*CLOAD\n2, 1, {FORCE}\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            deck(SPRING + DASHPOTS["DASHPOT1"], STATIC.replace("*STATIC", "*STATIC, RIKS")),
            r"deck.inp:\d+: \*STATIC, RIKS is not supported for .* DASHPOT1: no time passes; supported: \*STATIC",
        ),
        (
            deck(DASHPOTS["DASHPOT1"].replace("\n1\n3.0\n", "\n3.0\n"), STATIC),
            r"deck.inp:\d+: \*DASHPOT: needs a line with dofs, blank for DASHPOTA, and the coefficient on the next",
        ),
        (deck(DASHPOTS["DASHPOT1"].replace("3.0", "3.0, 50."), STATIC), r"\*DASHPOT: 2 entries, expected at most 1"),
        (
            deck(DASHPOTS["DASHPOT1"].replace("=D\n1\n3.0", "=D, NONLINEAR\n1\n1., 2."), STATIC),
            r"\*DASHPOT: NONLINEAR needs two or more lines of force and velocity, which ascends",
        ),
        (
            deck(DASHPOTS["DASHPOT1"].replace("*DASHPOT", "*SPRING"), STATIC),
            r"\*SPRING: element set D holds elements of type DASHPOT1, which take \*DASHPOT",
        ),
        (
            deck(DASHPOTS["DASHPOT1"].replace("=D\n1\n", "=D, RTOL=0.1\n1\n"), STATIC),
            r"\*DASHPOT: option RTOL is not supported",
        ),
    ],
)
def test_what_does_not_fit_is_refused(run_deck, text, message):
    with pytest.raises(DeckError, match=message):
        run_deck(text)
