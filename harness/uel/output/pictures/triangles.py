# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Triangulated surfaces in space: contour lines of a field, and paths along plane sections.

A location on a surface is a weighted mean of the nodes of one triangle; the value there of a field that is linear in
each triangle is the same weighted mean.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray

NONE = -1
"""Index in place of a triangle beyond an edge of the surface."""

_INWARDS = 1e-6
"""Distance, over that to the centre of a triangle, by which a plane that only touches it is shifted."""


@dataclass(frozen=True, slots=True)
class Locations:
    """Locations on a surface: nodes (..., k) and weights (..., k), whose sums are one."""

    nodes: IntArray
    weights: FloatArray

    def values(self, field: FloatArray) -> FloatArray:
        """Return the values (..., c) of a field (nodes, c)."""
        return np.asarray(np.einsum("...k,...kc->...c", self.weights, field[self.nodes]))

    def take(self, rows: IntArray) -> Locations:
        """Select some of the locations."""
        return Locations(self.nodes[rows], self.weights[rows])

    def towards(self, others: Locations, share: FloatArray) -> Locations:
        """Return locations at a fraction (...,) of the distance to others."""
        weights = ((1.0 - share)[..., None] * self.weights, share[..., None] * others.weights)
        return Locations(np.concatenate([self.nodes, others.nodes], axis=-1), np.concatenate(weights, axis=-1))


@dataclass(frozen=True, slots=True)
class Line:
    """Contour line.

    locations  n of them, on the edges that the line crosses; a closed line ends at its first one
    triangles  (n - 1,) through which it runs between them
    """

    locations: Locations
    triangles: IntArray


@dataclass(frozen=True, slots=True)
class SurfacePaths:
    """Paths across a surface, one per row: `lengths` (n, k) from the start, NaN after the end of a path."""

    locations: Locations
    lengths: FloatArray


