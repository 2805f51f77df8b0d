# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tips of delaminations in the plane (NAME_front.csv): places of damage 1/2, their growth, energy release rates.

The damage is SPENT, the dissipated share of the fracture energy, or DAMAGE if an element has no other. Values are those
of the integration points; between them they are linear.

The energy release rates are Rice's integral along the interface, from half-way to the next tip on one side to half-way
on the other, G_i = -int t_i dw_i along the direction of growth: I for the normal, II for the shear. t is the traction
and w the separation of the law, or the displacement jump if an element has no other.

The rate is the growth of a tip over the time since its last place. From the step FATIGUE on, time is the number of
cycles, and the rate is da/dN.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import meshio
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray
from uel.output.formats import write_numbers
from uel.output.pictures.interface_parts import parts
from uel.output.pictures.plots import COLOURS, STYLE
from uel.output.results import Result

NAMES = ("X", "Y", "AHEADX", "AHEADY", "LENGTH", "RATE", "TN", "TII", "GI", "GII", "MIX")


@dataclass(frozen=True, slots=True)
class Tip:
    """Tip of a delamination in one increment.

    step, increment, time  step, increment, total time
    line, number   numbers from 1 of the interface in the model, and of the tip on it, from the interface's beginning
    place      (2,) coordinates
    ahead      (2,) unit vector along the interface, towards smaller damage
    length     of the interface behind the tip, as far as the next tip or the end
    rate       growth of the length over the time since the last increment; NaN in the first
    traction   (2,) normal, shear along `ahead`
    release    (2,) G_I, G_II (energy/area)
    """

    step: int
    increment: int
    time: float
    line: int
    number: int
    place: FloatArray
    ahead: FloatArray
    length: float
    rate: float
    traction: FloatArray
    release: FloatArray


