# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Constants and section points of the cross-sections of beams (Analysis User's Guide, Beam cross-section library).

Places are along the local directions 1 and 2 from the nodes. Thin walls (PIPE, BOX, I) are lines in the middle of the
walls, along which Abaqus integrates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.model.properties import BeamSection

SHEAR_FACTORS: Final = {"RECT": 0.85, "CIRC": 0.89, "PIPE": 0.53, "BOX": 0.44, "I": 0.44, "GENERAL": 1.0}
"""Factors of G A in the transverse shear stiffness (Analysis User's Guide, Choosing a beam element)."""

Place = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Profile:
    """A cross-section.

    area          length^2
    inertia       I11, I22 and I12 about the centroid: integrals of x2^2, x1^2 and x1 x2
    torsion       torsional constant J
    centroid      place
    shear_centre  place
    points        numbers and places of the section points at which Abaqus gives stresses by default
    """

    area: float
    inertia: tuple[float, float, float]
    torsion: float
    centroid: Place = (0.0, 0.0)
    shear_centre: Place = (0.0, 0.0)
    points: tuple[tuple[int, float, float], ...] = ()


@dataclass(frozen=True, slots=True)
class _Wall:
    """A thin straight wall between two places."""

    start: Place
    end: Place
    thickness: float

    @property
    def length(self) -> float:
        return float(np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]))


def profile_of(section: BeamSection, dimension: int) -> Profile:
    """Return the cross-section of beams in a plane (2) or in space (3)."""
    return _PROFILES[section.profile](section.dimensions, dimension == 2)


def _rect(dimensions: tuple[float, ...], plane: bool) -> Profile:
    a, b = dimensions
    corners = ((1, -1, -1), (5, 1, -1), (21, -1, 1), (25, 1, 1))
    points = ((1, 0, -1), (5, 0, 1)) if plane else corners
    return Profile(
        a * b,
        (a * b**3 / 12, a**3 * b / 12, 0.0),
        rectangle_torsion(a, b),
        points=tuple((number, i * a / 2, j * b / 2) for number, i, j in points),
    )


def rectangle_torsion(a: float, b: float) -> float:
    """Compute the torsional constant of a rectangle (S. Timoshenko, J. Goodier, Theory of Elasticity, 1951,
    article 94).
    """
    long, short = max(a, b), min(a, b)
    odd = np.arange(1, 40, 2)
    series = (np.tanh(odd * np.pi * long / (2 * short)) / odd**5).sum()
    return float(long * short**3 * (1 - 192 / np.pi**5 * short / long * series) / 3)


def _circ(dimensions: tuple[float, ...], plane: bool) -> Profile:
    (radius,) = dimensions
    second = np.pi * radius**4 / 4
    points = _around(radius, (3, 7, 11, 15)) if not plane else ((1, 0.0, -radius), (5, 0.0, radius))
    return Profile(np.pi * radius**2, (second, second, 0.0), 2 * second, points=points)


def _pipe(dimensions: tuple[float, ...], plane: bool) -> Profile:
    outside, thickness = dimensions
    radius = outside - thickness / 2
    area = 2 * np.pi * radius * thickness
    second = area * radius**2 / 2
    points = _around(radius, (1, 3, 5, 7)) if not plane else ((1, 0.0, -radius), (5, 0.0, radius))
    return Profile(area, (second, second, 0.0), 2 * second, points=points)


def _around(radius: float, numbers: tuple[int, ...]) -> tuple[tuple[int, float, float], ...]:
    """Return points on direction 1, on 2, and opposite."""
    sides = ((1, 0), (0, 1), (-1, 0), (0, -1))
    return tuple((number, i * radius, j * radius) for number, (i, j) in zip(numbers, sides, strict=True))


def _box(dimensions: tuple[float, ...], plane: bool) -> Profile:
    a, b, thickness = dimensions[:3]
    x, y = (a - thickness) / 2, (b - thickness) / 2
    corners = ((-x, -y), (x, -y), (x, y), (-x, y))
    walls = [_Wall(start, end, thickness) for start, end in zip(corners, (*corners[1:], corners[0]), strict=True)]
    # R. Bredt's formula
    torsion = 4 * (4 * x * y) ** 2 * thickness / sum(wall.length for wall in walls)
    points = tuple((number, *place) for number, place in zip((1, 5, 9, 13), corners, strict=True))
    return _walled(walls, torsion, (0.0, 0.0), ((1, 0.0, -y), (5, 0.0, y)) if plane else points)


def _i(dimensions: tuple[float, ...], plane: bool) -> Profile:
    origin, height, bottom, top, t_bottom, t_top, t_web = dimensions
    low, high = t_bottom / 2 - origin, height - t_top / 2 - origin
    walls = [
        _Wall((-bottom / 2, low), (bottom / 2, low), t_bottom),
        _Wall((0.0, low), (0.0, high), t_web),
        _Wall((-top / 2, high), (top / 2, high), t_top),
    ]
    torsion = sum(wall.length * wall.thickness**3 for wall in walls) / 3
    # each flange takes the shear along direction 1 that its own inertia gives it
    stiffness = t_bottom * bottom**3, t_top * top**3
    centre = (stiffness[0] * low + stiffness[1] * high) / sum(stiffness)
    ends = ((1, -bottom / 2, low), (5, bottom / 2, low), (9, -top / 2, high), (13, top / 2, high))
    return _walled(walls, torsion, (0.0, centre), ((1, 0.0, low), (5, 0.0, high)) if plane else ends)


def _walled(
    walls: list[_Wall], torsion: float, shear_centre: Place, points: tuple[tuple[int, float, float], ...]
) -> Profile:
    """Integrate a section of thin straight walls by Simpson's rule, which is exact."""
    places = np.array([[w.start, np.add(w.start, w.end) / 2, w.end] for w in walls]).reshape(-1, 2)
    weights = np.array([np.array([1, 4, 1]) / 6 * w.length * w.thickness for w in walls]).ravel()
    area = weights.sum()
    centroid = weights @ places / area
    second = (places - centroid).T @ (weights[:, None] * (places - centroid))
    inertia = float(second[1, 1]), float(second[0, 0]), float(second[0, 1])
    return Profile(float(area), inertia, torsion, (float(centroid[0]), float(centroid[1])), shear_centre, points)


def _general(dimensions: tuple[float, ...], plane: bool) -> Profile:
    del plane
    area, first, product, second, torsion = dimensions
    return Profile(area, (first, second, product), torsion)


_PROFILES: Final[dict[str, Callable[[tuple[float, ...], bool], Profile]]] = {
    **{"RECT": _rect, "CIRC": _circ, "PIPE": _pipe, "BOX": _box, "I": _i},
    "GENERAL": _general,
}
