# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Several processes, the ranks of MPI, that run one job together; README.md says how.

Here is what those that watch the ranks need, which load neither numpy nor MPI; `ranks` is what the ranks themselves do.
"""

from uel.parallel.end_reason import await_end, forget_word, leave_word, read_word
from uel.parallel.launch import Launch, launched, without_launch

__all__ = ["Launch", "await_end", "forget_word", "launched", "leave_word", "read_word", "without_launch"]
