# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Geometry and displacements of the interfaces in space, for the tests that use them."""

import numpy as np
from reference import ply_stress, serendipity
from reference_cells import EDGES, SQUARE_EDGES, with_middles

from uel.usersub import layout

STANDARD, QUADRATIC = (7, 11), (11, 12)
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
# mid-surfaces: height over the square
SURFACES = {
    "flat": np.zeros(4),
    "sloping": np.array([0.0, 0.2, 0.35, 0.15]),
    "warped": np.array([0.05, -0.1, 0.12, -0.06]),
}
SKEW = np.array([[0.0, 0.0], [0.1, -0.15], [-0.2, 0.1], [0.05, 0.2]])
# parent coordinates of the nodes of a face
FACE = with_middles(2 * SQUARE - 1, SQUARE_EDGES)


def faces(surface, skew=1.0):
    """(4, 3) nodes of a face."""
    return np.column_stack([SQUARE + skew * SKEW, SURFACES[surface]])


def nodes_of(jtype, surface, skew=1.0):
    """Nodes of an interface; bricks are distorted, faces with middles curved where the surface is warped."""
    face = faces(surface, skew)
    if jtype == 7:
        return np.vstack([face, face])
    below, above = face + np.array([0.05 * skew, 0, -0.8]), face + np.array([0, -0.1 * skew, 0.9])
    below[2, 2] -= 0.1 * skew
    above[0, 2] += 0.15 * skew
    if jtype == 8:
        return np.vstack([below, face, face, above])
    curved = with_middles(face, SQUARE_EDGES)
    if surface == "warped":
        curved[4:] += 0.06 * np.array([[0.2, -0.3, 1.0], [0.4, 0.1, -1.0], [0.0, 0.5, 0.7], [-0.5, 0.1, 0.4]])
    if jtype == 11:
        return np.vstack([face, face, curved[4:], curved[4:]])
    bricks = [with_middles(np.vstack(pair), EDGES["hexahedron"]) for pair in ((below, face), (face, above))]
    bricks[0][12:16] = bricks[1][8:12] = curved[4:]
    return np.vstack(bricks)


def bottom_of(jtype):
    """Nodes of the bottom face."""
    return list(layout.variables(jtype).bottom)


def top_of(jtype):
    """Nodes of the top face."""
    return list(layout.variables(jtype).top)


def points_of(jtype, rule):
    """Parent coordinates of the integration points: each next to a node, of nine the last one in the middle."""
    if jtype in QUADRATIC:
        return np.vstack([FACE, [[0.0, 0.0]]]) * (1.0 if rule else np.sqrt(0.6))
    return FACE[:4] / (1.0 if rule else np.sqrt(3.0))


def weights_of(jtype, rule):
    """Their weights."""
    if jtype in QUADRATIC:
        end, middle = (1 / 3, 4 / 3) if rule else (5 / 9, 8 / 9)
        return np.array([end**2] * 4 + [end * middle] * 4 + [middle**2])
    return np.ones(4)


def frames(coordinates, jtype, parents, direction=(1.0, 0.0, 0.0)):
    """Rows s, n, t at points of the mid-surface: s is the projection of a direction (Abaqus: of the x axis)."""
    face = coordinates[top_of(jtype)]
    found = []
    for parent in parents:
        n = np.cross(*(serendipity(FACE[: len(face)], parent)[1] @ face))
        n /= np.linalg.norm(n)
        s = np.array(direction) - n @ direction * n
        s /= np.linalg.norm(s)
        found.append([s, n, np.cross(n, s)])
    return np.array(found)


def opened(jtype, gaps, seed, strain=0.0):
    """Displacements whose top face is moved by gaps (4 corners, 3), with random strains of the bricks."""
    count = layout.element_layouts()[jtype].nodes
    gaps = np.broadcast_to(gaps, (4, 3))
    if jtype in QUADRATIC:
        gaps = with_middles(gaps, SQUARE_EDGES)
    u = strain * np.random.default_rng(seed).normal(size=(count, 3))
    u[top_of(jtype)] = u[bottom_of(jtype)] + gaps
    if jtype == 8:
        u[12:] += gaps
    if jtype == 12:
        moved = with_middles(np.vstack([gaps[:4], gaps[:4]]), EDGES["hexahedron"])
        outer = np.setdiff1d(np.arange(20, 40), top_of(jtype))
        u[outer] += moved[outer - 20]
    return u


def stress_of(gradient, coordinates, jtype, angle, direction=(1.0, 0.0, 0.0)):
    """Stress of the ply of the fixtures, from its compliance in material axes: 3 is n, 1 at an angle from s to t."""
    s, n, t = frames(coordinates, jtype, [(0, 0)], direction)[0]
    c, d = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
    axes = np.array([c * s + d * t, c * t - d * s, n])
    return axes.T @ ply_stress(axes @ (0.5 * (gradient + gradient.T)) @ axes.T) @ axes
