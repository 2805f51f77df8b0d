# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of interface elements in space, and values at their nodes from those at the integration points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import meshio
import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.face_directions import face_directions
from uel.model.face_shapes import natural_gradients, shape_functions
from uel.output.files.interface import DIRECTIONS
from uel.output.pictures.interface_parts import occurrences, parts
from uel.output.pictures.triangles import TriangulatedSurface

CORNERS: Final = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4}
"""Corners of the faces of interface elements, by their cell."""
_NATURAL: Final = {
    3: np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    4: np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
}
"""Natural coordinates of the corners."""
OCCURRENCES: Final = 2**20
"""Most elements of one label."""
_STEPS: Final = 8
"""Iterations of Newton's method for natural coordinates; two suffice in parallelograms."""


@dataclass(frozen=True, slots=True)
class Faces:
    """Faces of one shape.

    corners   3 or 4
    nodes     (m, k) nodes, the corners first, then those between them
    elements  (m,) keys of the elements: OCCURRENCES times the label, and how many before have the same one, as those of
              instances do
    """

    corners: int
    nodes: IntArray
    elements: IntArray


class Fields:
    """Fields at the nodes of a surface, and behind them at the middles of its faces.

    damage   (n,) SPENT, or DAMAGE if an element has no SPENT
    normals  (n, 2) traction and separation in the direction of the normal
    shears   (n, 2, 3) traction and separation in the surface, in global components
    """

    def __init__(self, values: FloatArray) -> None:
        self.damage = np.clip(values[:, 0], 0.0, 1.0)
        self.normals = values[:, 1:3]
        self.shears = values[:, 3:].reshape(-1, 2, 3)


