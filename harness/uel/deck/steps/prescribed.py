# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*BOUNDARY, *CLOAD, *CFLUX and *CECHARGE."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.deck.error_report import Problems, look_up, nearest
from uel.deck.language.blocks import Block, Row
from uel.deck.language.repetition import overlaps, repeated_value
from uel.deck.language.table import INPUT, Keyword, Kind, Option, Where, ignored, one_of, refused, unquote
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.mesh.surfaces import Surfaces
from uel.deck.mesh.transforms import Transforms
from uel.deck.sections.user_elements import LARGEST_DOF
from uel.errors import Source
from uel.model.amplitude import Amplitude
from uel.model.dofs import dof_in_deck
from uel.model.steps import Boundary, Load

# dofs of the named boundary types (Abaqus Analysis User's Guide, "Boundary conditions")
NAMED_DOFS = {
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
    "XASYMM": (2, 3, 4),
    "YASYMM": (1, 3, 5),
    "ZASYMM": (1, 2, 6),
    "PINNED": (1, 2, 3),
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
}
REFUSED_TYPES = ("NOWARP", "NOOVAL", "NODEFORM")


@dataclass(frozen=True, slots=True)
class Prescription:
    """Reader of prescribed values and point loads.

    flat, amplitudes  sets and amplitudes by name
    active_dofs       dofs of the elements
    built_in          (elements,) mask of built-in elements
    surfaces          faces of elements, for loads
    transforms        local directions of nodes
    """

    flat: FlatMesh
    amplitudes: Mapping[str, Amplitude]
    active_dofs: Collection[int]
    built_in: NDArray[np.bool_]
    surfaces: Surfaces
    transforms: Transforms

    def read_boundary(self, block: Block, in_step: bool) -> list[Boundary]:
        """Read one *BOUNDARY, an entry for each dof. Raises DeckError."""
        amplitude = self.amplitude(block)
        velocity, user = block.options.text("TYPE") == "VELOCITY", block.options.flag("USER")
        if user and not in_step:
            raise block.error("USER before the first *STEP, where only zero can be prescribed")
        fixed = block.options.flag("FIXED")
        if fixed and (not in_step or velocity or user or amplitude is not None):
            raise block.error(
                "FIXED holds the values at the start of the step, and excludes AMPLITUDE, TYPE=VELOCITY and USER"
            )
        if user and velocity:
            raise block.error("USER is supported for displacements, not for TYPE=VELOCITY")
        entries = []
        for row in block.rows():
            nodes = self.flat.nodes(row.name(0, "node or node set"), row.source)
            dofs = self._dofs(row)
            magnitude = row.real(3, "value", 0.0)
            row.at_most(4)
            if magnitude and not in_step:
                raise row.error(f"value {magnitude:g} before the first *STEP, where only zero can be prescribed")
            data = magnitude, amplitude, row.source, velocity, user, fixed, block.options.flag("IMAGINARY")
            if user and (name := self.transforms.named(nodes)):
                raise row.error(f"USER is not supported at nodes with *TRANSFORM, such as {name}")
            parts = [part for dof in dofs for part in self.transforms.parts(nodes, dof, row.source)]
            entries += [Boundary(subset, dof, *data) for subset, dof in parts]
        return entries

    def read_loads(self, block: Block) -> list[Load]:
        """Read the entries of one *CLOAD, *CFLUX or *CECHARGE. Raises DeckError."""
        amplitude = self.amplitude(block)
        if block.name == "CECHARGE" and amplitude is not None and amplitude.absolute:
            raise block.error("an amplitude with VALUE=ABSOLUTE is not supported; give the charge, and factors of it")
        entries = []
        for row in block.rows():
            row.at_most(3)
            nodes = self.flat.nodes(row.name(0, "node or node set"), row.source)
            default_dof = _OWN_DOFS.get(block.name)
            dof = default_dof if default_dof is not None and row.blank(1) else read_dof(row, 1)
            if block.name == "CECHARGE" and dof != default_dof:
                raise row.error(f"charges belong to dof {default_dof}, found {dof}")
            imaginary = block.options.known("IMAGINARY") and block.options.flag("IMAGINARY")
            # the force of a potential is minus the charge
            value = row.real(2, "value", 0.0) * (-1 if block.name == "CECHARGE" else 1)
            data = value, amplitude, row.source, imaginary
            entries += [Load(subset, number, *data) for subset, number in self.transforms.parts(nodes, dof, row.source)]
        return entries

    def amplitude(self, block: Block, option: str = "AMPLITUDE") -> Amplitude | None:
        """Return the amplitude that a keyword names, None if it names none. Raises DeckError."""
        name = block.options.text(option)
        return look_up(self.amplitudes, name, "amplitude", block.source) if name else None

    def _dofs(self, row: Row) -> list[int]:
        named = unquote(row.text(1, "dof")).replace(" ", "")
        if named in NAMED_DOFS:
            # a named type fixes its active dofs
            return [dof for dof in NAMED_DOFS[named] if dof in self.active_dofs]
        if named in REFUSED_TYPES:
            raise row.unsupported(f"boundary type {named}")
        if named[:1].isalpha():
            raise row.error(f"unknown boundary type {named}{nearest(named, NAMED_DOFS)}")
        first = read_dof(row, 1)
        last = first if row.blank(2) else read_dof(row, 2)
        if last < first:
            raise row.error(f"last dof {last} is before the first, {first}")
        return list(range(first, last + 1))


def of_load_case(blocks: Sequence[Block], case: int) -> list[Block]:
    """Return the keywords of a step, with *BOUNDARY only of this LOAD CASE."""
    return [block for block in blocks if block.name != "BOUNDARY" or _load_case(block) == case]


