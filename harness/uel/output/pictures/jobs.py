# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of jobs from their files, for `uel plot` and `uel report`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

from uel.errors import UelError, UsageError
from uel.model.arrays import FloatArray
from uel.model.energies import ENERGIES
from uel.output.files.sta_file import StatusRow
from uel.output.pictures.column import Column, column_names, read_column
from uel.output.pictures.load_curve import LoadCurve
from uel.output.pictures.measured_curve import read_curve
from uel.output.pictures.mesh import draw_mesh, in_space
from uel.output.pictures.plots import Curve, stacked
from uel.output.pictures.space import INSTALL, RenderError, has_pyvista
from uel.output.results import Result

ENDINGS: Final = (".png", ".svg", ".pdf")

_FEW: Final = 5
"""Number of values of a curve up to which they have markers."""

_TRACTIONS: Final = ("TN", "TT", "TS")
"""Variables of a profile, as far as the elements have them."""


_VISIBLE: Final = 1e-3
"""Energy over the largest one above which it is drawn."""

_ROUNDING: Final = 1e-6
"""Traction over the largest one up to which it is not drawn."""

_SAME: Final = 1e-9
"""Distance along an interface, over its length, up to which points count as coincident."""

_APART: Final = 1e-4
"""Distance across an interface, over its length, from which on points belong to different interfaces."""


@dataclass(frozen=True, slots=True)
class PictureOptions:
    """Request for a picture.

    x, y            columns of the history, with a factor if wanted; '' and none: load over displacement
    measured        CSV files of measured curves
    increment, step  of a profile or a mesh: -1 and None for the last one written
    field, scale    of a mesh: see `draw_mesh`
    tell            called with a sentence if a picture is drawn by a fallback
    """

    x: str = ""
    y: Sequence[str] = ()
    measured: Sequence[Path] = ()
    increment: int = -1
    step: int | None = None
    field: str = "U"
    scale: float | None = None
    tell: Callable[[str], None] = lambda _: None


def draw(kind: str, results: Sequence[Result], path: Path, options: PictureOptions) -> Path:
    """Draw a picture.

    Parameters
    ----------
    kind
        One of KINDS.
    results
        Jobs to draw in one picture.
    path
        .png, .svg or .pdf.
    options
        Options of the picture.

    Raises
    ------
    UelError
        The files do not have the requested data; UsageError for invalid options.
    """
    if path.suffix.lower() not in ENDINGS:
        raise UsageError(f"{path}: expected a file name that ends with {', '.join(ENDINGS)}")
    if kind != "load" and (options.x or options.y or options.measured):
        raise UsageError(f"--kind {kind}: expected without --x, --y and --csv, which belong to the history")
    return KINDS[kind](results, path, options)


def _load(results: Sequence[Result], path: Path, options: PictureOptions) -> Path:
    """Draw load over displacement, or columns of the history over another."""
    if options.x or options.y:
        return _columns(results, path, options)
    of_jobs = [_load_curve(result) for result in results]
    curves = [_curve(_name(result, results), curve.x, curve.y) for result, curve in zip(results, of_jobs, strict=True)]
    x_names, y_names = {curve.x_name for curve in of_jobs}, {curve.y_name for curve in of_jobs}
    axes = [Column(next(iter(names)) if len(names) == 1 else "") for names in (x_names, y_names)]
    curves += [Curve(file.stem, *read_curve(file, axes), "points") for file in options.measured]
    x_label = f"Displacement {next(iter(x_names))}" if len(x_names) == 1 else "Displacement"
    y_label = f"Load {next(iter(y_names))}" if len(y_names) == 1 else "Load"
    return stacked([curves], path, x_label, [y_label], from_zero=True)


def _load_curve(result: Result) -> LoadCurve:
    curve = result.load_curve
    if curve is None:
        raise UelError(
            f"{result.file('_history.csv')}: no force with its displacement; ask for both with *OUTPUT, HISTORY and "
            f"*NODE OUTPUT (U, RF), or name columns with --x and --y: {column_names(result.history)}"
        )
    return curve


