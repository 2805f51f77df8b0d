# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures, data and table of `uel law`: traction over separation of one interface element."""

from __future__ import annotations

import csv
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from rich.table import Table

from uel import usersub
from uel.delamination import law
from uel.delamination.law import LawCurve, LawElement
from uel.delamination.softening import LAWS, alike_in_both_modes
from uel.errors import UsageError
from uel.model.arrays import FloatArray
from uel.output.lock import job_stem, locked
from uel.output.pictures.plots import COLOURS, STYLE

SURFACE_ANGLES = 31
SURFACE_SIZES = 60
NOTICED = 0.05
"""Share of a toughness by which the dissipated energy may leave the range of both without a word."""
_LINE = 130
"""Width of the caption in characters."""
_MOST_PRESSURE = 0.5
"""Largest pressure plotted, over the largest tension."""
_SHORTEST_ARROWED = 0.05
"""Shortest branch with an arrow, over the size of the axes."""


@dataclass(frozen=True, slots=True)
class Exploration:
    """Options of `uel law`.

    properties  words NAME=VALUE that override those of the deck or of the paper
    deck, elset source of the properties: *UEL PROPERTY in the deck
    element     number of the element type, 2 and 5 standard, 4 and 6 stabilised; None: as in the deck, or U2
    angles      of the separation, from opening (0) to sliding (90 degrees); a curve each
    path        points (normal, tangential) of a path from the origin, instead of the angles
    reach       largest separation of a curve; None: until no traction is left
    unload      fractions of the reach at which to unload to the origin
    close       fraction of the reach by which to close after unloading
    surface     also draw both tractions over both separations
    increments  per curve, or per segment of a path
    duration    step time of a curve, for VISCOSITY and the rate of the separation
    units       of length and traction, for the axes; None: those of the paper, with a deck none
    """

    properties: Sequence[str] = ()
    deck: Path | None = None
    elset: str | None = None
    element: int | None = None
    angles: Sequence[float] = (0.0, 30.0, 60.0, 90.0)
    path: FloatArray | None = None
    reach: float | None = None
    unload: Sequence[float] = ()
    close: float = 0.0
    surface: bool = False
    increments: int = 400
    duration: float = 1.0
    job: str = "law"
    output_dir: Path = Path()
    units: tuple[str, str] | None = None


def explore(options: Exploration) -> tuple[list[LawCurve], list[Path]]:
    """Compute the curves; write JOB.csv, JOB.png and, if requested, JOB_surface.png. Returns curves and files."""
    stem = job_stem(options.job, options.output_dir)
    options.output_dir.mkdir(parents=True, exist_ok=True)
    with locked(stem):
        return _explore(options)


def _properties(options: Exploration) -> tuple[int, dict[str, float]]:
    """Return the element type and the properties by name. Raises UelError."""
    jtype, values = law.STANDARD, law.standard_properties()
    if options.deck is not None:
        jtype, from_deck = law.deck_properties(options.deck, options.elset)
        values |= from_deck
    properties = law.read_properties(options.properties)
    values |= properties
    jtype = options.element or jtype
    law.refuse_ignored(properties, jtype, int(values["LAW"]))
    return jtype, values


def advice(options: Exploration) -> str:
    """Say how far the strengths make the dissipated energy depend on the order of the modes; '' if they hardly do.

    Raises
    ------
    UelError
        The properties are not those of a law.
    """
    _, values = _properties(options)
    if int(values["LAW"]) not in LAWS:
        return ""
    least, most = law.orders_of_modes(values)
    low, high = sorted((values["GIC"], values["GIIC"]))
    if least > (1.0 - NOTICED) * low and most < (1.0 + NOTICED) * high:
        return ""
    ratio = values["ALPHAT"] / values["ALPHAN"] if values["ALPHAN"] else 1.0
    better = values["SIGMAMAX"] * np.sqrt(values["GIIC"] * ratio / values["GIC"])
    alike = (
        "" if alike_in_both_modes(values) else ", and the same parts of the bridging in both modes, keep it between."
    )
    return (
        f"A point that softens in one mode and fails in the other dissipates {least:.3g} to {most:.3g}, beyond GIC = "
        f"{values['GIC']:g} and GIIC = {values['GIIC']:g}. With this SIGMAMAX, TAUMAX = {better:.3g}"
        f"{alike or ' keeps it between.'}"
    )