def check_load_cases(
    blocks: Sequence[Block], first: Sequence[Boundary], second: Sequence[Boundary], problems: Problems
) -> None:
    """Report LOAD CASE outside *BUCKLE, and different supports in LOAD CASE=2."""
    load_cases = [block for block in blocks if block.name == "BOUNDARY" and block.options.has("LOAD CASE")]
    for block in load_cases:
        if not any(other.name == "BUCKLE" for other in blocks):
            problems.add(block.source, "*BOUNDARY: LOAD CASE is for *BUCKLE")
        elif _load_case(block) not in (1, 2):
            problems.add(block.source, f"*BOUNDARY: LOAD CASE={_load_case(block)}: expected 1 or 2")
    modes = next((block for block in load_cases if _load_case(block) == 2), None)
    held = [{(n, entry.dof) for entry in entries for n in entry.nodes.tolist()} for entries in (first, second)]
    if modes is not None and held[0] != held[1]:
        message = "LOAD CASE=2 holds other dofs than LOAD CASE=1: modes with supports of their own are not supported"
        problems.add(modes.source, f"*BOUNDARY: {message}")


def _load_case(block: Block) -> int:
    return block.options.integer("LOAD CASE", 1)


def read_dof(row: Row, index: int) -> int:
    """Read the dof in a field of a data line. Raises DeckError."""
    dof = row.integer(index, "dof")
    if not 1 <= dof <= LARGEST_DOF:
        raise row.error(f"{dof} is not a dof (1 to {LARGEST_DOF})")
    return dof


def contradictions(entries: Sequence[Boundary], flat: FlatMesh) -> Iterator[tuple[Source, str]]:
    """Yield location and message of each entry of a step with another value than an earlier entry."""
    alike: dict[tuple[int, bool], list[Boundary]] = {}
    for entry in entries:
        alike.setdefault((entry.dof, entry.imaginary), []).append(entry)
    for group in alike.values():
        for first, later, node in overlaps([entry.nodes for entry in group]):
            before, here = group[first], group[later]
            if _described(before) != _described(here):
                item = f"*BOUNDARY: node {flat.mesh.name(node)}, dof {dof_in_deck(here.dof)}"
                yield (
                    here.source,
                    repeated_value(item, _described(here), _described(before), before.source, "in one step"),
                )


def _described(entry: Boundary) -> str:
    """Return the prescribed value of an entry, for messages."""
    if entry.fixed or entry.user:
        return "what DISP says" if entry.user else "the value at the start of the step"
    return f"{'the rate' if entry.velocity else 'the value'} {of_amplitude(entry)}"


def of_amplitude(entry: Boundary | Load) -> str:
    """Return the magnitude of an entry, with its amplitude, for messages."""
    return f"{entry.magnitude:g}{f' with amplitude {entry.amplitude.name}' if entry.amplitude else ''}"


OP = one_of("OP", "NEW removes what earlier steps prescribed", ("MOD", "NEW"), default="MOD")
AMPLITUDE = Option("AMPLITUDE", Kind.NAME, "amplitude; without it that of *STEP, but displacements always ramp")

HARMONIC = (
    Option("REAL", doc="real part of harmonic values, in *STEADY STATE DYNAMICS (default)"),
    Option("IMAGINARY", doc="imaginary part of harmonic values, in *STEADY STATE DYNAMICS"),
)

_OWN_DOFS = {"CFLUX": 11, "CECHARGE": 9}
"""Dofs that the data lines may leave out."""

LOAD = (OP, Option("AMPLITUDE", Kind.NAME, "amplitude; without it that of *STEP"), INPUT)

KEYWORDS = (
    Keyword(
        "BOUNDARY",
        "Prescribed values of dofs.",
        Where.ANY,
        (
            OP,
            AMPLITUDE,
            one_of("TYPE", "what is prescribed", ("DISPLACEMENT", "VELOCITY"), refused=("ACCELERATION",)),
            INPUT,
            Option("USER", doc="DISP gives the values"),
            Option("FIXED", doc="values stay as at the start of the step"),
            *HARMONIC,
            *ignored("REGION TYPE"),
            Option("LOAD CASE", Kind.INTEGER, "in *BUCKLE: 1 (default), and 2 of the modes, which must be the same"),
            *refused(*("BASE NAME", "PHANTOM", "SCALE", "STEP", "SUBMODEL", "BLOCKING", "TIMESCALE")),
        ),
        "node or set, first dof, last dof, value; or node or set, XSYMM, YSYMM, ZSYMM, XASYMM, YASYMM, ZASYMM, "
        "PINNED or ENCASTRE",
    ),
    Keyword(
        "CLOAD",
        "Concentrated loads.",
        Where.STEP,
        (*LOAD, *HARMONIC, *ignored("REGION TYPE"), *refused("CYCLIC MODE", "FOLLOWER", "LOAD CASE", "SUBMODEL")),
        "node or set, dof, value",
    ),
    Keyword(
        "CECHARGE",
        "Concentrated electrical charges; with *CLOAD in the same step both need the same OP.",
        Where.STEP,
        (*LOAD, *HARMONIC, *ignored("REGION TYPE"), *refused("LOAD CASE")),
        "node or set, dof (9), charge",
    ),
    Keyword(
        "CFLUX",
        "Concentrated heat fluxes; with *CLOAD in the same step both need the same OP.",
        Where.STEP,
        (*LOAD, *ignored("REGION TYPE")),
        "node or set, dof (11), value",
    ),
)
