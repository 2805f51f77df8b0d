# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Step procedures: generators of records, which write no output themselves."""

from uel.procedures.loads.initial_states import set_initial_states
from uel.procedures.sequence import run_steps

__all__ = ["run_steps", "set_initial_states"]
