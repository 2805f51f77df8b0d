# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Potentials of *HYPERELASTIC by coefficients as polynomials and sums of powers of stretches, as the host has them.

Formulas: Abaqus Analysis User's Guide, Hyperelastic behavior of rubberlike materials.
"""

from __future__ import annotations

from math import comb, inf
from typing import Final

import numpy as np

from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.properties import HIGHEST_ORDER, Hyperelastic, Potential
from uel.usersub import Library, _materials

MOST_BULK: Final = 100.0
"""Initial bulk modulus over the shear modulus, above which Abaqus wants hybrid elements (nu = 0.495)."""

CHAIN: Final = (1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750)
"""Coefficients of the powers of I1 over those of the locking stretch squared (E.M. Arruda, M.C. Boyce, Journal of the
Mechanics and Physics of Solids 41 (1993) 389), equation (13)."""


def define_hyperelastic(
    law: Hyperelastic, ntens: int, library: Library, *, hybrid: bool = False, long_term: float = 1.0
) -> int:
    """Define a hyperelastic material in the host, and return its number. Raises DeckError.

    hybrid: its elements are; long_term: the energy of the coefficients over the
    instantaneous one.
    """
    polynomial, ogden = _polynomial(law) / long_term, _ogden(law) / (long_term, 1.0)
    shear, bulk = initial_moduli(law)
    if not shear > 0:
        raise _error(law, f"the initial shear modulus {shear:g} must be positive")
    if bulk > MOST_BULK * shear and not hybrid:
        message = (
            f"the initial bulk modulus is {bulk / shear:g} times the shear modulus; Abaqus stops above {MOST_BULK:g}"
        )
        library.warn(f"{law.source}: *HYPERELASTIC: {message} with elements that are not hybrid")
    volumetric = np.zeros(HIGHEST_ORDER)
    volumetric[: len(law.compliances)] = [1 / (long_term * d) if d else 0.0 for d in law.compliances]
    ratio = shear / bulk
    moduli = 9 * shear / (3 + ratio) / long_term, (3 - 2 * ratio) / (6 + 2 * ratio)
    logarithmic = law.potential is Potential.ARRUDA_BOYCE
    return _materials.define_hyperelastic(ntens, polynomial, ogden, volumetric, logarithmic=logarithmic, moduli=moduli)


def initial_moduli(law: Hyperelastic) -> tuple[float, float]:
    """Return shear and bulk modulus of the undeformed material; the latter infinite if it is incompressible.

    Raises DeckError if a D is negative, or only the first one is zero.
    """
    first, *others = law.compliances
    if min(law.compliances) < 0:
        raise _error(law, f"D = {min(law.compliances):g} must not be negative")
    if first == 0 and any(others):
        raise _error(law, "D1 = 0 is an incompressible material; expected that the other D are zero too")
    polynomial = _polynomial(law)
    return float(2 * (polynomial[1, 0] + polynomial[0, 1]) + _ogden(law)[:, 0].sum()), 2 / first if first else inf


def _polynomial(law: Hyperelastic) -> FloatArray:
    """Return coefficients (i, j) of the powers of I1 - 3 and I2 - 3. Raises DeckError."""
    found = np.zeros((HIGHEST_ORDER + 1, HIGHEST_ORDER + 1))
    match law.potential:
        case Potential.OGDEN:
            pass
        case Potential.ARRUDA_BOYCE:
            mu, locking = law.coefficients
            if locking <= 0:
                raise _error(law, f"lambda_m = {locking:g} must be positive")
            for power, factor in enumerate(CHAIN, 1):
                # I1**power = (I1 - 3 + 3)**power
                for i in range(1, power + 1):
                    found[i, 0] += mu * factor / locking ** (2 * power - 2) * comb(power, i) * 3.0 ** (power - i)
        case Potential.POLYNOMIAL | Potential.MOONEY_RIVLIN:
            places = [(total - j, j) for total in range(1, law.order + 1) for j in range(total + 1)]
            for place, value in zip(places, law.coefficients, strict=True):
                found[place] = value
        case _:
            found[1 : law.order + 1, 0] = law.coefficients
    return found


def _ogden(law: Hyperelastic) -> FloatArray:
    """Return rows of mu and alpha; zeros for no term. Raises DeckError if an alpha is zero."""
    found = np.zeros((HIGHEST_ORDER, 2))
    if law.potential is Potential.OGDEN:
        found[: law.order] = np.reshape(law.coefficients, (law.order, 2))
        if (found[: law.order, 1] == 0).any():
            raise _error(law, "alpha = 0: expected another number")
    return found


def _error(law: Hyperelastic, message: str) -> DeckError:
    return DeckError(law.source, f"*HYPERELASTIC: {message}")
