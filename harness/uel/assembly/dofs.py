# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbering of the unknowns by node and dof."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from uel.elements import REFERENCE, Contributor, field_of
from uel.model.arrays import ComplexArray, FloatArray, IntArray
from uel.model.dofs import COUPLED, MULTIPLIER, PRESSURE, dof_in_deck, is_local
from uel.model.mesh import Mesh
from uel.model.model import Equation

Forces = TypeVar("Forces", FloatArray, ComplexArray)


@dataclass(frozen=True, slots=True)
class DofMap:
    """Unknowns of a model, ordered by node, then by dof; those of elements, contact points and couplings come last.

    node   (n,) node index of each unknown; the items of the contributors are numbered after the nodes
    dof    (n,) its dof, as Abaqus numbers them (1-3 displacements, ...)
    field  (n,) its field, index into FIELD_NAMES
    coordinates  (n, 3) original coordinates of its node, or of the centre of its element
    """

    mesh: Mesh
    node: IntArray
    dof: IntArray
    field: IntArray
    coordinates: FloatArray
    _keys: IntArray
    _base: int
    _elements: dict[int, str]
    _local: tuple[IntArray, IntArray, FloatArray]

    @classmethod
    def build(cls, mesh: Mesh, contributors: Iterable[Contributor], equations: Sequence[Equation] = ()) -> Self:
        """Collect the unknowns of the contributors, and of *EQUATION.

        Reference nodes need not belong to an element.
        """
        nodes = [np.zeros(0, dtype=np.int64)]
        dofs = [np.zeros(0, dtype=np.int64)]
        elements: dict[int, str] = {}
        centres: dict[int, FloatArray] = {}
        for contributor in contributors:
            for local, dof in contributor.unknowns:
                used = np.unique(_positions(mesh, contributor, local))
                nodes.append(used)
                dofs.append(np.full(len(used), dof))
            if any(dof >= PRESSURE for _, dof in contributor.unknowns):
                own = _positions(mesh, contributor, contributor.nodes.shape[1]).tolist()
                elements |= dict(zip(own, contributor.names, strict=True))
                centres |= dict(zip(own, mesh.coordinates[contributor.nodes].mean(axis=1), strict=True))
        terms = np.array([(node, dof) for equation in equations for node, dof, _ in equation.terms], dtype=np.int64)
        nodes.append(terms.reshape(-1, 2)[:, 0])
        dofs.append(terms.reshape(-1, 2)[:, 1])
        all_dofs = np.concatenate(dofs)
        base = int(all_dofs.max(initial=0)) + 1
        keys = np.unique(np.concatenate(nodes) * base + all_dofs)
        fields = np.array([field_of(dof) for dof in range(base)])
        owners, numbers = keys // base, keys % base
        # unknowns of elements come last
        last = np.searchsorted(owners, len(mesh.labels))
        others = [centres[owner] for owner in owners[last:].tolist()]
        coordinates = np.vstack([mesh.coordinates[owners[:last]], *others])
        rotated = [equation.terms for equation in equations if is_local(equation.terms[0][1])]
        pairs = [(first[0] * base + first[1], node * base + dof) for first, *terms in rotated for node, dof, _ in terms]
        along, into = np.searchsorted(keys, np.array(pairs, dtype=np.int64).reshape(-1, 2).T)
        in_global = along, into, np.array([-cosine for _, *terms in rotated for _, _, cosine in terms])
        return cls(mesh, owners, numbers, fields[numbers], coordinates, keys, base, elements, in_global)

    def __len__(self) -> int:
        return len(self.node)

    @property
    def of_nodes(self) -> NDArray[np.bool_]:
        """Mask (n,) of the unknowns of nodes, as opposed to those of elements, contact points and couplings."""
        mask: NDArray[np.bool_] = self.node < len(self.mesh.labels)
        return mask

    def find(self, nodes: IntArray | int, dof: IntArray | int) -> IntArray:
        """Return the unknowns of (node, dof) pairs.

        Parameters
        ----------
        nodes, dof
            Indices of nodes in the mesh, from 0, and dofs as Abaqus numbers them; broadcast against each other.

        Returns
        -------
        IntArray
            Numbers from 0, of the shape to which the arguments broadcast; -1 where no element or equation uses the dof.
        """
        keys = np.asarray(nodes, dtype=np.int64) * self._base + dof
        if not len(self._keys):
            return np.full(keys.shape, -1)
        numbers = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        known = (self._keys[numbers] == keys) & (np.asarray(dof) < self._base)
        return np.asarray(np.where(known, numbers, -1), dtype=np.int64)

    def equations_of(self, contributor: Contributor) -> NDArray[np.int32]:
        """Return the unknowns of each item of a contributor.

        Parameters
        ----------
        contributor
            One of those from which the map was built, with all or some of its items.

        Returns
        -------
        NDArray[np.int32]
            (m, unknowns) numbers from 0; a row has the order of `contributor.unknowns`.
        """
        columns = [self.find(_positions(self.mesh, contributor, local), dof) for local, dof in contributor.unknowns]
        return np.stack(columns, axis=1).astype(np.int32)

    def element(self, unknown: int) -> str:
        """Return the name of the element that owns an unknown, '' for an unknown of a node."""
        return self._elements.get(int(self.node[unknown]), "")

    def name(self, unknown: int) -> tuple[str, int]:
        """Return node name and dof of an unknown, for messages; or the element or contact point that owns it."""
        if (number := int(self.dof[unknown]) - COUPLED) >= 0:
            return f"{self.element(unknown)}, forces of its distributing coupling", number + 1
        if int(self.dof[unknown]) == MULTIPLIER:
            return f"{self.element(unknown)}, contact pressure", 1
        if element := self.element(unknown):
            return f"of element {element}, pressure", int(self.dof[unknown]) - PRESSURE + 1
        return self.mesh.name(int(self.node[unknown])), dof_in_deck(int(self.dof[unknown]))

    def in_global(self, forces: Forces) -> Forces:
        """Return forces (n,) with those in directions of *TRANSFORM added to the global components of their nodes."""
        along, into, cosines = self._local
        if not len(along):
            return forces
        total = forces.copy()
        np.add.at(total, into, cosines * forces[along])
        return total


def _positions(mesh: Mesh, contributor: Contributor, local: int) -> IntArray:
    """Return the nodes (m,) with a local number, or the reference node.

    The local number after the last node stands for the item itself, which is numbered after all nodes.
    """
    nodes = contributor.nodes
    if local == REFERENCE:
        return np.full(len(nodes), contributor.reference)
    if local < nodes.shape[1]:
        return nodes[:, local]
    positions: IntArray = len(mesh.labels) + contributor.first + contributor.rows
    return positions
