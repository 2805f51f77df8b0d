# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in elements in generalised plane strain for the driver (fortran/host/elements/solid/generalised.f90)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.elements.families.solid import solid_of, solid_routine
from uel.elements.routine import Routine
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import SolidSection
from uel.usersub import Library, _binding


def generalised_routine(model: Model, group: ElementGroup, section: SolidSection, library: Library) -> Routine:
    """Build the routine of a group of elements in generalised plane strain. Raises DeckError."""
    kind = solid_of(group)
    solid = solid_routine(model, group, section, library)
    origin = model.mesh.coordinates[section.reference, : kind.dimension]
    return replace(solid, address=_binding.address_of("generalised"), props=np.concatenate([solid.props, origin]))
