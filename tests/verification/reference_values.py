# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reference values of the decks of abaqus_inputs: one reference.toml in each folder.

A file holds a table `[[value]]` for each quantity:

decks      decks it holds for
quantity   name in `uel.paper.measures`, or a column of the history, or RF3[SET] for the sum over a node set;
           of columns the last value is meant, or that at the time `at`
against    deck to compare with, where the quantity is a comparison
value, unit
relative, absolute  tolerance, one of them
why        why the tolerance is what it is
kind       'analytic', 'paper figure', 'other code', 'regression'
source     where the value comes from

and at its head `long`, the decks that take too long for the quick tests, `fallback`, true where the decks are run
with `uel run --fallback`, and `unsettled`, the decks of which rounding decides whether they come to their end.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.measures import COMPARISONS, QUANTITIES

ENTRIES = {"decks", "quantity", "value", "unit", "why", "kind", "source"}
KINDS = ("analytic", "paper figure", "other code", "regression")


@dataclass(frozen=True, slots=True)
class Reference:
    """One value of one deck; `tolerance` is absolute."""

    deck: Path
    quantity: str
    against: Path | None
    at: float | None
    value: float
    tolerance: float
    unit: str
    why: str
    kind: str
    source: str

    def measure(self, run: Callable[[Path], Result]) -> float:
        """The quantity from a run of the deck; `run` gives the result of a deck."""
        result = run(self.deck)
        if self.against is not None:
            return COMPARISONS[self.quantity](result, run(self.against))
        if self.quantity in QUANTITIES:
            return QUANTITIES[self.quantity](result)
        history = result.history
        columns = [name for name in history if name == self.quantity or name.startswith(f"{self.quantity[:-1]}:")]
        if not columns:
            raise KeyError(self.quantity)
        row = self._row(history["time"])
        return float(sum(history[name][row] for name in columns))

    def _row(self, times: FloatArray) -> int:
        """The increment that is meant. ValueError where none ends at its time."""
        if self.at is None:
            return -1
        found = np.flatnonzero(np.isclose(times, self.at, rtol=1e-9))
        if not found.size:
            raise ValueError(f"{self.deck.name}: no increment ends at {self.at}")
        return int(found[0])


class References(NamedTuple):
    """References of a folder of decks, deck by deck; its long decks, whether all need the fall-back, unsettled ones."""

    values: list[Reference]
    long: set[Path]
    fallback: bool
    unsettled: set[Path]


def read_references(folder: Path) -> References:
    """What reference.toml of a folder says.

    Raises
    ------
    ValueError
        A value lacks an entry or has one that is not known.
    """
    file = folder / "reference.toml"
    content = tomllib.loads(file.read_text(encoding="utf-8"))
    references = [
        _reference(folder, entry, deck, f"{file}: {entry.get('quantity')}")
        for entry in content["value"]
        for deck in entry["decks"]
    ]
    ordered = sorted(references, key=lambda reference: (reference.deck, str(reference.against or "")))
    long, unsettled = ({folder / deck for deck in content.get(name, ())} for name in ("long", "unsettled"))
    return References(ordered, long, content.get("fallback", False), unsettled)


def _reference(folder: Path, entry: dict[str, object], deck: str, place: str) -> Reference:
    given = set(entry)
    tolerances = given & {"relative", "absolute"}
    if given - tolerances - {"against", "at"} != ENTRIES or len(tolerances) != 1:
        wanted = ", ".join(sorted(ENTRIES))
        raise ValueError(f"{place}: expected {wanted}, and relative or absolute; against and at are optional")
    if entry["kind"] not in KINDS:
        raise ValueError(f"{place}: kind '{entry['kind']}' is none of {', '.join(KINDS)}")
    value = float(str(entry["value"]))
    tolerance = float(str(entry["absolute"])) if "absolute" in given else abs(value) * float(str(entry["relative"]))
    against = folder / str(entry["against"]) if "against" in given else None
    if against is not None and entry["quantity"] not in COMPARISONS:
        raise ValueError(f"{place}: no comparison of that name; expected one of {', '.join(COMPARISONS)}")
    at = float(str(entry["at"])) if "at" in given else None
    texts = (str(entry[key]) for key in ("unit", "why", "kind", "source"))
    return Reference(folder / deck, str(entry["quantity"]), against, at, value, tolerance, *texts)
