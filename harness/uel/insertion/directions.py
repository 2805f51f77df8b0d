# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Direction from whose projection on each face the angles of the plies are measured: DIRECTION1 to 3 of an element.

It is constant in space and may be nowhere near the normal of a face, so that one set of properties serves a curved
laminate. In this order:

1. the direction of the command line, at all faces; x, if an angle is given without one;
2. the axis of the cylindrical *ORIENTATION of the ply below, or above: it is the normal nowhere on the cylinder;
3. that of all cylinders, if they are parallel, at other faces too: legs of an angle have the direction of its corner;
4. an axis of a rectangular *ORIENTATION, where x is close to the normal but not along it, so that its projection on an
   uneven face would be any;
5. none, that is x.

Isotropic solids have no angles and need no direction.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from uel.errors import UsageError
from uel.insertion.sections import PARALLEL, Faces, Sections
from uel.model.arrays import FloatArray
from uel.model.face_directions import ALIGNED, LEAST_DEGREES, degrees_between

NAMES: Final = ("DIRECTION1", "DIRECTION2", "DIRECTION3")
_CLOSE: Final = 2.0 * LEAST_DEGREES
"""Degrees between a direction and a normal up to which it is not chosen: at the points of a curved face the normal is
another one."""

Pair = tuple[Faces, Faces]
"""Faces below and above the elements of a type."""


def choose_directions(sections: Sections, pairs: Sequence[Pair], given: Mapping[str, float]) -> list[FloatArray]:
    """Return the directions (k, 3) at the faces of each pair, zero for none.

    Parameters
    ----------
    sections
        Of the solids.
    pairs
        Faces in space of all elements.
    given
        Properties of the command line.

    Raises
    ------
    UsageError
        The given direction is close to the normal of a face.
    """
    chosen = [np.zeros_like(below.normals) for below, _ in pairs]
    direction = np.array([given.get(name, 0.0) for name in NAMES])
    if direction.any():
        for below, _ in pairs:
            _check(sections, below, direction)
        return [values + direction for values in chosen]
    if any(given.get(f"ANGLE {side}") for side in ("BOTTOM", "TOP")):
        return chosen
    axes: list[FloatArray] = []
    for pair, values in zip(pairs, chosen, strict=True):
        for faces in pair:
            _take(sections, pair[0], values, _joined(sections.polar_axes(faces), axes))
    others: list[FloatArray] = []
    for pair, values in zip(pairs, chosen, strict=True):
        in_plane = [sections.plane_axes(faces) for faces in pair]
        if len(axes) == 1:
            has_angle = np.any([found.any(axis=1) for found in in_plane], axis=0)
            _take(sections, pair[0], values, np.where(has_angle[:, None], axes[0], 0.0))
        degrees = degrees_between(pair[0].normals, np.eye(3)[0])
        close = ~values.any(axis=1) & (degrees < _CLOSE)
        if (degrees[close] > ALIGNED).any():
            for found in in_plane:
                _take(sections, pair[0], values, _joined(np.where(close[:, None], found, 0.0), others))
    return chosen


def _take(sections: Sections, faces: Faces, chosen: FloatArray, found: FloatArray) -> None:
    """Put directions that were found, zero for none, where there is none yet and they will do."""
    will_do = (degrees_between(faces.normals, found) > _CLOSE) & sections.stays(faces, found)
    rows = ~chosen.any(axis=1) & found.any(axis=1) & will_do
    chosen[rows] = found[rows]


def _joined(found: FloatArray, axes: list[FloatArray]) -> FloatArray:
    """Replace directions by the parallel ones among those that there are, to which new ones are added."""
    joined = np.zeros_like(found)
    for axis in np.unique(found[found.any(axis=1)], axis=0):
        parallel = next((each for each in axes if abs(each @ axis) > np.cos(PARALLEL)), None)
        if parallel is None:
            parallel = axis + 0.0  # no -0
            axes.append(parallel)
        joined[(found == axis).all(axis=1)] = parallel
    return joined


def _check(sections: Sections, faces: Faces, direction: FloatArray) -> None:
    degrees = degrees_between(faces.normals, direction)
    row = int(degrees.argmin())
    if degrees[row] < LEAST_DEGREES:
        text = " ".join(f"{name}={value:g}" for name, value in zip(NAMES, direction, strict=True))
        where = f"at element {sections.name(faces, row)} it is {degrees[row]:.3g} degrees from the normal"
        raise UsageError(f"{text}: {where} of the interface; expected at least {LEAST_DEGREES:g}")
