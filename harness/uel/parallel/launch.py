# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Data that `mpiexec` passes to each process that it starts; known before MPI is loaded."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Final

_VARIABLES: Final = (("PMI_RANK", "PMI_SIZE"), ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"))
"""Environment variables of MPICH and its descendants, and of Open MPI."""

_DESCRIPTOR: Final = "PMI_FD"
"""Variable with the descriptor by which MPICH talks to `mpiexec`."""


@dataclass(frozen=True, slots=True)
class Launch:
    """Rank of this process, from 0, and number of ranks; 0 of 1 without `mpiexec`.

    descriptors  that a process which is to be the rank in place of this one needs
    """

    rank: int = 0
    size: int = 1
    descriptors: tuple[int, ...] = ()

    @property
    def name(self) -> str:
        """Name of the rank for messages."""
        return f"rank {self.rank} of {self.size}"


def launched() -> Launch:
    """Find out how this process was started."""
    for rank, size in _VARIABLES:
        try:
            found = Launch(int(os.environ[rank]), int(os.environ[size]))
        except (KeyError, ValueError):
            continue
        if found.size > 1:
            given = os.environ.get(_DESCRIPTOR, "")
            return Launch(found.rank, found.size, (int(given),) if given.isdigit() else ())
    return Launch()


def without_launch() -> dict[str, str]:
    """Return the environment of a process that is no rank, whoever started this one."""
    names = {name for pair in _VARIABLES for name in pair}
    return {name: value for name, value in os.environ.items() if name not in names}
