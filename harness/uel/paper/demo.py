# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Demonstration of the consistent element, in five runs and two pictures.

Three double cantilever beams on the same interface, whose nodes lie alternately 3 % of an element up and down: the
standard element, the paper's stabilised one and the consistent one. Then an end-notched flexure of unlike plies, which
snaps back: Newton's method stops there, control by dissipated energy traces it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.delamination.damage import stiffness_lost
from uel.delamination.markdown import head, line
from uel.delamination.materials import TABLE_2
from uel.delamination.specimens import ARMS, CRACK
from uel.delamination.theory import dcb_curve
from uel.errors import FAILURES, ConvergenceError, tell_error, tell_failure
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.plots import Curve, Panel, grid
from uel.paper import measures
from uel.paper.beam_table import SHARP_PEAK, summary
from uel.paper.decks import FOLDER
from uel.running.job import run
from uel.solver.options import SolverOptions

BEAMS = {
    "standard": "dcb_0_0_standard_1e8_perturbed.inp",
    "paper's": "dcb_0_0_paper_1e8_perturbed.inp",
    "consistent": "dcb_0_0_consistent_1e8_perturbed.inp",
}
"""Decks of abaqus_inputs/paper_dcb by element."""
LAW = TABLE_2.with_stiffness(1.0e8)
"""Cohesive law of the beams."""
SNAP = "enf_0_90_consistent_1e6.inp"
"""Deck of abaqus_inputs/paper_enf that snaps back."""
NEWTON, ENERGY = "Newton's method", "energy control"
AROUND_FRONT = (2.0, 8.0)
"""Stretch of the interface that is drawn (mm): behind the front of the damage, and before it."""
PICTURES = "pictures"
"""Folder of the pictures beside the page."""


@dataclass(frozen=True, slots=True)
class ElementRow:
    """A double cantilever beam: loads (N), shear traction on the interface at the end (MPa), damage ahead of the front.

    peak, end            largest load, and load at 3 mm
    lowest, highest      of the shear traction
    variation            its total variation
    ahead                how far ahead of the front points are damaged (mm)
    iterations           of all increments
    """

    peak: float
    end: float
    lowest: float
    highest: float
    variation: float
    ahead: float
    iterations: int


@dataclass(frozen=True, slots=True)
class SnapRow:
    """The end-notched flexure; deflections (mm) and loads (N) at mid-span.

    stopped        where Newton's method ends
    turn, back     where energy control turns back, and to where
    load, drop     load at the first, and at the second
    end            deflection at the end with energy control
    """

    stopped: float
    turn: float
    load: float
    back: float
    drop: float
    end: float


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the decks, draw the pictures, print the table; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m uel.paper.demo",
        description="Run three elements on a bumpy interface and a snap-back, draw them, compare them with theory.",
        epilog="Exit code: 0 all runs have completed, but for Newton's method in the snap-back; 1 a run has not, and "
        "the last lines say why; 2 wrong usage.",
    )
    parser.add_argument("--output-dir", type=Path, default=Path("demo"), help="folder of all files written (demo)")
    parser.add_argument("--page", type=Path, help="also write this page, with the pictures in a folder beside it")
    options = parser.parse_args(arguments)
    console = Console()
    try:
        demonstration = Demonstration(options.output_dir, console)
        completed = demonstration.tell()
        if options.page is not None:
            write_page(demonstration, options.page)
    except FAILURES as error:
        tell_failure(error)
        return 1
    return 0 if completed else 1


