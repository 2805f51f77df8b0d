# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Comparison of the forces of linear elements with their matrices times U."""

from __future__ import annotations

from typing import Final

import numpy as np

from uel.elements.block import ElementBlock
from uel.elements.call import Call
from uel.elements.lflags import Request
from uel.model.arrays import FloatArray

MOST_TRIED: Final = 20
"""Elements of a block whose forces are compared before its matrices are used in place of calls."""

FORCE_TOLERANCE: Final = 1e-8
"""Largest difference of a force from matrix times U, over the sum of the magnitudes of its terms.

Rounding is 1e-12 in thin shells; a matrix that is not the derivative of the force differs in the first digits.
"""


def has_forces_of(block: ElementBlock, matrices: FloatArray, call: Call) -> bool:
    """Return whether RHS is minus the matrix times U, in some elements of the block and for trial values of U.

    Parameters
    ----------
    block
        In small displacements and at rest, bound to a system.
    matrices
        Of the elements, as `ElementBlock.evaluate_unassembled` returns them.
    call
        A static one with small displacements.
    """
    rows = np.unique(np.linspace(0, len(matrices) - 1, MOST_TRIED).round().astype(np.int64))
    matrices = matrices[rows]
    part, (m, n) = block.part(rows), matrices.shape[:2]
    # elements without common unknowns, so that their forces are not summed
    part.bind(np.arange(m * n, dtype=np.int32).reshape(m, n), np.arange(m * n * n, dtype=np.int32).reshape(m, n, n))
    stiffness = np.abs(matrices)
    largest = stiffness.max(axis=2)
    # displacements, rotations and pressures scaled so that their forces have the same magnitude
    trial = np.divide(
        np.random.default_rng(0).uniform(-1.0, 1.0, (m, n)), largest, where=largest > 0, out=np.zeros((m, n))
    )
    called, u = np.zeros(m * n), trial.ravel()
    part.evaluate(call.asking(Request.RESIDUAL), u, u, called, None)
    deviation = np.abs(called.reshape(m, n) + np.einsum("ej,eji->ei", trial, matrices))
    return bool((deviation <= FORCE_TOLERANCE * np.einsum("ej,eji->ei", np.abs(trial), stiffness)).all())


def largest_deviation(
    block: ElementBlock, matrices: FloatArray, call: Call, u: FloatArray, du: FloatArray
) -> tuple[int, int, float, float]:
    """Find the entry of RHS that differs most from minus the matrix times U.

    Parameters
    ----------
    block
        In small displacements and at rest, bound to a system.
    matrices
        Of the elements, as `ElementBlock.evaluate_unassembled` returns them.
    call, u, du
        As of `ElementBlock.evaluate`.

    Returns
    -------
    tuple[int, int, float, float]
        Row of the element in the block from 0, entry of RHS from 1, its value, and that of minus the matrix times U.
    """
    n = len(block.unknowns)
    own, scatter = np.arange(n, dtype=np.int32)[None], np.zeros((1, n, n), dtype=np.int32)
    called, expected = np.zeros((len(matrices), n)), np.zeros((len(matrices), n))
    for row, (part, at) in enumerate(zip(block.split(strict=False), block.couplings(), strict=True)):
        part.bind(own, scatter)
        part.evaluate(call, u[at], du[at], called[row], None)
        expected[row] = -u[at] @ matrices[row]
    row, entry = divmod(int(np.abs(called - expected).argmax()), n)
    return row, entry + 1, float(called[row, entry]), float(expected[row, entry])
