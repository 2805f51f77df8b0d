# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""my_uel against theory; the checks of pytest.ini look at the rest."""

from pathlib import Path

import pytest

import uel

HERE = Path(__file__).parent
DECK, USER = HERE / "my_uel.inp", HERE / "my_uel.for"
YOUNG, POISSON, LENGTH, HEIGHT, THICKNESS, STRETCH = 70000.0, 0.3, 20.0, 10.0, 2.0, 0.2


def test_patch(tmp_path: Path) -> None:
    """Stretch a patch uniaxially: distorted quads reproduce F = E A u/L, and the height shrinks by nu H u/L."""
    end = {name: values[-1] for name, values in uel.run(DECK, USER, output_dir=tmp_path).history.items()}
    strain = STRETCH / LENGTH
    assert sum(end[f"RF1[ALL:{node}]"] for node in (3, 6, 9)) == pytest.approx(YOUNG * strain * HEIGHT * THICKNESS)
    assert end["U2[ALL:9]"] == pytest.approx(-POISSON * strain * HEIGHT)
