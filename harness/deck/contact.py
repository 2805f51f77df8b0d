# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTACT PAIR: nodes of a secondary surface against the faces of a main surface, in small sliding."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from harness.deck.anchors import Anchors, find_anchors, nodal_normals
from harness.deck.blocks import Block, Row
from harness.deck.error_report import Problems
from harness.deck.flatten import FlatMesh, Owner
from harness.deck.interactions import Interactions
from harness.deck.numbers import read_real
from harness.deck.surfaces import Surfaces, tributary_areas
from harness.deck.table import INPUT, Keyword, Kind, Option, Where, ignored, one_of, refused
from harness.deck.user_elements import dofs_by_node
from harness.errors import Source
from harness.model.arrays import FloatArray, IntArray
from harness.model.contact import ContactPair
from harness.model.element_types import LINE2, QUAD4, TRI3, ContinuumType, Family
from harness.model.mesh import ElementGroup
from harness.model.properties import SolidSection
from harness.model.steps import Step

LINEAR_FACES = (LINE2, TRI3, QUAD4)


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

    def read(self) -> tuple[ContactPair, ...]:
        """All pairs of the deck."""
        found: list[ContactPair] = []
        for owner in self._flat.owners:
            for block in owner.blocks:
                if block.name == "CONTACT PAIR":
                    with self._problems.gather():
                        found += self._read(block, owner)
        return tuple(found)

    def _read(self, block: Block, owner: Owner) -> Iterator[ContactPair]:
        options = block.options
        if options.text("TYPE") != "NODE TO SURFACE":
            kind = options.text("TYPE")
            raise block.error(f"TYPE={kind} is not supported; TYPE=NODE TO SURFACE with SMALL SLIDING is")
        if not options.flag("SMALL SLIDING"):
            raise block.error("finite sliding is not supported; SMALL SLIDING is")
        for row in block.rows():
            if row.blank(1):
                raise row.error("expected the secondary and the main surface; contact with itself is not supported")
            row.at_most(2)
            yield self._pair(block, row, owner)

    def _pair(self, block: Block, row: Row, owner: Owner) -> ContactPair:
        surface = self._interactions.find(block.options.text("INTERACTION"), block.source)
        secondary, main = row.name(0, "secondary surface"), row.name(1, "main surface")
        if self._surfaces.of_nodes(main, row.source, owner.name) is not None:
            raise row.error(f"the main surface {main} is made of nodes; expected faces of elements")
        facets, _, size = self._facets(main, row.source, owner)
        nodes, looks, areas, own_size = self._secondary(secondary, row.source, owner, size)
        shared = np.intersect1d(nodes, np.concatenate([faces.ravel() for faces, _ in facets]))
        if len(shared):
            name = self._flat.mesh.name(int(shared[0]))
            raise row.error(f"node {name} is on both surfaces, {secondary} and {main}")
        anchors = find_anchors(self._points[nodes], looks, facets, self._points)
        self._warn_beside(nodes[~anchors.found], secondary, main, row)
        if not anchors.found.any():
            raise row.error(f"no node of {secondary} faces {main}: normals of {main} go through none of them")
        clearances = self._adjust(block, nodes, anchors, owner)
        dimension = facets[0][0].shape[1] if facets[0][0].shape[1] == 2 else 3
        here = anchors.found
        slip = surface.elastic_slip or surface.slip_tolerance * own_size
        return ContactPair(
            name=f"({secondary},{main})",
            property=surface,
            source=row.source,
            dimension=dimension,
            nodes=np.concatenate([nodes[here, None], anchors.faces[here]], axis=1),
            weights=anchors.weights[here],
            slopes=anchors.slopes[here, :, : dimension - 1],
            normals=anchors.normals[here],
            clearances=clearances[here],
            areas=areas[here],
            slip=slip,
        )

    def _facets(
        self, name: str, source: Source, owner: Owner
    ) -> tuple[list[tuple[IntArray, FloatArray]], FloatArray, float]:
        """Faces of a surface by their corners, with outward normals; tributary areas of all nodes of the model; mean
        length of a face.
        """
        by_corners: dict[int, list[tuple[IntArray, FloatArray]]] = {}
        areas, lengths = np.zeros(len(self._points)), [np.zeros(0)]
        for group, rows, local, place in self._surfaces.facets(name, source, owner.name):
            family = _face_family(group, local)
            if family is None:
                kinds = ", ".join(f"those of {count} nodes" for count in (2, 3, 4))
                message = f"faces of elements of type {group.type} are not supported in contact pairs"
                raise Row("CONTACT PAIR", (), place).error(f"{message}; expected linear ones of solids: {kinds}")
            nodes = group.nodes[rows]
            faces = nodes[:, list(local)]
            corners = self._points[faces]
            own = tributary_areas(family, corners)
            length = own.sum(axis=1) if family is LINE2 else np.sqrt(own.sum(axis=1))
            lengths.append(length)
            np.add.at(areas, faces, own * self._depth(group, faces))
            outward = _outward(corners, self._points[nodes].mean(axis=1))
            by_corners.setdefault(family.corners, []).append((faces, outward))
        if not by_corners:
            raise Row("CONTACT PAIR", (), source).error(f"surface {name} has no faces")
        facets = [
            (np.concatenate([faces for faces, _ in parts]), np.concatenate([normals for _, normals in parts]))
            for parts in by_corners.values()
        ]
        return facets, areas, float(np.concatenate(lengths).mean())

    def _depth(self, group: ElementGroup, faces: IntArray) -> FloatArray:
        """Thickness at the nodes of faces (f, n); about an axis, the circumference."""
        kind, section = group.built_in, group.section
        assert isinstance(kind, ContinuumType)
        assert isinstance(section, SolidSection)
        if kind.axisymmetric:
            return np.asarray(2 * np.pi * self._points[faces, 0])
        return np.full(faces.shape, section.thickness if kind.dimension == 2 else 1.0)

    def _secondary(
        self, name: str, source: Source, owner: Owner, size: float
    ) -> tuple[IntArray, FloatArray, FloatArray, float]:
        """Nodes of the secondary surface, ascending, their normals and areas, and the length of its faces. A surface of
        nodes has no normals, and the length of those of the main surface.
        """
        given = self._surfaces.of_nodes(name, source, owner.name)
        if given is None:
            facets, areas, size = self._facets(name, source, owner)
            nodes = np.unique(np.concatenate([faces.ravel() for faces, _ in facets]))
            return nodes, nodal_normals(facets, self._points)[nodes], areas[nodes], size
        areas = np.zeros(len(self._points))
        for nodes, area in given:
            areas[nodes] = area
        nodes = np.unique(np.concatenate([nodes for nodes, _ in given]))
        active = dofs_by_node(len(self._points), self._groups)
        for node in nodes.tolist():
            if not active[node] >= {1, 2}:
                message = (
                    f"node {self._flat.mesh.name(node)} of surface {name} belongs to no element with displacements"
                )
                raise Row("CONTACT PAIR", (), source).error(message)
        return nodes, np.zeros((len(nodes), 3)), areas[nodes], size

    def _warn_beside(self, nodes: IntArray, secondary: str, main: str, row: Row) -> None:
        if len(nodes):
            name, more = self._flat.mesh.name(int(nodes[0])), len(nodes) - 1
            others = f" and {more} more" if more else ""
            message = f"node {name}{others} of {secondary} will not touch {main}: no normal of {main} goes through it"
            self._problems.warn(row.source, f"*CONTACT PAIR: {message}")

    def _adjust(self, block: Block, nodes: IntArray, anchors: Anchors, owner: Owner) -> FloatArray:
        """Clearances after ADJUST: of nodes that it moves onto the main surface, zero."""
        options = block.options
        if not options.given("ADJUST"):
            return anchors.clearances
        text = options.text("ADJUST")
        try:
            depth = read_real(text)
        except ValueError:
            chosen = np.isin(nodes, self._flat.nodes(text, block.source, owner.name))
        else:
            if depth < 0:
                raise block.error(f"ADJUST={depth:g} must not be negative")
            chosen = anchors.clearances <= depth
        chosen &= anchors.found & (anchors.clearances != 0.0)
        self._points[nodes[chosen]] -= (anchors.clearances[:, None] * anchors.normals)[chosen]
        return np.where(chosen, 0.0, anchors.clearances)


