# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A material that nothing uses has no effect, whatever it holds; one that is used is read to its last line."""

import pytest

from uel.deck.language.abaqus_names import ABAQUS_KEYWORDS, MATERIAL_KEYWORDS
from uel.deck.materials.material import MATERIAL_OPTIONS
from uel.errors import DeckError

DECK = """*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
*ELEMENT, TYPE=S4, ELSET=E
1, 1, 2, 3, 4
*SHELL SECTION, ELSET=E, MATERIAL=M
0.1
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
{}*STEP
*STATIC
*END STEP
"""
SPARE = "*MATERIAL, NAME=SPARE\n*ELASTIC\n1000., 0.\n"
FAULTS = {
    "keyword": (
        "*CONCRETE DAMAGED PLASTICITY\n38., 0.1, 1.16, 0.667, 0.\n",
        r"\*CONCRETE DAMAGED PLASTICITY is not supp",
    ),
    "abbreviated keyword": ("*HYPOELAS\n1., 2.\n", r"\*HYPOELASTIC is not supported"),
    "option": ("*DENSITY, PORE FLUID\n1.\n", r"\*DENSITY: option PORE FLUID is not supported"),
    "value": ("*DAMAGE INITIATION, CRITERION=MAXPS\n1.\n", r"CRITERION=MAXPS is not supported"),
    "what depends on it": (
        "*DAMAGE INITIATION, CRITERION=MAXPS\n1.\n*DAMAGE EVOLUTION, TYPE=ENERGY\n1.\n",
        "MAXPS is not",
    ),
    "data": ("*PLASTIC\n10., 0., 20.\n", r"\*PLASTIC: .*dependence on temperature is not supported"),
    "type": ("*VISCOELASTIC, TIME=FREQUENCY DATA\n1.\n", r"TIME=FREQUENCY DATA is not supported"),
}


def test_names():
    assert MATERIAL_OPTIONS <= MATERIAL_KEYWORDS <= ABAQUS_KEYWORDS


@pytest.mark.parametrize("name", FAULTS)
def test_listed_where_nothing_uses_it(read, name):
    lines, _ = FAULTS[name]
    model = read(DECK.format(SPARE + lines))
    assert [(what, source.line) for what, source in model.ignored] == [("MATERIAL, NAME=SPARE", 13)]
    assert not model.warnings


def test_not_listed_where_it_is_understood(read):
    assert read(DECK.format(SPARE)).ignored == ()


@pytest.mark.parametrize("name", FAULTS)
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("MATERIAL=M\n0.1", "MATERIAL=SPARE\n0.1"),
        ("MATERIAL=M\n0.1", "COMPOSITE\n0.1, 3, spare"),
        ("MATERIAL=M\n0.1", 'COMPOSITE\n0.1, 3, M\n0.1, 3, "Spare"'),
    ],
)
def test_refused_where_a_section_uses_it(read, old, new, name):
    lines, message = FAULTS[name]
    with pytest.raises(DeckError, match=rf"deck\.inp:1\d: .*{message}|deck\.inp:2\d: .*{message}"):
        read(DECK.format(SPARE + lines).replace(old, new))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        # no option of a material
        ("*CONNECTOR SECTION, ELSET=E\nAXIAL,\n", r"16: \*CONNECTOR SECTION is not supported"),
        ("*CONCRETEE\n1.\n", r"16: unknown keyword \*CONCRETEE; did you mean CONCRETE\?"),
        # the material has ended
        ("*NSET, NSET=X\n1\n*HYPOELASTIC\n1.\n", r"18: \*HYPOELASTIC is not supported"),
        ("*MATERIAL, NAME=OTHER, RTOL=1.\n*HYPOELASTIC\n1.\n", r"17: \*HYPOELASTIC is not supported"),
    ],
)
def test_what_follows_is_read(read, lines, message):
    with pytest.raises(DeckError, match=rf"deck\.inp:{message}"):
        read(DECK.format(SPARE + lines))
