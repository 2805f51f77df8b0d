# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Single interface element under prescribed separation paths, for `uel law`.

The element is a small square with a uniform separation. Separations and tractions are (normal, tangential). The nodes
of a standard element (U2, U5) are displaced. The two quads of a stabilised element (U4, U6) are strained so that their
stress balances the interface traction: the response is then the law, without the compliance of Nitsche's method.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from uel.deck import read_deck
from uel.delamination.blocks import Interface, Specimen, interface_values
from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.mesh import two_arms
from uel.delamination.softening import pure_modes
from uel.elements import Call, Flags, build_blocks
from uel.errors import Source, UelError, UsageError
from uel.model.arrays import FloatArray
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import UserElement, UserProperty
from uel.usersub import Library
from uel.usersub.layout import check_law_uses, element_layouts

LOCATION: Final = Source("uel law", 0)
STANDARD: Final = 2
LOW: Final = np.array([[0, -1], [1, -1], [1, 0], [0, 0], [0.5, -1], [1, -0.5], [0.5, 0], [0, -0.5]])
HIGH: Final = np.add(LOW, [0, 1])
NODES: Final = {
    2: np.array([[0, 0], [1, 0], [1, 0], [0, 0]]),
    4: np.vstack([LOW[:4], HIGH[:4]]),
    5: np.array([[0, 0], [1, 0], [1, 0], [0, 0], [0.5, 0], [0.5, 0]]),
    6: np.vstack([LOW, HIGH]),
}
"""Coordinates divided by the size, by element type."""
TOP: Final = {2: [2, 3], 4: [4, 5, 6, 7], 5: [2, 3, 5], 6: list(range(8, 16))}
"""Nodes above the interface."""
SIZE: Final = 0.125
"""Edge length of the quads of a stabilised element (mm), on which beta depends: as in the double cantilever beam."""

MOST_ITERATIONS: Final = 50
PATIENCE: Final = 10
"""Iterations after which a Newton step may no longer increase the residual."""
BISECTIONS: Final = 30
RIGID: Final = 1e6
"""Penalty stiffness that replaces an infinite one, over the softening stiffness, to find the end of a curve."""
UNLOADING: Final = 20
"""Number of increments of an unloading branch."""
SWITCHES: Final = 500
"""Number of moments at which a path may switch from one mode to the other."""

Properties = Mapping[str, float]

LARGEST: Final = 1 << 31
"""The first integer too large for JPROPS."""


def standard_properties() -> dict[str, float]:
    """Return the properties of the paper's interface (tables 1 and 2) for all element types."""
    mesh = two_arms(np.array([0.0, 1.0]), 1.0, 1, crack=0.0)
    return interface_values(Specimen("law", mesh, Interface("U2", TABLE_2), 1.0, PLY_0, PLY_0))


def read_properties(words: Iterable[str]) -> dict[str, float]:
    """Read properties from words NAME=VALUE; an underscore stands for a blank. Raises UsageError naming the word."""
    layouts = element_layouts().values()
    integers = {item.name for layout in layouts for item in layout.integers}
    names = integers | {item.name for layout in layouts for item in layout.reals}
    properties = {}
    for word in words:
        name, equals, value = word.upper().partition("=")
        name = name.replace("_", " ")
        if not equals or name not in names:
            raise UsageError(f"'{word}': expected NAME=VALUE with a name among {', '.join(sorted(names))}")
        try:
            properties[name] = float(value)
        except ValueError:
            properties[name] = math.nan
        if not math.isfinite(properties[name]):
            raise UsageError(f"'{word}': '{value}' is not a finite number")
        if name in integers and not (properties[name].is_integer() and abs(properties[name]) < LARGEST):
            raise UsageError(f"'{word}': '{value}' is not a whole number below {LARGEST}")
    return properties


def refuse_ignored(values: Properties, jtype: int, number: int) -> None:
    """Raise UsageError for a property that the element type or the law would ignore; names the types that use it."""
    layouts = element_layouts()
    accepted = {number: {item.name for item in (*layouts[number].reals, *layouts[number].integers)} for number in NODES}
    for name in values:
        if name not in accepted[jtype]:
            others = [f"U{number}" for number in NODES if name in accepted[number]]
            other = f"; --element {' or '.join(others)} has it" if others else ""
            raise UsageError(f"{name}: U{jtype} has no such property and would ignore it{other}")
    check_law_uses(jtype, values, number)


