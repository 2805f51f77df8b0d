# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A smooth plane stress field without body forces, decks that prescribe it on a boundary, and norms of the error.

Airy's function phi = A exp(k x) sin(s k y) gives the stresses (phi_yy, phi_xx, -phi_xy), in equilibrium by
construction. With the in-plane compliances a_ij of an orthotropic ply, compatibility asks for

    a_22 - (2 a_12 + a_66) s^2 + a_11 s^4 = 0

(S. G. Lekhnitskii, Anisotropic Plates, 1968), whose smaller root is taken. Integrated strains are

    u = k (a_12 - a_11 s^2) phi,   v = -k (a_22 - a_12 s^2) A exp(k x) cos(s k y)/s.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uel.delamination.blocks import BY_EQUATION_21, Interface, Specimen, element_blocks
from uel.delamination.keywords import integer_table, node_block, node_set, number, text
from uel.delamination.materials import PLY_0, Cohesive, Ply
from uel.delamination.mesh import TwoArmMesh, two_arms
from uel.model.arrays import FloatArray, IntArray

# so stiff that its separation is negligible, so strong that it stays elastic
STIFF = Cohesive(1.0e12, 1.0e12, strength_normal=1e6, strength_shear=1e6, toughness_1=1e6, toughness_2=1e6)
# a smooth distortion keeps the rates and makes the quads general; it leaves the interface at y = 1/2 alone
DISTORTION = 0.04


