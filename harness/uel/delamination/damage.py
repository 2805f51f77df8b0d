# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Conversion between the damage variables of the elements.

The standard and the paper's element and COH2D4 write d of (9), the loss of the initial stiffness alpha: with the secant
stiffness K of traction over separation, d = 1 - K/alpha. With an infinite alpha, d = 1 from the onset on. The
consistent element therefore writes D = (1 - K/alpha) k/(K + k), with the softening stiffness k of mode I: the
dissipated fraction of the toughness. K is the same in both, so that with q = k/alpha

    d = D (1 + q)/(D + q),    D = d q/(1 + q - d).
"""

from __future__ import annotations

import numpy as np

from uel.delamination.materials import Cohesive
from uel.model.arrays import FloatArray


def stiffness_lost(spent: FloatArray, law: Cohesive) -> FloatArray:
    """Compute d of (9) from D (n,); for an infinite stiffness, written 0, its limit: 1 wherever D is above 0."""
    ratio = softening_ratio(law)
    return np.asarray(np.divide(spent * (1.0 + ratio), spent + ratio, out=np.zeros_like(spent), where=spent > 0.0))


def toughness_spent(lost: FloatArray, law: Cohesive) -> FloatArray:
    """Compute D from d of (9) (n,), of a law of finite stiffness."""
    ratio = softening_ratio(law)
    return np.asarray(lost * ratio / (1.0 + ratio - lost))


def softening_ratio(law: Cohesive) -> float:
    """Return k/alpha of mode I: softening stiffness over initial stiffness; 0 for an infinite stiffness."""
    if law.stiffness_normal == 0.0:
        return 0.0
    return 1.0 / (2.0 * law.toughness_1 * law.stiffness_normal / law.strength_normal**2 - 1.0)
