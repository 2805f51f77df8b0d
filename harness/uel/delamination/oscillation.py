# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Oscillation measures of a traction along or over the interface.

The total variation of a profile, the sum of its steps up and down, counts the variation of the solution as well as what
the discretisation adds. The oscillation index of a profile f is

    1 + (TV(f) - TV(g))/max(TV(g), scale)

with g the reference traction at the same points. It is 1 without oscillations and 1.1 where they add a tenth to
the variation that the solution has. `scale`, the strength of the mode, keeps the traction of a mode that is not
loaded, pure round-off, from counting. g is the solution on a finer mesh of the same interface, averaged over
the tributary area of each point (`harness/uel/paper/study/reference.py`): on an interface with bumps the true tractions
vary from facet to facet, and f alone does not distinguish this from an error.

In this index missing variation in one region may compensate excess in another. The error index

    1 + TV(f - g)/max(TV(g), scale)

excludes such cancellation. It also counts other errors, such as a process zone slightly ahead on the coarser mesh, and
so is far from 1 on any mesh; only its increase by bumps or a stiffness is oscillation.

If only f is known, the raw index uses as g the smooth profile closest to f. The traction on a straight
interface has few extrema on any mesh: it rises through the process zone, changes sign ahead of it, decays, and varies
at a load and at a support. Spurious oscillations have extrema at every element. So g is, among the profiles of at most
`PIECES` monotone pieces nearest in the maximum norm, the one of least total variation. On a straight interface the raw
index equals the index; on bumps it counts true variation as oscillation.

TV(g) has a closed form. Extrema of f cancel in pairs, the closest values first, until few enough pieces remain; at an
end of the profile the end point is removed. With c the largest cancelled difference, no profile of as few pieces is
nearer than c/2, and every remaining extremum may move by c/2 towards its neighbours, so that TV(g) is the sum of
|difference| - c over the remaining pieces. For a zig-zag on a smooth profile, g is that smooth profile; where the
remaining extrema do not oscillate, g is slightly too flat and the raw index too high.

For a smooth profile the indices do not depend on the number of points, and oscillations count whatever their
wavelength: a zig-zag of amplitude A adds 2 A per point, ten times as much on ten times as many elements. A profile with
fewer extrema than `PIECES` allows has the raw index 1 even if they are spurious.

On a surface the total variation is the integral of |grad f|, here per unit of width. A straight front then has the
variation of a profile across it for any mesh orientation; differences along mesh lines would add up to |cos| + |sin|
times that, 1.22 times on a mesh rotated by 15 degrees. f is given at points in rows and columns. Between four of them
it is linear on the two triangles of a diagonal, and the result is the mean over both diagonals: it depends neither on
the numbering nor on the direction, and where f is constant along the front it equals the variation of the profile. A
checkerboard of amplitude A at spacing h has the slope 2 A/h in both directions and adds 2 sqrt(2) A/h per unit of area.
g is again the solution on finer elements, averaged over the tributary areas. There is no raw index: the nearest field
of few pieces has no closed form.
"""

from __future__ import annotations

import itertools

import numpy as np

from uel.model.arrays import FloatArray

# a smooth traction in these specimens has up to six pieces: three around the crack tip, and up to three from a load
# and from the support or clamp. The value hardly matters: with four to ten, the stabilised element on a structured
# mesh has indices of 1.000 to 1.008 in all three specimens.
PIECES = 6


def total_variation(profile: FloatArray) -> float:
    """Return the sum of |f_{k+1} - f_k| over a profile (n,); 0 for fewer than two values."""
    return float(np.sum(np.abs(np.diff(profile))))


def turns(profile: FloatArray) -> FloatArray:
    """Return the first value, local extrema and last value of a profile (n,); one value where it is constant."""
    values = profile[np.concatenate([[True], np.diff(profile) != 0.0])] if len(profile) else profile
    if len(values) < 3:
        return values
    rises = np.diff(values) > 0.0
    return np.asarray(values[np.concatenate([[True], rises[1:] != rises[:-1], [True]])])


def cancelled(profile: FloatArray, pieces: int) -> tuple[FloatArray, float]:
    """Return the remaining extrema (m <= pieces + 1,), ends included, and the largest cancelled difference c.

    Parameters
    ----------
    profile
        Values (n,) along the interface.
    pieces
        Largest number of monotone pieces, at least 1.
    """
    remaining, largest = turns(profile), 0.0
    while len(remaining) > pieces + 1:
        differences = np.abs(np.diff(remaining))
        k = int(np.argmin(differences))
        largest = max(largest, float(differences[k]))
        # of a pair at an end the end point is removed: the extremum beside it becomes the end
        first, last = k + (k == len(remaining) - 2), k + 1 + (k > 0)
        remaining = np.concatenate([remaining[:first], remaining[last:]])
    return remaining, largest


def smooth_variation(profile: FloatArray) -> float:
    """Return TV(g): the least total variation of the nearest profiles of at most PIECES monotone pieces."""
    remaining, largest = cancelled(profile, PIECES)
    return float(np.sum(np.abs(np.diff(remaining)) - largest))


def surface_variation(points: FloatArray, field: FloatArray, width: float) -> float:
    """Return the integral of |grad f| over a surface, per unit of width; in the unit of f.

    Parameters
    ----------
    points
        Coordinates (rows, columns, 2) in the plane of the surface; rows and columns follow the mesh lines.
    field
        f at these points (rows, columns).
    width
        Length of the front.
    """
    # the triangles at the four corners of each cell are those of both diagonals
    corners = [(slice(None, -1), slice(1, None))[::step] for step in (1, -1)]
    integral = 0.0
    for (row, next_row), (column, next_column) in itertools.product(corners, corners):
        here, there, across = (row, column), (row, next_column), (next_row, column)
        (ax, ay), (bx, by) = (np.moveaxis(points[end] - points[here], -1, 0) for end in (there, across))
        a, b = (field[end] - field[here] for end in (there, across))
        # gradient times twice the area; a triangle has half of that, and the weight of a diagonal is half
        integral += float(np.sum(np.hypot(a * by - b * ay, b * ax - a * bx)))
    return 0.25 * integral / width


def _index(variation: float, reference: float, scale: float) -> float:
    return 1.0 + (variation - reference) / max(reference, scale)


def oscillation_index(profile: FloatArray, reference: FloatArray, scale: float) -> float:
    """Return 1 + (TV(f) - TV(g))/max(TV(g), scale).

    Parameters
    ----------
    profile
        f: values (n,) along the interface.
    reference
        g: reference values (m,), not necessarily at the same points.
    scale
        Variation, in the unit of the profile, below which g counts as flat: the strength of the mode.
    """
    return _index(total_variation(profile), total_variation(reference), scale)


def surface_index(points: FloatArray, field: FloatArray, reference: FloatArray, scale: float, width: float) -> float:
    """Return the `oscillation_index` of fields (rows, columns) on a surface; places as in `surface_variation`."""
    return _index(surface_variation(points, field, width), surface_variation(points, reference, width), scale)


def error_index(profile: FloatArray, reference: FloatArray, scale: float) -> float:
    """Return 1 + TV(f - g)/max(TV(g), scale), of profiles (n,) at the same points, as in `oscillation_index`."""
    return 1.0 + total_variation(profile - reference) / max(total_variation(reference), scale)


def raw_index(profile: FloatArray, scale: float) -> float:
    """Return 1 + (TV(f) - TV(g))/max(TV(g), scale), g smooth with at most PIECES monotone pieces."""
    return _index(total_variation(profile), smooth_variation(profile), scale)
