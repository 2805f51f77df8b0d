# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface element types, and their connectivity between two solids.

The types are those of the tables of built-in elements and of the kernels. A standard element has the nodes of both
faces; an element that owns both solids has all their nodes, each solid permuted so that its face is as in the table.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from uel.insertion.cut import NONE, Cells, Solids
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import COHESIVE, FAMILIES, Face, Family
from uel.usersub.layout import element_layouts


@dataclass(frozen=True, slots=True)
class InterfaceType:
    """Interface element type.

    jtype   n of a user element Un of the project; 0 for an element of Abaqus
    face    family of its faces
    nodes   number of nodes
    bottom  local nodes of its bottom face, from 0: corners, then midside nodes; `top`: opposite nodes
    solids  families of the solids below and above that it owns; () for a standard element
    """

    name: str
    jtype: int
    face: Family
    nodes: int
    bottom: Face
    top: Face
    solids: tuple[Family, ...] = ()

    @property
    def dimension(self) -> int:
        """Dimension, 2 or 3."""
        return self.face.dimension + 1


@cache
def known_types() -> dict[str, InterfaceType]:
    """Return the interface elements by their names."""
    types = {
        name: InterfaceType(name, 0, kind.face, kind.nodes, kind.bottom, kind.top) for name, kind in COHESIVE.items()
    }
    for jtype, layout in element_layouts().items():
        bottom, top = layout.faces
        if bottom:
            face = FAMILIES[layout.dimension - 1, len(bottom)]
            solids = tuple(FAMILIES[layout.dimension, nodes] for nodes in layout.solids)
            types[f"U{jtype}"] = InterfaceType(f"U{jtype}", jtype, face, layout.nodes, bottom, top, solids)
    return types


@cache
def interface_types() -> dict[str, InterfaceType]:
    """Return the types that can be inserted: all but U3 and U10, whose properties are element numbers."""
    layouts = element_layouts()
    return {
        name: kind
        for name, kind in known_types().items()
        if not kind.jtype or all(item.name != "OFFSETBOTTOM" for item in layouts[kind.jtype].integers)
    }


def recommended(face: Family, below: Family, above: Family) -> InterfaceType:
    """Return the recommended type between two solids with this face; a standard element fits any."""
    types = [
        kind
        for kind in interface_types().values()
        if kind.face is face and (not kind.solids or kind.solids == (below, above))
    ]
    # stabilised elements, then standard ones of the project, then those of Abaqus
    return min(types, key=lambda kind: (not kind.solids, not kind.jtype))


def face_nodes(solids: Solids, faces: IntArray) -> IntArray:
    """Return the nodes of faces of one family, (faces, nodes): corners, with the outward normal, then midside nodes.

    In the plane, the normal of an edge is its direction rotated by 90 degrees, counter-clockwise; in space, corners are
    counter-clockwise seen from outside.
    """
    size, corners = int(solids.sizes[faces[0]]), int(solids.corners[faces[0]])
    nodes = solids.nodes[faces, :size]
    points = solids.points[nodes[:, :corners]]
    outward = points.mean(axis=1) - solids.centroids[solids.element[faces]]
    inward = np.sum(face_normals(points) * outward, axis=1) < 0.0
    back = list(range(corners - 1, -1, -1))
    # a midside node is on the edge from its corner to the next one
    middles = [corners + (corner - 1) % corners for corner in back] if corners > 2 else [2]
    order = back + middles if size > corners else back
    return np.where(inward[:, None], nodes[:, order], nodes)


def face_normals(corners: FloatArray) -> FloatArray:
    """Return unit normals (faces, 3) of faces with these corners, (faces, corners, 3), in the order of `face_nodes`."""
    count = corners.shape[1]
    if count == 2:
        along = corners[:, 1] - corners[:, 0]
        normal = np.stack([-along[:, 1], along[:, 0], np.zeros(len(along))], axis=1)
    else:
        # diagonals of a quadrilateral, edges of a triangle
        normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, count - 1] - corners[:, 1])
        normal = normal if count == 4 else np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])


