# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel run`, also in the spelling of the `abaqus` command."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from uel.cli.run_options import add_run_options, add_same_process
from uel.cli.values import assignment
from uel.errors import tell
from uel.parallel import launched

# options of the `abaqus` command and what they are here; None: accepted and without effect on one machine
ABAQUS_OPTIONS = {
    "job": "--job",
    "input": "deck",
    "oldjob": "--oldjob",
    "user": "--user",
    "cpus": "--cpus",
    "interactive": None,
    "ask_delete": None,
    "double": None,
    "memory": None,
    "scratch": None,
}


def add_run(run: argparse.ArgumentParser) -> None:
    """Add the options of `uel run`."""
    run.epilog = (
        "Abaqus' spelling works too: uel run job=NAME user=FILE. "
        "Exit code: 0 the analysis has completed; 1 an error, an interrupt or the system ended it; 2 wrong usage."
    )
    run.add_argument("deck", type=Path, metavar="DECK.inp", help="an Abaqus deck")
    add_run_options(run)
    run.add_argument("--job", metavar="NAME", help="name of the output files (the deck's name)")
    run.add_argument(
        "--oldjob",
        type=Path,
        metavar="JOB",
        help="job to go on from, with its folder: *RESTART, READ says from which state, its own deck from the last one",
    )
    run.add_argument("--output-dir", type=Path, metavar="DIR", help="folder of the output files (the current folder)")
    run.add_argument(
        "--parameter",
        type=assignment,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="value of a parameter that replaces the one in the deck's *PARAMETER; repeat for each parameter",
    )
    run.add_argument(
        "--cpus", type=int, default=1, metavar="N", help="threads that call the elements: the same results (1)"
    )
    run.add_argument(
        "--thread-safe",
        action="append",
        default=[],
        metavar="NAME",
        help="user elements of this type (Un), UMAT or USDFLD may be called by several threads; repeat for each",
    )
    add_same_process(run)
    run.add_argument("--quiet", action="store_true", help="no progress display")
    run.set_defaults(function=run_job)


def from_abaqus(parser: argparse.ArgumentParser, words: list[str]) -> list[str]:
    """Translate `job=NAME input=DECK user=FILE cpus=2` into this command's options."""
    pairs: list[tuple[str, str]] = []
    rest: list[str] = []
    for before, word in zip(["", *words], words, strict=False):
        key, equals, value = word.partition("=")
        # folders may have = in their names
        plain = not (equals or key.lower() in ABAQUS_OPTIONS) or os.sep in key
        if word.startswith("-") or before == "--parameter" or plain:
            rest.append(word)
        elif key.lower() in ABAQUS_OPTIONS:
            pairs.append((key.lower(), value))
        else:
            parser.error(f"unknown option '{key}='; expected one of {', '.join(f'{name}=' for name in ABAQUS_OPTIONS)}")
    if not pairs:
        return words
    deck = dict(pairs).get("input", dict(pairs).get("job", ""))
    if deck:
        rest.append(deck if Path(deck).suffix else f"{deck}.inp")
    for key, value in pairs:
        if (option := ABAQUS_OPTIONS[key]) and key != "input":
            rest += [option, value]
    return rest


def run_job(options: argparse.Namespace) -> int:
    """Run `uel run`."""
    from uel.output.outcome import ending  # noqa: PLC0415
    from uel.parallel.mpi import begin  # noqa: PLC0415
    from uel.running.job import run  # noqa: PLC0415 (keeps the other commands quick)
    from uel.running.options import RoutineOptions  # noqa: PLC0415
    from uel.solver.options import SolverOptions  # noqa: PLC0415

    ranks = begin(launched())

    result = run(
        options.deck,
        options.user,
        job=options.job,
        oldjob=options.oldjob,
        output_dir=options.output_dir,
        parameters=dict(options.parameter),
        solver=SolverOptions(
            linear_solver=options.solver, fallback=options.fallback, energy_control=options.control == "energy"
        ),
        routines=RoutineOptions(
            linear=options.linear,
            cpus=options.cpus,
            thread_safe=options.thread_safe,
            call_limit=options.call_limit,
            debug=options.debug,
        ),
        quiet=options.quiet,
        ranks=ranks,
    )
    if not (options.quiet or ranks.rank):
        for line in ending(result):
            tell(line)
    return 0
