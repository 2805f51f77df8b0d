# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pagano's strip: the exact solution against theory, and the page of convergence against runs of coarse meshes."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from uel.paper.study.pagano import Strip, StripPly
from uel.paper.study.rates import DISTORTION, KINDS, ROWS, STRIP, errors, half_strip, loads

PAGE = Path(__file__).parents[2] / "fortran" / "convergence.md"


def test_slender_homogeneous_strip_bends_as_a_plate() -> None:
    """w = q L^4/(pi^4 D), D = E h^3/(12 (1 - nu^2)); shear adds (h/L)^2."""
    ply = StripPly((1000.0, 1000.0, 1000.0), (0.3, 0.3, 0.3), 1000.0 / 2.6)
    strip = Strip(100.0, (0.25, 0.75), (ply, ply))
    u, v, shear, normal = strip.amplitudes(0.5)
    assert v == pytest.approx(12 * (1 - 0.09) / 1000.0 * (100.0 / np.pi) ** 4, rel=1e-3)
    # the neutral line, the parabola of the shear, 1.5 times its mean q L/pi, and half of the pressure
    assert abs(u) < 1e-6 * v
    assert shear == pytest.approx(1.5 * 100.0 / np.pi, rel=1e-3)
    assert normal == pytest.approx(0.5, rel=1e-3)


def test_equilibrium_of_unlike_plies() -> None:
    """The shear over the end carries the load; the lower face is free; displacements and tractions do not jump."""
    heights = np.linspace(0.0, 1.0, 2001)
    amplitudes = np.array([STRIP.amplitudes(y) for y in heights])
    assert amplitudes[0, 2:] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert amplitudes[-1, 2:] == pytest.approx([0.0, 1.0], abs=1e-9)
    assert trapezoid(amplitudes[:, 2], heights) == pytest.approx(1.0 / STRIP.wave, rel=1e-5)
    assert np.abs(np.diff(amplitudes, axis=0)).max() < 2e-2
    x = np.linspace(0.0, 2.0, 5)
    assert STRIP.tractions(x, 0.5)[:, 1] == pytest.approx(amplitudes[1000, 3] * np.sin(STRIP.wave * x))


@pytest.mark.parametrize("kind", KINDS)
def test_loads_are_those_of_the_pressure(kind: str) -> None:
    """Its resultant, q/p on half of the strip, and its moment about the support, q/p^2."""
    mesh = half_strip(kind, 4, DISTORTION)
    forces = loads(mesh)
    assert forces.sum() == pytest.approx(1.0 / STRIP.wave)
    assert forces @ mesh.nodes[:, 0] == pytest.approx(1.0 / STRIP.wave**2)


def rows() -> dict[tuple[bool, str, int], list[float]]:
    """Numbers of the page by distortion, solid and rows."""
    found, distorted = {}, False
    for line in PAGE.read_text("utf-8").partition("## Tables")[2].splitlines():
        distorted = distorted or line == "### Distorted meshes"
        if re.match(r"\| CP", line):
            kind, count, *cells = (cell.strip() for cell in line.strip("|").split("|"))
            found[distorted, kind, int(count)] = [float(cell) if cell else np.nan for cell in cells]
    return found


@pytest.mark.parametrize("distorted", [False, True], ids=["regular", "distorted"])
@pytest.mark.parametrize("kind", KINDS)
def test_page_has_what_runs_give(tmp_path: Path, kind: str, distorted: bool) -> None:
    page = rows()
    assert len(page) == 2 * len(KINDS) * len(ROWS)
    ours, shared = errors(kind, ROWS[0], DISTORTION if distorted else 0.0, tmp_path)
    printed = page[distorted, kind, ROWS[0]]
    for column, name in ((0, "energy"), (3, "displacement"), (6, "traction")):
        assert [getattr(ours, name), getattr(shared, name)] == pytest.approx(printed[column : column + 2], rel=0.01)


def test_what_the_page_says_of_its_numbers() -> None:
    page = rows()
    finest = {key: numbers for key, numbers in page.items() if key[2] == ROWS[-1]}
    for numbers in page.values():
        # nothing is lost
        assert numbers[0] == pytest.approx(numbers[1], rel=0.03)
        assert numbers[3] == pytest.approx(numbers[4], rel=0.03)
    for (distorted, kind, count), numbers in page.items():
        share = numbers[6] / numbers[7]
        if not distorted and kind != "CPE3":
            assert share < (1 / 70 if kind.startswith("CPE8") else 1 / 6)
        if count == ROWS[-1] and not distorted:
            assert share < 1 / 19
        if distorted and kind != "CPE4R" and count == ROWS[-1]:
            assert share < 1 / 3
    linear = [numbers for (distorted, kind, _), numbers in finest.items() if not distorted and kind in KINDS[:3]]
    assert [numbers[8] for numbers in linear] == pytest.approx([2.0] * 3, abs=0.1)
