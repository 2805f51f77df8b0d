# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel insert`: from a deck or a mesh to a deck with interface elements."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uel.delamination.keywords import element_block, keyword
from uel.errors import DeckError, UsageError
from uel.insertion.assembly import Deck, Run
from uel.insertion.connectivity import (
    InterfaceType,
    attached,
    beside,
    element_nodes,
    face_nodes,
    face_normals,
    interface_types,
    known_types,
    recommended,
)
from uel.insertion.cut import NONE, Cells, Cut, cut, mask_of
from uel.insertion.directions import NAMES, Pair, choose_directions
from uel.insertion.initial_tractions import InitialTractions
from uel.insertion.meshes import is_mesh, read_mesh
from uel.insertion.neighbours import check_neighbours
from uel.insertion.properties import (
    check_values,
    definition_lines,
    element_values,
    material_lines,
    names_of,
    property_lines,
    read_values,
)
from uel.insertion.rewriting import Rewriting, quoted
from uel.insertion.sections import Faces, Sections
from uel.insertion.selection import CutRequest, Selection, select
from uel.model.arrays import IntArray
from uel.model.element_types import BUILT_IN, DISCRETE, FAMILIES, ContinuumType

Items = tuple[tuple[str, float], ...]
"""Properties of an element by name."""
_ON_CRACK = "-CRACK"
"""Suffix of the name of the set of the elements on an initial crack."""


@dataclass(frozen=True, slots=True)
class Insertion:
    """Result of an insertion.

    kinds       number of elements of each type
    doubled     number of new nodes
    crack       number of faces of the initial crack
    contact     number of elements on them
    closed      number of faces without duplicated nodes, which get no element
    warnings    warnings of the deck and of the insertion
    plies       cut pairs of plies, and their numbers of faces
    """

    kinds: Mapping[str, int]
    doubled: int
    crack: int
    closed: int
    warnings: tuple[str, ...]
    plies: tuple[tuple[str, str, int], ...] = ()
    contact: int = 0

    @property
    def elements(self) -> int:
        """Number of elements of all types."""
        return sum(self.kinds.values())

    def lines(self, elset: str) -> list[str]:
        """Return the report to the user."""
        lines = [f"warning: {warning}" for warning in self.warnings]
        lines += [
            f"--plies: cut between {lower} and {upper}: {count} face{'s' * (count != 1)}"
            for lower, upper, count in self.plies
        ]
        if self.closed:
            lines.append(
                f"warning: {self.closed} faces get no element: the mesh around them holds all their nodes together"
            )
        made = ", ".join(f"{count} elements {kind}" for kind, count in self.kinds.items())
        made = f"{made} in {elset}" if made else "no elements"
        crack = f", {self.crack} faces of an initial crack" if self.crack else ""
        if self.contact:
            crack = f", {self.contact} of them on an initial crack"
        return [*lines, f"{made}{crack}, {self.doubled} nodes doubled"]


@dataclass(frozen=True, slots=True)
class _Interface:
    """Elements of one type.

    sides       (elements, 2) faces of the solids below and above
    properties  rows of the elements by the properties that they have in common
    """

    kind: InterfaceType
    sides: IntArray
    properties: Mapping[Items, IntArray]


