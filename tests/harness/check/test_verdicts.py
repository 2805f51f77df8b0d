# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the checks come to: a run that ends early, nothing to look at, exit codes, and what programs read."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from uel.check.examine import examine
from uel.check.finding import Conclusion, Verdict
from uel.cli import main

QUAD = Path(__file__).parent / "quad.f"
INCLUDE = QUAD.parents[1] / "uel.inc"
TEMPLATE = Path(__file__).parents[3] / "harness" / "uel" / "project" / "template"

SPRING = f"""\
      include '{INCLUDE}'
      rhs(1,1) = props(1)*(u(2) - u(1))
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = props(1)*props(2)
      amatrx(2,2) = props(1)*props(2)
      amatrx(1,2) = -props(1)*props(2)
      amatrx(2,1) = -props(1)*props(2)
      end
"""
SPRINGS = """\
*NODE
1, 0.
2, 1.
3, 2.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=2, VARIABLES=1
1
*USER ELEMENT, TYPE=U2, NODES=2, COORDINATES=1, PROPERTIES=2, VARIABLES=1
1
*ELEMENT, TYPE=U1, ELSET=FIRST
1, 1, 2
*ELEMENT, TYPE=U2, ELSET=SECOND
2, 2, 3
*UEL PROPERTY, ELSET=FIRST
10., 1.
*UEL PROPERTY, ELSET=SECOND
{second}
*STEP, INC={inc}
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1
*CLOAD
{node}, 1, 1.
*END STEP
"""


HELD = ("1, 1\n*CLOAD", "1, 1\n3, 1\n*CLOAD")
"""Node 3, too, at the boundary: what acts there need not hold it."""

LEAVES = """\
      integer, save :: last = 0
      if (jtype == 2 .and. last /= 1) call xit
      last = jtype
"""
NEEDS_A_NEIGHBOUR = SPRING.replace("      rhs(1,1) = ", LEAVES + "      rhs(1,1) = ", 1)


@pytest.fixture
def springs(tmp_path):
    """Deck of two springs of two types in a row, and their UEL."""

    def springs(second="10., 1.", node=3, inc=100):
        deck, user = tmp_path / "springs.inp", tmp_path / "springs.f"
        deck.write_text(SPRINGS.format(second=second, node=node, inc=inc))
        user.write_text(SPRING)
        return deck, user

    return springs


@pytest.mark.parametrize(
    ("old", "new"),
    [("volume = area*props(3)", "volume = aera*props(3)"), ("70000., 0.3, 2.", "70000., 0.3")],
    ids=["a variable that is misspelt", "a property that is not given"],
)
def test_element_that_does_nothing(tmp_path, capsys, monkeypatch, old, new):
    """The element of the guide with a factor that is zero: nothing holds the model, and no check of forces applies."""
    for name in ("my_uel.for", "my_uel.inp"):
        (tmp_path / name).write_text((TEMPLATE / name).read_text().replace(old, new))
    monkeypatch.delenv("COLUMNS", raising=False)
    assert main(["check", str(tmp_path / "my_uel.for"), str(tmp_path / "my_uel.inp")]) == 1
    printed = capsys.readouterr().out
    assert re.search(r"run .*FAILED .*ended after 0 increments: .*my_uel.inp:\d+: singular system matrix", printed)
    assert "U1 run: AMATRX of the elements there is zero, or does not restrain the node" in printed
    assert re.search("tangent .* FAILED .* RHS and AMATRX are zero at every state tried", printed)
    assert "U1 tangent: Look for entries of AMATRX and RHS that are set to zero and never filled" in printed


def test_type_without_stiffness_is_blamed(springs):
    """At node 3 there is no other than U2."""
    outcome = examine(*springs("0., 1."))
    first, second = (report.findings["run"] for report in outcome.types)
    assert outcome.conclusion is Conclusion.FAILED
    assert second.verdict is Verdict.FAILED
    assert re.search(r"after 0 increments: .*springs.inp:\d+: singular system matrix at node 3, dof 1", second.message)
    assert first.verdict is Verdict.NOT_APPLICABLE
    assert re.search("another type of element ended it, fix that first: .*singular", first.message)


