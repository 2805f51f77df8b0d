# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TRANSFORM: local system of dofs 1 to 6 of nodes in *BOUNDARY, *CLOAD and *EQUATION.

Elements and constraints have global components. A prescribed or loaded local component is an additional unknown of its
node, with an equation in the global ones.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.sections.user_elements import dofs_by_node
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import FIRST_LOCAL
from uel.model.mesh import ElementGroup
from uel.model.model import Equation
from uel.model.orientation_axes import LocalSystem, SystemKind, UndefinedDirectionsError

_KINDS = {"R": SystemKind.RECTANGULAR, "C": SystemKind.CYLINDRICAL, "S": SystemKind.SPHERICAL}
_ROTATIONS = 3
"""Difference between the dof of a rotation and that of the displacement along its axis."""
_ALIGNED = 1e-9
"""Cosine that is rounding."""


_MOST_ALONG_X = 0.99
"""Cosine of the angle to x above which an axis is parallel to it."""


class Transforms:
    """Local directions of nodes, and the local dofs that the deck prescribes or loads."""

    def __init__(self, flat: FlatMesh, groups: Sequence[ElementGroup], problems: Problems) -> None:
        """Read all *TRANSFORM, and report errors to `problems`."""
        self._mesh, self._problems = flat.mesh, problems
        self._active = dofs_by_node(len(flat.mesh.coordinates), groups)
        self._axes: dict[int, FloatArray] = {}
        self._sources: dict[int, Source] = {}
        self._used: set[tuple[int, int]] = set()
        for block, owner in flat.blocks("TRANSFORM"):
            with problems.gather():
                self._read(block, owner, flat)

    def _read(self, block: Block, owner: Owner, flat: FlatMesh) -> None:
        nodes = flat.nodes(block.options.text("NSET"), block.source, owner.name)
        kind = _KINDS[block.options.text("TYPE")]
        row = block.required_row("the points a and b")
        row.at_most(6)
        points = np.array([row.real(index, "coordinate", 0.0) for index in range(6)]).reshape(2, 3)
        if kind is not SystemKind.RECTANGULAR:
            points = owner.placement.move(points)
        system = LocalSystem(kind, np.vstack([points, np.zeros((1, 3))]))
        coordinates = flat.mesh.coordinates[nodes]
        if kind is SystemKind.CYLINDRICAL:
            coordinates, moved = _off_axis(coordinates, points)
            if len(moved):
                name = flat.mesh.name(int(nodes[moved[0]]))
                message = (
                    "is on the polar axis, where Abaqus does not document direction 1: here it is that of the global"
                )
                self._problems.warn(block.source, f"*TRANSFORM: node {name} {message} x-axis, or y-axis, normal to it")
        try:
            axes = system.axes(nodes, np.zeros((len(nodes), 1, 3)), coordinates[:, None])[:, 0]
        except UndefinedDirectionsError as error:
            name = flat.mesh.name(int(nodes[error.row[0]]))
            raise row.error(f"node {name} has no directions: {error}") from None
        if kind is SystemKind.RECTANGULAR:
            axes = np.stack([owner.placement.turn(matrix) for matrix in axes])
        for node, matrix in zip(nodes.tolist(), axes, strict=True):
            if node in self._axes and np.abs(self._axes[node] - matrix).max() > _ALIGNED:
                message = f"node {flat.mesh.name(node)} has other directions already, by {self._sources[node]}"
                raise block.error(message)
            self._axes[node], self._sources[node] = matrix, block.source

    def parts(self, nodes: IntArray, dof: int, source: Source) -> list[tuple[IntArray, int]]:
        """Split the nodes of a prescribed value or load into global and local ones, each with its dof.

        Raises DeckError where the elements of a node lack a dof of its local system.
        """
        if not self._axes or dof > 2 * _ROTATIONS:
            return [(nodes, dof)]
        local = np.array([self._has(node, dof) for node in nodes.tolist()], dtype=np.bool_)
        for node in nodes[local].tolist():
            self._terms(node, dof, source)
            self._used.add((node, dof))
        split = [(nodes[~local], dof), (nodes[local], FIRST_LOCAL + dof)]
        return [entry for entry in split if len(entry[0])]

    def named(self, nodes: IntArray) -> str:
        """Return the name of the first node with a local system, '' without one."""
        return next((self._mesh.name(node) for node in nodes.tolist() if node in self._axes), "")

    def equations(self) -> tuple[Equation, ...]:
        """Return the equations of prescribed or loaded local components in global ones."""
        equations = []
        for node, dof in sorted(self._used):
            terms = self._terms(node, dof, self._sources[node])
            equations.append(Equation(((node, FIRST_LOCAL + dof, 1.0), *terms), self._sources[node]))
        return tuple(equations)

    def check(self, equations: Sequence[Equation], related: Sequence[Equation], in_steps: Sequence[Block]) -> None:
        """Report each *EQUATION with such a node, and each other constraint that eliminates one."""
        printed = next((block for block in in_steps if block.name == "NODE PRINT"), None)
        if self._axes and printed is not None:
            message = "components are global here; in Abaqus they are those of *TRANSFORM without GLOBAL=YES"
            self._problems.differ(printed.source, f"*NODE PRINT: {message}")
        firsts = [(equation.source, equation.terms[:1]) for equation in related]
        for source, terms in [*((equation.source, equation.terms) for equation in equations), *firsts]:
            for node, dof, _ in terms:
                if node in self._axes and dof <= 2 * _ROTATIONS:
                    name = self._mesh.name(node)
                    message = f"node {name} has a *TRANSFORM ({self._sources[node]}), which is not supported here"
                    self._problems.add(source, message)

    def _has(self, node: int, dof: int) -> bool:
        """Return whether the dof of the node is local; a dof of no element is not."""
        dofs = self._active[node]
        return node in self._axes and (not dofs or dof in dofs)

    def _terms(self, node: int, dof: int, source: Source) -> tuple[tuple[int, int, float], ...]:
        """Return the terms of a local dof in the global dofs of the node, times -1. Raises DeckError."""
        base = 0 if dof <= _ROTATIONS else _ROTATIONS
        direction = self._axes[node][dof - base - 1]
        dofs = self._active[node]
        missing = [base + k + 1 for k in range(3) if abs(direction[k]) > _ALIGNED and base + k + 1 not in dofs]
        if dofs and missing:
            message = f"local dof {dof} of node {self._mesh.name(node)} has a part along dof {missing[0]}"
            raise DeckError(source, f"*TRANSFORM: {message}, which no element of the node has")
        terms = [(node, base + k + 1, -float(direction[k])) for k in range(3) if abs(direction[k]) > _ALIGNED]
        return tuple(terms)


