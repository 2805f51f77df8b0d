# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hybrid elements: which of their materials make the pressure an unknown of the system.

The pressure of hyperelastic and of incompressible materials is an unknown (host/elements/solid/hybrid.f90). That of
others, which have a finite bulk modulus, follows from the mean stresses of the points of the element: it is eliminated.
Elements with further unknowns of their own have only that: incompatible modes, temperatures or bounding planes.
"""

from __future__ import annotations

from uel.elements.materials.library import is_incompressible
from uel.model.element_types import ContinuumType
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
