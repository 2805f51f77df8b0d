# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of the deformed mesh."""

import itertools
from pathlib import Path

import matplotlib as mpl
import matplotlib.image
import meshio
import numpy as np
import pytest
from matplotlib.figure import Figure
from reference_cells import CORNERS, FACES, SHARES, nodes_of, shape_of

from uel.errors import UsageError
from uel.model.element_types import FAMILIES
from uel.output.pictures.mesh import draw_mesh, fields_of, outer_faces, outline, visible_scale

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])


def stacked(count: int, step: tuple[float, float, float]) -> np.ndarray:
    """Squares, each a step beyond the one before."""
    return (SQUARE + np.multiply.outer(np.arange(count), step)[:, None]).reshape(-1, 3)


def has_colour(picture: np.ndarray, colour: tuple[float, ...]) -> bool:
    return bool((np.abs(picture[:, :, :3] - colour[:3]).max(axis=2) < 0.01).any())


def test_a_cell_has_the_colour_of_its_value(tmp_path: Path) -> None:
    """Lowest and highest value at the ends of the colours; a cell without the field is grey."""
    points = stacked(3, (1.0, 0.0, 0.0))
    cells = [("quad", np.arange(12).reshape(3, 4))]
    mesh = meshio.Mesh(points, cells, {"U": 0.0 * points}, {"S11": [np.array([0.0, 1.0, np.nan])]})
    picture = matplotlib.image.imread(draw_mesh(mesh, tmp_path / "m.png", field="S11"))
    rows = slice(0, int(0.6 * len(picture)))
    colours = mpl.colormaps["viridis"]
    assert has_colour(picture[rows], colours(0.0))
    assert has_colour(picture[rows], colours(1.0))
    assert not has_colour(picture[rows], colours(0.5))
    assert has_colour(picture[rows], (0.85, 0.85, 0.85))


BY_NAME = {family.cell: family for family in FAMILIES.values()}


@pytest.mark.parametrize("cell", [cell for cell in SHARES if CORNERS[shape_of(cell)].shape[1] == 2])
def test_outline_of_a_cell_in_the_plane(cell: str) -> None:
    """All its nodes in order, around the whole area: that of the corners."""
    nodes, corners = nodes_of(cell), CORNERS[shape_of(cell)]
    order = outline(BY_NAME[cell])
    assert sorted(order) == list(range(len(nodes)))
    assert area(nodes[order]) == pytest.approx(area(corners), rel=1e-12)


def area(ring: np.ndarray) -> float:
    """Of a polygon (trapezoidal formula)."""
    following = np.roll(ring, -1, axis=0)
    return float((ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]).sum()) / 2.0


@pytest.mark.parametrize("cell", [cell for cell in SHARES if CORNERS[shape_of(cell)].shape[1] == 3])
def test_a_single_solid_shows_all_its_faces(cell: str) -> None:
    nodes = np.arange(len(nodes_of(cell)))[None]
    found = outer_faces(BY_NAME[cell], nodes, np.ones(1))
    faces = {frozenset(face) for corners, _ in found for face in corners.tolist()}
    assert faces == {frozenset(face) for face in FACES[shape_of(cell)]}


def test_face_between_two_solids_is_hidden() -> None:
    """The others have the value of their brick."""
    bricks = np.array([[*range(8)], [*range(4, 12)]])
    ((faces, values),) = outer_faces(BY_NAME["hexahedron"], bricks, np.array([1.0, 2.0]))
    assert len(faces) == 10
    assert frozenset(range(4, 8)) not in {frozenset(face) for face in faces.tolist()}
    below = faces.max(axis=1) < 8
    assert (values[below] == 1.0).all()
    assert (values[~below] == 2.0).all()


def test_in_space_what_lacks_the_field_does_not_hide_what_has_it(tmp_path: Path) -> None:
    """The interface between two bricks."""
    points = stacked(3, (0.0, 0.0, 1.0))
    cells = [("hexahedron", np.array([[*range(8)], [*range(4, 12)]])), ("quad", np.arange(4, 8)[None])]
    data = {"DAMAGE": [np.full(2, np.nan), np.zeros(1)]}
    mesh = meshio.Mesh(points, cells, {"U": 0.0 * points}, data)
    lowest = mpl.colormaps["viridis"](0.0)
    # the only value is the lowest; displacements are zero too, and hide the interface
    inner, outer = (
        (
            np.abs(matplotlib.image.imread(draw_mesh(mesh, tmp_path / "m.png", field=field))[:, :, :3] - lowest[:3])
            < 0.05
        )
        .all(axis=2)
        .sum()
        for field in ("DAMAGE", "U")
    )
    assert 0 < inner < outer


