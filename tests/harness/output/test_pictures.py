# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What `uel plot` draws of the files of jobs."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from uel.cli import main
from uel.errors import UelError, UsageError
from uel.output import Result
from uel.output.files.sta_file import StatusRow, head
from uel.output.pictures.jobs import KINDS, PictureOptions, draw
from uel.output.pictures.plots import Curve

HISTORY = (
    "step,increment,time,U2[TIP],RF2[TIP],ALLIE,ALLVD,ALLWK\n"
    "1,1,0.5,0.1,2.0,0.1,1e-9,0.1\n1,2,0.75,0.15,3.0,0.2,1e-9,0.2\n1,3,1.0,0.2,,0.3,1e-9,0.3\n"
)
ROWS = (
    StatusRow(1, 1, 1, False, 3, 0.5, 0.5, 0.5),
    StatusRow(1, 2, 1, True, 16, 0.5, 0.5, 0.5),
    StatusRow(1, 2, 2, False, 4, 0.75, 0.75, 0.25),
    StatusRow(1, 3, 1, False, 2, 1.0, 1.0, 0.25),
)
Job = Callable[..., Result]


@pytest.fixture
def job(tmp_path: Path) -> Job:
    """A job with these files."""

    def write(name: str = "job", history: str = HISTORY, interface: str = "") -> Result:
        (tmp_path / f"{name}.sta").write_text(head() + "".join(f"{row}\n" for row in ROWS))
        (tmp_path / f"{name}_history.csv").write_text(history)
        if interface:
            (tmp_path / f"{name}_interface.csv").write_text(interface)
        return Result(tmp_path / name)

    return write


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., tuple[list[list[Curve]], str, list[str]]]:
    """Panels and labels of a picture, which is not drawn."""
    kept: list[tuple[list[list[Curve]], str, list[str]]] = []

    def keep(panels: list[list[Curve]], path: Path, x: str, y: list[str], **_: bool) -> Path:
        kept.append((panels, x, y))
        return path

    monkeypatch.setattr("uel.output.pictures.jobs.stacked", keep)

    def picture(kind: str, *results: Result, **asked: object) -> tuple[list[list[Curve]], str, list[str]]:
        draw(kind, results, tmp_path / "p.png", PictureOptions(**asked))
        return kept[-1]

    return picture


def test_load_over_displacement(job: Job, drawn, tmp_path: Path) -> None:
    """Of two jobs and an experiment; an increment without the load is left out."""
    measured = tmp_path / "test_7.csv"
    measured.write_text("0.1,1.9\n0.2,4.1\n")
    ((curves,), x, (y,)) = drawn("load", job("a"), job("b"), measured=[measured])
    assert [(curve.label, curve.kind) for curve in curves] == [("a", "marked"), ("b", "marked"), ("test_7", "points")]
    assert list(curves[0].x) == [0.1, 0.15]
    assert list(curves[0].y) == [2.0, 3.0]
    assert list(curves[2].y) == [1.9, 4.1]
    assert (x, y) == ("Displacement U2[TIP]", "Load RF2[TIP]")


def test_any_column_over_any_other(job: Job, drawn) -> None:
    ((curve,),), x, y = drawn("load", job(), x="u2[tip]", y=["allwk"])
    assert (x, y, list(curve.x), list(curve.y)) == ("u2[tip]", ["allwk"], [0.1, 0.15, 0.2], [0.1, 0.2, 0.3])
    (curves,), x, y = drawn("load", job("a"), job("b"), y=["ALLIE", "ALLWK"])
    assert [curve.label for curve in curves] == ["a, ALLIE", "a, ALLWK", "b, ALLIE", "b, ALLWK"]
    assert (x, y) == ("time", ["Value"])


def test_columns_and_curves_with_a_factor(job: Job, drawn, tmp_path: Path) -> None:
    """The opening of a beam is twice the displacement of an end, in the file of a test and on an axis."""
    measured = tmp_path / "test_7.csv"
    measured.write_text("2*U2[TIP], RF2[TIP]\n0.2,1.9\n0.4,4.1\n")
    ((_, points),), *_ = drawn("load", job(), measured=[measured])
    assert (list(points.x), list(points.y)) == ([0.1, 0.2], [1.9, 4.1])
    ((curve, points),), x, y = drawn("load", job(), x="2*U2[TIP]", y=["-RF2[TIP]"], measured=[measured])
    assert (x, y, list(curve.x), list(curve.y)) == ("2*U2[TIP]", ["-RF2[TIP]"], [0.2, 0.3], [-2.0, -3.0])
    assert (list(points.x), list(points.y)) == ([0.2, 0.4], [-1.9, -4.1])


def test_energies_that_matter(job: Job, drawn) -> None:
    """Viscous dissipation of a billionth is not drawn; several jobs have a panel for each energy."""
    (curves,), _, y = drawn("energies", job())
    assert ([curve.label for curve in curves], y) == (["ALLIE", "ALLWK"], ["Energy"])
    panels, _, y = drawn("energies", job("a"), job("b"))
    assert ([[curve.label for curve in panel] for panel in panels], y) == ([["a", "b"]] * 2, ["ALLIE", "ALLWK"])


def test_iterations_include_those_of_abandoned_attempts(job: Job, drawn) -> None:
    ((iterations,), (sizes,)), x, _ = drawn("iterations", job())
    assert list(iterations.x) == [0.5, 0.75, 1.0]
    assert list(iterations.y) == [3.0, 20.0, 2.0]
    assert list(sizes.y) == [0.5, 0.25, 0.25]
    assert x == "Total time"