def test_run_that_does_not_converge(springs):
    """AMATRX of a tenth makes corrections that diverge; no type is known to be to blame."""
    for report in examine(*springs("10., 0.1")).types:
        run = report.findings["run"]
        assert run.verdict is Verdict.FAILED
        assert re.search("the run of the deck ended after 0 increments: .*step 1, increment 1, attempt", run.message)
        assert re.search("If `tangent` fails, fix AMATRX first", run.advice)


def test_xit_in_a_later_increment(springs):
    deck, user = springs()
    user.write_text(SPRING.replace("      end\n", "      if (kinc == 2 .and. jtype == 2) call xit\n      end\n"))
    first, second = (report.findings["run"] for report in examine(deck, user).types)
    assert first.verdict is Verdict.NOT_APPLICABLE
    assert second.verdict is Verdict.FAILED
    assert re.search(r"element 2 \(type U2\): stopped the analysis", second.message)


def test_fewer_increments_than_asked_for(springs):
    """A deck may end before; and INC= is the author's own choice where all increments converge at once."""
    deck, user = springs()
    outcome = examine(deck, user, increments=20)
    assert outcome.passed
    assert [report.findings["run"].message for report in outcome.types] == ["4 increments of the deck"] * 2
    outcome = examine(*springs(inc=2))
    assert outcome.passed
    run = outcome.types[0].findings["run"].message
    assert re.search(r"^2 increments of the deck; the deck allows no more: TOO MANY INCREMENTS .*INC=2", run)


def test_type_that_nothing_is_known_of(springs, tmp_path, capsys, monkeypatch):
    """U2 needs a call of U1 before each of its own; the check of the order, which finds that, is left out."""
    deck, user = springs()
    user.write_text(NEEDS_A_NEIGHBOUR)
    file = tmp_path / "found.json"
    monkeypatch.delenv("COLUMNS", raising=False)
    assert main(["check", str(deck), str(user), "--json", str(file), "--skip", "order"]) == 2
    said = "U2: nothing was looked at: no element returns from a call by itself"
    assert said in capsys.readouterr().out
    data = json.loads(file.read_text())
    assert (data["conclusion"], data["passed"]) == ("nothing looked at", False)
    first, second = data["types"]
    assert (first["conclusion"], second["conclusion"]) == ("passed", "nothing looked at")
    assert "tangent" in first["looked_at"]
    assert "tangent" not in second["looked_at"]


ZERO = "      amatrx = 0\n      end\n"


@pytest.mark.sample(3)
@pytest.mark.parametrize("lost", [ZERO, "      rhs(1:2,1) = 0\n" + ZERO], ids=["AMATRX", "RHS and AMATRX"])
@pytest.mark.parametrize("all_of_them", [True, False], ids=["all elements", "other elements carry the load"])
def test_matrices_that_are_zero(springs, capsys, monkeypatch, lost, all_of_them):
    """They fail, with advice, also where the run of the deck gets to its end."""
    deck, user = springs(node=2)
    deck.write_text(deck.read_text().replace(*HELD))
    zero = lost if all_of_them else "".join(f"      if (jtype == 2) {row.strip()}\n" for row in lost.splitlines()[:-1])
    user.write_text(SPRING.replace("      end\n", zero if all_of_them else f"{zero}      end\n"))
    monkeypatch.delenv("COLUMNS", raising=False)
    assert main(["check", str(deck), str(user)]) == 1
    report = examine(deck, user).types[-1]
    assert (report.type, report.conclusion) == ("U2", Conclusion.FAILED)
    tangent = report.findings["tangent"]
    assert tangent.verdict is Verdict.FAILED
    if lost != ZERO:
        assert tangent.message == "RHS and AMATRX are zero at every state tried"
        assert "AMATRX and RHS that are set to zero and never filled" in tangent.advice
        assert report.findings["patch"].verdict is Verdict.NOT_APPLICABLE
    assert tangent.advice in capsys.readouterr().out


