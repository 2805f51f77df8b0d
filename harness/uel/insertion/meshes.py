# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of other programs as a deck: nodes, elements, and groups as sets."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from uel.delamination.keywords import keyword, wrapped
from uel.errors import UsageError
from uel.files import read_whole
from uel.insertion.rewriting import element_lines
from uel.model.arrays import IntArray
from uel.model.element_types import CONTINUUM, FAMILIES, ContinuumType

DECKS = (".inp", "")
"""File name extensions of decks."""
_DEFAULTS = ("CPS3", "CPS4", "CPS6", "CPS8", "C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20")


def is_mesh(file: Path) -> bool:
    """Return whether a file is a mesh of another program, by its extension."""
    return file.suffix.lower() not in DECKS


def read_mesh(file: Path, types: Sequence[str]) -> list[str]:
    """Write the lines of a deck with the nodes, elements and sets of a mesh that meshio reads.

    Groups of solids become element sets, groups of faces, edges and points node sets; solids are the cells of the
    largest dimension. types: continuum elements in place of CPS4, C3D8, ..., by their number of nodes. Raises
    UsageError for an unreadable file, cells without an element type, or groups with equal set names.
    """
    chosen = _types(types)
    mesh = _load(file)
    dimension = max((_DIMENSIONS.get(block.type, -1) for block in mesh.cells), default=-1)
    if dimension < 2:
        raise UsageError(f"{file}: has no triangles, quadrilaterals or solids")
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    solid = [_DIMENSIONS.get(block.type) == dimension for block in mesh.cells]
    used = np.unique(np.concatenate([block.data.ravel() for block, yes in zip(mesh.cells, solid, strict=True) if yes]))
    if dimension == 2 and np.ptp(points[used, 2]) > 1e-9 * np.ptp(points[used]):
        raise UsageError(f"{file}: its faces do not lie in a plane z = constant, and it has no solids")
    rows = zip((used + 1).tolist(), points[used].tolist(), strict=True)
    lines = [f"** {file.name}", "*NODE", *(", ".join(map(repr, (label, *point))) for label, point in rows)]
    starts, start = [], 1
    for block, yes in zip(mesh.cells, solid, strict=True):
        starts.append(start)
        if not yes:
            continue
        kind = next((kind for kind in chosen if kind.family.cell == block.type), None)
        if kind is None:
            known = ", ".join(dict.fromkeys(kind.family.cell for kind in chosen if kind.dimension == dimension))
            hint = (
                "; Gmsh leaves out the middle nodes with Mesh.SecondOrderIncomplete = 1" if block.type in _FULL else ""
            )
            raise UsageError(
                f"{file}: cells of type {block.type}, for which there is no element (there are: {known}){hint}"
            )
        nodes = 1 + _oriented(block.data, points, kind)
        lines.append(keyword("ELEMENT", TYPE=kind.name))
        for label, row in enumerate(nodes, start=start):
            lines += element_lines(label, row)
        start += len(nodes)
    return lines + _sets(file, mesh, solid, starts, set(used.tolist()))


_DIMENSIONS = {family.cell: family.dimension for family in FAMILIES.values()} | {"vertex": 0}
"""Dimension of cells by their name in meshio."""
_FULL = ("quad9", "hexahedron27", "wedge18", "pyramid14")
"""Quadratic cells with midface nodes."""
_DIMENSIONS |= {name: 2 if name == "quad9" else 3 for name in (*_FULL, "pyramid", "pyramid13")}


def _types(names: Sequence[str]) -> list[ContinuumType]:
    """Return the types of solids, the named ones first."""
    chosen = []
    for name in (*names, *_DEFAULTS):
        if name.upper() not in CONTINUUM:
            raise UsageError(f"--solids {name}: expected continuum elements, such as CPE4 or C3D8I")
        chosen.append(CONTINUUM[name.upper()])
    return chosen


