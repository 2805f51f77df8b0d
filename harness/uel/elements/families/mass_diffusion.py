# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heat transfer elements in *MASS DIFFUSION for the driver (fortran/host/elements/heat/mass_diffusion.f90)."""

from __future__ import annotations

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.families.solid import check_radii, section_depth, solid_section
from uel.elements.materials.library import directions
from uel.elements.routine import PARALLEL, Routine
from uel.errors import DeckError
from uel.model.dofs import CONCENTRATION
from uel.model.element_types import HeatType
from uel.model.mesh import ElementGroup
from uel.model.properties import Diffusivity, Material, Orientation
from uel.model.records import PointVariables
from uel.usersub import _binding, _materials, built_in

_ROWS, _COLUMNS = (0, 0, 1, 0, 1, 2), (0, 1, 1, 2, 2, 2)
"""Rows and columns of D11, D12, D22, D13, D23, D33."""


def mass_diffusion_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of heat transfer elements in *MASS DIFFUSION. Raises DeckError."""
    model, kind, section = building.model, group.built_in, solid_section(group)
    assert isinstance(kind, HeatType)
    if kind.axisymmetric:
        check_radii(model, group)
    material = section.material
    law = _checked(group, material, section.orientation, kind)
    axes, _ = directions(section.orientation)
    tensors = axes.T @ law.tensors @ axes
    number = _materials.define_empty_material()
    _materials.set_diffusion(
        number,
        fick=law.fick,
        absolute_zero=model.constants.absolute_zero,
        axes=axes,
        diffusivity=np.hstack([tensors[:, _ROWS, _COLUMNS], law.points]),
        solubility=material.solubility,
        soret=law.soret,
        pressure=law.pressure,
    )
    routine = Routine(
        address=_binding.address_of("mass diffusion"),
        jtype=kind.nodes,
        mcrd=kind.dimension,
        svars=len(_names(kind)) * kind.points,
        props=built_in.reals("flow", depth=section_depth(kind, section)),
        jprops=built_in.integers("flow", family=kind.family.number, points=kind.points, direct=kind.direct),
        family=kind.family.number,
        material=number,
    )
    return ElementBlock(
        group,
        model.mesh.coordinates,
        tuple((node, CONCENTRATION) for node in range(kind.nodes)),
        routine,
        building.library,
        unsymmetric=_depends_on_concentration(material),
        variables=PointVariables("continuum", _names(kind), kind.points),
    )


def _names(kind: HeatType) -> tuple[str, ...]:
    return (*(f"MFL{component}" for component in kind.components), "CONC", "ISOL", "IVOL")


def _depends_on_concentration(material: Material) -> bool:
    """Return whether the flux depends on the concentration besides its gradient: then the matrix is unsymmetric."""
    law = material.diffusivity
    if law is None:
        return False
    tables = law.points[:, 0], law.soret[:, 1], law.pressure[:, 1]
    by_solubility = law.fick and len(material.solubility) > 1
    return by_solubility or any(len(np.unique(given)) > 1 for given in tables)


def _checked(group: ElementGroup, material: Material, orientation: Orientation | None, kind: HeatType) -> Diffusivity:
    """Return the diffusivity if it fits the directions. Raises DeckError."""
    law = material.diffusivity
    assert law is not None
    if orientation is None:
        if not law.isotropic:
            message = "*DIFFUSIVITY that is not isotropic needs ORIENTATION on *SOLID SECTION"
            raise DeckError(law.source, f"{message} ({group.section.source})")
    elif kind.dimension == 2 and abs(orientation.axes[2, 2]) < 1 - PARALLEL:
        message = f"*ORIENTATION, NAME={orientation.name}: direction 3 must be normal to the plane of the elements"
        raise DeckError(orientation.source, message)
    return law
