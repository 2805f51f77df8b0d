# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel check`."""

from __future__ import annotations

import argparse
from pathlib import Path

from uel.cli.run_options import add_call_limit, add_same_process
from uel.cli.values import positive


def add_check(check: argparse.ArgumentParser) -> None:
    """Add the options of `uel check`."""
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


def check_elements(options: argparse.Namespace) -> int:
    """Run `uel check`."""
    from rich.console import Console  # noqa: PLC0415

    from uel.check.command import check  # noqa: PLC0415

    return check(options, Console(), isolated=options.apart)
