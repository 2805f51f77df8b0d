# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cells as Abaqus numbers them (Elements Guide), written down apart from the table that is tested.

Cells have the names of meshio. Numbers of nodes and faces begin at 0, faces are S1, S2, ...
"""

from itertools import pairwise, product
from math import factorial

import numpy as np

SIMPLEX = np.vstack([np.zeros(3), np.eye(3)])
SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
CORNERS = {
    "line": np.array([[-1.0], [1.0]]),
    "triangle": SIMPLEX[:3, :2],
    "quad": SQUARE,
    "tetra": SIMPLEX,
    "wedge": np.array([(*corner, r) for r in (-1.0, 1.0) for corner in SIMPLEX[:3, :2]]),
    "hexahedron": np.array([(*corner, r) for r in (-1.0, 1.0) for corner in SQUARE]),
}
"""Parent coordinates."""
TRIANGLE_EDGES = [(0, 1), (1, 2), (2, 0)]
SQUARE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
EDGES = {
    "line": [(0, 1)],
    "triangle": TRIANGLE_EDGES,
    "quad": SQUARE_EDGES,
    "tetra": [*TRIANGLE_EDGES, (0, 3), (1, 3), (2, 3)],
    "wedge": [*TRIANGLE_EDGES, (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hexahedron": [*SQUARE_EDGES, (4, 5), (5, 6), (6, 7), (7, 4), *((k, k + 4) for k in range(4))],
}
"""Ends of the edges in the order of their middles."""
FACES = {
    "triangle": TRIANGLE_EDGES,
    "quad": SQUARE_EDGES,
    "tetra": [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
    "wedge": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    "hexahedron": [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
}
"""Corners of the faces."""
SHARES = {
    # parts of a constant load: of a corner, of a middle of an edge, in wedges of one between the triangles (O.C.
    # Zienkiewicz, R.L. Taylor, The Finite Element Method, and by integration of the functions)
    **{"line": (1 / 2,), "line3": (1 / 6, 2 / 3), "triangle": (1 / 3,), "triangle6": (0.0, 1 / 3)},
    **{"quad": (1 / 4,), "quad8": (-1 / 12, 1 / 3), "tetra": (1 / 4,), "tetra10": (-1 / 20, 1 / 5)},
    **{"hexahedron": (1 / 8,), "hexahedron20": (-1 / 8, 1 / 6), "wedge": (1 / 6,), "wedge15": (-1 / 9, 1 / 6, 2 / 9)},
}


def shape_of(cell):
    """The cell without middles of edges."""
    return cell.rstrip("0123456789")


def with_middles(corners, edges):
    """Corners and the middles of edges."""
    corners = np.asarray(corners, dtype=float)
    return np.vstack([corners, *(corners[list(edge)].mean(axis=0) for edge in edges)])


def nodes_of(cell):
    """Parent coordinates of all nodes."""
    shape = shape_of(cell)
    return with_middles(CORNERS[shape], EDGES[shape] if cell != shape else [])


def share_of_nodes(cell):
    """Parts of a constant load (nodes,) in an undistorted cell."""
    shape, shares = shape_of(cell), SHARES[cell]
    counts = [6, 6, 3] if shape == "wedge" else [len(CORNERS[shape]), len(EDGES[shape])]
    return np.repeat(shares, counts[: len(shares)])


def face_of(cell, number):
    """Nodes of a face from 0, corners first, and their shares of a constant pressure."""
    shape = shape_of(cell)
    corners = FACES[shape][number]
    of_face = {2: "line", 3: "triangle", 4: "quad"}[len(corners)]
    if cell == shape:
        return list(corners), share_of_nodes(of_face)
    edges = [frozenset(edge) for edge in EDGES[shape]]
    ends = [frozenset((corners[a], corners[b])) for a, b in EDGES[of_face]]
    middles = [len(CORNERS[shape]) + edges.index(pair) for pair in ends]
    return [*corners, *middles], share_of_nodes({"line": "line3", "triangle": "triangle6", "quad": "quad8"}[of_face])


def integral(cell, powers):
    """Of a product of powers of the parent coordinates over the cell."""
    if shape_of(cell) in ("triangle", "tetra"):
        return np.prod([factorial(power) for power in powers]) / factorial(sum(powers) + len(powers))
    if shape_of(cell) == "wedge":
        return integral("triangle", powers[:2]) * integral("line", powers[2:])
    return np.prod([(1 - (-1) ** (power + 1)) / (power + 1) for power in powers])


def monomials(dimension, degree, *, total):
    """Powers up to a degree, in each direction or in all."""
    return [p for p in product(range(degree + 1), repeat=dimension) if not total or sum(p) <= degree]


def unit_cell(cell):
    """Nodes of a cell whose edges along the axes are 1, and its volume."""
    nodes = nodes_of(cell)
    low = nodes.min(axis=0)
    return (nodes - low) / (1 - low), integral(cell, (0,) * nodes.shape[1]) / np.prod(1 - low)


# R.H. MacNeal, R.L. Harder, A proposed standard set of problems to test finite element accuracy, Finite Elements in
# Analysis and Design 1 (1985) 3: an inner hexahedron, and one between each of its faces and that of a cube
CUBE = (CORNERS["hexahedron"] + 1) / 2
INNER = np.array(
    [
        *([0.249, 0.342, 0.192], [0.826, 0.288, 0.288], [0.850, 0.649, 0.263], [0.273, 0.750, 0.230]),
        *([0.320, 0.186, 0.643], [0.677, 0.305, 0.683], [0.788, 0.693, 0.644], [0.165, 0.745, 0.702]),
    ]
)
CUBE_FACES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
MIDDLE = np.array([0.4, 0.55, 0.45])


def _square_and_inner():
    ring = [(*edge, edge[1] + 4, edge[0] + 4) for edge in SQUARE_EDGES]
    return np.vstack([CUBE[:4, :2], INNER[:4, :2]]), [*ring, (4, 5, 6, 7)]


def _triangles():
    return np.vstack([CUBE[:4, :2], MIDDLE[:2]]), [(*edge, 4) for edge in SQUARE_EDGES]


def _hexahedra():
    return np.vstack([CUBE, INNER]), [tuple(range(8, 16)), *((*(face + 8), *face) for face in CUBE_FACES)]


def _tetrahedra():
    # each face in two triangles, which with a point inside make a tetrahedron each
    halves = [half for a, b, c, d in CUBE_FACES.tolist() for half in ((a, b, c), (a, c, d))]
    nodes = np.vstack([CUBE, MIDDLE])
    turned = [np.linalg.det(nodes[[b, c, 8]] - nodes[a]) < 0 for a, b, c in halves]
    return nodes, [(a, c, b, 8) if turn else (a, b, c, 8) for (a, b, c), turn in zip(halves, turned, strict=True)]


def _wedges():
    # two layers of triangles between three levels, with a line of nodes inside that is bent
    levels = [np.column_stack([CUBE[:4, :2], np.full(4, z)]) for z in (0.0, 0.5, 1.0)]
    inside = [[0.45, 0.4, 0.0], MIDDLE, [0.55, 0.5, 1.0]]
    _, triangles = _triangles()
    nodes = np.vstack([np.vstack([level, middle]) for level, middle in zip(levels, inside, strict=True)])
    return nodes, [tuple(k + 5 * (layer + up) for up in (0, 1) for k in t) for layer in (0, 1) for t in triangles]


PATCHES = {
    **{"quad": _square_and_inner, "triangle": _triangles},
    **{"hexahedron": _hexahedra, "tetra": _tetrahedra, "wedge": _wedges},
}


def patch_of(cell):
    """Nodes and elements of a unit square or cube in distorted cells, with nodes inside."""
    shape = shape_of(cell)
    nodes, elements = PATCHES[shape]()
    elements = np.array(elements)
    if cell == shape:
        return nodes, elements
    pairs = elements[:, EDGES[shape]].reshape(-1, 2)
    edges, inverse = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
    return with_middles(nodes, edges), np.hstack([elements, len(nodes) + inverse.reshape(len(elements), -1)])


def affine(cell, seed=1):
    """Nodes of a cell that is turned, stretched and sheared, and what that makes of a unit volume."""
    nodes = nodes_of(cell)
    dimension = nodes.shape[1]
    change = np.eye(dimension) + 0.3 * np.random.default_rng(seed).uniform(-1, 1, (dimension, dimension))
    return 3.0 + nodes @ change.T, abs(np.linalg.det(change))


def area_vector(corners):
    """Normal times area of a plane face, or length of an edge: to the right of the edge, or by the right hand."""
    if corners.shape[1] == 2:
        along = corners[1] - corners[0]
        return np.array([along[1], -along[0]])
    return sum(np.cross(a - corners[0], b - corners[0]) for a, b in pairwise(corners[1:])) / 2
