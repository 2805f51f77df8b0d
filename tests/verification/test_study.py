# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The parameter study: its rows, what is measured of a run, what is checked, and that it goes on where it stopped."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from harness.delamination.oscillation import total_variation
from harness.delamination.study import cases as study
from harness.delamination.study.__main__ import main
from harness.delamination.study.cases import Case, all_cases, select
from harness.delamination.study.criteria import check, index_ratios
from harness.delamination.study.digests import ratios, variations, viscosity
from harness.delamination.study.reference import FOLDER, ReferenceRun, reference_of, restricted
from harness.delamination.study.refinement import Bonded, bonded, facet_means, on_facets, turned
from harness.delamination.study.rows import (
    Row,
    at_tenths,
    bonded_part,
    damage_variation,
    measure,
    oscillations,
    same_moments,
)
from harness.delamination.study.runner import reference_store, row_store
from harness.delamination.study.tables import csv_table, markdown_tables
from harness.errors import UelError
from harness.output.status import StatusRow

CASE = Case("frmm", "0/0", "1e6", "paper", "structured", "newton")
GOOD = Row(
    reached=1.0,
    stopped="",
    increments=100,
    iterations=200,
    cutbacks=0,
    snaps=0,
    snap_iterations=0,
    peak_load=100.0,
    peak_displacement=2.0,
    final_load=80.0,
    dissipation_error=0.002,
    balance_error=0.001,
    index_n=1.0,
    index_t=1.0,
    error_n=1.5,
    error_t=1.5,
    raw_n=1.0,
    raw_t=1.0,
    variation_n=69.0,
    variation_t=100.0,
    real_n=69.0,
    real_t=100.0,
    difference_n=30.0,
    difference_t=50.0,
    damage_variation=1.0,
    peak_n=30.0,
    peak_t=60.0,
    seconds=1.0,
)


def test_all_combinations_are_there_once() -> None:
    cases = all_cases()
    # 4 specimens, 2 layups, 2 meshes; 4 stiffnesses of 2 elements and 5 of the consistent one with 2 solutions, and
    # the fifth with 3 viscosities; 3 other laws in 2 specimens with 3 solutions
    assert len(cases) == len(set(cases)) == 4 * 2 * 2 * (4 * 2 * 2 + 5 * 2 + 3) + 3 * 2 * 3
    assert {case.stiffness for case in cases if case.law != study.OWN_LAW} == {"inf"}
    assert len({case.name for case in cases}) == len(cases)
    assert {case.element for case in cases if case.stiffness == "inf"} == {"consistent"}
    assert {case.stiffness for case in cases if case.solution in study.VISCOSITIES} == {"inf"}


def test_selection() -> None:
    chosen = select(all_cases(), ["enf", "0/0", "1e6", "1e8", "standard", "paper", "newton"])
    assert len(chosen) == 2 * 2 * 2
    assert {case.specimen for case in chosen} == {"enf"}
    assert {case.stiffness for case in chosen} == {"1e6", "1e8"}
    assert select(all_cases(), []) == all_cases()
    with pytest.raises(UelError, match=r"no row has 'dbc'; there are dcb, dcb025, enf, frmm; 0/0"):
        select(all_cases(), ["dbc"])


@pytest.mark.parametrize("specimen", study.KINDS)
def test_decks(specimen: str) -> None:
    files = Case(specimen, "0/90", "inf", "consistent", "perturbed", "newton").files()
    deck = next(text for name, text in files.items() if name.endswith("_newton.inp"))
    # a hundredth of the displacement at most, no controls of the solution, no viscosity
    assert "*STATIC\n0.01, 1., 1e-07, 0.01\n" in deck
    assert "CONTROLS" not in deck
    names = [
        name.strip()
        for line in deck.splitlines()
        if line.startswith("** THICKNESS, ALPHAN")
        for name in line[3:].split(",")
    ]
    values = deck.split("*UEL PROPERTY, ELSET=INTERFACE\n")[1].splitlines()[0].split(", ")
    given = dict(zip(names, values, strict=True))
    assert (given["ALPHAN"], given["ALPHAT"], given["VISCOSITY"]) == ("0.", "0.", "0.")
    # the soft ply is the lower arm
    assert "ELSET=BOTTOM, MATERIAL=PLY_90" in deck
    assert "ELSET=TOP, MATERIAL=PLY_0" in deck


