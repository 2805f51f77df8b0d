# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The short form of kills.py."""

import kills
import pytest


def test_files_of_runs_that_are_killed(capsys: pytest.CaptureFixture[str]) -> None:
    bad = kills.main(count=6, jobs=2, seed=2, longest=4.0)
    assert not bad, capsys.readouterr().out
