# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coloured faces in space, drawn off screen by PyVista, which hides parts of faces; matplotlib sorts whole faces.

PyVista runs in a separate process, because VTK ends the process with a signal on a machine without OpenGL.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.image import imread, imsave

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray

INSTALL: Final = "pip install pyvista"
_SECONDS: Final = 300.0
"""Time limit in seconds, longer than any picture takes, in case a display does not answer."""
_SIZE: Final = (2800, 2000)
"""Size of the picture in pixels, before its margins are cut off; large enough to be smooth when reduced."""
_TO_EYE: Final = np.array([0.5, -0.87, 0.55]) / np.linalg.norm([0.5, -0.87, 0.55])
_RIGHT: Final = np.cross([0.0, 0.0, 1.0], _TO_EYE) / np.linalg.norm(np.cross([0.0, 0.0, 1.0], _TO_EYE))
SCREEN: Final = np.array([_RIGHT, np.cross(_TO_EYE, _RIGHT)])
"""Directions (2, 3) to the right and upwards in a picture, which is a parallel projection."""
_CREASE: Final = 30.0
"""Smallest angle in degrees between faces whose edge is part of the outline."""


class RenderError(UelError):
    """PyVista is missing, or cannot draw on this machine."""


@dataclass(frozen=True, slots=True)
class Faces:
    """Polygons with equal numbers of corners: points (k, corners, 3) and values (k,)."""

    corners: FloatArray
    values: FloatArray


def has_pyvista() -> bool:
    """Return whether PyVista is installed."""
    return find_spec("pyvista") is not None


def render_faces(
    faces: Sequence[Faces], outline: Sequence[FloatArray], limits: tuple[float, float], *, edges: bool
) -> np.ndarray:
    """Draw faces, and the creases of other faces as lines.

    Parameters
    ----------
    faces
        Coloured by their values.
    outline
        Faces (k, corners, 3) of which only creases are drawn.
    limits
        Lowest and highest value of the colours.
    edges
        Whether to draw the edges of the faces.

    Returns
    -------
    np.ndarray
        Picture (rows, columns, 4), red, green, blue and opacity from 0 to 1, without margins.

    Raises
    ------
    RenderError
    """
    with tempfile.TemporaryDirectory() as folder:
        file, picture = Path(folder) / "faces.npz", Path(folder) / "faces.png"
        arrays: dict[str, Any] = {"limits": limits, "edges": edges}
        for k, group in enumerate(faces):
            arrays |= {f"corners{k}": group.corners, f"values{k}": group.values}
        arrays |= {f"outline{k}": group for k, group in enumerate(outline)}
        np.savez(file, **arrays)
        command = [sys.executable, "-m", __name__, str(file), str(picture)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=_SECONDS)
        except subprocess.TimeoutExpired:
            raise RenderError(f"PyVista has not drawn within {_SECONDS:g} s") from None
        if done.returncode:
            raise RenderError(f"PyVista cannot draw here: {_reason(done)}")
        return _without_margins(imread(picture))


def _reason(done: subprocess.CompletedProcess[str]) -> str:
    """Return the reason why the process has failed."""
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        return f"VTK ended with {name}, as it does without OpenGL; install libegl1 and libgl1-mesa-dri, or libosmesa6"
    lines = done.stderr.strip().splitlines()
    return lines[-1] if lines else f"exit code {done.returncode}"


def main(arguments: Sequence[str]) -> int:
    """Draw in a separate process; arguments: file with the arrays, and picture."""
    import pyvista  # noqa: PLC0415

    file, picture = arguments
    # with several samples, the diagonals that VTK splits faces by would show
    pyvista.global_theme.multi_samples = 1
    plotter = pyvista.Plotter(off_screen=True, window_size=list(_SIZE))
    plotter.set_background("white")
    lines = {"color": "#4d4d4d", "line_width": 2}
    with np.load(file) as arrays:
        for k in range(sum(name.startswith("corners") for name in arrays)):
            plotter.add_mesh(
                _surface(pyvista, arrays[f"corners{k}"]),
                scalars=arrays[f"values{k}"],
                clim=arrays["limits"].tolist(),
                cmap="viridis",
                nan_color="lightgrey",
                show_edges=bool(arrays["edges"]),
                edge_color=lines["color"],
                line_width=lines["line_width"],
                lighting=False,
                show_scalar_bar=False,
            )
        for k in range(sum(name.startswith("outline") for name in arrays)):
            creases = _surface(pyvista, arrays[f"outline{k}"]).clean().extract_feature_edges(_CREASE)
            if creases.n_cells:
                plotter.add_mesh(creases, lighting=False, **lines)
    plotter.enable_parallel_projection()
    plotter.view_vector(_TO_EYE, viewup=(0.0, 0.0, 1.0))
    imsave(picture, plotter.screenshot(None, return_img=True))
    plotter.close()
    return 0


def _surface(pyvista: Any, corners: FloatArray) -> Any:
    """Return the faces (k, corners, 3) as PyVista has them."""
    count, each, _ = corners.shape
    nodes: IntArray = np.arange(count * each).reshape(count, each)
    return pyvista.PolyData(corners.reshape(-1, 3), faces=np.insert(nodes, 0, each, axis=1).ravel())


def _without_margins(picture: np.ndarray) -> np.ndarray:
    """Cut off the white margins of the picture."""
    inside = np.argwhere((picture < 1.0).any(axis=2))
    if not len(inside):
        return picture
    (top, left), (bottom, right) = inside.min(axis=0), inside.max(axis=0)
    return picture[top : bottom + 1, left : right + 1]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