def test_laws() -> None:
    case = Case("dcb", "0/0", "inf", "consistent", "structured", "fallback", "bk")
    assert case.name == "dcb_0-0_inf_consistent_structured_fallback_bk"
    assert replace(case, law=study.OWN_LAW).name == "dcb_0-0_inf_consistent_structured_fallback"
    decks = [c.files()[f"{c.name}.inp"].splitlines() for c in (case, replace(case, law="ppr"))]
    differing = [lines for lines in zip(*decks, strict=True) if lines[0] != lines[1]]
    # the exponent of Benzeggagh and Kenane, then LAW
    assert [[line.split(", ")[k] for line in lines] for k, lines in enumerate(differing)] == [
        ["1.45", "0."],
        ["2", "4"],
    ]


class Run:
    """What a result gives, made up: 4 increments, the third after a cutback and with the load falling by half."""

    def __init__(self) -> None:
        self.history = {
            "U2[LOAD_TOP]": np.array([1.5, 3.0, 4.5, 6.0]),
            "RF2[LOAD_TOP]": np.array([10.0, 20.0, 10.0, 9.7]),
            "ALLWK": np.array([1.0, 2.0, 3.0, 10.0]),
            "ALLSE": np.array([1.0, 2.0, 2.0, 2.0]),
            "ALLPD": np.array([0.0, 0.0, 1.0, 5.0]),
            "ALLVD": np.array([0.0, 0.0, 0.0, 2.0]),
        }
        self.status = [
            StatusRow(1, 1, 1, False, 2, 0.25, 0.25, 0.25),
            StatusRow(1, 2, 1, False, 3, 0.5, 0.5, 0.25),
            StatusRow(1, 3, 1, True, 5, 0.5, 0.5, 0.25),
            StatusRow(1, 3, 2, False, 7, 0.75, 0.75, 0.25),
            StatusRow(1, 4, 1, False, 4, 1.0, 1.0, 0.25),
        ]

    def interface(self) -> dict[str, np.ndarray]:
        """The last profile."""
        return self.interfaces()[-1]

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        """Smooth at first, then with one point of tension less and a damage that comes back."""
        smooth = {
            "TN": [0.0, 0.0, 30.0, -9.0, 0.0],
            "TT": [0.0, 0.0, -50.0, 0.0, 0.0],
            "DAMAGE": [1.0, 0.5, 0.2, 0.0, 0.0],
            "DISSI": [0.13, 0.1, 0.0, 0.0, 0.0],
            "DISSII": [0.5511, 0.0, 0.0, 0.0, 0.0],
        }
        later = smooth | {"TN": [0.0, 0.0, 28.0, -9.0, 0.0], "DAMAGE": [1.0, 0.5, 0.2, 0.4, 0.0]}
        return [
            {name: np.array(column) for name, column in (profile | {"time": [time] * 5}).items()}
            for time, profile in ((0.5, smooth), (1.0, later))
        ]


def test_measures_of_a_run() -> None:
    real = Run().interfaces()
    row = measure(CASE, Run(), "", 1.0, real)  # type: ignore[arg-type]
    assert row.finished
    assert (row.reached, row.increments, row.iterations, row.cutbacks) == (1.0, 4, 21, 1)
    # the load falls by 10 of 20 N in the third increment: a snap, whose 12 iterations are counted apart
    assert (row.snaps, row.snap_iterations, row.iterations_per_increment) == (1, 12, 3.0)
    assert (row.peak_load, row.peak_displacement, row.final_load) == (20.0, 3.0, 9.7)
    assert row.balance_error == pytest.approx((8.0 - 7.0) / 8.0)
    # one failed point, which has spent 0.13 of 0.26 and 0.5511 of 1.002 N/mm
    assert row.dissipation_error == pytest.approx(0.05)
    assert (row.peak_n, row.peak_t) == (30.0, 50.0)
    assert (row.index_n, row.index_t, row.error_n, row.error_t, row.raw_n, row.raw_t) == (1.0,) * 6
    # from the point with damage 0.5 on: up by 30, down by 39, up by 9; and 50 down and up
    assert (row.variation_n, row.real_n, row.difference_n) == (78.0, 78.0, 0.0)
    assert (row.variation_t, row.real_t, row.difference_t) == (100.0, 100.0, 0.0)
    # down by 0.8, up by 0.2, down by 0.4
    assert row.damage_variation == pytest.approx(1.4)


def test_a_run_that_stopped() -> None:
    run = Run()
    run.history = {name: column[:2] for name, column in run.history.items()}
    row = measure(CASE, run, "TOO MANY ATTEMPTS", 1.0, [])  # type: ignore[arg-type]
    assert not row.finished
    assert row.reached == 0.5
    assert row.balance_error == 0.0


