# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The keyword table and the page made from it."""

from harness.deck.abaqus_names import ABAQUS_KEYWORDS
from harness.deck.keywords import KEYWORDS, MARKDOWN, markdown
from harness.deck.user_elements import BUILT_IN_NODES


def test_page_is_current() -> None:
    assert MARKDOWN.read_text(encoding="utf-8") == markdown(), "run python -m harness.deck"


def test_every_keyword_is_one_of_abaqus() -> None:
    assert {keyword.name for keyword in KEYWORDS.values()} <= ABAQUS_KEYWORDS


def test_options_have_one_entry_each() -> None:
    for keyword in KEYWORDS.values():
        names = [option.name for option in keyword.options]
        assert len(names) == len(set(names)), keyword.name


def test_page_names_all_built_in_elements() -> None:
    doc = next(option.doc for option in KEYWORDS["ELEMENT"].options if option.name == "TYPE")
    assert doc.partition("built in: ")[2].split(", ") == list(BUILT_IN_NODES)
