# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.energy`: whether the work of the loads is what a model stores and dissipates.

The balance of a run is -ETOTAL/ALLWK at its end: what is missing of the work. ALLWK is summed by the trapezoidal
rule, and the path of a point within an increment is not known, so that some is missing in large increments: runs with
more of them tell what is left. The fall is the largest one of the load in an increment, over the largest load, in the
run with the most increments. A structure that snaps loses energy, which is in motion then: its balance is no error.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
from rich.console import Console

from uel.delamination.markdown import head, line
from uel.output import Result
from uel.paper.elastica import elastica_deck
from uel.paper.measures import load
from uel.paper.run_deck import run_deck
from uel.paper.space_beams import CASES, SpaceBeam
from uel.paper.study.cases import INCREMENTS, KINDS, LAWS, deck_files, interface_of, mesh_of
from uel.paper.study.options import study_parser, write_tables

COUNTS = (100, 200, 400)
"""Numbers of increments."""

REQUEST = "*OUTPUT, HISTORY\n*ENERGY OUTPUT\nALLWK, ETOTAL\n*END STEP"
"""End of a step, with what the balance needs."""

MARK = "\n## Table\n"
"""Line of a page above its table."""

COLUMNS = ("model", "interface", "law", *(f"{count} increments" for count in COUNTS), "fall")


class Model(Protocol):
    """A model of the table: cells of its row, and its deck by the number of increments."""

    @property
    def cells(self) -> tuple[str, str, str]:
        """Model, interface, law."""

    def files(self, count: int) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""


@dataclass(frozen=True, slots=True)
class PlaneModel:
    """A specimen of the study, by the keys of its tables."""

    specimen: str
    layup: str
    element: str = "consistent"
    stiffness: str = "inf"
    law: str = "linear"
    mesh: str = "structured"

    @property
    def cells(self) -> tuple[str, str, str]:
        """Model, interface, law."""
        model = f"{self.specimen} [{self.layup}]" + (", perturbed" if self.mesh == "perturbed" else "")
        return model, f"{self.element}, {self.stiffness}", self.law

    def files(self, count: int) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        law, eta = LAWS[self.law]
        interface = replace(interface_of(self.element, self.stiffness), law=law, eta=eta)
        kind, part = KINDS[self.specimen], 1.0 / count
        increments = replace(INCREMENTS, initial=part, largest=part, limit=20 * count)
        mesh = mesh_of(kind, self.mesh)
        return deck_files(name_of(self, count), "energy", kind, self.layup, mesh, interface, increments=increments)


@dataclass(frozen=True, slots=True)
class SpaceModel:
    """A beam in space."""

    beam: SpaceBeam

    @property
    def cells(self) -> tuple[str, str, str]:
        """Model, interface, law."""
        return f"{self.beam.problem} in space [{self.beam.plies.replace('_', '/')}]", "consistent, inf", "bk"

    def files(self, count: int) -> dict[str, str]:
        """Return the deck `NAME.inp`."""
        part = 1.0 / count
        return {f"{name_of(self, count)}.inp": self.beam.deck(static=(part, 1.0, 1e-6, part))}


@dataclass(frozen=True, slots=True)
class FoldedModel:
    """A double cantilever beam in large rotations."""

    @property
    def cells(self) -> tuple[str, str, str]:
        """Model, interface, law."""
        return "dcb, NLGEOM", "consistent, inf", "linear"

    def files(self, count: int) -> dict[str, str]:
        """Return the deck `NAME.inp`."""
        return {f"{name_of(self, count)}.inp": elastica_deck("U4", 1.0 / count)}


def models() -> Iterator[Model]:
    """Yield all models: each specimen and layup, the laws, elements and meshes where most happens, space, NLGEOM."""
    for specimen in ("dcb", "dcb025", "enf", "frmm"):
        for layup in ("0/0", "0/90"):
            yield PlaneModel(specimen, layup)
    for specimen in ("dcb", "frmm"):
        for law in ("bk", "exponential", "ppr"):
            yield PlaneModel(specimen, "0/0", law=law)
        yield PlaneModel(specimen, "0/0", mesh="perturbed")
    yield PlaneModel("dcb", "0/90", mesh="perturbed")
    yield PlaneModel("dcb", "0/90", stiffness="1e4")
    yield PlaneModel("frmm", "0/0", stiffness="1e4")
    for specimen, layup in (("dcb", "0/90"), ("frmm", "0/0")):
        yield PlaneModel(specimen, layup, "standard", "1e6")
    yield from (SpaceModel(beam) for beam in CASES if not beam.turned)
    yield FoldedModel()


def name_of(model: Model, count: int) -> str:
    """Return the name of a deck."""
    return re.sub(r"[^0-9a-z]+", "_", " ".join([*model.cells, str(count)]).lower())


@dataclass(frozen=True, slots=True)
class _Deck:
    name: str
    content: dict[str, str]

    def files(self) -> dict[str, str]:
        return self.content


@dataclass(frozen=True, slots=True)
class Balance:
    """Missing share of the work at the end, and the largest fall of the load over the largest load."""

    missing: float
    fall: float


def balance_of(result: Result) -> Balance:
    """Return the balance of a run."""
    history, loads = result.history, load(result)
    fall = float(np.max(-np.diff(loads, prepend=0.0)) / loads.max())
    return Balance(float(-history["ETOTAL"][-1] / history["ALLWK"][-1]), fall)


def run_model(model: Model, count: int, folder: Path) -> Balance | None:
    """Run a model with a number of increments, with the fall-back; None if it stops before its end."""
    name, files = name_of(model, count), model.files(count)
    files[f"{name}.inp"] = files[f"{name}.inp"].replace("*END STEP", REQUEST)
    deck = _Deck(name, files)
    outcome = run_deck(deck, folder, fallback=True)
    return None if outcome.stopped else balance_of(outcome.result)


def row(model: Model, found: Sequence[Balance | None]) -> str:
    """Return the row of a model, by the numbers of increments."""
    cells = ["stops" if each is None else f"{100.0 * each.missing:+.3f} %" for each in found]
    last = next((each for each in reversed(found) if each is not None), None)
    return line([*model.cells, *cells, "" if last is None else f"{100.0 * last.fall:.1f} %"])


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all models and print the table; returns the exit code."""
    description = "The work of the loads against the energies that models store and dissipate."
    parser = study_parser("uel.paper.study.energy", description, "study/energy")
    parser.add_argument("--only", default="", metavar="TEXT", help="models whose first cells have this text")
    parser.add_argument("--page", type=Path, help="file whose table is written again, that below its mark")
    options = parser.parse_args(arguments)
    rows = []
    for model in models():
        if options.only not in " ".join(model.cells):
            continue
        rows.append(row(model, [run_model(model, count, options.output_dir) for count in COUNTS]))
        Console().print(rows[-1], soft_wrap=True)
    if options.page:
        write_tables(options.page, MARK, "\n".join([*head(COLUMNS), *rows]) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
