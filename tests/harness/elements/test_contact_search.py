# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The search for the nearest piece of a surface, against all points of a fine grid on all pieces."""

import numpy as np
import pytest

from uel.contact import FaceSurface
from uel.deck.contact.sliding_surfaces import make_pieces, whole_pieces
from uel.model.element_types import QUAD8

FACING = -0.5
FINE = np.linspace(-1.0, 1.0, 41)


def grid(corners):
    """Points (n, 3) of a quadrilateral or a triangle, its normals there, and which of them are on no edge."""
    s, t = (axis.ravel() for axis in np.meshgrid(FINE, FINE))
    if len(corners) == 3:
        s, t = (0.5 + 0.5 * s)[s + t <= 0], (0.5 + 0.5 * t)[s + t <= 0]
        inner = (s > 0) & (t > 0) & (s + t < 1 - 1e-9)
        along = np.stack([corners[1] - corners[0], corners[2] - corners[0]])
        places = corners[0] + np.outer(s, along[0]) + np.outer(t, along[1])
        return places, np.broadcast_to(np.cross(*along), places.shape), inner
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    one, other = 1 + np.outer(s, signs[:, 0]), 1 + np.outer(t, signs[:, 1])
    first, second = (signs[:, 0] * other) @ corners, (signs[:, 1] * one) @ corners
    return 0.25 * (one * other) @ corners, np.cross(first, second), np.maximum(np.abs(s), np.abs(t)) < 1


@pytest.mark.parametrize("looking", [False, True])
def test_nearest_of_warped_faces(looking):
    """Five faces around a node, where the nearest point is on no edge; those that look the same way are left out."""
    rng = np.random.default_rng(3)
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0), indexing="ij")
    nodes = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3) + rng.uniform(-0.4, 0.4, (9, 3))
    n = np.arange(9).reshape(3, 3)
    four = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4)
    faces = [four[:3], np.stack([four[3, :3], four[3, [0, 2, 3]]])]
    points = rng.uniform([0, 0, -0.7], [2, 2, 0.7], (100, 3))
    looks = rng.normal(size=points.shape) - [0, 0, 1.5]
    looks *= looking / np.linalg.norm(looks, axis=1)[:, None]
    apart, inside, sure = [], [], []
    for corners in [nodes[face] for part in faces for face in part]:
        places, normals, inner = grid(corners)
        every = np.linalg.norm(points[:, None] - places, axis=2)
        least = every.argmin(axis=1)
        normals = normals[least] / np.linalg.norm(normals[least], axis=1)[:, None]
        cosine = np.einsum("md,md->m", normals, looks)
        apart.append(np.where((cosine > FACING) & looking, np.inf, every.min(axis=1)))
        inside.append(inner[least])
        sure.append(np.abs(cosine - FACING) > 0.05)
    apart, inside = np.array(apart), np.array(inside)
    surface = FaceSurface(make_pieces(faces, nodes, 0.0, 0.0), nodes, FACING)
    still, before = np.zeros_like(nodes), np.zeros(len(points), dtype=np.int64)
    piece, _, above = surface.track(points, looks, still, before, everywhere=True)
    ordered = np.sort(apart, axis=0)
    nearest = apart.argmin(axis=0)
    clear = np.all(sure, axis=0) & np.isfinite(ordered[0]) & (ordered[1] > ordered[0] + 0.01)
    clear &= inside[nearest, np.arange(len(points))]
    assert np.count_nonzero(clear) > 20
    np.testing.assert_array_equal(piece[clear], nearest[clear])
    nothing = np.all(sure, axis=0) & np.isinf(ordered[0])
    assert not above[nothing].any()
    assert np.count_nonzero(nothing) > 5 or not looking


def test_faces_that_leave_the_box_of_their_nodes():
    """Middle nodes on one side bend a face beyond all of its nodes: its middle is the nearest point."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    bent = np.column_stack([np.concatenate([corners, middles]), [0] * 4 + [1] * 4])
    flat = np.column_stack([np.concatenate([corners, middles]), [1.9] * 8])
    # the face, z = 2 - x^2 / 2 - y^2 / 2 on its axes: 2 in the middle, and the flat one is further away
    nodes = np.concatenate([bent, flat])
    surface = FaceSurface(whole_pieces({QUAD8: np.arange(16).reshape(2, 8)}), nodes)
    found, shares = surface.nearest(np.array([[0.0, 0.0, 2.3]]))
    np.testing.assert_array_equal(np.sort(found[0]), np.arange(8))
    np.testing.assert_allclose(shares @ nodes[found[0]], [[0.0, 0.0, 2.0]], atol=1e-12)


def test_coordinates_that_are_not_finite():
    """A diverging iteration passes NaN to the search: it returns pieces of the surface, and nothing touches."""
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0), indexing="ij")
    nodes, n = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), np.arange(9).reshape(3, 3)
    four = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4)
    surface = FaceSurface(make_pieces([four], nodes, 0.0, 0.0), nodes, FACING)
    away, before = np.full_like(nodes, np.nan), np.array([2, 1])
    for outward in (np.zeros((2, 3)), np.array([[0.0, 0.0, -1.0]] * 2)):
        piece, _, above = surface.track(away[:2], outward, away, before, everywhere=False)
        assert np.isin(piece, range(4)).all()
        assert not above.any()
