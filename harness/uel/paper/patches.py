# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Patch test with an inclined interface, section 4.1.2, and the stabilisation that (21) and (22) give (N, mm, MPa).

The paper gives the angle (140.4 degrees), the side of the square (1 mm) and the mesh (13 x 18, 13 elements along the
interface), not where the interface lies; here it goes through the middle of the square, from edge to edge. Columns of
quads are vertical, rows fan out between the interface and the lower and upper edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from uel.delamination.blocks import Interface, Specimen
from uel.delamination.materials import PLY_0, PLY_90, Ply
from uel.delamination.mesh import TwoArmMesh, two_arms
from uel.model.arrays import FloatArray, IntArray

ANGLE = 140.4
COLUMNS, ROWS = 13, 18
COLLINEAR = 12
"""Decimals of the coordinates (mm) that leave the nodes of the inclined interface on one line."""
BETAS = {"0/0": 5.0e6, "0/90": 3.0e5}
"""Stabilisation of the paper by layup (N/mm^3)."""
PLIES = {"0/0": (PLY_0, PLY_0), "0/90": (PLY_0, PLY_90)}
"""Upper and lower ply by layup."""


@dataclass(frozen=True, slots=True)
class SlantedMesh(TwoArmMesh):
    """Two arms whose common line of nodes is inclined about the middle of its length.

    slope     of the interface; `lower` and `upper` are the ordinates at mid-length, `bumps` vertical shifts
    decimals  of the coordinates that are kept
    """

    slope: float
    decimals: int

    def nodes(self) -> tuple[IntArray, FloatArray]:
        """Return the labels (n,) and coordinates (n, 2) of all nodes."""
        interface = self.lower[-1] + self.slope * (self.x - self.x.mean()) + self.bumps
        base, crown = self.lower[0], self.upper[-1]
        share_below = (self.lower - base) / (self.lower[-1] - base)
        share_above = (self.upper - self.upper[0]) / (crown - self.upper[0])
        heights = [base + share * (interface - base) for share in share_below]
        heights += [interface + share * (crown - interface) for share in share_above]
        labels = np.concatenate([self.line(number) for number in range(1, len(heights) + 1)])
        places = np.concatenate([np.column_stack([self.x, height]) for height in heights])
        return labels, np.round(places, self.decimals)


def inclined_mesh(bump: float = 0.0, decimals: int = COLLINEAR) -> SlantedMesh:
    """Mesh with 13 x 18 quads on a square of 1 mm.

    Parameters
    ----------
    bump
        Distance of the interface nodes from the straight line over the length of an element, to both sides in turns.
        Nodes move along their columns, so that the edges of the square stay straight.
    decimals
        Of the coordinates (mm) that are kept.
    """
    inclination = math.radians(ANGLE - 180.0)
    size = 1.0 / COLUMNS / math.cos(inclination)
    flat = two_arms(np.linspace(0.0, 1.0, COLUMNS + 1), 0.5, ROWS // 2, 0.0, bump * size / math.cos(inclination))
    values = {field.name: getattr(flat, field.name) for field in fields(flat)}
    return SlantedMesh(**values, slope=math.tan(inclination), decimals=decimals)


def inclined_specimen(name: str, mesh: TwoArmMesh, layup: str, interface: Interface) -> Specimen:
    """Build the patch of two plies."""
    top, bottom = PLIES[layup]
    return Specimen(name, mesh, interface, 1.0, bottom, top)


def plane_stress(ply: Ply) -> FloatArray:
    """Return the plane-stress stiffness in the ply's axes, (3, 3), stresses over strains with engineering shear."""
    e1, e2, nu12, g12 = ply.in_plane
    return np.linalg.inv(np.array([[1.0 / e1, -nu12 / e1, 0.0], [-nu12 / e1, 1.0 / e2, 0.0], [0.0, 0.0, 1.0 / g12]]))


def stabilisation(bottom: Ply, top: Ply, areas: tuple[float, float], length: float) -> float:
    """Return the stabilisation parameter of (21) with the weights of (22) (N/mm^3).

    Parameters
    ----------
    bottom, top
        Plies below and above the interface; |D| is the spectral norm of `plane_stress`.
    areas
        Of the quads below and above (mm^2).
    length
        Of the interface element (mm).
    """
    norms = np.array([np.linalg.norm(plane_stress(ply), 2) for ply in (bottom, top)])
    softness = np.array(areas) / norms
    weights = softness / softness.sum()
    return float(2.0 * length * np.sum(weights**2 / softness))
