# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The user's side of a job: compile a file of user routines as Abaqus does, load it, call it.

A Fortran STOP or a run-time error of the Fortran library inside a user routine ends the whole process; XIT and
STDB_ABQERR do not: they end the call, and the caller gets a KernelError.
"""

from harness.usersub.library import Library, load
from harness.usersub.messages import Message

__all__ = ["Library", "Message", "load"]
