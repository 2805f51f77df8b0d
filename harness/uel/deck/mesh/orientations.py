# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*ORIENTATION, with *DISTRIBUTION and *DISTRIBUTION TABLE for points or angles by element.

`harness/uel/model/orientation_axes.py` computes the axes at the points of elements; the readers of
`harness/uel/deck/sections` give them to the sections that name an ORIENTATION.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from uel.deck.error_report import Problems, look_up
from uel.deck.language.blocks import Block, Row
from uel.deck.language.definitions import read_definitions
from uel.deck.language.numbers import is_integer, read_real
from uel.deck.language.table import INPUT, NAME, Keyword, Kind, Option, Where, one_of, refused
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.sections.user_elements import read_count
from uel.model.arrays import FloatArray
from uel.model.orientation_axes import LocalSystem, SystemKind, UndefinedDirectionsError
from uel.model.properties import Orientation

_POINTS = ("COORD3D", "COORD3D")
_ANGLE = ("ANGLE",)
MOST_DIRECTIONS = 100
_VALUES = {_POINTS: 6, _ANGLE: 1}
"""Values per element of each kind of *DISTRIBUTION TABLE."""


@dataclass(frozen=True, slots=True)
class _Distribution:
    """Values (n, values) of all elements of the model, with the labels of its table."""

    labels: tuple[str, ...]
    values: FloatArray


def read_orientations(flat: FlatMesh, problems: Problems) -> dict[str, dict[str, Orientation]]:
    """Return the orientations of each instance and the root (''): those of the root, and its own ones, rotated."""
    root = flat.owners[-1]
    tables = read_definitions(root.blocks, "DISTRIBUTION TABLE", _read_table, problems)
    outer: dict[str, _Distribution] = {}
    shared: dict[str, Orientation] = {}
    orientations: dict[str, dict[str, Orientation]] = {}
    for owner in reversed(flat.owners):
        read = partial(_read_distribution, flat, owner, tables)
        values = outer | read_definitions(owner.blocks, "DISTRIBUTION", read, problems)
        local = read_definitions(owner.blocks, "ORIENTATION", partial(_read_orientation, flat, owner, values), problems)
        orientations[owner.name] = shared | local
        if owner is root:
            outer, shared = values, local
    return orientations


def _read_table(block: Block) -> tuple[str, ...]:
    labels = tuple(field.upper() for row in block.rows() for field in row.fields)
    if labels not in _VALUES:
        supported = "; ".join(", ".join(known) for known in _VALUES)
        raise block.error(f"{', '.join(labels) or 'no labels'} is not supported (supported: {supported})")
    return labels


def _read_distribution(
    flat: FlatMesh, owner: Owner, tables: Mapping[str, tuple[str, ...]], block: Block
) -> _Distribution:
    labels = look_up(tables, block.options.text("TABLE"), "distribution table", block.source)
    count = _VALUES[labels]
    rows = list(block.rows())
    if not rows or not rows[0].blank(0):
        raise (rows[0] if rows else block).error("the first data line has the default values, after a blank entry")
    values = np.tile(_values(rows[0], count), (sum(len(other.elements) for other in flat.owners), 1))
    numbered = [row for row in rows[1:] if not row.blank(0) and is_integer(row.fields[0])]
    numbers = np.array([row.integer(0, "element") for row in numbered], dtype=np.int64)
    positions = owner.find_elements(numbers).tolist()
    of_number = {id(row): position for row, position in zip(numbered, positions, strict=True)}
    for row in rows[1:]:
        position = of_number.get(id(row))
        if position is None or position < 0:
            values[flat.elements(row.name(0, "element or element set"), row.source, owner.name)] = _values(row, count)
        else:
            values[position] = _values(row, count)
    return _Distribution(labels, values)


def _values(row: Row, count: int) -> FloatArray:
    row.at_most(1 + count)
    return np.array([row.real(1 + k, "value", 0.0) for k in range(count)])