class InterfaceSurface:
    """Interface elements that share nodes, as triangles.

    Parameters
    ----------
    points
        (n, 3) coordinates of the nodes of the model.
    faces
        Faces of the elements.

    Attributes
    ----------
    size
        Length of a typical edge: squares, or halves of squares, with that edge have the median area of the faces.
    triangles
        The surface, with a node in the middle of each face: so they prefer no diagonal.
    """

    def __init__(self, points: FloatArray, faces: Sequence[Faces]) -> None:
        if len({each.nodes.shape[1] == each.corners for each in faces}) > 1:
            # nodes between corners would lie on edges without them
            faces = [replace(each, nodes=each.nodes[:, : each.corners]) for each in faces]
        self._used = np.unique(np.concatenate([each.nodes.ravel() for each in faces]))
        self._points = points[self._used]
        nodes, triangles, sizes, self._faces = [self._points], [], [], []
        start = len(self._used)
        for each in faces:
            cells, corners = np.searchsorted(self._used, each.nodes), each.corners
            middles = start + np.arange(len(cells))
            # around the face: each corner, then the node between it and the next one
            around = np.moveaxis(cells.reshape(len(cells), -1, corners), 1, 2).reshape(len(cells), -1)
            after = np.roll(around, -1, axis=1)
            triangles += [np.column_stack([a, b, middles]) for a, b in zip(around.T, after.T, strict=True)]
            nodes.append(_middles(self._points[cells], corners))
            ends = self._points[cells[:, :corners]]
            areas = 0.5 * np.cross(ends, np.roll(ends, -1, axis=1)).sum(axis=1)
            sizes.append(np.sqrt(np.linalg.norm(areas, axis=1) * (2.0 if corners == 3 else 1.0)))
            self._faces.append(Faces(corners, cells, each.elements))
            start += len(cells)
        self.size = float(np.median(np.concatenate(sizes)))
        self.triangles = TriangulatedSurface(np.concatenate(nodes), np.concatenate(triangles))
        self._extrapolations: dict[tuple[int, bytes], tuple[FloatArray, FloatArray]] = {}

    def fields(self, profile: Mapping[str, FloatArray]) -> Fields:
        """Return the fields at the nodes from the values at the integration points of an interface profile.

        Values at a node are means over its faces. On a face they are constant, linear or bilinear, as the number of its
        points permits.

        Raises
        ------
        UelError
            The profile lacks an element, or the damage of a point.
        """
        keys, order = _in_order(profile)
        wanted = np.concatenate([each.elements for each in self._faces])
        first = np.searchsorted(keys, wanted)
        counts = np.searchsorted(keys, wanted, side="right") - first
        if not counts.all():
            label = int(wanted[np.argmin(counts)]) // OCCURRENCES
            raise UelError(f"increment {profile['increment'][0]:.0f}: no interface profile of element {label}")
        rows = order[np.isin(keys, wanted)]

        def known(*names: str) -> bool:
            return all(name in profile and bool(np.isfinite(profile[name][rows]).all()) for name in names)

        damage, separation = "SPENT" if known("SPENT") else "DAMAGE", "W" if known("WN") else "SEP"
        if not known(damage):
            raise UelError(f"increment {profile['increment'][0]:.0f}: {damage} of some points is not known")
        names: tuple[str, ...] = "X", "Y", "Z", damage, "TN", f"{separation}N", "TS", "TT", f"{separation}S"
        names += (f"{separation}T", *(DIRECTIONS if known(*DIRECTIONS) else ()))
        sums, elements = np.zeros((len(self._points), 9)), np.zeros(len(self._points))
        middles = []
        start = 0
        for number, each in enumerate(self._faces):
            mine = slice(start, start + len(each.nodes))
            start = mine.stop
            middle = np.zeros((len(each.nodes), 9))
            for count in np.unique(counts[mine]).tolist():
                some = np.flatnonzero(counts[mine] == count)
                points = order[first[mine][some][:, None] + np.arange(count)]
                values = np.stack([profile[name][points] for name in names], axis=-1)
                nodal = self._to_nodes((number, some.tobytes()), each, some, values)
                np.add.at(sums, each.nodes[some], nodal[:, :-1])
                middle[some] = nodal[:, -1]
            np.add.at(elements, each.nodes, 1.0)
            middles.append(middle)
        return Fields(np.concatenate([sums / elements[:, None], *middles]))

    def _to_nodes(self, key: tuple[int, bytes], each: Faces, some: IntArray, values: FloatArray) -> FloatArray:
        """Return values (m, k + 1, 9) at the nodes and the middle of some faces, from those at their points.

        Shears, which have directions of their own at each point, become vectors.

        Parameters
        ----------
        key
            Faces, and which of them: what depends on the mesh alone is kept.
        values
            (m, p, 10 or 13) coordinates, damage, normals, shears, and directions that the elements were given.
        """
        if key not in self._extrapolations:
            corners = self._points[each.nodes[some, : each.corners]]
            natural = _natural(values[..., :3], corners)
            given = values[:, :1, 10:] if values.shape[2] > 10 else np.zeros((len(some), 1, 3))
            slopes = np.einsum("mpka,mkd->mpad", natural_gradients(natural, each.corners), corners)
            normals = np.cross(slopes[:, :, 0], slopes[:, :, 1])
            normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
            axes = np.stack(face_directions(normals, given), axis=-2)
            count = values.shape[1]
            terms = 1 if count < 3 else min(count, each.corners)
            there = _terms(_natural_of_nodes(each.corners, each.nodes.shape[1]), terms)
            self._extrapolations[key] = there @ np.linalg.pinv(_terms(natural, terms)), axes
        shares, axes = self._extrapolations[key]
        shears = values[..., 6:10].reshape(*values.shape[:2], 2, 2)
        vectors = np.einsum("mpca,mpad->mpcd", shears, axes).reshape(*values.shape[:2], 6)
        return np.asarray(shares @ np.concatenate([values[..., 3:6], vectors], axis=-1))