class Demonstration:
    """The runs, made when this is, and what they show.

    Parameters
    ----------
    folder
        Gets the files of the jobs and the pictures.
    console
        Gets a line for each run as it begins.

    beams and snap are the runs by the names of the pictures; ended_early the errors of those that did not complete.
    """

    def __init__(self, folder: Path, console: Console) -> None:
        self._folder, self._console = folder, console
        self.ended_early: dict[str, str] = {}
        place = FOLDER / "paper_dcb"
        self.beams = {
            name: self._run(name, place / deck, "double cantilever beam", Path(deck).stem, SolverOptions(fallback=True))
            for name, deck in BEAMS.items()
        }
        enf = FOLDER / "paper_enf" / SNAP
        self.snap = {
            name: self._run(name, enf, "end-notched flexure", job, SolverOptions(energy_control=name == ENERGY))
            for name, job in ((NEWTON, "enf_newton"), (ENERGY, "enf_energy"))
        }

    def _run(self, name: str, deck: Path, what: str, job: str, solver: SolverOptions) -> Result:
        console = self._console
        console.print(f"{deck.name}: {what}, {name}", highlight=False)
        try:
            quiet = not console.is_terminal
            return run(deck, job=job, output_dir=self._folder, solver=solver, quiet=quiet)
        except ConvergenceError as error:
            self.ended_early[name] = str(error)
            return Result(self._folder / job)

    def tell(self) -> bool:
        """Draw the pictures and print what the runs show; returns whether all have completed that should."""
        figures = [draw_interface(self.beams, self._folder), draw_loads(self.beams, self.snap, self._folder)]
        console = self._console
        console.print(summary(self.beams))
        peaks = ", ".join(f"{name} {row.peak:.2f} N" for name, row in element_rows(self.beams).items())
        snap = snap_row(self.snap)
        for text in (
            f"snap-back: {NEWTON} ends at {snap.stopped:.2f} mm; {ENERGY} goes back from {snap.turn:.2f} to "
            f"{snap.back:.2f} mm and on to {snap.end:.2f} mm",
            *(f"picture: {figure}" for figure in figures),
            f"peak load: {peaks}; beam theory {SHARP_PEAK:.2f} N for a sharp crack",
        ):
            console.print(text, highlight=False, soft_wrap=True)
        failed = {name: why for name, why in self.ended_early.items() if name != NEWTON}
        for name, why in failed.items():
            tell_error(f"{name} ended early: {why}")
        return not failed


def element_rows(beams: Mapping[str, Result]) -> dict[str, ElementRow]:
    """Return the rows of the double cantilever beams."""
    return {name: _element_row(result) for name, result in beams.items()}


def _element_row(result: Result) -> ElementRow:
    profile = result.interface()
    shear, damaged = profile["TT"], profile["X"][profile["DAMAGE"] > 0.0]
    return ElementRow(
        measures.peak_load(result),
        measures.final_load(result),
        float(shear.min()),
        float(shear.max()),
        measures.shear_variation(result),
        float(damaged.max(initial=_tip(profile)) - _tip(profile)),
        measures.iterations(result),
    )


def _tip(profile: Mapping[str, FloatArray]) -> float:
    """Find where the normal traction is largest (mm): damage beyond it is ahead of the process zone."""
    return float(profile["X"][profile["TN"].argmax()])


def snap_row(snap: Mapping[str, Result]) -> SnapRow:
    """Return the row of the end-notched flexure."""
    moved, load = measures.displacement(snap[ENERGY]), measures.load(snap[ENERGY])
    back = int(np.argmax(np.maximum.accumulate(moved) - moved))
    turn = int(np.argmax(moved[: back + 1]))
    stopped = measures.final_displacement(snap[NEWTON])
    values = (moved[turn], load[turn], moved[back], load[back], moved[-1])
    return SnapRow(stopped, *map(float, values))


def draw_interface(beams: Mapping[str, Result], folder: Path) -> Path:
    """Draw tractions and damage around the front at the end of the runs, an element in each column."""
    profiles = {name: result.interface() for name, result in beams.items()}
    # the other two write d of (9)
    profiles["consistent"]["DAMAGE"] = stiffness_lost(profiles["consistent"]["DAMAGE"], LAW)
    front = min(map(_tip, profiles.values()))
    shown = (front - AROUND_FRONT[0], front + AROUND_FRONT[1])
    rows = {"TT": "Shear traction [MPa]", "TN": "Normal traction [MPa]", "DAMAGE": "Damage $d$ of (9)"}
    first, top, bottom = next(iter(profiles)), "TT", "DAMAGE"
    panels = [
        [
            Panel(
                f"{name} element" if column == top else "",
                [Curve("", profile["X"], profile[column])],
                "Position along the interface [mm]" if column == bottom else "",
                label if name == first else "",
                shown,
            )
            for name, profile in profiles.items()
        ]
        for column, label in rows.items()
    ]
    return grid(panels, folder / "interface.png", share_y=True, legend=False)


