# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Records that a step procedure reports while it runs; output writes them, and nothing else passes between the two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import ContactChanges
from uel.model.restart import Saved


class Convergence(StrEnum):
    """Outcome of the convergence check of one field in one iteration."""

    LINEAR = "linear"
    ZERO_FLUX = "zero_flux"
    NOT_ACHIEVED = "not_achieved"
    CONVERGED = "converged"
    ACCEPTED_ESTIMATE = "accepted_estimate"
    CORRECTION_TOO_LARGE = "correction_too_large"

    @property
    def accepted(self) -> bool:
        """Whether the field is in equilibrium."""
        return self not in (Convergence.NOT_ACHIEVED, Convergence.CORRECTION_TOO_LARGE)


@dataclass(frozen=True, slots=True)
class Largest:
    """Largest entry (signed) of a nodal array of a field, with its node (index; -1 for none) and dof.

    element  name of the element, where it is no node that has it
    """

    value: float
    node: int
    dof: int
    element: str = ""


@dataclass(frozen=True, slots=True)
class FieldCheck:
    """Convergence check of one field, as a block of the message file prints it; or of the volumes of hybrid elements,
    of distributing couplings, or of contact.

    These have no fluxes. Their residual is the largest difference of two changes of volume, the largest error of the
    displacement of a reference node, or the largest penetration; their correction that of its rotation, or of a force.

    converted  the time average flux comes from the other of the two fields, forces and moments
    """

    field: str
    average_flux: float
    time_average_flux: float
    residual: Largest
    increment: Largest
    correction: Largest
    verdict: Convergence
    estimated_correction: float | None = None
    converted: bool = False


@dataclass(frozen=True, slots=True)
class AttemptStarted:
    """An attempt at an increment begins. Times are those of the start of the increment."""

    step: int
    increment: int
    attempt: int
    step_time: float
    total_time: float
    time_increment: float


@dataclass(frozen=True, slots=True)
class IterationDone:
    """One iteration with its checks; line_search holds the scale factors tried, if any.

    iteration  its number among severe discontinuity iterations, or among equilibrium iterations since the last of these
    contact    changes in each contact pair; any change makes it a severe discontinuity iteration
    """

    iteration: int
    checks: tuple[FieldCheck, ...]
    line_search: tuple[float, ...] = ()
    contact: tuple[ContactChanges, ...] = ()

    @property
    def severe(self) -> bool:
        """Whether it is a severe discontinuity iteration."""
        return any(changes.count for changes in self.contact)


@dataclass(frozen=True, slots=True)
class AttemptEnded:
    """An attempt at an increment that is over, with its equilibrium iterations and, apart, those of severe
    discontinuities.
    """

    step: int
    increment: int
    attempt: int
    iterations: int
    step_time: float
    total_time: float
    time_increment: float
    severe: int = field(default=0, kw_only=True)


@dataclass(frozen=True, slots=True)
class AttemptAbandoned(AttemptEnded):
    """Abandoned attempt. The times are those of its start; `next_increment` is tried next (0: no attempt is left)."""

    next_increment: float
    reason: str


@dataclass(frozen=True, slots=True)
class IncrementDone(AttemptEnded):
    """A converged increment, after commit. Times are those of its end.

    `next_increment` is what the next increment starts with; 0 where none follows in the step. `load_factor`, where it
    is part of the solution, is the step time then, and the total time is the length of the path.
    """

    solution: Solution
    next_increment: float = 0.0
    load_factor: float | None = None


@dataclass(frozen=True, slots=True)
class ModesFound:
    """Eigenvalues (k,) of a step, their frequencies in cycles per time, and generalized masses."""

    step: int
    total_time: float
    eigenvalues: FloatArray
    frequencies: FloatArray
    masses: FloatArray


@dataclass(frozen=True, slots=True)
class ModeShape(IncrementDone):
    """One mode: `increment` is its number, its frequency replaces the times, the displacement is its shape."""


@dataclass(frozen=True, slots=True)
class BucklingFactors:
    """Eigenvalues (k,) of *BUCKLE: factors of the loads of the step at which the structure buckles."""

    step: int
    total_time: float
    eigenvalues: FloatArray


@dataclass(frozen=True, slots=True)
class BucklingMode(ModeShape):
    """One buckling mode: its eigenvalue replaces the times."""


@dataclass(frozen=True, slots=True)
class HarmonicResponse(IncrementDone):
    """The response at one frequency, which replaces the times; the solution has an imaginary part."""


MODAL: Final = ("EIGVAL", "EIGFREQ", "GM")
"""Whole-model variables of a mode: eigenvalue, frequency in cycles per time, generalized mass."""


@dataclass(frozen=True, slots=True)
class StepStarted:
    """A step begins."""

    step: int


