# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.newton`: what Abaqus' own iterations need to get through a failing interface.

AS4/PEEK laminate [0]24, double cantilever beam, mixed-mode bending and end-notched flexure: P.P. Camanho and
C.G. Davila, "Mixed-mode decohesion finite elements for the simulation of delamination in composite materials",
NASA/TM-2002-211737, tables 1 and 2. Plane strain (CPE4I), four rows of quads in an arm, U4 with an infinite stiffness,
elements of one length along the whole specimen, increments of 2 %, Abaqus' default controls.

Each deck also runs with `--fallback`, which searches downhill where Newton's method fails. Its loads are what the
others are compared with, at the multiples of 2 % of the step: where elements are long, the load is a sawtooth, and runs
of other increments see other points of it.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from uel.delamination.flexure import lever
from uel.delamination.kernels import formulations, uel_property, user_element
from uel.delamination.keywords import integer_table, keyword, node_block, node_set, number, table, text, wrapped
from uel.delamination.markdown import head, line
from uel.delamination.materials import SolidPly
from uel.delamination.mesh import TwoArmMesh, two_arms
from uel.delamination.steps import Output, static_step
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.measures import iterations, load
from uel.paper.run_deck import run_deck
from uel.paper.study.options import study_parser

LENGTH, WIDTH, ARM = 102.0, 25.4, 1.56
"""Span and length, width, height of an arm (mm)."""

PLY = SolidPly("AS4_PEEK", (122700.0, 10100.0, 10100.0), (0.25, 0.25, 0.45), (5500.0, 5500.0, 3700.0))
LAW = {"SIGMAMAX": 80.0, "TAUMAX": 100.0, "GIC": 0.969, "GIIC": 1.719, "ETA": 2.284, "LAW": 2.0}
SOLIDS = "CPE4I"
ROWS = 4


@dataclass(frozen=True, slots=True)
class Specimen:
    """Crack (mm), displacement of the load at the end (mm), and length of the lever (mm), None without a lever."""

    crack: float
    displacement: float
    lever: float | None = None


SPECIMENS = {
    "dcb": Specimen(32.9, 4.5),
    "mmb_20": Specimen(33.7, 12.5, 109.4),
    "mmb_50": Specimen(34.1, 6.5, 44.4),
    "mmb_80": Specimen(31.4, 6.0, 28.4),
    "enf": Specimen(39.3, 4.8),
}
SIZES = (0.25, 0.5, 1.0)
"""Lengths of the elements (mm); the process zone is about 1 mm long."""

INCREMENT = 0.02
"""Initial and largest increment, in step time."""

COLUMNS = ("specimen", "elements", "run", "increments", "cutbacks", "iterations", "peak", "end", "mean")

TIMES = np.arange(1, 51) * INCREMENT


