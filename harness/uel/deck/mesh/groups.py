# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements of the model: connectivity by node index, sections, and element groups in calling order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Where
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.mesh.local_mesh import ElementRun
from uel.deck.mesh.orientations import read_orientations
from uel.deck.sections.beams import BEAM_KEYWORDS, read_beam_shear
from uel.deck.sections.membranes import MEMBRANE_KEYWORD
from uel.deck.sections.shells import SHELL_KEYWORDS, read_shear_stiffness
from uel.deck.sections.solids import SECTION_KEYWORDS, make_section, reference_node
from uel.deck.sections.user_elements import ElementType
from uel.errors import DeckError, Source
from uel.model.arrays import IntArray
from uel.model.element_types import HOURGLASS_CONTROLLED
from uel.model.mesh import ElementGroup
from uel.model.properties import (
    BeamSection,
    CompositeSection,
    Material,
    MembraneSection,
    Section,
    SectionControls,
    ShellSection,
    SolidSection,
    SpringSection,
)


class _Elements:
    """Elements by position: type, row in the connectivity of the type, section keyword (-1: none)."""

    def __init__(self, flat: FlatMesh, problems: Problems) -> None:
        self.flat = flat
        self.types: list[ElementType] = []
        count = sum(len(owner.elements) for owner in flat.owners)
        self.type_of, self.row_of, self.section_of = (np.full(count, -1, dtype=np.int64) for _ in range(3))
        self._nodes: list[list[IntArray]] = []
        rows: list[int] = []
        for owner in flat.owners:
            for run in (run for run in owner.mesh.runs if len(run.labels)):
                with problems.gather():
                    nodes = node_indices(owner, run)
                    if run.type not in self.types:
                        self.types.append(run.type)
                        self._nodes.append([])
                        rows.append(0)
                    index = self.types.index(run.type)
                    positions = owner.find_elements(run.labels)
                    self.type_of[positions] = index
                    self.row_of[positions] = rows[index] + np.arange(len(positions))
                    self._nodes[index].append(nodes)
                    rows[index] += len(positions)

    def connectivity(self) -> list[IntArray]:
        """Return the node indices of all elements of each type."""
        return [np.concatenate(parts) for parts in self._nodes]


def node_indices(owner: Owner, run: ElementRun) -> IntArray:
    """Return the node indices (m, nodes) of the elements of a run. Raises DeckError for an undefined node."""
    indices = np.where(run.nodes < 0, -1 - run.nodes, owner.find_nodes(run.nodes.ravel()).reshape(run.nodes.shape))
    missing = np.argwhere(indices < 0)
    if len(missing):
        row, column = missing[0]
        others = len({int(row) for row, _ in missing}) - 1
        more = f"; {others} more elements here lack nodes" if others else ""
        message = f"element {run.labels[row]} uses node {run.nodes[row, column]}, which is not defined{more}"
        raise DeckError(run.source(int(row)), message)
    return indices


def make_groups(
    flat: FlatMesh, materials: Mapping[str, Material], controls: Mapping[str, SectionControls], problems: Problems
) -> tuple[ElementGroup, ...]:
    """Make the element groups, in the order in which Abaqus calls user elements; errors go to `problems`."""
    elements = _Elements(flat, problems)
    problems.check()
    sections: list[tuple[Block, Owner]] = []
    seen: dict[tuple[str, int], Block] = {}
    hourglass: dict[int, tuple[float, float, float]] = {}
    shear: dict[int, tuple[tuple[float, ...], float | None]] = {}
    for owner in flat.owners:
        for block in owner.blocks:
            with problems.gather():
                if block.name in SECTION_KEYWORDS:
                    _assign(elements, sections, block, owner)
                elif block.name == "HOURGLASS STIFFNESS":
                    section_number = _last_section(block, sections, "SOLID SECTION", *SHELL_KEYWORDS, MEMBRANE_KEYWORD)
                    _refuse_second(block, section_number, seen)
                    hourglass[section_number] = _hourglass_stiffness(block)
                elif block.name == "TRANSVERSE SHEAR STIFFNESS":
                    section_number = _last_section(block, sections, *SHELL_KEYWORDS, *BEAM_KEYWORDS)
                    _refuse_second(block, section_number, seen)
                    of_beam = sections[section_number][0].name in BEAM_KEYWORDS
                    shear[section_number] = read_beam_shear(block) if of_beam else read_shear_stiffness(block)
    problems.check()
    _check_assigned(elements, problems)
    problems.check()
    made = _make_sections(elements, sections, materials, controls, problems)
    problems.check()
    for (section, kind), section_made in made.items():
        controlled = SolidSection | CompositeSection | ShellSection | MembraneSection
        if section in hourglass and isinstance(section_made, controlled):
            control, rotation, drilling = hourglass[section]
            made[section, kind] = replace(section_made, hourglass=control)
            if isinstance(section_made, ShellSection):
                made[section, kind] = replace(
                    section_made, hourglass=control, hourglass_rotation=rotation, drilling=drilling
                )
    for (section, kind), section_made in made.items():
        if section in shear and isinstance(section_made, ShellSection | BeamSection):
            stiffness, slenderness = shear[section]
            made[section, kind] = replace(section_made, shear=stiffness, slenderness=slenderness)
    return _cut(elements, made)


