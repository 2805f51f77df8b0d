# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tractions of the initial stress of solids on the interface elements that own them.

Abaqus passes no initial stress to a user element: INITIALS, INITIALN and INITIALT among its properties are the traction
of that of its solids. In equilibrium it is the same on both sides.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import Tensor
from uel.model.face_directions import face_directions
from uel.model.steps import InitialStress

NAMES: Final = ("INITIALS", "INITIALN", "INITIALT")
"""Properties of an element in space, along s, n and t."""
PLANE_NAMES: Final = ("INITIALT", "INITIALN")
"""Properties of an element in the plane, along t and n."""
_COMPONENTS: Final = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
_PLANE_STRESS: Final = ((0, 0), (1, 1), (0, 1))
"""Components in Abaqus' order."""


@dataclass(frozen=True, slots=True)
class InitialStresses:
    """Initial stresses of solids.

    tensors  (m, 3, 3) in the directions of *ORIENTATION
    source   place of the first entry that is not zero; None without any
    """

    tensors: FloatArray
    source: Source | None

    @classmethod
    def of(cls, entries: Iterable[InitialStress], elements: IntArray, tensor: Tensor | None) -> InitialStresses:
        """Return those of elements (m,), positions in the model, with a state of stress, by entries with components.

        The last entry that names an element counts. Those of SIGINI and GEOSTATIC are left out: `find_faults` refuses
        them beside elements that own their solids.
        """
        order = _PLANE_STRESS if tensor is Tensor.PLANE_STRESS else _COMPONENTS
        tensors, source = np.zeros((len(elements), 3, 3)), None
        for entry in entries:
            rows = np.isin(elements, entry.elements)
            if entry.values is None or not rows.any():
                continue
            stress = np.zeros((3, 3))
            for (i, j), value in zip(order, entry.values.tolist(), strict=False):
                stress[i, j] = stress[j, i] = value
            tensors[rows] = stress
            if source is None and stress.any():
                source = entry.source
        return cls(tensors, source)

    def tractions(self, axes: FloatArray, normals: FloatArray) -> FloatArray:
        """Return the tractions (m, 3) along x, y and z.

        Parameters
        ----------
        axes
            (m, 3, 3) directions of the stresses, in rows.
        normals
            (m, 3) unit normals of the interface, from below to above.
        """
        return np.asarray(np.einsum("mai,mab,mbj,mj->mi", axes, self.tensors, axes, normals))


def components(tractions: FloatArray, normals: FloatArray, directions: FloatArray | None) -> FloatArray:
    """Return tractions (m, 3) along x, y and z by the directions of interface elements.

    Parameters
    ----------
    tractions
        (m, 3) along x, y and z.
    normals
        (m, 3) unit normals, from below to above.
    directions
        (m, 3) reference directions for s in space, zero for x; None in the plane.

    Returns
    -------
    (m, 3) or (m, 2)
        Values of NAMES, in the plane of PLANE_NAMES.
    """
    if directions is None:
        along = np.stack([normals[:, 1], -normals[:, 0]], axis=1)
        return np.stack([np.sum(tractions[:, :2] * each, axis=1) for each in (along, normals[:, :2])], axis=1)
    s, t = face_directions(normals, directions)
    return np.stack([np.sum(tractions * each, axis=1) for each in (s, normals, t)], axis=1)
