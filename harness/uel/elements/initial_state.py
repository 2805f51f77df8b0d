# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Initial state of the elements of a block."""

from __future__ import annotations

import numpy as np

from uel.elements.array_mistakes import at_point
from uel.elements.directions import is_user, undefined_directions
from uel.elements.routine import Routine
from uel.errors import KernelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import ContinuumType
from uel.model.mesh import ElementGroup
from uel.model.orientation_axes import UndefinedDirectionsError, orthonormal
from uel.model.properties import SolidSection
from uel.model.steps import VerticalStress
from uel.usersub import Library, _binding, _points
from uel.usersub.exchange import BlockArrays


class InitialState:
    """Setter of the initial state of elements: variables, stresses and directions, by values or by user routines.

    Parameters
    ----------
    group, routine, library
        Those of the block.
    arrays
        Arrays of the block, whose committed and trial states are set.
    """

    def __init__(self, group: ElementGroup, arrays: BlockArrays, routine: Routine, library: Library) -> None:
        self._group = group
        self._arrays = arrays
        self._routine = routine
        self._library = library

    def initialise(self, rows: IntArray, values: FloatArray) -> None:
        """Set initial SVARS of elements, or STATEV of their points.

        Parameters
        ----------
        rows
            (k,) elements, as rows of the block from 0.
        values
            The first variables, the same for all these elements and their points.

        Raises
        ------
        ValueError
            There are more values than variables.
        """
        state = self._variables()
        if len(values) > state.shape[2]:
            raise ValueError(f"{len(values)} values, but elements of type {self._group.type} have {state.shape[2]}")
        state[rows, :, : len(values)] = values
        self._begin(state)

    def set_stress(self, rows: IntArray, values: FloatArray | VerticalStress) -> None:
        """Set the initial stress at all points of elements; `ElementBlock.begin_stressed` passes it to the material.

        Parameters
        ----------
        rows
            (k,) elements, as rows of the block from 0.
        values
            Components in Abaqus' order (force/length^2), in the directions of *ORIENTATION; those left out are zero.
            Or a stress that varies with the elevation, in global directions.

        Raises
        ------
        ValueError
            The elements take no stress, lack a component that is not zero, or have an orientation.
        """
        try:
            if isinstance(values, VerticalStress):
                values = values.components(self._elevations(rows), len(self._routine.stress))
            self._routine.set_stress(self._arrays.svars, rows, values)
        except ValueError as error:
            raise ValueError(f"elements of type {self._group.type} {error}") from None

    @property
    def takes_stress(self) -> bool:
        """Whether the elements take an initial stress."""
        return bool(self._routine.stress)

    def call_sigini(self, address: int) -> None:
        """Call SIGINI for the initial stress at all points; `ElementBlock.begin_stressed` passes it to the material.

        Parameters
        ----------
        address
            Of SIGINI, as `Library.sigini`.

        Raises
        ------
        KernelError
            It ends the analysis.
        """
        states, columns = self._routine.stress_of(self._arrays.svars)
        sigma = np.zeros((*states.shape[:2], len(columns)))
        element, point = _points.sigini(address, self._group.type, self._arrays, sigma, self._routine.family)
        self._check(element, at_point("SIGINI", point))
        states[:, :, columns] = sigma

    def _elevations(self, rows: IntArray) -> FloatArray:
        """Return the elevation (k, points), the last coordinate, of the integration points of elements."""
        kind, section = self._group.built_in, self._group.section
        if not isinstance(kind, ContinuumType) or not isinstance(section, SolidSection):
            raise ValueError("do not take an initial stress by elevation")
        if section.orientation is not None:
            raise ValueError("have directions of their own (*ORIENTATION), for which GEOSTATIC is not supported")
        family = kind.family
        _, shapes, _ = _binding.integration_rule(family.number, kind.points, family.nodes, family.dimension)
        elevations: FloatArray = self._arrays.coords[rows, :, kind.dimension - 1] @ shapes.T
        return elevations

    def call_sdvini(self, address: int) -> None:
        """Call SDVINI for the initial state variables.

        Parameters
        ----------
        address
            Of SDVINI, as `Library.sdvini`.

        Raises
        ------
        KernelError
            It ends the analysis.
        """
        state = np.ascontiguousarray(self._variables())
        element, point = _points.sdvini(address, self._arrays, state, self._routine.family) if state.size else (0, 0)
        self._check(element, at_point("SDVINI", point) if self._group.definition is None else "SDVINI ")
        self._begin(state)

    def begin_axes(self, axes: FloatArray) -> None:
        """Set the initial directions of *ORIENTATION.

        Parameters
        ----------
        axes
            (m, points, 3, 3), in rows.

        Raises
        ------
        DeckError
            Direction 3 is not normal to the plane of plane elements.
        """
        layout = self._routine.axes
        assert layout is not None
        try:
            layout.begin(self._arrays.svars, axes)
        except UndefinedDirectionsError as error:
            raise undefined_directions(self._group, layout.orientation, error) from None
        self._arrays.svars_trial[:] = self._arrays.svars

    def set_last(self, values: FloatArray) -> None:
        """Set the last SVARS (m, count) of all elements, which no pass changes."""
        self._arrays.svars[:, -values.shape[1] :] = self._arrays.svars_trial[:, -values.shape[1] :] = values

    def call_orient(self, address: int, labels: IntArray) -> None:
        """Call ORIENT for the directions of points with *ORIENTATION, SYSTEM=USER.

        Parameters
        ----------
        address
            Of ORIENT, as `Library.orient`.
        labels
            Numbers of all nodes of the model.

        Raises
        ------
        KernelError
            It ends the analysis.
        DeckError
            It does not define two directions, or direction 3 of plane elements is not normal to the plane.
        """
        layout = self._routine.axes
        if layout is None or not is_user(layout.orientation) or not len(self._group.labels):
            return
        nodes = labels[self._group.nodes].astype(np.int32)
        name, family = layout.orientation.name, self._routine.family
        directions, element, point = _points.orient(address, name, self._arrays, nodes, family, layout.points)
        self._check(element, at_point("ORIENT", point))
        try:
            axes = orthonormal(directions)
        except UndefinedDirectionsError as error:
            raise undefined_directions(self._group, layout.orientation, error) from None
        self.begin_axes(axes)

    def _check(self, element: int, at: str) -> None:
        """Raise KernelError if a user routine ended the analysis for an element; 0 for none."""
        if element:
            raise KernelError(element, self._group.type, at + self._library.stop_reason())

    def _variables(self) -> FloatArray:
        """Return a view (m, points, values) of the committed variables of *INITIAL CONDITIONS, TYPE=SOLUTION."""
        if self._group.definition is not None:
            return self._arrays.svars[:, None, :]
        history = self._arrays.history
        return history[:, :, history.shape[2] - self._routine.statev :]

    def _begin(self, state: FloatArray) -> None:
        """Set the committed and the trial state."""
        self._variables()[:] = state
        self._arrays.svars_trial[:], self._arrays.history_trial[:] = self._arrays.svars, self._arrays.history
