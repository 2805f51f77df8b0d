# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Outcome of a fit: lines for the user, tables and a picture."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from uel.fit.curve import Measurement
from uel.fit.estimate import Fit
from uel.fit.uncertainty import LEVEL
from uel.fit.variables import Variable

BOUNDS: Final = {-1: "lower", 1: "upper"}
SAME: Final = 0.9
"""Correlation from which on two variables cannot be told apart."""


def summary(variables: Sequence[Variable], measured: Measurement, result: Fit, ended: str) -> list[str]:
    """Describe a fit: how it ended, why it may not be reliable, and the variables."""
    certainty = result.certainty
    lines = [f"{ended}; {measured.spread(result.deviation)}"]
    if not result.converged:
        lines.append("the search has not converged: values and intervals are not reliable; allow more runs")
    if not certainty.noise:
        lines.append(
            f"the residuals are not noise: neighbours along {measured.columns[0]} go together (Durbin-Watson "
            f"{certainty.statistic:.2f}, p = {certainty.probability:.1g}). The model cannot follow the measurement, or "
            "its errors depend on each other: the intervals are not to be trusted"
        )
    for variable, bound in zip(variables, certainty.bounds.tolist(), strict=True):
        if bound:
            lines.append(
                f"{variable.name} is at its {BOUNDS[bound]} bound: the measurement asks for "
                f"{'more' if bound > 0 else 'less'}. The bound is too narrow, or the model cannot follow the "
                "measurement; other intervals hold for this value alone"
            )
    lines += [_line(k, variable, measured, result) for k, variable in enumerate(variables)]
    for i in range(len(variables)):
        for k in range(i):
            if abs(certainty.correlation[i, k]) > SAME:
                lines.append(
                    f"{variables[k].name} and {variables[i].name} cannot be told apart by this curve: correlation "
                    f"{certainty.correlation[i, k]:.2f}"
                )
    return lines


def _line(k: int, variable: Variable, measured: Measurement, result: Fit) -> str:
    """Describe a variable."""
    certainty = result.certainty
    low, high = certainty.intervals[k]
    interval = f"{LEVEL:.0%} between {low:.5g} and {high:.5g}"
    if bound := int(certainty.bounds[k]):
        interval = f"at its {BOUNDS[bound]} bound, no interval"
    elif not result.reliable:
        interval += ", not reliable"
    largest = 0.01 * float(np.abs(result.sensitivity[:, k]).max())
    return (
        f"{variable.name} = {result.values[k]:.5g}, {interval}; {variable.hundredth} of it {measured.change(largest)}"
    )


def _note(bound: int, result: Fit) -> str:
    """Return what makes the interval of a variable unreliable, '' if nothing does."""
    reasons = {
        "not converged": not result.converged,
        "residuals are not noise": not result.certainty.noise,
        f"at its {BOUNDS.get(bound)} bound": bound != 0,
        "another at its bound": not bound and result.certainty.bounds.any(),
    }
    return "; ".join(reason for reason, holds in reasons.items() if holds)


def write_tables(stem: Path, variables: Sequence[Variable], measured: Measurement, result: Fit) -> None:
    """Write NAME_fit.csv with the variables, and NAME_fit_curve.csv with the curves and their derivatives."""
    names = [variable.name for variable in variables]
    certainty = result.certainty
    head = ["name", "value", "lower", "upper", "note", "start", "low", "high"]
    rows = [
        [v.name, value, *interval, _note(int(bound), result), v.start, v.low, v.high, *correlation]
        for v, value, interval, bound, correlation in zip(
            variables, result.values, certainty.intervals, certainty.bounds, certainty.correlation, strict=True
        )
    ]
    _write_table(Path(f"{stem}.csv"), [*head, *(f"correlation {name}" for name in names)], rows)
    x, y = map(str, measured.columns)
    head = [x, *measured.beside, f"measured {y}", f"fitted {y}", f"start {y}", *(f"{name} d/d{name}" for name in names)]
    written = [measured.written(values) for values in (measured.y, result.curve, result.start)]
    columns = [measured.x, *measured.beside.values(), *written, *result.sensitivity.T]
    _write_table(Path(f"{stem}_curve.csv"), head, np.column_stack(columns).tolist())


def _write_table(path: Path, head: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows([[f"{c:.9g}" if isinstance(c, float) else c for c in row] for row in rows])


def draw(path: Path, variables: Sequence[Variable], measured: Measurement, result: Fit) -> None:
    """Draw the curves, and how they depend on the variables."""
    from uel.output.pictures.plots import Curve, Panel, grid  # noqa: PLC0415 (the runs come first)

    x, y = map(str, measured.columns)
    points = measured.written(measured.y)
    curves = [Curve(label, measured.x[rows], points[rows], "points") for label, rows in measured.marks.items()]
    for label, kind, values in (("start", "reference", result.start), ("fitted", "line", result.curve)):
        written = measured.written(values)
        curves += [Curve(label, measured.x[part], written[part], kind) for part in measured.parts]
    depends = [
        Curve(f"{v.hundredth} {v.name}", measured.x[part], 0.01 * result.sensitivity[part, k])
        for k, v in enumerate(variables)
        for part in measured.parts
    ]
    left = Panel("", curves, x, y, logarithmic="xy" if measured.logarithmic else "")
    right = Panel("", depends, x, measured.difference, logarithmic="x" if measured.logarithmic else "")
    grid([[left, right]], path)
