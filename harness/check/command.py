# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel check`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Final

from rich.console import Console

from harness.check.examine import examine
from harness.check.report import as_json, table
from harness.check.shuffle import report, shuffle
from harness.errors import UelError
from harness.usersub import limit_calls

UNCHECKED: Final = 2
"""Exit code where nothing could be checked."""

CALL_LIMIT: Final = 60.0
"""Seconds that a call of a user routine may take."""


def check(options: argparse.Namespace, console: Console) -> int:
    """Run the checks and print what they found; returns the exit code: 0 all passed, 1 a check failed, 2 neither."""
    limit_calls(CALL_LIMIT)
    try:
        deck, user = deck_and_user(options.files, options.user)
        if options.shuffle:
            shuffled = shuffle(deck, user, seed=options.seed, increments=options.increments)
            console.print(report(shuffled))
            return int(not shuffled.passed)
        outcome = examine(deck, user, seed=options.seed, increments=options.increments, skip=options.skip)
    except UelError as error:
        print(f"uel: {error}", file=sys.stderr)
        return UNCHECKED
    console.print(table(outcome))
    if options.json:
        options.json.write_text(as_json(outcome), encoding="utf-8")
    return int(not outcome.passed)


def deck_and_user(files: list[Path], user: list[Path]) -> tuple[Path, list[Path]]:
    """Which of the files is the deck and which are the user's. Raises UelError."""
    decks = [file for file in files if file.suffix.lower() == ".inp"]
    others = [file for file in files if file not in decks] + user
    if len(decks) != 1:
        raise UelError(f"expected one deck (.inp), found {len(decks)}")
    return decks[0], others