def check_contact(pairs: Sequence[ContactPair], steps: Sequence[Step], problems: Problems) -> None:
    """What contact pairs cannot be used with is an error of the step."""
    if not pairs:
        return
    for step in steps:
        given, place = step.procedure, f"*CONTACT PAIR ({pairs[0].source})"
        obstacles = {
            "*STATIC, RIKS": given.riks is not None,
            f"*{given.keyword}": given.linear or given.inertia or given.temperatures,
        }
        for what, there in obstacles.items():
            if there:
                problems.add(step.source, f"{place} is not supported with {what}")


def _face_family(group: ElementGroup, local: tuple[int, ...]) -> Family | None:
    """The family of a face, None where contact does not support it."""
    kind = group.built_in
    if not isinstance(kind, ContinuumType):
        return None
    family = kind.family.face_family(local)
    return family if family in LINEAR_FACES else None


def _outward(corners: FloatArray, centres: FloatArray) -> FloatArray:
    """Unit normals (f, 3) of faces (f, corners, 3) that point away from the centres (f, 3) of their elements."""
    if corners.shape[1] == 2:
        along = corners[:, 1] - corners[:, 0]
        normals = np.stack([along[:, 1], -along[:, 0], np.zeros(len(along))], axis=1)
    else:
        # the diagonals of a quadrilateral, two edges of a triangle
        last = corners.shape[1] - 1
        normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, last] - corners[:, 1])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
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
                "discretisation; SURFACE TO SURFACE is refused where it is read",
                ("NODE TO SURFACE", "SURFACE TO SURFACE"),
                default="NODE TO SURFACE",
            ),
            Option("SMALL SLIDING", doc="the main surface is a plane for each node; needed"),
            Option(
                "ADJUST",
                Kind.NAME,
                "nodes of a set, or those with at most this clearance (0), begin on the main surface, without strain",
                bare="0",
            ),
            *ignored("EXTENSION ZONE", "HCRIT", "MINIMUM DISTANCE", "NO THICKNESS", "SMOOTH", "TRACKING"),
            *ignored("MIDFACE NODES", "SUPPLEMENTARY CONSTRAINTS", "SLIDING TRANSITION"),
            *refused("GEOMETRIC CORRECTION", "MECHANICAL CONSTRAINT", "TIED", "CPSET", "OP", "WEIGHT"),
        ),
        "secondary surface, main surface",
    ),
)