def element_nodes(
    kind: InterfaceType, solids: Solids, faces: IntArray, opposite: IntArray, after: Mapping[int, Cells]
) -> IntArray:
    """Return the connectivity of interface elements, (faces, nodes of the type), after the cut.

    Parameters
    ----------
    kind
        Their type.
    solids
        Solids before the cut.
    faces, opposite
        Faces of the solids below and above.
    after
        Cells after the cut, by family number.
    """
    below, above = solids.element[faces], solids.element[opposite]
    along = face_nodes(solids, faces)
    connectivity = np.full((len(faces), kind.nodes), NONE)
    for upper, (number, face_nodes_of) in enumerate(((below, kind.bottom), (above, kind.top))):
        old, new = _rows(solids, after, number)
        local = _local(old, along)
        if not kind.solids:
            connectivity[:, list(face_nodes_of)] = np.take_along_axis(new, local, axis=1)
        else:
            start, family = kind.solids[0].nodes if upper else 0, kind.solids[upper]
            order = _permutation(family, local, tuple(node - start for node in face_nodes_of))
            connectivity[:, start : start + family.nodes] = np.take_along_axis(new, order, axis=1)
    return connectivity


def attached(
    kind: InterfaceType, solids: Solids, nodes: IntArray, after: Mapping[int, Cells]
) -> tuple[IntArray, NDArray[np.bool_]]:
    """Return the new connectivity of existing interface elements, and the mask of those not between solids.

    nodes: (elements, nodes of the type) before the cut.
    """
    connectivity, lost = nodes.copy(), np.zeros(len(nodes), dtype=bool)
    for upper, face_nodes_of in enumerate((kind.bottom, kind.top)):
        corners = [node for node, _ in zip(face_nodes_of, range(kind.face.corners), strict=False)]
        faces = solids.faces_at(nodes[:, corners])
        lost |= faces == NONE
        rows = np.flatnonzero(faces != NONE)
        old, new = _rows(solids, after, solids.element[faces[rows]])
        columns = np.array(face_nodes_of)
        if kind.solids:
            columns = (kind.solids[0].nodes if upper else 0) + np.arange(kind.solids[upper].nodes)
        local = _local(old, nodes[np.ix_(rows, columns)])
        connectivity[np.ix_(rows, columns)] = np.take_along_axis(new, local, axis=1)
    return connectivity, lost


def beside(solids: Solids, faces: IntArray, nodes: IntArray, after: Mapping[int, Cells]) -> IntArray:
    """Return the new connectivity of elements on faces (elements,) of solids; nodes: (elements, k) before the cut."""
    old, new = _rows(solids, after, solids.element[faces])
    return np.take_along_axis(new, _local(old, nodes), axis=1)


def _rows(solids: Solids, after: Mapping[int, Cells], numbers: IntArray) -> tuple[IntArray, IntArray]:
    """Return the nodes of solids before and after the cut, padded with -1."""
    widest = max(group.nodes.shape[1] for group in solids.cells)
    old, new = np.full((2, len(numbers), widest), NONE)
    for group in solids.cells:
        rows = np.flatnonzero(solids.families[numbers] == group.family.number)
        where = np.searchsorted(group.numbers, numbers[rows])
        old[rows, : group.nodes.shape[1]] = group.nodes[where]
        new[rows, : group.nodes.shape[1]] = after[group.family.number].nodes[where]
    return old, new


def _local(rows: IntArray, nodes: IntArray) -> IntArray:
    """Return the column of each node in its row."""
    return np.stack([np.argmax(rows == column[:, None], axis=1) for column in nodes.T], axis=1)


def _permutation(family: Family, local: IntArray, targets: Face) -> IntArray:
    """Return the permutation of the nodes of solids that moves a face, local (faces, nodes), to the targets."""
    middles, beside = _edges(family)
    corners = sum(node < family.corners for node in targets)
    face = local[:, :corners]
    order = np.full((len(local), family.nodes), NONE)
    for k, target in enumerate(targets[:corners]):
        order[:, target] = face[:, k]
        # the adjacent corner that is not on the face
        near = np.array(beside)[face[:, k]]
        on_face = np.any(near[:, :, None] == face[:, None, :], axis=2)
        opposite = next(node for node in beside[target] if node not in targets)
        order[:, opposite] = near[np.arange(len(near)), np.argmin(on_face, axis=1)]
    for a in range(family.corners):
        for b in beside[a]:
            if middles[a, b] != NONE:
                order[:, middles[a, b]] = middles[order[:, a], order[:, b]]
    return order


@cache
def _edges(family: Family) -> tuple[IntArray, list[list[int]]]:
    """Return the midside node between two corners, -1 without one, and the adjacent corners of each corner."""
    middles = np.full((family.corners, family.corners), NONE)
    beside: list[set[int]] = [set() for _ in range(family.corners)]
    for face in family.faces:
        count = sum(node < family.corners for node in face)
        for k in range(count if count > 2 else 1):
            a, b = face[k], face[(k + 1) % count]
            beside[a].add(b)
            beside[b].add(a)
            if len(face) > count:
                middles[a, b] = middles[b, a] = face[count + k]
    return middles, [sorted(near) for near in beside]
