# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Zero modes of AMATRX at the start of the analysis: only rigid-body motions."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Final

import numpy as np

from uel.check.differences import differences
from uel.check.element_calls import ElementState
from uel.check.finding import Finding, Verdict, failed, not_applicable, passed
from uel.check.rigid_motions import Body, body_at_rest, uniform_strains
from uel.check.subject import Subject
from uel.model.arrays import FloatArray

TOLERANCE: Final = 1e-9
"""Limit relative to the largest eigenvalue: a mode with a smaller one costs no energy."""

SHEARED: Final = 1e-6
"""Limit relative to the largest energy of a uniform strain: one that costs less costs none."""

DIFFERENCES: Final = 1e-6
"""Limit relative to the largest eigenvalue for differences of RHS, in a dynamic step."""


@dataclass(frozen=True, slots=True)
class _Stiffness:
    """Stiffness: matrix (k, k) of the displacements, its name, and its tolerance."""

    name: str
    limit: float
    matrix: FloatArray


def check(subject: Subject) -> Finding:
    """Check the eigenvalues of the symmetric part of AMATRX for the displacements, at rest."""
    at_rest = body_at_rest(subject)
    if isinstance(at_rest, Finding):
        return at_rest
    state, body = at_rest
    chosen = body.displacement | body.turning.any(axis=0)
    name, limit, matrix = "AMATRX", TOLERANCE, state.evaluate().amatrx
    if state.dynamic:
        # AMATRX includes mass
        name, limit, matrix = "-dRHS/dU", DIFFERENCES, subject.differences(state).matrix
    stiffness = _Stiffness(name, limit, matrix[np.ix_(chosen, chosen)])
    rigid = _rigid(body)[:, chosen]
    resisted = _resisted(stiffness.matrix, rigid)
    if resisted > limit:
        return failed(
            f"{state}: {name} resists a rigid-body motion with {100 * resisted:.3g} % of its stiffness",
            "Rows and columns of AMATRX have to sum to zero over the nodes, for each direction. What the checks "
            "`translation` and `rotation` say about RHS holds for AMATRX too.",
            figure=resisted,
            limit=limit,
        )
    expected = int(np.linalg.matrix_rank(rigid))
    finding = _judge(state, stiffness, expected, uniform_strains(body)[:, chosen], interface=body.coincident)
    if finding.verdict is Verdict.FAILED and finding.limit == expected and _suppressed(subject, body):
        return passed(
            f"{round(finding.figure or 0)} zero modes, more than the {expected} rigid-body motions, but those around "
            "a node of the deck have no others together",
            finding.figure,
            finding.limit,
        )
    return finding


def _judge(
    state: ElementState, stiffness: _Stiffness, expected: int, uniform: FloatArray, *, interface: bool
) -> Finding:
    """Judge the stiffness by the expected number of rigid-body motions; interface: nodes coincide.

    uniform: (strains, k) displacements of uniform strains.
    """
    name, limit, matrix = stiffness.name, stiffness.limit, stiffness.matrix
    if not matrix.any():
        return not_applicable(f"{name} is zero at rest: it is for elements that resist the first displacement")
    values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T)) / np.abs(matrix).max()
    zero = int(np.count_nonzero(np.abs(values) < limit))
    if interface:
        return not_applicable(
            f"nodes coincide: {zero} zero modes of {len(values)}, which is no mistake in an interface; it is "
            "for elements with a volume"
        )
    if values[0] < -limit:
        return failed(
            f"{state}: {name} has a negative eigenvalue at rest, {values[0]:.3g} of its largest entry",
            "An element that is stable at rest has none: check the sign of AMATRX (it is -dRHS/dU), the Jacobian "
            "(order of the nodes), and the material's stiffness.",
            figure=float(values[0]),
            limit=-limit,
        )
    if zero > expected:
        return failed(
            f"{state}: {name} has {zero} zero modes, but there are {expected} rigid-body motions",
            _advice(stiffness, uniform, zero - expected),
            figure=float(zero),
            limit=float(expected),
        )
    return passed(f"{zero} zero modes, the {expected} rigid-body motions", float(zero), float(expected))


def _advice(stiffness: _Stiffness, uniform: FloatArray, count: int) -> str:
    """Return the advice for an element with this number of zero-energy deformation modes."""
    symmetric = 0.5 * (stiffness.matrix + stiffness.matrix.T)
    values = np.linalg.eigvalsh(uniform @ symmetric @ uniform.T)
    if values[0] <= SHEARED * values[-1]:
        return (
            "A uniform strain costs no energy: check the rows of the strain-displacement matrix (which derivative "
            "belongs to which displacement, and to which component of the strain) and the material's stiffness; more "
            "integration points do not help."
        )
    return (
        f"{count} deformation(s) cost no energy (hourglass modes): take more integration points, or stabilise the "
        "element. If reduced integration is intended, check whether neighbours suppress the mode: a deck with a node "
        "that elements surround shows it."
    )


def _suppressed(subject: Subject, body: Body) -> bool:
    """Return whether the elements around a node of the deck together have only rigid-body motions as zero modes."""
    for patch in subject.patches:
        nodes = np.unique([state.single.block.group.nodes[0] for state in patch.states])
        moved = np.unique(subject.dofs[body.displacement | body.turning.any(axis=0)])
        index_of = {(node, dof): k for k, (node, dof) in enumerate(product(nodes.tolist(), moved.tolist()))}
        total = np.zeros((len(index_of), len(index_of)))
        used = np.zeros(len(index_of), dtype=np.bool_)
        for state in patch.states:
            nodes_at = state.single.block.group.nodes[0][subject.local_nodes]
            rows = [index_of.get((int(node), int(dof)), -1) for node, dof in zip(nodes_at, subject.dofs, strict=True)]
            local_rows = np.flatnonzero(np.array(rows) >= 0)
            global_rows = np.array(rows)[local_rows]
            still = state.still().quiet()
            matrix = still.evaluate().amatrx if not still.dynamic else differences(still, subject.scales).matrix
            total[np.ix_(global_rows, global_rows)] += matrix[np.ix_(local_rows, local_rows)]
            used[global_rows] = True
        limit = DIFFERENCES if patch.states[0].dynamic else TOLERANCE
        matrix = total[np.ix_(used, used)]
        values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T)) / (np.abs(matrix).max() or 1.0)
        rotations = body.dimensions * (body.dimensions - 1) // 2
        if np.count_nonzero(np.abs(values) < limit) == body.dimensions + rotations:
            return True
    return False


def _rigid(body: Body) -> FloatArray:
    """Return translations and small rotations (motions, n)."""
    translations = [body.size * body.translation(direction) for direction in range(body.dimensions)]
    return np.array(translations + body.small_rotations())


def _resisted(amatrx: FloatArray, rigid: FloatArray) -> float:
    """Return the largest force of a rigid-body motion, over the sum of |stiffness| |motion|."""
    forces, costs = np.abs(amatrx @ rigid.T).max(axis=0), (np.abs(amatrx) @ np.abs(rigid.T)).max(axis=0)
    return float(np.max(forces / np.where(costs > 0.0, costs, 1.0)))
