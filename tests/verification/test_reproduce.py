# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel reproduce`: cases, statements, page; that it goes on where it stopped."""

import io
import math
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from rich.console import Console

from uel import cli
from uel.delamination import theory
from uel.delamination.beams import RIGID_ROOT, growth
from uel.delamination.materials import PLY_0, PLY_90, TABLE_2
from uel.delamination.specimens import ARMS, CRACK
from uel.errors import UelError
from uel.paper.patches import ANGLE, COLLINEAR, COLUMNS, inclined_mesh, stabilisation
from uel.paper.reproduce import command, convergence, curves, findings, parameters, patch_cases, sensitivity
from uel.paper.reproduce.cases import LONGER, PROBLEMS, PaperCase, longer_cases, paper_cases
from uel.paper.reproduce.convergence import Steady
from uel.paper.reproduce.curves import to_line
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.page import Content, Table, write_page
from uel.paper.reproduce.runs import AnyCase, Runs
from uel.paper.reproduce.statements import JudgedStatement, Number, Statement, judge, read_statements


def quiet() -> Console:
    return Console(file=io.StringIO(), width=200)


def test_cases_are_there_once() -> None:
    cases = [case for problem in PROBLEMS for case in paper_cases(problem)]
    # 3 specimens, 2 layups, 3 elements, 3 stiffnesses, 2 meshes
    assert len(cases) == len({case.name for case in cases}) == 3 * 2 * 3 * 3 * 2
    # the paper shows the perturbed mesh of [0/0] at the stiffest
    assert len([case for problem in PROBLEMS for case in paper_cases(problem, coarse=True)]) == 3 * (2 * 3 * 3 + 3)
    everything: list[AnyCase] = [*cases, *patch_cases.patch_cases()]
    everything += [case for study in sensitivity.studies(coarse=False) for case in study.cases()]
    different = set(everything)
    assert len({case.name for case in different}) == len(different)


@pytest.mark.parametrize("problem", PROBLEMS)
def test_quick_decks_are_coarser(problem: str) -> None:
    fine, coarse = (PaperCase(problem, "0/90", "consistent", "inf", coarse=coarse) for coarse in (False, True))
    assert np.diff(coarse.mesh().x).min() == pytest.approx(4.0 / 3.0 * np.diff(fine.mesh().x).min(), rel=1e-4)
    assert CRACK in coarse.mesh().x
    assert 2 * coarse.increment_count == fine.increment_count


def test_deck_of_a_variation() -> None:
    case = PaperCase("enf", "0/90", "paper", "1e8", increments=50, beta=2.0, sampling=1, newton_cotes=True)
    text = case.files()[f"{case.name}.inp"]
    names = [n.strip() for line in text.splitlines() if line.startswith("** ") for n in line[3:].split(",")]
    start = names.index("THICKNESS", names.index("ALPHAN") - 1)
    values = text.split("*UEL PROPERTY, ELSET=INTERFACE\n")[1].split("*")[0].replace("\n", ",").split(",")
    given = dict(zip(names[start:], (value.strip() for value in values if value.strip()), strict=False))
    assert "*STATIC\n0.02, 1., 1e-07, 0.02\n" in text
    assert (given["SAMPLING"], given["INTEGRATION"], given["CLOSURE"]) == ("1", "1", "2")
    height = 1.55 / 4.0
    # (21) and (22) with |D| = E/(1 - nu) of the isotropic ply and, within 1 %, E11 of the other
    soft, stiff = height * (1.0 - PLY_90.nu12) / PLY_90.e1, height / PLY_0.e1
    assert float(given["BETAN"]) == pytest.approx(2.0 * 2.0 / (soft + stiff), rel=0.01)


def test_rows_and_weight_of_a_deck() -> None:
    case = PaperCase("dcb", "0/90", "consistent_bk", "1e6", rows=8, weight=0.5)
    assert case.name == "dcb_0_90_consistent_bk_1e6_rows8_weight0p5"
    mesh, usual = case.mesh(), replace(case, rows=4).mesh()
    assert mesh.rows == (8, 8)
    assert mesh.lower[::2] == pytest.approx(usual.lower)
    assert mesh.upper[::2] == pytest.approx(usual.upper)
    text = case.files()[f"{case.name}.inp"].split("*UEL PROPERTY, ELSET=INTERFACE\n")[1]
    values = text.split("*")[0].replace("\n", ",").split(",")
    assert float(values[14]) == 0.5  # GAMMABOT, the 15th property


