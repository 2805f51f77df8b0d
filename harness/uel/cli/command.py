# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel`, and how it ends."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr
from pathlib import Path
from typing import Final

from uel.cli.insert import mark_properties
from uel.cli.law import properties_first
from uel.cli.parser import build_parser
from uel.cli.run import from_abaqus, run_job
from uel.errors import FAILURES, SilentError, UsageError, drop_output, tell_failure
from uel.parallel import launched
from uel.running import isolation, sanitizer

SPELLINGS: Final = {"run": from_abaqus, "law": properties_first, "insert": mark_properties}
"""Functions that bring the words after a subcommand into the order and spelling of its options."""


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
    """Put a command line in this command's spelling, and parse its options; ends the process if they are wrong.

    Of several ranks of `uel run` only the first one says what is wrong.
    """
    words = list(arguments)
    speaks = not launched().rank or words[:1] != ["run"]
    with redirect_stderr(sys.stderr if speaks else io.StringIO()):
        parser = build_parser()
        if words and words[0] in SPELLINGS:
            words[1:] = SPELLINGS[words[0]](parser, words[1:])
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
