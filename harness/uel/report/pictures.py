# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a page: those that a job has files for, as text that an HTML file holds."""

from __future__ import annotations

import base64
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from uel.errors import UelError
from uel.output.pictures.jobs import PictureOptions, draw
from uel.output.pictures.mesh import fields_of
from uel.output.results import Result

_CURVES: Final = (
    ("load", "Load over displacement."),
    ("energies", "Energies of the whole model."),
    ("interface", "Tractions and damage along the interface, last increment written."),
    ("iterations", "Iterations of each increment, those of abandoned attempts included, and its size."),
)
_TYPES: Final = {".svg": "image/svg+xml", ".png": "image/png"}
_PREFERRED: Final = ("SPENT", "DAMAGE", "S22", "S11")
"""Fields of cells of which the first that a job has is shown on the mesh, beside the displacement."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture: its caption, and its address, which holds all of it."""

    caption: str
    address: str


def pictures(result: Result) -> Iterator[Picture]:
    """Yield the pictures of a job, in the order of the page."""
    with tempfile.TemporaryDirectory() as folder:
        for kind, caption in _CURVES:
            yield from _picture(result, kind, PictureOptions(), Path(folder) / f"{kind}.svg", caption)
        for field in _fields(result):
            caption = f"Deformed mesh with {field}, last increment written; means of the elements."
            yield from _picture(result, "mesh", PictureOptions(field=field), Path(folder) / "mesh.png", caption)


def _picture(result: Result, kind: str, options: PictureOptions, path: Path, caption: str) -> Iterator[Picture]:
    """Yield the picture, unless the job has no output for it."""
    try:
        draw(kind, [result], path, options)
    except UelError:
        return
    data = base64.b64encode(path.read_bytes()).decode()
    yield Picture(caption, f"data:{_TYPES[path.suffix]};base64,{data}")


def _fields(result: Result) -> list[str]:
    """Return the fields to draw: the displacement, and one of the cells."""
    if not result.frames:
        return []
    mesh = result.mesh()
    of_cells = [name for name in fields_of(mesh) if name in mesh.cell_data]
    of_cells = [name for name in of_cells if np.isfinite(np.concatenate(mesh.cell_data[name])).any()]
    return ["U", *[*(name for name in _PREFERRED if name in of_cells), *of_cells][:1]]
