# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of Markdown pages."""

from __future__ import annotations

from collections.abc import Sequence


def line(cells: Sequence[object]) -> str:
    """Write a line of a table."""
    return f"| {' | '.join(map(str, cells))} |"


def head(cells: Sequence[object]) -> list[str]:
    """Write the first two lines of a table."""
    return [line(cells), line(["---"] * len(cells))]