def test_oscillations_against_the_reference() -> None:
    # the reference holds one point more; a step of 3 MPa that it does not have, up and down
    first, second = (
        {"time": np.full(4, time), "DAMAGE": np.array([1.0, 0.9, 0.0, 0.0]), "TN": np.array(values)}
        for time, values in ((0.1, [0.0, 0.0, 30.0, 0.0]), (0.2, [0.0, 3.0, 30.0, 0.0]))
    )
    other = {"time": np.full(4, 0.2), "DAMAGE": np.array([0.9, 0.9, 0.0, 0.0]), "TN": np.array([0.0, 0.0, 30.0, 0.0])}
    found = oscillations("TN", "n", [first, second], [(first, first), (second, other)])
    # TV 57 against 60; the strength is 30 MPa
    assert found["index_n"] == 1.0
    assert found["error_n"] == pytest.approx(1.0 + 3.0 / 60.0)
    assert (found["variation_n"], found["real_n"], found["difference_n"]) == (60.0, 60.0, 0.0)
    alone = oscillations("TN", "n", [first], [])
    assert np.isnan(alone["index_n"])
    assert alone["raw_n"] == 1.0


def test_moments_of_the_reference_are_less_than_half_an_increment_away() -> None:
    profiles, real = ([{"time": np.array([t])} for t in times] for times in ((0.1, 0.196, 0.294), (0.1, 0.2, 0.3)))
    assert [(p["time"][0], r["time"][0]) for p, r in same_moments(profiles, real)] == [(0.1, 0.1), (0.196, 0.2)]


def test_restriction_takes_the_mean_over_the_share_of_a_point() -> None:
    # a facet with two points; cut in two, four points, of which two lie on each half
    fine = {"X": np.array([0.1, 0.4, 0.6, 0.9]), "TN": np.array([1.0, 3.0, 10.0, 20.0])}
    coarse = restricted(fine, 2)
    assert coarse["X"].tolist() == [0.25, 0.75]
    assert coarse["TN"].tolist() == [2.0, 15.0]
    assert restricted(fine, 1)["TN"].tolist() == fine["TN"].tolist()


def test_stress_on_facets() -> None:
    # turned by 45 degrees: uniaxial tension has half of itself as tension and as shear; pure shear becomes tension
    angle, zero, one = np.full(1, np.pi / 4), np.zeros(1), np.ones(1)
    assert np.concatenate(on_facets((one, zero, zero), angle)) == pytest.approx([0.5, -0.5])
    assert np.concatenate(on_facets((zero, one, zero), angle)) == pytest.approx([0.5, 0.5])
    assert np.concatenate(on_facets((zero, zero, one), angle)) == pytest.approx([-1.0, 0.0])
    # small angles: the shear of bending stress
    assert on_facets((np.array([500.0]), zero, zero), np.array([0.06]))[1] == pytest.approx(-30.0, rel=0.01)


def test_profiles_are_those_of_the_tenths() -> None:
    profiles = [{"time": np.array([time])} for time in (0.05, 0.1, 0.1001, 0.17, 0.2, 0.95, 1.0)]
    assert [float(profile["time"][0]) for profile in at_tenths(profiles)] == [0.1, 0.2, 1.0]


def test_bonded_part_starts_where_the_first_point_holds() -> None:
    profile = {"DAMAGE": np.array([1.0, 1.0, 0.9, 1.0, 0.0]), "TN": np.arange(5.0)}
    assert bonded_part(profile)["TN"].tolist() == [2.0, 3.0, 4.0]


def test_damage_variation() -> None:
    assert damage_variation(np.array([1.0, 1.0, 0.6, 0.0])) == 1.0
    assert damage_variation(np.array([0.5, 0.2, 0.0])) == 1.0
    assert damage_variation(np.array([1.0, 0.2, 0.7, 0.0])) == 2.0
    # damaged everywhere: it does not fall to 0
    assert damage_variation(np.array([1.0, 0.9, 0.9])) == pytest.approx(0.1)
    assert damage_variation(np.zeros(3)) == 1.0


def consistent(specimen: str = "enf", stiffness: str = "1e8", mesh: str = "perturbed", layup: str = "0/0") -> Case:
    return Case(specimen, layup, stiffness, "consistent", mesh, "newton")


