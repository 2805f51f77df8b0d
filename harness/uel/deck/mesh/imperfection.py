# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*IMPERFECTION: move nodes by mode shapes of an earlier job, or by data lines."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.repetition import overlaps
from uel.deck.language.table import INPUT, Keyword, Kind, Option, Where, one_of
from uel.deck.mesh.flatten import FlatMesh
from uel.errors import UelError
from uel.model.arrays import FloatArray, IntArray


class EarlierResults(Protocol):
    """Reader of the field output of earlier jobs."""

    def shape(self, job: str, step: int, mode: int, increment: int) -> tuple[IntArray, FloatArray]:
        """Return labels (m,) of the nodes of a job, and displacements (m, 3) of a mode or of an increment of a general
        step.

        increment: 0 for the last one. Raises UelError if they were not written.
        """

    def temperatures(self, job: str, step: int, increment: int) -> tuple[IntArray, FloatArray]:
        """Return labels (m,) of the nodes of a job, and temperatures (m,); step and increment: 0 for the last ones.

        Raises UelError if they were not written.
        """


def displace(blocks: Iterable[Block], flat: FlatMesh, problems: Problems, earlier: EarlierResults | None) -> None:
    """Move the nodes of the mesh. Without a reader of results, imperfections from other jobs are skipped."""
    change = np.zeros_like(flat.mesh.coordinates)
    for block in blocks:
        if block.name != "IMPERFECTION":
            continue
        with problems.gather():
            if not block.options.has("FILE"):
                _by_nodes(block, flat, change, problems)
            elif earlier is not None:
                _by_shapes(block, flat, change, earlier)
    if change.any():
        flat.displace(change)


def _by_nodes(block: Block, flat: FlatMesh, change: FloatArray, problems: Problems) -> None:
    if block.options.has("STEP") or block.options.has("INC") or block.options.has("NSET"):
        raise block.error("STEP, INC and NSET are about FILE")
    rows = list(block.rows())
    if not rows:
        raise block.error("needs FILE, or data lines with nodes")
    moved = [flat.nodes(row.name(0, "node"), row.source) for row in rows]
    for before, later, node in overlaps(moved):
        message = f"node {flat.mesh.name(node)} is moved here and at {rows[before].source}: by the sum, which Abaqus"
        problems.warn(rows[later].source, f"*IMPERFECTION: {message} does not document")
    for row, nodes in zip(rows, moved, strict=True):
        row.at_most(4)
        first, second, third = (row.real(k, "change of a coordinate", 0.0) for k in (1, 2, 3))
        if block.options.text("SYSTEM") == "C":
            x, y, _ = flat.mesh.coordinates[nodes].T
            r, angle = np.hypot(x, y) + first, np.arctan2(y, x) + np.radians(second)
            change[nodes] += np.stack([r * np.cos(angle) - x, r * np.sin(angle) - y, np.full(len(x), third)], axis=1)
        else:
            change[nodes] += (first, second, third)


def _by_shapes(block: Block, flat: FlatMesh, change: FloatArray, earlier: EarlierResults) -> None:
    options = block.options
    if not options.has("STEP"):
        raise block.error("FILE needs STEP, the number of the step of that job")
    job, step, increment = options.text("FILE"), options.integer("STEP", 0), options.integer("INC", 0)
    chosen = np.zeros(len(change), dtype=bool)
    name = options.text("NSET")
    chosen[flat.nodes(name, block.source) if name else slice(None)] = True
    rows = list(block.rows())
    if not rows:
        raise block.error("needs data lines with a mode and its factor")
    for row in rows:
        row.at_most(2)
        mode, factor = row.integer(0, "mode"), row.real(1, "factor")
        try:
            labels, shape = earlier.shape(job, step, mode, increment)
        except UelError as error:
            raise row.error(f"FILE={job}: {error}") from None
        displacements = np.zeros_like(change)
        here, earlier_rows = same_nodes(flat, labels, row, job)
        displacements[here] = shape[earlier_rows]
        change[chosen] += factor * displacements[chosen]


def same_nodes(flat: FlatMesh, labels: IntArray, line: Row | Block, job: str) -> tuple[IntArray, IntArray]:
    """Match nodes of the mesh and of an earlier job by label; return their positions in both. Raises DeckError."""
    mesh = flat.mesh
    if np.array_equal(labels, mesh.labels):
        every = np.arange(len(labels))
        return every, every
    if any(mesh.instances) or len(np.unique(labels)) < len(labels):
        raise line.error(f"FILE={job}: the nodes of that job are not those of this model with instances")
    _, here, earlier_rows = np.intersect1d(mesh.labels, labels, return_indices=True)
    return here, earlier_rows


KEYWORDS = (
    Keyword(
        "IMPERFECTION",
        "Move nodes before the analysis: by shapes of an earlier job, as *BUCKLE and *FREQUENCY write them "
        "to their field output, or of *STATIC; or by data lines.",
        Where.MODEL,
        (
            Option(
                "FILE",
                Kind.FILE,
                "name of the job; it is looked up in the current folder, the folder of the results, and that "
                "of the deck",
            ),
            Option("STEP", Kind.INTEGER, "step of that job"),
            Option("INC", Kind.INTEGER, "increment of a general step (the last one written)"),
            Option("NSET", Kind.NAME, "nodes that FILE moves (all)"),
            one_of(
                "SYSTEM",
                "of the data lines: R: x, y, z; C: r, angle in degrees, z",
                ("R", "C"),
                default="R",
                refused=("S",),
            ),
            INPUT,
        ),
        "mode and factor; of a general step 1 and factor; without FILE node and changes of its coordinates",
    ),
)
