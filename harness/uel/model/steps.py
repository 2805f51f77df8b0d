# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Steps: procedure, prescribed values, loads and output requests; solution controls are in controls.py."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from typing import Final

import numpy as np

from uel.errors import Source
from uel.model.amplitude import Amplitude
from uel.model.arrays import FloatArray, IntArray
from uel.model.controls import Controls
from uel.model.procedures import Procedure
from uel.model.restart import RestartWrite


@dataclass(frozen=True, slots=True)
class Boundary:
    """One *BOUNDARY entry: nodes (indices), one dof, magnitude, amplitude (None: the step's default).

    With `velocity` (TYPE=VELOCITY) the rate of the dof is prescribed; with `user` DISP has the last word;
    with `fixed` it is the value at the start of the step. `imaginary`: the imaginary part, of a harmonic one.
    """

    nodes: IntArray
    dof: int
    magnitude: float
    amplitude: Amplitude | None
    source: Source
    velocity: bool = False
    user: bool = False
    fixed: bool = False
    imaginary: bool = False


@dataclass(frozen=True, slots=True)
class Load:
    """One *CLOAD entry: nodes (indices), one dof, reference magnitude, amplitude (None: the step's default).

    imaginary  it is the imaginary part of a harmonic load
    user       UTEMP or UFIELD has the last word, of a field
    """

    nodes: IntArray
    dof: int
    magnitude: float
    amplitude: Amplitude | None
    source: Source
    imaginary: bool = False
    user: bool = False


PRESSURE_STRESS: Final = -1
"""Number of the equivalent pressure stress among the predefined fields; temperature is 0, field variables follow."""


@dataclass(frozen=True, slots=True)
class DistributedLoad:
    """One *DLOAD entry on user elements: their positions in the model, n of type Un or -n of UnNU, magnitude."""

    elements: IntArray
    kind: int
    magnitude: float
    amplitude: Amplitude | None
    source: Source


class LoadKind(StrEnum):
    """Kind of a distributed load on a built-in element: on a face, on a volume, along an edge, or along a beam.

    The direction of LOCAL_LINE has components along t, 1 and 2 of the beam. Of the loads on edges of shells only the
    general one, EDLD, has a direction.
    """

    PRESSURE = "P"
    TRACTION = "TRVEC"
    SHEAR = "TRSHR"
    BODY = "B"
    GRAVITY = "GRAV"
    LINE = "LINE"
    LOCAL_LINE = "LOCAL LINE"
    EDGE = "EDLD"
    EDGE_NORMAL = "EDNOR"
    EDGE_SHEAR = "EDSHR"
    EDGE_TRANSVERSE = "EDTRA"


ON_EDGES: Final = (LoadKind.EDGE, LoadKind.EDGE_NORMAL, LoadKind.EDGE_SHEAR, LoadKind.EDGE_TRANSVERSE)
"""Loads per length of an edge of shells."""


@dataclass(frozen=True, slots=True)
class LoadType:
    """Type of a distributed load on built-in elements.

    face       local nodes of the face; none: the volume
    direction  unit vector; none for pressure
    follows    the load turns with the face (FOLLOWER=)
    jltyp      JLTYP of a load whose magnitude at each point is that of DLOAD; 0: that of the deck
    """

    kind: LoadKind
    face: tuple[int, ...] = ()
    direction: tuple[float, float, float] = (0.0, 0.0, 0.0)
    follows: bool = False
    jltyp: int = 0


@dataclass(frozen=True, slots=True)
class ElementLoad:
    """One *DLOAD or *DSLOAD entry on built-in continuum elements of one type: their positions in the model.

    imaginary  it is the imaginary part of a harmonic load
    """

    elements: IntArray
    type: LoadType
    magnitude: float
    amplitude: Amplitude | None
    source: Source
    imaginary: bool = False


class HeatLaw(IntEnum):
    """Law of a heat load: a flux, or exchange with a sink through a film or with the surroundings by radiation.

    The numbers are those of fortran/host/elements/heat/loads.f90.
    """

    FLUX = 0
    FILM = 1
    RADIATION = 2


