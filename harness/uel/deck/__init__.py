# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Abaqus input decks: keyword table, lexer and reader."""

from uel.deck.language.lexer import Survey
from uel.deck.reader import part_of, read_deck, survey_deck, survey_restart

__all__ = ["Survey", "part_of", "read_deck", "survey_deck", "survey_restart"]
