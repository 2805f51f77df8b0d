# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.surface`: how smooth the tractions over an interface in space are.

A double cantilever beam of bricks is opened until its crack has grown by a quarter, on four meshes of one specimen:
aligned with the front; with the lines across turned by 15 degrees, so that the front runs through the elements one
after the other; with the nodes of the interface moved at random in its plane; and out of it as well, which makes bumps.
The index is that of `uel.delamination.oscillation`, with the same mesh cut into bricks of half the size, rigidly
bonded, as what really acts, bumps included.
"""

from __future__ import annotations

import sys
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from operator import itemgetter
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from rich.console import Console

from uel.batch.engine import Store, StoredRow, complete
from uel.delamination.blocks import Interface
from uel.delamination.markdown import head, line
from uel.delamination.mesh import crack_columns
from uel.delamination.oscillation import surface_index, surface_variation
from uel.delamination.plates import Laminate, TwoPlateMesh, refined, two_plates
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.bricks import ARM, CRACK, HEIGHT, LAW, LENGTH
from uel.paper.measures import cutbacks, iterations, load
from uel.paper.run_deck import run_deck
from uel.paper.study.options import study_parser
from uel.paper.study.reference import FOLDER, run_reference
from uel.paper.study.runner import reference_store
from uel.paper.study.spatial import Field, field, opened, restricted

WIDTH = 6.0
"""Width of the specimen (mm); the rest is that of `bricks.py`."""

OPENING = 1.6
"""Distance of the outer edges of the arms at the end (mm)."""

SIZE, GROWTH, RATIO, LARGEST = 1.0, 31.0, 1.5, 4.0
"""Length of the bricks from the crack's tip to x = GROWTH, and the largest one (mm); ratio of neighbours beyond."""

TURN = 15.0
"""Degrees between the turned lines and the front."""

RAMP = 3.0
"""Distance from the initial front, which is straight, to where the lines are turned (mm)."""

MOVED = 0.03
"""Largest shift of an interface node along each direction, over the length of a brick, as in `cases.BUMP`."""

SEED = 15
MESHES = {"aligned": "", "turned": "", "moved": "xy", "bumpy": "xyz"}
"""Directions in which the interface nodes are moved."""

STRENGTH = LAW.strength_normal
STIFFNESSES = {"1e6": 1.0e6, "1e8": 1.0e8, "inf": 0.0}
ELEMENTS = {
    "standard": Interface("U7", LAW, law=2, eta=1.0),
    "consistent": Interface("U8", LAW, law=2, eta=1.0),
}
ALLOWED = 1.1
"""Index over that of the same element on the aligned mesh at 1e6 N/mm^3."""

COLUMNS = (
    *("element", "mesh", "stiffness", "peak (N)", "end (N)", "cutbacks", "iterations"),
    *("variation (MPa)", "real", "index", "ratio", "in growth", "ratio in growth", "from", "to", "at the end"),
)
ROWS = "rows"
"""Folder of the runs of the table, beside that of the references."""


@dataclass(frozen=True, slots=True)
class SurfaceMesh:
    """Mesh of `MESHES`, its bricks cut into factor x factor x factor; by default that of the table.

    size    length and width of the bricks where the crack grows (mm)
    layers  bricks through the height of an arm
    """

    name: str
    factor: int = 1
    size: float = SIZE
    layers: int = 2

    @property
    def rows(self) -> int:
        """Bricks across."""
        return self.factor * round(WIDTH / self.size)

    def plates(self) -> TwoPlateMesh:
        """Build the mesh of the two arms."""
        x = crack_columns(LENGTH, (CRACK, GROWTH), self.size, RATIO, (LARGEST, LARGEST))
        y = np.linspace(0.0, WIDTH, round(WIDTH / self.size) + 1)
        mesh = two_plates(x, y, np.linspace(0.0, HEIGHT, self.layers + 1), CRACK)
        positions = mesh.positions
        if self.name == "turned":
            slope = np.interp(x, [CRACK, CRACK + RAMP, GROWTH, LENGTH], [0.0, 1.0, 1.0, 0.0])
            positions[..., 0] += slope * np.tan(np.radians(TURN)) * (y[:, None] - WIDTH / 2)
        positions[self.layers : self.layers + 2] += self._shift((len(y), len(x)))
        finer = refined(replace(mesh, moved=positions), self.factor)
        # rounded, the deck does not depend on the processor
        return replace(finer, moved=np.round(finer.positions, 9))

    def _shift(self, shape: tuple[int, ...]) -> FloatArray:
        shift = MOVED * self.size * np.random.default_rng(SEED).uniform(-1.0, 1.0, (*shape, 3))
        shift *= [direction in MESHES[self.name] for direction in "xyz"]
        # the outline stays
        shift[:, [0, -1], 0] = shift[[0, -1], :, 1] = 0.0
        return np.asarray(shift)


