# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Check of the solids that stabilised elements own, by `uel.elements.interfaces.neighbour_solids`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.steps.initial import read_initial_stresses, read_initial_values
from uel.elements.interfaces.neighbour_solids import (
    Finding,
    Neighbours,
    States,
    changed_temperatures,
    find_faults,
    initially_stressed,
    shell_fault,
)
from uel.errors import DeckError, all_of
from uel.insertion.assembly import Deck
from uel.insertion.connectivity import InterfaceType
from uel.insertion.sections import Sections
from uel.model.arrays import IntArray
from uel.model.element_types import BUILT_IN, ContinuumShellType
from uel.model.steps import Load


def check_neighbours(deck: Deck, sections: Sections, kind: InterfaceType, sides: IntArray) -> list[str]:
    """Check the solids that elements of a type will own; sides: (faces, 2) faces below and above.

    Returns warnings where results may be wrong. Raises DeckError where they would be wrong.
    """
    if not kind.solids:
        return []
    states = _read_states(deck)
    findings = {str(finding): finding for finding in _shells(deck, sections, kind, sides.ravel())}
    for neighbours in _neighbours(deck, sections, kind, sides.ravel()):
        findings |= {str(finding): finding for finding in find_faults(neighbours, states)}
    errors = [DeckError(finding.source, finding.message) for finding in findings.values() if finding.wrong]
    if errors:
        raise all_of(errors)
    return list(findings)


def _shells(deck: Deck, sections: Sections, kind: InterfaceType, faces: IntArray) -> Iterator[Finding]:
    """Find the continuum shells, whose sections are none of solids."""
    for number, type, rows in sections.kinds(faces):
        if number >= 0 and isinstance(BUILT_IN.get(type.name), ContinuumShellType):
            _, block = deck.section_blocks[number]
            name = deck.name(int(np.min(deck.solids.element[faces[rows]])))
            yield shell_fault(kind.jtype, type.name, name, block.source)


def _neighbours(deck: Deck, sections: Sections, kind: InterfaceType, faces: IntArray) -> Iterator[Neighbours]:
    for number, type, rows in sections.kinds(faces):
        section = sections.section(number, type) if number >= 0 else ""
        if isinstance(section, str):
            continue
        solids = np.unique(deck.solids.element[faces[rows]])
        group = next(each for each in deck.solids.cells if each.family.number == deck.solids.families[solids[0]])
        run, row = deck.run_of(int(solids[0]))
        yield Neighbours(
            kind.jtype,
            type.name,
            section,
            deck.name(int(solids[0])),
            run.run.source(row),
            deck.positions[solids],
            group.nodes[np.searchsorted(group.numbers, solids)],
        )


def _read_states(deck: Deck) -> States:
    """Return the temperatures and initial stresses of the first instances."""
    problems, root = Problems(), deck.structure.root
    initial = read_initial_values(root, "TEMPERATURE", deck.flat, problems, None)
    stresses = read_initial_stresses(root, deck.flat, problems)
    loads = [load for scope in deck.structure.steps for block in scope.blocks for load in _temperatures(deck, block)]
    problems.check()
    count = len(deck.flat.mesh.labels)
    return States(
        [(deck.node_of[nodes], source) for nodes, source in changed_temperatures(initial, loads, count)],
        [(deck.element_of[elements], source) for elements, source in initially_stressed(stresses)],
    )


def _temperatures(deck: Deck, block: Block) -> Iterator[Load]:
    """Yield the entries of *TEMPERATURE; an entry with an amplitude is treated like one of UTEMP."""
    if block.name != "TEMPERATURE":
        return
    varies = block.options.has("AMPLITUDE") or block.options.flag("USER")
    for row in block.rows():
        nodes = deck.flat.nodes(row.name(0, "node or node set"), row.source)
        yield Load(nodes, 0, row.real(1, "temperature", 0.0), None, row.source, user=varies)