def interface(points: list[tuple[float, ...]], names: str = "X,Y", damage: float = 0.5) -> str:
    rows = [f"1,3,1.0,{k},1,{','.join(map(str, point))},{point[0]},1e-12,{damage}\n" for k, point in enumerate(points)]
    return f"step,increment,time,element,point,{names},TN,TT,DAMAGE\n{''.join(rows)}"


def test_profile_in_the_order_of_the_points(job: Job, drawn) -> None:
    """On an interface along an axis the position is the coordinate. The shear of a pure mode is rounding."""
    panels, _, names = drawn("interface", job(interface=interface([(3.0, 1.5), (1.0, 1.5), (2.0, 1.5)])))
    assert names == ["TN", "DAMAGE"]
    ((tractions,), _) = panels
    assert tractions.x == pytest.approx([1.0, 2.0, 3.0])
    assert tractions.y == pytest.approx([1.0, 2.0, 3.0])


def test_spent_takes_the_panel_of_the_damage(job: Job, drawn) -> None:
    """Where all jobs have it; the panel of jobs with and without means one thing, DAMAGE."""
    text = interface([(3.0, 1.5), (1.0, 1.5)])
    head, *rows = text.splitlines()
    spent = "\n".join([f"{head},SPENT", *(f"{row},0.25" for row in rows), ""])
    (_, (curve,)), _, names = drawn("interface", job("a", interface=spent))
    assert names == ["TN", "SPENT"]
    assert list(curve.y) == [0.25, 0.25]
    (_, curves), _, names = drawn("interface", job("b", interface=spent), job("c", interface=text))
    assert names == ["TN", "DAMAGE"]
    assert [list(curve.y) for curve in curves] == [[0.5, 0.5]] * 2


def test_interfaces_above_each_other_are_not_joined(job: Job, drawn) -> None:
    points = [(1.0, 0.0), (1.0, 1.0), (20.0, 0.0), (20.0, 1.0)]
    ((tractions,), _), *_ = drawn("interface", job(interface=interface(points)))
    assert np.isnan(tractions.x[2])
    assert np.delete(tractions.x, 2) == pytest.approx([1.0, 20.0, 1.0, 20.0])
    # a slope, or one bump, is one interface
    bumpy = [(1.0, 0.0), (5.0, 0.3), (9.0, 0.0), (20.0, 0.1)]
    ((tractions,), _), *_ = drawn("interface", job(interface=interface(bumpy)))
    assert tractions.y == pytest.approx([1.0, 5.0, 9.0, 20.0])


@pytest.mark.parametrize(
    ("kind", "asked", "error", "message"),
    [
        ("load", {"y": ["RF"]}, UsageError, r"no column 'RF'; expected one of time, U2\[TIP\]"),
        ("load", {"y": ["0*U2[TIP]"]}, UsageError, r"'0\*U2\[TIP\]': expected a column of the history, with a factor"),
        ("load", {"x": "time"}, UsageError, "--x time: expected with --y"),
        ("energies", {"x": "time"}, UsageError, "--kind energies: expected without --x, --y and --csv"),
        ("interface", {}, UelError, "no such file; it is written only if the model has interface elements"),
        ("mesh", {}, UelError, "no field output"),
    ],
)
def test_what_is_not_there(job: Job, drawn, kind: str, asked: dict, error: type[UelError], message: str) -> None:
    with pytest.raises(error, match=message):
        drawn(kind, job(), **asked)


def test_what_a_history_or_an_interface_lacks(job: Job, drawn) -> None:
    bare = job("bare", "step,increment,time,U2[TIP]\n1,1,1.0,0.1\n")
    with pytest.raises(UelError, match=r"no force with its displacement; ask for both .* columns .*: time, U2\[TIP\]"):
        drawn("load", bare)
    with pytest.raises(UelError, match=r"no energies; ask for them with \*ENERGY OUTPUT"):
        drawn("energies", bare)
    surface = interface([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 1.0, 0.0), (2.0, 1.0, 0.0)], "X,Y,Z")
    with pytest.raises(UelError, match="the interface is a surface; --kind mesh --field SPENT shows it, and uel front"):
        drawn("interface", job(interface=surface))
    with pytest.raises(UsageError, match="--kind mesh: expected one job"):
        drawn("mesh", job("a"), job("b"))


def test_command(job: Job, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The kinds that it offers are those there are."""
    job("a")
    assert main(["plot", str(tmp_path / "a")]) == 0
    assert capsys.readouterr().out == f"written: {tmp_path}/a_load.png\n"
    assert (tmp_path / "a_load.png").stat().st_size > 1000
    words = ["plot", str(tmp_path / "a"), "--kind", "iterations", "-o", str(tmp_path / "b.tif")]
    assert main(words) == 2
    assert "expected a file name that ends with .png, .svg, .pdf" in capsys.readouterr().err
    assert main(["plot", str(tmp_path / "c")]) == 1
    assert "c.sta: no such job" in capsys.readouterr().err
    for kind in KINDS:
        main(["plot", str(tmp_path / "c"), "--kind", kind])
    with pytest.raises(SystemExit):
        main(["plot", "--help"])
    assert f"{{{','.join(KINDS)}}}" in capsys.readouterr().out