def _off_axis(points: FloatArray, ends: FloatArray) -> tuple[FloatArray, IntArray]:
    """Move points on an axis (2, 3) along x, or along y for an axis along x; return all points, and the moved ones."""
    axis = (ends[1] - ends[0]) / max(float(np.linalg.norm(ends[1] - ends[0])), float(np.finfo(np.float64).tiny))
    arms = points - ends[0]
    distances = np.linalg.norm(arms - np.outer(arms @ axis, axis), axis=1)
    sizes = np.linalg.norm(points, axis=1) + np.linalg.norm(ends[0])
    moved = np.flatnonzero(distances <= _ALIGNED * np.maximum(sizes, np.finfo(np.float64).tiny))
    side = np.eye(3)[1 if abs(axis[0]) > _MOST_ALONG_X else 0]
    shifted = points.copy()
    shifted[moved] += side * np.maximum(sizes[moved], 1.0)[:, None]
    return shifted, moved


KEYWORDS = (
    Keyword(
        "TRANSFORM",
        "Local directions of *BOUNDARY and *CLOAD at nodes, fixed in space. C: 1 is radial, 2 circumferential, 3 "
        "axial; S: radial, circumferential, meridional. Initial velocities and output are in global directions, also "
        "that of *NODE PRINT, which in Abaqus is local unless it has GLOBAL=YES.",
        Where.MODEL,
        (
            Option("NSET", Kind.NAME, "node set", required=True),
            one_of("TYPE", "rectangular, cylindrical or spherical", tuple(_KINDS), default="R"),
        ),
        "R: coordinates of a on the 1-axis and b in the 1-2 plane, from the origin; C, S: a and b on the polar axis, a "
        "the centre",
    ),
)
