# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Field output of an earlier job that a deck imports: displacements, temperatures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.perturbations import PERTURBATION_TIME
from uel.output.results import Result

ENDINGS = (".fil", ".odb", ".sim")
"""Endings of Abaqus' result files, which a deck may name; this program does not write such files."""


class EarlierJobs:
    """Jobs with results in some folders.

    Parameters
    ----------
    folders
        Folders in which to find a job, whose name may begin with a folder too.
    """

    def __init__(self, folders: Sequence[Path]) -> None:
        self._folders = folders

    def shape(self, job: str, step: int, mode: int, increment: int) -> tuple[IntArray, FloatArray]:
        """Read displacements.

        Parameters
        ----------
        job
            Its name, with or without an ending of Abaqus.
        step
            Number of the step.
        mode
            Mode of a linear step; 1 of others.
        increment
            Increment of a general step; 0: the last one written.

        Returns
        -------
        tuple[IntArray, FloatArray]
            Labels of the nodes (m,), and displacements (m, 3).

        Raises
        ------
        UelError
            There is no such job, or it has not written this output.
        """
        result = self._result(job)
        if any(row.step == step and row.time_increment <= PERTURBATION_TIME for row in result.status):
            increment = mode
        elif mode != 1:
            raise UelError(f"step {step} has no modes: expected 1 for its displacements, found mode {mode}")
        mesh = result.mesh(increment or -1, step)
        return np.asarray(mesh.point_data["NODE"]), np.asarray(mesh.point_data["U"])

    def temperatures(self, job: str, step: int, increment: int) -> tuple[IntArray, FloatArray]:
        """Read temperatures of dof 11.

        Parameters
        ----------
        job, increment
            As `shape` takes them.
        step
            Number of the step; 0: the last one.

        Returns
        -------
        tuple[IntArray, FloatArray]
            Labels of the nodes that have one (m,), and temperatures (m,).

        Raises
        ------
        UelError
            There is no such job, or it has not written this output.
        """
        result = self._result(job)
        last = max((row.step for row in result.status), default=0)
        mesh = result.mesh(increment or -1, step or last)
        if TEMPERATURE not in mesh.point_data:
            raise UelError("the job has no temperatures (dof 11)")
        values = np.asarray(mesh.point_data[TEMPERATURE], dtype=float).ravel()
        known = ~np.isnan(values)
        return np.asarray(mesh.point_data["NODE"])[known], values[known]

    def _result(self, job: str) -> Result:
        name = job[: -len(Path(job).suffix)] if Path(job).suffix.lower() in ENDINGS else job
        stems = [folder / name for folder in self._folders]
        stem = next((stem for stem in stems if stem.with_name(f"{stem.name}.sta").exists()), None)
        if stem is None:
            folders = ", ".join(dict.fromkeys(str(stem.parent) for stem in stems))
            raise UelError(f"no results of a job {name} in {folders}")
        return Result(stem)


TEMPERATURE = "NT11"
