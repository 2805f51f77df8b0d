# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m harness.deck` writes keywords.md from the keyword table."""

from harness.deck.keywords import MARKDOWN, markdown

MARKDOWN.write_text(markdown(), encoding="utf-8")
