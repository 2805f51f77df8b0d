# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel check`."""

from __future__ import annotations

import argparse
import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Final

from rich.console import Console, Group

from uel.check.examine import examine
from uel.check.finding import Conclusion
from uel.check.isolated import ShowProgress, call_isolated, examine_isolated
from uel.check.progress import Progress, Running, no_progress
from uel.check.report import as_json, error_as_json, table
from uel.check.shuffle import report, shuffle
from uel.errors import UelError, tell_failure
from uel.usersub import limit_calls

CODES: Final = {Conclusion.PASSED: 0, Conclusion.FAILED: 1, Conclusion.NOTHING: 2}
"""Exit codes."""

WIDEST: Final = 10_000
"""Columns if neither a terminal nor COLUMNS gives their number: tables are as wide as their texts."""


def check(options: argparse.Namespace, console: Console, *, isolated: bool) -> int:
    """Run the checks and print the findings; returns the exit code, see CODES.

    isolated: in a separate process, which user code may end; a terminal shows what it does.
    """
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console = Console(file=console.file, width=WIDEST)
    try:
        _clear(options.json, shuffle=options.shuffle)
    except UelError as error:
        print(f"uel: {error}", file=sys.stderr)
        return CODES[Conclusion.NOTHING]
    try:
        deck, user = deck_and_user(options.files, options.user)
        how = {"seed": options.seed, "increments": options.increments}
        limit = options.call_limit
        limit_calls(limit)
        with display(shown=isolated and not options.quiet) as show:
            if options.shuffle:
                run_order = (
                    partial(call_isolated, examine_order, call_limit=limit, show=show) if isolated else examine_order
                )
                passed, shown_result = run_order(deck, user, **how)
                conclusion = Conclusion.PASSED if passed else Conclusion.FAILED
            else:
                run = partial(examine_isolated, call_limit=limit, show=show) if isolated else examine
                outcome = run(deck, user, **how, skip=options.skip)
                conclusion, shown_result = outcome.conclusion, table(outcome)
    except UelError as error:
        tell_failure(error)
        if options.json:
            _write(options.json, error_as_json(error))
        return CODES[Conclusion.NOTHING]
    console.print(shown_result)
    if options.json and not _write(options.json, as_json(outcome)):
        return CODES[Conclusion.NOTHING]
    return CODES[conclusion]


def _write(file: Path, findings: str) -> bool:
    """Write the findings as JSON; an error is reported."""
    try:
        file.write_text(findings, encoding="utf-8")
    except OSError as error:
        print(f"uel: --json {file}: {error.strerror}", file=sys.stderr)
        return False
    return True


def _clear(file: Path | None, *, shuffle: bool) -> None:
    """Remove the findings of an earlier run, so that they are not mistaken for current ones. Raises UelError."""
    if file is None:
        return
    if shuffle:
        raise UelError("--json writes the table of all checks, which --shuffle does not make")
    try:
        # before the checks, which take time
        with file.open("a", encoding="utf-8"):
            pass
        # a device, or a link to one, stays: /dev/stdout
        if stat.S_ISREG(file.lstat().st_mode):
            file.unlink()
    except (OSError, ValueError) as error:
        raise UelError(f"--json {file}: {getattr(error, 'strerror', error)}") from None


@contextmanager
def display(*, shown: bool, console: Console | None = None) -> Iterator[ShowProgress | None]:
    """Yield a function that shows the current check on a terminal; None if nothing is to be shown."""
    if not shown:
        yield None
        return
    with (console or Console(stderr=True)).status("uel check") as status:
        yield lambda activity: status.update(f"uel check: {activity}")


def examine_order(
    deck: Path, user: list[Path], *, seed: int, increments: int, progress: Progress = no_progress
) -> tuple[bool, Group]:
    """Check the calling order only; returns whether all passed, and the report. Raises UelError."""
    progress(Running("calls of all elements in random orders"), None)
    shuffled = shuffle(deck, user, seed=seed, increments=increments)
    return shuffled.passed, report(shuffled)


def deck_and_user(files: list[Path], user: list[Path]) -> tuple[Path, list[Path]]:
    """Separate the deck from the user's files. Raises UelError."""
    decks = [file for file in files if file.suffix.lower() == ".inp"]
    others = [file for file in files if file not in decks] + user
    if len(decks) != 1:
        raise UelError(f"expected one deck (.inp), found {len(decks)}")
    return decks[0], others
