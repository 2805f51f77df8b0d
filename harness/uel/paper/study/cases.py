# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rows of the study: every combination of specimen, layup, stiffness, element, mesh and solution."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

from uel.delamination import flexure, specimens
from uel.delamination.blocks import BY_EQUATION_21, Interface, Specimen
from uel.delamination.materials import PLY_0, PLY_90, TABLE_2
from uel.delamination.mesh import TwoArmMesh, refined
from uel.delamination.steps import Increments
from uel.errors import UelError

BUMP = 0.03
"""Height of the perturbed interface nodes over the length of an element."""

# a hundredth of the displacement at a time, Abaqus' own tolerances and cutbacks; the minimum increment is a hundredth
# of Abaqus' default, for elements that advance slowly
INCREMENTS = Increments(initial=0.01, smallest=1e-7, largest=0.01, limit=1000, field_parts=10)
FIELD_EVERY = 10


class MeshedSpecimen(NamedTuple):
    """A specimen on a mesh.

    title         in words
    size          length of the elements along the crack's way (mm)
    displacement  at the end (mm), by layup: beyond the peak load
    mesh, deck    builders
    load          node set whose U2 and RF2 are displacement and load
    sign          of both, where they act
    modes         tractions of the loading mode
    """

    title: str
    size: float
    displacement: dict[str, float]
    mesh: Callable[[float, float], TwoArmMesh]
    deck: Callable[[str, Specimen, float, Increments, int], str]
    load: str
    sign: float
    modes: tuple[str, ...]


_ENDS = {"0/0": 3.0, "0/90": 6.0}
KINDS = {
    "dcb": MeshedSpecimen(
        "double cantilever beam", 0.125, _ENDS, specimens.dcb_mesh, specimens.dcb_deck, "LOAD_TOP", 1.0, ("TN",)
    ),
    "dcb025": MeshedSpecimen(
        "double cantilever beam, 0.25 mm", 0.25, _ENDS, specimens.dcb_mesh, specimens.dcb_deck, "LOAD_TOP", 1.0, ("TN",)
    ),
    "enf": MeshedSpecimen(
        "end-notched flexure",
        0.25,
        {"0/0": 4.0, "0/90": 6.0},
        flexure.enf_mesh,
        flexure.enf_deck,
        "MIDSPAN",
        -1.0,
        ("TT",),
    ),
    "frmm": MeshedSpecimen(
        "fixed-ratio mixed mode",
        0.125,
        {"0/0": 6.0, "0/90": 6.0},
        flexure.frmm_mesh,
        flexure.frmm_deck,
        "LOAD_TOP",
        1.0,
        ("TN", "TT"),
    ),
}
# the first ply is the upper arm's
LAYUPS = {"0/0": (PLY_0, PLY_0), "0/90": (PLY_0, PLY_90)}
STIFFNESSES = {"1e4": 1.0e4, "1e6": 1.0e6, "1e8": 1.0e8, "1e12": 1.0e12, "inf": 0.0}
"""Stiffness of the interface (N/mm^3) by name; the consistent law's infinite one is written 0."""
ELEMENTS = {"standard": ("U2", False), "paper": ("U4", False), "consistent": ("U4", True)}
"""Element type, and whether the law is the consistent one."""
MESHES = {"structured": 0.0, "perturbed": BUMP}
VISCOSITIES = {f"viscous{text}": float(text) for text in ("1e-4", "3e-4", "1e-3")}
"""Viscosity in step time: what Abaqus alone can do where Newton's method stops."""
SOLUTIONS = {"newton": (False, 0.0), "fallback": (True, 0.0)} | {n: (False, v) for n, v in VISCOSITIES.items()}
"""Solutions by name: whether the fall-back helps, and the viscosity in step time."""
LAWS = {"linear": (1, 0.0), "bk": (2, 1.45), "exponential": (3, 0.0), "ppr": (4, 0.0)}
"""LAW and the exponent of Benzeggagh and Kenane; the last has its default shapes."""
OWN_LAW = "linear"


