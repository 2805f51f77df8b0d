# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.benchmarks`: run the benchmarks of the literature in space, write their table."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.batch.engine import Store, StoredRow, complete
from uel.delamination.markdown import head, line
from uel.errors import UelError
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper import literature, literature_measures, measures, space_beam_measures, space_beams
from uel.paper.decks import FOLDER

PAGE = FOLDER / "benchmarks.md"

SNAP = 0.05
"""An increment in which the load falls by more than this part of the largest one is a snap, and the one after it."""

DECKS: dict[str, Callable[[], str]] = {"krueger_dcb": literature.dcb_benchmark}
DECKS |= {f"mmb_{100 * ratio:.0f}": partial(literature.mmb_benchmark, ratio) for ratio in literature.MMB_CRITICAL}
DECKS |= {"circle": literature.circle, "dcb_100k": literature.large_dcb}
BEAMS = {case.name: case for case in space_beams.CASES}
DECKS |= {name: case.deck for name, case in BEAMS.items()}
"""By name."""


@dataclass(frozen=True, slots=True)
class Benchmark:
    """A deck that is run."""

    name: str

    def files(self) -> dict[str, str]:
        """Return the deck by name."""
        return {f"{self.name}.inp": DECKS[self.name]()}


@dataclass(frozen=True, slots=True)
class Row(StoredRow):
    """Row of the table: cost and results of a run.

    stopped     '' for a run to the end, else why not
    calm        iterations of an increment that is not a snap, attempts given up among them: mean
    cpu, wall   seconds; memory: largest resident set (MB)
    values      by quantity: the benchmark's value and that of the run
    """

    stopped: str
    unknowns: int
    increments: int
    cutbacks: int
    iterations: int
    calm: float
    cpu: float
    wall: float
    memory: float
    values: dict[str, tuple[float, float]]


def read_row(entry: Mapping[str, object]) -> Row:
    """Read the row of an entry of the store."""
    values = entry["values"]
    assert isinstance(values, dict)
    return Row(**{**entry, "values": {name: tuple(pair) for name, pair in values.items()}})  # type: ignore[arg-type]