def _read_orientation(
    flat: FlatMesh, owner: Owner, distributions: Mapping[str, _Distribution], block: Block
) -> Orientation:
    name, kind = block.options.text("NAME"), SystemKind(block.options.text("SYSTEM"))
    if kind is SystemKind.USER:
        return Orientation(name, np.eye(3), block.source, LocalSystem(kind, np.zeros((3, 3))))
    rows = list(block.rows())
    count = read_count(block, "LOCAL DIRECTIONS", 0, 0, MOST_DIRECTIONS)
    local = np.zeros((0, 3))
    if count:
        if len(rows) != 2 + count:
            message = f"{len(rows)} data lines; expected points, a rotation and {count} for LOCAL DIRECTIONS={count}"
            raise block.error(message)
        local, rows = np.array([_direction(row) for row in rows[2:]]), rows[:2]
    if not 1 <= len(rows) <= 2:
        raise block.error("needs a data line with the points a, b and c, and may have one with a rotation")
    points, nodes = _read_points(flat, owner, distributions, block, rows[0])
    axis, angle = _read_rotation(distributions, rows[1]) if len(rows) == 2 else (1, 0.0)
    system = LocalSystem(kind, points, nodes, axis, angle)
    polar = kind in (SystemKind.CYLINDRICAL, SystemKind.SPHERICAL) and not nodes
    if polar and (points[..., 0, :] == points[..., 1, :]).all(axis=-1).any():
        raise rows[0].error("the points a and b, which give the polar axis, are the same")
    if not system.uniform:
        return Orientation(name, np.eye(3), block.source, _placed(system, owner, block), axis, local)
    try:
        ((axes,),) = system.axes(np.zeros(1, dtype=np.int64), np.zeros((1, 1, 3)), np.zeros((1, 1, 3)))
    except UndefinedDirectionsError as error:
        raise rows[0].error(str(error)) from None
    rotated = axes if _in_model(block) else owner.placement.turn(axes)
    return Orientation(name, rotated, block.source, normal=axis, local=local)


def _direction(row: Row) -> FloatArray:
    """Return the unit vector of a local direction. Raises DeckError if its length is zero."""
    row.at_most(3)
    components = np.array([row.real(k, "component of a local direction", 0.0) for k in range(3)])
    length = np.linalg.norm(components)
    if length == 0:
        raise row.error("a local direction of length zero")
    return np.asarray(components / length)


def _in_model(block: Block) -> bool:
    """Return whether the points are nodes, whose coordinates are those of the model."""
    return block.options.text("DEFINITION") != "COORDINATES"


def _placed(system: LocalSystem, owner: Owner, block: Block) -> LocalSystem:
    """Return the system with its points moved with the instance, unless they are nodes."""
    if _in_model(block):
        return system
    moved = owner.placement.move(system.points.reshape(-1, 3)).reshape(system.points.shape)
    return LocalSystem(system.kind, moved, system.nodes, system.axis, system.angle)


def _read_points(
    flat: FlatMesh, owner: Owner, distributions: Mapping[str, _Distribution], block: Block, row: Row
) -> tuple[FloatArray, tuple[int, ...]]:
    """Read the points a, b and c, (3, 3) or by element; or the local node numbers of OFFSET TO NODES."""
    definition = block.options.text("DEFINITION")
    if definition == "COORDINATES":
        if len(row) == 1 and not _is_number(row.fields[0]):
            ends = _distributed(distributions, row, 0, _POINTS).values.reshape(-1, 2, 3)
            return np.concatenate([ends, np.zeros((len(ends), 1, 3))], axis=1), ()
        row.at_most(9)
        return np.array([row.real(index, "coordinate", 0.0) for index in range(9)]).reshape(3, 3), ()
    row.at_most(3)
    count = max(len(row), 2)
    if definition == "NODES":
        node_sets = [flat.nodes(row.name(k, "node"), row.source, owner.name) for k in range(count)]
        if any(len(nodes) != 1 for nodes in node_sets):
            raise row.error("expected the numbers of two or three nodes")
        points = flat.mesh.coordinates[np.concatenate(node_sets)]
        return np.vstack([points, np.zeros((3 - count, 3))]), ()
    # the default origin is the first node
    numbers = tuple(row.integer(k, "local node number") for k in range(count))
    if min(numbers) < 1:
        raise row.error(f"local node number {min(numbers)} must be positive")
    return np.zeros((3, 3)), (*numbers, 1)[:3]