@pytest.mark.parametrize(
    ("case", "row", "words", "found"),
    [
        (consistent(), replace(GOOD, reached=0.5, stopped="TOO MANY"), "finishes", "50.0%, TOO MANY"),
        (consistent(), replace(GOOD, iterations=301), "mean iterations", "3.01"),
        (consistent("dcb"), replace(GOOD, iterations=601), "mean iterations", "6.01"),
        (consistent(), replace(GOOD, cutbacks=6), "at most 5 cutbacks", "6"),
        (consistent(), replace(GOOD, damage_variation=1.01), "damage falls", "1.0100"),
        (consistent(), replace(GOOD, peak_t=59.0), "largest shear", "59.00 MPa of 60"),
    ],
)
def test_criteria_of_single_rows(case: Case, row: Row, words: str, found: str) -> None:
    def verdict(of: Row) -> tuple[str, ...]:
        return next(v.failures for v in check({case: of}) if words in v.criterion)

    assert verdict(GOOD) == ()
    assert verdict(row) == (f"{case.name}: {found}",)


def test_snaps_count_apart() -> None:
    row = replace(GOOD, iterations=400, snaps=1, snap_iterations=150)
    assert row.iterations_per_increment == pytest.approx(250.0 / 99.0)


def test_peak_loads_agree_over_the_stiffnesses_on_one_mesh() -> None:
    rows = {
        consistent(stiffness=s): replace(GOOD, peak_load=p) for s, p in (("1e4", 50.0), ("1e6", 100.0), ("inf", 100.4))
    }
    assert next(v for v in check(rows) if "peak loads" in v.criterion).holds
    rows[consistent(stiffness="1e12")] = replace(GOOD, peak_load=99.8)
    verdict = next(v for v in check(rows) if "peak loads" in v.criterion)
    assert verdict.judged == 1
    assert verdict.failures == ("enf 0/0 perturbed: 0.60% (1e6 100.00, inf 100.40, 1e12 99.80)",)


def test_oscillation_is_compared_with_the_structured_mesh_at_1e6() -> None:
    plain, rough = consistent(stiffness="1e6", mesh="structured"), consistent()
    rows = {plain: replace(GOOD, index_t=1.01), rough: replace(GOOD, index_n=9.0, index_t=1.02 * 1.11, error_t=2.0)}
    # the traction of the loading mode alone
    assert index_ratios(rough, rows) == pytest.approx({"TT": 1.02 * 1.11 / 1.01})
    assert index_ratios(rough, rows, "error") == pytest.approx({"TT": 2.0 / 1.5})
    verdict = next(v for v in check(rows) if "index" in v.criterion)
    assert verdict.failures == (f"{rough.name}: TT 1.121",)
    assert index_ratios(rough, {rough: GOOD}) is None
    # nothing to judge where the run stopped before the first moment
    assert index_ratios(rough, rows | {rough: replace(GOOD, index_t=float("nan"))}) is None


def test_standard_element_has_to_fail_the_criterion_of_the_index() -> None:
    rough = replace(consistent(), element="standard")
    plain = replace(rough, stiffness="1e6", mesh="structured")
    assert check({plain: GOOD, rough: replace(GOOD, index_t=1.2)})[0].holds
    assert check({plain: GOOD, rough: GOOD})[0].failures == (f"{rough.name}: TT 1.000",)


def test_tables() -> None:
    stopped = replace(CASE, stiffness="1e8")
    rows = {
        CASE: replace(GOOD, snaps=2, snap_iterations=30),
        stopped: replace(GOOD, reached=0.25, stopped="TIME INCREMENT REQUIRED IS LESS (step 1, increment 9)"),
    }
    text = markdown_tables(rows, check(rows))
    assert "## frmm: fixed-ratio mixed mode, [0/0], to 6 mm" in text
    assert "| 1e6 | paper | structured | newton | 100 | 200 | 1.73 + 30 in 2 snaps | 0 | 100.00 |" in text
    assert "| 25.0%: time increment required is less |" in text
    read = list(csv.DictReader(csv_table(rows).splitlines()))
    assert [line["stiffness"] for line in read] == ["1e6", "1e8"]
    assert float(read[0]["peak_load"]) == 100.0


def test_digests() -> None:
    case = Case("enf", "0/0", "1e8", "consistent", "perturbed", "fallback")
    standard = replace(case, element="standard")
    rows = {standard: replace(GOOD, variation_t=300.0, difference_t=float("nan")), case: GOOD}
    assert variations(rows)[2:] == ["| enf [0/0] | perturbed | tangential | 100 | 300 | - |  |  | 100 | 50 |"]
    exact = replace(case, stiffness="inf")
    rows = {
        exact: GOOD,
        replace(exact, solution="newton"): replace(GOOD, reached=0.4, stopped="TOO MANY"),
        replace(exact, solution="viscous1e-3"): replace(GOOD, peak_load=102.0, final_load=84.0),
    }
    assert viscosity(rows)[2:] == [
        "| enf [0/0] | perturbed | linear | 0 | 100 | 200 | 0 | stops at 40.0% |  |  |  |",
        "| enf [0/0] | perturbed | linear | 0, fall-back | 100 | 200 | 0 | 100.00 | +0.0% | 80.00 | +0.0% |",
        "| enf [0/0] | perturbed | linear | 1e-3 | 100 | 200 | 0 | 102.00 | +2.0% | 84.00 | +5.0% |",
    ]
    assert variations({}) == viscosity({}) == ratios({}) == []


