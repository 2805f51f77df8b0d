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


def test_codes_that_are_not_there_are_left_out(tmp_path, monkeypatch, capsys) -> None:
    done = limit.Run(np.array([0.5, 0.5]), [2, 3], np.array([5.0, 10.0]), np.array([50.0, 26.0]), 1.0)
    monkeypatch.setattr(limit, "run", lambda: done)
    words = ["peers.py", "--python", "no-such-python", "--pyfem", str(tmp_path), "--environments", str(tmp_path / "e")]
    monkeypatch.setattr(sys, "argv", words)
    assert peers.main() == 0
    printed = capsys.readouterr().out
    assert "Akantu is left out: no-such-python: No such file or directory" in printed
    assert f"PyFEM is left out: {tmp_path} has no folder pyfem" in printed
    assert "0.67" in printed


@pytest.mark.parametrize(("group", "count"), [("quads", 4800), ("interface", 460)])
def test_elements_of_the_deck(group: str, count: int) -> None:
    quads, interface = peers.elements(peers.read_deck(peers.DECK))
    assert len({"quads": quads, "interface": interface}[group]) == count
