# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Analytical rigid surfaces: *SURFACE, TYPE=SEGMENTS, with the reference node that *RIGID BODY gives.

The outward normal is on the left of the way from the start to the end.
"""

from __future__ import annotations

import numpy as np

from harness.deck.blocks import Block, Row
from harness.deck.constraints import bodies_with_surfaces, reference_node
from harness.deck.flatten import FlatMesh
from harness.deck.placement import Placement
from harness.deck.surfaces import Surfaces
from harness.elements import RigidSurface
from harness.errors import Source
from harness.model.arrays import FloatArray
from harness.model.contact import RigidProfile

CLOSE = 1e-3
"""Difference of the distances of both ends of an arc from its centre, over the radius, that a deck may have."""


def find_profile(name: str, source: Source, owner: str, flat: FlatMesh, surfaces: Surfaces) -> RigidProfile | None:
    """An analytical rigid surface, None for another one. Raises DeckError."""
    found = surfaces.profile(name, source, owner)
    if found is None:
        return None
    place, block = found
    level = next(one for one in flat.owners if one.name == place)
    return _read(block, level.placement, _reference(block, name, source, flat, surfaces))


def _reference(surface: Block, name: str, source: Source, flat: FlatMesh, surfaces: Surfaces) -> int:
    """The reference node of the rigid body that has the surface."""
    for body, owner, own in bodies_with_surfaces(flat):
        if surfaces.locate(own, body.source, owner.name)[1] is surface:
            return reference_node(body, owner, flat)
    raise surface.error(f"needs *RIGID BODY, ANALYTICAL SURFACE={name}, for a contact pair uses it ({source})")


def reference_dofs(flat: FlatMesh) -> frozenset[int]:
    """Dofs of the reference nodes of analytical rigid surfaces; none where there are none."""
    return frozenset(RigidSurface.dofs if any(True for _ in bodies_with_surfaces(flat)) else ())


def _read(block: Block, placement: Placement, reference: int) -> RigidProfile:
    if placement.turn(np.eye(3))[2, 2] < 0.5:
        raise block.error("its instance is turned out of the plane, which is not supported")
    rows = list(block.rows())
    if not rows or rows[0].name(0, "START") != "START":
        raise block.error("expected START, x, y on the first data line")
    rows[0].at_most(3)
    last = first = _point(rows[0], 1, placement)
    pieces: list[tuple[FloatArray, FloatArray, float]] = []
    for row in rows[1:]:
        kind, end = row.name(0, "LINE or CIRCL"), _point(row, 1, placement)
        if kind not in ("LINE", "CIRCL"):
            raise row.error(f"segment {kind} is not supported (supported: LINE, CIRCL)")
        row.at_most(3 if kind == "LINE" else 5)
        if np.array_equal(last, end):
            raise row.error("the segment has no length")
        pieces.append(_line(last, end) if kind == "LINE" else _arc(last, end, _point(row, 3, placement), row))
        last = end
    if not pieces:
        raise block.error("expected LINE or CIRCL on the second data line")
    # from the end to the start the outward normal is on the right, as of all main surfaces
    middle, half, radius = (np.array(values) for values in zip(*reversed(pieces), strict=True))
    free = np.zeros((len(pieces), 2), dtype=np.bool_)
    free[0, 0] = free[-1, 1] = not np.allclose(first, last, rtol=0.0, atol=CLOSE * float(np.abs(half).max()))
    return RigidProfile(reference, middle, half, radius, free)


def _point(row: Row, index: int, placement: Placement) -> FloatArray:
    point = np.array([[row.real(index, "x"), row.real(index + 1, "y"), 0.0]])
    return np.asarray(placement.move(point)[0, :2])


def _line(start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Middle, half and radius, from the end to the start."""
    return 0.5 * (start + end), 0.5 * (start - end), 0.0


def _arc(start: FloatArray, end: FloatArray, centre: FloatArray, row: Row) -> tuple[FloatArray, FloatArray, float]:
    radii = [float(np.linalg.norm(point - centre)) for point in (start, end)]
    radius = 0.5 * sum(radii)
    if not radius > 0.0 or abs(radii[0] - radii[1]) > CLOSE * radius:
        raise row.error(f"the ends of the arc are {radii[0]:g} and {radii[1]:g} from its centre; expected the same")
    angles = [float(np.arctan2(*(point - centre)[::-1])) for point in (start, end)]
    sweep = (angles[1] - angles[0] + np.pi) % (2.0 * np.pi) - np.pi
    if np.pi - abs(sweep) < CLOSE:
        raise row.error("the arc has 180 degrees; expected less")
    return centre, np.array([angles[0] + 0.5 * sweep, -0.5 * sweep]), radius
