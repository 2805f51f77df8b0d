# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements of *DYNAMIC steps: inertia is no stiffness."""

import re
from pathlib import Path

import pytest

from uel.check.examine import examine
from uel.check.finding import Verdict

QUAD = Path(__file__).parent / "dynamic_quad.f"

DYNAMIC = (
    ("PROPERTIES=3, I PROPERTIES=1, VARIABLES=12", "PROPERTIES=4, I PROPERTIES=2, VARIABLES=16"),
    ("1000., 0.3, 2., ", "1000., 0.3, 2., 0.1, "),
    ("*STATIC, DIRECT\n0.5, 1.", "*DYNAMIC\n0.01, 0.1"),
    ("3, 1, 1, 0.01\n6, 1, 1, 0.01\n9, 1, 1, 0.01\n", "*CLOAD\n3, 1, 1.\n6, 1, 2.\n9, 1, 1.\n"),
    ("3, 2\n", ""),
)
LUMPED, CONSISTENT = 0, 1


def findings(patch, mistake, mass):
    (report,) = examine(patch(f"{mistake}, {mass}", *DYNAMIC), QUAD).types
    return report.findings


@pytest.mark.parametrize("mass", [LUMPED, CONSISTENT])
def test_right_element_passes(patch, mass):
    found = findings(patch, 0, mass)
    assert not [(name, finding) for name, finding in found.items() if finding.verdict is Verdict.FAILED]
    assert {name for name, finding in found.items() if finding.verdict is Verdict.NOT_APPLICABLE} == {
        *("energy", "increments", "loads")
    }
    assert found["zero-modes"].message == "3 zero modes, the 3 rigid-body motions"


@pytest.mark.sample(3)
@pytest.mark.parametrize("mass", [LUMPED, CONSISTENT])
@pytest.mark.parametrize(
    ("mistake", "check", "message"),
    [
        (2, "zero-modes", r"-dRHS/dU has 5 zero modes, but there are 3 rigid-body motions"),
        (3, "rotation", r"a small rigid rotation causes forces of 25.2 %"),
        (8, "translation", r"RHS\(1\) changes by .* in direction 1"),
        (20, "patch", r"node 5, .* the forces of its 4 elements do not balance"),
        (
            51,
            "requests",
            r"in the increment in which U changes, RHS\(\d\) of a normal call changes by .*; alpha is -0.05",
        ),
        (52, "requests", r"in the increment after that, RHS\(\d\) of a normal call changes by .*; alpha is -0.05"),
        (53, "shear", r"the shear stiffness in directions 1 and 2 is 2 times that of an isotropic material"),
        (50, "state", r"with a tenth of DU and DTIME and the same U"),
    ],
)
def test_mistakes_in_the_stiffness_are_found(patch, mistake, check, message, mass):
    finding = findings(patch, mistake, mass)[check]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message


def test_inertia_of_displacements(patch, tmp_path):
    """An element that makes its accelerations of DU, for a body at rest: rotations are not judged in that deck."""
    text = QUAD.read_text().replace("'../uel.inc'", f"'{QUAD.parents[1] / 'uel.inc'}'")
    user = tmp_path / "own.f"
    user.write_text(text.replace("matmul(mass, a)", "matmul(mass, du(1:8,1)/(params(2)*dtime**2))"))
    (report,) = examine(patch("0, 0", *DYNAMIC), user).types
    for name in ("rotation", "patch", "zero-modes"):
        assert report.findings[name].verdict is Verdict.NOT_APPLICABLE
        assert (
            report.findings[name].message
            == "the element computes inertia from DU, not from A: take a deck with a static step"
        )
