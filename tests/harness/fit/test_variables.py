# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Variables of `uel fit`, and the decks that get parameters for them."""

from pathlib import Path

import pytest

from uel.deck import read_deck, survey_deck
from uel.errors import UsageError
from uel.fit.variables import Variable, prepare_deck, read_variable
from uel.paper.reproduce.cases import PaperCase
from uel.usersub.layout import element_layouts

GIC, SIGMAMAX = Variable("GIC", 0.1, 0.2, 0.5), Variable("sigmamax", 10.0, 20.0, 50.0)


def test_words() -> None:
    assert read_variable("GIC=0.1:0.2:0.5") == GIC
    # the geometric mean
    assert read_variable(" E = 1:100") == Variable("E", 1.0, 10.0, 100.0)
    # the mean, where there is no other
    assert read_variable("EXPONENT=-0.5:1.5") == Variable("EXPONENT", -0.5, 0.5, 1.5)
    assert read_variable("EXPONENT=0:1:3") == Variable("EXPONENT", 0.0, 1.0, 3.0)


@pytest.mark.parametrize(
    "text", ["GIC", "GIC=", "GIC=1", "=1:2", "GIC=2:1", "GIC=1:3:2", "GIC=1:2:3:4", "GIC=a:b", "GIC=1:inf"]
)
def test_wrong_words(text: str) -> None:
    with pytest.raises(
        UsageError, match=r"expected NAME=LOW:HIGH or NAME=LOW:START:HIGH with LOW < HIGH and LOW <= START <= HIGH"
    ):
        read_variable(text)


@pytest.mark.parametrize("element", ["standard", "consistent"])
def test_properties_of_a_deck_of_ours(tmp_path: Path, element: str) -> None:
    case = PaperCase("dcb", "0/0", element, "1e6", size=4.0)
    (tmp_path / "decks").mkdir()
    for name, text in case.files().items():
        (tmp_path / "decks" / name).write_text(text)
    deck = tmp_path / "decks" / f"{case.name}.inp"
    copy = prepare_deck(deck, [GIC, SIGMAMAX], tmp_path / "fit")
    assert copy == tmp_path / "fit" / f"{case.name}_fit.inp"
    assert survey_deck(copy).parameters == ("GIC", "SIGMAMAX")

    def properties(path: Path, given: dict[str, float] | None = None) -> dict[str, float]:
        group = read_deck(path, given).groups[-1]
        assert group.definition is not None
        names = [item.name for item in element_layouts()[group.definition.number].reals]
        return dict(zip(names, group.section.values.tolist(), strict=True))

    before = properties(deck)
    assert properties(copy) == before | {"GIC": 0.2, "SIGMAMAX": 20.0}
    assert properties(copy, {"GIC": 0.4}) == before | {"GIC": 0.4, "SIGMAMAX": 20.0}
    # all else is as before: the files that it includes are found
    assert read_deck(copy).mesh.coordinates.tolist() == read_deck(deck).mesh.coordinates.tolist()


def test_deck_with_the_parameters_runs_itself(tmp_path: Path) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text("*PARAMETER\nGic = 0.2\n*NODE\n1, 0.\n")
    assert prepare_deck(deck, [GIC], tmp_path / "fit") == deck
    assert not (tmp_path / "fit").exists()


def test_name_that_is_neither(tmp_path: Path) -> None:
    case = PaperCase("dcb", "0/0", "standard", "1e6", size=4.0)
    for name, text in case.files().items():
        (tmp_path / name).write_text(text)
    with pytest.raises(UsageError, match="nor is 'GICC' a property of the project's interface elements on data lines"):
        prepare_deck(tmp_path / f"{case.name}.inp", [Variable("GICC", 0.1, 0.2, 0.5)], tmp_path / "fit")


def test_zero_that_stands_for_a_default(tmp_path: Path) -> None:
    case = PaperCase("dcb", "0/0", "consistent", "1e6", size=4.0)
    for name, text in case.files().items():
        (tmp_path / name).write_text(text)
    deck = tmp_path / f"{case.name}.inp"
    prepare_deck(deck, [Variable("EXPONENT", 0.0, 1.0, 2.0)], tmp_path / "fit")
    with pytest.raises(UsageError, match=r"ENDURANCE: 0 stands for 0\.2, so that bounds above 0 are expected"):
        prepare_deck(deck, [Variable("ENDURANCE", 0.0, 0.2, 0.5)], tmp_path / "fit")
