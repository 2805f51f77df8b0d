# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in elements in generalised plane strain for the driver (fortran/host/elements/solid/generalised.f90)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.elements.families.solid import solid_of, solid_routine
from uel.elements.materials.library import refuse_hyperelastic
from uel.elements.routine import Routine
from uel.errors import DeckError
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import SolidSection
from uel.usersub import Library, _binding


def generalised_routine(model: Model, group: ElementGroup, section: SolidSection, library: Library) -> Routine:
    """Build the routine of a group of elements in generalised plane strain. Raises DeckError."""
    kind, material = solid_of(group), section.material
    elements = f"elements of type {group.type}"
    for step in model.steps:
        procedure = step.procedure
        if procedure.inertia or procedure.finds_modes or procedure.harmonic or procedure.modal:
            message = "are not supported in steps that need a mass: that of their bounding planes is not documented"
            raise DeckError(step.source, f"{elements} {message}")
    refuse_hyperelastic(material, elements)
    solid = solid_routine(model, group, section, library)
    origin = model.mesh.coordinates[section.reference, : kind.dimension]
    return replace(solid, address=_binding.address_of("generalised"), props=np.concatenate([solid.props, origin]))
