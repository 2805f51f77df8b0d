# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Field output: a .vtu file per increment in the folder NAME_vtu, and NAME.pvd, which lists them by total time.

Point data: U and RF (three components), NODE (label), and an array for each other dof (UR1, NT11, ...). With contact
also COPEN, CPRESS, CSHEAR1 and CSHEAR2, which are NaN at nodes outside secondary surfaces.
Cell data: ELEMENT (label) and the variables of elements with known SVARS, as means over the integration points of the
cell; NaN in cells without the variable. Continuum and interface are in one file. For a harmonic response these are the
real parts; names of the imaginary parts end with _imaginary.
"""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from html import escape, unescape
from pathlib import Path
from typing import TypeVar

import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Model
from uel.model.nodal_variables import NodalIndex
from uel.model.records import IncrementDone, Solution
from uel.output.cells import Cells, cell_values, cells_of, is_solid
from uel.output.meshio_cells import meshio
from uel.output.schedule import Schedule, find_written

Values = TypeVar("Values")
_ENTRY = re.compile(r'<DataSet timestep="([^"]+)" part="0" file="([^"]*step(\d+)_increment(\d+)\.vtu)"/>')


@dataclass(frozen=True, slots=True)
class Frame:
    """Entry of the .pvd file."""

    step: int
    increment: int
    time: float
    path: Path


class FieldFiles:
    """Writer of NAME.pvd and NAME_vtu/*.vtu."""

    def __init__(self, pvd: Path, model: Model) -> None:
        self._pvd = pvd
        self._folder = pvd.with_name(f"{pvd.stem}_vtu")
        self._model = model
        self._schedule = Schedule()
        self._entries: list[str] = []
        self._cells: tuple[Cells, ...] = ()
        self._nodal: list[_PointArray] = []
        # at every moment, the files it lists exist
        pvd.unlink(missing_ok=True)
        shutil.rmtree(self._folder, ignore_errors=True)

    def write(self, record: IncrementDone, *, last: bool) -> None:
        """Write the increment if the step requests it."""
        if not self._schedule.due_field(self._model.steps[record.step - 1], record, last=last):
            return
        if not self._entries:
            self._plan(record.solution)
        name = f"step{record.step}_increment{record.increment:04d}.vtu"
        unfinished = self._folder / "unfinished.tmp"
        try:
            meshio.vtu.write(unfinished, self._mesh(record.solution), binary=True, compression="zlib")
        except OSError as error:
            unfinished.unlink(missing_ok=True)
            error.filename = str(self._folder / name)
            raise
        unfinished.replace(self._folder / name)
        self._entries.append(
            f'    <DataSet timestep="{record.total_time!r}" part="0" file="{_quoted(self._folder.name)}/{name}"/>\n'
        )
        _replace(
            self._pvd,
            '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
            f"  <Collection>\n{''.join(self._entries)}  </Collection>\n</VTKFile>\n",
        )

    def _plan(self, solution: Solution) -> None:
        """Build cells and point arrays, which do not change during a run."""
        self._folder.mkdir(parents=True, exist_ok=True)
        solid = is_solid(self._model)
        variables = {state.group: state.variables for state in solution.elements}
        self._cells = tuple(
            cells_of(group, variables.get(k), solid=solid) for k, group in enumerate(self._model.groups)
        )
        index = NodalIndex(len(self._model.mesh.labels), solution)
        everywhere = np.arange(len(self._model.mesh.labels))
        self._nodal = [
            _PointArray("U", "displacement", [index.find(everywhere, dof) for dof in (1, 2, 3)]),
            _PointArray("RF", "reaction", [index.find(everywhere, dof) for dof in (1, 2, 3)]),
        ]
        self._nodal += [
            _PointArray(component.name, component.quantity, [index.find(everywhere, component.dof)])
            for component in index.components(("UR", "POR", "EPOT", "NT", "NNC"), everywhere)
        ]

    def _mesh(self, solution: Solution) -> meshio.Mesh:
        mesh = self._model.mesh
        labels = [group.labels[cells.element] for group, cells in zip(self._model.groups, self._cells, strict=True)]
        return meshio.Mesh(
            mesh.coordinates,
            [(cells.type, cells.nodes) for cells in self._cells],
            point_data=self._point_values(solution) | {"NODE": mesh.labels},
            cell_data=self._cell_values(solution) | {"ELEMENT": labels},
        )

    def _point_values(self, solution: Solution) -> dict[str, FloatArray]:
        values = {array.name: array.values(solution) for array in self._nodal} | solution.contact
        return values | (_imaginary(self._point_values(solution.imaginary)) if solution.imaginary else {})

    def _cell_values(self, solution: Solution) -> dict[str, list[FloatArray]]:
        values = cell_values(solution.elements, self._cells)
        return values | (_imaginary(self._cell_values(solution.imaginary)) if solution.imaginary else {})


def _imaginary(values: dict[str, Values]) -> dict[str, Values]:
    """Return the imaginary parts by the names of their arrays."""
    return {f"{name}_imaginary": value for name, value in values.items()}


class _PointArray:
    """Point array: components gathered from an array of the solution, zero at nodes without the dof."""

    def __init__(self, name: str, quantity: str, positions: list[IntArray]) -> None:
        self.name = name
        self._quantity = quantity
        self._positions = np.stack(positions, axis=1)

    def values(self, solution: Solution) -> FloatArray:
        array: FloatArray = getattr(solution, self._quantity)
        gathered = np.append(array, 0.0)[self._positions]
        return gathered[:, 0] if gathered.shape[1] == 1 else gathered


def _quoted(name: str) -> str:
    """Escape a file name for XML."""
    return escape(name).replace("\n", "&#10;")


def _replace(path: Path, text: str) -> None:
    """Replace a file atomically; names of files keep their bytes."""
    unfinished = path.with_suffix(".tmp")
    try:
        unfinished.write_bytes(os.fsencode(text))
    except OSError as error:
        error.filename = str(unfinished)
        raise
    unfinished.replace(path)


def read_frames(pvd: Path) -> list[Frame]:
    """Return the increments that were written, in order; empty if there are none."""
    if not pvd.exists():
        return []
    return [
        Frame(int(step), int(increment), float(time), pvd.parent / unescape(file))
        for time, file, step, increment in _ENTRY.findall(os.fsdecode(pvd.read_bytes()))
    ]


def read_field_mesh(pvd: Path, step: int | None = None, increment: int = -1) -> meshio.Mesh:
    """Read the mesh with point and cell data of one increment.

    Parameters
    ----------
    pvd
        NAME.pvd.
    step
        Number of the step; by default the last one that has the increment.
    increment
        Number of the increment; -1 is the last one written of the step.

    Raises
    ------
    UelError
        The increment was not written.
    """
    frames = read_frames(pvd)
    if not frames:
        raise UelError(f"{pvd}: no field output; it is written only if the deck has *OUTPUT, FIELD")
    entries = [(frame.step, frame.increment) for frame in frames]
    return meshio.read(frames[find_written(pvd, "field output", entries, step, increment)].path)
