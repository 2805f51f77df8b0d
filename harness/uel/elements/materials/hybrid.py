# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hybrid elements: which of their materials make the pressure an unknown of the system, and which are refused.

The pressure of hyperelastic and of incompressible materials is an unknown (host/elements/solid/hybrid.f90). That of
others, which have a finite bulk modulus, follows from the mean stresses of the points of the element: it is eliminated.
Elements with further unknowns of their own have only that: incompatible modes, temperatures or bounding planes.
"""

from __future__ import annotations

from uel.elements.materials.library import is_incompressible
from uel.errors import DeckError
from uel.model.element_types import HYBRID, ContinuumType
from uel.model.properties import Material, UserPotential


def pressure_unknowns(kind: ContinuumType, material: Material) -> int:
    """Return the number of pressures of an element that are unknowns of the system."""
    compressible_user = isinstance(material.hyperelastic, UserPotential) and not material.hyperelastic.incompressible
    with_energy = material.hyperelastic is not None and not compressible_user
    return kind.pressures if with_energy or is_incompressible(material) else 0


def has_unsymmetric_pressure(kind: ContinuumType, material: Material) -> bool:
    """Return whether eliminating the pressure may leave an unsymmetric matrix, whatever the material's tangent is.

    The pressure is that of equal weights with user routines, which tell no bulk modulus.
    """
    by_routine = material.user is not None or isinstance(material.hyperelastic, UserPotential)
    return bool(kind.pressures) and by_routine and not pressure_unknowns(kind, material)


def check_hybrid(name: str, kind: ContinuumType, material: Material) -> None:
    """Raise DeckError if the material needs hybrid elements and these are none, or if it has what they cannot have."""
    user = material.user or (material.hyperelastic if isinstance(material.hyperelastic, UserPotential) else None)
    if user is not None and not kind.pressures and is_incompressible(material):
        umat = "*USER MATERIAL, HYBRID FORMULATION=INCOMPRESSIBLE"
        what = f"*{user.keyword}: USER without TYPE=COMPRESSIBLE" if isinstance(user, UserPotential) else umat
        message = f"is an incompressible material, which elements of type {name} cannot have; expected hybrid ones"
        raise DeckError(user.source, f"{what} {message}: {', '.join(HYBRID)}")
    if pressure_unknowns(kind, material) and (kind.incompatible or kind.coupled or kind.generalised):
        what = "incompressible materials"
        if not is_incompressible(material) and material.hyperelastic is not None:
            what = f"laws of *{material.hyperelastic.keyword} by coefficients"
        message = f"{what} (material {material.name}) are not supported for elements of type {name}"
        raise DeckError(material.source, message)
    if material.elastic is None or not (kind.pressures and is_incompressible(material)):
        return
    unsupported = {
        "*PLASTIC": material.plastic is not None,
        "*EXPANSION": bool(material.expansion),
        "dependence on temperature and fields": material.elastic.table is not None,
    }
    for what, given in unsupported.items():
        if given:
            message = f"nu = 0.5 is not supported with {what}; expected nu < 0.5"
            raise DeckError(material.elastic.source, f"*ELASTIC: {message}")
