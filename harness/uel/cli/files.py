# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Commands that write files to begin with: `uel new`, `uel amalgamate`."""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path


def add_new(new: argparse.ArgumentParser) -> None:
    """Add the options of `uel new`."""
    new.add_argument("name", type=Path, metavar="NAME", help="name of the element and of its new folder")
    new.set_defaults(function=begin_element)


def begin_element(options: argparse.Namespace) -> int:
    """Run `uel new`."""
    from uel.project import create  # noqa: PLC0415

    for file in create(options.name):
        print(file)
    print(f"next: cd {options.name}; uel run {options.name.name}.inp --user {options.name.name}.for; pytest")
    return 0


def add_amalgamate(amalgamate: argparse.ArgumentParser) -> None:
    """Add the options of `uel amalgamate`."""
    amalgamate.add_argument(
        "-o", "--output", type=Path, required=True, metavar="FILE.for", help="the file that is written"
    )
    amalgamate.set_defaults(function=write_amalgam)


def write_amalgam(options: argparse.Namespace) -> int:
    """Run `uel amalgamate`."""
    from uel.usersub.own_kernels import path_of_amalgam  # noqa: PLC0415

    shutil.copyfile(path_of_amalgam(), options.output)
    print(f"{options.output}: UEL, UELMAT and UEXTERNALDB for abaqus job=... user={options.output.name}")
    return 0
