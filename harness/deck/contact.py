# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTACT PAIR: a secondary surface, or its nodes, against the faces of a main surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from harness.deck.anchors import EQUAL, Anchors, find_anchors, nodal_normals
from harness.deck.averages import average
from harness.deck.blocks import Block, Row
from harness.deck.error_report import Problems
from harness.deck.flatten import FlatMesh, Owner
from harness.deck.interactions import Interactions
from harness.deck.numbers import read_real
from harness.deck.pieces import make_pieces, wound
from harness.deck.profiles import find_profile
from harness.deck.surfaces import Surfaces, linear_face, tributary_areas
from harness.deck.table import INPUT, Keyword, Kind, Option, Where, ignored, one_of, refused
from harness.deck.user_elements import dofs_by_node
from harness.elements import FiniteSliding
from harness.errors import DeckError
from harness.model.arrays import FloatArray, IntArray
from harness.model.contact import ContactPair, ContactProperty, Pieces, RigidProfile, SlidingPair
from harness.model.element_types import LINE2, ContinuumType, RigidType
from harness.model.mesh import ElementGroup, full_name
from harness.model.properties import SolidSection
from harness.model.steps import Step

PROCEDURES = ("STATIC", "VISCO")

SMOOTH = 0.2
"""Default SMOOTH: fraction of faces of a main surface, in the plane, that are rounded (Abaqus Keywords Guide)."""

EXTENSION = 0.1
"""Default EXTENSION ZONE (Abaqus Keywords Guide)."""


@dataclass(frozen=True, slots=True)
class _Side:
    """A surface of m nodes.

    faces    by their corners, with outward normals; none of a surface of nodes
    normals  (m, 3) of the nodes, with areas (m,)
    depth    factor from the length or area of faces to area, at all nodes of the model
    size     mean length of a face
    """

    faces: list[tuple[IntArray, FloatArray]]
    nodes: IntArray
    normals: FloatArray
    areas: FloatArray
    depth: FloatArray
    size: float


@dataclass(frozen=True, slots=True)
class _Points:
    """The points of a pair, as in `ContactPair`, and which of them the main surface faces."""

    found: np.ndarray
    nodes: IntArray
    shares: FloatArray
    slopes: FloatArray
    normals: FloatArray
    clearances: FloatArray
    areas: FloatArray


