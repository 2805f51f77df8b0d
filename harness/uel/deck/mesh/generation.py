# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*NGEN, *NFILL, *NCOPY and *ELGEN."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of, refused
from uel.deck.mesh.local_mesh import LARGEST_LABEL, TAKES_ELEMENTS, TAKES_NODES, ElementRun, LocalMesh, Members
from uel.deck.mesh.placement import read_placement
from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray


def _always(source: Source) -> Callable[[int], Source]:
    return lambda _: source


def _add_nodes(mesh: LocalMesh, row: Row, name: str, labels: IntArray, points: FloatArray) -> None:
    if len(labels) and (labels.min() < 1 or labels.max() > LARGEST_LABEL):
        raise row.error(f"generates node numbers outside 1 to {LARGEST_LABEL}")
    mesh.add_nodes(labels, points, _always(row.source))
    mesh.add_to_set(mesh.nsets, name, [Members("", labels, row.source)])


def generate_nodes(mesh: LocalMesh, block: Block) -> None:
    """Generate nodes on straight lines by *NGEN; the end nodes join the set."""
    for row in block.rows():
        first, last = row.integer(0, "first node"), row.integer(1, "last node")
        step = abs(row.integer(2, "increment", 1))
        start, end = np.array(mesh.point(first, row.source)), np.array(mesh.point(last, row.source))
        if step == 0 or (last - first) % step or first == last:
            raise row.error(f"the increment {step} does not lead from node {first} to node {last}")
        count = abs(last - first) // step
        mesh.reserve(count, "nodes", row)
        fraction = np.arange(count + 1)[:, None] / count
        points = start + (end - start) * fraction
        points[-1] = end
        labels = first + np.arange(count + 1) * (step if last > first else -step)
        _add_nodes(mesh, row, block.options.text("NSET"), labels, points)


def fill_nodes(mesh: LocalMesh, block: Block) -> None:
    """Generate equidistant nodes between corresponding nodes of two sets by *NFILL."""
    for row in block.rows():
        first = mesh.node_labels(row.name(0, "first set"), row.source)
        second = mesh.node_labels(row.name(1, "second set"), row.source)
        intervals, step = row.integer(2, "number of intervals"), row.integer(3, "increment", 1)
        if len(first) != len(second) or not len(first):
            raise row.error(f"the sets hold {len(first)} and {len(second)} nodes")
        if intervals < 1:
            raise row.error(f"{intervals} intervals cannot be filled")
        mesh.reserve((intervals - 1) * len(first), "nodes", row)
        start = np.array([mesh.point(label, row.source) for label in first.tolist()])
        end = np.array([mesh.point(label, row.source) for label in second.tolist()])
        name = block.options.text("NSET")
        mesh.add_to_set(mesh.nsets, name, [Members("", labels, row.source) for labels in (first, second)])
        for layer in range(1, intervals):
            _add_nodes(mesh, row, name, first + layer * step, start + (end - start) * (layer / intervals))


def copy_nodes(mesh: LocalMesh, block: Block) -> None:
    """Add one moved copy of a node set by *NCOPY, SHIFT."""
    options = block.options
    old = mesh.node_labels(options.text("OLD SET"), block.source)
    points = np.array([mesh.point(label, block.source) for label in old.tolist()]).reshape(-1, 3)
    row = Row(block.name, (), block.source)
    labels = old + options.integer("CHANGE NUMBER", 0)
    mesh.reserve(len(labels), "nodes", row)
    _add_nodes(mesh, row, options.text("NEW SET"), labels, read_placement(block).move(points))


def generate_elements(mesh: LocalMesh, block: Block) -> None:
    """Generate rows, rows of rows and layers of a master element by *ELGEN."""
    for row in block.rows():
        master = row.integer(0, "master element")
        kind, nodes = mesh.element(master, row.source)
        if master in mesh.orienting:
            raise row.error(f"element {master} has an additional node that gives n1, which cannot be generated here")
        labels, shifts = np.array([master]), np.array([0])
        for start in (1, 4, 7):
            count = row.integer(start, "number of elements", 1)
            node_step = row.integer(start + 1, "node increment", 1)
            step = row.integer(start + 2, "element increment", 1)
            if count < 1:
                raise row.error(f"{count} elements in one direction cannot be generated")
            mesh.reserve((count - 1) * len(labels), "elements", row)
            labels = (labels[None, :] + np.arange(count)[:, None] * step).ravel()
            shifts = (shifts[None, :] + np.arange(count)[:, None] * node_step).ravel()
        if labels.min() < 1 or labels.max() > LARGEST_LABEL or np.any(nodes + shifts.min() < 1):
            raise row.error(f"generates element or node numbers outside 1 to {LARGEST_LABEL}")
        new = slice(1, None)
        run = ElementRun(kind, labels[new], nodes[None, :] + shifts[new, None], _always(row.source))
        mesh.add_elements(run)
        mesh.add_to_set(mesh.elsets, block.options.text("ELSET"), [Members("", labels, row.source)])


GENERATORS: tuple[tuple[Keyword, Callable[[LocalMesh, Block], None]], ...] = (
    (
        Keyword(
            "NGEN",
            "Generate nodes on a line between two nodes.",
            Where.MODEL,
            (TAKES_NODES, one_of("LINE", "shape of the line", ("S",), refused=("C", "P")), *refused("SYSTEM")),
            "first node, last node, increment",
        ),
        generate_nodes,
    ),
    (
        Keyword(
            "NFILL",
            "Fill the region between two node sets with lines of nodes.",
            Where.MODEL,
            (TAKES_NODES, *refused("BIAS", "SINGULAR", "TWO STEP")),
            "first set, second set, number of intervals, increment of node numbers",
        ),
        fill_nodes,
    ),
    (
        Keyword(
            "NCOPY",
            "Copy a node set.",
            Where.MODEL,
            (
                Option("CHANGE NUMBER", Kind.INTEGER, "added to the node numbers", required=True),
                Option("OLD SET", Kind.NAME, "set to copy", required=True),
                Option("NEW SET", Kind.NAME, "set that takes the copies"),
                Option("SHIFT", doc="translate and rotate the copies", required=True),
                *refused("MULTIPLE", "POLE", "REFLECT"),
            ),
            "translation; then two points of an axis and an angle in degrees",
        ),
        copy_nodes,
    ),
    (
        Keyword(
            "ELGEN",
            "Generate elements from a master element, in rows, rows of rows and layers.",
            Where.MODEL,
            (TAKES_ELEMENTS, *refused("ALL NODES")),
            "master element, then count, node increment, element increment of each direction",
        ),
        generate_elements,
    ),
)
"""Keywords and their readers."""

KEYWORDS = tuple(keyword for keyword, _ in GENERATORS)
