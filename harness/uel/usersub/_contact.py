# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Typed interface to the arithmetic of contact points (fortran/host/entry/contact.f90).

Coordinates are (n, d) of all nodes of the model; natural coordinates (m, a) of points (m,) on pieces (m,).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import Pieces
from uel.usersub._extension import host
from uel.usersub.exchange import Int32Array


class SparseValues(NamedTuple):
    """Values of a CSR matrix with its pattern, whose columns ascend in each row."""

    indptr: Int32Array
    indices: Int32Array
    values: FloatArray


class Hits(NamedTuple):
    """Projections of m points onto the nearest pieces.

    piece     (m,)
    natural   (m, a), beyond the ends of the piece too
    within    (m, a) clipped to the piece
    distance  (m,) from the piece; the largest number if no piece faces the point
    above     (m,) whether the projection is in the reach of the piece
    """

    piece: IntArray
    natural: FloatArray
    within: FloatArray
    distance: FloatArray
    above: NDArray[np.bool_]


class Samples(NamedTuple):
    """Samples (q,) of a secondary surface: shape functions (q, l) of its nodes, and projections onto pieces."""

    own: FloatArray
    piece: IntArray
    natural: FloatArray


def monomials(natural: FloatArray, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Evaluate the first ones of 1, xi, xi^2 or 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2,
    and their derivatives.

    Parameters
    ----------
    natural
        (m, 1 or 2) natural coordinates.
    count
        p of them: 3 on a line, 4 or 8 on an area.

    Returns
    -------
    tuple[FloatArray, FloatArray, FloatArray]
        (m, p), with first (m, p, a) and second derivatives (m, p, a, a).
    """
    m, along = natural.shape
    values, first, second = np.zeros((m, count)), np.zeros((m, count, along)), np.zeros((m, count, along, along))
    if m:
        host.host_contact_monomials(natural.T, values.T, first.T, second.T)
    return values, first, second


def sizes(nodes: IntArray, coordinates: FloatArray) -> FloatArray:
    """Return (m,) largest distances of the nodes (m, k) of faces from their centroids."""
    return host.host_contact_sizes(nodes.T, coordinates.T) if len(nodes) else np.zeros(0)


def frames(tangents: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return unit normals (m, d) and metrics (m, a, a) of tangents (m, a, d), regularized where these are dependent."""
    m, along, dimension = tangents.shape
    normals, metrics = np.zeros((m, dimension)), np.zeros((m, along, along))
    if m:
        host.host_contact_frames(tangents.T, normals.T, metrics.T)
    return normals, metrics


def feet(
    pieces: Pieces, coordinates: FloatArray, piece: IntArray, natural: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return points (m, d) of pieces, tangents (m, a, d) there and their derivatives (m, a, a, d)."""
    (m, along), dimension = natural.shape, coordinates.shape[1]
    at, tangents = np.zeros((m, dimension)), np.zeros((m, along, dimension))
    second = np.zeros((m, along, along, dimension))
    if m:
        of_faces = pieces.shapes.T, pieces.nodes.T, coordinates.T
        host.host_contact_feet(*of_faces, piece, natural.T, at.T, tangents.T, second.T)
    return at, tangents, second


def search(
    pieces: Pieces,
    coordinates: FloatArray,
    facing: float,
    points: tuple[FloatArray, FloatArray],
    before: IntArray,
    near: IntArray,
    most: int,
) -> Hits:
    """Find the pieces nearest to points.

    Parameters
    ----------
    pieces, coordinates
        Surface in its current position.
    facing
        Largest cosine between the normals of a point and of its piece.
    points
        Coordinates and outward normals (m, d); a zero normal: any piece.
    before, near
        Pieces (m,) and (m, c) from which the nearest one is taken at first.
    most
        Number of pieces that a point then passes, from one to the next; 0: none.
    """
    m, along = len(before), pieces.low.shape[1]
    piece, natural, within = np.zeros(m, dtype=np.int64), np.zeros((m, along)), np.zeros((m, along))
    distance, above = np.zeros(m), np.zeros(m, dtype=np.int32)
    if m:
        host.host_contact_search(
            pieces.shapes.T,
            pieces.nodes.T,
            coordinates.T,
            pieces.low.T,
            pieces.high.T,
            pieces.total,
            pieces.reach_low.T,
            pieces.reach_high.T,
            pieces.reach_total,
            pieces.ring.T,
            facing,
            points[0].T,
            points[1].T,
            before,
            near.T,
            most,
            piece,
            natural.T,
            within.T,
            distance,
            above,
        )
    return Hits(piece, natural, within, distance, above > 0)


def derivatives(
    tangents: FloatArray, second: FloatArray, gap: FloatArray, along: FloatArray, across: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives of foot points, see fortran/host/contact/derivatives.f90.

    Parameters
    ----------
    tangents, second
        (m, a, d) and (m, a, a, d) of the foot points.
    gap
        (m,) clearances.
    along, across
        (m, a, u) motions of the points along the tangents, and of the tangents along the normal.

    Returns
    -------
    tuple[FloatArray, FloatArray]
        (m, a, u) of the natural coordinates, and t with -tau_a t_a (m, a, u) of the normal.
    """
    natural_by, tilt = np.zeros(along.shape), np.zeros(along.shape)
    if len(gap):
        host.host_contact_derivatives(tangents.T, second.T, gap, along.T, across.T, natural_by.T, tilt.T)
    return natural_by, tilt


def add_products(
    left: FloatArray, rows: Int32Array, right: FloatArray, columns: Int32Array, matrix: SparseValues
) -> None:
    """Add the sums over r of left x right, (m, r, u) and (m, r, v), to a sparse matrix, which has all their entries.

    rows, columns: unknowns (m, u) and (m, v).
    """
    if left.size and right.size:
        host.host_contact_products(left.T, rows.T, right.T, columns.T, *matrix)


def means(
    pieces: Pieces,
    coordinates: FloatArray,
    samples: Samples,
    pairs: tuple[IntArray, IntArray, FloatArray, IntArray],
    positions: IntArray,
    shape: tuple[int, int],
) -> tuple[FloatArray, FloatArray]:
    """Compute the means of points over samples.

    Parameters
    ----------
    pieces, coordinates, samples
        Surface in its current position, and samples above it.
    pairs
        Samples (r,), which ascend, and points (r,) to which they belong, with weights (r,), and rows (r,) of
        `positions`.
    positions
        (p, l + k) of the nodes of the sample, those of the secondary surface first, among those of the point.
    shape
        Numbers of points m and of nodes n of each.

    Returns
    -------
    tuple[FloatArray, FloatArray]
        Gradients (m, n, d) of the clearances, and shares (m, n) of the nodes in a force.
    """
    gradients, shares = np.zeros((*shape, coordinates.shape[1])), np.zeros(shape)
    if len(pairs[0]):
        host.host_contact_means(
            *_of_samples(pieces, coordinates, samples),
            *pairs,
            positions.T,
            gradients.T,
            shares.T,
        )
    return gradients, shares


def add_stiffness(
    pieces: Pieces,
    coordinates: FloatArray,
    samples: Samples,
    forces: tuple[FloatArray, FloatArray, FloatArray],
    groups: tuple[IntArray, Int32Array],
    matrix: SparseValues,
) -> None:
    """Add the derivatives of the nodal forces of samples to a sparse matrix.

    Parameters
    ----------
    pieces, coordinates, samples
        Surface in its current position, and samples above it.
    forces
        Clearances (q,), contact forces (q,) along the normals, friction forces (q, d).
    groups
        First sample (g + 1,) of each group with the same nodes; unknowns (g, u) of these, those of the secondary
        surface first.
    matrix
        Is changed.
    """
    gap, normal_force, friction = forces
    first, equations = groups
    if len(equations):
        host.host_contact_samples_stiffness(
            *_of_samples(pieces, coordinates, samples),
            gap,
            normal_force,
            friction.T,
            first,
            equations.T,
            *matrix,
        )


_OfSamples = tuple[FloatArray, FloatArray, IntArray, FloatArray, FloatArray, IntArray, FloatArray]


def _of_samples(pieces: Pieces, coordinates: FloatArray, samples: Samples) -> _OfSamples:
    """Return the arguments that say where samples are."""
    of_faces = pieces.shapes.T, pieces.loads.T, pieces.nodes.T, coordinates.T
    return *of_faces, samples.own.T, samples.piece, samples.natural.T
