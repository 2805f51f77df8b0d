# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Definitions that keywords make by name; `uel.deck.language.repetition` refuses a name that is defined twice."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block

Defined = TypeVar("Defined")


def read_definitions(
    blocks: Iterable[Block],
    keyword: str,
    read: Callable[[Block], Defined],
    problems: Problems,
    option: str = "NAME",
) -> dict[str, Defined]:
    """Read the definitions of the blocks of a keyword, by name.

    Parameters
    ----------
    blocks
        Of one scope; those of other keywords are passed over.
    keyword
        Its name, without the asterisk.
    read
        From a block to what its name stands for.
    problems
        Gets the errors.
    option
        Has the name.
    """
    found: dict[str, Defined] = {}
    for block in blocks:
        if block.name == keyword:
            with problems.gather():
                found[block.options.text(option)] = read(block)
    return found