def interface_surfaces(mesh: meshio.Mesh) -> list[InterfaceSurface]:
    """Return the surfaces of interface elements with a damage in space, in the order of their first elements."""
    own = [
        (block, labels)
        for block, damage, labels in zip(
            mesh.cells, mesh.cell_data.get("DAMAGE", []), mesh.cell_data["ELEMENT"], strict=False
        )
        if block.type in CORNERS and np.isfinite(damage).all()
    ]
    faces, before = [], np.zeros(0, dtype=np.int64)
    for block, labels in own:
        before = np.concatenate([before, np.asarray(labels, dtype=np.int64)])
        faces.append(Faces(CORNERS[block.type], block.data, _keys(before)[-len(labels) :]))
    if not faces:
        return []
    width = max(each.nodes.shape[1] for each in faces)
    # the least node once more where a face has fewer: the same for faces on the same nodes
    wide = np.concatenate(
        [np.pad(each.nodes, ((0, 0), (0, width - each.nodes.shape[1])), mode="minimum") for each in faces]
    )
    ends = np.cumsum([len(each.nodes) for each in faces])[:-1]
    surfaces = []
    for part in parts(wide, len(mesh.points)):
        masks = zip(faces, np.split(part, ends), strict=True)
        some = [Faces(each.corners, each.nodes[mask], each.elements[mask]) for each, mask in masks if mask.any()]
        surfaces.append(InterfaceSurface(mesh.points, some))
    return surfaces


def _keys(labels: IntArray) -> IntArray:
    """Return keys (m,) of labels: the label and how many of the same one come before."""
    return labels * OCCURRENCES + occurrences(labels)


def _in_order(profile: Mapping[str, FloatArray]) -> tuple[IntArray, IntArray]:
    """Return the keys of elements of the rows of a profile, ascending, and the rows in that order, by points.

    The points of an element follow each other; elements of one label are in the order of the mesh.
    """
    labels, points = profile["element"].astype(np.int64), profile["point"].astype(np.int64)
    # a row begins an element where the label changes, or the points begin again
    begins = np.flatnonzero((np.diff(labels, prepend=labels[:1] - 1) != 0) | (np.diff(points, prepend=0) <= 0))
    keys = np.repeat(_keys(labels[begins]), np.diff(np.append(begins, len(labels))))
    order = np.lexsort((points, keys))
    return keys[order], order


def _middles(nodes: FloatArray, corners: int) -> FloatArray:
    """Return the middles (m, 3) of faces with straight or curved edges, from the coordinates (m, k, 3) of nodes."""
    middle = nodes[:, :corners].mean(axis=1)
    if nodes.shape[1] == corners:
        return np.asarray(middle)
    # the shape functions of the nodes between corners rise above those of the corners there
    return np.asarray(middle + (2.0 if corners == 4 else 4.0 / 3.0) * (nodes[:, corners:].mean(axis=1) - middle))


def _natural_of_nodes(corners: int, count: int) -> FloatArray:
    """Return natural coordinates (count + 1, 2) of the nodes of a face and of its middle."""
    ends = _NATURAL[corners]
    between = 0.5 * (ends + np.roll(ends, -1, axis=0))
    return np.concatenate([ends, between[: count - corners], ends.mean(axis=0, keepdims=True)])


def _natural(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the natural coordinates (m, p, 2) of points (m, p, 3) nearest to them in faces with straight edges."""
    count = corners.shape[1]
    natural: FloatArray = np.zeros((*points.shape[:2], 2)) + _NATURAL[count].mean(axis=0)
    for _ in range(_STEPS):
        away = points - np.einsum("mpk,mkd->mpd", shape_functions(natural, count), corners)
        slopes = np.einsum("mpka,mkd->mpad", natural_gradients(natural, count), corners)
        matrix = slopes @ np.swapaxes(slopes, -1, -2)
        natural += np.linalg.solve(matrix, (slopes @ away[..., None]))[..., 0]
    return np.asarray(natural)


def _terms(natural: FloatArray, count: int) -> FloatArray:
    """Evaluate the first ones of 1, xi, eta and xi eta at natural coordinates (..., 2)."""
    x, y = natural[..., 0], natural[..., 1]
    return np.stack([np.ones_like(x), x, y, x * y][:count], axis=-1)
