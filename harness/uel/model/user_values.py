# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values of a user routine that replace those of the deck."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class UserValues:
    """Arguments of a routine that gives values at the end of an increment.

    routine  its name
    time     step and total time
    size     of the increment, for DISP
    numbers  (n, 2) node number and dof for DISP, or number of the field for UTEMP and UFIELD, 0 for temperature;
             (n, 3) element number, point and JLTYP for DLOAD
    coords   (n, 3) coordinates of the nodes or points
    values   (n,) values by magnitude and amplitude
    temperatures  (n, 2) for UFIELD: at the end of the increment, and their change
    """

    routine: Literal["DISP", "DLOAD", "UTEMP", "UFIELD"]
    step: int
    increment: int
    time: tuple[float, float]
    numbers: NDArray[np.int32]
    coords: FloatArray
    values: FloatArray
    temperatures: FloatArray | None = None
    size: float = 0.0


@dataclass(frozen=True, slots=True)
class AskedAmplitude:
    """Arguments of UAMP, which gives the value of an amplitude at the end of an increment.

    old         value at the end of the last increment
    time        step and total time
    size        of the increment; 0 in the call at the start of a step (`increment` is 0 then)
    cutbacks    of this increment so far
    state       (k,) its state variables at the start of the increment
    sensors     values at the end of the last increment by name
    """

    name: str
    old: float
    step: int
    increment: int
    time: tuple[float, float]
    size: float
    cutbacks: int
    properties: FloatArray
    state: FloatArray
    sensors: dict[str, float]


@dataclass(frozen=True, slots=True)
class GivenAmplitude:
    """Results of UAMP: the value, the state variables, and whether the step ends with this increment."""

    value: float
    state: FloatArray
    concludes: bool


class GivesValues(Protocol):
    """The part of a loaded library that gives values; disp, dload, ...: addresses, None without the routine."""

    disp: int | None
    dload: int | None
    utemp: int | None
    ufield: int | None
    uamp: int | None

    def user_values(self, asked: UserValues) -> FloatArray:
        """Return the values (n,) that the routine makes of those of the deck."""

    def user_amplitude(self, asked: AskedAmplitude) -> GivenAmplitude:
        """Return the results of UAMP."""
