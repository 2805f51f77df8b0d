# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What runs a step, by its procedure; and a procedure, with its keyword, of the tests' own."""

import inspect
import math
import re
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

import uel
from uel.deck.keywords import KEYWORDS
from uel.deck.language.table import Keyword, Kind, Option, Where
from uel.deck.steps.procedures import PROCEDURES
from uel.errors import DeckError
from uel.model import perturbations, procedures
from uel.model.procedures import Procedure
from uel.model.records import Noted
from uel.procedures.context import StepContext
from uel.procedures.general.increments import GeneralStep
from uel.procedures.general.path import TimePath
from uel.procedures.general.step_parts import Part, PartEnd
from uel.procedures.registry import run_of
from uel.procedures.step_setting import Setting, StepRun

KINDS = [
    kind
    for module in (procedures, perturbations)
    for _, kind in inspect.getmembers(module, inspect.isclass)
    if issubclass(kind, Procedure) and not inspect.isabstract(kind)
]


@pytest.mark.parametrize("kind", KINDS)
def test_every_procedure_has_what_runs_it(kind):
    assert run_of.dispatch(kind) is not run_of.dispatch(object)
    assert kind.keyword
    assert kind.title


def test_procedure_that_nothing_runs():
    class Unknown(Procedure):
        lflag = 0

    with pytest.raises(TypeError, match="no run is registered for Unknown"):
        run_of(Unknown(), None)


@dataclass(frozen=True, slots=True)
class Relaxation(Procedure):
    """A step with a dashpot of 10 at each dof, which ends where nothing moves faster than `slowest`.

    It is what CONTRIBUTING says of adding a procedure, done once: this description, the part and the entry in the
    registry below it, and the keyword with its reader.
    """

    keyword: ClassVar = "RELAXATION"
    title: ClassVar = "RELAXATION"
    lflag: ClassVar = 1

    slowest: float = 0.0

    def head(self):
        yield "SLOWEST RATE", self.slowest


class Dashpots(Part):
    def __init__(self, context, procedure):
        self._context, self._slowest, self._rate = context, procedure.slowest, math.inf

    def add_to(self, increment, size):
        system = self._context.system
        positions = system.matrix(np.arange(len(system.indices))).diagonal()
        damping = np.zeros(len(system.indices))
        damping[positions] = 10.0 / size
        return replace(increment, damping=damping)

    def converged(self, last, size):
        self._rate = abs(last.du).max() / size
        return PartEnd([Noted(f"RATE {self._rate:.6f}")])

    @property
    def finished(self):
        return self._rate < self._slowest


@run_of.register
def relax(procedure: Relaxation, setting: Setting) -> StepRun:
    context = StepContext(setting)
    parts = (Dashpots(context, procedure),)
    return GeneralStep(context, TimePath(context, parts), parts)


def read(block, _):
    return Relaxation(1.0, 100.0, 1.0, 1.0, slowest=block.options.real("SLOWEST", 0.1))


RELAXATION = Keyword("RELAXATION", "Viscous.", Where.STEP, (Option("SLOWEST", Kind.REAL, "rate that ends the step"),))
DECK = """*NODE
1, 0.
2, 1.
*ELEMENT, TYPE=SPRINGA, ELSET=S
1, 1, 2
*SPRING, ELSET=S

2.
*BOUNDARY
1, 1, 3
2, 2, 3
*STEP, AMPLITUDE=STEP
A step of its own
*RELAXATION, SLOWEST=0.05
*CLOAD
2, 1, 1.
*END STEP
"""


def test_procedure_and_keyword_of_its_own(tmp_path, monkeypatch):
    """Spring of stiffness 2 and dashpot under a force of 1: 10 u' + 2 u = 1 by backward Euler in steps of 1."""
    monkeypatch.setitem(KEYWORDS, RELAXATION.name, RELAXATION)
    monkeypatch.setattr("uel.deck.steps.procedures.PROCEDURES", (*PROCEDURES, (RELAXATION, read)))
    deck = tmp_path / "relaxation.inp"
    deck.write_text(DECK)
    result = uel.run(deck, output_dir=tmp_path, quiet=True)
    rates = [1.0 / 12.0]
    while rates[-1] >= 0.05:
        rates.append((1.0 - 2.0 * sum(rates)) / 12.0)
    assert result.status[-1].step_time == len(rates)
    message = (tmp_path / "relaxation.msg").read_text()
    assert re.findall(r"NOTE: RATE (\S+)", message) == [f"{rate:.6f}" for rate in rates]
    assert re.search(r"R E L A X A T I O N\s+A step of its own\s+SLOWEST RATE +5.000E-02", message)
    deck.write_text(DECK.replace("SLOWEST", "SLOW"))
    assert uel.run(deck, output_dir=tmp_path, quiet=True).status[-1].step_time == len(rates)
    deck.write_text(DECK.replace("SLOWEST", "SLOWLY"))
    with pytest.raises(DeckError, match=r"relaxation.inp:14: \*RELAXATION: unknown option SLOWLY"):
        uel.run(deck, output_dir=tmp_path, quiet=True)