@dataclass(frozen=True, slots=True)
class StepDone:
    """A step is complete."""

    step: int
    increments: int
    cutbacks: int
    iterations: int


@dataclass(frozen=True, slots=True)
class Warned:
    """Warning for the user, printed to .msg."""

    message: str


@dataclass(frozen=True, slots=True)
class SearchHelped:
    """An increment converged only with the descent search of the fall-back; comes before its IncrementDone.

    since       iteration from which on the search worked, of `iterations`
    reason      why it took over
    """

    step: int
    increment: int
    since: int
    iterations: int
    reason: str


@dataclass(frozen=True, slots=True)
class Noted:
    """Note for the user that needs no action, printed to .msg."""

    message: str


@dataclass(frozen=True, slots=True)
class StateKept:
    """The state at the end of an increment, of which all else is written: an analysis can resume from it.

    overlay   it replaces the last one of the step
    analysis  arrays are those of the run: they are written before it goes on
    """

    step: int
    increment: int
    overlay: bool
    analysis: Saved


Record = (
    StepStarted
    | AttemptStarted
    | IterationDone
    | AttemptAbandoned
    | SearchHelped
    | IncrementDone
    | ModesFound
    | BucklingFactors
    | StepDone
    | StateKept
    | Warned
    | Noted
)


@dataclass(frozen=True, slots=True)
class PointVariables:
    """Layout of the SVARS of an element type at its integration points.

    kind    'continuum', 'interface' or, with names that the deck gives, 'user'
    names   name of each variable of a point, in order ('S11', ..., 'DAMAGE'), '' for one without a name
    points  number of points; the variables of point k are SVARS[k*len(names) : (k+1)*len(names)]
    bottom, top  interface only: local nodes (from 0) of the two coincident faces; in the plane both along the tangent:
            left and right end, and the middle if the faces are quadratic
    outline continuum only: local nodes (from 0) of the cell, where the element is not one of the built-in ones
    aliases pairs of a name in Abaqus' output and the name here, where they differ ('S22', 'TN')
    sections section points of an integration point of a shell or beam, which follow each other; `points` counts all
    whole   shells and beams only: names of what is the same at all points of a section
    numbers beams only: numbers of the section points with a line in tables, and their positions among all, from 0
    """

    kind: str
    names: tuple[str, ...]
    points: int
    bottom: tuple[int, ...] = (0, 1)
    top: tuple[int, ...] = (3, 2)
    outline: tuple[int, ...] = ()
    aliases: tuple[tuple[str, str], ...] = ()
    sections: int = 1
    whole: tuple[str, ...] = ()
    numbers: tuple[tuple[int, int], ...] = ()

    @property
    def sides(self) -> tuple[tuple[str, int, int], ...]:
        """Section points with a line in tables: suffix in field output, number, position among all, from 0."""
        if self.numbers:
            return tuple((f"_SP{number}", number, position) for number, position in self.numbers)
        return (("_SNEG", 1, 0), ("_SPOS", self.sections, self.sections - 1)) if self.sections > 1 else ()


@dataclass(frozen=True, slots=True)
class ElementState:
    """Committed element state of one group, for output. Arrays are copies.

    group     index into Model.groups
    svars     (m, number of SVARS)
    energy    (m, 8) as in ENERGY
    variables meaning of the SVARS, None where unknown (a user's own element)
    damages   ENERGY(4) is dissipated by damage, not by plasticity
    """

    group: int
    svars: FloatArray
    energy: FloatArray
    variables: PointVariables | None
    damages: bool = False


@dataclass(frozen=True, slots=True)
class Solution:
    """Converged nodal state and element states.

    node, dof         (n,) node index and dof of each unknown of the model
    displacement      (n,) U
    reaction          (n,) RF, zero where nothing is prescribed
    load              (n,) CF, concentrated load
    velocity, acceleration  (n,) V and A
    energies          whole model, by Abaqus name: ALLSE, ALLPD, ALLDMD, ALLCD, ALLVD, ALLAE, ALLKE, ALLIE, ALLWK,
                      ETOTAL
    elements          a state for each block; read it before the next increment ends
    imaginary         the imaginary part of a harmonic response, of which this is the real one
    contact           (nodes,) contact variables by Abaqus name, NaN at nodes that are in no contact pair
    """

    node: IntArray
    dof: IntArray
    displacement: FloatArray
    reaction: FloatArray
    load: FloatArray
    energies: dict[str, float] = field(default_factory=dict)
    elements: Sequence[ElementState] = ()
    velocity: FloatArray = field(default_factory=lambda: np.zeros(0))
    acceleration: FloatArray = field(default_factory=lambda: np.zeros(0))
    imaginary: Solution | None = None
    contact: dict[str, FloatArray] = field(default_factory=dict)
