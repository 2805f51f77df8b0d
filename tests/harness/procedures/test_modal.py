# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Steps by modes of *FREQUENCY: *STEADY STATE DYNAMICS and *MODAL DYNAMIC of an oscillator and of a bar, from vibration
theory, and against the same steps by the matrices of the model.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from vibrating import PAIR, bar, harmonic

import uel
from uel.deck import read_deck
from uel.errors import DeckError

CYCLES = 2 * np.pi
K, M = 9.0, 4.0
OMEGA = np.sqrt(K / M)
OSCILLATOR = f"""*NODE, NSET=ALL
1, 0.
2, 1.
*ELEMENT, TYPE=SPRINGA, ELSET=S
1, 1, 2
*SPRING, ELSET=S

{K}
*ELEMENT, TYPE=MASS, ELSET=M
2, 2
*MASS, ELSET=M
{M}
*BOUNDARY
ALL, 2, 3
1, 1
"""
OUTPUT = """*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, V, A, RF, CF
*OUTPUT, FIELD
*END STEP
"""
MODES = "*STEP\n*FREQUENCY{how}\n{number}\n*END STEP\n"
PUSHED = "*CLOAD\n2, 1, 3.\n*CLOAD, IMAGINARY\n2, 1, 4."
SWEEP = "*STEADY STATE DYNAMICS, INTERVAL=RANGE\n0.1, 0.5, 5"


@pytest.fixture
def run_modal(run_deck):
    def run_modal(model, procedure, more="", *, number="1", how="", options="", user=None):
        step = f"*STEP{options}\n{procedure}\n{more}\n{OUTPUT}"
        return run_deck(model + MODES.format(how=how, number=number) + step, user)

    return run_modal


def last_step(history):
    """Columns without the rows of the modes."""
    return {name: values[history["step"] == 2] for name, values in history.items()}


def viscous(fraction):
    return 2 * fraction * OMEGA * M


DAMPED = [
    ("", 0, 0),
    ("*MODAL DAMPING\n1, 1, 0.1", viscous(0.1), 0),
    ("*MODAL DAMPING, MODAL=DIRECT\n1, , 0.1", viscous(0.1), 0),
    ("*MODAL DAMPING, VISCOUS=FRACTION OF CRITICAL DAMPING\n1, 5, 0.1", viscous(0.1), 0),
    ("*MODAL DAMPING\n2, 5, 0.1", 0, 0),
    ("*MODAL DAMPING, RAYLEIGH\n1, 1, 0.2, 0.03", 0.2 * M + 0.03 * K, 0),
    ("*MODAL DAMPING, VISCOUS=RAYLEIGH\n1, 1, 0.2", 0.2 * M, 0),
    ("*MODAL DAMPING, STRUCTURAL\n1, 1, 0.05", 0, 0.05 * K),
    ("*MODAL DAMPING, STRUCTURAL\n1, 1, 0.05\n*MODAL DAMPING\n1, 1, 0.1", viscous(0.1), 0.05 * K),
    # the frequency of the mode is 0.2387, between the first two
    (
        "*MODAL DAMPING, DEFINITION=FREQUENCY RANGE\n0.1, 0.\n0.3, 0.2\n5., 7.",
        viscous(0.2 * (OMEGA / CYCLES - 0.1) / 0.2),
        0,
    ),
    ("*MODAL DAMPING, DEFINITION=FREQUENCY RANGE\n0.3, 0.2\n5., 7.", viscous(0.2), 0),
]


@pytest.mark.parametrize(("damping", "c", "s"), DAMPED)
def test_an_oscillator_over_frequency(run_modal, damping, c, s):
    history = last_step(run_modal(OSCILLATOR, SWEEP, f"{damping}\n{PUSHED}").history)
    rate = 1j * CYCLES * history["time"]
    x = (3 + 4j) / (K + rate**2 * M + rate * c + 1j * s)
    np.testing.assert_allclose(harmonic(history, "U1[ALL:2]"), x)
    np.testing.assert_allclose(harmonic(history, "V1[ALL:2]"), rate * x)
    np.testing.assert_allclose(harmonic(history, "A1[ALL:2]"), rate**2 * x)
    np.testing.assert_allclose(harmonic(history, "CF1[ALL:2]"), 3 + 4j)
    # of the spring; there is no damper that could pull
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:1]"), -K * x)
    np.testing.assert_allclose(history["ALLSE"], K / 4 * np.abs(x) ** 2)
    np.testing.assert_allclose(history["ALLKE"], M / 4 * np.abs(rate * x) ** 2)


