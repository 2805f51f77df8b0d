# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""S-N points of an interface: the lives of CF20 under a constant traction, and their fit.

A traction of S times the strength fails after N = 10^7 (E/S)^b (1 - S^(b + EXPONENT + 1)) cycles (fortran/laws.md,
Fatigue). The logarithms of N scatter by a normal distribution of standard deviation sigma. Tests that ended without
failure, runouts, say that N is more: the likelihood is that of censored data (M. Aitkin, Technometrics 23 (1981) 161),
whose largest value the expectation-maximisation of that paper finds. Without runouts that is least squares.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.stats import norm

from uel.batch.table import read_cells
from uel.errors import DeckError, Source, UelError, UsageError
from uel.fit.endurance import BRITTLENESS, CYCLES, ENDURANCE, endurance_limit
from uel.fit.estimate import CONVERGED, Fit
from uel.fit.logarithmic import LogarithmicMeasurement
from uel.fit.uncertainty import ROUNDING, assess
from uel.fit.variables import Variable, coordinates, values_at
from uel.model.arrays import FloatArray
from uel.output.pictures.column import Column

DEFAULTS: Final[Mapping[str, float]] = {"ENDURANCE": ENDURANCE, "BRITTLENESS": BRITTLENESS, "EXPONENT": 0.0}
"""Values of the properties that are not fitted."""
RANGES: Final[Mapping[str, tuple[float, float]]] = {
    "ENDURANCE": (0.0, 1.0),
    "BRITTLENESS": (0.0, np.inf),
    "EXPONENT": (-1.0, np.inf),
}
"""Bounds that the law needs, without the ends."""
COLUMNS: Final[Mapping[str, tuple[float, float, str]]] = {
    "S": (0.0, 1.0, "above 0 and below 1"),
    "CYCLES": (0.0, np.inf, "above 0"),
    "R": (-1.0 - 1e-9, 1.0, "from -1 to below 1"),
    "B": (-1e-9, 1.0 + 1e-9, "from 0 to 1"),
    "RUNOUT": (-1e-9, 1.0 + 1e-9, "0 or 1"),
}
"""Columns of the file, with the ends of their values."""
NEEDED: Final = ("S", "CYCLES")
ROUNDS: Final = 500
"""Most steps of the expectation-maximisation."""
STEADY: Final = 1e-5
"""Change of the coordinates and of sigma at which it ends."""


@dataclass(frozen=True, slots=True)
class Lives(LogarithmicMeasurement):
    """Measured lives, in the order of R, B and S.

    x       (n,) S, greatest traction over strength
    y       (n,) logarithm of the cycles to failure, or to the end of the test
    ratio   (n,) R
    shear   (n,) B
    runout  (n,) True where the test ended without failure
    """

    ratio: FloatArray
    shear: FloatArray
    runout: NDArray[np.bool_]

    @property
    def beside(self) -> dict[str, FloatArray]:
        """Columns of the table beside x and y."""
        return {"R": self.ratio, "B": self.shear, "RUNOUT": self.runout.astype(float)}

    @property
    def marks(self) -> dict[str, NDArray[np.bool_]]:
        """Failures, and runouts if there are any."""
        return {"measured": ~self.runout, **({"runout": self.runout} if self.runout.any() else {})}

    @property
    def parts(self) -> list[slice]:
        """Points of one R and B each."""
        changes = np.flatnonzero((np.diff(self.ratio) != 0.0) | (np.diff(self.shear) != 0.0)) + 1
        ends = [0, *changes.tolist(), len(self.x)]
        return [slice(a, b) for a, b in pairwise(ends)]

    def computed(self, properties: Mapping[str, float]) -> FloatArray:
        """Return the logarithms of the lives (n,) with these properties."""
        return log_life(self.x, self.ratio, self.shear, **{name.lower(): at for name, at in properties.items()})


def log_life(
    level: FloatArray, ratio: FloatArray, shear: FloatArray, *, endurance: float, brittleness: float, exponent: float
) -> FloatArray:
    """Return the logarithms of the lives (n,) at S, R and B, (n,) each; below E as if there were no threshold."""
    limit, slope = endurance_limit(ratio, shear, endurance, brittleness)
    power = slope + exponent + 1.0
    return np.asarray(np.log(CYCLES) + slope * np.log(limit / level) + np.log1p(-(level**power)))


def read_lives(path: Path) -> Lives:
    """Read S-N points from a CSV file: a line of names, S, CYCLES and of R, B, RUNOUT what is measured, then numbers.

    Raises
    ------
    UsageError
        The file cannot be read.
    DeckError
        With file:line where a line is not as expected.
    """
    names: list[str] = []
    rows: list[list[float]] = []
    for source, words in read_cells(path, str(path)):
        if names:
            rows.append(_row(source, names, words))
            continue
        names = [word.upper() for word in words]
        if not set(NEEDED) <= set(names) <= set(COLUMNS) or len(set(names)) < len(names):
            raise DeckError(source, f"expected columns S, CYCLES and of R, B, RUNOUT any, found {', '.join(words)}")
    if not rows:
        raise DeckError(Source(str(path), 1), "expected a line of names, such as S, CYCLES, and a line for each point")
    table = dict(zip(names, np.array(rows).T, strict=True))
    none = np.zeros(len(rows))
    level, ratio, shear = table["S"], table.get("R", none), table.get("B", none)
    order = np.lexsort((level, shear, ratio))
    return Lives(
        level[order],
        np.log(table["CYCLES"][order]),
        (Column("S"), Column("CYCLES")),
        ratio[order],
        shear[order],
        table.get("RUNOUT", none)[order] == 1.0,
    )


