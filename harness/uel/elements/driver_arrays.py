# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributed loads and predefined fields of a block, as arrays for the driver."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.elements.call import Distributed, Predefined
from uel.elements.routine import Routine
from uel.model.arrays import FloatArray, IntArray
from uel.model.mesh import ElementGroup
from uel.usersub.exchange import LoadArrays

NO_LOADS: Final = LoadArrays(np.zeros(1, np.int32), np.zeros((1, 1), np.int32), np.zeros((1, 1, 2)))
"""Arrays of a block without loads: a single row."""


def loads_of(distributed: Distributed, mine: NDArray[np.bool_], row: IntArray, count: int) -> LoadArrays:
    """Return the loads on the elements of a block, one row for each element.

    Parameters
    ----------
    distributed
        All loads.
    mine
        Mask of those on elements of the block.
    row
        Element of each of these, from 0.
    count
        Number of elements of the block.
    """
    counts = np.bincount(row, minlength=count)
    # number of a load among those of its element
    column = np.arange(len(row)) - (np.cumsum(counts) - counts)[row]
    most = max(int(counts.max(initial=0)), 1)
    kinds, values = np.zeros((count, most), np.int32), np.zeros((count, most, 2))
    kinds[row, column] = distributed.kinds[mine]
    values[row, column] = np.stack([distributed.end[mine], distributed.increment[mine]], axis=1)
    return LoadArrays(counts.astype(np.int32), kinds, values)


def fields_of(group: ElementGroup, routine: Routine, predefined: Predefined | None) -> FloatArray:
    """Return PREDEF of the elements, (m, nodes, fields, 2), or (1, nodes, fields, 2) without predefined fields.

    The last field of built-in elements is the initial temperature.
    """
    initial = routine.initial_temperatures
    if predefined is None:
        if initial is None:
            return np.zeros((1, group.nodes.shape[1], 1 if group.definition else 2, 2))
        none = np.zeros((1, len(initial)))
        predefined = Predefined(none, none, initial)
    end, increment = predefined.end, predefined.increment
    if group.definition is None:
        initial = predefined.initial if initial is None else initial
        end, increment = np.vstack([end, initial]), np.vstack([increment, np.zeros_like(increment[0])])
    values = np.stack([end, increment], axis=-1)[:, group.nodes]
    return np.ascontiguousarray(values.transpose(1, 2, 0, 3))
