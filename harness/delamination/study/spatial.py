# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beams of bricks for the studies in space: any places of the nodes, a ply for each arm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from harness.delamination.kernels import uel_property, user_element
from harness.delamination.keywords import element_block, keyword, node_block, node_set, number, text, wrapped
from harness.model.arrays import FloatArray, IntArray

Constants = Mapping[str, float]
"""Elastic constants by name: E1, E2, E3, NU12, NU13, NU23, G12, G13, G23 (MPa); axis 1 is x, axis 3 is z."""

_CONSTANTS = ("E1", "E2", "E3", "NU12", "NU13", "NU23", "G12", "G13", "G23")
_AROUND = ((0, 0), (0, 1), (1, 1), (1, 0))
"""Row and column of the corners of a face, counter-clockwise from above, and of the points next to them."""

Field = dict[str, FloatArray]
"""Variables of the interface by name, at the points in rows and columns."""


@dataclass(frozen=True, slots=True)
class Cantilever:
    """The specimen: clamped at the last column of nodes, pulled apart at the first one.

    places   (2, layers + 1, rows + 1, columns + 1, 3): nodes by arm (lower, upper), from below, along y, along x (mm);
             the upper nodes of the lower arm and the lower ones of the upper arm coincide
    tip      column of nodes at the end of the crack
    lower, upper  plies of the arms
    kind     U7 or U8
    law      properties of the interface elements by name, without the plies
    opening  distance of the outer edges of the arms at the end (mm); it is the step time
    fields   when field output is written
    """

    places: FloatArray
    tip: int
    lower: Constants
    upper: Constants
    kind: str
    law: Mapping[str, float]
    opening: float
    fields: str

    def deck(self, title: str) -> str:
        """Deck with C3D8I; increments of at most a twentieth of the opening, default controls."""
        shape = self.places.shape[:-1]
        labels: IntArray = 1 + np.arange(np.prod(shape)).reshape(shape)
        arms = [np.concatenate([_bricks(arm[k : k + 2]) for k in range(shape[1] - 1)]) for arm in labels]
        bonded = labels[..., self.tip :]
        below, above = (bonded[0, -2:], bonded[1, :2]) if self.kind == "U8" else (bonded[0, -1:], bonded[1, :1])
        values = dict(self.law)
        for side, ply in (("BOTTOM", self.lower), ("TOP", self.upper)):
            values |= {f"{name} {side}": value for name, value in ply.items()}
        jtype = int(self.kind[1:])
        lines = [
            *("*HEADING", title),
            *node_block(labels.ravel(), self.places.reshape(-1, 3)),
            *element_block("C3D8I", "LOWER", arms[0], 1),
            *element_block("C3D8I", "UPPER", arms[1], 1 + len(arms[0])),
            *user_element(jtype, "UNSYMM"),
            *element_block(self.kind, "INTERFACE", _bricks(np.concatenate([below, above])), 1 + 2 * len(arms[0])),
            *node_set("CLAMPED", labels[..., -1].ravel()),
            *node_set("TOP", labels[1, -1, :, 0]),
            *node_set("BOTTOM", labels[0, 0, :, 0]),
            *("*ORIENTATION, NAME=AXES", "1., 0., 0., 0., 1., 0."),
        ]
        for name, ply in (("LOWER", self.lower), ("UPPER", self.upper)):
            lines += [keyword("SOLID SECTION", ELSET=name, MATERIAL=name, ORIENTATION="AXES")]
            lines += [keyword("MATERIAL", NAME=name), "*ELASTIC, TYPE=ENGINEERING CONSTANTS"]
            lines += wrapped([ply[constant] for constant in _CONSTANTS])
        half = number(0.5 * self.opening)
        lines += [
            *uel_property(jtype, "INTERFACE", values),
            *("*STEP, INC=1000, UNSYMM=YES", "*STATIC"),
            f"{number(0.005 * self.opening)}, {number(self.opening)}, 1.e-10, {number(0.05 * self.opening)}",
            *("*BOUNDARY", "CLAMPED, 1, 3", f"TOP, 3, 3, {half}", f"BOTTOM, 3, 3, -{half}"),
            *(f"*OUTPUT, FIELD, {self.fields}", "*NODE OUTPUT", "U"),
            *("*OUTPUT, HISTORY, FREQUENCY=1", "*NODE OUTPUT, NSET=TOP", "RF3", "*END STEP"),
        ]
        return text(lines)


def _bricks(layers: IntArray) -> IntArray:
    """Corners of the faces of layers of nodes (n, rows + 1, columns + 1), counter-clockwise, layer after layer."""
    _, rows, columns = layers.shape
    corners = [layer[j : rows - 1 + j, i : columns - 1 + i].ravel() for layer in layers for j, i in _AROUND]
    return np.stack(corners, axis=-1)


def stacked(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """Places of the nodes of both arms from those in the plane, (rows + 1, columns + 1), and the heights in an arm."""
    heights = np.array([z - z[-1], z])
    shape = (*heights.shape, *x.shape)
    planes = (np.broadcast_to(values, shape) for values in (x, y, heights[..., None, None]))
    return np.stack(list(planes), axis=-1)


def refined(places: FloatArray, factor: int) -> FloatArray:
    """Places of the nodes with every brick cut into factor x factor x factor; faces keep their shape, bumps and all."""
    for axis in (1, 2, 3):
        last = places.shape[axis] - 1
        along = np.arange(factor * last + 1) / factor
        before = np.minimum(along.astype(int), last - 1)
        share = (along - before).reshape([-1 if k == axis else 1 for k in range(places.ndim)])
        places = places.take(before, axis) * (1.0 - share) + places.take(before + 1, axis) * share
    return places


def field(profile: Field, rows: int) -> Field:
    """The columns of a profile at the points in rows and columns (2 rows, n/(2 rows)).

    Parameters
    ----------
    profile
        Variables (n,) of the points by name, four points of a face after the other.
    rows
        Number of faces across.
    """
    grid = {}
    for name, column in profile.items():
        points = column.reshape(rows, -1, len(_AROUND))
        values = np.empty((2 * rows, 2 * points.shape[1]))
        for k, (j, i) in enumerate(_AROUND):
            values[j::2, i::2] = points[..., k]
        grid[name] = values
    return grid


def restricted(finer: Field, factor: int) -> Field:
    """Means over the shares of the points of the mesh that is not cut."""
    return {
        name: values.reshape(len(values) // factor, factor, -1, factor).mean(axis=(1, 3))
        for name, values in finer.items()
    }
