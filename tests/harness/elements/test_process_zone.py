# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface elements that fail and are too long for the process zone are told."""

import math
import re
from pathlib import Path

import pytest

from uel.delamination.kernels import formulations, uel_property, user_element
from uel.errors import UelError
from uel.output import Result
from uel.running.job import run
from uel.running.options import RoutineOptions
from uel.solver.options import SolverOptions

E1, E3, STRENGTH, TOUGHNESS = 4000.0, 1000.0, 10.0, 0.05
LAW = {"ALPHAN": 1e5, "ALPHAT": 1e5, "SIGMAMAX": STRENGTH, "TAUMAX": 3.0, "GIC": TOUGHNESS, "GIIC": 0.2, "LAW": 1}
# that of solids of 1 mm is below the softening slope of the law
LAW |= {"BETAN": 1e5, "BETAT": 1e5}
# those of PLIES: in the plane axis 2 is across, in space axis 3
MODULI = {
    2: {"E1": E1, "E2": E3, "NU12": 0.0, "G12": 500.0},
    3: {"E1": E1, "E2": E1, "E3": E3, "NU12": 0.0, "G12": 500.0, "G13": 500.0, "G23": 500.0},
}
PLIES = {
    2: "*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=LAMINA\n4000., 1000., 0., 500., 500., 500.\n",
    3: "*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n4000., 4000., 1000., 0., 0., 0., 500., 500.\n500.\n",
}
TURNED = "*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=LAMINA\n1000., 4000., 0., 500., 500., 500.\n"
COHESIVE = """*COHESIVE SECTION, ELSET=INTERFACE, MATERIAL=BOND, RESPONSE=TRACTION SEPARATION
1., 1.
*MATERIAL, NAME=BOND
*ELASTIC, TYPE=TRACTION
1e5, 1e5, 1e5
*DAMAGE INITIATION, CRITERION=QUADS
10., 3., 3.
*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=POWER LAW, POWER=1.
0.05, 0.2, 0.2
"""


def square(x: float, y: float, dimension: int, length: float) -> list[tuple[float, ...]]:
    """Nodes of a level: two in the plane, four in space; x the length of the element, twice that along y."""
    if dimension == 2:
        return [(0.0, y), (x, y)]
    return [(0.0, 0.0, y), (x, 0.0, y), (x, 2.0 * length, y), (0.0, 2.0 * length, y)]


