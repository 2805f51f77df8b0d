# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STEADY STATE DYNAMICS, DIRECT: an oscillator of one mass, a bar, a string; responses from vibration theory."""

from pathlib import Path

import numpy as np
import pytest
from vibrating import PAIR, bar, harmonic

from uel.deck import read_deck
from uel.errors import DeckError, SingularMatrixError
from uel.output.formats import exponential

UEL = Path(__file__).parent / "harmonic.f"
K, C, S, M = 9.0, 0.6, 0.9, 4.0
OSCILLATOR = f"""*NODE, NSET=ALL
1, 0.
2, 1.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=5, I PROPERTIES=1, UNSYMM
1
*ELEMENT, TYPE=U1, ELSET=E
1, 1, 2
*UEL PROPERTY, ELSET=E
{K}, {C}, {S}, {M}, 0., 0
"""
HELD = "*BOUNDARY\n1, 1\n"
PUSHED = "*CLOAD\n2, 1, 3.\n*CLOAD, IMAGINARY\n2, 1, 4."
STEP = """*STEP
*STEADY STATE DYNAMICS, DIRECT{how}
{frequencies}
{more}
*OUTPUT, FIELD
*OUTPUT, HISTORY, OP=ADD
*NODE OUTPUT, NSET=ALL
U, V, A, RF, CF
*END STEP
"""


@pytest.fixture
def run_sweep(run_deck):
    def run_sweep(model, frequencies="0.1, 0.5, 5", more=PUSHED, *, how="", user=UEL, before="", after=""):
        step = STEP.format(how=how, frequencies=frequencies, more=more)
        return run_deck(model + before + step + after, user)

    return run_sweep


def stiffness(history, damped=True):
    """Of the mass, over the frequencies: m x'' + c x' + (k + i s) x = p, with x = X exp(i w t)."""
    rate = 2j * np.pi * history["time"]
    return K + rate**2 * M + (rate * C + 1j * S) * damped


@pytest.mark.parametrize("how", ["", ", REAL ONLY"])
def test_an_oscillator(run_sweep, how):
    history = run_sweep(OSCILLATOR + HELD, how=how).history
    rate = 2j * np.pi * history["time"]
    x = (3 + 4j) / stiffness(history, damped=not how)
    np.testing.assert_allclose(harmonic(history, "U1[ALL:2]"), x)
    np.testing.assert_allclose(harmonic(history, "V1[ALL:2]"), rate * x)
    np.testing.assert_allclose(harmonic(history, "A1[ALL:2]"), rate**2 * x)
    np.testing.assert_allclose(harmonic(history, "CF1[ALL:2]"), 3 + 4j)
    # the spring and the dampers pull at the support
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:1]"), -(K + (rate * C + 1j * S) * (not how)) * x)


def test_energies_are_means_over_a_period(run_sweep):
    """Half of 1/2 k |x|^2 and 1/2 m |v|^2, which the means of 1/2 k x(t)^2 and 1/2 m v(t)^2 are."""
    history = run_sweep(OSCILLATOR + HELD).history
    rate = 2j * np.pi * history["time"]
    x = (3 + 4j) / stiffness(history)
    np.testing.assert_allclose(history["ALLSE"], K / 4 * np.abs(x) ** 2)
    np.testing.assert_allclose(history["ALLKE"], M / 4 * np.abs(rate * x) ** 2)
    turn = np.exp(2j * np.pi * np.arange(12) / 12)
    np.testing.assert_allclose(history["ALLSE"], (K / 2 * np.outer(turn, x).real ** 2).mean(axis=0))
    np.testing.assert_allclose(history["ALLKE"], (M / 2 * np.outer(turn, rate * x).real ** 2).mean(axis=0))


def test_energies_are_printed(run_sweep):
    result = run_sweep(OSCILLATOR + HELD, "0.2", more=PUSHED + "\n*ENERGY PRINT")
    text = " ".join(result.file(".dat").read_text().split())
    head = "FOR THE WHOLE MODEL AT FREQUENCY = 0.200000 MEAN ENERGIES OVER A PERIOD - RECOVERABLE STRAIN ENERGY"
    found = text.split(head)[1].replace("KINETIC ENERGY", "").split()[:2]
    expected = [result.history[name][0] for name in ("ALLSE", "ALLKE")]
    np.testing.assert_allclose([float(value) for value in found], expected, rtol=1e-5)


def test_energies_of_a_moved_support(run_sweep):
    """The spring stretches by the difference of the displacements; only the second node has a mass."""
    history = run_sweep(OSCILLATOR + HELD, more="*BOUNDARY, IMAGINARY\n1, 1, 1, 0.2").history
    first, second = (harmonic(history, f"U1[ALL:{node}]") for node in (1, 2))
    np.testing.assert_allclose(history["ALLSE"], K / 4 * np.abs(second - first) ** 2)
    np.testing.assert_allclose(history["ALLKE"], M * (np.pi * history["time"] * np.abs(second)) ** 2)


