# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Variables at the integration points of a group, from its SVARS."""

from __future__ import annotations

from uel.model.arrays import FloatArray
from uel.model.records import ElementState, PointVariables


def point_values(state: ElementState, variables: PointVariables) -> FloatArray:
    """Return the values (m, points, variables) of the elements of a group."""
    count = variables.points * len(variables.names)
    return state.svars[:, :count].reshape(len(state.svars), variables.points, len(variables.names))
