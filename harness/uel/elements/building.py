# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions and data shared by the builders of blocks."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.directions import initial_axes
from uel.elements.materials.library import has_unsymmetric_tangent
from uel.elements.routine import Routine
from uel.model.element_types import BuiltInType, ContinuumShellType, SurfaceType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import materials_of
from uel.model.records import PointVariables
from uel.usersub import Library


@dataclass(frozen=True, slots=True)
class Building:
    """Input of the builders of blocks.

    model    the whole deck
    library  the loaded user routines
    strict   a write of a user element outside an array is an error, otherwise a warning
    zeros    an entry of RHS or AMATRX that a user element does not set gives a warning and is zero, otherwise it is an
             error
    linear   types of user elements that the user says are linear
    """

    model: Model
    library: Library
    strict: bool = True
    zeros: bool = False
    linear: Collection[str] = ()


def nodal_block(
    building: Building,
    group: ElementGroup,
    kind: BuiltInType,
    routine: Routine,
    variables: PointVariables | None,
    *,
    unsymmetric: bool = False,
) -> ElementBlock:
    """Build a block whose unknowns are dofs of its nodes; it is unsymmetric if asked, or if a material tangent is."""
    return ElementBlock(
        group,
        building.model.mesh.coordinates,
        tuple((node, dof) for node in range(kind.nodes) for dof in kind.dofs(node)),
        routine,
        building.library,
        unsymmetric=unsymmetric or any(map(has_unsymmetric_tangent, materials_of(group.section))),
        variables=variables,
    )


def begin_surface_axes(
    building: Building,
    group: ElementGroup,
    kind: SurfaceType | ContinuumShellType,
    block: ElementBlock,
    routine: Routine,
) -> None:
    """Set the initial directions of *ORIENTATION at the points of shells or membranes. Raises DeckError."""
    if routine.axes is not None:
        axes = initial_axes(building.model, group, kind, routine.axes.orientation, building.library)
        # the direction that is projected, the next one, and that closest to the normal
        block.initial.begin_axes(np.roll(axes, -routine.axes.orientation.normal, axis=-2))
