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

    descriptors  file descriptors that a process needs to be this rank in place of this process
    """

    rank: int = 0
    size: int = 1
    descriptors: tuple[int, ...] = ()

    @property
    def name(self) -> str:
        """Name of the rank for messages."""
        return f"rank {self.rank} of {self.size}"


def launched() -> Launch:
    """Read rank and size from the variables of `mpiexec`; 0 of 1 without them."""
    for rank, size in _VARIABLES:
        try:
            launch = Launch(int(os.environ[rank]), int(os.environ[size]))
        except (KeyError, ValueError):
            continue
        if launch.size > 1:
            descriptor = os.environ.get(_DESCRIPTOR, "")
            return Launch(launch.rank, launch.size, (int(descriptor),) if descriptor.isdigit() else ())
    return Launch()


def without_launch() -> dict[str, str]:
    """Return the environment without the variables of `mpiexec`, for a process that is no rank."""
    names = {name for pair in _VARIABLES for name in pair}
    return {name: value for name, value in os.environ.items() if name not in names}
