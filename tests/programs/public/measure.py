# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run one public user element, unmodified, and measure one quantity: `python measure.py FOLDER ROW` prints JSON.

Each row runs in a process of its own (see table.py), since user code may end its process.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uel import usersub
from uel.assembly import TolerantSystem
from uel.deck import read_deck
from uel.errors import UelError
from uel.model.model import Model
from uel.model.records import AttemptAbandoned, IncrementDone, Solution
from uel.output.files.sta_file import read_status
from uel.procedures import run_steps
from uel.usersub import guard_values

MANIFEST = Path(__file__).with_name("manifest.toml")
Row = dict[str, Any]
ATTEMPTS = {"what": "attempts"}
"""Quantity of a row that counts increments and cutbacks."""


@dataclass
class Outcome:
    """Outcome of a row: increments and cutbacks done, the figure (None without one), and the error ('' if none).

    expected is the figure of the row's reference run, None for a row without one.
    """

    increments: int = 0
    cutbacks: int = 0
    figure: float | None = None
    error: str = ""
    expected: float | None = None


def rows() -> dict[str, Row]:
    """Rows of the manifest by name."""
    return {row["name"]: row for row in tomllib.loads(MANIFEST.read_text("utf-8"))["row"]}


def missing(folder: Path, row: Row) -> list[str]:
    """Files of a row that are not in the folder."""
    root = folder / row["folder"]
    wanted = [row["deck"], *row["sources"], *row.get("files", ()), *([row["status"]] if "status" in row else [])]
    return [name for name in wanted if not (root / name).is_file()]


def measure(folder: Path, row: Row) -> Outcome:
    """Run a row, and its reference: the same quantity of another deck, or of the same one with built-in elements."""
    outcome = _run(folder, row)
    if "reference" in row and not outcome.error:
        other = {key: value for key, value in row.items() if key != "reference"} | row["reference"]
        reference = _run(folder, other)
        outcome.expected = reference.figure
        outcome.error = f"reference: {reference.error}" if reference.error else ""
    return outcome


def _run(folder: Path, row: Row) -> Outcome:
    """Run a deck and evaluate the quantity after every increment."""
    outcome = Outcome()
    lines: list[tuple[int, int]] = []
    values: list[tuple[float, float]] = []
    try:
        if row.get("only") == "read":
            outcome.figure = sum(len(group.labels) for group in read_deck(folder / row["folder"] / row["deck"]).groups)
            return outcome
        for model, record in _records(folder / row["folder"], row):
            if isinstance(record, AttemptAbandoned):
                outcome.cutbacks += 1
            if isinstance(record, IncrementDone):
                outcome.increments += 1
                lines.append((record.attempt, record.iterations))
                if "quantity" in row and row["quantity"] != ATTEMPTS:
                    values.append((record.total_time, _evaluate(model, record.solution, row["quantity"])))
                if outcome.increments == row.get("increments"):
                    break
    except UelError as error:
        outcome.error = str(error).splitlines()[0]
    if values:
        outcome.figure = _pick(values, row["quantity"]["pick"])
    if row.get("quantity") == ATTEMPTS and not outcome.error:
        outcome.figure = outcome.increments + outcome.cutbacks
    if "status" in row and not outcome.error:
        outcome.figure = _agreement(lines, folder / row["folder"] / row["status"])
    return outcome


def _records(root: Path, row: Row) -> Iterator[tuple[Model, Any]]:
    deck = root / row["deck"]
    with tempfile.TemporaryDirectory() as output:
        if "replace" in row:
            deck = _replaced(deck, row["replace"], Path(output))
        for name in row.get("files", ()):
            shutil.copy(root / name, output)
        model = read_deck(deck)
        sources = [root / name for name in row["sources"]] or None
        library = usersub.load(sources, job=deck.stem, output_dir=Path(output), deck=deck, zero_locals=True)
        try:
            with guard_values({}):
                for record in run_steps(TolerantSystem(model, library), model, library):
                    library.messages()
                    yield model, record
        finally:
            library.close()


def _replaced(deck: Path, pairs: list[tuple[str, str]], folder: Path) -> Path:
    """Copy of a deck in which each text, which must occur in it, is replaced."""
    text = deck.read_text("utf-8").replace("\r\n", "\n")
    for old, new in pairs:
        if old not in text:
            raise UelError(f"{deck} has no {old!r} to replace")
        text = text.replace(old, new)
    copy = folder / deck.name
    copy.write_text(text, encoding="utf-8")
    return copy


def _evaluate(model: Model, solution: Solution, quantity: Row) -> float:
    """Sum, smallest or largest of a nodal quantity of one dof over nodes; a sum of ENERGY; or an SVARS."""
    if "energy" in quantity:
        return float(solution.energies[quantity["energy"]])
    if "svars" in quantity:
        (group, row), *_ = (
            (k, row)
            for k, group in enumerate(model.groups)
            for row in np.flatnonzero(group.labels == quantity["element"])
        )
        return float(solution.elements[group].svars[row, quantity["svars"] - 1])
    if "nset" in quantity:
        nodes = model.nsets[quantity["nset"].upper()]
    elif "nodes" in quantity:
        nodes = np.flatnonzero(np.isin(model.mesh.labels, quantity["nodes"]))
    else:
        nodes = np.arange(len(model.mesh.labels))
    chosen = np.isin(solution.node, nodes) & (solution.dof == quantity["dof"])
    values = {"RF": solution.reaction, "U": solution.displacement}[quantity["what"]][chosen]
    reduced = {"sum": np.sum, "min": np.min, "max": np.max}[quantity["over"]](values)
    return float(reduced) * float(quantity.get("factor", 1.0))


def _pick(values: list[tuple[float, float]], which: str | float) -> float:
    """The value of the largest magnitude ('peak'), the last one ('end'), or the one at a total time."""
    if which == "end":
        return values[-1][1]
    if which == "peak":
        return max((value for _, value in values), key=abs)
    times, found = np.array(values).T
    return float(np.interp(float(which), times, found))


def _agreement(lines: list[tuple[int, int]], status: Path) -> float:
    """Share of the increments of Abaqus' status file that ended with as many iterations in the same attempt here."""
    theirs = [(row.attempt, row.total_iterations) for row in read_status(status) if not row.cutback]
    same = sum(ours == other for ours, other in zip(lines, theirs, strict=False))
    return same / max(len(theirs), len(lines))


if __name__ == "__main__":
    print(json.dumps(asdict(measure(Path(sys.argv[1]), rows()[sys.argv[2]]))))