def insert(
    files: Sequence[Path],
    request: CutRequest,
    *,
    element: str = "",
    elset: str = "INTERFACE",
    solids: Sequence[str] = (),
    values: Sequence[str] = (),
) -> tuple[str, Insertion]:
    """Write the deck with interface elements.

    Parameters
    ----------
    files
        A deck; or a mesh, with or without a deck for its sections, steps and so on.
    request
        Faces to cut.
    element
        Type of the interface elements; '' for the recommended one at each face.
    elset
        Element set of the interface elements.
    solids
        Continuum element types for the cells of a mesh.
    values
        Properties of the interface elements, NAME=VALUE.

    Raises
    ------
    UelError
        With the option, or the location in the deck.
    """
    properties_given = read_values(values)
    deck = _read(files, solids)
    selection = select(deck, request)
    if not selection.cuts.any():
        raise UsageError("say where: --between, --surface, --nodes, --plies or --all")
    cut_mesh = cut(deck.solids, selection.cuts)
    chosen, cracked, closed = _with_elements(deck, selection, cut_mesh, contact=request.contact)
    if not len(chosen) and not selection.crack.any():
        raise UsageError("no face gets an element: nothing there can open")
    warnings: list[str] = []
    interfaces: list[_Interface] = []
    if len(chosen):
        sections = Sections(deck)
        tractions = InitialTractions(deck, sections)
        kinds = _kinds(deck, chosen, element)
        for kind, rows in kinds.items():
            check_values(kind, properties_given)
            if cracked[rows].any() and "CRACKED" not in names_of(kind):
                raise UsageError(f"--contact: {kind.name} cannot fail from the start, the elements of the project can")
            warnings += check_neighbours(deck, sections, kind, chosen[rows])
        pairs = [_two_sides(deck, chosen[rows]) for rows in kinds.values()]
        for (kind, rows), pair in zip(kinds.items(), _directed(kinds, sections, pairs, properties_given), strict=True):
            values_of = _values(kind, sections, pair, cracked[rows], tractions, properties_given)
            interfaces.append(_Interface(kind, chosen[rows], values_of))
        warnings += sections.warnings
    if request.plies is not None and not request.plies:
        warnings += _meeting(deck, selection)
    rewriting = Rewriting(deck, cut_mesh)
    rewriting.write_nodes()
    rewriting.write_elements(_changed(deck, cut_mesh, warnings))
    rewriting.write_sets()
    rewriting.write_nodal_lines()
    rewriting.write_equations()
    if interfaces:
        _write_interfaces(deck, rewriting, cut_mesh, interfaces, elset)
    done = Insertion(
        {each.kind.name: len(each.sides) for each in interfaces},
        len(cut_mesh.origins),
        int(np.sum(selection.crack)),
        closed,
        (*deck.warnings, *warnings, *_ties(deck, cut_mesh)),
        tuple(selection.plies),
        int(np.sum(cracked)),
    )
    return rewriting.text(), done


def _read(files: Sequence[Path], solids: Sequence[str]) -> Deck:
    meshes = [file for file in files if is_mesh(file)]
    if len(files) > 2 or meshes[1:] or (len(files) == 2 and meshes != [files[0]]):
        raise UsageError("expected one deck, one mesh, or a mesh and then a deck with what belongs to it")
    if solids and not meshes:
        raise UsageError("--solids is for meshes: a deck says what its elements are")
    return Deck(files, {file: read_mesh(file, solids) for file in meshes})


def _meeting(deck: Deck, selection: Selection) -> list[str]:
    """Return a warning where cuts between sections intersect, since the section changes within a ply."""
    faces = np.flatnonzero(selection.branching)
    if not len(faces):
        return []
    first, second = (deck.name(int(deck.solids.element[face])) for face in deck.solids.pairs[faces[0]])
    return [
        f"--plies: cuts between sections meet at {len(faces)} faces, the first between elements {first} and {second}: "
        "where the section of a ply changes along it, the ply is cut across; name the element sets of whole plies to "
        "cut between them alone (--plies PLY1 PLY2 ...)"
    ]


def _with_elements(
    deck: Deck, selection: Selection, cut_mesh: Cut, *, contact: bool
) -> tuple[IntArray, NDArray[np.bool_], int]:
    """Return the faces below and above, (faces, 2), of the elements, which (faces,) of these are on a crack, and the
    number of faces that cannot open.
    """
    pairs = deck.solids.pairs
    order = np.stack([selection.below, 1 - selection.below], axis=1)
    wanted = selection.cuts & (contact | ~selection.crack)
    sides = np.take_along_axis(pairs, order, axis=1)[wanted]
    opens = mask_of(cut_mesh.origins, len(deck.solids.points) + 1)[deck.solids.nodes[sides[:, 0]]].any(axis=1)
    return sides[opens], selection.crack[wanted][opens], int(np.sum(~opens))