def shown_properties(values: Properties, jtype: int) -> list[tuple[str, float]]:
    """Return the non-zero properties of the law; those of the plies and the thickness do not affect it."""
    layout = element_layouts()[jtype]
    names = [item.name for item in (*layout.reals, *layout.integers)]
    names = [name for name in names if name != "THICKNESS" and not name.endswith((" BOTTOM", " TOP"))]
    return [(name, values[name]) for name in names if values.get(name)]


def deck_properties(path: Path, elset: str | None = None) -> tuple[int, dict[str, float]]:
    """Return type and properties of the interface elements in `elset` of a deck, by default the first set.

    The four-node stabilised element needs its neighbours; it is replaced by the standard element with the same law.
    """
    sections = []
    for group in read_deck(path).groups:
        definition, section = group.definition, group.section
        if definition is None or not isinstance(section, UserProperty) or definition.number < 2:
            continue
        if elset is None or section.elset.upper() == elset.upper():
            layout = element_layouts()[definition.number]
            values = dict(zip((item.name for item in layout.reals), section.values.tolist(), strict=False))
            values |= dict(zip((item.name for item in layout.integers), section.integers.tolist(), strict=False))
            values.setdefault("THICKNESS", 1.0)
            return definition.number if definition.number in NODES else STANDARD, values
        sections.append(section.elset)
    if not sections:
        raise UelError(f"{path}: no interface elements of the project with *UEL PROPERTY")
    expected = ", ".join(sections)
    raise UelError(f"{path}: no interface elements with *UEL PROPERTY, ELSET={elset}; expected one of {expected}")


@dataclass(frozen=True, slots=True)
class LawCurve:
    """Response along a separation path.

    label    in the legend
    columns  one value per increment, the start included: TIME, SEPN, SEPT, TN, TT, the other variables of the point,
             WORK (per area)
    """

    label: str
    columns: dict[str, FloatArray]


