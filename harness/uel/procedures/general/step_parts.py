# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Part that a procedure adds to the increments of a general step: time integration, damping, a limit of accuracy."""

from __future__ import annotations

from collections.abc import Iterable

from uel.model.records import Record
from uel.model.restart import Saved
from uel.procedures.general.incrementation import Accuracy
from uel.solver.newton import Increment, Iterate


class Part:
    """A part of a general step. Each method by default changes nothing."""

    def start(self) -> Iterable[Record]:
        """Begin the step, before its first increment. Raises KernelError, SingularMatrixError."""
        return ()

    def given(self, given: Increment, size: float) -> Increment:
        """Return the increment with the part's additions to what its end prescribes.

        Parameters
        ----------
        given
            With the additions of the parts before this one; not to be changed, but copied by `dataclasses.replace`.
        size
            Of the increment, in step time.
        """
        return given

    def accuracy(self, last: Iterate, size: float) -> Accuracy | None:
        """Measure the accuracy of the integration over time in an increment in equilibrium.

        Parameters
        ----------
        last
            State after the last iteration.
        size
            Of the increment, in step time.

        Returns
        -------
        Accuracy | None
            The increment is cut back if that of any part is above 1, unless increments are fixed; None: not measured.
        """
        return None

    def converged(self, last: Iterate, size: float) -> Iterable[Record]:
        """Take over a converged increment.

        The state and the step time of the context are still those of its start; the elements have committed theirs.

        Parameters
        ----------
        last
            State after the last iteration.
        size
            Of the increment, in step time.

        Returns
        -------
        Iterable[Record]
            Written after that of the increment.
        """
        return ()

    def kept(self) -> Saved:
        """Return what an increment takes from those before it in the step."""
        return {}

    def resume(self, saved: Saved) -> None:
        """Go on from what `kept` returned; `start` is not called then."""

    @property
    def finished(self) -> bool:
        """True if the part ends the step."""
        return False
