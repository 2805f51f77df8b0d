# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solves small systems on the ranks of one `mpiexec`, each with its part of the matrix.

A chain of elements with four unknowns each, of which two are those of the next one; each rank has a piece of it. Rank 0
prints, for each solver and matrix, the largest error over that of dense algebra, and what the solver has done.
"""

from __future__ import annotations

import json
import sys

import numpy as np
from scipy import sparse

from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray
from uel.parallel import launched
from uel.parallel.mpi import MpiRanks
from uel.solver.linear import Effort, Pattern, RankSolver

ELEMENTS = 40
SIZE = 2 * ELEMENTS + 2
RIGID = np.kron(np.array([[1.0, -1.0], [-1.0, 1.0]]), np.eye(2))


def elements(*, symmetric: bool = True, changed: bool = False, free: bool = False) -> FloatArray:
    """(elements, 4, 4) matrices; changed: the last one is another; free: nothing holds the chain."""
    random = np.random.default_rng(1).standard_normal((ELEMENTS, 4, 4))
    found = random @ random.transpose(0, 2, 1) + np.eye(4)
    if not symmetric:
        found += 0.5 * random
    if free:
        found[:] = RIGID
    if changed:
        found[-1] *= 2.0
    return found


def part_of(matrices: FloatArray, ranks: MpiRanks) -> FloatArray:
    """(n, n) dense part of this rank."""
    part = np.zeros((SIZE, SIZE))
    for k in np.array_split(np.arange(ELEMENTS), ranks.size)[ranks.rank]:
        part[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += matrices[k]
    return part


def systems(ranks: MpiRanks) -> dict[str, list[FloatArray]]:
    """By name the parts of this rank of matrices that one solver gets, one after another."""
    spring, multiplier = np.zeros((SIZE, SIZE)), part_of(elements(), ranks)
    # an unknown of the first rank, which the last one has in no element
    if ranks.rank == ranks.size - 1:
        spring[0, 0] = 50.0
    # of unknowns that the others do not touch
    multiplier[4:6, 4:6] = np.array([[0.0, 1.0], [2.0, 0.0]]) if not ranks.rank else 0.0
    multiplier[4:6, :4] = multiplier[:4, 4:6] = multiplier[4:6, 6:] = multiplier[6:, 4:6] = 0.0
    loose = part_of(elements(), ranks)
    loose[4], loose[:, 4] = 0.0, 0.0
    failed = elements()
    for pieces in np.array_split(np.arange(ELEMENTS), ranks.size)[1:]:
        failed[pieces[0], :2] = failed[pieces[0], :, :2] = 0.0
    return {
        "symmetric, then changed on the last rank": [
            part_of(elements(), ranks),
            part_of(elements(changed=True), ranks),
        ],
        "unsymmetric": [part_of(elements(symmetric=False), ranks)],
        "symmetric, then unsymmetric": [part_of(elements(), ranks), part_of(elements(symmetric=False), ranks)],
        "a spring on a rank without the element": [part_of(elements(), ranks) + spring],
        "shared unknowns without stiffness on a rank": [part_of(failed, ranks)],
        "zeros on the diagonal": [multiplier],
        "an unknown without stiffness": [loose],
        "free": [part_of(elements(free=True), ranks)],
    }


def solved(ranks: MpiRanks, name: str, parts: list[FloatArray]) -> dict[str, object]:
    """What a solver does with matrices of one pattern."""
    pattern = sparse.csr_array(part_of(np.ones((ELEMENTS, 4, 4)), ranks) + np.eye(SIZE))
    rows, columns = pattern.nonzero()
    solver = RankSolver(
        ranks, name, Pattern(pattern.indptr, pattern.indices), lambda unknown: (f"of {unknown}", 1), Effort()
    )
    rhs, error = np.random.default_rng(2).standard_normal(SIZE), 0.0
    taken = solver.name
    for part in parts:
        whole = ranks.sum(part)
        try:
            solver.factorise(part[rows, columns])
            solution = solver.solve(rhs)
        except SingularMatrixError as failure:
            return {"solver": taken, "singular": str(failure), "refused": solver.effort.refused}
        expected = np.linalg.solve(whole, rhs)
        same = {found.tobytes() for found in ranks.allgather(solution)}
        assert len(same) == 1, "the ranks have different bits"
        error = max(error, float(np.abs(solution - expected).max() / np.abs(expected).max()))
    effort = solver.effort
    solver.release()
    return {"solver": taken, "error": error, "in part": effort.in_part, "refused": effort.refused}


ranks = MpiRanks(launched())
found = {name: {title: solved(ranks, name, parts) for title, parts in systems(ranks).items()} for name in sys.argv[1:]}
if not ranks.rank:
    print(json.dumps(found))
ranks.ended(None)
ranks.close()
