# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fronts of delaminations in space (NAME_front.csv): where the damage of an interface is one half, and what acts there.

Computed from the field output and the interface profiles of a job, whatever its interface elements. Values at the
nodes are means of those of their elements, extrapolated from the integration points. A front is a line of constant
damage on that surface, given by the middles of equal parts about as long as the elements. Surfaces that share no node
are separate; each is projected on its mean plane.

Energy release rates are Rice's integral along a line through the process zone, normal to the front:
G_i = -int t_i dw_i, i = I for the normal, II and III for the shears normal to the front and along it. t is the
traction, and w the separation of the law, or the displacement jump if an element has no other. While the delamination
grows, their sum is the fracture energy of the law at this mode mix; before, it is the energy release rate at a crack
whose process zone is forming. What lies beyond the edge of the interface, such as an initial crack, has no traction.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import meshio
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.tri import LinearTriInterpolator, Triangulation
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from harness.errors import UelError
from harness.model.arrays import FloatArray, IntArray
from harness.output.formats import TextFile
from harness.output.plots import COLOURS, STYLE
from harness.output.results import Result

DAMAGE = 0.5
"""Of the front."""

_ALIGNED = np.cos(np.radians(0.1))
"""Abaqus takes the z axis for the local direction s where the normal is within 0.1 degrees of the x axis."""

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])

_SAMPLES = 6
"""Of the process zone, for each element length."""

_HALVINGS = 20
"""Of a distance of samples, to find the edge of the surface."""


@dataclass(frozen=True, slots=True)
class Front:
    """One line of one surface in one increment.

    step, increment, time  when; total time
    surface, line          numbers from 1, of the surfaces of a model and of the lines on one of them
    places     (n, 3) points of the front, in order
    ahead      (n, 3) unit normals of the front in the surface, towards smaller damage
    tractions  (n, 3) normal, shear along `ahead`, shear along the front
    releases   (n, 3) G_I, G_II, G_III (energy/area)
    """

    step: int
    increment: int
    time: float
    surface: int
    line: int
    places: FloatArray
    ahead: FloatArray
    tractions: FloatArray
    releases: FloatArray


class _Surface:
    """Interface elements that share nodes, as triangles in their mean plane.

    Parameters
    ----------
    points
        (n, 3) coordinates of the nodes of the model.
    cells
        (m, 4) nodes of the faces.
    elements
        (m,) labels.
    """

    def __init__(self, points: FloatArray, cells: IntArray, elements: IntArray) -> None:
        used, numbers = np.unique(cells, return_inverse=True)
        self.elements = elements
        self._cells = numbers.reshape(cells.shape)
        self._points = points[used]
        corners = self._points[self._cells]
        diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
        areas = np.cross(*diagonals)
        self.size = float(np.sqrt(np.median(np.linalg.norm(areas, axis=1)) / 2.0))
        normal = areas.sum(axis=0) / np.linalg.norm(areas.sum(axis=0))
        first = np.array([0.0, 0.0, 1.0]) if abs(normal[0]) > _ALIGNED else np.array([1.0, 0.0, 0.0])
        first -= (first @ normal) * normal
        first /= np.linalg.norm(first)
        # local directions s and t of the tractions
        self.axes = np.stack([first, np.cross(normal, first)])
        plane = self._points @ self.axes.T
        centres = corners.mean(axis=1)
        # a node in the middle of each face: the triangles prefer no diagonal
        middle = len(plane) + np.arange(len(cells))
        triangles = [np.column_stack([self._cells[:, k], self._cells[:, (k + 1) % 4], middle]) for k in range(4)]
        self.nodes = np.concatenate([self._points, centres])
        plane = np.concatenate([plane, centres @ self.axes.T])
        self.triangulation = Triangulation(plane[:, 0], plane[:, 1], np.concatenate(triangles))
        self._to_corners: tuple[IntArray, FloatArray] | None = None

    def at_nodes(self, places: FloatArray, values: FloatArray) -> FloatArray:
        """(n, k) values at the nodes from those at the integration points (m, 4, k) at `places` (m, 4, 3)."""
        if self._to_corners is None:
            corners = self._points[self._cells]
            nearest = np.argmin(np.linalg.norm(corners[:, :, None] - places[:, None], axis=-1), axis=2)
            centres = corners.mean(axis=1, keepdims=True)
            reach = np.linalg.norm(places - centres, axis=-1).mean() / np.linalg.norm(corners - centres, axis=-1).mean()
            # bilinear functions of the points, at the corners
            shares = 0.25 * np.prod(1.0 + _CORNERS[:, None] * _CORNERS / reach, axis=-1)
            self._to_corners = nearest, shares
        nearest, shares = self._to_corners
        ordered = np.take_along_axis(values, nearest[..., None], axis=1)
        sums = np.zeros((len(self._points), values.shape[-1]))
        np.add.at(sums, self._cells, shares @ ordered)
        mean = sums / np.bincount(self._cells.ravel())[:, None]
        return np.concatenate([mean, values.mean(axis=1)])


