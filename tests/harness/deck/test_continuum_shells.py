# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sections of continuum shells: what the deck gives, and what is refused."""

import pytest

import uel
from uel.deck import read_deck
from uel.errors import DeckError

DECK = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*NSET, NSET=BOTTOM
1, 2, 3, 4
*NSET, NSET=TOP
5, 6, 7
*ELEMENT, TYPE={type}, ELSET=ALL
1, {nodes}
*MATERIAL, NAME=M
{material}
*ORIENTATION, NAME=O
1., 0., 0., 0., 1., 0.
3, 0.
{keyword}, ELSET=ALL, MATERIAL=M{options}
0.5
*BOUNDARY
1, 1, 2
2, 2
BOTTOM, 3
*STEP{step}
*STATIC
*DLOAD
ALL, {load}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=TOP
U
*END STEP
"""


@pytest.fixture
def deck(tmp_path):
    def deck(options="", *, type="SC8R", material="*ELASTIC\n100., 0.3", load="P2, 1.", step="", general=False):
        file = tmp_path / "shell.inp"
        nodes = ", ".join(map(str, range(1, 9) if type == "SC8R" else (1, 2, 3, 5, 6, 7)))
        keyword = "*SHELL GENERAL SECTION" if general else "*SHELL SECTION"
        values = {"type": type, "nodes": nodes, "material": material, "options": options, "load": load, "step": step}
        file.write_text(DECK.format(**values, keyword=keyword))
        return file

    return deck


@pytest.mark.parametrize("general", [False, True])
def test_defaults(deck, general):
    section = read_deck(deck(general=general)).groups[0].section
    assert (section.stack, section.poisson, section.modulus) == (3, None, 0.0)


@pytest.mark.parametrize("general", [False, True])
@pytest.mark.parametrize(
    ("options", "stack", "poisson"),
    [
        (", STACK DIRECTION=1, POISSON=-0.5, THICKNESS MODULUS=70.", 1, -0.5),
        (", STACK DIRECTION=ORIENTATION, ORIENTATION=O, POISSON=ELASTIC, THICKNESS MODULUS=70.", None, "ELASTIC"),
    ],
)
def test_options(deck, options, stack, poisson, general):
    section = read_deck(deck(options, general=general)).groups[0].section
    assert (section.stack, section.poisson, section.modulus) == (stack, poisson, 70.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (", STACK DIRECTION=4", "STACK DIRECTION"),
        (", STACK DIRECTION=ORIENTATION", "STACK DIRECTION=ORIENTATION needs ORIENTATION="),
        (", POISSON=0.6", "POISSON=0.6: expected a number from -1 to 0.5, or ELASTIC"),
        (", POISSON=-1.", "POISSON=-1.: expected a number from -1 to 0.5, or ELASTIC"),
        (", POISSON=MATERIAL", "POISSON=MATERIAL: expected a number from -1 to 0.5, or ELASTIC"),
        (", THICKNESS MODULUS=0.", "THICKNESS MODULUS=0 must be positive"),
    ],
)
def test_wrong_options(deck, options, message):
    with pytest.raises(DeckError, match=rf"shell\.inp:22: .*{message}"):
        read_deck(deck(options))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"load": "P, 1."}, r"shell\.inp:31: .*load type P on elements of type SC8R; expected Pn"),
        (
            {"options": ", STACK DIRECTION=1", "type": "SC6R"},
            r"shell\.inp:22: \*SHELL SECTION: STACK DIRECTION=1 of elements of type SC6R; expected 3 or ORIENTATION",
        ),
        (
            {"material": "*ELASTIC\n100., 0.3\n*EXPANSION\n1e-5"},
            r"\*EXPANSION is not supported for elements of type SC8R \(material M",
        ),
        ({"load": "GRAV, 1., 0., 0., 1."}, r"shell\.inp:31: GRAV needs \*DENSITY, which material M does not have"),
    ],
)
def test_what_is_refused(deck, tmp_path, options, message):
    with pytest.raises(DeckError, match=message):
        uel.run(deck(**options), output_dir=tmp_path)


@pytest.mark.parametrize("type", ["SC8R", "SC6R"])
def test_pressure_across(deck, tmp_path, type):
    """A block under pressure that is free to the sides.

    The stress across, -p, is the thickness modulus E/(1 + nu) times the strain across and, with Poisson's ratio 0.5 of
    the section, those of the plane, on which it acts as well: they are p (1 - nu)/E each.
    """
    history = uel.run(deck(type=type), output_dir=tmp_path).history
    aside, down = 0.7 / 100, -1.3 / 100 - 2 * 0.7 / 100
    for node in (5, 6, 7):
        assert history[f"U3[TOP:{node}]"][-1] == pytest.approx(down)
    assert history["U1[TOP:6]"][-1] - history["U1[TOP:5]"][-1] == pytest.approx(aside)
