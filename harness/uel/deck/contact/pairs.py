# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTACT PAIR: a secondary surface, or its nodes, against the faces of a main surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from uel.contact import FiniteSliding, SurfaceSliding
from uel.deck.contact.anchor_points import EQUAL, Anchors, find_anchors
from uel.deck.contact.contact_sides import Side, Sides, check_corners, surface_pair
from uel.deck.contact.geometric_corrections import SMOOTHING, Region, read_smoothings
from uel.deck.contact.interactions import Interactions
from uel.deck.contact.profiles import find_profile
from uel.deck.contact.sliding_surfaces import make_pieces, wound
from uel.deck.contact.surface_to_surface import average
from uel.deck.error_report import Problems, look_up
from uel.deck.language.blocks import Block, Row
from uel.deck.language.numbers import read_real
from uel.deck.language.table import INPUT, Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.sections.user_elements import dofs_by_node
from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import ContactPair, ContactProperty, Pieces, RigidProfile, SlidingPair, SurfacePair
from uel.model.mesh import ElementGroup
from uel.model.steps import Step

PROCEDURES = ("STATIC", "VISCO", "COUPLED TEMPERATURE-DISPLACEMENT")

SMOOTH = 0.2
"""Default SMOOTH: fraction of faces of a main surface, in the plane, that are rounded (Abaqus Keywords Guide)."""

EXTENSION = 0.1
"""Default EXTENSION ZONE (Abaqus Keywords Guide)."""


@dataclass(frozen=True, slots=True)
class _Points:
    """Points of a pair, as in `ContactPair`, and the mask of those that the main surface faces."""

    facing: np.ndarray
    nodes: IntArray
    shares: FloatArray
    slopes: FloatArray
    normals: FloatArray
    clearances: FloatArray
    areas: FloatArray


