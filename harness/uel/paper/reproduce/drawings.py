# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Geometry, boundary conditions and mesh, drawn from the decks: figures 1, 3, 5, 7, 12, 17 of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from uel.deck import read_deck
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.model.properties import SolidSection, UserProperty
from uel.output.pictures.plots import COLOURS, STYLE

PLAIN = STYLE | {"axes.grid": False, "axes.titlesize": 9}
INTERFACE, SUPPORT, LOAD = COLOURS[1], COLOURS[2], COLOURS[0]
GREYS = ("0.93", "0.80")


@dataclass(frozen=True, slots=True)
class Drawing:
    """Drawing of a deck.

    plies      name and quads (m, 4, 2) of each material
    interface  edges (n, 2, 2) of the bonded interface
    held       places (k, 2) by direction 1, 2 of supports
    moved      place (2,), direction (2,) and size (mm) of each prescribed displacement, one for each entry of the deck
    """

    plies: dict[str, FloatArray]
    interface: FloatArray
    held: dict[int, FloatArray]
    moved: list[tuple[FloatArray, FloatArray, float]]

    @property
    def box(self) -> tuple[FloatArray, FloatArray]:
        """Lower left and upper right corner."""
        points = np.concatenate([quads.reshape(-1, 2) for quads in self.plies.values()])
        return points.min(axis=0), points.max(axis=0)


def read_drawing(deck: Path) -> Drawing:
    """Read a deck of ours: quads, four- or eight-node interface elements, zero and prescribed displacements."""
    model = read_deck(deck)
    place = model.mesh.coordinates[:, :2]
    plies: dict[str, list[FloatArray]] = {}
    edges = np.zeros((0, 2, 2))
    for group in model.groups:
        section = group.section
        if isinstance(section, SolidSection | UserProperty) and section.material is not None:
            plies.setdefault(section.material.name, []).append(place[group.nodes])
        else:
            # the lower edge: nodes 1 and 2 of four, 4 and 3 of eight
            columns = [0, 1] if group.nodes.shape[1] == 4 else [3, 2]
            edges = place[group.nodes[:, columns]]
    return Drawing(
        {name: np.concatenate(quads) for name, quads in plies.items()}, edges, _held(model, place), _moved(model, place)
    )


def _held(model: Model, place: FloatArray) -> dict[int, FloatArray]:
    held: dict[int, list[FloatArray]] = {}
    for boundary in model.boundaries:
        held.setdefault(boundary.dof, []).append(place[boundary.nodes])
    return {dof: np.concatenate(points) for dof, points in held.items()}


def _moved(model: Model, place: FloatArray) -> list[tuple[FloatArray, FloatArray, float]]:
    moved = []
    for boundary in model.steps[0].boundaries:
        if boundary.magnitude:
            direction = np.eye(2)[boundary.dof - 1] * np.sign(boundary.magnitude)
            moved.append((place[boundary.nodes].mean(axis=0), direction, abs(boundary.magnitude)))
    return moved


def draw_domain(deck: Path, path: Path) -> Path:
    """Draw figure 1: the two domains, the interface between them with its normal, the initial crack."""
    drawing = read_drawing(deck)
    with mpl.rc_context(PLAIN):
        figure, (axis,) = _figure((7.0, 2.4), 1)
        _plies(axis, drawing, edges=False)
        low, high = drawing.box
        start, end = drawing.interface[0, 0], drawing.interface[-1, 1]
        axis.plot(*zip(start, end, strict=True), color=INTERFACE, linewidth=2.0)
        axis.plot([low[0], start[0]], [start[1], start[1]], color="k", linewidth=1.0)
        middle = 0.5 * (start + end)
        height = high[1] - low[1]
        arrow = {"arrowstyle": "->", "color": "k"}
        axis.annotate("", (middle[0], middle[1] + 0.28 * height), middle, arrowprops=arrow)
        axis.text(middle[0] + 1.0, middle[1] + 0.24 * height, "n", weight="bold", va="center")
        x = 0.25 * end[0]
        for word, share in (("$\\Omega^{(1)}$", 0.75), ("$\\Omega^{(2)}$", 0.25)):
            axis.text(2.0 * x, low[1] + share * height, word, fontsize=12, va="center")
        axis.text(end[0] * 0.85, start[1] + 0.04 * height, "interface $\\Gamma_*$", color=INTERFACE, ha="center")
        axis.text(0.5 * start[0], start[1] + 0.04 * height, "initial crack", ha="center")
        _name_axes(axis, "heights are not to scale")
        _legend_of_plies(figure, drawing)
        figure.savefig(path, dpi=200)
    return path


