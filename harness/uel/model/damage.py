# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damage of traction-separation responses, of materials and of contact properties."""

from __future__ import annotations

from dataclasses import dataclass

from uel.errors import Source


@dataclass(frozen=True, slots=True)
class DamageEvolution:
    """*DAMAGE EVOLUTION of a traction-separation response.

    type       'DISPLACEMENT' or 'ENERGY'
    softening  'LINEAR', 'EXPONENTIAL' or 'TABULAR'
    mixed_mode '' mode independent, 'BK' or 'POWER LAW'
    values     displacement from onset to failure and exponential law parameter; or the fracture energy; or those of the
               normal and both shear modes; or displacement after the onset and damage in turn
    power      POWER=
    """

    type: str
    softening: str
    mixed_mode: str
    values: tuple[float, ...]
    power: float
    source: Source


@dataclass(frozen=True, slots=True)
class Damage:
    """*DAMAGE INITIATION of a traction-separation response, with the keywords after it.

    criterion  'MAXS', 'QUADS', 'MAXE', 'QUADE', or in contact 'MAXU', 'QUADU'
    onset      nominal stresses, strains or separations at the onset: normal, first and second shear direction
    viscosity  of *DAMAGE STABILIZATION, time
    """

    criterion: str
    onset: tuple[float, float, float]
    source: Source
    evolution: DamageEvolution | None = None
    viscosity: float = 0.0