def _kinds(deck: Deck, sides: IntArray, name: str) -> dict[InterfaceType, IntArray]:
    """Return the requested or recommended element types with their rows.

    Raises UsageError for an unknown type, DeckError for one that does not fit.
    """
    known = interface_types()
    if name and name.upper() not in known:
        reason = ""
        if name.upper() in known_types():
            reason = f": {name.upper()} knows its neighbours by their numbers, which no mesh promises"
        raise UsageError(f"--element {name}: expected one of {', '.join(known)}{reason}")
    solids = deck.solids
    numbers = solids.element[sides]
    for number in numbers.ravel()[np.unique(deck.run_index[numbers], return_index=True)[1]].tolist():
        built_in = BUILT_IN.get(deck.run_of(number)[0].run.type.name)
        if isinstance(built_in, ContinuumType) and built_in.axisymmetric:
            raise deck.error(number, "is axisymmetric, and no interface element here is")
    families = {family.number: family for family in FAMILIES.values()}
    flat = solids.cells[0].family.dimension - 1
    combinations, which = np.unique(
        np.column_stack([solids.sizes[sides[:, 0]], solids.families[numbers]]), axis=0, return_inverse=True
    )
    kinds: dict[InterfaceType, list[IntArray]] = {}
    for index, (size, below, above) in enumerate(combinations.tolist()):
        rows = np.flatnonzero(which.ravel() == index)
        first = int(numbers[rows[0], 0])
        face = FAMILIES[flat, size]
        kind = known[name.upper()] if name else recommended(face, families[below], families[above])
        if kind.face is not face:
            message = f"has a face of {face.nodes} nodes there; {kind.name} fits between faces of {kind.face.nodes}"
            raise deck.error(first, message)
        if kind.solids and kind.solids != (families[below], families[above]):
            owned = " and ".join(str(each.nodes) for each in kind.solids)
            message = f"{kind.name} owns the solids on both sides, which need {owned} nodes"
            raise deck.error(first, message)
        kinds.setdefault(kind, []).append(rows)
    return {kind: np.sort(np.concatenate(rows)) for kind, rows in kinds.items()}


def _changed(deck: Deck, cut_mesh: Cut, warnings: list[str]) -> dict[int, IntArray]:
    """Return the new connectivity of elements with duplicated nodes, by position; adds to the warnings."""
    connectivity: dict[int, IntArray] = {}
    for before, after in zip(deck.solids.cells, cut_mesh.cells, strict=True):
        rows = np.flatnonzero(np.any(before.nodes != after.nodes, axis=1))
        connectivity |= dict(zip(deck.positions[before.numbers[rows]].tolist(), after.nodes[rows], strict=True))
    doubled = mask_of(cut_mesh.origins, len(deck.solids.points))
    cells = {group.family.number: group for group in cut_mesh.cells}
    for run in (run for run in deck.runs if run.run.type.name not in DISCRETE):
        rows = np.flatnonzero(doubled[run.nodes].any(axis=1))
        if np.any(run.run.nodes[rows] < 0):
            row = int(rows[np.argmax(np.any(run.run.nodes[rows] < 0, axis=1))])
            raise _unknown_element(run, row, "nodes of instances, in an element of the assembly, cannot be doubled")
        if len(rows) and run.family is None:
            kind = _interface_type(run)
            if run.face is not None:
                nodes, lost = _on_faces(deck, run, rows, cells, warnings)
            elif kind is not None:
                nodes, lost = attached(kind, deck.solids, run.nodes[rows], cells)
            else:
                nodes, lost = run.nodes[rows], np.ones(len(rows), dtype=bool)
            if lost.any():
                row = int(rows[np.argmax(lost)])
                reason = "neither a solid of this program nor an interface element between two of them"
                if run.face is not None:
                    reason = "it lies on no face, or on one that is cut"
                raise _unknown_element(run, row, f"it is not known on which side it is: {reason}")
            connectivity |= dict(zip(run.positions[rows].tolist(), nodes, strict=True))
    return connectivity


