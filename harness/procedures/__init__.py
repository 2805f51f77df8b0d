# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Step procedures: generators of records, without output of their own."""

from harness.procedures.sequence import run_steps

__all__ = ["run_steps"]
