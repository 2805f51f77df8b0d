# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in space: by PyVista where it is installed and can draw, else by matplotlib, which is told."""

from pathlib import Path

import matplotlib as mpl
import meshio
import numpy as np
import pytest
from matplotlib.image import imread

from uel.cli import main
from uel.output import Result
from uel.output.pictures.mesh import draw_mesh
from uel.output.pictures.space import SCREEN, Faces, RenderError, render_faces

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])


def bricks(values: tuple[float, float]) -> meshio.Mesh:
    """Two, one above the other."""
    points = np.vstack([np.add(SQUARE, [0.0, 0.0, level]) for level in range(3)])
    cells = [("hexahedron", np.array([[*range(8)], [*range(4, 12)]]))]
    return meshio.Mesh(points, cells, {"U": 0.0 * points}, {"S11": [np.array(values)]})


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A job whose mesh is that of two bricks."""
    monkeypatch.setattr(Result, "mesh", lambda *_: bricks((0.0, 1.0)))
    (tmp_path / "job.sta").write_text("")
    return tmp_path / "job"


@pytest.fixture
def child(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Let a script stand for the process that draws."""

    def stand_in(text: str) -> None:
        script = tmp_path / "draws"
        script.write_text(f"#!/bin/sh\n{text}\n")
        script.chmod(0o755)
        monkeypatch.setattr("uel.output.pictures.space.sys.executable", str(script))
        monkeypatch.setattr("uel.output.pictures.jobs.has_pyvista", lambda: True)

    return stand_in


def plotted(job: Path, ending: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """What `uel plot` says; the picture is there whatever drew it."""
    picture = job.with_suffix(ending)
    assert main(["plot", str(job), "--kind", "mesh", "--field", "S11", "-o", str(picture)]) == 0
    *notes, last = capsys.readouterr().out.splitlines()
    assert last == f"written: {picture}"
    assert picture.stat().st_size > 1000
    return notes


def test_without_pyvista(job: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """The note says what to install; lines and polygons of .svg and .pdf are matplotlib's in any case."""
    monkeypatch.setattr("uel.output.pictures.jobs.has_pyvista", lambda: False)
    (note,) = plotted(job, ".png", capsys)
    assert note == "drawn by matplotlib, which may take a face behind for one in front; PyVista: pip install pyvista"
    assert plotted(job, ".svg", capsys) == []


@pytest.mark.parametrize(
    ("script", "note"),
    [
        (
            "kill -SEGV $$",
            "VTK ended with SIGSEGV, as it does without OpenGL; install libegl1 and libgl1-mesa-dri, or lib",
        ),
        (
            "echo first >&2; echo ImportError: no libGL >&2; exit 1",
            "PyVista cannot draw here: ImportError: no libGL; drawn",
        ),
        ("exit 3", "PyVista cannot draw here: exit code 3; drawn by matplotlib"),
    ],
)
def test_pyvista_that_cannot_draw(script: str, note: str, job: Path, child, capsys: pytest.CaptureFixture[str]) -> None:
    child(script)
    (told,) = plotted(job, ".png", capsys)
    assert note in told
    assert told.endswith("; drawn by matplotlib")


def test_display_that_does_not_answer(child, monkeypatch: pytest.MonkeyPatch) -> None:
    child("exec sleep 60")
    monkeypatch.setattr("uel.output.pictures.space._SECONDS", 0.1)
    with pytest.raises(RenderError, match=r"PyVista has not drawn within 0\.1 s"):
        render_faces([Faces(SQUARE[None], np.zeros(1))], [], (0.0, 1.0), edges=False)


def test_what_the_process_draws_is_shown(job: Path, child, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without its margins, with the colours' bar of all pictures."""
    red = np.ones((60, 90, 4))
    red[20:40, 30:60, 1:3] = 0.0
    mpl.image.imsave(tmp_path / "red.png", red)
    child(f'cp "{tmp_path / "red.png"}" "$4"')
    assert plotted(job, ".png", capsys) == []
    picture = imread(job.with_suffix(".png"))[:, :, :3]
    reds = np.argwhere(np.abs(picture - [1.0, 0.0, 0.0]).max(axis=2) < 0.02)
    height, width = np.ptp(reds, axis=0)
    assert width / height == pytest.approx(1.5, rel=0.02)
    # as wide as the picture allows
    assert width > 0.8 * picture.shape[1]
    assert (np.abs(picture - mpl.colormaps["viridis"](0.5)[:3]).max(axis=2) < 0.02).any()


def test_directions_of_the_picture() -> None:
    """Of unit length and at right angles; z points upwards."""
    np.testing.assert_allclose(SCREEN @ SCREEN.T, np.eye(2), atol=1e-12)
    assert SCREEN[0, 2] == 0.0
    assert SCREEN[1, 2] > 0.5


@pytest.fixture(scope="module")
def drawing() -> None:
    """PyVista, where it is installed and can draw."""
    pytest.importorskip("pyvista")
    try:
        render_faces([Faces(SQUARE[None], np.zeros(1))], [], (0.0, 1.0), edges=False)
    except RenderError as error:
        pytest.skip(str(error))


def shares(picture: np.ndarray) -> list[int]:
    """Pixels in the lowest and the highest colour."""
    colours = (mpl.colormaps["viridis"](value)[:3] for value in (0.0, 1.0))
    return [int((np.abs(picture[:, :, :3] - colour).max(axis=2) < 0.02).sum()) for colour in colours]


@pytest.mark.usefixtures("drawing")
def test_pyvista_hides_what_lies_behind() -> None:
    """A face above hides one below it; side by side both are seen, in the same size."""
    below, beside = SQUARE[None] - 1e-3 * np.array([0.5, -0.87, 0.55]), SQUARE[None] + [1.5, 0.0, 0.0]
    for other, visible in ((below, False), (beside, True)):
        faces = [Faces(SQUARE[None], np.ones(1)), Faces(other, np.zeros(1))]
        low, high = shares(render_faces(faces, [], (0.0, 1.0), edges=False))
        assert high > 10000
        assert low == pytest.approx(high, rel=0.02) if visible else low < 0.01 * high


@pytest.mark.usefixtures("drawing")
def test_directions_of_pyvista() -> None:
    """The projection of a square: its width and height by the directions of the arrows."""
    picture = render_faces([Faces(SQUARE[None], np.zeros(1))], [], (0.0, 1.0), edges=False)
    width, height = np.ptp(SQUARE @ SCREEN.T, axis=0)
    assert picture.shape[1] / picture.shape[0] == pytest.approx(width / height, rel=0.01)


@pytest.mark.usefixtures("drawing")
def test_pyvista_draws_the_mesh_and_its_outline(tmp_path: Path) -> None:
    """Both bricks in the colours of their values; without values only lines, and no colours' bar."""
    picture = draw_mesh(bricks((0.0, 1.0)), tmp_path / "m.png", field="S11", by_pyvista=True)
    low, high = shares(imread(picture)[: int(0.7 * len(imread(picture)))])
    assert low > 10000
    assert high > 10000
    picture = draw_mesh(bricks((np.nan, np.nan)), tmp_path / "n.png", field="S11", by_pyvista=True)
    lines = (np.abs(imread(picture)[:, :, :3] - 0.3) < 0.2).all(axis=2).sum()
    assert 1000 < lines < 0.1 * imread(picture)[:, :, 0].size
