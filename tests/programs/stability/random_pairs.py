# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Random pairs of solids with a common face: their shapes, many at once, and the plies that they are made of.

The face is about the unit edge, triangle or square, and lies across e_n, the last of the axes of a shape: normal to the
face in its middle.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from reference_cells import EDGES
from solid_pairs import CELLS, FACES, face_of_solid, parent_nodes, solid_nodes

from uel.model.element_types import BUILT_IN, FAMILIES
from uel.usersub import _binding
from uel.usersub.layout import element_layouts

SLENDEREST, FLATTEST = 0.02, 50.0
"""Length of the face over the height of a solid."""

LEAST_CORNER = 0.05
"""Jacobian at a corner over the mean of all corners, below which a shape is refused."""


@dataclass(frozen=True)
class Kind:
    """An interface element with the built-in elements below and above it."""

    jtype: int
    below: str
    above: str

    @property
    def name(self):
        """Name: the interface element, the solids below and above."""
        return f"U{self.jtype} {self.below} {self.above}"

    @property
    def plane(self):
        """PLANE: 0 plane stress, 1 plane strain; None in space."""
        return {"S": 0, "E": 1, "D": None}[self.below[2]]


NAMES = [
    name for state in ("CPS", "CPE") for name in (f"{state}{kind}" for kind in ("4", "4I", "4R", "3", "8", "8R", "6"))
] + [f"C3D{kind}" for kind in ("8", "8I", "8R", "6", "4", "20", "20R", "15", "10")]
"""Built-in elements that an interface element may own."""


def kinds():
    """All interface elements that own their solids, between all built-in elements that they may own."""
    found = []
    for jtype, layout in element_layouts().items():
        if layout.solids:
            families = [FAMILIES[layout.dimension, nodes] for nodes in layout.solids]
            below, above = ([name for name in NAMES if BUILT_IN[name].family is family] for family in families)
            found += [Kind(jtype, low, high) for low in below for high in above if low[:3] == high[:3]]
    return sorted(found, key=lambda kind: (NAMES.index(kind.below), NAMES.index(kind.above)))


# --- plies


def random_ply(rng, scale):
    """Constants of an orthotropic ply by name, with ANGLE; moduli and shear moduli differ by up to 100.

    The contraction is nu_ij = c_ij sqrt(E_i/E_j), where the matrix of ones and -c_ij is positive definite: by as little
    as 1e-4, which an isotropic material has with nu = 0.49995.
    """
    young = scale * np.exp(rng.uniform(0, np.log(100.0), 3))
    shear = scale * np.exp(rng.uniform(np.log(0.1), np.log(10.0), 3))
    pairs = ((0, 1), (0, 2), (1, 2))
    coupling = np.zeros((3, 3))
    alike = rng.random() < 0.5
    for i, j in pairs:
        coupling[i, j] = coupling[j, i] = 1.0 if alike else rng.uniform(-0.3, 1.0)
    largest = np.linalg.eigvalsh(coupling)[-1]
    coupling *= (1.0 - 10.0 ** rng.uniform(-4, 0)) / largest
    values = dict(zip(("E1", "E2", "E3"), young, strict=True))
    values |= {f"NU{i + 1}{j + 1}": coupling[i, j] * np.sqrt(young[i] / young[j]) for i, j in pairs}
    values |= {f"G{i + 1}{j + 1}": g for (i, j), g in zip(pairs, shear, strict=True)}
    return values | {"ANGLE": rng.uniform(-90.0, 90.0)}


# --- shapes


def random_shapes(jtype, rng, count):
    """Coordinates (count, nodes, dim) of interface elements, none of whose solids is inside out."""
    found = np.zeros((0, element_layouts()[jtype].nodes, element_layouts()[jtype].dimension))
    while len(found) < count:
        shapes = _any_shapes(jtype, rng, 2 * count)
        found = np.concatenate([found, shapes[_is_valid(jtype, shapes)]])
    return found[:count]


def _any_shapes(jtype, rng, count):
    """Coordinates as those of `random_shapes`, of solids that may be inside out."""
    layout = element_layouts()[jtype]
    dim, corners_of_face = layout.dimension, layout.corners
    stretch = np.ones((count, 1, dim - 1))
    if dim == 3:
        stretch[:, 0, 1] = np.exp(rng.uniform(-2, 2, count))
    extent = stretch * np.ptp(FACES[corners_of_face][:, :-1], axis=0)
    ratio = np.exp(rng.uniform(np.log(SLENDEREST), np.log(FLATTEST), (count, 2)))
    height = extent.prod(axis=2) ** (1 / (dim - 1)) / ratio
    flattest = np.minimum(1.0, height.min(axis=1))
    moved = _noise(rng, corners_of_face, 0.2, flattest, extent)
    curved, parts = None, []
    for side in (0, 1):
        nodes = layout.solids[side]
        points, mine = _leaning(jtype, side, rng, height[:, side], stretch, extent)
        corners = points.shape[1]
        points[:, mine] += moved
        others = [k for k in range(corners) if k not in mine]
        points[:, others] += _noise(rng, len(others), 0.3, np.minimum(1.0, height[:, side]), extent)
        if nodes > corners:
            edges = EDGES[CELLS[dim, nodes].rstrip("0123456789")]
            points = np.concatenate([points, points[:, edges].mean(axis=2)], axis=1)
            on_face = [node - solid_nodes(jtype)[side].start for node in layout.faces[side][corners_of_face:]]
            if curved is None:
                curved = _noise(rng, len(on_face), 0.05, flattest, extent)
            points[:, on_face] += curved
        parts.append(points)
    return _turned(jtype, np.concatenate(parts, axis=1), rng)


