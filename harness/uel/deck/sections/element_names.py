# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of the properties and variables of a user element, from comments below its *USER ELEMENT.

Abaqus has no keyword for them, and allows comments anywhere: a deck with names runs there unchanged.
"""

from __future__ import annotations

import re
from typing import Final

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.table import compact
from uel.errors import Source
from uel.model.properties import ElementNames, UserElement

_LINE: Final = re.compile(r"(PROPERTIES|I\s*PROPERTIES|VARIABLES)\s*:\s*(.*)", re.IGNORECASE)
_UNIT: Final = re.compile(r"\s*\[[^\]]*\]$")
_UNNAMED: Final = "-"


def read_names(block: Block, element: UserElement, problems: Problems) -> ElementNames:
    """Read the names in the comments of a *USER ELEMENT; warn of names that do not match it, and drop them."""
    names_of: dict[str, list[str]] = {}
    locations: dict[str, Source] = {}
    for text, source in block.comments:
        if match := _LINE.match(text):
            kind = " ".join(match[1].upper().replace("IP", "I P").split())
            locations.setdefault(kind, source)
            names_of.setdefault(kind, []).extend(name.strip() for name in match[2].strip(" ,").split(","))
    counts = {"PROPERTIES": element.properties, "I PROPERTIES": element.integer_properties}
    for kind, names in list(names_of.items()):
        count, fault = counts.get(kind, element.variables), ""
        plain = [_plain(name, kind) for name in names if name != _UNNAMED]
        if not all(names):
            fault = "a name is empty"
        elif len(set(plain)) < len(plain):
            fault = f"{next(name for name in plain if plain.count(name) > 1)} is named twice"
        elif kind == "VARIABLES" and count % len(names):
            fault = f"{len(names)} names for {kind}={count}, which is no multiple of them"
        elif kind != "VARIABLES" and len(names) != count:
            fault = f"{len(names)} names for {kind}={count}"
        if fault:
            problems.warn(locations[kind], f"*USER ELEMENT: {fault}; the names of {kind} in comments are not used")
            del names_of[kind]
    return ElementNames(
        tuple(names_of.get("PROPERTIES", [])),
        tuple(names_of.get("I PROPERTIES", [])),
        tuple("" if name == _UNNAMED else _plain(name, "VARIABLES") for name in names_of.get("VARIABLES", [])),
    )


def _plain(name: str, kind: str) -> str:
    """Return a name without its unit, for a variable in the spelling of output requests."""
    plain = _UNIT.sub("", name)
    return compact(plain) if kind == "VARIABLES" else plain