def draw_loads(beams: Mapping[str, Result], snap: Mapping[str, Result], folder: Path) -> Path:
    """Load over displacement: the double cantilever beams with beam theory, and the snap-back."""
    end = max(measures.final_displacement(result) for result in beams.values())
    opening = np.linspace(0.0, end, 400)
    curves = [Curve("beam theory", opening, dcb_curve(ARMS, CRACK, TABLE_2.toughness_1, opening), "reference")]
    curves += [_load_curve(f"{name} element", result) for name, result in beams.items()]
    last = snap[NEWTON]
    snapped = [
        _load_curve(f"consistent, {ENERGY}", snap[ENERGY]),
        Curve(f"{NEWTON} ends", [measures.final_displacement(last)], [measures.final_load(last)], "points"),
    ]
    panels = [
        Panel("double cantilever beam [0/0]", curves, "Displacement of each arm [mm]", "Load [N]"),
        Panel("end-notched flexure [0/90]", snapped, "Deflection at mid-span [mm]", "Load [N]"),
    ]
    return grid([panels], folder / "loads.png")


def _load_curve(label: str, result: Result) -> Curve:
    # the history starts with the first increment
    x, y = (np.concatenate([[0.0], column]) for column in (measures.displacement(result), measures.load(result)))
    return Curve(label, x, y)


def write_page(demonstration: Demonstration, path: Path) -> None:
    """Write the page and its pictures."""
    place = path.with_name(PICTURES)
    place.mkdir(parents=True, exist_ok=True)
    draw_interface(demonstration.beams, place)
    draw_loads(demonstration.beams, demonstration.snap, place)
    path.write_text(page(element_rows(demonstration.beams), snap_row(demonstration.snap)), encoding="utf-8")


def page(rows: Mapping[str, ElementRow], snap: SnapRow) -> str:
    """Write the page."""
    columns = ["peak (N)", "at 3 mm (N)", "lowest shear (MPa)", "highest", "its variation", "damage ahead (mm)"]
    table = head(["element", *columns, "iterations"])
    for name, row in rows.items():
        values = [getattr(row, field.name) for field in fields(row)]
        table.append(line([name, *(f"{value:.2f}" for value in values[:-1]), values[-1]]))
    snaps = head([f"{NEWTON} ends at (mm)", "energy control turns at (mm)", "load there (N)", "goes back to (mm)"])
    snaps[0] += " load there (N) | ends at (mm) |"
    snaps[1] += " --- | --- |"
    snaps.append(line([f"{getattr(snap, field.name):.2f}" for field in fields(snap)]))
    return _PAGE.format(table="\n".join(table), snap="\n".join(snaps), pictures=PICTURES)


_PAGE = """\
<!-- SPDX-FileCopyrightText: The uel-harness authors -->
<!-- SPDX-License-Identifier: BSD-3-Clause -->
# The demonstration

`make demo` runs it; `python -m uel.paper.demo --page harness/uel/paper/demo.md` writes this page.

## Three elements on a bumpy interface

![Tractions and damage along the interface, for each element]({pictures}/interface.png)

A double cantilever beam [0/0] at 3 mm each arm, `dcb_0_0_*_1e8_perturbed.inp` of `abaqus_inputs/paper_dcb`: stiffness
1e8 N/mm³, nodes of the interface alternately 3 % of an element's length up and down, `uel run --fallback`. The
specimen opens in mode I. Part of the shear is real: inclined facets turn stress along the plies into shear
([what is real](../../../fortran/stabilised.md#what-is-real-on-a-bumpy-interface)).

{table}

*Damage ahead* is the distance from the largest normal traction, at the crack's tip, to the last point that is damaged.
The picture's damage is that of (9), the share of its stiffness that a point has lost; at 1e8 N/mm³ that is nearly all
of it soon after the onset.

- The standard element's shear traction zigzags between minus and plus the strength of 60 MPa, and damages points here
  and there ahead of the tip.
- The paper's element is as smooth as the consistent one, but takes the damage from the gap that the mesh leaves: points
  ahead of the crack are damaged while they still carry the traction.
- The consistent element does neither, and takes half of the standard element's iterations.

## A snap-back

![Loads over displacements]({pictures}/loads.png)

Left: all three elements give the same load, and it is that of beam theory; the loads alone do not tell them apart.
Right: an end-notched flexure [0/90], `enf_0_90_consistent_1e6.inp` of `abaqus_inputs/paper_enf`. When the crack starts
it releases more energy than it takes, and the deflection would have to decrease. Newton's method, as in Abaqus, stops
there; `uel run --control energy` follows.

{snap}
"""


if __name__ == "__main__":
    sys.exit(main())
