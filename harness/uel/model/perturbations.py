# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear perturbation procedures: *STATIC with PERTURBATION, *FREQUENCY, *BUCKLE, *STEADY STATE DYNAMICS and *MODAL
DYNAMIC.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from uel.model.arrays import FloatArray
from uel.model.modal import DampingKind, FrequencyRange, Motion
from uel.model.procedures import HeadLine, Procedure
from uel.model.records import MODAL

PERTURBATION_TIME = 1e-36
"""Period of a perturbation step, in which no time passes."""

ROUNDING = 1e-6
"""Rounding of an increment."""


@dataclass(frozen=True, slots=True)
class LinearPerturbation(Procedure):
    """A linear step about the state at the end of the last general one, in which no time passes."""

    linear: ClassVar = True

    initial: float = PERTURBATION_TIME
    period: float = PERTURBATION_TIME
    minimum: float = PERTURBATION_TIME
    maximum: float = PERTURBATION_TIME
    direct: bool = True

    @property
    def extent(self) -> tuple[str, float]:
        """Unit and total of the progress: one increment."""
        return "increment", 1


@dataclass(frozen=True, slots=True)
class StaticPerturbation(LinearPerturbation):
    """*STATIC in a step with PERTURBATION."""

    keyword: ClassVar = "STATIC"
    title: ClassVar = "STATIC ANALYSIS"
    energies: ClassVar = ("ALLSE", "ALLWK")

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 1."""
        return 1

    def head(self) -> Iterator[HeadLine]:
        """Yield the line that the step is linear."""
        yield "A LINEAR PERTURBATION ABOUT THE BASE STATE"


@dataclass(frozen=True, slots=True)
class Frequency(LinearPerturbation):
    """*FREQUENCY.

    number           of eigenvalues; 0: all up to `highest`
    lowest, highest  frequencies of interest, cycles per time
    by_mass          shapes have unit generalized mass; the largest displacement is one otherwise
    """

    keyword: ClassVar = "FREQUENCY"
    title: ClassVar = "CALCULATION OF EIGENVALUES FOR NATURAL FREQUENCIES"
    finds_modes: ClassVar = True
    loaded: ClassVar = False
    energies: ClassVar = MODAL

    number: int = 0
    lowest: float = -math.inf
    highest: float = math.inf
    by_mass: bool = False

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 41."""
        return 41

    @property
    def extent(self) -> tuple[str, float]:
        """Modes."""
        return "mode", self.number or 1

    def head(self) -> Iterator[HeadLine]:
        """Yield the choice of the modes, and their scaling."""
        yield "NUMBER OF EIGENVALUES", f"{self.number or 'ALL':>10}"
        if math.isfinite(self.highest):
            yield "HIGHEST FREQUENCY OF INTEREST (CYCLES/TIME)", self.highest
        if math.isfinite(self.lowest):
            yield "LOWEST FREQUENCY OF INTEREST (CYCLES/TIME)", self.lowest
        scale = "UNIT GENERALIZED MASS" if self.by_mass else "UNIT MAXIMUM DISPLACEMENT"
        yield f"EIGENVECTORS ARE NORMALIZED TO {scale}"