def fronts(result: Result, damage: float = DAMAGE) -> list[Front]:
    """Fronts of all increments of the field output, in order; none in an increment without such a damage.

    Parameters
    ----------
    result
        Of a job with interface elements in space.
    damage
        Of the front.

    Raises
    ------
    UelError
        The job has no field output, or no interface elements that are surfaces and have a damage.
    """
    frames = result.frames
    if not frames:
        raise UelError(f"{result.file('.pvd')}: no field output, from which the front is computed")
    surfaces = _surfaces(result.mesh(frames[0].increment, frames[0].step))
    if not surfaces:
        raise UelError(
            f"{result.file('.pvd')}: no interface elements in space with a damage; "
            "a front is a line on a surface of interface elements with four nodes on a face"
        )
    profiles = {(int(profile["step"][0]), int(profile["increment"][0])): profile for profile in result.interfaces()}
    found: list[Front] = []
    for frame in frames:
        # a killed run may lack the last profile
        profile = profiles.get((frame.step, frame.increment))
        if profile is None:
            continue
        for number, surface in enumerate(surfaces, 1):
            nodal = _nodal(surface, profile)
            lines = _lines(surface, nodal["DAMAGE"], damage)
            for line, (front, reach) in enumerate(
                zip(lines, _reaches(surface, nodal["DAMAGE"], lines), strict=True), 1
            ):
                places, ahead, tractions, releases = _along(surface, nodal, front, reach)
                found.append(
                    Front(frame.step, frame.increment, frame.time, number, line, places, ahead, tractions, releases)
                )
    return found


def write_fronts(path: Path, found: list[Front]) -> None:
    """Write NAME_front.csv: a row for each point of each front, with the ratio (G_II + G_III)/G as MIX."""
    names = ("X", "Y", "Z", "AHEADX", "AHEADY", "AHEADZ", "TN", "TII", "TIII", "GI", "GII", "GIII", "MIX")
    file = TextFile(path)
    file.write(",".join(["step,increment,time,surface,line,point", *names]) + "\n")
    for front in found:
        total = front.releases.sum(axis=1)
        shear = front.releases[:, 1:].sum(axis=1)
        mix = np.divide(shear, total, out=np.zeros_like(total), where=total > 0.0)
        rows = np.column_stack([front.places, front.ahead, front.tractions, front.releases, mix])
        head = f"{front.step},{front.increment},{front.time!r},{front.surface},{front.line}"
        for point, row in enumerate(rows.tolist(), 1):
            file.write(f"{head},{point}," + ",".join(f"{value:.9g}" for value in row) + "\n")
    file.close()


