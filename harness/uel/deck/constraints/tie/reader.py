# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TIE: the nodes of a secondary surface follow points of the main surface.

TYPE=NODE TO SURFACE: a node follows the nearest point of the main surface, by the shape functions of the face. SURFACE
TO SURFACE, the default: it follows means over its faces (`mean_weights`) where main faces cover these, else the nearest
point. On a main surface of nodes it follows the nearest node. Nodes outside the position tolerance stay untied. ADJUST
moves tied nodes onto the main surface. `nearest_points` has the weights of the nearest points, which it projects onto
faces as contact does (`fortran/host/contact/faces.f90`).

With CYCLIC SYMMETRY the main surface is that of the next sector, rotated by 360/N degrees about the axis, with its
displacements and rotations. Nodes on both surfaces are on the axis and move along it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse

from uel.deck.constraints.tie.faces import TiedFaces, read_faces
from uel.deck.constraints.tie.mean_weights import surface_weights
from uel.deck.constraints.tie.nearest_points import mean_spacing, nearest_points
from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import NAME, Keyword, Kind, Option, Where, ignored, one_of
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.mesh.surfaces import Surfaces
from uel.elements import rotation_matrices
from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Equation
from uel.model.steps import Step

Term = tuple[int, int, float]
"""Node, dof and coefficient of an equation."""

CLOSE: Final = 0.05
"""Default position tolerance over the element size, or on a surface of nodes over the average distance of nodes (Abaqus
Keywords Guide, *TIE)."""

NAMED: Final = 5
"""Largest number of nodes in a warning."""

ROUNDED: Final = 1e-6
"""Distance over the face size that is rounding of coordinates in the deck."""

ROTATIONS: Final = (4, 5, 6)
"""Dofs of rotations."""

ROUNDING: Final = 1e-12
"""Largest cosine that is rounding."""


@dataclass(frozen=True, slots=True)
class _Sector:
    """*CYCLIC SYMMETRY MODEL: point and unit vector of the axis, and the angle of a sector."""

    point: FloatArray
    axis: FloatArray
    angle: float

    def turn(self, sign: int) -> FloatArray:
        """Return the rotation (3, 3) to the next sector; sign -1: to the previous one."""
        rotation = rotation_matrices(sign * self.angle * self.axis[None])[0]
        return np.where(np.abs(rotation) <= ROUNDING, 0.0, rotation)

    def distances(self, points: FloatArray) -> FloatArray:
        """Return the distances (n,) of points from the axis."""
        return np.asarray(np.linalg.norm(np.cross(points - self.point, self.axis), axis=1))


@dataclass(frozen=True, slots=True)
class _Weights:
    """Weights (m, n) of main nodes for secondary nodes (m,): at their nearest points, and as means."""

    nearest: sparse.csr_array
    means: sparse.csr_array


@dataclass(frozen=True, slots=True)
class _Tie:
    """A data line of *TIE.

    nodes     (m,) that are tied
    weights   of the nodes of the main surface; corners: those between the corners of the faces, for dofs that only the
              corners have
    common     dofs that all nodes of both surfaces have
    offsets   (m, 3) from the points to the nodes that follow them; zero after ADJUST
    turn      (3, 3) rotation to the main surface; None: identity
    both      nodes on both surfaces of a sector
    """

    row: Row
    nodes: IntArray
    weights: _Weights
    corners: _Weights | None
    common: frozenset[int]
    offsets: FloatArray
    turn: FloatArray | None
    tolerance: float
    both: IntArray


