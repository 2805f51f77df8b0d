# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TIE: the nodes of a secondary surface move as the points of the main surface where they are.

Where each has a node of the main surface beside it, it follows this node; otherwise the point of the main surface that
is nearest to it, by the shape functions of the face. With CYCLIC SYMMETRY the main surface is that of the next sector
of the model: turned by 360/N degrees about the axis, displacements and rotations with it. Nodes of both surfaces lie on
the axis, along which they move.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from harness.deck.blocks import Block, Row
from harness.deck.error_report import Problems
from harness.deck.flatten import FlatMesh, Owner
from harness.deck.pieces import whole_pieces
from harness.deck.surfaces import Surfaces, family_of_face
from harness.deck.table import NAME, Keyword, Kind, Option, Where, ignored, one_of, refused
from harness.elements import FaceSurface, rotation_matrices
from harness.model.arrays import FloatArray, IntArray
from harness.model.element_types import Family
from harness.model.model import Equation
from harness.model.steps import Step

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

CLOSE: Final = 0.05
"""Position tolerance as a fraction of the largest distance between neighbouring nodes of the main surface."""

ROTATIONS: Final = (4, 5, 6)
"""Dofs that are rotations."""

ROUNDING: Final = 1e-12
"""Cosine that is none: of an axis that is meant to be along a global one, and of the angle that it turns by."""


@dataclass(frozen=True, slots=True)
class _Sector:
    """*CYCLIC SYMMETRY MODEL: a point of the axis, its direction (unit vector), and the angle of a sector."""

    point: FloatArray
    axis: FloatArray
    angle: float

    def turn(self, sign: int) -> FloatArray:
        """(3, 3) to the next sector, or back."""
        turned = rotation_matrices(sign * self.angle * self.axis[None])[0]
        return np.where(np.abs(turned) <= ROUNDING, 0.0, turned)

    def distances(self, places: FloatArray) -> FloatArray:
        """(n,) of places from the axis."""
        return np.asarray(np.linalg.norm(np.cross(places - self.point, self.axis), axis=1))


@dataclass(frozen=True, slots=True)
class _Followed:
    """What m nodes follow: nodes (m, k) with shares (m, k), turned by a matrix (3, 3), None for none."""

    nodes: IntArray
    shares: FloatArray
    turn: FloatArray | None


