# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*AMPLITUDE, DEFINITION=USER: UAMP gives the force on a spring of stiffness 2; what it is told comes back as force."""

import textwrap
from types import SimpleNamespace

import numpy as np
import pytest

from uel.errors import DeckError, Source, UelError
from uel.model.amplitude import AmplitudeType, UserAmplitude
from uel.model.procedures import Static
from uel.model.steps import Load, Step
from uel.model.user_values import GivenAmplitude
from uel.procedures.loads.user_amplitudes import UserAmplitudes

DECK = """*NODE, NSET=ALL
1, 0.
2, 1.
*NSET, NSET=END
2
*ELEMENT, TYPE=SPRINGA, ELSET=S
1, 1, 2
*SPRING, ELSET=S

2.
*BOUNDARY
1, 1, 3
2, 2, 3
*AMPLITUDE, NAME=Told, DEFINITION=USER, PROPERTIES=9, VARIABLES=2{time}
1., 2., 3., 4., 5., 6., 7., 8.,
9.
*STEP, INC=20
*STATIC{direct}
0.25, 1.
*CLOAD, AMPLITUDE=TOLD
2, 1, 10.
{requests}
*END STEP
{more}"""
REQUESTS = """*OUTPUT, HISTORY, OP=ADD
*NODE OUTPUT, NSET=ALL
U, CF
*OUTPUT, HISTORY, SENSOR, NAME=Stretch, OP=ADD
*NODE OUTPUT, NSET=END
U1"""
SECOND = """*STEP
*STATIC, DIRECT
0.5, 1.
{}
*END STEP
"""
UAMP = """      SUBROUTINE UAMP(AMPNAME,TIME,AMPVALUEOLD,DT,NPROPS,PROPS,NSVARS,
     1  SVARS,LFLAGSINFO,NSENSOR,SENSORVALUES,SENSORNAMES,
     2  JSENSORLOOKUPTABLE,AMPVALUENEW,LFLAGSDEFINE,AMPDERIVATIVE,
     3  AMPSECDERIVATIVE,AMPINCINTEGRAL,AMPDOUBLEINTEGRAL)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 AMPNAME,SENSORNAMES(NSENSOR)
      DIMENSION TIME(2),PROPS(NPROPS),SVARS(NSVARS),LFLAGSINFO(4),
     1  SENSORVALUES(NSENSOR),JSENSORLOOKUPTABLE(*),LFLAGSDEFINE(6)
      IF (AMPNAME .NE. 'TOLD') CALL XIT
%s
      END
"""


@pytest.fixture
def run_with_uamp(run_deck):
    def run_with_uamp(body, *, requests=REQUESTS, more="", direct=", DIRECT", time="", user=UAMP):
        text = DECK.format(requests=requests, more=more, direct=direct, time=time)
        return run_deck(text, user.replace("%s", textwrap.indent(body, 6 * " ")))

    return run_with_uamp


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("TIME(1) + 100*TIME(2)", [25.25, 50.5, 75.75, 101, 150.5, 201]),
        ("DT", [0.25, 0.25, 0.25, 0.25, 0.5, 0.5]),
        ("NPROPS + PROPS(1) + 10*PROPS(9)", [100] * 6),
        # the call at the start of a step has a value too
        ("AMPVALUEOLD + LFLAGSINFO(1) + 10*LFLAGSINFO(2)", [11, 21, 31, 41, 52, 62]),
        ("LFLAGSINFO(3) + 10*LFLAGSINFO(4) + 100*NSVARS + 1000*NSENSOR", [1210] * 4 + [1220] * 2),
    ],
)
def test_arguments(run_with_uamp, expression, expected):
    more = SECOND.format("*CLOAD, AMPLITUDE=TOLD\n2, 1, 10.")
    history = run_with_uamp(f"AMPVALUENEW = {expression}", more=more).history
    np.testing.assert_allclose(history["CF1[ALL:2]"], 10 * np.array(expected))
    np.testing.assert_allclose(history["U1[ALL:2]"], 10 * np.array(expected) / 2)


def test_a_sensor_has_the_value_of_the_last_increment(run_with_uamp):
    """Force 10 (1 + u/10) with u of the increment before: u' = 5 + u/2, from zero."""
    history = run_with_uamp("AMPVALUENEW = 1 + GETSENSORVALUE('STRETCH',JSENSORLOOKUPTABLE,SENSORVALUES)/10").history
    np.testing.assert_allclose(history["U1[ALL:2]"], [5, 7.5, 8.75, 9.375])


def test_a_sensor_by_its_number(run_with_uamp):
    body = "K = IGETSENSORID('STRETCH',JSENSORLOOKUPTABLE)\nIF (SENSORNAMES(K) .EQ. 'STRETCH') AMPVALUENEW = K"
    np.testing.assert_allclose(run_with_uamp(body).history["CF1[ALL:2]"], 10)


def test_state_variables_go_on(run_with_uamp):
    body = "SVARS(1) = SVARS(1) + LFLAGSINFO(2)\nSVARS(2) = SVARS(2) + 10*LFLAGSINFO(1)\nAMPVALUENEW = SUM(SVARS)"
    np.testing.assert_allclose(run_with_uamp(body).history["CF1[ALL:2]"], 10 * np.array([11, 12, 13, 14]))


