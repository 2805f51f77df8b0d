# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS, TYPE=SOLUTION: state variables of elements at the start of the analysis."""

from __future__ import annotations

from collections.abc import Iterable

from harness.elements import Block
from harness.errors import DeckError
from harness.model.model import Model


def set_initial_states(blocks: Iterable[Block], model: Model, sdvini: int | None) -> None:
    """Set the state variables that the deck gives, by themselves or by SDVINI (its address; None without it).

    Raises DeckError, and KernelError where SDVINI ends the analysis.
    """
    for entry in model.initial_solutions:
        if entry.elements is None and sdvini is None:
            raise DeckError(entry.source, "*INITIAL CONDITIONS, USER needs SDVINI, which the job does not have")
        for block in blocks:
            if entry.elements is None:
                assert sdvini is not None
                block.call_sdvini(sdvini)
                continue
            rows = entry.elements - block.first
            rows = rows[(rows >= 0) & (rows < len(block.group.labels))]
            try:
                if len(rows):
                    block.initialise(rows, entry.values)
            except ValueError as error:
                raise DeckError(entry.source, f"*INITIAL CONDITIONS, TYPE=SOLUTION: {error}") from None
