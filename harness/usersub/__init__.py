# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The user's side of a job: compile a file of user routines as Abaqus does, load it, call it.

XIT, STDB_ABQERR, STOP, a segmentation fault, division of integers by zero and a call that takes too long end the call,
and the caller gets an error with the reason. What still ends the whole process: an error inside the Fortran library
(reading a file that is not there), abort where memory is found damaged, and STOP in a library that the user compiled
himself. What is on the slate (harness/slate.py) tells another process where that was.
"""

from harness.usersub._binding import limit_calls, share_slate
from harness.usersub.inputs import Change, beyond_jprops, local_variables, watched_inputs
from harness.usersub.library import Library, load
from harness.usersub.marks import ARRAYS, AS_GOOD_AS_ZERO, UNSET, marks, set_marks
from harness.usersub.messages import Message

__all__ = [
    "ARRAYS",
    "AS_GOOD_AS_ZERO",
    "UNSET",
    "Change",
    "Library",
    "Message",
    "beyond_jprops",
    "limit_calls",
    "load",
    "local_variables",
    "marks",
    "set_marks",
    "share_slate",
    "watched_inputs",
]