@dataclass(frozen=True, slots=True)
class HeatLoadType:
    """Type of a heat load.

    keyword  that gives it, as 'DFLUX'
    law      how heat enters
    face     local nodes of the face; none: the volume, or nodes
    jltyp    JLTYP of DFLUX or FILM, 0 on surfaces and at nodes
    surface  its name, '' for none
    by_user  DFLUX or FILM gives the magnitudes
    area     of nodes, 0 for others
    number   0, and 1, 2, ... of further exchanges of a step on the same node or face
    """

    keyword: str
    law: HeatLaw
    face: tuple[int, ...] = ()
    jltyp: int = 0
    surface: str = ""
    by_user: bool = False
    area: float = 0.0
    number: int = 0

    @property
    def exchanges(self) -> bool:
        """Whether heat is exchanged, so that there is a coefficient beside the temperature of the other side."""
        return self.law is not HeatLaw.FLUX


@dataclass(frozen=True, slots=True)
class HeatLoad:
    """One entry of a heat load: positions of elements of one type in the model, or nodes.

    magnitude, amplitude         flux, or temperature of the sink or the surroundings
    coefficient, film_amplitude  film coefficient or emissivity, which is constant without an amplitude
    """

    places: IntArray
    type: HeatLoadType
    magnitude: float
    amplitude: Amplitude | None
    source: Source
    coefficient: float = 0.0
    film_amplitude: Amplitude | None = None


@dataclass(frozen=True, slots=True)
class InitialValue:
    """One *INITIAL CONDITIONS entry: nodes (indices), one dof, value."""

    nodes: IntArray
    dof: int
    value: float
    source: Source


@dataclass(frozen=True, slots=True)
class InitialSolution:
    """One *INITIAL CONDITIONS, TYPE=SOLUTION: elements (positions in the model) and their state variables.

    elements  None: all of them, by SDVINI (USER)
    """

    elements: IntArray | None
    values: FloatArray
    source: Source


PLANE_STRESS, LARGEST_TENSOR = 3, 6
"""Components of a stress."""


@dataclass(frozen=True, slots=True)
class VerticalStress:
    """A vertical stress that is linear over the elevation, and lateral stresses in proportion to it.

    stress, elevation  (first, second) of two points
    lateral            ratios of the stress along 1, and along 2 in space, or normal to the plane or around the axis
    """

    stress: tuple[float, float]
    elevation: tuple[float, float]
    lateral: tuple[float, float]

    def components(self, elevation: FloatArray, count: int) -> FloatArray:
        """Return the stress (..., count) in Abaqus' order at elevations: 6 components in space, 4,
        or 3 in plane stress.
        """
        (first, second), (low, high) = self.stress, self.elevation
        vertical = first + (second - first) * (elevation - low) / (high - low)
        stresses = np.zeros((*elevation.shape, count))
        upwards, other = (2, 1) if count == LARGEST_TENSOR else (1, 2)
        stresses[..., 0] = self.lateral[0] * vertical
        if count > PLANE_STRESS:
            stresses[..., other] = self.lateral[1] * vertical
        stresses[..., upwards] = vertical
        return stresses


@dataclass(frozen=True, slots=True)
class InitialStress:
    """One *INITIAL CONDITIONS, TYPE=STRESS: elements (positions in the model) and components in Abaqus' order.

    values   None: SIGINI gives them at each point (USER)
    profile  with GEOSTATIC, instead of the components
    ramped  the unbalanced part of the stresses takes effect gradually over the first step, else at once
    """

    elements: IntArray
    values: FloatArray | None
    ramped: bool
    source: Source
    profile: VerticalStress | None = None


@dataclass(frozen=True, slots=True)
class NodeRequest:
    """*NODE OUTPUT (history) or *NODE PRINT: variables as Abaqus names them (U, U2, RF2, CF1, ...).

    sensor  name by which UAMP reads it: one component of one node; '' for none
    """

    nset: str
    nodes: IntArray
    variables: tuple[str, ...]
    frequency: int = 1
    totals: bool = False
    sensor: str = ""


