# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The parameter study: its rows, what is checked, its tables, and that it goes on where it stopped."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest

from uel.errors import UelError
from uel.paper.study import cases as study
from uel.paper.study.__main__ import main
from uel.paper.study.cases import StudyCase, all_cases, select
from uel.paper.study.criteria import check, index_ratios
from uel.paper.study.digests import ratios, variations, viscosity
from uel.paper.study.reference import FOLDER, ReferenceRun, reference_of
from uel.paper.study.rows import StudyRow
from uel.paper.study.runner import reference_store, row_store
from uel.paper.study.tables import csv_table, markdown_tables
from uel.usersub.layout import element_layouts

CASE = StudyCase("frmm", "0/0", "1e6", "paper", "structured", "newton")
GOOD = StudyRow(
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
    # 4 specimens, 2 layups, 2 meshes; 4 stiffnesses of 2 elements and 5 of the consistent one with 2 solutions, less
    # one of the standard element, and the fifth with 3 viscosities; 3 other laws in 2 specimens with 3 solutions
    assert len(cases) == len(set(cases)) == 4 * 2 * 2 * (4 * 2 * 2 - 1 + 5 * 2 + 3) + 3 * 2 * 3
    assert {case.stiffness for case in cases if case.law != study.OWN_LAW} == {"inf"}
    assert len({case.name for case in cases}) == len(cases)
    assert {case.element for case in cases if case.stiffness == "inf"} == {"consistent"}
    assert {case.stiffness for case in cases if case.solution in study.VISCOSITIES} == {"inf"}
    standard = {(case.stiffness, case.solution) for case in cases if case.element == "standard"}
    assert ("1e12", "newton") in standard and ("1e12", "fallback") not in standard


def test_selection() -> None:
    chosen = select(all_cases(), ["enf", "0/0", "1e6", "1e8", "standard", "paper", "newton"])
    assert len(chosen) == 2 * 2 * 2
    assert {case.specimen for case in chosen} == {"enf"}
    assert {case.stiffness for case in chosen} == {"1e6", "1e8"}
    assert select(all_cases(), []) == all_cases()
    with pytest.raises(UelError, match=r"no row has 'dbc'; expected words among dcb, dcb025, enf, frmm; 0/0"):
        select(all_cases(), ["dbc"])


@pytest.mark.parametrize("specimen", study.KINDS)
def test_decks(specimen: str) -> None:
    files = StudyCase(specimen, "0/90", "inf", "consistent", "perturbed", "newton").files()
    deck = next(text for name, text in files.items() if name.endswith("_newton.inp"))
    # a hundredth of the displacement at most, no controls of the solution, no viscosity
    assert "*STATIC\n0.01, 1., 1e-07, 0.01\n" in deck
    assert "CONTROLS" not in deck
    assert "*OUTPUT, FIELD, NUMBER INTERVAL=10, TIME MARKS=NO\n" in deck
    captions, values = deck[deck.index("** THICKNESS, ALPHAN") :].split("*UEL PROPERTY, ELSET=INTERFACE\n")
    names = [name.strip() for line in captions.splitlines() for name in line[3:].split(",")]
    given = dict(zip(names, values.split("\n*")[0].replace("\n", ", ").split(", "), strict=True))
    assert (given["ALPHAN"], given["ALPHAT"], given["VISCOSITY"]) == ("0.", "0.", "0.")
    # the soft ply is the lower arm
    assert "ELSET=BOTTOM, MATERIAL=PLY_90" in deck
    assert "ELSET=TOP, MATERIAL=PLY_0" in deck


def test_laws() -> None:
    case = StudyCase("dcb", "0/0", "inf", "consistent", "structured", "fallback", "bk")
    assert case.name == "dcb_0-0_inf_consistent_structured_fallback_bk"
    assert replace(case, law=study.OWN_LAW).name == "dcb_0-0_inf_consistent_structured_fallback"
    decks = [c.files()[f"{c.name}.inp"].splitlines() for c in (case, replace(case, law="ppr"))]
    differing = [lines for lines in zip(*decks, strict=True) if lines[0] != lines[1]]
    layout = element_layouts()[4]
    names = [item.name for item in (*layout.reals, *layout.integers)]
    # the exponent of Benzeggagh and Kenane, then LAW
    places = (names.index("ETA") % 8, names.index("LAW") % 8)
    assert [[line.split(", ")[k] for line in lines] for k, lines in zip(places, differing, strict=True)] == [
        ["1.45", "0."],
        ["2", "4"],
    ]


def consistent(specimen: str = "enf", stiffness: str = "1e8", mesh: str = "perturbed", layup: str = "0/0") -> StudyCase:
    return StudyCase(specimen, layup, stiffness, "consistent", mesh, "newton")


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
def test_criteria_of_single_rows(case: StudyCase, row: StudyRow, words: str, found: str) -> None:
    def verdict(of: StudyRow) -> tuple[str, ...]:
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
    case = StudyCase("enf", "0/0", "1e8", "consistent", "perturbed", "fallback")
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
    plain = StudyCase("enf", "0/0", "1e6", "consistent", "structured", "fallback")
    stiff, rigid = (replace(plain, stiffness=name, mesh="perturbed") for name in ("1e8", "inf"))
    rows = {plain: GOOD, stiff: replace(GOOD, index_t=1.05), rigid: replace(GOOD, index_t=0.9)}
    assert ratios(rows)[2:] == ["| enf | tangential |  |  | 0.900 to 1.050 |  |  | 1.000 |"]


def test_rows_are_kept_until_their_deck_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    row_store(tmp_path).put(CASE, GOOD)
    assert row_store(tmp_path).get(CASE) == GOOD
    assert row_store(tmp_path).get(replace(CASE, stiffness="1e8")) is None
    monkeypatch.setattr(study, "FIELD_EVERY", 7)
    assert row_store(tmp_path).get(CASE) is None


def put_reference(case: StudyCase, folder: Path) -> None:
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
    # nothing is run for a table of what is there
    assert main(["--output-dir", str(tmp_path), "--kept"]) == 0
    lines = csv.DictReader((tmp_path / "study.csv").read_text().splitlines())
    assert [line["specimen"] for line in lines] == [CASE.specimen]
    page = tmp_path / "pages.md"
    assert main([*words, "--page", str(page)]) == 0
    assert f"{CASE.name}:" not in capsys.readouterr().out
    assert page.read_text() == (tmp_path / "study.md").read_text()
    assert page.with_suffix(".csv").exists()


def test_command_names_what_it_does_not_know(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["--output-dir", str(tmp_path), "--only", "1e7"]) == 2
    assert "study: no row has '1e7'" in capsys.readouterr().err