def _refuse_second(block: Block, section: int, seen: dict[tuple[str, int], Block]) -> None:
    """Refuse a keyword that its section has already."""
    first = seen.setdefault((block.name, section), block)
    if first is not block:
        raise block.error(f"the section has one already, at {first.source}")


def _last_section(block: Block, sections: list[tuple[Block, Owner]], *names: str) -> int:
    if not sections or sections[-1][0].name not in names:
        raise block.error(f"does not follow *{' or *'.join(names)}")
    return len(sections) - 1


def _hourglass_stiffness(block: Block) -> tuple[float, float, float]:
    """Read the hourglass stiffnesses of displacements and rotations (0: default) and the drilling factor."""
    row = next(block.rows(), None)
    if row is None:
        return 0.0, 0.0, 1.0
    stiffness = row.real(0, "hourglass stiffness", 0.0)
    rotation = row.real(2, "rotational hourglass stiffness", 0.0)
    drilling = row.real(3, "factor of the drilling stiffness", 1.0) or 1.0
    for value in (stiffness, rotation, drilling):
        if value < 0:
            raise block.error(f"stiffness {value:g} must not be negative")
    return stiffness, rotation, drilling


def _assign(elements: _Elements, sections: list[tuple[Block, Owner]], block: Block, owner: Owner) -> None:
    if block.name == "RIGID BODY" and not block.options.has("ELSET"):
        return
    positions = elements.flat.elements(block.options.text("ELSET"), block.source, owner.name)
    if block.name == "RIGID BODY":
        # other elements of a rigid body have their own section
        kinds = np.array([kind.section == block.name for kind in elements.types])
        positions = positions[kinds[elements.type_of[positions]]]
    assigned = positions[elements.section_of[positions] >= 0]
    if len(assigned):
        other = sections[elements.section_of[assigned[0]]][0]
        label = elements.flat.element_name(int(assigned[0]))
        raise block.error(f"element {label} has a section already, by *{other.name} at {other.source}")
    elements.section_of[positions] = len(sections)
    sections.append((block, owner))


def _check_assigned(elements: _Elements, problems: Problems) -> None:
    """Report elements without a section, one error per type."""
    without = np.flatnonzero(elements.section_of < 0)
    for index, kind in enumerate(elements.types):
        lacking = without[elements.type_of[without] == index]
        if len(lacking):
            more = f" and {len(lacking) - 1} more of type {kind.name} have" if len(lacking) > 1 else " has"
            name = elements.flat.element_name(int(lacking[0]))
            message = f"element {name}{more} no section: no *{kind.section} refers to it"
            problems.add(_source(elements.flat, int(lacking[0])), message)


def _make_sections(
    elements: _Elements,
    sections: list[tuple[Block, Owner]],
    materials: Mapping[str, Material],
    controls: Mapping[str, SectionControls],
    problems: Problems,
) -> dict[tuple[int, int], Section]:
    """Make the section of each pair of section keyword and element type."""
    kinds = max(len(elements.types), 1)
    pairs = np.unique(elements.section_of * kinds + elements.type_of)
    orientations = read_orientations(elements.flat, problems)
    problems.check()
    made = {}
    for section, kind in (divmod(pair, kinds) for pair in pairs.tolist()):
        block, owner = sections[section]
        with problems.gather():
            type, axes = elements.types[kind], orientations[owner.name]
            made_section = make_section(block, type, materials, axes, controls, problems)
            if isinstance(made_section, SolidSection):
                find = partial(elements.flat.one_node, owner=owner.name)
                made_section = replace(made_section, reference=reference_node(block, type.name, find))
            made[section, kind] = _rotated(made_section, owner, problems)
    return made


