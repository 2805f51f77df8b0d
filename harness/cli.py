# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel`."""

from __future__ import annotations

import argparse
import io
import math
import os
import re
import shutil
import sys
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr
from pathlib import Path
from typing import TYPE_CHECKING

from harness import isolation, sanitizer
from harness.errors import FAILURES, SilentError, UelError, UsageError, drop_output, tell, tell_failure
from harness.parallel import launched

if TYPE_CHECKING:
    from harness.batch.runs import Settings

# options of the `abaqus` command and what they are here; None: accepted and without effect on one machine
ABAQUS_OPTIONS = {
    "job": "--job",
    "input": "deck",
    "user": "--user",
    "cpus": "--cpus",
    "interactive": None,
    "ask_delete": None,
    "double": None,
    "memory": None,
    "scratch": None,
}


_MANY = 1 << 31
"""Above every sensible count."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code: 0 on success, 1 on a failed or interrupted job, 2 on wrong usage.

    Without arguments it takes those of the command line, and `uel run` and `uel check` work in a separate process.
    """
    try:
        open_standard_streams()
        words, options = parse(sys.argv[1:] if arguments is None else arguments)
        # a program that calls this function, or a debugger, gets the work in its own process
        options.apart = arguments is None and not getattr(options, "same_process", True)
        if options.apart and options.function is run_job:
            stem = (options.output_dir or Path()) / (options.deck.stem if options.job is None else options.job)
            sanitized = options.debug and sanitizer.applies_to(options.user or ())
            return isolation.supervise(words, stem, options.call_limit, sanitized=sanitized, launch=launched())
        code = int(options.function(options))
        if sys.stdout is not None:
            sys.stdout.flush()
        return code
    except BrokenPipeError:
        # the reader of a pipe has closed it
        drop_output()
    except SilentError as silent:
        return silent.code
    except FAILURES as error:
        if isinstance(error, OSError) and error.filename is None:
            error.filename = "standard output"
            drop_output()
        tell_failure(error)
        return 2 if isinstance(error, UsageError) else 1
    return 1


def parse(arguments: Sequence[str]) -> tuple[list[str], argparse.Namespace]:
    """Words of a command line in this command's spelling, and its options; ends the process if they are wrong.

    Of several ranks of `uel run` only the first one says what is wrong.
    """
    words = list(arguments)
    speaks = not launched().rank or words[:1] != ["run"]
    with redirect_stderr(sys.stderr if speaks else io.StringIO()):
        parser = build_parser()
        if words[:1] == ["run"]:
            words[1:] = from_abaqus(parser, words[1:])
        elif words[:1] == ["law"]:
            # properties may stand anywhere between the options
            words[1:] = sorted(words[1:], key=lambda word: word.startswith("-") or "=" not in word)
        elif words[:1] == ["insert"]:
            # here, too, also where an option takes any number of names
            words[1:] = [f"--property={word}" if re.match(r"\w[\w ]*=", word) else word for word in words[1:]]
        for word in words:
            if word.startswith("-") and word.endswith("=--"):
                # argparse drops two dashes
                parser.error(f"argument {word.removesuffix('=--')}: expected one argument, found '--'")
        return words, parser.parse_args(words)


