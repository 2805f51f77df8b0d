# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What runs a step, by its procedure; and a procedure of a test's own, from its parts."""

import inspect
import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from harness.model import perturbations, procedures
from harness.model.procedures import Procedure
from harness.model.records import Noted
from harness.procedures.context import StepContext
from harness.procedures.general import GeneralStep
from harness.procedures.parts import Part
from harness.procedures.path import TimePath
from harness.procedures.registry import run_of
from harness.procedures.setting import Setting, StepRun

PROCEDURES = [
    kind
    for module in (procedures, perturbations)
    for _, kind in inspect.getmembers(module, inspect.isclass)
    if issubclass(kind, Procedure) and not inspect.isabstract(kind)
]


@pytest.mark.parametrize("kind", PROCEDURES)
def test_every_procedure_has_what_runs_it(kind):
    assert run_of.dispatch(kind) is not run_of.dispatch(object)
    assert kind.keyword
    assert kind.title


def test_procedure_that_nothing_runs():
    class Unknown(Procedure):
        lflag = 0

    with pytest.raises(TypeError, match="nothing runs Unknown"):
        run_of(Unknown(), None)


@dataclass(frozen=True, slots=True)
class Relaxation(Procedure):
    """A step with a dashpot of 10 at its last node, which ends where nothing moves faster than `slowest`."""

    keyword: ClassVar = "RELAXATION"
    title: ClassVar = "RELAXATION"
    lflag: ClassVar = 1

    slowest: float = 0.0


class Dashpot(Part):
    def __init__(self, procedure):
        self._slowest, self._rate = procedure.slowest, math.inf

    def given(self, given, size):
        return replace(given, damping=np.array([0.0, 0.0, 0.0, 10.0 / size]))

    def converged(self, last, size):
        self._rate = abs(last.increment[1]) / size
        return [Noted(f"RATE {self._rate:.6f}")]

    @property
    def finished(self):
        return self._rate < self._slowest


@run_of.register
def relax(procedure: Relaxation, setting: Setting) -> StepRun:
    context, parts = StepContext(setting), (Dashpot(procedure),)
    return GeneralStep(context, TimePath(context, parts), parts)


def test_procedure_of_its_own_from_a_path_and_a_part(bench):
    """Spring of stiffness 2 and dashpot under a force of 1: 10 u' + 2 u = 1 by backward Euler in steps of 1."""
    relaxation = Relaxation(1.0, 100.0, 1.0, 1.0, slowest=0.05)
    step = bench.step(static=relaxation, amplitude="STEP", boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))
    run = bench.run([(0, 1, 1, (2.0, 0.0))], [step])
    assert run.error is None
    rates = [1.0 / 12.0]
    while rates[-1] >= 0.05:
        rates.append((1.0 - 2.0 * sum(rates)) / 12.0)
    assert run.last.displacement[1] == pytest.approx(sum(rates), rel=1e-9)
    assert [noted.message for noted in run.of(Noted)][1:] == [f"RATE {rate:.6f}" for rate in rates]
