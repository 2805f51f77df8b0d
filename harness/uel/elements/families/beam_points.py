# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Section points of beams over which a material is integrated (Analysis User's Guide, Beam cross-section library).

Their numbers are the default ones. Second moments of the points are exact, and so is the torsional constant.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.elements.families.beam_profiles import profile_of
from uel.elements.simpson import simpson
from uel.model.arrays import FloatArray
from uel.model.element_types import Tensor
from uel.model.properties import BeamSection

DEFAULT_POINTS: Final = {
    "RECT": ((5,), (5, 5)),
    "CIRC": ((5,), (3, 8)),
    "PIPE": ((5,), (8,)),
    "BOX": ((5,), (5, 5)),
    "I": ((5,), (5, 5, 5)),
}
"""Default numbers of section points in a plane and in space, as on the data line."""

_WALL: Final = 5
"""Points of a thin straight wall."""

_TERMS: Final = 2000
"""Terms of the series of the torsion of a rectangle."""


@dataclass(frozen=True, slots=True)
class SectionPoints:
    """Section points in the order of their numbers, from 1.

    place  (points, 2) along the local directions 1 and 2 from the nodes
    area   (points,)
    lever  (points,) shear strain over the twist; zero where torsion makes none at the points
    """

    place: FloatArray
    area: FloatArray
    lever: FloatArray


def section_tensor(section: BeamSection, dimension: int) -> Tensor:
    """Return the stress components at points of beams in a plane (2) or in space (3):
    open sections have no torsional shear.
    """
    return Tensor.UNIAXIAL if dimension == 2 or section.profile == "I" else Tensor.TORSION


def section_points(section: BeamSection, dimension: int) -> SectionPoints:
    """Return all section points of beams in a plane (2) or in space (3)."""
    place, area, lever = (_IN_PLANE if dimension == 2 else _IN_SPACE)[section.profile](section.dimensions)
    if section_tensor(section, dimension) is Tensor.TORSION:
        # the strain energy of an elastic section is that of its torsional constant
        lever = lever * np.sqrt(profile_of(section, dimension).torsion / (area @ lever**2))
    return SectionPoints(place, area, lever)


_Points = tuple[FloatArray, FloatArray, FloatArray]


def _along_2(heights: FloatArray, area: FloatArray) -> _Points:
    """Return points of beams in a plane."""
    return np.column_stack([np.zeros(len(heights)), heights]), area, np.zeros(len(heights))


def _rect_in_plane(dimensions: tuple[float, ...]) -> _Points:
    a, b = dimensions
    at, weight = simpson(_WALL)
    return _along_2((at - 0.5) * b, weight * a * b)


def _circ_in_plane(dimensions: tuple[float, ...]) -> _Points:
    """Return points in equal steps; area, second moment and the moment of both
    halves (of a plastic hinge) are exact.
    """
    (radius,) = dimensions
    area = np.array([np.pi / 4 - 2 / 3, 8 / 3 - np.pi / 2, 3 * np.pi / 2 - 4, 8 / 3 - np.pi / 2, np.pi / 4 - 2 / 3])
    return _along_2(radius * np.linspace(-1, 1, _WALL), radius**2 * area)


def _pipe_in_plane(dimensions: tuple[float, ...]) -> _Points:
    """Return points of eight equal parts of the circumference, seen from the side."""
    outside, thickness = dimensions
    radius = outside - thickness / 2
    angle = np.pi * np.linspace(-0.5, 0.5, 5)
    return _along_2(radius * np.sin(angle), 2 * np.pi * radius * thickness * np.array([1, 2, 2, 2, 1]) / 8)


def _box_in_plane(dimensions: tuple[float, ...]) -> _Points:
    """Return points of two walls, with the other two walls at their ends."""
    a, b, thickness = dimensions[:3]
    at, weight = simpson(_WALL)
    height = b - thickness
    area = 2 * thickness * height * weight
    area[[0, -1]] += thickness * (a - thickness)
    return _along_2((at - 0.5) * height, area)


def _i_in_plane(dimensions: tuple[float, ...]) -> _Points:
    """Return points of the web, with the flanges at its ends."""
    origin, height, bottom, top, t_bottom, t_top, t_web = dimensions
    low, high = t_bottom / 2 - origin, height - t_top / 2 - origin
    at, weight = simpson(_WALL)
    area = t_web * (high - low) * weight
    area[0] += t_bottom * bottom
    area[-1] += t_top * top
    return _along_2(low + at * (high - low), area)


def _rect(dimensions: tuple[float, ...]) -> _Points:
    a, b = dimensions
    at, weight = simpson(_WALL)
    x, y = np.meshgrid((at - 0.5) * a, (at - 0.5) * b)
    area = a * b * np.outer(weight, weight).ravel()
    return np.column_stack([x.ravel(), y.ravel()]), area, rectangle_shear(a, b, x.ravel(), y.ravel())


