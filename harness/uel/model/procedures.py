# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Procedures of a step: *STATIC, *VISCO, *GEOSTATIC, *DYNAMIC, *HEAT TRANSFER, *MASS DIFFUSION; `perturbations` has the
linear ones.

A procedure answers all that others ask of it, so that nobody asks which one it is: whether there is inertia, which
fields have equations, whether it is linear or harmonic, LFLAGS(1), how its progress counts, and its head in .msg and
.dat. `uel.procedures.registry` has what runs it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from typing import ClassVar

from uel.model.modal import DampingKind, Motion, Superposition

HeadLine = str | tuple[str, float | str]
"""A line of the head of a step in .msg and .dat: words, or words and a value."""


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

    fraction  of the strain energy that the first increment would dissipate; sets the factor if that is 0
    factor    0: set by `fraction`
    limit     ALLSDTOL: largest ratio of dissipated to strain energy before the factor is reduced; 0: no limit
    """

    fraction: float = 2e-4
    factor: float = 0.0
    limit: float = 0.05


@dataclass(frozen=True, slots=True)
class Procedure(ABC):
    """Initial increment, period, smallest and largest increment of a step; direct = fixed increments.

    With `riks` these are arc lengths, the period is only their scale, and the step ends where `riks` says.

    keyword       keyword of the procedure
    title         its name in .msg and .dat
    inertia       V and A go with U: elements need a mass, and loads work against it
    displacements, temperatures, concentrations  which of them have equations of their own
    linear        a linear perturbation of the state at the end of the last general step, without passage of time
    harmonic      loads and results are complex amplitudes, over frequency
    modal         modes of an earlier *FREQUENCY respond, and nothing is prescribed but the motion of their supports
    finds_modes   later steps may take its modes
    damping, base_motions  kinds of *MODAL DAMPING and *BASE MOTION that it takes
    loaded        loads and prescribed values of the step act
    buckles       the initial stress matrix of the elements and the load stiffness are asked for
    unsymmetric   matrices are stored and solved as unsymmetric ones, UNSYMM or not
    growth        name of the control D_M that bounds the growth from one increment to the next
    energies      names of the energies of the whole model in the history output; None: those that the step requests
    """

    keyword: ClassVar[str]
    title: ClassVar[str]
    inertia: ClassVar[bool] = False
    displacements: ClassVar[bool] = True
    temperatures: ClassVar[bool] = False
    concentrations: ClassVar[bool] = False
    linear: ClassVar[bool] = False
    harmonic: ClassVar[bool] = False
    modal: ClassVar[bool] = False
    finds_modes: ClassVar[bool] = False
    damping: ClassVar[tuple[DampingKind, ...]] = ()
    base_motions: ClassVar[tuple[Motion, ...]] = ()
    loaded: ClassVar[bool] = True
    buckles: ClassVar[bool] = False
    unsymmetric: ClassVar[bool] = False
    growth: ClassVar[str] = "d_m"
    energies: ClassVar[tuple[str, ...] | None] = None

    initial: float = 1.0
    period: float = 1.0
    minimum: float = 1e-5
    maximum: float = 1.0
    direct: bool = False
    riks: Riks | None = None
    stabilize: Stabilize | None = field(default=None, kw_only=True)
    superposition: Superposition = field(default_factory=Superposition, kw_only=True)

    @property
    @abstractmethod
    def lflag(self) -> int:
        """LFLAGS(1), which tells user elements the procedure."""

    @property
    def needs_modes(self) -> bool:
        """Whether a step *FREQUENCY must precede it."""
        return self.modal

    @property
    def params(self) -> tuple[float, float, float]:
        """PARAMS of the calls."""
        return 0.0, 0.0, 0.0

    @property
    def default_amplitude(self) -> str:
        """Amplitude of loads if neither they nor *STEP name one: RAMP or STEP."""
        return "RAMP"

    @property
    def full_title(self) -> str:
        """Title with the further properties of the step."""
        return self.title

    @property
    def stores_heat(self) -> bool:
        """Whether elements store heat."""
        return False

    @property
    def extent(self) -> tuple[str, float]:
        """Unit and total of the step's progress, for the progress display."""
        return "time", self.period

    def head(self) -> Iterator[HeadLine]:
        """Yield the lines of .msg and .dat about the procedure at the start of the step."""
        if self.riks is not None:
            yield from self._arc_lengths(self.riks)
        elif self.direct:
            yield from ("FIXED TIME INCREMENTS", ("TIME INCREMENT IS", self.initial), ("TIME PERIOD IS", self.period))
        else:
            yield "AUTOMATIC TIME CONTROL WITH -"
            yield "A SUGGESTED INITIAL TIME INCREMENT OF", self.initial
            yield "AND A TOTAL TIME PERIOD OF", self.period
            yield "THE MINIMUM TIME INCREMENT ALLOWED IS", self.minimum
            yield "THE MAXIMUM TIME INCREMENT ALLOWED IS", self.maximum

    def _arc_lengths(self, riks: Riks) -> Iterator[HeadLine]:
        yield f"{'FIXED' if self.direct else 'AUTOMATIC'} ARC LENGTH CONTROL (RIKS METHOD) WITH -"
        yield "AN INITIAL ARC LENGTH INCREMENT OF", self.initial
        yield "A TOTAL ARC LENGTH SCALE FACTOR OF", self.period
        if not self.direct:
            yield "THE MINIMUM ARC LENGTH INCREMENT ALLOWED IS", self.minimum
        if math.isfinite(self.maximum) and not self.direct:
            yield "THE MAXIMUM ARC LENGTH INCREMENT ALLOWED IS", self.maximum
        if riks.largest_factor is not None:
            yield "THE MAXIMUM LOAD PROPORTIONALITY FACTOR IS", riks.largest_factor