def _load(file: Path) -> Any:
    from uel.output.meshio_cells import meshio  # noqa: PLC0415 (keeps the other commands quick)

    try:
        read_whole(file)
    except OSError as error:
        raise UsageError(f"cannot read {file}: {error.strerror or type(error).__name__}") from None
    printed = io.StringIO()
    try:
        # meshio prints errors, and exits
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            return meshio.read(file)
    except (Exception, SystemExit) as error:
        words = [line.strip() for line in (printed.getvalue() or str(error)).splitlines() if line.strip()]
        reason = words[-1] if words and not isinstance(error, SystemExit) else " ".join(words)
        raise UsageError(f"cannot read the mesh {file}: {reason or type(error).__name__}") from None


def _oriented(nodes: IntArray, points: np.ndarray, kind: ContinuumType) -> IntArray:
    """Return the connectivity of cells, with clockwise ones in the plane reversed."""
    if kind.dimension == 3:
        return nodes
    corners = points[nodes[:, : kind.corners], :2]
    following = np.roll(corners, -1, axis=1)
    area = (corners[:, :, 0] * following[:, :, 1] - corners[:, :, 1] * following[:, :, 0]).sum(axis=1)
    back = [0, *range(kind.corners - 1, 0, -1)]
    middles = [kind.corners + (corner - 1) % kind.corners for corner in back] if kind.nodes > kind.corners else []
    return np.where((area < 0.0)[:, None], nodes[:, back + middles], nodes)


def _sets(file: Path, mesh: Any, solid: Sequence[bool], starts: Sequence[int], used: set[int]) -> list[str]:
    """Write *ELSET and *NSET of the groups of a mesh."""
    elements: dict[str, list[IntArray]] = {}
    nodes: dict[str, list[IntArray]] = {}
    for name, members in _groups(mesh).items():
        for block, cells, yes, start in zip(mesh.cells, members, solid, starts, strict=True):
            if cells is None or not len(cells):
                continue
            rows = np.asarray(cells, dtype=np.int64)
            if yes:
                elements.setdefault(name, []).append(start + rows)
            else:
                nodes.setdefault(name, []).append(np.unique(block.data[rows]))
    for name, members in mesh.point_sets.items():
        nodes.setdefault(name, []).append(np.asarray(members, dtype=np.int64).ravel())
    lines: list[str] = []
    for name, members_of in _by_label(file, nodes).items():
        labels = np.unique(np.concatenate(members_of))
        labels_used = [label + 1 for label in labels.tolist() if label in used]
        if labels_used:
            lines += [keyword("NSET", NSET=name), *wrapped(labels_used)]
    for name, members_of in _by_label(file, elements).items():
        lines += [keyword("ELSET", ELSET=name), *wrapped(np.unique(np.concatenate(members_of)).tolist())]
    return lines


def _by_label(file: Path, groups: Mapping[str, list[IntArray]]) -> dict[str, list[IntArray]]:
    """Rename groups so that Abaqus reads them without quotes: 'ply 1' becomes PLY_1. Raises UsageError for clashes."""
    group_of: dict[str, str] = {}
    for name in groups:
        label = re.sub(r"[^\w.-]", "_", name.strip(), flags=re.ASCII).upper()
        label = label if re.match("[A-Z_]", label) else f"_{label}"
        if group_of.setdefault(label, name) != name:
            raise UsageError(f"{file}: groups '{group_of[label]}' and '{name}' are both {label} in a deck; rename one")
    return {label: groups[name] for label, name in group_of.items()}


def _groups(mesh: Any) -> Mapping[str, Sequence[Any]]:
    """Return the cells of each group, by block; unnamed groups of Gmsh are PHYSICAL-number."""
    groups: dict[str, Sequence[Any]] = {
        name: members for name, members in mesh.cell_sets.items() if not name.startswith("gmsh:")
    }
    numbers = mesh.cell_data.get("gmsh:physical")
    if numbers is None:
        return groups
    dimensions = [_DIMENSIONS.get(block.type, -1) for block in mesh.cells]
    named = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
    for block, tags in enumerate(numbers):
        for tag in np.unique(tags).tolist():
            name = named.get((tag, dimensions[block]))
            if tag and name not in mesh.cell_sets:
                members = groups.setdefault(name or f"PHYSICAL-{tag}", [None] * len(mesh.cells))
                members[block] = np.flatnonzero(tags == tag)  # type: ignore[index]
    return groups
