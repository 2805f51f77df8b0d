# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel reproduce`: its figures compare like with like, and what its page says follows from the numbers beside it."""

from __future__ import annotations

import io
import math
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from rich.console import Console

from uel import usersub
from uel.delamination import law
from uel.delamination.damage import stiffness_lost, toughness_spent
from uel.delamination.materials import TABLE_2, Cohesive
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.plots import Panel
from uel.paper.reproduce import advice, curves, figures, findings, parameters, runs, sensitivity, tables
from uel.paper.reproduce.advice import Point, settled
from uel.paper.reproduce.cases import ELEMENTS, SHOWN, PaperCase
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.runs import AnyCase, Entry, Run, Runs
from uel.paper.reproduce.statements import JudgedStatement, read_statements

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
    assert profile["SOFTENED" if own else "LOST"].tolist() == damages
    ratio = 1.0 / (2.0 * 0.26 * 1e6 / 30.0**2 - 1.0)
    other = 0.5 * (1.0 + ratio) / (0.5 + ratio) if own else 0.5 * ratio / (0.5 + ratio)
    assert profile["LOST" if own else "SOFTENED"] == pytest.approx([1.0, other, 0.0])


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


def judged(name: str, value: float, **also: float) -> JudgedStatement:
    """A statement of the file with these numbers; those that are not given are NaN, in no range."""
    found = next(statement for statement in read_statements() if statement.id == name)
    assert set(also) <= {number.name for number in found.also}
    return JudgedStatement(found, value, tuple((number, also.get(number.name, math.nan)) for number in found.also))


@pytest.mark.parametrize("name", ["dcb-damage-standard", "dcb-cross-damage", "enf-damage-standard", "enf-cross-damage"])
def test_nothing_is_damaged_where_the_damage_falls_steadily(name: str) -> None:
    assert "damages nothing" in judged(name, 0.0, moment=0.0).why
    # the number of the quick double cantilever beam of [0/90], below which that stood
    damaged = judged(name, 0.25188, moment=0.0)
    assert damaged.reproduced
    assert damaged.why == "The damage turns back at other moments than that of the figure."
    assert judged(name, 0.3, moment=0.2).why == "The damage turns back at the moment of the figure too."


def test_remarks_have_their_numbers() -> None:
    soft = judged("dcb-standard-soft", 1.0515, soft=1.0515, middle=1.0, ever=1.85)
    assert "1.052 of the consistent element's at 1e4" in soft.why
    assert "it is 1.850" in soft.why
    assert judged("dcb-standard-soft", 1.01, ever=1.01).why == ""
    share = judged("dcb-coh2d4", 0.03, share=0.25, criteria=-0.041, alike=0.019).why
    assert "25% of the energy in mode II" in share
    assert "-4% off" in share
    assert "With the same criterion the elements agree." in share
    assert "the elements agree" not in judged("dcb-coh2d4", 0.03, share=0.2, criteria=0.1, alike=0.021).why
    early = judged("enf-methods", 0.03, flat=0.014, paper=-0.023, consistent=0.006).why
    assert "snaps earlier, its peak load differing by -2.3%" in early
    assert (
        judged("enf-methods", 0.01, flat=0.01, paper=0.0).why == "2 % of the peak load is a line's width in the figure."
    )
    assert "comes to its end" not in judged("secant-tolerance", 0.4, mild=0.44, relaxed=0.54).why
    assert "comes to its end" in judged("secant-tolerance", 0.4, mild=1.0, relaxed=1.0).why


def test_remarks_hold_for_some_numbers() -> None:
    """Every remark of the file appears for some numbers, and one with a condition not for all."""
    for statement in read_statements():
        for remark in statement.remarks:
            lowest = {
                name: low if low > -math.inf else min(high, 0.0) - 1.0 for name, (low, high) in remark.limits.items()
            }
            values = dict.fromkeys(remark.names(), 0.0) | lowest
            verdict = remark.reproduced is not False
            assert remark.holds(values, reproduced=verdict), (statement.id, remark.text)
            if remark.limits:
                assert not remark.holds(dict.fromkeys(values, math.nan), reproduced=verdict)
            if remark.names():
                assert not remark.holds({}, reproduced=verdict)


@pytest.mark.parametrize(
    ("why", "message"),
    [
        ("[{ when = { value = { below = 1 } } }]", "bad: why: expected text, and when with reproduced or numbers"),
        ('[{ text = "a", when = { value = { at_most = 1 } } }]', "bad: why: expected text, .* 'below'"),
        ('[{ text = "a", then = 1 }]', "bad: why: expected text"),
        ('"{share:.0%}"', r"bad: why: no number is named \['share'\]; there are \['value'\]"),
        ('[{ text = "a", when = { peak = { below = 1 } } }]', r"bad: why: no number is named \['peak'\]"),
    ],
)
def test_bad_remarks_are_refused(tmp_path: Path, why: str, message: str) -> None:
    file = tmp_path / "statements.toml"
    file.write_text(
        '[[statement]]\nid = "bad"\nsection = "1"\nfigure = ""\nquote = "a"\nnumber = "b"\n'
        f'measure = "isotropy"\nat_most = 1\ncases = []\nwhy = {why}\n'
    )
    with pytest.raises(ValueError, match=message):
        read_statements(file)


