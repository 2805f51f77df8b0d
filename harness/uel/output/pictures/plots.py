# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Figures for print: load-displacement curves and profiles along an interface.

Colours are those of Okabe and Ito, which colour-blind readers can distinguish; each curve also has its own line style
or marker, for black and white. The legend is above the axes and covers nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator
from numpy.typing import ArrayLike

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
_DASHES: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1.5, 1.2)))
_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.labelsize": 9,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.5,
    "xtick.direction": "in",
    "ytick.direction": "in",
}


@dataclass(frozen=True, slots=True)
class Curve:
    """Curve of a figure.

    kind  'line'; 'reference' (thin, grey, drawn below the others: theory); 'points' (markers only: few values, as from
          an experiment or another code); 'marked' (line with a marker at every value)
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    kind: str = "line"


@dataclass(frozen=True, slots=True)
class Panel:
    """Pair of axes of a `grid`: title, labels with units, and the ranges shown (all of the data by default).

    logarithmic  axes with a logarithmic scale: '', 'x', 'xy'
    """

    title: str
    curves: Sequence[Curve]
    x_label: str
    y_label: str
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    logarithmic: str = ""


def load_displacement(curves: Sequence[Curve], path: Path, *, x_label: str = "Displacement [mm]") -> Path:
    """Draw load over displacement, both axes from zero if the data allow it.

    Parameters
    ----------
    curves
        At least one.
    path
        .png (300 dots per inch), .pdf or .svg.
    x_label
        With its unit; loads are in N.

    Returns
    -------
    Path
        `path`.
    """
    return stacked([curves], path, x_label, ["Load [N]"], from_zero=True)


def profiles(panels: Sequence[Sequence[Curve]], path: Path, *, y_labels: Sequence[str]) -> Path:
    """Draw several quantities along one interface, one panel each above a common axis.

    Curves of the same label look the same in every panel and appear once in the legend.
    """
    return stacked(panels, path, "Position along the interface [mm]", y_labels)


def stacked(
    panels: Sequence[Sequence[Curve]],
    path: Path,
    x_label: str,
    y_labels: Sequence[str],
    *,
    from_zero: bool = False,
) -> Path:
    """Draw panels above a common axis.

    Parameters
    ----------
    panels
        Curves of each, as in `profiles`.
    path
        .png (300 dots per inch), .pdf or .svg.
    x_label, y_labels
        With their units, if these are known; one for each panel.
    from_zero
        Both axes begin at zero if the data allow it.
    """
    with mpl.rc_context(STYLE):
        # 140 mm, the text width of a one-column page: prints without scaling, so fonts keep their size
        figure = Figure(figsize=(5.5, 3.4 + 1.9 * (len(panels) - 1)), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        looks = _looks([curve for curves in panels for curve in curves])
        for axis, curves, y_label in zip(axes, panels, y_labels, strict=True):
            for curve in curves:
                axis.plot(curve.x, curve.y, label=curve.label, **looks[curve.label])
            axis.set_ylabel(y_label)
            axis.margins(x=0.02)
            if from_zero:
                _start_at_zero(axis)
        axes[-1].set_xlabel(x_label)
        figure.align_ylabels(axes)
        _legend(figure, axes, 84)
        figure.savefig(path, dpi=300)
    return path


def grid(rows: Sequence[Sequence[Panel]], path: Path, *, share_y: bool = False, legend: bool = True) -> Path:
    """Draw panels in rows and columns, each with its own axes.

    Parameters
    ----------
    rows
        Panels of each row, equally many.
    path
        .png (200 dots per inch), .pdf or .svg.
    share_y
        One range of ordinates for the panels of a row, so that heights compare.
    legend
        Whether to draw a legend.

    Curves of the same label look the same in every panel and appear once in the legend.
    """
    with mpl.rc_context(STYLE | {"axes.titlesize": 9}):
        height, width = len(rows), len(rows[0])
        figure = Figure(figsize=(max(5.5, 2.9 * width), 0.5 + 2.3 * height), layout="constrained")
        FigureCanvasAgg(figure)
        sharing: Any = "row" if share_y else "none"
        axes = figure.subplots(height, width, squeeze=False, sharey=sharing)
        looks = _looks([curve for row in rows for panel in row for curve in panel.curves])
        for axis, panel in zip(axes.flat, (panel for row in rows for panel in row), strict=True):
            for curve in panel.curves:
                axis.plot(curve.x, curve.y, label=curve.label, **looks[curve.label])
            axis.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label)
            axis.set(**{f"{name}scale": "log" for name in panel.logarithmic})
            if "x" in panel.logarithmic and axis.dataLim.x1 < 10.0 * axis.dataLim.x0:
                # powers of ten would be too few
                axis.xaxis.set_major_locator(MaxNLocator(5))
                axis.xaxis.set_major_formatter("{x:g}")
                axis.xaxis.set_minor_locator(NullLocator())
            axis.margins(x=0.02)
            if panel.x_range:
                axis.set_xlim(panel.x_range)
            if panel.y_range:
                axis.set_ylim(panel.y_range)
            axis.tick_params(labelleft=True)
        if legend:
            _legend(figure, axes.flat, 42 * max(2, width))
        figure.savefig(path, dpi=200)
    return path


def _legend(figure: Figure, axes: Iterable[Any], letters: int) -> None:
    """Draw one legend above all axes, if there is more than one curve; letters: number that fits on a line."""
    handles = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    if len(handles) > 1:
        longest = max(map(len, handles))
        figure.legend(
            handles.values(),
            handles.keys(),
            loc="outside upper center",
            ncols=max(1, min(len(handles), letters // (longest + 8))),
            handlelength=2.8,
        )


def _looks(curves: Sequence[Curve]) -> dict[str, dict[str, Any]]:
    """Return the arguments of `plot` for each label."""
    looks: dict[str, dict[str, Any]] = {}
    drawn = references = 0
    for curve in curves:
        if curve.label in looks:
            continue
        if curve.kind == "reference":
            looks[curve.label] = {
                "color": "0.35",
                "linewidth": 1.0,
                "linestyle": _DASHES[(references + 1) % len(_DASHES)],
                "zorder": 1.5,
            }
            references += 1
            continue
        look: dict[str, Any] = {"color": COLOURS[drawn % len(COLOURS)]}
        if curve.kind in ("points", "marked"):
            look |= {"marker": _MARKERS[drawn % len(_MARKERS)], "markersize": 3.5 if curve.kind == "points" else 2.5}
        look["linestyle"] = "none" if curve.kind == "points" else _DASHES[drawn % len(_DASHES)]
        looks[curve.label] = look
        drawn += 1
    return looks


def _start_at_zero(axis: Any) -> None:
    """Let both axes begin at zero unless there are values below it."""
    left, right = axis.dataLim.intervalx
    bottom, top = axis.dataLim.intervaly
    if left >= 0.0 and right > 0.0:
        axis.set_xlim(left=0.0)
    if bottom >= 0.0 and top > 0.0:
        axis.set_ylim(bottom=0.0)
