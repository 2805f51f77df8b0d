# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tractions that really act on an interface, including bumps: on a finer mesh of the same interface.

The quads are cut into 2 x 2, or 4 x 4, inside the bumps, which stay as they are. The interface is a rigid bond before
it fails, that is, the consistent element with an infinite stiffness: finite ones are approximations of that. A bond of
1e6 N/mm^3 and less is so soft that it yields to the bumps (`refinement.py`), and really shows less of them.

A traction on the finer mesh varies within the facet of a coarser one, and more so the finer it is: bumps have kinks,
and at a kink the stress of two different plies, or of two arms that slip, has a weak singularity. A coarser mesh does
not show that and need not. So the finer traction is averaged over the share of each point of the coarser mesh before
the two are compared: the two Gauss points of a facet have the same weight, and half of the facet each.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from uel.batch.engine import Deck, StoredRow
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.run_deck import run_deck
from uel.paper.study.cases import KINDS, StudyCase, deck_files, interface_of, mesh_of

FACTORS = {"dcb": 2, "dcb025": 2, "enf": 2, "frmm": 4}
"""Factors by which quads are cut each way: more if bumps affect both tractions, by bending stress and slip."""
FOLDER = "references"
"""Folder of the runs, below that of the study."""

Profile = dict[str, FloatArray]


@dataclass(frozen=True, slots=True)
class StudyReference:
    """Reference of all rows of a specimen, layup and mesh; every entry is a key of the table of its name."""

    specimen: str
    layup: str
    mesh: str

    @property
    def factor(self) -> int:
        """Factor by which every quad is cut, in both directions."""
        return FACTORS[self.specimen]

    @property
    def name(self) -> str:
        """Name of the run and of its folder."""
        return f"{self.specimen}_{self.layup.replace('/', '-')}_{self.mesh}"

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        kind = KINDS[self.specimen]
        mesh = mesh_of(kind, self.mesh, self.factor)
        title = f"{kind.title}, [{self.layup}], {self.mesh} mesh, quads cut into {self.factor} x {self.factor}"
        return deck_files(self.name, title, kind, self.layup, mesh, interface_of("consistent", "inf"))


@dataclass(frozen=True, slots=True)
class ReferenceRun(StoredRow):
    """Ending of a reference run: `stopped` says why it stopped early, empty if it finished; wall-clock time."""

    stopped: str
    seconds: float


def reference_of(case: StudyCase) -> StudyReference:
    """Return the reference that a row is compared with."""
    return StudyReference(case.specimen, case.layup, case.mesh)


def run_reference(reference: Deck, folder: Path) -> ReferenceRun:
    """Run a reference in a folder of its name below `folder`, with the fall-back."""
    outcome = run_deck(reference, folder, fallback=True)
    return ReferenceRun(outcome.stopped, outcome.seconds)


@lru_cache(maxsize=2)
def real_profiles(reference: StudyReference, folder: Path) -> list[Profile]:
    """Return the profiles of a reference that has run in `folder`, at the points of the mesh that is not refined."""
    profiles = Result(folder / reference.name / reference.name).interfaces()
    return [restricted(profile, reference.factor) for profile in profiles]


def restricted(profile: Profile, factor: int) -> Profile:
    """Average every column (factor n,) of a profile over the share of each point of the mesh that is not refined.

    Both meshes have two points of equal weight on every interface element, left to right: the first `factor` points of
    the finer one lie in the share of the first point of the coarser one.
    """
    return {name: column.reshape(-1, factor).mean(axis=1) for name, column in profile.items()}
