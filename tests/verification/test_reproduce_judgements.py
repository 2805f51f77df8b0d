# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel reproduce`: its figures compare like with like, and what its page says follows from the numbers beside it."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from harness import usersub
from harness.delamination import law
from harness.delamination.materials import TABLE_2, Cohesive
from harness.delamination.reproduce import figures, runs
from harness.delamination.reproduce.cases import ELEMENTS, SHOWN, PaperCase
from harness.delamination.reproduce.damage import stiffness_lost, toughness_spent
from harness.delamination.reproduce.runs import AnyCase, Entry, Run, Runs
from harness.model.arrays import FloatArray
from harness.output import Result
from harness.output.plots import Panel

ENDED = Entry("", 1, 1, 0, 0.0)


@pytest.fixture(autouse=True)
def no_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """The runs of these tests have no files."""
    monkeypatch.setattr(runs, "Result", lambda stem: SimpleNamespace(stem=stem))


def run_of(case: PaperCase, **columns: Sequence[float]) -> Run:
    """A run with one profile."""
    run = Run(case, ENDED, Path())
    profile = {name: np.array(values) for name, values in columns.items()}
    run._result = cast("Result", SimpleNamespace(interfaces=lambda: [profile]))
    return run


@pytest.mark.parametrize("stiffness", [1e4, 1e6, 1e8])
def test_two_definitions_of_damage(stiffness: float) -> None:
    """Mode I of the bilinear law: 1 - t/(alpha w), and the dissipated share of the area below the law."""
    cohesive = TABLE_2.with_stiffness(stiffness)
    strength, toughness = cohesive.strength_normal, cohesive.toughness_1
    onset, end = strength / stiffness, 2.0 * toughness / strength
    separation = np.linspace(onset, end, 9)
    traction = strength * (end - separation) / (end - onset)
    below = 0.5 * strength * onset + 0.5 * (strength + traction) * (separation - onset)
    lost, spent = 1.0 - traction / (stiffness * separation), (below - 0.5 * traction * separation) / toughness
    # 1 - d has the rounding of d, of which the division by q makes more
    assert toughness_spent(lost, cohesive) == pytest.approx(spent, abs=1e-15 * stiffness)
    assert stiffness_lost(spent, cohesive) == pytest.approx(lost, abs=1e-9)


def test_damage_of_a_rigid_interface() -> None:
    rigid = Cohesive(0.0, 0.0)
    assert stiffness_lost(np.array([0.0, 1e-6, 0.5, 1.0]), rigid).tolist() == [0.0, 1.0, 1.0, 1.0]


def test_elements_have_one_damage_when_they_are_opened_alike() -> None:
    """What U2 and the consistent U4 write for a point half-way to failure, in mixed mode."""
    end = 2.0 * TABLE_2.toughness_1 / TABLE_2.strength_normal
    path = np.linspace([0.0, 0.0], [0.5 * end, 0.3 * end], 200)
    written = {}
    with closing(usersub.load(None, job="damage", output_dir=Path(tempfile.gettempdir()))) as library:
        for kind, jtype in (("standard", 2), ("consistent", 4)):
            element = law.LawElement(library, jtype, law.standard_properties())
            written[kind] = law.drive(element, "", path, 1.0).columns
    assert written["consistent"]["DAMAGE"][-1] < 0.9 < written["standard"]["DAMAGE"][-1]
    # the consistent law's own separation is what is driven where the stress of the solids is that of the interface
    cases = {kind: PaperCase("dcb", "0/0", kind, "1e6") for kind in written}
    lost = {
        kind: run_of(cases[kind], DAMAGE=columns["DAMAGE"].tolist()).profiles[0]["LOST"]
        for kind, columns in written.items()
    }
    assert lost["consistent"] == pytest.approx(lost["standard"], abs=1e-6)


@pytest.mark.parametrize("element", ["standard", "paper", "consistent", "COH2D4", "consistent_bk"])
def test_a_profile_has_both_damages(element: str) -> None:
    case = PaperCase("dcb", "0/90", element, "1e6")
    damages = [1.0, 0.5, 0.0]
    profile = run_of(case, DAMAGE=damages).profiles[0]
    own = element.startswith("consistent")
    assert profile["SPENT" if own else "LOST"].tolist() == damages
    ratio = 1.0 / (2.0 * 0.26 * 1e6 / 30.0**2 - 1.0)
    other = 0.5 * (1.0 + ratio) / (0.5 + ratio) if own else 0.5 * ratio / (0.5 + ratio)
    assert profile["LOST" if own else "SPENT"] == pytest.approx([1.0, other, 0.0])


class Drawn:
    """Stands for `plots.grid`: keeps the panels."""

    def __init__(self) -> None:
        self.panels: list[Panel] = []

    def __call__(self, rows: Sequence[Sequence[Panel]], path: Path, **_: object) -> Path:
        self.panels += [panel for row in rows for panel in row]
        return path


class Loaded(Runs):
    """Runs of which there is a load curve."""

    def __init__(self, load: Mapping[str, FloatArray]) -> None:
        super().__init__({}, Path())
        self._load = load

    def __contains__(self, case: AnyCase) -> bool:
        return True

    def __getitem__(self, case: PaperCase) -> Run:
        run = Run(case, ENDED, Path())
        run.load = self._load[case.element]
        run.displacement = np.linspace(0.0, 1.0, len(run.load))
        return run


@pytest.mark.parametrize("problem", ["dcb", "enf", "frmm"])
def test_load_figures_show_all_elements(problem: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # one load for each element, and a peak that every 40th point misses
    peaked = np.concatenate([np.linspace(0.0, 8.0, 1002), np.linspace(4.0, 3.0, 20)])
    loads = {name: factor * peaked for factor, name in enumerate((*ELEMENTS, "COH2D4"), 1)}
    monkeypatch.setattr(figures, "grid", drawn := Drawn())
    figures.draw_loads(Loaded(loads), PaperCase(problem, "0/0", "paper", "1e8"), Path())
    assert [panel.title for panel in drawn.panels] == [
        f"[{layup}], {element}" for layup in ("0/0", "0/90") for element in ELEMENTS
    ]
    for panel in drawn.panels:
        element = panel.title.split(", ")[1]
        shown = {curve.label: np.asarray(curve.y) for curve in panel.curves}
        assert [label for label in shown if label.endswith("N/mm³")] == [f"{stiffness} N/mm³" for stiffness in SHOWN]
        assert (shown["1e4 N/mm³"] == loads[element]).all()
        assert ("corrected beam theory" in shown) == panel.title.startswith("[0/0]")
        assert shown["COH2D4 1e6, its own criterion"].max() == loads["COH2D4"].max()