def measure(deck: Benchmark, folder: Path) -> Row:
    """Run a deck in a process of its own, which has the time and the memory of the run alone."""
    place = folder / deck.name
    place.mkdir(parents=True, exist_ok=True)
    for name, content in deck.files().items():
        (place / name).write_text(content, encoding="ascii")
    words = ["run", str(place / f"{deck.name}.inp"), "--output-dir", str(place), "--fallback", "--quiet"]
    begun = time.perf_counter()
    command = [sys.executable, "-m", "uel", *words, "--same-process"]
    with (place / "output.txt").open("wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - begun
    result = Result(place / deck.name)
    stopped = "" if process.returncode == 0 else (place / "output.txt").read_text("utf-8").strip().splitlines()[-1]
    return Row(
        stopped,
        3 * len(result.mesh().points),
        measures.increments(result),
        measures.cutbacks(result),
        measures.iterations(result),
        calm_iterations(result, measures.load(result)),
        usage.ru_utime + usage.ru_stime,
        wall,
        usage.ru_maxrss / 1024.0,
        {} if stopped else values_of(deck.name, result),
    )


def calm_iterations(result: Result, load: FloatArray) -> float:
    """Return the mean number of iterations of an increment that is not a snap, with those of its attempts given up."""
    falls = -np.diff(load, prepend=0.0) > SNAP * np.abs(load).max()
    snap = falls | np.concatenate([[False], falls[:-1]])
    counts = np.zeros(len(load))
    places = {(row.step, row.increment): k for k, row in enumerate(row for row in result.status if not row.cutback)}
    for row in result.status:
        if (row.step, row.increment) in places:
            counts[places[row.step, row.increment]] += row.total_iterations
    return float(counts[~snap].mean())


def values_of(name: str, result: Result) -> dict[str, tuple[float, float]]:
    """Return the benchmark's values and those of a run, by quantity."""
    if name in BEAMS:
        return space_beam_measures.against_theory(BEAMS[name], result)
    if name.startswith("mmb"):
        ratio = float(name.removeprefix("mmb_")) / 100.0
        _, displacement, load = literature.MMB_CRITICAL[ratio]
        curve = literature.MMB_WIDTH * measures.load(result)
        where = float(-result.history["U3[LEVER]"][curve.argmax()])
        mix = literature_measures.first_mode_mix(result)
        return {
            "largest load (N)": (load, float(curve.max())),
            "at (mm)": (displacement, where),
            "G_II/G": (ratio, mix),
        }
    if name == "circle":
        rows = literature_measures.circle_radii(result)
        radii, loads, corrected = (np.array(values) for values in zip(*rows, strict=True))
        values = {}
        for radius in (22.0, 24.0, 26.0, 28.0):
            load, form = (float(np.interp(radius, radii, column)) for column in (loads, corrected))
            values[f"load at radius {radius:g} mm (N)"] = (literature.circle_load(), load)
            values[f"... with the compliance of the rim, {radius:g} mm (N)"] = (form, load)
        return values | {"radii differ by (mm)": (0.0, literature_measures.circle_roundness(result))}
    found = {"load at the displacement of a = {:g} mm (N)": literature_measures.loads_at_openings(result)}
    releases = {"G by Rice's integral along the front (N/mm)": literature_measures.front_release}
    if name == "krueger_dcb":
        # the large one has few fronts
        found["load at the compliance of a = {:g} mm (N)"] = literature_measures.loads_at_compliances(result)
        found["load at a front at a = {:g} mm (N)"] = literature_measures.mid_width_loads(result)
        releases["G by dissipation per area (N/mm)"] = literature_measures.dissipated_release
        releases["G by the compliance (N/mm)"] = literature_measures.compliance_release
    values = {
        quantity.format(length): (literature.DCB_CRITICAL[length][1], load)
        for quantity, loads in found.items()
        for length, load in loads.items()
    }
    return values | {key: (literature.DCB_TOUGHNESS, release(result)) for key, release in releases.items()}


HEAD = """<!-- SPDX-FileCopyrightText: The uel-harness authors -->
<!-- SPDX-License-Identifier: BSD-3-Clause -->
# Benchmarks in space

Delaminations with `U8` of infinite stiffness between `C3D8I`: Abaqus' default tolerances, no viscosity,
`uel run --fallback`. Pages of the specimens: [double cantilever beam](krueger_dcb/README.md),
[mixed-mode bending](krueger_mmb/README.md), [circular delamination](circle/README.md). `dcb_100k` is the double
cantilever beam on a finer mesh, until its crack is 33 mm long; its deck is built, not kept. The decks of
[beams on turned meshes](space_beams/README.md) are small; beam theory and the fracture energies are their benchmarks.

The linear solver is the one that `--solver auto` takes: PARDISO if it is installed (`pip install .[fast]`), as it was
here.

Written by `python -m uel.paper.benchmarks`, which keeps finished runs; times are of one thread, and the wall
clock that of the machine it ran on, with whatever else it did.

## Convergence and cost

No more than 5 attempts given up, and at most 5 iterations per increment away from snaps, are wanted. A snap is an
increment in which the load falls by more than 5 % of the largest one, and the increment after it; iterations of
attempts given up count.

"""


FRONT = """Krueger's cracks are straight and sharp. A front of damage 0.5 in the middle of the width is ahead of the one
that has the same compliance; [the page](krueger_dcb/README.md#position-of-the-front) says by how much, and why.
"""


def page(rows: Mapping[str, Row]) -> str:
    """Write the page of these rows, by name of the deck."""
    header = ("run", "unknowns", "increments", "given up", "iterations", "away from snaps", "CPU", "wall", "memory")
    lines = head(header)
    for name, row in rows.items():
        held = row.cutbacks <= 5 and row.calm <= 5.0 and not row.stopped
        cells = (f"`{name}`", f"{row.unknowns:,}", row.increments, row.cutbacks, f"{row.iterations}")
        mean = f"{row.calm:.2f}" + ("" if held else ", **not met**")
        cost = (f"{row.cpu:.0f} s", f"{row.wall / 60.0:.0f} min", f"{row.memory:.0f} MB")
        lines.append(line((*cells, mean, *cost)))
    for name, row in rows.items():
        if row.stopped:
            lines += ["", f"`{name}` stopped: {row.stopped}"]
    lines += ["", "## Against the benchmarks", "", FRONT]
    lines += head(("run", "quantity", "benchmark", "here", "difference"))
    for name, row in rows.items():
        for quantity, (expected, found) in row.values.items():
            away = f"{100.0 * (found / expected - 1.0):+.1f} %" if expected else ""
            lines.append(line((f"`{name}`", quantity, f"{expected:.4g}", f"{found:.4g}", away)))
    return HEAD + "\n".join(lines) + "\n"


def row_store(path: Path) -> Store[Row]:
    """Open the store of the rows in a file."""
    return Store(path, read_row)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code: 0 if all runs are complete, 1 if one is not, 2 on wrong usage."""
    parser = argparse.ArgumentParser(
        prog="python -m uel.paper.benchmarks",
        description="Run the benchmarks of the literature in space, and write their table.",
        epilog="An interrupted command resumes where it stopped.",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(DECKS)} (all of them)")
    parser.add_argument("--output-dir", type=Path, default=Path("benchmarks"), help="folder of the runs (benchmarks)")
    parser.add_argument("--page", type=Path, default=PAGE, help="file of the table, with the rows as .json beside it")
    parser.add_argument("--kept", action="store_true", help="run nothing: write the page of the rows kept")
    parser.add_argument("--workers", type=int, default=1, help="runs at a time (1)")
    options = parser.parse_args(arguments)
    for name in options.names:
        if name not in DECKS:
            parser.error(f"no benchmark {name}; expected one of {', '.join(DECKS)}")
    path: Path = options.page.with_suffix(".json")
    options.output_dir.mkdir(parents=True, exist_ok=True)
    if not options.kept:
        try:
            complete(
                [Benchmark(name) for name in options.names or DECKS],
                row_store(path),
                measure,
                options.output_dir,
                workers=options.workers,
                console=Console(),
                describe=_ending,
            )
        except UelError as error:
            print(f"benchmarks: {error}", file=sys.stderr)
            return 2
    rows = kept_rows(path)
    options.page.write_text(page(rows), encoding="utf-8")
    print(f"table: {options.page}")
    return int(any(row.stopped for row in rows.values()))


def kept_rows(path: Path) -> dict[str, Row]:
    """Return the rows of a file in the order of the decks, of whatever version of the sources."""
    entries = json.loads(path.read_text(encoding="utf-8"))
    return {name: read_row(entries[name]["row"]) for name in DECKS if name in entries}


def _ending(row: Row) -> str:
    return row.stopped or f"{row.increments} increments, {row.cutbacks} given up, {row.cpu:.0f} s"


if __name__ == "__main__":
    sys.exit(main())