def _explore(options: Exploration) -> tuple[list[LawCurve], list[Path]]:
    jtype, values = _properties(options)
    caption = f"U{jtype}: " + ", ".join(f"{name}={value:g}" for name, value in law.shown_properties(values, jtype))
    # the paper's values are in mm and MPa
    units = options.units or (("mm", "MPa") if options.deck is None else ("", ""))
    library = usersub.load(None, job=options.job, output_dir=options.output_dir)
    try:

        def curve(label: str, path: FloatArray) -> LawCurve:
            return law.drive(LawElement(library, jtype, values), label, path, options.duration)

        def reach(angle: float) -> float:
            return options.reach or law.reach_of(library, values, angle, options.duration)

        if options.path is None:
            curves = [
                curve(
                    f"{angle:g}°",
                    law.opening(angle, reach(angle), options.increments, options.unload, options.close),
                )
                for angle in options.angles
            ]
        else:
            curves = [curve("path", law.along(options.path, options.increments))]
        files = [options.output_dir / f"{options.job}.csv", options.output_dir / f"{options.job}.png"]
        write_csv(curves, files[0], caption)
        draw_curves(curves, files[1], units, caption)
        if options.surface:
            angles = np.linspace(0.0, 90.0, SURFACE_ANGLES)
            sheets = [curve("", law.opening(angle, reach(angle), SURFACE_SIZES)) for angle in angles]
            files.append(options.output_dir / f"{options.job}_surface.png")
            draw_surface(sheets, files[-1], units, caption)
    finally:
        library.close()
    return curves, files


def path_points(text: str) -> FloatArray:
    """Read points 'NORMAL,TANGENTIAL NORMAL,TANGENTIAL ...', also with semicolons between. Raises UsageError."""
    try:
        points = np.array([[float(value) for value in point.split(",")] for point in text.replace(";", " ").split()])
    except ValueError:
        points = np.zeros(0)
    if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
        raise UsageError(f"'{text}': expected points NORMAL,TANGENTIAL with blanks between them")
    return points


def write_csv(curves: Sequence[LawCurve], path: Path, caption: str) -> None:
    """Write the caption as a comment (#), then a row per increment with the label and columns of its curve."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write(f"# {caption}\r\n")
        writer = csv.writer(file)
        writer.writerow(["CURVE", *curves[0].columns])
        for curve in curves:
            for row in zip(*curve.columns.values(), strict=True):
                writer.writerow([curve.label, *(f"{value:.10g}" for value in row)])


def summary(curves: Sequence[LawCurve]) -> Table:
    """Return the largest tractions, work and dissipation of each curve."""
    table = Table("curve", "max TN", "max TT", "work", "dissipated I", "dissipated II", "spent")
    for curve in curves:
        columns = curve.columns
        peaks = [float(np.abs(columns[name]).max()) for name in ("TN", "TT")]
        ends = [float(columns[name][-1]) for name in ("WORK", "DISSI", "DISSII")]
        table.add_row(curve.label, *_shown(peaks), *_shown(ends), f"{columns['SPENT'][-1]:.5g}")
    return table


def _shown(values: list[float]) -> list[str]:
    """Format values of one kind; round-off relative to the largest is shown as zero."""
    largest = max(map(abs, values))
    return [f"{value if abs(value) > 1e-9 * largest else 0.0:.5g}" for value in values]


def _with_unit(words: str, unit: str) -> str:
    return f"{words} [{unit}]" if unit else words


def draw_curves(curves: Sequence[LawCurve], path: Path, units: tuple[str, str], caption: str = "") -> None:
    """Plot normal traction over opening and tangential traction over sliding, with arrows if a path reverses.

    A pressure much larger than the largest tension is cut off, and its value annotated.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplots(1, 2)
        for axis, name, words in zip(panels, "NT", (("Opening", "Normal"), ("Sliding", "Tangential")), strict=True):
            for number, curve in enumerate(curves):
                colour = COLOURS[number % len(COLOURS)]
                axis.plot(curve.columns[f"SEP{name}"], curve.columns[f"T{name}"], color=colour, label=curve.label)
            axis.set_xlabel(_with_unit(words[0], units[0]))
            axis.set_ylabel(_with_unit(f"{words[1]} traction", units[1]))
            axis.ticklabel_format(axis="x", scilimits=(-2, 3), useMathText=True)
            axis.axhline(0.0, color="0.6", linewidth=0.6, zorder=1)
            if name == "N":
                _cut_pressure(axis, curves)
            for number, curve in enumerate(curves):
                _arrows(axis, curve.columns[f"SEP{name}"], curve.columns[f"T{name}"], COLOURS[number % len(COLOURS)])
        if len(curves) > 1:
            handles, labels = panels[0].get_legend_handles_labels()
            title = "angle of the separation, 0° opening, 90° sliding"
            figure.legend(handles, labels, title=title, loc="outside upper center", ncols=8)
        figure.supxlabel(textwrap.fill(caption, _LINE), fontsize=7, color="0.35")
        figure.savefig(path, dpi=200)


