# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in coupled temperature-displacement elements for the driver (fortran/host/host_coupled.f90)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.elements.materials import refuse_fields
from harness.elements.routine import Routine
from harness.elements.solid import solid_of, solid_routine
from harness.errors import DeckError
from harness.model.mesh import ElementGroup
from harness.model.model import Model
from harness.model.properties import SolidSection
from harness.usersub import Library, _binding


def coupled_routine(model: Model, group: ElementGroup, section: SolidSection, library: Library) -> Routine:
    """What the driver calls for a group of solids with temperatures. Raises DeckError."""
    material = section.material
    refuse_fields(material, f"elements of type {group.type}")
    transient = False
    for step in model.steps:
        procedure = step.procedure
        if not (procedure.temperatures and procedure.displacements):
            message = f"elements of type {group.type} are supported in *COUPLED TEMPERATURE-DISPLACEMENT steps only"
            raise DeckError(step.source, message)
        transient = transient or procedure.stores_heat
    needed = [("*CONDUCTIVITY", material.conductivity)]
    if transient:
        needed += [("*DENSITY", material.density), ("*SPECIFIC HEAT", material.specific_heat)]
    for keyword, value in needed:
        if not value:
            message = f"material {material.name} has no {keyword}, which elements of type {group.type} need"
            raise DeckError(material.source, message)
    solid = solid_routine(model, group, section, library)
    thermal = [material.conductivity, material.specific_heat]
    kind = solid_of(group)
    points = np.array([kind.thermal_points, kind.family.linear.number])
    return replace(
        solid,
        address=_binding.address_of("coupled"),
        props=np.concatenate([solid.props, thermal]),
        jprops=np.concatenate([solid.jprops, points]),
    )
