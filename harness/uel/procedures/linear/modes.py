# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Modes of *FREQUENCY, for the steps in which they respond."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.assembly import Constraints
from uel.model.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Modes:
    """Modes of a *FREQUENCY step in ascending order of frequency, for n unknowns.

    step         number of the step
    constraints  constraints of the step
    values       (k,) eigenvalues, masses (k,) generalized masses
    shapes       (k, n), stiffness (k, n) K phi, inertia (k, n) M phi
    rigid        (3, n) M r, where r is a unit translation of all nodes along 1, 2 or 3
    """

    step: int
    constraints: Constraints
    values: FloatArray
    masses: FloatArray
    shapes: FloatArray
    stiffness: FloatArray
    inertia: FloatArray
    rigid: FloatArray

    @property
    def omega(self) -> FloatArray:
        """Natural frequencies (k,), radians per time; 0 for modes that rounding, or instability, makes negative."""
        return np.sqrt(np.maximum(self.values, 0.0))

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies (k,), cycles per time."""
        return self.omega / (2 * np.pi)

    def chosen(self, numbers: NDArray[np.int64]) -> Modes:
        """Select the modes with these numbers, from 1."""
        at = numbers - 1
        arrays = self.values[at], self.masses[at], self.shapes[at], self.stiffness[at], self.inertia[at]
        return Modes(self.step, self.constraints, *arrays, self.rigid)
