# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that are fitted, and decks of ours that have properties instead of parameters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uel.batch.values import value_of
from uel.deck import read_deck, survey_deck
from uel.deck.language.lexer import unknown_parameter
from uel.errors import UsageError
from uel.files import read_whole
from uel.model.mesh import ElementGroup
from uel.model.properties import UserProperty
from uel.usersub.layout import element_layouts

_INPUT = re.compile(r'(\bINPUT\s*=\s*)("[^"]*"|[^,\n]+?)(\s*(?:,|$))', re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Variable:
    """A parameter that is fitted, within low and high; positive, as strengths, toughnesses and stiffnesses are."""

    name: str
    low: float
    start: float
    high: float


def read_variable(text: str) -> Variable:
    """Read a variable, NAME=LOW:HIGH or NAME=LOW:START:HIGH; the start defaults to the geometric mean. UsageError."""
    name, _, rest = text.partition("=")
    try:
        values = [float(value_of(word.strip())) for word in rest.split(":")]
        low, *start, high = values
        variable = Variable(name.strip(), low, start[0] if start else float(np.sqrt(low * high)), high)
        if len(start) > 1 or not variable.name or not 0.0 < low < high or not low <= variable.start <= high:
            raise ValueError
    except ValueError:
        raise UsageError(
            f"'{text}': expected NAME=LOW:HIGH or NAME=LOW:START:HIGH with 0 < LOW <= START <= HIGH"
        ) from None
    return variable


def prepare_deck(deck: Path, variables: Sequence[Variable], folder: Path) -> Path:
    """Write the deck with all variables among its parameters: itself, or a copy in the folder, NAME_fit.inp.

    A variable that *PARAMETER of the deck does not define is a property of our interface elements, such as GIC, on the
    data lines of *UEL PROPERTY in the deck itself. In the copy a parameter stands there, and included files are named
    with their folders.

    Raises
    ------
    DeckError
        The deck cannot be read.
    UsageError
        A variable is neither a parameter nor such a property.
    """
    known = survey_deck(deck).parameters
    missing = [variable for variable in variables if variable.name.lower() not in {name.lower() for name in known}]
    if not missing:
        return deck
    lines = read_whole(deck).decode("utf-8", errors="replace").splitlines()
    groups = list({group.section.source: group for group in read_deck(deck).groups}.values())
    for variable in missing:
        text = f"<{variable.name.upper()}>"
        positions = [position for group in groups if (position := _position_of(group, variable.name, deck)) is not None]
        if not [position for position in positions if _replace(lines, *position, text)]:
            raise UsageError(
                f"{unknown_parameter(variable.name, deck, known)}; nor is '{variable.name}' a property of the "
                f"project's interface elements on data lines of {deck}"
            )
    # a keyword line is continued by the next one where it ends in a comma, so INPUT is sought in all but data lines
    lines = [_with_folder(line, deck.parent) if "=" in line and not line.startswith("**") else line for line in lines]
    head = ["*PARAMETER", *(f"{variable.name.upper()} = {variable.start!r}" for variable in missing)]
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / f"{deck.stem}_fit.inp"
    copy.write_text("\n".join([*head, *lines]) + "\n", encoding="utf-8")
    return copy


def _position_of(group: ElementGroup, name: str, deck: Path) -> tuple[int, int] | None:
    """Find a property on *UEL PROPERTY in the deck: line from 1 and position from 0; None if there is no such."""
    section = group.section
    if not isinstance(section, UserProperty) or group.definition is None or section.source.file != str(deck):
        return None
    layout = element_layouts().get(group.definition.number)
    if layout is None or not layout.faces[0]:
        return None
    positions = [item.position - 1 for item in layout.reals if item.name == name.upper()]
    return (section.source.line, positions[0]) if positions else None


def _replace(lines: list[str], keyword: int, position: int, text: str) -> bool:
    """Replace a value by a text on the data lines after a keyword line, whose number counts from 1.

    Returns False if there is no such value.
    """
    for number in range(keyword, len(lines)):
        line = lines[number]
        if line.startswith("**") or "=" in line:
            # a comment, or the keyword line goes on
            continue
        if line.startswith("*"):
            break
        # a comma at the end of a line has no value after it
        cells = line.rstrip().removesuffix(",").split(",")
        if position < len(cells):
            cells[position] = f" {text}" if position else text
            lines[number] = ",".join(cells)
            return True
        position -= len(cells)
    return False


def _with_folder(line: str, folder: Path) -> str:
    """Give the file that INPUT= names in a line its folder."""
    return _INPUT.sub(lambda m: f'{m[1]}"{(folder / m[2].strip().strip(chr(34))).resolve()}"{m[3]}', line)