@pytest.mark.parametrize("size", [(30.0, 16.0, 1.0), (1.0, 1.0, 20.0), (1.0, 1.0, 1.0)], ids=["plate", "bar", "cube"])
@pytest.mark.parametrize("value", [1.0, np.nan], ids=["colours", "no values"])
def test_picture_in_space_has_no_empty_parts(tmp_path: Path, size: tuple[float, ...], value: float) -> None:
    """Of the square of axes in space a plate fills a third."""
    points = stacked(2, (0.0, 0.0, 1.0)) * size
    mesh = meshio.Mesh(points, [("hexahedron", np.arange(8)[None])], {"U": 0.0 * points}, {"S11": [np.array([value])]})
    picture = matplotlib.image.imread(draw_mesh(mesh, tmp_path / "m.png", field="S11"))[:, :, :3]
    height, width = picture.shape[:2]
    assert max(height, width) < 200 * 8.5
    for axis, length in ((1, height), (0, width)):
        drawn = np.flatnonzero((picture < 1.0).any(axis=(axis, 2)))
        # from side to side: the margins of the picture are a tenth of an inch
        assert np.diff([0, *drawn, length]).max() < max(40, 0.1 * length)


@pytest.mark.parametrize(
    ("largest", "scale"), [(0.0, 1.0), (0.5, 1.0), (0.02, 1.0), (0.01, 2.0), (1e-4, 200.0), (3e-4, 70.0)]
)
def test_small_displacements_are_made_visible(largest: float, scale: float) -> None:
    u = np.zeros((4, 3))
    u[2, 1] = largest
    assert visible_scale(SQUARE, u) == scale


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """Gets the figures, which are not written."""
    figures: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: figures.append(figure))
    return figures


@pytest.mark.parametrize(("value", "limits"), [(1.0, (0.0, 1.0)), (0.0, (0.0, 1.0)), (-5.0, (-5.0, 0.0))])
def test_range_of_one_value(tmp_path: Path, kept: list[Figure], value: float, limits: tuple[float, float]) -> None:
    """A damage of 1 everywhere is the upper end of a range that does not go beyond it."""
    mesh = meshio.Mesh(SQUARE, [("quad", np.arange(4)[None])], {"U": 0.0 * SQUARE}, {"DAMAGE": [np.array([value])]})
    draw_mesh(mesh, tmp_path / "m.png", field="DAMAGE")
    assert kept[0].axes[-1].get_xlim() == limits


def test_rounding_of_a_uniform_field_has_one_colour(tmp_path: Path, kept: list[Figure]) -> None:
    points = stacked(2, (1.0, 0.0, 0.0))
    stress = np.array([700.0, np.nextafter(700.0, 800.0)])
    cells = [("quad", np.arange(8).reshape(2, 4))]
    draw_mesh(meshio.Mesh(points, cells, {"U": 0.0 * points}, {"S11": [stress]}), tmp_path / "m.png", field="S11")
    assert kept[0].axes[-1].get_xlim() == (0.0, stress[1])
    first, second = kept[0].axes[0].collections[0].get_facecolors()
    assert first.tolist() == second.tolist()


def test_numbers_below_the_colours_stay_apart(tmp_path: Path, kept: list[Figure]) -> None:
    """Below a tall model, where the bar is short."""
    points = stacked(3, (0.0, 1.0, 0.0))
    data = {"S11": [np.array([0.0012, 0.02, 0.0443])]}
    draw_mesh(
        meshio.Mesh(points, [("quad", np.arange(12).reshape(3, 4))], {"U": 0.0 * points}, data),
        tmp_path / "m.png",
        field="S11",
    )
    (figure,) = kept
    figure.canvas.draw()
    low, high = figure.axes[-1].get_xlim()
    labels = [label for label in figure.axes[-1].get_xticklabels() if low <= label.get_position()[0] <= high]
    boxes = [label.get_window_extent() for label in labels]
    assert 2 < len(boxes) <= 6
    assert all(left.x1 < right.x0 for left, right in itertools.pairwise(boxes))


def test_components_and_unknown_fields(tmp_path: Path) -> None:
    mesh = meshio.Mesh(SQUARE, [("quad", np.arange(4)[None])], {"U": 0.1 * SQUARE, "NT11": SQUARE[:, 0]})
    assert fields_of(mesh) == ["U", "U1", "U2", "U3", "NT11"]
    assert draw_mesh(mesh, tmp_path / "m.svg", field="U2").stat().st_size > 1000
    with pytest.raises(UsageError, match="no field 'U4'; expected one of U, U1, U2, U3, NT11"):
        draw_mesh(mesh, tmp_path / "m.svg", field="U4")
