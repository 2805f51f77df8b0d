# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run Abaqus decks with Abaqus user elements, without Abaqus."""

from harness.job import run

__all__ = ["run"]
