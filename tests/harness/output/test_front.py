# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fronts on surfaces with known fields: places, directions, and Rice's integral."""

from pathlib import Path
from typing import ClassVar

import meshio
import numpy as np
import pytest
from matplotlib.figure import Figure

from uel.cli import main
from uel.errors import UelError
from uel.output import Result
from uel.output.files.field_output import Frame
from uel.output.pictures.front import draw_fronts, fronts, write_fronts
from uel.output.pictures.interface_surface import Faces, InterfaceSurface

RADIUS, ZONE = 6.0, 3.0
STRENGTH, FINAL = np.array([30.0, 40.0, 50.0]), np.array([0.01, 0.02, 0.03])
"""Traction where the zone begins, separation where it ends: normal, radial, around the circle."""
G = 0.5 * STRENGTH * FINAL
BAR = """*NODE
1, 0., 0., 0.
2, 1., 0., 0.
*ELEMENT, TYPE=T3D2, ELSET=BAR
1, 1, 2
*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL
1.
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E5, 0.3
*BOUNDARY
1, 1, 3
2, 2, 3
*STEP
*STATIC
*CLOAD
2, 1, 1.
*OUTPUT, FIELD
*NODE OUTPUT
U
*END STEP
"""


class Disc(Result):
    """A job whose interface is a square mesh of 24 x 24 elements with a round process zone.

    The damage falls linearly over the zone, about the front; tractions are the strengths times 1 - D, separations the
    final ones times D, so that each mode releases half of their product. tilt turns the surface about the x axis.
    """

    def __init__(self, tilt: float = 0.0, names: str = "W", grain: int = 24) -> None:
        self.names = names
        edges = np.linspace(0.0, 12.0, grain + 1)
        y, x = np.meshgrid(edges, edges, indexing="ij")
        self.turn = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
        plane = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
        number = np.arange(x.size).reshape(x.shape)
        cells = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
        g = np.sqrt(1.0 / 3.0)
        xi = np.array([[-g, -g], [g, -g], [g, g], [-g, g]])
        shapes = 0.25 * np.prod(1.0 + xi[:, None] * np.sign(xi), axis=-1)
        self.points = (shapes @ plane[cells]).reshape(-1, 3)
        self.plane, self.cells = plane, cells
        # elements are numbered neither from one nor in the order of the file
        self.labels = np.random.default_rng(1).permutation(len(cells)) + 100
        self.blocks = [("quad", cells, self.labels)]
        self.elements, self.numbers = np.repeat(self.labels, 4), np.tile(np.arange(1.0, 5.0), len(cells))

    @staticmethod
    def damage(radius: np.ndarray) -> np.ndarray:
        return np.clip(0.5 + (RADIUS - radius) / ZONE, 0.0, 1.0)

    @property
    def frames(self) -> list[Frame]:
        return [Frame(1, 3, 0.5, Path("none.vtu"))]

    def file(self, ending: str) -> Path:
        return Path(f"disc{ending}")

    def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
        shapes = [(kind, cells) for kind, cells, _ in self.blocks]
        labels = [names for _, _, names in self.blocks]
        damage = [np.zeros(len(names)) for names in labels]
        return meshio.Mesh(self.plane @ self.turn.T, shapes, cell_data={"DAMAGE": damage, "ELEMENT": labels})

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        x, y, _ = self.points.T
        radius = np.hypot(x, y)
        damage = self.damage(radius)
        outward = np.stack([x, y], axis=-1) / radius[:, None]
        around = np.stack([-outward[:, 1], outward[:, 0]], axis=-1)
        count = len(x)
        profile = {"step": np.full(count, 1.0), "increment": np.full(count, 3.0), "time": np.full(count, 0.5)}
        profile |= {"element": self.elements, "point": self.numbers}
        profile |= dict(zip("XYZ", (self.points @ self.turn.T).T, strict=True)) | {"DAMAGE": damage}
        for name, share, sizes in (("T", 1.0 - damage, STRENGTH), (self.names, damage, FINAL)):
            shear = sizes[1] * outward + sizes[2] * around
            vector = np.column_stack([np.full(count, sizes[0]), shear]) * share[:, None]
            profile |= {f"{name}{axis}": vector[:, k] for k, axis in enumerate("NST")}
        order = np.lexsort((profile["point"], profile["element"]))
        return [{name: values[order] for name, values in profile.items()}]