def _leaning(jtype, side, rng, height, stretch, extent):
    """Corners (count, corners, dim) of a solid that leans from the face by up to 45 degrees and half of the face."""
    base, mine = _base(jtype, side)
    points = np.tile(base, (len(height), 1, 1))
    points[:, :, :-1] *= stretch
    tall = height[:, None, None]
    lean, shift = rng.uniform(-1, 1, (2, *extent.shape))
    up = abs(base[:, -1])[None, :, None]
    points[:, :, :-1] += up * (lean * tall + 0.5 * shift * np.minimum(1.0, 4.0 * tall) * extent)
    points[:, :, -1] *= height[:, None]
    return points, mine


def _noise(rng, nodes, size, height, extent):
    """Random moves (count, nodes, dim): over the extent of the face along it, and over a height (count,) across."""
    count, _, along = extent.shape
    moves = size * rng.uniform(-1, 1, (count, nodes, along + 1))
    moves[:, :, :-1] *= np.minimum(1.0, 4.0 * height)[:, None, None] * extent
    moves[:, :, -1] *= (height * np.minimum(1.0, extent.min(axis=(1, 2))))[:, None]
    return moves


@cache
def _base(jtype, side):
    """Corners of a solid on the face of FACES, one high, and those of them that are on the face."""
    layout = element_layouts()[jtype]
    dim, mine = layout.dimension, face_of_solid(jtype, side)
    parents, corners = parent_nodes(dim, layout.solids[side])
    apex = next(node for node in range(corners) if node not in mine)
    face = FACES[layout.corners]
    if corners == dim + 1:
        above = face.mean(axis=0)
    else:
        edges = EDGES[CELLS[dim, layout.solids[side]].rstrip("0123456789")]
        near = next(a if b == apex else b for a, b in edges if apex in (a, b) and (a in mine or b in mine))
        above = face[mine.index(near)].copy()
    above[-1] = 1.0 if side else -1.0
    # the affine map that takes the face to its place and the apex across from it
    source = np.column_stack([parents[[*mine[:dim], apex]], np.ones(dim + 1)])
    target = np.vstack([face[:dim], above])
    return np.column_stack([parents[:corners], np.ones(corners)]) @ np.linalg.solve(source, target), mine


def _turned(jtype, shapes, rng):
    """Shapes turned at random: in the plane, or in space about e_3, which is the normal in the middle of the face."""
    layout = element_layouts()[jtype]
    angle = rng.uniform(-np.pi, np.pi, len(shapes))
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    if layout.dimension == 2:
        axes = np.stack([np.hstack([c, s]), np.hstack([-s, c])], axis=1)
    else:
        family = FAMILIES[2, len(layout.faces[0])]
        _, _, slopes = _binding.integration_rule(family.number, 1, family.nodes, 2)
        along = np.einsum("mnx,nk->mkx", shapes[:, list(layout.faces[0])], slopes[0])
        normal = np.cross(along[:, 0], along[:, 1])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        first = along[:, 0] / np.linalg.norm(along[:, 0], axis=1)[:, None]
        second = np.cross(normal, first)
        axes = np.stack([c * first + s * second, c * second - s * first, normal], axis=1)
    return np.einsum("mnx,mkx->mnk", shapes, axes)


def _is_valid(jtype, shapes):
    """Mask (count,) of the shapes with positive Jacobians, at the corners and at the points of full integration."""
    valid = np.ones(len(shapes), dtype=bool)
    layout = element_layouts()[jtype]
    dim = layout.dimension
    for nodes, part in zip(layout.solids, solid_nodes(jtype), strict=True):
        family = FAMILIES[dim, nodes]
        places = shapes[:, part]
        _, _, slopes = _binding.integration_rule(family.number, family.full_points, nodes, dim)
        jacobians = np.linalg.det(np.einsum("mnx,pnk->mpxk", places, slopes))
        valid &= jacobians.min(axis=1) > LEAST_CORNER * jacobians.mean(axis=1)
        at_corners = _at_corners(family, places)
        valid &= at_corners.min(axis=1) > LEAST_CORNER * at_corners.mean(axis=1)
    return valid


def _at_corners(family, places):
    """Jacobians (count, corners) at the corners: of the tangents of the edges that meet there, over the parent's."""
    edges = EDGES[family.cell.rstrip("0123456789")]
    parents, corners = parent_nodes(family.dimension, family.nodes)
    found = []
    for corner in range(corners):
        own, theirs = [], []
        for number, edge in enumerate(edges):
            if corner not in edge:
                continue
            end = edge[0] if edge[1] == corner else edge[1]
            own.append(parents[end] - parents[corner])
            theirs.append(places[:, end] - places[:, corner])
            if family.nodes > corners:
                # of the parabola through the middle
                theirs[-1] = 4.0 * (places[:, corners + number] - places[:, corner]) - theirs[-1]
        found.append(np.linalg.det(np.stack(theirs, axis=1)) / np.linalg.det(own))
    return np.stack(found, axis=1)
