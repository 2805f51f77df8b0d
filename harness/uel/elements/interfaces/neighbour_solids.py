# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solids beside which a self-contained interface element is wrong or doubtful.

Those that own their solids compute their traction themselves: from the displacements of all their nodes, with the
formulation, the elastic constants, the expansion and the traction of the initial stress among their properties. So they
do not know what else makes a stress in a solid: inelastic strains, the strain normal to a plane, an electrical field, a
temperature that is an unknown, or an interpolation of its own. The standard elements have no such limits.

This is the only place that says beside what these elements can stand. `find_faults` is the rule; `examine` applies it
to a model that has the elements, and `uel insert` to a deck before it has them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import TEMPERATURE
from uel.model.element_types import (
    BUILT_IN,
    HEX8,
    HEX20,
    QUAD4,
    QUAD8,
    ContinuumShellType,
    ContinuumType,
    Tensor,
)
from uel.model.mesh import ElementGroup, full_name
from uel.model.model import Model
from uel.model.properties import Material, Section, materials_of
from uel.model.steps import InitialStress, InitialValue, Load
from uel.usersub.layout import element_layouts

NONE = -1
"""Number for a solid that the model does not have."""
OBLIQUE: Final = 0.5
"""Degrees up to which axes of a material are those of an element that owns it: a fibre stress has sin(0.5 degrees),
0.9 %, of it as a traction."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Reason why interface elements do not have the traction of a solid beside them.

    message  what is wrong and what to do, without the place
    source   place in the deck
    wrong    True where results are wrong, False where they may be
    """

    message: str
    source: Source
    wrong: bool

    def __str__(self) -> str:
        return f"{self.source}: {self.message}"


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Solids of one type and section beside interface elements of one type.

    jtype     n of the interface elements Un
    type      of the solids: 'C3D8I'
    section   of the solids
    name      of the first of them, for messages
    source    its place in the deck
    elements  (m,) their positions in the model
    nodes     their nodes, indices into those of the model, in any shape
    """

    jtype: int
    type: str
    section: Section
    name: str
    source: Source
    elements: IntArray
    nodes: IntArray

    def joined(self, others: Neighbours) -> Neighbours:
        """Return these and other neighbours of the same type and section."""
        elements = np.concatenate([self.elements, others.elements])
        return replace(self, elements=elements, nodes=np.concatenate([self.nodes, others.nodes]))


@dataclass(frozen=True, slots=True)
class States:
    """Fields and initial states that a deck gives solids besides displacements.

    temperatures  nodes whose temperature changes, and the place that says so
    stresses      positions of elements whose initial stress varies within them, and its place
    """

    temperatures: Sequence[tuple[IntArray, Source]] = ()
    stresses: Sequence[tuple[IntArray, Source]] = ()


FORMULATIONS: Final = ("full integration", "incompatible modes", "the mean volume strain", "reduced integration")
"""Values of FORMULATION BOTTOM and TOP, in words."""
MODES: Final = 1
MEAN_VOLUME: Final = 2
REDUCED: Final = 3


def formulation_of(kind: ContinuumType) -> int:
    """Return the value of FORMULATION BOTTOM or TOP for a built-in element on that side."""
    if kind.incompatible:
        return MODES
    product = kind.family in (QUAD4, QUAD8, HEX8, HEX20)
    if product and kind.points < kind.family.full_points:
        return REDUCED
    if kind.family in (QUAD4, HEX8) and kind.tensor is not Tensor.PLANE_STRESS:
        return MEAN_VOLUME
    return 0


def owns_solids(group: ElementGroup) -> bool:
    """Return whether elements are interface elements of the project that own the solids on both sides.

    Those with another number of nodes do not: they are refused when they are called.
    """
    layout = None if group.definition is None else element_layouts().get(group.definition.number)
    return layout is not None and bool(layout.own) and group.nodes.shape[1] == layout.nodes


def standard_type(jtype: int) -> int:
    """Return n of the standard element Un between the faces of an interface element that owns its solids."""
    layout = element_layouts()[jtype]
    size = len(layout.faces[0])
    return next(
        other.jtype
        for other in element_layouts().values()
        if other.dimension == layout.dimension and len(other.faces[0]) == size and other.nodes == 2 * size
    )


def examine(model: Model, groups: Iterable[ElementGroup]) -> list[Finding]:
    """Examine the solids beside interface elements.

    Parameters
    ----------
    model
        The model.
    groups
        Those of its groups that are elements of the project; those that own no solids are left out.

    Returns
    -------
    list of Finding
        Each of them once; empty where the elements have the tractions of their solids.
    """
    states = States(_changes(model), initially_stressed(model.initial_stresses))
    starts = group_starts(model)
    owned: dict[int, IntArray] = {}
    for group in groups:
        if owns_solids(group):
            assert group.definition is not None
            jtype = group.definition.number
            others = owned.get(jtype, np.zeros(0, dtype=np.int64))
            owned[jtype] = np.unique(np.concatenate([others, *solids_of(model, group)]))
    found: dict[str, Finding] = {}
    for jtype, solids in owned.items():
        alike: dict[tuple[str, Source], Neighbours] = {}
        for start, beside in zip(starts, model.groups, strict=True):
            rows = solids[(solids >= start) & (solids < start + len(beside.labels))] - start
            if not len(rows):
                continue
            key = beside.type, beside.section.source
            name = full_name(beside.instance, int(beside.labels[rows[0]]))
            new = Neighbours(jtype, beside.type, beside.section, name, beside.source, start + rows, beside.nodes[rows])
            alike[key] = alike[key].joined(new) if key in alike else new
        for neighbours in alike.values():
            found |= {str(each): each for each in find_faults(neighbours, states)}
    return list(found.values())


def group_starts(model: Model) -> list[int]:
    """Return the position of the first element of each group."""
    sizes = [len(group.labels) for group in model.groups]
    starts: list[int] = np.cumsum([0, *sizes[:-1]]).tolist()
    return starts


def solids_of(model: Model, group: ElementGroup) -> tuple[IntArray, IntArray]:
    """Find the solids that interface elements own, by their nodes.

    Parameters
    ----------
    model
        The model.
    group
        Elements of the project that own their solids.

    Returns
    -------
    (m,), (m,)
        Positions in the model of the solids below and above, -1 where no solid has these nodes.
    """
    assert group.definition is not None
    below, above = element_layouts()[group.definition.number].solids
    return _with_nodes(model, group, slice(0, below)), _with_nodes(model, group, slice(below, below + above))


def _with_nodes(model: Model, group: ElementGroup, part: slice) -> IntArray:
    """Find the solids that have some of the nodes of each element of a group, whatever their order."""
    wanted = np.sort(group.nodes[:, part], axis=1)
    found = np.full(len(wanted), NONE)
    order = np.lexsort(wanted.T[::-1])
    for start, beside in zip(group_starts(model), model.groups, strict=True):
        if beside is group or beside.nodes.shape[1] != wanted.shape[1] or not _is_solid(beside):
            continue
        own = np.sort(beside.nodes, axis=1)
        rows, number = np.unique(np.concatenate([own, wanted[order]]), axis=0, return_inverse=True)
        position = np.full(len(rows), NONE)
        number = number.ravel()
        position[number[: len(own)]] = start + np.arange(len(own))
        there = position[number[len(own) :]]
        found[order[there != NONE]] = there[there != NONE]
    return found


def _is_solid(group: ElementGroup) -> bool:
    """Return whether elements are continuum elements, built in or of the project."""
    if group.definition is None:
        return isinstance(group.built_in, ContinuumType)
    return not owns_solids(group)


def changed_temperatures(
    initial: Iterable[InitialValue], given: Iterable[Load], count: int
) -> list[tuple[IntArray, Source]]:
    """Find the nodes whose temperature differs from the initial one.

    Parameters
    ----------
    initial
        *INITIAL CONDITIONS, TYPE=TEMPERATURE.
    given
        Predefined fields of all steps, of which the dof of temperatures is 0.
    count
        Number of nodes.

    Returns
    -------
    list of (nodes, place)
        For each *TEMPERATURE entry that changes the temperature of a node.
    """
    start: FloatArray = np.zeros(count)
    for value in initial:
        if value.dof == TEMPERATURE:
            start[value.nodes] = value.value
    found = []
    for entry in given:
        if entry.dof != 0:
            continue
        constant = entry.amplitude is None and not entry.user
        nodes = entry.nodes[start[entry.nodes] != entry.magnitude] if constant else entry.nodes
        if len(nodes):
            found.append((nodes, entry.source))
    return found


def _changes(model: Model) -> list[tuple[IntArray, Source]]:
    """Return the nodes of a model whose temperature differs from the initial one, with the place of each entry."""
    given = [entry for step in model.steps for entry in step.fields]
    return changed_temperatures(model.initial_temperatures, given, len(model.mesh.labels))


def changed_nodes(model: Model) -> IntArray:
    """Return the nodes of a model whose temperature differs from the initial one."""
    return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *(nodes for nodes, _ in _changes(model))]))


def initially_stressed(stresses: Iterable[InitialStress]) -> list[tuple[IntArray, Source]]:
    """Return the elements with initial stresses by SIGINI or GEOSTATIC, and the place of each entry."""
    return [(each.elements, each.source) for each in stresses if each.values is None or each.profile is not None]


def find_faults(solids: Neighbours, states: States) -> list[Finding]:
    """Find reasons for a traction of an interface element that differs from the stress of the solids beside it.

    Parameters
    ----------
    solids
        Of one type and section, beside elements that own them.
    states
        What the deck gives them.
    """
    found = [*_formulation(solids)]
    for material in {material.name: material for material in materials_of(solids.section)}.values():
        found += _material(solids, material)
        found += _temperature(solids, material, states)
    for elements, source in states.stresses:
        if np.isin(solids.elements, elements).any():
            message = f"{_type(solids)} takes an initial stress by components, and that of the {solids.type} beside it"
            found.append(Finding(f"{message} varies; {_instead(solids)}", source, wrong=True))
            break
    return found


def shell_fault(jtype: int, type: str, name: str, place: Source) -> Finding:
    """Return the finding about a continuum shell, its type and name, beside Un that owns its solids."""
    message = (
        f"{type} beside U{jtype} (element {name}) has the stresses of a shell, where U{jtype} takes those of a solid"
    )
    return Finding(f"{message}; {_standard(jtype)}", place, wrong=True)


def _type(solids: Neighbours) -> str:
    return f"U{solids.jtype}"


def _instead(solids: Neighbours) -> str:
    return _standard(solids.jtype)


def _standard(jtype: int) -> str:
    return f"take U{standard_type(jtype)}, which needs no stress of its solids"


def _formulation(solids: Neighbours) -> Iterator[Finding]:
    """Check the type of the solids: interpolation, state of stress, further unknowns."""
    kind = BUILT_IN.get(solids.type)
    if not isinstance(kind, ContinuumType):
        return
    place, here = solids.section.source, f"{solids.type} beside {_type(solids)} (element {solids.name})"
    if isinstance(kind, ContinuumShellType):
        yield shell_fault(solids.jtype, solids.type, solids.name, place)
        return
    if kind.modified:
        message = f"{here} has an interpolation of its own, which {_type(solids)} does not know"
        yield Finding(f"{message}; {_instead(solids)}", place, wrong=True)
    if kind.pressures:
        message = f"{here} has a pressure of its own, where {_type(solids)} takes that of the displacements"
        yield Finding(f"{message}: tractions may differ; {_instead(solids)}", place, wrong=False)
    if kind.generalised:
        message = f"{here} strains normal to the plane, where {_type(solids)} takes plane strain"
        yield Finding(f"{message}; {_instead(solids)}", place, wrong=True)
    if kind.electrical:
        message = f"{here} has stresses by its electrical field, which {_type(solids)} does not know"
        yield Finding(f"{message}; {_instead(solids)}", place, wrong=True)


def _material(solids: Neighbours, material: Material) -> Iterator[Finding]:
    """Check for stresses that do not follow from constant elastic moduli."""
    of = f"material {material.name} of the {solids.type} beside {_type(solids)}"
    time_dependent = material.viscoelastic or material.creep or next(iter(material.networks), None)
    if time_dependent is not None:
        keyword = "CREEP" if time_dependent is material.creep else "VISCOELASTIC"
        message = f"*{keyword} of {of}: {_type(solids)} takes it as elastic"
        yield Finding(f"{message}; {_instead(solids)}", time_dependent.source, wrong=True)
    if material.plastic is not None:
        message = f"*PLASTIC of {of}: {_type(solids)} takes it as elastic, so its tractions are wrong once it yields"
        yield Finding(f"{message}; {_instead(solids)}", material.plastic.source, wrong=False)
    if material.hyperelastic is not None:
        message = f"*{material.hyperelastic.keyword} of {of}: {_type(solids)} takes it as linear elastic"
        yield Finding(f"{message}; {_instead(solids)}", material.hyperelastic.source, wrong=False)
    if material.user is not None:
        message = f"*USER MATERIAL of {of}: {_type(solids)} takes it as elastic, with the moduli of its properties"
        yield Finding(f"{message}; {_instead(solids)} unless it is", material.user.source, wrong=False)
    if material.elastic is not None and material.elastic.table is not None:
        message = f"*ELASTIC of {of} depends on temperature or fields: {_type(solids)} has the same moduli throughout"
        yield Finding(f"{message}; {_instead(solids)}", material.elastic.source, wrong=False)


def _temperature(solids: Neighbours, material: Material, states: States) -> Iterator[Finding]:
    """Check for thermal strains that no three constants and PREDEF give."""
    if material.expansion is None or not material.expansion.table[:, 1:].any():
        return
    kind = BUILT_IN.get(solids.type)
    of = f"material {material.name} of the {solids.type} beside it has *EXPANSION ({material.expansion.source})"
    if isinstance(kind, ContinuumType) and kind.coupled:
        message = f"{_type(solids)} knows temperatures of *TEMPERATURE, not those of {solids.type}: {of}"
        yield Finding(f"{message}; {_instead(solids)}", solids.section.source, wrong=True)
        return
    place = next((place for nodes, place in states.temperatures if np.isin(solids.nodes, nodes).any()), None)
    if place is None or constant_expansion(material) is not None:
        return
    message = f"{_type(solids)} has one expansion along each axis of a ply, at all temperatures: {of}, which is another"
    yield Finding(f"{message}; {_instead(solids)}", place, wrong=True)


def constant_expansion(material: Material) -> FloatArray | None:
    """Return the expansion (3,) along the axes of a material, zero without any; None if it takes more than these."""
    if material.expansion is None:
        return np.zeros(3)
    table = material.expansion.table
    return None if len(table) > 1 or table[:, 4:].any() else np.array(table[0, 1:4])