def open_standard_streams() -> None:
    """Open those that are closed: the next file opened would get their number, and what user code prints."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def build_parser() -> argparse.ArgumentParser:
    """Subcommands and their options."""
    parser = argparse.ArgumentParser(prog="uel", description="Run Abaqus decks with user elements, without Abaqus.")
    parser.add_argument(
        "--version", action=_Version, nargs=0, default=argparse.SUPPRESS, help="print the version and exit"
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    run = commands.add_parser("run", help="run a deck")
    run.epilog = (
        "Abaqus' spelling works too: uel run job=NAME user=FILE. "
        "Exit code: 0 the analysis has completed; 1 an error, an interrupt or the system ended it; 2 wrong usage."
    )
    run.add_argument("deck", type=Path, metavar="DECK.inp")
    add_run_options(run)
    run.add_argument("--job", metavar="NAME", help="name of the output files (the deck's name)")
    run.add_argument("--output-dir", type=Path, metavar="DIR", help="folder of the output files (the current folder)")
    run.add_argument(
        "--parameter",
        type=assignment,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="value of a parameter in place of the one in the deck's *PARAMETER; repeat for each parameter",
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

    add_batch(commands.add_parser("batch", help="run many decks, or one deck with many values, several at a time"))

    add_fit(commands.add_parser("fit", help="find parameters of a deck from a measured curve"))
    add_insert(commands.add_parser("insert", help="put interface elements into a deck or a mesh"))

    new = commands.add_parser("new", help="start a user element: kernel, deck, tests, CI")
    new.add_argument("name", type=Path, metavar="NAME", help="name of the element and of its new folder")
    new.set_defaults(function=begin_element)

    add_reproduce(
        commands.add_parser("reproduce", help="run the cases of the paper, draw its figures, check what it says")
    )

    amalgamate = commands.add_parser("amalgamate", help="write our elements as one file for Abaqus")
    amalgamate.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.for")
    amalgamate.set_defaults(function=write_amalgam)

    add_law(commands.add_parser("law", help="drive one interface element, plot traction over separation"))

    front = commands.add_parser("front", help="write and draw the front of a delamination in space, with G along it")
    front.epilog = "Written: JOB_front.csv and JOB_front.png, next to the files of the job."
    front.add_argument("job", type=Path, metavar="JOB", help="name of a job that has run, with its folder")
    front.add_argument("--damage", type=PART, default=0.5, metavar="D", help="damage at the front (0.5)")
    front.set_defaults(function=trace_front)

    add_plot(commands.add_parser("plot", help="draw jobs that have run: load-displacement and more, over each other"))

    report = commands.add_parser("report", help="write a page about a job: model, run, warnings, pictures")
    report.add_argument("job", type=Path, metavar="JOB", help="name of a job that has run, with its folder")
    report.add_argument("-o", "--output", type=Path, metavar="FILE.html", help="the page (JOB.html)")
    report.set_defaults(function=write_report)

    add_check(commands.add_parser("check", help="check the user elements of a deck with the calls of a run"))

    solvers = commands.add_parser("solvers", help="list the linear solvers and say when each is used")
    solvers.set_defaults(function=list_solvers)

    doctor = commands.add_parser("doctor", help="say what of this installation works, and what to do about the rest")
    doctor.epilog = "Exit code: 0 all that is indispensable works; 1 something is broken."
    doctor.set_defaults(function=examine_installation)

    completion = commands.add_parser("completion", help="print the script with which a shell completes this command")
    completion.epilog = "For bash: uel completion bash > ~/.local/share/bash-completion/completions/uel"
    completion.add_argument("shell", choices=["bash", "zsh", "fish"])
    completion.set_defaults(function=print_completion)
    return parser


class _Version(argparse.Action):
    """Looks the version up where it is asked for: reading the metadata of packages takes time."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from harness.doctor import release  # noqa: PLC0415

        print(f"{parser.prog} {release() or '(not installed as a package)'}")
        parser.exit()


def add_run_options(command: argparse.ArgumentParser) -> list[argparse.Action]:
    """Options that say how a deck runs, of commands that run decks."""
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


def add_batch(batch: argparse.ArgumentParser) -> None:
    """Options of `uel batch`."""
    batch.formatter_class = argparse.RawDescriptionHelpFormatter
    batch.description = (
        "Each run has a folder of its own in the output folder, and a line of its table results.csv. The same command\n"
        "again runs what has not completed, and what has other inputs than before: deck, included files, user files,\n"
        "values, options, or another version of this program."
    )
    batch.epilog = (
        "On a cluster each task of a job array runs a part; all have one output folder:\n"
        "  Slurm  --part $SLURM_ARRAY_TASK_ID/20   after sbatch --array=1-20\n"
        "  PBS    --part $PBS_ARRAY_INDEX/20       after qsub -J 1-20\n"
        "  LSF    --part $LSB_JOBINDEX/20          after bsub -J 'NAME[1-20]'\n"
        "Exit code: 0 all runs (of the part) have completed; 1 one has not, or nothing could be run; 2 wrong usage."
    )
    batch.add_argument(
        "decks",
        nargs="+",
        type=Path,
        metavar="DECK.inp",
        help="decks, or folders: all their decks that no other includes",
    )
    batch.add_argument(
        "--table",
        type=Path,
        metavar="FILE.csv",
        help="values for the parameters of one deck's *PARAMETER: their names in the first line, then a line for each "
        "run; a column `job` names the runs (DECK-1, DECK-2, ...)",
    )
    batch.add_argument(
        *("-o", "--output-dir"), type=Path, default=Path("batch"), metavar="DIR", help="folder of the output (batch)"
    )
    batch.add_argument("--cpus", type=positive, metavar="N", help="runs at a time (one for each core)")
    batch.add_argument(
        "--part", type=part, default=(1, 1), metavar="I/N", help="run the I-th of N parts only, I from 1 to N"
    )
    batch.add_argument(
        "--keep-failed", action="store_true", help="do not repeat runs that did not complete, if nothing has changed"
    )
    batch.add_argument("--collect", action="store_true", help="run nothing: write the table of what has run")
    batch.add_argument("--quiet", action="store_true", help="neither progress nor a summary")
    batch.set_defaults(function=run_batch, of_runs=add_run_options(batch))