@dataclass(frozen=True, slots=True)
class Static(Procedure):
    """*STATIC."""

    keyword: ClassVar = "STATIC"
    title: ClassVar = "STATIC ANALYSIS"

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 1 automatic, 2 fixed increments."""
        return 2 if self.direct else 1


@dataclass(frozen=True, slots=True)
class Visco(Procedure):
    """*VISCO: a static step on a real time scale.

    tolerance  CETOL: largest change of a viscous strain rate in an increment times its length; inf without a limit
    """

    keyword: ClassVar = "VISCO"
    title: ClassVar = "VISCO ANALYSIS"
    growth: ClassVar = "d_m_diff"

    tolerance: float = field(default=math.inf, kw_only=True)

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 21."""
        return 21

    @property
    def default_amplitude(self) -> str:
        """Loads are there at once."""
        return "STEP"


@dataclass(frozen=True, slots=True)
class Geostatic(Procedure):
    """*GEOSTATIC: equilibrium of initial stresses with the loads, in one increment."""

    keyword: ClassVar = "GEOSTATIC"
    title: ClassVar = "GEOSTATIC STRESS ANALYSIS"

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 61."""
        return 61


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
    half_force            the same as a force (HAFTOL); 0: not used
    """

    keyword: ClassVar = "DYNAMIC"
    title: ClassVar = "DYNAMIC ANALYSIS"
    inertia: ClassVar = True
    growth: ClassVar = "d_m_dyn"

    alpha: float = -0.05
    beta: float = 0.275625
    gamma: float = 0.55
    integrator: Integrator = Integrator.HHT
    initial_acceleration: bool = True
    half_increment: float = math.inf
    half_force: float = 0.0

    @property
    def params(self) -> tuple[float, float, float]:
        """Parameters of the integrator: alpha, beta, gamma."""
        return self.alpha, self.beta, self.gamma

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 11 automatic, 12 fixed increments."""
        return 12 if self.direct else 11

    @property
    def default_amplitude(self) -> str:
        """Loads act at once, but ramp if the step looks for a static state."""
        return "RAMP" if self.integrator is Integrator.BACKWARD_EULER else "STEP"

    def head(self) -> Iterator[HeadLine]:
        """Yield increments, integrator, and its tolerances."""
        # without arguments super() does not find the class that slots=True makes
        yield from Procedure.head(self)
        if self.integrator is Integrator.HHT:
            yield "NUMERICAL DAMPING CONTROL PARAMETER (ALPHA) IS", self.alpha
            yield from (("BETA", self.beta), ("GAMMA", self.gamma))
        if self.half_force:
            yield "HALF-INCREMENT RESIDUAL TOLERANCE IS", self.half_force
        elif math.isfinite(self.half_increment):
            yield "HALF-INCREMENT SCALE FACTOR IS", self.half_increment


@dataclass(frozen=True, slots=True)
class Diffusive(Procedure):
    """*HEAT TRANSFER, *MASS DIFFUSION and the like: temperatures or concentrations, with transient and steady steps.

    unknown         whose changes are limited: a field of FIELD_NAMES
    limit           the option that limits them
    steady          STEADY STATE: time is a scale for loads
    largest_change  largest change of a temperature or concentration in an increment; inf: not limited
    end_change      END=SS: the step ends where none changes faster than this; 0: with the period
    """

    growth: ClassVar = "d_m_diff"
    unknown: ClassVar[str]
    limit: ClassVar[str]

    steady: bool = False
    largest_change: float = math.inf
    end_change: float = 0.0

    @property
    def _kind(self) -> int:
        """Steady, transient and with fixed increments 1, 2 and 3: the last digit of LFLAGS(1)."""
        return 1 if self.steady else 3 if self.direct else 2

    @property
    def default_amplitude(self) -> str:
        """Loads act at once, but ramp in a steady-state step."""
        return "RAMP" if self.steady else "STEP"

    @property
    def full_title(self) -> str:
        """Steady state or transient."""
        return f"{'STEADY STATE' if self.steady else 'TRANSIENT'} {self.title}"

    @property
    def complaint(self) -> str:
        """Message of .msg about a change that is too large for an increment."""
        return f"THE {self.unknown.upper()} CHANGES BY MORE THAN {self.limit} IN THE INCREMENT."

    def head(self) -> Iterator[HeadLine]:
        """Yield increments, and the largest change in one of them."""
        yield from Procedure.head(self)
        if math.isfinite(self.largest_change):
            yield f"MAXIMUM {self.unknown.upper()} CHANGE IN AN INCREMENT IS", self.largest_change


@dataclass(frozen=True, slots=True)
class HeatTransfer(Diffusive):
    """*HEAT TRANSFER."""

    keyword: ClassVar = "HEAT TRANSFER"
    title: ClassVar = "HEAT TRANSFER"
    displacements: ClassVar = False
    temperatures: ClassVar = True
    unknown: ClassVar = "temperature"
    limit: ClassVar = "DELTMX"

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 31 steady, 32 transient, 33 with fixed increments."""
        return 30 + self._kind

    @property
    def stores_heat(self) -> bool:
        """Whether heat capacity counts: not in a steady state."""
        return not self.steady


@dataclass(frozen=True, slots=True)
class CoupledTemperatureDisplacement(HeatTransfer):
    """*COUPLED TEMPERATURE-DISPLACEMENT."""

    keyword: ClassVar = "COUPLED TEMPERATURE-DISPLACEMENT"
    title: ClassVar = "COUPLED TEMPERATURE-DISPLACEMENT"
    displacements: ClassVar = True
    unsymmetric: ClassVar = True

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 71 steady, 72 transient, 73 with fixed increments."""
        return 70 + self._kind


@dataclass(frozen=True, slots=True)
class MassDiffusion(Diffusive):
    """*MASS DIFFUSION."""

    keyword: ClassVar = "MASS DIFFUSION"
    title: ClassVar = "MASS DIFFUSION"
    displacements: ClassVar = False
    concentrations: ClassVar = True
    unknown: ClassVar = "concentration"
    limit: ClassVar = "DCMAX"

    @property
    def lflag(self) -> int:
        """LFLAGS(1): 131 to 133, for built-in elements only: Abaqus lists none for *MASS DIFFUSION."""
        return 130 + self._kind
