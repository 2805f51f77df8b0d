# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that a user routine gives in place of those of the deck."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from harness.model.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class UserValues:
    """What a routine is asked for, at the end of an increment.

    routine  its name
    time     step and total time
    places   (n, 2) node number and dof for DISP; (n, 3) element number, point and JLTYP for DLOAD
    coords   (n, 3) of the places
    given    (n,) values by magnitude and amplitude
    """

    routine: Literal["DISP", "DLOAD"]
    step: int
    increment: int
    time: tuple[float, float]
    places: NDArray[np.int32]
    coords: FloatArray
    given: FloatArray


class GivesValues(Protocol):
    """The part of a loaded library that gives values; disp, dload: addresses, None without the routine."""

    disp: int | None
    dload: int | None

    def user_values(self, asked: UserValues) -> FloatArray:
        """Values (n,) that the routine makes of those given."""
