# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in piezoelectric elements for the driver; they are in fortran/host/elements/solid/piezoelectric.f90."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.families.solid import continuum_block, solid_of, solid_routine, solid_section
from uel.elements.materials.library import directions, global_compliance
from uel.model.arrays import FloatArray
from uel.model.dofs import POTENTIAL
from uel.model.element_types import ContinuumType, Tensor
from uel.model.mesh import ElementGroup
from uel.model.properties import Material, SolidSection
from uel.model.records import PointVariables
from uel.usersub import _binding, built_in

_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def piezoelectric_block(building: Building, group: ElementGroup) -> ElementBlock:
    """Build the block of a group of piezoelectric solids. Raises DeckError."""
    kind, section = solid_of(group), solid_section(group)
    material = section.material
    solid = solid_routine(building.model, group, building.library)
    coupling, dielectric = _constants(material, section, kind.tensor)
    chosen = slice(kind.dimension)
    components = 2 * kind.dimension
    constants = np.hstack([coupling[chosen, :components], dielectric[chosen, chosen]])
    routine = replace(
        solid,
        address=_binding.address_of("piezoelectric"),
        svars=kind.points * (2 * components + 2 * kind.dimension),
        hidden=0,
        props=built_in.reals("piezoelectric", solid.props, constants=constants.ravel(order="F")),
        # the matrix does not store the energy: it is that of the enthalpy
        stores=False,
        stress=(),
        turns=False,
    )
    potentials = tuple((node, POTENTIAL) for node in range(kind.nodes))
    return continuum_block(building, group, routine, potentials, variables=_variables(kind))


def _variables(kind: ContinuumType) -> PointVariables:
    names = [f"{letter}{component}" for letter in "ES" for component in kind.components]
    names += [f"{name}{k + 1}" for name in ("EPG", "EFLX") for k in range(kind.dimension)]
    return PointVariables("continuum", tuple(names), kind.points)


def _constants(material: Material, section: SolidSection, tensor: Tensor) -> tuple[FloatArray, FloatArray]:
    """Return stress coefficients (3, 6) and permittivity (3, 3) in global axes;
    in plane stress with S33 and EPG3 eliminated.
    """
    axes, _ = directions(section.orientation)
    assert material.dielectric is not None
    dielectric = axes.T @ material.dielectric @ axes
    given, coupling = material.piezoelectric, np.zeros((3, 6))
    if given is not None:
        values = given.values
        if given.by_strain:
            values = values @ _stiffness(material, None, tensor)
        tensors = np.zeros((3, 3, 3))
        for place, (i, j) in enumerate(_PAIRS):
            tensors[:, i, j] = tensors[:, j, i] = values[:, place]
        turned = np.einsum("mkl,mp,ki,lj->pij", tensors, axes, axes, axes)
        coupling = np.array([turned[:, i, j] for i, j in _PAIRS]).T
    if tensor is Tensor.PLANE_STRESS:
        # S33 = 0 gives the strain along 3
        stiffness = _stiffness(material, section, tensor)
        ratio = stiffness[2] / stiffness[2, 2]
        dielectric = dielectric + np.outer(coupling[:, 2], coupling[:, 2]) / stiffness[2, 2]
        coupling = coupling - np.outer(coupling[:, 2], ratio)
    if tensor is not Tensor.SOLID:
        coupling = coupling[:, [0, 1, 2, 3]]
    return coupling, dielectric


def _stiffness(material: Material, section: SolidSection | None, tensor: Tensor) -> FloatArray:
    """Return the (6, 6) elastic stiffness, in global axes or, without a section, in those of the material."""
    compliance = global_compliance(material, section.orientation if section is not None else None, tensor)
    assert compliance is not None
    return np.asarray(np.linalg.inv(compliance), dtype=np.float64)
