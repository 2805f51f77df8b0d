# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fronts of delaminations in space (NAME_front.csv): lines of damage 1/2, with tractions and energy release rates.

The damage is SPENT, the dissipated share of the fracture energy, or DAMAGE if an element has no other.

Computed from the field output and the interface profiles of a job, whatever its interface elements. Values at the
nodes are means over their elements, extrapolated from the integration points. A front is a line of constant damage on
the surface, sampled at the midpoints of equal parts about as long as the elements. Surfaces that share no node are
separate; they may be curved.

Energy release rates are Rice's integral along a line through the process zone, in the plane normal to the front:
G_i = -int t_i dw_i, i = I for the normal, II and III for the shears normal to the front and along it. t is the
traction, and w the separation of the law, or the displacement jump if an element has no other. While the delamination
grows, their sum is the fracture energy of the law at this mode mix; before, it is the energy release rate of a crack
whose process zone is forming. Beyond the edge of the interface, as in an initial crack, tractions are zero.

The rate is the growth along `ahead` since the last increment with a front of that line, over the time since then. From
the step FATIGUE on, time is the number of cycles, and the rate is da/dN.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from scipy.spatial import cKDTree

from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray
from uel.output.formats import write_numbers
from uel.output.pictures.interface_surface import Fields, InterfaceSurface, interface_surfaces
from uel.output.pictures.plots import COLOURS, STYLE
from uel.output.pictures.triangles import Locations, SurfacePaths, TriangulatedSurface
from uel.output.results import Result

DAMAGE = 0.5
"""Damage at the front."""

NAMES = ("X", "Y", "Z", "AHEADX", "AHEADY", "AHEADZ", "TN", "TII", "TIII", "GI", "GII", "GIII", "MIX", "RATE")
"""Columns of the table."""

_FLAT = 0.05
"""Extent of fronts normal to a plane, over that in it, up to which they are drawn in the plane."""


@dataclass(frozen=True, slots=True)
class Front:
    """Front on one surface in one increment.

    step, increment, time  step, increment, total time
    surface, line          numbers from 1 of the surface in the model, and of the line on it
    coordinates  (n, 3) of points of the front, in order
    ahead      (n, 3) unit normals of the front in the surface, towards smaller damage
    tractions  (n, 3) normal, shear along `ahead`, shear along the front
    releases   (n, 3) G_I, G_II, G_III (energy/area)
    rate       (n,) growth over the time since the line before; NaN without one, or where it is not behind
    """

    step: int
    increment: int
    time: float
    surface: int
    line: int
    coordinates: FloatArray
    ahead: FloatArray
    tractions: FloatArray
    releases: FloatArray
    rate: FloatArray


def fronts(result: Result, damage: float = DAMAGE) -> list[Front]:
    """Return the fronts of all increments of the field output, in order.

    Parameters
    ----------
    result
        Result of a job with interface elements in space.
    damage
        Value of the damage on the front.

    Raises
    ------
    UelError
        The job has no field output, or no interface elements that are surfaces and have a damage.
    """
    frames = result.frames
    if not frames:
        raise UelError(f"{result.file('.pvd')}: no field output, from which the front is computed")
    surfaces = interface_surfaces(result.mesh(frames[0].increment, frames[0].step))
    if not surfaces:
        raise UelError(
            f"{result.file('.pvd')}: no interface elements with a damage; "
            "a front is a line on a surface of interface elements in space"
        )
    profiles = {(int(profile["step"][0]), int(profile["increment"][0])): profile for profile in result.interfaces()}
    all_fronts: list[Front] = []
    last: dict[tuple[int, int], Front] = {}
    for frame in frames:
        # a killed run may lack the last profile
        profile = profiles.get((frame.step, frame.increment))
        if profile is None:
            continue
        for number, surface in enumerate(surfaces, 1):
            fields = surface.fields(profile)
            lines = _lines(surface, fields.damage, damage)
            reaches = _half_lengths(surface, fields.damage, [locations for locations, _ in lines])
            for line, ((locations, triangles), reach) in enumerate(zip(lines, reaches, strict=True), 1):
                points, ahead, *values = _along(surface, fields, locations, triangles, reach)
                before = last.get((number, line))
                rate = np.full(len(points), np.nan)
                if before is not None and frame.time > before.time:
                    rate = _growth(points, ahead, before.coordinates) / (frame.time - before.time)
                front = Front(
                    frame.step, frame.increment, frame.time, number, line, points, ahead, values[0], values[1], rate
                )
                last[number, line] = front
                all_fronts.append(front)
    return all_fronts


