# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Materials, orientations and amplitudes, by name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TypeVar

import numpy as np

from harness.deck.blocks import PER_LINE, Block, Row
from harness.deck.damage import DAMAGE_KEYWORDS, extend_damage
from harness.deck.problems import Problems, nearest
from harness.deck.user_elements import MOST_VALUES, read_count
from harness.errors import DeckError, Source
from harness.model.amplitude import Amplitude, AmplitudeType, UserAmplitude
from harness.model.arrays import FloatArray
from harness.model.properties import (
    Elastic,
    ElasticType,
    Material,
    Orientation,
    Plastic,
    UserMaterial,
    isotropic_fault,
)

MATERIAL_OPTIONS = (
    *("ELASTIC", "PLASTIC", "DENSITY", "CONDUCTIVITY", "SPECIFIC HEAT", "EXPANSION"),
    *("USER MATERIAL", "DEPVAR", "USER OUTPUT VARIABLES", "USER DEFINED FIELD"),
    *DAMAGE_KEYWORDS,
)
DEPENDENT = (ElasticType.ISOTROPIC, ElasticType.LAMINA, ElasticType.ENGINEERING_CONSTANTS)
"""Those whose constants may depend on temperature and fields."""
MOST_FIELDS = 1000
SMALLEST_SINE = 1e-10
MOST_VARIABLES = 1_000_000
Entry = TypeVar("Entry")


def look_up(known: Mapping[str, Entry], name: str, what: str, source: Source) -> Entry:
    """Entry of a name; DeckError that names the nearest one."""
    if name not in known:
        raise DeckError(source, f"unknown {what} {name}{nearest(name, known)}")
    return known[name]


def read_materials(blocks: list[Block], problems: Problems) -> dict[str, Material]:
    """Materials: *MATERIAL and the options that follow it at once."""
    materials: dict[str, Material] = {}
    current: str | None = None
    for block in blocks:
        with problems.gather():
            if block.name == "MATERIAL":
                current = block.options.text("NAME")
                if current in materials:
                    raise block.error(f"{current} is defined already, at {materials[current].source}")
                materials[current] = Material(current, block.source)
            elif block.name in MATERIAL_OPTIONS:
                if current is None:
                    raise block.error("does not follow *MATERIAL")
                materials[current] = _extend(materials[current], block, problems)
            else:
                current = None
    return materials


def _extend(material: Material, block: Block, problems: Problems) -> Material:
    match block.name:
        case "ELASTIC":
            extended = replace(material, elastic=_read_elastic(block))
        case "PLASTIC":
            extended = replace(material, plastic=_read_plastic(block))
        case "USER MATERIAL":
            extended = replace(material, user=_read_user_material(block, problems))
        case "USER DEFINED FIELD":
            extended = replace(material, user_field=block.source)
        case "DEPVAR":
            extended = replace(material, state_variables=_read_count(block))
        case "USER OUTPUT VARIABLES":
            extended = replace(material, output_variables=_read_count(block))
        case "DENSITY":
            extended = replace(material, density=_read_constant(block, "density"))
        case "CONDUCTIVITY":
            extended = replace(material, conductivity=_read_constant(block, "conductivity"))
        case "EXPANSION":
            extended = replace(material, expansion=_read_constant(block, "expansion coefficient", positive=False))
        case "SPECIFIC HEAT":
            extended = replace(material, specific_heat=_read_constant(block, "specific heat"))
        case _:
            extended = replace(material, damage=extend_damage(material.damage, block))
    return extended


def _read_constant(block: Block, what: str, *, positive: bool = True) -> float:
    """The one number of a material option."""
    rows = list(block.rows())
    if len(rows) != 1 or len(rows[0]) != 1:
        raise block.error(f"needs one data line with the {what}; a temperature is not supported")
    value = rows[0].real(0, what)
    if positive and value <= 0:
        raise rows[0].error(f"{what} {value:g} must be positive")
    return value


def _read_elastic(block: Block) -> Elastic:
    kind = ElasticType(block.options.text("TYPE"))
    count = kind.constants
    rows = list(block.rows())
    if not rows:
        raise block.error("needs a data line")
    fields = read_count(block, "DEPENDENCIES", 0, 0, MOST_FIELDS)
    values = [value for row in rows for value in row.reals("elastic constant")]
    if fields or len(values) > count:
        table = _read_dependence(block, kind, count, fields)
        # one row is no dependence
        return Elastic(kind, tuple(table[0, :count].tolist()), block.source, table if len(table) > 1 else None)
    # trailing constants may be left out: Poisson's ratio, the transverse shear moduli of a lamina, Ett in the plane
    needed = {ElasticType.ISOTROPIC: 1, ElasticType.LAMINA: 4, ElasticType.TRACTION: 2}.get(kind, count)
    if len(values) < needed:
        raise rows[0].error(f"{len(values)} values where {kind.value} takes {count}")
    values += [0.0] * (count - len(values))
    if kind is ElasticType.ISOTROPIC:
        _check_isotropic(rows[0], *values)
    return Elastic(kind, tuple(values), block.source)


