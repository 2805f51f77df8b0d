# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The shear modulus of an element that is isotropic otherwise: engineering shear strains against tensor ones."""

from __future__ import annotations

from itertools import combinations
from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.motions import Body, body_at_rest
from harness.check.state import ElementState
from harness.check.subject import Subject
from harness.model.arrays import FloatArray

MISTAKES: Final = 0.25, 0.5, 2.0, 4.0
"""What a factor 2 too much, or too few, in strains, stresses or both makes of the modulus."""

EQUAL: Final = 1e-6
"""Relative difference up to which moduli are equal."""


def check(subject: Subject) -> Finding:
    """Where extensions in all directions are alike, shear is not a factor of 2 or 4 away from an isotropic material."""
    found = body_at_rest(subject)
    if isinstance(found, Finding):
        return found
    state, body = found
    planes = list(combinations(range(body.dimensions), 2))
    moduli = _moduli(subject, state, body, planes)
    isotropic = _isotropic(moduli, body.dimensions)
    if body.coincident or not planes or not isotropic:
        return not_applicable(
            "not extended in all directions alike: it is for elements with a volume and an isotropic material"
        )
    return _judge(state, isotropic, dict(zip(planes, np.diag(moduli)[body.dimensions :].tolist(), strict=True)))


def _isotropic(moduli: FloatArray, count: int) -> float:
    """Shear modulus that goes with the extensions in so many directions; 0 where these are not alike."""
    normal = moduli[:count, :count]
    along, across = np.diag(normal), normal[~np.eye(count, dtype=np.bool_)]
    coupling = np.abs(moduli[:count, count:]).max(initial=0.0)
    size = float(np.abs(along).max())
    shear = 0.5 * float(along[0] - across.max(initial=0.0))
    alike = max(np.ptp(along), np.ptp(across) if len(across) else 0.0, coupling) <= EQUAL * size
    return shear if alike and shear > EQUAL * size else 0.0


def _judge(state: ElementState, isotropic: float, moduli: dict[tuple[int, int], float]) -> Finding:
    """Finding for the shear moduli in the planes of two directions."""
    for (i, j), modulus in moduli.items():
        for factor in MISTAKES:
            if abs(modulus - factor * isotropic) <= EQUAL * isotropic:
                return failed(
                    f"{state}: shear in directions {i + 1} and {j + 1} is resisted {factor:g} times as much as an "
                    "isotropic material with these extensions resists it",
                    "Engineering shear strain is du/dy + dv/dx, twice that of the tensor, and goes with "
                    "G = E/(2 + 2 nu): look at the shear row of the strain-displacement matrix, at the shear modulus, "
                    "and whether stress and AMATRX take the same strain.",
                    figure=factor,
                    limit=1.0,
                )
    return passed("shear and extensions are not a factor of 2 or 4 away from an isotropic material")


def _moduli(subject: Subject, state: ElementState, body: Body, planes: list[tuple[int, int]]) -> FloatArray:
    """Work of unit strains, the normal ones and then the engineering shears, on the forces of each other."""
    matrix = subject.differences(state).matrix if state.dynamic else state.evaluate().amatrx
    fields = []
    for i, j in [(i, i) for i in range(body.dimensions)] + planes:
        field = np.zeros(len(body.axis))
        # half of each: without rotation
        for row, column in ((i, j), (j, i)):
            moved = body.displacement & (body.axis == row)
            field[moved] += 0.5 * body.points[body.local[moved], column]
        fields.append(field)
    strains = np.array(fields)
    work: FloatArray = strains @ matrix @ strains.T
    return work
