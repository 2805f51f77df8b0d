# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel`."""

from harness.cli.command import main
from harness.cli.parser import build_parser
from harness.cli.run import from_abaqus

__all__ = ["build_parser", "from_abaqus", "main"]
