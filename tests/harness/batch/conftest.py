# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks with parameters, and the table that a batch writes."""

import csv
from collections.abc import Callable
from pathlib import Path

import pytest
from batch_decks import CRASHING, MESH, PULLED

Rows = list[dict[str, str]]


@pytest.fixture
def pulled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A spring of stiffness 1 that is pulled by a parameter; its folder is the current one."""
    monkeypatch.chdir(tmp_path)
    Path("mesh.inp").write_text(MESH)
    Path("pulled.inp").write_text(PULLED)
    return Path("pulled.inp")


@pytest.fixture
def crashing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A spring whose element ends in many ways, by a parameter; its folder is the current one."""
    monkeypatch.chdir(tmp_path)
    Path("crash.inp").write_text(CRASHING)
    return Path("crash.inp")


@pytest.fixture
def results() -> Callable[[], Rows]:
    """Reads the table that a batch has written into the folder `batch`."""

    def read() -> Rows:
        with Path("batch/results.csv").open(newline="") as file:
            return list(csv.DictReader(file))

    return read
