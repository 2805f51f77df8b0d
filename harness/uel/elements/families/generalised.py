# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in elements in generalised plane strain for the driver (fortran/host/elements/solid/solid.f90)."""

from __future__ import annotations

from dataclasses import replace

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.families.solid import continuum_block, solid_of, solid_routine, solid_section
from uel.elements.fields import REFERENCE
from uel.model.element_types import PLANES
from uel.model.mesh import ElementGroup
from uel.usersub import _binding, built_in


def generalised_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of elements in generalised plane strain. Raises DeckError."""
    solid = solid_routine(building.model, group, building.library)
    reference, dimension = solid_section(group).reference, solid_of(group).dimension
    origin = building.model.mesh.coordinates[reference, :dimension]
    props = built_in.reals("generalised", solid.props, origin=origin)
    routine = replace(solid, address=_binding.address_of("generalised"), props=props)
    return continuum_block(building, group, routine, tuple((REFERENCE, dof) for dof in PLANES))