class TieReader:
    """Turns *TIE into equations."""

    def __init__(self, flat: FlatMesh, surfaces: Surfaces, solid: bool, problems: Problems) -> None:
        """solid: the model is in space."""
        self._flat, self._surfaces, self._solid, self._problems = flat, surfaces, solid, problems
        self._points = flat.mesh.coordinates
        self._sector: _Sector | None = None

    def read_sector(self, ties: Sequence[Block], steps: Sequence[Step]) -> None:
        """Take *CYCLIC SYMMETRY MODEL, and refuse steps that have other solutions than one for all sectors."""
        cyclic = [block for block in ties if block.options.flag("CYCLIC SYMMETRY")]
        models = [
            block for owner in self._flat.owners for block in owner.blocks if block.name == "CYCLIC SYMMETRY MODEL"
        ]
        if models and not cyclic:
            raise models[0].error("no *TIE has CYCLIC SYMMETRY")
        if cyclic and not models:
            raise cyclic[0].error("CYCLIC SYMMETRY needs *CYCLIC SYMMETRY MODEL")
        for step in steps if cyclic else ():
            given = step.procedure
            # modes differ from sector to sector
            if given.inertia or (given.linear and given.keyword != "STATIC"):
                where = f"*{given.keyword} ({step.source})"
                self._problems.add(cyclic[0].source, f"*TIE: CYCLIC SYMMETRY is not supported with {where}")
        if models:
            self._sector = self._read_sector(models[0])

    def _read_sector(self, block: Block) -> _Sector:
        count = block.options.integer("N", 0)
        if count < 1:
            raise block.error(f"N={count}: expected at least one sector")
        row = block.only_row()
        if row is None:
            raise block.error("needs a data line with the points a and b of the axis")
        row.at_most(6)
        first, second = np.array([row.real(k, "coordinate", 0.0) for k in range(6)]).reshape(2, 3)
        axis = second - first if self._solid else np.array([0.0, 0.0, 1.0])
        length = float(np.linalg.norm(axis))
        if not length > 0.0:
            raise row.error("points a and b of the axis are the same")
        axis = np.where(np.abs(axis) <= ROUNDING * length, 0.0, axis) / length
        return _Sector(first, axis, 2.0 * np.pi / count)

    def read(
        self, block: Block, owner: Owner, active: Sequence[frozenset[int]], held: dict[int, set[int]]
    ) -> Iterator[Equation]:
        """Equations of the ties of a keyword.

        Dofs of nodes that elements use, and those that are held at zero in each step: where both surfaces have them,
        there is nothing left to say.
        """
        rotations, cyclic = not block.options.flag("NO ROTATION"), block.options.flag("CYCLIC SYMMETRY")
        if cyclic and self._sector is None:
            # the sector is wrong, which is known
            return
        # a plane model has no motion out of the plane, whatever its masses and springs could have
        without = {3, 4, 5} if not self._solid else set()
        without |= set() if rotations else set(ROTATIONS)
        for row in block.rows():
            second, main = (self._surfaces.nodes(row.name(k, "surface"), row.source, owner.name) for k in range(2))
            if not len(main) or not len(second):
                raise row.error("a surface has no nodes")
            tolerance = block.options.real("POSITION TOLERANCE", CLOSE * _spacing(self._points[main]))
            if cyclic:
                both = np.intersect1d(second, main)
                second = np.setdiff1d(second, both)
                yield from self._on_axis(both, active, tolerance, row)
            followed = self._follow(block, row, owner, second, main, tolerance)
            for node, others, shares in zip(
                second.tolist(), followed.nodes.tolist(), followed.shares.tolist(), strict=True
            ):
                for dof in sorted(active[node] - without) if node not in others else ():
                    terms = self._terms(dof, others, shares, followed.turn)
                    same = dof in held.get(node, ()) and all(k in held.get(other, ()) for other, k, _ in terms)
                    if not same:
                        yield Equation(((node, dof, 1.0), *terms), row.source)

    def _terms(
        self, dof: int, nodes: Sequence[int], shares: Sequence[float], turn: FloatArray | None
    ) -> list[tuple[int, int, float]]:
        """Those of the nodes that a dof follows."""
        own = [(dof, 1.0)]
        if turn is not None and dof <= ROTATIONS[-1]:
            base = 0 if dof < ROTATIONS[0] else ROTATIONS[0] - 1
            own = [(base + k + 1, float(cosine)) for k, cosine in enumerate(turn[dof - base - 1])]
        return [
            (node, other, -share * cosine)
            for node, share in zip(nodes, shares, strict=True)
            for other, cosine in own
            if share * cosine != 0.0
        ]

    def _on_axis(
        self, nodes: IntArray, active: Sequence[frozenset[int]], tolerance: float, row: Row
    ) -> Iterator[Equation]:
        """Nodes of both sides of a sector move along the axis, and turn about it: u_j = (n_j/n_k) u_k."""
        assert self._sector is not None
        axis = self._sector.axis
        off = nodes[self._sector.distances(self._points[nodes]) > tolerance]
        if len(off):
            raise row.error(f"node {self._flat.mesh.name(int(off[0]))} is on both surfaces, but not on the axis")
        k = int(np.argmax(np.abs(axis)))
        others = [(base + j + 1, base + k + 1, float(axis[j] / axis[k])) for base in (0, 3) for j in range(3) if j != k]
        for node in nodes.tolist():
            for dof, along, ratio in others:
                if dof in active[node]:
                    yield Equation(((node, dof, 1.0), *(((node, along, -ratio),) if ratio else ())), row.source)

    def _follow(
        self, block: Block, row: Row, owner: Owner, second: IntArray, main: IntArray, tolerance: float
    ) -> _Followed:
        """What secondary nodes follow: nodes of the main surface, or its points."""
        sector = self._sector if block.options.flag("CYCLIC SYMMETRY") else None
        ways = [None] if sector is None else [sector.turn(1), sector.turn(-1)]
        found = []
        for turn in ways:
            turned = self._points.copy()
            if turn is not None and sector is not None:
                turned[main] = (turned[main] - sector.point) @ turn.T + sector.point
            distance, nearest = _search_tree(turned[main]).query(self._points[second])
            found.append((distance, nearest, turned, turn))
        distance, nearest, turned, turn = min(found, key=lambda one: float(one[0].max(initial=0.0)))
        apart = second[distance > tolerance]
        if not len(apart):
            return _Followed(main[nearest][:, None], np.ones((len(second), 1)), turn)
        faces = self._faces(row, owner)
        if not faces:
            raise row.error(
                f"{self._named(apart)} of the first surface coincides with no node of the second one (tolerance "
                f"{tolerance:g}); expected matching nodes, or a second surface of faces of solids"
            )
        return self._between(block, row, second, (faces, turned, turn), tolerance)

    def _named(self, nodes: IntArray) -> str:
        others = f" and {len(nodes) - 1} more" if len(nodes) > 1 else ""
        return f"node {self._flat.mesh.name(int(nodes[0]))}{others}"

    def _faces(self, row: Row, owner: Owner) -> dict[Family, IntArray]:
        """Nodes (f, k) of the faces of the main surface by family; none if it is of nodes, or has faces of shells."""
        name, found = row.name(1, "surface"), dict[Family, list[IntArray]]()
        if self._surfaces.of_nodes(name, row.source, owner.name) is not None:
            return {}
        for group, rows, local, _ in self._surfaces.facets(name, row.source, owner.name):
            family = family_of_face(group, local)
            if family is None:
                return {}
            found.setdefault(family, []).append(group.nodes[rows][:, list(local)])
        return {family: np.concatenate(parts) for family, parts in found.items()}

    def _between(
        self,
        block: Block,
        row: Row,
        second: IntArray,
        main: tuple[dict[Family, IntArray], FloatArray, FloatArray | None],
        tolerance: float,
    ) -> _Followed:
        """The nearest points of the main surface: of its faces, in these places of all nodes, turned by this matrix."""
        faces, places, turn = main
        dimension = next(iter(faces)).dimension + 1
        surface = FaceSurface(whole_pieces(faces), places[:, :dimension])
        nodes, shares = surface.nearest(self._points[second, :dimension])
        at = np.einsum("mk,mkd->md", shares, places[nodes])
        apart = second[np.linalg.norm(self._points[second] - at, axis=1) > tolerance]
        if len(apart):
            raise row.error(
                f"{self._named(apart)} of the first surface is farther than {tolerance:g} from the second one"
            )
        if block.options.text("TYPE") != "NODE TO SURFACE":
            message = (
                "nodes between those of the main surface follow its faces at their places, as NODE TO SURFACE says"
            )
            self._problems.warn(block.source, f"*TIE: {message}; Abaqus takes means, whose weights are not published")
        return _Followed(nodes, shares, turn)


