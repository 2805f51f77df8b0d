# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Procedures of a step: what *STATIC, *DYNAMIC, *FREQUENCY, *HEAT TRANSFER and so on say."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from enum import StrEnum


@dataclass(frozen=True, slots=True)
class Riks:
    """*STATIC, RIKS: where the step ends.

    largest_factor     load proportionality factor, None without a limit
    node, dof, value   displacement of a node (index; -1: none) that ends the step once it is crossed
    """

    largest_factor: float | None = None
    node: int = -1
    dof: int = 0
    value: float = 0.0


@dataclass(frozen=True, slots=True)
class Stabilize:
    """STABILIZE: viscous forces, factor times the mass of built-in elements of unit density times velocity.

    fraction  of the strain energy that the first increment would dissipate; sets the factor unless it is given
    factor    0: not given
    limit     ALLSDTOL: largest ratio of dissipated to strain energy before the factor is reduced; 0: no limit
    """

    fraction: float = 2e-4
    factor: float = 0.0
    limit: float = 0.05


@dataclass(frozen=True, slots=True)
class Procedure(ABC):
    """Initial increment, period, smallest and largest increment of a step; direct = fixed increments.

    With `riks` these are arc lengths, the period is their scale alone, and the step ends where `riks` says.
    """

    initial: float = 1.0
    period: float = 1.0
    minimum: float = 1e-5
    maximum: float = 1.0
    direct: bool = False
    riks: Riks | None = None
    stabilize: Stabilize | None = field(default=None, kw_only=True)

    @property
    @abstractmethod
    def lflag(self) -> int:
        """LFLAGS(1), which tells user elements the procedure."""

    @property
    def growth(self) -> str:
        """Name of the control D_M that bounds the growth from one increment to the next."""
        return "d_m"

    @property
    def default_amplitude(self) -> str:
        """How loads vary where neither they nor *STEP name an amplitude: RAMP or STEP."""
        return "RAMP"


@dataclass(frozen=True, slots=True)
class Static(Procedure):
    """*STATIC."""

    @property
    def lflag(self) -> int:
        """1 automatic, 2 fixed increments."""
        return 2 if self.direct else 1


@dataclass(frozen=True, slots=True)
class Visco(Procedure):
    """*VISCO: a static step on a real time scale."""

    @property
    def lflag(self) -> int:
        """21."""
        return 21

    @property
    def default_amplitude(self) -> str:
        """Loads are there at once."""
        return "STEP"


class Integrator(StrEnum):
    """TIME INTEGRATOR= of *DYNAMIC."""

    HHT = "HHT"
    BACKWARD_EULER = "BWE"


@dataclass(frozen=True, slots=True)
class Dynamic(Procedure):
    """*DYNAMIC by an implicit operator.

    alpha, beta, gamma    of Hilber, Hughes and Taylor; PARAMS of the calls
    initial_acceleration  computed at the start of the step from equilibrium; zero otherwise
    half_increment        tolerance of the half-increment residual as a multiple of the average force; inf: no check
    half_force            the same as a force (HAFTOL); 0: not given
    """

    alpha: float = -0.05
    beta: float = 0.275625
    gamma: float = 0.55
    integrator: Integrator = Integrator.HHT
    initial_acceleration: bool = True
    half_increment: float = math.inf
    half_force: float = 0.0

    @property
    def growth(self) -> str:
        """That of dynamic steps."""
        return "d_m_dyn"

    @property
    def lflag(self) -> int:
        """11 automatic, 12 fixed increments."""
        return 12 if self.direct else 11

    @property
    def default_amplitude(self) -> str:
        """Loads are there at once, but ramp where the step looks for a static state."""
        return "RAMP" if self.integrator is Integrator.BACKWARD_EULER else "STEP"


PERTURBATION_TIME = 1e-36
"""Period of a perturbation step, in which no time passes."""


@dataclass(frozen=True, slots=True)
class LinearPerturbation(Procedure):
    """A linear step about the state at the end of the last general one, in which no time passes."""

    initial: float = PERTURBATION_TIME
    period: float = PERTURBATION_TIME
    minimum: float = PERTURBATION_TIME
    maximum: float = PERTURBATION_TIME
    direct: bool = True


@dataclass(frozen=True, slots=True)
class StaticPerturbation(LinearPerturbation):
    """*STATIC in a step with PERTURBATION."""

    @property
    def lflag(self) -> int:
        """1."""
        return 1


@dataclass(frozen=True, slots=True)
class Frequency(LinearPerturbation):
    """*FREQUENCY.

    number           of eigenvalues; 0: all up to `highest`
    lowest, highest  frequencies of interest, cycles per time
    by_mass          shapes have unit generalized mass; the largest displacement is one otherwise
    """

    number: int = 0
    lowest: float = -math.inf
    highest: float = math.inf
    by_mass: bool = False

    @property
    def lflag(self) -> int:
        """41."""
        return 41


@dataclass(frozen=True, slots=True)
class SteadyState(LinearPerturbation):
    """*STEADY STATE DYNAMICS, DIRECT: the response to harmonic loads.

    frequencies  cycles per time, in the order in which they are run through
    undamped     REAL ONLY: damping is left out
    """

    frequencies: tuple[float, ...] = ()
    undamped: bool = False

    @property
    def lflag(self) -> int:
        """95."""
        return 95


@dataclass(frozen=True, slots=True)
class HeatTransfer(Procedure):
    """*HEAT TRANSFER, and *COUPLED TEMPERATURE-DISPLACEMENT where displacements are `coupled`.

    steady          STEADY STATE: time is a scale for loads
    largest_change  DELTMX, largest change of temperature in an increment; inf: not limited
    end_change      END=SS: the step ends where no temperature changes faster than this; 0: with the period
    """

    coupled: bool = False
    steady: bool = False
    largest_change: float = math.inf
    end_change: float = 0.0

    @property
    def growth(self) -> str:
        """That of diffusion."""
        return "d_m_diff"

    @property
    def lflag(self) -> int:
        """31 or 71 steady, 32 or 72 transient, 33 or 73 with fixed increments."""
        kind = 1 if self.steady else 3 if self.direct else 2
        return (70 if self.coupled else 30) + kind

    @property
    def default_amplitude(self) -> str:
        """Loads are there at once, but ramp to a steady state."""
        return "RAMP" if self.steady else "STEP"
