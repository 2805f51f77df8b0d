# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact variables at nodes, for output."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uel.contact.block import ContactBlock
from uel.model.arrays import FloatArray


def nodal_fields(contacts: Sequence[ContactBlock], count: int) -> dict[str, FloatArray]:
    """Return contact variables (count,) by Abaqus name at the end of the increment; NaN at nodes without a point.

    A node of several pairs has those of the one where its clearance is smallest.
    """
    if not contacts:
        return {}
    nodes = np.concatenate([pair.secondary for pair in contacts])
    clearance, pressure = (np.concatenate([pair.output[k] for pair in contacts]) for k in range(2))
    # directions of friction: one in the plane
    shear = np.concatenate([np.pad(pair.output[2], ((0, 0), (0, 2)))[:, :2] for pair in contacts])
    order = np.argsort(-clearance, kind="stable")
    fields = {}
    for name, values in (
        ("COPEN", clearance),
        ("CPRESS", pressure),
        ("CSHEAR1", shear[:, 0]),
        ("CSHEAR2", shear[:, 1]),
    ):
        fields[name] = np.full(count, np.nan)
        fields[name][nodes[order]] = values[order]
    for pair in contacts:
        for name, values in pair.bonds.items():
            of_nodes = fields.setdefault(name, np.full(count, np.nan))
            of_nodes[pair.secondary] = np.fmax(of_nodes[pair.secondary], values)
    return fields