@pytest.mark.parametrize("tilt", [0.0, 0.7])
@pytest.mark.parametrize("names", ["W", "SEP"])
def test_a_round_front(tilt: float, names: str) -> None:
    """The errors are those of linear interpolation on elements of a sixth of the process zone."""
    disc = Disc(tilt, names)
    (front,) = fronts(disc)
    assert (front.step, front.increment, front.time, front.surface, front.line) == (1, 3, 0.5, 1, 1)
    flat = front.coordinates @ disc.turn
    radius = np.hypot(flat[:, 0], flat[:, 1])
    assert np.abs(flat[:, 2]).max() < 1e-12
    assert radius == pytest.approx(RADIUS, abs=0.1 * 0.5)
    outward = flat / radius[:, None]
    assert np.sum(front.ahead @ disc.turn * outward, axis=1).min() > 0.99
    # a quarter of a circle in parts as long as the elements
    assert len(radius) == pytest.approx(0.5 * np.pi * RADIUS / 0.5, rel=0.1)
    inner = slice(2, -2)
    assert np.abs(front.tractions[inner]) == pytest.approx(np.tile(0.5 * STRENGTH, (len(radius) - 4, 1)), rel=0.1)
    assert front.releases[inner] == pytest.approx(np.tile(G, (len(radius) - 4, 1)), rel=0.08)


def weights_of_corners(kind: str) -> np.ndarray:
    """Integration points of a face as weights of its corners: 3 on triangles, 9 on faces of eight nodes."""
    if kind.startswith("triangle"):
        return np.full((3, 3), 1 / 6) + 0.5 * np.eye(3)
    place = np.sqrt(0.6) if kind == "quad8" else np.sqrt(1.0 / 3.0)
    line = np.array([-place, 0.0, place] if kind == "quad8" else [-place, place])
    xi = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 1, 2)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return 0.25 * np.prod(1.0 + xi * corners, axis=-1)


class Shaped(Disc):
    """The disc with faces of other shapes, in turns where there are several: squares are cut along one diagonal."""

    def __init__(self, *kinds: str, tilt: float = 0.0) -> None:
        super().__init__(tilt)
        cells, self.blocks = self.cells, []
        points, elements, numbers = [], [], []
        for k, kind in enumerate(kinds):
            some = cells[k :: len(kinds)]
            if kind.startswith("triangle"):
                some = np.concatenate([some[:, [0, 1, 2]], some[:, [0, 2, 3]]])
            labels = k * 10_000 + 1 + np.arange(len(some))
            weights = weights_of_corners(kind)
            points.append((weights @ self.plane[some]).reshape(-1, 3))
            elements.append(np.repeat(labels, len(weights)))
            numbers.append(np.tile(np.arange(1.0, len(weights) + 1.0), len(some)))
            if kind[-1] in "68":
                between = 0.5 * (self.plane[some] + self.plane[np.roll(some, -1, axis=1)])
                middles, inverse = np.unique(between.reshape(-1, 3), axis=0, return_inverse=True)
                some = np.concatenate([some, len(self.plane) + inverse.reshape(some.shape)], axis=1)
                self.plane = np.concatenate([self.plane, middles])
            self.blocks.append((kind, some, labels))
        self.points = np.concatenate(points)
        self.elements, self.numbers = np.concatenate(elements), np.concatenate(numbers)


