# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Selection of the faces to cut, of the solid below each, and of the cut faces that are an initial crack."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uel.errors import UsageError
from uel.insertion.assembly import Deck
from uel.insertion.cut import NONE
from uel.model.arrays import IntArray

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Wanted:
    """Places to cut, as the user names them.

    between   pairs of element sets: the first is below
    surfaces  surfaces of elements, which are below
    nodes     node sets: faces all of whose nodes are in one
    plies     element sets from the lowest to the highest, between any two of which is cut; () for the sets of the
              sections; None for no plies
    inside    element sets between all elements of which is cut
    crack     sets or surfaces: what is cut there gets no elements
    """

    between: Sequence[tuple[str, str]] = ()
    surfaces: Sequence[str] = ()
    nodes: Sequence[str] = ()
    plies: Sequence[str] | None = None
    inside: Sequence[str] = ()
    crack: Sequence[str] = ()


@dataclass(slots=True)
class Selection:
    """Faces by their pairs in `Solids.pairs`.

    cuts   (pairs,) which are separated
    crack  (pairs,) which of them get no element
    below  (pairs,) 0 or 1: which of the pair belongs to the solid below
    plies  between which plies is cut, and how many faces there
    meets  (pairs,) which of the faces between plies have an edge, in the plane a node, in common with two others
    """

    cuts: Mask
    crack: Mask
    below: IntArray
    oriented: Mask = field(repr=False)
    plies: list[tuple[str, str, int]] = field(default_factory=list)
    meets: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))

    def add(self, which: Mask, below: IntArray | None = None) -> None:
        """Cut along more faces; those that had no direction yet take this one."""
        if below is not None:
            new = which & ~self.oriented
            self.below[new] = below[new]
            self.oriented |= which
        self.cuts |= which


def select(deck: Deck, wanted: Wanted) -> Selection:
    """Find the faces that are wanted. Raises UsageError where a name is unknown or names no face between two solids."""
    solids = deck.solids
    sides = solids.element[solids.pairs]
    found = Selection(
        np.zeros(len(sides), dtype=bool),
        np.zeros(len(sides), dtype=bool),
        _upwards(deck),
        np.zeros(len(sides), dtype=bool),
    )
    for lower, upper in wanted.between:
        first, second = (_solids(deck, name, "--between") for name in (lower, upper))
        if np.any(first & second):
            shared = deck.name(int(np.argmax(first & second)))
            raise UsageError(f"--between {lower} {upper}: element {shared} is in both sets")
        forward, backward = first[sides[:, 0]] & second[sides[:, 1]], first[sides[:, 1]] & second[sides[:, 0]]
        _take(found, f"--between {lower} {upper}", forward | backward, backward.astype(np.int64))
    for name in wanted.surfaces:
        faces = _surface(deck, name, "--surface")
        _take(found, f"--surface {name}", faces[:, 0] | faces[:, 1], (~faces[:, 0]).astype(np.int64))
    for name in wanted.nodes:
        nodes = deck.nodes_of(name, "--nodes")
        if nodes is None:
            raise deck.unknown("--nodes", "node set", name, deck.flat.nsets)
        _take(found, f"--nodes {name}", _within(deck, nodes))
    for name in wanted.inside:
        inside = _solids(deck, name, "--all")
        _take(found, f"--all {name}", inside[sides].all(axis=1))
    if wanted.plies is not None:
        plies, names = _plies(deck, wanted.plies)
        ply = plies[sides]
        different = (ply[:, 0] != ply[:, 1]) & np.all(ply != NONE, axis=1)
        below = (ply[:, 0] > ply[:, 1]).astype(np.int64) if wanted.plies else None
        _take(found, " ".join(["--plies", *wanted.plies]), different, below)
        pairs, counts = np.unique(np.sort(ply[different], axis=1), axis=0, return_counts=True)
        found.plies = [(names[a], names[b], n) for (a, b), n in zip(pairs.tolist(), counts.tolist(), strict=True)]
        found.meets = _meeting(deck, different)
    for name in wanted.crack:
        faces = _crack(deck, name) & found.cuts
        if not faces.any():
            raise UsageError(f"--crack {name}: none of the faces that are cut is there")
        found.crack |= faces
    return found


def _take(found: Selection, option: str, which: Mask, below: IntArray | None = None) -> None:
    if not which.any():
        raise UsageError(f"{option}: no two solids share a face there")
    found.add(which, below)


