# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The state with which an increment begins: bars with material laws, right ones and wrong ones."""

import re
from pathlib import Path

import pytest

from uel.check.examine import examine
from uel.check.finding import Verdict

FOLDER = Path(__file__).parents[1]

BAR = """\
      include '{folder}/uel.inc'
      eps = u(2) - u(1)
      deps = du(2,1) - du(1,1)
      rate = 0
      per = 0
      if (dtime > 0) rate = deps/dtime
      if (dtime > 0) per = 1/dtime
      {law}
      rhs(1,1) = s
      rhs(2,1) = -s
      amatrx(1,1) = t
      amatrx(2,2) = t
      amatrx(1,2) = -t
      amatrx(2,1) = -t
      end
"""

DECK = """\
*NODE
1, 0.
2, 1.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, VARIABLES=2
{dof}
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
*UEL PROPERTY, ELSET=ALL
*STEP
{procedure}
*BOUNDARY
1, {dof}
2, {dof}, {dof}, 0.02
*END STEP
"""

VISCOUS_DAMAGE = """\
damage = max(svars(1), 1 - 1d-2/max(abs(eps), 1d-2))
      share = dtime/(dtime + 0.1d0)
      slow = svars(2) + share*(damage - svars(2))
      s = 100*(1 - slow)*eps
      t = 100*(1 - slow)
      if (damage > svars(1)) t = t - 100*share*1d-2/abs(eps)
      svars(1) = damage
      svars(2) = slow"""

PLASTIC = """\
trial = 100*(eps - svars(1))
      over = max(abs(trial) - 1 - 10*svars(2), 0d0)
      s = trial - sign(100*over/110, trial)
      t = merge(100d0*10/110, 100d0, over > 0)
      svars(1) = svars(1) + sign(over/110, trial)
      svars(2) = svars(2) + over/110"""

RIGHT = {
    "elastic": "s = 100*eps\n      t = 100",
    "hypoelastic": "s = svars(1) + 100*deps\n      t = 100\n      svars(1) = s",
    "Kelvin": "s = 100*eps + 5*rate\n      t = 100 + 5*per",
    "Maxwell": "share = exp(-dtime/0.3d0)\n      s = share*(svars(1) + 50*deps) + 100*eps\n"
    "      t = 100 + 50*share\n      svars(1) = s - 100*eps",
    "creep, explicit": "creep = svars(1) + 1d-2*dtime*svars(2)\n      s = 100*(eps - creep)\n      t = 100\n"
    "      svars(1) = creep\n      svars(2) = s",
    "damage of the last increment": "s = 100*(1 - svars(1))*eps\n      t = 100*(1 - svars(1))\n"
    "      svars(1) = max(svars(1), min(10*abs(eps), 0.5d0))",
    "viscous damage": VISCOUS_DAMAGE,
    "Kelvin, with constants for the state at the start": "old = svars(1)\n"
    "      if (kstep == 1 .and. kinc <= 1) old = 0\n"
    "      s = 100*eps + 5*per*(eps - old)\n      t = 100 + 5*per\n      svars(1) = eps",
    "Kelvin, which needs a state in SVARS after the first increment": "old = svars(1) - 1\n"
    "      if (kstep == 1 .and. kinc <= 1) old = 0\n      if (old == -1) call xit\n"
    "      s = 100*eps + 5*per*(eps - old)\n      t = 100 + 5*per\n      svars(1) = eps + 1",
    "plastic": PLASTIC,
    "elastic as far as it goes": PLASTIC.replace("- 1 -", "- 1d9 -"),
}

WRONG = [
    ("s = 100*deps\n      t = 100", "state", r"RHS\(1\) is \S+, and \S+ with a tenth of DU and DTIME .* no SVARS$"),
    ("s = 100*eps + 5*deps\n      t = 105", "state", r"with a tenth of DU and DTIME"),
    (
        "s = svars(1) + 100*deps\n      t = 100",
        "state",
        r"made in 128 parts, RHS\(1\) ends at .* with 128 it is 99.9 %$",
    ),
    (
        "s = svars(1) + 100*deps\n      t = 100",
        "history",
        r"RHS depends on SVARS\(1\) on entry, and no call writes any",
    ),
    ("s = svars(1) + 100*deps\n      t = 100\n      svars(2) = s", "history", r"depends on SVARS\(1\) on entry"),
    (
        "s = svars(1) + 100*deps\n      t = 100\n      svars(1) = svars(1) + s",
        "state",
        r"made in 128 parts, RHS\(1\) ends at",
    ),
    (VISCOUS_DAMAGE.partition("      svars(1)")[0], "history", r"depends on SVARS\(1\), SVARS\(2\) on entry"),
]


@pytest.fixture
def look(tmp_path):
    """Findings on a bar with a material law."""

    def look(law, dof=1, procedure="*STATIC, DIRECT\n0.25, 1.", *, text=DECK):
        deck, user = tmp_path / "bar.inp", tmp_path / "bar.f"
        deck.write_text(text.format(dof=dof, procedure=procedure))
        user.write_text(BAR.format(folder=FOLDER, law=law))
        (report,) = examine(deck, user).types
        return report.findings

    return look


@pytest.mark.sample(5)
@pytest.mark.parametrize("law", RIGHT.values(), ids=RIGHT)
def test_right_laws(look, law):
    found = look(law)
    assert not [(name, finding) for name, finding in found.items() if finding.verdict is Verdict.FAILED]
    assert found["state"].verdict is Verdict.PASSED
    assert found["history"].verdict is Verdict.PASSED


@pytest.mark.parametrize("theta", ["1", "0.5d0"], ids=["backward Euler", "Crank and Nicolson"])
def test_right_conduction(look, theta):
    law = f"s = 100*(eps - (1 - {theta})*deps) + 3*rate\n      t = 100*{theta} + 3*per"
    found = look(law, dof=11, procedure="*HEAT TRANSFER, DELTMX=1.\n0.25, 1.")
    assert found["state"].verdict is Verdict.PASSED
    assert not [(name, finding) for name, finding in found.items() if finding.verdict is Verdict.FAILED]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("law", "check", "message"), WRONG)
def test_wrong_laws(look, law, check, message):
    finding = look(law)[check]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message
    advice = {
        "state": "An increment, however small, has to begin with the forces|DU gets smaller with the increments",
        "history": "Store the state at the end of UEL",
    }
    assert re.search(advice[check], finding.advice), finding.advice


def test_initial_values_may_stay(look):
    """*INITIAL CONDITIONS, TYPE=SOLUTION gives what no call has to write."""
    given = "*INITIAL CONDITIONS, TYPE=SOLUTION\nALL, 0.5\n*STEP"
    history = look("s = 100*(eps - svars(1)*1d-3)\n      t = 100", text=DECK.replace("*STEP", given))["history"]
    assert history.verdict is Verdict.NOT_APPLICABLE
    assert re.search("SVARS have initial values.*take a deck without", history.message)


def test_state_where_nothing_moves(look):
    findings = look(RIGHT["elastic"], text=DECK.replace("0.02", "0."))
    for name in ("state", "increments"):
        assert re.search("nothing moves within an increment: take a deck whose", findings[name].message)
