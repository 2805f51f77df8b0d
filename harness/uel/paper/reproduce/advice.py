# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Advice from the numbers of the sensitivities alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

SETTLED = 0.01
"""Peak loads, and slopes, closer than this count as equal."""
SMOOTHER = 0.05
"""A variation of the traction that is lower by this counts as lower."""


@dataclass(frozen=True, slots=True)
class Point:
    """Results at a value of a parameter.

    The value as shown; peak load in small increments, and as the run's own increments sample it (N); variation of the
    traction (MPa); slope of the load curve in the first increment (N/mm).
    """

    value: str
    peak: float
    sampled: float
    variation: float
    slope: float


Curves = Mapping[str, Sequence[Point]]
"""Values in the order of the table, by label of the curve."""


def settled(points: Sequence[Point]) -> Point | None:
    """Find the first value from which on peak load and slope are those of the last; None if that is the last alone."""
    last = points[-1]
    for k, point in enumerate(points[:-1]):
        changes = [change for other in points[k:] for change in _changes(other, last)]
        if max(map(abs, changes)) <= SETTLED:
            return point
    return None


def _changes(one: Point, other: Point) -> tuple[float, float]:
    """Return the relative changes of peak load and slope."""
    return other.peak / one.peak - 1.0, other.slope / one.slope - 1.0


def on_lengths(curves: Curves) -> str:
    """Advise on lengths of elements, from the largest."""
    starts = {label: settled(points) for label, points in curves.items()}
    enough = [f"{label}: {start.value} mm" for label, start in starts.items() if start is not None]
    close = f"Peak load and slope are within {SETTLED:.0%} of those of the shortest elements from these lengths on"
    texts = [f"{close}: {'; '.join(enough)}."] if enough else []
    for label, start in starts.items():
        if start is None:
            peak, slope = _changes(*curves[label][-2:])
            texts.append(
                f"{label}: by the last refinement still {peak:+.1%} of the peak load and {slope:+.1%} of the slope; "
                "take shorter elements and compare."
            )
    return " ".join(texts)


def on_increments(curves: Curves) -> str:
    """Advise on numbers of increments, from the least."""
    texts = [f"Peak loads of the table are those in small increments, which these numbers change by {_most(curves)}."]
    for label, points in curves.items():
        missed = [point.sampled / point.peak - 1.0 for point in points]
        close = [k for k in range(len(points)) if all(abs(miss) <= SETTLED for miss in missed[k:])]
        ends = f"{points[0].value} increments give {missed[0]:+.1%}, {points[-1].value} {missed[-1]:+.1%}"
        start = f"within {SETTLED:.0%} from {points[close[0]].value} on" if close else f"none within {SETTLED:.0%}"
        texts.append(f"{label}: as their own load curves have it, {ends}; {start}.")
    return " ".join(texts)


def on_stiffness(curves: Curves) -> str:
    """Advise on stiffnesses, from the lowest."""
    texts = []
    for label, points in curves.items():
        start, last = settled(points), points[-1]
        if start is None:
            peak, slope = _changes(points[-2], last)
            texts.append(
                f"{label}: not settled; up to {last.value} the peak load changes by {peak:+.1%}, "
                f"the slope by {slope:+.1%}."
            )
            continue
        before = points[-2]
        words = f"{label}: peak load and slope are settled from {start.value} on"
        if last.variation > (1.0 + SMOOTHER) * before.variation:
            words += (
                f", while the traction varies more and more, {_from_to(before, last)} from {before.value} to "
                f"{last.value}: take no more than {start.value}."
            )
        else:
            words += (
                f", and up to {last.value} the traction's variation settles, at {last.variation:.0f} MPa: take any."
            )
        texts.append(words)
    return " ".join(texts)


def on_strength(curves: Curves) -> str:
    """Advise on strengths."""
    changes = {
        label: max(point.peak for point in points) / min(point.peak for point in points) - 1.0
        for label, points in curves.items()
    }
    first, last = (next(iter(curves.values()))[k].value for k in (0, -1))
    shares = ", ".join(f"{change:.1%} ({label})" for label, change in changes.items())
    text = f"From {first} to {last} times the strengths the peak load changes by {shares}."
    if max(changes.values()) > SETTLED:
        return f"{text} Measure the strengths, or give their effect on the peak load with the result."
    return f"{text} The strengths need not be known well."


def on_choice(curves: Curves, default: str) -> str:
    """Advise on values in no order, of which one is the default."""
    texts = []
    for label, points in curves.items():
        usual = next((point for point in points if point.value == default), None)
        if usual is None:
            texts.append(f"{label}: the run with the default has not finished.")
            continue
        best = min(points, key=lambda point: point.variation)
        if best.variation < (1.0 - SMOOTHER) * usual.variation:
            change = best.peak / usual.peak - 1.0
            texts.append(
                f"{label}: with {best.value} the traction varies less than with the default, {_from_to(usual, best)}; "
                f"the peak load changes by {change:+.1%}."
            )
    if texts:
        return " ".join([f"Default: {default}.", *texts])
    return f"Keep the default, {default}: with no other value does the traction vary less by more than {SMOOTHER:.0%}."


def _most(curves: Curves) -> str:
    spans = [
        max(point.peak for point in points) / min(point.peak for point in points) - 1.0 for points in curves.values()
    ]
    return f"{max(spans):.1%} at most"


def _from_to(one: Point, other: Point) -> str:
    return f"{one.variation:.0f} to {other.variation:.0f} MPa"
