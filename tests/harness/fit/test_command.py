# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel fit`, on a deck that runs in no time: a truss that yields."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from uel.cli import main

MODULUS, YIELD, LENGTH = 200.0, 3.0, 10.0
HARDENED = MODULUS / 20.0
DECK = """\
*PARAMETER
modulus = 100.
strength = 2.
hardened = strength + 10.
*NODE
1, 0., 0.
2, 10., 0.
*NSET, NSET=END
2
*ELEMENT, TYPE=T2D2, ELSET=BAR
1, 1, 2
*SOLID SECTION, ELSET=BAR, MATERIAL=METAL
1.
*MATERIAL, NAME=METAL
*ELASTIC
<modulus>, 0.3
*PLASTIC
<strength>, 0.
<hardened>, 1.
*BOUNDARY
1, 1, 2
2, 2
*STEP, INC=100
*STATIC, DIRECT
0.05, 1.
*BOUNDARY
2, 1, 1, 0.5
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U1, RF1
*END STEP
"""


def force(displacement: np.ndarray) -> np.ndarray:
    """Closed form: elastic up to the yield stress, then with the tangent of E and the plastic modulus 10 in series."""
    strain = displacement / LENGTH
    onset = YIELD / MODULUS
    tangent = 1.0 / (1.0 / MODULUS + 1.0 / 10.0)
    return np.where(strain < onset, MODULUS * strain, YIELD + tangent * (strain - onset))


@pytest.fixture
def bar(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Deck and measured curve in the current folder."""
    monkeypatch.chdir(tmp_path)
    Path("bar.inp").write_text(DECK)
    x = np.linspace(0.01, 0.499, 30)
    rows = [f"{a:.6g}, {b:.6g}\n" for a, b in zip(x, force(x), strict=True)]
    Path("curve.csv").write_text("U1[END], RF1[END]\n" + "".join(rows))
    return tmp_path


@pytest.mark.long
def test_modulus_and_strength(bar: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["fit", "bar.inp", "curve.csv", "modulus=100:180:300", "STRENGTH=2:2.8:4", "--cpus", "2"]
    assert main(words) == 0
    told = capsys.readouterr().out.splitlines()
    (runs,) = (int(match[1]) for line in told if (match := re.match(r"converged after (\d+) runs; standard", line)))
    assert runs <= 40
    with Path("fit/bar_fit.csv").open(newline="") as file:
        found = {row["name"]: row for row in csv.DictReader(file)}
    # increments of 0.025 cut the corner of the closed form
    assert float(found["modulus"]["value"]) == pytest.approx(MODULUS, rel=0.01)
    assert float(found["STRENGTH"]["value"]) == pytest.approx(YIELD, rel=0.01)
    with Path("fit/bar_fit_curve.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head[:3] == ["U1[END]", "measured RF1[END]", "fitted RF1[END]"]
    curves = np.array(rows, dtype=float)
    assert curves[:, 2] == pytest.approx(curves[:, 1], abs=0.05 * YIELD)
    assert Path("fit/bar_fit.png").read_bytes().startswith(b"\x89PNG")
    done = sorted(Path("fit/runs").glob("fit-*/fit-*.sta"))
    assert len(done) == runs

    # the same command again repeats nothing, and finds the same
    times = [path.stat().st_mtime_ns for path in done]
    assert main([*words, "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    assert [path.stat().st_mtime_ns for path in done] == times


@pytest.mark.parametrize(
    "words, message",
    [
        (["GIC=0.1:0.5"], r"nor is 'GIC' a property of the project's interface elements on data lines of bar.inp"),
        (["modulus=5"], r"'modulus=5': expected NAME=LOW:HIGH"),
        (["modulus=5:6", "MODULUS=5:6"], r"MODULUS, modulus: given more than once"),
        (["modulus=5:6", "--x=0*U"], r"'0\*U': expected a column of the history"),
    ],
)
def test_wrong_usage(bar: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str) -> None:
    assert main(["fit", "bar.inp", "curve.csv", *words]) == 2
    assert re.search(message, capsys.readouterr().err)


def test_limit_is_told(bar: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fit", "bar.inp", "curve.csv", "modulus=50:80", "--runs", "2"]) == 1
    told = capsys.readouterr().out
    assert "the limit of 2 runs after 2 runs" in told


def test_run_that_cannot_be_compared(bar: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["fit", "bar.inp", "curve.csv", "modulus=50:600", "--runs", "2"]
    assert main([*words, "--y=RF3[END]"]) == 2
    told = capsys.readouterr().err
    assert "fit-001 (modulus = 173.205): no column 'RF3[END]'" in told
    assert re.search(r"what it printed is in fit/runs/.*fit-001\.log; narrower bounds or --fallback may help", told)
    assert main([*words, "--y=RF3[END]", "--fallback"]) == 2
    assert "fit-001.log; narrower bounds may help" in capsys.readouterr().err