class ContactReader:
    """Reads contact pairs; nodes that ADJUST moves are moved in the mesh."""

    def __init__(
        self,
        flat: FlatMesh,
        groups: Sequence[ElementGroup],
        interactions: Interactions,
        problems: Problems,
    ) -> None:
        self._flat = flat
        self._surfaces = Surfaces(flat, groups)
        self._groups = groups
        self._interactions = interactions
        self._problems = problems
        self._points = flat.mesh.coordinates

    def read(self) -> tuple[ContactPair | SlidingPair, ...]:
        """All pairs of the deck."""
        found: list[ContactPair | SlidingPair] = []
        for owner in self._flat.owners:
            for block in owner.blocks:
                if block.name == "CONTACT PAIR":
                    with self._problems.gather():
                        found += self._read(block, owner)
        return tuple(found)

    def _read(self, block: Block, owner: Owner) -> Iterator[ContactPair | SlidingPair]:
        for row in block.rows():
            if row.blank(1):
                raise row.error("expected the secondary and the main surface; contact with itself is not supported")
            row.at_most(2)
            yield self._pair(block, row, owner)

    def _pair(self, block: Block, row: Row, owner: Owner) -> ContactPair | SlidingPair:
        surface = self._interactions.find(block.options.text("INTERACTION"), block.source)
        secondary, main = row.name(0, "secondary surface"), row.name(1, "main surface")
        rigid = find_profile(main, row.source, owner.name, self._flat, self._surfaces)
        if rigid is not None:
            return self._against_rigid(block, row, owner, rigid, surface)
        if self._surfaces.of_nodes(main, row.source, owner.name) is not None:
            raise row.error(f"the main surface {main} is made of nodes; expected faces of elements")
        self._check_secondary(secondary, row, owner)
        target = self._side(main, row, owner, None)
        side = self._side(secondary, row, owner, target)
        shared = np.intersect1d(side.nodes, target.nodes)
        if len(shared):
            name = self._flat.mesh.name(int(shared[0]))
            raise row.error(f"node {name} is on both surfaces, {secondary} and {main}")
        slip = surface.elastic_slip or surface.slip_tolerance * side.size
        averaged = block.options.text("TYPE") == "SURFACE TO SURFACE" and bool(side.faces)
        if not block.options.flag("SMALL SLIDING"):
            if averaged:
                raise block.error(
                    "finite sliding of surface to surface is not supported: its means would have to be taken again as "
                    "the faces move; expected SMALL SLIDING, or TYPE=NODE TO SURFACE"
                )
            smooth, zone = _smoothing(block)
            faces = wound(target.faces, self._points)
            self._check_corners(faces, row)
            pieces = make_pieces(faces, self._points, smooth, zone)
            return self._sliding(block, row, owner, side, pieces, (surface, slip))
        anchors = find_anchors(self._points[side.nodes], side.normals, target.faces, self._points)
        moved = self._adjust(block, side.nodes, (anchors.found, anchors.clearances, anchors.normals), owner)
        anchors = replace(anchors, clearances=np.where(moved, 0.0, anchors.clearances))
        points = self._averages(side, target) if averaged else _at_nodes(side, anchors)
        here = points.found
        self._warn_beside(side.nodes[~here], secondary, main, row)
        if not here.any():
            raise row.error(f"no node of {secondary} faces {main}: normals of {main} go through none of them")
        dimension = 2 if target.faces[0][0].shape[1] == 2 else 3
        self._check_planes(points, dimension, row)
        return ContactPair(
            name=f"({secondary},{main})",
            property=surface,
            source=row.source,
            dimension=dimension,
            nodes=points.nodes[here],
            shares=points.shares[here],
            slopes=points.slopes[here, :, : dimension - 1],
            normals=points.normals[here],
            clearances=points.clearances[here],
            areas=points.areas[here],
            slip=slip,
        )

    def _against_rigid(
        self, block: Block, row: Row, owner: Owner, rigid: RigidProfile, surface: ContactProperty
    ) -> SlidingPair:
        """A pair with an analytical rigid surface."""
        secondary, main = row.name(0, "secondary surface"), row.name(1, "main surface")
        if block.options.flag("SMALL SLIDING"):
            raise block.error(f"SMALL SLIDING is not supported on the analytical rigid surface {main}; leave it out")
        if block.options.text("TYPE") == "SURFACE TO SURFACE":
            raise block.error(
                f"TYPE=SURFACE TO SURFACE is not supported on the analytical rigid surface {main}; expected NODE TO "
                "SURFACE"
            )
        self._check_secondary(secondary, row, owner)
        side = self._side(secondary, row, owner, None)
        active = dofs_by_node(len(self._points), self._groups)
        if any(3 in active[node] for node in side.nodes.tolist()):
            raise row.error(f"the analytical rigid surface {main} is in the plane, {secondary} is not")
        if surface.friction > 0.0 and not side.faces and not surface.elastic_slip:
            raise row.error(f"{secondary} has no faces whose length gives the elastic slip; expected ELASTIC SLIP")
        slip = surface.elastic_slip or surface.slip_tolerance * side.size
        return self._sliding(block, row, owner, side, rigid, (surface, slip))

    def _sliding(
        self,
        block: Block,
        row: Row,
        owner: Owner,
        side: _Side,
        main: Pieces | RigidProfile,
        given: tuple[ContactProperty, float],
    ) -> SlidingPair:
        """A pair in finite sliding."""
        surface, slip = given
        pair = SlidingPair(
            name=f"({row.name(0, 'secondary surface')},{row.name(1, 'main surface')})",
            property=surface,
            source=row.source,
            dimension=3 if isinstance(main, Pieces) and main.low.shape[1] == 2 else 2,
            secondary=side.nodes,
            faces=tuple(wound(side.faces, self._points)),
            main=main,
            areas=side.areas,
            slip=slip,
        )
        at_start = FiniteSliding(pair, self._points)
        normals = np.pad(at_start.start_normals, ((0, 0), (0, 3 - pair.dimension)))
        self._adjust(block, side.nodes, (at_start.above, at_start.start(), normals), owner)
        return pair

    def _check_secondary(self, name: str, row: Row, owner: Owner) -> None:
        """Raise DeckError if a secondary surface is rigid."""
        if self._surfaces.of_nodes(name, row.source, owner.name) is not None:
            return
        for group, _, _, _ in self._surfaces.facets(name, row.source, owner.name):
            if isinstance(group.built_in, RigidType):
                raise row.error(f"surface {name} is rigid ({group.type}); expected it as the main surface")

    def _side(self, name: str, row: Row, owner: Owner, main: _Side | None) -> _Side:
        """A surface of a pair; main: the other one of a secondary surface, if it has faces, whose length one of nodes
        has.
        """
        given = self._surfaces.of_nodes(name, row.source, owner.name)
        if given is not None:
            return self._of_nodes(name, row, given, 0.0 if main is None else main.size)
        by_corners: dict[int, list[tuple[IntArray, FloatArray]]] = {}
        areas, depth, lengths = np.zeros(len(self._points)), np.zeros(len(self._points)), [np.zeros(0)]
        for group, rows, local, place in self._surfaces.facets(name, row.source, owner.name):
            family = linear_face(group, local)
            if family is None:
                kinds = ", ".join(f"those of {count} nodes" for count in (2, 3, 4))
                message = f"faces of elements of type {group.type} are not supported in contact pairs"
                raise DeckError(
                    place, f"*CONTACT PAIR: {message}; expected linear ones of solids, or rigid ones: {kinds}"
                )
            nodes = group.nodes[rows]
            faces = nodes[:, list(local)]
            corners = self._points[faces]
            with np.errstate(over="ignore", invalid="ignore"):
                own, outward = tributary_areas(family, corners), _normals(corners)
                if not isinstance(group.built_in, RigidType):
                    outward = _away(outward, corners, self._points[nodes].mean(axis=1))
                size = np.linalg.norm(outward, axis=1)
                flat = ~(np.isfinite(own).all(axis=1) & np.isfinite(size) & (own.sum(axis=1) > 0.0) & (size > 0.0))
            if flat.any():
                label = full_name(group.instance, int(group.labels[rows[flat][0]]))
                raise DeckError(place, f"*CONTACT PAIR: the face of element {label} in surface {name} has no area")
            lengths.append(own.sum(axis=1) if family is LINE2 else np.sqrt(own.sum(axis=1)))
            depth[faces] = across = self._depth(group, faces)
            if family is LINE2:
                # the integral of a shape function, over the radius too
                across = (across + across.sum(axis=1, keepdims=True)) / 3.0
            np.add.at(areas, faces, own * across)
            outward /= size[:, None]
            by_corners.setdefault(family.corners, []).append((faces, outward))
        if not by_corners:
            raise row.error(f"surface {name} has no faces")
        all_faces = [
            (np.concatenate([faces for faces, _ in parts]), np.concatenate([normals for _, normals in parts]))
            for parts in by_corners.values()
        ]
        nodes = np.unique(np.concatenate([faces.ravel() for faces, _ in all_faces]))
        normals = nodal_normals(all_faces, self._points)[nodes]
        return _Side(all_faces, nodes, normals, areas[nodes], depth, float(np.concatenate(lengths).mean()))

    def _depth(self, group: ElementGroup, faces: IntArray) -> FloatArray:
        """Thickness at the nodes of faces (f, n); about an axis, the circumference."""
        kind, section = group.built_in, group.section
        assert isinstance(kind, ContinuumType | RigidType)
        if kind.axisymmetric:
            return np.asarray(2 * np.pi * self._points[faces, 0])
        thickness = section.thickness if isinstance(section, SolidSection) and kind.dimension == 2 else 1.0
        return np.full(faces.shape, thickness)

    def _of_nodes(self, name: str, row: Row, given: list[tuple[IntArray, float]], size: float) -> _Side:
        areas = np.zeros(len(self._points))
        for nodes, area in given:
            areas[nodes] = area
        nodes = np.unique(np.concatenate([nodes for nodes, _ in given]))
        active = dofs_by_node(len(self._points), self._groups)
        for node in nodes.tolist():
            if not active[node] >= {1, 2}:
                label = self._flat.mesh.name(node)
                raise row.error(f"node {label} of surface {name} belongs to no element with displacements")
        return _Side([], nodes, np.zeros((len(nodes), 3)), areas[nodes], areas, size)

    def _averages(self, side: _Side, target: _Side) -> _Points:
        found, areas = average(side.faces, target.faces, side.depth, self._points)
        apart = np.einsum("mn,mnd->md", found.shares, self._points[found.nodes])
        clearances = np.einsum("md,md->m", apart, found.normals)
        clearances[np.abs(clearances) <= EQUAL * side.size] = 0.0
        return _Points(found.found, found.nodes, found.shares, found.slopes, found.normals, clearances, areas)

    def _check_planes(self, points: _Points, dimension: int, row: Row) -> None:
        """Raise DeckError where the surface with which a normal turns has no tangent plane."""
        places = self._points[points.nodes]
        along = np.einsum("mna,mnd->mad", points.slopes[..., : dimension - 1], places)
        area = np.linalg.norm(np.cross(along[:, 0], along[:, 1]) if dimension == 3 else along[:, 0], axis=1)
        size = np.linalg.norm(along, axis=2).max(axis=1) ** (dimension - 1)
        wrong = points.found & ~(area > EQUAL * size)
        if wrong.any():
            label = self._flat.mesh.name(int(points.nodes[wrong][0, 0]))
            raise row.error(
                f"the surface has no tangent plane for node {label}; faces with coincident corners cannot touch"
            )

    def _check_corners(self, faces: Sequence[IntArray], row: Row) -> None:
        """Raise DeckError where a face of a main surface has no tangent plane at a corner."""
        for nodes in faces:
            corners = self._points[nodes]
            sides = np.roll(corners, -1, axis=1) - corners
            size = np.linalg.norm(sides, axis=2).max(axis=1, keepdims=True)
            area = np.linalg.norm(np.cross(sides, np.roll(sides, 1, axis=1)), axis=2)
            wrong = area <= EQUAL * size**2
            if nodes.shape[1] > 2 and wrong.any():
                label = self._flat.mesh.name(int(nodes[wrong][0]))
                raise row.error(
                    f"the main surface has no tangent plane at node {label}; faces with coincident corners cannot touch"
                )

    def _warn_beside(self, nodes: IntArray, secondary: str, main: str, row: Row) -> None:
        if len(nodes):
            name, more = self._flat.mesh.name(int(nodes[0])), len(nodes) - 1
            others = f" and {more} more" if more else ""
            message = f"node {name}{others} of {secondary} will not touch {main}: no normal of {main} goes through it"
            self._problems.warn(row.source, f"*CONTACT PAIR: {message}")

    def _adjust(
        self, block: Block, nodes: IntArray, start: tuple[np.ndarray, FloatArray, FloatArray], owner: Owner
    ) -> np.ndarray:
        """Which nodes (m,) ADJUST moves onto the main surface; start: which of them it faces, clearances, normals."""
        options, (found, clearances, normals) = block.options, start
        if not options.given("ADJUST"):
            return np.zeros(len(nodes), dtype=np.bool_)
        text = options.text("ADJUST")
        try:
            depth = read_real(text)
        except ValueError:
            chosen = np.isin(nodes, self._flat.nodes(text, block.source, owner.name))
        else:
            if depth < 0:
                raise block.error(f"ADJUST={depth:g} must not be negative")
            chosen = clearances <= depth
        chosen &= found & (clearances != 0.0)
        self._points[nodes[chosen]] -= (clearances[:, None] * normals)[chosen]
        return chosen


