# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Corrected beam theory of delamination specimens of two equal orthotropic arms, fibres along the beam.

Source of the corrections: J. G. Williams, "End corrections for orthotropic DCB specimens", Composites Science and
Technology 35 (1989) 367-376, and Y. Wang, J. G. Williams, "Corrections for mode II fracture toughness specimens of
composites materials", Composites Science and Technology 43 (1992) 251-256. The elastic
ligament is equivalent to a crack longer by chi h in mode I and by 0.42 chi h in mode II.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from uel.model.arrays import FloatArray

MODE_2_CORRECTION = 0.42


@dataclass(frozen=True, slots=True)
class Arms:
    """Two equal arms: width B and height h of one arm in mm; E11, E22, G12 in MPa."""

    width: float
    height: float
    e11: float
    e22: float
    g12: float

    @property
    def inertia(self) -> float:
        """Second moment of area of one arm, B h^3 / 12 (mm^4)."""
        return self.width * self.height**3 / 12.0

    @property
    def bending_stiffness(self) -> float:
        """E11 I of one arm (N mm^2)."""
        return self.e11 * self.inertia

    @property
    def chi(self) -> float:
        """Williams' correction factor: chi = sqrt(E11/(11 G12) (3 - 2 (Gamma/(1 + Gamma))^2))."""
        gamma = 1.18 * math.sqrt(self.e11 * self.e22) / self.g12
        return math.sqrt(self.e11 / (11.0 * self.g12) * (3.0 - 2.0 * (gamma / (1.0 + gamma)) ** 2))

    @property
    def correction(self) -> float:
        """Crack length correction of mode I, chi h (mm)."""
        return self.chi * self.height


def dcb_load(arms: Arms, crack: float, toughness: float) -> float:
    """Load (N) at which a double cantilever beam's crack of length a (mm) grows.

    From G_I = P^2 (a + chi h)^2 / (B E11 I) = G_Ic (N/mm).
    """
    return math.sqrt(arms.width * arms.bending_stiffness * toughness) / (crack + arms.correction)


def dcb_compliance(arms: Arms, crack: float) -> float:
    """Return the displacement of one arm's end per load (mm/N): Delta/P = (a + chi h)^3 / (3 E11 I)."""
    return (crack + arms.correction) ** 3 / (3.0 * arms.bending_stiffness)


def dcb_crack(arms: Arms, compliance: float) -> float:
    """Return the crack length (mm) with this compliance (mm/N, one arm): the inverse of `dcb_compliance`."""
    return math.cbrt(3.0 * arms.bending_stiffness * compliance) - arms.correction


def dcb_elastica(bending: float, toughness: float, width: float, opening: float) -> tuple[float, float]:
    """Load (N) and length of the crack (mm) of a double cantilever beam in large rotations while the crack grows.

    The arms are elasticas, clamped at the crack tip; the loads keep their direction. With the rotation t0 of
    an end, EI theta'^2/2 = P (sin t0 - sin theta); the moments at the tip make the energy release rate
    2 P sin t0/width, which is the fracture energy.

    Parameters
    ----------
    bending
        EI of an arm (N mm^2).
    toughness
        Fracture energy (N/mm).
    width
        Of the specimen (mm).
    opening
        Distance of the loaded ends (mm).
    """

    def arm(end: float) -> tuple[float, float, float]:
        """Return the load, rise of the end and length of an arm."""
        load = toughness * width / (2.0 * math.sin(end))

        def by_root(s: float) -> float:
            # theta = end - s^2 takes the root out of the denominator
            if not s > 0.0:
                return 2.0 / math.sqrt(math.cos(end))
            return 2.0 * s / math.sqrt(math.sin(end) - math.sin(end - s * s))

        scale, limit = math.sqrt(bending / (2.0 * load)), math.sqrt(end)
        rise = quad(lambda s: math.sin(end - s * s) * by_root(s), 0.0, limit)[0]
        return load, scale * rise, scale * quad(by_root, 0.0, limit)[0]

    end = brentq(lambda angle: arm(angle)[1] - 0.5 * opening, 1e-5, 1.4)
    load, _, length = arm(end)
    return load, length


def dcb_displacement(arms: Arms, crack: float, toughness: float) -> float:
    """Return the displacement of one arm's end (mm) while the crack of length a (mm) grows."""
    return dcb_load(arms, crack, toughness) * dcb_compliance(arms, crack)


