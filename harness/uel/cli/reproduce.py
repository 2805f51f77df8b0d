# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel reproduce`."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_reproduce(reproduce: argparse.ArgumentParser) -> None:
    """Add the options of `uel reproduce`."""
    reproduce.epilog = "An interrupted run resumes where it stopped."
    reproduce.add_argument(
        "cases", nargs="*", metavar="CASE", help="law, patch, dcb, enf, frmm, sensitivity (all of them)"
    )
    reproduce.add_argument("--quick", action="store_true", help="coarser meshes, fewer increments")
    reproduce.add_argument(
        "--output-dir", type=Path, default=Path("reproduce"), metavar="DIR", help="folder of the output (reproduce)"
    )
    reproduce.set_defaults(function=reproduce_paper)


def reproduce_paper(options: argparse.Namespace) -> int:
    """Run `uel reproduce`."""
    from rich.console import Console  # noqa: PLC0415

    from uel.paper.reproduce.command import reproduce  # noqa: PLC0415

    reproduce(options.cases, options.output_dir, quick=options.quick, console=Console())
    return 0
