# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User elements, *USER ELEMENT and *UEL PROPERTY, and element type names."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.abaqus_elements import is_abaqus_element
from uel.deck.language.blocks import PER_LINE, Block
from uel.deck.language.numbers import LARGEST_INTEGER
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of, refused
from uel.deck.sections.element_names import read_names
from uel.errors import DeckError, Source
from uel.model.element_types import BUILT_IN, PLANES
from uel.model.mesh import ElementGroup
from uel.model.properties import Material, Orientation, SpringSection, UserElement, UserProperty

_USER_TYPE = re.compile(r"U([1-9]\d{0,3})")
LARGEST_DOF = 30
MOST_NODES = 10_000
MOST_VALUES = 10_000_000

Definitions = Mapping[str, UserElement]


@dataclass(frozen=True, slots=True)
class ElementType:
    """Element type name, with the definition of a user element, None for a built-in one."""

    name: str
    definition: UserElement | None

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return self.definition.nodes if self.definition else BUILT_IN[self.name].nodes

    @property
    def section(self) -> str:
        """Keyword that gives its properties."""
        return "UEL PROPERTY" if self.definition else BUILT_IN[self.name].section


def dofs_of(group: ElementGroup) -> set[int]:
    """Return the dofs of the element type of a group."""
    if group.definition is not None:
        return {dof for _, dof in group.definition.dofs}
    return set(BUILT_IN[group.type].dofs(0))


def dofs_by_node(count: int, groups: Sequence[ElementGroup]) -> list[frozenset[int]]:
    """Return the dofs that elements use at each of `count` nodes."""
    # one bit per dof, without a loop over elements
    bits_of_node = np.zeros(count, dtype=np.int64)
    for group in groups:
        for local in range(group.nodes.shape[1]):
            if group.definition is not None:
                dofs = {dof for node, dof in group.definition.dofs if node == local}
            elif isinstance(group.section, SpringSection) and group.section.dofs:
                dofs = {group.section.dofs[local]}
            else:
                dofs = set(BUILT_IN[group.type].dofs(local))
            bits_of_node[group.nodes[:, local]] |= sum(1 << dof for dof in dofs)
        if group.reference >= 0:
            bits_of_node[group.reference] |= sum(1 << dof for dof in PLANES)
    of_nodes = bits_of_node.tolist()
    sets = {bits: frozenset(dof for dof in range(1, LARGEST_DOF + 1) if bits >> dof & 1) for bits in set(of_nodes)}
    return [sets[bits] for bits in of_nodes]


_NEAREST: Final = 3
LISTED: Final = f"harness/uel/deck/keywords.md, *ELEMENT, lists all {len(BUILT_IN)} types"
"""Reference to the list of supported element types, for messages."""


def find_type(name: str, definitions: Definitions, source: Source) -> ElementType:
    """Return the element type of a name. Raises DeckError if it is neither built in nor defined."""
    if name in BUILT_IN:
        return ElementType(name, None)
    if name in definitions:
        return ElementType(name, definitions[name])
    if _USER_TYPE.fullmatch(name):
        defined = ", ".join(definitions) or "none"
        raise DeckError(source, f"element type {name} is not defined by *USER ELEMENT (defined: {defined})")
    near = difflib.get_close_matches(name, [*BUILT_IN, *definitions], n=_NEAREST, cutoff=0.6)
    fault = "of Abaqus is not supported here" if is_abaqus_element(name) else "is not supported"
    hint = f"; the nearest are {', '.join(near)}" if near else ""
    raise DeckError(source, f"element type {name} {fault}{hint}; {LISTED}")


def refuse_types(blocks: Sequence[Block], problems: Problems) -> None:
    """Report the first use of each unsupported type of Abaqus, for decks whose errors end the reading before."""
    seen: set[str] = set()
    for block in blocks:
        if block.name == "ELEMENT":
            with problems.gather():
                name = block.options.text("TYPE")
                if name not in seen and name not in BUILT_IN and is_abaqus_element(name):
                    seen.add(name)
                    find_type(name, {}, block.source)


