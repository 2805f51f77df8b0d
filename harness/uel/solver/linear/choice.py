# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear solvers, and the choice of one."""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stderr
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.errors import UsageError
from uel.model.arrays import FloatArray
from uel.solver.linear.band import BandSolver
from uel.solver.linear.linear_solver import LinearSolver, Pattern
from uel.solver.linear.mumps import MumpsSolver
from uel.solver.linear.ordering import BandOrdering, narrowest
from uel.solver.linear.pardiso import PardisoSolver
from uel.solver.linear.superlu import SuperLUSolver

SOLVERS: Final[dict[str, type[LinearSolver]]] = {
    solver.name: solver for solver in (BandSolver, PardisoSolver, MumpsSolver, SuperLUSolver)
}
"""Linear solvers by name. `auto` takes the band solver for narrow models, else the first other one installed.

The limit, `widest_band`, comes from the times in measured.json. The time of the band solver per unknown grows with the
square of the half bandwidth, that of the others hardly at all in the plane, and in space like the size of the model.
"""

LARGEST_BAND: Final = 2**33
"""Largest band storage in bytes; other solvers need more for slender bodies of this size."""


SLOW: Final = 10_000
"""Unknowns in space from which on superlu takes three times as long as pardiso (solvers.md)."""

FAST: Final = "pip install pypardiso"


@dataclass(frozen=True, slots=True)
class Availability:
    """Row of the table of solvers; note: when `auto` takes the solver, or why it cannot be used."""

    name: str
    installed: bool
    version: str
    note: str


def available() -> list[Availability]:
    """List all solvers, in the order in which `auto` tries them."""
    rows = []
    for name, solver in SOLVERS.items():
        obstacle = _obstacle(solver)
        try:
            release = version(solver.distribution)
        except PackageNotFoundError:
            release = ""
        note = _when(solver) + (f" ({obstacle})" if obstacle else "")
        rows.append(Availability(name, not obstacle, release, note))
    return rows


def _when(solver: type[LinearSolver]) -> str:
    """Describe when `auto` takes a solver."""
    others = [other for other in SOLVERS.values() if other is not BandSolver]
    if solver is BandSolver:
        widths = ", ".join(f"{'/'.join(map(str, other.widest_band))} (against {other.name})" for other in others)
        return f"auto, half bandwidth in the plane/in space up to {widths}, as in slender bodies"
    first = [other.name for other in others[: others.index(solver)]]
    return "auto, wider models" + (f" without {' and '.join(first)}" if first else "")


def choose(
    name: str,
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    *,
    coordinates: FloatArray | None = None,
    name_of: Callable[[int], tuple[str, int]] | None = None,
) -> LinearSolver:
    """Choose the solver for matrices of a CSR pattern: the one named, or with 'auto' the one that should be fastest.

    Parameters
    ----------
    name
        'auto', or one of SOLVERS.
    indptr, indices
        Symmetric pattern, columns ascending in each row.
    coordinates
        (n, 3) of the node of each unknown: a slender body is numbered along its length.
    name_of
        Node name and dof of an unknown, for the message of a singular matrix.

    Raises
    ------
    UsageError
        The name is unknown, or what the solver needs is not installed.
    """
    pattern = Pattern(indptr, indices, coordinates)
    if name == "auto":
        return _quickest(pattern, name_of)
    if name not in SOLVERS:
        raise UsageError(f"unknown linear solver '{name}'; expected one of auto, {', '.join(SOLVERS)}")
    if obstacle := _obstacle(SOLVERS[name]):
        raise UsageError(f"linear solver '{name}' cannot be used: {obstacle}")
    return SOLVERS[name](pattern, name_of)


def _quickest(pattern: Pattern, name_of: Callable[[int], tuple[str, int]] | None) -> LinearSolver:
    ordering = narrowest(pattern)
    # finding a package takes no time, loading MKL half a second, which narrow models save
    others = [solver for solver in SOLVERS.values() if solver is not BandSolver]
    likely = next(solver for solver in others if find_spec(solver.module))
    if _band_is_quicker(pattern, ordering, likely):
        band = BandSolver(pattern, name_of, ordering)
        band.reason = f"half bandwidth {ordering.width} of {pattern.size} unknowns, {ordering.method}"
        return band
    usable = next(solver for solver in others if not _obstacle(solver))
    solver = usable(pattern, name_of)
    solver.reason = f"half bandwidth {ordering.width} of {pattern.size} unknowns is too wide for the band solver"
    if isinstance(solver, SuperLUSolver) and pattern.in_space and pattern.size >= SLOW:
        solver.advice = f"pardiso takes a third of the time of superlu for {pattern.size} unknowns: {FAST}"
    return solver


def _band_is_quicker(pattern: Pattern, ordering: BandOrdering, other: type[LinearSolver]) -> bool:
    storage = 8 * pattern.size * (3 * ordering.width + 1)
    return ordering.width <= other.widest_band[pattern.in_space] and storage <= LARGEST_BAND


@cache
def _obstacle(solver: type[LinearSolver]) -> str:
    """Return the reason why a solver cannot be used, '' if it can."""
    module, distribution = solver.module, solver.distribution
    try:
        # numpy prints a long text if a module was built for another version; the error has the reason too
        with redirect_stderr(io.StringIO()):
            import_module(module)
    except ModuleNotFoundError:
        return f"{distribution} is not installed"
    except ImportError as error:
        return f"{distribution} does not load: {str(error).partition(' (')[0]}"
    return ""
