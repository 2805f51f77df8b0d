# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every element type beside quads and bricks and every value of its properties has a deck in abaqus_inputs.

Those beside triangles, tetrahedra and wedges run in tests/harness/insertion.
"""

import re
import tomllib
from collections.abc import Iterable
from pathlib import Path

import pytest

from uel.paper import columns, decks
from uel.usersub.layout import Item, element_layouts

FOLDER = Path("properties")
LAYOUTS = element_layouts()
ESTIMATES = {"BETAN": (-1, -2), "BETAT": (-1, -2)}


def shown(texts: Iterable[str]) -> set[tuple[str, str]]:
    """Types, as ('TYPE', 'U4'), and properties with their values: 0, an option or an estimate, or '+' for another."""
    found = set()
    for text in texts:
        sets = {name: int(jtype) for jtype, name in re.findall(r"^\*ELEMENT, TYPE=U(\d+), ELSET=(\w+)", text, re.M)}
        for name, options, data in re.findall(r"^\*UEL PROPERTY, ELSET=(\w+)(.*)\n((?:[^*].*\n)+)", text, re.M):
            # what takes a material are quads or bricks, whose sets may be cut out of larger ones
            jtype = (1 if "TYPE=U1," in text else 9) if "MATERIAL" in options else sets[name]
            layout = LAYOUTS[jtype]
            found.add(("TYPE", f"U{jtype}"))
            values = [float(word) for word in data.replace("\n", ",").split(",") if word.strip()]
            for item, value in zip((*layout.reals, *layout.integers), values, strict=True):
                found.add((item.name, label(item, value)))
    return found


def label(item: Item, value: float) -> str:
    """A value as `shown` names it."""
    named = value == 0 or value in ESTIMATES.get(item.name, ()) or (not item.unit and options_of(item))
    return f"{value:g}" if named else "+"


def options_of(item: Item) -> range:
    """The values of an option; none of those of a place or of a number, and of a real."""
    found = re.fullmatch(r"(\d+) to (\d+)", item.permitted)
    return range(0) if item.unit or item.name == "FACE" or not found else range(int(found[1]), int(found[2]) + 1)


def wanted() -> set[tuple[str, str]]:
    """What has to be shown: 0 where it is permitted and another value, every option and every estimate."""
    found = {("TYPE", f"U{jtype}") for jtype in LAYOUTS if jtype <= 12}
    for layout in LAYOUTS.values():
        for item in (*layout.reals, *layout.integers):
            options = options_of(item)
            zero = "default 0" in item.permitted or item.name == "FACE"
            values = {str(value) for value in options} if options else {"+"} | ({"0"} if zero else set())
            values |= {str(value) for value in ESTIMATES.get(item.name, ())}
            found |= {(item.name, value) for value in values}
    return found


@pytest.fixture(scope="module")
def committed() -> dict[Path, str]:
    return {path.relative_to(decks.FOLDER): path.read_text() for path in decks.FOLDER.rglob("*.inp")}


def test_every_value_of_a_property_has_a_deck(committed: dict[Path, str]) -> None:
    assert wanted() - shown(committed.values()) == set()


def test_what_no_deck_shows_is_found(committed: dict[Path, str]) -> None:
    missing = wanted() - shown(text for path, text in committed.items() if path.parent != FOLDER)
    assert {("TYPE", "U6"), ("LAW", "3"), ("LAW", "4"), ("FRICTION", "+"), ("SHAPEN", "+"), ("PLANE", "1")} <= missing
    assert not {("CLOSURE", "2"), ("BETAN", "-1"), ("BETAN", "-2"), ("BETAN", "0"), ("ALPHAN", "0")} & missing
    # one deck less
    rest = {path: text for path, text in committed.items() if path != FOLDER / "u4_friction.inp"}
    assert wanted() - shown(rest.values()) == {("FRICTION", "+")}


@pytest.mark.parametrize(
    ("name", "load"),
    [
        ("u4_plane_strain", columns.normal_stiffness),
        ("u8_turned", columns.shear_stiffness),
        ("u4_friction", columns.normal_stiffness),
        ("u4_cracked", columns.normal_stiffness),
        ("u10_formulation1", columns.normal_stiffness),
    ],
)
def test_reference_values_of_the_loads(name, load) -> None:
    """Blocks as springs in series: the values of reference.toml."""
    column = columns.COLUMNS[name]
    values = tomllib.loads((decks.FOLDER / FOLDER / "reference.toml").read_text())["value"]
    (value,) = (entry["value"] for entry in values if f"{name}.inp" in entry["decks"])
    stiffness = load(column)
    if "ALPHAN" in column.values:
        stiffness = 1.0 / (1.0 / stiffness + 1.0 / (column.values["ALPHAN"] * columns.SIDE**2))
    moved = column.moved[0] if load is columns.shear_stiffness else abs(column.moved[1])
    assert stiffness * moved * column.values.get("FRICTION", 1.0) == pytest.approx(abs(value), rel=1e-7)