def draw_fronts(path: Path, found: list[Front]) -> None:
    """Draw the fronts of all increments, coloured by time, and G with its parts along those of the last one.

    Raises
    ------
    UelError
        There is no front.
    """
    if not found:
        raise UelError(f"{path}: no front to draw: the damage of no increment reaches that of the front")
    last = [front for front in found if (front.step, front.increment) == (found[-1].step, found[-1].increment)]
    places = np.concatenate([front.places for front in found])
    # the two directions in which the surface extends most
    first, second = sorted(np.argsort(np.ptp(places, axis=0))[1:])
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5.5, 6.4), layout="constrained")
        FigureCanvasAgg(figure)
        above, below = figure.subplots(2, 1)
        lines = LineCollection(
            [front.places[:, [first, second]] for front in found],
            array=np.array([front.time for front in found]),
            linewidths=1.2,
        )
        above.add_collection(lines)
        above.autoscale_view()
        above.set(xlabel="XYZ"[first], ylabel="XYZ"[second], aspect="equal", adjustable="datalim")
        figure.colorbar(lines, ax=above, label="Time")
        for k, front in enumerate(last):
            arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(front.places, axis=0), axis=1))])
            for name, colour, values in zip(("I", "II", "III"), COLOURS, front.releases.T, strict=False):
                below.plot(arc, values, color=colour, label=None if k else f"$G_{{{name}}}$")
            below.plot(arc, front.releases.sum(axis=1), color="0.35", linestyle="--", label=None if k else "$G$")
        below.set(xlabel=f"Length along the front at time {last[0].time:g}", ylabel="Energy release rate")
        below.set_ylim(bottom=min(0.0, below.get_ylim()[0]))
        figure.legend(ncols=4, loc="outside lower center")
        figure.savefig(path, dpi=200)


def _surfaces(mesh: meshio.Mesh) -> list[_Surface]:
    """Surfaces of interface elements with a damage, in the order of their first elements."""
    cells, labels = [], []
    damage = mesh.cell_data.get("DAMAGE", [])
    for block, values, names in zip(mesh.cells, damage, mesh.cell_data["ELEMENT"], strict=False):
        if block.type == "quad" and np.isfinite(values).all():
            cells.append(block.data)
            labels.append(names)
    if not cells:
        return []
    faces, elements = np.concatenate(cells), np.concatenate(labels)
    rows = np.repeat(np.arange(len(faces)), 4)
    shape = (len(faces), len(mesh.points))
    touching = coo_array((np.ones(rows.size), (rows, faces.ravel())), shape=shape).tocsr()
    count, member = connected_components(touching @ touching.T, directed=False)
    return [_Surface(mesh.points, faces[member == k], elements[member == k]) for k in range(count)]


