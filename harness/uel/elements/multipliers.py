# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scaling of Lagrange multipliers to the stiffness of the nodes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray


def scale_of_multipliers(data: FloatArray, scatter: NDArray[np.int32], dimension: int) -> float:
    """Return the scale of multipliers that balances the matrix: the largest stiffness of their nodes, as a power of 2.

    Parameters
    ----------
    data
        (nnz,) CSR values of the stiffness.
    scatter
        (m, unknowns, unknowns) positions in it of the matrices of the points; displacements of the node come first.
    dimension
        Number of displacements of a node.
    """
    own = np.arange(dimension)
    largest = float(np.abs(data[scatter[:, own, own]]).max())
    return 2.0 ** round(math.log2(largest)) if largest > 0.0 else 1.0
