# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of commands that run decks."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from uel.cli.values import NOT_NEGATIVE
from uel.running import isolation

if TYPE_CHECKING:
    from uel.batch.runs import Settings


def add_run_options(command: argparse.ArgumentParser) -> list[argparse.Action]:
    """Add the options that say how a deck runs, for commands that run decks."""
    user = command.add_argument(
        "--user",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="user routines (.f .for .f90 .c .cpp .so); repeat for each file, in compilation order (the project's own)",
    )
    solver = command.add_argument(
        "--solver", default="auto", metavar="NAME", help="linear solver, see `uel solvers` (auto)"
    )
    help_ = command.add_mutually_exclusive_group()
    fallback = help_.add_argument("--fallback", action="store_true", help="search downhill where Newton's method fails")
    control = help_.add_argument(
        "--control", choices=("load", "energy"), default="load", help="energy: trace snap-backs (load)"
    )
    linear = command.add_argument(
        "--linear",
        action="append",
        default=[],
        metavar="Un",
        help="user elements of this type are linear and need not be called in each iteration; verified in each "
        "increment; repeat for each type",
    )
    limit = add_call_limit(command)
    debug = command.add_argument(
        "--debug", action="store_true", help="run-time checks: errors in user code come with file and line"
    )
    return [user, solver, fallback, control, linear, limit, debug]


def add_call_limit(command: argparse.ArgumentParser) -> argparse.Action:
    """Add the option of commands that call user code."""
    return command.add_argument(
        "--call-limit",
        type=NOT_NEGATIVE,
        default=60.0,
        metavar="SECONDS",
        help="time limit of one call of a user routine, and of loading the library; 0: none (60)",
    )


def add_same_process(command: argparse.ArgumentParser) -> None:
    """Add the option of commands that work in a separate process."""
    command.add_argument(isolation.SAME_PROCESS, action="store_true", help="for debuggers: run in this process")


def settings_of(options: argparse.Namespace) -> Settings:
    """Collect the settings of the runs of a command."""
    from uel.batch.runs import Settings  # noqa: PLC0415

    how = [action for action in options.of_runs if action.dest not in ("user", "call_limit")]
    return Settings(options.user, words_of(how, options), options.call_limit)


def words_of(actions: Sequence[argparse.Action], options: argparse.Namespace) -> list[str]:
    """Return the words of the command line that give these options."""
    words: list[str] = []
    for action in actions:
        value = getattr(options, action.dest)
        if value is True:
            words.append(action.option_strings[0])
        elif value != action.default:
            each = value if isinstance(value, list) else [value]
            words += [f"{action.option_strings[0]}={one}" for one in each]
    return words
