# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The modified Riks method: arc length along the path in the space of displacements and load factor.

Abaqus Theory Guide, "Modified Riks algorithm": displacements are scaled by the largest entry of the first solution of
the step. An increment starts with the arc length along the tangent; Newton's method then iterates in the plane through
that point normal to the tangent. The tangent continues in the direction of the previous increment.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray
from uel.solver.path import Directions, PathIterate, Reaction


class ArcLength:
    """Control by arc length; set `length` before an increment, call `converged` after it.

    Parameters
    ----------
    measured
        (n,) mask of the unknowns that count in the length: those of nodes, not the pressures of elements.
    """

    def __init__(self, measured: NDArray[np.bool_]) -> None:
        self._measured = measured
        self.length = 0.0
        self._scale = 0.0
        self._unit = 0.0
        self._tangent: FloatArray | None = None
        self._last: tuple[FloatArray, float] | None = None

    def change(self, state: PathIterate, directions: Directions, reaction: Reaction) -> float:
        """Return dlam along the tangent in iteration 1, in the plane normal to it afterwards.

        In the first increment of a step the length is the change of the load factor; its length in the scaled space is
        the unit of later lengths.
        """
        del reaction
        v = np.where(self._measured, directions.du_lam, 0.0)
        if state.iteration == 0:
            if not self._scale:
                self._scale = float(np.abs(v).max(initial=0.0)) or 1.0
                self._unit = self._norm(v)
            self._tangent = v
            return self._sign(v) * self.length * self._unit / self._norm(v) - state.lam
        assert self._tangent is not None
        scale = self._scale**2
        return -float(directions.du_r @ self._tangent) / (float(v @ self._tangent) + scale)

    def converged(self, du: FloatArray, lam: float) -> None:
        """Store the direction of a converged increment: du (n,) and the change lam of the load factor."""
        self._last = np.where(self._measured, du, 0.0), lam

    def _sign(self, v: FloatArray) -> float:
        if self._last is None:
            return 1.0
        du, lam = self._last
        return 1.0 if float(du @ v) / self._scale**2 + lam >= 0.0 else -1.0

    def _norm(self, v: FloatArray) -> float:
        return float(np.sqrt(v @ v / self._scale**2 + 1.0))
