# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What peers.py makes of other codes: their rows, and reasons where there are none."""

import sys

import limit
import numpy as np
import peers
import pytest


def test_rows_before_a_code_dies() -> None:
    found = peers.rows_of([sys.executable, "-c", "print('Step 1\\n0.1 2.5 3 0.7'); raise SystemExit('diverged')"])
    assert found.rows == [(0.1, 2.5, 3, 0.7)]
    assert peers.rows_of([sys.executable, "-c", "raise SystemExit('no licence')"]) == ([], "no licence")


def ours(monkeypatch, seconds: float) -> None:
    """Ours takes so long; the least is 0.673 s."""
    halves = np.array([seconds / 2, seconds / 2])
    done = limit.Run(halves, [2, 3], np.array([5.0, 10.0]), np.array([50.0, 26.0]), 1.0)
    monkeypatch.setattr(limit, "run", lambda: done)


@pytest.mark.parametrize(("seconds", "exit_code"), [(0.8, 0), (1.0, 1)])
def test_codes_that_are_not_there_are_left_out(tmp_path, monkeypatch, capsys, seconds, exit_code) -> None:
    ours(monkeypatch, seconds)
    words = ["peers.py", "--python", "no-such-python", "--pyfem", str(tmp_path), "--environments", str(tmp_path / "e")]
    monkeypatch.setattr(sys, "argv", words)
    assert peers.main() == exit_code
    printed = capsys.readouterr().out
    assert "Akantu is left out: no-such-python: No such file or directory" in printed
    assert "Akantu with a search is left out: no-such-python: No such file or directory" in printed
    assert f"PyFEM is left out: {tmp_path} has no folder pyfem" in printed
    assert f"{0.673 / seconds:.2f} (at least 0.8)" in printed


@pytest.mark.parametrize(("theirs", "exit_code"), [(15.9, 1), (16.1, 0)])
def test_ratio_of_a_code_that_reaches_the_end_is_judged(tmp_path, monkeypatch, capsys, theirs, exit_code) -> None:
    ours(monkeypatch, 0.64)
    rows = [(5.0, 2.5, 30, 1.0), (10.0, 1.3, 40, theirs)]
    monkeypatch.setattr(peers, "run_akantu", lambda *_: {"Akantu with a search": peers.Peer(rows)})
    monkeypatch.setattr(sys, "argv", ["peers.py", "--environments", str(tmp_path)])
    assert peers.main() == exit_code
    assert f"{theirs / 0.64:.1f} (at least 25)" in capsys.readouterr().out


@pytest.mark.parametrize(("group", "count"), [("quads", 4800), ("interface", 460)])
def test_elements_of_the_deck(group: str, count: int) -> None:
    quads, interface = peers.elements(peers.read_deck(peers.DECK))
    assert len({"quads": quads, "interface": interface}[group]) == count