def add_fit(fit: argparse.ArgumentParser) -> None:
    """Options of `uel fit`."""
    fit.description = (
        "Runs the deck with other values until its curve is the measured one, in the sense of least squares. An "
        "interrupted fit resumes where it stopped."
    )
    fit.epilog = (
        "Written: DECK_fit.csv with values, confidence intervals and correlations, DECK_fit_curve.csv and DECK_fit.png "
        "with the curves and their derivatives. "
        "Exit code: 0 the search has converged; 1 it has not, or a run cannot be compared; 2 wrong usage."
    )
    fit.add_argument("deck", type=Path, metavar="DECK.inp")
    fit.add_argument(
        "curve",
        type=Path,
        metavar="CURVE.csv",
        help="two columns, whose names are those of the history: x, which rises, y",
    )
    fit.add_argument(
        "variables",
        nargs="+",
        metavar="NAME=LOW:HIGH",
        help="parameters of the deck's *PARAMETER, or properties of the project's interface elements, with bounds "
        "above 0; NAME=LOW:START:HIGH chooses the start",
    )
    for axis in "xy":
        fit.add_argument(
            f"--{axis}", metavar="COLUMN", help=f"column of the history that is {axis}, such as U2[TOP], 2*U2[TOP]"
        )
    fit.add_argument(
        "-o", "--output-dir", type=Path, default=Path("fit"), metavar="DIR", help="folder of the output (fit)"
    )
    fit.add_argument("--runs", type=positive, default=40, metavar="N", help="largest number of runs (40)")
    fit.add_argument("--cpus", type=positive, metavar="N", help="runs at a time (one for each core)")
    fit.add_argument("--quiet", action="store_true", help="print errors only")
    fit.set_defaults(function=fit_parameters, of_runs=add_run_options(fit))


def add_law(law: argparse.ArgumentParser) -> None:
    """Options of `uel law`."""
    law.add_argument("properties", nargs="*", metavar="NAME=VALUE", help="properties (those of the paper's table 2)")
    law.add_argument("--deck", type=Path, metavar="DECK.inp", help="take properties and element type from a deck")
    law.add_argument("--elset", metavar="NAME", help="... from the *UEL PROPERTY of this set (the first)")
    law.add_argument("--element", choices=["U2", "U4", "U5", "U6"], help="element type (U2, or as in the deck)")
    law.add_argument(
        *("--angles", "-a"),
        nargs="+",
        type=FINITE,
        metavar="DEGREES",
        default=[0.0, 30.0, 60.0, 90.0],
        help="directions of the separation in degrees, 0 opening, 90 sliding (0 30 60 90)",
    )
    law.add_argument(
        "--reach", type=ABOVE_ZERO, metavar="LENGTH", help="largest separation (where no traction is left)"
    )
    law.add_argument(
        *("--unload", "-u"), nargs="+", type=PART, metavar="F", default=[], help="unload to 0 at these fractions of it"
    )
    law.add_argument(
        "--close",
        type=NOT_NEGATIVE,
        metavar="F",
        default=0.0,
        help="... and then press together by this fraction of it",
    )
    law.add_argument("--path", metavar="'N,T N,T ...'", help="follow these separations instead")
    law.add_argument(
        "--units", nargs=2, metavar=("LENGTH", "STRESS"), help="for the axes (mm MPa; unknown with --deck)"
    )
    law.add_argument("--surface", action="store_true", help="also draw both tractions over both separations")
    law.add_argument(
        "--increments",
        type=positive,
        default=400,
        metavar="N",
        help="increments per curve, or per line of a path (400)",
    )
    law.add_argument("--duration", type=ABOVE_ZERO, default=1.0, metavar="TIME", help="step time of a curve (1)")
    law.add_argument("--job", default="law", metavar="NAME", help="name of the output files (law)")
    law.add_argument("--output-dir", type=Path, default=Path(), metavar="DIR", help="folder of the files (current)")
    law.set_defaults(function=explore_law)


