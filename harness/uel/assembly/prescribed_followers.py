# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed displacements of nodes that follow a reference node by a rigid arm.

Each is an equation p = x_a + ((R(theta) - 1) r)_a of the six unknowns x of the reference node. It eliminates one of
them: a displacement if one is left, otherwise a rotation. An equation without such an unknown is redundant, and the
prescribed values must satisfy it.
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
"""Coefficient of an unknown, of a rotation over the length of the arms, below which it counts as zero."""

FIRST_CHOICE: Final = 0.1
"""Smallest coefficient of a displacement that is eliminated rather than a rotation."""


@dataclass(frozen=True, slots=True)
class PrescribedFollowers:
    """Equations of prescribed displacements of nodes that follow, m of them.

    arm, axis   (m,) row of the arm, and direction from 0
    unknown     (m,) prescribed unknown
    reference   (m,) row of the reference node
    eliminated  (m,) column that the equation eliminates; -1 if it is redundant
    """

    arm: IntArray
    axis: IntArray
    unknown: IntArray
    reference: IntArray
    eliminated: IntArray

    @property
    def redundant(self) -> NDArray[np.bool_]:
        """Mask (m,) of the redundant equations."""
        mask: NDArray[np.bool_] = self.eliminated < 0
        return mask

    @property
    def solved(self) -> list[tuple[int, IntArray]]:
        """Rows of reference nodes, each with the equations that eliminate its unknowns."""
        own = np.flatnonzero(~self.redundant)
        return [(row, own[self.reference[own] == row]) for row in np.unique(self.reference[own]).tolist()]


def choose_eliminated(
    slopes: FloatArray,
    lengths: FloatArray,
    own: IntArray,
    of: IntArray,
    prescribed: NDArray[np.bool_],
    free: NDArray[np.bool_],
) -> PrescribedFollowers:
    """Choose the unknown that each equation eliminates, by Gaussian elimination in the order of the arms.

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
        (k, 3) mask of the prescribed ones.
    free
        (references, 6) mask of the unknowns of reference nodes that can be eliminated.
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
    return PrescribedFollowers(arm, axis, own[arm, axis], of[arm], eliminated)
