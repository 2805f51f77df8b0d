# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""History output (NAME_history.csv): nodal variables and energies, one row per increment.

Columns are step, increment, time (total time), `LPF` if the load factor is part of the solution, then what *NODE
OUTPUT and *ENERGY OUTPUT of the steps request, in order: `U2[LOAD]` for a set of one node, `RF2[LOAD:17]` for each node
of a larger set, `ALLSE` for an energy of the whole model, `ALLSE[TOP]` for that of an element set. A mode of *FREQUENCY
has a row, with its frequency as time. So does a frequency of *STEADY STATE DYNAMICS, with amplitudes and, in further
columns `PU2[LOAD]`, phase angles in degrees. A column that a step does not request is empty there. What each energy is
the sum of stands in `harness/uel/model/energies.py`.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.energies import ELEMENT_ENERGIES, ENERGIES, PLASTIC, energies_of_elements
from uel.model.model import Model
from uel.model.nodal_variables import PHASE, Component, NodalIndex
from uel.model.records import MODAL, IncrementDone, Solution
from uel.model.steps import EnergyRequest, NodeRequest
from uel.output.files.tables import chosen_elements
from uel.output.formats import TextFile
from uel.output.schedule import Schedule

FIXED = ("step", "increment", "time")


class HistoryFile:
    """Writer of NAME_history.csv; its first line is written with the first increment, when the dofs are known."""

    def __init__(self, path: Path, model: Model) -> None:
        self._model = model
        self._file = TextFile(path)
        self._schedule = Schedule()
        self._columns: list[_Column] = []
        self._of_step: dict[int, list[tuple[int, _Column]]] = {}
        self._along_path = False
        self.unavailable: list[str] = []

    def write(self, record: IncrementDone, *, last: bool) -> None:
        """Append the row of an increment if the step requests it."""
        output = self._model.steps[record.step - 1].output
        if not self._schedule.due(output.history_frequency, record, last=last):
            return
        if not self._of_step:
            self._along_path = record.load_factor is not None or any(s.procedure.riks for s in self._model.steps)
            self._plan(record.solution)
        cells = [""] * len(self._columns)
        for position, column in self._of_step[record.step]:
            cells[position] = repr(column.value(record.solution))
        head = f"{record.step},{record.increment},{record.total_time!r}"
        if self._along_path:
            head += f",{record.load_factor!r}" if record.load_factor is not None else ","
        self._file.write(",".join([head, *cells]) + "\n")

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _plan(self, solution: Solution) -> None:
        """Fix the columns of all steps and write the first line."""
        index = NodalIndex(len(self._model.mesh.labels), solution)
        position: dict[str, int] = {}
        for step in self._model.steps:
            columns: list[_Column] = []
            for request in step.output.history_nodes:
                columns += self._nodal(request, index, harmonic=step.procedure.harmonic)
            for name in step.output.history_energies:
                if name in ENERGIES or name in MODAL:
                    columns.append(_Column(name))
                else:
                    self.unavailable.append(f"{name} of step {step.number}")
            for asked in step.output.history_sets:
                columns += self._of_set(asked, step.number, linear=step.procedure.linear)
            chosen: dict[str, _Column] = {column.name: column for column in columns}
            for name, column in chosen.items():
                if name not in position:
                    position[name] = len(self._columns)
                    self._columns.append(column)
            self._of_step[step.number] = [(position[name], column) for name, column in chosen.items()]
        buffer = io.StringIO()
        fixed = (*FIXED, "LPF") if self._along_path else FIXED
        csv.writer(buffer, lineterminator="\n").writerow([*fixed, *(column.name for column in self._columns)])
        self._file.write(buffer.getvalue())

    def _of_set(self, request: EnergyRequest, step: int, *, linear: bool) -> list[_Column]:
        names = [name for name in request.variables if name in ELEMENT_ENERGIES and not linear]
        unavailable = [name for name in request.variables if name not in names]
        self.unavailable += [f"{name} of element set {request.elset} in step {step}" for name in unavailable]
        energies = _SetEnergies(self._model, request.elements)
        return [_Column(f"{name}[{request.elset}]", energies=energies, key=name) for name in names]

    def _nodal(self, request: NodeRequest, index: NodalIndex, *, harmonic: bool) -> list[_Column]:
        names = request.variables
        if harmonic:
            names = tuple(name for variable in names for name in (variable, PHASE + variable))
        components = index.components(names, request.nodes, harmonic=harmonic)
        for variable in request.variables:
            if not index.components((variable,), request.nodes, harmonic=harmonic):
                self.unavailable.append(f"{variable} of {request.nset or 'all nodes'}")
        return [
            _Column(f"{component.name}[{where}]", component, np.array([position]))
            for component in components
            for where, position in zip(
                _labels(self._model, request.nset, request.nodes), index.find(request.nodes, component.dof), strict=True
            )
            if position >= 0
        ]


class _SetEnergies:
    """Energies of an element set, summed once for each increment."""

    def __init__(self, model: Model, elements: IntArray) -> None:
        self._model, self._elements = model, elements
        self._last: tuple[Solution, dict[str, float]] | None = None

    def of(self, solution: Solution) -> dict[str, float]:
        """Return the energies by name."""
        if self._last is None or self._last[0] is not solution:
            energy, damage = np.zeros(8), 0.0
            for _, inside, state in chosen_elements(self._elements, self._model, solution):
                own = state.energy[inside].sum(axis=0)
                if state.damages:
                    damage, own[PLASTIC] = damage + own[PLASTIC], 0.0
                energy += own
            self._last = solution, energies_of_elements(energy, float(damage))
        return self._last[1]


class _Column:
    """Column: a nodal component, or an energy of a set or of the whole model."""

    def __init__(
        self,
        name: str,
        component: Component | None = None,
        position: IntArray | None = None,
        energies: _SetEnergies | None = None,
        key: str = "",
    ) -> None:
        self.name = name
        self._component = component
        self._position = position
        self._energies, self._key = energies, key

    def value(self, solution: Solution) -> float:
        if self._energies is not None:
            return self._energies.of(solution)[self._key]
        if self._component is None or self._position is None:
            return float(solution.energies[self.name])
        return float(self._component.values(solution, self._position)[0])


def _labels(model: Model, nset: str, nodes: IntArray) -> list[str]:
    """Return the text in the brackets of the columns of a set."""
    if nset and len(nodes) == 1:
        return [nset]
    names = [model.mesh.name(int(node)) for node in nodes]
    return [f"{nset}:{name}" for name in names] if nset else names


def read_history(path: Path) -> dict[str, FloatArray]:
    """Read columns by name; NaN where a step does not write a column. An unfinished last row is left out."""
    lines = [line for line in path.read_text("utf-8").splitlines(keepends=True) if line.endswith("\n")]
    if not lines:
        return {name: np.zeros(0) for name in FIXED}
    names, *rows = csv.reader(lines)
    values = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows]).reshape(-1, len(names))
    return {name: values[:, k].copy() for k, name in enumerate(names)}
