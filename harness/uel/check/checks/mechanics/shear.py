# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shear modulus of an otherwise isotropic element: engineering against tensor shear strains."""

from __future__ import annotations

from itertools import combinations, product
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.rigid_motions import Body, body_at_rest, uniform_strains
from uel.check.subject import Subject
from uel.model.arrays import FloatArray

MISTAKES: Final = 0.25, 0.5, 2.0, 4.0
"""Factors of the modulus if strains, stresses or both have a factor of 2 too many or too few."""

EQUAL: Final = 1e-6
"""Relative difference up to which moduli are equal."""


def check(subject: Subject) -> Finding:
    """Check that, with isotropic extension, shear does not differ by a factor of 2 or 4 from an isotropic material."""
    at_rest = body_at_rest(subject)
    if isinstance(at_rest, Finding):
        return at_rest
    state, body = at_rest
    planes = list(combinations(range(body.dimensions), 2))
    moduli = _moduli(subject, state, body)
    isotropic = _isotropic(moduli, body.dimensions)
    if not isotropic and not body.coincident and planes and (rows := _exchanged(moduli, body.dimensions, planes)):
        return failed(
            f"{state}: the stiffness is that of an isotropic material only if {rows} are exchanged",
            "Rows of the strain-displacement matrix and of the material's stiffness have to stand in the same order, "
            "in Abaqus 11, 22, 33, 12, 13, 23: compare which derivatives each row has.",
        )
    if body.coincident or not planes or not isotropic:
        return not_applicable(
            "extension is not the same in all directions: it is for elements with a volume and an isotropic material"
        )
    return _judge(state, isotropic, dict(zip(planes, np.diag(moduli)[body.dimensions :].tolist(), strict=True)))


def _isotropic(moduli: FloatArray, count: int) -> float:
    """Return the isotropic shear modulus from the extensions in the given number of directions; 0 if they differ."""
    normal = moduli[:count, :count]
    along, across = np.diag(normal), normal[~np.eye(count, dtype=np.bool_)]
    coupling = np.abs(moduli[:count, count:]).max(initial=0.0)
    size = float(np.abs(along).max())
    shear = 0.5 * float(along[0] - across.max(initial=0.0))
    alike = max(np.ptp(along), np.ptp(across) if len(across) else 0.0, coupling) <= EQUAL * size
    return shear if alike and shear > EQUAL * size else 0.0


def _judge(state: ElementState, isotropic: float, moduli: dict[tuple[int, int], float]) -> Finding:
    """Check the shear moduli in the coordinate planes."""
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


def _exchanged(moduli: FloatArray, count: int, planes: list[tuple[int, int]]) -> str:
    """Name a normal and a shear strain whose exchange makes the stiffness isotropic; '' if there are none.

    It has to be isotropic in shear, too: two anisotropic stiffnesses are not alike by chance.
    """
    for normal, plane in product(range(count), range(len(planes))):
        order = np.arange(len(moduli))
        order[[normal, count + plane]] = order[[count + plane, normal]]
        other = moduli[np.ix_(order, order)]
        shear = _isotropic(other, count)
        if shear and np.abs(np.diag(other)[count:] - shear).max() <= EQUAL * shear:
            return f"strain {normal + 1}{normal + 1} and shear strain {planes[plane][0] + 1}{planes[plane][1] + 1}"
    return ""


def _moduli(subject: Subject, state: ElementState, body: Body) -> FloatArray:
    """Return the work of unit strains, first normal and then engineering shear strains, on each other's forces."""
    matrix = subject.differences(state).matrix if state.dynamic else state.evaluate().amatrx
    strains = uniform_strains(body)
    return np.asarray(strains @ matrix @ strains.T)
