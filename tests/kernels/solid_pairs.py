# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of solids of every kind with an interface element between them, in random positions and shapes."""

import itertools

import numpy as np
from reference_cells import CORNERS, EDGES, with_middles

from uel.usersub.layout import element_layouts

FULL, MODES, MEAN, REDUCED = range(4)
"""Formulations of the solids: JPROPS FORMULATION BOTTOM and TOP."""

CELLS = {
    (2, 3): "triangle",
    (2, 4): "quad",
    (2, 6): "triangle6",
    (2, 8): "quad8",
    (3, 4): "tetra",
    (3, 6): "wedge",
    (3, 8): "hexahedron",
    (3, 10): "tetra10",
    (3, 15): "wedge15",
    (3, 20): "hexahedron20",
}
"""Cells by dimension and number of nodes."""

BUILT_IN = {
    ("triangle", FULL): "CPE3",
    ("quad", FULL): "CPS4",
    ("quad", MODES): "CPE4I",
    ("quad", MEAN): "CPE4",
    ("quad", REDUCED): "CPE4R",
    ("triangle6", FULL): "CPE6",
    ("quad8", FULL): "CPE8",
    ("quad8", REDUCED): "CPE8R",
    ("tetra", FULL): "C3D4",
    ("wedge", FULL): "C3D6",
    ("hexahedron", MODES): "C3D8I",
    ("hexahedron", MEAN): "C3D8",
    ("hexahedron", REDUCED): "C3D8R",
    ("tetra10", FULL): "C3D10",
    ("wedge15", FULL): "C3D15",
    ("hexahedron20", FULL): "C3D20",
    ("hexahedron20", REDUCED): "C3D20R",
}
"""Built-in elements in plane strain and in space. CPE4 and C3D8 have the mean volume strain: full integration is
that of CPS4, in plane stress.
"""

FACES = {
    2: np.array([[0.0, 0.0], [1.0, 0.0]]),
    3: np.array([[0.0, 0.0, 0.0], [1.1, 0.0, 0.0], [0.4, 1.0, 0.0]]),
    4: np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]),
}
"""Corners of a face by their number."""

OWNING = [jtype for jtype, layout in element_layouts().items() if layout.solids]


def combinations(jtype):
    """Formulations below and above that a type may have, each with its built-in elements in one state of stress."""
    layout = element_layouts()[jtype]
    sides = [[key for key in BUILT_IN if key[0] == CELLS[layout.dimension, nodes]] for nodes in layout.solids]
    for below, above in itertools.product(*sides):
        plane = [BUILT_IN[side].startswith("CPS") for side in (below, above)]
        if plane[0] == plane[1]:
            yield below[1], above[1]


def cases():
    """All types with their formulations."""
    return [(jtype, *pair) for jtype in OWNING for pair in combinations(jtype)]


def plane_of(jtype, formulation):
    """PLANE of a case: 1 for plane strain, but for CPS4."""
    return int(not (jtype == 4 and formulation == FULL))


def built_in_names(jtype, below, above):
    """Built-in elements below and above."""
    layout = element_layouts()[jtype]
    return [
        BUILT_IN[CELLS[layout.dimension, nodes], formulation]
        for nodes, formulation in zip(layout.solids, (below, above), strict=True)
    ]


def solid_nodes(jtype):
    """Slices of the nodes of the solids below and above."""
    below, above = element_layouts()[jtype].solids
    return slice(0, below), slice(below, below + above)


def corners_of(layout):
    """Number of corners of the face of an interface element."""
    return 2 if layout.dimension == 2 else 3 if len(layout.faces[0]) in (3, 6) else 4


def face_of_solid(jtype, side):
    """Corners of the face of a solid among its own nodes."""
    layout = element_layouts()[jtype]
    start = solid_nodes(jtype)[side].start
    return [node - start for node in layout.faces[side][: corners_of(layout)]]


def parent_nodes(dimension, nodes):
    """Parent coordinates of a cell with all its nodes, and its number of corners."""
    cell = CELLS[dimension, nodes]
    shape = cell.rstrip("0123456789")
    corners = CORNERS[shape]
    return with_middles(corners, EDGES[shape] if cell != shape else []), len(corners)


