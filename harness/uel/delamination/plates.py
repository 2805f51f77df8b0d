# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two plates of bricks with pairs of coincident nodes at their interface: mesh and keyword blocks.

Nodes are numbered along x, then along y, then from below, first those of the lower plate. The interface elements come
after the bricks. A mesh of uniform parts can be generated in the deck (`Laminate.generated`), which is then short.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.delamination.blocks import Interface, cohesive_section, law_values
from uel.delamination.kernels import formulations, uel_property, user_element
from uel.delamination.keywords import element_block, keyword, node_block, number, table, wrapped
from uel.delamination.materials import SolidPly
from uel.delamination.mesh import cut
from uel.model.arrays import FloatArray, IntArray

AROUND = ((0, 0), (0, 1), (1, 1), (1, 0))
"""Corners of a face, and the points next to them, counter-clockwise from above, along y and along x."""


@dataclass(frozen=True, slots=True)
class TwoPlateMesh:
    """Two plates of bricks in common columns.

    x, y          (nx+1,), (ny+1,) edges of the columns, ascending (mm)
    lower, upper  (n+1,) heights of the layers of nodes of the two plates; lower[-1] = upper[0] is the interface
    bonded        (ny, nx) columns with an interface element; the others are the initial crack
    moved         coordinates of the nodes if they are not on the grid, shaped as `positions`
    """

    x: FloatArray
    y: FloatArray
    lower: FloatArray
    upper: FloatArray
    bonded: NDArray[np.bool_]
    moved: FloatArray | None = None

    @property
    def positions(self) -> FloatArray:
        """Nodes of both plates by layer from below, by y and by x, (layers, ny+1, nx+1, 3) (mm)."""
        if self.moved is not None:
            return self.moved
        z, y, x = np.meshgrid(np.concatenate([self.lower, self.upper]), self.y, self.x, indexing="ij")
        return np.stack([x, y, z], axis=-1)

    @property
    def labels(self) -> tuple[IntArray, IntArray]:
        """Labels of the nodes of both plates, each by height, y and x."""
        below, above = ((len(heights), len(self.y), len(self.x)) for heights in (self.lower, self.upper))
        first = 1 + np.arange(np.prod(below)).reshape(below)
        return first, 1 + first.size + np.arange(np.prod(above)).reshape(above)

    def nodes(self) -> tuple[IntArray, FloatArray]:
        """Return the labels (n,) and coordinates (n, 3) of all nodes."""
        return np.concatenate([labels.ravel() for labels in self.labels]), self.positions.reshape(-1, 3)

    def bricks(self, plate: int, layer: int) -> IntArray:
        """Return nodes (nx*ny, 8) of the bricks in a layer, from 0, of the lower (0) or the upper plate (1)."""
        labels = self.labels[plate]
        return np.hstack([faces(labels[layer]), faces(labels[layer + 1])])

    def interface(self, kind: str) -> IntArray:
        """Return the nodes of the interface elements: both faces, or the bricks below and above for U8."""
        below, above = self.labels
        layers = [*below[-2:], *above[:2]] if kind == "U8" else [below[-1], above[0]]
        return np.hstack([faces(layer)[self.bonded.ravel()] for layer in layers])


def faces(layer: IntArray) -> IntArray:
    """Return corners (n, 4) of faces between the nodes of a layer (y, x), row by row, counter-clockwise from above."""
    across, along = layer.shape
    corners = [layer[j : across - 1 + j, i : along - 1 + i].ravel() for j, i in AROUND]
    return np.stack(corners, axis=-1)


def two_plates(x: FloatArray, y: FloatArray, z: FloatArray, crack: float) -> TwoPlateMesh:
    """Mesh two plates of equal height with a straight front.

    Parameters
    ----------
    x, y
        Edges of the columns (mm), one of x at the crack tip.
    z
        Heights of the layers of nodes of the upper plate above the interface (mm); the lower plate mirrors them.
    crack
        Length of the initial crack, from x = 0 (mm).
    """
    bonded = np.broadcast_to(x[:-1] > crack - 1e-6, (len(y) - 1, len(x) - 1))
    return TwoPlateMesh(x, y, -z[::-1], z, bonded)


def refined(mesh: TwoPlateMesh, factor: int) -> TwoPlateMesh:
    """Divide every brick into factor x factor x factor; faces keep their shape, bumps included."""
    x, y, lower, upper = (cut(values, factor) for values in (mesh.x, mesh.y, mesh.lower, mesh.upper))
    bonded = mesh.bonded.repeat(factor, axis=0).repeat(factor, axis=1)
    plates = np.split(mesh.positions, [len(mesh.lower)])
    moved = np.concatenate([cut(cut(cut(plate, factor, 0), factor, 1), factor, 2) for plate in plates])
    return TwoPlateMesh(x, y, lower, upper, bonded, moved)


@dataclass(frozen=True, slots=True)
class Laminate:
    """The elements of a deck.

    lower, upper  plies of the two plates, one for each layer of bricks, from below
    bricks        type of the continuum elements
    generated     the deck generates nodes and elements from corners and master elements: each plate has layers of
                  equal height, the mesh lines along y are straight and equidistant, and the crack is a rectangle
    """

    mesh: TwoPlateMesh
    interface: Interface
    lower: tuple[SolidPly, ...]
    upper: tuple[SolidPly, ...]
    bricks: str = "C3D8I"
    generated: bool = False


