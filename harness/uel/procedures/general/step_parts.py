# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Part that a procedure adds to the increments of a general step: time integration, damping, a limit of accuracy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from uel.elements import Motion
from uel.model.arrays import FloatArray
from uel.model.records import Record
from uel.model.restart import Saved
from uel.procedures.general.incrementation import Accuracy
from uel.solver.newton import Increment, Iterate


@dataclass(frozen=True, slots=True)
class InitialMotion:
    """State at the start of a dynamic step, consistent with its constraints and in equilibrium with its accelerations.

    velocity, acceleration  (n,) V, A
    displacement            (n,) U, with the pressures of incompressible hybrid elements
    external, energy        (n,) and (8,) as in `ConvergedState`
    """

    velocity: FloatArray
    acceleration: FloatArray
    displacement: FloatArray
    external: FloatArray
    energy: FloatArray


@dataclass(frozen=True, slots=True)
class PartStart:
    """Outcome of the start of a part: records, and the motion with which the state begins; None: as it is."""

    remarks: Sequence[Record] = ()
    motion: InitialMotion | None = None


@dataclass(frozen=True, slots=True)
class PartEnd:
    """Outcome of a part at the end of a converged increment.

    remarks        records that are written after that of the increment
    motion         V and A at its end; None: those of its start
    stabilization  energy that artificial damping has dissipated in it
    """

    remarks: Sequence[Record] = ()
    motion: Motion | None = None
    stabilization: float = 0.0


class Part:
    """A part of a general step. Each method by default changes nothing."""

    def start(self) -> PartStart:
        """Begin the step, before its first increment. Raises KernelError, SingularMatrixError."""
        return PartStart()

    def add_to(self, increment: Increment, size: float) -> Increment:
        """Return the increment with the part's additions to what its end prescribes.

        Parameters
        ----------
        increment
            It has the additions of the parts before this one. Copy it by `dataclasses.replace`.
        size
            Step time of the increment.
        """
        return increment

    def accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """Measure the accuracy of the integration over time in an increment in equilibrium.

        Parameters
        ----------
        last
            State after the last iteration.
        size
            Step time of the increment.

        Returns
        -------
        Accuracy | None
            The increment is cut back if that of any part is above 1, unless increments are fixed; None: not measured.

        Raises DistortionError and SingularMatrixError if it takes a pass that fails: the increment is cut back too.
        """
        return None

    def converged(self, last: Iterate, size: float) -> PartEnd:
        """Take over a converged increment.

        The state and the step time of the context are still those of its start; the elements have committed theirs.

        Parameters
        ----------
        last
            State after the last iteration.
        size
            Step time of the increment.

        Returns
        -------
        PartEnd
            Data of the part for the state at the end of the increment.
        """
        return PartEnd()

    def kept(self) -> Saved:
        """Return the data of earlier increments that the next one needs, for *RESTART."""
        return {}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned; `start` is not called then."""

    @property
    def finished(self) -> bool:
        """True if the part ends the step."""
        return False