def _upwards(deck: Deck) -> IntArray:
    """Find which solid of each pair is below by its position: along z, where that is the same y, then x."""
    solids = deck.solids
    centroids = solids.centroids[solids.element[solids.pairs]]
    ahead = centroids[:, 1] - centroids[:, 0]
    size = np.abs(ahead).max(axis=1, initial=0.0)
    below = np.zeros(len(ahead), dtype=np.int64)
    undecided = np.ones(len(ahead), dtype=bool)
    for axis in (2, 1, 0):
        # smaller differences are those of the digits of the coordinates
        clear = undecided & (np.abs(ahead[:, axis]) > 1e-3 * size)
        below[clear] = (ahead[clear, axis] < 0.0).astype(np.int64)
        undecided &= ~clear
    return below


def _solids(deck: Deck, name: str, option: str) -> Mask:
    numbers = deck.solids_of(name, option)
    if numbers is None:
        raise deck.unknown(option, "element set", name, deck.flat.elsets)
    found = np.zeros(deck.solids.count, dtype=bool)
    found[numbers] = True
    return found


def _within(deck: Deck, nodes: IntArray) -> Mask:
    """Return the pairs of faces whose nodes all are among these."""
    inside = np.zeros(len(deck.solids.points) + 1, dtype=bool)
    inside[nodes] = True
    inside[NONE] = True
    found: Mask = inside[deck.solids.nodes[deck.solids.pairs[:, 0]]].all(axis=1)
    return found


def _surface(deck: Deck, name: str, option: str) -> Mask:
    """Mask the faces (pairs, 2) that belong to a surface of elements."""
    at = deck.surface(name, option)
    if at is None:
        raise deck.unknown(option, "surface", name, deck.surface_names())
    block = at[1]
    if block.options.text("TYPE") != "ELEMENT":
        raise UsageError(f"{option} {name}: expected a surface of elements (TYPE=ELEMENT), see {block.source}")
    found: Mask = deck.faces_of(*at)[deck.solids.pairs]
    return found


def _plies(deck: Deck, names: Sequence[str]) -> tuple[IntArray, Sequence[str]]:
    """Assign a ply to each solid, (solids,), -1 for none; return the plies' names too, as given or by section."""
    found = np.full(deck.solids.count, NONE)
    if not names:
        found = deck.sections.copy()
        if len(np.unique(found[found != NONE])) < 2:
            raise UsageError("--plies: the deck has no two sections of solids; name the element sets of the plies")
        return found, [f"{block.options.text('ELSET')} ({block.source})" for _, block in deck.section_blocks]
    for place, name in enumerate(names):
        inside = _solids(deck, name, "--plies")
        twice = inside & (found != NONE)
        if twice.any():
            number = int(np.argmax(twice))
            raise UsageError(f"--plies: element {deck.name(number)} is in {names[found[number]]} and in {name}")
        found[inside] = place
    return found, names


def _meeting(deck: Deck, cuts: Mask) -> Mask:
    """Mask of the faces of a cut that have an edge, in the plane a node, in common with two others of it."""
    solids = deck.solids
    rows = np.flatnonzero(cuts)
    faces = solids.pairs[rows, 0]
    corners = solids.corners[faces]
    found = np.zeros(len(cuts), dtype=bool)
    edges, owners = [], []
    for count in np.unique(corners).tolist():
        here = rows[corners == count]
        nodes = solids.nodes[faces[corners == count], :count]
        ends = nodes[:, :, None] if count == 2 else np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=2)
        ends = np.sort(ends, axis=2).reshape(len(here) * count, -1)
        # nodes of the plane stand for edges
        edges.append(np.column_stack([ends[:, 0], ends[:, -1]]))
        owners.append(np.repeat(here, count))
    _, which, counts = np.unique(np.concatenate(edges), axis=0, return_inverse=True, return_counts=True)
    found[np.concatenate(owners)[counts[which.ravel()] > 2]] = True
    return found


def _crack(deck: Deck, name: str) -> Mask:
    """Return the pairs of faces in a node set, at the elements of a set, or in a surface."""
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
    inside = np.zeros(deck.solids.count, dtype=bool)
    inside[numbers] = True
    found: Mask = inside[deck.solids.element[deck.solids.pairs]].any(axis=1)
    return found
