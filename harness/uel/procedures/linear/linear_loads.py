# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Loads and prescribed values of a linear step at a frequency or a time, with their amplitudes."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from uel.model.steps import Boundary, ElementLoad, Load, Step

Entry = TypeVar("Entry", Boundary, Load, ElementLoad)


def step_at(step: Step, at: tuple[float, float], *, imaginary: bool = False, without: float = 1.0) -> Step:
    """Return the step with the real or the imaginary part of its loads and prescribed values.

    at       arguments of the amplitudes: step and total time, or the frequency twice
    without  factor of entries without an amplitude
    """

    def scaled(entry: Entry) -> Entry:
        if isinstance(entry, ElementLoad) and entry.type.jltyp:
            # no amplitude applies to the magnitudes that DLOAD gets
            return entry
        if entry.amplitude is None:
            return replace(entry, magnitude=without * entry.magnitude)
        factor = entry.amplitude.value(*at)
        return replace(entry, magnitude=factor if entry.amplitude.absolute else entry.magnitude * factor)

    def part(entries: tuple[Entry, ...]) -> tuple[Entry, ...]:
        return tuple(scaled(entry) for entry in entries if entry.imaginary == imaginary)

    return replace(
        step,
        boundaries=part(step.boundaries),
        loads=part(step.loads),
        element_loads=part(step.element_loads),
        surface_loads=part(step.surface_loads),
    )
