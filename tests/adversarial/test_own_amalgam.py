# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The project's own single file, as any user's, in its own decks: no check but the intended ones fails."""

from pathlib import Path

import pytest

from uel.check.finding import Verdict
from uel.check.isolated import examine_isolated
from uel.usersub.own_kernels import path_of_amalgam

DECKS = sorted(
    deck
    for deck in (Path(__file__).parents[2] / "abaqus_inputs").glob("*/*.inp")
    if "*USER ELEMENT" in deck.read_text("utf-8").upper()
)

INTENDED = {("U3", "order"), ("U10", "order"), *((kind, "energy") for kind in ("U4", "U6", "U8", "U12"))}
"""Results of harness/uel/check/README.md, 'The project's own elements'."""

LOADED_AT_REST = {"u8_prestressed": {("U8", "rest")}}
"""The same, of decks with an initial stress."""


@pytest.mark.long
@pytest.mark.parametrize("deck", DECKS, ids=lambda deck: f"{deck.parent.name}-{deck.stem}")
def test_no_false_alarm(deck):
    intended = INTENDED | LOADED_AT_REST.get(deck.stem, set())
    # what the compiler says is the same in every deck: tests/harness/check/test_compiler.py
    outcome = examine_isolated(deck, [path_of_amalgam()], increments=1, skip=["compiler"])
    failed = {
        (report.type, name): finding.message
        for report in outcome.types
        for name, finding in report.findings.items()
        if finding.verdict is Verdict.FAILED and (report.type, name) not in intended
    }
    assert not failed
