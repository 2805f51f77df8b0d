# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values given to the parameters of a deck from outside, and what a deck consists of."""

from pathlib import Path

import pytest

from uel.deck import read_deck, survey_deck
from uel.errors import DeckError, UsageError
from uel.model.mesh import Mesh

DECK = """\
*PARAMETER
length = 2.
half = length/2
parts = 4
*NODE, NSET=ENDS
1, 0., 0.
2, <length>, <half>
*INCLUDE, INPUT=rest{which}.inp
*STEP
*STATIC
1., 1.
*END STEP
"""
REST = """\
*NGEN
1, 2, 1
*ELEMENT, TYPE=SPRINGA, ELSET=ALL
1, 1, 2
*SPRING, ELSET=ALL

1.
"""


@pytest.fixture
def deck(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("rest.inp").write_text(REST)
    Path("rest4.inp").write_text(REST)
    Path("deck.inp").write_text(DECK.format(which=""))
    return Path("deck.inp")


def end(mesh: Mesh) -> list[float]:
    return list(mesh.coordinates[1][:2])


def test_given_value_replaces_the_one_of_the_deck(deck: Path) -> None:
    """What is computed from it follows; case does not matter where it does not distinguish."""
    assert end(read_deck(deck).mesh) == [2.0, 1.0]
    model = read_deck(deck, {"LENGTH": 6.0})
    assert end(model.mesh) == [6.0, 3.0]
    assert model.parameters == {"LENGTH": 6.0}
    assert end(read_deck(deck, {"half": 5.0}).mesh) == [2.0, 5.0]


def test_whole_number_for_a_real_one(deck: Path) -> None:
    """length/2 of the deck stays a quotient of real numbers, and a whole number stays one where the deck has one."""
    assert end(read_deck(deck, {"length": 5}).mesh) == [5.0, 2.5]
    deck.write_text(DECK.format(which="<parts>"))
    assert len(read_deck(deck, {"parts": 4}).mesh.labels) == 2
    with pytest.raises(DeckError, match=r"deck.inp:8: cannot read rest4.0.inp"):
        read_deck(deck, {"parts": 4.0})


def test_given_value_of_no_parameter(deck: Path) -> None:
    message = r"--parameter lengths: deck.inp defines no parameter of this name; its parameters are length, half, parts"
    with pytest.raises(UsageError, match=rf"^{message}; did you mean length\?$"):
        read_deck(deck, {"lengths": 1.0})
    deck.write_text("*HEADING\nnothing\n")
    with pytest.raises(UsageError, match=r"--parameter a: deck.inp defines .* name; it has no \*PARAMETER$"):
        read_deck(deck, {"a": 1.0})


def test_survey(deck: Path) -> None:
    found = survey_deck(deck)
    assert found.files == (deck, Path("rest.inp"))
    assert found.parameters == ("length", "half", "parts")
    assert not found.depends


def test_survey_of_files_that_parameters_choose(deck: Path) -> None:
    deck.write_text(DECK.format(which="<parts>"))
    assert survey_deck(deck).files == (deck, Path("rest4.inp"))
    found = survey_deck(deck, {"parts": 5})
    assert (found.files, found.depends) == ((deck, Path("rest5.inp")), True)


def test_survey_of_a_deck_with_mistakes(deck: Path) -> None:
    """They are the reader's concern."""
    deck.write_text("*NODDE\n*PARAMETER\na = 1\nb = \n*INCLUDE\n*INCLUDE, INPUT=rest.inp\n")
    found = survey_deck(deck)
    assert found.files == (deck, Path("rest.inp"))
    assert "a" in found.parameters
    with pytest.raises(DeckError, match=r"none\.inp: cannot read the file"):
        survey_deck(Path("none.inp"))
