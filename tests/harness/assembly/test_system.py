# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbering, pattern and scatter against plain loops."""

import numpy as np
import pytest

from uel.assembly import DofMap, System
from uel.assembly.system import build_pattern
from uel.elements import FIELD_NAMES
from uel.errors import Source
from uel.model.model import Equation
from uel.usersub._binding import scatter_map


def dense(system, blocks):
    """Matrix of the blocks by a loop over elements, with unknowns looked up one by one."""
    lookup = {(node, dof): k for k, (node, dof) in enumerate(zip(system.dofs.node, system.dofs.dof, strict=True))}
    full = np.zeros((len(system), len(system)))
    for block in blocks:
        for nodes, matrix in zip(block.group.nodes, block.matrices, strict=True):
            at = [lookup[nodes[local], dof] for local, dof in block.unknowns]
            for i, row in enumerate(at):
                for j, column in enumerate(at):
                    full[row, column] += matrix[i, j]
    return full


def test_unknowns_are_ordered_by_node_then_dof(two_blocks) -> None:
    dofs = DofMap.build(*two_blocks)
    assert list(zip(dofs.node.tolist(), dofs.dof.tolist(), strict=True)) == [
        *((node, dof) for node in range(6) for dof in (1, 2)),
        (6, 11),
    ]
    assert dofs.field.tolist() == [0] * 12 + [4]
    assert dofs.name(3) == ("20", 2)
    assert dofs.coordinates[12, 0] == 6.0


def test_find_gives_minus_one_for_unused_dofs(two_blocks) -> None:
    dofs = DofMap.build(*two_blocks)
    assert dofs.find(np.array([0, 5, 6, 6, 7]), np.array([2, 1, 11, 1, 1])).tolist() == [1, 10, 12, -1, -1]
    # a dof above all used ones is no other node's unknown
    assert dofs.find(np.arange(8), 12).tolist() == [-1] * 8
    assert DofMap.build(two_blocks[0], []).find(np.arange(2), 1).tolist() == [-1, -1]


def test_reference_node_of_an_equation_is_an_unknown(two_blocks) -> None:
    mesh, blocks = two_blocks
    equation = Equation(((0, 1, 1.0), (7, 3, -1.0)), Source("a.inp", 1))
    system = System(mesh, blocks, [equation])
    assert system.dofs.find(7, 3) == len(system) - 1


def test_matrix_and_residual_equal_a_loop_over_elements(two_blocks, call) -> None:
    mesh, blocks = two_blocks
    system = System(mesh, blocks)
    u = np.random.default_rng(1).normal(size=len(system))
    expected = dense(system, blocks)
    for _ in range(2):  # the second pass finds the values of the first in its arrays
        evaluation = system.evaluate(call, u, u)
        np.testing.assert_allclose(system.matrix(evaluation.data).toarray(), expected, rtol=0, atol=1e-14)
        np.testing.assert_allclose(evaluation.residual, -expected @ u, rtol=0, atol=1e-13)


def test_sums_over_blocks(two_blocks, call) -> None:
    mesh, blocks = two_blocks
    system = System(mesh, blocks)
    evaluation = system.evaluate(call, np.ones(len(system)), np.zeros(len(system)), matrix=False)
    assert evaluation.data is None
    forces = sum(np.abs(block.matrices.sum(axis=2)).sum() for block in blocks)
    assert evaluation.flux[0] == pytest.approx(forces, rel=1e-14)
    assert evaluation.flux_count.tolist() == [2 * 8 + 2 * 3] + [0] * (len(FIELD_NAMES) - 1)
    assert evaluation.pnewdt == 0.7
    assert evaluation.energy.tolist() == [0, 2, 4, 6, 8, 10, 12, 14]
    system.commit()
    assert [block.commits for block in blocks] == [1, 1]


def test_pattern_is_sorted_symmetric_and_holds_the_diagonal() -> None:
    numbers = [np.array([[4, 0, 2]], dtype=np.int32)]
    indptr, indices = build_pattern(5, numbers)
    scatter = scatter_map(numbers[0], indptr, indices)
    rows = np.repeat(np.arange(5), np.diff(indptr))
    entries = list(zip(rows.tolist(), indices.tolist(), strict=True))
    corners = [(i, j) for i in (0, 2, 4) for j in (0, 2, 4)]
    assert entries == sorted([*corners, (1, 1), (3, 3)])
    assert [entries[k] for k in scatter[0, 0]] == [(4, 4), (4, 0), (4, 2)]
    assert (indptr.dtype, indices.dtype, scatter.dtype) == (np.int32,) * 3
