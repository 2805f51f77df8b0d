# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Counts and positions of the properties of the project's elements."""

from __future__ import annotations

from dataclasses import dataclass

_LAW = ("THICKNESS", "ALPHAN", "ALPHAT", "SIGMAMAX", "TAUMAX", "GIC", "GIIC", "VISCOSITY")
_STABILISED = (*_LAW, "BETAN", "BETAT", "GAMMABOT")
_CONSTANTS = ("E1", "E2", "E3", "NU12", "NU13", "NU23", "G12", "ANGLE")


@dataclass(frozen=True, slots=True)
class Kernel:
    """Names of the properties of an element type, in order, and the number of its SVARS."""

    nodes: int
    real_names: tuple[str, ...]
    integer_names: tuple[str, ...]
    variables: int

    @property
    def reals(self) -> int:
        """Number of real properties."""
        return len(self.real_names)

    @property
    def integers(self) -> int:
        """Number of integer properties."""
        return len(self.integer_names)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the reals, then of the integers."""
        return self.real_names + self.integer_names


KERNELS = {
    1: Kernel(4, ("THICKNESS",), ("PLANE", "FACE"), 32),
    2: Kernel(4, _LAW, ("LAW", "INTEGRATION", "TANGENT"), 26),
    3: Kernel(4, _STABILISED, ("LAW", "INTEGRATION", "TANGENT", "SAMPLING", "OFFSETBOTTOM", "OFFSETTOP"), 26),
    4: Kernel(
        8,
        (*_STABILISED, *(f"{name} {side}" for side in ("BOTTOM", "TOP") for name in _CONSTANTS)),
        ("LAW", "INTEGRATION", "TANGENT", "SAMPLING", "PLANE"),
        26,
    ),
}


def positions(jtype: int, values: dict[str, float]) -> tuple[list[float], list[int]]:
    """Reals and integers of an element type in their order."""
    kernel = KERNELS[jtype]
    return [float(values[name]) for name in kernel.real_names], [int(values[name]) for name in kernel.integer_names]