def _rotated(section: Section, owner: Owner, problems: Problems) -> Section:
    """Return a section with its directions rotated with the instance."""
    if not owner.placement.rotates:
        return section
    if isinstance(section, BeamSection):
        x, y, z = owner.placement.turn(np.array(section.n1)).tolist()
        return replace(section, n1=(x, y, z))
    if isinstance(section, SpringSection) and section.dofs:
        dofs = ", ".join(map(str, section.dofs))
        message = f"dofs {dofs} are those of the global axes, which do not turn with instance {owner.name}"
        problems.warn(section.source, message)
    return section


def _cut(elements: _Elements, made: dict[tuple[int, int], Section]) -> tuple[ElementGroup, ...]:
    connectivity = elements.connectivity()
    groups = []
    for owner in elements.flat.owners:
        span = slice(owner.element_offset, owner.element_offset + len(owner.elements))
        types, sections, rows = elements.type_of[span], elements.section_of[span], elements.row_of[span]
        cuts = np.flatnonzero((np.diff(types) != 0) | (np.diff(sections) != 0)) + 1
        for span_rows in np.split(np.arange(len(types)), cuts) if len(types) else []:
            index, section = int(types[span_rows[0]]), int(sections[span_rows[0]])
            groups.append(
                ElementGroup(
                    type=elements.types[index].name,
                    labels=owner.elements[span_rows],
                    nodes=connectivity[index][rows[span_rows]],
                    instance=owner.name,
                    section=made[section, index],
                    definition=elements.types[index].definition,
                    source=_source(elements.flat, span.start + int(span_rows[0])),
                    orienting=_orienting(elements.flat, owner, owner.elements[span_rows], span.start + span_rows),
                )
            )
    return tuple(groups)


def _orienting(flat: FlatMesh, owner: Owner, labels: IntArray, positions: IntArray) -> IntArray | None:
    """Return the index of the additional node of each beam, for n1, -1 without; None if no beam has one."""
    orienting = owner.mesh.orienting
    if not orienting or not any(label in orienting for label in labels.tolist()):
        return None
    indices = np.full(len(labels), -1)
    for row, label in enumerate(labels.tolist()):
        node = orienting.get(label)
        if node is None:
            continue
        indices[row] = -1 - node if node < 0 else int(owner.find_nodes(np.array([node]))[0])
        if indices[row] < 0:
            message = f"element {label} uses node {node}, which is not defined"
            raise DeckError(_source(flat, int(positions[row])), message)
    return indices


def _source(flat: FlatMesh, position: int) -> Source:
    owner = flat.owner_of(position)
    label = int(owner.elements[position - owner.element_offset])
    run = owner.mesh.runs[owner.mesh.run_of[label]]
    return run.source(int(np.flatnonzero(run.labels == label)[0]))


KEYWORDS = (
    Keyword(
        "HOURGLASS STIFFNESS",
        f"Hourglass stiffness parameter r of {', '.join(HOURGLASS_CONTROLLED)} and those with temperatures, "
        "of the *SOLID SECTION before. With mean gradients B and volume V before any displacement the stiffness per "
        "squared hourglass displacement q is r V sum(B^2)/16 in the plane, in direction i of space 0.2357 r V "
        "sum(B_i^2); with NLGEOM F^T q takes the place of q, F the mean deformation gradient. Results of Abaqus R2018x "
        "and 2024 show it for square CPS4R, skewed CAX4RT and skewed C3D8RT; for CPE4R and skewed CPS4R it is inferred "
        "from CAX4RT. After *SHELL SECTION it is r_F G of S4R, whose rotations have r_theta G: "
        "the stiffness per squared hourglass displacement is r_F G t A sum(B^2)/16, "
        "per squared rotation 4 r_theta G t^3 A sum(B^2)/16, as "
        "public jobs of Abaqus show for rectangles. The hourglass modes of SC8R have the stiffness of an elastic shell "
        "with the shear modulus r/0.005 and a Poisson's ratio of zero. After *MEMBRANE SECTION it is that of M3D4R: "
        "that of CPS4R in its plane and, which is inferred, along its normal.",
        Where.MODEL,
        data="stiffness parameter in place of 0.005 times the shear modulus; empty; of shells that of rotations in "
        "place of 0.00375 times the shear modulus, and a factor of the drilling stiffness (1) of S4R",
    ),
)