@pytest.mark.parametrize("normalization", ["", ", NORMALIZATION=MASS"])
@pytest.mark.parametrize("projected", [False, True])
def test_all_modes_of_a_bar_are_the_direct_solution(run_modal, tmp_path, normalization, projected):
    """Twenty modes of twenty unknowns; consistent masses act on the support too."""
    n = 20
    model = bar(n, more="1, 1\n")
    load = f"*CLOAD\n{n + 1}, 1, 3.\n*CLOAD, IMAGINARY\n7, 1, 2."
    kind = ", SUBSPACE PROJECTION" if projected else ""
    by_modes = run_modal(
        model, f"*STEADY STATE DYNAMICS, INTERVAL=RANGE{kind}\n0.2, 1.9, 6", load, number=f"{n}", how=normalization
    )
    by_modes = last_step(by_modes.history)
    direct = last_step(
        run_modal(model, "*STEADY STATE DYNAMICS, DIRECT, REAL ONLY\n0.2, 1.9, 6", load, number="1").history
    )
    for name in ("U1[ALL:5]", f"U1[ALL:{n + 1}]", "A1[ALL:9]", "RF1[ALL:1]"):
        np.testing.assert_allclose(harmonic(by_modes, name), harmonic(direct, name), rtol=1e-7)
    for name in ("ALLSE", "ALLKE"):
        np.testing.assert_allclose(by_modes[name], direct[name], rtol=1e-7)


def test_projected_matrices_have_the_damping_of_user_elements(run_modal):
    """A mass on a spring and dampers that are not those of a mode: one mode of one unknown is the direct solution."""
    user = Path(__file__).parent / "harmonic.f"
    c, s = 0.6, 0.9
    model = f"""*NODE, NSET=ALL
1, 0.
2, 1.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=5, I PROPERTIES=1, UNSYMM
1
*ELEMENT, TYPE=U1, ELSET=E
1, 1, 2
*UEL PROPERTY, ELSET=E
{K}, {c}, {s}, {M}, 0., 0
*BOUNDARY
1, 1
"""
    procedure = "*STEADY STATE DYNAMICS, SUBSPACE PROJECTION, INTERVAL=RANGE\n0.1, 0.5, 5"
    history = last_step(run_modal(model, procedure, PUSHED, user=user).history)
    rate = 1j * CYCLES * history["time"]
    x = (3 + 4j) / (K + rate**2 * M + rate * c + 1j * s)
    np.testing.assert_allclose(harmonic(history, "U1[ALL:2]"), x)
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:1]"), -(K + rate * c + 1j * s) * x)


@pytest.mark.parametrize(
    ("selection", "chosen"),
    [
        ("1, 3", [0, 2]),
        ("1, 5, 2", [0, 1, 4]),
        ("*GENERATE\n1, 5, 2", [0, 2, 4]),
        ("*GENERATE\n2, 4", [1, 2, 3]),
        ("*FREQUENCY\n0., 0.6\n1.4, 1.6", [0, 1]),
    ],
)
def test_modes_that_respond(run_modal, selection, chosen):
    """A bar of lumped masses between walls, pushed in a quarter: each mode by itself, from its shape."""
    n = 20
    model = bar(n, more=f"1, 1\n{n + 1}, 1\n")
    options = {"*GENERATE": ", GENERATE", "*FREQUENCY": ", DEFINITION=FREQUENCY RANGE"}
    head = next((word for word in options if selection.startswith(word)), "")
    if head == "*FREQUENCY":
        selection = "*FREQUENCY\n0., 1.05\n1.9, 2.1"
    text = f"*SELECT EIGENMODES{options.get(head, '')}\n{selection.removeprefix(head).lstrip()}"
    history = last_step(
        run_modal(model, "*STEADY STATE DYNAMICS\n0.33", f"{text}\n*CLOAD\n{n // 4 + 1}, 1, 1.", number="6").history
    )
    k = np.arange(1, 7)[chosen]
    omega = 2 * n * 2.0 * np.sin(k * np.pi / (2 * n))
    # generalized mass 1/2 of a shape sin(k pi x), masses 1/n
    shape = np.sin(k * np.pi / 4)
    expected = np.sum(shape**2 / (0.5 * (omega**2 - (CYCLES * 0.33) ** 2)))
    np.testing.assert_allclose(harmonic(history, f"U1[ALL:{n // 4 + 1}]")[0], expected)


