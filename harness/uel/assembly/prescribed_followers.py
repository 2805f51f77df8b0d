# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed displacements of nodes that follow a reference node by a rigid arm.

Each is an equation p = x_a + ((R(theta) - 1) r)_a of the six unknowns x of the reference node. It eliminates one of
them: a displacement where it has one that is left, else a rotation. An equation without such an unknown is redundant:
it must hold by itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray

COLUMNS: Final = 6
"""Unknowns of a reference node: three displacements, three rotations."""

SMALLEST: Final = 1e-6
"""Coefficient of an unknown, rotations times the length of the arms, below which an equation does not determine it."""

FIRST_CHOICE: Final = 0.1
"""Coefficient of a displacement from which on it is eliminated rather than a rotation."""


@dataclass(frozen=True, slots=True)
class HeldFollowers:
    """Equations of prescribed displacements of nodes that follow, m of them.

    arm, axis   (m,) row of its arm, and direction from 0
    unknown     (m,) the prescribed unknown
    reference   (m,) row of the reference node
    eliminated  (m,) column that the equation eliminates; -1: it is redundant
    """

    arm: IntArray
    axis: IntArray
    unknown: IntArray
    reference: IntArray
    eliminated: IntArray

    @property
    def redundant(self) -> NDArray[np.bool_]:
        """Mask (m,) of the redundant equations."""
        found: NDArray[np.bool_] = self.eliminated < 0
        return found

    @property
    def solved(self) -> list[tuple[int, IntArray]]:
        """Reference nodes (rows) with the equations that eliminate one of their unknowns."""
        own = np.flatnonzero(~self.redundant)
        return [(row, own[self.reference[own] == row]) for row in np.unique(self.reference[own]).tolist()]


def choose(
    slopes: FloatArray,
    lengths: FloatArray,
    own: IntArray,
    of: IntArray,
    prescribed: NDArray[np.bool_],
    free: NDArray[np.bool_],
) -> HeldFollowers:
    """Find the unknown that each equation eliminates, by Gaussian elimination in the order of the arms.

    Parameters
    ----------
    slopes
        (k, 3, 6) derivatives of the displacements of the nodes by the unknowns of their reference nodes.
    lengths
        (k,) of the arms, the longest one of each reference node.
    own
        (k, 3) unknowns of the nodes, -1 where there is none.
    of
        (k,) row of the reference node.
    prescribed
        (k, 3) which of them are prescribed.
    free
        (references, 6) whether an unknown of a reference node can be eliminated.
    """
    arm, axis = np.nonzero(prescribed)
    eliminated = np.full(len(arm), -1)
    rows: dict[int, list[tuple[int, FloatArray]]] = {}
    for number, (k, a) in enumerate(zip(arm.tolist(), axis.tolist(), strict=True)):
        earlier = rows.setdefault(int(of[k]), [])
        row = np.where(free[of[k]], slopes[k, a], 0.0)
        row[3:] /= lengths[k]
        for column, other in earlier:
            row = row - row[column] * other
        column = int(np.abs(row[:3]).argmax())
        if abs(row[column]) < FIRST_CHOICE:
            column = int(np.abs(row).argmax())
        if abs(row[column]) > SMALLEST:
            eliminated[number] = column
            earlier.append((column, row / row[column]))
    return HeldFollowers(arm, axis, own[arm, axis], of[arm], eliminated)
