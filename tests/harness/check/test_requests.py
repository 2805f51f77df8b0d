# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What LFLAGS(3) asks for: residuals, mass matrices, the stiffness alone."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from uel.check.finding import Verdict
from uel.check.recording import Pass, record
from uel.elements import Flags, Request

QUAD = Path(__file__).parent / "quad.f"
OSCILLATORS = Path(__file__).parents[1] / "procedures" / "oscillators.f"


def test_residual_alone(findings, patch):
    """Corrections that are too large need the line search, which asks for the residual alone."""
    search = "*CONTROLS, PARAMETERS=LINE SEARCH\n4\n*END STEP"
    requests = findings(patch(25, ("*END STEP", search)))["requests"]
    assert requests.message == "LFLAGS(3): residual only (5)"
    requests = findings(patch(26, ("*END STEP", search)))["requests"]
    assert requests.verdict is Verdict.FAILED
    assert re.search(r"RHS\(1\) is .* with LFLAGS\(3\) = 5, .* with 1", requests.message)
    assert re.search("asks for RHS only", requests.advice)


OSCILLATOR = """\
*NODE
1, 0.
2, 1.
3, 2.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=3, I PROPERTIES=1, VARIABLES=4
1
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
2, 2, 3
*UEL PROPERTY, ELSET=ALL
4., 0.25, 1., 0
*STEP
*DYNAMIC
0.1, 0.3
*BOUNDARY
1, 1
*CLOAD
3, 1, 1.
*END STEP
"""


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    "requests, wrong, message, advice",
    [
        ("", "", None, None),
        ("4", "amatrx = 0", r"AMATRX is zero with LFLAGS\(3\) = 4", "otherwise the element has no inertia"),
        ("6", "amatrx = 2*amatrx", r"AMATRX differs between LFLAGS\(3\) = 4 and 6 by 0.25", "Both ask for the mass"),
        ("4 6", "amatrx = -amatrx", "the mass matrix has a negative eigenvalue, -1 of", "whether the stiffness is"),
        ("4 6", "amatrx(1,2) = 0.1d0", "the mass matrix is not symmetric, by 0.1", "Inertia has a potential"),
        (
            *("1", "rhs(1,1) = rhs(1,1) + 0.1d0*a(1)"),
            r"AMATRX\(1,1\) is 0.25 with LFLAGS\(3\) = 4; -dRHS\(1\)/dA\(1\) of a normal call is 0.15",
            "includes -M A, with the mass matrix M",
        ),
        (
            *("5", "rhs(1:2,1) = rhs(1:2,1)/2"),
            r"when U changes, RHS\(1\) changes by \S+ with LFLAGS\(3\) = 5, by \S+ with 1",
            "asks for the residual at half the increment",
        ),
        (
            *("5", "rhs(1:2,1) = rhs(1:2,1) + props(2)*a(1:2)"),
            r"when A changes, RHS\(\d\) changes by 0 with LFLAGS\(3\) = 5",
            "From it Abaqus chooses the next increment",
        ),
    ],
)
def test_mass_matrix(findings, tmp_path, requests, wrong, message, advice):
    """The oscillators of the dynamic tests, with another mass matrix in some requests."""
    source = OSCILLATORS.read_text().replace("'../uel.inc'", f"'{OSCILLATORS.parents[1] / 'uel.inc'}'")
    lines = "".join(f"      if (lflags(3) .eq. {number}) {wrong}\n" for number in requests.split())
    user, deck = tmp_path / "oscillators.f", tmp_path / "oscillators.inp"
    head, end, _ = source.rpartition("      end\n")
    user.write_text(head + lines + end)
    deck.write_text(OSCILLATOR)
    found = findings(deck, user)
    if message is None:
        assert found["requests"].message == "LFLAGS(3): mass (4 and 6), weights of alpha, half-increment residual (5)"
        assert not [name for name, finding in found.items() if finding.verdict is Verdict.FAILED]
        return
    assert found["requests"].verdict is Verdict.FAILED
    assert re.search(message, found["requests"].message), found["requests"].message
    assert re.search(advice, found["requests"].advice)


FREQUENCIES = """\
*STEP
*FREQUENCY
1
*END STEP
"""