def dcb_curve(arms: Arms, crack: float, toughness: float, displacement: FloatArray) -> FloatArray:
    """Load (N) of a double cantilever beam that is opened steadily.

    Parameters
    ----------
    arms, crack, toughness
        Specimen, initial crack length (mm) and G_Ic (N/mm).
    displacement
        Displacements of one arm's end (mm), any shape.

    Returns
    -------
    FloatArray
        Linear up to the onset of growth, then P = sqrt(B E11 I G_Ic) / (a + chi h) with
        (a + chi h)^2 = 3 Delta sqrt(E11 I / (B G_Ic)); same shape as `displacement`.
    """
    stiff = arms.bending_stiffness
    linear = displacement / dcb_compliance(arms, crack)
    length = np.sqrt(3.0 * np.maximum(displacement, 1e-300) * math.sqrt(stiff / (arms.width * toughness)))
    growing = math.sqrt(arms.width * stiff * toughness) / length
    return np.asarray(np.where(displacement <= dcb_displacement(arms, crack, toughness), linear, growing))


def enf_load(arms: Arms, crack: float, toughness: float) -> float:
    """Load (N) at which an end-notched flexure specimen's crack of length a (mm) grows.

    From G_II = 9 P^2 (a + 0.42 chi h)^2 / (16 B^2 h^3 E11) = G_IIc (N/mm).
    """
    length = crack + MODE_2_CORRECTION * arms.correction
    return 4.0 * arms.width * math.sqrt(arms.height**3 * arms.e11 * toughness) / (3.0 * length)


def frmm_load(arms: Arms, crack: float, toughness_1: float, toughness_2: float) -> float:
    """Load (N) at which the crack (mm) of a fixed-ratio mixed-mode specimen grows: only the upper arm is loaded.

    The moment M = P a of one arm alone splits into G_I = M^2/(4 B E11 I) and G_II = 3 M^2/(16 B E11 I), 4 to 3
    (Williams, International Journal of Fracture 36 (1988) 101-119), here with the corrections above; the criterion
    is G_I/G_Ic + G_II/G_IIc = 1, toughnesses in N/mm.
    """
    mode_1 = (crack + arms.correction) ** 2 / (4.0 * toughness_1)
    mode_2 = 3.0 * (crack + MODE_2_CORRECTION * arms.correction) ** 2 / (16.0 * toughness_2)
    return math.sqrt(arms.width * arms.bending_stiffness / (mode_1 + mode_2))


def frmm_mode_ratio(arms: Arms, crack: float) -> float:
    """Return G_I/G_II of a fixed-ratio mixed-mode specimen: 4/3 of plain beams, with the corrections above."""
    return 4.0 / 3.0 * ((crack + arms.correction) / (crack + MODE_2_CORRECTION * arms.correction)) ** 2


def enf_compliance(arms: Arms, crack: float, half_span: float) -> float:
    """Return the deflection at mid-span per load (mm/N) of an end-notched flexure specimen of span 2 L (mm).

    (2 L^3 + 3 (a + 0.42 chi h)^3)/(8 B h^3 E11) plus the shear of the beam, 3 L/(10 B h G12); the correction includes
    the shear at the crack tip.
    """
    length = crack + MODE_2_CORRECTION * arms.correction
    bending = (2.0 * half_span**3 + 3.0 * length**3) / (8.0 * arms.width * arms.height**3 * arms.e11)
    return bending + 3.0 * half_span / (10.0 * arms.width * arms.height * arms.g12)


def frmm_compliance(arms: Arms, crack: float, length: float) -> float:
    """Return the loaded end's displacement per load (mm/N) of a fixed-ratio specimen, clamped at `length` (mm).

    Superposition of opposite and of equal deflections of the arms:
    (a + chi h)^3/(6 E11 I) + (a + 0.42 chi h)^3/(8 E11 I) + L^3/(24 E11 I).
    """
    mode_1 = (crack + arms.correction) ** 3 / 6.0
    mode_2 = (crack + MODE_2_CORRECTION * arms.correction) ** 3 / 8.0
    return (mode_1 + mode_2 + length**3 / 24.0) / arms.bending_stiffness


def mmb_mode_mix(arms: Arms, crack: float, half_span: float, lever: float) -> float:
    """Return G_II/G of a mixed-mode bending specimen with the load at the distance c from mid-span, for a crack (mm).

    G_I = 12 P^2 (3 c - L)^2 (a + chi h)^2/(16 B^2 h^3 L^2 E11), G_II = 9 P^2 (c + L)^2 (a + 0.42 chi h)^2 over the same
    (J. R. Reeder and J. H. Crews, AIAA Journal 28 (1990) 1270-1276, with the corrections above).
    """
    mode_1 = 12.0 * ((3.0 * lever - half_span) * (crack + arms.correction)) ** 2
    mode_2 = 9.0 * ((lever + half_span) * (crack + MODE_2_CORRECTION * arms.correction)) ** 2
    return mode_2 / (mode_1 + mode_2)
