# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Benchmarks of the literature in space, with U8 at an infinite stiffness between C3D8I.

- Double cantilever beam: R. Krueger, "An approach to assess delamination propagation simulation capabilities in
  commercial finite element codes", NASA/TM-2008-215123, sections 5.1 and 5.2: T300/1076, [0]24.
- Mixed-mode bending: R. Krueger, "Development and application of benchmark examples for mixed-mode I/II quasi-static
  delamination propagation predictions", NASA/CR-2012-217562: IM7/8552, [0]24. Its models are in plane strain.
- Circular delamination: two Kirchhoff plates, see `circle_load`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from uel.delamination.blocks import Interface
from uel.delamination.keywords import text
from uel.delamination.materials import Cohesive, SolidPly, isotropic
from uel.delamination.mesh import crack_columns, graded_columns
from uel.delamination.plate_specimens import HALF, STRIP, circular_deck, dcb_deck, mmb_deck
from uel.delamination.plates import Laminate, TwoPlateMesh, two_plates
from uel.model.arrays import FloatArray

T300 = SolidPly("T300_1076", (139400.0, 10160.0, 10160.0), (0.30, 0.30, 0.436), (4600.0, 4600.0, 3540.0))
"""Table I of NASA/TM-2008-215123."""

DCB_LENGTH, DCB_WIDTH, DCB_ARM, DCB_CRACK, DCB_TOUGHNESS = 150.0, 25.0, 1.5, 30.0, 0.1703
"""Dimensions and toughness of the double cantilever beam (mm, N/mm)."""

DCB_CRITICAL = {
    30.0: (0.750, 60.7),
    31.0: (0.794, 58.8),
    32.0: (0.842, 57.3),
    33.0: (0.890, 55.6),
    34.0: (0.942, 54.2),
    35.0: (1.001, 52.5),
    40.0: (1.274, 46.7),
}
"""Crack length (mm): displacement of an arm (mm) and load (N) at which G reaches G_c in the middle of a straight front.

From equation (5) of the report and the values read from its figures 11 and 13.
"""

DCB_STRENGTH = 30.0
"""MPa. The report has none. Its process zone is 1 mm long, between 3 and 4 elements."""

IM7 = SolidPly("IM7_8552", (161000.0, 11380.0, 11380.0), (0.32, 0.32, 0.45), (5200.0, 5200.0, 3900.0))
MMB_SPAN, MMB_LENGTH, MMB_WIDTH, MMB_ARM, MMB_CRACK = 100.8, 110.4, 25.4, 2.25, 25.4
"""Span 2 L, width, height of an arm, crack (mm) of NASA/CR-2012-217562; the overhang beyond the support is free."""

MMB_LAW = Cohesive(0.0, 0.0, 60.0, 130.0, 0.212, 0.774)
MMB_ETA = 2.1
"""Toughnesses and exponent of BK of the report; the strengths are chosen, as it has none."""

MMB_CRITICAL = {0.2: (92.9, 1.64, 128.5), 0.5: (41.3, 1.34, 385.0), 0.8: (27.3, 1.65, 751.0)}
"""G_II/G: length of the lever (mm), displacement (mm) and load (N) at which the crack starts to grow."""

GRADING = 1.3, (3.0, 6.0)
"""Grading of the columns away from the crack's tip: ratio of neighbours, the largest before and behind (mm)."""

METAL = isotropic("METAL", 70000.0, 0.3)
CIRCLE_ARM, CIRCLE_CRACK, CIRCLE_TOUGHNESS, CIRCLE_STRENGTH = 1.0, 20.0, 0.5, 30.0
"""Height of a plate, radius of the first delamination (mm), fracture energy (N/mm), strength (MPa)."""

CIRCLE_LAW = Cohesive(0.0, 0.0, CIRCLE_STRENGTH, CIRCLE_STRENGTH, CIRCLE_TOUGHNESS, CIRCLE_TOUGHNESS)

RIM = 0.6728
"""Length, over its height, by which an isotropic arm is longer than the crack beside it: see `circle_load_with_rim`."""


def literature_files() -> dict[str, Callable[[], dict[str, str]]]:
    """Return the functions that build the decks, by folder."""

    def mmb() -> dict[str, str]:
        return {f"mmb_{100 * ratio:.0f}.inp": mmb_benchmark(ratio) for ratio in MMB_CRITICAL}

    return {
        "krueger_dcb": lambda: {"krueger_dcb.inp": dcb_benchmark()},
        "krueger_mmb": mmb,
        "circle": lambda: {"circle.inp": circle()},
    }


def consistent(law: Cohesive, eta: float = 1.0) -> Interface:
    """Return U8 with the consistent law, BK and local eigenvalues for beta."""
    return Interface("U8", law, law=2, eta=eta)


def dcb_benchmark(
    size: float = 0.3,
    across: int = 18,
    layers: int = 2,
    fine: tuple[float, float] = (28.8, 43.2),
    opening: float = 1.3,
    increment: float = 0.0125,
    every: int = 2,
) -> str:
    """Write half of the double cantilever beam.

    Parameters
    ----------
    size, fine
        Length of the bricks (mm) between two positions along the beam.
    across, layers
        Bricks across half the width, narrower towards the edge, and through the height of an arm.
    opening, increment, every
        Of each arm (mm), in increments of at most this part; field output in every so many.
    """
    x = crack_columns(DCB_LENGTH, fine, size, *GRADING)
    y = 0.5 * DCB_WIDTH * (1.0 - (1.0 - np.linspace(0.0, 1.0, across + 1)) ** 1.4)
    law = Cohesive(0.0, 0.0, DCB_STRENGTH, DCB_STRENGTH, DCB_TOUGHNESS, DCB_TOUGHNESS)
    z = np.round(np.linspace(0.0, DCB_ARM, layers + 1), 6)
    laminate = _beam(x, np.round(y, 6), z, DCB_CRACK, T300, consistent(law))
    title = "Krueger's double cantilever beam, C3D8I and U8 of infinite stiffness"
    static = (increment, 1.0, 1.0e-6, increment)
    return text(dcb_deck(title, laminate, opening, static, part=HALF, every=every))


