# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Commands about the installation: `uel solvers`, `uel doctor`, `uel completion`."""

from __future__ import annotations

import argparse
from pathlib import Path

from uel.errors import UelError, tell


def add_solvers(solvers: argparse.ArgumentParser) -> None:
    """Add the options of `uel solvers`."""
    solvers.set_defaults(function=list_solvers)


def list_solvers(_: argparse.Namespace) -> int:
    """Run `uel solvers`."""
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    from uel.solver.linear import available, measured, with_ranks  # noqa: PLC0415

    console = Console()
    table = Table("solver", "installed", "version", "when it is used")
    for row in (*available(), *with_ranks()):
        table.add_row(row.name, "yes" if row.installed else "no", row.version, row.note)
    console.print(table)
    machine, rows = measured.read()
    times = Table(*measured.HEADER, title=f"CPU times in ms, {machine}", title_justify="left")
    for measurement in rows:
        times.add_row(*measurement.cells)
    console.print(times)
    console.print(
        "first: with the analysis; in part: after a change in the process zone of a crack; GMRES: iterations after it "
        "on the last factors. auto goes by these times; see harness/uel/solver/linear/solvers.md"
    )
    return 0


def add_doctor(doctor: argparse.ArgumentParser) -> None:
    """Add the options of `uel doctor`."""
    doctor.epilog = "Exit code: 0 all that is indispensable works; 1 something is broken."
    doctor.set_defaults(function=examine_installation)


def examine_installation(_: argparse.Namespace) -> int:
    """Run `uel doctor`."""
    from uel.doctor import report  # noqa: PLC0415

    return 0 if report(tell) else 1


def add_completion(completion: argparse.ArgumentParser, parser: argparse.ArgumentParser) -> None:
    """Add the options of `uel completion`; parser: of all commands."""
    completion.epilog = "For bash: uel completion bash > ~/.local/share/bash-completion/completions/uel"
    completion.add_argument("shell", choices=["bash", "zsh", "fish"], help="whose script it is")
    completion.set_defaults(function=print_completion, parser=parser)


def print_completion(options: argparse.Namespace) -> int:
    """Run `uel completion`."""
    try:
        import shtab  # noqa: PLC0415
    except ImportError:
        raise UelError("completion needs the package shtab (pip install shtab)") from None
    commands = next(action for action in options.parser._actions if isinstance(action, argparse._SubParsersAction))
    for command in commands.choices.values():
        for action in command._actions:
            if action.type is Path:
                action.complete = shtab.DIRECTORY if action.metavar == "DIR" else shtab.FILE
    print(shtab.complete(options.parser, options.shell))
    return 0
