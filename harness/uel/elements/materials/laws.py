# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a material in the words of the deck: rows of the table of formulations."""

from __future__ import annotations

from enum import StrEnum

from uel.elements.materials.library import is_incompressible
from uel.errors import Source
from uel.model.properties import ElasticType, HybridFormulation, Hyperelastic, Material, UserPotential


class Law(StrEnum):
    """A part of a material; values are its name in messages and in the manual."""

    ISOTROPIC = "*ELASTIC, TYPE=ISOTROPIC"
    HALF = "*ELASTIC with nu = 0.5"
    ENGINEERING = "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
    ORTHOTROPIC = "*ELASTIC, TYPE=ORTHOTROPIC"
    ANISOTROPIC = "*ELASTIC, TYPE=ANISOTROPIC"
    LAMINA = "*ELASTIC, TYPE=LAMINA"
    TRACTION = "*ELASTIC, TYPE=TRACTION"
    BY_FIELDS = "*ELASTIC with dependence on temperature and fields"
    PLASTIC = "*PLASTIC"
    KINEMATIC = "*PLASTIC with kinematic or combined hardening"
    UHARD = "*PLASTIC, HARDENING=USER"
    HYPERELASTIC = "*HYPERELASTIC"
    HYPERELASTIC_0 = "*HYPERELASTIC with D1 = 0"
    UHYPER = "*HYPERELASTIC, USER, TYPE=COMPRESSIBLE"
    UHYPER_0 = "*HYPERELASTIC, USER without TYPE=COMPRESSIBLE"
    HOLZAPFEL = "*ANISOTROPIC HYPERELASTIC"
    HOLZAPFEL_0 = "*ANISOTROPIC HYPERELASTIC with D = 0"
    INVARIANTS = "*ANISOTROPIC HYPERELASTIC, USER, TYPE=COMPRESSIBLE"
    INVARIANTS_0 = "*ANISOTROPIC HYPERELASTIC, USER without TYPE=COMPRESSIBLE"
    VISCOELASTIC = "*VISCOELASTIC"
    NETWORKS = "*VISCOELASTIC, NONLINEAR"
    CREEP = "*CREEP"
    UMAT = "*USER MATERIAL"
    UMAT_0 = "*USER MATERIAL, HYBRID FORMULATION=INCOMPRESSIBLE"
    EXPANSION = "*EXPANSION"
    EXPANSION_DIRECTED = "*EXPANSION other than TYPE=ISO"
    DAMAGE = "*DAMAGE INITIATION"
    USDFLD = "*USER DEFINED FIELD"
    UVARM = "*USER OUTPUT VARIABLES"
    CONDUCTIVITY = "*CONDUCTIVITY"
    SPECIFIC_HEAT = "*SPECIFIC HEAT"
    LATENT_HEAT = "*LATENT HEAT"
    HETVAL = "*HEAT GENERATION"
    UMATHT = "*USER MATERIAL, TYPE=THERMAL"
    DIFFUSIVITY = "*DIFFUSIVITY"
    SOLUBILITY = "*SOLUBILITY"
    PIEZOELECTRIC = "*PIEZOELECTRIC"
    DIELECTRIC = "*DIELECTRIC"

    @property
    def keyword(self) -> str:
        """The keyword alone."""
        return self.split(",", maxsplit=1)[0].split(" with", maxsplit=1)[0]


_ELASTIC = {
    ElasticType.ISOTROPIC: Law.ISOTROPIC,
    ElasticType.ENGINEERING_CONSTANTS: Law.ENGINEERING,
    ElasticType.ORTHOTROPIC: Law.ORTHOTROPIC,
    ElasticType.ANISOTROPIC: Law.ANISOTROPIC,
    ElasticType.LAMINA: Law.LAMINA,
    ElasticType.TRACTION: Law.TRACTION,
}


def laws_of(material: Material) -> dict[Law, Source]:
    """Return what a material has, each with its place."""
    elastic, plastic, networks, source = material.elastic, material.plastic, material.networks, material.source
    parts = {
        _elasticity(material): elastic,
        Law.BY_FIELDS: elastic if elastic is not None and elastic.table is not None else None,
        _hardening(material): plastic,
        _potential(material): material.hyperelastic,
        Law.VISCOELASTIC: material.viscoelastic,
        Law.NETWORKS: networks[0] if networks else None,
        Law.CREEP: material.creep,
        _umat(material): material.user,
        _expansion(material): material.expansion,
        Law.DAMAGE: material.damage,
        Law.UMATHT: material.user_thermal,
        Law.DIFFUSIVITY: material.diffusivity,
        Law.PIEZOELECTRIC: material.piezoelectric,
    }
    found = {law: part.source for law, part in parts.items() if part is not None}
    places = {
        Law.USDFLD: material.user_field,
        Law.HETVAL: material.heat_generation,
        Law.UVARM: source if material.output_variables else None,
        Law.CONDUCTIVITY: source if len(material.conductivity) else None,
        Law.SPECIFIC_HEAT: source if len(material.specific_heat) else None,
        Law.LATENT_HEAT: source if len(material.latent_heat) else None,
        Law.SOLUBILITY: source if len(material.solubility) else None,
        Law.DIELECTRIC: source if material.dielectric is not None else None,
    }
    return found | {law: place for law, place in places.items() if place is not None}


def _elasticity(material: Material) -> Law:
    if material.elastic is None:
        return Law.ISOTROPIC
    other = material.user is not None or material.hyperelastic is not None
    return Law.HALF if is_incompressible(material) and not other else _ELASTIC[material.elastic.type]


def _hardening(material: Material) -> Law:
    plastic = material.plastic
    if plastic is None or plastic.user is None:
        return Law.KINEMATIC if plastic is not None and len(plastic.backstresses) else Law.PLASTIC
    return Law.UHARD


def _potential(material: Material) -> Law:
    law = material.hyperelastic
    if isinstance(law, UserPotential):
        kinds = (Law.UHYPER, Law.UHYPER_0) if law.directions is None else (Law.INVARIANTS, Law.INVARIANTS_0)
    elif isinstance(law, Hyperelastic):
        kinds = Law.HYPERELASTIC, Law.HYPERELASTIC_0
    else:
        kinds = Law.HOLZAPFEL, Law.HOLZAPFEL_0
    return kinds[law is not None and is_incompressible(material)]


def _umat(material: Material) -> Law:
    incompressible = material.user is not None and material.user.hybrid is HybridFormulation.INCOMPRESSIBLE
    return Law.UMAT_0 if incompressible else Law.UMAT


def _expansion(material: Material) -> Law:
    isotropic = material.expansion is None or material.expansion.isotropic
    return Law.EXPANSION if isotropic else Law.EXPANSION_DIRECTED
