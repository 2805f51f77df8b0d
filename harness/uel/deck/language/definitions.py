# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Definitions that keywords make by name; `uel.deck.language.repetition` refuses a name that is defined twice."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

from uel.deck.error_report import Problems, look_up
from uel.deck.language.blocks import Block

Defined = TypeVar("Defined")


def read_definitions(
    blocks: Iterable[Block],
    keyword: str,
    read: Callable[[Block], Defined],
    problems: Problems,
    option: str = "NAME",
) -> dict[str, Defined]:
    """Read the definitions that a keyword makes in one scope, by the name that `option` gives.

    Errors of `read`, which makes one definition, go to `problems`.
    """
    definitions: dict[str, Defined] = {}
    for block in blocks:
        if block.name == keyword:
            with problems.gather():
                definitions[block.options.text(option)] = read(block)
    return definitions


def named(block: Block, option: str, definitions: Mapping[str, Defined]) -> Defined | None:
    """Return the definition that an option names, None without the option. Raises DeckError if it is unknown."""
    name = block.options.text(option)
    return look_up(definitions, name, option.lower(), block.source) if name else None
