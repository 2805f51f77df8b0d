# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear equations between dofs: *EQUATION."""

from __future__ import annotations

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import INPUT, Keyword, Where
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.steps.prescribed import read_dof
from uel.errors import DeckError, Source
from uel.model.arrays import IntArray
from uel.model.model import Equation

TERM_FIELDS = 3
"""Fields of a term of *EQUATION: node or set, dof, coefficient."""


def read_equations(flat: FlatMesh, problems: Problems) -> tuple[Equation, ...]:
    """Read the equations of all instances and of the root."""
    equations: list[Equation] = []
    for block, owner in flat.blocks("EQUATION"):
        with problems.gather():
            equations += _read_equation(flat, owner, block)
    return tuple(equations)


def _read_equation(flat: FlatMesh, owner: Owner, block: Block) -> list[Equation]:
    if owner.placement.rotates:
        raise block.error(f"is not supported in an instance that is rotated ({owner.name})")
    rows = iter(block.rows())
    equations = []
    for head in rows:
        count = head.integer(0, "number of terms")
        if count < 1 or len(head) != 1:
            raise head.error("expected a line with the number of terms")
        terms: list[tuple[IntArray, int, float]] = []
        while len(terms) < count:
            row = next(rows, None)
            if row is None:
                raise head.error(f"expected {count} terms, found {len(terms)}")
            terms += _read_terms(flat, owner, row)
        if len(terms) > count:
            raise head.error(f"expected {count} terms, found {len(terms)}")
        equations += _expand(terms, head.source)
    return equations


def _read_terms(flat: FlatMesh, owner: Owner, row: Row) -> list[tuple[IntArray, int, float]]:
    if len(row) % TERM_FIELDS:
        raise row.error("expected node or set, dof, coefficient of each term")
    return [
        (
            flat.nodes(row.name(start, "node or node set"), row.source, owner.name),
            read_dof(row, start + 1),
            row.real(start + 2, "coefficient"),
        )
        for start in range(0, len(row), TERM_FIELDS)
    ]


def _expand(terms: list[tuple[IntArray, int, float]], source: Source) -> list[Equation]:
    """Expand to one equation for each node of the first term; a single node is combined with sets of any size.
    Raises DeckError.
    """
    count = len(terms[0][0])
    if terms[0][2] == 0:
        raise DeckError(source, "*EQUATION: the coefficient of the first term, which is eliminated, is zero")
    if any(len(nodes) not in (1, count) for nodes, _, _ in terms):
        sizes = ", ".join(str(len(nodes)) for nodes, _, _ in terms)
        raise DeckError(source, f"*EQUATION: the node sets of the terms have different sizes ({sizes})")
    return [
        Equation(tuple((int(nodes[k if len(nodes) > 1 else 0]), dof, factor) for nodes, dof, factor in terms), source)
        for k in range(count)
    ]


KEYWORDS = (
    Keyword(
        "EQUATION",
        "Linear constraint between dofs; the first term is eliminated, or another one if its dof is prescribed. A set "
        "stands for its nodes in order.",
        Where.MODEL,
        (INPUT,),
        "number of terms; then node or set, dof, coefficient of each term",
    ),
)
