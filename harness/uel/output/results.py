# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Results of a job, read from its files, whether it has completed, failed or been killed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import meshio
import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray
from uel.model.perturbations import PERTURBATION_TIME
from uel.output.files.field_output import Frame, read_field_mesh, read_frames
from uel.output.files.history import read_history
from uel.output.files.interface import read_interface, read_profiles
from uel.output.files.msg_file import read_times
from uel.output.files.sta_file import StatusRow, has_completed, read_status
from uel.output.formats import read_remarks
from uel.output.pictures.load_curve import LoadCurve, load_curve


@dataclass(frozen=True, slots=True)
class Counts:
    """Converged increments, iterations including abandoned attempts, and cutbacks."""

    increments: int
    iterations: int
    cutbacks: int

    @classmethod
    def of(cls, rows: Sequence[StatusRow]) -> Counts:
        """Count increments, iterations and cutbacks in rows of a status file."""
        done = sum(not row.cutback for row in rows)
        return cls(done, sum(row.total_iterations for row in rows), len(rows) - done)

    def __str__(self) -> str:
        named = zip(self.__slots__, (self.increments, self.iterations, self.cutbacks), strict=True)
        return ", ".join(f"{count} {name.removesuffix('s') if count == 1 else name}" for name, count in named)


class Result:
    """Files of one job.

    Parameters
    ----------
    stem
        Folder and name of the job: the files are stem.sta, stem_history.csv and so on.
    seconds
        Wall-clock time of the run, if known.
    warnings
        Warnings of the .dat and .msg files, if known from the run; None: they are read on demand.

    Raises
    ------
    UelError
        There is no stem.sta.
    """

    def __init__(
        self, stem: Path | str, *, seconds: float | None = None, warnings: Sequence[str] | None = None
    ) -> None:
        self._stem = Path(stem)
        self.seconds = seconds
        self._warnings = warnings
        if not self._stem.name:
            raise UelError(f"{stem}: expected the name of a job, with its folder")
        if not self.file(".sta").exists():
            # users may name the deck, or another file of the job
            there = self._stem.suffix and self._stem.with_suffix(".sta").exists()
            meant = f"; did you mean {self._stem.with_suffix('')}?" if there else ""
            raise UelError(f"{self.file('.sta')}: no such job{meant}")

    @property
    def job(self) -> str:
        """Name of the job."""
        return self._stem.name

    def file(self, ending: str) -> Path:
        """Return the path of a file of the job.

        Parameters
        ----------
        ending
            End of the file name after the name of the job: '.msg', '_history.csv', ...

        Returns
        -------
        Path
            The file need not exist.
        """
        return self._stem.with_name(self._stem.name + ending)

    @cached_property
    def status(self) -> list[StatusRow]:
        """Lines of the status file."""
        return read_status(self.file(".sta"))

    @property
    def completed(self) -> bool:
        """True if the analysis has completed."""
        return has_completed(self.file(".sta"))

    @cached_property
    def counts(self) -> Counts:
        """Increments, iterations and cutbacks so far."""
        return Counts.of(self.status)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings in the .dat file, then those in the .msg file."""
        if self._warnings is not None:
            return tuple(self._warnings)
        return tuple(text for ending in (".dat", ".msg") for text in read_remarks(self.file(ending), "WARNING"))

    @property
    def processor_time(self) -> float | None:
        """CPU time of the analysis in seconds; None if it has not closed its files itself."""
        times = read_times(self.file(".msg"))
        return None if times is None else times[0]

    @cached_property
    def history(self) -> dict[str, FloatArray]:
        """History by column: 'step', 'increment', 'time', 'U2[LOAD]', ...; NaN where a step does not write it."""
        return read_history(self.file("_history.csv"))

    @cached_property
    def load_curve(self) -> LoadCurve | None:
        """Load-displacement curve: see harness/uel/output/pictures/load_curve.py. None if the history has none."""
        linear = {row.step for row in self.status if row.time_increment <= PERTURBATION_TIME}
        rows = ~np.isin(self.history["step"], list(linear))
        return load_curve({name: values[rows] for name, values in self.history.items()})

    @property
    def frames(self) -> list[Frame]:
        """Increments with field output."""
        return read_frames(self.file(".pvd"))

    def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
        """Read the mesh with all fields of an increment.

        Parameters
        ----------
        increment
            Its number in the step; -1 is the last one written.
        step
            Number of the step; by default the last one that has the increment.

        Returns
        -------
        meshio.Mesh
            Nodes in the order of the model, cells group after group, with point and cell data.

        Raises
        ------
        UelError
            The increment was not written.
        """
        return read_field_mesh(self.file(".pvd"), step, increment)

    def field(self, name: str, increment: int = -1, step: int | None = None) -> FloatArray:
        """Read one field of an increment.

        Parameters
        ----------
        name
            Name of point data ('U', 'RF', ...) or of cell data ('S11', 'DAMAGE', ...).
        increment, step
            As in `mesh`.

        Returns
        -------
        FloatArray
            Nodal: (nodes,) or (nodes, 3), zero at nodes without the dof. Of cells: (cells,) group after group, means
            over the integration points, NaN in cells without the variable.

        Raises
        ------
        UelError
            The increment or the field was not written.
        """
        mesh = self.mesh(increment, step)
        if name in mesh.point_data:
            return np.asarray(mesh.point_data[name])
        if name in mesh.cell_data:
            return np.concatenate(mesh.cell_data[name])
        known = ", ".join([*mesh.point_data, *mesh.cell_data])
        raise UelError(f"{self.file('.pvd')}: no field '{name}'; available fields: {known}")

    def interface(self, increment: int = -1, step: int | None = None) -> dict[str, FloatArray]:
        """Read the interface profile of an increment, by column: 'element', 'point', 'X', 'SEPN', 'TN', 'DAMAGE', ...

        Parameters
        ----------
        increment, step
            As in `mesh`.

        Returns
        -------
        dict[str, FloatArray]
            Each (integration points of all interface elements,), NaN where an element type lacks the variable.

        Raises
        ------
        UelError
            The increment was not written, or the model has no interface elements of the project, nor cohesive ones.
        """
        return read_interface(self.file("_interface.csv"), step, increment)

    def interfaces(self) -> list[dict[str, FloatArray]]:
        """Read the interface profiles of all increments that were written, in order."""
        return read_profiles(self.file("_interface.csv"))
