# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Subcommands of `uel`."""

from __future__ import annotations

import argparse

from uel.cli.batch import add_batch
from uel.cli.check import add_check
from uel.cli.files import add_amalgamate, add_new
from uel.cli.fit import add_fit, add_fit_sn
from uel.cli.insert import add_insert
from uel.cli.installation import add_completion, add_doctor, add_solvers
from uel.cli.law import add_law
from uel.cli.reproduce import add_reproduce
from uel.cli.results import add_front, add_plot, add_report
from uel.cli.run import add_run


def build_parser() -> argparse.ArgumentParser:
    """Build the parser of the subcommands and their options."""
    parser = argparse.ArgumentParser(prog="uel", description="Run Abaqus decks with user elements, without Abaqus.")
    parser.add_argument(
        "--version", action=_Version, nargs=0, default=argparse.SUPPRESS, help="print the version and exit"
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    add_run(commands.add_parser("run", help="run a deck"))
    add_batch(commands.add_parser("batch", help="run many decks, or one deck with many values, several at a time"))
    add_fit(commands.add_parser("fit", help="find parameters of a deck from a measured curve"))
    add_fit_sn(commands.add_parser("fit-sn", help="find properties of FATIGUE from S-N points"))
    add_insert(commands.add_parser("insert", help="put interface elements into a deck or a mesh"))
    add_new(commands.add_parser("new", help="start a user element: kernel, deck, tests, CI"))
    add_reproduce(
        commands.add_parser("reproduce", help="run the cases of the paper, draw its figures, check what it says")
    )
    add_amalgamate(commands.add_parser("amalgamate", help="write our elements as one file for Abaqus"))
    add_law(commands.add_parser("law", help="drive one interface element, plot traction over separation"))
    add_front(commands.add_parser("front", help="write and draw the front of a delamination in space, with G along it"))
    add_plot(commands.add_parser("plot", help="draw jobs that have run: load-displacement and more, over each other"))
    add_report(commands.add_parser("report", help="write a page about a job: model, run, warnings, pictures"))
    add_check(commands.add_parser("check", help="check the user elements of a deck with the calls of a run"))
    add_solvers(commands.add_parser("solvers", help="list the linear solvers and say when each is used"))
    add_doctor(commands.add_parser("doctor", help="say what of this installation works, and what to do about the rest"))
    add_completion(
        commands.add_parser("completion", help="print the script with which a shell completes this command"), parser
    )
    return parser


class _Version(argparse.Action):
    """Option that looks the version up where it is asked for: reading the metadata of packages takes time."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from uel.doctor import release  # noqa: PLC0415

        print(f"{parser.prog} {release() or '(not installed as a package)'}")
        parser.exit()