@dataclass(frozen=True, slots=True)
class SurfaceCase:
    """A row of the table: a mesh, a key of ELEMENTS, and one of STIFFNESSES; opening at the end (mm)."""

    mesh: SurfaceMesh
    element: str
    stiffness: str
    opening: float = OPENING

    @property
    def name(self) -> str:
        """Name of the deck and of its folder."""
        return f"{self.mesh.name}_{self.element}_{self.stiffness}"

    @property
    def reference(self) -> SurfaceCase:
        """Case of the tractions that really act: a rigid bond on bricks of half the size."""
        mesh = SurfaceMesh(self.mesh.name, 2, self.mesh.size, self.mesh.layers)
        return SurfaceCase(mesh, "consistent", "inf", self.opening)

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp`."""
        stiffness = STIFFNESSES[self.stiffness]
        interface = replace(ELEMENTS[self.element], cohesive=LAW.with_stiffness(stiffness))
        mesh = self.mesh.plates()
        arm = (ARM,) * (len(mesh.lower) - 1)
        title = f"Double cantilever beam, {self.mesh.name} mesh, {self.element} element, {self.stiffness} N/mm^3"
        return {f"{self.name}.inp": opened(title, Laminate(mesh, interface, arm, arm), self.opening, every=1)}


def all_cases() -> list[SurfaceCase]:
    """List the rows; the others are compared with the aligned mesh at 1e6 N/mm^3."""
    rows = {"standard": ("1e8",), "consistent": ("1e8", "inf")}
    return [
        SurfaceCase(SurfaceMesh(mesh), element, stiffness)
        for element, stiff in rows.items()
        for mesh in MESHES
        for stiffness in (*(("1e6",) if mesh == "aligned" else ()), *stiff)
    ]


@dataclass(frozen=True, slots=True)
class SurfaceRow(StoredRow):
    """Numbers of one row. If the run stopped early, they hold up to that point.

    stopped      why it stopped early; empty for a run that finished
    peak, final  load (N)
    cutbacks, iterations
    index        largest oscillation index of the normal traction in all increments
    variation, real  of the normal traction, and what really acts, per unit of width, where the index is largest (MPa)
    growth       mean of the index over the second half of the opening
    least, most  of the index in the second half of the opening
    last         index in the last increment
    """

    stopped: str
    peak: float
    final: float
    cutbacks: int
    iterations: int
    variation: float
    real: float
    index: float
    growth: float
    least: float
    most: float
    last: float


def run_case(case: SurfaceCase, folder: Path) -> SurfaceRow:
    """Run a case with the fall-back, and measure it against its reference, which has to have run beside `folder`."""
    outcome = run_deck(case, folder, fallback=True)
    return measure(case, outcome.result, outcome.stopped, real_fields(case.reference, folder.parent / FOLDER))


def measure(case: SurfaceCase, result: Result, stopped: str, real: Fields) -> SurfaceRow:
    """Read the row of a case from the files of its run, and what really acts."""
    found = []
    for time, shown in fields_of(case, result):
        places = np.stack([shown["X"], shown["Y"]], axis=-1)
        pair = shown["TN"], _at(real, time)
        index = surface_index(places, *pair, STRENGTH, WIDTH)
        found.append((index, *(surface_variation(places, values, WIDTH) for values in pair), time))
    index, variation, acting, _ = max(found)
    curve = load(result)
    grown = [each for each, *_, time in found if time > 0.5 * case.opening]
    return SurfaceRow(
        stopped=stopped,
        peak=float(curve.max()),
        final=float(curve[-1]),
        cutbacks=cutbacks(result),
        iterations=iterations(result),
        variation=variation,
        real=acting,
        index=index,
        growth=float(np.mean(grown)),
        least=min(grown),
        most=max(grown),
        last=grown[-1],
    )


Fields = list[tuple[float, Field]]
"""Fields of all increments with their times, which are openings (mm)."""


@lru_cache(maxsize=1)
def real_fields(reference: SurfaceCase, folder: Path) -> Fields:
    """Return the tractions that really act, at the points of the mesh that is not cut."""
    finer = fields_of(reference, Result(folder / reference.name / reference.name))
    return [(time, restricted(values, reference.mesh.factor)) for time, values in finer]


def fields_of(case: SurfaceCase, result: Result) -> Fields:
    """Return the fields of a run in all increments."""
    return [(float(profile["time"][0]), field(profile, case.mesh.rows)) for profile in result.interfaces()]


def _at(fields: Fields, time: float) -> FloatArray:
    """Interpolate the normal traction at a time: where the run was cut back, it has other increments."""
    after = min(max(bisect_left(fields, time, key=itemgetter(0)), 1), len(fields) - 1)
    (start, before), (end, then) = fields[after - 1 : after + 1]
    share = (time - start) / (end - start)
    return np.asarray((1.0 - share) * before["TN"] + share * then["TN"])


def markdown(rows: Mapping[SurfaceCase, SurfaceRow]) -> list[str]:
    """Write the table of the page."""
    lines = head(COLUMNS)
    for case, row in rows.items():
        least = rows[SurfaceCase(SurfaceMesh("aligned"), case.element, "1e6")]
        loads = f"{row.peak:.2f}", f"{row.final:.2f}" if not row.stopped else "stopped"
        spent = str(row.cutbacks), str(row.iterations)
        measured = f"{row.variation:.1f}", f"{row.real:.1f}", f"{row.index:.3f}", f"{row.index / least.index:.3f}"
        growth = f"{row.growth:.3f}", f"{row.growth / least.growth:.3f}"
        waves = f"{row.least:.3f}", f"{row.most:.3f}", f"{row.last:.3f}"
        lines.append(line([case.element, case.mesh.name, case.stiffness, *loads, *spent, *measured, *growth, *waves]))
    return lines


def draw(shown: Sequence[Mapping[str, Field]], path: Path) -> None:
    """Draw the normal tractions about the front: a line of panels for each entry, with their titles."""
    with mpl.rc_context({"font.size": 8}):
        figure = Figure(figsize=(12.0, 1.8 * len(shown)), layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplots(len(shown), len(shown[0]), sharex=True, sharey=True, squeeze=False)
        scale = {"vmin": -2.0 * STRENGTH, "vmax": 2.0 * STRENGTH, "cmap": "RdBu_r"}
        for axes, fields in zip(panels, shown, strict=True):
            for axis, (title, values) in zip(axes, fields.items(), strict=True):
                colours = axis.pcolormesh(values["X"], values["Y"], values["TN"], shading="gouraud", **scale)
                axis.plot(values["X"].ravel(), values["Y"].ravel(), ",k")
                axis.set(title=title, aspect="equal", xlim=(CRACK, GROWTH + 3.0))
        figure.colorbar(colours, ax=panels, label="normal traction (MPa)", shrink=0.6)
        figure.supxlabel("x (mm)")
        figure.supylabel("y (mm)")
        figure.savefig(path, dpi=150)


def last_fields(folder: Path) -> list[dict[str, Field]]:
    """Read the fields at the end on each mesh: both elements at 1e8 N/mm^3, and what really acts."""
    shown = []
    for mesh in MESHES:
        panels = {}
        for element in ELEMENTS:
            case = SurfaceCase(SurfaceMesh(mesh), element, "1e8")
            result = Result(folder / ROWS / case.name / case.name)
            panels[f"{mesh}, {element}, 1e8"] = field(result.interface(), case.mesh.rows)
        _, real = real_fields(case.reference, folder / FOLDER)[-1]
        shown.append(panels | {f"{mesh}, finer": real})
    return shown


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what is missing, print the table, draw the fields; returns the exit code."""
    description = "Oscillation of the tractions over an interface in space on aligned, turned and moved meshes."
    parser = study_parser("uel.paper.study.surface", description, "study/surface", resumes=True)
    options = parser.parse_args(arguments)
    folder: Path = options.output_dir
    console, cases = Console(), all_cases()
    complete(
        list(dict.fromkeys(case.reference for case in cases)),
        reference_store(folder),
        run_reference,
        folder / FOLDER,
        workers=options.workers,
        console=console,
        describe=lambda row: row.stopped or "finished",
    )
    rows = complete(
        cases,
        Store(folder / "rows.json", SurfaceRow.from_json),
        run_case,
        folder / ROWS,
        workers=options.workers,
        console=console,
        describe=lambda row: f"{row.stopped or 'finished'}, index {row.index:.3f}",
    )
    print("\n".join(markdown(rows)))
    draw(last_fields(folder), folder / "surface.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