def test_all_checks_of_forces_left_out(springs):
    """What was asked for was looked at."""
    names = [name for name in examine(*springs()).types[0].findings if name != "run"]
    assert examine(*springs(), skip=names).passed


def test_findings_of_an_earlier_run_do_not_stay(springs, tmp_path, capsys):
    deck, user = springs()
    file = tmp_path / "found.json"
    assert main(["check", str(deck), str(user), "--json", str(file)]) == 0
    assert json.loads(file.read_text())["conclusion"] == "passed"
    user.write_text("      this is no Fortran\n")
    assert main(["check", str(deck), str(user), "--json", str(file)]) == 2
    data = json.loads(file.read_text())
    assert (data["conclusion"], data["passed"]) == ("nothing looked at", False)
    assert "springs.f" in data["error"]
    assert data["error"] in capsys.readouterr().err


def test_folder_of_the_json_file_is_looked_for_first(springs, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("uel.check.command.examine_isolated", lambda *_, **__: pytest.fail("the checks were made"))
    monkeypatch.setattr("uel.check.command.examine", lambda *_, **__: pytest.fail("the checks were made"))
    words = ["check", *map(str, springs()), "--json"]
    assert main([*words, str(tmp_path / "missing" / "found.json")]) == 2
    assert re.search(r"uel: --json .*missing.found.json: No such file or directory", capsys.readouterr().err)
    assert main([*words, str(tmp_path)]) == 2
    assert re.search(r"uel: --json .*: Is a directory", capsys.readouterr().err)
    assert main([*words, str(tmp_path / "found.json"), "--shuffle"]) == 2
    assert re.search("--json writes the table of all checks, which --shuffle does not make", capsys.readouterr().err)


def test_json_that_is_no_file_stays(springs, tmp_path):
    """As /dev/stdout, a link to a device."""
    link = tmp_path / "stdout"
    link.symlink_to("/dev/null")
    assert main(["check", *map(str, springs()), "--json", str(link)]) == 0
    assert link.is_symlink()


def test_json_that_cannot_be_written_in_the_end(springs, tmp_path, capsys):
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full")
    link = tmp_path / "found.json"
    link.symlink_to("/dev/full")
    assert main(["check", *map(str, springs()), "--json", str(link)]) == 2
    assert f"uel: --json {link}: No space left on device" in capsys.readouterr().err


def test_nothing_is_cut_without_a_terminal(springs, capsys, monkeypatch):
    """Findings are longer than 80 columns, and stand in one line each."""
    monkeypatch.delenv("COLUMNS", raising=False)
    deck, user = springs("10., 0.1")
    assert main(["check", str(deck), str(user)]) == 1
    printed = capsys.readouterr().out
    findings = [finding for report in examine(deck, user).types for finding in report.findings.values()]
    assert max(len(finding.message) for finding in findings) > 80
    for finding in findings:
        assert finding.message in printed
        assert finding.advice in printed


def test_plugin_tells_where_nothing_was_looked_at(springs, tmp_path):
    """As a test that fails, beside those of the other type, which pass; without the check of the order."""
    deck, user = springs()
    user.write_text(NEEDS_A_NEIGHBOUR)
    (tmp_path / "conftest.py").write_text(
        "from uel.check import isolated, examine\n"
        "def look(deck, user, **options):\n"
        "    options.pop('call_limit', None)\n"
        "    return examine.examine(deck, user, skip=['order'], **options)\n"
        "isolated.examine_isolated = look\n"
    )
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir", str(tmp_path)]
    command += ["--deck", str(deck), "--uel", str(user)]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert result.returncode == pytest.ExitCode.TESTS_FAILED
    assert re.search("U2: nothing was looked at: no element returns from a call by itself", result.stdout)
    assert re.search(r"1 failed, \d+ passed", result.stdout)