@pytest.mark.parametrize("tilt", [0.0, 0.7])
@pytest.mark.parametrize(
    "kinds", [("triangle",), ("triangle6",), ("quad8",), ("quad", "triangle"), ("quad", "quad8"), ("triangle6", "quad")]
)
def test_a_round_front_on_faces_of_other_shapes(kinds: tuple[str, ...], tilt: float) -> None:
    """The same tolerances as on squares with four nodes."""
    disc = Shaped(*kinds, tilt=tilt)
    (front,) = fronts(disc)
    flat = front.coordinates @ disc.turn
    radius = np.hypot(flat[:, 0], flat[:, 1])
    assert radius == pytest.approx(RADIUS, abs=0.1 * 0.5)
    assert np.sum(front.ahead @ disc.turn * flat / radius[:, None], axis=1).min() > 0.99
    assert len(radius) == pytest.approx(0.5 * np.pi * RADIUS / 0.5, rel=0.1)
    inner = slice(2, -2)
    assert np.abs(front.tractions[inner]) == pytest.approx(np.tile(0.5 * STRENGTH, (len(radius) - 4, 1)), rel=0.1)
    assert front.releases[inner] == pytest.approx(np.tile(G, (len(radius) - 4, 1)), rel=0.08)


class Twice(Disc):
    """Two instances of the disc, far apart, of which the second is bonded: their elements have the same labels."""

    def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
        one = super().mesh(increment, step)
        nodes = np.concatenate([one.points, one.points + np.array([100.0, 0.0, 0.0])])
        cells = [("quad", self.cells), ("quad", self.cells + len(one.points))]
        return meshio.Mesh(nodes, cells, cell_data={name: 2 * values for name, values in one.cell_data.items()})

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        (one,) = super().interfaces()
        other = one | {"X": one["X"] + 100.0, "DAMAGE": np.zeros_like(one["X"])}
        return [{name: np.concatenate([values, other[name]]) for name, values in one.items()}]


def test_instances_with_the_same_labels() -> None:
    (expected,), (found,) = fronts(Disc()), fronts(Twice())
    np.testing.assert_array_equal(found.coordinates, expected.coordinates)
    np.testing.assert_array_equal(found.releases, expected.releases)


@pytest.mark.parametrize("which", [0, 100, -1])
def test_an_element_that_the_profile_lacks(which: int) -> None:
    """A run that was killed may have written a part of it."""
    disc = Disc()
    (profile,) = disc.interfaces()
    label = np.sort(disc.labels)[which]
    there = profile["element"] != label
    disc.interfaces = lambda: [{name: values[there] for name, values in profile.items()}]
    with pytest.raises(UelError, match=f"increment 3: no interface profile of element {label}$"):
        fronts(disc)


def test_damage_that_is_not_known() -> None:
    """At one point SPENT is not a number: DAMAGE takes its place; without that there is no front."""
    disc = Spent()
    (profile,) = disc.interfaces()
    for name in ("SPENT", "DAMAGE"):
        profile[name][7] = np.nan
        disc.interfaces = lambda: [profile]
        if name == "SPENT":
            assert len(fronts(disc)) == 1
    with pytest.raises(UelError, match="increment 3: DAMAGE of some points is not known"):
        fronts(disc)


@pytest.mark.parametrize(
    ("corners", "natural"),
    [
        (4, [[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]]),
        (3, [[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5], [1 / 3, 1 / 3]]),
    ],
)
def test_the_middle_of_a_curved_face_is_on_it(corners: int, natural: list[list[float]]) -> None:
    """Quadratic functions are those of its nodes."""
    x, y = np.array(natural).T
    nodes = np.column_stack([x, y, 0.3 + 0.1 * x + 0.2 * x**2 - 0.3 * y**2 + 0.1 * x * y])
    faces = Faces(corners, np.arange(len(nodes) - 1)[None], np.array([1]))
    surface = InterfaceSurface(nodes[:-1], [faces])
    np.testing.assert_allclose(surface.triangles.nodes[-1], nodes[-1], atol=1e-14)


