# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solids beside which an element that owns them would be wrong are refused, doubtful ones are said."""

import re

import pytest
from solid_grids import LAW, grid, inserted

from uel.errors import DeckError

WARM = ["*EXPANSION", "1e-5, 0.", "2e-5, 100."]
STANDARD = (*LAW, "ALPHAN=1e6")


def deck(folder, *, kind="CPS4", section="", material=(), model=(), step=()):
    mesh = grid(kind, (2, 2), (2.0, 2.0))
    mesh.sets = {"LOW": mesh.cell[:, 1] == 0, "HIGH": mesh.cell[:, 1] == 1}
    lines = [*mesh.lines(), f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{section}", "1.", "*MATERIAL, NAME=M"]
    lines += ["*ELASTIC", "1e4, 0.3", *material, *model, "*STEP", "*STATIC", "1., 1.", *step, "*END STEP"]
    path = folder / "deck.inp"
    path.write_text("\n".join(lines) + "\n")
    return path


def insert(folder, values=LAW, element="", **what):
    path = deck(folder, **what)
    done = inserted(path, folder / "out.inp", values, between=[("LOW", "HIGH")], element=element)
    lines = path.read_text().splitlines()
    places = [lines[int(re.match(r".*deck.inp:(\d+): ", each)[1]) - 1] for each in done.warnings]
    return done, places


WRONG = [
    (
        {"material": WARM, "step": ["*TEMPERATURE", "1, 150."]},
        r"deck.inp:\d+: U4 has one expansion along each axis of a ply, at all temperatures: material M of the CPS4 "
        r"beside it has \*EXPANSION \(.*deck.inp:\d+\), which is another; take U2",
    ),
    (
        {
            "material": WARM,
            "model": ["*AMPLITUDE, NAME=A", "0., 0.", "1., 1."],
            "step": ["*TEMPERATURE, AMPLITUDE=A", "1, 0."],
        },
        "U4 has one expansion along each axis of a ply",
    ),
    (
        {"model": ["*INITIAL CONDITIONS, TYPE=STRESS, USER"]},
        r"deck.inp:\d+: U4 takes an initial stress by components, and that of the CPS4 beside it varies; take U2",
    ),
    (
        {"model": ["*INITIAL CONDITIONS, TYPE=STRESS", "LOW, 0., 2., 1."]},
        r"deck.inp:\d+: the initial stresses of elements \d+ and \d+ have the tractions \(1, 2, 0\) and \(0, 0, 0\) on "
        "the interface between them; expected the same on both sides",
    ),
    ({"material": ["*CREEP", "1e-9, 2., 0."]}, r"deck.inp:\d+: \*CREEP of material M of the CPS4 beside U4"),
]


@pytest.mark.parametrize(("what", "message"), WRONG)
def test_wrong_ones_are_refused_and_the_standard_element_is_not(tmp_path, what, message):
    with pytest.raises(DeckError, match=message):
        insert(tmp_path, **what)
    assert not (tmp_path / "out.inp").exists()
    done, places = insert(tmp_path, STANDARD, "U2", **what)
    assert done.elements == 2 and places == []


def test_doubtful_ones_are_said(tmp_path):
    done, places = insert(tmp_path, material=["*PLASTIC", "10., 0."])
    assert places == ["*PLASTIC"] and "its tractions are wrong once it yields; take U2" in done.warnings[0]
    assert done.lines("INTERFACE")[0].startswith("warning: ")


def test_what_does_not_matter_is_not_said(tmp_path):
    """Expansion without a change of temperature, and stress elsewhere."""
    model = ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "1, 20."]
    _, places = insert(tmp_path, material=WARM, model=model, step=["*TEMPERATURE", "1, 20."])
    assert places == []
    model = ["*INITIAL CONDITIONS, TYPE=STRESS", "LOW, 0., 0., 0."]
    assert insert(tmp_path, model=model)[1] == []


@pytest.mark.parametrize(
    ("shell", "solid", "element", "standard"),
    [("SC8R", "C3D8", "U8", "U7"), ("SC6R", "C3D6", "U606", "U13")],
)
def test_continuum_shells_are_refused_by_name(tmp_path, shell, solid, element, standard):
    mesh = grid(solid, (2, 2, 2), (2.0, 2.0, 2.0))
    mesh.sets = {"LOW": mesh.cell[:, 2] == 0, "HIGH": mesh.cell[:, 2] == 1}
    lines = [*mesh.lines(), "*SHELL SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", "*ELASTIC", "1e4, 0.3"]
    path = tmp_path / "deck.inp"
    path.write_text("\n".join([*lines, "*STEP", "*STATIC", "1., 1.", "*END STEP", ""]).replace(solid, shell))
    of_solids = (
        rf"{shell} beside {element} \(element \d+\) has the stresses of a shell, where {element} takes those of a"
    )
    with pytest.raises(DeckError, match=rf"deck.inp:\d+: {of_solids} solid; take {standard}, which"):
        inserted(path, tmp_path / "out.inp", LAW, between=[("LOW", "HIGH")], element="")
    inserted(path, tmp_path / "out.inp", STANDARD, between=[("LOW", "HIGH")], element=standard)
    assert f"*ELEMENT, TYPE={standard}" in (tmp_path / "out.inp").read_text()