def draw_square(decks: Sequence[tuple[str, Path]], path: Path, zoom: tuple[float, float, float] | None) -> Path:
    """Draw figures 3 and 5: squares with supports, prescribed displacement and mesh.

    Parameters
    ----------
    decks
        Title and deck of each square.
    path
        The picture.
    zoom
        x, y and half-width of an inset (mm), or none.
    """
    with mpl.rc_context(PLAIN):
        figure, axes = _figure((3.4 * len(decks), 3.9), len(decks))
        for axis, (title, deck) in zip(axes, decks, strict=True):
            drawing = read_drawing(deck)
            _plies(axis, drawing, edges=True)
            _interface(axis, drawing, 1.6)
            _supports(axis, drawing)
            low, high = drawing.box
            for place, direction, size in drawing.moved:
                _arrow(axis, place, direction, 0.12 * (high[1] - low[1]), f"$\\Delta$ = {size:g} mm")
            axis.set(title=title, xlim=(-0.08, 1.08), ylim=(-0.12, 1.25))
            axis.set_aspect("equal")
            if zoom is not None:
                _inset(axis, drawing, zoom)
            _name_axes(axis)
        _legend_of_plies(figure, drawing)
        figure.savefig(path, dpi=200)
    return path


def _inset(axis: Any, drawing: Drawing, zoom: tuple[float, float, float]) -> None:
    x, y, half = zoom
    inset = axis.inset_axes((0.58, 0.60, 0.36, 0.26))
    _plies(inset, drawing, edges=True)
    _interface(inset, drawing, 1.6)
    inset.set(xlim=(x - half, x + half), ylim=(y - half / 3.0, y + half / 3.0), xticks=[], yticks=[])
    for spine in inset.spines.values():
        spine.set_visible(True)
    axis.indicate_inset_zoom(inset, edgecolor="k")


def draw_beam(deck: Path, path: Path, tip: tuple[float, float]) -> Path:
    """Draw figures 7, 12, 17: the specimen with supports and displacements, and the mesh near the crack's tip.

    Parameters
    ----------
    deck, path
        Deck and picture.
    tip
        Range of X1 of the lower drawing (mm), which is to scale.
    """
    drawing = read_drawing(deck)
    low, high = drawing.box
    with mpl.rc_context(PLAIN):
        figure, axes = _figure((7.0, 4.2), 2, vertical=True)
        whole, near = axes
        _plies(whole, drawing, edges=False)
        _interface(whole, drawing, 2.0)
        start = drawing.interface[0, 0]
        whole.plot([low[0], start[0]], [start[1], start[1]], color="k", linewidth=1.0)
        _supports(whole, drawing)
        height = high[1] - low[1]
        for place, direction, size in drawing.moved:
            _arrow(whole, place, direction, 0.5 * height, f"$\\Delta$ = {size:g} mm")
        _measure(whole, (low[0], start[0]), start[1] - 0.16 * height, f"$a_0$ = {start[0]:g} mm")
        _measure(whole, (low[0], high[0]), low[1] - 0.85 * height, f"L = {high[0] - low[0]:g} mm")
        margin = 0.04 * (high[0] - low[0])
        whole.set(
            xlim=(low[0] - margin, high[0] + 2.0 * margin), ylim=(low[1] - 1.45 * height, high[1] + 0.95 * height)
        )
        whole.set_title(f"H = {height:g} mm; heights are not to scale")
        _plies(near, drawing, edges=True)
        _interface(near, drawing, 2.0)
        near.set(xlim=tip, ylim=(low[1], high[1]), title="mesh at the crack's tip, to scale")
        near.set_aspect("equal")
        for axis in axes:
            _name_axes(axis)
        _legend_of_plies(figure, drawing)
        figure.savefig(path, dpi=200)
    return path


