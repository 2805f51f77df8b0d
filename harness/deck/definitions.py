# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What keywords with a name define: each name once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from harness.deck.blocks import Block
from harness.deck.error_report import Problems
from harness.errors import Source

Defined = TypeVar("Defined")


def read_definitions(
    blocks: Iterable[Block],
    keyword: str,
    read: Callable[[Block], Defined],
    problems: Problems,
    option: str = "NAME",
) -> dict[str, Defined]:
    """What the blocks of a keyword define, by name.

    Parameters
    ----------
    blocks
        Of one scope; those of other keywords are passed over.
    keyword
        Its name, without the asterisk.
    read
        From a block to what its name stands for.
    problems
        Gets the errors; a second definition of a name is one, with the place of the first.
    option
        Has the name.
    """
    found: dict[str, Defined] = {}
    places: dict[str, Source] = {}
    for block in blocks:
        if block.name == keyword:
            with problems.gather():
                name = block.options.text(option)
                if name in places:
                    raise block.error(f"{name} is defined already, at {places[name]}")
                places[name] = block.source
                found[name] = read(block)
    return found