def _nodal(surface: _Surface, profile: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Damage (n,), tractions (n, 3) and separations (n, 3), components along n, s, t, at the nodes of a surface."""
    order = np.lexsort((profile["point"], profile["element"]))
    labels = profile["element"][order].astype(np.int64)
    rows = order[np.isin(labels, surface.elements)]
    sorted_labels = np.sort(surface.elements)
    back = np.argsort(np.argsort(surface.elements))
    count = len(rows) // len(sorted_labels)

    def gather(*names: str) -> FloatArray:
        stacked = np.stack([profile[name][rows] for name in names], axis=-1)
        return stacked.reshape(len(sorted_labels), count, len(names))[back]

    places = gather("X", "Y", "Z")
    separation = "W" if "WN" in profile and np.isfinite(profile["WN"][rows]).all() else "SEP"
    values = np.concatenate(
        [gather("DAMAGE"), gather("TN", "TS", "TT"), gather(*(f"{separation}{axis}" for axis in "NST"))], axis=-1
    )
    nodal = surface.at_nodes(places, values)
    return {"DAMAGE": np.clip(nodal[:, 0], 0.0, 1.0), "T": nodal[:, 1:4], "W": nodal[:, 4:7]}


def _lines(surface: _Surface, damage: FloatArray, level: float) -> list[FloatArray]:
    """Lines (n, 2) of a damage in the plane of a surface, as points at the distance of the elements."""
    if not damage.min() < level < damage.max():
        return []
    contours = Figure().subplots().tricontour(surface.triangulation, damage, [level])
    return [
        _even(line, surface.size)
        for line in contours.allsegs[0]
        if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() > surface.size
    ]


def _even(line: FloatArray, distance: float) -> FloatArray:
    """Middles of at least three equal parts of the line, about `distance` long: its ends lie on edges."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    parts = max(3, round(arc[-1] / distance))
    at = arc[-1] * (np.arange(parts) + 0.5) / parts
    return np.stack([np.interp(at, arc, values) for values in line.T], axis=-1)


def _along(
    surface: _Surface, nodal: Mapping[str, FloatArray], line: FloatArray, reach: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Places, normals, tractions and energy release rates of a front, as in `Front`."""
    triangulation = surface.triangulation

    def at(values: FloatArray, where: FloatArray) -> FloatArray:
        found = LinearTriInterpolator(triangulation, values)(where[..., 0], where[..., 1])
        return np.asarray(np.ma.filled(found, np.nan))

    tangent = _tangents(line)
    ahead = np.stack([tangent[:, 1], -tangent[:, 0]], axis=-1)
    # the side on which the damage is smaller
    step = 0.5 * surface.size * ahead
    slope = np.nan_to_num(at(nodal["DAMAGE"], line + step), nan=1.0)
    slope -= np.nan_to_num(at(nodal["DAMAGE"], line - step), nan=1.0)
    ahead = ahead * (-1.0 if np.sum(slope) > 0.0 else 1.0)
    tangent = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)

    offsets = np.linspace(-reach, reach, 1 + 2 * max(1, round(_SAMPLES * reach / surface.size)))
    where = _to_edges(triangulation, line[:, None] + offsets[:, None] * ahead[:, None])
    traction = np.stack([np.nan_to_num(at(values, where)) for values in nodal["T"].T], axis=-1)
    opening = np.stack([at(values, where) for values in nodal["W"].T], axis=-1)
    traction, opening = (_turned(values, ahead[:, None], tangent[:, None]) for values in (traction, opening))
    mean = 0.5 * (traction[:, 1:] + traction[:, :-1])
    # steps beyond the edge of the surface count nothing
    releases = -np.nansum(mean * np.diff(opening, axis=1), axis=1)
    middle = np.stack([np.nan_to_num(at(values, line)) for values in nodal["T"].T], axis=-1)
    places = np.stack([at(values, line) for values in surface.nodes.T], axis=-1)
    return places, ahead @ surface.axes, _turned(middle, ahead, tangent), releases


def _to_edges(triangulation: Triangulation, where: FloatArray) -> FloatArray:
    """Points of lines (n, m, 2), those beside an edge of the surface moved to it, whose last step would be lost."""
    finder = triangulation.get_trifinder()

    def on(places: FloatArray) -> NDArray[np.bool_]:
        return np.asarray(finder(places[..., 0], places[..., 1])) >= 0

    inside = on(where)
    moved = where.copy()
    for step in (1, -1):
        outer, inner = (slice(None, -1), slice(1, None))[::step]
        rows, columns = np.nonzero(~inside[:, outer] & inside[:, inner])
        places = np.arange(where.shape[1])
        beyond, within = where[rows, places[outer][columns]], where[rows, places[inner][columns]]
        for _ in range(_HALVINGS):
            middle = 0.5 * (beyond + within)
            found = on(middle)[:, None]
            beyond, within = np.where(found, beyond, middle), np.where(found, middle, within)
        moved[rows, places[outer][columns]] = within
    return moved


def _turned(values: FloatArray, ahead: FloatArray, tangent: FloatArray) -> FloatArray:
    """Components along n, s, t as normal, ahead of the front and along it."""
    shear = values[..., 1:]
    return np.stack([values[..., 0], np.sum(shear * ahead, axis=-1), np.sum(shear * tangent, axis=-1)], axis=-1)


def _tangents(line: FloatArray) -> FloatArray:
    """Unit tangents (n, 2) between the second neighbours."""
    index = np.arange(len(line))
    chords = line[np.minimum(index + 2, len(line) - 1)] - line[np.maximum(index - 2, 0)]
    return np.asarray(chords / np.linalg.norm(chords, axis=1)[:, None])


def _reaches(surface: _Surface, damage: FloatArray, lines: list[FloatArray]) -> list[float]:
    """Half the length of the lines through the process zone of each front.

    It holds all that is damaged in part and closer to this front than to others, and three faces.
    """
    if not lines:
        return []
    partly = (damage > 1e-3) & (damage < 1.0 - 1e-3)
    plane = np.column_stack([surface.triangulation.x, surface.triangulation.y])[partly]
    # a front passes between nodes, which may all be undamaged or failed
    distances = np.stack([cKDTree(line).query(plane)[0] for line in lines])
    closest = np.argmin(distances, axis=0)
    spreads = [np.append(0.0, distances[k, closest == k]).max() for k in range(len(lines))]
    return [float(spread) + 3.0 * surface.size for spread in spreads]