def _smoothing(block: Block) -> tuple[float, float]:
    """SMOOTH and EXTENSION ZONE."""
    smooth, zone = block.options.real("SMOOTH", SMOOTH), block.options.real("EXTENSION ZONE", EXTENSION)
    if not 0.0 <= smooth < 0.5:
        raise block.error(f"SMOOTH={smooth:g} must be at least 0 and less than 0.5")
    if not 0.0 <= zone <= 0.2:
        raise block.error(f"EXTENSION ZONE={zone:g} must be from 0 to 0.2")
    return smooth, zone


def _at_nodes(side: _Side, anchors: Anchors) -> _Points:
    """Points of node to surface contact."""
    count = len(side.nodes)
    return _Points(
        anchors.found,
        np.concatenate([side.nodes[:, None], anchors.faces], axis=1),
        np.concatenate([np.ones((count, 1)), -anchors.weights], axis=1),
        np.concatenate([np.zeros((count, 1, 2)), anchors.slopes], axis=1),
        anchors.normals,
        anchors.clearances,
        side.areas,
    )


def check_contact(pairs: Sequence[ContactPair | SlidingPair], steps: Sequence[Step], problems: Problems) -> None:
    """What contact pairs cannot be used with is an error of the step."""
    if not pairs:
        return
    for step in steps:
        given, place = step.procedure, f"*CONTACT PAIR ({pairs[0].source})"
        obstacles = {
            "*STATIC, RIKS": given.riks is not None,
            "*STEP, PERTURBATION": given.linear and given.keyword in PROCEDURES,
            f"*{given.keyword}": given.keyword not in PROCEDURES,
        }
        for what, there in obstacles.items():
            if there:
                problems.add(step.source, f"{place} is not supported with {what}")