class Growing(Disc):
    """The disc in three increments, whose front moves from 5.5 to 6 and to 6.4 in times of 2 and 4."""

    RADII: ClassVar = {3: (5.5, 1.0), 4: (6.0, 3.0), 5: (6.4, 7.0)}
    now = 0.0

    def damage(self, radius: np.ndarray) -> np.ndarray:
        return np.clip(0.5 + (self.now - radius) / ZONE, 0.0, 1.0)

    @property
    def frames(self) -> list[Frame]:
        return [Frame(1, increment, time, Path("none.vtu")) for increment, (_, time) in self.RADII.items()]

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        found = []
        for increment, (radius, time) in self.RADII.items():
            self.now = radius
            (profile,) = super().interfaces()
            count = len(profile["X"])
            found.append(profile | {"increment": np.full(count, float(increment)), "time": np.full(count, time)})
        return found


@pytest.mark.parametrize("tilt", [0.0, 0.7])
def test_growth_along_a_front(tilt: float) -> None:
    """0.5 in a time of 2 and 0.4 in 4, at each point; interpolation on elements of 0.5 is right to 0.02 of length."""
    first, second, third = fronts(Growing(tilt))
    assert np.isnan(first.rate).all()
    assert second.rate == pytest.approx(0.25, abs=0.02 / 2.0)
    assert third.rate == pytest.approx(0.1, abs=0.02 / 4.0)
    assert third.rate.mean() == pytest.approx(0.1, rel=0.01)


class Spent(Disc):
    """The same disc with the share of the fracture energy in SPENT, and in DAMAGE what an element of (9) would have."""

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        (profile,) = super().interfaces()
        spent = profile["DAMAGE"]
        return [profile | {"SPENT": spent, "DAMAGE": 1.0 - (1.0 - spent) ** 8}]


def test_the_front_is_where_half_of_the_energy_is_spent() -> None:
    """SPENT counts, and DAMAGE only where an element has no SPENT, as built-in ones."""
    (expected,), (found,) = fronts(Disc()), fronts(Spent())
    np.testing.assert_array_equal(found.coordinates, expected.coordinates)
    np.testing.assert_array_equal(found.releases, expected.releases)


class Ring(Disc):
    """The delamination between two circles, which grows inwards and outwards; its zones are 1.5 long."""

    @staticmethod
    def damage(radius: np.ndarray) -> np.ndarray:
        return np.clip(0.5 + (2.0 - np.abs(radius - RADIUS)) / 1.5, 0.0, 1.0)


def test_two_fronts_of_one_surface() -> None:
    """Each has its own process zone, of three elements."""
    inner, outer = sorted(fronts(Ring()), key=lambda front: np.abs(front.coordinates).max())
    assert (inner.surface, outer.surface) == (1, 1)
    for front, radius, side in ((inner, 4.0, -1.0), (outer, 8.0, 1.0)):
        places = front.coordinates[:, :2]
        assert np.hypot(*places.T) == pytest.approx(radius, abs=0.15)
        assert (side * np.sum(front.ahead[:, :2] * places, axis=1)).min() > 0.9 * radius
        middle = slice(3, -3)
        assert front.releases[middle].mean(axis=0) == pytest.approx(G, rel=0.15)


class Edge(Disc):
    """A process zone that forms at the edge x = 0 of the surface: damage 0.4 there, none from x = 1.5 on."""

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        (profile,) = super().interfaces()
        damage = 0.4 * np.clip(1.0 - profile["X"] / 1.5, 0.0, 1.0)
        profile["DAMAGE"] = damage
        for k, axis in enumerate("NST"):
            profile[f"T{axis}"], profile[f"W{axis}"] = STRENGTH[k] * (1.0 - damage), FINAL[k] * damage
        return [profile]


@pytest.mark.parametrize("level", [0.03, 0.1, 0.2])
def test_a_zone_counts_up_to_the_edge_of_the_surface(level: float) -> None:
    """The integral of t dw from d = 0 to 0.4 is that of (1 - d) dd."""
    (front,) = fronts(Edge(), level)
    assert front.coordinates[:, 0] == pytest.approx(1.5 * (1.0 - level / 0.4), abs=0.02)
    assert np.abs(front.releases) == pytest.approx(
        np.tile((0.4 - 0.08) * 2.0 * G, (len(front.coordinates), 1)), rel=1e-2
    )


