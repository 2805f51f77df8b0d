# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Data of modal steps: the modes of *FREQUENCY that respond, their damping, and the motion of the supports."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from uel.errors import Source
from uel.model.amplitude import Amplitude
from uel.model.arrays import FloatArray


class DampingKind(StrEnum):
    """Kind of *MODAL DAMPING."""

    CRITICAL = "FRACTION OF CRITICAL DAMPING"
    RAYLEIGH = "RAYLEIGH"
    STRUCTURAL = "STRUCTURAL"


@dataclass(frozen=True, slots=True)
class ModalDamping:
    """One *MODAL DAMPING.

    ranges        (k, 2) first and last mode, from 1, or (k, 1) frequencies, cycles per time, ascending
    factors       (k, 1) fraction of critical damping or structural damping, or (k, 2) alpha and beta of RAYLEIGH
    by_frequency  between the frequencies factors are linear, outside those of the closest one
    """

    kind: DampingKind
    ranges: FloatArray
    factors: FloatArray
    source: Source
    by_frequency: bool = False

    def of(self, modes: NDArray[np.int64], frequencies: FloatArray) -> FloatArray:
        """Return factors (modes, 1 or 2) of modes, from 1; modes outside all ranges are not damped."""
        if self.by_frequency:
            at = self.ranges[:, 0]
            return np.column_stack([np.interp(frequencies, at, factors) for factors in self.factors.T])
        fractions = np.zeros((len(modes), self.factors.shape[1]))
        for (first, last), factors in zip(self.ranges.tolist(), self.factors, strict=True):
            fractions[(modes >= first) & (modes <= last)] = factors
        return fractions


class Motion(StrEnum):
    """TYPE= of *BASE MOTION."""

    DISPLACEMENT = "DISPLACEMENT"
    VELOCITY = "VELOCITY"
    ACCELERATION = "ACCELERATION"


@dataclass(frozen=True, slots=True)
class BaseMotion:
    """One *BASE MOTION: translation of all supports along a global direction, `scale` times the amplitude.

    dof  1 to 3
    """

    dof: int
    motion: Motion
    amplitude: Amplitude
    scale: float
    source: Source
    imaginary: bool = False

    def value(self, step_time: float, total_time: float) -> float:
        """Return displacement, velocity or acceleration at a time or a frequency."""
        return self.scale * self.amplitude.value(step_time, total_time)


@dataclass(frozen=True, slots=True)
class Superposition:
    """Modes that respond, and the damping and base motions that act on them.

    selected      (k, 2) ranges of *SELECT EIGENMODES: first and last mode, from 1, or lowest and highest frequency,
                  cycles per time; None: all modes
    by_frequency  which of the two the ranges have
    """

    selected: FloatArray | None = None
    by_frequency: bool = False
    damping: tuple[ModalDamping, ...] = ()
    base: tuple[BaseMotion, ...] = ()

    def modes(self, frequencies: FloatArray) -> NDArray[np.int64]:
        """Return the numbers, from 1, of the modes that respond, by the frequencies of all."""
        numbers = np.arange(1, len(frequencies) + 1)
        if self.selected is None:
            return numbers
        measured = frequencies if self.by_frequency else numbers
        lowest, highest = self.selected.T
        inside = (measured[:, None] >= lowest) & (measured[:, None] <= highest)
        chosen: NDArray[np.int64] = numbers[inside.any(axis=1)]
        return chosen

    def viscous(self, modes: NDArray[np.int64], omega: FloatArray) -> FloatArray:
        """Return (modes,) 2 xi omega: viscous damping over generalized mass; omega (modes,): radians per time."""
        damped = np.zeros(len(modes))
        for damping in self.damping:
            factors = damping.of(modes, omega / (2 * np.pi))
            if damping.kind is DampingKind.CRITICAL:
                damped += 2 * factors[:, 0] * omega
            elif damping.kind is DampingKind.RAYLEIGH:
                damped += factors[:, 0] + factors[:, 1] * omega**2
        return damped

    def structural(self, modes: NDArray[np.int64], omega: FloatArray) -> FloatArray:
        """Return (modes,) structural damping s: the stiffness is complex, 1 + i s times the real one."""
        damped = np.zeros(len(modes))
        for damping in self.damping:
            if damping.kind is DampingKind.STRUCTURAL:
                damped += damping.of(modes, omega / (2 * np.pi))[:, 0]
        return damped


@dataclass(frozen=True, slots=True)
class FrequencyRange:
    """A data line of *STEADY STATE DYNAMICS.

    lowest, highest  cycles per time; highest 0: the lowest alone
    number           of points of each interval, its ends among them
    bias             points are closer to the ends of an interval the larger it is
    factor           of all points but the lowest and the highest
    logarithmic      the scale that points divide
    """

    lowest: float
    highest: float = 0.0
    number: int = 20
    bias: float = 1.0
    factor: float = 1.0
    logarithmic: bool = True

    def points(self, natural: FloatArray) -> list[float]:
        """Return the frequencies, ascending; natural frequencies (k,) within the range divide it into intervals."""
        if not self.highest:
            return [self.lowest]
        inside = np.unique(natural[(natural > self.lowest) & (natural < self.highest)])
        limits = [self.lowest, *inside.tolist(), self.highest]
        frequencies = [self.lowest]
        for first, last in pairwise(limits):
            frequencies += [*self._between(first, last), last]
        return [frequencies[0], *(self.factor * point for point in frequencies[1:-1]), frequencies[-1]]

    def _between(self, first: float, last: float) -> list[float]:
        """Return the points inside an interval."""
        # Abaqus Analysis User's Guide, "Direct-solution steady-state dynamic analysis", the bias parameter
        share = np.linspace(-1.0, 1.0, self.number)[1:-1]
        share = 0.5 + 0.5 * np.sign(share) * np.abs(share) ** (1.0 / self.bias)
        inside = first * (last / first) ** share if self.logarithmic else first + (last - first) * share
        return [float(point) for point in inside]
