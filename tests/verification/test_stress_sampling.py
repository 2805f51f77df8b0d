# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The place where the stabilised element takes the bulk stress."""

import re
from pathlib import Path

import pytest

from uel.paper.study.sampling import flexure

PAGE = Path(__file__).parents[2] / "fortran" / "stabilised.md"


def test_stress_from_the_middle_of_the_face_does_not_zigzag(tmp_path: Path) -> None:
    # before anything fails: elsewhere the stress of a quad varies along its face
    middle, face, gauss = (flexure(sampling, 0.4, tmp_path, size=1.0) for sampling in range(3))
    assert face.variation > 2.0 * middle.variation
    assert gauss.variation > 2.0 * middle.variation
    assert face.load == pytest.approx(middle.load, rel=0.01)


@pytest.mark.long
def test_total_variation_of_the_samplings(tmp_path: Path) -> None:
    middle, face, gauss = (flexure(sampling, 4.0, tmp_path) for sampling in range(3))
    # other code: a prototype of this element on this mesh, 130.1 (1e6 N/mm^3) to 130.5 (1e12) at this displacement
    assert middle.variation == pytest.approx(130.3, rel=0.01)
    assert (face.load, gauss.load) == pytest.approx((middle.load, middle.load), rel=1e-3)
    # regression: the table of the page. A point more or less that fails at the end changes the tractions by 1 %.
    rows = re.findall(r"^\| [012] \| [^|]+ \| ([\d.]+) \| ([\d.]+) \| (\d+) \|$", PAGE.read_text("utf-8"), re.MULTILINE)
    assert len(rows) == 3
    for found, row in zip((middle, face, gauss), rows, strict=True):
        variation, load, iterations = map(float, row)
        assert found.variation == pytest.approx(variation, rel=0.01)
        assert found.load == pytest.approx(load, rel=5e-3)
        assert found.iterations == pytest.approx(iterations, rel=0.1)
