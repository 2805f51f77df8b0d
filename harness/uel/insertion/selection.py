# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Selection of the faces to cut, of the solid below each, and of initial cracks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uel.errors import UsageError
from uel.insertion.assembly import Deck
from uel.insertion.cut import NONE, mask_of
from uel.model.arrays import IntArray

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class CutRequest:
    """Faces to cut, by the names of the command line.

    between   pairs of element sets: the first one is below
    surfaces  surfaces of elements, which are below
    nodes     node sets: faces with all nodes in one set
    plies     element sets from bottom to top, cut between any two of them; (): the sets of the sections; None: no plies
    inside    element sets, cut between all their elements
    crack     sets or surfaces whose cut faces get no elements, or with `contact` such that have failed
    contact   whether the faces of the crack press and rub on each other
    """

    between: Sequence[tuple[str, str]] = ()
    surfaces: Sequence[str] = ()
    nodes: Sequence[str] = ()
    plies: Sequence[str] | None = None
    inside: Sequence[str] = ()
    crack: Sequence[str] = ()
    contact: bool = False


@dataclass(slots=True)
class Selection:
    """Faces by their pairs in `Solids.pairs`.

    cuts       (pairs,) mask of separated pairs
    crack      (pairs,) mask of pairs of an initial crack
    below      (pairs,) 0 or 1: face of the pair in the solid below
    plies      cut pairs of plies, and their numbers of faces
    branching  (pairs,) mask of faces between plies with an edge, in the plane a node, common to two others
    """

    cuts: Mask
    crack: Mask
    below: IntArray
    oriented: Mask = field(repr=False)
    plies: list[tuple[str, str, int]] = field(default_factory=list)
    branching: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))

    def add(self, which: Mask, below: IntArray | None = None) -> None:
        """Add faces to cut; `below` applies to those without a direction."""
        if below is not None:
            new = which & ~self.oriented
            self.below[new] = below[new]
            self.oriented |= which
        self.cuts |= which


def select(deck: Deck, request: CutRequest) -> Selection:
    """Select the faces of a request. Raises UsageError for an unknown name, or one without faces between solids."""
    solids = deck.solids
    sides = solids.element[solids.pairs]
    selection = Selection(
        np.zeros(len(sides), dtype=bool),
        np.zeros(len(sides), dtype=bool),
        _upwards(deck),
        np.zeros(len(sides), dtype=bool),
    )
    for lower, upper in request.between:
        first, second = (_solids(deck, name, "--between") for name in (lower, upper))
        if np.any(first & second):
            shared = deck.name(int(np.argmax(first & second)))
            raise UsageError(f"--between {lower} {upper}: element {shared} is in both sets")
        forward, backward = first[sides[:, 0]] & second[sides[:, 1]], first[sides[:, 1]] & second[sides[:, 0]]
        _take(selection, f"--between {lower} {upper}", forward | backward, backward.astype(np.int64))
    for name in request.surfaces:
        faces = _surface(deck, name, "--surface")
        _take(selection, f"--surface {name}", faces[:, 0] | faces[:, 1], (~faces[:, 0]).astype(np.int64))
    for name in request.nodes:
        nodes = deck.nodes_of(name, "--nodes")
        if nodes is None:
            raise deck.unknown("--nodes", "node set", name, deck.flat.nsets)
        _take(selection, f"--nodes {name}", _within(deck, nodes))
    for name in request.inside:
        inside = _solids(deck, name, "--all")
        _take(selection, f"--all {name}", inside[sides].all(axis=1))
    if request.plies is not None:
        plies, names = _plies(deck, request.plies)
        ply = plies[sides]
        different = (ply[:, 0] != ply[:, 1]) & np.all(ply != NONE, axis=1)
        below = (ply[:, 0] > ply[:, 1]).astype(np.int64) if request.plies else None
        _take(selection, " ".join(["--plies", *request.plies]), different, below)
        pairs, counts = np.unique(np.sort(ply[different], axis=1), axis=0, return_counts=True)
        selection.plies = [(names[a], names[b], n) for (a, b), n in zip(pairs.tolist(), counts.tolist(), strict=True)]
        selection.branching = _meeting(deck, different)
    if request.contact and not request.crack:
        raise UsageError("--contact is between the faces of a crack: say where it is, by --crack SET")
    for name in request.crack:
        faces = _crack(deck, name) & selection.cuts
        if not faces.any():
            raise UsageError(f"--crack {name}: none of the faces that are cut is there")
        selection.crack |= faces
    return selection


def _take(selection: Selection, option: str, which: Mask, below: IntArray | None = None) -> None:
    if not which.any():
        raise UsageError(f"{option}: no two solids share a face there")
    selection.add(which, below)


