# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of elements by topic, one per file; each takes a Subject and returns a Finding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from uel.check.checks.arguments import inputs, loads, no_time, pnewdt
from uel.check.checks.evolution import energy, history, increments, state_rule
from uel.check.checks.mechanics import patch_test, rest, rotation, shear, symmetry, tangent, translation, zero_modes
from uel.check.checks.memory import arrays, local_variables, order, repeat, resources, threads
from uel.check.checks.requests import procedures
from uel.check.checks.run import compiler, debug, deck_run, values
from uel.check.finding import Finding
from uel.check.subject import Subject


@dataclass(frozen=True, slots=True)
class Check:
    """A check: its name on the command line and in the table, and its function.

    function  checks one element type; its KernelError is a failure if the element returns at random displacements
    calls     calls elements, so needs a state
    forces    checks RHS and AMATRX, so needs a state at which they are not all zero
    unless    name of another check whose failure would also explain a failure of this one; '' for none
    """

    name: str
    function: Callable[[Subject], Finding]
    calls: bool = True
    forces: bool = False
    unless: str = ""


CHECKS: Final = (
    Check("run", deck_run.check, calls=False),
    Check("values", values.check, calls=False),
    Check("compiler", compiler.check, calls=False),
    Check("resources", resources.check),
    Check("filled", arrays.check_filled),
    Check("outside", arrays.check_outside),
    Check("undeclared", arrays.check_undeclared),
    Check("inputs", inputs.check),
    Check("locals", local_variables.check),
    Check("repeat", repeat.check),
    Check("order", order.check, calls=False, unless="locals"),
    Check("threads", threads.check),
    Check("no-time", no_time.check),
    Check("requests", procedures.check),
    Check("pnewdt", pnewdt.check),
    Check("loads", loads.check),
    Check("tangent", tangent.check, forces=True),
    Check("symmetry", symmetry.check, forces=True),
    Check("translation", translation.check, forces=True),
    Check("rotation", rotation.check, forces=True, unless="translation"),
    Check("zero-modes", zero_modes.check, forces=True, unless="translation"),
    Check("shear", shear.check, forces=True, unless="translation"),
    Check("rest", rest.check, forces=True, unless="repeat"),
    Check("patch", patch_test.check, forces=True),
    Check("energy", energy.check, forces=True),
    Check("increments", increments.check, forces=True, unless="repeat"),
    Check("state", state_rule.check, forces=True, unless="repeat"),
    Check("history", history.check, forces=True, unless="repeat"),
    Check("debug", debug.check, calls=False),
)
"""All checks, in the order of the table: what invalidates later ones comes first."""
