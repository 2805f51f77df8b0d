# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Several processes, the ranks of MPI, that run one job together; README.md says how.

The processes that watch the ranks use these functions, which load neither numpy nor MPI. The ranks use `ranks`.
"""

from uel.parallel.end_reason import await_end, read_reason, remove_reason, write_reason
from uel.parallel.launch import Launch, launched, without_launch

__all__ = ["Launch", "await_end", "launched", "read_reason", "remove_reason", "without_launch", "write_reason"]