def large_dcb() -> str:
    """Write the double cantilever beam with 100,860 unknowns, until its crack is about 33 mm long."""
    return dcb_benchmark(0.25, 40, 4, (29.0, 39.0), 0.9, 0.04, 10)


def mmb_benchmark(ratio: float, size: float = 0.25) -> str:
    """Strip of 1 mm in plane strain of the mixed-mode bending specimen at G_II/G; size: of the bricks (mm)."""
    lever, displacement, _ = MMB_CRITICAL[ratio]
    half = 0.5 * MMB_SPAN
    before = crack_columns(half, (24.4, half), size, *GRADING)
    after = np.linspace(half, 70.0, round((70.0 - half) / size) + 1)
    right = graded_columns(70.0, MMB_SPAN, size, 1.2, 1.0)
    x = np.concatenate([before, after[1:], right[1:], np.linspace(MMB_SPAN, MMB_LENGTH, 10)[1:]])
    y, z = np.array([0.0, 1.0]), np.array([0.0, 0.25, 0.75, 1.5, MMB_ARM])
    laminate = _beam(np.round(x, 6), y, z, MMB_CRACK, IM7, consistent(MMB_LAW, MMB_ETA))
    title = f"Krueger's mixed-mode bending at G_II/G = {ratio:g}, C3D8I and U8 of infinite stiffness"
    static = (0.01, 1.0, 1.0e-6, 0.01)
    return text(mmb_deck(title, laminate, MMB_SPAN, lever, 1.4 * displacement, static, part=STRIP, every=5))


def circle(size: float = 0.75, fine: float = 33.75, opening: float = 2.1) -> str:
    """Write a quarter of the circular delamination, on squares of `size` (mm) up to `fine`; opening: per plate (mm)."""
    laminate = circular_plates(size, fine, consistent(CIRCLE_LAW))
    title = "Circular delamination of two plates, C3D8I and U8 of infinite stiffness"
    return text(circular_deck(title, laminate, opening, (0.02, 1.0, 1.0e-6, 0.02), every=2))


def circular_plates(size: float, fine: float, interface: Interface) -> Laminate:
    """Mesh a quarter of two plates with a circular delamination, on squares of `size` (mm) up to `fine`."""
    inner = np.linspace(0.0, fine, round(fine / size) + 1)
    edges = np.round(np.concatenate([inner, graded_columns(fine, fine + 12.0, size, 1.3, 4.0)[1:]]), 6)
    centres = 0.5 * (edges[1:] + edges[:-1])
    bonded = np.hypot(*np.meshgrid(centres, centres, indexing="ij")) > CIRCLE_CRACK
    z = np.array([0.0, CIRCLE_ARM])
    return Laminate(TwoPlateMesh(edges, edges, z - CIRCLE_ARM, z, bonded), interface, (METAL,), (METAL,))


def circle_load() -> float:
    """Load (N) at which a circular delamination between two equal plates grows, whatever its radius.

    A clamped circular plate of radius a under a force P in its middle deflects by P a^2/(16 pi D) there (Timoshenko and
    Woinowsky-Krieger, Theory of Plates and Shells, section 19). Both plates together open by P a^2/(8 pi D), at
    constant load with the energy release rate G = P^2/2 dC/dA = P^2/2 (a/(4 pi D))/(2 pi a) = P^2/(16 pi^2 D). With
    G = G_c: P = 4 pi sqrt(D G_c). For one film on a rigid base it is sqrt(2) times as much.
    """
    return 4.0 * math.pi * math.sqrt(circle_bending() * CIRCLE_TOUGHNESS)


def circle_load_with_rim(radius: float) -> float:
    """Load (N) at which a circular delamination of a radius (mm) grows, with plates that give way at its rim.

    At a front with the bending moment M and the shear force V per length, each arm of height h has K = 2 sqrt(3) (M +
    chi V h)/h^(3/2), chi = RIM: the exact solution of an isotropic double cantilever beam, where M = P a and V = P
    (R.M.L. Foote and V.T. Buchwald, International Journal of Fracture 29 (1985) 125). With G = K^2/E' = (M + chi V
    h)^2/D of both arms, its compliance follows: the arm is longer by chi h, that is, the rim turns by M chi h/D. A
    plate under a force P in its middle has V = P/(2 pi a) there and, clamped, M = P/(4 pi). A rotation t of its rim
    takes D (1 + nu) t/a from M. Thus M = P/(4 pi) a/(a + (1 + nu) chi h), and G = G_c gives P.
    """
    rim = RIM * CIRCLE_ARM
    moment = radius / (radius + (1.0 + METAL.ratios[0]) * rim)
    return circle_load() / (moment + 2.0 * rim / radius)


def circle_bending() -> float:
    """Return the bending stiffness D of a plate (N mm)."""
    modulus, ratio = METAL.moduli[0], METAL.ratios[0]
    return modulus * CIRCLE_ARM**3 / (12.0 * (1.0 - ratio**2))


def _beam(x: FloatArray, y: FloatArray, z: FloatArray, crack: float, ply: SolidPly, interface: Interface) -> Laminate:
    """Build two like arms with a straight front; z: heights of the layers of nodes above the interface (mm)."""
    plies = (ply,) * (len(z) - 1)
    return Laminate(two_plates(x, y, z, crack), interface, plies, plies)