def test_criteria_of_benzeggagh_and_kenane_and_11() -> None:
    # a quarter of the energy in mode II: 0.26 + 0.742/16 over 1/(0.75/0.26 + 0.25/1.002)
    profile = {"DAMAGE": [1.0, 1.0, 0.5], "DISSI": [0.2, 0.1, 9.0], "DISSII": [0.04, 0.06, 9.0]}
    case = PaperCase("dcb", "0/90", "paper", "1e6")
    evidence = cast("Evidence", SimpleNamespace(run=lambda *_: run_of(case, **profile)))
    assert findings.mode_two_share(evidence, "dcb", "0/90", "paper") == pytest.approx(0.25)
    expected = (0.26 + 0.742 / 16.0) * (0.75 / 0.26 + 0.25 / 1.002) - 1.0
    assert findings.criteria_apart(evidence, "dcb", "0/90", "paper") == pytest.approx(expected)


def points(*values: tuple[str, float, float], sampled: float = 1.0) -> list[Point]:
    """Values with peak load and variation; the run's own increments see a share of the peak."""
    return [Point(value, peak, sampled * peak, variation, 40.0) for value, peak, variation in values]


def test_advice_on_lengths() -> None:
    fine = points(("0.5", 53.0, 90.0), ("0.25", 50.2, 90.0), ("0.125", 50.1, 90.0), ("0.0625", 50.0, 90.0))
    coarse = points(("0.5", 53.0, 90.0), ("0.25", 51.0, 90.0))
    text = advice.on_lengths({"DCB, standard": fine, "ENF, paper": coarse})
    assert "from these lengths on: DCB, standard: 0.25 mm." in text
    assert "ENF, paper: by the last refinement still -3.8% of the peak load and +0.0% of the slope; take" in text
    # that one length agrees by chance settles nothing
    assert settled(points(("1", 50.0, 1.0), ("0.5", 60.0, 1.0), ("0.25", 50.0, 1.0))) is None


def test_advice_on_increments() -> None:
    text = advice.on_increments({"DCB": [Point("25", 50.0, 48.0, 1.0, 40.0), Point("50", 50.1, 49.9, 1.0, 40.0)]})
    assert "these numbers change by 0.2% at most" in text
    assert "DCB: as their own load curves have it, 25 increments give -4.0%, 50 -0.4%; within 1% from 50 on." in text
    assert "none within 1%" in advice.on_increments({"DCB": [Point("25", 50.0, 48.0, 1.0, 40.0)]})


def test_advice_on_stiffness() -> None:
    rough = points(("1e4", 50.0, 70.0), ("1e6", 50.1, 90.0), ("1e8", 50.1, 110.0))
    smooth = points(("1e4", 52.0, 70.0), ("1e6", 50.1, 80.0), ("inf", 50.1, 82.0))
    text = advice.on_stiffness(
        {"standard": rough, "consistent": smooth, "paper": points(("1", 5.0, 1.0), ("2", 6.0, 1.0))}
    )
    assert (
        "standard: peak load and slope are settled from 1e4 on, while the traction varies more and more, 90 to 110 MPa"
        in text
    )
    assert (
        "consistent: peak load and slope are settled from 1e6 on, and up to inf the traction's variation settles"
        in text
    )
    assert "paper: not settled; up to 2 the peak load changes by +20.0%, the slope by +0.0%." in text


def test_a_compliant_interface_is_not_stiff_enough() -> None:
    """Same peak loads, but the softest interface bends the rise."""
    soft, *stiff = points(("1e4", 50.0, 70.0), ("1e6", 50.0, 70.0), ("1e8", 50.0, 70.0))
    assert settled([replace(soft, slope=38.0), *stiff]) == stiff[0]
    assert settled([soft, *stiff]) == soft


def test_advice_on_strength() -> None:
    assert "changes by 6.0% (DCB). Measure" in advice.on_strength(
        {"DCB": points(("0.5", 50.0, 1.0), ("1.5", 53.0, 1.0))}
    )
    assert "need not be known" in advice.on_strength({"DCB": points(("0.5", 50.0, 1.0), ("1.5", 50.1, 1.0))})


def test_advice_on_a_choice() -> None:
    alike = points(("Gauss", 50.0, 90.0), ("Newton-Cotes", 50.0, 89.0))
    better = points(("Gauss", 50.0, 110.0), ("Newton-Cotes", 51.0, 70.0))
    assert advice.on_choice({"paper": alike}, "Gauss").startswith("Keep the default, Gauss:")
    text = advice.on_choice({"paper": alike, "standard": better}, "Gauss")
    assert "Keep" not in text
    assert "standard: with Newton-Cotes the traction varies less than with the default, 110 to 70 MPa" in text
    assert "changes by +2.0%" in text
    assert "has not finished" in advice.on_choice({"paper": alike[1:]}, "Gauss")


