# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Partition of the elements among the ranks: METIS cuts the graph of elements that share nodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from uel.errors import UsageError
from uel.model.arrays import IntArray


def owners_of(groups: Sequence[IntArray], parts: int) -> IntArray:
    """Return the part of each element.

    Parameters
    ----------
    groups
        (m, nodes) nodes of the elements of each group.
    parts
        Number of parts. An element counts with the number of its nodes; parts differ little in their sum, and cut few
        pairs of elements that share nodes.

    Returns
    -------
    IntArray
        (elements,) from 0, group by group.

    Raises
    ------
    UsageError
        pymetis is not installed.
    """
    try:
        import pymetis  # noqa: PLC0415 (only for several ranks)
    except ImportError:
        raise UsageError(f"a job on {parts} ranks needs pymetis; pip install .[mpi]") from None
    if sum(map(len, groups)) <= parts:
        return np.arange(sum(map(len, groups)))
    sizes = np.concatenate([np.full(len(nodes), nodes.shape[1]) for nodes in groups])
    starts = np.concatenate([[0], np.cumsum(sizes)])
    nodes = np.concatenate([nodes.ravel() for nodes in groups])
    ones = np.ones(len(nodes), dtype=np.int32)
    incidence = sparse.csr_array((ones, nodes, starts), shape=(len(sizes), int(nodes.max(initial=0)) + 1))
    # (elements, elements): number of nodes that two elements share
    shared = sparse.csr_array(incidence @ incidence.T)
    shared.setdiag(0)
    shared.eliminate_zeros()
    _, parts_of = pymetis.part_graph(
        parts,
        xadj=shared.indptr.tolist(),
        adjncy=shared.indices.tolist(),
        vweights=sizes.tolist(),
        eweights=shared.data.tolist(),
    )
    return np.array(parts_of, dtype=np.int64)
