# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The keyword table, look-up in it, and its Markdown form."""

from __future__ import annotations

from pathlib import Path

from harness.deck.abaqus_names import ABAQUS_KEYWORDS
from harness.deck.keywords_model import MODEL_KEYWORDS
from harness.deck.keywords_step import STEP_KEYWORDS
from harness.deck.problems import nearest
from harness.deck.table import Keyword, Kind, Option, Support, compact
from harness.errors import DeckError, Source

KEYWORDS = {compact(keyword.name): keyword for keyword in (*MODEL_KEYWORDS, *STEP_KEYWORDS)}
MARKDOWN = Path(__file__).with_name("keywords.md")
_ABAQUS = {compact(name): name for name in ABAQUS_KEYWORDS}


def find_keyword(name: str, source: Source) -> Keyword:
    """Keyword of this name, or the only one of Abaqus that begins like this; DeckError says whether Abaqus has it."""
    wanted = compact(name)
    begins = [full for full in _ABAQUS if full.startswith(wanted)] if wanted not in _ABAQUS else []
    if len(begins) == 1:
        wanted = begins[0]
    if wanted in KEYWORDS:
        return KEYWORDS[wanted]
    if wanted in _ABAQUS:
        raise DeckError(source, f"*{_ABAQUS[wanted]} is not supported")
    known = {keyword.name for keyword in KEYWORDS.values()} | ABAQUS_KEYWORDS
    raise DeckError(source, f"unknown keyword *{name.strip()}{nearest(name.strip().upper(), known)}")


def markdown() -> str:
    """Supported keywords with their options, as a document."""
    lines = ["# Supported keywords", ""]
    lines.append(
        "Any other keyword or option of Abaqus is refused with its place in the deck; a misspelt one is named."
    )
    lines.append("This page is written by `python -m harness.deck` from the table that the reader uses.")
    for keyword in sorted(KEYWORDS.values(), key=lambda keyword: keyword.name):
        if keyword.support is Support.READ:
            lines += ["", f"## *{keyword.name}", "", f"{keyword.doc} ({keyword.where.value})", *_option_lines(keyword)]
    lines += ["", "## Accepted and listed: they cannot change the solution", "", "| keyword | |", "|---|---|"]
    passive = sorted((k for k in KEYWORDS.values() if k.support is Support.IGNORED), key=lambda keyword: keyword.name)
    lines += [f"| *{keyword.name} | {keyword.doc} |" for keyword in passive]
    return "\n".join(lines) + "\n"


def _option_lines(keyword: Keyword) -> list[str]:
    read = [option for option in keyword.options if option.support is Support.READ]
    lines = ["", "| option | value | |", "|---|---|---|", *map(_option_row, read)] if read else []
    for support, title in ((Support.IGNORED, "Ignored"), (Support.REFUSED, "Refused")):
        names = [option.name for option in keyword.options if option.support is support]
        if names:
            lines += ["", f"{title}: {', '.join(names)}."]
    if keyword.data:
        lines += ["", f"Data: {keyword.data}."]
    return lines


def _option_row(option: Option) -> str:
    value = ", ".join(option.choices) if option.kind is Kind.CHOICE else option.kind.value
    notes = [option.doc, "required" if option.required else "", f"default {option.default}" if option.default else ""]
    if option.refused:
        notes.append(f"refused: {', '.join(option.refused)}")
    return f"| {option.name} | {value} | {'; '.join(note for note in notes if note)} |"
