# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel report`: one page about a job, with its model, its run and its pictures."""

from uel.report.command import report

__all__ = ["report"]