def write_fronts(path: Path, all_fronts: list[Front]) -> None:
    """Write NAME_front.csv: a row for each point of each front, with the ratio (G_II + G_III)/G as MIX."""
    rows = []
    for front in all_fronts:
        total = front.releases.sum(axis=1)
        shear = front.releases[:, 1:].sum(axis=1)
        mix = np.divide(shear, total, out=np.zeros_like(total), where=total > 0.0)
        values = np.column_stack([front.coordinates, front.ahead, front.tractions, front.releases, mix, front.rate])
        head = front.step, front.increment, front.time, front.surface, front.line
        rows += [((*head, point), row) for point, row in enumerate(values.tolist(), 1)]
    write_numbers(path, ["step", "increment", "time", "surface", "line", "point", *NAMES], rows)


def draw_fronts(path: Path, all_fronts: list[Front]) -> None:
    """Draw the fronts of all increments, coloured by time, and G with its parts along those of the last one.

    Raises
    ------
    UelError
        There is no front.
    """
    if not all_fronts:
        raise UelError(f"{path}: no front to draw: the damage of no increment reaches that of the front")
    last = [
        front
        for front in all_fronts
        if (front.step, front.increment) == (all_fronts[-1].step, all_fronts[-1].increment)
    ]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5.5, 6.4), layout="constrained")
        FigureCanvasAgg(figure)
        below = figure.add_subplot(2, 1, 2)
        _draw_lines(figure, all_fronts)
        for k, front in enumerate(last):
            arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(front.coordinates, axis=0), axis=1))])
            for name, colour, values in zip(("I", "II", "III"), COLOURS, front.releases.T, strict=False):
                below.plot(arc, values, color=colour, label=None if k else f"$G_{{{name}}}$")
            below.plot(arc, front.releases.sum(axis=1), color="0.35", linestyle="--", label=None if k else "$G$")
        below.set(xlabel=f"Length along the front at time {last[0].time:g}", ylabel="Energy release rate")
        below.set_ylim(bottom=min(0.0, below.get_ylim()[0]))
        figure.legend(ncols=4, loc="outside lower center")
        figure.savefig(path, dpi=200)


def _draw_lines(figure: Figure, all_fronts: list[Front]) -> None:
    """Draw fronts in their plane, along the two axes closest to it, or in space if they are not plane."""
    locations = np.concatenate([front.coordinates for front in all_fronts])
    times = np.array([front.time for front in all_fronts])
    # the plane of a single straight front contains its direction of growth
    grown = locations + 0.1 * np.ptp(locations, axis=0).max() * np.concatenate([front.ahead for front in all_fronts])
    _, sizes, axes = np.linalg.svd(np.concatenate([locations, grown]) - locations.mean(axis=0), full_matrices=False)
    if sizes[2] > _FLAT * sizes[1]:
        space = figure.add_subplot(2, 1, 1, projection="3d")
        lines = Line3DCollection([front.coordinates for front in all_fronts], array=times, linewidths=1.2)
        space.add_collection(lines)
        low, high = locations.min(axis=0), locations.max(axis=0)
        half = 0.5 * (high - low).max()
        for name, middle in zip("xyz", 0.5 * (low + high), strict=True):
            space.set(**{f"{name}lim": (middle - half, middle + half), f"{name}label": name.upper()})
        figure.colorbar(lines, ax=space, label="Time")
        return
    first, second = sorted(np.argsort(np.abs(axes[2]))[:2])
    above = figure.add_subplot(2, 1, 1)
    drawn = LineCollection([front.coordinates[:, [first, second]] for front in all_fronts], array=times, linewidths=1.2)
    above.add_collection(drawn)
    above.autoscale_view()
    above.set(xlabel="XYZ"[first], ylabel="XYZ"[second], aspect="equal", adjustable="datalim")
    figure.colorbar(drawn, ax=above, label="Time")


def _lines(surface: InterfaceSurface, damage: FloatArray, level: float) -> list[tuple[Locations, IntArray]]:
    """Return the lines of a level of damage, as locations at distances of an element and their triangles."""
    if not damage.min() < level < damage.max():
        return []
    triangles = surface.triangles
    return [
        triangles.even(line, surface.size)
        for line in triangles.lines(damage, level)
        if triangles.length(line) > surface.size
    ]


