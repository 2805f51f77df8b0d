# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The demonstration runs through and shows what it promises."""

import re
from pathlib import Path

import pytest

from harness.delamination import demo


@pytest.mark.long
def test_demo(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert demo.main(["--output-dir", str(tmp_path)]) == 0
    table = capsys.readouterr().out
    for figure in ("dcb_load.png", "dcb_traction.png"):
        assert (tmp_path / figure).read_bytes().startswith(b"\x89PNG")
    peaks = re.search(r"peak load, N\D+52\.32\D+([\d.]+)\D+([\d.]+)", table)
    assert peaks is not None
    # beam theory with a sharp crack: the process zone takes a few per cent off
    assert [float(peak) for peak in peaks.groups()] == pytest.approx([52.32, 52.32], rel=0.04)


def test_unknown_deck(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        demo.main(["--output-dir", str(tmp_path), "dcb_u7.inp"])
    assert "no deck dcb_u7.inp; expected one of dcb_u2_1e6.inp, dcb_u2_1e8.inp" in capsys.readouterr().err
