# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface profile (NAME_interface.csv): all variables at all integration points of interface and cohesive elements.

A block of rows per increment of field output: step, increment, time (total time), element, point (from 1), then the
variables of the elements: coordinates X and Y, separations SEPN and SEPT, tractions TN and TT,
DAMAGE, ... A variable that one element type lacks is empty there. Where elements have a direction from which s follows,
the last columns are DIRECTION1 to 3, zero for elements without one.
"""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.model.properties import UserProperty
from uel.model.records import ElementState, IncrementDone, PointVariables
from uel.output.formats import TextFile
from uel.output.points import point_values
from uel.output.schedule import Schedule, find_written
from uel.usersub.layout import element_layouts

FIXED = ("step", "increment", "time", "element", "point")
DIRECTIONS = ("DIRECTION1", "DIRECTION2", "DIRECTION3")


class InterfaceFile:
    """Writer of NAME_interface.csv; no file without interface elements of the project or cohesive elements."""

    def __init__(self, path: Path, model: Model) -> None:
        path.unlink(missing_ok=True)
        self._path = path
        self._model = model
        self._schedule = Schedule()
        self._file: TextFile | None = None
        self._names: list[str] = []

    def write(self, record: IncrementDone, *, last: bool) -> None:
        """Append the block of an increment if the step requests field output."""
        step = self._model.steps[record.step - 1]
        if not self._schedule.due_field(step, record, last=last):
            return
        states = [
            (state, state.variables)
            for state in record.solution.elements
            if state.variables is not None and state.variables.kind == "interface"
        ]
        if not states:
            return
        if self._file is None:
            self._names = list(dict.fromkeys(name for _, variables in states for name in variables.names))
            if any(self._direction(state).any() for state, _ in states):
                self._names += DIRECTIONS
            self._file = TextFile(self._path)
            self._file.write(",".join([*FIXED, *self._names]) + "\n")
        head = f"{record.step},{record.increment},{record.total_time!r}"
        lines: list[str] = []
        for state, variables in states:
            lines += self._rows(head, state, variables)
        self._file.write("".join(lines))

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()

    def _rows(self, head: str, state: ElementState, variables: PointVariables) -> list[str]:
        values = point_values(state, variables)
        columns = np.full((*values.shape[:2], len(self._names)), np.nan)
        columns[:, :, [self._names.index(name) for name in variables.names]] = values
        if self._names[-1] == DIRECTIONS[-1]:
            columns[:, :, -3:] = self._direction(state)
        labels = self._model.groups[state.group].labels.tolist()
        # str of a list has the shortest numbers that read back exactly, and is faster than one number at a time
        return [
            f"{head},{label},{k},{str(point)[1:-1].replace(', ', ',').replace('nan', '')}\n"
            for label, points in zip(labels, columns.tolist(), strict=True)
            for k, point in enumerate(points, 1)
        ]

    def _direction(self, state: ElementState) -> FloatArray:
        """Return the direction (3,) of the elements of a group, zero without any."""
        group = self._model.groups[state.group]
        if group.definition is None or not isinstance(group.section, UserProperty):
            return np.zeros(3)
        layout = element_layouts().get(group.definition.number)
        positions = [item.position - 1 for item in layout.reals if item.name in DIRECTIONS] if layout else []
        values = group.section.values
        return values[positions] if positions and positions[-1] < len(values) else np.zeros(3)


def read_profiles(path: Path) -> list[dict[str, FloatArray]]:
    """Read all profiles that were written, each by column as in `read_interface`. Raises UelError without a file."""
    names, blocks = _read_blocks(path)
    return [dict(zip(names, rows.T.copy(), strict=True)) for rows in blocks.values()]


def read_interface(path: Path, step: int | None = None, increment: int = -1) -> dict[str, FloatArray]:
    """Read the profile of one increment, by column, in the order of the elements.

    Parameters
    ----------
    path
        NAME_interface.csv.
    step
        Number of the step; by default the last one that has the increment.
    increment
        Number of the increment; -1 is the last one written of the step.

    Raises
    ------
    UelError
        There is no such file, or it does not hold the increment.
    """
    names, blocks = _read_blocks(path)
    entries = list(blocks)
    values = blocks[entries[find_written(path, "interface profile", entries, step, increment)]]
    return {name: values[:, k].copy() for k, name in enumerate(names)}


def _read_blocks(path: Path) -> tuple[list[str], dict[tuple[int, int], FloatArray]]:
    """Read rows by step and increment. A last block that a killed run left unfinished is left out."""
    if not path.exists():
        needed = "interface elements of the project, or cohesive elements, and the deck has *OUTPUT, FIELD"
        raise UelError(f"{path}: no such file; it is written only if the model has {needed}")
    head, *lines = [line for line in path.read_text("utf-8").splitlines(keepends=True) if line.endswith("\n")]
    names = head.rstrip().split(",")
    if not lines:
        return names, {}
    # loadtxt cannot read an empty cell
    cells = "".join(lines).replace(",\n", ",nan\n").replace(",,", ",nan,").replace(",,", ",nan,")
    table = np.loadtxt(io.StringIO(cells), delimiter=",", ndmin=2)
    starts = 1 + np.flatnonzero(np.diff(table[:, :2], axis=0).any(axis=1))
    blocks = {(int(rows[0, 0]), int(rows[0, 1])): rows for rows in np.split(table, starts)}
    entries = list(blocks)
    if len(entries) > 1 and len(blocks[entries[-1]]) < len(blocks[entries[0]]):
        del blocks[entries[-1]]
    return names, blocks
