# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The user's side of a job: compile a file of user routines as Abaqus does, load it, call it.

XIT, STDB_ABQERR and STOP in a user routine end the call, and the caller gets an error with the reason. What still ends
the whole process: an error inside the Fortran library (reading a file that is not there), a memory fault, and STOP in a
library that the user compiled himself.
"""

from harness.usersub.library import Library, load
from harness.usersub.messages import Message

__all__ = ["Library", "Message", "load"]
