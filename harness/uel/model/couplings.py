# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DISTRIBUTING in large displacements: the coupled nodes, and the errors of the constraints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray

COUPLING: Final = "coupling"
"""Name of the field of the forces that distributing couplings pass on, and of the check of their constraints."""


@dataclass(frozen=True, slots=True)
class Distributing:
    """A reference node whose forces and moments are spread over other nodes.

    reference  node
    nodes      (n,) coupled ones
    weights    (n,) of them; their sum is one
    dimension  displacements of a node: 2 or 3
    """

    reference: int
    nodes: IntArray
    weights: FloatArray
    dimension: int
    source: Source


@dataclass(frozen=True, slots=True)
class CouplingErrors:
    """Largest errors of the constraints of distributing couplings, and the reference nodes that have them.

    displacement  of the reference node over the characteristic length of its coupling
    rotation      of the reference node (radians)
    """

    displacement: tuple[float, int]
    rotation: tuple[float, int]