def test_natural_frequencies_divide_the_range(run_modal):
    """Two masses: four points from limit to mode to mode to limit, closer to their ends with the bias 3."""
    natural = np.sqrt(4.0 * (3 + np.array([-1, 1]) * np.sqrt(5)) / 2) / CYCLES
    load = "*MODAL DAMPING\n1, 2, 0.1\n*CLOAD\n3, 1, 1."
    place = 0.5 + 0.5 * np.array([-1, -((1 / 3) ** (1 / 3)), (1 / 3) ** (1 / 3), 1])
    limits = [0.1, *natural, 1.0]
    expected = np.concatenate([[0.1], *(a * (b / a) ** place[1:] for a, b in pairwise(limits))])
    found = last_step(run_modal(PAIR, "*STEADY STATE DYNAMICS\n0.1, 1., 4", load, number="2").history)
    np.testing.assert_allclose(found["time"], expected)
    # off the poles, where nothing damps
    by_matrices = "*STEADY STATE DYNAMICS, DIRECT, INTERVAL=EIGENFREQUENCY\n0.1, 1., 4, , 1.01"
    found = last_step(run_modal(PAIR, by_matrices, "*CLOAD\n3, 1, 1.", number="2").history)
    np.testing.assert_allclose(found["time"], expected * ([1.0] + [1.01] * 8 + [1.0]))


@pytest.mark.parametrize(("kind", "power"), [("", 0), (", TYPE=VELOCITY", 1), (", TYPE=DISPLACEMENT", 2)])
@pytest.mark.parametrize(("part", "value"), [("", 1.0), (", IMAGINARY", 1j)])
def test_supports_move_over_frequency(run_modal, kind, power, part, value):
    """Relative displacement -M a / (K - w^2 M); the support pulls what accelerates the mass."""
    table = "*AMPLITUDE, NAME=A\n0., 1., 1., 3.\n"
    moved = f"*BASE MOTION, DOF=1, AMPLITUDE=A, SCALE=0.5{kind}{part}"
    history = last_step(run_modal(table + OSCILLATOR, SWEEP, moved).history)
    rate = 1j * CYCLES * history["time"]
    acceleration = value * 0.5 * (1 + 2 * history["time"]) * rate**power
    x = -M * acceleration / (K + rate**2 * M)
    np.testing.assert_allclose(harmonic(history, "U1[ALL:2]"), x)
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:1]"), -K * x)


def test_moved_supports_are_the_direct_solution(run_modal):
    """Absolute displacements of DIRECT less those of the supports, of a bar with masses and a support at both ends."""
    n, moved = 12, 0.2
    model = "*AMPLITUDE, NAME=A\n0., 1.\n" + bar(n, more=f"1, 1\n{n + 1}, 1\n")
    found = run_modal(
        model,
        "*STEADY STATE DYNAMICS\n0.8",
        f"*BASE MOTION, DOF=1, AMPLITUDE=A, TYPE=DISPLACEMENT, SCALE={moved}",
        number=f"{n - 1}",
    ).history
    direct = run_modal(
        model, "*STEADY STATE DYNAMICS, DIRECT, REAL ONLY\n0.8", f"*BOUNDARY\n1, 1, 1, {moved}\n{n + 1}, 1, 1, {moved}"
    ).history
    found, direct = last_step(found), last_step(direct)
    for node in range(2, n + 1):
        name = f"U1[ALL:{node}]"
        np.testing.assert_allclose(harmonic(found, name), harmonic(direct, name) - moved, rtol=1e-8)
    np.testing.assert_allclose(harmonic(found, "RF1[ALL:1]"), harmonic(direct, "RF1[ALL:1]"), rtol=1e-8)


