# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`pytest --uel my_uel.for --deck job.inp`: a test for each check."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

QUAD = Path(__file__).parent / "quad.f"


def run_pytest(folder, *words):
    """Exit code and output of pytest in a folder."""
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir", str(folder), *map(str, words)]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return result.returncode, result.stdout + result.stderr


def test_checks_are_tests(patch):
    deck = patch()
    code, printed = run_pytest(deck.parent, "-v", "--uel", QUAD, "--deck", deck.name)
    assert code == 0
    assert "patch.inp::U1-tangent PASSED" in printed
    assert re.search(r"patch.inp::U1-requests SKIPPED \(the procedures of the deck", printed)
    assert re.search(r"\d+ passed, 2 skipped", printed)


def test_finding_is_shown_without_a_traceback(patch):
    deck = patch(5)
    (deck.parent / "test_mine.py").write_text("def test_mine():\n    pass\n")
    code, printed = run_pytest(deck.parent, "test_mine.py", "--uel", QUAD, "--deck", deck.name, "-k", "tangent or mine")
    assert code == 1
    assert "1 failed, 1 passed" in printed
    assert re.search("patch.inp: U1-tangent, elements: 4 _", printed)
    assert "AMATRX is 2 times what it should be" in printed
    assert "Traceback" not in printed


@pytest.mark.parametrize(
    "words, code, message",
    [
        pytest.param(["--uel", "none.for", "--deck", "patch.inp"], 2, "none.for: no such file", marks=pytest.mark.long),
        (["--uel", "none.for"], 4, "--uel needs a deck with the elements: --deck job.inp"),
    ],
)
def test_nothing_can_be_checked(patch, words, code, message):
    found, printed = run_pytest(patch().parent, *words)
    assert found == code
    assert message in printed
    assert "Traceback" not in printed


def test_other_tests_of_the_environment_do_not_wait_for_the_checks():
    program = "import sys, uel.check.plugin; print([m for m in ('numpy', 'uel.usersub') if m in sys.modules])"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout == "[]\n"
