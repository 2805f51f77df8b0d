# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*EQUATION, and equations of other constraints: elimination of an unknown of each, chains resolved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import sparse

from harness.assembly.dofs import DofMap
from harness.errors import DeckError, Source
from harness.model.arrays import IntArray
from harness.model.model import Equation

ROUNDING = 1e-12
"""Part of the largest coefficient of an equation that is none after elimination."""


def eliminate(
    dofs: DofMap, equations: Sequence[Equation], prescribed: IntArray, places: Mapping[int, Source]
) -> tuple[IntArray, sparse.csr_array]:
    """Dependent unknowns and their coefficients on all others.

    The dependent unknown of an equation is that of its first term; if that is prescribed, another one of the equation.

    Parameters
    ----------
    dofs
        Numbers of the unknowns.
    equations
        In the order of the deck.
    prescribed
        Unknowns with a given value.
    places
        Where the deck prescribes them.

    Returns
    -------
    tuple[IntArray, sparse.csr_array]
        The k unknowns that depend on others, and C, (k, n), with u[dependent] = C u; columns of dependent unknowns are
        empty.

    Raises
    ------
    DeckError
        All unknowns of an equation are prescribed, or those of several equations together; an unknown is the first one
        of two equations, or depends on itself.
    """
    held = set(prescribed.tolist())
    by_unknown: dict[int, int] = {}
    terms = [_terms(dofs, equation) for equation in equations]
    others: list[int] = []
    for row, equation in enumerate(equations):
        first = next(iter(terms[row]))
        if terms[row][first] == 0.0:
            raise DeckError(equation.source, f"the coefficient of the first term, {_named(dofs, first)}, is zero")
        if first in held:
            others.append(row)
        elif first in by_unknown:
            raise DeckError(
                equation.source,
                f"over-constrained: {_named(dofs, first)} is the first term of this constraint and of the one at "
                f"{equations[by_unknown[first]].source}; it can be eliminated only once",
            )
        else:
            by_unknown[first] = row
    _choose_others(dofs, equations, terms, others, by_unknown, held, places)
    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []
    for number, (unknown, row) in enumerate(by_unknown.items()):
        pivot = terms[row].pop(unknown)
        rows += [number] * len(terms[row])
        columns += terms[row].keys()
        values += [-value / pivot for value in terms[row].values()]
    dependent = np.array(list(by_unknown), dtype=np.int64)
    shape = (len(dependent), len(dofs))
    direct = sparse.coo_array((values, (rows, columns)), shape=shape).tocsr()
    sources = [equations[row].source for row in by_unknown.values()]
    return dependent, _resolve(dofs, sources, dependent, direct)


def _choose_others(
    dofs: DofMap,
    equations: Sequence[Equation],
    terms: list[dict[int, float]],
    rows: list[int],
    by_unknown: dict[int, int],
    held: set[int],
    places: Mapping[int, Source],
) -> None:
    """Dependent unknowns of equations whose first one is prescribed: Gaussian elimination, the largest term as pivot.

    It replaces in `terms` what the equations before it have made dependent, so that the choice of one leaves an unknown
    to the next, as the six equations of an average motion need.
    """
    chosen: dict[int, dict[int, float]] = {}
    for row in rows:
        own = terms[row]
        size = max(map(abs, own.values()))
        for unknown, equation in chosen.items():
            if factor := own.pop(unknown, 0.0):
                for other, value in equation.items():
                    own[other] = own.get(other, 0.0) - factor * value
        left = [unknown for unknown in own if unknown not in held and unknown not in by_unknown]
        pivot = max(left, key=lambda unknown: abs(own[unknown]), default=-1)
        if pivot < 0 or abs(own[pivot]) <= ROUNDING * size:
            first = equations[row].terms[0]
            unknown = int(dofs.find(first[0], first[1]))
            where = f" at {places[unknown]}" if unknown in places else ""
            raise DeckError(
                equations[row].source,
                f"over-constrained: {_named(dofs, unknown)}, the first term of this constraint, is prescribed{where}, "
                "and the constraint has no other unknown that is free",
            )
        by_unknown[pivot] = row
        chosen[pivot] = {unknown: value / own[pivot] for unknown, value in own.items() if unknown != pivot}


def _terms(dofs: DofMap, equation: Equation) -> dict[int, float]:
    """Coefficient of each unknown, terms in order, repeated ones added."""
    terms: dict[int, float] = {}
    for node, dof, coefficient in equation.terms:
        unknown = int(dofs.find(node, dof))
        if unknown < 0:
            raise DeckError(equation.source, f"no element uses dof {dof} of node {dofs.mesh.name(node)}")
        terms[unknown] = terms.get(unknown, 0.0) + coefficient
    return terms


def _resolve(
    dofs: DofMap, sources: Sequence[Source], dependent: IntArray, direct: sparse.csr_array
) -> sparse.csr_array:
    """Replace dependent unknowns on the right-hand sides by what they depend on: the sum of N^k D over k >= 0."""
    between = direct[:, dependent]
    if between.nnz == 0:
        return direct
    _, label = sparse.csgraph.connected_components(between, connection="strong")
    same = np.bincount(label)[label] > 1
    if same.any():
        row = int(np.flatnonzero(same)[0])
        others = ", ".join(str(sources[k]) for k in np.flatnonzero(label == label[row]).tolist() if k != row)
        raise DeckError(
            sources[row],
            f"over-constrained: {_named(dofs, int(dependent[row]))} depends on itself through the constraint "
            f"at {others}",
        )
    keep = np.ones(len(dofs))
    keep[dependent] = 0.0
    term = direct @ sparse.diags_array(keep)
    total = term
    while (term := between @ term).nnz:
        total = total + term
    total.eliminate_zeros()
    return sparse.csr_array(total)


def _named(dofs: DofMap, unknown: int) -> str:
    node, dof = dofs.name(unknown)
    return f"node {node}, dof {dof}"
