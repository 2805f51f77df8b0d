# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS of elements: their state variables (TYPE=SOLUTION) and stresses (TYPE=STRESS)."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from functools import partial
from typing import Protocol

import numpy as np

from uel.assembly import System
from uel.elements import Call, ElementBlock, Flags
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.model.records import Warned
from uel.model.steps import InitialStress
from uel.procedures.state import ConvergedState


class InitialRoutines(Protocol):
    """Addresses of user routines that are called before the first step; None without the routine."""

    sdvini: int | None
    sigini: int | None
    orient: int | None


def set_initial_states(blocks: Iterable[ElementBlock], model: Model, user: InitialRoutines) -> None:
    """Set directions by ORIENT, then state variables by the deck or by SDVINI.

    Parameters
    ----------
    blocks
        Blocks of all elements; their committed state changes.
    model
        Its initial solutions, in their order.
    user
        User routines.

    Raises
    ------
    DeckError
        An entry needs SDVINI, which the job does not have, or has more values than an element has variables; or
        ORIENT defines no directions.
    KernelError
        SDVINI or ORIENT ends the analysis.
    """
    if user.orient is not None:
        for block in blocks:
            block.initial.call_orient(user.orient, model.mesh.labels)
    sdvini = user.sdvini
    for entry in model.initial_solutions:
        if entry.elements is None and sdvini is None:
            raise DeckError(entry.source, "*INITIAL CONDITIONS, USER needs SDVINI, which the job does not have")
        for block in blocks:
            if entry.elements is None:
                assert sdvini is not None
                block.initial.call_sdvini(sdvini)
                continue
            rows = block.rows_of(entry.elements[block.holds(entry.elements)])
            try:
                if block.in_group(entry.elements).any():
                    block.initial.initialise(rows, entry.values)
            except ValueError as error:
                raise DeckError(entry.source, f"*INITIAL CONDITIONS, TYPE=SOLUTION: {error}") from None


def set_initial_stresses(
    system: System, model: Model, state: ConvergedState, user: InitialRoutines
) -> Generator[Warned, None, FloatArray | None]:
    """Set the initial stresses; return nodal forces (n,) that balance them at first, None if there are none.

    Raises DeckError; KernelError if an element is inside out or SIGINI ends the analysis.
    """
    stressed: dict[int, ElementBlock] = {}
    for entry in model.initial_stresses:
        if entry.values is None:
            stressed |= system.agree(partial(_stresses_by_user, system, entry, user))
            continue
        for block in system.blocks:
            if not block.in_group(entry.elements).any():
                continue
            if block.group.definition is not None:
                message = f"user elements ({block.group.type}) do not get initial stresses, nor do they in Abaqus"
                yield Warned(f"{entry.source}: *INITIAL CONDITIONS, TYPE=STRESS has no effect: {message}")
                continue
            rows = block.rows_of(entry.elements[block.holds(entry.elements)])
            try:
                block.initial.set_stress(rows, entry.values if entry.profile is None else entry.profile)
            except ValueError as error:
                raise DeckError(entry.source, f"*INITIAL CONDITIONS, TYPE=STRESS: {error}") from None
            stressed[block.first] = block
    if not model.initial_stresses:
        return None
    call = Call(Flags(1), 1, 0, 0.0, 0.0, 0.0, 0.0, predefined=state.predefined)
    residual = np.zeros(len(system))

    def begin() -> None:
        for block in stressed.values():
            block.begin_stressed(call, state.displacement, residual)

    system.agree(begin)
    residual = system.sum(residual)
    # Analysis User's Guide, Initial conditions: stresses of opposite sign are added and ramped off in the first step.
    # Here they are nodal forces, whose work counts as external work, so that ETOTAL is constant
    return -residual if model.initial_stresses[0].ramped else None


def _stresses_by_user(system: System, entry: InitialStress, user: InitialRoutines) -> dict[int, ElementBlock]:
    """Set the stresses of all built-in elements by SIGINI; return the blocks by their first elements.

    Raises DeckError and KernelError.
    """
    if user.sigini is None:
        message = "*INITIAL CONDITIONS, TYPE=STRESS, USER needs SIGINI, which the job does not have"
        raise DeckError(entry.source, message)
    blocks = {block.first: block for block in system.blocks if block.initial.takes_stress}
    for block in blocks.values():
        block.initial.call_sigini(user.sigini)
    return blocks