def add_plot(plot: argparse.ArgumentParser) -> None:
    """Options of `uel plot`."""
    plot.epilog = (
        "load: load over displacement, or the columns --y of NAME_history.csv over --x; energies: of the whole model; "
        "iterations: of each increment, and its size; interface: tractions and damage along an interface in the plane; "
        "mesh: the deformed mesh of one job, with a field."
    )
    plot.add_argument("jobs", nargs="+", type=Path, metavar="JOB", help="names of jobs that have run, with folders")
    plot.add_argument(
        "--kind", choices=("load", "energies", "iterations", "interface", "mesh"), default="load", help="what (load)"
    )
    plot.add_argument("--x", default="", metavar="COLUMN", help="of the history, such as U2[TIP] (time)")
    plot.add_argument("--y", nargs="+", default=[], metavar="COLUMN", help="of the history, such as RF2[TIP] ALLSE")
    plot.add_argument(
        "--csv",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="draw a measured curve too: two columns, or those named --x and --y; repeat for each file",
    )
    plot.add_argument("--step", type=positive, metavar="N", help="of a profile or mesh (the last one)")
    plot.add_argument("--increment", type=positive, default=-1, metavar="N", help="... (the last one written)")
    plot.add_argument("--field", default="U", metavar="NAME", help="on the mesh: U, U1, S22, DAMAGE, ... (U)")
    plot.add_argument(
        "--scale", type=NOT_NEGATIVE, metavar="F", help="of its displacements (1, or more where they would not be seen)"
    )
    plot.add_argument(
        *("-o", "--output"), type=Path, metavar="FILE", help="picture: .png, .svg or .pdf (JOB_KIND.png, of the first)"
    )
    plot.set_defaults(function=plot_jobs)


def add_insert(insert: argparse.ArgumentParser) -> None:
    """Options of `uel insert`."""
    insert.description = (
        "The mesh is cut where the options say, and the nodes there are doubled; loads, sets, surfaces and constraints "
        "of the deck follow. See harness/insertion/README.md."
    )
    insert.epilog = "Properties of the elements, NAME=VALUE, may stand anywhere: SIGMAMAX=30 TAUMAX=60 GIC=0.26 GIIC=1."
    insert.add_argument(
        "files", nargs="+", type=Path, metavar="FILE", help="a deck (.inp); or a mesh (.msh, ...), and its deck"
    )
    insert.add_argument("-o", "--output", type=Path, required=True, metavar="OUT.inp", help="the deck that is written")
    where = insert.add_argument_group("where; repeat what takes names of one place")
    where.add_argument(
        *("--between", "-b"),
        nargs=2,
        action="append",
        default=[],
        metavar=("BELOW", "ABOVE"),
        help="between two element sets",
    )
    where.add_argument("--surface", action="append", default=[], metavar="NAME", help="along a surface of elements")
    where.add_argument(
        "--nodes", action="append", default=[], metavar="NSET", help="along the faces whose nodes are in a node set"
    )
    where.add_argument(
        "--plies",
        nargs="*",
        metavar="ELSET",
        help="between all plies: element sets from the lowest to the highest (those of the sections)",
    )
    where.add_argument("--all", action="append", default=[], metavar="ELSET", help="between all elements of a set")
    where.add_argument(
        "--crack",
        action="append",
        default=[],
        metavar="SET",
        help="initial crack: no elements where these faces are in a node set, at an element set or in a surface",
    )
    insert.add_argument(
        "--element", default="", metavar="TYPE", help="COH2D4, COH3D8, U2, U4, ... (the recommended one that fits)"
    )
    insert.add_argument("--elset", default="INTERFACE", metavar="NAME", help="set that takes them (INTERFACE)")
    insert.add_argument(
        "--solids",
        action="append",
        default=[],
        metavar="TYPE",
        help="continuum element for cells of a mesh; repeat for each shape (CPS4, C3D8, ...)",
    )
    insert.add_argument("--property", action="append", default=[], help=argparse.SUPPRESS)
    insert.set_defaults(function=insert_elements)


