# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Subdivision of an increment, each part starting from the state at the end of the previous one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from uel.check.element_calls import ElementState
from uel.check.single import Returned
from uel.elements import Call


def subdivide(state: ElementState, ends: list[float]) -> Iterator[Returned]:
    """Subdivide the increment of a state at the given fractions; yields the results of each part.

    Fractions above 1 continue at the rates of the increment: displacements, time, loads and fields.
    """
    single, before = state.single.twin(strict=False), 0.0
    for number, end in enumerate(ends):
        fraction, rest = end - before, 1.0 - end
        call = _part_call(state.call, number, fraction, rest)
        yield replace(state, single=single, call=call, u=state.u - rest * state.du, du=fraction * state.du).evaluate()
        single.block.commit()
        before = end


def _part_call(call: Call, number: int, fraction: float, rest: float) -> Call:
    """Return the call of a part of an increment; fraction: its relative size; rest: the fraction after it."""
    loads, fields, size = call.distributed, call.predefined, call.time_increment
    return replace(
        call,
        increment=call.increment + number,
        time_increment=fraction * size,
        step_time=call.step_time - rest * size,
        total_time=call.total_time - rest * size,
        distributed=loads
        and replace(loads, end=loads.end - rest * loads.increment, increment=fraction * loads.increment),
        predefined=fields
        and replace(fields, end=fields.end - rest * fields.increment, increment=fraction * fields.increment),
    )