def test_trends_follow_from_the_numbers() -> None:
    assert tables.nearer_to_beams([0.07, 0.03, 0.01]).startswith("the longer the crack, the less")
    assert "does not count for less" in tables.nearer_to_beams([0.03, 0.07])


def loaded(case: PaperCase, displacement: Sequence[float], load: Sequence[float]) -> Run:
    """A run with a load curve."""
    run = Run(case, ENDED, Path())
    run.displacement, run.load = np.array(displacement), np.array(load)
    return run


def test_a_peak_is_passed_in_small_increments() -> None:
    case = PaperCase("dcb", "0/0", "consistent", "inf", coarse=True)
    run = loaded(case, [0.0, 0.6, 1.2, 1.26, 1.32, 1.38], [0.0, 25.0, 48.6, 50.5, 50.8, 47.0])
    passing = run.around_peak
    assert passing is not None
    assert passing.window == pytest.approx((1.26, 1.38, 0.002 * 1.32))
    assert passing.name == f"{case.name}_peak"
    # a curve that still rises has no peak yet
    assert loaded(case, [0.0, 0.6, 1.2, 1.26], [0.0, 25.0, 48.6, 50.5]).around_peak is None
    deck = passing.files()[f"{passing.name}.inp"]
    assert deck.count("*STEP") == deck.count("*END STEP") == 2
    starts = [
        line for line, before in zip(deck.splitlines()[1:], deck.splitlines(), strict=False) if before == "*STATIC"
    ]
    first, second = ([float(word) for word in line.split(",")] for line in starts)
    # 3 mm in 50 increments up to 1.26 mm; then 0.00264 mm at a time
    assert (first[0], first[3]) == pytest.approx((0.06 / 1.26, 0.06 / 1.26), rel=1e-4)
    assert (second[0], second[3]) == pytest.approx((0.00264 / 0.12, 0.00264 / 0.12), rel=1e-4)
    moved = [float(line.split(",")[3]) for line in deck.splitlines() if line.startswith("LOAD_TOP, 2, 2,")]
    assert moved == pytest.approx([1.26, 1.38])


def test_compared_peaks_are_those_in_small_increments(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Two stiffnesses whose increments sample one peak differently."""
    one, other = (PaperCase("dcb", "0/0", "paper", stiffness, coarse=True) for stiffness in ("1e8", "1e12"))
    curves = {
        one: ([0.0, 0.6, 1.2, 1.26, 1.32], [0.0, 25.0, 48.6, 50.5, 48.0]),
        other: ([0.0, 0.6, 1.2, 1.29, 1.32], [0.0, 25.0, 48.6, 51.1, 48.0]),
    }
    ran: list[AnyCase] = []

    def complete(cases: Sequence[AnyCase], *_: object, **__: object) -> dict[AnyCase, Entry]:
        ran.extend(cases)
        return dict.fromkeys(cases, ENDED)

    class Read(Run):
        def __init__(self, case: PaperCase, entry: Entry, folder: Path) -> None:
            super().__init__(case, entry, folder)
            curve = curves.get(case, ([0.0, 1.26, 1.3, 1.32], [0.0, 50.5, 51.2, 50.0]))
            self.displacement, self.load = map(np.array, curve)

    monkeypatch.setattr(runs, "complete", complete)
    monkeypatch.setattr(runs, "Run", Read)
    found = runs.run_cases([one, other], tmp_path, 1, Console(file=io.StringIO()), peaks=[one, other])
    assert [case.name for case in ran[2:]] == [f"{one.name}_peak", f"{other.name}_peak"]
    assert (found[one].peak[0], found[other].peak[0]) == (50.5, 51.1)
    assert found.peak(one) == found.peak(other) == 51.2
    assert parameters.stiff_load(Evidence(found, coarse=True), ["dcb"]) == 0.0


@pytest.mark.parametrize("coarse", [True, False])
def test_no_statement_compares_peaks_of_coarse_increments(coarse: bool) -> None:
    studied = set(sensitivity.cases(coarse=coarse))
    others = {"methods_peak_difference": "standard", "peak_difference": "COH2D4"}
    for number in (number for statement in read_statements() for number in (statement.number, *statement.also)):
        words = number.arguments
        if number.measure in others:
            problem, layup = str(words["problem"]), str(words["layup"])
            pair = {
                PaperCase(problem, layup, element, "1e6", coarse=coarse)
                for element in (str(words["element"]), others[number.measure])
            }
            assert pair <= set(curves.compared(problem, coarse=coarse)), number.text
        elif number.measure == "strength_effect":
            case = PaperCase(str(words["problem"]), "0/0", "consistent", "inf", coarse=coarse)
            assert {case, replace(case, strength=cast("float", words["strength"]))} <= studied, number.text
        elif number.measure == "stiff_load":
            for problem in cast("Sequence[str]", words["problems"]):
                assert {PaperCase(problem, "0/0", "paper", s, coarse=coarse) for s in ("1e8", "1e12")} <= studied
