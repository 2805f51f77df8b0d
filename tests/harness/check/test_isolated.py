# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User code that ends the process of the checks, or does not end: what was found is kept, and the reason is said."""

import io
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rich.console import Console

from uel.check.checks import CHECKS
from uel.check.command import display
from uel.check.examine import examine
from uel.check.finding import Verdict
from uel.check.isolated import EndedError, call_isolated, examine_isolated
from uel.check.progress import Running, Snapshot
from uel.errors import UelError
from uel.usersub import limit_calls

QUAD = Path(__file__).parent / "quad.f"

PATHS = os.pathsep.join(filter(None, (os.environ.get("PYTHONPATH"), str(Path(__file__).parents[3]))))
"""Where the process of the checks finds the functions of this module: behind the package that is tested."""


def uel_check(deck, *words):
    """Exit code, output and messages of the command."""
    command = [sys.executable, "-m", "uel.cli", "check", str(QUAD), deck.name, *words]
    result = subprocess.run(command, cwd=deck.parent, capture_output=True, text=True, check=False)
    assert "Traceback" not in result.stderr
    return result.returncode, " ".join(result.stdout.split()), result.stderr


def test_outcome_is_that_of_the_same_process(patch):
    assert examine_isolated(patch(5), [QUAD]) == examine(patch(5), [QUAD])


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "mistake, check, message",
    [
        (
            29,
            "rotation",
            r"ended by the Fortran library, in an input .* 'rotation' of U1; in UEL for element 1, step 1, ",
        ),
        (
            31,
            "no-time",
            "ended by SIGABRT: .* 'no-time' of U1; in UEL for element 1, step 1, increment 0, iteration 0: ",
        ),
    ],
)
def test_findings_before_the_end_are_kept(patch, mistake, check, message):
    deck = patch(mistake)
    code, printed, said = uel_check(deck, "--json", "findings.json")
    assert code == 1
    (report,) = json.loads((deck.parent / "findings.json").read_text())["types"]
    *before, last = report["findings"]
    assert last == check
    assert "filled" in before
    assert {report["findings"][name]["verdict"] for name in before} <= {"passed", "not applicable"}
    assert re.search(message, report["findings"][check]["message"])
    assert f"U1 {check}: The element ended the process" in printed
    assert "uel: in" not in said


@pytest.mark.long
def test_check_that_ends_the_process_is_left_out(patch):
    code, printed, _ = uel_check(patch(31), "--skip", "no-time", "--increments", "1")
    assert code == 0
    assert "increments" in printed


def test_call_that_does_not_return(patch):
    deck = patch(30)
    code, printed, _ = uel_check(deck, "--call-limit", "1", "--json", "findings.json")
    assert code == 1
    (report,) = json.loads((deck.parent / "findings.json").read_text())["types"]
    limit = "within 1 s, the limit for one call (--call-limit)"
    place = f"the call did not return {limit} (step 1, increment 1, iteration 0)"
    where = r"element 1 \(type U1\): stopped the analysis: in UEL, quad.f line \d+: "
    assert re.fullmatch(where + re.escape(place), report["findings"]["rotation"]["message"])
    assert (
        report["findings"]["energy"]["message"]
        == "not run, because a call did not return in 'rotation', which comes first"
    )
    assert "U1 rotation: A call did not return in time (--call-limit): look for a loop" in printed


@pytest.mark.parametrize(
    "words, what",
    [
        ([], "the run of the deck"),
        pytest.param(["--shuffle"], "calls of all elements in random orders", marks=pytest.mark.long),
    ],
)
def test_nothing_was_found_before_the_end(patch, words, what):
    code, printed, said = uel_check(patch(32), *words)
    assert (code, printed) == (2, "")
    assert re.search(rf"uel: the process was ended by the Fortran library.* during {what}; in UEL for element 1", said)
    assert "no-such-file" in said


@pytest.mark.long
def test_order_alone(patch):
    code, printed, _ = uel_check(patch(11), "--shuffle", "--increments", "1")
    assert code == 1
    assert "something outlives a call" in printed


def interrupted(*, progress):
    progress(Running("a test"), None)
    raise KeyboardInterrupt


def quit_quietly(*, progress):
    progress(Running("a test"), None)
    sys.exit(0)


@pytest.mark.parametrize(
    "function, message",
    [
        (interrupted, "the process was interrupted during a test"),
        pytest.param(quit_quietly, r"the process was ended \(exit code 0\) during a test", marks=pytest.mark.long),
    ],
)
def test_other_ends(function, message, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", PATHS)
    with pytest.raises(UelError, match=message):
        call_isolated(function)


def slow(*, progress):
    progress(Running("a long check"), None)
    time.sleep(1.5)


def test_tells_what_is_done(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", PATHS)
    told = []
    call_isolated(slow, show=told.append)
    assert told[-1] == "a long check"


def test_display_on_a_terminal():
    terminal, file = (Console(file=io.StringIO(), force_terminal=kind, width=80) for kind in (True, False))
    for console in (terminal, file):
        with display(shown=True, console=console) as tell:
            tell("the check 'rotation' of U1")
            time.sleep(0.3)
    assert "uel check: the check 'rotation' of U1" in terminal.file.getvalue()
    assert file.file.getvalue() == ""
    with display(shown=False, console=terminal) as tell:
        assert tell is None


def full(*, progress):
    progress(Running("a test"), None)
    raise MemoryError


def unreadable(*, progress):
    progress(Running("a test"), None)
    Path("no-such-folder/file").read_text()


@pytest.mark.parametrize(
    "function, message",
    [
        (full, "^not enough memory for this model$"),
        pytest.param(unreadable, "^no-such-folder/file: No such file or directory$", marks=pytest.mark.long),
    ],
)
def test_errors_of_the_system(function, message, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", PATHS)
    with pytest.raises(UelError, match=message):
        call_isolated(function)


def test_interruption_keeps_findings(patch, monkeypatch):
    """As if it came while the second check ran."""
    examination = examine(patch(), QUAD, skip=[check.name for check in CHECKS if check.name not in ("run", "filled")])
    checks = examination.types[0].findings
    del checks["filled"]

    def interrupt(*_, **__):
        raise EndedError("interrupted", Snapshot(Running("a check", "filled"), examination), interrupted=True)

    monkeypatch.setattr("uel.check.isolated.call_isolated", interrupt)
    found = examine_isolated(patch(), [QUAD])
    assert found.types[0].findings["run"].verdict is Verdict.PASSED
    assert found.types[0].findings["filled"].advice == "The checks after this one did not run."
    assert not found.passed


def test_error_without_a_place(tmp_path):
    with pytest.raises(UelError, match=r"none\.inp"):
        examine_isolated(tmp_path / "none.inp", [])


def test_endless_call_in_the_same_process(patch):
    limit_calls(1.0)
    try:
        (report,) = examine(patch(30), QUAD, skip=["patch"]).types
    finally:
        limit_calls(0.0)
    assert report.findings["rotation"].verdict is Verdict.FAILED
    assert report.findings["increments"].verdict is Verdict.NOT_APPLICABLE
