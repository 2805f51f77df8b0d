# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear perturbation procedures: *STATIC with PERTURBATION, *FREQUENCY, *BUCKLE and *STEADY STATE DYNAMICS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from harness.model.procedures import HeadLine, Procedure
from harness.model.records import MODAL

PERTURBATION_TIME = 1e-36
"""Period of a perturbation step, in which no time passes."""


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
        """Its one increment."""
        return "increment", 1


@dataclass(frozen=True, slots=True)
class StaticPerturbation(LinearPerturbation):
    """*STATIC in a step with PERTURBATION."""

    keyword: ClassVar = "STATIC"
    title: ClassVar = "STATIC ANALYSIS"
    energies: ClassVar = ("ALLSE", "ALLWK")

    @property
    def lflag(self) -> int:
        """1."""
        return 1

    def head(self) -> Iterator[HeadLine]:
        """That it is linear."""
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
    loaded: ClassVar = False
    energies: ClassVar = MODAL

    number: int = 0
    lowest: float = -math.inf
    highest: float = math.inf
    by_mass: bool = False

    @property
    def lflag(self) -> int:
        """41."""
        return 41

    @property
    def extent(self) -> tuple[str, float]:
        """Modes."""
        return "mode", self.number or 1

    def head(self) -> Iterator[HeadLine]:
        """Which modes, and how they are scaled."""
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
        """1, which no user element gets: they are refused."""
        return 1

    @property
    def extent(self) -> tuple[str, float]:
        """Modes."""
        return "mode", self.number

    def head(self) -> Iterator[HeadLine]:
        """How many modes, and how they are scaled."""
        yield "NUMBER OF EIGENVALUES", f"{self.number:>10}"
        if math.isfinite(self.highest):
            yield "HIGHEST EIGENVALUE OF INTEREST", self.highest
        if math.isfinite(self.lowest):
            yield "LOWEST EIGENVALUE OF INTEREST", self.lowest
        yield "EIGENVECTORS ARE NORMALIZED TO UNIT MAXIMUM DISPLACEMENT"


@dataclass(frozen=True, slots=True)
class SteadyState(LinearPerturbation):
    """*STEADY STATE DYNAMICS, DIRECT: the response to harmonic loads.

    frequencies  cycles per time, in the order in which they are solved
    undamped     REAL ONLY: damping is left out
    """

    keyword: ClassVar = "STEADY STATE DYNAMICS"
    title: ClassVar = "DIRECT SOLUTION STEADY STATE DYNAMIC ANALYSIS"
    harmonic: ClassVar = True
    energies: ClassVar = ()

    frequencies: tuple[float, ...] = ()
    undamped: bool = False

    @property
    def lflag(self) -> int:
        """95."""
        return 95

    @property
    def extent(self) -> tuple[str, float]:
        """Frequencies."""
        return "frequency", len(self.frequencies)

    def head(self) -> Iterator[HeadLine]:
        """Which frequencies."""
        yield "NUMBER OF FREQUENCIES", f"{len(self.frequencies):>10}"
        yield "LOWEST FREQUENCY (CYCLES/TIME)", min(self.frequencies)
        yield "HIGHEST FREQUENCY (CYCLES/TIME)", max(self.frequencies)
        if self.undamped:
            yield "DAMPING IS LEFT OUT"
