# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Geometric corrections: *SURFACE SMOOTHING of contact pairs, *SURFACE PROPERTY ASSIGNMENT of general contact."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.definitions import read_definitions
from uel.deck.language.table import NAME, Keyword, Where, one_of
from uel.deck.mesh.surfaces import Surfaces
from uel.model.arrays import FloatArray
from uel.model.contact import Pieces, Rounded

SMOOTHING, ASSIGNMENT = "SURFACE SMOOTHING", "SURFACE PROPERTY ASSIGNMENT"
_COUNTS = {"CIRCUMFERENTIAL": (2, 6), "SPHERICAL": (3,), "TOROIDAL": (7,)}
"""Numbers on a data line; 2 for a circle in the plane."""


@dataclass(frozen=True, slots=True)
class Region:
    """Faces, by their sorted nodes, and the surface that they approximate, as in `Rounded`."""

    faces: frozenset[tuple[int, ...]]
    centre: FloatArray
    axis: FloatArray
    radius: float | None


def read_smoothings(blocks: Iterable[Block], surfaces: Surfaces, problems: Problems) -> dict[str, tuple[Region, ...]]:
    """Read the regions of each *SURFACE SMOOTHING, by name."""

    def read(block: Block) -> tuple[Region, ...]:
        return tuple(region for row in block.rows() for region in _regions(row, 2, surfaces))

    return read_definitions(blocks, SMOOTHING, read, problems)


def read_corrections(blocks: Iterable[Block], surfaces: Surfaces) -> tuple[Region, ...]:
    """Read the regions of *SURFACE PROPERTY ASSIGNMENT."""
    chosen = [block for block in blocks if block.name == ASSIGNMENT]
    return tuple(region for block in chosen for row in block.rows() for region in _regions(row, 1, surfaces))


def _regions(row: Row, names: int, surfaces: Surfaces) -> Iterator[Region]:
    """Yield the regions of a data line; names: number of surfaces at its start. Raises DeckError."""
    kind = row.name(names, "kind of the correction")
    if kind not in _COUNTS:
        raise row.error(f"correction {kind} is not known; expected {', '.join(_COUNTS)}")
    numbers = [row.real(k, "coordinate") for k in range(names + 1, len(row))]
    if len(numbers) not in _COUNTS[kind]:
        counts = " or ".join(map(str, _COUNTS[kind]))
        raise row.error(f"{len(numbers)} numbers of a {kind.lower()} correction, expected {counts}")
    dimension = 2 if len(numbers) == 2 else 3
    centre, axis = np.array(numbers[:dimension]), np.zeros(dimension)
    if len(numbers) > dimension:
        axis = np.array(numbers[3:6]) - centre
        size = float(np.linalg.norm(axis))
        if not size > 0.0:
            raise row.error("the two points on the axis are in the same place")
        axis /= size
    for k in range(names):
        if not row.blank(k):
            name = row.name(k, "surface")
            faces = [group.nodes[rows][:, list(local)] for group, rows, local, _ in surfaces.facets(name, row.source)]
            chosen = frozenset(tuple(sorted(nodes)) for connectivity in faces for nodes in connectivity.tolist())
            if not chosen:
                raise row.error(f"surface {name} has no faces")
            yield Region(chosen, centre, axis, numbers[6] if len(numbers) == 7 else None)


def rounded_pieces(regions: Sequence[Region], pieces: Pieces) -> tuple[Rounded, ...]:
    """Return the curved surfaces that the pieces of a surface approximate."""
    if not regions:
        return ()
    faces = [tuple(sorted(set(nodes))) for nodes in pieces.nodes.tolist()]
    dimension = pieces.low.shape[1] + 1
    matches = [(region, [k for k, face in enumerate(faces) if face in region.faces]) for region in regions]
    return tuple(
        Rounded(np.array(chosen), region.centre, region.axis, region.radius)
        for region, chosen in matches
        if chosen and len(region.centre) == dimension
    )


_LINE = (
    "CIRCUMFERENTIAL and the centre of a circle in the plane, or two points on the axis of revolution; or SPHERICAL "
    "and its centre; or TOROIDAL, two points on the axis, the first one in the plane of the centres of the arcs, and "
    "the distance of these from the axis"
)

KEYWORDS = (
    Keyword(
        "SURFACE SMOOTHING",
        "Curved surfaces that faces of a contact pair approximate: their distances from the faces count in clearances.",
        Where.MODEL,
        (NAME,),
        f"part of the secondary surface, part of the main surface, {_LINE}",
    ),
    Keyword(
        "SURFACE PROPERTY ASSIGNMENT",
        "Curved surfaces that faces in general contact approximate: their distances from the faces count in "
        "clearances.",
        Where.MODEL,
        (
            one_of(
                "PROPERTY",
                "what is assigned",
                ("GEOMETRIC CORRECTION",),
                required=True,
                refused=("FEATURE EDGE CRITERIA", "OFFSET FRACTION", "THICKNESS"),
            ),
        ),
        f"part of a surface, {_LINE}",
    ),
)
