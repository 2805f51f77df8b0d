# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.smoothness`: how smooth the tractions are beside each kind of solids.

A double cantilever beam, that of `bricks.py`, on one grid of cells: each cell is a quad or two triangles, a brick, two
wedges or six tetrahedra. The interface is that of the recommended element, with an infinite stiffness, and once more
that of the standard one with 1e8 N/mm^3. The normal traction is looked at in the part of the grid whose cells are
short, ahead of the crack's tip:

- by columns: its means over columns of cells, that is over an element length and the whole width, which every kind of
  solids has. What really acts falls to a minimum and rises again: two monotone pieces. The index is the oscillation
  index of these means against what really acts: CPS4I on a grid that is cut in half each way, at the same columns. In
  the first increment, which is linear, tractions are over the load: solids that are too stiff or too soft in bending,
  such as linear triangles, carry another load. While the crack grows, the largest traction is the strength, and the
  index is averaged over the increments in which the front is in WINDOW.
- within the columns: root mean square of the distance of all points from the means of their columns over that of these
  means, from the third column on, in the first increment.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.batch.engine import Store, StoredRow, complete
from uel.delamination.keywords import element_block, keyword, node_block, node_set, number, text
from uel.delamination.markdown import head, line
from uel.delamination.mesh import crack_columns, cut
from uel.delamination.oscillation import oscillation_index, total_variation, turns
from uel.delamination.solid_blocks import block
from uel.insertion.command import insert
from uel.insertion.selection import CutRequest
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.bricks import ARM, CRACK, HEIGHT, LAW, LENGTH
from uel.paper.measures import cutbacks, iterations, load
from uel.paper.run_deck import run_deck
from uel.paper.study.options import study_parser, write_tables

SIZE, GROWTH, RATIO, LARGEST = 0.5, 27.0, 1.5, 4.0
"""Length and width of the cells from the crack's tip to x = GROWTH, and the largest length (mm); ratio of neighbours
beyond."""
ROWS = 2
"""Cells across."""
LAYERS = 4
"""Cells through the height of an arm: they are as high as long."""
HEIGHTS = (2, 8)
"""The same in the table of other heights."""
WINDOW = 21.0, 23.5
"""Front of the increments that count as growth (mm): the middle of the column with the largest traction."""
STIFFNESS = 1.0e8
"""Stiffness of the standard elements (N/mm^3)."""
PLANE = {"CPS4I": "U2", "CPS4": "U2", "CPS4R": "U2", "CPS8": "U5", "CPS8R": "U5", "CPS3": "U2", "CPS6": "U5"}
SPACE = {"C3D8I": "U7", "C3D8": "U7", "C3D8R": "U7", "C3D20R": "U11", "C3D6": "U13", "C3D4": "U13", "C3D10": "U14"}
STANDARD = PLANE | SPACE
"""Standard element between the solids."""
ELEMENTS = ("consistent", "standard")
OPENING = 1.35
STIFF = {"CPS4": 1.0, "C3D8": 1.0, "CPS3": 0.7, "C3D4": 0.72, "C3D6": 1.2, "CPS4R": 1.45, "C3D8R": 1.45}
"""Distance of the outer edges at the end (mm), when the front has left WINDOW; of arms that are stiffer or softer."""
ALLOWED = 1.1
"""Index over that beside the incompatible element."""
COLUMNS = (
    *(
        "solid",
        "interface",
        "first index",
        "ratio",
        "pieces",
        "within",
        "in growth",
        "ratio in growth",
        "ratio of the largest",
    ),
    *("increments", "peak (N)", "cutbacks", "iterations"),
)
SETS = ("LOWER", "UPPER")
MARK = "\n## Tables\n"
"""Line of the page above its tables."""