def _spacing(points: FloatArray) -> float:
    """Largest distance of a point to the one nearest to it; 1 for a single point."""
    if len(points) == 1:
        return 1.0
    distance, _ = _search_tree(points).query(points, k=2)
    return float(distance[:, 1].max())


def _search_tree(points: FloatArray) -> cKDTree:
    """Finds the points (n, 3) that are nearest to others."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (takes 0.2 s, and few decks have ties)

    return cKDTree(points)


KEYWORDS = (
    Keyword(
        "TIE",
        "Tie surfaces: all dofs of the nodes of the first one follow the second. Where nodes do not match, those of "
        "the first follow the faces of the second, of solids or cohesive elements, at the points that are nearest to "
        "them.",
        Where.MODEL,
        (
            NAME,
            Option("POSITION TOLERANCE", Kind.REAL, "largest distance of nodes that are tied"),
            Option("NO ROTATION", doc="rotations stay free"),
            Option(
                "CYCLIC SYMMETRY",
                doc="the second surface is that of the next sector of *CYCLIC SYMMETRY MODEL; in static steps",
            ),
            one_of(
                "TYPE",
                "what nodes that do not match follow; here always as NODE TO SURFACE says, with a warning",
                ("SURFACE TO SURFACE", "NODE TO SURFACE"),
                default="SURFACE TO SURFACE",
            ),
            *ignored("ADJUST", "CONSTRAINT RATIO", "NO THICKNESS"),
            *refused("TIED NSET"),
        ),
        "first (secondary) surface, second (main) surface",
    ),
    Keyword(
        "CYCLIC SYMMETRY MODEL",
        "The model is a sector, which repeats itself about an axis; ties with CYCLIC SYMMETRY join its two sides. "
        "Steps have the solution that is the same in all sectors.",
        Where.MODEL,
        (Option("N", Kind.INTEGER, "number of sectors", required=True),),
        "coordinates of the points a and b of the axis; in the plane those of a",
    ),
)
