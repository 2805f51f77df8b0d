# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of double cantilever beams."""

import re
from pathlib import Path

import pytest

from uel.paper import beam_table


@pytest.mark.long
def test_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert beam_table.main(["--output-dir", str(tmp_path), "dcb_u4_1e8.inp"]) == 0
    peaks = re.search(r"peak load, N\D+([\d.]+)\D+([\d.]+)", capsys.readouterr().out)
    assert peaks is not None
    # beam theory with a sharp crack: the process zone takes a few per cent off
    assert [float(peak) for peak in peaks.groups()] == pytest.approx([52.32, 52.32], rel=0.04)


def test_unknown_deck(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        beam_table.main(["--output-dir", str(tmp_path), "dcb_u7.inp"])
    assert "no deck dcb_u7.inp; expected one of dcb_u2_1e6.inp, dcb_u2_1e8.inp" in capsys.readouterr().err
