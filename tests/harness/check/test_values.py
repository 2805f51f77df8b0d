# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What UEL returns beside RHS and AMATRX: numbers; and what it does with loads."""

import re
from pathlib import Path

import pytest

from uel.check.finding import Verdict
from uel.cli import main

FOLDER = Path(__file__).parents[1]

SPRING = """\
      include '{folder}/uel.inc'
      rhs(1,1) = 10*(u(2) - u(1))
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = 10
      amatrx(2,2) = 10
      amatrx(1,2) = -10
      amatrx(2,1) = -10
      {line}
      end
"""
DECK = """\
*NODE
1, 0.
2, 1.
3, 2.
4, 3.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, VARIABLES=3
1
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
2, 2, 3
3, 3, 4
*UEL PROPERTY, ELSET=ALL
*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
1, 1
4, 1, 1, 0.1
{load}*END STEP
"""
ROOT = "sqrt(-1 - u(1)**2)"


@pytest.fixture
def model(tmp_path):
    def model(line, load=""):
        deck, user = tmp_path / "springs.inp", tmp_path / "springs.f"
        deck.write_text(DECK.format(load=load))
        user.write_text(SPRING.format(folder=FOLDER, line=line))
        return deck, user

    return model


@pytest.mark.sample(2)
@pytest.mark.nan
@pytest.mark.parametrize("entry", ["ENERGY(2)", "SVARS(3)", "PNEWDT"])
@pytest.mark.parametrize("value", ["nan", "inf"])
def test_values_that_are_no_numbers(findings, model, entry, value):
    """In an element of which no states are taken, in one iteration."""
    number = ROOT if value == "nan" else "1/(0*abs(u(1)))"
    finding = findings(*model(f"if (jelem == 2 .and. kinc == 2) {entry.lower()} = {number}"))["values"]
    assert finding.verdict is Verdict.FAILED
    message = rf"^element 2, step 1, increment 2, iteration 0: {re.escape(entry)} is {value}$"
    assert re.search(message, finding.message), finding.message
    assert re.search("Look for 0/0 without deformation", finding.advice)


def test_values_that_are_numbers(findings, model):
    finding = findings(*model("svars(1) = 1"))["values"]
    assert finding.message == "SVARS, ENERGY and PNEWDT are finite in all iterations of the run"


@pytest.mark.nan
@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (
            "ENERGY(2)",
            r"element 2 \(type U1\): ENERGY\(2\) is NaN or infinite at the end of step 1, increment 2; the run",
        ),
        (
            "SVARS(3)",
            r"element 2 \(type U1\): SVARS\(3\) is NaN or infinite at the end of step 1, increment 2; the run",
        ),
        ("PNEWDT", r"an element \(type U1\): PNEWDT is NaN or infinite \(step 1, increment 2, iteration 0\); the run"),
    ],
)
def test_run_warns_once(model, tmp_path, capsys, entry, message):
    deck, user = model(f"if (jelem == 2 .and. kinc == 2) {entry.lower()} = {ROOT}")
    assert main(["run", str(deck), "--user", str(user), "--output-dir", str(tmp_path)]) == 0
    assert "warnings in .dat and .msg: 1" in capsys.readouterr().out
    text = " ".join((tmp_path / "springs.msg").read_text().split())
    assert len(re.findall(message, text)) == 1


LOAD = "*DLOAD\n2, U3, 4.\n"


def test_loads_that_are_not_read(findings, model):
    finding = findings(*model("continue", LOAD))["loads"]
    assert finding.verdict is Verdict.FAILED
    message = r"^element 2, .*: RHS does not change when the magnitude of U3 is doubled$"
    assert re.search(message, finding.message), finding.message
    assert re.search(r"arrives as JDLTYP\(k,1\) = n with the magnitude ADLMAG\(k,1\)", finding.advice)


def test_loads_that_are_read(findings, model):
    line = "if (ndload > 0) rhs(1:2,1) = rhs(1:2,1) + adlmag(1,1)/2"
    assert findings(*model(line, LOAD))["loads"].message == "RHS changes with the magnitude of U3"


def test_deck_without_loads(findings, model):
    assert re.search(
        "no loads on the elements: .* take a deck with .DLOAD", findings(*model("continue"))["loads"].message
    )


COUNTED = """\
      module residuals
      integer :: calls = 0
      end module
"""


def test_residual_alone_leaves_no_trace(findings, model):
    """A call with LFLAGS(3) = 5 that calls with 1 remember."""
    deck, user = model("call remember(lflags(3), rhs)")
    user.write_text(
        f"{COUNTED}{user.read_text()}"
        "      subroutine remember(request, rhs)\n      use residuals, only: calls\n      integer request\n"
        "      double precision rhs(2)\n      if (request == 5) calls = calls + 1\n"
        "      rhs = rhs*(1 + 0.1d0*calls)\n      end\n"
    )
    # other checks make such calls too, and their trace shows as soon as a call is made again
    finding = findings(deck, user, skip=["outside", "resources"])["repeat"]
    assert finding.verdict is Verdict.FAILED
    message = r"the same call returns different values after calls with LFLAGS\(3\) = 5: RHS\(1\) is"
    assert re.search(message, finding.message), finding.message
    assert re.search("they must leave no trace", finding.advice)
