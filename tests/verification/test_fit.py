# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel fit` recovers toughness and strength of a double cantilever beam from its curve with noise."""

import csv
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.cli import main
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
            row["name"]: {key: float(text) for key, text in row.items() if key != "name"}
            for row in csv.DictReader(file)
        }
    # what the curve was made with
    assert fitted["GIC"]["value"] == pytest.approx(TABLE_2.toughness_1, rel=0.01)
    assert fitted["SIGMAMAX"]["value"] == pytest.approx(TABLE_2.strength_normal, rel=0.1)
    assert fitted["GIC"]["lower"] < TABLE_2.toughness_1 < fitted["GIC"]["upper"]
    assert fitted["SIGMAMAX"]["lower"] < TABLE_2.strength_normal < fitted["SIGMAMAX"]["upper"]
    # a hundredth of the load is the noise
    assert fitted["GIC"]["upper"] - fitted["GIC"]["lower"] < 0.05 * TABLE_2.toughness_1