def _check_isotropic(row: Row, young: float, poisson: float) -> None:
    if fault := isotropic_fault(young, poisson):
        raise row.error(fault)


def _read_dependence(block: Block, kind: ElasticType, count: int, fields: int) -> FloatArray:
    """Rows of constants, temperature and fields; each takes as many lines as eight to a line need."""
    if kind not in DEPENDENT:
        names = ", ".join(sorted(DEPENDENT))
        raise block.error(f"dependence on temperature and fields is supported for {names}, not for {kind.value}")
    rows, width = list(block.rows()), count + 1 + fields
    lines = math.ceil(width / PER_LINE)
    if len(rows) % lines:
        raise block.error(f"{width} values take {lines} lines, found {len(rows)}")
    table: list[list[float]] = []
    for first in range(0, len(rows), lines):
        values: list[float] = []
        for number, row in enumerate(rows[first : first + lines]):
            here = min(PER_LINE, width - PER_LINE * number)
            row.at_most(here)
            values += row.reals("elastic constant") + [0.0] * (here - len(row))
        if kind is ElasticType.ISOTROPIC:
            _check_isotropic(rows[first], *values[:count])
        if any(values[count:] == earlier[count:] for earlier in table):
            raise rows[first].error("the temperature and fields of an earlier line")
        table.append(values)
    return np.array(table)


def _read_user_material(block: Block, problems: Problems) -> UserMaterial:
    count = block.options.integer("CONSTANTS", 0)
    if not 0 <= count <= MOST_VARIABLES:
        raise block.error(f"CONSTANTS={count} is not a number of constants (0 to {MOST_VARIABLES})")
    values = [row.real(index, "constant", 0.0) for row, index in block.entries(problems.warn)]
    if len(values) == count + 1:
        # a temperature behind the only set of constants is no dependence
        values.pop()
    if len(values) > count:
        message = f"{len(values)} values where CONSTANTS={count} announces {count}; dependence on temperature is not "
        raise block.error(message + "supported")
    # entries that are not given are zero, as everywhere
    return UserMaterial(np.array(values + [0.0] * (count - len(values))), block.options.flag("UNSYMM"), block.source)


def _read_count(block: Block) -> int:
    row = next(block.rows(), None)
    if row is None:
        raise block.error("needs a data line with the number of variables")
    count = row.integer(0, "number of variables")
    if not 0 <= count <= MOST_VARIABLES:
        raise row.error(f"{count} is not a number of variables (0 to {MOST_VARIABLES})")
    return count


def _read_plastic(block: Block) -> Plastic:
    table = []
    for row in block.rows():
        if len(row) > 2:
            raise row.error("more than yield stress and plastic strain; dependence on temperature is not supported")
        table.append((row.real(0, "yield stress"), row.real(1, "plastic strain", 0.0)))
        if table[-1][0] <= 0:
            raise row.error(f"yield stress {table[-1][0]:g} must be positive")
        if (table[-1][1] != 0) if len(table) == 1 else (table[-1][1] <= table[-2][1]):
            raise row.error("plastic strains must begin at zero and increase")
    if not table:
        raise block.error("needs a data line")
    return Plastic(np.array(table), block.source)


def read_orientations(blocks: list[Block], problems: Problems) -> dict[str, Orientation]:
    """Orientations of *ORIENTATION."""
    found: dict[str, Orientation] = {}
    for block in blocks:
        if block.name == "ORIENTATION":
            with problems.gather():
                name = block.options.text("NAME")
                if name in found:
                    raise block.error(f"{name} is defined already, at {found[name].source}")
                found[name] = Orientation(name, _read_axes(block), block.source)
    return found


def _read_axes(block: Block) -> FloatArray:
    """Rows are the local directions: a on the first, b in the plane of the first two, c the origin."""
    rows = list(block.rows())
    if not 1 <= len(rows) <= 2:
        raise block.error("needs a data line with the points a, b and c, and may have one with a rotation")
    rows[0].at_most(9)
    a, b, c = np.array([rows[0].real(index, "coordinate", 0.0) for index in range(9)]).reshape(3, 3)
    third = np.cross(a - c, b - c)
    if np.linalg.norm(third) <= SMALLEST_SINE * np.linalg.norm(a - c) * np.linalg.norm(b - c):
        raise rows[0].error("the points a, b and c are on one line")
    axes = np.array([a - c, np.cross(third, a - c), third])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    if len(rows) == 2:
        axis = rows[1].integer(0, "axis", 1)
        if axis not in (1, 2, 3):
            raise rows[1].error(f"axis {axis} is not 1, 2 or 3")
        angle = math.radians(rows[1].real(1, "angle", 0.0))
        first, second = axis % 3, (axis + 1) % 3
        turned = [math.cos(angle) * axes[first] + math.sin(angle) * axes[second]]
        turned += [-math.sin(angle) * axes[first] + math.cos(angle) * axes[second]]
        axes[first], axes[second] = turned
    return axes