def axes_at(angle: float) -> str:
    """*ORIENTATION with axis 1 at an angle from x, in degrees."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return f"*ORIENTATION, NAME=AXES\n{c:.9g}, {s:.9g}, 0., {-s:.9g}, {c:.9g}, 0."


def pulled(
    folder: Path,
    kind: str,
    length: float,
    height: float,
    opening: float = 0.05,
    ply: str = "",
    upper: str = "",
    axes: str = "",
    across: bool = False,
    columns: int = 1,
    first: float = 0.1,
    cpus: int = 1,
    **values: float,
) -> Result:
    """Columns of two solids with an interface element between them, pulled apart by `opening`, or sheared.

    The interface elements have the labels 3, 6, 9 and so on; `first` is the size of the increments, `values` are
    properties of the elements, `upper` is the material UPPER of the upper solids.
    """
    space = kind in ("COH3D8", "U7", "U8")
    dimension = 3 if space else 2
    levels = [square(length, y, dimension, length) for y in (0.0, height, height, 2.0 * height)]
    count = len(levels[0])
    nodes = [(x + 2.0 * k * length, *rest) for k in range(columns) for level in levels for x, *rest in level]
    lines = ["*NODE"]
    lines += [f"{k}, " + ", ".join(map(repr, x)) for k, x in enumerate(nodes, 1)]
    solid = "C3D8" if space else "CPS4"

    def numbers(column: int, *wanted: int) -> list[int]:
        """Nodes of two or four levels, from one to the next as quads or bricks have them."""
        found = []
        for k, level in enumerate(wanted):
            low = (4 * column + level) * count + 1
            found += list(range(low, low + count))[:: -1 if k % 2 and not space else 1]
        return found

    def elements(kind: str, elset: str, *wanted: tuple[int, ...]) -> list[str]:
        start = 1 if elset == "SOLID" else 3
        rows = [[3 * k + i, *numbers(k, *levels)] for k in range(columns) for i, levels in enumerate(wanted, start)]
        return [f"*ELEMENT, TYPE={kind}, ELSET={elset}", *(", ".join(map(str, row)) for row in rows)]

    lines += elements(solid, "SOLID", (0, 1), (2, 3))
    own = kind.startswith("U")
    if own:
        lines += user_element(int(kind[1:]))
    lines += elements(kind, "INTERFACE", (0, 1, 2, 3) if kind in ("U4", "U8") else (1, 2))
    named = ", ORIENTATION=AXES" if axes else ""
    tops = [str(3 * k + 2) for k in range(columns)]
    sets = {"LOWER": [str(3 * k + 1) for k in range(columns)] + ([] if upper else tops), "UPPER": tops if upper else []}
    lines += axes.splitlines()
    for (name, labels), material in zip(sets.items(), ("PLY", "UPPER"), strict=True):
        if labels:
            lines += [
                f"*ELSET, ELSET={name}",
                *labels,
                f"*SOLID SECTION, ELSET={name}, MATERIAL={material}{named}",
                "1.",
            ]
    if own:
        moduli = {f"{name} {side}": value for name, value in MODULI[dimension].items() for side in ("BOTTOM", "TOP")}
        lines += uel_property(
            int(kind[1:]), "INTERFACE", LAW | {"THICKNESS": 1.0} | formulations(solid) | moduli | values
        )
    else:
        lines += COHESIVE.splitlines()
    lines += [*(ply or PLIES[dimension]).splitlines(), *upper.splitlines()]
    for name, level in (("BASE", 0), ("CROWN", 3)):
        lines += [f"*NSET, NSET={name}", *(", ".join(map(str, numbers(k, level))) for k in range(columns))]
    lines += ["*BOUNDARY", f"BASE, 1, {dimension}"]
    moved = 1 if across else dimension
    lines += ["*STEP, UNSYMM=YES", "*STATIC", f"{first}, 1., 1e-6, {first}", "*BOUNDARY"]
    lines += [f"CROWN, {k}, {k}, {opening if k == moved else 0.0}" for k in range(1, dimension + 1)]
    lines.append("*END STEP")
    (folder / "deck.inp").write_text("\n".join(lines) + "\n")
    return run(
        folder / "deck.inp", output_dir=folder, solver=SolverOptions(fallback=True), routines=RoutineOptions(cpus=cpus)
    )


# half of E_n G/s^2 with E_n = 1000 across, and half of (E_t G/s^2)^(1/4) h^(3/4) with E_t = 4000 along, by hand
LARGE, SLENDER = 0.25, 0.5 * 2.0**0.25 * 0.1**0.75


@pytest.mark.parametrize("kind", ["COH2D4", "U2", "COH3D8", "U7"])
def test_long_element_that_fails(kind: str, tmp_path: Path) -> None:
    result = pulled(tmp_path, kind, 0.1, 1.0)
    (warning,) = result.warnings
    message = (
        f"element 3 (type {kind}) fails and is 0.1 long, the process zone about {LARGE:.2g} (0% mode II): expected"
    )
    assert message in warning
    assert "deck.inp:" in warning
    assert "fails and is 0.1 long" in " ".join((tmp_path / "deck.dat").read_text().split())


@pytest.mark.parametrize("kind", ["COH2D4", "U2", "COH3D8", "U7"])
def test_short_element_that_fails(kind: str, tmp_path: Path) -> None:
    # 0.08 is less than a third of 0.25; in space the other edge, 0.16, is not
    assert pulled(tmp_path, kind, 0.08, 1.0).warnings == ()


def test_slender_arms_shorten_the_zone(tmp_path: Path) -> None:
    (warning,) = pulled(tmp_path, "COH2D4", 0.08, 0.1).warnings
    assert f"zone about {SLENDER:.2g} (0% mode II)" in warning
    assert SLENDER < 3 * 0.08 < LARGE


def test_modulus_across_the_interface_counts(tmp_path: Path) -> None:
    # four times as stiff across: 1.0 in a large body, and 0.42 between arms of 1 mm with E_t = 1000
    (warning,) = pulled(tmp_path, "U2", 0.3, 1.0, ply=TURNED).warnings
    assert "zone about 0.42 (0% mode II)" in warning


def test_directions_of_the_material(tmp_path: Path) -> None:
    axes = "*ORIENTATION, NAME=AXES\n0., 1., 0., -1., 0., 0."
    (warning,) = pulled(tmp_path, "U2", 0.3, 1.0, axes=axes).warnings
    assert "zone about 0.42 (0% mode II)" in warning
    # directions that differ from point to point have no modulus for all
    axes = "*ORIENTATION, NAME=AXES, SYSTEM=CYLINDRICAL\n-5., 0., 0., -5., 0., 1."
    assert pulled(tmp_path, "U2", 0.3, 1.0, axes=axes).warnings == ()


def test_long_element_that_stays_bonded(tmp_path: Path) -> None:
    # the strength of 10 takes 0.02 of displacement of two solids of 1 mm and E = 1000
    assert pulled(tmp_path, "COH2D4", 1.0, 1.0, opening=0.015).warnings == ()


def test_zone_of_mode_2(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # half of sqrt(1000 * 4000) 0.05/30^2, by hand; mode I has 0.25
    assert pulled(tmp_path, "U2", 2.0, 1.0, opening=0.015, across=True).warnings == ()
    monkeypatch.setitem(LAW, "TAUMAX", 30.0)
    monkeypatch.setitem(LAW, "GIIC", 0.05)
    (warning,) = pulled(tmp_path, "U2", 2.0, 1.0, opening=0.3, across=True).warnings
    assert "zone about 0.056 (100% mode II)" in warning


def test_mode_that_does_not_act_is_left_out(tmp_path: Path) -> None:
    # in mode I the zone is 0.25; sheared, half of the smaller of sqrt(1000 * 4000) 0.2/3^2 and sqrt(4000 0.2/3^2 1)
    zone = 0.5 * min(2000.0 * 0.2 / 9.0, (4000.0 * 0.2 / 9.0) ** 0.5)
    assert 0.25 < 3.0 * 1.5 < zone
    assert pulled(tmp_path, "U2", 1.5, 1.0, opening=0.3, across=True).warnings == ()
    (warning,) = pulled(tmp_path, "U2", 1.7, 1.0, opening=0.3, across=True).warnings
    assert f"zone about {zone:.2g} (100% mode II)" in warning


OWN = pytest.mark.parametrize("kind", ["U4", "U8"])


def told(warning: str, kind: str) -> tuple[float, ...]:
    """Label, length, zone and share of mode II (%) of the message that an element sends."""
    number = r"([\d.E+-]+)"
    message = (
        rf"{kind} element {number}: fails and is {number} long, the process zone at most {number} \({number} per cent "
        r"mode II\): expected at least 3 elements in it; with fewer the load comes out too high\. Told once in a job"
    )
    found = re.search(message, warning)
    assert found, warning
    return tuple(float(text) for text in found.groups())


@OWN
def test_elements_with_solids_tell_it_themselves(kind: str, tmp_path: Path) -> None:
    """In .msg, and again in the next job of the process; the harness has nothing to add, even for slender arms."""
    for height in (1.0, 0.1):
        (warning,) = pulled(tmp_path, kind, 0.1, height).warnings
        assert told(warning, kind) == pytest.approx((3, 0.1, LARGE, 0), rel=1e-5)
        assert "fails and is 0.1" in " ".join((tmp_path / "deck.msg").read_text().split())
    assert pulled(tmp_path, kind, 0.08, 1.0).warnings == ()


@OWN
def test_elements_do_not_know_the_arms(kind: str, tmp_path: Path) -> None:
    (warning,) = pulled(tmp_path, kind, 0.08, 0.1).warnings
    assert f"element 3 (type {kind}) fails and is 0.08 long, the process zone about {SLENDER:.2g} (0%" in warning
    assert "fails and is 0.08 long" in " ".join((tmp_path / "deck.dat").read_text().split())


@pytest.mark.parametrize("kind", ["U2", "U4", "U8"])
def test_zone_of_the_tip_where_fibres_bridge(kind: str, tmp_path: Path) -> None:
    """Half of E_n G/s^2 with E_n = 1000, and 0.02 N/mm and 8 MPa of the tip: 0.156 mm; 0.25 with the total."""
    bridging = {"LAW": 5, "SIGMABRIDGE": 2.0, "GIBRIDGE": 0.03}
    (warning,) = pulled(tmp_path, kind, 0.07, 1.0, opening=0.1, **bridging).warnings
    if kind == "U2":
        assert "fails and is 0.07 long, the process zone about 0.16 (0% mode II)" in warning
    else:
        assert told(warning, kind) == pytest.approx((3, 0.07, 0.15625, 0), rel=1e-5)


def test_element_that_fails_in_the_last_increment(tmp_path: Path) -> None:
    """It would tell in the next one."""
    (warning,) = pulled(tmp_path, "U4", 0.1, 1.0, opening=0.05, first=1.0).warnings
    assert f"element 3 (type U4) fails and is 0.1 long, the process zone about {LARGE:.2g} (0%" in warning


@OWN
def test_one_message_of_many_elements(kind: str, tmp_path: Path) -> None:
    (warning,) = pulled(tmp_path, kind, 0.1, 1.0, columns=4).warnings
    assert told(warning, kind)[0] == 3


def test_one_message_of_several_threads(tmp_path: Path) -> None:
    """So many elements that each thread has some: where one sends the message, all of them are called again."""
    (warning,) = pulled(tmp_path, "U4", 0.1, 1.0, columns=150, cpus=2).warnings
    assert told(warning, "U4")[0] == 3


@OWN
def test_elements_that_stay_bonded_tell_nothing(kind: str, tmp_path: Path) -> None:
    assert pulled(tmp_path, kind, 1.0, 1.0, opening=0.015).warnings == ()


@pytest.mark.parametrize("kind", ["U2", "U7", "U4", "U8"])
def test_an_initial_crack_does_not_fail(kind: str, tmp_path: Path) -> None:
    """It has no process zone: elements of any length will do, and it has dissipated nothing in the end."""
    result = pulled(tmp_path, kind, 1.0, 1.0, CRACKED=1)
    assert result.warnings == ()
    assert result.history["ALLPD"][-1] == 0.0


@pytest.mark.parametrize("angle", [30.0, 90.0])
def test_element_takes_the_modulus_across(angle: float, tmp_path: Path) -> None:
    """The modulus is that of axis 1 at 90 degrees less the angle from the normal; no contraction.

    It fails in its first increment: in shorter ones the shear of the ply before onset has a part, 0.3 % of the energy.
    """
    c, s = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    across = 1.0 / (c**4 / E1 + s**4 / E3 + c**2 * s**2 / 500.0)
    angles = {"ANGLE BOTTOM": angle, "ANGLE TOP": angle}
    (warning,) = pulled(tmp_path, "U4", 0.5, 1.0, axes=axes_at(angle), first=0.5, **angles).warnings
    assert told(warning, "U4")[2] == pytest.approx(0.5 * across * TOUGHNESS / STRENGTH**2, rel=1e-5)


@pytest.mark.parametrize(("kind", "angle"), [("U4", 0.0), ("U8", 45.0)])
def test_element_takes_the_modulus_along(kind: str, angle: float, tmp_path: Path) -> None:
    """In mode II; at 45 degrees that of two axes with E1 each, without contraction."""
    along = E1 if angle == 0.0 else 1.0 / (0.5 / E1 + 0.25 / 500.0)
    values = {"TAUMAX": 30.0, "GIIC": 0.05, "ANGLE BOTTOM": angle, "ANGLE TOP": angle}
    axes = axes_at(angle)
    (warning,) = pulled(tmp_path, kind, 2.0, 1.0, opening=0.3, axes=axes, across=True, **values).warnings
    _, length, zone, share = told(warning, kind)
    assert (length, share) == (2.0, 100.0)
    assert zone == pytest.approx(0.5 * math.sqrt(E3 * along) * 0.05 / 30.0**2, rel=1e-5)


def test_softer_of_two_solids_counts(tmp_path: Path) -> None:
    upper = "*MATERIAL, NAME=UPPER\n*ELASTIC, TYPE=LAMINA\n4000., 500., 0., 500., 500., 500.\n"
    (warning,) = pulled(tmp_path, "U4", 0.1, 1.0, upper=upper, **{"E2 TOP": 0.5 * E3}).warnings
    assert told(warning, "U4")[2] == pytest.approx(0.5 * LARGE, rel=1e-5)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        ((r"(TYPE=U2, .*)\bPROPERTIES=(\d+), I", r"\1PROPERTIES=4, I"), "PROPERTIES"),
        ((r"TYPE=U2, NODES=4(.*)", r"TYPE=U2, NODES=3\1"), "nodes|NODES"),
    ],
)
def test_elements_say_themselves_what_is_missing(tmp_path: Path, damage: tuple[str, str], message: str) -> None:
    pulled(tmp_path, "U2", 0.3, 1.0)
    deck = tmp_path / "deck.inp"
    text, count = re.subn(*damage, deck.read_text())
    assert count == 1
    deck.write_text(text)
    with pytest.raises(UelError, match=message):
        run(deck, output_dir=tmp_path)
