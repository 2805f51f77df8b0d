# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shape functions of lines, triangles and quadrilaterals by their corners."""

from __future__ import annotations

import numpy as np

from uel.model.arrays import FloatArray


def shape_functions(natural: FloatArray, count: int) -> FloatArray:
    """Evaluate the shape functions (..., corners) of lines, triangles or quadrilaterals."""
    if count == 2:
        return 0.5 * np.stack([1 - natural[..., 0], 1 + natural[..., 0]], axis=-1)
    x, y = natural[..., 0], natural[..., 1]
    if count == 3:
        return np.stack([1 - x - y, x, y], axis=-1)
    return 0.25 * np.stack([(1 - x) * (1 - y), (1 + x) * (1 - y), (1 + x) * (1 + y), (1 - x) * (1 + y)], axis=-1)


def natural_gradients(natural: FloatArray, count: int) -> FloatArray:
    """Evaluate the derivatives (..., corners, 1 or 2) of the shape functions by the natural coordinates."""
    if count == 2:
        return np.broadcast_to(np.array([[-0.5], [0.5]]), (*natural.shape[:-1], 2, 1))
    if count == 3:
        return np.broadcast_to(np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]), (*natural.shape[:-1], 3, 2))
    x, y = natural[..., 0], natural[..., 1]
    by_x = 0.25 * np.stack([-(1 - y), 1 - y, 1 + y, -(1 + y)], axis=-1)
    by_y = 0.25 * np.stack([-(1 - x), -(1 + x), 1 + x, 1 - x], axis=-1)
    return np.stack([by_x, by_y], axis=-1)