class _Line:
    """Interface elements that share nodes, in order along the interface.

    Parameters
    ----------
    points
        (n, 2) coordinates of the nodes of the model.
    cells
        (m, 2) end nodes of the elements.
    elements
        (m,) labels.
    """

    def __init__(self, points: FloatArray, cells: IntArray, elements: IntArray) -> None:
        nodes, number = np.unique(cells, return_inverse=True)
        number = number.reshape(cells.shape)
        count = len(nodes)
        ends = np.flatnonzero(np.bincount(number.ravel()) == 1)
        # a closed interface begins at its first element
        start = min(ends, key=lambda k: tuple(points[nodes[k]]), default=int(number[0, 0]))
        graph = coo_array((np.ones(len(cells)), (number[:, 0], number[:, 1])), shape=(count, count)).tocsr()
        order, _ = breadth_first_order(graph, start, directed=False)
        rank = np.argsort(order)
        # an element comes where its first node does
        first = np.argsort(np.sort(rank[number], axis=1)[:, 0], kind="stable")
        self.elements = elements[first]
        ordered = np.take_along_axis(nodes[number], np.argsort(rank[number], axis=1), axis=1)[first]
        # 1 where the tangent of an element, from its first node to its second, is along the line
        self.senses = np.where(ordered[:, 0] == cells[first, 0], 1.0, -1.0)
        self.origins = points[ordered[:, 0]]
        chords = points[ordered[:, 1]] - self.origins
        self.sizes = np.linalg.norm(chords, axis=1)
        self.directions = chords / self.sizes[:, None]
        self.before = np.concatenate([[0.0], np.cumsum(self.sizes)[:-1]])
        self.length = float(self.sizes.sum())

    def profile(self, profile: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Read the integration points along the interface: arc, damage, traction and separation (normal, along it)."""
        position = {int(label): k for k, label in enumerate(self.elements)}
        rows = np.array([k for k, label in enumerate(profile["element"]) if int(label) in position])
        own = np.array([position[int(label)] for label in profile["element"][rows]])
        places = np.column_stack([profile["X"][rows], profile["Y"][rows]])
        arc = self.before[own] + np.sum((places - self.origins[own]) * self.directions[own], axis=1)
        order = np.argsort(arc, kind="stable")

        def known(name: str) -> bool:
            return name in profile and bool(np.isfinite(profile[name][rows]).all())

        damage, separation = "SPENT" if known("SPENT") else "DAMAGE", "W" if known("WN") else "SEP"
        senses = np.column_stack([np.ones(len(own)), self.senses[own]])[order]
        traction, opening = (
            senses * np.column_stack([profile[f"{letter}{name}"][rows][order] for name in ("N", "T")])
            for letter in ("T", separation)
        )
        return arc[order], profile[damage][rows][order], traction, opening

    def at(self, arc: float) -> tuple[FloatArray, FloatArray]:
        """Return the place at an arc length and the tangent there."""
        k = int(np.clip(np.searchsorted(self.before, arc, side="right") - 1, 0, len(self.before) - 1))
        return self.origins[k] + (arc - self.before[k]) * self.directions[k], self.directions[k]


def are_lines(result: Result) -> bool:
    """Tell whether a job has interface elements in the plane that have a damage, and field output of them."""
    frames = result.frames
    return bool(frames) and bool(_lines(result.mesh(frames[0].increment, frames[0].step)))


def tips(result: Result, damage: float) -> list[Tip]:
    """Return the tips of all increments of the field output, in order.

    Parameters
    ----------
    result
        Result of a job with interface elements in the plane.
    damage
        Value of the damage at the tip.

    Raises
    ------
    UelError
        The job has no interface elements in the plane that have a damage.
    """
    frames = result.frames
    lines = _lines(result.mesh(frames[0].increment, frames[0].step)) if frames else []
    if not lines:
        raise UelError(f"{result.file('.pvd')}: no field output of interface elements in the plane with a damage")
    profiles = {(int(profile["step"][0]), int(profile["increment"][0])): profile for profile in result.interfaces()}
    found: list[Tip] = []
    last: dict[tuple[int, int], tuple[float, float]] = {}
    for frame in frames:
        # a killed run may lack the last profile
        profile = profiles.get((frame.step, frame.increment))
        if profile is None:
            continue
        for line, interface in enumerate(lines, 1):
            for number, (arc, sign, length, traction, release) in enumerate(_crossings(interface, profile, damage), 1):
                place, tangent = interface.at(arc)
                time, before = last.get((line, number), (frame.time, length))
                rate = (length - before) / (frame.time - time) if frame.time > time else np.nan
                last[line, number] = frame.time, length
                found.append(
                    Tip(
                        frame.step,
                        frame.increment,
                        frame.time,
                        line,
                        number,
                        place,
                        sign * tangent,
                        length,
                        rate,
                        traction * [1.0, sign],
                        release,
                    )
                )
    return found


def write_tips(path: Path, all_tips: list[Tip]) -> None:
    """Write NAME_front.csv: a row for each tip, with the ratio G_II/G as MIX."""
    rows = []
    for tip in all_tips:
        total = float(tip.release.sum())
        mix = float(tip.release[1]) / total if total > 0.0 else 0.0
        values = [*tip.place, *tip.ahead, tip.length, tip.rate, *tip.traction, *tip.release, mix]
        rows.append(((tip.step, tip.increment, tip.time, tip.line, tip.number), values))
    write_numbers(path, ["step", "increment", "time", "line", "tip", *NAMES], rows)


def draw_tips(path: Path, all_tips: list[Tip]) -> None:
    """Draw the damaged length over time, and G with its parts over the length.

    Raises
    ------
    UelError
        There is no tip.
    """
    if not all_tips:
        raise UelError(f"{path}: no front to draw: the damage of no increment reaches that of the front")
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5.5, 6.4), layout="constrained")
        FigureCanvasAgg(figure)
        above, below = figure.subplots(2, 1)
        for number, key in enumerate(sorted({(tip.line, tip.number) for tip in all_tips})):
            mine = [tip for tip in all_tips if (tip.line, tip.number) == key]
            length = [tip.length for tip in mine]
            colour = COLOURS[number % len(COLOURS)]
            above.plot([tip.time for tip in mine], length, color=colour, label=f"tip {number + 1}")
            release = np.array([tip.release for tip in mine])
            for name, colour, values in zip(("I", "II"), COLOURS, release.T, strict=False):
                below.plot(length, values, color=colour, label=None if number else f"$G_{{{name}}}$")
            below.plot(length, release.sum(axis=1), color="0.35", linestyle="--", label=None if number else "$G$")
        above.set(xlabel="Time", ylabel="Damaged length")
        below.set(xlabel="Damaged length", ylabel="Energy release rate")
        below.set_ylim(bottom=min(0.0, below.get_ylim()[0]))
        below.legend(ncols=3)
        if len({(tip.line, tip.number) for tip in all_tips}) > 1:
            above.legend()
        figure.savefig(path, dpi=200)


def _lines(mesh: meshio.Mesh) -> list[_Line]:
    """Return the interfaces with a damage, in the order of their first elements."""
    cells, labels = [], []
    damage = mesh.cell_data.get("DAMAGE", [])
    for block, values, names in zip(mesh.cells, damage, mesh.cell_data.get("ELEMENT", []), strict=False):
        if block.type in ("line", "line3") and np.isfinite(values).all():
            cells.append(block.data[:, :2])
            labels.append(names)
    if not cells:
        return []
    edges, elements = np.concatenate(cells), np.concatenate(labels)
    points = mesh.points[:, :2]
    return [_Line(points, edges[part], elements[part]) for part in parts(edges, len(points))]


def _crossings(
    line: _Line, profile: Mapping[str, FloatArray], level: float
) -> Iterator[tuple[float, float, float, FloatArray, FloatArray]]:
    """Yield each tip: arc length, 1 where growth is along the line and -1 against it, damaged length, traction, G."""
    arc, damage, traction, opening = line.profile(profile)
    beyond = damage > level
    places = np.flatnonzero(beyond[1:] != beyond[:-1])
    if not places.size:
        return
    shares = (level - damage[places]) / (damage[places + 1] - damage[places])
    tips_at = arc[places] + shares * (arc[places + 1] - arc[places])
    bounds = np.concatenate([[0.0], tips_at, [line.length]])
    # half-way to the next tip
    limits = np.concatenate([[-np.inf], 0.5 * (tips_at[1:] + tips_at[:-1]), [np.inf]])
    for number, (place, share, (low, high)) in enumerate(zip(tips_at, shares, pairwise(limits), strict=True)):
        k = places[number]
        forward = bool(damage[k + 1] < damage[k])
        near = np.flatnonzero((arc >= low) & (arc <= high))
        mean = 0.5 * (traction[near[1:]] + traction[near[:-1]])
        release = np.sum(mean * np.diff(opening[near], axis=0), axis=0)
        length = place - bounds[number] if forward else bounds[number + 2] - place
        at_tip = traction[k] + share * (traction[k + 1] - traction[k])
        yield float(place), 1.0 if forward else -1.0, float(length), at_tip, -release if forward else release
