# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The demonstration runs through, shows what it promises, and its page has what it shows."""

import re
from pathlib import Path

import pytest

from uel.paper import demo
from uel.paper.reproduce.cases import PaperCase

HERE = Path(demo.__file__).parent
PAGE = HERE / "demo.md"
NUMBER = r"-?\d+\.?\d*"


def rows(page: str) -> dict[str, list[float]]:
    """Rows of the page's tables, by their first word."""
    lines = re.findall(rf"^\| (\S[^|]*) ((?:\| {NUMBER} )+)\|$", page, re.MULTILINE)
    return {name.strip(): [float(cell) for cell in re.findall(NUMBER, cells)] for name, cells in lines}


@pytest.mark.long
def test_demo(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert demo.main(["--output-dir", str(tmp_path), "--page", str(tmp_path / "demo.md")]) == 0
    for name in ("interface.png", "loads.png"):
        for folder in (tmp_path, tmp_path / demo.PICTURES):
            assert (folder / name).read_bytes().startswith(b"\x89PNG")
    told = capsys.readouterr().out.splitlines()[-1]
    # beam theory with a sharp crack: the process zone takes a few per cent off
    peaks = [float(peak) for peak in re.findall(r"([\d.]+) N", told)]
    assert peaks[-1] == pytest.approx(52.32, abs=0.005)
    assert peaks[:-1] == pytest.approx([52.32] * 3, rel=0.04)

    found, kept = rows((tmp_path / "demo.md").read_text("utf-8")), rows(PAGE.read_text("utf-8"))
    assert list(found) == list(kept)
    # regression: the page. Rounding decides how increments of the standard element end
    for name in demo.BEAMS:
        peak, end, lowest, highest, variation, _, iterations = kept[name]
        assert found[name][:2] == pytest.approx([peak, end], rel=5e-3)
        assert found[name][2:4] == pytest.approx([lowest, highest], abs=4.0)
        assert found[name][4] == pytest.approx(variation, rel=0.1)
        assert found[name][6] == pytest.approx(iterations, rel=0.15)
    # a strength of 60 MPa bounds the shear; of the smooth elements the shear stays well below it
    assert -60.0 <= found["standard"][2] < -55.0
    assert 55.0 < found["standard"][3] <= 60.0
    assert max(map(abs, found["consistent"][2:4])) < 25.0
    assert found["consistent"][5] == 0.0 < found["standard"][5] < found["paper's"][5]


def test_a_run_that_ends_early_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same runs on coarse meshes; one of them may take only eight increments."""
    beams = [PaperCase("dcb", "0/0", name, "1e4", size=2.0, increments=10) for name in ("standard", "consistent")]
    snap = PaperCase("enf", "0/90", "consistent", "1e4", size=4.0, increments=10)
    for case, folder in ((beams[0], "paper_dcb"), (beams[1], "paper_dcb"), (snap, "paper_enf")):
        (tmp_path / folder).mkdir(exist_ok=True)
        for name, text in case.files().items():
            (tmp_path / folder / name).write_text(text)
    short = tmp_path / "paper_dcb" / f"{beams[0].name}.inp"
    short.write_text(short.read_text().replace("INC=200", "INC=8"))
    monkeypatch.setattr(demo, "FOLDER", tmp_path)
    monkeypatch.setattr(demo, "BEAMS", {case.element: f"{case.name}.inp" for case in beams})
    monkeypatch.setattr(demo, "SNAP", f"{snap.name}.inp")
    assert demo.main(["--output-dir", str(tmp_path / "out")]) == 1
    told = capsys.readouterr()
    assert "standard ended early: TOO MANY INCREMENTS" in told.err
    assert "consistent ended early" not in told.err
    assert "peak load: standard" in told.out.splitlines()[-1]


def test_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        demo.main(["dcb_u7.inp"])
    assert "unrecognized arguments: dcb_u7.inp" in capsys.readouterr().err