def add_reproduce(reproduce: argparse.ArgumentParser) -> None:
    """Options of `uel reproduce`."""
    reproduce.epilog = "An interrupted run resumes where it stopped."
    reproduce.add_argument(
        "cases", nargs="*", metavar="CASE", help="law, patch, dcb, enf, frmm, sensitivity (all of them)"
    )
    reproduce.add_argument("--quick", action="store_true", help="coarser meshes, fewer increments")
    reproduce.add_argument(
        "--output-dir", type=Path, default=Path("reproduce"), metavar="DIR", help="folder of the output (reproduce)"
    )
    reproduce.set_defaults(function=reproduce_paper)


def add_check(check: argparse.ArgumentParser) -> None:
    """Options of `uel check`."""
    check.epilog = (
        "Exit code: 0 all checks that apply passed, and at least one per element type judged forces; 1 a check failed, "
        "possibly the run itself; 2 nothing was looked at: the deck or a file is wrong, or no check applies."
    )
    check.add_argument("files", nargs="+", type=Path, metavar="FILE", help="the deck (.inp), and user routines")
    check.add_argument(
        "--user", type=Path, action="append", default=[], metavar="FILE", help="as for `uel run` (the project's own)"
    )
    check.add_argument("--shuffle", action="store_true", help="check the calling order only, in detail")
    check.add_argument(
        "--skip", action="append", default=[], metavar="CHECK", help="leave out a check (may be repeated)"
    )
    check.add_argument("--json", type=Path, metavar="FILE", help="write the findings for other programs")
    check.add_argument("--quiet", action="store_true", help="no progress display")
    check.add_argument(
        "--seed", type=positive, default=1, metavar="N", help="seed of random orders and displacements (1)"
    )
    check.add_argument("--increments", type=positive, default=3, metavar="K", help="increments of the deck to run (3)")
    add_call_limit(check)
    add_same_process(check)
    check.set_defaults(function=check_elements)


def add_call_limit(command: argparse.ArgumentParser) -> argparse.Action:
    """Option of commands that call user code."""
    return command.add_argument(
        "--call-limit",
        type=NOT_NEGATIVE,
        default=60.0,
        metavar="SECONDS",
        help="time limit of one call of a user routine, and of loading the library; 0: none (60)",
    )


def add_same_process(command: argparse.ArgumentParser) -> None:
    """Option of commands that work in a separate process."""
    command.add_argument(isolation.SAME_PROCESS, action="store_true", help="for debuggers: run in this process")


def number(words: str, holds: Callable[[float], bool] = math.isfinite) -> Callable[[str], float]:
    """Converter of an option to a finite number that meets a condition; words say what is expected."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and holds(value)):
            raise argparse.ArgumentTypeError(f"expected {words}, found '{text}'")
        return value

    return read


FINITE = number("a number")
ABOVE_ZERO = number("a number above 0", lambda value: value > 0.0)
NOT_NEGATIVE = number("a number of 0 or more", lambda value: value >= 0.0)
PART = number("a number from 0 to 1", lambda value: 0.0 <= value <= 1.0)


def positive(text: str) -> int:
    """A whole number of 1 or more, given as an option."""
    return int(
        number("a whole number of 1 or more", lambda value: value >= 1.0 and value == int(value) and value < _MANY)(
            text
        )
    )


def part(text: str) -> tuple[int, int]:
    """Which of how many parts, given as an option."""
    index, _, count = text.partition("/")
    if index.isdecimal() and count.isdecimal() and 1 <= int(index) <= int(count) < _MANY:
        return int(index), int(count)
    raise argparse.ArgumentTypeError(f"expected I/N with I from 1 to N, such as 3/20, found '{text}'")


def words_of(actions: Sequence[argparse.Action], options: argparse.Namespace) -> list[str]:
    """Words of the command line that give these options."""
    words: list[str] = []
    for action in actions:
        value = getattr(options, action.dest)
        if value is True:
            words.append(action.option_strings[0])
        elif value != action.default:
            each = value if isinstance(value, list) else [value]
            words += [f"{action.option_strings[0]}={one}" for one in each]
    return words


def assignment(text: str) -> tuple[str, float]:
    """Name and value of a parameter, given as an option."""
    from harness.batch.values import value_of  # noqa: PLC0415 (keeps the other commands quick)

    name, _, value = text.partition("=")
    try:
        return name.strip(), value_of(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected NAME=VALUE with a number, found '{text}'") from None


def from_abaqus(parser: argparse.ArgumentParser, words: list[str]) -> list[str]:
    """Translate `job=NAME input=DECK user=FILE cpus=2` into this command's options."""
    given: list[tuple[str, str]] = []
    rest: list[str] = []
    for before, word in zip(["", *words], words, strict=False):
        key, equals, value = word.partition("=")
        if word.startswith("-") or before == "--parameter" or not (equals or key.lower() in ABAQUS_OPTIONS):
            rest.append(word)
        elif key.lower() in ABAQUS_OPTIONS:
            given.append((key.lower(), value))
        else:
            parser.error(f"unknown option '{key}='; expected one of {', '.join(f'{name}=' for name in ABAQUS_OPTIONS)}")
    if not given:
        return words
    deck = dict(given).get("input", dict(given).get("job", ""))
    if deck:
        rest.append(deck if Path(deck).suffix else f"{deck}.inp")
    for key, value in given:
        if (option := ABAQUS_OPTIONS[key]) and key != "input":
            rest += [option, value]
    return rest