def _on_faces(
    deck: Deck, run: Run, rows: IntArray, cells: Mapping[int, Cells], warnings: list[str]
) -> tuple[IntArray, NDArray[np.bool_]]:
    """Return the new nodes of shells and the like on faces of solids, and the mask of those on no unique side.

    Elements without a section, groups of faces of a mesh, stay on the old nodes.
    """
    assert run.face is not None
    solids, nodes = deck.solids, run.nodes[rows]
    first = solids.faces_at(nodes[:, : run.face.corners])
    on = first != NONE
    partner = np.arange(len(solids.element))
    partner[solids.pairs] = solids.pairs[:, ::-1]
    new_nodes, lost = nodes.copy(), ~on
    if on.any():
        new_nodes[on] = beside(solids, first[on], nodes[on], cells)
        other = beside(solids, partner[first[on]], nodes[on], cells)
        lost[on] = (new_nodes[on] != other).any(axis=1)
    without = deck.lacks_section(run.positions[rows])
    stay = lost & without
    if stay.any():
        row = int(rows[np.argmax(stay)])
        warnings.append(
            f"{run.run.source(row)}: {int(stay.sum())} elements {run.run.type.name} without a section, such as "
            f"element {int(run.run.labels[row])}, are on faces that are cut: they stay on the old nodes"
        )
        new_nodes[stay] = nodes[stay]
    return new_nodes, lost & ~without


def _interface_type(run: Run) -> InterfaceType | None:
    """Return the type of a run of interface elements, None for others."""
    kind = known_types().get(run.run.type.name)
    return kind if kind is not None and kind.nodes == run.run.type.nodes else None


def _unknown_element(run: Run, row: int, reason: str) -> DeckError:
    label = int(run.run.labels[row])
    return DeckError(run.run.source(row), f"element {label} ({run.run.type.name}) has a node that is doubled; {reason}")


def _write_interfaces(
    deck: Deck, rewriting: Rewriting, cut_mesh: Cut, interfaces: Sequence[_Interface], elset: str
) -> None:
    """Write elements, sets and properties, part by part."""
    cells = {group.family.number: group for group in cut_mesh.cells}
    number = int(max(other.elements.max() for other in deck.owners if len(other.elements))) + 1
    for owner in deck.first.values():
        groups = []
        for each in interfaces:
            positions = deck.positions[deck.solids.element[each.sides[:, 0]]]
            inside = (positions >= owner.element_offset) & (positions < owner.element_offset + len(owner.elements))
            nodes = element_nodes(each.kind, deck.solids, each.sides[:, 0], each.sides[:, 1], cells)
            groups += [
                (each.kind, dict(items), nodes[rows[inside[rows]]])
                for items, rows in each.properties.items()
                if inside[rows].any()
            ]
        if not groups:
            continue
        if elset.upper() in owner.mesh.elsets:
            raise UsageError(f"--elset {elset}: the deck has an element set of this name; give another one")
        names = [elset.upper()] if len(groups) == 1 else [f"{elset.upper()}-{k}" for k in range(1, len(groups) + 1)]
        lines = ["** interface elements, by uel insert"]
        for kind in dict.fromkeys(kind for kind, _, _ in groups):
            definition = owner.mesh.definitions.get(kind.name)
            if definition is not None and definition.nodes != kind.nodes:
                raise UsageError(f"--element {kind.name}: the deck defines another {kind.name}, at {definition.source}")
            lines += definition_lines(kind) if definition is None else []
        properties: list[str] = []
        first = number
        for name, (kind, items, nodes) in zip(names, groups, strict=True):
            lines += element_block(kind.name, quoted(name), rewriting.labels(nodes), first)
            first += len(nodes)
            properties += property_lines(kind, quoted(name), quoted(elset), items)
        if len(names) > 1:
            lines += [keyword("ELSET", ELSET=quoted(elset)), *map(quoted, names)]
        on_crack = [name for name, (_, items, _) in zip(names, groups, strict=True) if items.get("CRACKED")]
        if on_crack:
            if f"{elset.upper()}{_ON_CRACK}" in owner.mesh.elsets:
                raise UsageError(f"--elset {elset}: the deck has an element set {elset.upper()}{_ON_CRACK}")
            lines += [keyword("ELSET", ELSET=quoted(f"{elset.upper()}{_ON_CRACK}")), *map(quoted, on_crack)]
        rewriting.after_elements(owner, [*lines, *properties])
    for each in interfaces:
        rewriting.after_model(material_lines(each.kind, quoted(elset), dict(next(iter(each.properties)))))


