# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Softening along straight lines in the pure modes, for LAW 1, 2, 5 and 6.

In a pure mode the traction is a sum of ramps, strength sum_j a_j (d_j - d)/(d_j - d_0) with the separation d_0 at the
onset and d_j where ramp j ends: fortran/cohesive/multilinear.f90.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from uel.elements.interfaces.bridging import BRIDGING, bridging_shares
from uel.model.arrays import FloatArray

BILINEAR = (0, 1, 2)
TABLE = 6
LAWS = (*BILINEAR, BRIDGING, TABLE)
"""Values of LAW of these laws."""


@dataclass(frozen=True, slots=True)
class PureMode:
    """Softening of a pure mode.

    strength  traction at the onset
    onset     separation there; 0 for an infinite stiffness
    heights   (n,) shares of the ramps in the strength
    ends      (n,) separations at their ends
    """

    strength: float
    onset: float
    heights: FloatArray
    ends: FloatArray

    @property
    def toughness(self) -> float:
        """Area under the curve."""
        return 0.5 * self.strength * float(self.heights @ self.ends)

    def shares_at(self, secants: FloatArray) -> FloatArray:
        """Return the shares of the toughness that are dissipated once the secant has fallen to each of these (n,)."""
        lengths = self.ends - self.onset
        at_ends = self.strength * np.maximum(0.0, 1.0 - lengths[:, None] / lengths) @ self.heights
        # strength T = K d is linear in the separation beyond the onset between the ends that it has not reached
        ahead = at_ends <= secants[:, None] * self.ends
        heights = np.where(ahead, self.heights, 0.0)
        beyond = self.strength * heights.sum(axis=1) - secants * self.onset
        beyond = beyond / (secants + self.strength * (heights / lengths).sum(axis=1))
        gone = np.clip(beyond[:, None] / lengths, 0.0, 1.0)
        return np.asarray(0.5 * self.strength * gone @ (self.heights * self.ends) / self.toughness)


def pure_modes(values: Mapping[str, float]) -> tuple[PureMode, PureMode]:
    """Return the softening in mode I and II of a law by its properties."""
    first, second = bridging_shares(values).T
    return _pure_mode(values, ("ALPHAN", "SIGMAMAX", "GIC"), first), _pure_mode(
        values, ("ALPHAT", "TAUMAX", "GIIC"), second
    )


def alike_in_both_modes(values: Mapping[str, float]) -> bool:
    """Tell whether both modes soften along curves of one shape: not with other shares of the bridging in mode II."""
    return bool(np.allclose(*bridging_shares(values).T))


def _pure_mode(values: Mapping[str, float], names: tuple[str, str, str], bridging: FloatArray) -> PureMode:
    """Return the softening in one mode; bridging: its shares (2,) in strength and fracture energy."""
    stiffness, strength, toughness = (values[name] for name in names)
    onset = strength / stiffness if stiffness else 0.0
    failure = 2.0 * toughness / strength
    heights, ends = np.ones(1), np.array([failure])
    if int(values["LAW"]) == BRIDGING:
        heights, energies = np.array([1.0 - bridging, bridging]).T
        ends = failure * energies / heights
    elif int(values["LAW"]) == TABLE:
        rows = [(values.get(f"SEPARATION{k}", 0.0), values.get(f"TRACTION{k}", 0.0)) for k in range(1, 6)]
        x, t = np.array([(0.0, 1.0), *(row for row in rows if row[0]), (1.0, 0.0)]).T
        slopes = np.append(np.diff(t) / np.diff(x), 0.0)
        heights = np.diff(slopes) * x[1:]
        ends = onset + (toughness / strength - 0.5 * onset) / float(np.trapezoid(t, x)) * x[1:]
    return PureMode(strength, onset, heights, ends)