class LawElement:
    """Model of one interface element."""

    def __init__(self, library: Library, jtype: int, values: Properties, size: float = SIZE) -> None:
        layout = element_layouts()[jtype]
        nodes = NODES[jtype]
        self._stabilised = len(nodes) > 6
        self._names = [item.name for item in layout.variables]
        self._points = layout.points
        self._height = nodes[:, 1] * size
        self._top = np.isin(np.arange(len(nodes)), TOP[jtype])
        self._area = size * values["THICKNESS"]
        user = UserElement(
            jtype,
            layout.nodes,
            tuple((node, dof) for node in range(layout.nodes) for dof in (1, 2)),
            LOCATION,
            coordinates=2,
            properties=len(layout.reals),
            integer_properties=len(layout.integers),
            variables=layout.svars,
            unsymmetric=True,
        )
        section = UserProperty(
            "LAW",
            LOCATION,
            np.array([float(values.get(item.name, 0.0)) for item in layout.reals]),
            np.array([int(values.get(item.name, 0)) for item in layout.integers]),
        )
        group = ElementGroup(f"U{jtype}", np.array([1]), np.arange(layout.nodes)[None], "", section, user, LOCATION)
        coordinates = np.column_stack([nodes * size, np.zeros(len(nodes))])
        mesh = Mesh(np.arange(1, len(nodes) + 1), coordinates, ("",) * len(nodes))
        (self._block,) = build_blocks(Model(Path("uel law"), "", mesh, (group,), ()), library)
        n = 2 * layout.nodes
        self._block.bind(np.arange(n, dtype=np.int32)[None], np.arange(n * n, dtype=np.int32).reshape(1, n, n))
        self._u = np.zeros(n)
        self._gradient = np.zeros(2)
        self._time = 0.0
        self._strength = min(values["SIGMAMAX"], values["TAUMAX"])
        self._operator = self._stress_operator(values) if self._stabilised else np.zeros((2, 2))

    def advance(self, separation: FloatArray, dtime: float) -> FloatArray:
        """Advance one increment to a separation (normal, tangential) and return the traction."""
        self._time += dtime
        if self._stabilised:
            self._gradient = self._equilibrium(separation, dtime)
        u = self._displacements(separation, self._gradient)
        traction = self._traction(u, dtime)
        self._block.commit()
        self._u = u
        return traction

    def probe(self, separation: FloatArray, dtime: float) -> FloatArray:
        """Return the traction of a standard element at a trial separation, without advancing."""
        return self._traction(self._displacements(separation, self._gradient), dtime)

    def variables(self) -> dict[str, float]:
        """Return the committed variables of the first point by name."""
        return dict(zip(self._names, self._block.state(0).svars[0].tolist(), strict=False))

    def _displacements(self, separation: FloatArray, gradient: FloatArray) -> FloatArray:
        u = np.where(self._top, 0.5, -0.5)[:, None] * separation + self._height[:, None] * gradient
        return np.array(u[:, ::-1]).ravel()

    def _traction(self, u: FloatArray, dtime: float) -> FloatArray:
        call = Call(Flags(1), 1, 1, self._time, self._time, dtime, 1.0)
        rhs = np.zeros(len(u))
        self._block.evaluate(call, u, u - self._u, rhs, np.zeros(len(u) ** 2))
        tangential, normal = -rhs.reshape(-1, 2)[self._top].sum(axis=0) / self._area
        return np.array([normal, tangential])

    def _stress_operator(self, values: Properties) -> FloatArray:
        """Return the matrix from gradient to quad stress; at zero separation the traction is 1 - S times the stress."""
        columns = []
        # far below onset
        step = 1e-3 * min(values["SIGMAMAX"], values["TAUMAX"]) / max(values["E2 BOTTOM"], values["G12 BOTTOM"])
        for gradient in step * np.eye(2):
            traction = self._traction(self._displacements(np.zeros(2), gradient), 0.0)
            self._block.commit()
            point = self.variables()
            columns.append(traction / (1.0 - np.array([point["SN"], point["ST"]])) / step)
        return np.array(columns).T

    def _equilibrium(self, separation: FloatArray, dtime: float) -> FloatArray:
        """Solve for the normal derivative of the displacement at which the quad stress balances the traction.

        Newton's method with a finite-difference Jacobian. The solution is unique: 1 - dT/dsigma is S or, with a
        consistent law, positive because beta exceeds the steepest softening.
        """
        gradient = self._gradient

        def imbalance(at: FloatArray) -> FloatArray:
            return self._traction(self._displacements(separation, at), dtime) - self._operator @ at

        negligible = 1e-10 * self._strength
        for iteration in range(MOST_ITERATIONS):
            residual = imbalance(gradient)
            if np.abs(residual).max() <= negligible:
                return gradient
            steps = np.linalg.solve(self._operator, 1e-6 * self._strength * np.eye(2)).T
            jacobian = np.array([(imbalance(gradient + step) - residual) / (1e-6 * self._strength) for step in steps]).T
            left, singular, right = np.linalg.svd(jacobian)
            projected, free = left.T @ residual, singular > 1e-6
            stress = -right[free].T @ (projected[free] / singular[free])
            # a rigid interface separates only at the onset stress
            rigid = right[~free & (np.abs(projected) > negligible)]
            stress = stress + rigid.T @ (rigid @ (self._operator @ gradient + residual))
            change, fraction = np.linalg.solve(self._operator, stress), 1.0
            # backtracking: a rigid interface may oscillate across its onset
            while (
                iteration >= PATIENCE
                and fraction > negligible
                and np.abs(imbalance(gradient + fraction * change)).max() > np.abs(residual).max()
            ):
                fraction /= 2.0
            gradient = gradient + fraction * change
        raise UelError(f"no equilibrium of the quads with the interface at a separation of {separation}")


def orders_of_modes(values: Properties) -> tuple[float, float]:
    """Return the least and the largest energy of a point that softens in one pure mode and fails in the other.

    Per area, over all moments of the switch, for a softening along straight lines. Both modes have one secant K, that
    of sliding divided by ALPHAT/ALPHAN, and have dissipated the shares of their toughness that belong to it
    (fortran/laws.md, Strengths and the order of the modes).
    """
    ratio = np.array([1.0, values["ALPHAT"] / values["ALPHAN"] if values["ALPHAN"] else 1.0])
    modes = pure_modes(values)
    energies = np.array([mode.toughness for mode in modes])
    slopes = np.array([0.5 * mode.strength**2 / mode.toughness for mode in modes]) / ratio
    remaining = np.geomspace(1e-6 * slopes.min(), 1e4 * slopes.max(), SWITCHES)
    shares = [mode.shares_at(remaining * part) for mode, part in zip(modes, ratio, strict=True)]
    opened_first = energies[0] * shares[0] + energies[1] * (1.0 - shares[1])
    either = np.concatenate([opened_first, energies.sum() - opened_first, energies])
    return float(either.min()), float(either.max())


