# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hyperelastic materials with preferred directions (fortran/host/materials/anisotropic.f90)."""

from __future__ import annotations

import numpy as np

from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.properties import Holzapfel, Orientation, UserPotential
from uel.usersub import _materials


def define_holzapfel(law: Holzapfel, orientation: Orientation | None, ntens: int) -> int:
    """Define a material of Holzapfel, Gasser and Ogden in the host, and return its number. Raises DeckError."""
    c10, compliance, *fibres = law.coefficients
    return _materials.define_anisotropic(ntens, _directions(law, orientation), (c10, *fibres), compliance)


def define_user_invariants(
    law: UserPotential, orientation: Orientation | None, name: str, ntens: int, statev: int, address: int
) -> int:
    """Define a material of UANISOHYPER_INV in the host, and return its number. Raises DeckError."""
    number = _materials.define_anisotropic(ntens, _directions(law, orientation), (0.0, 0.0, 0.0, 0.0), 0.0)
    _materials.set_user_invariants(number, address, name, statev, law.constants)
    return number


def _directions(law: Holzapfel | UserPotential, orientation: Orientation | None) -> FloatArray:
    """Return (m, 3) preferred directions in the axes of the material: those of its orientation, or the axes.
    Raises DeckError.
    """
    count = law.directions or 0
    given = np.zeros((0, 3)) if orientation is None else orientation.local
    if not len(given):
        return np.eye(3)[:count]
    if len(given) < count:
        assert orientation is not None
        message = (
            f"LOCAL DIRECTIONS={count}, but *ORIENTATION {orientation.name} ({orientation.source}) has {len(given)}"
        )
        raise DeckError(law.source, f"*{law.keyword}: {message}")
    return given[:count]