def _normals(corners: FloatArray) -> FloatArray:
    """Normals (f, 3) of faces (f, corners, 3) by the order of their corners, not of length one."""
    if corners.shape[1] == 2:
        along = corners[:, 1] - corners[:, 0]
        return np.stack([along[:, 1], -along[:, 0], np.zeros(len(along))], axis=1)
    # the diagonals of a quadrilateral, two edges of a triangle
    last = corners.shape[1] - 1
    return np.cross(corners[:, 2] - corners[:, 0], corners[:, last] - corners[:, 1])


def _away(normals: FloatArray, corners: FloatArray, centres: FloatArray) -> FloatArray:
    """The normals, or those on the other side, that point away from the centres (f, 3) of the elements of faces."""
    inward = np.einsum("fd,fd->f", normals, corners.mean(axis=1) - centres) < 0.0
    return np.where(inward[:, None], -normals, normals)


KEYWORDS = (
    Keyword(
        "CONTACT PAIR",
        "Surfaces that may touch: nodes of the first one do not penetrate the second one. See "
        "harness/elements/contact.md.",
        Where.MODEL,
        (
            INPUT,
            Option("INTERACTION", Kind.NAME, "surface interaction", required=True),
            one_of(
                "TYPE",
                "discretisation; against a surface of nodes it is always NODE TO SURFACE",
                ("NODE TO SURFACE", "SURFACE TO SURFACE"),
                default="NODE TO SURFACE",
            ),
            Option("SMALL SLIDING", doc="the main surface is a plane for each node; without it finite sliding"),
            Option(
                "ADJUST",
                Kind.NAME,
                "nodes of a set, or those with at most this clearance (0), begin on the main surface, without strain",
                bare="0",
            ),
            Option("SMOOTH", Kind.REAL, f"part of faces that is rounded in finite sliding, in the plane ({SMOOTH})"),
            Option(
                "EXTENSION ZONE",
                Kind.REAL,
                f"of the main surface beyond its edges in finite sliding, over the length of a face ({EXTENSION})",
            ),
            *ignored("HCRIT", "MINIMUM DISTANCE", "NO THICKNESS", "TRACKING"),
            *ignored("MIDFACE NODES", "SUPPLEMENTARY CONSTRAINTS", "SLIDING TRANSITION"),
            *refused("GEOMETRIC CORRECTION", "MECHANICAL CONSTRAINT", "TIED", "CPSET", "OP", "WEIGHT"),
        ),
        "secondary surface, main surface",
    ),
)
