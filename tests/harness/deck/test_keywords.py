# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The keyword table and the page made from it."""

import ast
from collections.abc import Callable, Iterator

import pytest

from uel.deck.keywords import KEYWORDS, MARKDOWN, markdown
from uel.deck.language.abaqus_names import ABAQUS_KEYWORDS
from uel.deck.language.table import Keyword, Kind, Option, Options, Support, Where, compact, read_options, refused
from uel.errors import Source
from uel.model.element_types import BUILT_IN


def test_page_is_current() -> None:
    assert MARKDOWN.read_text(encoding="utf-8") == markdown(), "run python -m uel.deck"


def test_every_keyword_is_one_of_abaqus() -> None:
    assert {keyword.name for keyword in KEYWORDS.values()} <= ABAQUS_KEYWORDS


def test_options_have_one_entry_each() -> None:
    for keyword in KEYWORDS.values():
        names = [option.name for option in keyword.options]
        assert len(names) == len(set(names)), keyword.name


KEYWORD = Keyword(
    "STATIC",
    "",
    Where.STEP,
    (Option("DIRECT"), Option("FACTOR", Kind.REAL), Option("TYPE", Kind.CHOICE, choices=("A", "B")), *refused("CREEP")),
)
READ = read_options(KEYWORD, ["DIRECT", "FACTOR=2.", "TYPE=B"], Source("deck.inp", 1))


def test_options_that_the_table_has() -> None:
    assert READ.flag("DIRECT")
    assert READ.real("FACTOR", 1.0) == 2.0
    assert READ.text("TYPE") == "B"
    assert READ.has("FACTOR")
    assert [READ.known(name) for name in ("DIRECT", "RIKS", "CREEP")] == [True, False, False]
    assert Options(KEYWORD).real("FACTOR", 1.0) == 1.0


@pytest.mark.parametrize(
    "ask, name",
    [
        (READ.flag, "RIKS"),
        (READ.has, "RIKS"),
        (READ.text, "INPUT"),
        (READ.text, "CREEP"),
        (READ.flag, "FACTOR"),
        (lambda name: READ.integer(name, 1), "FACTOR"),
        (lambda name: READ.real(name, 1.0), "TYPE"),
    ],
)
def test_an_option_that_the_table_does_not_have_is_no_silent_default(ask: Callable[[str], object], name: str) -> None:
    with pytest.raises(LookupError, match=rf"\*STATIC has no option {name} of kind .* in the keyword table"):
        ask(name)


KINDS = {
    "flag": {Kind.FLAG, Kind.SWITCH},
    "has": set(Kind),
    "known": set(Kind),
    "text": {Kind.NAME, Kind.CHOICE, Kind.FILE},
    "real": {Kind.REAL},
    "integer": {Kind.INTEGER},
    "positive": {Kind.REAL},
    "not_negative": {Kind.REAL},
}


def look_ups(code: str) -> Iterator[tuple[str, str]]:
    """Look-ups of options by literal names: flag, real, ... and the name."""
    for node in ast.walk(ast.parse(code)):
        match node:
            case ast.Call(func=ast.Attribute(value=owner, attr=how), args=[ast.Constant(value=str(name)), *_]) if (
                how in KINDS and ast.unparse(owner).endswith(("options", "block"))
            ):
                yield how, name


def entries(code: str) -> Iterator[str]:
    """Names of the keywords whose entries stand in a file."""
    for node in ast.walk(ast.parse(code)):
        match node:
            case ast.Call(func=ast.Name(id="Keyword"), args=[ast.Constant(value=str(name)), *_]):
                yield name


CODES = {
    path.relative_to(MARKDOWN.parent).with_suffix("").as_posix(): path.read_text(encoding="utf-8")
    for path in MARKDOWN.parent.rglob("*.py")
}
"""Sources of the deck, by their path without ending."""


def test_every_entry_is_in_the_table_once() -> None:
    """What `keywords.py` leaves out is not read, and of two entries of one name it would take the last."""
    names = sorted(name for code in CODES.values() for name in entries(code))
    assert names == sorted(keyword.name for keyword in KEYWORDS.values() if keyword.support is Support.READ)


def test_every_option_that_a_reader_asks_for_is_of_an_entry_beside_it() -> None:
    """Also where no test reads such a deck."""
    asked, elsewhere = 0, set()
    for stem, code in CODES.items():
        options = [option for name in entries(code) for option in KEYWORDS[compact(name)].options]
        own = {(option.name, option.kind) for option in options if option.support is Support.READ}
        for how, name in look_ups(code):
            asked += 1
            if not any((name, kind) in own for kind in KINDS[how]):
                elsewhere.add((stem, name))
    assert asked > 100
    # what is asked for again, or of several keywords
    named = {("mesh/groups", "ELSET"), ("language/lexer", "NAME")}
    assert elsewhere == {*named, ("steps/procedures", "PERTURBATION"), ("steps/step", "OP")}


def test_page_names_all_built_in_elements() -> None:
    doc = next(option.doc for option in KEYWORDS["ELEMENT"].options if option.name == "TYPE")
    assert doc.partition("built in: ")[2].split(", ") == list(BUILT_IN)
