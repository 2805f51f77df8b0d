# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Exchange between Python and the compiled host."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.usersub.faults import Fault

Int32Array = NDArray[np.int32]

_Integers = tuple[Int32Array, Int32Array, Int32Array, Int32Array]
_Reals = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
ReversedArrays = tuple[*_Integers, *_Reals]


class Called(NamedTuple):
    """Routine that the driver calls for a block.

    address   of UEL or UELMAT
    material  number of the material in the host; 0 for none, then it is UEL
    tensor    stress components of the material, 0 without one
    """

    address: int
    material: int
    jtype: int
    tensor: int


class Moment(NamedTuple):
    """Arguments of a pass that all blocks share, under Abaqus' names; iteration is for messages."""

    kstep: int
    kinc: int
    iteration: int
    time: tuple[float, float]
    dtime: float
    period: float
    params: tuple[float, float, float]
    lflags: tuple[int, ...]


class Outcome(NamedTuple):
    """Outcome of a pass over a block; a tuple, as it takes half the time of a frozen data class.

    position  element of the fault (from 0; -1 unknown)
    array, item  array of the fault and entry, from 1 (beyond its ends for a write outside); or
    routine, item  user routine of points that has ended the call, and the point, from 1; '' for another one
    alone     elements that one thread has called again, because several could not go on
    flux      (3, fields) of the elements: sum of |RHS|, number of those above the floor, the largest one
    """

    fault: Fault
    position: int
    array: str
    routine: str
    item: int
    flux: FloatArray
    pnewdt: float
    energy: FloatArray
    alone: int


@dataclass(frozen=True, slots=True)
class UnknownFields:
    """Fields to which the forces of an element belong.

    of      (ndofel,) field of each unknown, from 1; 0: none
    number  of all fields
    """

    of: Int32Array
    number: int


@dataclass(frozen=True)
class BlockArrays:
    """Arrays of a block that the driver reads and writes, C order, element first (the driver's shapes reversed)."""

    labels: Int32Array
    jprops: Int32Array
    equations: Int32Array
    map: Int32Array
    props: FloatArray
    coords: FloatArray
    svars: FloatArray
    svars_trial: FloatArray
    energy: FloatArray
    energy_trial: FloatArray
    history: FloatArray
    history_trial: FloatArray

    @cached_property
    def reversed(self) -> ReversedArrays:
        """Arrays with the driver's shapes, cached for the passes."""
        integers = self.labels, self.jprops, self.equations.T, self.map.T
        start = self.svars.T, self.energy.T, self.history.T
        end = self.svars_trial.T, self.energy_trial.T, self.history_trial.T
        return *integers, self.props, self.coords.T, *start, *end

    def of(self, rows: IntArray) -> BlockArrays:
        """Copy the arrays of some of the elements."""
        shared = ("jprops", "props")
        selected = {field.name: getattr(self, field.name)[rows] for field in fields(self) if field.name not in shared}
        return replace(self, **selected)


@dataclass(frozen=True, slots=True)
class LoadArrays:
    """Distributed loads of the elements of a block, C order; m elements, or 1 if all are equal.

    counts  (m,) number of loads on each element
    kinds   (m, most) JDLTYP
    values  (m, most, 2) magnitude at the end of the increment, and its change
    """

    counts: Int32Array
    kinds: Int32Array
    values: FloatArray


@dataclass(frozen=True, slots=True)
class RawMessage:
    """Message of STDB_ABQERR; level is its LOP."""

    level: int
    element: int
    step: int
    increment: int
    text: str