class ContactReader:
    """Reader of contact pairs. Moves nodes by ADJUST."""

    def __init__(
        self,
        flat: FlatMesh,
        groups: Sequence[ElementGroup],
        interactions: Interactions,
        problems: Problems,
    ) -> None:
        self._flat = flat
        self._sides = Sides(flat, groups)
        self._groups = groups
        self._interactions = interactions
        self._problems = problems
        self._points = flat.mesh.coordinates
        self._pairs: dict[tuple[Source, ...], Source] = {}
        smoothings = (block for block, _ in flat.blocks(SMOOTHING))
        self._smoothings = read_smoothings(smoothings, self._sides.surfaces, problems)

    def read(self) -> tuple[ContactPair | SlidingPair, ...]:
        """Return all contact pairs of the deck."""
        pairs: list[ContactPair | SlidingPair] = []
        for block, owner in self._flat.blocks("CONTACT PAIR"):
            with self._problems.gather():
                pairs += self._read(block, owner)
        return tuple(pairs)

    def _read(self, block: Block, owner: Owner) -> Iterator[ContactPair | SlidingPair]:
        for row in block.rows():
            if row.blank(1):
                raise row.error("expected the secondary and the main surface; contact with itself is not supported")
            row.at_most(2)
            surfaces = self._sides.surfaces
            names = row.name(0, "secondary surface"), row.name(1, "main surface")
            key = tuple(surfaces.locate(name, row.source, owner.name)[1].source for name in names)
            if key in self._pairs:
                raise row.error(f"{' and '.join(names)} are a contact pair already, at {self._pairs[key]}")
            self._pairs[key] = row.source
            yield self._pair(block, row, owner)

    def _pair(self, block: Block, row: Row, owner: Owner) -> ContactPair | SlidingPair:
        surface = self._interactions.find(block.options.text("INTERACTION"), block.source)
        secondary, main = row.name(0, "secondary surface"), row.name(1, "main surface")
        rigid = find_profile(main, row.source, owner.name, self._flat, self._sides.surfaces)
        if rigid is not None:
            return self._against_rigid(block, row, owner, rigid, surface)
        if self._sides.surfaces.of_nodes(main, row.source, owner.name) is not None:
            raise row.error(f"the main surface {main} is made of nodes; expected faces of elements")
        self._sides.check_secondary(secondary, row, owner)
        target = self._sides.side(main, row, owner, None)
        side = self._sides.side(secondary, row, owner, target)
        shared = np.intersect1d(side.nodes, target.nodes)
        if len(shared):
            name = self._flat.mesh.name(int(shared[0]))
            raise row.error(f"node {name} is on both surfaces, {secondary} and {main}")
        averaged = block.options.text("TYPE") == "SURFACE TO SURFACE" and bool(side.faces)
        if block.options.has("GEOMETRIC CORRECTION") and (block.options.flag("SMALL SLIDING") or not averaged):
            raise block.error("GEOMETRIC CORRECTION is supported between surfaces in finite sliding")
        if not block.options.flag("SMALL SLIDING"):
            if averaged:
                return self._surface_sliding(block, row, owner, (side, target), surface)
            smooth, zone = _smoothing(block)
            check_corners(target, self._flat.mesh, row)
            pieces = make_pieces(wound(target.faces, self._points), self._points, smooth, zone)
            return self._sliding(block, row, owner, side, pieces, surface)
        anchors = find_anchors(self._points[side.nodes], side.normals, target.faces, self._points)
        moved = self._adjust(block, side.nodes, (anchors.facing, anchors.clearances, anchors.normals), owner)
        anchors = replace(anchors, clearances=np.where(moved, 0.0, anchors.clearances))
        points = self._averages(side, target) if averaged else _at_nodes(side, anchors)
        facing = points.facing
        self._warn_beside(side.nodes[~facing], secondary, main, row)
        if not facing.any():
            raise row.error(f"no node of {secondary} faces {main}: normals of {main} go through none of them")
        dimension = 2 if target.faces[0][0].shape[1] == 2 else 3
        self._check_planes(points, dimension, row)
        return ContactPair(
            name=f"({secondary},{main})",
            property=surface,
            source=row.source,
            dimension=dimension,
            nodes=points.nodes[facing],
            shares=points.shares[facing],
            slopes=points.slopes[facing, :, : dimension - 1],
            normals=points.normals[facing],
            clearances=points.clearances[facing],
            areas=points.areas[facing],
            length=side.size,
        )

    def _against_rigid(
        self, block: Block, row: Row, owner: Owner, rigid: RigidProfile, surface: ContactProperty
    ) -> SlidingPair:
        """Build a pair with an analytical rigid surface. Raises DeckError."""
        secondary, main = row.name(0, "secondary surface"), row.name(1, "main surface")
        if block.options.has("GEOMETRIC CORRECTION"):
            raise block.error(f"GEOMETRIC CORRECTION: the analytical rigid surface {main} has no faces")
        if block.options.flag("SMALL SLIDING"):
            raise block.error(f"SMALL SLIDING is not supported on the analytical rigid surface {main}; leave it out")
        if block.options.text("TYPE") == "SURFACE TO SURFACE":
            raise block.error(
                f"TYPE=SURFACE TO SURFACE is not supported on the analytical rigid surface {main}; expected NODE TO "
                "SURFACE"
            )
        self._sides.check_secondary(secondary, row, owner)
        side = self._sides.side(secondary, row, owner, None)
        active = dofs_by_node(len(self._points), self._groups)
        if any(3 in active[node] for node in side.nodes.tolist()):
            raise row.error(f"the analytical rigid surface {main} is in the plane, {secondary} is not")
        if surface.friction > 0.0 and not side.faces and not surface.elastic_slip:
            raise row.error(f"{secondary} has no faces whose length gives the elastic slip; expected ELASTIC SLIP")
        return self._sliding(block, row, owner, side, rigid, surface)

    def _surface_sliding(
        self, block: Block, row: Row, owner: Owner, sides: tuple[Side, Side], surface: ContactProperty
    ) -> SurfacePair:
        """Build a surface-to-surface pair in finite sliding. Raises DeckError."""
        check_corners(sides[1], self._flat.mesh, row)
        name = f"({row.name(0, 'secondary surface')},{row.name(1, 'main surface')})"
        smoothing, regions = block.options.text("GEOMETRIC CORRECTION"), tuple[Region, ...]()
        if smoothing:
            regions = look_up(self._smoothings, smoothing, "surface smoothing", block.source)
        origin = block.name, row.source
        pair = surface_pair(name, origin, sides, self._points, surface, everywhere=False, regions=regions)
        if block.options.has("ADJUST"):
            self._adjust_sliding(block, pair, SurfaceSliding(pair, self._points).at_nodes(), owner)
        return pair

    def _sliding(
        self,
        block: Block,
        row: Row,
        owner: Owner,
        side: Side,
        main: Pieces | RigidProfile,
        surface: ContactProperty,
    ) -> SlidingPair:
        """Build a node-to-surface pair in finite sliding."""
        pair = SlidingPair(
            name=f"({row.name(0, 'secondary surface')},{row.name(1, 'main surface')})",
            property=surface,
            source=row.source,
            dimension=3 if isinstance(main, Pieces) and main.low.shape[1] == 2 else 2,
            secondary=side.nodes,
            faces=tuple(np.searchsorted(side.nodes, faces) for faces in wound(side.faces, self._points)),
            main=main,
            areas=side.areas,
            length=side.size,
        )
        if block.options.has("ADJUST"):
            start = FiniteSliding(pair, self._points)
            self._adjust_sliding(block, pair, (start.above, start.start(), start.start_normals), owner)
        return pair

    def _adjust_sliding(
        self, block: Block, pair: SlidingPair, start: tuple[np.ndarray, FloatArray, FloatArray], owner: Owner
    ) -> None:
        """Move nodes by ADJUST; start: mask of those that can touch, clearances, and normals."""
        facing, clearances, normals = start
        normals = np.pad(normals, ((0, 0), (0, 3 - pair.dimension)))
        self._adjust(block, pair.secondary, (facing, clearances, normals), owner)

    def _averages(self, side: Side, target: Side) -> _Points:
        mean, areas = average(side.faces, target.faces, side.depth, self._points)
        gaps = np.einsum("mn,mnd->md", mean.shares, self._points[mean.nodes])
        clearances = np.einsum("md,md->m", gaps, mean.normals)
        clearances[np.abs(clearances) <= EQUAL * side.size] = 0.0
        return _Points(mean.facing, mean.nodes, mean.shares, mean.slopes, mean.normals, clearances, areas)

    def _check_planes(self, points: _Points, dimension: int, row: Row) -> None:
        """Raise DeckError where the surface of a rotating normal has no tangent plane."""
        coordinates = self._points[points.nodes]
        along = np.einsum("mna,mnd->mad", points.slopes[..., : dimension - 1], coordinates)
        area = np.linalg.norm(np.cross(along[:, 0], along[:, 1]) if dimension == 3 else along[:, 0], axis=1)
        size = np.linalg.norm(along, axis=2).max(axis=1) ** (dimension - 1)
        wrong = points.facing & ~(area > EQUAL * size)
        if wrong.any():
            label = self._flat.mesh.name(int(points.nodes[wrong][0, 0]))
            raise row.error(
                f"the surface has no tangent plane for node {label}; faces with coincident corners cannot touch"
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
        """Move nodes onto the main surface by ADJUST, and return their mask (m,).

        start: mask of the nodes that face the main surface, clearances and normals.
        """
        options, (facing, clearances, normals) = block.options, start
        if not options.has("ADJUST"):
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
        chosen &= facing & (clearances != 0.0)
        np.subtract.at(self._points, nodes[chosen], (clearances[:, None] * normals)[chosen])
        return chosen


def _smoothing(block: Block) -> tuple[float, float]:
    """Read SMOOTH and EXTENSION ZONE. Raises DeckError outside their ranges."""
    smooth, zone = block.options.real("SMOOTH", SMOOTH), block.options.real("EXTENSION ZONE", EXTENSION)
    if not 0.0 <= smooth < 0.5:
        raise block.error(f"SMOOTH={smooth:g} must be at least 0 and less than 0.5")
    if not 0.0 <= zone <= 0.2:
        raise block.error(f"EXTENSION ZONE={zone:g} must be from 0 to 0.2")
    return smooth, zone


def _at_nodes(side: Side, anchors: Anchors) -> _Points:
    """Return the points of node-to-surface contact."""
    count = len(side.nodes)
    return _Points(
        anchors.facing,
        np.concatenate([side.nodes[:, None], anchors.faces], axis=1),
        np.concatenate([np.ones((count, 1)), -anchors.weights], axis=1),
        np.concatenate([np.zeros((count, 1, 2)), anchors.slopes], axis=1),
        anchors.normals,
        anchors.clearances,
        side.areas,
    )


def check_contact(pairs: Sequence[ContactPair | SlidingPair], steps: Sequence[Step], problems: Problems) -> None:
    """Add an error to each step with a feature that contact pairs do not support."""
    if not pairs:
        return
    for step in steps:
        procedure, origin = step.procedure, f"*{pairs[0].keyword} ({pairs[0].source})"
        obstacles = {
            "*STATIC, RIKS": procedure.riks is not None,
            "*STEP, PERTURBATION": procedure.linear and procedure.keyword in PROCEDURES,
            f"*{procedure.keyword}": procedure.keyword not in PROCEDURES,
        }
        for feature, used in obstacles.items():
            if used:
                problems.add(step.source, f"{origin} is not supported with {feature}")
        for heat in dict.fromkeys(pair.property.heat for pair in pairs):
            if heat is not None and procedure.temperatures:
                message = f"heat that crosses a contact is not supported (*{procedure.keyword}, {step.source})"
                problems.add(heat, f"{message}; without this line none crosses it")


KEYWORDS = (
    Keyword(
        "CONTACT PAIR",
        "Surfaces that may touch: nodes of the first one do not penetrate the second one. See "
        "harness/uel/contact/contact.md.",
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
            Option("SMOOTH", Kind.REAL, f"part of faces that is rounded for sliding nodes, in the plane ({SMOOTH})"),
            Option(
                "EXTENSION ZONE",
                Kind.REAL,
                f"of the main surface beyond its edges for sliding nodes, over the length of a face ({EXTENSION})",
            ),
            Option("GEOMETRIC CORRECTION", Kind.NAME, "*SURFACE SMOOTHING of the surfaces"),
            *ignored("HCRIT", "MINIMUM DISTANCE", "NO THICKNESS", "TRACKING"),
            *ignored("MIDFACE NODES", "SUPPLEMENTARY CONSTRAINTS", "SLIDING TRANSITION"),
            *refused("MECHANICAL CONSTRAINT", "TIED", "CPSET", "OP", "WEIGHT"),
        ),
        "secondary surface, main surface",
    ),
)