@dataclass(frozen=True, slots=True)
class StudyCase:
    """Row of the study; every entry is a key of the table of its name."""

    specimen: str
    layup: str
    stiffness: str
    element: str
    mesh: str
    solution: str
    law: str = OWN_LAW

    @property
    def name(self) -> str:
        """Name of the row and of its folder."""
        words = [str(getattr(self, field.name)).replace("/", "-") for field in fields(self)]
        return "_".join(words[:-1] if self.law == OWN_LAW else words)

    @property
    def kind(self) -> MeshedSpecimen:
        """Specimen."""
        return KINDS[self.specimen]

    @property
    def displacement(self) -> float:
        """Displacement at the end (mm)."""
        return self.kind.displacement[self.layup]

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        _, viscosity = SOLUTIONS[self.solution]
        law, eta = LAWS[self.law]
        interface = replace(interface_of(self.element, self.stiffness), viscosity=viscosity, law=law, eta=eta)
        title = f"{self.kind.title}, [{self.layup}], {self.stiffness} N/mm^3, {self.element} element, {self.mesh} mesh"
        return deck_files(self.name, title, self.kind, self.layup, mesh_of(self.kind, self.mesh), interface)


def interface_of(element: str, stiffness: str) -> Interface:
    """Return the interface elements with the law of the paper, by the names of the tables."""
    kind, consistent = ELEMENTS[element]
    return Interface(kind, TABLE_2.with_stiffness(STIFFNESSES[stiffness]), BY_EQUATION_21, consistent=consistent)


def mesh_of(kind: MeshedSpecimen, mesh: str, factor: int = 1) -> TwoArmMesh:
    """Mesh a specimen with every quad cut into factor x factor; the bumps are those of the mesh with 1."""
    return refined(kind.mesh(kind.size, MESHES[mesh] * kind.size), factor)


def deck_files(
    name: str,
    title: str,
    kind: MeshedSpecimen,
    layup: str,
    mesh: TwoArmMesh,
    interface: Interface,
    *,
    displacement: float | None = None,
    increments: Increments = INCREMENTS,
) -> dict[str, str]:
    """Write the deck `NAME.inp` of a specimen and its mesh files; the displacement (mm) defaults to the study's."""
    top, bottom = LAYUPS[layup]
    specimen = Specimen("mesh", mesh, interface, specimens.WIDTH, bottom, top)
    end = kind.displacement[layup] if displacement is None else displacement
    deck = kind.deck(title, specimen, end, increments, FIELD_EVERY)
    return specimens.mesh_files("mesh", mesh, (interface.nodes,)) | {f"{name}.inp": deck}


TABLES: dict[str, Iterable[str]] = {
    "specimen": KINDS,
    "layup": LAYUPS,
    "stiffness": STIFFNESSES,
    "element": ELEMENTS,
    "mesh": MESHES,
    "solution": SOLUTIONS,
    "law": LAWS,
}


def all_cases() -> list[StudyCase]:
    """List all rows: only the consistent law has an infinite stiffness, with the rows with viscosity and other laws.

    The standard element at 1e12 does not use the fall-back: because of its oscillations that takes tens of thousands
    of iterations without end.
    """
    return [case for entries in itertools.product(*TABLES.values()) if _is_row(case := StudyCase(*entries))]


def _is_row(case: StudyCase) -> bool:
    if case.law != OWN_LAW:
        plain = (case.layup, case.mesh, case.stiffness, case.element) == ("0/0", "structured", "inf", "consistent")
        return plain and case.specimen in ("dcb", "frmm") and case.solution in ("newton", "fallback", "viscous3e-4")
    if case.stiffness == "inf":
        return case.element == "consistent"
    if (case.stiffness, case.element) == ("1e12", "standard"):
        return case.solution == "newton"
    return case.solution not in VISCOSITIES


def select(cases: Iterable[StudyCase], words: Sequence[str]) -> list[StudyCase]:
    """Select the cases that match the words: of one table any, of different tables all.

    Raises
    ------
    UelError
        A word is not in any table.
    """
    wanted: dict[str, set[str]] = {}
    for word in words:
        table = next((name for name, entries in TABLES.items() if word in entries), None)
        if table is None:
            known = "; ".join(", ".join(entries) for entries in TABLES.values())
            raise UelError(f"no row has '{word}'; expected words among {known}")
        wanted.setdefault(table, set()).add(word)
    return [case for case in cases if all(getattr(case, name) in choice for name, choice in wanted.items())]