def test_another_damage_is_elsewhere() -> None:
    (front,) = fronts(Disc(), 0.75)
    assert np.hypot(*front.coordinates.T[:2]) == pytest.approx(RADIUS - 0.25 * ZONE, abs=0.05)


class Rolled(Disc):
    """The disc rolled about the y axis to more than a quarter of a cylinder, of the radius 6: lengths do not change."""

    RADIUS = 6.0

    def _roll(self, flat: np.ndarray) -> np.ndarray:
        angle = flat[:, 0] / self.RADIUS
        return np.column_stack([self.RADIUS * np.sin(angle), flat[:, 1], self.RADIUS * np.cos(angle)])

    def mesh(self, increment: int = -1, step: int | None = None) -> meshio.Mesh:
        found = super().mesh(increment, step)
        found.points = self._roll(self.plane)
        return found

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        (profile,) = super().interfaces()
        # in the order of the profile
        order = np.argsort(self.labels)
        cells = self.cells[order]
        g = np.sqrt(1.0 / 3.0)
        xi = np.array([[-g, -g], [g, -g], [g, g], [-g, g]])
        shapes = 0.25 * np.prod(1.0 + xi[:, None] * np.sign(xi), axis=-1)
        profile |= dict(zip("XYZ", (shapes @ self._roll(self.plane)[cells]).reshape(-1, 3).T, strict=True))
        # s is the projection of the x axis, which runs back beyond a quarter of the circle
        middle = np.repeat(self.plane[cells].mean(axis=1)[:, 0], 4) / self.RADIUS
        sense = np.sign(np.cos(middle))
        for name in ("TS", "TT", "WS", "WT"):
            profile[name] = profile[name] * sense
        return [profile]


class Directed(Rolled):
    """The rolled disc with its axis, y, as the direction of its elements: s is y, and t is -x where n is z."""

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        ((flat,), (profile,)) = Disc.interfaces(self), super().interfaces()
        for name in ("T", "W"):
            profile[f"{name}S"], profile[f"{name}T"] = flat[f"{name}T"], -flat[f"{name}S"]
        return [profile | {f"DIRECTION{k}": np.full(len(profile["X"]), float(k == 2)) for k in (1, 2, 3)}]


def test_shears_along_another_direction() -> None:
    (expected,), (found,) = fronts(Rolled()), fronts(Directed())
    np.testing.assert_array_equal(found.coordinates, expected.coordinates)
    for name in ("tractions", "releases"):
        values = getattr(expected, name)
        np.testing.assert_allclose(getattr(found, name), values, atol=1e-12 * np.abs(values).max())


def test_a_front_on_a_curved_surface() -> None:
    """Rolled, the disc has the same front: ahead of it is along the surface, and modes keep their parts.

    A projection on the mean plane exchanges them, and is not unique beyond a quarter of the circle on both sides.
    """
    (flat,), (front,) = fronts(Disc()), fronts(Rolled())
    assert len(front.coordinates) == len(flat.coordinates)
    x, y, z = front.coordinates.T
    radius = np.hypot(x, z)
    # on facets of a twelfth of a radian
    assert radius.min() > Rolled.RADIUS * np.cos(1 / 24.0) - 1e-9 and radius.max() < Rolled.RADIUS + 1e-9
    angle = np.arctan2(x, z)
    order = np.argsort(y), np.argsort(flat.coordinates[:, 1])
    assert Rolled.RADIUS * angle[order[0]] == pytest.approx(flat.coordinates[order[1], 0], abs=0.02)
    normal = np.column_stack([x, 0.0 * y, z]) / radius[:, None]
    assert np.abs(np.sum(front.ahead * normal, axis=1)).max() < 1.0 / 24.0
    assert np.linalg.norm(front.ahead, axis=1) == pytest.approx(1.0)
    around = np.column_stack([np.cos(angle), np.zeros(len(angle)), -np.sin(angle)])
    assert np.sum(front.ahead * around, axis=1)[order[0]] == pytest.approx(flat.ahead[order[1], 0], abs=0.02)
    assert front.releases[order[0]] == pytest.approx(flat.releases[order[1]], rel=0.02)
    assert np.abs(front.tractions[order[0]]) == pytest.approx(np.abs(flat.tractions[order[1]]), rel=0.02)