def _row(source: Source, names: Sequence[str], words: Sequence[str]) -> list[float]:
    if len(words) != len(names):
        raise DeckError(source, f"expected a number for each of {', '.join(names)}, found {len(words)}")
    values = []
    for name, word in zip(names, words, strict=True):
        low, high, expected = COLUMNS[name]
        try:
            value = float(word)
            if not low < value < high or (name == "RUNOUT" and value not in (0.0, 1.0)):
                raise ValueError
        except ValueError:
            raise DeckError(source, f"{name}: expected a number {expected}, found '{word}'") from None
        values.append(value)
    return values


def check_properties(variables: Sequence[Variable]) -> None:
    """Raise UsageError for a variable that S-N points do not depend on, or whose bounds the law does not permit."""
    for variable in variables:
        if variable.name not in RANGES:
            raise UsageError(f"'{variable.name}': S-N points depend on {', '.join(RANGES)}")
        low, high = RANGES[variable.name]
        if not low < variable.low or not variable.high < high:
            ends = f"above {low:g}" + (f" and below {high:g}" if np.isfinite(high) else "")
            raise UsageError(f"{variable.name}: expected bounds {ends}")


def fit_lives(measured: Lives, variables: Sequence[Variable]) -> Fit:
    """Fit properties to lives.

    The variance is the expected sum of squares over the points less the variables; intervals are from the second
    derivatives of the likelihood, which include that of sigma, and Student's t for the failures less the variables.

    Raises
    ------
    UelError
        There are too few failures.
    """
    failures, unknowns = int(np.sum(~measured.runout)), len(variables)
    freedom = failures - unknowns
    if freedom < 1:
        raise UelError(f"{failures} failures for {unknowns} properties: expected more failures than properties")
    start, low, high = (coordinates(variables, name) for name in ("start", "low", "high"))

    def curve(point: FloatArray) -> FloatArray:
        named = zip(variables, values_at(variables, point), strict=True)
        return measured.computed({**DEFAULTS, **{variable.name: float(value) for variable, value in named}})

    point, target, sigma = start, measured.y, 0.0
    ended = f"the limit of {ROUNDS} steps"
    for _ in range(ROUNDS):
        found = least_squares(
            lambda at, target=target: curve(at) - target, point, bounds=(low, high), xtol=1e-10, ftol=1e-12, gtol=1e-10
        )
        mean = curve(found.x)
        hazard, z = _runouts(measured, mean, sigma)
        squares = np.where(measured.runout, sigma**2 * (1.0 + z * hazard), (mean - measured.y) ** 2)
        # at first runouts count as failures
        squares = squares if sigma else (mean - measured.y) ** 2
        before = np.append(point, sigma)
        point = found.x
        sigma = max(float(np.sqrt(np.sum(squares) / (len(target) - unknowns))), ROUNDING)
        if np.abs(np.append(point, sigma) - before).max() < STEADY:
            ended = CONVERGED
            break
        hazard, _ = _runouts(measured, mean, sigma)
        target = np.where(measured.runout, mean + sigma * hazard, measured.y)
    slopes = np.asarray(found.jac)
    residual = mean - target
    return Fit(
        values=values_at(variables, point),
        certainty=assess(
            variables,
            point,
            residual,
            slopes,
            _information(measured, mean, sigma, slopes),
            slopes.T @ residual / sigma**2,
            freedom,
        ),
        sensitivity=slopes,
        curve=mean,
        start=curve(start),
        deviation=sigma,
        ended=ended,
    )


def _runouts(measured: Lives, mean: FloatArray, sigma: float) -> tuple[FloatArray, FloatArray]:
    """Return hazard of the normal distribution and z (n,) at the ends of the tests, 0 for failures."""
    if not sigma:
        return np.zeros_like(mean), np.zeros_like(mean)
    z = np.where(measured.runout, (measured.y - mean) / sigma, 0.0)
    return np.where(measured.runout, np.exp(norm.logpdf(z) - norm.logsf(z)), 0.0), z


def _information(measured: Lives, mean: FloatArray, sigma: float, slopes: FloatArray) -> FloatArray:
    """Return the second derivatives (k, k) of the negative log-likelihood, at the best sigma for each point."""
    hazard, z = _runouts(measured, mean, sigma)
    steepness = hazard * (hazard - z)
    weights = np.where(measured.runout, steepness, 1.0)
    mixed = slopes.T @ (hazard + z * steepness) / sigma
    of_sigma = float(np.sum(np.where(measured.runout, z * (hazard + z * steepness), 2.0)))
    return np.asarray(slopes.T @ (weights[:, None] * slopes) / sigma**2 - np.outer(mixed, mixed) / of_sigma)