@dataclass(frozen=True, slots=True)
class Field:
    """The field in a ply whose axes are x and y; stresses of the size of `amplitude` (MPa), wave number 1/mm."""

    ply: Ply = PLY_0
    amplitude: float = 10.0
    wave: float = 2.0

    @property
    def compliance(self) -> FloatArray:
        """Plane stress compliance (3, 3) for (e11, e22, 2 e12)."""
        e1, e2, nu12, g12 = self.ply.in_plane
        return np.array([[1.0 / e1, -nu12 / e1, 0.0], [-nu12 / e1, 1.0 / e2, 0.0], [0.0, 0.0, 1.0 / g12]])

    @property
    def root(self) -> float:
        """The root s of the characteristic equation."""
        a = self.compliance
        middle = 2.0 * a[0, 1] + a[2, 2]
        return float(np.sqrt((middle - np.sqrt(middle**2 - 4.0 * a[0, 0] * a[1, 1])) / (2.0 * a[0, 0])))

    def displacement(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Displacements (mm), components last."""
        a, s, k = self.compliance, self.root, self.wave
        size = self.amplitude / k**2 * np.exp(k * x)
        u = k * (a[0, 1] - a[0, 0] * s**2) * size * np.sin(s * k * y)
        v = -k * (a[1, 1] - a[0, 1] * s**2) * size * np.cos(s * k * y) / s
        return np.stack([u, v], axis=-1)

    def stress(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Stresses s11, s22, s12 (MPa), components last."""
        s, k = self.root, self.wave
        size = self.amplitude * np.exp(k * x)
        sine, cosine = np.sin(s * k * y), np.cos(s * k * y)
        return np.stack([-(s**2) * size * sine, size * sine, -s * size * cosine], axis=-1)


@dataclass(frozen=True, slots=True)
class Plate:
    """Unit square of n x n quads; `points` by `labels`, quads as label and nodes."""

    mesh: TwoArmMesh
    labels: IntArray
    points: FloatArray
    quads: IntArray


def plate(n: int, *, interface: bool) -> Plate:
    """Unit square of n x n distorted quads (n even); the halves share their nodes unless there is an interface."""
    mesh = two_arms(np.linspace(0.0, 1.0, n + 1), 0.5, n // 2, crack=0.0)
    labels, points = mesh.nodes()
    wave = np.prod(np.sin(2.0 * np.pi * points), axis=1)
    points = points + DISTORTION * wave[:, None] * np.array([1.0, 0.5])
    quads = np.concatenate([mesh.quads("lower"), mesh.quads("upper")])
    if not interface:
        low, high = mesh.interface_lines
        keep = ~np.isin(labels, high)
        labels, points = labels[keep], points[keep]
        nodes = quads[:, 1:]
        quads[:, 1:] = np.where(np.isin(nodes, high), nodes - high[0] + low[0], nodes)
    return Plate(mesh, labels, points, quads)


def write_plate_deck(folder: Path, n: int, field: Field, *, quads: str = "U1", interface: str | None = None) -> Path:
    """Deck of a plate with the field's displacements on its boundary; returns its path.

    `quads` is 'U1' or 'CPS4', `interface` None, 'U2' or 'U4'.
    """
    body = plate(n, interface=interface is not None)
    specimen = Specimen(
        "plate",
        body.mesh,
        Interface(interface or "U2", STIFF, BY_EQUATION_21, consistent=False),
        1.0,
        field.ply,
        field.ply,
        quads,
    )
    (folder / "plate_quads.inp").write_text(integer_table(body.quads), encoding="ascii")
    blocks = element_blocks(specimen)
    if interface is None:
        blocks = blocks[: next(k for k, line in enumerate(blocks) if line.startswith("** interface"))]
    else:
        rows = body.mesh.interface8() if interface == "U4" else body.mesh.interface4()
        (folder / f"plate_interface{rows.shape[1] - 1}.inp").write_text(integer_table(rows), encoding="ascii")
    edge = np.any((body.points == 0.0) | (body.points == 1.0), axis=1)
    values = field.displacement(*body.points[edge].T)
    prescribed = [
        f"{label}, {dof}, {dof}, {number(value)}"
        for label, pair in zip(body.labels[edge].tolist(), values.tolist(), strict=True)
        for dof, value in enumerate(pair, start=1)
    ]
    lines = ["*HEADING", "Plate with a manufactured solution", *node_block(body.labels, body.points), *blocks]
    lines += node_set("EDGE", body.labels[edge])
    lines += ["*STEP, INC=1" + (", UNSYMM=YES" if interface else ""), "*STATIC"]
    lines += [
        "1., 1., 1., 1.",
        "*BOUNDARY",
        *prescribed,
        "*OUTPUT, FIELD, FREQUENCY=1",
        "*NODE OUTPUT",
        "U",
        "*END STEP",
    ]
    path = folder / "plate.inp"
    path.write_text(text(lines), encoding="ascii")
    return path


def errors(body: Plate, field: Field, displacement: FloatArray) -> tuple[float, float]:
    """L2 norm of the error of the displacements and energy norm of the error, both relative to those of the field.

    `displacement` (n, 2) belongs to the labels of `body`; 3 x 3 Gauss points in every quad.
    """
    place = np.searchsorted(body.labels, body.quads[:, 1:])
    corners, nodal = body.points[place], displacement[place]
    stiffness = np.linalg.inv(field.compliance)
    abscissas, weights = np.polynomial.legendre.leggauss(3)
    sums = np.zeros(4)
    for xi, weight_xi in zip(abscissas, weights, strict=True):
        for eta, weight_eta in zip(abscissas, weights, strict=True):
            shape, slopes = _bilinear(xi, eta)
            jacobian = np.einsum("dk,ekc->edc", slopes, corners)
            volume = np.linalg.det(jacobian) * weight_xi * weight_eta
            gradient = np.einsum("edc,ck->edk", np.linalg.inv(jacobian), slopes)
            slope = np.einsum("edk,ekc->edc", gradient, nodal)
            strain = np.stack([slope[:, 0, 0], slope[:, 1, 1], slope[:, 0, 1] + slope[:, 1, 0]], axis=-1)
            x, y = np.einsum("k,ekc->ce", shape, corners)
            exact, stress = field.displacement(x, y), field.stress(x, y)
            off = np.einsum("k,ekc->ec", shape, nodal) - exact
            strain_off = strain - stress @ field.compliance
            terms = (off**2, exact**2, strain_off * (strain_off @ stiffness), stress * (stress @ field.compliance))
            sums += [float(np.sum(volume * np.sum(term, axis=1))) for term in terms]
    return float(np.sqrt(sums[0] / sums[1])), float(np.sqrt(sums[2] / sums[3]))


def _bilinear(xi: float, eta: float) -> tuple[FloatArray, FloatArray]:
    """Shape functions (4,) and their derivatives (2, 4) by xi and eta."""
    signs = np.array([[-1.0, 1.0, 1.0, -1.0], [-1.0, -1.0, 1.0, 1.0]])
    along, across = 1.0 + signs[0] * xi, 1.0 + signs[1] * eta
    return along * across / 4.0, np.stack([signs[0] * across, signs[1] * along]) / 4.0