def read_user_element(block: Block, problems: Problems) -> UserElement:
    """Read a *USER ELEMENT, with the names in its comments. Raises DeckError."""
    options = block.options
    name = options.text("TYPE")
    match = _USER_TYPE.fullmatch(name)
    if match is None:
        raise block.error(f"TYPE={name}: expected Un with n from 1 to 9999")
    if options.has("INTEGRATION") != options.has("TENSOR"):
        raise block.error("INTEGRATION and TENSOR are given together or not at all")
    nodes = read_count(block, "NODES", 0, 1, MOST_NODES)
    element = UserElement(
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
    return replace(element, names=read_names(block, element, problems))


def read_count(block: Block, name: str, default: int, least: int, most: int) -> int:
    """Read the integer value of an option. Raises DeckError if it is out of bounds."""
    value = block.options.integer(name, default)
    if not least <= value <= most:
        raise block.error(f"{name}={value}: expected a number from {least} to {most}")
    return value


def _read_dofs(block: Block, nodes: int) -> tuple[tuple[int, int], ...]:
    """Read (local node, dof) of each unknown. Raises DeckError.

    The first line has the dofs from node 1 on, each further line `position, dofs` those from that position on. A
    position not above the previous one starts another pass over the nodes.
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
    unknowns: list[tuple[int, int]] = []
    for entries in passes:
        for (position, dofs), following in zip(entries, [*(entry[0] for entry in entries[1:]), nodes + 1], strict=True):
            unknowns += [(node - 1, dof) for node in range(position, following) for dof in dofs]
    if len(set(unknowns)) != len(unknowns):
        node, dof = next(pair for pair in unknowns if unknowns.count(pair) > 1)
        raise block.error(f"dof {dof} is listed twice at node {node + 1}")
    if not unknowns:
        raise block.error("no node has a dof")
    return tuple(unknowns)


def read_user_property(
    block: Block,
    definition: UserElement,
    material: Material | None,
    orientation: Orientation | None,
    problems: Problems,
) -> UserProperty:
    """Read the values of a *UEL PROPERTY, reals first. Raises DeckError if the number of lines is wrong."""
    entries = block.entries(problems.warn)
    reals, integers = definition.properties, definition.integer_properties
    expected = reals + integers
    if len(entries) != expected:
        announced = f"PROPERTIES={reals}" + (f", I PROPERTIES={integers}" if integers else "")
        message = f"{len(entries)} values where U{definition.number} takes {expected} ({announced})"
        lines, needed = math.ceil(len(entries) / PER_LINE), math.ceil(max(expected, 1) / PER_LINE)
        if lines != needed:
            raise block.error(f"{message}; a line has eight values" if lines > needed else message)
        remedy = "those that are left are not passed to it" if len(entries) > expected else "the others are zero"
        problems.warn(block.source, f"*{block.name}: {message}; {remedy}")
        if entries:
            entries += [(entries[-1][0], index) for index in range(entries[-1][1] + 1, PER_LINE)]
        entries = entries[:expected]
    values = [row.real(index, f"property {index + 1}", 0.0) for row, index in entries[:reals]]
    integer_values = []
    for row, index in entries[reals:]:
        value = row.real(index, "integer property", 0.0)
        if value != int(value) or abs(value) > LARGEST_INTEGER:
            raise DeckError(row.source, f"*{block.name}: integer property {row.fields[index]} is not an integer")
        integer_values.append(int(value))
    return UserProperty(
        block.options.text("ELSET"),
        block.source,
        np.array(values, dtype=np.float64),
        np.array(integer_values, dtype=np.int64),
        material,
        orientation,
    )


KEYWORDS = (
    Keyword(
        "USER ELEMENT",
        "Introduce a user element type.",
        Where.MODEL,
        (
            Option("TYPE", Kind.NAME, "Un, 0 < n < 10000", required=True),
            Option("NODES", Kind.INTEGER, "nodes per element", required=True),
            Option("COORDINATES", Kind.INTEGER, "largest coordinate used (1)"),
            Option("PROPERTIES", Kind.INTEGER, "number of real properties (0)"),
            Option("I PROPERTIES", Kind.INTEGER, "number of integer properties (0)"),
            Option("VARIABLES", Kind.INTEGER, "number of solution-dependent variables (1)"),
            Option("UNSYMM", doc="the matrix is unsymmetric"),
            Option("INTEGRATION", Kind.INTEGER, "material points, with UELMAT"),
            one_of("TENSOR", "tensors, with UELMAT", ("THREED", "TWOD", "PSTRAIN", "PSTRESS")),
            *refused("LINEAR", "FILE", "OLD ELEMENT", "STEP"),
        ),
        "dofs at the first node; then node position, dofs from that node on",
        comments=(
            "names for output, such as `** VARIABLES: S11 [MPa], S22 [MPa], DAMAGE`, in one line or several; so "
            "`** PROPERTIES:` and `** I PROPERTIES:`. Names of VARIABLES are those of one integration point, and its "
            "points follow each other in SVARS; `-` is a variable without a name. Field output then has the named "
            "ones, as means over the points of an element, and *EL PRINT takes their names"
        ),
    ),
    Keyword(
        "UEL PROPERTY",
        "Properties of user elements; with MATERIAL=, UELMAT is called.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "element set", required=True),
            Option("MATERIAL", Kind.NAME, "material for MATERIAL_LIB_MECH"),
            Option("ORIENTATION", Kind.NAME, "orientation of the material"),
            *refused("ALPHA", "BETA"),
        ),
        "real properties, then integer properties, eight per line; missing values are zero",
    ),
)