def _columns(results: Sequence[Result], path: Path, options: PictureOptions) -> Path:
    if not options.y:
        raise UsageError(f"--x {options.x}: expected with --y, the columns to draw over it")
    x_column, y_columns = read_column(options.x or "time"), [read_column(text) for text in options.y]
    curves = []
    for result in results:
        for y_column in y_columns:
            x, y = (_values(result, column) for column in (x_column, y_column))
            rows = np.isfinite(x) & np.isfinite(y)
            words = [_name(result, results)] * (len(results) > 1) + [str(y_column)] * (len(y_columns) > 1)
            curves.append(_curve(", ".join(words) or str(y_column), x[rows], y[rows]))
    curves += [Curve(file.stem, *read_curve(file, (x_column, y_columns[0])), "points") for file in options.measured]
    return stacked([curves], path, str(x_column), [str(y_columns[0]) if len(y_columns) == 1 else "Value"])


def _values(result: Result, column: Column) -> FloatArray:
    return column.find(result.history, str(result.file("_history.csv")))


def _energies(results: Sequence[Result], path: Path, _: PictureOptions) -> Path:
    """Draw the energies of the whole model over time that are not zero, with a panel for each job."""
    histories = [result.history for result in results]
    names = [name for name in ENERGIES if any(_matters(history, name) for history in histories)]
    if not names:
        raise UelError(f"{results[0].file('_history.csv')}: no energies; ask for them with *ENERGY OUTPUT")
    if len(results) == 1:
        curves = [_curve(name, histories[0]["time"], histories[0][name]) for name in names]
        return stacked([curves], path, "Total time", ["Energy"])
    panels = [
        [
            _curve(_name(result, results), history["time"], history[name])
            for result, history in zip(results, histories, strict=True)
            if name in history
        ]
        for name in names
    ]
    return stacked(panels, path, "Total time", names)


def _matters(history: Mapping[str, FloatArray], name: str) -> bool:
    """Return whether an energy is visible beside the others."""
    sizes = {other: np.abs(history[other]) for other in ENERGIES if other in history}
    largest = max((float(values[np.isfinite(values)].max(initial=0.0)) for values in sizes.values()), default=0.0)
    size = sizes.get(name, np.zeros(0))
    return largest > 0.0 and float(size[np.isfinite(size)].max(initial=0.0)) > _VISIBLE * largest


def _iterations(results: Sequence[Result], path: Path, _: PictureOptions) -> Path:
    """Draw the iterations of each increment, including abandoned attempts, and its size over time."""
    panels: list[list[Curve]] = [[], []]
    for result in results:
        done = _of_increments(result.status)
        if not done:
            raise UelError(f"{result.file('.sta')}: no increment is complete")
        time = np.array([row.total_time for row, _ in done])
        label = _name(result, results)
        panels[0].append(_curve(label, time, np.array([float(count) for _, count in done])))
        panels[1].append(_curve(label, time, np.array([row.time_increment for row, _ in done])))
    return stacked(panels, path, "Total time", ["Iterations", "Size of the increment"], from_zero=True)


def _of_increments(rows: Sequence[StatusRow]) -> list[tuple[StatusRow, int]]:
    """Return the converged increments with the iterations of all their attempts."""
    done: list[tuple[StatusRow, int]] = []
    spent = 0
    for row in rows:
        spent += row.total_iterations
        if not row.cutback:
            done.append((row, spent))
            spent = 0
    return done


