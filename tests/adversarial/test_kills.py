# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The short form of kills.py."""

import kills
import pytest


@pytest.mark.parametrize("count", [2, pytest.param(12, marks=pytest.mark.long)])
def test_files_of_runs_that_are_killed(count: int, capsys: pytest.CaptureFixture[str]) -> None:
    bad = kills.main(count=count, jobs=2, seed=2, longest=4.0)
    assert not bad, capsys.readouterr().out
