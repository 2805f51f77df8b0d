# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Oscillation measures of a traction along or over the interface.

The total variation of a profile, the sum of its steps up and down, counts the variation of the solution as well as what
the discretisation adds. The oscillation index of a profile f is

    1 + (TV(f) - TV(g))/max(TV(g), scale)

with g the traction that really acts at the same points. It is 1 without oscillations and 1.1 where they add a tenth to
the variation that the solution has. `scale`, the strength of the mode, keeps the traction of a mode that is not
loaded, all of it round-off, from counting. g is the solution on a finer mesh of the same interface, averaged over what
belongs to each point (`harness/uel/paper/study/reference.py`): an interface with bumps carries tractions that vary
from facet to facet in reality, and no function of f alone can distinguish that part from an error.

In the index too little variation in one place may compensate too much in another. The error index

    1 + TV(f - g)/max(TV(g), scale)

lets nothing cancel. It also counts what is not oscillation, such as a process zone that is a little ahead on the
coarser mesh, and so is far from 1 on any mesh; what bumps or a stiffness add to it is oscillation.

If only f is known, the raw index uses as g the smooth profile closest to f. The traction on a straight
interface turns a few times on any mesh: it rises through the process zone, falls to the other sign ahead of it, comes
back, and varies at a load and at a support. Spurious oscillations turn at every element. So this g is, of the profiles
of at most `PIECES` monotone pieces that are nearest in the maximum norm, the one of least total variation. On a
straight interface the raw index is the index; on bumps it counts real variation as oscillation.

Its TV(g) has a closed form. Turns of f cancel in pairs, those closest to each other first, until few enough pieces are
left; at an end of the profile the end itself goes. With c the largest difference that has gone, no profile of as few
pieces is nearer than c/2, and every turn that is left may move by c/2 towards its neighbours, so that TV(g) is the sum
of |difference| - c over the pieces left. For a zig-zag on a smooth profile, g is that smooth profile; where turns that
are left do not oscillate themselves, g is a little too flat, and the raw index errs high.

For a smooth profile no index changes with the number of points, and wiggles count however short they are: a zig-zag of
amplitude A adds 2 A for every point, and ten times as many elements make it ten times as bad. A profile with fewer
turns than `PIECES` allows has the raw index 1 even if they are spurious: a single kink is not an oscillation.

On the surface between two solids the total variation is the integral of |grad f|, here per unit of width. A straight
front then has the variation of a profile across it, however the mesh lines run; steps along mesh lines would add up to
|cos| + |sin| times that, 1.22 times on a mesh turned by 15 degrees. f is known at points in rows and columns. Between
four of them it is linear on either triangle of a diagonal, and the mean over both diagonals counts: neither numbers nor
directions matter, and where f does not change along the front, it is the variation of the profile to the last digit. A
checkerboard of amplitude A at points h apart has the slope 2 A/h in both directions, so that it adds 2 sqrt(2) A/h for
each unit of area. g is again the solution on finer elements, averaged over what belongs to each point. There is no raw
index: no field of few pieces is the nearest by a closed form.
"""

from __future__ import annotations

import itertools

import numpy as np

from uel.model.arrays import FloatArray

# a smooth traction of these specimens has up to six pieces: three about the crack's tip, and up to three from a
# load on the way and from the support or clamp. The value hardly matters: with four to ten, the stabilised element on
# a structured mesh has indices of 1.000 to 1.008 in all three specimens.
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
    """Return the turns left (m <= pieces + 1,), ends included, and the largest difference c of those that cancelled.

    Parameters
    ----------
    profile
        Values (n,) in the order along the interface.
    pieces
        Monotone pieces to be left, at least 1.
    """
    kept, largest = turns(profile), 0.0
    while len(kept) > pieces + 1:
        differences = np.abs(np.diff(kept))
        k = int(np.argmin(differences))
        largest = max(largest, float(differences[k]))
        # of a pair at an end the end itself goes: the extremum beside it becomes the end
        first, last = k + (k == len(kept) - 2), k + 1 + (k > 0)
        kept = np.concatenate([kept[:first], kept[last:]])
    return kept, largest


def smooth_variation(profile: FloatArray) -> float:
    """Return TV(g): the least total variation of the nearest profiles of at most PIECES monotone pieces."""
    kept, largest = cancelled(profile, PIECES)
    return float(np.sum(np.abs(np.diff(kept)) - largest))


def surface_variation(places: FloatArray, field: FloatArray, width: float) -> float:
    """Return the integral of |grad f| over a surface, per unit of width; in the unit of f.

    Parameters
    ----------
    places
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
        (ax, ay), (bx, by) = (np.moveaxis(places[end] - places[here], -1, 0) for end in (there, across))
        a, b = (field[end] - field[here] for end in (there, across))
        # gradient times twice the area; a triangle has half of that, and the weight of a diagonal is half
        integral += float(np.sum(np.hypot(a * by - b * ay, b * ax - a * bx)))
    return 0.25 * integral / width


def _index(variation: float, real: float, scale: float) -> float:
    return 1.0 + (variation - real) / max(real, scale)


def oscillation_index(profile: FloatArray, real: FloatArray, scale: float) -> float:
    """Return 1 + (TV(f) - TV(g))/max(TV(g), scale).

    Parameters
    ----------
    profile
        f: values (n,) in the order along the interface.
    real
        g: what really acts (m,); the two may begin at different points.
    scale
        Variation, in the unit of the profile, below which g counts as flat: the strength of the mode.
    """
    return _index(total_variation(profile), total_variation(real), scale)


def surface_index(places: FloatArray, field: FloatArray, real: FloatArray, scale: float, width: float) -> float:
    """Return the `oscillation_index` of fields (rows, columns) on a surface; places as in `surface_variation`."""
    return _index(surface_variation(places, field, width), surface_variation(places, real, width), scale)


def error_index(profile: FloatArray, real: FloatArray, scale: float) -> float:
    """Return 1 + TV(f - g)/max(TV(g), scale), of profiles (n,) at the same points, as in `oscillation_index`."""
    return 1.0 + total_variation(profile - real) / max(total_variation(real), scale)


def raw_index(profile: FloatArray, scale: float) -> float:
    """Return 1 + (TV(f) - TV(g))/max(TV(g), scale), g smooth with at most PIECES monotone pieces."""
    return _index(total_variation(profile), smooth_variation(profile), scale)
