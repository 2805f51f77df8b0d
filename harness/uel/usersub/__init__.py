# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User routines of a job: compiled as in Abaqus, loaded and called.

XIT, STDB_ABQERR, STOP, a segmentation fault, an integer division by zero and a time-out end the call, and the caller
gets an error with the reason. Errors of the Fortran library (reading a missing file), an abort because of damaged
memory, and STOP in a library compiled by the user end the process; the slate (harness/uel/shared_progress.py) tells
another process the location.
"""

from uel.usersub._binding import allocated, limit_calls, set_rank, set_threads, share_slate, trap
from uel.usersub.compilation.languages import is_source
from uel.usersub.compilation.source_lines import names_line
from uel.usersub.compilation.suspicions import Suspicion, suspicions
from uel.usersub.guards import ARRAYS, AS_GOOD_AS_ZERO, UNSET, guard_values, room, set_guard_values
from uel.usersub.input_watch import Change, around, local_variables, watched_inputs, writes_outside
from uel.usersub.library import Library, compile_ahead, load
from uel.usersub.messages import Message

__all__ = [
    "ARRAYS",
    "AS_GOOD_AS_ZERO",
    "UNSET",
    "Change",
    "Library",
    "Message",
    "Suspicion",
    "allocated",
    "around",
    "compile_ahead",
    "guard_values",
    "is_source",
    "limit_calls",
    "load",
    "local_variables",
    "names_line",
    "room",
    "set_guard_values",
    "set_rank",
    "set_threads",
    "share_slate",
    "suspicions",
    "trap",
    "watched_inputs",
    "writes_outside",
]
