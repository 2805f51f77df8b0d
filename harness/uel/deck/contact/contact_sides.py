# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The two sides of contact: faces of elements with their outward normals, and the data of their nodes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from uel.deck.contact.anchor_points import EQUAL, nodal_normals
from uel.deck.contact.geometric_corrections import Region, rounded_pieces
from uel.deck.contact.sliding_surfaces import face_normals, filled, make_pieces, wound
from uel.deck.language.blocks import Row
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.mesh.smooth_parts import smooth_parts
from uel.deck.mesh.surfaces import Surfaces, linear_face, tributary_areas
from uel.deck.sections.user_elements import dofs_by_node
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import ContactProperty, SurfacePair
from uel.model.element_types import LINE2, ContinuumType, Face, RigidType
from uel.model.mesh import ElementGroup, Mesh, full_name
from uel.model.properties import SolidSection

Facets = tuple[ElementGroup, IntArray, Face, Source]
"""Element group, rows of it, local nodes of their face, and location in the deck."""


@dataclass(frozen=True, slots=True)
class Side:
    """A surface of m nodes.

    faces    by their corners, with outward normals; none of a surface of nodes
    normals  (m, 3) of the nodes, with areas (m,)
    depth    factor from length or area of faces to area, at all nodes of the model
    size     mean length of a face
    heights  (f,) of the elements behind the faces, in the order of `faces`; 0 for rigid elements
    """

    faces: list[tuple[IntArray, FloatArray]]
    nodes: IntArray
    normals: FloatArray
    areas: FloatArray
    depth: FloatArray
    size: float
    heights: FloatArray


class Sides:
    """Builder of the sides of contact from the surfaces of a deck.

    surfaces  those of the deck
    """

    def __init__(self, flat: FlatMesh, groups: Sequence[ElementGroup]) -> None:
        self.surfaces = Surfaces(flat, groups)
        self._flat, self._groups = flat, groups
        self._points = flat.mesh.coordinates

    def check_secondary(self, name: str, row: Row, owner: Owner) -> None:
        """Raise DeckError if a secondary surface is rigid."""
        if self.surfaces.of_nodes(name, row.source, owner.name) is not None:
            return
        for group, _, _, _ in self.surfaces.facets(name, row.source, owner.name):
            if isinstance(group.built_in, RigidType):
                raise row.error(f"surface {name} is rigid ({group.type}); expected it as the main surface")

    def side(self, name: str, row: Row, owner: Owner, main: Side | None) -> Side:
        """Build one side of a pair; main: main side, whose face length a secondary surface of nodes takes."""
        nodes = self.surfaces.of_nodes(name, row.source, owner.name)
        if nodes is not None:
            return self._of_nodes(name, row, nodes, 0.0 if main is None else main.size)
        facets = self.surfaces.facets(name, row.source, owner.name)
        return self.of_facets(facets, name, row)

    def of_facets(self, facets: Iterable[Facets], name: str, row: Row) -> Side:
        """Build the side of a surface of faces; name and row are for messages."""
        by_corners: dict[int, list[tuple[IntArray, FloatArray, FloatArray]]] = {}
        areas, depth, lengths = np.zeros(len(self._points)), np.zeros(len(self._points)), [np.zeros(0)]
        for group, rows, local, source in facets:
            family = linear_face(group, local)
            if family is None:
                kinds = ", ".join(f"those of {count} nodes" for count in (2, 3, 4))
                message = f"faces of elements of type {group.type} are not supported in contact pairs"
                raise DeckError(
                    source, f"*{row.keyword}: {message}; expected linear ones of solids, or rigid ones: {kinds}"
                )
            nodes = group.nodes[rows]
            faces = nodes[:, list(local)]
            corners = self._points[faces]
            with np.errstate(over="ignore", invalid="ignore"):
                tributary, outward = tributary_areas(family, corners), face_normals(corners)
                inside = np.zeros_like(outward)
                if not isinstance(group.built_in, RigidType):
                    inside = corners.mean(axis=1) - self._points[nodes].mean(axis=1)
                    outward = np.where(np.einsum("fd,fd->f", outward, inside)[:, None] < 0.0, -outward, outward)
                size = np.linalg.norm(outward, axis=1)
                flat = ~(
                    np.isfinite(tributary).all(axis=1)
                    & np.isfinite(size)
                    & (tributary.sum(axis=1) > 0.0)
                    & (size > 0.0)
                )
            if flat.any():
                label = full_name(group.instance, int(group.labels[rows[flat][0]]))
                raise DeckError(source, f"*{row.keyword}: the face of element {label} in surface {name} has no area")
            lengths.append(tributary.sum(axis=1) if family is LINE2 else np.sqrt(tributary.sum(axis=1)))
            depth[faces] = across = self._depth(group, faces)
            if family is LINE2:
                # the integral of a shape function, over the radius too
                across = (across + across.sum(axis=1, keepdims=True)) / 3.0
            np.add.at(areas, faces, tributary * across)
            outward /= size[:, None]
            # the centroid is half of the height behind the face
            heights = 2.0 * np.einsum("fd,fd->f", outward, inside)
            by_corners.setdefault(family.corners, []).append((faces, outward, heights))
        if not by_corners:
            raise row.error(f"surface {name} has no faces")
        all_faces = [
            (np.concatenate([faces for faces, *_ in entries]), np.concatenate([normals for _, normals, _ in entries]))
            for entries in by_corners.values()
        ]
        nodes = np.unique(np.concatenate([faces.ravel() for faces, _ in all_faces]))
        normals = nodal_normals(all_faces, self._points)[nodes]
        heights = np.concatenate([tributary for entries in by_corners.values() for *_, tributary in entries])
        return Side(all_faces, nodes, normals, areas[nodes], depth, float(np.concatenate(lengths).mean()), heights)

    def _depth(self, group: ElementGroup, faces: IntArray) -> FloatArray:
        """Return the thickness at the nodes of faces (f, n), or the circumference in axisymmetry."""
        kind, section = group.built_in, group.section
        assert isinstance(kind, ContinuumType | RigidType)
        if kind.axisymmetric:
            return np.asarray(2 * np.pi * self._points[faces, 0])
        thickness = section.thickness if isinstance(section, SolidSection) and kind.dimension == 2 else 1.0
        return np.full(faces.shape, thickness)

    def _of_nodes(self, name: str, row: Row, lines: list[tuple[IntArray, float]], size: float) -> Side:
        areas = np.zeros(len(self._points))
        for nodes, area in lines:
            areas[nodes] = area
        nodes = np.unique(np.concatenate([nodes for nodes, _ in lines]))
        active = dofs_by_node(len(self._points), self._groups)
        for node in nodes.tolist():
            if not active[node] >= {1, 2}:
                label = self._flat.mesh.name(node)
                raise row.error(f"node {label} of surface {name} belongs to no element with displacements")
        return Side([], nodes, np.zeros((len(nodes), 3)), areas[nodes], areas, size, np.zeros(0))