def test_a_moved_support(run_sweep):
    """Transmissibility of displacements; the harmonic motion of node 1 has an imaginary part alone."""
    moved = "*BOUNDARY, IMAGINARY\n1, 1, 1, 0.2"
    history = run_sweep(OSCILLATOR + HELD, more=moved).history
    rate = 2j * np.pi * history["time"]
    np.testing.assert_allclose(harmonic(history, "U1[ALL:1]"), 0.2j)
    expected = 0.2j * (K + rate * C + 1j * S) / stiffness(history)
    np.testing.assert_allclose(harmonic(history, "U1[ALL:2]"), expected)
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:1]"), rate**2 * M * expected)


def test_everything_is_moved(run_sweep):
    moved = "*BOUNDARY, REAL\n1, 1, 1, 0.\n2, 1, 1, 0.5"
    history = run_sweep(OSCILLATOR, "0.3", more=moved).history
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:2]"), 0.5 * stiffness(history))


def test_the_matrix_need_not_be_symmetric(run_sweep):
    """A force on the mass, -5 times the displacement of its free support."""
    free = OSCILLATOR.replace(", 0., 0", ", 5., 0")
    history = run_sweep(free, more="*CLOAD\n1, 1, 2.").history
    rate = 2j * np.pi * history["time"]
    spring = K + rate * C + 1j * S
    for k, (pull, mass) in enumerate(zip(spring, rate**2 * M, strict=True)):
        expected = np.linalg.solve([[pull, -pull], [-pull - 5, pull + mass]], [2, 0])
        found = [harmonic(history, f"U1[ALL:{node}]")[k] for node in (1, 2)]
        np.testing.assert_allclose(found, expected)


def test_loads_over_frequency(run_sweep):
    """An amplitude is one over frequency."""
    table = "*AMPLITUDE, NAME=A\n0.1, 1., 0.5, 3.\n"
    history = run_sweep(
        table + OSCILLATOR + HELD,
        "0.1, 0.4, 3",
        how=", FREQUENCY SCALE=LINEAR",
        more=PUSHED.replace("\n2", ", AMPLITUDE=A\n2", 1),
    ).history
    load = 3 * np.array([1, 1.75, 2.5]) + 4j
    np.testing.assert_allclose(harmonic(history, "CF1[ALL:2]"), load)
    np.testing.assert_allclose(harmonic(history, "U1[ALL:2]"), load / stiffness(history))


@pytest.mark.parametrize("more", ["", "*EQUATION\n2\n{tip}, 1, 1., {pulled}, 1, -1.\n"])
def test_a_bar_that_is_pulled_at_its_end(run_sweep, more):
    """Lumped masses: u_j = F h sin(j t) / (EA cos(n t) sin t), w = 2 c / h sin(t/2); a node tied to the end takes F."""
    n, pulled = 40, 40
    model = bar(n, more="1, 1\n")
    if more:
        # the node behind the bar has no element of its own
        pulled = n + 2
        extra = f"*ELEMENT, TYPE=SPRING1, ELSET=NO\n900, {pulled}\n*SPRING, ELSET=NO\n1\n0.\n"
        model = model.replace("*ELEMENT", f"{pulled}, 2., 0.\n{extra}*ELEMENT", 1) + more.format(
            tip=n + 1, pulled=pulled
        )
    else:
        pulled = n + 1
    history = run_sweep(model, "0.2, 1.9, 6", more=f"*CLOAD\n{pulled}, 1, 3.", user=None).history
    h, c = 1 / n, 2.0
    angle = 2 * np.arcsin(np.pi * history["time"] * h / c)
    scale = 3 * h / (4 * np.cos(n * angle) * np.sin(angle))
    for node in (11, 21, 41):
        np.testing.assert_allclose(
            harmonic(history, f"U1[ALL:{node}]"), scale * np.sin((node - 1) * angle), rtol=1e-9, atol=1e-12
        )
    np.testing.assert_allclose(harmonic(history, "RF1[ALL:1]"), -scale * 4 / h * np.sin(angle), rtol=1e-9, atol=1e-9)
    # of springs EA/h and masses h, half a mass at the end
    u = scale * np.sin(np.arange(n + 1)[:, np.newaxis] * angle)
    mass = np.array([h] * n + [h / 2])
    np.testing.assert_allclose(history["ALLSE"], 4 / h / 4 * (np.diff(u, axis=0) ** 2).sum(axis=0), rtol=1e-9)
    np.testing.assert_allclose(history["ALLKE"], (np.pi * history["time"]) ** 2 * (mass @ u**2), rtol=1e-9)
    # without damping they differ by the virial of the load
    np.testing.assert_allclose(history["ALLSE"] - history["ALLKE"], 3 * u[-1] / 4, rtol=1e-7)