@dataclass(frozen=True, slots=True)
class Buckle(LinearPerturbation):
    """*BUCKLE.

    number           of eigenvalues
    lowest, highest  eigenvalues of interest, factors of the loads of the step
    """

    keyword: ClassVar = "BUCKLE"
    title: ClassVar = "BUCKLING ANALYSIS - EIGENVALUE BUCKLING PREDICTION"
    buckles: ClassVar = True
    energies: ClassVar = ("EIGVAL",)

    number: int = 1
    lowest: float = -math.inf
    highest: float = math.inf

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 1, which no user element gets: they are refused."""
        return 1

    @property
    def extent(self) -> tuple[str, float]:
        """Modes."""
        return "mode", self.number

    def head(self) -> Iterator[HeadLine]:
        """Yield the number of modes, and their scaling."""
        yield "NUMBER OF EIGENVALUES", f"{self.number:>10}"
        if math.isfinite(self.highest):
            yield "HIGHEST EIGENVALUE OF INTEREST", self.highest
        if math.isfinite(self.lowest):
            yield "LOWEST EIGENVALUE OF INTEREST", self.lowest
        yield "EIGENVECTORS ARE NORMALIZED TO UNIT MAXIMUM DISPLACEMENT"


@dataclass(frozen=True, slots=True)
class SteadyState(LinearPerturbation):
    """*STEADY STATE DYNAMICS, DIRECT: the response to harmonic loads.

    ranges    of frequencies, in the order in which they are solved
    natural   INTERVAL=EIGENFREQUENCY: natural frequencies of *FREQUENCY divide the ranges
    undamped  REAL ONLY: damping is left out
    """

    keyword: ClassVar = "STEADY STATE DYNAMICS"
    title: ClassVar = "DIRECT SOLUTION STEADY STATE DYNAMIC ANALYSIS"
    harmonic: ClassVar = True
    energies: ClassVar = ("ALLSE", "ALLKE")

    ranges: tuple[FrequencyRange, ...] = ()
    natural: bool = False
    undamped: bool = False

    @property
    def needs_modes(self) -> bool:
        """Whether modes are needed: also if natural frequencies divide the ranges."""
        return self.modal or self.natural

    def frequencies(self, natural: FloatArray) -> tuple[float, ...]:
        """Return the frequencies in cycles per time; natural (k,): the natural frequencies."""
        divides = natural if self.natural else np.zeros(0)
        return tuple(frequency for one in self.ranges for frequency in one.points(divides))

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 95."""
        return 95

    @property
    def extent(self) -> tuple[str, float]:
        """Frequencies: of those that natural ones add, nothing is known before they are."""
        return "frequency", len(self.frequencies(np.zeros(0)))

    def head(self) -> Iterator[HeadLine]:
        """Yield the frequencies."""
        frequencies = self.frequencies(np.zeros(0))
        if self.natural:
            yield "THE FREQUENCY RANGES ARE DIVIDED BY THE EIGENFREQUENCIES"
        else:
            yield "NUMBER OF FREQUENCIES", f"{len(frequencies):>10}"
        yield "LOWEST FREQUENCY (CYCLES/TIME)", min(frequencies)
        yield "HIGHEST FREQUENCY (CYCLES/TIME)", max(frequencies)
        if self.undamped:
            yield "DAMPING IS LEFT OUT"


@dataclass(frozen=True, slots=True)
class SubspaceSteadyState(SteadyState):
    """*STEADY STATE DYNAMICS, SUBSPACE PROJECTION: the matrices of the model act on modes of *FREQUENCY alone."""

    title: ClassVar = "SUBSPACE PROJECTION STEADY STATE DYNAMIC ANALYSIS"
    modal: ClassVar = True
    base_motions: ClassVar = tuple(Motion)


@dataclass(frozen=True, slots=True)
class ModalSteadyState(SteadyState):
    """*STEADY STATE DYNAMICS by modes of *FREQUENCY, each with a damping of its own."""

    title: ClassVar = "MODAL STEADY STATE DYNAMIC ANALYSIS"
    modal: ClassVar = True
    damping: ClassVar = tuple(DampingKind)
    base_motions: ClassVar = tuple(Motion)

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 92, which no element gets: only the modes respond."""
        return 92


@dataclass(frozen=True, slots=True)
class ModalDynamic(LinearPerturbation):
    """*MODAL DYNAMIC: the response over time, by modes of *FREQUENCY."""

    keyword: ClassVar = "MODAL DYNAMIC"
    title: ClassVar = "MODAL DYNAMIC ANALYSIS"
    modal: ClassVar = True
    damping: ClassVar = (DampingKind.CRITICAL, DampingKind.RAYLEIGH)
    base_motions: ClassVar = (Motion.ACCELERATION,)
    energies: ClassVar = ("ALLSE", "ALLKE")

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 91, which no element gets: only the modes respond."""
        return 91

    @property
    def default_amplitude(self) -> str:
        """Loads are there at once."""
        return "STEP"

    @property
    def extent(self) -> tuple[str, float]:
        """Increments."""
        return "increment", len(self.times)

    @property
    def times(self) -> list[float]:
        """Ends of the increments; the last one is shorter where the increment does not divide the period."""
        count = max(1, math.ceil(self.period / self.initial - ROUNDING))
        return [self.initial * k for k in range(1, count)] + [self.period]

    def head(self) -> Iterator[HeadLine]:
        """Yield the increments."""
        yield "FIXED TIME INCREMENTS"
        yield from (("TIME INCREMENT IS", self.initial), ("TIME PERIOD IS", self.period))