def read_amplitudes(blocks: list[Block], problems: Problems) -> dict[str, Amplitude]:
    """Amplitudes of *AMPLITUDE."""
    found: dict[str, Amplitude] = {}
    for block in blocks:
        if block.name == "AMPLITUDE":
            with problems.gather():
                name = block.options.text("NAME")
                if name in found:
                    raise block.error(f"{name} is defined already, at {found[name].source}")
                found[name] = _read_amplitude(block, name)
    return found


def _read_amplitude(block: Block, name: str) -> Amplitude:
    options = block.options
    spaced = options.text("DEFINITION") == "EQUALLY SPACED"
    if not spaced and (options.given("FIXED INTERVAL") or options.given("BEGIN")):
        raise block.error("FIXED INTERVAL and BEGIN are for DEFINITION=EQUALLY SPACED")
    kind = AmplitudeType.TABULAR if spaced else AmplitudeType(options.text("DEFINITION"))
    total, absolute = options.text("TIME") == "TOTAL TIME", options.text("VALUE") == "ABSOLUTE"
    if kind is AmplitudeType.USER:
        properties, variables = _read_user(block)
        return UserAmplitude(name, kind, properties, block.source, total, absolute, variables)
    if options.given("PROPERTIES") or options.given("VARIABLES"):
        raise block.error("PROPERTIES and VARIABLES are for DEFINITION=USER")
    readers = {AmplitudeType.PERIODIC: _read_periodic, AmplitudeType.DECAY: _read_decay}
    data = _read_spaced(block) if spaced else readers.get(kind, _read_pairs)(block)
    if kind is AmplitudeType.SMOOTH_STEP and len(data) < 2:
        raise block.error("SMOOTH STEP needs two points at least")
    return Amplitude(name, kind, data, block.source, total, absolute)


def _read_user(block: Block) -> tuple[FloatArray, int]:
    """Properties for UAMP, and the number of its state variables."""
    count = read_count(block, "PROPERTIES", 0, 0, MOST_VALUES)
    values = [value for row in block.rows() for value in row.reals("property")]
    if len(values) != count:
        raise block.error(f"PROPERTIES={count}, and the data lines hold {len(values)}")
    return np.array(values), read_count(block, "VARIABLES", 1, 1, MOST_VALUES)


def _read_pairs(block: Block) -> FloatArray:
    values: list[float] = []
    for row in block.rows():
        before = values[-2] if len(values) % 2 == 0 and values else None
        values += row.reals("time or value")
        times = ([] if before is None else [before]) + values[len(values) - len(row) :: 2]
        if len(row) % 2:
            raise row.error("expected pairs of time and value")
        if any(later <= earlier for earlier, later in pairwise(times)):
            raise row.error("times must increase")
    if not values:
        raise block.error("needs a data line")
    return np.array(values).reshape(-1, 2)


def _read_spaced(block: Block) -> FloatArray:
    """Times and values of a curve with values at equal intervals."""
    interval, begin = block.options.real("FIXED INTERVAL", 0.0), block.options.real("BEGIN", 0.0)
    if interval <= 0:
        raise block.error("DEFINITION=EQUALLY SPACED needs a positive FIXED INTERVAL")
    values = [value for row in block.rows() for value in row.reals("value")]
    if not values:
        raise block.error("needs a data line")
    return np.column_stack([begin + interval * np.arange(len(values)), values])


def _read_decay(block: Block) -> FloatArray:
    """Rows (A0, A), (t0, td)."""
    row = next(block.rows(), None)
    if row is None:
        raise block.error("needs a data line")
    row.at_most(4)
    values = [row.real(index, what, 0.0) for index, what in enumerate(("A0", "A", "t0", "td"))]
    if values[3] <= 0:
        raise row.error(f"decay time td = {values[3]:g} must be positive")
    return np.array(values).reshape(2, 2)


def _read_periodic(block: Block) -> FloatArray:
    """Rows (omega, t0), (A0, 0), then (An, Bn)."""
    rows = list(block.rows())
    if not rows:
        raise block.error("needs a data line")
    terms = rows[0].integer(0, "number of terms")
    head = [rows[0].real(index, what, 0.0) for index, what in ((1, "omega"), (2, "t0"), (3, "A0"))]
    values = [value for row in rows[1:] for value in row.reals("coefficient")]
    if len(values) % 2:
        values.append(0.0)
    if len(values) != 2 * terms:
        raise rows[0].error(f"{terms} terms are announced, coefficients of {len(values) / 2:g} are given")
    return np.array([head[0], head[1], head[2], 0.0, *values]).reshape(-1, 2)
