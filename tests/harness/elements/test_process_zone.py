# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface elements that fail and are too long for the process zone are told."""

from pathlib import Path

import pytest

from harness.delamination.kernels import uel_property, user_element
from harness.job import run
from harness.output import Result

E1, E3, STRENGTH, TOUGHNESS = 4000.0, 1000.0, 10.0, 0.05
LAW = {"ALPHAN": 1e5, "ALPHAT": 1e5, "SIGMAMAX": STRENGTH, "TAUMAX": 3.0, "GIC": TOUGHNESS, "GIIC": 0.2, "LAW": 1}
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


def pulled(
    folder: Path,
    kind: str,
    length: float,
    height: float,
    opening: float = 0.05,
    ply: str = "",
    axes: str = "",
    across: bool = False,
) -> Result:
    """Two solids with an interface element between them, pulled apart by `opening`, or sheared."""
    space = kind in ("COH3D8", "U7")
    dimension = 3 if space else 2
    levels = [square(length, y, dimension, length) for y in (0.0, height, height, 2.0 * height)]
    count = len(levels[0])
    lines = ["*NODE"]
    lines += [f"{k}, " + ", ".join(map(repr, x)) for k, x in enumerate((x for level in levels for x in level), 1)]
    solid = "C3D8" if space else "CPS4"

    def numbers(level: int, *, reverse: bool) -> list[int]:
        found = list(range(level * count + 1, (level + 1) * count + 1))
        return found[::-1] if reverse else found

    for label, low in ((1, 0), (2, 2)):
        nodes = numbers(low, reverse=False) + numbers(low + 1, reverse=not space)
        lines += [f"*ELEMENT, TYPE={solid}, ELSET=SOLID", ", ".join(map(str, [label, *nodes]))]
    own = kind.startswith("U")
    if own:
        lines += user_element(int(kind[1:]), "UNSYMM")
    nodes = numbers(1, reverse=False) + numbers(2, reverse=not space)
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=INTERFACE", ", ".join(map(str, [3, *nodes]))]
    named = ", ORIENTATION=AXES" if axes else ""
    lines += [*axes.splitlines(), f"*SOLID SECTION, ELSET=SOLID, MATERIAL=PLY{named}", "1."]
    if own:
        lines += uel_property(int(kind[1:]), "INTERFACE", LAW | {"THICKNESS": 1.0})
    else:
        lines += COHESIVE.splitlines()
    lines += (ply or PLIES[dimension]).splitlines()
    last = ", ".join(map(str, numbers(3, reverse=False)))
    first = ", ".join(map(str, numbers(0, reverse=False)))
    lines += [f"*NSET, NSET=BASE\n{first}\n*NSET, NSET=CROWN\n{last}", "*BOUNDARY", f"BASE, 1, {dimension}"]
    moved = 1 if across else dimension
    lines += ["*STEP, UNSYMM=YES", "*STATIC", "0.1, 1., 1e-6, 0.1", "*BOUNDARY"]
    lines += [f"CROWN, {k}, {k}, {opening if k == moved else 0.0}" for k in range(1, dimension + 1)]
    lines.append("*END STEP")
    (folder / "deck.inp").write_text("\n".join(lines) + "\n")
    return run(folder / "deck.inp", output_dir=folder, fallback=True)


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
