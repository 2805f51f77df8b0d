# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Picture of the deformed mesh of an increment with a field: cells in the plane, the surface in space.

A cell has one colour: the mean over its integration points, or over its corners for a nodal field. Cells without the
field are grey; in space, where they would hide others, they are left out. In the plane a thin outline shows the
undeformed model; in space, drawn by PyVista, the deformed one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import matplotlib as mpl
import meshio
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d import proj3d
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from uel.errors import UsageError
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import FAMILIES, Family
from uel.output.pictures.plots import STYLE
from uel.output.pictures.space import SCREEN, Faces, render_faces

_FAMILIES: Final = {family.cell: family for family in FAMILIES.values()}
_WIDTH: Final = 7.0
"""Width of a picture, in inches."""
_MOST_EDGED: Final = 4000
"""Number of cells above which edges would cover the colours."""
_BELOW: Final = {"location": "bottom", "shrink": 0.6, "aspect": 40, "pad": 0.02}
"""Options of the colour bar below the axes."""
_ROUNDING: Final = 1e-9
"""Relative difference of values that counts as zero, so that colours do not show the rounding of a uniform field."""
_LARGE: Final = 0.02
"""Displacement over the size of the model from which on it is drawn without a factor."""


def draw_mesh(
    mesh: meshio.Mesh, path: Path, *, field: str = "U", scale: float | None = None, by_pyvista: bool = False
) -> Path:
    """Draw the deformed mesh.

    Parameters
    ----------
    mesh
        Mesh of one increment, from `Result.mesh`.
    path
        .png, .svg or .pdf.
    field
        Cell or point data; of a vector its magnitude, or a component such as 'U2'.
    scale
        Scale of the displacements; None: 1, or a factor that makes small ones visible.
    by_pyvista
        Let PyVista draw a mesh in space, as .png.

    Raises
    ------
    UsageError
        There is no such field.
    RenderError
        PyVista is missing, or cannot draw on this machine.
    """
    u = np.asarray(mesh.point_data["U"])
    factor = visible_scale(mesh.points, u) if scale is None else scale
    values = _cell_values(mesh, field, path)
    blocks = [
        (_FAMILIES[block.type], block.data, of_block)
        for block, of_block in zip(mesh.cells, values, strict=True)
        if block.type in _FAMILIES
    ]
    times = "" if factor == 1.0 else f", displacements × {factor:g}"
    what = f"{field}{times}"
    after = mesh.points + factor * u
    spatial = _render_space if by_pyvista else _draw_space
    draw = spatial if in_space(mesh) else _draw_plane
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        figure = Figure(figsize=(_WIDTH, 4.0), layout="constrained")
        FigureCanvasAgg(figure)
        drawn = draw(figure, blocks, mesh.points, after)
        if any(np.isfinite(of_block).any() for *_, of_block in blocks):
            bar = figure.colorbar(_colours(blocks), label=what, orientation="horizontal", **drawn.bar)
            bar.locator = MaxNLocator(5)
        elif drawn.shown is None:
            drawn.axis.set_title(what, fontsize=9)
        else:
            drawn.bar["cax"].set_axis_off()
            drawn.bar["cax"].set_title(what, fontsize=9)
        figure.savefig(path, dpi=200, bbox_inches=_cut(figure, drawn))
    return path


def in_space(mesh: meshio.Mesh) -> bool:
    """Return whether a mesh is not in the plane of x and y."""
    return bool(np.ptp(mesh.points[:, 2]) > 0.0)


def visible_scale(points: FloatArray, u: FloatArray) -> float:
    """Return 1 if displacements are visible, else a factor of one digit with which the largest is 1/50 of the model."""
    size = float(np.ptp(points, axis=0).max(initial=0.0))
    largest = float(np.linalg.norm(u, axis=1).max(initial=0.0))
    if largest == 0.0 or size == 0.0 or largest >= _LARGE * size:
        return 1.0
    return float(f"{_LARGE * size / largest:.0e}")


def fields_of(mesh: meshio.Mesh) -> list[str]:
    """Return the names that `draw_mesh` takes."""
    names: list[str] = []
    for name, values in mesh.point_data.items():
        vector = np.ndim(values) == 2
        names += [name, *(f"{name}{k + 1}" for k in range(np.shape(values)[1]))] if vector else [name]
    return [name for name in (*names, *mesh.cell_data) if name not in ("NODE", "ELEMENT")]


_Block = tuple[Family, IntArray, FloatArray]
"""Cells of a family: their nodes, and their values."""