def _cut_pressure(axis: Any, curves: Sequence[LawCurve]) -> None:
    """Limit the axis so that a large pressure does not flatten the tension."""
    tractions = np.concatenate([curve.columns["TN"] for curve in curves])
    lowest, highest = float(tractions.min()), float(tractions.max())
    if highest > 0.0 and lowest < -_MOST_PRESSURE * highest:
        axis.set_ylim(-_MOST_PRESSURE * highest, 1.05 * highest)
        axis.text(0.97, 0.03, f"down to {lowest:.3g}", transform=axis.transAxes, ha="right", fontsize=7, color="0.35")


def _arrows(axis: Any, x: FloatArray, y: FloatArray, colour: str) -> None:
    """Draw an arrow in the middle of each branch between two reversals; none on a monotone curve."""
    scale = np.array([max(float(np.ptp(x)), 1e-300), max(float(np.ptp(y)), 1e-300)])
    steps = np.diff(np.column_stack([x, y]), axis=0) / scale
    moving = np.flatnonzero(np.abs(np.diff(x)) > 0.0)
    reversals = moving[1:][np.diff(np.sign(np.diff(x)[moving])) != 0]
    if not len(reversals):
        return
    bounds = [0, *reversals.tolist(), len(x) - 1]
    for first, last in pairwise(bounds):
        lengths = np.cumsum(np.linalg.norm(steps[first:last], axis=1))
        if len(lengths) and lengths[-1] > _SHORTEST_ARROWED:
            k = first + int(np.searchsorted(lengths, 0.5 * lengths[-1]))
            style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0}
            axis.annotate("", (x[k + 1], y[k + 1]), (x[k], y[k]), arrowprops=style, annotation_clip=True)


def draw_surface(curves: Sequence[LawCurve], path: Path, units: tuple[str, str], caption: str = "") -> None:
    """Plot both tractions over opening and sliding, from one curve per angle, all with the same increments."""
    grids = {name: np.array([curve.columns[name] for curve in curves]) for name in ("SEPN", "SEPT", "TN", "TT")}
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        figure = Figure(figsize=(8.0, 3.8), layout="constrained")
        FigureCanvasAgg(figure)
        for number, (name, word) in enumerate((("TN", "Normal"), ("TT", "Tangential"))):
            axis: Any = figure.add_subplot(1, 2, number + 1, projection="3d")
            axis.plot_surface(
                grids["SEPN"],
                grids["SEPT"],
                grids[name],
                cmap="viridis",
                rcount=len(curves),
                ccount=SURFACE_SIZES,
                edgecolor="k",
                linewidth=0.1,
            )
            axis.set_xlabel(_with_unit("Opening", units[0]))
            axis.set_ylabel(_with_unit("Sliding", units[0]))
            axis.set_title(_with_unit(f"{word} traction", units[1]))
            axis.view_init(elev=28, azim=35)
            # room for the labels with their units
            axis.set_box_aspect(None, zoom=0.9)
            axis.locator_params(nbins=4, axis="x")
            axis.locator_params(nbins=4, axis="y")
        figure.supxlabel(textwrap.fill(caption, _LINE), fontsize=7, color="0.35")
        figure.savefig(path, dpi=200)