def _interface(results: Sequence[Result], path: Path, options: PictureOptions) -> Path:
    """Draw tractions and damage along an interface in the plane."""
    profiles = [result.interface(options.increment, options.step) for result in results]
    sizes = {
        name: max(float(np.nanmax(np.abs(profile[name]))) for profile in profiles if name in profile)
        for name in _TRACTIONS
        if any(name in profile for profile in profiles)
    }
    # tractions of a pure mode are rounding in the others
    largest = max(sizes.values(), default=0.0)
    names = [name for name, size in sizes.items() if size > _ROUNDING * largest]
    # built-in elements have no SPENT, and the curves of one panel mean the same
    damage = "SPENT" if all("SPENT" in profile for profile in profiles) else "DAMAGE"
    names += [damage] if any(damage in profile for profile in profiles) else []
    panels: list[list[Curve]] = [[] for _ in names]
    for result, profile in zip(results, profiles, strict=True):
        where, breaks = _position(result, profile)
        for panel, name in zip(panels, names, strict=True):
            if name in profile:
                values = np.insert(profile[name][where[1]], breaks, np.nan)
                panel.append(_curve(_name(result, results), np.insert(where[0], breaks, np.nan), values))
    return stacked(panels, path, "Position along the interface", names)


def _position(result: Result, profile: Mapping[str, FloatArray]) -> tuple[tuple[FloatArray, np.ndarray], list[int]]:
    """Return coordinates along the interface, the order of the points, and where another interface begins in it.

    The direction is that of the largest extent; on an interface along an axis, the coordinate.
    """
    points = np.column_stack([profile[name] for name in ("X", "Y", "Z") if name in profile])
    spread = points - points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(spread, full_matrices=False)
    if len(sizes) > 2 and sizes[1] > 0.05 * sizes[0]:
        file = result.file("_interface.csv")
        raise UelError(f"{file}: the interface is a surface; --kind mesh --field SPENT shows it, and uel front")
    along = axes[0] * np.sign(axes[0][np.argmax(np.abs(axes[0]))])
    # rounding would tilt an interface along an axis
    along = np.where(np.abs(along) < 1e-9, 0.0, along)
    position = points @ along
    order = np.argsort(position, kind="stable")
    if len(sizes) < 2 or not len(points):
        return (position[order], order), []
    beside, length = spread @ axes[1], float(np.ptp(position))
    above = np.abs(np.diff(beside[order])) > _APART * length
    if not (above & (np.diff(position[order]) < _SAME * length)).any():
        return (position[order], order), []
    # interfaces above each other: from the lowest to the highest
    heights = np.sort(beside)
    layers = np.searchsorted(heights[1:][np.diff(heights) > _APART * length], beside, side="right")
    order = np.lexsort((position, layers))
    breaks = (1 + np.flatnonzero(np.diff(layers[order]))).tolist()
    return (position[order], order), breaks


def _mesh(results: Sequence[Result], path: Path, options: PictureOptions) -> Path:
    """Draw the deformed mesh."""
    if len(results) > 1:
        raise UsageError("--kind mesh: expected one job")
    mesh = results[0].mesh(options.increment, options.step)
    drawn = partial(draw_mesh, mesh, path, field=options.field, scale=options.scale)
    if in_space(mesh) and path.suffix.lower() == ".png":
        if has_pyvista():
            try:
                return drawn(by_pyvista=True)
            except RenderError as error:
                options.tell(f"{error}; drawn by matplotlib")
        else:
            options.tell(f"drawn by matplotlib, which may take a face behind for one in front; PyVista: {INSTALL}")
    return drawn()


KINDS: Final[dict[str, Callable[[Sequence[Result], Path, PictureOptions], Path]]] = {
    "load": _load,
    "energies": _energies,
    "iterations": _iterations,
    "interface": _interface,
    "mesh": _mesh,
}
"""Pictures by name."""


def _curve(label: str, x: FloatArray, y: FloatArray) -> Curve:
    return Curve(label, x, y, "marked" if len(x) <= _FEW else "line")


def _name(result: Result, results: Sequence[Result]) -> str:
    """Return the name of a job in the legend: with its folder where another job has the same."""
    same = sum(other.job == result.job for other in results) > 1
    return str(result.file("")) if same else result.job
