# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Displacements of an earlier job, for *IMPERFECTION."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from harness.errors import UelError
from harness.model.arrays import FloatArray, IntArray
from harness.model.perturbations import PERTURBATION_TIME
from harness.output.results import Result

ENDINGS = (".fil", ".odb", ".sim")
"""Of result files of Abaqus, which a deck may name; those of this program have none of them."""


def read_shape(folders: Sequence[Path], job: str, step: int, mode: int, increment: int) -> tuple[IntArray, FloatArray]:
    """Displacements from the field output of a job.

    Parameters
    ----------
    folders
        Where the job is looked up; its name may begin with a folder.
    job
        Its name, with or without an ending of Abaqus.
    step
        Number of the step.
    mode
        Mode of a linear step; 1 of others.
    increment
        Of a general step; 0: the last one written.

    Returns
    -------
    tuple[IntArray, FloatArray]
        Labels of the nodes (m,), and displacements (m, 3).

    Raises
    ------
    UelError
        There is no such job, or it has not written them.
    """
    name = job[: -len(Path(job).suffix)] if Path(job).suffix.lower() in ENDINGS else job
    stems = [folder / name for folder in folders]
    stem = next((stem for stem in stems if stem.with_name(f"{stem.name}.sta").exists()), None)
    if stem is None:
        raise UelError(f"no results of a job {name} in {', '.join(dict.fromkeys(str(stem.parent) for stem in stems))}")
    result = Result(stem)
    if any(row.step == step and row.time_increment <= PERTURBATION_TIME for row in result.status):
        increment = mode
    elif mode != 1:
        raise UelError(f"step {step} has no modes: expected 1 for its displacements, found mode {mode}")
    mesh = result.mesh(increment or -1, step)
    return np.asarray(mesh.point_data["NODE"]), np.asarray(mesh.point_data["U"])
