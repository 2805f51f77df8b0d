# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Errors and warnings of a block about mistakes of its elements."""

from __future__ import annotations

from uel.elements.array_mistakes import ERRORS, distortion, material_point, write_outside, wrong_entry
from uel.elements.call import Call
from uel.elements.routine import Routine
from uel.errors import ElementError, KernelError
from uel.model.mesh import ElementGroup
from uel.usersub import Library
from uel.usersub.exchange import Outcome
from uel.usersub.faults import Entries, Fault, Guards


class Mistakes:
    """Checks of the passes over a block: a mistake is an error, or a warning after which the run goes on.

    group    elements on this rank
    guards   action of the driver on a write outside an array: an error if strict, otherwise a warning
    entries  action on an entry of RHS or AMATRX that is not set: an error, or a warning and zero
    """

    def __init__(
        self, group: ElementGroup, routine: Routine, unknowns: int, library: Library, *, strict: bool, zeros: bool
    ) -> None:
        """Start without mistakes; unknowns: number in an element; strict and zeros as in `ElementBlock`."""
        self.group, self._routine, self._unknowns, self._library = group, routine, unknowns, library
        self.guards = Guards.STOP if strict else Guards.NOTICE
        self.entries = Entries.NOTICE if zeros else Entries.STOP
        self._noticed: Outcome | None = None

    def check(self, outcome: Outcome, nrhs: int, call: Call) -> None:
        """Raise the ElementError of a pass, or give a warning if the run can go on."""
        if outcome.fault is Fault.UNSET and self.entries is not Entries.STOP:
            self.entries = Entries.ZERO
            error = self._error(outcome, nrhs, call)
            self._library.warn(f"{error}; the run goes on with zeros there before each call")
        elif self.guards is not Guards.STOP and outcome.fault in (Fault.NONE, Fault.OUTSIDE):
            self._warn(outcome, nrhs, call)
        elif outcome.fault is not Fault.NONE:
            raise self._error(outcome, nrhs, call)

    def _warn(self, outcome: Outcome, nrhs: int, call: Call) -> None:
        """Report a write outside an array once; the run goes on, and the next pass finds the element."""
        if self.guards is Guards.SEARCH:
            self.guards = Guards.IGNORE
            found = outcome if outcome.fault is Fault.OUTSIDE else self._noticed
            assert found is not None
            self._library.warn(f"{self._error(found, nrhs, call)}; the run goes on, with extra room after the arrays")
        elif outcome.fault is Fault.OUTSIDE:
            self.guards, self._noticed = Guards.SEARCH, outcome

    def _error(self, outcome: Outcome, nrhs: int, call: Call) -> ElementError:
        element = int(self.group.labels[outcome.position]) if outcome.position >= 0 else 0
        match outcome.fault:
            case Fault.LEFT | Fault.ENDLESS:
                message = material_point(outcome) + self._library.stop_reason()
            case Fault.OUTSIDE:
                message = self._outside(outcome, nrhs)
            case Fault.DISTORTED:
                message = distortion(outcome, getattr(self.group.built_in, "points", 0))
            case _:
                message = wrong_entry(outcome, self._unknowns)
        return ERRORS.get(outcome.fault, KernelError)(element, self.group.type, f"{message} ({call.place})")

    def _outside(self, outcome: Outcome, nrhs: int) -> str:
        sizes = {
            "SVARS": f"{self._routine.svars} (VARIABLES=)",
            "PROPS": f"{len(self._routine.props)} (PROPERTIES=)",
            "COORDS": str(self._routine.mcrd * self.group.nodes.shape[1]),
            "PREDEF": str(2 * self.group.nodes.shape[1]),
        }
        return write_outside(outcome, self._unknowns, nrhs, sizes)
