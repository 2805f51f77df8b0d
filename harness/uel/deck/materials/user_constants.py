# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Constants of user materials: PROPS of UMAT, UMATHT and UHYPER."""

from __future__ import annotations

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.sections.user_elements import read_count
from uel.model.arrays import FloatArray

MOST_VARIABLES = 1_000_000


def read_constants(block: Block, option: str, problems: Problems) -> FloatArray:
    """Read the constants, whose number an option gives; missing ones are zero. Raises DeckError."""
    count = read_count(block, option, 0, 0, MOST_VARIABLES)
    values = [row.real(index, "constant", 0.0) for row, index in block.entries(problems.warn)]
    if len(values) == count + 1:
        # a temperature after a single set of constants is ignored
        values.pop()
    if len(values) > count:
        raise block.dependent(f"{len(values)} values, but {option}={count}")
    return np.array(values + [0.0] * (count - len(values)))