@pytest.mark.parametrize(
    "line, message",
    [
        ("if (lflags(3) .eq. 2) amatrx = stiff", r"LFLAGS\(3\): stiffness only \(2\), mass \(4\)$"),
        ("", r"AMATRX\(\d,\d\) is 0 with LFLAGS\(3\) = 2, \S+ with 1"),
    ],
)
def test_frequencies(findings, tmp_path, line, message):
    """A static step and natural frequencies; without a stiffness these end the run, not the checks."""
    source = OSCILLATORS.read_text().replace("'../uel.inc'", f"'{OSCILLATORS.parents[1] / 'uel.inc'}'")
    head, end, _ = source.rpartition("      end\n")
    user, deck = tmp_path / "oscillators.f", tmp_path / "oscillators.inp"
    user.write_text(f"{head}      {line}\n{end}")
    deck.write_text(OSCILLATOR.replace("*DYNAMIC\n0.1, 0.3", "*STATIC, DIRECT\n1., 1.") + FREQUENCIES)
    requests = findings(deck, user)["requests"]
    assert re.search(message, requests.message), requests.message
    assert requests.verdict is (Verdict.PASSED if line else Verdict.FAILED)


def test_deck_of_linear_steps_alone(findings, patch):
    """Its elements are called as in a static step too."""
    found = findings(patch(0, ("*STEP", "*STEP, PERTURBATION"), ("*STATIC, DIRECT\n0.5, 1.", "*STATIC")))
    assert not [name for name, finding in found.items() if finding.verdict is Verdict.FAILED]
    assert found["tangent"].verdict is Verdict.PASSED
    assert found["requests"].message == "LFLAGS(3): linear step (1), linear step (100)"
    found = findings(patch(5, ("*STEP", "*STEP, PERTURBATION"), ("*STATIC, DIRECT\n0.5, 1.", "*STATIC")))
    assert found["tangent"].verdict is Verdict.FAILED


@pytest.mark.parametrize(
    ("mistake", "message"),
    [
        (43, r"RHS\(\d\) is \S+ with LFLAGS\(3\) = 1 and LFLAGS\(4\) = 1, not -?0$"),
        (44, r"RHS\(\d\) is 0 with LFLAGS\(3\) = 100 and LFLAGS\(4\) = 1, not \S+$"),
    ],
)
def test_forces_of_a_linear_step(findings, patch, mistake, message):
    """Those of the base state, as in a general step; and none where the change is known."""
    linear = "*END STEP\n*STEP, PERTURBATION\n*STATIC\n*CLOAD\n9, 1, 1.\n*END STEP"
    requests = findings(patch(mistake, ("*END STEP", linear)))["requests"]
    assert requests.verdict is Verdict.FAILED
    assert re.search(message, requests.message), requests.message
    assert re.search("Abaqus would take them for loads", requests.advice)


def test_element_without_mass(findings, tmp_path):
    deck = tmp_path / "oscillators.inp"
    deck.write_text(OSCILLATOR.replace("4., 0.25, 1.", "4., 0., 1."))
    assert findings(deck, OSCILLATORS)["requests"].message.startswith(
        "LFLAGS(3): no mass (4 and 6), weights of alpha, half"
    )


@pytest.mark.parametrize(
    "mistake, message, advice",
    [
        (0, "LFLAGS(3): stiffness only (2), no mass (4)", None),
        (36, r"AMATRX\(\d,\d\) is 0 with LFLAGS\(3\) = 2, \S+ with 1", "asks for the stiffness only"),
        (37, r"AMATRX with LFLAGS\(3\) = 4 is the stiffness, as with 1", r"Test LFLAGS\(3\) at the beginning"),
    ],
)
def test_requests_for_eigenfrequencies(findings, patch, monkeypatch, mistake, message, advice):
    """The calls that *FREQUENCY makes, behind those of a static step."""

    def recorded(*arguments, **options):
        recording = record(*arguments, **options)
        last = [event for event in recording.events if isinstance(event, Pass)][-1]
        calls = [
            replace(last.call, flags=Flags(41, request=request, linear=True))
            for request in (Request.STIFFNESS, Request.MASS)
        ]
        return replace(recording, events=(*recording.events, *(replace(last, call=call) for call in calls)))

    monkeypatch.setattr("uel.check.recording.record", recorded)
    requests = findings(patch(mistake))["requests"]
    if advice is None:
        assert requests.message == message
    else:
        assert requests.verdict is Verdict.FAILED
        assert re.search(message, requests.message)
        assert re.search(advice, requests.advice)


