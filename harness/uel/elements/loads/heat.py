# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heat, or a diffusing material, that enters through faces, into volumes and at nodes: blocks that are called as
elements are.

They are in fortran/host/elements/heat/loads.f90. Their loads are of kind 1, the flux or the temperature of the other
side, and 2, the film coefficient or emissivity.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from uel.elements.call import BlockReport, Distributed
from uel.elements.families.solid import section_depth
from uel.elements.loads.load_block import LoadBlock
from uel.elements.routine import Routine
from uel.errors import DeckError
from uel.model.arrays import IntArray
from uel.model.dofs import CONCENTRATION, TEMPERATURE
from uel.model.element_types import Family, HeatType, SolidType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import NodalSection, SolidSection
from uel.model.steps import HeatLaw, HeatLoad, HeatLoadType
from uel.usersub import Library, _binding, built_in

FACE, VOLUME, NODE = 1, 2, 3
"""JTYPE in fortran/host/elements/heat/loads.f90."""


class HeatLoadBlock(LoadBlock):
    """Faces, volumes or nodes that heat of one type may enter.

    places  (m,) positions of the elements in the model, or nodes, ascending
    load    the type of the load
    terms   of the average flux that one load is: the nodes of the element that have temperatures, whatever the face
    """

    places: IntArray
    load: HeatLoadType
    terms: int

    def owners(self, ranks: IntArray) -> IntArray:
        """Return the ranks (m,) that call the items: those of their elements, rank 0 where heat enters nodes."""
        return np.zeros_like(self.places) if self.load.area else np.asarray(ranks[self.places])

    def _as_terms(self, report: BlockReport, distributed: Distributed) -> BlockReport:
        """Return the report of a pass with the loads on these elements counted as terms of the average flux."""
        loaded = np.count_nonzero(self.holds(distributed.elements[distributed.kinds == 1]))
        return report._replace(entries=np.where(self._forces > 0, self.terms * loaded, 0))

    def keep(self, rows: IntArray) -> None:
        """Keep these elements only, as in other blocks."""
        super().keep(rows)
        self.places = self.places[rows]


def heat_load_blocks(model: Model, library: Library) -> Iterator[HeatLoadBlock]:
    """Yield the blocks of all faces, volumes and nodes that heat enters. Raises DeckError."""
    under: dict[HeatLoadType, list[HeatLoad]] = {}
    for step in model.steps:
        for entry in step.heat_loads:
            under.setdefault(entry.type, []).append(entry)
    starts = np.cumsum([0, *(len(group.labels) for group in model.groups)])
    for load, entries in under.items():
        number = _define(model, load, entries[0], library)
        places = np.unique(np.concatenate([entry.places for entry in entries]))
        if load.area:
            _check_nodes(model, entries)
            yield _at_nodes(model, places, entries[0], number, library)
            continue
        for parent, start, end in zip(model.groups, starts, starts[1:], strict=False):
            mine = places[(places >= start) & (places < end)]
            if len(mine):
                yield _on_elements(model, parent, mine - start, mine, load, number, library)


def _define(model: Model, load: HeatLoadType, entry: HeatLoad, library: Library) -> int:
    """Define a load in the host, and return its number. Raises DeckError if a routine or constant is missing."""
    if load.law is HeatLaw.RADIATION and not model.constants.stefan_boltzmann:
        raise DeckError(entry.source, f"*{load.keyword} needs *PHYSICAL CONSTANTS, STEFAN BOLTZMANN=")
    routine, address = ("FILM", library.film) if load.law is HeatLaw.FILM else ("DFLUX", library.dflux)
    if load.by_user and address is None:
        message = (
            f"*{load.keyword}: nonuniform loads need {routine}; {library.name or 'the job'} has {library.contents}"
        )
        raise DeckError(entry.source, message)
    return _binding.define_heat_load(
        law=load.law,
        address=address if load.by_user else None,
        surface=load.surface,
        jltyp=load.jltyp,
        absolute_zero=model.constants.absolute_zero,
        stefan_boltzmann=model.constants.stefan_boltzmann,
    )


def _on_elements(
    model: Model,
    parent: ElementGroup,
    rows: IntArray,
    places: IntArray,
    load: HeatLoadType,
    number: int,
    library: Library,
) -> HeatLoadBlock:
    kind, section = parent.built_in, parent.section
    assert isinstance(kind, SolidType)
    assert isinstance(section, SolidSection)
    family, points, nodes = kind.family, kind.body_points, parent.nodes[rows]
    if load.face:
        family = kind.family.face_family(load.face)
        points, nodes = family.full_points, nodes[:, list(load.face)]
    # coupled elements have temperatures at their corners
    field = family if isinstance(kind, HeatType) else family.linear
    depth = section_depth(kind, section)
    integers = built_in.integers(
        "heat_load",
        family=family.number,
        points=points,
        field=field.number,
        axisymmetric=kind.axisymmetric,
        load=number,
        diffusive=model.diffusive,
    )
    group = replace(parent, labels=parent.labels[rows], nodes=nodes)
    jtype = FACE if load.face else VOLUME
    routine = _routine(jtype, kind.dimension, depth, integers)
    terms = sum(TEMPERATURE in kind.dofs(node) for node in range(kind.nodes))
    return _block(model, group, routine, library, field, places, load, terms)


def _check_nodes(model: Model, entries: list[HeatLoad]) -> None:
    """Raise DeckError where a node has no temperature."""
    warm = np.zeros(len(model.mesh.labels), dtype=bool)
    for group in model.groups:
        kind = group.built_in
        for local in range(group.nodes.shape[1]):
            definition = group.definition
            dofs = [dof for node, dof in definition.dofs if node == local] if definition else kind and kind.dofs(local)
            if TEMPERATURE in (dofs or ()):
                warm[group.nodes[:, local]] = True
    for entry in entries:
        if not warm[entry.places].all():
            label = model.mesh.name(int(entry.places[~warm[entry.places]][0]))
            raise DeckError(entry.source, f"*{entry.type.keyword}: node {label} has no temperature")


def _at_nodes(model: Model, nodes: IntArray, entry: HeatLoad, number: int, library: Library) -> HeatLoadBlock:
    load, section = entry.type, NodalSection(entry.source)
    group = ElementGroup(load.keyword, model.mesh.labels[nodes], nodes[:, None], "", section, None, entry.source)
    none = {"family": 0, "points": 0, "field": 0, "axisymmetric": False, "diffusive": False}
    routine = _routine(NODE, 3, load.area, built_in.integers("heat_load", **none, load=number))
    return _block(model, group, routine, library, None, nodes, load, 1)


def _routine(jtype: int, dimension: int, depth: float, integers: IntArray) -> Routine:
    return Routine(
        address=_binding.address_of("heat load"),
        jtype=jtype,
        mcrd=dimension,
        svars=1,
        props=built_in.reals("heat_load", depth=depth),
        jprops=integers,
    )


def _block(
    model: Model,
    group: ElementGroup,
    routine: Routine,
    library: Library,
    field: Family | None,
    places: IntArray,
    load: HeatLoadType,
    terms: int,
) -> HeatLoadBlock:
    count = 1 if field is None else field.nodes
    dof = CONCENTRATION if model.diffusive else TEMPERATURE
    unknowns = tuple((node, dof) for node in range(count))
    block = HeatLoadBlock(group, model.mesh.coordinates, unknowns, routine, library, unsymmetric=False, variables=None)
    block.places, block.load, block.terms = places, load, terms
    return block
