# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table, assembled from the files that read the keywords, and its Markdown form."""

from __future__ import annotations

from pathlib import Path

from uel.deck import ignored
from uel.deck.constraints import couplings, equations
from uel.deck.constraints.tie import reader as ties
from uel.deck.contact import general_contact, geometric_corrections, interactions
from uel.deck.contact import pairs as contact
from uel.deck.language import lexer, structure
from uel.deck.language.repetition import RULES
from uel.deck.language.table import Keyword, Kind, Option, Support, compact
from uel.deck.materials import (
    damage,
    diffusion,
    expansion,
    heat,
    hyperelastic,
    physical_constants,
    piezoelectric,
    plastic,
    viscous,
)
from uel.deck.materials import material as materials
from uel.deck.mesh import generation, groups, imperfection, local_mesh, orientations, placement, surfaces, transforms
from uel.deck.sections import beams, membranes, shells, user_elements
from uel.deck.sections import controls as section_controls
from uel.deck.sections import solids as sections
from uel.deck.steps import (
    amplitudes,
    controls,
    distributed,
    heat_loads,
    initial,
    modal,
    prescribed,
    procedures,
    requests,
    restart,
)
from uel.deck.steps import step as steps

_FILES = (
    *(
        structure,
        lexer,
        placement,
        orientations,
        local_mesh,
        generation,
        user_elements,
        surfaces,
        equations,
        couplings,
        ties,
    ),
    *(contact, general_contact, geometric_corrections, interactions),
    *(
        materials,
        expansion,
        plastic,
        viscous,
        hyperelastic,
        damage,
        heat,
        diffusion,
        physical_constants,
        piezoelectric,
        section_controls,
        sections,
        membranes,
        shells,
        beams,
        groups,
        amplitudes,
        initial,
        imperfection,
        steps,
        procedures,
        modal,
    ),
    *(controls, transforms, prescribed, distributed, heat_loads, requests, restart, ignored),
)
KEYWORDS: dict[str, Keyword] = {compact(keyword.name): keyword for file in _FILES for keyword in file.KEYWORDS}
MARKDOWN = Path(__file__).with_name("keywords.md")


def markdown() -> str:
    """Return the supported keywords with their options as a Markdown page."""
    lines = ["# Supported keywords", ""]
    lines.append(
        "Any other keyword or option of Abaqus is refused with its place in the deck; a misspelt one is named."
    )
    lines.append("This page is written by `python -m uel.deck` from the table that the reader uses.")
    for keyword in sorted(KEYWORDS.values(), key=lambda keyword: keyword.name):
        if keyword.support is Support.READ:
            lines += ["", f"## *{keyword.name}", "", f"{keyword.doc} ({keyword.where.value})", *_option_lines(keyword)]
            lines += ["", f"Comments: {keyword.comments}."] if keyword.comments else []
            lines += ["", RULES[keyword.name].sentence] if keyword.name in RULES else []
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
