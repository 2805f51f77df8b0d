# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""An increment made in equal parts, each of which starts from the state that the one before has left."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from uel.check.element_calls import ElementState
from uel.check.single import Returned
from uel.elements import Call


def in_pieces(state: ElementState, ends: list[float]) -> Iterator[Returned]:
    """Make the increment of a state in parts that end at these fractions of it; yields what each part returns.

    Fractions above 1 continue at the rates of the increment: displacements, time, loads and fields.
    """
    single, before = state.single.twin(strict=False), 0.0
    for number, end in enumerate(ends):
        share, left = end - before, 1.0 - end
        call = _part(state.call, number, share, left)
        yield replace(state, single=single, call=call, u=state.u - left * state.du, du=share * state.du).evaluate()
        single.block.commit()
        before = end


def _part(call: Call, number: int, share: float, left: float) -> Call:
    """Return the call of a part of an increment; share: its size over the increment's; left: the share after it."""
    loads, fields, size = call.distributed, call.predefined, call.time_increment
    return replace(
        call,
        increment=call.increment + number,
        time_increment=share * size,
        step_time=call.step_time - left * size,
        total_time=call.total_time - left * size,
        distributed=loads and replace(loads, end=loads.end - left * loads.increment, increment=share * loads.increment),
        predefined=fields
        and replace(fields, end=fields.end - left * fields.increment, increment=share * fields.increment),
    )