@pytest.mark.parametrize(("damping", "c", "s"), [case for case in DAMPED if not case[2]])
def test_an_oscillator_over_time(run_modal, damping, c, s):
    """A force that is there at once, in large increments: x = F/K (1 - e^(-d t) (cos w_d t + d / w_d sin w_d t))."""
    assert not s
    history = last_step(run_modal(OSCILLATOR, "*MODAL DYNAMIC\n0.7, 6.", f"{damping}\n*CLOAD\n2, 1, 3.").history)
    t = history["time"]
    np.testing.assert_allclose(t, [0.7, 1.4, 2.1, 2.8, 3.5, 4.2, 4.9, 5.6, 6.0])
    decay = c / (2 * M)
    damped = np.sqrt(OMEGA**2 - decay**2)
    x = 3 / K * (1 - np.exp(-decay * t) * (np.cos(damped * t) + decay / damped * np.sin(damped * t)))
    v = 3 / K * OMEGA**2 / damped * np.exp(-decay * t) * np.sin(damped * t)
    np.testing.assert_allclose(history["U1[ALL:2]"], x, rtol=1e-9)
    np.testing.assert_allclose(history["V1[ALL:2]"], v, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(history["A1[ALL:2]"], (3 - c * v - K * x) / M, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(history["RF1[ALL:1]"], -K * x, rtol=1e-9)
    np.testing.assert_allclose(history["ALLSE"], K / 2 * x**2, rtol=1e-9)
    np.testing.assert_allclose(history["ALLKE"], M / 2 * v**2, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("ramp", ["*AMPLITUDE", ", AMPLITUDE=RAMP"])
def test_a_ramp_is_integrated_exactly(run_modal, ramp):
    """F t: x = F/K (t - sin(w t)/w)."""
    model = "*AMPLITUDE, NAME=A\n0., 0., 4., 4.\n" + OSCILLATOR
    given = "*CLOAD, AMPLITUDE=A\n2, 1, 3." if ramp == "*AMPLITUDE" else "*CLOAD\n2, 1, 12."
    options = "" if ramp == "*AMPLITUDE" else ramp
    history = last_step(run_modal(model, "*MODAL DYNAMIC\n1., 4.", given, options=options).history)
    t = history["time"]
    np.testing.assert_allclose(history["U1[ALL:2]"], 3 / K * (t - np.sin(OMEGA * t) / OMEGA))


def test_supports_move_over_time(run_modal):
    model = "*AMPLITUDE, NAME=A\n0., 2., 1., 2.\n" + OSCILLATOR
    history = last_step(run_modal(model, "*MODAL DYNAMIC\n0.5, 3.", "*BASE MOTION, DOF=1, AMPLITUDE=A").history)
    x = -2 * M / K * (1 - np.cos(OMEGA * history["time"]))
    np.testing.assert_allclose(history["U1[ALL:2]"], x)
    np.testing.assert_allclose(history["RF1[ALL:1]"], -K * x)


def test_initial_velocities_and_a_mode_without_stiffness(run_modal):
    """Two masses on one spring, free: the middle goes on at 1.5/2, they vibrate about it with w^2 = 2 k/m.

    Their energy stays that at the start.
    """
    free = PAIR.replace("1, 1, 2\n2, 2, 3\n", "2, 2, 3\n").replace(
        "*BOUNDARY\nALL, 2, 3\n1, 1\n", "*BOUNDARY\nALL, 2, 3\n"
    )
    model = free.replace("1, 0.\n", "", 1) + "*INITIAL CONDITIONS, TYPE=VELOCITY\n3, 1, 1.5\n"
    history = last_step(run_modal(model, "*MODAL DYNAMIC\n0.25, 2.", number="2").history)
    t, omega = history["time"], np.sqrt(8.0)
    np.testing.assert_allclose(history["U1[ALL:3]"], 0.75 * (t + np.sin(omega * t) / omega), rtol=1e-6)
    np.testing.assert_allclose(history["U1[ALL:2]"], 0.75 * (t - np.sin(omega * t) / omega), rtol=1e-5)
    np.testing.assert_allclose(history["ALLSE"] + history["ALLKE"], 1.5**2, rtol=1e-6)


def test_what_is_written(run_modal):
    result = run_modal(
        OSCILLATOR, "*MODAL DYNAMIC\n0.5, 1.", "*CLOAD\n2, 1, 3.\n*NODE PRINT\nU\n*MONITOR, NODE=2, DOF=1"
    )
    message = result.file(".msg").read_text()
    assert "M O D A L   D Y N A M I C   A N A L Y S I S" in message
    assert "1 OF 1 MODES OF STEP 1 RESPOND" in message
    assert "TIME INCREMENT COMPLETED  0.500    ,  FRACTION OF STEP COMPLETED   1.00" in result.file(".dat").read_text()
    assert [(row.increment, row.step_time) for row in result.status if row.step == 2] == [(1, 0.5), (2, 1.0)]
    x = 3 / K * (1 - np.cos(OMEGA))
    np.testing.assert_allclose(result.field("U", step=2, increment=2)[1, 0], x, rtol=1e-6)


@pytest.mark.parametrize(
    ("procedure", "more", "message"),
    [
        (
            SWEEP,
            "*BOUNDARY\n1, 1, 1, 0.1",
            r"deck.inp:\d+: a step by modes moves all supports alike, by \*BASE MOTION",
        ),
        (SWEEP, "*BOUNDARY\n2, 1", r"\*BOUNDARY holds other dofs than the step of the modes, 1"),
        (SWEEP, "*BOUNDARY, OP=NEW\n1, 1", r"\*BOUNDARY holds other dofs than the step of the modes, 1"),
        (SWEEP, "*SELECT EIGENMODES\n2", r"none of the 1 modes of \*FREQUENCY, step 1, responds"),
        (SWEEP, "*SELECT EIGENMODES\n", "SELECT EIGENMODES: needs a data line"),
        (SWEEP, "*SELECT EIGENMODES\n0", "mode 0 must be positive"),
        (SWEEP, "*SELECT EIGENMODES, GENERATE\n3, 1", "expected first and last mode and a positive increment"),
        (SWEEP, "*SELECT EIGENMODES, GENERATE, DEFINITION=FREQ\n3, 1", "GENERATE is for DEFINITION=MODE NUMBERS"),
        (SWEEP, "*SELECT EIGENMODES, DEFINITION=FREQ\n3., 1.", "the highest frequency 1 is below the lowest, 3"),
        (SWEEP, "*SELECT EIGENMODES\n1\n*SELECT EIGENMODES\n1", r"EIGENMODES: a step has one already, at .*deck.inp"),
        (SWEEP, "*MODAL DAMPING\n", "MODAL DAMPING: needs a data line"),
        (SWEEP, "*MODAL DAMPING\n3, 1, 0.1", "the last mode 1 is before the first, 3"),
        (SWEEP, "*MODAL DAMPING\n1, 1, -0.1", "damping must not be negative"),
        (SWEEP, "*MODAL DAMPING, DEFINITION=FREQ\n1., 0.1\n1., 0.2", "frequencies must increase"),
        (SWEEP, "*MODAL DAMPING, RAYLEIGH, STRUCTURAL\n1", "RAYLEIGH and STRUCTURAL exclude each other"),
        (SWEEP, "*MODAL DAMPING, VISCOUS=COMPOSITE\n1", "VISCOUS=COMPOSITE is not supported"),
        (SWEEP, "*MODAL DAMPING\n1, 1, .1\n*MODAL DAMPING\n1, 1, .1", "DAMPING is given already, at .*deck.inp"),
        ("*STEADY STATE DYNAMICS, SUBSPACE\n1.", "*MODAL DAMPING\n1, 1, .1", "which has that of the elements"),
        (
            "*MODAL DYNAMIC\n0.1, 1.",
            "*MODAL DAMPING, STRUCTURAL\n1, 1, .1",
            "STRUCTURAL is not for this step, MODAL DYN",
        ),
        ("*STATIC", "*MODAL DAMPING\n1, 1, .1", r"\*MODAL DAMPING: is for \*MODAL DYNAMIC, and \*STEADY STATE"),
        ("*MODAL DYNAMIC\n0.1, 1.", "*BASE MOTION, DOF=1, AMPLITUDE=A, TYPE=VELOCITY", "TYPE=VELOCITY over time"),
        ("*MODAL DYNAMIC\n0.1, 1.", "*BASE MOTION, DOF=1, AMPLITUDE=A, IMAGINARY", "IMAGINARY are for"),
        (SWEEP, "*BASE MOTION, DOF=4, AMPLITUDE=A", "DOF=4: supports move along 1, 2 or 3"),
        (SWEEP, "*BASE MOTION, DOF=1", r"\*BASE MOTION needs the option AMPLITUDE"),
        (SWEEP, "*BASE MOTION, DOF=1, AMPLITUDE=U", "an amplitude by UAMP is not supported here"),
        ("*MODAL DYNAMIC\n0.1, 1.", "*CLOAD, AMPLITUDE=U\n2, 1, 1.", "the time of this step alone here, which UAMP"),
        ("*MODAL DYNAMIC", "", r"\*MODAL DYNAMIC: needs a data line with the time increment and the period"),
        ("*MODAL DYNAMIC\n2., 1.", "", "expected 0 < time increment <= period, found 2 and 1"),
        ("*MODAL DYNAMIC\n1e-9, 1.", "", "the period has more than 100000 increments"),
        ("*MODAL DYNAMIC, CONTINUE\n1., 1.", "", "CONTINUE=YES is not supported"),
        ("*STEADY STATE DYNAMICS, REAL ONLY\n1.", "", "REAL ONLY needs DIRECT or SUBSPACE PROJECTION"),
        ("*STEADY STATE DYNAMICS, DIRECT, SUBSPACE\n1.", "", "DIRECT and SUBSPACE PROJECTION exclude each other"),
        ("*STEADY STATE DYNAMICS, SUBSPACE=RANGE\n1.", "", "SUBSPACE PROJECTION=RANGE is not supported"),
        ("*STEADY STATE DYNAMICS\n1., 2., 3, 1., -1.", "", "frequency scale factor -1 must be positive"),
        *(
            (
                f"*STEADY STATE DYNAMICS{kind}\n{OMEGA / CYCLES:.16g}",
                "*CLOAD\n2, 1, 1.",
                "is a natural frequency of a mode",
            )
            for kind in ("", ", SUBSPACE PROJECTION")
        ),
    ],
)
def test_what_is_wrong_is_named(run_modal, procedure, more, message):
    tables = "*AMPLITUDE, NAME=A\n0., 1.\n*AMPLITUDE, NAME=U, DEFINITION=USER\n"
    with pytest.raises(DeckError, match=message):
        run_modal(tables + OSCILLATOR, procedure, more)


@pytest.mark.parametrize(
    ("procedure", "how"),
    [
        ("*MODAL DYNAMIC\n0.5, 1.", r"\*MODAL DYNAMIC by modes"),
        ("*STEADY STATE DYNAMICS, DIRECT, INTERVAL=EIGENFREQUENCY\n0.5, 1.", "INTERVAL=EIGENFREQUENCY"),
    ],
)
def test_modes_do_not_outlast_their_job(tmp_path, monkeypatch, procedure, how):
    """A state that is kept has none: a job that resumes behind *FREQUENCY says so."""
    monkeypatch.chdir(tmp_path)
    static = "*STEP\n*STATIC\n*END STEP\n"
    modes = MODES.format(how="", number=1)
    text = f"{OSCILLATOR}*RESTART, WRITE\n{static}{modes}{static}*STEP\n{procedure}\n*END STEP\n"
    (tmp_path / "deck.inp").write_text(text)
    uel.run("deck.inp")
    with pytest.raises(DeckError, match=rf"{how} needs a \*FREQUENCY step before it in the same job"):
        uel.run("deck.inp", job="again", oldjob="deck")


@pytest.mark.parametrize(
    ("procedure", "message"),
    [
        ("*STEADY STATE DYNAMICS\n1.", r"\*STEADY STATE DYNAMICS by modes needs a \*FREQUENCY step before it"),
        ("*MODAL DYNAMIC\n1., 1.", r"\*MODAL DYNAMIC by modes needs a \*FREQUENCY step before it"),
        ("*STEADY STATE DYNAMICS, DIRECT, INTERVAL=EIGEN\n1.", "with INTERVAL=EIGENFREQUENCY needs"),
    ],
)
def test_modes_come_first(tmp_path, procedure, message):
    (tmp_path / "deck.inp").write_text(OSCILLATOR + f"*STEP\n{procedure}\n*END STEP\n" + MODES.format(how="", number=1))
    with pytest.raises(DeckError, match=message):
        read_deck(tmp_path / "deck.inp")