def rectangle_shear(a: float, b: float, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return shear strains over the twist at places of a rectangle with sides a along x and b along y.

    S. Timoshenko, J. Goodier, Theory of Elasticity, 1951, article 94.
    """
    if a > b:
        return rectangle_shear(b, a, y, x)
    odd = np.arange(1, 2 * _TERMS, 2)
    wave, sign = odd * np.pi / a, np.where(odd % 4 == 1, 1.0, -1.0)
    # of hyperbolic functions over the cosine at the end, which would overflow
    below, above = np.exp(-np.outer(b / 2 - y, wave)), np.exp(-np.outer(b / 2 + y, wave))
    end = 1 + np.exp(-wave * b)
    factor = 8 * a / np.pi**2 * sign / odd**2 / end
    along_y = -2 * x + ((below + above) * np.sin(np.outer(x, wave))) @ factor
    along_x = -((below - above) * np.cos(np.outer(x, wave))) @ factor
    found = np.hypot(along_x, along_y)
    found[(abs(abs(x) - a / 2) < 1e-9 * a) & (abs(abs(y) - b / 2) < 1e-9 * b)] = 0.0
    return np.asarray(found)


def _circ(dimensions: tuple[float, ...]) -> _Points:
    """Return the middle, then two points on each of eight radii, from direction 1 to 2 and on."""
    (radius,) = dimensions
    at, weight = simpson(3)
    angle = np.pi / 4 * np.arange(8)
    r = np.concatenate([[0.0], np.tile(radius * at[1:], 8)])
    angles = np.concatenate([[0.0], np.repeat(angle, 2)])
    area = np.concatenate([[0.0], np.tile(radius * weight[1:] * radius * at[1:] * np.pi / 4, 8)])
    return np.column_stack([r * np.cos(angles), r * np.sin(angles)]), area, r


def _pipe(dimensions: tuple[float, ...]) -> _Points:
    """Return eight points from direction 1 to 2 and on."""
    outside, thickness = dimensions
    radius = outside - thickness / 2
    angle = np.pi / 4 * np.arange(8)
    place = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return place, np.full(8, 2 * np.pi * radius * thickness / 8), np.full(8, radius)


def _box(dimensions: tuple[float, ...]) -> _Points:
    """Return points along the middle line from the lower left corner, first to the right; walls share their corners."""
    a, b, thickness = dimensions[:3]
    x, y = (a - thickness) / 2, (b - thickness) / 2
    corners = np.array([(-x, -y), (x, -y), (x, y), (-x, y)])
    at, weight = simpson(_WALL)
    count = 4 * (_WALL - 1)
    place, area = np.zeros((count, 2)), np.zeros(count)
    for k, (start, end) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
        rows = (k * (_WALL - 1) + np.arange(_WALL)) % count
        place[rows] = start + np.outer(at, end - start)
        area[rows] += thickness * np.linalg.norm(end - start) * weight
    # the shear flow is the same everywhere
    return place, area, np.ones(count)


def _i(dimensions: tuple[float, ...]) -> _Points:
    """Return points of the bottom flange from left to right, of the web between the flanges upwards,
    of the top flange.
    """
    origin, height, bottom, top, t_bottom, t_top, t_web = dimensions
    low, high = t_bottom / 2 - origin, height - t_top / 2 - origin
    at, weight = simpson(_WALL)
    zeros = np.zeros(_WALL)
    web = np.column_stack([zeros, low + at * (high - low)])
    parts = [
        np.column_stack([(at - 0.5) * bottom, zeros + low]),
        web[1:-1],
        np.column_stack([(at - 0.5) * top, zeros + high]),
    ]
    of_web = t_web * (high - low) * weight
    area = np.concatenate([t_bottom * bottom * weight, of_web[1:-1], t_top * top * weight])
    # both ends of the web are in the middle of a flange
    area[[_WALL // 2, -_WALL // 2]] += of_web[[0, -1]]
    return np.concatenate(parts), area, np.zeros(len(area))


_IN_PLANE: Final[dict[str, Callable[[tuple[float, ...]], _Points]]] = {
    **{"RECT": _rect_in_plane, "CIRC": _circ_in_plane, "PIPE": _pipe_in_plane, "BOX": _box_in_plane, "I": _i_in_plane}
}
_IN_SPACE: Final[dict[str, Callable[[tuple[float, ...]], _Points]]] = {
    **{"RECT": _rect, "CIRC": _circ, "PIPE": _pipe, "BOX": _box, "I": _i}
}