def test_energies_explain_a_difference_of_loads() -> None:
    # slender arms: P a^3 ~ displacement, P^2 a^2 ~ G, so that 1 % less energy is 3/4 % less load
    built_in, ours = Steady(24.0, 1.0, 0.32), Steady(23.0, 0.99, 0.32)
    assert convergence.expected(ours, built_in) == pytest.approx(-0.0075, abs=2e-5)
    assert convergence.load_difference(ours, built_in) == pytest.approx(-1.0 / 24.0)


@pytest.mark.parametrize("coarse", [True, False])
def test_pairs_have_one_mesh(coarse: bool) -> None:
    for built_in, ours in convergence.pairs(coarse=coarse):
        assert (built_in.element, ours.element) == ("standard_bk", "consistent_bk")
        assert (built_in.element_size, built_in.rows) == (ours.element_size, ours.rows)


def test_kink_ahead_of_the_front() -> None:
    place = np.arange(30.0, 50.0, 0.5)
    damage = np.where(place < 40.0, 1.0, 0.0)
    smooth = {"X": place, "TT": np.exp(40.0 - place) * (place >= 40.0), "LOST": damage}
    rough = smooth | {"TT": smooth["TT"] + np.where(place == 42.0, 0.5, 0.0)}
    # a kink within the failed part does not count
    rough["TT"][3] += 5.0

    def smooth_or_rough(problem: str, layup: str, element: str, stiffness: str) -> SimpleNamespace:
        assert (layup, stiffness) == ("0/0", "1e8")
        profile = rough if element == "standard" else smooth
        return SimpleNamespace(case=SimpleNamespace(problem=problem, layup=layup), at=lambda _: profile)

    evidence = cast("Evidence", SimpleNamespace(run=smooth_or_rough))
    assert parameters.kink_distance(evidence, "enf", "TT") == pytest.approx(42.0 - 39.5)


def test_mode_ratio_of_beams_and_of_a_process_zone() -> None:
    # plain beams: 4/3
    assert theory.frmm_mode_ratio(replace(ARMS, g12=1e12), CRACK) == pytest.approx(4.0 / 3.0, rel=1e-2)
    loads = [theory.frmm_load(ARMS, CRACK, one, two) ** -2 for one, two in ((1.0, 1e12), (1e12, 1.0))]
    assert theory.frmm_mode_ratio(ARMS, CRACK) == pytest.approx(loads[0] / loads[1])
    # separations and tractions that fall and rise along a straight line: the areas below the law's curves
    share = np.linspace(0.0, 1.0, 200)
    columns = {"TN": 30.0 * share, "SEPN": 0.02 * (1.0 - share), "TT": -60.0 * share, "SEPT": -0.03 * (1.0 - share)}
    profile = columns | {"X": 35.0 + share, "DAMAGE": 1.0 - share}
    run = SimpleNamespace(case=SimpleNamespace(problem="frmm", layup="0/0"), at=lambda _: profile)
    evidence = cast("Evidence", SimpleNamespace(run=lambda *_: run))
    assert findings.mode_ratio(evidence, "standard") == pytest.approx(30.0 * 0.02 / (60.0 * 0.03))
    assert findings.theory_mode_ratio(evidence, "standard") == pytest.approx(
        theory.frmm_mode_ratio(ARMS, 35.0), rel=1e-3
    )


def test_longer_specimens_come_near_plain_beams() -> None:
    short, *longer = (PROBLEMS["frmm"].mesh(0.5, 0.0), *(case.mesh() for case in longer_cases()))
    for case, mesh in zip(longer_cases(), longer, strict=True):
        crack = LONGER[case.problem]
        # every length of the specimen but its height grows alike
        assert mesh.x[-1] / crack == pytest.approx(short.x[-1] / CRACK)
        assert crack in mesh.x
        assert mesh.upper[-1] == short.upper[-1]
        assert theory.frmm_mode_ratio(ARMS, crack) < 1.05 * 4.0 / 3.0 < theory.frmm_mode_ratio(ARMS, CRACK)


def test_damage_counts_near_the_tip() -> None:
    place = np.arange(35.0, 100.0, 1.0)
    damage = np.where(place < 45.0, 1.0, 0.0)
    damage[-3] = 0.4
    profile = {"X": place, "DAMAGE": damage, "LOST": damage}
    assert findings.damage_near_tip(profile, "enf").max() == 1.0
    assert findings.damage_near_tip(profile, "enf").size == np.count_nonzero(place <= 45.0 + 14.0)


