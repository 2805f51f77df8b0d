# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Capacity matrix of LFLAGS(3) = 4 in heat transfer steps against RHS: part of `requests`."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, passed
from uel.check.rigid_motions import ROTATIONS
from uel.check.subject import Subject
from uel.elements import Request
from uel.model.arrays import FloatArray
from uel.usersub import UNSET, guard_values

TRANSIENT: Final = 32, 33, 72, 73
"""LFLAGS(1) of transient heat transfer, uncoupled and coupled."""

TOLERANCE: Final = 1e-6
"""Tolerance of the difference to RHS, relative to the sum of a capacity matrix."""


def check_capacity(subject: Subject, state: ElementState) -> Finding | None:
    """Compare the sums for each dof other than displacements, since one matrix may be lumped and the other consistent.

    None if the element has no such dof, or returns no capacity with LFLAGS(3) = 4.
    """
    still = state.still()
    with guard_values({UNSET: float("nan")}):
        capacity = still.asked(Request.MASS).evaluate().amatrx
    rates = _of_rates(subject, still)
    judged = []
    for dof in np.unique(subject.dofs[(subject.dofs > 3) & ~np.isin(subject.dofs, ROTATIONS)]).tolist():
        block = np.ix_(subject.dofs == dof, subject.dofs == dof)
        if not capacity[block].any():
            continue
        judged.append(str(dof))
        sum_, in_rhs = float(capacity[block].sum()), float(rates[block].sum())
        if abs(sum_ - in_rhs) > TOLERANCE * max(np.abs(capacity[block]).sum(), np.abs(rates[block]).sum()):
            return failed(
                f"{still}: the entries of AMATRX with LFLAGS(3) = 4 for dof {dof} add up to {sum_:.6g}, the capacity "
                f"in RHS to {in_rhs:.6g}",
                "The capacity matrix is -dRHS/d(rate of dof): both have the same density, specific heat, thickness and "
                "integration points, and add up to the heat that one degree takes.",
                figure=sum_ - in_rhs,
            )
    return passed(f"capacity of dof {', '.join(judged)} (4)") if judged else None


def _of_rates(subject: Subject, state: ElementState) -> FloatArray:
    """Return -dRHS/d(DU/DTIME) (n, n) with the same U."""
    columns = []
    for step in np.diag(subject.scales):
        there, back = (replace(state, du=sign * step).evaluate(matrix=False).rhs[0] for sign in (1.0, -1.0))
        columns.append((back - there) * state.call.time_increment / (2.0 * step.sum()))
    return np.array(columns).T
