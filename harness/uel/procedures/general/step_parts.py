# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts that procedures add to general steps: time integration, damping, limits of accuracy."""

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
    """Result of the start of a part: records, and the initial motion of the state; None: unchanged."""

    remarks: Sequence[Record] = ()
    motion: InitialMotion | None = None


@dataclass(frozen=True, slots=True)
class PartEnd:
    """Result of a part at the end of a converged increment.

    remarks        records that follow the one of the increment
    motion         V and A at its end; None: those of its start
    stabilization  energy dissipated in it by artificial damping
    """

    remarks: Sequence[Record] = ()
    motion: Motion | None = None
    stabilization: float = 0.0


class Part:
    """Part of a general step. By default its methods change nothing."""

    def start(self) -> PartStart:
        """Begin the step, before its first increment. Raises KernelError, SingularMatrixError."""
        return PartStart()

    def add_to(self, increment: Increment, size: float) -> Increment:
        """Return the increment with the additions of this part to its definition.

        Parameters
        ----------
        increment
            Increment with the additions of earlier parts. Copy it by `dataclasses.replace`.
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
            The increment is cut back if a measure is above 1, unless increments are fixed; None: not measured.

        Raises DistortionError and SingularMatrixError if a pass fails; the increment is then cut back too.
        """
        return None

    def converged(self, last: Iterate, size: float) -> PartEnd:
        """Take over a converged increment.

        The state and the step time of the context are still those of its start; elements have been committed.

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
