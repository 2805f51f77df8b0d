# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Load-displacement curve of a job, from its history: the force that does most work, over its displacement.

A force is a reaction or a concentrated load, in a component of a node whose displacement is in the history too, or the
sum over a node set that moves as one. A moment is drawn over its rotation. Without a force, as with loads on faces, the
load factor, if it is part of the solution, is drawn over the displacement that changes most.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray
from uel.model.nodal_variables import COMPONENTS

COLUMN: Final = re.compile(r"(?P<component>\w+)\[(?P<set>[^\]]*?)(?::(?P<node>[^:\]]*))?\]")
"""Name of a column of a nodal variable."""

_MECHANICAL: Final = range(1, 7)
"""Dofs whose conjugate is a force or a moment."""

FORCES: Final = ("reaction", "load")
"""Quantities that add up over the nodes of a set."""

_TIE: Final = 1e-6
"""Relative difference of works, or of displacements of a set, that counts as zero."""


@dataclass(frozen=True, slots=True)
class LoadCurve:
    """Load over displacement.

    x_name, y_name  of the displacement and the load, as in the history
    x, y            one value per increment
    step, increment (n,) numbers of the increments
    """

    x_name: str
    y_name: str
    x: FloatArray
    y: FloatArray
    step: FloatArray
    increment: FloatArray

    @property
    def peak(self) -> int:
        """Row of the load of largest magnitude."""
        return int(np.argmax(np.abs(self.y)))


def load_curve(history: Mapping[str, FloatArray]) -> LoadCurve | None:
    """Find the load-displacement curve of a history; None if there is none.

    Parameters
    ----------
    history
        Columns by name, without the rows of linear perturbation steps.
    """
    sets = _sets(history)
    pairs = [pair for (quantity, *_), force in sets.items() if quantity in FORCES for pair in _pairs(sets, force)]
    works = [_work(x, y) for _, x, _, y in pairs]
    most = max(works, default=0.0)
    if most > 0.0:
        # rounding does not decide between equal ones
        return _curve(history, *pairs[next(k for k, work in enumerate(works) if work >= (1.0 - _TIE) * most)])
    moved = [
        (f"{one.component}[{one.brackets(node)}]", values)
        for (quantity, *_), one in sets.items()
        if quantity == "displacement"
        for node, values in one.nodes.items()
    ]
    sizes = [float(np.abs(values[np.isfinite(values)]).max(initial=0.0)) for _, values in moved]
    if "LPF" in history and max(sizes, default=0.0) > 0.0:
        name, values = moved[next(k for k, size in enumerate(sizes) if size >= (1.0 - _TIE) * max(sizes))]
        return _curve(history, name, values, "LPF", history["LPF"])
    return None


@dataclass(frozen=True, slots=True)
class _Set:
    """Component of the nodes of a set: their columns by the name of the node, '' if there is only one."""

    component: str
    dof: int
    name: str
    nodes: dict[str, FloatArray]

    def brackets(self, node: str) -> str:
        """Return the text in the brackets of the column of a node."""
        return f"{self.name}:{node}" if node else self.name


_Sets = dict[tuple[str, int, str], _Set]
_Pair = tuple[str, FloatArray, str, FloatArray]


def _sets(history: Mapping[str, FloatArray]) -> _Sets:
    """Return the mechanical components by quantity, dof and set."""
    sets: _Sets = {}
    for name, values in history.items():
        match = COLUMN.fullmatch(name)
        quantity, dof = COMPONENTS.get(match["component"], ("", 0)) if match else ("", 0)
        if match and dof in _MECHANICAL:
            empty = _Set(match["component"], dof, match["set"], {})
            sets.setdefault((quantity, dof, match["set"]), empty).nodes[match["node"] or ""] = values
    return sets


def _pairs(sets: _Sets, force: _Set) -> Iterator[_Pair]:
    """Yield the displacements and forces of the nodes of a set, or of all together where they move as one."""
    moved = sets.get(("displacement", force.dof, force.name))
    if moved is None:
        return
    nodes = [node for node in force.nodes if node in moved.nodes]
    if len(nodes) > 1 and move_as_one(moved.nodes[node] for node in nodes):
        total = np.sum([force.nodes[node] for node in nodes], axis=0)
        names = f"{moved.component}[{force.name}]", f"sum of {force.component}[{force.name}]"
        yield names[0], moved.nodes[nodes[0]], names[1], total
        return
    for node in nodes:
        names = f"{moved.component}[{force.brackets(node)}]", f"{force.component}[{force.brackets(node)}]"
        yield names[0], moved.nodes[node], names[1], force.nodes[node]


def move_as_one(displacements: Iterable[FloatArray]) -> bool:
    """Return whether nodes have the same displacement in each increment, except for rounding."""
    u = np.array([*displacements])
    u = u[:, np.isfinite(u).all(axis=0)]
    return bool(np.ptp(u, axis=0).max(initial=0.0) <= _TIE * np.abs(u).max(initial=0.0))


def _work(u: FloatArray, force: FloatArray) -> float:
    """Return the sum of the magnitudes of the work of a force in all increments, so that unloading counts."""
    rows = np.isfinite(u) & np.isfinite(force)
    du, ends = np.diff(u[rows], prepend=0.0), np.append(0.0, force[rows])
    return float(np.abs(du * (ends[1:] + ends[:-1])).sum()) / 2.0


def _curve(history: Mapping[str, FloatArray], x_name: str, x: FloatArray, y_name: str, y: FloatArray) -> LoadCurve:
    rows = np.isfinite(x) & np.isfinite(y)
    return LoadCurve(x_name, y_name, x[rows], y[rows], history["step"][rows], history["increment"][rows])