def test_stabilisation_of_the_horizontal_patch() -> None:
    # formulation of the 10 x 10 patch, [0/0], by an independent code: 1.21e6 N/mm^3
    assert stabilisation(PLY_0, PLY_0, (0.01, 0.01), 0.1) == pytest.approx(1.21e6, rel=2e-3)


def test_coordinates_in_single_precision_leave_the_line() -> None:
    exact, rounded = (inclined_mesh(decimals=decimals).nodes()[1] for decimals in (COLLINEAR, patch_cases.PRINTED))
    off = np.abs(rounded - exact).max()
    assert 0.0 < off <= 0.5 * 10.0**-patch_cases.PRINTED


def test_inclined_interface() -> None:
    straight, moved = inclined_mesh(), inclined_mesh(0.03)
    labels, places = straight.nodes()
    low, high = (places[np.isin(labels, line)] for line in straight.interface_lines)
    assert (low == high).all()
    assert len(straight.interface8()) == COLUMNS
    along = np.diff(low, axis=0)
    assert np.degrees(np.arctan2(along[:, 1], along[:, 0])) % 180.0 == pytest.approx(ANGLE)
    assert (places.min(axis=0), places.max(axis=0)) == (pytest.approx([0.0, 0.0]), pytest.approx([1.0, 1.0]))
    normal = np.array([-along[0, 1], along[0, 0]]) / math.hypot(*along[0])
    size = math.hypot(*along[0])
    other = moved.nodes()[1][np.isin(labels, straight.interface_lines[0])]
    assert (other - low) @ normal / size == pytest.approx([0.03, -0.03] * (COLUMNS // 2 + 1))


@pytest.mark.parametrize("problem", PROBLEMS)
def test_growth_curves_start_at_the_onset(problem: str) -> None:
    curve = growth(problem)
    load = {
        "dcb": theory.dcb_load(ARMS, CRACK, TABLE_2.toughness_1),
        "enf": theory.enf_load(ARMS, CRACK, TABLE_2.toughness_2),
        "frmm": theory.frmm_load(ARMS, CRACK, TABLE_2.toughness_1, TABLE_2.toughness_2),
    }[problem]
    assert curve.load[0] == pytest.approx(load)
    # the crack grows steadily under displacement, and the load falls
    assert (np.diff(curve.displacement) > 0.0).all()
    assert (np.diff(curve.load) < 0.0).all()
    assert curve.deviation(curve.displacement, 1.03 * curve.load) == pytest.approx(0.03)
    # without end corrections the specimen is stiffer and carries more
    assert RIGID_ROOT.correction < 0.1 * ARMS.correction
    assert growth(problem, RIGID_ROOT).load[0] > curve.load[0]


def test_distance_to_a_curve_with_a_jump() -> None:
    # two loads that fall at once, at displacements that differ by one increment: 0.01 apart, not 1
    line = np.array([[0.0, 0.0], [0.5, 1.0], [0.51, 0.0], [1.0, 0.5]])
    assert to_line(np.array([0.52, 0.5]), line) == pytest.approx(0.015, abs=1e-4)
    assert to_line(np.array([0.25, 0.5]), line) == 0.0


def test_statements_are_well_formed() -> None:
    statements = read_statements()
    assert len(statements) >= 20
    assert len({statement.id for statement in statements}) == len(statements)
    for statement in statements:
        assert set(statement.cases) <= set(command.PARTS)
        assert statement.limits
        assert len(statement.quote.split()) <= 30, statement.id


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('quote = "a"\n', "", "bad: expected cases, figure, id, measure, number, quote, section, and at_least"),
        ("at_most = 1\n", "", "bad: expected .* and at_least or at_most"),
        ('measure = "isotropy"', 'measure = "beauty"', "bad: no measure 'beauty'; expected one of asymmetry"),
        ('quote = "a"', 'quote = "a"\nmood = 1', "bad: expected"),
        (
            "cases = []",
            "cases = []\nalso = [{ ful = true }]",
            "bad: also: expected arguments, full, measure, name, number",
        ),
    ],
)
def test_bad_statements_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    good = (
        '[[statement]]\nid = "bad"\nsection = "1"\nfigure = ""\nquote = "a"\nnumber = "b"\n'
        'measure = "isotropy"\nat_most = 1\ncases = []\n'
    )
    file = tmp_path / "statements.toml"
    file.write_text(good)
    assert read_statements(file)[0].at_most == 1.0
    file.write_text(good.replace(old, new))
    with pytest.raises(ValueError, match=message):
        read_statements(file)


def statement(low: float | None, high: float | None, figure: str = "") -> Statement:
    number = Number("a ratio", "modulus_contrast", {})
    return Statement("x", "1", figure, "<quote>", number, low, high, (), (number,), ())