class TieReader:
    """Reader of *TIE."""

    def __init__(self, flat: FlatMesh, surfaces: Surfaces, solid: bool, problems: Problems) -> None:
        """Prepare the reader; solid: the model is three-dimensional."""
        self._flat, self._surfaces, self._solid, self._problems = flat, surfaces, solid, problems
        self._points = flat.mesh.coordinates
        self._sector: _Sector | None = None
        self._ties: dict[Source, list[_Tie]] = {}

    def find(self, active: Sequence[frozenset[int]], axisymmetric: np.ndarray) -> None:
        """Find the tied nodes of all ties, and move them by ADJUST.

        Parameters
        ----------
        active
            Active dofs of each node.
        axisymmetric
            (n,) mask of the nodes of axisymmetric elements.
        """
        self._active, self._axisymmetric = active, axisymmetric
        with self._problems.gather():
            self._find_sector()
        for block, owner in self._flat.blocks("TIE"):
            with self._problems.gather():
                self._ties[block.source] = self._find(block, owner)

    def check(self, steps: Sequence[Step]) -> None:
        """Refuse steps whose solution differs between sectors."""
        cyclic = self._cyclic()
        for step in steps if cyclic else ():
            procedure = step.procedure
            # modes differ from sector to sector
            if procedure.inertia or (procedure.linear and procedure.keyword != "STATIC"):
                where = f"*{procedure.keyword} ({step.source})"
                self._problems.add(cyclic[0].source, f"*TIE: CYCLIC SYMMETRY is not supported with {where}")

    def _cyclic(self) -> list[Block]:
        return [block for block, _ in self._flat.blocks("TIE") if block.options.flag("CYCLIC SYMMETRY")]

    def _find_sector(self) -> None:
        """Read *CYCLIC SYMMETRY MODEL. Raises DeckError."""
        cyclic, models = self._cyclic(), [block for block, _ in self._flat.blocks("CYCLIC SYMMETRY MODEL")]
        if models and not cyclic:
            raise models[0].error("no *TIE has CYCLIC SYMMETRY")
        if cyclic and not models:
            raise cyclic[0].error("CYCLIC SYMMETRY needs *CYCLIC SYMMETRY MODEL")
        if models:
            self._sector = self._read_sector(models[0])

    def _read_sector(self, block: Block) -> _Sector:
        count = block.options.integer("N", 0)
        if count < 1:
            raise block.error(f"N={count}: expected at least one sector")
        row = block.required_row("the points a and b of the axis")
        row.at_most(6)
        first, second = np.array([row.real(k, "coordinate", 0.0) for k in range(6)]).reshape(2, 3)
        axis = second - first if self._solid else np.array([0.0, 0.0, 1.0])
        length = float(np.linalg.norm(axis))
        if not length > 0.0:
            raise row.error("points a and b of the axis are the same")
        axis = np.where(np.abs(axis) <= ROUNDING * length, 0.0, axis) / length
        return _Sector(first, axis, 2.0 * np.pi / count)

    def read(self, block: Block, held: dict[int, set[int]], *, nlgeom: bool) -> Iterator[Equation]:
        """Yield the equations of the ties of a keyword, after `find`.

        Parameters
        ----------
        block
            The keyword.
        held
            Dofs of nodes that are zero in each step: no equation is needed where both surfaces have them; a secondary
            node with such a dof follows the nearest point in it.
        nlgeom
            Whether a step has NLGEOM.
        """
        rotations = not block.options.flag("NO ROTATION")
        # no motion out of the plane in a plane model, even where masses and springs have the dof
        without = {3, 4, 5} if not self._solid else set()
        without |= set() if rotations else set(ROTATIONS)
        for tie in self._ties.get(block.source, ()):
            yield from self._on_axis(tie)
            rotates = False
            for k, node in enumerate(tie.nodes.tolist()):
                for dof in sorted(self._active[node] - without):
                    row = self._row(tie, k, dof, exactly=dof in held.get(node, ()))
                    if row is None or node in row[0]:
                        continue
                    terms = self._terms(dof, *row, tie.turn)
                    arms = self._arms(dof, *row, tie.offsets[k]) if rotations else []
                    rotates |= bool(arms)
                    same = dof in held.get(node, ()) and all(j in held.get(other, ()) for other, j, _ in terms)
                    if not same:
                        yield Equation(((node, dof, 1.0), *terms, *arms), tie.row.source)
            if rotates and nlgeom:
                message = "nodes beside the main surface follow its rotations as small ones, also with NLGEOM"
                self._problems.warn(tie.row.source, f"*TIE: {message}")
            elif nlgeom and tie.offsets.any():
                message = (
                    "the gap between the surfaces does not turn with them: it resists large rotations; ADJUST closes it"
                )
                self._problems.warn(tie.row.source, f"*TIE: {message}")

    def _row(self, tie: _Tie, k: int, dof: int, *, exactly: bool) -> tuple[list[int], list[float]] | None:
        """Return the main nodes of the k-th secondary node in a dof, and their weights; None if they lack the dof."""
        candidates = (tie.weights,) if tie.corners is None or dof in tie.common else (tie.corners, tie.weights)
        for weights in candidates:
            matrix = weights.nearest if exactly else weights.means
            entries = slice(matrix.indptr[k], matrix.indptr[k + 1])
            nodes = matrix.indices[entries].tolist()
            if all(dof in self._active[other] for other in nodes):
                return nodes, matrix.data[entries].tolist()
        return None

    def _arms(self, dof: int, nodes: Sequence[int], weights: Sequence[float], offset: FloatArray) -> list[Term]:
        """Return the terms of theta x offset in a displacement, none if the main surface has no rotations."""
        if dof > 3 or not offset.any() or not all(self._active[node] >= {4, 5, 6} for node in nodes):
            return []
        first, second = dof % 3, (dof + 1) % 3
        axes = ((4 + first, float(offset[second])), (4 + second, -float(offset[first])))
        return [(node, turn, -w * arm) for node, w in zip(nodes, weights, strict=True) for turn, arm in axes if arm]

    def _terms(self, dof: int, nodes: Sequence[int], weights: Sequence[float], turn: FloatArray | None) -> list[Term]:
        """Return the terms of main nodes in a dof, rotated by `turn`."""
        components = [(dof, 1.0)]
        if turn is not None and dof <= ROTATIONS[-1]:
            base = 0 if dof < ROTATIONS[0] else ROTATIONS[0] - 1
            components = [(base + k + 1, float(cosine)) for k, cosine in enumerate(turn[dof - base - 1])]
        return [
            (node, other, -weight * cosine)
            for node, weight in zip(nodes, weights, strict=True)
            for other, cosine in components
            if weight * cosine != 0.0
        ]

    def _on_axis(self, tie: _Tie) -> Iterator[Equation]:
        """Yield the equations of nodes on the axis, which move along it and rotate about it: u_j = (n_j/n_k) u_k."""
        if not len(tie.both):
            return
        assert self._sector is not None
        axis = self._sector.axis
        off = tie.both[self._sector.distances(self._points[tie.both]) > tie.tolerance]
        if len(off):
            raise tie.row.error(f"node {self._flat.mesh.name(int(off[0]))} is on both surfaces, but not on the axis")
        k = int(np.argmax(np.abs(axis)))
        others = [(base + j + 1, base + k + 1, float(axis[j] / axis[k])) for base in (0, 3) for j in range(3) if j != k]
        for node in tie.both.tolist():
            for dof, along, ratio in others:
                if dof in self._active[node]:
                    terms = ((node, along, -ratio),) if ratio else ()
                    yield Equation(((node, dof, 1.0), *terms), tie.row.source)

    def _find(self, block: Block, owner: Owner) -> list[_Tie]:
        """Find the tied nodes of each data line."""
        if block.options.flag("CYCLIC SYMMETRY") and self._sector is None:
            # the error of the sector is reported already
            return []
        if block.options.has("POSITION TOLERANCE") and block.options.has("TIED NSET"):
            raise block.error("POSITION TOLERANCE and TIED NSET exclude each other")
        return [self._find_row(block, row, owner) for row in block.rows()]

    def _find_row(self, block: Block, row: Row, owner: Owner) -> _Tie:
        secondary, main = (self._surfaces.nodes(row.name(k, "surface"), row.source, owner.name) for k in range(2))
        if not len(main) or not len(secondary):
            raise row.error("a surface has no nodes")
        side, faces = (read_faces(self._surfaces, row, k, owner) for k in range(2))
        size = mean_spacing(self._points[main]) if faces is None else faces.edge(self._points)
        tolerance = block.options.real("POSITION TOLERANCE", CLOSE * size)
        cyclic, both = block.options.flag("CYCLIC SYMMETRY"), np.zeros(0, dtype=np.int64)
        if cyclic:
            both = np.intersect1d(secondary, main)
            secondary = np.setdiff1d(secondary, both)
        if block.options.has("TIED NSET"):
            tolerance = np.inf
            secondary = np.intersect1d(
                secondary, self._flat.nodes(block.options.text("TIED NSET"), block.source, owner.name)
            )
            if not len(secondary):
                raise row.error("no node of the first surface is in TIED NSET")
        thick = 0.0
        if not block.options.flag("NO THICKNESS"):
            thick = sum(surface.half_thickness for surface in (side, faces) if surface is not None)
        rotations: list[FloatArray | None] = [None]
        if cyclic and self._sector is not None:
            rotations = [self._sector.turn(1), self._sector.turn(-1)]
        attempts = [(turn, *self._nearest(secondary, main, faces, self._rotated(main, turn))) for turn in rotations]
        turn, nearest, distance = min(attempts, key=lambda attempt: float(np.minimum(attempt[2], size).sum()))
        near = distance - thick <= tolerance
        if len(secondary) and not near.any():
            raise row.error(
                f"no node of the first surface is within {tolerance:g} of the second one; expected surfaces that "
                "touch, or a larger POSITION TOLERANCE"
            )
        self._warn_far(row, secondary[~near], tolerance)
        secondary, nearest = secondary[near], sparse.csr_array(nearest[np.flatnonzero(near)])
        points = self._rotated(main, turn)
        if block.options.flag("ADJUST"):
            self._adjust(row, secondary, nearest @ points, (thick, size))
        weights = self._weights(block, (row, secondary, nearest), (side, faces), points, tolerance + thick)
        corners = None
        if faces is not None and (faces.quadratic or (side is not None and side.quadratic)):
            pointed = self._nearest(secondary, main, faces.corners, points)[0]
            sides = None if side is None else side.corners, faces.corners
            corners = self._weights(block, (row, secondary, pointed), sides, points, tolerance + thick)
        common = frozenset.intersection(*(self._active[node] for node in np.union1d(secondary, main).tolist()))
        offsets = self._points[secondary] - weights.means @ points
        offsets[np.linalg.norm(offsets, axis=1) <= ROUNDED * size] = 0.0
        return _Tie(row, secondary, weights, corners, common, offsets, turn, tolerance, both)

    def _adjust(self, row: Row, secondary: IntArray, at: FloatArray, sizes: tuple[float, float]) -> None:
        """Move nodes to points `at` (m, 3), except with shells; sizes: shell thickness and face size."""
        thick, size = sizes
        gap = np.linalg.norm(self._points[secondary] - at, axis=1) - thick
        if not thick:
            separate = gap > ROUNDING * size
            self._points[secondary[separate]] = at[separate]
        elif (np.abs(gap) > ROUNDED * size).any():
            self._problems.warn(row.source, "*TIE: nodes beside shells stay where they are; Abaqus adjusts them")

    def _warn_far(self, row: Row, nodes: IntArray, tolerance: float) -> None:
        if len(nodes):
            names = ", ".join(self._flat.mesh.name(node) for node in nodes[:NAMED].tolist())
            names += f" and {len(nodes) - NAMED} more" if len(nodes) > NAMED else ""
            message = f"nodes of the first surface farther than {tolerance:g} from the second one stay untied: {names}"
            self._problems.warn(row.source, f"*TIE: {message}")

    def _rotated(self, main: IntArray, turn: FloatArray | None) -> FloatArray:
        """Return (n, 3) coordinates, with the main surface rotated into the next sector."""
        points = self._points.copy()
        if turn is not None and self._sector is not None:
            points[main] = (points[main] - self._sector.point) @ turn.T + self._sector.point
        return points

    def _nearest(
        self, secondary: IntArray, main: IntArray, faces: TiedFaces | None, coordinates: FloatArray
    ) -> tuple[sparse.csr_array, FloatArray]:
        """Return weights (m, n) of the nearest points on the main surface, and their distances (m,)."""
        dimension = 3 if self._solid else 2
        return nearest_points(self._points[secondary], main, faces, coordinates, dimension)

    def _weights(
        self,
        block: Block,
        tied: tuple[Row, IntArray, sparse.csr_array],
        sides: tuple[TiedFaces | None, TiedFaces | None],
        points: FloatArray,
        reach: float,
    ) -> _Weights:
        """Return the weights of tied nodes: at the nearest points, and as means."""
        row, secondary, nearest = tied
        side, faces = sides
        if block.options.text("TYPE") == "NODE TO SURFACE" or side is None or faces is None:
            return _Weights(nearest, nearest)
        dimension = 3 if self._solid else 2
        if side.dimension != dimension - 1 or faces.dimension != dimension - 1:
            return _Weights(nearest, nearest)
        coordinates = self._points[:, :dimension], points[:, :dimension]
        reach = min(reach, float(side.edge(self._points) + faces.edge(points)))
        round_axis = bool(self._axisymmetric[secondary].all())
        entries = nearest.tocoo()
        every = sparse.coo_array(
            (entries.data, (secondary[entries.row], entries.col)), shape=(len(points),) * 2
        ).tocsr()
        means, valid = surface_weights(side.nodes, faces.nodes, coordinates, every, reach, round_axis=round_axis)
        mean = valid[secondary].astype(np.float64)
        means = sparse.csr_array(sparse.diags_array(mean) @ means[secondary] + sparse.diags_array(1.0 - mean) @ nearest)
        means.eliminate_zeros()
        if means.nnz > len(secondary):
            message = "nodes follow means of the main surface over their faces, which pass constant stress"
            self._problems.warn(row.source, f"*TIE: {message}; the weights of Abaqus are not published")
        return _Weights(nearest, means)


