# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The shear modulus of an otherwise isotropic element: engineering shear strains against tensor ones."""

from __future__ import annotations

from itertools import combinations
from typing import Final

import numpy as np

from harness.check.finding import Finding, failed, not_applicable, passed
from harness.check.rigid_motions import Body, body_at_rest
from harness.check.state import ElementState
from harness.check.subject import Subject
from harness.model.arrays import FloatArray

MISTAKES: Final = 0.25, 0.5, 2.0, 4.0
"""Factors of the modulus if strains, stresses or both have a factor of 2 too many or too few."""

EQUAL: Final = 1e-6
"""Relative difference up to which moduli are equal."""


def check(subject: Subject) -> Finding:
    """If extension is the same in all directions, shear is not a factor of 2 or 4 off an isotropic material."""
    found = body_at_rest(subject)
    if isinstance(found, Finding):
        return found
    state, body = found
    planes = list(combinations(range(body.dimensions), 2))
    moduli = _moduli(subject, state, body, planes)
    isotropic = _isotropic(moduli, body.dimensions)
    if body.coincident or not planes or not isotropic:
        return not_applicable(
            "extension is not the same in all directions: it is for elements with a volume and an isotropic material"
        )
    return _judge(state, isotropic, dict(zip(planes, np.diag(moduli)[body.dimensions :].tolist(), strict=True)))


def _isotropic(moduli: FloatArray, count: int) -> float:
    """Isotropic shear modulus from the extensions in this number of directions; 0 if these differ."""
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
                    f"{state}: the shear stiffness in directions {i + 1} and {j + 1} is {factor:g} times that of an "
                    "isotropic material with the same stiffness in extension",
                    "Engineering shear strain is du/dy + dv/dx, twice the tensor component, and goes with "
                    "G = E/(2 + 2 nu): check the shear row of the strain-displacement matrix, the shear modulus, "
                    "and whether stress and AMATRX use the same strain.",
                    figure=factor,
                    limit=1.0,
                )
    return passed("shear and extension are not a factor of 2 or 4 off an isotropic material")


def _moduli(subject: Subject, state: ElementState, body: Body, planes: list[tuple[int, int]]) -> FloatArray:
    """Work of unit strains, first normal and then engineering shear strains, on each other's forces."""
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
