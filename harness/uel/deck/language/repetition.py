# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rules for repeated keywords: whether a second value adds, replaces or is refused.

`check_once` refuses repetitions in a scope. The readers apply the other rules: `uel.deck.steps.step` to entries of a
step, `uel.deck.mesh.surfaces` to faces, `uel.deck.mesh.groups` to sections, `uel.deck.mesh.local_mesh` to nodes,
elements and sets.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.errors import Source
from uel.model.arrays import IntArray


class Repeat(StrEnum):
    """Meaning of several values for the same thing."""

    ADD = "all of them count"
    LAST = "the last one counts"
    ONCE = "refused"


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule.

    repeat  what several values are
    of      owner of the values, for `keywords.md`
    within  keywords that open a scope with one such keyword; none: the part, the assembly or the model
    by      options that distinguish entries
    by_reader  the reader refuses repetitions, since no option identifies the owner
    note    remark for `keywords.md`
    """

    repeat: Repeat
    of: str
    within: tuple[str, ...] = ()
    by: tuple[str, ...] = ()
    by_reader: bool = False
    note: str = ""

    @property
    def sentence(self) -> str:
        """The rule, as `keywords.md` has it."""
        return f"Again for {self.of}: {self.repeat}{self.note and '; '}{self.note}."


_NAMED: Final = Rule(Repeat.ONCE, "a name", by=("NAME",))
_OF_MATERIAL: Final = Rule(Repeat.ONCE, "a material", within=("MATERIAL",))
_OF_INTERACTION: Final = Rule(Repeat.ONCE, "a surface interaction", within=("SURFACE INTERACTION",))
_OF_STEP: Final = Rule(Repeat.ONCE, "a step", within=("STEP",))
_OF_ELEMENT: Final = Rule(Repeat.ONCE, "an element", by_reader=True)
_OF_DAMAGE: Final = Rule(Repeat.ONCE, "a *DAMAGE INITIATION", within=("DAMAGE INITIATION",))
_IN_MODEL: Final = Rule(Repeat.ONCE, "the model")
_WARNED: Final = "a warning says where it differs"
_FIELD: Final = Rule(Repeat.LAST, "a node in a step", note=_WARNED)
_LOAD: Final = Rule(Repeat.ADD, "a node and dof, or an element and load type, in a step")
_FILM: Final = Rule(Repeat.ADD, "a node or face in a step", note="each exchanges heat with its own surroundings")
_CONSTRAINT: Final = Rule(Repeat.ADD, "a node", note="each eliminates dofs, and a dof can be eliminated once")
_REQUEST: Final = Rule(Repeat.ADD, "a step")
_ASSIGNMENT: Final = Rule(Repeat.LAST, "two surfaces")
_DEFINITION: Final = Rule(Repeat.LAST, "a node or element", note=_WARNED)
_SET: Final = Rule(Repeat.ADD, "a name")
_PROCEDURE: Final = Rule(Repeat.ONCE, "a step", by_reader=True)

RULES: Final[dict[str, Rule]] = {
    # each node, element and set; a set is extended (Analysis User's Guide, "Node definition", "Element definition")
    **dict.fromkeys(("NODE", "NGEN", "NFILL", "NCOPY", "ELEMENT", "ELGEN"), _DEFINITION),
    **dict.fromkeys(("NSET", "ELSET"), _SET),
    "SYSTEM": Rule(Repeat.LAST, "the nodes that follow"),
    "PARAMETER": Rule(Repeat.LAST, "the lines that follow"),
    "IMPERFECTION": Rule(Repeat.ADD, "a node", note="of data lines with a warning, since Abaqus does not say"),
    "TRANSFORM": Rule(Repeat.ONCE, "a node", by_reader=True, note="the same directions are accepted"),
    "DISTRIBUTION": Rule(Repeat.ONCE, "a name", by=("NAME",), note="in one the last value of an element counts"),
    # what has a name
    **dict.fromkeys(("AMPLITUDE", "DISTRIBUTION TABLE", "MATERIAL", "ORIENTATION", "SECTION CONTROLS"), _NAMED),
    **dict.fromkeys(("SURFACE", "SURFACE INTERACTION", "SURFACE SMOOTHING", "CONTACT INITIALIZATION DATA"), _NAMED),
    "USER ELEMENT": Rule(Repeat.ONCE, "a type", by=("TYPE",)),
    # options of a material
    **dict.fromkeys(("ELASTIC", "PLASTIC", "CYCLIC HARDENING", "CREEP", "DENSITY", "EXPANSION"), _OF_MATERIAL),
    **dict.fromkeys(("HYPERELASTIC", "ANISOTROPIC HYPERELASTIC"), _OF_MATERIAL),
    **dict.fromkeys(("DEPVAR", "USER OUTPUT VARIABLES", "USER DEFINED FIELD"), _OF_MATERIAL),
    **dict.fromkeys(("CONDUCTIVITY", "HEAT GENERATION", "LATENT HEAT", "SPECIFIC HEAT"), _OF_MATERIAL),
    **dict.fromkeys(("DIFFUSIVITY", "SOLUBILITY", "PIEZOELECTRIC", "DIELECTRIC"), _OF_MATERIAL),
    "KAPPA": Rule(Repeat.ONCE, "a *DIFFUSIVITY and TYPE", within=("DIFFUSIVITY",), by=("TYPE",)),
    "USER MATERIAL": Rule(Repeat.ONCE, "a material and TYPE", within=("MATERIAL",), by=("TYPE",)),
    "VISCOELASTIC": Rule(Repeat.ONCE, "a material and network", within=("MATERIAL",), by=("NETWORKID",)),
    "TRS": Rule(Repeat.ONCE, "a network", within=("VISCOELASTIC",)),
    "DAMAGE INITIATION": Rule(Repeat.ONCE, "a material or surface interaction", by_reader=True),
    **dict.fromkeys(("DAMAGE EVOLUTION", "DAMAGE STABILIZATION"), _OF_DAMAGE),
    # options of a contact property
    **dict.fromkeys(("SURFACE BEHAVIOR", "FRICTION", "COHESIVE BEHAVIOR", "CONTACT DAMPING"), _OF_INTERACTION),
    **dict.fromkeys(
        ("GAP CONDUCTANCE", "GAP HEAT GENERATION"),
        Rule(Repeat.ADD, "a surface interaction", note="none of them changes the solution here"),
    ),
    # sections of elements
    **dict.fromkeys(("SOLID SECTION", "COHESIVE SECTION", "SHELL SECTION", "SHELL GENERAL SECTION"), _OF_ELEMENT),
    **dict.fromkeys(("BEAM SECTION", "BEAM GENERAL SECTION", "MEMBRANE SECTION", "UEL PROPERTY"), _OF_ELEMENT),
    **dict.fromkeys(("MASS", "SPRING", "DASHPOT", "RIGID BODY"), _OF_ELEMENT),
    **dict.fromkeys(
        ("HOURGLASS STIFFNESS", "TRANSVERSE SHEAR STIFFNESS"), Rule(Repeat.ONCE, "a section", by_reader=True)
    ),
    # constraints and contact
    **dict.fromkeys(("EQUATION", "MPC", "KINEMATIC COUPLING", "TIE", "COUPLING"), _CONSTRAINT),
    **dict.fromkeys(("KINEMATIC", "DISTRIBUTING"), Rule(Repeat.ONCE, "a *COUPLING", within=("COUPLING",))),
    "CYCLIC SYMMETRY MODEL": _IN_MODEL,
    "CONTACT": _IN_MODEL,
    "CONTACT PAIR": Rule(Repeat.ONCE, "two surfaces", by_reader=True),
    **dict.fromkeys(("CONTACT INCLUSIONS", "CONTACT EXCLUSIONS"), Rule(Repeat.ADD, "the model")),
    **dict.fromkeys(("CONTACT PROPERTY ASSIGNMENT", "CONTACT INITIALIZATION ASSIGNMENT"), _ASSIGNMENT),
    "CONTACT FORMULATION": _ASSIGNMENT,
    "SURFACE PROPERTY ASSIGNMENT": Rule(Repeat.LAST, "a face"),
    # values at the start, and constants
    "INITIAL CONDITIONS": Rule(Repeat.LAST, "a node and dof, or an element", note=_WARNED),
    "PHYSICAL CONSTANTS": _IN_MODEL,
    # what a step prescribes
    "BOUNDARY": Rule(Repeat.LAST, "a node and dof in a step", note=_WARNED),
    **dict.fromkeys(("TEMPERATURE", "FIELD", "PRESSURE STRESS"), _FIELD),
    **dict.fromkeys(("CLOAD", "CFLUX", "CECHARGE", "DLOAD", "DSLOAD", "DFLUX", "DSFLUX"), _LOAD),
    **dict.fromkeys(("FILM", "SFILM", "CFILM", "RADIATE", "SRADIATE", "CRADIATE"), _FILM),
    "BASE MOTION": Rule(Repeat.ONCE, "a step, dof and part", within=("STEP",), by=("DOF", "IMAGINARY")),
    "MODAL DAMPING": Rule(Repeat.ONCE, "a step and kind of damping", by_reader=True),
    "SELECT EIGENMODES": _OF_STEP,
    "MONITOR": _OF_STEP,
    "CONTROLS": Rule(Repeat.LAST, "an entry of the data lines"),
    "SOLUTION TECHNIQUE": Rule(Repeat.ADD, "a step", note="none of them changes the solution"),
    **dict.fromkeys(("STATIC", "VISCO", "GEOSTATIC", "DYNAMIC", "FREQUENCY", "BUCKLE"), _PROCEDURE),
    **dict.fromkeys(("STEADY STATE DYNAMICS", "MODAL DYNAMIC", "HEAT TRANSFER", "MASS DIFFUSION"), _PROCEDURE),
    "COUPLED TEMPERATURE-DISPLACEMENT": _PROCEDURE,
    # what a step writes
    **dict.fromkeys(("OUTPUT", "NODE OUTPUT", "ENERGY OUTPUT", "NODE PRINT", "EL PRINT"), _REQUEST),
    "ENERGY PRINT": Rule(Repeat.LAST, "a step"),
    "RESTART": Rule(Repeat.LAST, "a step"),
}

STRUCTURE: Final = (
    *("HEADING", "INCLUDE", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE", "END INSTANCE", "STEP"),
    "END STEP",
)
"""Keywords that set no value."""

_ALIKE: Final = {"ANISOTROPIC HYPERELASTIC": "HYPERELASTIC", "DISTRIBUTING": "KINEMATIC"}
"""Keywords that set the same thing as another one."""


_MEMBERS: Final = {
    opener: [_ALIKE.get(name, name) for name, rule in RULES.items() if opener in rule.within]
    for opener in {opener for rule in RULES.values() for opener in rule.within}
}
"""Keywords allowed once, by the keyword that opens their scope."""


def check_once(blocks: Iterable[Block], problems: Problems) -> None:
    """Report repeated keywords of one scope that are allowed once."""
    seen: dict[str, dict[tuple[str, ...], Block]] = {}
    for block in blocks:
        for name in _MEMBERS.get(block.name, ()):
            seen.pop(name, None)
        rule = RULES.get(block.name)
        if rule is None or rule.repeat is not Repeat.ONCE or rule.by_reader:
            continue
        values = tuple(block.options.values.get(option, "") for option in rule.by)
        first = seen.setdefault(_ALIKE.get(block.name, block.name), {}).setdefault(values, block)
        # compare objects, not locations: a file may be included twice
        if first is block:
            continue
        if rule.by and not rule.within:
            message = f"{values[0]} is defined already"
        else:
            repeated = ", ".join(f"{name}={value}" for name, value in zip(rule.by, values, strict=True) if value)
            message = f"{repeated} is given already" if repeated else f"{rule.of} has one already"
        problems.add(block.source, f"*{block.name}: {message}, at {first.source}")


def overlaps(members: Sequence[IntArray]) -> Iterator[tuple[int, int, int]]:
    """Yield each pair of consecutive entries with a common member, and the first such member.

    members: (k,) unique numbers of each entry.
    """
    if len(members) < 2:
        return
    all_members = np.concatenate(members)
    numbers = np.repeat(np.arange(len(members)), [len(numbers_of) for numbers_of in members])
    order = np.argsort(all_members, kind="stable")
    all_members, numbers = all_members[order], numbers[order]
    again = np.flatnonzero(all_members[1:] == all_members[:-1])
    pairs, first = np.unique(np.stack([numbers[again], numbers[again + 1]], axis=1), axis=0, return_index=True)
    for (earlier, later), k in zip(pairs.tolist(), first.tolist(), strict=True):
        yield earlier, later, int(all_members[again[k]])


def repeated_value(item: str, here: str, before: str, source: Source, scope: str = "") -> str:
    """Return the message about an item with another value here than before, at an earlier location."""
    return f"{item} is given {here} here and {before} at {source}{scope and ', '}{scope}; the entry here counts"
