# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that are fitted, and decks of ours that have properties instead of parameters."""

from __future__ import annotations

import math
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
from uel.model.arrays import FloatArray
from uel.model.mesh import ElementGroup
from uel.model.properties import UserProperty
from uel.usersub.layout import element_layouts

_INPUT = re.compile(r'(\bINPUT\s*=\s*)("[^"]*"|[^,\n]+?)(\s*(?:,|$))', re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Variable:
    """A parameter that is fitted, within low and high.

    A positive one, as strengths, toughnesses and stiffnesses are, is sought on a logarithmic scale, one whose low is
    not above 0 on a linear scale. Its coordinate is the logarithm, or its place between the bounds, from 0 to 1.
    """

    name: str
    low: float
    start: float
    high: float

    @property
    def logarithmic(self) -> bool:
        """True if the coordinate is the logarithm."""
        return self.low > 0.0

    @property
    def hundredth(self) -> str:
        """Change of the coordinate by 0.01 in words."""
        return "1 % more" if self.logarithmic else "1 % of its range more"

    def coordinate(self, value: float) -> float:
        """Return the coordinate of a value."""
        return math.log(value) if self.logarithmic else (value - self.low) / (self.high - self.low)

    def value(self, coordinate: float) -> float:
        """Return the value at a coordinate."""
        if self.logarithmic:
            return math.exp(coordinate)
        return self.low + coordinate * (self.high - self.low)


def coordinates(variables: Sequence[Variable], name: str) -> FloatArray:
    """Return the coordinates (k,) of the starts ('start') or bounds ('low', 'high') of variables."""
    return np.array([variable.coordinate(getattr(variable, name)) for variable in variables])


def values_at(variables: Sequence[Variable], point: FloatArray) -> FloatArray:
    """Return the values (k,) at coordinates (k,)."""
    return np.array([variable.value(at) for variable, at in zip(variables, point.tolist(), strict=True)])


def read_variable(text: str) -> Variable:
    """Read a variable, NAME=LOW:HIGH or NAME=LOW:START:HIGH.

    The start defaults to the geometric mean of the bounds, or to their mean if LOW is not above 0. Raises UsageError.
    """
    name, _, rest = text.partition("=")
    try:
        values = [float(value_of(word.strip())) for word in rest.split(":")]
        low, *start, high = values
        middle = math.sqrt(low * high) if 0.0 < low < high else 0.5 * (low + high)
        variable = Variable(name.strip(), low, start[0] if start else middle, high)
        if len(start) > 1 or not variable.name or not low < high or not low <= variable.start <= high:
            raise ValueError
    except ValueError:
        raise UsageError(
            f"'{text}': expected NAME=LOW:HIGH or NAME=LOW:START:HIGH with LOW < HIGH and LOW <= START <= HIGH"
        ) from None
    return variable


def read_variables(words: Sequence[str]) -> list[Variable]:
    """Read variables, each of another name. Raises UsageError."""
    variables = [read_variable(word) for word in words]
    twice = {v.name for v in variables if sum(v.name.lower() == w.name.lower() for w in variables) > 1}
    if twice:
        raise UsageError(f"{', '.join(sorted(twice))}: given more than once")
    return variables


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
        A variable is neither a parameter nor such a property, or a property whose 0, within the bounds, is a default.
    """
    known = survey_deck(deck).parameters
    missing = [variable for variable in variables if variable.name.lower() not in {name.lower() for name in known}]
    if not missing:
        return deck
    lines = read_whole(deck).decode("utf-8", errors="replace").splitlines()
    groups = list({group.section.source: group for group in read_deck(deck).groups}.values())
    for variable in missing:
        text = f"<{variable.name.upper()}>"
        positions = [position for group in groups if (position := _position_of(group, variable, deck)) is not None]
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


def _position_of(group: ElementGroup, variable: Variable, deck: Path) -> tuple[int, int] | None:
    """Find a property on *UEL PROPERTY in the deck: line from 1 and position from 0; None if there is no such.

    Raises UsageError if 0, which stands for a default, is within the bounds.
    """
    section = group.section
    if not isinstance(section, UserProperty) or group.definition is None or section.source.file != str(deck):
        return None
    layout = element_layouts().get(group.definition.number)
    if layout is None or not layout.faces[0]:
        return None
    items = [item for item in layout.reals if item.name == variable.name.upper()]
    if not items:
        return None
    if variable.low <= 0.0 <= variable.high and items[0].default:
        raise UsageError(f"{variable.name}: 0 stands for {items[0].default}, so that bounds above 0 are expected")
    return section.source.line, items[0].position - 1


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
