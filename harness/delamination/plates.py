# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two plates of bricks, one on the other, that meet in pairs of coincident nodes: mesh and keyword blocks.

Nodes are numbered along x, then along y, then from below, first those of the lower plate. The interface elements come
after the bricks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from harness.delamination.blocks import Interface, cohesive_section, law_values
from harness.delamination.kernels import uel_property, user_element
from harness.delamination.keywords import element_block, keyword, node_block, number, wrapped
from harness.delamination.materials import SolidPly
from harness.model.arrays import FloatArray, IntArray

Placement = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]

_AROUND = ((0, 0), (0, 1), (1, 1), (1, 0))
"""Corners of a face counter-clockwise from above, along y and along x."""


def unmoved(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Leave the nodes where they are."""
    return x, y


@dataclass(frozen=True, slots=True)
class TwoPlateMesh:
    """Two plates of bricks in common columns.

    x, y          (nx+1,), (ny+1,) edges of the columns, ascending (mm)
    lower, upper  (n+1,) heights of the layers of nodes of the two plates; lower[-1] = upper[0] is the interface
    bonded        (ny, nx) columns that have an interface element: the others are the initial crack
    place         maps the plane positions x, y of the nodes to others, to turn mesh lines against the front
    """

    x: FloatArray
    y: FloatArray
    lower: FloatArray
    upper: FloatArray
    bonded: NDArray[np.bool_]
    place: Placement = unmoved

    @property
    def labels(self) -> tuple[IntArray, IntArray]:
        """Labels of the nodes of both plates, each by height, y and x."""
        below, above = ((len(heights), len(self.y), len(self.x)) for heights in (self.lower, self.upper))
        first = 1 + np.arange(np.prod(below)).reshape(below)
        return first, 1 + first.size + np.arange(np.prod(above)).reshape(above)

    def nodes(self) -> tuple[IntArray, FloatArray]:
        """Labels (n,) and coordinates (n, 3) of all nodes."""
        y, x = np.meshgrid(self.y, self.x, indexing="ij")
        x, y = self.place(x, y)
        points = [
            np.stack([x, y, np.full_like(x, height)], axis=-1).reshape(-1, 3)
            for height in np.concatenate([self.lower, self.upper])
        ]
        return np.concatenate([labels.ravel() for labels in self.labels]), np.concatenate(points)

    def bricks(self, plate: int, layer: int) -> IntArray:
        """(nx*ny, 8) nodes of the bricks in a layer, from 0, of the lower (0) or the upper plate (1)."""
        labels = self.labels[plate]
        return np.hstack([_faces(labels[layer]), _faces(labels[layer + 1])])

    def interface(self, kind: str) -> IntArray:
        """Nodes of the interface elements: both faces, or the bricks below and above for U8."""
        below, above = self.labels
        layers = [*below[-2:], *above[:2]] if kind == "U8" else [below[-1], above[0]]
        return np.hstack([_faces(layer)[self.bonded.ravel()] for layer in layers])


def _faces(layer: IntArray) -> IntArray:
    """Corners of the faces between the nodes of a layer (y, x), counter-clockwise from above."""
    across, along = layer.shape
    corners = [layer[j : across - 1 + j, i : along - 1 + i].ravel() for j, i in _AROUND]
    return np.stack(corners, axis=-1)


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
