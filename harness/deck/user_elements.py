# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*USER ELEMENT, and what an element type name stands for."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from harness.deck.abaqus_elements import is_abaqus_element
from harness.deck.blocks import Block
from harness.deck.problems import nearest
from harness.errors import DeckError, Source
from harness.model.mesh import ElementGroup
from harness.model.properties import SpringSection, UserElement

PLANE = ("CPS", "CPE", "CAX")
"""Beginnings of the names of continuum elements that lie in a plane, CAX around direction 2."""
_PLANE_NODES = {"3": 3, "4": 4, "4R": 4, "6": 6, "8": 8, "8R": 8}
_SOLID_NODES = {
    **{f"{kind}{name}": nodes for kind in PLANE for name, nodes in _PLANE_NODES.items()},
    **{"C3D4": 4, "C3D8": 8, "C3D8R": 8, "C3D20": 20, "C3D20R": 20},
}
_COUPLED_NODES = {f"{name}T": nodes for name, nodes in _SOLID_NODES.items() if nodes != 6}
"""Continuum elements with temperatures at their corners."""
COHESIVE_NODES = {"COH2D4": 4, "COH3D8": 8}
BUILT_IN_NODES = {
    **_SOLID_NODES,
    **_COUPLED_NODES,
    **COHESIVE_NODES,
    **{"T2D2": 2, "T3D2": 2, "SPRING1": 1, "SPRING2": 2, "SPRINGA": 2, "MASS": 1},
}
_USER_TYPE = re.compile(r"U([1-9]\d{0,3})")
LARGEST_DOF = 30
MOST_NODES = 10_000
MOST_VALUES = 10_000_000

Definitions = Mapping[str, UserElement]


@dataclass(frozen=True, slots=True)
class ElementType:
    """Type name with the user element it stands for, None for a built-in element."""

    name: str
    definition: UserElement | None

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return self.definition.nodes if self.definition else BUILT_IN_NODES[self.name]

    @property
    def section(self) -> str:
        """Keyword that gives its properties."""
        if self.definition:
            return "UEL PROPERTY"
        if self.name in COHESIVE_NODES:
            return "COHESIVE SECTION"
        return next((keyword for keyword in ("SPRING", "MASS") if self.name.startswith(keyword)), "SOLID SECTION")


def dofs_of(name: str, definition: UserElement | None) -> set[int]:
    """Dofs of an element type."""
    if definition is not None:
        return {dof for _, dof in definition.dofs}
    displacements = {1, 2} if name.startswith((*PLANE, "COH2D", "T2D")) else {1, 2, 3}
    return displacements | {11} if name in _COUPLED_NODES else displacements


def _corners(name: str) -> int:
    """Corners of a built-in element, whose nodes come first."""
    return min(BUILT_IN_NODES[name], 4 if name.startswith(PLANE) else 8)


def dofs_by_node(count: int, groups: Sequence[ElementGroup]) -> list[set[int]]:
    """Dofs that elements use at each of `count` nodes."""
    found: list[set[int]] = [set() for _ in range(count)]
    for group in groups:
        for local in range(group.nodes.shape[1]):
            if group.definition is not None:
                dofs = {dof for node, dof in group.definition.dofs if node == local}
            elif isinstance(group.section, SpringSection) and group.section.dofs:
                dofs = {group.section.dofs[local]}
            else:
                dofs = dofs_of(group.type, None)
                if local >= _corners(group.type):
                    dofs -= {11}
            for node in group.nodes[:, local].tolist():
                found[node] |= dofs
    return found


def find_type(name: str, definitions: Definitions, source: Source) -> ElementType:
    """The element type of a name; DeckError where it is neither built in nor defined."""
    if name in BUILT_IN_NODES:
        return ElementType(name, None)
    if name in definitions:
        return ElementType(name, definitions[name])
    if _USER_TYPE.fullmatch(name):
        defined = ", ".join(definitions) or "none"
        raise DeckError(source, f"element type {name} is not defined by *USER ELEMENT (defined: {defined})")
    supported = f"(supported: {', '.join(BUILT_IN_NODES)} and user elements)"
    if is_abaqus_element(name):
        raise DeckError(source, f"element type {name} of Abaqus is not supported here {supported}")
    hint = nearest(name, [*BUILT_IN_NODES, *definitions])
    raise DeckError(source, f"element type {name} is not supported {supported}{hint}")


def read_user_element(block: Block) -> UserElement:
    """The definition a *USER ELEMENT gives."""
    options = block.options
    name = options.text("TYPE")
    match = _USER_TYPE.fullmatch(name)
    if match is None:
        raise block.error(f"TYPE={name}: expected Un with n from 1 to 9999")
    if options.given("INTEGRATION") != options.given("TENSOR"):
        raise block.error("INTEGRATION and TENSOR are given together or not at all")
    nodes = read_count(block, "NODES", 0, 1, MOST_NODES)
    return UserElement(
        number=int(match[1]),
        nodes=nodes,
        dofs=_read_dofs(block, nodes),
        source=block.source,
        coordinates=read_count(block, "COORDINATES", 1, 1, 3),
        properties=read_count(block, "PROPERTIES", 0, 0, MOST_VALUES),
        integer_properties=read_count(block, "I PROPERTIES", 0, 0, MOST_VALUES),
        variables=read_count(block, "VARIABLES", 1, 1, MOST_VALUES),
        unsymmetric=options.flag("UNSYMM"),
        integration=read_count(block, "INTEGRATION", 0, 0, MOST_VALUES),
        tensor=options.text("TENSOR"),
    )


def read_count(block: Block, name: str, default: int, least: int, most: int) -> int:
    """A number that an option gives. Raises DeckError where it is out of bounds."""
    value = block.options.integer(name, default)
    if not least <= value <= most:
        raise block.error(f"{name}={value}: expected a number from {least} to {most}")
    return value


def _read_dofs(block: Block, nodes: int) -> tuple[tuple[int, int], ...]:
    """(local node, dof) of each unknown.

    The first line holds the dofs from node 1 on, each later line `position, dofs` those from that position on. A
    position that does not exceed the one before begins another pass over the nodes.
    """
    passes: list[list[tuple[int, tuple[int, ...]]]] = []
    for row in block.rows():
        first = not passes
        position = 1 if first else row.integer(0, "node position")
        if not 1 <= position <= nodes:
            raise row.error(f"node position {position} of an element of {nodes} nodes")
        dofs = tuple(row.integer(index, "dof") for index in range(0 if first else 1, len(row)))
        if any(not 1 <= dof <= LARGEST_DOF for dof in dofs):
            raise row.error(f"a dof is a number from 1 to {LARGEST_DOF}")
        if first or position <= passes[-1][-1][0]:
            passes.append([])
        passes[-1].append((position, dofs))
    if not passes:
        raise block.error("needs a data line with the dofs at the first node")
    found: list[tuple[int, int]] = []
    for entries in passes:
        for (position, dofs), following in zip(entries, [*(entry[0] for entry in entries[1:]), nodes + 1], strict=True):
            found += [(node - 1, dof) for node in range(position, following) for dof in dofs]
    if len(set(found)) != len(found):
        node, dof = next(pair for pair in found if found.count(pair) > 1)
        raise block.error(f"dof {dof} is listed twice at node {node + 1}")
    if not found:
        raise block.error("no node has a dof")
    return tuple(found)
