# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elimination of one unknown of each equation, of *EQUATION and other constraints; chains are resolved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from uel.assembly.dofs import DofMap
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.model import Equation

ROUNDING = 1e-12
"""Coefficient over the largest one of its equation that counts as zero after elimination."""


@dataclass(frozen=True, slots=True)
class RedundantEquation:
    """Equation with only prescribed unknowns after elimination: their values must satisfy it.

    unknown       prescribed unknown of its first term
    unknowns      (k,) unknowns of all terms
    coefficients  (k,) their coefficients
    source        location of the constraint in the deck
    """

    unknown: int
    unknowns: IntArray
    coefficients: FloatArray
    source: Source

    def error(self, u: FloatArray) -> float:
        """Return the relative error at unknowns u (n,): |sum of the terms| over the sum of their magnitudes."""
        terms = self.coefficients * u[self.unknowns]
        size = float(np.abs(terms).sum())
        return abs(float(terms.sum())) / size if size else 0.0


def eliminate(
    dofs: DofMap, equations: Sequence[Equation], prescribed: IntArray
) -> tuple[IntArray, sparse.csr_array, list[RedundantEquation]]:
    """Eliminate one unknown of each equation; find the redundant equations.

    The eliminated, dependent unknown is that of the first term; if that is prescribed, another one of the equation.

    Parameters
    ----------
    dofs
        Numbers of the unknowns.
    equations
        In the order of the deck.
    prescribed
        Prescribed unknowns.

    Returns
    -------
    tuple[IntArray, sparse.csr_array, list[RedundantEquation]]
        The k dependent unknowns, and C (k, n) with u[dependent] = C u, where columns of dependent unknowns are empty.
        Then the equations, or combinations of them, whose unknowns are all prescribed.

    Raises
    ------
    DeckError
        An unknown is the first one of two equations, or depends on itself.
    """
    prescribed_set = set(prescribed.tolist())
    by_unknown: dict[int, int] = {}
    terms = [_terms(dofs, equation) for equation in equations]
    others: list[int] = []
    for row, equation in enumerate(equations):
        first = next(iter(terms[row]))
        if terms[row][first] == 0.0:
            raise DeckError(equation.source, f"the coefficient of the first term, {named(dofs, first)}, is zero")
        if first in prescribed_set:
            others.append(row)
        elif first in by_unknown:
            raise DeckError(
                equation.source,
                f"over-constrained: {named(dofs, first)} is the first term of this constraint and of the one at "
                f"{equations[by_unknown[first]].source}; it can be eliminated only once",
            )
        else:
            by_unknown[first] = row
    redundant = _choose_others(dofs, equations, terms, others, by_unknown, prescribed_set)
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
    return dependent, _resolve(dofs, sources, dependent, direct), redundant


def _choose_others(
    dofs: DofMap,
    equations: Sequence[Equation],
    terms: list[dict[int, float]],
    rows: list[int],
    by_unknown: dict[int, int],
    prescribed_set: set[int],
) -> list[RedundantEquation]:
    """Choose the dependent unknowns of equations whose first unknown is prescribed; return the redundant equations.

    Gaussian elimination with the largest term as pivot. It replaces in `terms` the unknowns that earlier equations
    eliminate, so that each equation has one left, as the six equations of an average motion need.
    """
    chosen: dict[int, dict[int, float]] = {}
    redundant: list[RedundantEquation] = []
    for row in rows:
        own = terms[row]
        size = max(map(abs, own.values()))
        for unknown, equation in chosen.items():
            _replace(own, unknown, equation)
        pivot = _largest(own, prescribed_set, by_unknown)
        for _ in equations:
            dependent = [unknown for unknown in own if unknown in by_unknown]
            if (pivot >= 0 and abs(own[pivot]) > ROUNDING * size) or not dependent:
                break
            # unknowns on which these depend may be free
            for unknown in dependent:
                _replace(own, unknown, _solved(terms[by_unknown[unknown]], unknown))
            pivot = _largest(own, prescribed_set, by_unknown)
        if pivot < 0 or abs(own[pivot]) <= ROUNDING * size:
            left = {unknown: value for unknown, value in own.items() if unknown in prescribed_set}
            node, dof, _ = equations[row].terms[0]
            of_terms = np.array(list(left), dtype=np.int64), np.array(list(left.values()))
            redundant.append(RedundantEquation(int(dofs.find(node, dof)), *of_terms, equations[row].source))
            continue
        by_unknown[pivot] = row
        chosen[pivot] = _solved(own, pivot)
    return redundant


def _replace(own: dict[int, float], unknown: int, equation: Mapping[int, float]) -> None:
    """Replace an unknown of an equation by the unknowns that it depends on."""
    if factor := own.pop(unknown, 0.0):
        for other, value in equation.items():
            own[other] = own.get(other, 0.0) - factor * value


def _largest(own: Mapping[int, float], prescribed_set: set[int], dependent: Mapping[int, int]) -> int:
    """Return the unknown with the largest coefficient among those neither prescribed nor dependent, or -1."""
    left = [unknown for unknown in own if unknown not in prescribed_set and unknown not in dependent]
    return max(left, key=lambda unknown: abs(own[unknown]), default=-1)


def _solved(own: Mapping[int, float], pivot: int) -> dict[int, float]:
    """Return the coefficients of an equation over that of the pivot, which is left out."""
    return {unknown: value / own[pivot] for unknown, value in own.items() if unknown != pivot}


def _terms(dofs: DofMap, equation: Equation) -> dict[int, float]:
    """Return the coefficients by unknown in the order of the terms; repeated terms add up. Raises DeckError."""
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
    """Replace dependent unknowns on right-hand sides by independent ones: the sum of N^k D over k >= 0."""
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
            f"over-constrained: {named(dofs, int(dependent[row]))} depends on itself through the constraint "
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


def named(dofs: DofMap, unknown: int) -> str:
    """Return the name of an unknown in messages."""
    node, dof = dofs.name(unknown)
    return f"node {node}, dof {dof}"
