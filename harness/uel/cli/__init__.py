# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel`."""

from uel.cli.command import main
from uel.cli.parser import build_parser
from uel.cli.run import from_abaqus

__all__ = ["build_parser", "from_abaqus", "main"]