def _figure(size: tuple[float, float], panels: int, *, vertical: bool = False) -> tuple[Figure, list[Any]]:
    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    rows, columns = (panels, 1) if vertical else (1, panels)
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)


def _plies(axis: Any, drawing: Drawing, *, edges: bool) -> None:
    for grey, quads in zip(GREYS, drawing.plies.values(), strict=False):
        line: dict[str, Any] = (
            {"edgecolors": "0.35", "linewidths": 0.4} if edges else {"edgecolors": "face", "linewidths": 0.2}
        )
        axis.add_collection(PolyCollection(list(quads), facecolors=grey, **line))
    axis.autoscale_view()


def _interface(axis: Any, drawing: Drawing, width: float) -> None:
    axis.add_collection(LineCollection(list(drawing.interface), colors=INTERFACE, linewidths=width, zorder=3))


def _supports(axis: Any, drawing: Drawing) -> None:
    markers = {1: (">", "u1 = 0"), 2: ("^", "u2 = 0")}
    for dof, points in drawing.held.items():
        marker, label = markers[dof]
        fill = SUPPORT if dof == 2 else "none"
        axis.plot(*points.T, marker, color=SUPPORT, markerfacecolor=fill, markersize=6, label=label, clip_on=False)


def _arrow(axis: Any, place: FloatArray, direction: FloatArray, length: float, label: str) -> None:
    """Draw an arrow from `place` in the direction of the displacement; one that presses ends at the place."""
    outward = place + direction * length
    low, high = axis.dataLim.intervaly
    pressing = (place[1] - 0.5 * (low + high)) * direction[1] < 0.0
    begin, end = (place - direction * length, place) if pressing else (place, outward)
    axis.annotate("", end, begin, arrowprops={"arrowstyle": "-|>", "color": LOAD, "linewidth": 1.6}, zorder=5)
    far = begin if pressing else end
    axis.annotate(label, far, (6, 0), textcoords="offset points", color=LOAD, va="center", zorder=5)


def _measure(axis: Any, ends: tuple[float, float], y: float, label: str) -> None:
    axis.annotate("", (ends[0], y), (ends[1], y), arrowprops={"arrowstyle": "<->", "color": "0.3", "linewidth": 0.8})
    axis.annotate(label, (0.5 * sum(ends), y), (0, -3), textcoords="offset points", ha="center", va="top")


def _name_axes(axis: Any, note: str = "") -> None:
    axis.set_xlabel("$X_1$ [mm]" + (f"   ({note})" if note else ""))
    axis.set_ylabel("$X_2$ [mm]")


def _legend_of_plies(figure: Figure, drawing: Drawing) -> None:
    names = {"PLY_0": "0° ply", "PLY_90": "90° ply"}
    handles: list[Any] = [
        mpl.patches.Patch(facecolor=grey, edgecolor="0.35", label=names.get(name, name))
        for grey, name in zip(GREYS, drawing.plies, strict=False)
    ]
    handles.append(mpl.lines.Line2D([], [], color=INTERFACE, linewidth=2.0, label="cohesive interface"))
    seen: dict[str, Any] = {}
    for axis in figure.axes:
        seen |= {label: handle for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    figure.legend(handles=handles + list(seen.values()), loc="outside upper center", ncols=5)