def test_fronts_on_a_curved_surface_are_drawn_in_space(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    add = Figure.add_subplot
    monkeypatch.setattr(Figure, "add_subplot", lambda *a, **k: drawn.append(k.get("projection")) or add(*a, **k))
    draw_fronts(tmp_path / "rolled.png", fronts(Rolled()))
    draw_fronts(tmp_path / "flat.png", fronts(Disc(0.7)))
    assert drawn == [None, "3d", None, None]
    assert (tmp_path / "rolled.png").stat().st_size > 10000


def test_a_closed_front() -> None:
    """Around an island without damage in the middle of the surface, the line is closed."""

    class Island(Disc):
        def interfaces(self) -> list[dict[str, np.ndarray]]:
            (profile,) = super().interfaces()
            distance = np.hypot(profile["X"] - 6.0, profile["Y"] - 6.0)
            profile["DAMAGE"] = np.clip(0.5 + (distance - 3.0) / 2.0, 0.0, 1.0)
            return [profile]

    (front,) = fronts(Island())
    outward = front.coordinates[:, :2] - 6.0
    assert np.hypot(*outward.T) == pytest.approx(3.0, abs=0.05)
    assert len(outward) == pytest.approx(2 * np.pi * 3.0 / 0.5, rel=0.1)
    assert np.sum(front.ahead[:, :2] * outward, axis=1).max() < -0.95 * 3.0


def test_files_of_a_front(tmp_path: Path) -> None:
    found = fronts(Disc())
    write_fronts(tmp_path / "disc_front.csv", found)
    lines = (tmp_path / "disc_front.csv").read_text().splitlines()
    names = "step,increment,time,surface,line,point,X,Y,Z,AHEADX,AHEADY,AHEADZ,TN,TII,TIII,GI,GII,GIII,MIX,RATE"
    assert lines[0] == names
    assert len(lines) == 1 + len(found[0].coordinates)
    rows = np.loadtxt(lines[1:], delimiter=",")
    assert rows[:, 6:9] == pytest.approx(found[0].coordinates)
    assert rows[:, 18] == pytest.approx(found[0].releases[:, 1:].sum(axis=1) / found[0].releases.sum(axis=1))
    draw_fronts(tmp_path / "disc_front.png", found)
    assert (tmp_path / "disc_front.png").stat().st_size > 10000


def test_jobs_without_a_front(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = Path(__file__).parents[3] / "abaqus_inputs" / "patch_horizontal" / "flat_u2.inp"
    assert main(["run", str(deck), "--quiet", "--output-dir", str(tmp_path)]) == 0
    assert main(["front", str(tmp_path / "flat_u2")]) == 1
    assert "no front to draw: the damage of no increment reaches that of the front" in capsys.readouterr().err
    (tmp_path / "flat_u2.pvd").unlink()
    assert main(["front", str(tmp_path / "flat_u2")]) == 1
    assert "no field output, from which the front is computed" in capsys.readouterr().err
    with pytest.raises(UelError, match="no front to draw: the damage of no increment reaches"):
        draw_fronts(tmp_path / "a.png", fronts(Disc(), 1.0))


def test_jobs_without_an_interface(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "bar.inp"
    deck.write_text(BAR)
    assert main(["run", str(deck), "--quiet", "--output-dir", str(tmp_path)]) == 0
    assert main(["front", str(tmp_path / "bar")]) == 1
    assert "no interface elements with a damage; a front is a line on" in capsys.readouterr().err
