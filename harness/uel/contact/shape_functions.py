# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shape functions of the faces of main surfaces, as polynomials of natural coordinates."""

from __future__ import annotations

import numpy as np

from uel.model.arrays import FloatArray
from uel.usersub._contact import monomials


def weights_of(shapes: FloatArray, natural: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Evaluate N (m, k) of coefficients (m, k, p), and their derivatives (m, k, a)."""
    values, first, _ = monomials(natural, shapes.shape[2])
    return np.einsum("mkp,mp->mk", shapes, values), np.einsum("mkp,mpa->mka", shapes, first)


__all__ = ["monomials", "weights_of"]
