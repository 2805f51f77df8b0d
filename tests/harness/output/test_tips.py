# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tips on lines with known fields: places, growth, directions, and Rice's integral."""

from collections.abc import Sequence
from pathlib import Path

import meshio
import numpy as np
import pytest

from uel.cli import main
from uel.errors import UelError
from uel.output import Result
from uel.output.files.field_output import Frame
from uel.output.files.sta_file import StatusRow
from uel.output.pictures.growth import growth
from uel.output.pictures.tips import are_lines, draw_tips, tips, write_tips

LENGTH, ZONE, SIZE = 40.0, 3.0, 0.25
STRENGTH, FINAL = np.array([30.0, 40.0]), np.array([0.01, 0.02])
"""Traction where the zone begins, separation where it ends: normal, along the growth."""
G = 0.5 * STRENGTH * FINAL
SPEED = 0.4


class Strip(Result):
    """A job whose interface is a straight line, or a circle, with process zones about two tips.

    Both leave the middle at the same speed; without the left one, all is damaged from the beginning on. The damage
    falls linearly over the zone, tractions are the strengths times 1 - D and separations the final ones times D.
    """

    increments: Sequence[int] = (1, 3, 4)

    def __init__(self, angle: float = 0.0, both: bool = False, bent: bool = False) -> None:
        count = round(LENGTH / SIZE)
        arc = np.linspace(0.0, LENGTH, count + 1)
        self.both = both
        self.turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        self.bent = bent
        cells = np.column_stack([np.arange(count), np.arange(1, count + 1)])
        # elements are numbered neither from one nor in the order of the file
        self.order = np.random.default_rng(2).permutation(count)
        self.nodes, self.cells, self.labels = self.place(arc), cells[self.order], np.arange(count)[::-1] + 10
        gauss = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
        self.arc = (arc[:-1, None] + gauss * SIZE)[self.order]

    def place(self, arc: np.ndarray) -> np.ndarray:
        radius = LENGTH / 2
        flat = np.column_stack([arc, 0 * arc])
        if self.bent:
            flat = radius * np.column_stack([np.sin(arc / radius), 1 - np.cos(arc / radius)])
        return flat @ self.turn.T

    def tip(self, time: float) -> float:
        return 0.55 * LENGTH + SPEED * time

    def damage(self, time: float) -> np.ndarray:
        right = 0.5 - (self.arc - self.tip(time)) / ZONE
        left = 0.5 + (self.arc - LENGTH + self.tip(time)) / ZONE
        return np.clip(np.minimum(left, right) if self.both else right, 0.0, 1.0)

    @property
    def status(self) -> list[StatusRow]:
        return [StatusRow(1, 4, 1, False, 1, 4.0, 4.0, 1.0)]

    @property
    def frames(self) -> list[Frame]:
        return [Frame(1, k, float(k), Path("none.vtu")) for k in self.increments]

    def file(self, ending: str) -> Path:
        return Path(f"strip{ending}")

    def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
        nodes = np.column_stack([self.nodes, 0 * self.nodes[:, 0]])
        known = np.zeros(len(self.cells))
        return meshio.Mesh(nodes, [("line", self.cells)], cell_data={"DAMAGE": [known], "ELEMENT": [self.labels]})

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        found = []
        for frame in self.frames:
            damage = self.damage(frame.time).ravel()
            x, y = self.place(self.arc.ravel()).T
            sign = np.where(self.both & (self.arc.ravel() < LENGTH / 2), -1.0, 1.0)
            parts = {"N": np.ones_like(sign), "T": sign}
            count = damage.size
            found.append(
                {
                    "step": np.ones(count),
                    "increment": np.full(count, frame.increment),
                    "element": np.repeat(self.labels, 2).astype(float),
                    "point": np.tile([1.0, 2.0], count // 2),
                    "X": x,
                    "Y": y,
                    "SPENT": damage,
                    **{f"T{name}": s * parts[name] * (1 - damage) for name, s in zip("NT", STRENGTH, strict=True)},
                    **{f"W{name}": w * parts[name] * damage for name, w in zip("NT", FINAL, strict=True)},
                }
            )
        return found


@pytest.mark.parametrize("angle", [0.0, 0.7, 3.0])
@pytest.mark.parametrize("both", [False, True])
@pytest.mark.parametrize("bent", [False, True])
def test_places_growth_and_energy_release_rates(angle: float, both: bool, bent: bool) -> None:
    strip = Strip(angle, both, bent)
    found = tips(strip, 0.5)
    assert len(found) == 3 * (1 + both)
    for tip in found:
        at = strip.tip(tip.time)
        # a line may begin at either end
        ends = [strip.place(np.array([arc]))[0] for arc in ((at, LENGTH - at) if both else (at,))]
        assert min(np.linalg.norm(tip.place - end) for end in ends) < 1e-3 * ZONE
        outward = tip.place - strip.place(np.array([LENGTH / 2 if both else at - 1.0]))[0]
        assert tip.ahead @ outward > 0
        assert np.linalg.norm(tip.ahead) == pytest.approx(1)
        assert tip.length == pytest.approx(2 * at - LENGTH if both else at, abs=1e-3 * ZONE)
        assert tip.traction == pytest.approx(0.5 * STRENGTH, rel=1e-3)
        assert tip.release == pytest.approx(G, rel=1e-2)
        first = tip.time == 1.0
        assert np.isnan(tip.rate) if first else tip.rate == pytest.approx(SPEED * (1 + both), rel=1e-2)


def test_growth_over_the_energy_release_rate() -> None:
    strip = Strip()
    strip.increments = range(1, 12)
    found = growth(strip)
    assert found.cycles.tolist() == list(range(1, 12))
    assert found.rate == pytest.approx(SPEED, rel=1e-3)
    release, rate = found.line
    assert len(release) == len(rate) == 7
    assert release == pytest.approx(np.full(7, G.sum()), rel=1e-2)
    assert rate == pytest.approx(np.full(7, SPEED), rel=1e-2)
    with pytest.raises(UelError, match=r"strip\.pvd: 2 tips of delaminations in step 1, expected one"):
        growth(Strip(both=True))


def test_table_and_picture(tmp_path: Path) -> None:
    found = tips(Strip(), 0.5)
    write_tips(tmp_path / "front.csv", found)
    head, *rows = (tmp_path / "front.csv").read_text().splitlines()
    assert head == "step,increment,time,line,tip,X,Y,AHEADX,AHEADY,LENGTH,RATE,TN,TII,GI,GII,MIX"
    assert len(rows) == 3
    assert float(rows[-1].split(",")[-1]) == pytest.approx(G[1] / G.sum(), rel=1e-2)
    draw_tips(tmp_path / "front.png", found)
    assert (tmp_path / "front.png").stat().st_size > 5000
    with pytest.raises(UelError, match="no front to draw: the damage of no increment reaches that of the front"):
        draw_tips(tmp_path / "none.png", [])


def test_jobs_without_lines() -> None:
    class Bare(Strip):
        def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
            return meshio.Mesh(np.zeros((3, 3)), [("triangle", np.array([[0, 1, 2]]))])

    assert are_lines(Strip())
    assert not are_lines(Bare())
    with pytest.raises(UelError, match="no field output of interface elements in the plane with a damage"):
        tips(Bare(), 0.5)


def test_a_folder_is_no_job(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["front", "."]) == 1
    assert ".: expected the name of a job, with its folder" in capsys.readouterr().err


class Superposed(Strip):
    """The strip with a second element on the nodes of each one, whose tip is 3 behind; its nodes are the other way."""

    def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
        found = super().mesh(increment, step)
        cells, labels = (
            np.concatenate([self.cells, self.cells[:, ::-1]]),
            np.concatenate([self.labels, self.labels + 900]),
        )
        return meshio.Mesh(
            found.points,
            [("line", cells)],
            cell_data={"DAMAGE": [np.zeros(len(cells))], "ELEMENT": [labels]},
        )

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        first = super().interfaces()
        self.arc = self.arc + 3.0
        second = super().interfaces()
        self.arc = self.arc - 3.0
        for one, other in zip(first, second, strict=True):
            other["element"] = other["element"] + 900
            # the places are those of the first
            other["X"], other["Y"] = one["X"], one["Y"]
            for name in ("TT", "WT"):
                other[name] = -other[name]
        return [
            {name: np.concatenate([one[name], other[name]]) for name in one}
            for one, other in zip(first, second, strict=True)
        ]


def test_two_elements_on_the_same_nodes() -> None:
    """Each law has its own tip."""
    expected, found = tips(Strip(), 0.5), tips(Superposed(), 0.5)
    for line, behind in ((1, 0.0), (2, 3.0)):
        mine = [tip for tip in found if tip.line == line]
        assert len(mine) == len(expected)
        for tip, other in zip(mine, expected, strict=True):
            assert tip.length == pytest.approx(other.length - behind, abs=1e-6)
            assert tip.release == pytest.approx(other.release, rel=0.02)