def _upwards(deck: Deck) -> IntArray:
    """Return the lower solid of each pair by position: along z, if equal along y, then x."""
    solids = deck.solids
    centroids = solids.centroids[solids.element[solids.pairs]]
    ahead = centroids[:, 1] - centroids[:, 0]
    size = np.abs(ahead).max(axis=1, initial=0.0)
    below = np.zeros(len(ahead), dtype=np.int64)
    undecided = np.ones(len(ahead), dtype=bool)
    for axis in (2, 1, 0):
        # smaller differences are rounding of the coordinates
        clear = undecided & (np.abs(ahead[:, axis]) > 1e-3 * size)
        below[clear] = (ahead[clear, axis] < 0.0).astype(np.int64)
        undecided &= ~clear
    return below


def _solids(deck: Deck, name: str, option: str) -> Mask:
    numbers = deck.solids_of(name, option)
    if numbers is None:
        raise deck.unknown(option, "element set", name, deck.flat.elsets)
    return mask_of(numbers, deck.solids.count)


def _within(deck: Deck, nodes: IntArray) -> Mask:
    """Return the mask of the pairs of faces with all nodes among these."""
    inside = mask_of(np.append(nodes, NONE), len(deck.solids.points) + 1)
    return np.asarray(inside[deck.solids.nodes[deck.solids.pairs[:, 0]]].all(axis=1))


def _surface(deck: Deck, name: str, option: str) -> Mask:
    """Return the mask (pairs, 2) of the faces in a surface of elements."""
    at = deck.surface(name, option)
    if at is None:
        raise deck.unknown(option, "surface", name, deck.surface_names())
    block = at[1]
    if block.options.text("TYPE") != "ELEMENT":
        raise UsageError(f"{option} {name}: expected a surface of elements (TYPE=ELEMENT), see {block.source}")
    return np.asarray(deck.faces_of(*at)[deck.solids.pairs])


def _plies(deck: Deck, names: Sequence[str]) -> tuple[IntArray, Sequence[str]]:
    """Return the ply (solids,) of each solid, -1 for none, and the names of the plies."""
    ply_of = np.full(deck.solids.count, NONE)
    if not names:
        ply_of = deck.sections.copy()
        if len(np.unique(ply_of[ply_of != NONE])) < 2:
            raise UsageError("--plies: the deck has no two sections of solids; name the element sets of the plies")
        return ply_of, [f"{block.options.text('ELSET')} ({block.source})" for _, block in deck.section_blocks]
    for index, name in enumerate(names):
        inside = _solids(deck, name, "--plies")
        twice = inside & (ply_of != NONE)
        if twice.any():
            number = int(np.argmax(twice))
            raise UsageError(f"--plies: element {deck.name(number)} is in {names[ply_of[number]]} and in {name}")
        ply_of[inside] = index
    return ply_of, names


def _meeting(deck: Deck, cuts: Mask) -> Mask:
    """Return the mask of the faces of a cut with an edge, in the plane a node, common to two others."""
    solids = deck.solids
    rows = np.flatnonzero(cuts)
    faces = solids.pairs[rows, 0]
    corners = solids.corners[faces]
    edges, owners = [], []
    for count in np.unique(corners).tolist():
        here = rows[corners == count]
        nodes = solids.nodes[faces[corners == count], :count]
        ends = nodes[:, :, None] if count == 2 else np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=2)
        ends = np.sort(ends, axis=2).reshape(len(here) * count, -1)
        # edges, in the plane nodes
        edges.append(np.column_stack([ends[:, 0], ends[:, -1]]))
        owners.append(np.repeat(here, count))
    _, edge, counts = np.unique(np.concatenate(edges), axis=0, return_inverse=True, return_counts=True)
    return mask_of(np.concatenate(owners)[counts[edge.ravel()] > 2], len(cuts))


def _crack(deck: Deck, name: str) -> Mask:
    """Return the mask of the pairs of faces in a node set, at the elements of a set, or in a surface."""
    nodes = deck.nodes_of(name, "--crack")
    if nodes is not None:
        return _within(deck, nodes)
    if deck.surface(name, "--crack") is not None:
        faces = _surface(deck, name, "--crack")
        return faces[:, 0] | faces[:, 1]
    numbers = deck.solids_of(name, "--crack")
    if numbers is None:
        known = (deck.flat.nsets, deck.flat.elsets, deck.surface_names())
        raise deck.unknown("--crack", "node set, element set or surface", name, *known)
    return np.asarray(mask_of(numbers, deck.solids.count)[deck.solids.element[deck.solids.pairs]].any(axis=1))
