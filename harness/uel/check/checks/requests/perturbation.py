# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""RHS in a linear step, *STATIC with PERTURBATION: part of `requests`."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.check.element_calls import ElementState
from uel.check.finding import Finding, failed, passed
from uel.check.subject import Subject
from uel.check.tie_breaking import first_largest
from uel.elements import Flags, Request

TOLERANCE: Final = 1e-6
"""Tolerance relative to the largest force."""

ADVICE: Final = (
    "In a linear step (LFLAGS(4) = 1) U is the base state. RHS is what the loads of the step on the element add "
    "(DDLMAG), zero without loads; with LFLAGS(3) = 100 it is that minus AMATRX times DU, the perturbation. The "
    "forces of the base state do not belong in it: Abaqus would take them for loads."
)


def check_perturbation(subject: Subject, states: list[ElementState], flags: Flags) -> Finding:
    """Check RHS without loads on the element, at each of the states as a base state."""
    perturbed = flags.request is Request.PERTURBATION
    change = (subject.scales if perturbed else 0.0) * np.linspace(-1.0, 1.0, len(subject.scales))
    for state in states:
        still = replace(state, du=np.zeros_like(state.u)).called(distributed=None)
        forces = still.evaluate()
        linear = replace(still.called(flags=flags), du=change)
        rhs, expected = linear.evaluate().rhs[0], -forces.amatrx @ change
        row = first_largest(np.abs(rhs - expected))
        deviation = float(abs(rhs[row] - expected[row]))
        if deviation > TOLERANCE * max(float(np.abs(forces.rhs[0]).max()), float(np.abs(expected).max()), 1e-300):
            return failed(
                f"{state}: RHS({row + 1}) is {rhs[row]:.6g} with LFLAGS(3) = {flags.request} and LFLAGS(4) = 1, not "
                f"{expected[row]:.6g}",
                ADVICE,
                figure=deviation,
            )
    return passed(f"linear step ({flags.request})")