def run_job(options: argparse.Namespace) -> int:
    """`uel run`."""
    from harness.job import run  # noqa: PLC0415 (keeps the other commands quick)
    from harness.output.ending import ending  # noqa: PLC0415
    from harness.parallel.ranks import begin  # noqa: PLC0415

    ranks = begin(launched())

    result = run(
        options.deck,
        options.user,
        job=options.job,
        output_dir=options.output_dir,
        parameters=dict(options.parameter),
        solver=options.solver,
        fallback=options.fallback,
        energy_control=options.control == "energy",
        linear=options.linear,
        cpus=options.cpus,
        thread_safe=options.thread_safe,
        call_limit=options.call_limit,
        debug=options.debug,
        quiet=options.quiet,
        ranks=ranks,
    )
    if not (options.quiet or ranks.rank):
        for line in ending(result):
            tell(line)
    return 0


def run_batch(options: argparse.Namespace) -> int:
    """`uel batch`."""
    from harness.batch.command import batch  # noqa: PLC0415

    completed = batch(
        options.decks,
        options.output_dir,
        settings_of(options),
        table=options.table,
        part=options.part,
        workers=options.cpus,
        keep_failed=options.keep_failed,
        collect=options.collect,
        quiet=options.quiet,
    )
    return 0 if completed else 1


def settings_of(options: argparse.Namespace) -> Settings:
    """How the runs of a command are made."""
    from harness.batch.runs import Settings  # noqa: PLC0415

    how = [action for action in options.of_runs if action.dest not in ("user", "call_limit")]
    return Settings(options.user, words_of(how, options), options.call_limit)


def fit_parameters(options: argparse.Namespace) -> int:
    """`uel fit`."""
    from harness.fit.command import fit  # noqa: PLC0415
    from harness.fit.estimate import CONVERGED  # noqa: PLC0415

    found = fit(
        options.deck,
        options.curve,
        options.variables,
        options.output_dir,
        settings_of(options),
        x=options.x,
        y=options.y,
        limit=options.runs,
        workers=options.cpus,
        quiet=options.quiet,
    )
    return 0 if found.ended == CONVERGED else 1


def insert_elements(options: argparse.Namespace) -> int:
    """`uel insert`."""
    from harness.insertion.command import insert  # noqa: PLC0415
    from harness.insertion.selection import Wanted  # noqa: PLC0415

    if any(options.output.resolve() == file.resolve() for file in options.files):
        raise UsageError(f"-o {options.output}: is what is read; write to another file")
    pairs = [(below, above) for below, above in options.between]
    wanted = Wanted(pairs, options.surface, options.nodes, options.plies, options.all, options.crack)
    text, done = insert(
        options.files,
        wanted,
        element=options.element,
        elset=options.elset,
        solids=options.solids,
        values=options.property,
    )
    options.output.write_text(text, encoding="utf-8")
    for line in done.lines(options.elset):
        tell(line)
    tell(f"written: {options.output}")
    return 0


def begin_element(options: argparse.Namespace) -> int:
    """`uel new`."""
    from harness.project import create  # noqa: PLC0415

    for file in create(options.name):
        print(file)
    print(f"next: cd {options.name}; uel run {options.name.name}.inp --user {options.name.name}.for; pytest")
    return 0


