# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes and elements of the flattened model: parts are instanced, labels are kept for messages and output."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import BUILT_IN, BeamType, BuiltInType, ContinuumType, SurfaceType
from uel.model.properties import Section, SolidSection, UserElement


@dataclass(frozen=True, slots=True)
class Mesh:
    """Nodes, ordered by instance, then by label.

    labels      (n,) numbers as in the deck; unique within an instance
    coordinates (n, 3) original coordinates
    instances   (n,) name of the instance of each node, '' where the deck has none
    normals     (n, 3) normals of the deck, of any length; zero at nodes without one, None if no node has any
    """

    labels: IntArray
    coordinates: FloatArray
    instances: tuple[str, ...]
    normals: FloatArray | None = None

    def name(self, node: int) -> str:
        """Return the name of a node as Abaqus prints it: its label, or INSTANCE.label."""
        return full_name(self.instances[node], int(self.labels[node]))


def full_name(instance: str, label: int) -> str:
    """Return the name of a node or element: its label, or INSTANCE.label."""
    return f"{instance}.{label}" if instance else str(label)


@dataclass(frozen=True, slots=True)
class ElementGroup:
    """A run of like elements: one type, one section, consecutive in the calling order of Abaqus.

    Walking the groups in order, and each group in order, visits all elements by instance and ascending number
    (the order in which Abaqus calls user elements on one thread).

    type       'U3', 'CPS4'
    labels     (m,) element numbers, ascending
    nodes      (m, nodes per element) node indices into Mesh, from 0
    definition the *USER ELEMENT, None for a built-in element
    n2         (m, nodes per element, 3) unit normals of beams in space at their nodes, None: those that the approximate
               n1 of their section gives
    orienting  (m,) index of the additional node of beams in space, which lies along the approximate n1 from the first
               one, -1 without one; None if none has it
    """

    type: str
    labels: IntArray
    nodes: IntArray
    instance: str
    section: Section
    definition: UserElement | None
    source: Source
    n2: FloatArray | None = None
    orienting: IntArray | None = None

    def take(self, rows: IntArray) -> ElementGroup:
        """Return a group of some of its elements, by their rows."""
        n2 = None if self.n2 is None else self.n2[rows]
        orienting = None if self.orienting is None else self.orienting[rows]
        return replace(self, labels=self.labels[rows], nodes=self.nodes[rows], n2=n2, orienting=orienting)

    @property
    def built_in(self) -> BuiltInType | None:
        """The type in the table of built-in elements; None for user elements, and for a name that is not in it."""
        return None if self.definition else BUILT_IN.get(self.type)

    @property
    def reference(self) -> int:
        """Index of the reference node of its section, which has unknowns of all its elements; -1 without one."""
        return self.section.reference if isinstance(self.section, SolidSection) else -1

    @property
    def electrical(self) -> bool:
        """Whether its elements are piezoelectric."""
        kind = self.built_in
        return isinstance(kind, ContinuumType) and kind.electrical


def is_in_space(coordinates: FloatArray, groups: Iterable[ElementGroup]) -> bool:
    """Return False if all nodes are in one plane z = constant, and no shells,
    membranes or beams in space can leave it.
    """
    if np.ptp(coordinates[:, 2]) > 0.0:
        return True
    kinds = (group.built_in for group in groups)
    return any(isinstance(kind, SurfaceType | BeamType) and kind.dimension == 3 for kind in kinds)
