# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact pairs: properties of the interaction, and the points where it is tested."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.damage import Damage

CONTACT: Final = "contact"
"""Name of the field of contact pressures, and of the check of penetrations."""

SLIP_TOLERANCE: Final = 0.005
"""Default SLIP TOLERANCE of *FRICTION: largest elastic slip over the length of a face (Abaqus Keywords Guide)."""

INITIAL: Final = 0.01
"""Initial over final stiffness of PENALTY=NONLINEAR, the default of Abaqus (Scripting Reference, NormalBehavior)."""

STIFFENED: Final = 0.03
"""Overclosure of the final stiffness of PENALTY=NONLINEAR over the length of a face, the default likewise."""

STIFFENING: Final = 1 / 3
"""Overclosure up to which PENALTY=NONLINEAR has the initial stiffness, over that of the final one, both measured from
the clearance of zero pressure, the default likewise.
"""


@dataclass(frozen=True, slots=True)
class Cohesion:
    """*COHESIVE BEHAVIOR of a contact property, with its *DAMAGE INITIATION and the keywords after it.

    stiffness  tractions per separation (force/length^3): normal, first and second shear direction
    """

    stiffness: tuple[float, ...]
    source: Source
    damage: Damage | None = None


@dataclass(frozen=True, slots=True)
class ContactProperty:
    """*SURFACE INTERACTION with its *SURFACE BEHAVIOR, *FRICTION and *COHESIVE BEHAVIOR.

    stiffness       pressure per overclosure (force/length^3); None: the constraint is enforced directly
    clearance       at which there is no pressure yet, where there is a stiffness
    initial         part of the stiffness with which the pressure begins (PENALTY=NONLINEAR); 1: it is constant
    friction        coefficient; 0: none
    slip_tolerance  largest elastic slip over the length of a face
    elastic_slip    largest elastic slip itself, which replaces the tolerance unless it is 0
    cohesion        of points that are in contact at the start
    heat            the first keyword of heat that crosses the contact, which is not conducted here
    """

    name: str
    source: Source
    stiffness: float | None = None
    clearance: float = 0.0
    initial: float = 1.0
    friction: float = 0.0
    slip_tolerance: float = SLIP_TOLERANCE
    elastic_slip: float = 0.0
    cohesion: Cohesion | None = None
    heat: Source | None = None


@dataclass(frozen=True, slots=True)
class ContactPair:
    """*CONTACT PAIR, SMALL SLIDING: a point at each secondary node that faces the main surface.

    The clearance of a point is its normal times the sum of the shares of its nodes, each times their coordinates.

    name        both surfaces, '(SECONDARY,MAIN)'
    dimension   displacements of a node: 2 or 3
    nodes       (m, n) secondary node, then the others; a point with fewer than n repeats one
    shares      (m, n) of these nodes; their sum is zero
    slopes      (m, n, 1 or 2) shares of the nodes in the tangents of the surface with which the normal turns
    normals     (m, 3) unit vectors from the main surface towards the secondary node
    clearances  (m,) at the start, negative where the surfaces overlap
    areas       (m,) of the secondary surface that belong to the nodes
    length      mean length of the faces of the secondary surface
    keyword     from which it comes
    """

    name: str
    property: ContactProperty
    source: Source
    dimension: int
    nodes: IntArray
    shares: FloatArray
    slopes: FloatArray
    normals: FloatArray
    clearances: FloatArray
    areas: FloatArray
    length: float
    keyword: str = "CONTACT PAIR"


