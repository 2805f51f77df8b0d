# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel fit` recovers properties of a double cantilever beam from its curve with noise, without and with bridging."""

import csv
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.cli import main
from uel.delamination.kernels import uel_property
from uel.delamination.materials import TABLE_2
from uel.delamination.steps import Increments
from uel.paper import measures
from uel.paper.study.cases import KINDS, deck_files, interface_of
from uel.running.job import run
from uel.solver.options import SolverOptions

NOISE, POINTS, OPENING, INCREMENTS = 0.01, 80, 2.0, 60


@pytest.mark.long
def test_toughness_and_strength(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    kind = KINDS["dcb"]
    interface = replace(interface_of("consistent", "inf"), beta=-1.0)
    step = 1.0 / INCREMENTS
    files = deck_files(
        "dcb",
        "elements of 0.25 mm",
        kind,
        "0/0",
        kind.mesh(0.25, 0.0),
        interface,
        displacement=OPENING,
        increments=Increments(step, 1e-7, step, field_parts=1),
    )
    for name, text in files.items():
        Path(name).write_text(text)
    result = run("dcb.inp", output_dir="true", solver=SolverOptions(fallback=True))
    x = np.linspace(0.02 * OPENING, 0.999 * OPENING, POINTS)
    y = np.interp(x, measures.displacement(result), measures.load(result))
    y += np.random.default_rng(18).normal(0.0, NOISE * measures.peak_load(result), POINTS)
    rows = [f"{a:.6g}, {b:.6g}\n" for a, b in zip(x, y, strict=True)]
    Path("measured.csv").write_text("U2[LOAD_TOP], RF2[LOAD_TOP]\n" + "".join(rows))

    assert main(["fit", "dcb.inp", "measured.csv", "GIC=0.1:0.2:0.6", "SIGMAMAX=10:20:60", "--fallback"]) == 0
    found = re.search(r"converged after (\d+) runs", capsys.readouterr().out)
    assert found is not None
    assert int(found[1]) < 40
    with Path("fit/dcb_fit.csv").open(newline="") as file:
        fitted = {
            row["name"]: {key: float(text) for key, text in row.items() if key not in ("name", "note")}
            for row in csv.DictReader(file)
        }
    # what the curve was made with
    assert fitted["GIC"]["value"] == pytest.approx(TABLE_2.toughness_1, rel=0.01)
    assert fitted["SIGMAMAX"]["value"] == pytest.approx(TABLE_2.strength_normal, rel=0.1)
    assert fitted["GIC"]["lower"] < TABLE_2.toughness_1 < fitted["GIC"]["upper"]
    assert fitted["SIGMAMAX"]["lower"] < TABLE_2.strength_normal < fitted["SIGMAMAX"]["upper"]
    # a hundredth of the load is the noise
    assert fitted["GIC"]["upper"] - fitted["GIC"]["lower"] < 0.05 * TABLE_2.toughness_1


TIP = {"ALPHAN": 1e6, "ALPHAT": 1e6, "SIGMAMAX": 15.0, "TAUMAX": 30.0, "GIC": 0.26, "GIIC": 1.0}
BRIDGES = {"ALPHAN": 1e5, "ALPHAT": 1e5, "SIGMAMAX": 1.5, "TAUMAX": 3.0, "GIC": 0.30, "GIIC": 1.2}
"""Both soften from 1.5e-5 mm on, so that their sum in mode I is LAW 5 to the rounding."""
BRIDGING_NOISE = 0.3
"""Standard deviation (N) of the loads, of which the largest is 64 N."""


def properties(elset: str, **values: float) -> str:
    """Write *UEL PROPERTY of U2, 20 mm wide."""
    return "\n".join(uel_property(2, elset, {"THICKNESS": 20.0, **values})) + "\n"


def interface_decks(folder: Path, increments: int) -> None:
    """Write the beam with two elements on each pair of edges, two.inp, and with one of LAW 5, bridged.inp."""
    kind, step = KINDS["dcb"], 1.0 / increments
    files = deck_files(
        "dcb",
        "elements of 0.25 mm",
        kind,
        "0/0",
        kind.mesh(0.25, 0.0),
        interface_of("standard", "1e6"),
        displacement=8.0,
        increments=Increments(step, 1e-7, step, field_parts=1),
    )
    deck = files.pop("dcb.inp")
    for name, text in files.items():
        (folder / name).write_text(text)
    given = re.search(r"\*UEL PROPERTY, ELSET=INTERFACE\n(?:[^*].*\n)+", deck)
    assert given is not None
    rows = [line.split(",") for line in files["mesh_interface4.inp"].splitlines() if line[0].isdigit()]
    others = "\n".join(",".join([str(int(row[0]) + 100_000), *row[1:]]) for row in rows)
    both = [
        properties("INTERFACE", **TIP),
        f"*ELEMENT, TYPE=U2, ELSET=BRIDGES\n{others}\n",
        properties("BRIDGES", **BRIDGES),
    ]
    (folder / "two.inp").write_text(deck.replace(given[0], "".join(both)))
    total = {name: value + BRIDGES[name] for name, value in TIP.items()}
    # far from what the curve is made with
    start = total | {"LAW": 5, "GIC": 0.5, "SIGMABRIDGE": 3.0, "GIBRIDGE": 0.2}
    (folder / "bridged.inp").write_text(deck.replace(given[0], properties("INTERFACE", **start)))
    # without fibres
    (folder / "plain.inp").write_text(deck.replace(given[0], properties("INTERFACE", **total, LAW=2)))


@pytest.mark.long
def test_fibre_bridging(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """LAW 5 leaves nothing but the noise, and its parts are those of the two elements that made the curve.

    LAW 2 cannot follow, and the fit says so.
    """
    monkeypatch.chdir(tmp_path)
    interface_decks(tmp_path, 120)
    result = run("two.inp", output_dir="true", solver=SolverOptions(fallback=True))
    x = np.linspace(0.16, 7.98, POINTS)
    noise = np.random.default_rng(18).normal(0.0, BRIDGING_NOISE, POINTS)
    y = np.interp(x, measures.displacement(result), measures.load(result)) + noise
    rows = [f"{a:.6g}, {b:.6g}\n" for a, b in zip(x, y, strict=True)]
    Path("measured.csv").write_text("U2[LOAD_TOP], RF2[LOAD_TOP]\n" + "".join(rows))

    assert main(["fit", "plain.inp", "measured.csv", "GIC=0.2:0.5:0.8", "--fallback"]) == 3
    assert "the residuals are not noise: neighbours along U2[LOAD_TOP] go together" in capsys.readouterr().out

    words = ["GIC=0.47:0.5:0.8", "GIBRIDGE=0.1:0.2:0.45", "SIGMABRIDGE=0.5:3:6", "--fallback", "--runs", "80"]
    assert main(["fit", "bridged.inp", "measured.csv", *words]) == 0
    with Path("fit/bridged_fit.csv").open(newline="") as file:
        fitted = {row["name"]: row for row in csv.DictReader(file)}
    true = {"GIC": 0.56, "GIBRIDGE": 0.30, "SIGMABRIDGE": 1.5}
    for name, value in true.items():
        assert float(fitted[name]["lower"]) < value < float(fitted[name]["upper"])
    assert float(fitted["GIC"]["value"]) == pytest.approx(0.56, rel=0.005)
    assert float(fitted["GIBRIDGE"]["value"]) == pytest.approx(0.30, rel=0.03)
    assert float(fitted["SIGMABRIDGE"]["value"]) == pytest.approx(1.5, rel=0.05)
    with Path("fit/bridged_fit_curve.csv").open(newline="") as file:
        left = [
            float(row["fitted RF2[LOAD_TOP]"]) - float(row["measured RF2[LOAD_TOP]"]) for row in csv.DictReader(file)
        ]
    # no more than with the values that the curve is made with
    assert np.sqrt(np.mean(np.square(left))) <= np.sqrt(np.mean(noise**2))