def geometry(jtype, rng, *, height=1.0, affine=False, flat=False, curved=0.0, random=0.12):
    """Nodes of an interface element in a random direction, with solids of a height above a face of about 1 x 1.

    affine   parallel edges, straight faces
    flat     the face is a straight line or a plane
    curved   deviation of the midside nodes of the face
    random   deviation of the corners, of the edges
    """
    layout = element_layouts()[jtype]
    dim = layout.dimension
    corners_of_face = corners_of(layout)
    face = FACES[corners_of_face].copy()
    parts = []
    for side in (0, 1):
        count = layout.solids[side]
        parents, corners = parent_nodes(dim, count)
        mine = face_of_solid(jtype, side)
        apex = next(node for node in range(corners) if node not in mine)
        # the affine map that takes the face to its place and a node off it to a height
        source = np.column_stack([parents[[*mine[:dim], apex]], np.ones(dim + 1)])
        off = np.zeros(dim)
        off[-1] = height if side else -height
        if corners == dim + 1:
            target_apex = face[:dim].mean(axis=0) + off
        else:
            near = _neighbour(mine, apex, corners, dim)
            target_apex = face[mine.index(near)] + off
        target = np.vstack([face[:dim], target_apex])
        parts.append(
            (
                np.column_stack([parents[:corners], np.ones(corners)]) @ np.linalg.solve(source, target),
                mine,
                corners,
                count,
            )
        )
    moved = random * rng.uniform(-1, 1, size=(corners_of_face, dim)) * (0 if affine else 1)
    moved[:, -1] *= 0 if flat else min(1.0, height)
    found = []
    middles = None
    for side, (places, mine, corners, count) in enumerate(parts):
        points = places.copy()
        points[mine] += moved
        others = [k for k in range(corners) if k not in mine]
        if not affine:
            change = random * rng.uniform(-1, 1, size=(len(others), dim))
            change[:, -1] *= min(1.0, height)
            points[others] += change
        if count > corners:
            cell = CELLS[dim, count].rstrip("0123456789")
            points = with_middles(points, EDGES[cell])
            on_face = [node - solid_nodes(jtype)[side].start for node in layout.faces[side][corners_of_face:]]
            if middles is None:
                middles = curved * rng.uniform(-1, 1, size=(len(on_face), dim))
                middles[:, -1] *= 0 if flat else 1
            points[on_face] += middles
        found.append(points)
    nodes = np.vstack(found)
    q, r = np.linalg.qr(rng.normal(size=(dim, dim)))
    q *= np.sign(np.diag(r))
    if np.linalg.det(q) < 0:
        q[0] *= -1
    return nodes @ q.T


def _neighbour(face, apex, corners, dim):
    """Corner of a face that shares an edge with a corner off it."""
    shape = {(2, 4): "quad", (3, 6): "wedge", (3, 8): "hexahedron"}[dim, corners]
    return next(a if b == apex else b for a, b in EDGES[shape] if apex in (a, b) and (a in face or b in face))


def frames_at(jtype, nodes):
    """Rows s, n and t (tau and n in the plane) in the middle of the interface."""
    layout = element_layouts()[jtype]
    face = nodes[list(layout.faces[0])]
    if layout.dimension == 2:
        tau = face[1] - face[0]
        tau /= np.linalg.norm(tau)
        return np.array([tau, [-tau[1], tau[0]]])
    if corners_of(layout) == 3:
        along, across = face[1] - face[0], face[2] - face[0]
    else:
        along, across = face[1] + face[2] - face[0] - face[3], face[2] + face[3] - face[0] - face[1]
    n = np.cross(along, across)
    n /= np.linalg.norm(n)
    s = np.array([1.0, 0.0, 0.0]) - n[0] * n
    s /= np.linalg.norm(s)
    return np.array([s, n, np.cross(n, s)])


def ply_axes(jtype, nodes):
    """Material axes 1, 2 and 3 of plies at an angle of 0: s, t and n; None in the plane, where they are global."""
    if element_layouts()[jtype].dimension == 2:
        return None
    return frames_at(jtype, nodes)[[0, 2, 1]]