def test_limits_decide() -> None:
    assert statement(1.0, None).holds(1.0)
    assert not statement(1.0, None).holds(0.9)
    assert statement(1.0, 2.0).limits == "at least 1, at most 2"
    assert not statement(1.0, 2.0).holds(2.1)
    assert not statement(1.0, 2.0).holds(math.nan)
    verdict = judge(statement(11.0, 12.0), Evidence(Runs({}, Path()), coarse=False))
    assert verdict.reproduced
    assert verdict.value == pytest.approx(1.2e5 / 1.05e4)
    assert [other.text for other, _ in verdict.also] == ["a ratio"]


def test_numbers_of_the_full_meshes() -> None:
    number = Number("costly", "modulus_contrast", {}, full=True)
    costly = replace(statement(11.0, 12.0), also=(number,))
    found = [judge(costly, Evidence(Runs({}, Path()), coarse=coarse)).also for coarse in (True, False)]
    assert [len(also) for also in found] == [0, 1]
    assert {number.text for statement in read_statements() for number in statement.also if number.full} == {
        "with the same criterion and points: standard element"
    }


def test_page_is_one_file(tmp_path: Path) -> None:
    picture = tmp_path / "a.png"
    picture.write_bytes(b"\x89PNG")
    verdicts = [
        JudgedStatement(statement(1.0, 2.0, "9"), 3.0, ((Number("more", "isotropy", {}), 4.0),)),
        JudgedStatement(statement(1.0, None), float("inf"), ()),
    ]
    table = Table("Loads & ends", "text", ("a", "b"), [["1", "<2"]], picture)
    page = write_page(Content(["how"], {"9": picture}, verdicts, [table]), tmp_path / "index.html").read_text()
    assert "1 of 2 statements reproduced (50%)" in page
    # the one that is not stands at the head and below its figure
    assert page.count("✗ not reproduced") == 2
    assert page.count("✓ reproduced") == 1
    assert "<td class='number'>none</td>" in page
    assert "&lt;quote&gt;" in page
    assert "Loads &amp; ends" in page
    assert set(re.findall(r'(?:src|href)="([^"]{5})', page)) == {"data:"}


@pytest.mark.long
def test_command_runs_once_and_decides(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patch_cases, "STIFF", (1.0e6,))
    monkeypatch.setattr("uel.paper.reproduce.basics.STIFF", (1.0e6,))
    verdicts = command.reproduce(["law", "patch"], tmp_path, quick=False, console=quiet(), workers=1)
    found = {verdict.statement.id: verdict for verdict in verdicts}
    # prototype of the equations (formulation of the paper's 10 x 10 patch): deviations 168 and 25 MPa of 1050
    assert found["patch-perturbed-standard"].value == pytest.approx(168.0 / 1050.0, rel=0.01)
    assert found["patch-perturbed-paper"].value == pytest.approx(25.4 / 167.7, rel=0.01)
    assert found["law-energy-mixed"].value == pytest.approx(1.0, abs=1e-3)
    assert found["patch-perturbed-paper"].reproduced
    assert not found["patch-beta"].reproduced
    folder = tmp_path / "full"
    assert (folder / "figure_06.png").read_bytes().startswith(b"\x89PNG")
    assert "patch-beta" in (folder / "statements.csv").read_text()
    before = (folder / "runs.json").stat().st_mtime_ns
    command.reproduce(["law", "patch"], tmp_path, quick=False, console=quiet(), workers=1)
    assert (folder / "runs.json").stat().st_mtime_ns == before


def test_missing_runs_are_named() -> None:
    with pytest.raises(UelError, match="enf_0_0_standard_1e6: this case was not run"):
        curves.energy_error(Evidence(Runs({}, Path()), coarse=False), "enf", "standard", ["1e6"])


def test_unknown_case_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["reproduce", "dbc", "--output-dir", str(tmp_path)]) == 2
    expected = "uel: no case 'dbc'; expected one of law, patch, dcb, enf, frmm, sensitivity"
    assert expected in capsys.readouterr().err


@pytest.mark.long
def test_quick_reproduction(tmp_path: Path) -> None:
    verdicts = command.reproduce([], tmp_path, quick=True, console=quiet())
    assert [verdict.statement.id for verdict in verdicts] == [statement.id for statement in read_statements()]
    assert not any(math.isnan(verdict.value) for verdict in verdicts)
    assert len(list((tmp_path / "quick").glob("figure_*.png"))) >= 20