def write_amalgam(options: argparse.Namespace) -> int:
    """`uel amalgamate`."""
    from harness.usersub.built import path_of_amalgam  # noqa: PLC0415

    shutil.copyfile(path_of_amalgam(), options.output)
    print(f"{options.output}: UEL, UELMAT and UEXTERNALDB for abaqus job=... user={options.output.name}")
    return 0


def explore_law(options: argparse.Namespace) -> int:
    """`uel law`."""
    from rich.console import Console  # noqa: PLC0415

    from harness.delamination.law_report import Exploration, explore, path_points, summary  # noqa: PLC0415

    asked = {
        name: value for name, value in vars(options).items() if name not in ("function", "apart", "element", "path")
    }
    path = None if options.path is None else path_points(options.path)
    element = None if options.element is None else int(options.element[1:])
    asked["units"] = None if options.units is None else tuple(options.units)
    curves, files = explore(Exploration(**asked, path=path, element=element))
    Console().print(summary(curves))
    print("written:", *files)
    return 0


def trace_front(options: argparse.Namespace) -> int:
    """`uel front`."""
    from harness.output.front import draw_fronts, fronts, write_fronts  # noqa: PLC0415
    from harness.output.results import Result  # noqa: PLC0415

    result = Result(options.job)
    found = fronts(result, options.damage)
    table, picture = result.file("_front.csv"), result.file("_front.png")
    write_fronts(table, found)
    draw_fronts(picture, found)
    print(f"written: {table} {picture}")
    return 0


def plot_jobs(options: argparse.Namespace) -> int:
    """`uel plot`."""
    from harness.output.pictures import Asked, draw  # noqa: PLC0415
    from harness.output.results import Result  # noqa: PLC0415

    results = [Result(job) for job in options.jobs]
    asked = Asked(options.x, options.y, options.csv, options.increment, options.step, options.field, options.scale)
    path = options.output or results[0].file(f"_{options.kind}.png")
    print(f"written: {draw(options.kind, results, path, asked)}")
    return 0


def write_report(options: argparse.Namespace) -> int:
    """`uel report`."""
    from harness.report import report  # noqa: PLC0415

    print(f"written: {report(options.job, options.output)}")
    return 0


def check_elements(options: argparse.Namespace) -> int:
    """`uel check`."""
    from rich.console import Console  # noqa: PLC0415

    from harness.check.command import check  # noqa: PLC0415

    return check(options, Console(), apart=options.apart)


def reproduce_paper(options: argparse.Namespace) -> int:
    """`uel reproduce`."""
    from rich.console import Console  # noqa: PLC0415

    from harness.delamination.reproduce.command import reproduce  # noqa: PLC0415

    reproduce(options.cases, options.output_dir, quick=options.quick, console=Console())
    return 0


def list_solvers(_: argparse.Namespace) -> int:
    """`uel solvers`."""
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    from harness.solver.linear import available, measured, with_ranks  # noqa: PLC0415

    console = Console()
    table = Table("solver", "installed", "version", "when it is used")
    for row in (*available(), with_ranks()):
        table.add_row(row.name, "yes" if row.installed else "no", row.version, row.note)
    console.print(table)
    machine, rows = measured.read()
    times = Table(*measured.HEADER, title=f"CPU times in ms, {machine}", title_justify="left")
    for measurement in rows:
        times.add_row(*measurement.cells)
    console.print(times)
    console.print(
        "first: with the analysis; in part: after a change in the process zone of a crack; GMRES: iterations after it "
        "on the last factors. auto goes by these times; see harness/solver/linear/solvers.md"
    )
    return 0


def examine_installation(_: argparse.Namespace) -> int:
    """`uel doctor`."""
    from harness.doctor import report  # noqa: PLC0415

    return 0 if report(tell) else 1


def print_completion(options: argparse.Namespace) -> int:
    """`uel completion`."""
    try:
        import shtab  # noqa: PLC0415
    except ImportError:
        raise UelError("completion needs the package shtab (pip install shtab)") from None
    parser = build_parser()
    commands = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    for command in commands.choices.values():
        for action in command._actions:
            if action.type is Path:
                action.complete = shtab.DIRECTORY if action.metavar == "DIR" else shtab.FILE
    print(shtab.complete(parser, options.shell))
    return 0


if __name__ == "__main__":
    sys.exit(main())