STRING = PAIR.replace("4, 3\n", "")


def test_about_the_base_state(run_sweep):
    """A mass in the middle of a string under the tension T: stiffness 2 T / L across; nothing of it goes on."""
    pull = "*STEP, NLGEOM\n*STATIC\n*BOUNDARY\n2, 1, 1, 0.25\n3, 1, 1, 0.5\n*END STEP\n"
    across = "*BOUNDARY, OP=NEW\nALL, 3\nALL, 1\n1, 2\n3, 2\n*CLOAD\n2, 2, 1."
    stay = "*STEP\n*STATIC\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU1, U2\n*END STEP\n"
    result = run_sweep(STRING, "0.05, 0.08, 2", more=across, user=None, before=pull, after=stay)
    history = result.history
    sweep = history["step"] == 2
    expected = 1 / (2 * 8 * 0.25 / 1.25 - 2 * (2 * np.pi * history["time"][sweep]) ** 2)
    np.testing.assert_allclose(harmonic(history, "U2[ALL:2]")[sweep], expected)
    assert history["time"][-1] == pytest.approx(2)
    assert history["U1[ALL:3]"][-1] == pytest.approx(0.5)
    assert history["U2[ALL:2]"][-1] == 0
    assert np.isnan(history["PU2[ALL:2]"][-1])


SQUARE = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=S
1, 1, 2, 3, 4
*SURFACE, NAME=TOP
S, S3
*SOLID SECTION, ELSET=S, MATERIAL=M
2.
*MATERIAL, NAME=M
*ELASTIC
100., 0.
*DENSITY
1.
*BOUNDARY
1, 1, 2
2, 2
"""


@pytest.mark.parametrize("load", ["*DLOAD, IMAGINARY\nS, P3, -10.", "*DSLOAD, IMAGINARY\nTOP, P, -10."])
def test_stresses_of_slow_loads(run_sweep, load):
    """At frequency zero stress and strain are the static ones: a pull of 10 stretches by 10/100."""
    result = run_sweep(SQUARE, "0.", more=load, user=None)
    np.testing.assert_allclose(result.field("U_imaginary")[:, 1], [0, 0, 0.1, 0.1], atol=1e-15)
    np.testing.assert_allclose(result.field("U"), 0, atol=1e-15)
    np.testing.assert_allclose(result.field("S22_imaginary"), 10)
    np.testing.assert_allclose(result.field("RF_imaginary")[:, 1], [-10, -10, 0, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("how", "data", "expected"),
    [
        ("", "0.7", [0.7]),
        ("", "0.7, 0., 5", [0.7]),
        ("", "1., 100., 5", 10 ** np.linspace(0, 2, 5)),
        (", FREQUENCY SCALE=LINEAR", "0., 100., 5", [0, 25, 50, 75, 100]),
        (", FREQUENCY SCALE=LINEAR", "1., 20., 1", np.arange(1, 21)),
        # bias 2: (1 + sign(y) |y|^(1/2)) / 2 for y = -1, -1/2, 0, 1/2, 1
        (", FREQUENCY SCALE=LINEAR", "0., 100., 5, 2.", 50 + 50 * np.array([-1, -(0.5**0.5), 0, 0.5**0.5, 1])),
        (", INTERVAL=RANGE", "5.\n1., 100., 3\n7., 0.", [5, 1, 10, 100, 7]),
    ],
)
def test_frequencies(tmp_path, how, data, expected):
    """Abaqus Analysis User's Guide, Direct-solution steady-state dynamic analysis."""
    (tmp_path / "deck.inp").write_text(OSCILLATOR + HELD + STEP.format(how=how, frequencies=data, more=PUSHED))
    np.testing.assert_allclose(read_deck(tmp_path / "deck.inp").steps[0].procedure.frequencies(np.zeros(0)), expected)


def test_calls(run_sweep):
    result = run_sweep(OSCILLATOR.replace(", 0., 0", ", 0., 1") + HELD, "0.1\n0.2")
    lines = result.file(".msg").read_text().splitlines()
    calls = [line.split()[1:] for line in lines if line.startswith("FLAGS")]
    assert calls[0] == ["95", "0", "4", "0", "0", "0", "0", "0.000"]
    asked = [("2", "0"), ("4", "0"), ("3", "1"), ("3", "2")]
    expected = [["95", "0", what, "1", "0", "0", kind, time] for time in ("0.100", "0.200") for what, kind in asked]
    assert calls[1:] == expected


