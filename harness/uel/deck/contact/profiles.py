# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Analytical rigid surfaces: *SURFACE, TYPE=SEGMENTS, with the reference node of *RIGID BODY.

The outward normal is on the left, seen from the start to the end.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from uel.contact import RigidSurface
from uel.deck.constraints.couplings import bodies_with_surfaces, reference_node
from uel.deck.language.blocks import Block, Row
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.mesh.placement import Placement
from uel.deck.mesh.surfaces import Surfaces
from uel.errors import Source
from uel.model.arrays import FloatArray
from uel.model.contact import RigidProfile

CLOSE = 1e-3
"""Relative difference of the radii at both ends of an arc that a deck may have."""


@dataclass(frozen=True, slots=True)
class _Segment:
    """Line, or arc of less than 180 degrees about a centre."""

    start: FloatArray
    end: FloatArray
    centre: FloatArray | None

    @property
    def tangents(self) -> tuple[FloatArray, FloatArray]:
        """Directions at the start and the end."""
        if self.centre is None:
            along = (self.end - self.start) / np.linalg.norm(self.end - self.start)
            return along, along
        sign = np.sign(_angles(self.start, self.end, self.centre)[1])
        arms = [(point - self.centre) / np.linalg.norm(point - self.centre) for point in (self.start, self.end)]
        first, last = (sign * np.array([-arm[1], arm[0]]) for arm in arms)
        return first, last


def find_profile(name: str, source: Source, scope_name: str, flat: FlatMesh, surfaces: Surfaces) -> RigidProfile | None:
    """Return an analytical rigid surface, None for a surface of another type. Raises DeckError."""
    profile = surfaces.profile(name, source, scope_name)
    if profile is None:
        return None
    scope, block, radius = profile
    instance = next(owner for owner in flat.owners if owner.name == scope)
    reference = _reference(block, name, source, flat, surfaces)
    ways = _read(block, instance.placement)
    return _profile(_filleted(ways, radius, block) if radius else ways, reference)


def _reference(surface: Block, name: str, source: Source, flat: FlatMesh, surfaces: Surfaces) -> int:
    """Return the reference node of the rigid body with the surface. Raises DeckError without one."""
    for body, owner, surface_name in bodies_with_surfaces(flat):
        if surfaces.locate(surface_name, body.source, owner.name)[1] is surface:
            return reference_node(body, owner, flat)
    raise surface.error(f"needs *RIGID BODY, ANALYTICAL SURFACE={name}, for a contact pair uses it ({source})")


def reference_dofs(flat: FlatMesh) -> frozenset[int]:
    """Return the dofs of the reference nodes of analytical rigid surfaces; empty without such surfaces."""
    return frozenset(RigidSurface.dofs if any(True for _ in bodies_with_surfaces(flat)) else ())


def _read(block: Block, placement: Placement) -> list[_Segment]:
    if placement.turn(np.eye(3))[2, 2] < 0.5:
        raise block.error("its instance is turned out of the plane, which is not supported")
    rows = list(block.rows())
    if not rows or rows[0].name(0, "START") != "START":
        raise block.error("expected START, x, y on the first data line")
    rows[0].at_most(3)
    last, ways = _point(rows[0], 1, placement), []
    for row in rows[1:]:
        kind, end = row.name(0, "LINE or CIRCL"), _point(row, 1, placement)
        if kind not in ("LINE", "CIRCL"):
            raise row.unsupported(f"segment {kind}", ("LINE", "CIRCL"))
        row.at_most(3 if kind == "LINE" else 5)
        if np.array_equal(last, end):
            raise row.error("the segment has no length")
        centre = None if kind == "LINE" else _point(row, 3, placement)
        if centre is not None:
            _check_arc(last, end, centre, row)
        ways.append(_Segment(last, end, centre))
        last = end
    if not ways:
        raise block.error("expected LINE or CIRCL on the second data line")
    return ways


def _check_arc(start: FloatArray, end: FloatArray, centre: FloatArray, row: Row) -> None:
    radii = [float(np.linalg.norm(point - centre)) for point in (start, end)]
    if not min(radii) > 0.0 or abs(radii[0] - radii[1]) > CLOSE * radii[0]:
        raise row.error(f"the ends of the arc are {radii[0]:g} and {radii[1]:g} from its centre; expected the same")
    if np.pi - abs(_angles(start, end, centre)[1]) < CLOSE:
        raise row.error("the arc has 180 degrees; expected less")


def _filleted(lines: list[_Segment], radius: float, block: Block) -> list[_Segment]:
    """Insert arcs of this radius at corners between lines. Raises DeckError."""
    segments = [lines[0]]
    for segment_after in lines[1:]:
        before = segments[-1]
        into, out = before.tangents[1], segment_after.tangents[0]
        turn = float(np.arctan2(into[0] * out[1] - into[1] * out[0], into @ out))
        if abs(turn) > CLOSE:
            cut = radius * np.tan(0.5 * abs(turn))
            if before.centre is not None or segment_after.centre is not None:
                raise block.unsupported("FILLET RADIUS beside an arc that meets its neighbour at an angle")
            if not cut < min(np.linalg.norm(segment.end - segment.start) for segment in (before, segment_after)):
                raise block.error(f"an arc of FILLET RADIUS={radius:g} does not fit between two of its lines")
            start, end = before.end - cut * into, segment_after.start + cut * out
            side = np.sign(turn) * np.array([-into[1], into[0]])
            segments[-1] = replace(before, end=start)
            segments.append(_Segment(start, end, start + radius * side))
            segments.append(replace(segment_after, start=end))
        else:
            segments.append(segment_after)
    return segments


def _profile(ways: list[_Segment], reference: int) -> RigidProfile:
    """Build the profile, reversed so that the outward normal is on the right, as on all main surfaces."""
    count = len(ways)
    middle, half, radius = np.zeros((count, 2)), np.zeros((count, 2)), np.zeros(count)
    for k, way in enumerate(reversed(ways)):
        if way.centre is None:
            middle[k], half[k] = 0.5 * (way.start + way.end), 0.5 * (way.start - way.end)
        else:
            first, sweep = _angles(way.start, way.end, way.centre)
            middle[k], half[k] = way.centre, (first + 0.5 * sweep, -0.5 * sweep)
            radius[k] = np.linalg.norm(way.start - way.centre)
    size = max(float(np.linalg.norm(way.end - way.start)) for way in ways)
    free = np.zeros((count, 2), dtype=np.bool_)
    free[0, 0] = free[-1, 1] = np.linalg.norm(ways[-1].end - ways[0].start) > CLOSE * size
    return RigidProfile(reference, middle, half, radius, free)


def _angles(start: FloatArray, end: FloatArray, centre: FloatArray) -> tuple[float, float]:
    """Return the angle at the start of an arc, and the angle that the arc covers (rad)."""
    first, last = (float(np.arctan2(*(point - centre)[::-1])) for point in (start, end))
    return first, (last - first + np.pi) % (2.0 * np.pi) - np.pi


def _point(row: Row, index: int, placement: Placement) -> FloatArray:
    point = np.array([[row.real(index, "x"), row.real(index + 1, "y"), 0.0]])
    return np.asarray(placement.move(point)[0, :2])
