# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of a job for compiling and calling user routines."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Self

from uel.elements.threads import MOST_THREADS, known_routines
from uel.errors import UsageError
from uel.model.model import Model


@dataclass(frozen=True, slots=True, kw_only=True)
class RoutineOptions:
    """Options for compiling and calling user routines.

    Parameters
    ----------
    linear
        Types of user elements, such as 'U5', that are linear: in static steps with small displacements their first
        AMATRX stands for them, and they are called again only at the end of each increment, which verifies it. Elastic
        continuum elements, built in and the project's own, are always treated so, and called again only where their
        state is read.
    cpus
        Threads that call the elements; results are those of one thread to the bit. All of them call built-in elements
        and the project's own, except U3 and U10, which share stress; other routines if `thread_safe` names them.
    thread_safe
        Routines that several threads may call at the same time, as Abaqus does with cpus=2: types of user elements,
        such as 'U5', UMAT and USDFLD. They pass the checks 'shuffle' and 'threads' of `uel check`.
    call_limit
        Seconds that one call of a user routine may take; 0: no limit.
    debug
        Compile the user's files with run-time checks and stop at the first NaN or infinity, so that errors have file
        and line. Slower; a local variable without a value is an error, not zero. With AddressSanitizer if its runtime
        was loaded first, as the command `uel` does (harness/uel/running/sanitizer.py).

    Raises
    ------
    UsageError
        The number of threads is not allowed, or it is not 1 with `debug`.
    """

    linear: Collection[str] = ()
    cpus: int = 1
    thread_safe: Collection[str] = ()
    call_limit: float = 0.0
    debug: bool = False

    def __post_init__(self) -> None:
        if not 1 <= self.cpus <= MOST_THREADS:
            raise UsageError(f"--cpus {self.cpus}: expected a number from 1 to {MOST_THREADS}")
        if self.cpus > 1 and self.debug:
            raise UsageError(f"--cpus {self.cpus}: run-time checks (--debug) need one thread")

    def for_model(self, model: Model) -> Self:
        """Return these options with names in capitals. Raises UsageError for names that the model does not have."""
        return replace(self, linear=_linear_types(model, self.linear), thread_safe=_safe(model, self.thread_safe))


def _linear_types(model: Model, names: Collection[str]) -> frozenset[str]:
    """Return the types of user elements declared linear, in capitals. Raises UsageError."""
    known = sorted({group.type for group in model.groups if group.definition is not None})
    types = frozenset(name.upper() for name in names)
    for name in sorted(types.difference(known)):
        has = f"its user elements are {', '.join(known)}" if known else "it has no user elements"
        raise UsageError(f"--linear {name}: the deck has no elements of this type; {has}")
    return types


def _safe(model: Model, names: Collection[str]) -> frozenset[str]:
    """Return the routines declared thread-safe, in capitals. Raises UsageError."""
    known = known_routines(model)
    routines = frozenset(name.upper() for name in names)
    for name in sorted(routines.difference(known)):
        has = f"it calls {', '.join(known)}" if known else "it calls no user elements or materials"
        raise UsageError(f"--thread-safe {name}: the deck does not call it; {has}")
    return routines
