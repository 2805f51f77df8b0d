# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Single checks on elements of tests/programs/adversarial: with a mistake they fail, without it they pass."""

import re
from pathlib import Path

import pytest

from uel.check.checks import CHECKS
from uel.check.examine import examine
from uel.check.finding import Verdict

TESTS = Path(__file__).parents[2]
ELEMENTS = TESTS / "programs" / "adversarial" / "elements"

TRANSPOSED = (
    "dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det",
    "dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(1,2))/det",
)
ONE_VOLUME = ("        stiff = stiff + volume", "        if (k == 1) first = volume\n        stiff = stiff + first")
KEPT_TIME = (
    "decay = exp(-dtime/props(3))",
    "if (dtold == 0) dtold = dtime\n        decay = exp(-dtold/props(3))\n        dtold = dtime\n"
    "      data dtold /0d0/",
)
LOCAL_MASS = ("amatrx = matmul(transpose(turn), matmul(mass, turn))", "amatrx = mass")
HALF = "          rhs(1:24,1) = -mass*a - (1 + params(1))*force + params(1)*(svars(1:24) + svars(25:48))/2\n"
THIN = ("amatrx(i,i) + volume*props(2)*shape(i)", "amatrx(i,i) + det*props(2)*shape(i)")
DDLMAG = (
    "rhs(1:6:2,1) = rhs(1:6:2,1) + volume*adlmag(i,1)/3",
    "rhs(1:6:2,1) = rhs(1:6:2,1) + volume*ddlmag(i,1)/3",
)
ROWS = (
    "        b(2,2:8:2) = dx(:,2)\n        b(3,1:8:2) = dx(:,2)\n        b(3,2:8:2) = dx(:,1)\n",
    "        b(3,2:8:2) = dx(:,2)\n        b(2,1:8:2) = dx(:,2)\n        b(2,2:8:2) = dx(:,1)\n",
)
NO_STRAIN_22 = ("        b(2,2:16:2) = dx(:,2)\n", "")
FORGOTTEN = ("      svars(2) = svars(2) + props(4)*step\n", "")
THIS_INCREMENT = ("energy(5) = energy(5) + dissipated", "energy(5) = dissipated")
KINC = ("exp(-time(2)/props(3))", "exp(-0.125d0*kinc/props(3))")

MISTAKES = [
    ("heat", TRANSPOSED, "patch", "node 5, .*: the forces of its 4 elements do not balance for dof 11 = x1 times"),
    (
        "brick",
        ONE_VOLUME,
        "patch",
        "element .: the forces of u1 = x. times a constant are not those of a uniform stress",
    ),
    ("solid", KEPT_TIME, "repeat", "returns different values after calls with another DTIME: "),
    (
        "beam",
        LOCAL_MASS,
        "requests",
        r"turned about axis 3 by 29 degrees, entry \(1,3\) of its mass matrix is 0, and has",
    ),
    ("brick", (HALF, HALF + "          svars(1:24) = force\n"), "requests", r"SVARS\(1\) is .* with LFLAGS\(3\) = 5, "),
    ("heat", THIN, "requests", r"AMATRX with LFLAGS\(3\) = 4 for dof 11 add up to .*, the capacity in RHS to"),
    ("imperfect", DDLMAG, "loads", "RHS does not change when the magnitude of U1 is doubled"),
    ("ageing", KINC, "increments", "RHS changes if KINC is larger by 3"),
    ("condensed", ROWS, "shear", "isotropic material only if strain 22 and shear strain 12 are exchanged"),
    ("arch", FORGOTTEN, "history", r"RHS depends on SVARS\(2\) on entry, and no call writes any of them"),
    ("viscous", THIS_INCREMENT, "energy", r"ENERGY\(1\) to \(7\) are .* with DU = 0, and .* on entry"),
]

RIGHT = [
    ("heat", "patch", "forces balance at 1 nodes"),
    ("brick", "patch", "forces of single elements are those of a uniform stress or flux"),
    ("imperfect", "patch", "which differs from element to element"),
    ("phasefield", "state", "increments begin with the forces of the end of the last one"),
    ("ageing", "energy", "ENERGY grows by the work of the forces"),
    ("reduced", "zero-modes", "4 zero modes, more than the 3 rigid-body motions, but"),
    ("heat", "requests", r"capacity of dof 11 \(4\)"),
    ("frame", "requests", "mass"),
]


@pytest.fixture
def findings(tmp_path):
    """Findings of some checks about an element, with some text replaced."""

    def findings(element, checks, old="", new=""):
        text = (ELEMENTS / f"{element}.f").read_text("utf-8")
        assert not old or text.count(old) == 1
        source = tmp_path / f"{element}.f"
        source.write_text(
            text.replace(old or "\0", new).replace("../../harness/uel.inc", str(TESTS / "harness" / "uel.inc")), "utf-8"
        )
        others = [other.name for other in CHECKS if other.name not in checks]
        (report,) = examine(ELEMENTS / f"{element}.inp", [source], skip=others).types
        return report.findings

    return findings


@pytest.fixture
def finding(findings):
    """Finding of one check about an element, with some text replaced."""
    return lambda element, check, *mistake: findings(element, [check], *mistake)[check]


@pytest.mark.sample(4)
@pytest.mark.parametrize(("element", "mistake", "check", "message"), MISTAKES)
def test_mistake_is_found(finding, element, mistake, check, message):
    found = finding(element, check, *mistake)
    assert found.verdict is Verdict.FAILED
    assert re.search(message, found.message), found.message
    assert found.advice


@pytest.mark.sample(4)
@pytest.mark.parametrize(("element", "check", "message"), RIGHT)
def test_right_element_passes(finding, element, check, message):
    found = finding(element, check)
    assert found.verdict is Verdict.PASSED, found.message
    assert re.search(message, found.message), found.message


def test_uniform_strain_without_energy_is_no_matter_of_points(finding):
    found = finding("reduced", "zero-modes", *NO_STRAIN_22)
    assert found.verdict is Verdict.FAILED
    assert "more integration points do not help" in found.advice


def test_variable_that_keeps_the_time_increment_outlives_a_call(finding):
    found = finding("solid", "threads", *KEPT_TIME)
    assert found.verdict is Verdict.PASSED
    assert "local variable DTOLD" in found.message


def test_one_variable_is_blamed_once(findings):
    counted = (
        "      data number /0/\n      number = number + 1\n      stress = props(1)*strain + branch + 1d-3*number\n"
    )
    found = findings("solid", ["repeat", "rest"], "      stress = props(1)*strain + branch\n", counted)
    assert found["repeat"].verdict is Verdict.FAILED
    assert found["rest"].verdict is Verdict.NOT_APPLICABLE
    assert found["rest"].message == "it tells nothing while 'repeat' fails"


def test_age_by_the_time_of_the_step(finding):
    found = finding("ageing", "energy", "exp(-time(2)/props(3))", "exp(-time(1)/props(3))")
    assert found.verdict is Verdict.FAILED
    assert "TIME(1) starts again in each step" in found.advice