def _along(
    surface: InterfaceSurface, fields: Fields, line: Locations, triangles: IntArray, reach: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the locations, normals, tractions and energy release rates of a front, as in `Front`."""
    mesh = surface.triangles
    points = line.values(mesh.nodes)
    normal = _unit(line.values(mesh.normals))
    along = _tangents(points)
    along = _unit(along - np.sum(along * normal, axis=1, keepdims=True) * normal)
    ahead = np.cross(along, normal)
    both = [mesh.paths(line, triangles, along, direction, reach) for direction in (ahead, -ahead)]
    slope = [_damage_at(path, fields.damage, 0.5 * surface.size) for path in both]
    # the side on which the damage is smaller
    if np.sum(slope[0] - slope[1]) > 0.0:
        ahead, both = -ahead, both[::-1]
    along = np.cross(normal, ahead)
    releases = np.zeros((len(points), 3))
    for path, sign in zip(both, (1.0, -1.0), strict=True):
        traction, opening = _components(mesh, fields, path.locations, along)
        mean = 0.5 * (traction[:, 1:] + traction[:, :-1])
        # paths that have ended contribute nothing
        releases -= sign * np.nansum(mean * np.diff(opening, axis=1), axis=1)
    (middle,), _ = (
        each[None, :, 0]
        for each in _components(mesh, fields, Locations(line.nodes[:, None], line.weights[:, None]), along)
    )
    return points, ahead, middle, releases


def _growth(points: FloatArray, ahead: FloatArray, before: FloatArray) -> FloatArray:
    """Return the distances (n,) of points to an earlier front (m, 3), along the directions `ahead` (n, 3).

    The earlier front is a line of straight parts, the first and last of which go on by their own length, since a front
    is sampled in the middles of its parts. The distance is that in the plane normal to the front here; NaN if the line
    does not cross this plane nearby.
    """
    if len(before) < 2:
        return np.full(len(points), np.nan)
    chords = np.diff(before, axis=0)
    line = np.concatenate([before[:1] - chords[:1], before, before[-1:] + chords[-1:]])
    # signed distances (n, m + 2) of the earlier points from the planes
    side = np.einsum("nmd,nd->nm", line - points[:, None], _unit(_tangents(points)))
    low, high = side[:, :-1], side[:, 1:]
    crossing = (low <= 0.0) != (high <= 0.0)
    share = low / np.where(crossing, low - high, 1.0)
    way = points[:, None] - (line[:-1] + share[..., None] * np.diff(line, axis=0))
    length = np.where(crossing, np.linalg.norm(way, axis=-1), np.inf)
    row, nearest = np.arange(len(points)), np.argmin(length, axis=1)
    return np.where(np.isfinite(length[row, nearest]), np.sum(way[row, nearest] * ahead, axis=1), np.nan)


def _components(
    mesh: TriangulatedSurface, fields: Fields, locations: Locations, along: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the tractions and separations (n, k, 3) at locations (n, k): normal, ahead of the front and along it.

    along: (n, 3) direction of the front, normal to the paths; ahead and along turn with the surface.
    """
    normal = _unit(locations.values(mesh.normals))
    ahead = _unit(np.cross(along[:, None], normal))
    directions = np.stack([ahead, np.cross(normal, ahead)], axis=-2)
    values = locations.values(fields.normals)
    shape = fields.shears.shape
    shears = locations.values(fields.shears.reshape(shape[0], -1)).reshape(*values.shape[:-1], 2, 3)
    parts = np.einsum("nkcd,nkad->nkca", shears, directions)
    traction, opening = (np.concatenate([values[..., c, None], parts[..., c, :]], axis=-1) for c in (0, 1))
    return traction, opening


def _damage_at(path: SurfacePaths, damage: FloatArray, distance: float) -> FloatArray:
    """Return the damage (n,) at a distance along paths; 1 beyond an edge of the surface, as in a crack."""
    values = path.locations.values(damage[:, None])[..., 0]
    beside = np.ones(len(values))
    for row, (lengths, there) in enumerate(zip(path.lengths, values, strict=True)):
        known = np.isfinite(lengths)
        if lengths[known][-1] >= distance:
            beside[row] = np.interp(distance, lengths[known], there[known])
    return beside


def _unit(vectors: FloatArray) -> FloatArray:
    """Scale vectors (..., 3) to length 1; those of length 0 stay."""
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(size == 0.0, 1.0, size))


def _tangents(points: FloatArray) -> FloatArray:
    """Return the chords (n, 3) between the second neighbours of points of a line."""
    index = np.arange(len(points))
    return np.asarray(points[np.minimum(index + 2, len(points) - 1)] - points[np.maximum(index - 2, 0)])


def _half_lengths(surface: InterfaceSurface, damage: FloatArray, lines: list[Locations]) -> list[float]:
    """Return half the length of the paths through the process zone of each front.

    It covers all partly damaged points closer to this front than to others, and three faces.
    """
    if not lines:
        return []
    partly = surface.triangles.nodes[(damage > 1e-3) & (damage < 1.0 - 1e-3)]
    # nodes on both sides of a front may all be undamaged or failed
    distances = np.stack([cKDTree(line.values(surface.triangles.nodes)).query(partly)[0] for line in lines])
    closest = np.argmin(distances, axis=0)
    spreads = [np.append(0.0, distances[k, closest == k]).max() for k in range(len(lines))]
    return [float(spread) + 3.0 * surface.size for spread in spreads]
