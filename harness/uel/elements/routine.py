# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Routine that the driver calls for a block of elements, and its arrays."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from functools import cached_property

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.orientation_axes import UndefinedDirectionsError
from uel.model.properties import Orientation
from uel.usersub.exchange import Called

VALUES_OF_AXES = 18
"""SVARS that hold the directions of a point (fortran/host/elements/axes.f90)."""

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
    uvarm     UVARM to call after each increment; None without one, or if the elements call it themselves
    outputs   number of UVAR in the history, before STATEV, of elements that call UVARM themselves
    density   position of the density in PROPS, from 0; -1 without one
    internal  number of internal unknowns of an element, on which no external force acts
    massive   whether inertia forces are separate terms of the average flux
    hidden    number of SVARS at the end that belong to no point; output leaves them out
    tensor    stress components of the material: 3 plane stress, 4 plane strain, 6 three-dimensional; 0 without one
    mcrd      coordinates per node
    family    number of the family of continuum elements (harness/uel/model/element_types.py), 0 for others
    viscous   position in the material history of the change of the viscous strain rate times the time increment; -1
              without one
    damages   ENERGY(4) is dissipated by damage, not by plasticity
    linear    whether, in small displacements, the state of built-in elements is linear in the displacements
    forces    whether their forces are
    stores    whether ENERGY(2), the energy of AMATRX, is the only energy of linear elements
    free      dofs along which a translation of an element is known to cause no force
    axes      directions of the points, None if the material does not have those of *ORIENTATION
    turns     whether the elements have an initial stress matrix; stresses of others do not rotate
    forceless whether the elements have no forces at all, not even zeros that count in the average flux
    initial_temperatures  (nodes of the model,) at which elements with temperatures have no thermal strain; None: those
              of the predefined fields
    stress    positions of the stress components among the SVARS of a point, in Abaqus' order, up to S12 or S23; empty
              if the elements take no initial stress
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
        """Return a view (m, points, values) of SVARS (m, svars), and the positions of the stress in it.

        Raises ValueError if the elements take no initial stress.
        """
        if not self.stress:
            raise ValueError("do not take an initial stress")
        count, size = svars.shape[1] - self.hidden, self.stress[-1] + 1
        states = svars[:, :count].reshape(len(svars), count // size, size)
        return states, np.array(self.stress)

    def set_stress(self, svars: FloatArray, rows: IntArray, values: FloatArray) -> None:
        """Write the stress at all points of some elements (rows) into SVARS (elements, svars).

        values: the components of all points, or (rows, points, components). Raises ValueError if the elements have no
        stress, or lack a component that is not zero.
        """
        states, columns = self.stress_of(svars)
        count = len(columns)
        if values[..., count:].any():
            names = {3: "S11, S22, S12", 4: "S11, S22, S33, S12"}[count]
            raise ValueError(f"have {names}: component {count + 1} is not zero")
        stress = np.zeros((*values.shape[:-1], count))
        stress[..., : values.shape[-1]] = values[..., :count]
        states[np.ix_(rows, np.arange(states.shape[1]), columns)] = stress


@dataclass(frozen=True, slots=True)
class PointAxes:
    """Layout of the directions of *ORIENTATION in SVARS: initial and current ones of each point.

    first   position of the first value, from 0
    points  number of points of an element
    plane   whether direction 3 must be normal to the plane
    """

    first: int
    points: int
    plane: bool
    orientation: Orientation

    def view(self, svars: FloatArray) -> FloatArray:
        """Return a view (m, points, 2, 3, 3) of the directions, in columns, in SVARS (m, svars)."""
        count = VALUES_OF_AXES * self.points
        axes: FloatArray = svars[:, self.first : self.first + count].reshape(len(svars), self.points, 2, 3, 3)
        return axes

    def begin(self, svars: FloatArray, axes: FloatArray) -> None:
        """Write the initial directions (m, points, 3, 3), in rows, into SVARS (m, svars).

        Raises UndefinedDirectionsError if direction 3 is not normal to the plane of plane elements.
        """
        if self.plane:
            tilted = np.argwhere(~(np.abs(axes[..., 2, 2]) >= 1 - PARALLEL))
            if len(tilted):
                element, point = tilted[0].tolist()
                raise UndefinedDirectionsError((element, point), "direction 3 must be normal to the plane")
        count = VALUES_OF_AXES * self.points
        both = np.repeat(axes.swapaxes(-1, -2)[:, :, None], 2, axis=2)
        svars[:, self.first : self.first + count] = both.reshape(len(svars), count)


@dataclass(frozen=True, slots=True)
class OutputVariables:
    """*USER OUTPUT VARIABLES of a material: the address of UVARM, points of an element and variables of a point.

    names    names of the material and its orientation
    axes     (3, 3) directions, in rows, if they are the same at all points
    plastic  whether the history of a point begins with its plastic strain
    """

    address: int
    names: tuple[str, str]
    axes: FloatArray
    points: int
    count: int
    plastic: bool