def _cell_values(mesh: meshio.Mesh, field: str, path: Path) -> list[FloatArray]:
    """Return the values of each block of cells. Raises UsageError."""
    if field in mesh.cell_data:
        return [np.asarray(values, dtype=float) for values in mesh.cell_data[field]]
    vector, component = field[:-1], field[-1:]
    if field in mesh.point_data:
        nodal = np.asarray(mesh.point_data[field], dtype=float)
        nodal = nodal if nodal.ndim == 1 else np.linalg.norm(nodal, axis=1)
    elif field in fields_of(mesh):
        nodal = np.asarray(mesh.point_data[vector], dtype=float)[:, int(component) - 1]
    else:
        raise UsageError(f"{path}: no field '{field}'; expected one of {', '.join(fields_of(mesh))}")
    return [nodal[block.data].mean(axis=1) for block in mesh.cells]


def _colours(blocks: Sequence[_Block]) -> ScalarMappable:
    """Map values to colours over the range of all blocks; that of a single value, such as damage 1, begins at zero."""
    values = np.concatenate([of_block for *_, of_block in blocks])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    if high - low <= _ROUNDING * max(abs(low), abs(high)):
        low, high = min(low, 0.0), max(high, 0.0)
    colours = mpl.colormaps["viridis"].with_extremes(bad="0.85")
    return ScalarMappable(Normalize(low, high if high > low else low + 1.0), colours)


@dataclass(frozen=True, slots=True)
class _Drawn:
    """Axes of a picture, options of the colour bar, and the visible part of the axes in inches, None for all."""

    axis: Any
    bar: dict[str, Any]
    shown: Bbox | None = None


def _draw_plane(figure: Figure, blocks: Sequence[_Block], before: FloatArray, after: FloatArray) -> _Drawn:
    """Draw cells and lines, with the outline of the undeformed model."""
    axis = figure.add_subplot()
    colours = _colours(blocks)
    edge = 0.2 if sum(len(cells) for _, cells, _ in blocks) < _MOST_EDGED else 0.0
    sides: list[IntArray] = []
    for family, cells, values in blocks:
        if family.dimension == 2:
            polygons = after[cells[:, outline(family)], :2]
            axis.add_collection(
                PolyCollection(list(polygons), facecolors=colours.to_rgba(values), edgecolors="0.3", linewidths=edge)
            )
            sides += [cells[:, list(face[:2])] for face in family.faces]
        elif family.dimension == 1:
            known = np.isfinite(values)
            rgba = np.where(known[:, None], colours.to_rgba(values), (0.2, 0.2, 0.2, 1.0))
            axis.add_collection(
                LineCollection(list(after[cells[:, :2], :2]), colors=rgba, linewidths=np.where(known, 3.0, 0.8))
            )
    if sides:
        edges, counts = np.unique(np.sort(np.concatenate(sides), axis=1), axis=0, return_counts=True)
        axis.add_collection(
            LineCollection(list(before[edges[counts == 1], :2]), colors="0.6", linewidths=0.5, zorder=0.5)
        )
    axis.set_aspect("equal")
    axis.autoscale_view()
    axis.set(xlabel="X", ylabel="Y")
    width, height = (np.ptp(limits) for limits in (axis.get_xlim(), axis.get_ylim()))
    figure.set_figheight(float(np.clip(_WIDTH * height / width, 0.7, 6.0)) + 1.3)
    return _Drawn(axis, {"ax": axis, **_BELOW})


def _draw_space(figure: Figure, blocks: Sequence[_Block], _before: FloatArray, after: FloatArray) -> _Drawn:
    """Draw outer faces of solids, and faces of interfaces, of those that have the field."""
    axis: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d")
    colours = _colours(blocks)
    faces: list[FloatArray] = []
    rgba: list[FloatArray] = []
    for nodes, of_faces in _faces_with_values(blocks):
        faces += list(after[nodes])
        rgba.append(colours.to_rgba(of_faces))
    if faces:
        edge = 0.1 if len(faces) < _MOST_EDGED else 0.0
        axis.add_collection(Poly3DCollection(faces, facecolors=np.concatenate(rgba), edgecolors="0.3", linewidths=edge))
    low, high = after.min(axis=0), after.max(axis=0)
    size = np.maximum(high - low, 1e-3 * (high - low).max())
    axis.set(xlim=(low[0], low[0] + size[0]), ylim=(low[1], low[1] + size[1]), zlim=(low[2], low[2] + size[2]))
    axis.set_box_aspect(size)
    axis.set_xlabel("X", labelpad=8.0)
    axis.set(ylabel="Y", zlabel="Z")
    axis.tick_params(labelsize=7)
    for name, length in zip("xyz", size, strict=True):
        axis.locator_params(axis=name, nbins=4 if length > 0.3 * size.max() else 1)
    figure.set_layout_engine("none")
    figure.set_figheight(_WIDTH)
    for _ in range(2):
        # numbers and names keep their size
        shown = _shown(figure, axis, after)
        side = float(figure.get_figwidth()) * min(_WIDTH / shown.width, 6.0 / shown.height)
        figure.set_size_inches(side, side)
    shown = _shown(figure, axis, after)
    left, bottom, length = (shown.x0 + 0.2 * shown.width) / side, (shown.y0 - 0.3) / side, 0.6 * shown.width / side
    return _Drawn(axis, {"cax": figure.add_axes((left, bottom, length, 0.12 / side))}, shown)