def _directed(
    kinds: Iterable[InterfaceType], sections: Sections, pairs: Sequence[Pair], properties: Mapping[str, float]
) -> list[Pair]:
    """Return the faces below and above the elements of each type with the directions for the angles of their plies."""
    directed = list(pairs)
    rows = [row for row, kind in enumerate(kinds) if set(NAMES) <= set(names_of(kind))]
    found = choose_directions(sections, [pairs[row] for row in rows], properties)
    for row, directions in zip(rows, found, strict=True):
        below, above = pairs[row]
        directed[row] = replace(below, directions=directions), replace(above, directions=directions)
    return directed


def _values(
    kind: InterfaceType,
    sections: Sections,
    sides: Pair,
    cracked: NDArray[np.bool_],
    tractions: InitialTractions,
    properties: Mapping[str, float],
) -> dict[Items, IntArray]:
    """Return the rows of elements by their properties; cracked: (elements,) mask of those on a crack."""
    (below, first), (above, second) = (sections.sides(faces) for faces in sides)
    groups: dict[Items, list[IntArray]] = {}
    initial = tractions.at(sides) if kind.solids else np.zeros((len(cracked), 0))
    alike = np.column_stack([cracked, first, second, sides[0].directions, initial])
    unique, number = np.unique(alike, axis=0, return_inverse=True)
    for index, (crack, lower, upper, *vectors) in enumerate(unique.tolist()):
        rows = np.flatnonzero(number.ravel() == index)
        direction, traction = vectors[:3], vectors[3:]
        given = {**properties, **(dict(zip(NAMES, direction, strict=True)) if any(direction) else {})}
        given |= dict(zip(tractions.names, traction, strict=True)) if any(traction) else {}
        given |= {"CRACKED": 1.0} if crack else {}
        values = element_values(kind, given, below[int(lower)], above[int(upper)])
        groups.setdefault(tuple(values.items()), []).append(rows)
    return {items: np.sort(np.concatenate(rows)) for items, rows in groups.items()}


def _two_sides(deck: Deck, sides: IntArray) -> tuple[Faces, Faces]:
    """Return the faces of the solids below and above."""
    solids = deck.solids
    corners = face_nodes(solids, sides[:, 0])[:, : int(solids.corners[sides[0, 0]])]
    normals = face_normals(solids.points[corners])
    none = np.zeros_like(normals)
    return Faces(sides[:, 0], normals, none, above=False), Faces(sides[:, 1], normals, none, above=True)


def _ties(deck: Deck, cut_mesh: Cut) -> list[str]:
    """Return warnings of ties to a cut surface, where a tied node follows one of two coincident nodes."""
    doubled = mask_of(cut_mesh.origins, len(deck.solids.points) + 1)
    warnings = []
    for row in (row for block in deck.blocks if block.name == "TIE" for row in block.rows()):
        surface = deck.surface(row.name(1, "surface"), f"{row.source}: *TIE")
        if surface is None or surface[1].options.text("TYPE") != "ELEMENT":
            continue
        if doubled[deck.solids.nodes[deck.faces_of(*surface)]].any():
            name = row.name(1, "surface")
            warnings.append(
                f"{row.source}: *TIE: nodes of {name} are doubled; a node tied there follows one of each two"
            )
    return warnings
