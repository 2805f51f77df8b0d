# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Routine that the driver calls for a block of elements."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from functools import cached_property

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.local_systems import UndefinedDirectionsError
from uel.model.properties import Orientation
from uel.usersub.exchange import Called

VALUES_OF_AXES = 18
"""Values of SVARS for the directions of a point (fortran/host/elements/axes.f90)."""

PARALLEL = 1e-9
"""Largest component of the difference of unit vectors that are parallel."""


class Linearity(Enum):
    """Whether the forces of elements at rest and in small displacements are AMATRX times U, with one AMATRX for all U.

    KNOWN    they are
    ASSUMED  the user says that they are
    UNKNOWN  they may not be
    """

    KNOWN = auto()
    ASSUMED = auto()
    UNKNOWN = auto()


@dataclass(frozen=True)
class Routine:
    """Routine that the driver calls for a block, with the constants of the calls.

    material  number of the material in the host, 0 without one (then UEL is called, else UELMAT)
    history   values per point and points of the material history; (1, 1) without one
    statev    number of STATEV, which are the last values of the history
    uvarm     UVARM to call after each increment, None for none, or if the elements call it themselves
    outputs   number of UVAR that elements which call UVARM themselves keep in the history, before STATEV
    density   place of the density in PROPS, from 0; -1 without one
    internal  unknowns within each element, on which no force acts
    massive   whether forces of inertia are terms of the average flux of their own
    hidden    number of SVARS at the end that do not belong to a point, which output leaves out
    tensor    stress components of the material: 3 plane stress, 4 plane strain, 6 three-dimensional; 0 without one
    mcrd      coordinates per node
    family    number of the family of continuum elements (harness/uel/model/element_types.py), 0 for others
    viscous   place in the material history of the change of a viscous strain rate in the increment, times its length;
              -1 without one
    damages   ENERGY(4) is dissipated by damage, not by plasticity
    linear    the state of built-in elements is linear in small displacements
    forces    whether the forces are
    stores    whether linear elements have no ENERGY but ENERGY(2), which is what AMATRX stores
    free      dofs along which a translation of an element causes no force, as far as that is known
    axes      the directions of the points, if the material is in them, None if it is not
    turns     whether the elements have an initial stress matrix; stresses of others do not turn with them
    forceless whether they have no forces, not even zeros that would count in average forces
    initial_temperatures  (nodes of the model,) from which elements with temperatures expand; None: those of the
              predefined fields
    stress    places of the stress components of a point among its SVARS, in Abaqus' order; the last one is S12 or
              S23; none: the elements take no initial stress
    """

    address: int
    jtype: int
    mcrd: int
    svars: int
    props: FloatArray
    jprops: IntArray
    material: int = 0
    tensor: int = 0
    history: tuple[int, int] = (1, 1)
    statev: int = 0
    viscous: int = -1
    hidden: int = 0
    density: int = -1
    internal: int = 0
    massive: bool = False
    uvarm: OutputVariables | None = None
    outputs: int = 0
    family: int = 0
    damages: bool = False
    linear: bool = False
    forces: Linearity = Linearity.UNKNOWN
    stores: bool = False
    free: tuple[int, ...] = ()
    axes: PointAxes | None = None
    stress: tuple[int, ...] = ()
    turns: bool = False
    forceless: bool = False
    initial_temperatures: FloatArray | None = None

    @cached_property
    def called(self) -> Called:
        """Arguments of the driver in each pass."""
        return Called(self.address, self.material, self.jtype, self.tensor)

    def stress_of(self, svars: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return SVARS (m, svars) by points (m, points, values), a view, and the places of the stress there.

        Raises ValueError if the elements take no initial stress.
        """
        if not self.stress:
            raise ValueError("do not take an initial stress")
        count, size = svars.shape[1] - self.hidden, self.stress[-1] + 1
        states = svars[:, :count].reshape(len(svars), count // size, size)
        return states, np.array(self.stress)

    def set_stress(self, svars: FloatArray, rows: IntArray, values: FloatArray) -> None:
        """Write the stress at all points of elements, rows of their SVARS (elements, svars); values: for all points the
        same, or (rows, points, components).

        Raises ValueError if there is no such stress or component; zeros beyond those are ignored.
        """
        states, places = self.stress_of(svars)
        count = len(places)
        if values[..., count:].any():
            names = {3: "S11, S22, S12", 4: "S11, S22, S33, S12"}[count]
            raise ValueError(f"have {names}: component {count + 1} is not zero")
        given = np.zeros((*values.shape[:-1], count))
        given[..., : values.shape[-1]] = values[..., :count]
        states[np.ix_(rows, np.arange(states.shape[1]), places)] = given


@dataclass(frozen=True, slots=True)
class PointAxes:
    """Layout of the directions of *ORIENTATION in SVARS: at the start and now, for each point.

    place   of the first value, from 0
    points  of an element
    plane   direction 3 must be normal to the plane
    """

    place: int
    points: int
    plane: bool
    orientation: Orientation

    def view(self, svars: FloatArray) -> FloatArray:
        """Return a view (m, points, 2, 3, 3) of the directions in SVARS (m, svars); they are columns."""
        count = VALUES_OF_AXES * self.points
        found: FloatArray = svars[:, self.place : self.place + count].reshape(len(svars), self.points, 2, 3, 3)
        return found

    def begin(self, svars: FloatArray, axes: FloatArray) -> None:
        """Write the directions (m, points, 3, 3), in rows, at the start into SVARS (m, svars).

        Raises UndefinedDirectionsError if direction 3 is not normal to the plane of plane elements.
        """
        if self.plane:
            tilted = np.argwhere(~(np.abs(axes[..., 2, 2]) >= 1 - PARALLEL))
            if len(tilted):
                element, point = tilted[0].tolist()
                raise UndefinedDirectionsError((element, point), "direction 3 must be normal to the plane")
        count = VALUES_OF_AXES * self.points
        both = np.repeat(axes.swapaxes(-1, -2)[:, :, None], 2, axis=2)
        svars[:, self.place : self.place + count] = both.reshape(len(svars), count)


@dataclass(frozen=True, slots=True)
class OutputVariables:
    """*USER OUTPUT VARIABLES of a material: the address of UVARM, points and variables of each.

    names    of the material and its orientation; axes (3, 3), rows are its directions, if they are the same everywhere
    plastic  the history of a point begins with its plastic strain
    """

    address: int
    names: tuple[str, str]
    axes: FloatArray
    points: int
    count: int
    plastic: bool
