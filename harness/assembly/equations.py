# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*EQUATION, and equations of other constraints: elimination of the first term of each, chains resolved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import sparse

from harness.assembly.dofs import DofMap
from harness.errors import DeckError, Source
from harness.model.arrays import IntArray
from harness.model.model import Equation


def eliminate(
    dofs: DofMap, equations: Sequence[Equation], prescribed: IntArray, places: Mapping[int, Source]
) -> tuple[IntArray, sparse.csr_array]:
    """Dependent unknowns and their coefficients on all others.

    Returns the unknowns eliminated, (k,), and C, (k, n), with u[dependent] = C u; columns of dependent unknowns are
    empty. `places` says where unknowns are prescribed. Raises DeckError if an unknown is prescribed and eliminated,
    eliminated twice, or depends on itself.
    """
    held = set(prescribed.tolist())
    by_unknown: dict[int, int] = {}
    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []
    for row, equation in enumerate(equations):
        terms = _terms(dofs, equation)
        first = next(iter(terms))
        _check_free(dofs, equation, first, held, places)
        if first in by_unknown:
            raise DeckError(
                equation.source,
                f"over-constrained: {_named(dofs, first)} is the first term of this constraint and of the one at "
                f"{equations[by_unknown[first]].source}; it can be eliminated only once",
            )
        by_unknown[first] = row
        pivot = terms.pop(first)
        if pivot == 0.0:
            raise DeckError(equation.source, f"the coefficient of the first term, {_named(dofs, first)}, is zero")
        rows += [row] * len(terms)
        columns += terms.keys()
        values += [-value / pivot for value in terms.values()]
    dependent = np.array(list(by_unknown), dtype=np.int64)
    shape = (len(dependent), len(dofs))
    direct = sparse.coo_array((values, (rows, columns)), shape=shape).tocsr()
    return dependent, _resolve(dofs, equations, dependent, direct)


def _terms(dofs: DofMap, equation: Equation) -> dict[int, float]:
    """Coefficient of each unknown, terms in order, repeated ones added."""
    terms: dict[int, float] = {}
    for node, dof, coefficient in equation.terms:
        unknown = int(dofs.find(node, dof))
        if unknown < 0:
            raise DeckError(equation.source, f"no element uses dof {dof} of node {dofs.mesh.name(node)}")
        terms[unknown] = terms.get(unknown, 0.0) + coefficient
    return terms


def _check_free(dofs: DofMap, equation: Equation, unknown: int, held: set[int], places: Mapping[int, Source]) -> None:
    if unknown in held:
        where = f" at {places[unknown]}" if unknown in places else ""
        raise DeckError(
            equation.source,
            f"over-constrained: {_named(dofs, unknown)} is the first term of this constraint, which is eliminated, and "
            f"is also prescribed{where}; prescribe another term or put it first",
        )


def _resolve(
    dofs: DofMap, equations: Sequence[Equation], dependent: IntArray, direct: sparse.csr_array
) -> sparse.csr_array:
    """Replace dependent unknowns on the right-hand sides by what they depend on: the sum of N^k D over k >= 0."""
    between = direct[:, dependent]
    if between.nnz == 0:
        return direct
    _, label = sparse.csgraph.connected_components(between, connection="strong")
    same = np.bincount(label)[label] > 1
    if same.any():
        row = int(np.flatnonzero(same)[0])
        others = ", ".join(str(equations[k].source) for k in np.flatnonzero(label == label[row]).tolist() if k != row)
        raise DeckError(
            equations[row].source,
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