class TriangulatedSurface:
    """Triangulated surface.

    Parameters
    ----------
    nodes
        (n, 3) coordinates.
    triangles
        (m, 3) nodes, ordered so that all normals point to the same side.
    """

    def __init__(self, nodes: FloatArray, triangles: IntArray) -> None:
        self.nodes = nodes
        self.triangles = triangles
        corners = nodes[triangles]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        sums = np.zeros_like(nodes)
        np.add.at(sums, triangles, areas[:, None])
        size = np.linalg.norm(sums, axis=1, keepdims=True)
        self.normals: FloatArray = sums / np.where(size > 0.0, size, 1.0)
        self.neighbours = self._neighbours()

    def _neighbours(self) -> IntArray:
        """Find the triangle (m, 3) beyond each edge, which begins at the node of that column; -1 if there is none."""
        pairs = np.sort(np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
        _, edge, counts = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
        edge = edge.ravel()
        order = np.argsort(edge, kind="stable")
        starts = np.concatenate([[0], np.cumsum(counts)[:-1]])[counts == 2]
        neighbours = np.full(len(pairs), NONE)
        first, second = order[starts], order[starts + 1]
        neighbours[first], neighbours[second] = second // 3, first // 3
        return neighbours.reshape(-1, 3)

    def lines(self, values: FloatArray, level: float) -> list[Line]:
        """Return the contour lines of a field (nodes,), linear in each triangle, at a level."""
        above = values > level
        corners = above[self.triangles]
        crossed = corners != np.roll(corners, -1, axis=1)
        left = crossed.any(axis=1)
        # first lines that begin at edges of the surface, then closed ones
        open_ends = np.argwhere(crossed & (self.neighbours == NONE))
        lines = []
        for triangle, edge in (*open_ends.tolist(), *((int(k), NONE) for k in np.flatnonzero(left))):
            if left[triangle]:
                edges = list(self._follow(crossed, left, triangle, edge))
                lines.append(self._line(values, level, edges))
        return lines

    def _follow(
        self, crossed: NDArray[np.bool_], left: NDArray[np.bool_], triangle: int, edge: int
    ) -> Iterator[tuple[int, int]]:
        """Yield triangles and edges that a line crosses: the edge where it begins, then that where it leaves each."""
        first = triangle
        edge = edge if edge != NONE else int(np.argmax(crossed[triangle]))
        yield triangle, edge
        while left[triangle]:
            left[triangle] = False
            edge = next(k for k in range(3) if crossed[triangle, k] and k != edge)
            yield triangle, edge
            beyond = int(self.neighbours[triangle, edge])
            if beyond in (NONE, first):
                return
            (edge,) = self._same_edge(*(np.array([k]) for k in (triangle, edge, beyond))).tolist()
            triangle = beyond

    def _line(self, values: FloatArray, level: float, edges: list[tuple[int, int]]) -> Line:
        triangles, positions = np.array(edges).T
        begin, end = self.triangles[triangles, positions], self.triangles[triangles, (positions + 1) % 3]
        share = (level - values[begin]) / (values[end] - values[begin])
        return Line(Locations(np.stack([begin, end], axis=1), np.stack([1.0 - share, share], axis=1)), triangles[1:])

    def length(self, line: Line) -> float:
        """Return the length of a line."""
        return float(self._arc(line)[-1])

    def _arc(self, line: Line) -> FloatArray:
        """Return the length (n,) of a line up to each of its locations."""
        steps = np.linalg.norm(np.diff(line.locations.values(self.nodes), axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def even(self, line: Line, distance: float) -> tuple[Locations, IntArray]:
        """Return the midpoints of at least three equal parts of a line, about `distance` long, and their triangles."""
        arc = self._arc(line)
        parts = max(3, round(arc[-1] / distance))
        at = arc[-1] * (np.arange(parts) + 0.5) / parts
        before = np.clip(np.searchsorted(arc, at, side="right") - 1, 0, len(arc) - 2)
        step = arc[before + 1] - arc[before]
        share = np.divide(at - arc[before], step, out=np.zeros(parts), where=step > 0.0)
        return line.locations.take(before).towards(line.locations.take(before + 1), share), line.triangles[before]

    def paths(
        self, start: Locations, triangles: IntArray, planes: FloatArray, directions: FloatArray, reach: float
    ) -> SurfacePaths:
        """Follow the surface from each location in a plane.

        Parameters
        ----------
        start, triangles
            n locations and their triangles.
        planes
            (n, 3) unit normals of the planes.
        directions
            (n, 3) approximate directions at the start.
        reach
            Length of the paths, which end at edges of the surface.
        """
        origin = start.values(self.nodes)
        # distance of each node from the plane of each path
        shift = self._shift(triangles, origin, planes)
        count = len(triangles)
        rows, triangle, edge = np.arange(count), triangles, np.full(count, NONE)
        last, length = start, np.zeros(count)
        visited, lengths = [start], [length]
        # no path enters a triangle twice
        for _ in range(len(self.triangles)):
            if not len(rows):
                break
            new, edge = self._leave(triangle, edge, origin[rows], planes[rows], directions[rows], shift[rows])
            step = np.linalg.norm(new.values(self.nodes) - last.values(self.nodes), axis=1)
            over = length + step > reach
            share = np.divide(reach - length, step, out=np.ones(len(rows)), where=over & (step > 0.0))
            length = np.minimum(length + step, reach)
            at = last.towards(new, share)
            locations = Locations(
                np.zeros((count, at.nodes.shape[1]), dtype=np.int64), np.full((count, at.nodes.shape[1]), np.nan)
            )
            locations.nodes[rows], locations.weights[rows] = at.nodes, at.weights
            visited.append(locations)
            lengths.append(np.full(count, np.nan))
            lengths[-1][rows] = length
            beyond = self.neighbours[triangle, edge]
            on = np.flatnonzero((beyond != NONE) & ~over)
            edge = self._same_edge(triangle[on], edge[on], beyond[on])
            rows, triangle, length, last = rows[on], beyond[on], length[on], new.take(on)
        widest = max(locations.nodes.shape[1] for locations in visited)
        nodes, weights = (
            np.stack(
                [np.pad(getattr(each, name), ((0, 0), (0, widest - each.nodes.shape[1]))) for each in visited], axis=1
            )
            for name in ("nodes", "weights")
        )
        return SurfacePaths(Locations(nodes, weights), np.stack(lengths, axis=1))

    def _shift(self, triangles: IntArray, origin: FloatArray, planes: FloatArray) -> FloatArray:
        """Return the distances (n,) by which to shift planes that only touch their first triangle."""
        corners = self.nodes[self.triangles[triangles]] - origin[:, None]
        heights = np.einsum("nkd,nd->nk", corners, planes)
        above = heights > 0.0
        touches = above.all(axis=1) | ~above.any(axis=1)
        return np.asarray(np.where(touches, _INWARDS * heights.mean(axis=1), 0.0))

    def _leave(
        self,
        triangle: IntArray,
        entered: IntArray,
        origin: FloatArray,
        planes: FloatArray,
        directions: FloatArray,
        shift: FloatArray,
    ) -> tuple[Locations, IntArray]:
        """Find where planes leave triangles entered by an edge, -1 for the first triangle: location and edge."""
        nodes = self.triangles[triangle]
        heights = np.einsum("nkd,nd->nk", self.nodes[nodes] - origin[:, None], planes) - shift[:, None]
        beyond = np.roll(heights, -1, axis=1)
        crossed = (heights > 0.0) != (beyond > 0.0)
        share = np.divide(heights, heights - beyond, out=np.zeros_like(heights), where=crossed)
        ends = np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=2)
        weights = np.stack([1.0 - share, share], axis=2)
        # the first triangle: with the interior on its left, an edge that rises above the plane is left in the
        # direction of the normal of the plane times that of the triangle
        corners = self.nodes[nodes]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        forward = np.sum(np.cross(planes, normal) * directions, axis=1) > 0.0
        first = (beyond > 0.0) == forward[:, None]
        others = np.arange(3) != entered[:, None]
        edge = (crossed & np.where(entered[:, None] == NONE, first, others)).argmax(axis=1)
        rows = np.arange(len(triangle))
        return Locations(ends[rows, edge], weights[rows, edge]), edge

    def _same_edge(self, triangle: IntArray, edge: IntArray, other: IntArray) -> IntArray:
        """Return the position (n,) of an edge of each triangle among the edges of its neighbour."""
        rows = np.arange(len(triangle))
        own = self.triangles[triangle]
        ends = np.sort(np.stack([own[rows, edge], own[rows, (edge + 1) % 3]], axis=1), axis=1)
        nodes = self.triangles[other]
        pairs = np.sort(np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=2), axis=2)
        return np.asarray((pairs == ends[:, None]).all(axis=2).argmax(axis=1))
