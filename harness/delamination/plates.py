# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two plates of bricks, one on the other, that meet in pairs of coincident nodes: mesh and keyword blocks.

Nodes are numbered along x, then along y, then from below, first those of the lower plate. The interface elements come
after the bricks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from harness.delamination.blocks import Interface, cohesive_section, law_values
from harness.delamination.kernels import uel_property, user_element
from harness.delamination.keywords import element_block, keyword, node_block, number, wrapped
from harness.delamination.materials import SolidPly
from harness.delamination.mesh import cut
from harness.model.arrays import FloatArray, IntArray

AROUND = ((0, 0), (0, 1), (1, 1), (1, 0))
"""Corners of a face, and the points next to them, counter-clockwise from above, along y and along x."""


@dataclass(frozen=True, slots=True)
class TwoPlateMesh:
    """Two plates of bricks in common columns.

    x, y          (nx+1,), (ny+1,) edges of the columns, ascending (mm)
    lower, upper  (n+1,) heights of the layers of nodes of the two plates; lower[-1] = upper[0] is the interface
    bonded        (ny, nx) columns that have an interface element: the others are the initial crack
    moved         positions of the nodes that are not in those columns and layers, shaped as `positions`
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
        """Labels (n,) and coordinates (n, 3) of all nodes."""
        return np.concatenate([labels.ravel() for labels in self.labels]), self.positions.reshape(-1, 3)

    def bricks(self, plate: int, layer: int) -> IntArray:
        """(nx*ny, 8) nodes of the bricks in a layer, from 0, of the lower (0) or the upper plate (1)."""
        labels = self.labels[plate]
        return np.hstack([faces(labels[layer]), faces(labels[layer + 1])])

    def interface(self, kind: str) -> IntArray:
        """Nodes of the interface elements: both faces, or the bricks below and above for U8."""
        below, above = self.labels
        layers = [*below[-2:], *above[:2]] if kind == "U8" else [below[-1], above[0]]
        return np.hstack([faces(layer)[self.bonded.ravel()] for layer in layers])


def faces(layer: IntArray) -> IntArray:
    """(n, 4) corners of the faces between the nodes of a layer (y, x), row after row, counter-clockwise from above."""
    across, along = layer.shape
    corners = [layer[j : across - 1 + j, i : along - 1 + i].ravel() for j, i in AROUND]
    return np.stack(corners, axis=-1)


def two_plates(x: FloatArray, y: FloatArray, z: FloatArray, crack: float) -> TwoPlateMesh:
    """Mesh of two plates of equal height with a straight front.

    Parameters
    ----------
    x, y
        Edges of the columns (mm); one of x is the crack's tip.
    z
        Heights of the layers of nodes of the upper plate above the interface (mm); the lower plate mirrors them.
    crack
        Length of the initial crack, from x = 0 (mm).
    """
    bonded = np.broadcast_to(x[:-1] > crack - 1e-6, (len(y) - 1, len(x) - 1))
    return TwoPlateMesh(x, y, -z[::-1], z, bonded)


def refined(mesh: TwoPlateMesh, factor: int) -> TwoPlateMesh:
    """Every brick cut into factor x factor x factor; faces keep their shape, bumps and all."""
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
    """

    mesh: TwoPlateMesh
    interface: Interface
    lower: tuple[SolidPly, ...]
    upper: tuple[SolidPly, ...]
    bricks: str = "C3D8I"


def mesh_blocks(laminate: Laminate) -> list[str]:
    """*NODE and *ELEMENT, with an element set for each ply and the set INTERFACE."""
    mesh, kind = laminate.mesh, laminate.interface.type
    lines = node_block(*mesh.nodes())
    layers = [(ply, 0, k) for k, ply in enumerate(laminate.lower)]
    layers += [(ply, 1, k) for k, ply in enumerate(laminate.upper)]
    count = 1
    for name in plies(laminate):
        bricks = np.concatenate([mesh.bricks(plate, k) for ply, plate, k in layers if ply.name == name])
        lines += element_block(laminate.bricks, name, bricks, count)
        count += len(bricks)
    if not laminate.interface.built_in:
        lines += user_element(int(kind[1:]), "UNSYMM")
    return lines + element_block(kind, "INTERFACE", mesh.interface(kind), count)


def property_blocks(laminate: Laminate) -> list[str]:
    """Sections, orientations, materials and the properties of the interface elements."""
    lines = []
    for name, ply in plies(laminate).items():
        turned = {} if ply.isotropic else {"ORIENTATION": name}
        lines.append(keyword("SOLID SECTION", ELSET=name, MATERIAL=name, **turned))
        if turned:
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
    values = law_values(interface)
    for side, ply in (("BOTTOM", laminate.lower[-1]), ("TOP", laminate.upper[0])):
        values |= {f"{constant} {side}": value for constant, value in ply.constants.items()}
        values[f"ANGLE {side}"] = ply.angle
    return lines + uel_property(int(interface.type[1:]), "INTERFACE", values)


def plies(laminate: Laminate) -> dict[str, SolidPly]:
    """Different plies by name, from below."""
    return {ply.name: ply for ply in (*laminate.lower, *laminate.upper)}