def test_ratios_of_the_indices() -> None:
    plain = Case("enf", "0/0", "1e6", "consistent", "structured", "fallback")
    stiff, rigid = (replace(plain, stiffness=name, mesh="perturbed") for name in ("1e8", "inf"))
    rows = {plain: GOOD, stiff: replace(GOOD, index_t=1.05), rigid: replace(GOOD, index_t=0.9)}
    assert ratios(rows)[2:] == ["| enf | tangential |  |  | 0.900 to 1.050 |  |  | 1.000 |"]


def test_rows_are_kept_until_their_deck_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    row_store(tmp_path).put(CASE, GOOD)
    assert row_store(tmp_path).get(CASE) == GOOD
    assert row_store(tmp_path).get(replace(CASE, stiffness="1e8")) is None
    monkeypatch.setattr(study, "FIELD_EVERY", 7)
    assert row_store(tmp_path).get(CASE) is None


def put_reference(case: Case, folder: Path) -> None:
    """A reference of the case that is kept as if it had run: no traction, at the end."""
    reference = reference_of(case)
    reference_store(folder).put(reference, ReferenceRun("", 1.0))
    place = folder / FOLDER / reference.name
    place.mkdir(parents=True)
    mesh = case.kind.mesh(case.kind.size, 0.0)
    points = 2 * (mesh.columns - mesh.first) * reference.factor
    (place / f"{reference.name}.sta").touch()
    (place / f"{reference.name}_interface.csv").write_text(
        "step,increment,time,element,point,X,TN,TT,DAMAGE\n" + "1,100,1.0,1,1,0.0,0.0,0.0,0.0\n" * points
    )


def test_command_runs_what_is_missing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    put_reference(CASE, tmp_path)
    words = [
        "--output-dir",
        str(tmp_path),
        "--workers",
        "1",
        "--only",
        "frmm",
        "0/0",
        "1e6",
        "paper",
        "structured",
        "newton",
    ]
    assert main(words) == 0
    entry = json.loads((tmp_path / "rows.json").read_text())[CASE.name]["row"]
    assert entry["reached"] == pytest.approx(1.0)
    assert f"{CASE.name}: finished" in capsys.readouterr().out.replace("\n", " ")
    row = json.loads((tmp_path / "rows.json").read_text())[CASE.name]["row"]
    assert row["real_t"] == 0.0
    assert row["index_t"] == pytest.approx(1.0 + row["variation_t"] / 60.0)
    assert CASE.stiffness in (tmp_path / "study.csv").read_text()
    assert not list((tmp_path / "runs" / CASE.name).glob("*_vtu"))
    page = tmp_path / "pages.md"
    assert main([*words, "--page", str(page)]) == 0
    assert f"{CASE.name}:" not in capsys.readouterr().out
    assert page.read_text() == (tmp_path / "study.md").read_text()
    assert page.with_suffix(".csv").exists()


def test_stress_of_the_homogeneous_body_acts_on_bonded_facets(tmp_path: Path) -> None:
    real = turned("frmm", tmp_path)
    found = [
        bonded(Bonded("frmm", "0/0", element, "perturbed", factor), tmp_path)
        for element, factor in (("consistent", 2), ("consistent", 1), ("standard", 1))
    ]
    for name in ("TN", "TT"):
        errors = [total_variation(profile[name] - real[name]) for profile in found]
        # refined, the consistent element comes closer; the standard one is far off
        assert errors == sorted(errors)
        assert errors[0] < 0.3 * total_variation(real[name])
        assert errors[2] > max(5.0 * errors[1], total_variation(real[name]))
        # what the consistent one adds on the coarsest mesh lies between the two points of a facet
        real_facets, consistent, standard = (
            total_variation(facet_means(profile[name])) for profile in (real, found[1], found[2])
        )
        assert consistent == pytest.approx(real_facets, rel=0.06)
        # and the standard one misses even the mean over a facet
        assert standard < 0.6 * real_facets


def test_command_names_what_it_does_not_know(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["--output-dir", str(tmp_path), "--only", "1e7"]) == 2
    assert "study: no row has '1e7'" in capsys.readouterr().err