@dataclass(frozen=True, slots=True)
class Pieces:
    """A main surface of p pieces, over which points slide from one to the next.

    A piece is X(xi) = sum over its nodes of N X; in the plane N are polynomials 1, xi, xi^2, in space 1, xi, eta,
    xi eta, of faces with middle nodes also xi^2, eta^2, xi^2 eta, xi eta^2. Tangents by xi (and eta) turn the outward
    normal: (t2, -t1) in the plane, their product in space.

    nodes       (p, k) of each piece, repeated where N is zero
    shapes      (p, k, 3, 4 or 8) coefficients of N
    loads       (p, k, 3, 4 or 8) those of the shares of the nodes in a force, whose sum is one
    low, high   (p, 1 or 2) ends of the natural coordinates
    total       (p,) largest sum of them, infinite where there is no such end
    reach_low, reach_high, reach_total  the same of where a point is still above the surface: beyond free edges by the
                extension zone, without end beyond the others
    ring        (p, r) pieces that share a node with a piece, and itself, repeated to fill a row
    """

    nodes: IntArray
    shapes: FloatArray
    loads: FloatArray
    low: FloatArray
    high: FloatArray
    total: FloatArray
    reach_low: FloatArray
    reach_high: FloatArray
    reach_total: FloatArray
    ring: IntArray


@dataclass(frozen=True, slots=True)
class RigidProfile:
    """An analytical rigid surface in the plane, of p lines and arcs; the outward normal is (t2, -t1), t along it.

    With the natural coordinate xi from -1 to 1 a point is middle + xi half on a line, and on an arc middle + radius
    times (cos, sin) of half[0] + xi half[1].

    reference  node with which it moves
    middle     (p, 2) of a line, or centre of an arc
    half       (p, 2)
    radius     (p,), 0 of a line
    free       (p, 2) whether the start and the end are ends of the surface
    """

    reference: int
    middle: FloatArray
    half: FloatArray
    radius: FloatArray
    free: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class SlidingPair:
    """*CONTACT PAIR or *CONTACT in finite sliding: a point at each secondary node.

    name        both surfaces, '(SECONDARY,MAIN)'
    dimension   displacements of a node: 2 or 3
    secondary   (m,) nodes
    faces       of the secondary surface by their corners, which are rows of `secondary`, wound like those of `Pieces`;
                none of a surface of nodes
    main        the main surface
    areas       (m,) of the secondary surface that belong to the nodes
    length      mean length of the faces of the secondary surface
    keyword     from which it comes
    """

    name: str
    property: ContactProperty
    source: Source
    dimension: int
    secondary: IntArray
    faces: tuple[IntArray, ...]
    main: Pieces | RigidProfile
    areas: FloatArray
    length: float
    keyword: str = field(default="CONTACT PAIR", kw_only=True)


@dataclass(frozen=True, slots=True)
class Rounded:
    """Curved surface, of d dimensions, that pieces of a surface approximate.

    pieces  (q,) of the surface
    centre  (d,) of a circle in the plane or a sphere, or a point on the axis of revolution
    axis    (d,) unit vector; zero without an axis
    radius  of a torus, of the circle on which the centres of its arcs are, in the plane of `centre`; None: no torus
    """

    pieces: IntArray
    centre: FloatArray
    axis: FloatArray
    radius: float | None = None


@dataclass(frozen=True, slots=True)
class SurfacePair(SlidingPair):
    """Surface to surface in finite sliding: a point at each secondary node of each smooth part of its surface.

    own      the secondary surface, a piece for each face
    corners  (p, k) rows of `secondary` that the nodes of the pieces of `own` are
    depths   (p, k) factor from length or area to area at these nodes
    deepest  (p,) overlap of these pieces at the start of an increment that is none, but the far side of the body
    rounded  what pieces of `own` and of `main` approximate
    """

    own: Pieces
    corners: IntArray
    depths: FloatArray
    deepest: FloatArray
    rounded: tuple[tuple[Rounded, ...], tuple[Rounded, ...]] = field(default=((), ()), kw_only=True)


@dataclass(frozen=True, slots=True)
class ContactChanges:
    """Contact in a pair at the end of an iteration.

    pair         its name
    opened, closed, sticking, slipping  points that changed to this status in it
    penetration  largest error of the clearance of closed points with a constraint, and the node that has it
    force        largest force that points which opened or closed give up or take on, and the node that has it
    """

    pair: str
    opened: int = 0
    closed: int = 0
    sticking: int = 0
    slipping: int = 0
    penetration: tuple[float, int] = (0.0, -1)
    force: tuple[float, int] = (0.0, -1)

    @property
    def count(self) -> int:
        """Severe discontinuities."""
        return self.opened + self.closed + self.sticking + self.slipping