def test_what_is_written(run_sweep):
    result = run_sweep(OSCILLATOR + HELD, "0.1, 0.5, 5", more=f"{PUSHED}\n*NODE PRINT\nU, PU\n*MONITOR, NODE=2, DOF=1")
    times = [row.total_time for row in result.status]
    np.testing.assert_allclose(times, result.history["time"], rtol=1e-2)
    data = result.file(".dat").read_text()
    assert "FREQUENCY (CYCLES/TIME)  0.224" in data
    x = (3 + 4j) / stiffness(result.history)
    assert f"          2      {exponential(abs(x[0])).strip()}  {exponential(np.angle(x[0], deg=True)).strip()}" in data
    np.testing.assert_allclose(result.field("U", increment=2)[1, 0], x[1].real)
    np.testing.assert_allclose(result.field("U_imaginary", increment=2)[1, 0], x[1].imag)
    message = result.file(".msg").read_text()
    assert "NUMBER OF FREQUENCIES                                       5" in message
    assert "D I R E C T   S O L U T I O N   S T E A D Y   S T A T E" in message


def test_every_second_frequency(run_sweep):
    result = run_sweep(OSCILLATOR + HELD, more=f"{PUSHED}\n*NODE PRINT, FREQUENCY=2\nU")
    data = result.file(".dat").read_text()
    assert [f"INCREMENT{k:6d} SUMMARY" in data for k in range(1, 6)] == [False, True, False, True, True]


def test_phases_are_there_for_harmonic_responses_alone(run_sweep):
    after = "*STEP\n*STATIC\n*NODE PRINT\nPU\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nPU1\n*END STEP\n"
    result = run_sweep(OSCILLATOR + HELD, after=after)
    data = result.file(".dat").read_text()
    assert "*NODE PRINT: PU IS NOT AVAILABLE AND IS LEFT OUT" in data
    assert "HISTORY OUTPUT OF PU1 of ALL IS NOT AVAILABLE" in data


def test_resonance_without_damping(run_sweep):
    """A frequency at which the matrix is singular is named like any other singular matrix."""
    with pytest.raises(SingularMatrixError, match="node 2, dof 1"):
        run_sweep(OSCILLATOR + HELD, f"{1.5 / (2 * np.pi)!r}", how=", REAL ONLY")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (", DIRECT", "", r"\*STEADY STATE DYNAMICS by modes needs a \*FREQUENCY step before it"),
        (", DIRECT", ", DIRECT, INTERVAL=SPREAD", "INTERVAL=SPREAD is not supported"),
        (", DIRECT", ", SUBSPACE PROJECTION=RANGE", "SUBSPACE PROJECTION=RANGE is not supported"),
        ("0.1, 0.5, 5", "", "needs a data line with a frequency, or the limits of a range"),
        ("0.1, 0.5, 5", "0.5, 0.1", "the upper limit 0.1 is not above the lower one, 0.5"),
        ("0.1, 0.5, 5", "0., 0.1", "frequency 0 must be positive"),
        ("0.1, 0.5, 5", "-1.", "frequency -1 must be positive"),
        ("0.1, 0.5, 5", "0.1, 0.5, 5, -1.", "bias parameter -1 must be positive"),
        ("0.1, 0.5, 5", "0.1, 0.5, 5, 1., 2.", "5 entries, expected at most 4"),
        ("0.1, 0.5, 5", "0.1, 0.5, 100001", "number of points 100001 is above 100000"),
        ("*CLOAD, IMAGINARY", "*CLOAD, IMAGINARY, REAL", r"\*CLOAD: REAL and IMAGINARY exclude each other"),
        ("*STEADY STATE DYNAMICS, DIRECT\n0.1, 0.5, 5", "*STATIC", r"\*CLOAD: REAL and IMAGINARY are for \*STEADY"),
        ("*BOUNDARY\n1, 1\n", "*BOUNDARY, REAL\n1, 1\n", r"\*BOUNDARY: REAL and IMAGINARY are for \*STEADY STATE"),
        ("*CLOAD\n", "*DLOAD\nE, U1, 1.\n*CLOAD\n", "harmonic loads on user elements are not supported"),
        ("*CLOAD\n", "*BOUNDARY, TYPE=VELOCITY\n1, 1, 1, 1.\n*CLOAD\n", "has no meaning in a linear perturbation"),
        (
            *("*CLOAD\n", "*CLOAD, AMPLITUDE=A\n"),
            "an amplitude is a function of frequency here, which UAMP cannot give",
        ),
    ],
)
def test_what_is_wrong_is_named(tmp_path, old, new, message):
    deck = OSCILLATOR + HELD + STEP.format(how="", frequencies="0.1, 0.5, 5", more=PUSHED)
    assert old in deck
    (tmp_path / "deck.inp").write_text("*AMPLITUDE, NAME=A, DEFINITION=USER\n" + deck.replace(old, new))
    with pytest.raises(DeckError, match=message):
        read_deck(tmp_path / "deck.inp")
