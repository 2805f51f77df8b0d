# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Friction of contact points: that of Coulomb with an elastic slip."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray
from uel.model.contact import ContactPair, SlidingPair

SMALLEST: Final = 1e-200
"""Smallest factor of the sticking stiffness, in place of zero where it divides."""


class Friction:
    """Friction of closed points: forces (m, directions), their derivatives, elastic slip, and which points slip."""

    def __init__(
        self,
        pair: ContactPair | SlidingPair,
        force: FloatArray,
        slip: FloatArray,
        closed: NDArray[np.bool_],
        sticks: FloatArray,
        small: float,
    ) -> None:
        """Compute the friction of closed points.

        Parameters
        ----------
        pair
            Its property has the friction coefficient and the largest elastic slip.
        force
            (m,) contact forces, positive where closed.
        slip
            (m, directions) elastic slip at the start of the increment plus the slip in it; zero where open.
        closed
            (m,) mask of the closed points.
        sticks
            (m,) factor of the sticking stiffness: 1, or the damage of the bond of the point.
        small
            Rounding error of the slip. After an increment with slip the elastic slip is at its limit; a point slips
            only if it exceeds the limit by more than this, so that rounding does not decide.
        """
        contact, directions = pair.property, slip.shape[1]
        coefficient = contact.friction
        most = (contact.elastic_slip or contact.slip_tolerance * pair.length) / np.maximum(sticks, SMALLEST)
        size = np.linalg.norm(slip, axis=1)
        self.slips = closed & (coefficient > 0.0) & (size > most + small)
        # slip at the friction limit
        reach = np.where(self.slips, size, most)[:, None]
        along = slip / reach
        limit = coefficient * np.maximum(force, 0.0)[:, None]
        self.force, self.by_force = limit * along, coefficient * closed[:, None] * along
        across = np.eye(directions) - np.where(self.slips, 1.0, 0.0)[:, None, None] * along[:, :, None] * along[:, None]
        self.by_slip = (limit / reach)[:, :, None] * across
        self.elastic = np.where(self.slips[:, None], most[:, None] * along, slip)
