# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of the problems: each has one, and what they draw as a reference is what the runs come to."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from uel.output.pictures.plots import Curve
from uel.paper import gallery
from uel.paper.decks import FOLDER
from uel.paper.gallery import EXAMPLES, PICTURE

PROBLEMS = sorted(page.parent for page in FOLDER.glob("*/README.md"))


def test_every_problem_has_an_example() -> None:
    assert sorted(EXAMPLES) == [folder.name for folder in PROBLEMS]


@pytest.mark.parametrize("folder", PROBLEMS, ids=lambda folder: folder.name)
def test_page_shows_its_picture(folder: Path) -> None:
    """Below its title; the decks are those of the references, so that the command of the manual runs one of them."""
    assert re.search(rf"^# .*\n\n!\[\w.*\]\({PICTURE}\)\n", (folder / "README.md").read_text("utf-8"), re.MULTILINE)
    assert (folder / PICTURE).read_bytes().startswith(b"\x89PNG")
    entries = tomllib.loads((folder / "reference.toml").read_text("utf-8"))["value"]
    known = {deck for entry in entries for deck in entry["decks"]}
    assert {f"{deck}.inp" for deck in EXAMPLES[folder.name].decks} <= known


def reference_and_run(problem: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[list[Curve], list[Curve]]:
    """References and runs that the picture of a problem shows; it is drawn too."""
    kept: list[Curve] = []
    drawn = gallery.load_displacement

    def keep(curves: list[Curve], path: Path, **labels: str) -> Path:
        kept.extend(curves)
        return drawn(curves, path, **labels)

    monkeypatch.setattr(gallery, "load_displacement", keep)
    assert gallery.main([problem, "--folder", str(tmp_path)]) == 0
    assert (tmp_path / problem / PICTURE).read_bytes().startswith(b"\x89PNG")
    return [curve for curve in kept if curve.kind != "line"], [curve for curve in kept if curve.kind == "line"]


def deviation(reference: Curve, run: Curve, first: float) -> float:
    """Largest distance of a run from its reference over its largest load, from a displacement on, where both are."""
    (x, y), (x_run, y_run) = ((np.asarray(curve.x), np.asarray(curve.y)) for curve in (reference, run))
    if reference.kind == "points":
        distances = np.interp(x, x_run, y_run) - y
    else:
        shown = (x_run >= first) & (x_run <= x[-1])
        distances = np.interp(x_run[shown], x, y) - y_run[shown]
    assert len(distances) > 1
    return float(np.abs(distances).max() / y_run.max())


@pytest.mark.parametrize(
    "problem, first, tolerance",
    [
        # published to eight digits
        ("dcb_3d", 0.0, 1e-6),
        # what the page says of the load after the start of growth
        ("dcb_elastica", 2.5, 0.01),
        # what the pages say, or require, of the deviation while the crack grows
        pytest.param("dcb", 1.5, 0.015, marks=pytest.mark.long),
        pytest.param("dcb_ref", 0.0, 0.01, marks=pytest.mark.long),
        pytest.param("paper_enf", 2.85, 0.04, marks=pytest.mark.long),
        pytest.param("paper_frmm", 2.8, 0.03, marks=pytest.mark.long),
        pytest.param("space_beams", 2.0, 0.02, marks=pytest.mark.long),
        pytest.param("krueger_dcb", 0.0, 0.03, marks=pytest.mark.long),
        pytest.param("circle", 2.5, 0.05, marks=pytest.mark.long),
    ],
)
def test_references_are_what_the_runs_come_to(
    problem: str, first: float, tolerance: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the axes of the picture: a wrong column, width or arm would be off by a factor."""
    (reference,), (run,) = reference_and_run(problem, tmp_path, monkeypatch)
    assert deviation(reference, run, first) < tolerance


@pytest.mark.long
def test_benchmark_of_mixed_mode(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The report's loads at the start of growth are a few per cent above the peaks, which the process zone rounds."""
    (reference,), runs = reference_and_run("krueger_mmb", tmp_path, monkeypatch)
    peaks = [float(np.max(run.y)) for run in runs]
    assert peaks == pytest.approx(np.asarray(reference.y), rel=0.05)


@pytest.mark.parametrize("problem", ["patch_horizontal", "patch_inclined", "properties", "quad_cook"])
def test_pictures_without_a_load_of_reference(problem: str, tmp_path: Path) -> None:
    assert gallery.main([problem, "--folder", str(tmp_path)]) == 0
    assert (tmp_path / problem / PICTURE).read_bytes().startswith(b"\x89PNG")


def test_unknown_problem(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        gallery.main(["dbc"])
    assert "no problem dbc; expected some of bridging, circle, cohesive, dcb," in capsys.readouterr().err
