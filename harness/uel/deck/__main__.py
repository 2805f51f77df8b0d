# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Command `python -m uel.deck`: write keywords.md from the keyword table."""

from uel.deck.keywords import MARKDOWN, markdown

MARKDOWN.write_text(markdown(), encoding="utf-8")
