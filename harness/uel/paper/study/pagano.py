# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Exact solution of a laminated strip in cylindrical bending.

N.J. Pagano, Exact solutions for composite laminates in cylindrical bending, Journal of Composite Materials 3 (1969)
398: simply supported at x = 0 and x = L, in plane strain, pressed by q sin(p x) with p = pi/L at the upper face. With
u = U(y) cos(p x), v = V(y) sin(p x), tau = T(y) cos(p x) and sigma_y = S(y) sin(p x) the equations of elasticity of a
ply are four of first order in y; its matrix exponential hands them from the lower to the upper face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from uel.model.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class StripPly:
    """A ply in its axes x, y (across the plies) and z: moduli (3,), Poisson's ratios (xy, xz, yz), shear modulus xy."""

    moduli: tuple[float, float, float]
    ratios: tuple[float, float, float]
    shear: float

    @property
    def stiffness(self) -> FloatArray:
        """Matrix (2, 2) of sigma_x and sigma_y by their strains in plane strain."""
        (e1, e2, e3), (n12, n13, n23) = self.moduli, self.ratios
        flexibility = np.array(
            [[1 / e1, -n12 / e1, -n13 / e1], [-n12 / e1, 1 / e2, -n23 / e2], [-n13 / e1, -n23 / e2, 1 / e3]]
        )
        return np.linalg.inv(flexibility)[:2, :2]

    def transfer(self, wave: float) -> FloatArray:
        """Matrix (4, 4) of d(U, V, T, S)/dy."""
        (c11, c12), (_, c22) = self.stiffness
        # sigma_x = X sin(p x), X = -c11 p U + c12 dV/dy
        opening = np.array([c12 * wave / c22, 0.0, 0.0, 1.0 / c22])
        along = c12 * opening - np.array([c11 * wave, 0.0, 0.0, 0.0])
        return np.array([[0.0, -wave, 1.0 / self.shear, 0.0], opening, -wave * along, [0.0, 0.0, wave, 0.0]])


@dataclass(frozen=True, slots=True)
class Strip:
    """Strip of plies, from the lowest to the highest.

    length   L of the whole strip
    heights  of the plies
    load     q, in the direction of y
    """

    length: float
    heights: Sequence[float]
    plies: Sequence[StripPly]
    load: float = 1.0

    @property
    def wave(self) -> float:
        """p = pi/L."""
        return np.pi / self.length

    def amplitudes(self, y: float) -> FloatArray:
        """Return U, V, T and S at a height above the lower face."""
        whole = self._transfer(sum(self.heights))
        # at the lower face T = S = 0, at the upper one T = 0 and S = q
        lower = np.linalg.solve(whole[2:, :2], [0.0, self.load])
        amplitudes: FloatArray = self._transfer(y) @ np.concatenate([lower, np.zeros(2)])
        return amplitudes

    def _transfer(self, y: float) -> FloatArray:
        """Matrix (4, 4) from the lower face to a height."""
        matrix: FloatArray = np.eye(4)
        left = y
        for height, ply in zip(self.heights, self.plies, strict=True):
            matrix = expm(min(height, max(left, 0.0)) * ply.transfer(self.wave)) @ matrix
            left -= height
        return matrix

    def displacements(self, points: FloatArray) -> FloatArray:
        """Return u and v (n, 2) at points (n, 2)."""
        at = {y: self.amplitudes(y) for y in np.unique(points[:, 1]).tolist()}
        amplitudes = np.array([at[y] for y in points[:, 1].tolist()])
        angle = self.wave * points[:, 0]
        return np.column_stack([amplitudes[:, 0] * np.cos(angle), amplitudes[:, 1] * np.sin(angle)])

    def tractions(self, x: FloatArray, y: float) -> FloatArray:
        """Return tau and sigma_y (n, 2) at abscissas of a height."""
        _, _, shear, normal = self.amplitudes(y)
        return np.column_stack([shear * np.cos(self.wave * x), normal * np.sin(self.wave * x)])

    @property
    def work(self) -> float:
        """Half of the work of the load on one half of the strip, its strain energy, for a width of 1."""
        return 0.5 * self.load * float(self.amplitudes(sum(self.heights))[1]) * self.length / 4
