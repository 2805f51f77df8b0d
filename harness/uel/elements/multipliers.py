# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scale of Lagrange multipliers beside displacements."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray


def scale_of_multipliers(data: FloatArray, places: NDArray[np.int32], dimension: int) -> float:
    """Return the stiffness of the nodes that multipliers act on, as a power of two:
    as their scale it balances the matrix.

    Parameters
    ----------
    data
        (nnz,) CSR values of the stiffness.
    places
        (m, unknowns, unknowns) of the matrices of the points there; displacements of the node come first.
    dimension
        Displacements of a node.
    """
    own = np.arange(dimension)
    largest = float(np.abs(data[places[:, own, own]]).max())
    return 2.0 ** round(math.log2(largest)) if largest > 0.0 else 1.0