@dataclass(frozen=True, slots=True)
class NewtonDeck:
    """Deck of a specimen by its name in SPECIMENS, with elements of a length (mm).

    values  properties of U4 that are not the defaults
    label   of these values in the name of the deck
    """

    specimen: str
    size: float
    values: dict[str, float] = field(default_factory=dict)
    label: str = "plain"

    @property
    def name(self) -> str:
        """Name of the deck."""
        return f"{self.specimen}_{self.size:g}_{self.label}".replace(".", "p")

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp`."""
        mesh = _mesh(self.size, SPECIMENS[self.specimen].crack)
        lines = ["*HEADING", f"{self.specimen}, elements of {self.size:g} mm; N, mm, MPa"]
        lines += node_block(*mesh.nodes())
        lines += _elements(mesh, self.values)
        lines += _load(mesh, self.specimen)
        return {f"{self.name}.inp": text(lines)}


def _mesh(size: float, crack: float) -> TwoArmMesh:
    """Return columns of about `size` (mm) before the crack's tip and beyond it, with an edge at mid-span."""
    half = 0.5 * LENGTH
    edges = [0.0, crack, half, LENGTH]
    parts = [np.linspace(a, b, round((b - a) / size) + 1) for a, b in pairwise(edges)]
    x = np.round(np.concatenate([parts[0], parts[1][1:], parts[2][1:]]), 6)
    return two_arms(x, ARM, ROWS, crack)


def _elements(mesh: TwoArmMesh, values: dict[str, float]) -> list[str]:
    quads = np.concatenate([mesh.quads("lower"), mesh.quads("upper")])
    lines = [keyword("ELEMENT", TYPE=SOLIDS, ELSET="QUADS"), *integer_table(quads).splitlines()]
    lines += [keyword("SOLID SECTION", ELSET="QUADS", MATERIAL=PLY.name), *wrapped([WIDTH])]
    lines += [keyword("MATERIAL", NAME=PLY.name), "*ELASTIC, TYPE=ENGINEERING CONSTANTS"]
    lines += wrapped([*PLY.moduli, *PLY.ratios, *PLY.shear])
    properties = LAW | {"THICKNESS": WIDTH, "PLANE": 1.0} | formulations(SOLIDS)
    properties |= {f"{name} {side}": value for side in ("BOTTOM", "TOP") for name, value in PLY.constants.items()}
    lines += user_element(4)
    lines += [keyword("ELEMENT", TYPE="U4", ELSET="INTERFACE"), *integer_table(mesh.interface8()).splitlines()]
    return lines + uel_property(4, "INTERFACE", properties | values)


def _load(mesh: TwoArmMesh, name: str) -> list[str]:
    specimen = SPECIMENS[name]
    bottom, top = mesh.line(1), mesh.top_line
    middle = int(np.argmin(np.abs(mesh.x - 0.5 * LENGTH)))
    low, high = (int(line[0]) for line in mesh.interface_lines)
    lines: list[str] = []
    if name == "dcb":
        lines += node_set("LOAD_TOP", top[:1]) + node_set("LOAD_BOTTOM", bottom[:1]) + node_set("END", mesh.edge(-1))
        lines += ["*BOUNDARY", "END, 1, 2"]
        loaded = "LOAD_TOP"
        ends = (("LOAD_TOP", specimen.displacement), ("LOAD_BOTTOM", -specimen.displacement))
        moved = [f"{end}, 2, 2, {number(value)}" for end, value in ends]
    else:
        lines += node_set("LEFT", bottom[:1]) + node_set("RIGHT", bottom[-1:])
        loaded = "MIDSPAN"
        if specimen.lever is None:
            lines += node_set("MIDSPAN", top[middle : middle + 1])
            lines += ["*EQUATION", "2", *table([(high, 2, 1.0, low, 2, -1.0)])]
        else:
            node, end = int(top[-1]) + 1, int(mesh.edge(0)[ROWS + 1 + ROWS // 2])
            lines += lever(node, (specimen.lever, 2.0 * ARM), int(top[middle]), end, 0.5 * LENGTH)
            lines += node_set("MIDSPAN", np.array([node]))
        lines += ["*BOUNDARY", "LEFT, 2, 2", "RIGHT, 1, 2"]
        moved = [f"MIDSPAN, 2, 2, {number(-specimen.displacement)}"]
    energies = "ALLIE, ALLPD, ALLVD, ALLWK, ETOTAL"
    output = Output("FREQUENCY=50", stresses=False, history={loaded: "U2, RF2"}, energies=energies)
    return lines + static_step((INCREMENT, 1.0, 1.0e-6, INCREMENT), moved, output, limit=10000)


@dataclass(frozen=True, slots=True)
class Row:
    """A run: increments, cutbacks, iterations, step time reached, and loads (N) at TIMES up to there."""

    increments: int
    cutbacks: int
    iterations: int
    reached: float
    loads: FloatArray

    def changes(self, reference: Row) -> tuple[float, float, float]:
        """Return the relative changes of the largest load, the last one and their mean; of a run that finished."""
        pairs = [(f(self.loads), f(reference.loads)) for f in (np.max, lambda loads: loads[-1], np.mean)]
        peak, end, mean = (float(one / other - 1.0) for one, other in pairs)
        return peak, end, mean

    def cells(self, reference: Row) -> list[str]:
        """Return the cells of the table after deck and properties."""
        counts = [str(self.increments), str(self.cutbacks), str(self.iterations)]
        if self.reached < 1.0:
            return [*counts, f"stops at {self.reached:.0%}", "", ""]
        return [*counts, *(f"{100 * change:+.2f} %" for change in self.changes(reference))]


def measured(result: Result) -> Row:
    """Return the measures of a run."""
    time = result.history["time"]
    loads = np.interp([moment for moment in TIMES if moment < time[-1] + 1e-9], time, load(result))
    cutbacks = sum(line.cutback for line in result.status)
    return Row(len(time), cutbacks, iterations(result), round(float(time[-1]), 9), loads)


def run_row(deck: NewtonDeck, folder: Path, *, fallback: bool) -> Row:
    """Run a deck and measure it; folder gets a folder of its files."""
    return measured(run_deck(deck, folder, fallback=fallback).result)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the decks, print a table; returns the exit code."""
    description = "AS4/PEEK specimens with Abaqus' own iterations, against those with the fall-back."
    parser = study_parser("uel.paper.study.newton", description, "study/newton")
    parser.add_argument("--only", nargs="+", choices=SPECIMENS, default=list(SPECIMENS), help="specimens")
    parser.add_argument("--sizes", nargs="+", type=float, default=SIZES, metavar="MM", help="lengths of the elements")
    parser.add_argument(
        "--values", nargs="*", default=[], metavar="NAME=VALUE", help="properties of the elements, as VISCOSITY=3e-4"
    )
    options = parser.parse_args(arguments)
    values = {name: float(value) for name, _, value in (text.partition("=") for text in options.values)}
    label = "_".join(["newton", *(text.replace("=", "_") for text in options.values)]).lower()
    print("\n".join(head(COLUMNS)))
    for name in options.only:
        for size in options.sizes:
            reference = run_row(NewtonDeck(name, size, label="fallback"), options.output_dir, fallback=True)
            row = run_row(NewtonDeck(name, size, values, label), options.output_dir, fallback=False)
            loads = [f"{value:.2f} N" for value in (reference.loads.max(), reference.loads[-1], reference.loads.mean())]
            counts = [str(value) for value in (reference.increments, reference.cutbacks, reference.iterations)]
            print(line([name, f"{size:g} mm", "fall-back", *counts, *loads]))
            print(
                line([name, f"{size:g} mm", " ".join(options.values) or "defaults", *row.cells(reference)]), flush=True
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