HARMONIC = """\
*STEP
*STEADY STATE DYNAMICS, DIRECT
0.2
*CLOAD
3, 1, 1.
*END STEP
"""
DAMPER = """\
      if (lflags(3) .eq. 2) amatrx = stiff
      if (lflags(3) .eq. 3) then
        amatrx = 0
        if (lflags(7) .eq. 1) amatrx = stiff/8
        if (lflags(7) .eq. 2) amatrx = stiff/16
      end if
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "wrong, message, advice",
    [
        ("", r"LFLAGS\(3\): stiffness only \(2\), mass \(4\), damping \(3\)$", None),
        ("amatrx = 0", r"LFLAGS\(3\): stiffness only \(2\), mass \(4\), no damping \(3\)$", None),
        (
            *(
                "if (lflags(7) .eq. 2) amatrx = stiff",
                r"LFLAGS\(3\) = 3 and LFLAGS\(7\) = 2 is the stiffness, as with 1",
            ),
            r"Test LFLAGS\(3\) at the beginning",
        ),
        (
            *("amatrx = stiff/8", r"AMATRX with LFLAGS\(3\) = 3 is the same for LFLAGS\(7\) = 1 and 2"),
            "return zero for the one that the element does not have",
        ),
        (
            *("if (lflags(7) .eq. 2) amatrx = -amatrx", "the structural damping matrix has no positive eigenvalue"),
            "Check its sign",
        ),
    ],
)
def test_damping_of_harmonic_responses(findings, tmp_path, wrong, message, advice):
    user, deck = tmp_path / "oscillators.f", tmp_path / "oscillators.inp"
    user.write_text(_damped(wrong))
    deck.write_text(OSCILLATOR.replace("*DYNAMIC\n0.1, 0.3", "*STATIC, DIRECT\n1., 1.") + HARMONIC)
    requests = findings(deck, user)["requests"]
    assert requests.verdict is (Verdict.FAILED if advice else Verdict.PASSED)
    assert re.search(message, requests.message), requests.message
    assert advice is None or re.search(advice, requests.advice)


@pytest.mark.parametrize(
    "factor, message",
    [
        (
            "0.5d0",
            r"LFLAGS\(3\): mass \(4 and 6\), weights of alpha, half-increment residual \(5\), stiffness only",
        ),
        (
            "0.6d0",
            r"is 0.5 with LFLAGS\(3\) = 3 and LFLAGS\(7\) = 1; -dG\(1\)/dV\(1\) of a call of .DYNAMIC is 0.6$",
        ),
    ],
)
def test_damping_against_dynamics(findings, tmp_path, factor, message):
    """Viscous forces in *DYNAMIC, 0.5 times the velocity by which the spring of 4 grows, and their matrix."""
    lines = _damped("").replace("      force = (/", f"      f = f + {factor}*(v(2) - v(1))\n      force = (/")
    rate = f"1 + {factor}*params(3)/(4*params(2)*dtime)"
    user, deck = tmp_path / "oscillators.f", tmp_path / "oscillators.inp"
    user.write_text(lines.replace("amatrx = (1 + params(1))*stiff", f"amatrx = (1 + params(1))*stiff*({rate})"))
    static = "*STEP\n*STATIC, DIRECT\n1., 1.\n*END STEP\n"
    dynamic = OSCILLATOR.replace("4., 0.25, 1.", "4., 0.25, 0.").replace(
        "*DYNAMIC\n0.1, 0.3", "*DYNAMIC, DIRECT\n0.1, 0.1"
    )
    deck.write_text(dynamic + static + HARMONIC)
    requests = findings(deck, user)["requests"]
    assert re.search(message, requests.message), requests.message
    assert requests.verdict is (Verdict.PASSED if factor == "0.5d0" else Verdict.FAILED)


def _damped(wrong):
    """Oscillators with damping, a line of which is wrong."""
    source = OSCILLATORS.read_text().replace("'../uel.inc'", f"'{OSCILLATORS.parents[1] / 'uel.inc'}'")
    head, end, _ = source.rpartition("      end\n")
    line = f"      if (lflags(3) .eq. 3) then\n        {wrong}\n      end if\n" if wrong else ""
    return f"{head}{DAMPER}{line}{end}"
