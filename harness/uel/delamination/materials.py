# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plies and cohesive parameters (N, mm, MPa).

HTA/6376C carbon/epoxy is that of tables 1 and 2 of Ghosh, Duddu and Annavarapu.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Ply:
    """Orthotropic ply in its plane X1-X2, as the data line of *ELASTIC, TYPE=LAMINA (moduli in MPa).

    The last two shear moduli have no effect in a plane model; Abaqus requires them on the line.
    """

    name: str
    e1: float
    e2: float
    nu12: float
    g12: float
    g13: float
    g23: float

    @property
    def in_plane(self) -> tuple[float, float, float, float]:
        """E1, E2, nu12, G12 for plane stress."""
        return self.e1, self.e2, self.nu12, self.g12

    @property
    def lamina(self) -> tuple[float, ...]:
        """Data line of *ELASTIC, TYPE=LAMINA."""
        return self.e1, self.e2, self.nu12, self.g12, self.g13, self.g23


@dataclass(frozen=True, slots=True)
class SolidPly:
    """Orthotropic ply in 3D, as the data lines of *ELASTIC, TYPE=ENGINEERING CONSTANTS.

    name    of its material, its orientation and its element set
    moduli  E1, E2, E3 (MPa)
    ratios  nu12, nu13, nu23
    shear   G12, G13, G23 (MPa)
    angle   of axis 1 from x about z (degrees); axis 3 is z
    """

    name: str
    moduli: tuple[float, float, float]
    ratios: tuple[float, float, float]
    shear: tuple[float, float, float]
    angle: float = 0.0

    @property
    def isotropic(self) -> bool:
        """True if the constants are the same in all directions."""
        same = all(len(set(values)) == 1 for values in (self.moduli, self.ratios, self.shear))
        return same and math.isclose(self.shear[0], self.moduli[0] / (2.0 * (1.0 + self.ratios[0])), rel_tol=1e-12)

    @property
    def constants(self) -> dict[str, float]:
        """Constants by name: E1, ..., NU12, ..., G12, ..."""
        names = [f"{name}{axes}" for name, pairs in _CONSTANTS.items() for axes in pairs]
        return dict(zip(names, (*self.moduli, *self.ratios, *self.shear), strict=True))


_CONSTANTS = {"E": ("1", "2", "3"), "NU": ("12", "13", "23"), "G": ("12", "13", "23")}


def isotropic(name: str, modulus: float, ratio: float) -> SolidPly:
    """Create an isotropic material: Young's modulus (MPa), Poisson's ratio."""
    return SolidPly(name, (modulus,) * 3, (ratio,) * 3, (modulus / (2.0 * (1.0 + ratio)),) * 3)


@dataclass(frozen=True, slots=True)
class Cohesive:
    """Bilinear anisotropic cohesive law (8)-(11): stiffnesses in N/mm^3, strengths in MPa, toughnesses in N/mm."""

    stiffness_normal: float
    stiffness_shear: float
    strength_normal: float = 30.0
    strength_shear: float = 60.0
    toughness_1: float = 0.26
    toughness_2: float = 1.002

    def with_stiffness(self, stiffness: float) -> Cohesive:
        """Change the stiffness in both directions, and keep strengths and toughnesses."""
        return replace(self, stiffness_normal=stiffness, stiffness_shear=stiffness)


# table 1: fibres along X1, and the same ply with its fibres along X3, whose plane X1-X2 is that of isotropy
PLY_0 = Ply("PLY_0", 1.2e5, 1.05e4, 0.3, 5.52e3, 5.52e3, 3.48e3)
PLY_90 = Ply("PLY_90", 1.05e4, 1.05e4, 0.51, 3.48e3, 5.52e3, 5.52e3)
# table 2, with the middle one of its stiffnesses
TABLE_2 = Cohesive(1.0e6, 1.0e6)