def along(points: FloatArray, increments: int) -> FloatArray:
    """Return separations (n, 2) along straight segments from the origin through the points, in equal increments."""
    corners = np.vstack([np.zeros((1, 2)), points])
    segments = [start + np.linspace(0, 1, increments + 1)[1:, None] * (end - start) for start, end in pairwise(corners)]
    return np.vstack([corners[:1], *segments])


def opening(
    angle: float, reach: float, increments: int, unload: Sequence[float] = (), close: float = 0.0
) -> FloatArray:
    """Return separations (n, 2) up to `reach` at a fixed angle, from opening (0) to sliding (90 degrees).

    The increments grow with the separation to resolve the stiff initial slope. At the fractions `unload` of the reach
    the path unloads to the origin, closes by `close` times the reach, and reloads.
    """
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    fractions = np.linspace(0.0, 1.0, increments + 1) ** 2
    path: FloatArray = fractions[:, None] * reach * direction
    closed = np.linspace(0.0, -close * reach, UNLOADING + 1)[1:, None] * [1.0, 0.0] if close else np.zeros((0, 2))
    # from the last fraction, so that the earlier rows do not shift
    for fraction in sorted(unload, reverse=True):
        row = int(np.searchsorted(fractions, fraction))
        unloading = np.vstack([np.linspace(1.0, 0.0, UNLOADING + 1)[1:, None] * path[row], closed])
        path = np.vstack([path[: row + 1], unloading, unloading[-2::-1], path[row:]])
    return path


def reach_of(library: Library, values: Properties, angle: float, duration: float = 1.0) -> float:
    """Return the separation at an angle (degrees) at which the traction has dropped to a thousandth of the strength.

    The duration is that of a curve `opening`, which ends at twice its mean rate.
    """
    for name in ("SIGMAMAX", "TAUMAX", "GIC", "GIIC"):
        if not values[name] > 0.0:
            raise UelError(f"{name} = {values[name]:g}: expected a number above 0, which determines the reach")
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    stiff = {name: values[name] or RIGID * values["SIGMAMAX"] ** 2 / values["GIC"] for name in ("ALPHAN", "ALPHAT")}
    # probed in one increment, so without viscosity, which would delay the damage
    element = LawElement(library, STANDARD, {**values, **stiff, "VISCOSITY": 0.0})
    limit = 1e-3 * min(values["SIGMAMAX"], values["TAUMAX"])

    def above_limit(size: float) -> bool:
        return float(np.linalg.norm(element.probe(size * direction, 0.5 * duration))) > limit

    # a bilinear law ends at twice this in pure modes
    estimate = lower = min(values["GIC"] / values["SIGMAMAX"], values["GIIC"] / values["TAUMAX"])
    upper = lower
    while above_limit(upper):
        lower, upper = upper, 2.0 * upper
        if upper > 1e6 * estimate:
            raise UelError(f"the traction at {angle:g} degrees does not fall to a thousandth: give the reach (--reach)")
    for _ in range(BISECTIONS):
        middle = 0.5 * (lower + upper)
        lower, upper = (middle, upper) if above_limit(middle) else (lower, middle)
    return upper


def drive(element: LawElement, label: str, path: FloatArray, duration: float = 1.0) -> LawCurve:
    """Compute the tractions along a path with increments of equal duration."""
    rows = []
    work, previous, last = 0.0, np.zeros(2), np.zeros(2)
    dtime = duration / (len(path) - 1)
    for number, separation in enumerate(path):
        traction = element.advance(separation, dtime if number else 0.0)
        work += 0.5 * float((traction + previous) @ (separation - last))
        previous, last = traction, separation
        point = element.variables()
        rows.append({"TIME": number * dtime, **point, "TN": traction[0], "TT": traction[1], "WORK": work})
    return LawCurve(label, {name: np.array([row[name] for row in rows]) for name in rows[0]})
