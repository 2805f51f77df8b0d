# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Outcome of a run, in the last sentences of `uel run`."""

from __future__ import annotations

from typing import Final

from uel.errors import MOST_REPEATED
from uel.model.perturbations import PERTURBATION_TIME
from uel.output.results import Result

_FILES: Final = (".sta", ".msg", ".dat", "_history.csv", "_interface.csv", ".pvd")


def ending(result: Result) -> list[str]:
    """Return lines on a completed run: first warnings, increments and iterations, largest load, files."""
    last = result.status[-1]
    # a linear step takes no time, and may have a frequency instead
    time = f", total time {last.total_time:g}" if last.time_increment > PERTURBATION_TIME else ""
    seconds = "" if result.seconds is None else f" in {duration(result.seconds)}"
    warnings, shown = len(result.warnings), min(len(result.warnings), MOST_REPEATED)
    lines = [f"warning: {warning}" for warning in result.warnings[:shown]]
    lines.append(f"{result.job}: completed{time}: {result.counts}{seconds}")
    if warnings:
        above = "above" if warnings == shown else f"the first {shown} above"
        lines.append(f"  warnings in .dat and .msg: {warnings}, {above}")
    if load := largest_load(result):
        lines.append(f"  {load}")
    written = [ending for ending in _FILES if result.file(ending).exists()]
    return [*lines, f"  written: {result.file(written[0])} {' '.join(written[1:])}"]


def progress(result: Result) -> str:
    """Describe the progress of a run that ended early; '' before its first increment was complete."""
    if not result.counts.increments:
        return ""
    load = largest_load(result)
    return f"{result.counts}; {load}" if load else str(result.counts)


def largest_load(result: Result) -> str:
    """Describe the largest load of the load-displacement curve; '' if the history has no such curve."""
    curve = result.load_curve
    if curve is None:
        return ""
    peak = curve.peak
    moment = f"in increment {curve.increment[peak]:.0f} of step {curve.step[peak]:.0f}"
    where = "in the last increment" if peak == len(curve.y) - 1 else moment
    return f"largest load: {curve.y_name} = {curve.y[peak]:.5g} at {curve.x_name} = {curve.x[peak]:.5g}, {where}"


def duration(seconds: float) -> str:
    """Format a time with its unit."""
    if seconds < 0.1:
        return "less than 0.1 s"
    if seconds < 59.5:
        return f"{seconds:.1f} s" if seconds < 10.0 else f"{seconds:.0f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"