def _shown(figure: Figure, axis: Any, points: FloatArray) -> Bbox:
    """Return the extent of axes in space, in inches: the points, and the three axes with their numbers."""
    axis.apply_aspect()
    axis.M = axis.get_proj()
    across, up, *_ = proj3d.proj_transform(*points.T, axis.M)
    drawn = axis.transData.transform(np.column_stack([across, up]))
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    parts = [part.get_tightbbox(renderer) for part in (axis.xaxis, axis.yaxis, axis.zaxis)]
    return Bbox(Bbox.union([Bbox([drawn.min(axis=0), drawn.max(axis=0)]), *parts]).get_points() / figure.dpi)


def _render_space(figure: Figure, blocks: Sequence[_Block], _: FloatArray, after: FloatArray) -> _Drawn:
    """Draw a mesh in space by PyVista, with the outline of all solids."""
    faces = [Faces(after[nodes], of_faces) for nodes, of_faces in _faces_with_values(blocks)]
    solids = [after[nodes] for block in blocks if block[0].dimension == 3 for nodes, _ in outer_faces(*block)]
    edges = sum(len(group.values) for group in faces) < _MOST_EDGED
    picture = render_faces(faces, solids, _colours(blocks).get_clim(), edges=edges)
    axis = figure.add_subplot()
    axis.imshow(picture)
    axis.set_axis_off()
    height, width = picture.shape[:2]
    figure.set_figheight(float(np.clip(_WIDTH * height / width, 0.7, 6.0)) + 1.0)
    corner = figure.add_axes((0.0, 0.0, 0.8 / _WIDTH, 0.8 / figure.get_figheight()))
    corner.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), aspect="equal")
    corner.set_axis_off()
    for name, way in zip("XYZ", SCREEN.T, strict=True):
        corner.annotate("", way, (0.0, 0.0), arrowprops={"arrowstyle": "->", "shrinkA": 0.0, "shrinkB": 0.0})
        corner.text(1.2 * way[0], 1.2 * way[1], name, fontsize=7, ha="center", va="center")
    return _Drawn(axis, {"ax": axis, **_BELOW})


def _cut(figure: Figure, drawn: _Drawn) -> Bbox | str:
    """Return the part of a figure to save, without the empty part of the square axes in space."""
    if drawn.shown is None:
        return "tight"
    bar = drawn.bar["cax"].get_tightbbox().get_points() / figure.dpi
    return Bbox.union([drawn.shown, Bbox(bar)]).padded(0.1)


def _faces_with_values(blocks: Sequence[_Block]) -> Iterator[tuple[IntArray, FloatArray]]:
    """Yield the nodes and values of the outer faces of solids, and of interfaces, of the blocks that have the field."""
    for family, cells, values in blocks:
        if not np.isfinite(values).any():
            continue
        if family.dimension == 2:
            yield cells[:, outline(family)], values
        else:
            yield from outer_faces(family, cells, values)


def outline(family: Family) -> list[int]:
    """Return the nodes of a cell in the plane in order around it, those in the middle of its edges included."""
    return [node for face in family.faces for node in (face[0], *face[2:])]


def outer_faces(family: Family, cells: IntArray, values: FloatArray) -> list[tuple[IntArray, FloatArray]]:
    """Return the corners of faces that belong to one cell of the block, by number of corners, and the cells' values."""
    values_of_blocks = []
    for corners in sorted({_corners(face) for face in family.faces}):
        faces = [list(face[:corners]) for face in family.faces if _corners(face) == corners]
        nodes = np.concatenate([cells[:, face] for face in faces])
        _, first, counts = np.unique(np.sort(nodes, axis=1), axis=0, return_index=True, return_counts=True)
        once = first[counts == 1]
        values_of_blocks.append((nodes[once], np.tile(values, len(faces))[once]))
    return values_of_blocks


def _corners(face: Sequence[int]) -> int:
    """Return the number of corners of a face in space, whose other nodes are in the middle of its edges."""
    return len(face) if len(face) < 6 else len(face) // 2