def surface_pair(
    name: str,
    origin: tuple[str, Source],
    sides: tuple[Side, Side],
    coordinates: FloatArray,
    surface: ContactProperty,
    *,
    everywhere: bool,
    regions: Sequence[Region] = (),
) -> SurfacePair:
    """Build a surface-to-surface pair in finite sliding.

    Parameters
    ----------
    name, place
        Name of the pair; its keyword and location in the deck.
    sides
        Secondary and main side.
    coordinates
        (n, 3) of all nodes.
    surface
        The contact property.
    everywhere
        The surfaces may enclose their bodies: overlaps beyond half of the element height are ignored.
    regions
        Faces that approximate curved surfaces.
    """
    secondary, main = sides
    faces, opposite = wound(secondary.faces, coordinates), wound(main.faces, coordinates)
    smooth = smooth_parts(faces, coordinates)
    pieces = make_pieces(faces, coordinates, 0.0, 0.0, smooth.corners)
    main_pieces = make_pieces(opposite, coordinates, 0.0, 0.0, smooth_parts(opposite, coordinates).corners)
    return SurfacePair(
        name=name,
        property=surface,
        keyword=origin[0],
        source=origin[1],
        dimension=pieces.low.shape[1] + 1,
        secondary=smooth.nodes,
        faces=smooth.corners,
        main=main_pieces,
        areas=secondary.areas[np.searchsorted(secondary.nodes, smooth.nodes)],
        length=secondary.size,
        own=pieces,
        corners=filled(smooth.corners),
        depths=secondary.depth[pieces.nodes],
        deepest=0.5 * secondary.heights if everywhere else np.full(len(secondary.heights), np.inf),
        rounded=(rounded_pieces(regions, pieces), rounded_pieces(regions, main_pieces)),
    )


def check_corners(main: Side, mesh: Mesh, row: Row) -> None:
    """Raise DeckError where a face of a main surface in finite sliding has no tangent plane at a corner."""
    for nodes, _ in main.faces:
        corners = mesh.coordinates[nodes]
        sides = np.roll(corners, -1, axis=1) - corners
        size = np.linalg.norm(sides, axis=2).max(axis=1, keepdims=True)
        area = np.linalg.norm(np.cross(sides, np.roll(sides, 1, axis=1)), axis=2)
        wrong = area <= EQUAL * size**2
        if nodes.shape[1] > 2 and wrong.any():
            label = mesh.name(int(nodes[wrong][0]))
            raise row.error(
                f"the main surface has no tangent plane at node {label}; faces with coincident corners cannot touch"
            )