KEYWORDS = (
    Keyword(
        "TIE",
        "Tie surfaces: all dofs that both have. The nodes of the first one follow the faces of the second, of solids, "
        "cohesive elements, shells, membranes or rigid elements, or the edges of shells, or its nearest nodes if it is "
        "made of nodes. Nodes too far away stay untied, with a warning. Beside a surface with rotations nodes follow "
        "these too; the thickness of shells counts in distances.",
        Where.MODEL,
        (
            NAME,
            Option(
                "POSITION TOLERANCE",
                Kind.REAL,
                "largest distance of nodes that are tied; by default 5 % of the typical edge of the second surface",
            ),
            Option("TIED NSET", Kind.NAME, "the nodes that are tied, whatever their distance"),
            Option("NO ROTATION", doc="rotations stay free"),
            Option("NO THICKNESS", doc="the thickness of shells does not count in distances"),
            Option(
                "CYCLIC SYMMETRY",
                doc="the second surface is that of the next sector of *CYCLIC SYMMETRY MODEL; in static steps",
            ),
            one_of(
                "TYPE",
                "NODE TO SURFACE: nodes follow the nearest points. SURFACE TO SURFACE: they follow means over their "
                "faces, so that constant stress passes; Abaqus' weights are not published",
                ("SURFACE TO SURFACE", "NODE TO SURFACE"),
                default="SURFACE TO SURFACE",
            ),
            Option(
                "ADJUST",
                Kind.SWITCH,
                "move tied nodes onto the second surface; nodes of ties with shells stay where they are",
                default="YES",
            ),
            *ignored("CONSTRAINT RATIO"),
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
