# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Replay of the run in a build with run-time checks, in which uninitialised variables are NaN."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from uel.check.finding import Finding, failed, not_applicable, passed
from uel.check.recording import Build, Event, Pass, Recording
from uel.check.replay import abaqus_order, replay
from uel.check.subject import Subject
from uel.errors import CompileError, KernelError
from uel.model.arrays import FloatArray
from uel.usersub import is_source, names_line, trap

PASSES: Final = 8
"""Number of first passes of the run that are repeated, with the elements called in Abaqus' order."""

ROUNDING: Final = 1e-9
"""Largest difference with causes other than an uninitialised variable, relative to the largest entry of its kind."""

ADVICE: Final = (
    "It happens in the calls of the run, perhaps without visible harm. `uel run --debug` stops there; in Abaqus it "
    "reads or writes other data, and results differ from machine to machine."
)


UNSET: Final = "a local variable is used before it has a value"


@dataclass(frozen=True, slots=True)
class _Replayed:
    """Results (elements of the type, entries) of each pass, names of the entries, and the first error."""

    values: list[FloatArray]
    names: list[str]
    refusal: KernelError | None


def check(subject: Subject) -> Finding:
    """Check that run-time checks find nothing and that uninitialised local variables have no effect."""
    recording = subject.recording
    if not recording.user or not all(map(is_source, recording.user)):
        return not_applicable("there are no user sources to compile")
    short = replace(recording, events=_first(recording))
    try:
        zeros = _replayed(short, subject.type, Build(zero_locals=True, debug=True))
        marked = _replayed(short, subject.type, Build(debug=True))
    except CompileError as error:
        return not_applicable(f"with run-time checks it does not compile: {error}")
    # an element that ends calls of the ordinary build may end these too
    if zeros.refusal and (subject.order.refusal is None or names_line(str(zeros.refusal))):
        return failed(f"{zeros.refusal}{_line(short, subject.type, zeros.refusal)}", ADVICE)
    if marked.refusal and not zeros.refusal:
        return failed(f"{UNSET}: {marked.refusal}{_line(short, subject.type, marked.refusal)}", ADVICE)
    if difference := _difference(zeros, marked):
        return failed(f"{UNSET}: {difference}{_line(short, subject.type)}", ADVICE)
    return passed(f"run-time checks find nothing in {len(zeros.values)} passes of the run")


def _first(recording: Recording) -> tuple[Event, ...]:
    """Return the events up to the last pass to be repeated."""
    passes = [k for k, event in enumerate(recording.events) if isinstance(event, Pass)]
    return recording.events[: passes[min(PASSES, len(passes)) - 1] + 1]


def _replayed(recording: Recording, kind: str, build: Build) -> _Replayed:
    """Repeat the calls of the elements of a type."""
    values: list[FloatArray] = []
    names: list[str] = []
    with closing(replay(replace(recording, build=build), abaqus_order, strict=False)) as passes:
        for elements, results in passes:
            mine = np.flatnonzero(elements.types == kind).tolist()
            if refusal := next((results.refusals[k] for k in mine if k in results.refusals), None):
                return _Replayed(values, names, refusal)
            size = elements.starts[mine[0] + 1] - elements.starts[mine[0]]
            names = names or [elements.entry(mine[0], k) for k in range(size)]
            values.append(np.array([results.values[elements.starts[k] : elements.starts[k + 1]] for k in mine]))
    return _Replayed(values, names, None)


def _difference(zeros: _Replayed, marked: _Replayed) -> str:
    """Name, in a sentence, a result that uninitialised variables change; '' if there is none."""
    arrays = np.array([name.partition("(")[0] for name in zeros.names])
    magnitudes = np.max([np.nanmax(np.abs(values), axis=0) for values in zeros.values], axis=0)
    scale = np.array([magnitudes[arrays == array].max() for array in arrays])
    for first, second in zip(zeros.values, marked.values, strict=True):
        with np.errstate(invalid="ignore", over="ignore"):
            wrong = ~(np.abs(first - second) <= ROUNDING * scale) & np.isfinite(first)
        if wrong.any():
            row, column = np.argwhere(wrong)[0].tolist()
            value, other = first[row, column], second[row, column]
            return (
                f"{zeros.names[column]} is {value:.10g} where such variables are zero, {other:.10g} where they are NaN"
            )
    return ""


def _line(recording: Recording, kind: str, error: KernelError | None = None) -> str:
    """Return the line of the first operation on NaN, as the end of a sentence; '' if the error already has a line."""
    if error is not None and names_line(str(error)):
        return ""
    trapping = trap(True)
    try:
        refusal = _replayed(recording, kind, Build(debug=True)).refusal
    finally:
        trap(trapping)
    return f"; {refusal}" if refusal and names_line(str(refusal)) else ""
