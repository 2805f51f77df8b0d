# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rules for repeated keywords: one rule for each keyword that sets a value says what a second one means.

`check_once` refuses what may be given once in a scope, wherever the keyword is read. The other rules are carried out
where the values are: entries of a step in `uel.deck.steps.step`, faces of a surface in `uel.deck.mesh.surfaces`,
sections of elements in `uel.deck.mesh.groups`, nodes, elements and sets in `uel.deck.mesh.local_mesh`.
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
    of      what they are values of, for `keywords.md`
    within  keywords that begin what may have the keyword once; none: the part, the assembly or the model
    by      options that tell different things apart
    apart   the reader of the keyword refuses, since what is given once has no option of its own
    note    what else a user should know, for `keywords.md`
    """

    repeat: Repeat
    of: str
    within: tuple[str, ...] = ()
    by: tuple[str, ...] = ()
    apart: bool = False
    note: str = ""

    @property
    def sentence(self) -> str:
        """The rule, as `keywords.md` has it."""
        return f"Again for {self.of}: {self.repeat}{self.note and '; '}{self.note}."


_NAMED: Final = Rule(Repeat.ONCE, "a name", by=("NAME",))
_OF_MATERIAL: Final = Rule(Repeat.ONCE, "a material", within=("MATERIAL",))
_OF_INTERACTION: Final = Rule(Repeat.ONCE, "a surface interaction", within=("SURFACE INTERACTION",))
_OF_STEP: Final = Rule(Repeat.ONCE, "a step", within=("STEP",))
_OF_ELEMENT: Final = Rule(Repeat.ONCE, "an element", apart=True)
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
_PROCEDURE: Final = Rule(Repeat.ONCE, "a step", apart=True)

RULES: Final[dict[str, Rule]] = {
    # each node, element and set; a set is extended (Analysis User's Guide, "Node definition", "Element definition")
    **dict.fromkeys(("NODE", "NGEN", "NFILL", "NCOPY", "ELEMENT", "ELGEN"), _DEFINITION),
    **dict.fromkeys(("NSET", "ELSET"), _SET),
    "SYSTEM": Rule(Repeat.LAST, "the nodes that follow"),
    "PARAMETER": Rule(Repeat.LAST, "the lines that follow"),
    "IMPERFECTION": Rule(Repeat.ADD, "a node", note="of data lines with a warning, since Abaqus does not say"),
    "TRANSFORM": Rule(Repeat.ONCE, "a node", apart=True, note="the same directions are accepted"),
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
    "DAMAGE INITIATION": Rule(Repeat.ONCE, "a material or surface interaction", apart=True),
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
    **dict.fromkeys(("HOURGLASS STIFFNESS", "TRANSVERSE SHEAR STIFFNESS"), Rule(Repeat.ONCE, "a section", apart=True)),
    # constraints and contact
    **dict.fromkeys(("EQUATION", "MPC", "KINEMATIC COUPLING", "TIE", "COUPLING"), _CONSTRAINT),
    **dict.fromkeys(("KINEMATIC", "DISTRIBUTING"), Rule(Repeat.ONCE, "a *COUPLING", within=("COUPLING",))),
    "CYCLIC SYMMETRY MODEL": _IN_MODEL,
    "CONTACT": _IN_MODEL,
    "CONTACT PAIR": Rule(Repeat.ONCE, "two surfaces", apart=True),
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
    "MODAL DAMPING": Rule(Repeat.ONCE, "a step and kind of damping", apart=True),
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
"""Keywords that may be given once, by the keyword that opens their scope."""


def check_once(blocks: Iterable[Block], problems: Problems) -> None:
    """Report each keyword of one scope that repeats what may be given only once."""
    seen: dict[str, dict[tuple[str, ...], Block]] = {}
    for block in blocks:
        for name in _MEMBERS.get(block.name, ()):
            seen.pop(name, None)
        rule = RULES.get(block.name)
        if rule is None or rule.repeat is not Repeat.ONCE or rule.apart:
            continue
        values = tuple(block.options.values.get(option, "") for option in rule.by)
        first = seen.setdefault(_ALIKE.get(block.name, block.name), {}).setdefault(values, block)
        # not by their places: a file may be included twice
        if first is block:
            continue
        if rule.by and not rule.within:
            message = f"{values[0]} is defined already"
        else:
            given = ", ".join(f"{name}={value}" for name, value in zip(rule.by, values, strict=True) if value)
            message = f"{given} is given already" if given else f"{rule.of} has one already"
        problems.add(block.source, f"*{block.name}: {message}, at {first.source}")


def overlaps(places: Sequence[IntArray]) -> Iterator[tuple[int, int, int]]:
    """Yield each pair of entries that follow each other at some place, and the first such place.

    places: of each entry, (k,) numbers, none of them twice.
    """
    if len(places) < 2:
        return
    every = np.concatenate(places)
    numbers = np.repeat(np.arange(len(places)), [len(own) for own in places])
    order = np.argsort(every, kind="stable")
    every, numbers = every[order], numbers[order]
    again = np.flatnonzero(every[1:] == every[:-1])
    pairs, first = np.unique(np.stack([numbers[again], numbers[again + 1]], axis=1), axis=0, return_index=True)
    for (earlier, later), k in zip(pairs.tolist(), first.tolist(), strict=True):
        yield earlier, later, int(every[again[k]])


def given_again(what: str, here: str, before: str, source: Source, where: str = "") -> str:
    """Return the sentence about something that is given one value here and another before, at a place."""
    return f"{what} is given {here} here and {before} at {source}{where and ', '}{where}; the entry here counts"