def _read_rotation(distributions: Mapping[str, _Distribution], row: Row) -> tuple[int, float | FloatArray]:
    """Read the axis, and the angle or angles about it, degrees. Raises DeckError."""
    row.at_most(2)
    axis = row.integer(0, "axis", 1)
    if axis not in (1, 2, 3):
        raise row.error(f"axis {axis} is not 1, 2 or 3")
    if not row.blank(1) and not _is_number(row.fields[1]):
        return axis, _distributed(distributions, row, 1, _ANGLE).values[:, 0]
    return axis, row.real(1, "angle", 0.0)


def _distributed(
    distributions: Mapping[str, _Distribution], row: Row, index: int, labels: tuple[str, ...]
) -> _Distribution:
    name = row.name(index, "distribution")
    entry = look_up(distributions, name, "distribution", row.source)
    if entry.labels != labels:
        raise row.error(f"distribution {name} has {', '.join(entry.labels)}; expected one of {', '.join(labels)}")
    return entry


def _is_number(text: str) -> bool:
    try:
        read_real(text)
    except ValueError:
        return False
    return True


KEYWORDS = (
    Keyword(
        "ORIENTATION",
        "Local axes. With NLGEOM those of built-in continuum elements turn with the material, in each increment by the "
        "rotation of the polar decomposition of its deformation gradient (Theory Guide, State storage). "
        "CYLINDRICAL: 1 is radial, 2 circumferential, 3 axial; SPHERICAL: radial, circumferential, meridional.",
        Where.MODEL,
        (
            NAME,
            one_of(
                "DEFINITION",
                "how the points are given: by coordinates, by node numbers, by local node numbers of each element",
                ("COORDINATES", "NODES", "OFFSET TO NODES"),
                default="COORDINATES",
            ),
            one_of("SYSTEM", "kind of axes; USER: by ORIENT", tuple(SystemKind), default=SystemKind.RECTANGULAR),
            Option("LOCAL DIRECTIONS", Kind.INTEGER, "number of preferred directions, for *ANISOTROPIC HYPERELASTIC"),
            *refused("DISPERSION"),
        ),
        "RECTANGULAR: a (on the 1-axis), b (in the 1-2 plane), c (origin); Z RECTANGULAR: a (on the 3-axis), b (in the "
        "1-3 plane), c; CYLINDRICAL, SPHERICAL: a, b on the polar axis, a the centre; or the name of a distribution of "
        "a and b; then axis number and angle in degrees or the name of a distribution of angles; then for each local "
        "direction its components along these axes",
    ),
    Keyword(
        "DISTRIBUTION TABLE",
        "What a distribution gives to each element.",
        Where.MODEL,
        (NAME,),
        "COORD3D, COORD3D (points a and b of *ORIENTATION) or ANGLE (its additional rotation, degrees)",
    ),
    Keyword(
        "DISTRIBUTION",
        "Points or angles of *ORIENTATION by element.",
        Where.MODEL,
        (
            NAME,
            one_of("LOCATION", "where values are", ("ELEMENT",), required=True, refused=("NODE", "FACE", "NONE")),
            Option("TABLE", Kind.NAME, "distribution table", required=True),
            INPUT,
        ),
        "blank, default values; then element or set, values",
    ),
)
