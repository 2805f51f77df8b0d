# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from uel.output.pictures.plots import COLOURS, Curve, load_displacement, profiles

X = np.linspace(0.0, 3.0, 50)


def has_colour(picture: np.ndarray, colour: str) -> bool:
    return bool((np.abs(picture[:, :, :3] - to_rgb(colour)).max(axis=2) < 0.01).any())


@pytest.mark.parametrize("count", [1, 7])
def test_each_curve_is_drawn_in_its_own_colour_at_print_resolution(tmp_path: Path, count: int) -> None:
    curves = [Curve(f"curve {k}", X, X * (k + 1)) for k in range(count)]
    picture = matplotlib.image.imread(load_displacement(curves, tmp_path / "p.png"))
    assert picture.shape[:2] == (1020, 1650)
    assert all(has_colour(picture, colour) for colour in COLOURS[:count])
    assert not any(has_colour(picture, colour) for colour in COLOURS[count:6])


def test_curves_of_one_label_look_alike_in_all_panels(tmp_path: Path) -> None:
    panels = [[Curve("a", X, X), Curve("b", X, -X)], [Curve("b", X, X**2)]]
    picture = matplotlib.image.imread(profiles(panels, tmp_path / "p.png", y_labels=["T [MPa]", "Damage"]))
    lower = picture[picture.shape[0] // 2 :]
    assert has_colour(lower, COLOURS[1])
    assert not has_colour(lower[:-1], COLOURS[0])


@pytest.mark.parametrize("kind", ["line", "reference", "points", "marked"])
@pytest.mark.parametrize("ending", [".png", ".pdf", ".svg"])
def test_kinds_of_curves_and_of_files(tmp_path: Path, kind: str, ending: str) -> None:
    panels = [[Curve("a", X, np.sin(X), kind), Curve("b", X, X)]]
    path = profiles(panels, tmp_path / f"p{ending}", y_labels=["Normal traction [MPa]"])
    assert path.stat().st_size > 1000