def mesh_blocks(laminate: Laminate) -> list[str]:
    """Write nodes and elements, with an element set for each ply and the set INTERFACE."""
    mesh, kind = laminate.mesh, laminate.interface.type
    lines = _generated_nodes(mesh) if laminate.generated else node_block(*mesh.nodes())
    count = 1
    for name in plies(laminate):
        layers = list(_layers(laminate, name))
        if laminate.generated:
            lines += _generated_elements(mesh, laminate.bricks, name, layers, count)
        else:
            lines += element_block(laminate.bricks, name, np.concatenate(layers), count)
        count += sum(map(len, layers))
    if not laminate.interface.built_in:
        lines += user_element(int(kind[1:]))
    faces = mesh.interface(kind)
    if laminate.generated:
        return lines + _generated_elements(mesh, kind, "INTERFACE", [faces], count)
    return lines + element_block(kind, "INTERFACE", faces, count)


def _layers(laminate: Laminate, name: str) -> Iterator[IntArray]:
    """Yield the bricks of each layer of a ply, from below."""
    for plate, stack in enumerate((laminate.lower, laminate.upper)):
        for k, ply in enumerate(stack):
            if ply.name == name:
                yield laminate.mesh.bricks(plate, k)


def _generated_nodes(mesh: TwoPlateMesh) -> list[str]:
    """Write *NODE for the ends of the uniform parts of the lowest two lines along x, and generate the other nodes."""
    labels, points = mesh.nodes()
    coordinates = dict(zip(labels.tolist(), points.tolist(), strict=True))
    outer = mesh.labels[0][0]
    edges = outer[0], outer[-1]
    # ends where the spacing changes on one of the two lines
    steps = np.array([np.diff([coordinates[node][0] for node in edge.tolist()], 2) for edge in edges])
    ends = [0, *(1 + np.flatnonzero(np.abs(steps).max(axis=0) > 1e-6)).tolist(), len(outer[0]) - 1]
    along, layer = len(mesh.x), outer.size
    lines = ["*NODE", *table([node, *coordinates[node]] for edge in edges for node in edge[ends].tolist())]
    for name, edge in zip(("FRONT", "BACK"), edges, strict=True):
        nodes = edge[ends].tolist()
        lines += [keyword("NGEN", NSET=name), *table((*pair, 1) for pair in itertools.pairwise(nodes))]
    lines += [keyword("NFILL", NSET="FACE_1"), f"FRONT, BACK, {len(mesh.y) - 1}, {along}"]
    # the other faces of the plates: the one below the interface, the one above it, the uppermost
    heights = mesh.lower[-1], mesh.upper[0], mesh.upper[-1]
    firsts = mesh.labels[0][-1], mesh.labels[1][0], mesh.labels[1][-1]
    for k, (height, face) in enumerate(zip(heights, firsts, strict=True), start=2):
        number_change = int(face[0, 0] - outer[0, 0])
        lines.append(keyword("NCOPY", "SHIFT", CHANGE_NUMBER=number_change, OLD_SET="FACE_1", NEW_SET=f"FACE_{k}"))
        lines += [f"0., 0., {number(height - mesh.lower[0])}", "0., 0., 0., 0., 0., 1., 0."]
    for below, heights_of in ((1, mesh.lower), (3, mesh.upper)):
        if len(heights_of) > 2:
            lines += ["*NFILL", f"FACE_{below}, FACE_{below + 1}, {len(heights_of) - 1}, {layer}"]
    return lines


def _generated_elements(mesh: TwoPlateMesh, kind: str, name: str, layers: list[IntArray], first: int) -> list[str]:
    """Write *ELEMENT for the first of each layer (n, nodes), and *ELGEN for the others; numbered from `first`."""
    labels = first + np.concatenate([[0], np.cumsum([len(layer) for layer in layers])])[:-1]
    lines = [keyword("ELEMENT", TYPE=kind, ELSET=name)]
    lines += table([label, *layer[0].tolist()] for label, layer in zip(labels.tolist(), layers, strict=True))
    across = len(mesh.y) - 1
    rows = [
        (label, len(layer) // across, 1, 1, across, len(mesh.x), len(layer) // across)
        for label, layer in zip(labels.tolist(), layers, strict=True)
    ]
    return [*lines, keyword("ELGEN", ELSET=name), *table(rows)]


def property_blocks(laminate: Laminate) -> list[str]:
    """Write sections, orientations, materials and the properties of the interface elements."""
    lines = []
    for name, ply in plies(laminate).items():
        orientation = {} if ply.isotropic else {"ORIENTATION": name}
        lines.append(keyword("SOLID SECTION", ELSET=name, MATERIAL=name, **orientation))
        if orientation:
            axes = ["1., 0., 0., 0., 1., 0.", f"3, {number(ply.angle)}"]
            lines += [keyword("ORIENTATION", NAME=name), *axes]
        lines.append(keyword("MATERIAL", NAME=name))
        if ply.isotropic:
            lines += ["*ELASTIC", *wrapped([ply.moduli[0], ply.ratios[0]])]
        else:
            lines += ["*ELASTIC, TYPE=ENGINEERING CONSTANTS", *wrapped([*ply.moduli, *ply.ratios, *ply.shear])]
    interface = laminate.interface
    if interface.built_in:
        return lines + cohesive_section(interface)
    values = law_values(interface) | formulations(laminate.bricks)
    for side, ply in (("BOTTOM", laminate.lower[-1]), ("TOP", laminate.upper[0])):
        values |= {f"{constant} {side}": value for constant, value in ply.constants.items()}
        values[f"ANGLE {side}"] = ply.angle
    return lines + uel_property(int(interface.type[1:]), "INTERFACE", values)


def plies(laminate: Laminate) -> dict[str, SolidPly]:
    """Return different plies by name, from below."""
    return {ply.name: ply for ply in (*laminate.lower, *laminate.upper)}