@dataclass(frozen=True, slots=True)
class EnergyRequest:
    """*ENERGY OUTPUT, ELSET=: energies of a set as Abaqus names them; elements are positions in the model."""

    elset: str
    elements: IntArray
    variables: tuple[str, ...]


class Position(StrEnum):
    """Location of the values of *EL PRINT."""

    POINTS = "INTEGRATION POINTS"
    CENTROID = "CENTROIDAL"
    NODES = "NODES"
    AVERAGED = "AVERAGED AT NODES"


@dataclass(frozen=True, slots=True)
class ElementRequest:
    """*EL PRINT: variables as Abaqus names them (S, S11, E, SDV, SDV3, ...); elements are positions in the model."""

    elset: str
    elements: IntArray
    variables: tuple[str, ...]
    frequency: int = 1
    position: Position = Position.POINTS


@dataclass(frozen=True, slots=True)
class OutputRequests:
    """Output of a step. field_frequency: every k-th increment a .vtu, 0 never; the last one always unless 0.

    field_intervals: also at the end of each of so many parts of the step, at the first increment that gets there.
    energy_print: every k-th increment the energies of the whole model in .dat, 0 never.
    """

    history_nodes: tuple[NodeRequest, ...] = ()
    history_energies: tuple[str, ...] = ()
    history_sets: tuple[EnergyRequest, ...] = ()
    history_frequency: int = 1
    field_frequency: int = 1
    field_intervals: int = 0
    node_print: tuple[NodeRequest, ...] = ()
    element_print: tuple[ElementRequest, ...] = ()
    energy_print: int = 0
    monitor: tuple[int, int] | None = None


@dataclass(frozen=True, slots=True)
class Step:
    """*STEP. `amplitude` RAMP or STEP; `new_boundary`/`new_loads`: OP=NEW removes the prescriptions of earlier steps.

    Of heat loads OP=NEW removes those of the keywords in `new_heat_loads`.

    `convert_sdi`: an increment may end with a severe discontinuity iteration.

    `notes` say where the run of the step differs from the deck. `restart`: *RESTART, WRITE, None without.
    """

    number: int
    name: str
    procedure: Procedure
    source: Source
    nlgeom: bool = False
    increments: int = 100
    extrapolation: str = "LINEAR"
    unsymmetric: bool = False
    convert_sdi: bool = True
    amplitude: str = "RAMP"
    title: str = ""
    controls: Controls = field(default_factory=Controls)
    boundaries: tuple[Boundary, ...] = ()
    new_boundary: bool = False
    loads: tuple[Load, ...] = ()
    new_loads: bool = False
    distributed: tuple[DistributedLoad, ...] = ()
    new_distributed: bool = False
    element_loads: tuple[ElementLoad, ...] = ()
    surface_loads: tuple[ElementLoad, ...] = ()
    new_surface_loads: bool = False
    heat_loads: tuple[HeatLoad, ...] = ()
    new_heat_loads: frozenset[str] = frozenset()
    fields: tuple[Load, ...] = ()
    new_fields: bool = False
    output: OutputRequests = field(default_factory=OutputRequests)
    notes: tuple[str, ...] = ()
    restart: RestartWrite | None = None

    @property
    def amplitudes(self) -> tuple[Amplitude, ...]:
        """Amplitudes that its values, loads and fields name."""
        amplitudes = [entry.amplitude for entry in self._entries]
        amplitudes += [entry.film_amplitude for entry in self.heat_loads]
        return tuple(amplitude for amplitude in amplitudes if amplitude is not None)

    @property
    def varying(self) -> tuple[Source, ...]:
        """File and line of the entries that name an amplitude."""
        return tuple(entry.source for entry in self._entries if entry.amplitude is not None)

    @property
    def _entries(self) -> tuple[Boundary | Load | DistributedLoad | ElementLoad | HeatLoad, ...]:
        entries: list[Boundary | Load | DistributedLoad | ElementLoad | HeatLoad]
        entries = [*self.boundaries, *self.loads, *self.fields]
        entries += [*self.distributed, *self.element_loads, *self.surface_loads, *self.heat_loads]
        return tuple(entries)