@dataclass(frozen=True, slots=True)
class SmoothnessCase:
    """A run: type of the solids, one of ELEMENTS, cells through the height of an arm.

    factor  parts of each cell along each direction
    grown   whether the crack grows; otherwise one increment
    """

    kind: str
    element: str
    layers: int = LAYERS
    factor: int = 1
    grown: bool = True

    @property
    def name(self) -> str:
        """Name of the deck and of its folder."""
        last = "grown" if self.grown else "first"
        return f"{self.kind.lower()}_{self.element}_{self.layers}_{self.factor}_{last}"

    @property
    def reference(self) -> SmoothnessCase:
        """Case of what really acts: quads on a grid cut in half, in the plane, for the strip in space is narrow."""
        return SmoothnessCase("CPS4I", "consistent", LAYERS, 2, self.grown)

    @property
    def edges(self) -> list[FloatArray]:
        """Edges of the cells along x, in space across, and along the normal."""
        x = crack_columns(LENGTH, (CRACK, GROWTH), SIZE, RATIO, (LARGEST, LARGEST))
        across = [np.linspace(0.0, ROWS * SIZE, ROWS + 1)] if self.kind in SPACE else []
        return [cut(each, self.factor) for each in (x, *across, np.linspace(-HEIGHT, HEIGHT, 2 * self.layers + 1))]

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp`."""
        values = [f"SIGMAMAX={LAW.strength_normal}", f"TAUMAX={LAW.strength_shear}"]
        values += [f"GIC={LAW.toughness_1}", f"GIIC={LAW.toughness_2}", "ETA=1"]
        standard = self.element == "standard"
        with tempfile.TemporaryDirectory() as folder:
            whole = Path(folder, "whole.inp")
            whole.write_text(text(self._whole()), encoding="ascii")
            content, _ = insert(
                [whole],
                CutRequest(between=[SETS], crack=["CRACK"]),
                element=STANDARD[self.kind] if standard else "",
                values=[*values, f"ALPHAN={STIFFNESS:g}"] if standard else values,
            )
        return {f"{self.name}.inp": content}

    def _whole(self) -> list[str]:
        """Write the deck without an interface."""
        grid = block(self.kind, self.edges)
        dimension = grid.nodes.shape[1]
        low = grid.cell[:, -1] < self.layers * self.factor
        labels = np.arange(1, len(grid.nodes) + 1)
        lines = ["*HEADING", f"Double cantilever beam of {self.kind}", *node_block(labels, grid.nodes)]
        first = 1
        for name, part in zip(SETS, (low, ~low), strict=True):
            lines += element_block(self.kind, name, labels[grid.elements[part]], first)
            lines += [keyword("SOLID SECTION", ELSET=name, MATERIAL=ARM.name), "1."]
            first += int(part.sum())
        x, height = grid.nodes[:, 0], grid.nodes[:, -1]
        ends = {"LOAD_TOP": HEIGHT, "LOAD_BOTTOM": -HEIGHT} if dimension == 2 else {"TOP": HEIGHT, "BOTTOM": -HEIGHT}
        sets = {name: (x < 1e-9) & np.isclose(height, edge) for name, edge in ends.items()}
        sets |= {"CLAMPED": x > LENGTH - 1e-9, "CRACK": (np.abs(height) < 1e-9) & (x < CRACK + 1e-9)}
        for name, nodes in sets.items():
            lines += node_set(name, labels[nodes])
        opening = STIFF.get(self.kind, OPENING) if self.grown else 0.01 * OPENING
        largest = 0.015 if self.grown else 1.0
        top, bottom = ends
        lines += [keyword("MATERIAL", NAME=ARM.name), "*ELASTIC", f"{ARM.moduli[0]}, {ARM.ratios[0]}"]
        lines += ["*BOUNDARY", f"CLAMPED, 1, {dimension}", "*STEP, INC=1000, UNSYMM=YES", "*STATIC"]
        lines += [f"{min(0.005, largest) if self.grown else 1.0}, 1., 1e-10, {largest}", "*BOUNDARY"]
        lines += [f"{top}, {dimension}, {dimension}, {number(opening / 2)}"]
        lines += [f"{bottom}, {dimension}, {dimension}, {number(-opening / 2)}"]
        lines += ["*OUTPUT, FIELD, FREQUENCY=1", "*NODE OUTPUT", "U", "*OUTPUT, HISTORY, FREQUENCY=1"]
        return [*lines, f"*NODE OUTPUT, NSET={top}", f"U{dimension}, RF{dimension}", "*END STEP"]


@dataclass(frozen=True, slots=True)
class SmoothnessRow(StoredRow):
    """Measures of a run: see the head of this file. If it stopped early, they hold up to that point.

    stopped     why it stopped early; empty for a run that finished
    first       variation of the means over the load in the first increment (1/mm^2)
    pieces      monotone pieces of the means in the first increment
    within      share within the columns
    growth      mean variation of the means in growth (MPa), 0 without growth
    most        largest in growth (MPa)
    increments  number of increments that count as growth
    peak        load (N)
    cutbacks, iterations
    """

    stopped: str
    first: float
    pieces: int
    within: float
    growth: float
    most: float
    increments: int
    peak: float
    cutbacks: int
    iterations: int


def run_case(case: SmoothnessCase, folder: Path) -> SmoothnessRow:
    """Run a case with the fall-back, and measure it."""
    outcome = run_deck(case, folder, fallback=True)
    return measure(outcome.result, outcome.stopped)


def measure(result: Result, stopped: str) -> SmoothnessRow:
    """Read the row of a run from its files."""
    profiles, curve = result.interfaces(), load(result)
    means, away = columns(profiles[0])
    grown = [
        found for found in (columns(profile)[0] for profile in profiles[1:]) if WINDOW[0] < front(found) < WINDOW[1]
    ]
    variations = [total_variation(found) for found in grown] or [0.0]
    return SmoothnessRow(
        stopped=stopped,
        first=total_variation(means) / float(curve[0]),
        pieces=len(turns(means)) - 1,
        within=float(np.sqrt(np.mean(away[2:] ** 2) / np.mean(means[2:] ** 2))),
        growth=float(np.mean(variations)),
        most=max(variations),
        increments=len(grown),
        peak=float(curve.max()),
        cutbacks=cutbacks(result),
        iterations=iterations(result),
    )


def columns(profile: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return mean and standard deviation of the normal traction in each column ahead of the tip."""
    number_of = np.floor((profile["X"] - CRACK) / SIZE + 1e-9).astype(int)
    members = [number_of == k for k in range(round((GROWTH - CRACK) / SIZE))]
    values = [profile["TN"][which] for which in members]
    return np.array([each.mean() for each in values]), np.array([each.std() for each in values])


def front(means: FloatArray) -> float:
    """Return x of the middle of the column with the largest traction (mm)."""
    return CRACK + SIZE * (int(np.argmax(means)) + 0.5)


def index(variation: float, real: float) -> float:
    """Return the oscillation index of profiles of these variations."""
    return oscillation_index(np.array([0.0, variation]), np.array([0.0, real]), 0.0)


def all_cases() -> list[SmoothnessCase]:
    """List the rows: growth on cells as high as long, then the first increment in the plane by height."""
    grown = [SmoothnessCase(kind, element) for kind, element in product(STANDARD, ELEMENTS)]
    return grown + [
        SmoothnessCase(kind, element, layers, grown=False)
        for kind, element, layers in product(PLANE, ELEMENTS, HEIGHTS)
    ]


def by_solids(rows: Mapping[SmoothnessCase, SmoothnessRow]) -> list[str]:
    """Write the table of cells as high as long."""
    lines = head(COLUMNS)
    for case in (case for case in all_cases() if case.grown):
        row, real, least = (rows[found] for found in (case, case.reference, incompatible(case)))
        first, growth = index(row.first, real.first), index(row.growth, real.growth)
        cells = [
            f"{first:.3f}",
            f"{first / index(least.first, real.first):.3f}",
            row.pieces,
            f"{100 * row.within:.1f} %",
        ]
        cells += [f"{growth:.3f}", f"{growth / index(least.growth, real.growth):.3f}", f"{row.most / least.most:.3f}"]
        end = "stopped" if row.stopped else str(row.iterations)
        lines.append(line([case.kind, case.element, *cells, row.increments, f"{row.peak:.3f}", row.cutbacks, end]))
    return lines


def by_height(rows: Mapping[SmoothnessCase, SmoothnessRow]) -> list[str]:
    """Write the table of the first increment on cells of other heights."""
    titles = [f"{HEIGHT / layers:g} mm" for layers in HEIGHTS]
    lines = head(
        ["solid", "interface", *(f"{word}, {title}" for title in titles for word in ("ratio", "pieces", "within"))]
    )
    for kind, element in product(PLANE, ELEMENTS):
        cells = []
        for layers in HEIGHTS:
            case = SmoothnessCase(kind, element, layers, grown=False)
            row, least = rows[case], rows[incompatible(case)]
            cells += [f"{row.first / least.first:.3f}", row.pieces, f"{100 * row.within:.1f} %"]
        lines.append(line([kind, element, *cells]))
    return lines


def incompatible(case: SmoothnessCase) -> SmoothnessCase:
    """Return the case with the incompatible element and the consistent interface, on the same grid."""
    return replace(case, kind="CPS4I" if case.kind in PLANE else "C3D8I", element="consistent")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what is missing, print the tables; returns the exit code."""
    description = "Oscillation of the tractions of an interface beside each kind of solids."
    parser = study_parser("uel.paper.study.smoothness", description, "study/smoothness", resumes=True)
    parser.add_argument("--page", type=Path, help="file whose tables are written again, those below its mark")
    options = parser.parse_args(arguments)
    cases = all_cases()
    rows = complete(
        list(dict.fromkeys([*cases, *(case.reference for case in cases if case.grown)])),
        Store(options.output_dir / "rows.json", SmoothnessRow.from_json),
        run_case,
        options.output_dir,
        workers=options.workers,
        console=Console(),
        describe=lambda row: f"{row.stopped or 'finished'}, variation {row.first:.1f}, in growth {row.growth:.1f}",
    )
    content = text(["### Every kind of solids", "", *by_solids(rows), "", "### Other heights", "", *by_height(rows)])
    if options.page:
        write_tables(options.page, MARK, content)
    Console().print(content, soft_wrap=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