@pytest.mark.parametrize(("time", "expected"), [("", [2.5, 5, 7.5, 10, 10, 10]), (", TIME=TOTAL TIME", None)])
def test_in_a_later_step_it_goes_on_only_in_total_time(run_with_uamp, time, expected):
    history = run_with_uamp("AMPVALUENEW = TIME(2)", more=SECOND.format(""), time=time).history
    np.testing.assert_allclose(history["CF1[ALL:2]"], expected or [2.5, 5, 7.5, 10, 15, 20])


def test_a_step_may_be_concluded(run_with_uamp):
    """After the second of four increments; a load that ramps beside it stays where it is."""
    body = "AMPVALUENEW = TIME(1)\nIF (TIME(1) .GT. 0.4) LFLAGSDEFINE(6) = 1"
    result = run_with_uamp(body, requests=REQUESTS + "\n*CLOAD\n2, 1, 100.", more=SECOND.format(""))
    np.testing.assert_allclose(result.history["time"], [0.25, 0.5, 1.0, 1.5])
    np.testing.assert_allclose(result.history["CF1[ALL:2]"], [27.5, 55, 55, 55])


def test_state_and_value_of_an_attempt_that_failed_are_dropped():
    amplitude = UserAmplitude("A", AmplitudeType.USER, np.zeros(0), Source("a.inp", 1), variables=1)

    class Adds:
        """UAMP that adds the time increment to its state."""

        uamp = 1

        def user_amplitude(self, asked):
            return GivenAmplitude(asked.state[0] + asked.size, asked.state + asked.size, concludes=False)

    load = Load(np.array([0]), 1, 1.0, amplitude, amplitude.source)
    step = Step(1, "", Static(), amplitude.source, loads=(load,))
    model = SimpleNamespace(steps=(step,))
    running = UserAmplitudes(model).start_step(step, None, SimpleNamespace(total_time=0.0), Adds())
    running.attempt(1, (1.0, 1.0), 1.0, 0)
    assert amplitude.value(1.0, 1.0) == 1.0
    running.attempt(1, (0.25, 0.25), 0.25, 1)
    running.converged()
    running.attempt(2, (0.5, 0.5), 0.25, 0)
    assert [amplitude.value(t, t) for t in (0.0, 0.125, 0.25, 0.5)] == [0.0, 0.125, 0.25, 0.5]


def test_a_velocity_is_integrated(run_with_uamp):
    """V = 3 t^2 linear between the ends of increments of 0.25: the trapezoidal rule."""
    requests = REQUESTS + "\n*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=TOLD\n2, 1, 1, 3."
    history = run_with_uamp("AMPVALUENEW = TIME(1)**2", requests=requests).history
    ends = np.linspace(0, 1, 5)
    np.testing.assert_allclose(history["U1[ALL:2]"], [np.trapezoid(3 * ends[:k] ** 2, ends[:k]) for k in (2, 3, 4, 5)])


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("CALL XIT", r"user.f: UAMP stopped the analysis .*\(amplitude TOLD, step 1, increment 0\)"),
        ("AMPVALUENEW = 1\nLFLAGSDEFINE(5) = LFLAGSINFO(2)", r"by lFlagsDefine\(5\) \(.*, increment 1\)"),
        ("AMPVALUEOLD = 1", r"UAMP does not set AmpValueNew, or sets it to NaN or infinity"),
        ("AMPVALUENEW = GETSENSORVALUE('OTHER',JSENSORLOOKUPTABLE,SENSORVALUES)", "there is no sensor OTHER"),
    ],
)
def test_ends_of_the_analysis(run_with_uamp, body, message):
    with pytest.raises(UelError, match=message):
        run_with_uamp(body)


def test_it_needs_uamp(run_with_uamp):
    with pytest.raises(DeckError, match=r"deck.inp:14: \*AMPLITUDE, DEFINITION=USER needs UAMP, which the job"):
        run_with_uamp("", user="      SUBROUTINE OTHER\n      END\n")


def test_it_has_no_meaning_along_a_path(run_with_uamp):
    with pytest.raises(DeckError, match="an amplitude has no meaning in a step whose load factor"):
        run_with_uamp("AMPVALUENEW = 1", direct=", RIKS")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("PROPERTIES=9", "PROPERTIES=8", r"deck.inp:14: \*AMPLITUDE: PROPERTIES=8, but the data lines have 9"),
        ("VARIABLES=2", "VARIABLES=0", r"VARIABLES=0: expected a number from 1 to"),
        ("DEFINITION=USER", "DEFINITION=TABULAR", "PROPERTIES and VARIABLES are for DEFINITION=USER"),
        ("NAME=Stretch, ", "", r"\*OUTPUT: SENSOR needs HISTORY and NAME="),
        ("NSET=END\nU1", "NSET=ALL\nU1", r"sensor STRETCH must be one component, such as U2, of one node"),
        ("NSET=END\nU1", "NSET=END\nU", r"sensor STRETCH must be one component, such as U2, of one node"),
        ("NSET=END\nU1", "NSET=END\nUR1", r"deck.inp:17: sensor STRETCH: no element uses dof 4 of node 2"),
    ],
)
def test_what_is_wrong_in_a_deck_is_named(run_with_uamp, monkeypatch, old, new, message):
    monkeypatch.setattr(f"{__name__}.DECK", DECK.replace(old, new, 1))
    with pytest.raises(DeckError, match=message):
        run_with_uamp("AMPVALUENEW = 1", requests=REQUESTS.replace(old, new, 1))
