# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Friction of contact points: that of Coulomb with an elastic slip."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray
from uel.model.contact import ContactPair, SlidingPair

NONE: Final = 1e-200
"""Part of a stiffness that is none."""


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
        """Compute the friction of closed points; sticks: (m,) part of the stiffness of sticking points.

        small: rounding of the slip; an increment after one with slip begins with sticking on every processor.
        """
        given, directions = pair.property, slip.shape[1]
        coefficient = given.friction
        most = (given.elastic_slip or given.slip_tolerance * pair.length) / np.maximum(sticks, NONE)
        size = np.linalg.norm(slip, axis=1)
        self.slips = closed & (coefficient > 0.0) & (size > most + small)
        # length of the slip at which the force would reach its limit
        reach = np.where(self.slips, size, most)[:, None]
        along = slip / reach
        limit = coefficient * np.maximum(force, 0.0)[:, None]
        self.force, self.by_force = limit * along, coefficient * closed[:, None] * along
        across = np.eye(directions) - np.where(self.slips, 1.0, 0.0)[:, None, None] * along[:, :, None] * along[:, None]
        self.by_slip = (limit / reach)[:, :, None] * across
        self.elastic = np.where(self.slips[:, None], most[:, None] * along, slip)
