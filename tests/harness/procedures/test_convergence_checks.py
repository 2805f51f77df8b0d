# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks by field of a made-up iterate with forces and temperatures."""

from types import SimpleNamespace

import numpy as np
import pytest

from uel.assembly import Evaluation
from uel.model.controls import Controls, FieldControls, TimeControls
from uel.model.records import Convergence, Largest
from uel.procedures.general import incrementation
from uel.procedures.general.average_flux import FluxHistory
from uel.procedures.general.convergence_checks import Checker
from uel.solver.newton import Iterate

FORCE, TEMPERATURE = 0, 4
# nodes 0 and 1 with dofs 1 and 11; the first unknown is prescribed
DOFS = SimpleNamespace(
    node=np.array([0, 0, 1, 1]),
    dof=np.array([1, 11, 1, 11]),
    field=np.array([FORCE, TEMPERATURE, FORCE, TEMPERATURE]),
)
CONSTRAINTS = SimpleNamespace(free=np.array([1, 2, 3]))


ENTRIES = np.array([4, 0, 0, 0, 2])
MADE_UP = Evaluation(
    np.zeros(4), None, np.array([12.0, 0.0, 0.0, 0.0, 8.0]), ENTRIES, 1e36, np.zeros(8), entries=ENTRIES
)


def checker(controls=None):
    return Checker(DOFS, CONSTRAINTS, controls or Controls(), [FluxHistory()] * 5)


def iterate(iteration, reduced, increment=(1.0, -2.0, -3.0, 1.0), correction=(0.0, 0.1, 0.2, -0.3)):
    return Iterate(
        iteration, np.array(increment), np.array(correction), np.zeros(4), np.array(reduced, dtype=float), MADE_UP
    )


def test_largest_entries_are_found_by_field():
    under_test = checker()
    under_test.start(iterate(0, [0, 0, 0]), extrapolated=False)
    force, temperature = under_test.check(iterate(1, [5.0, -7.0, -6.0]))
    assert (force.field, temperature.field) == ("force", "temperature")
    assert force.residual == Largest(-7.0, 1, 1)
    assert temperature.residual == Largest(-6.0, 1, 11)
    assert force.increment == Largest(-3.0, 1, 1)
    assert temperature.increment == Largest(-2.0, 0, 11)
    assert force.correction == Largest(0.2, 1, 1)
    assert temperature.correction == Largest(-0.3, 1, 11)


def test_first_of_equal_entries_is_named_on_every_processor():
    """A symmetric model: which side rounding makes larger is not for a user to see."""
    dofs = SimpleNamespace(node=np.arange(3), dof=np.ones(3, dtype=int), field=np.zeros(3, dtype=int))
    under_test = Checker(dofs, SimpleNamespace(free=np.arange(3)), Controls(), [FluxHistory()] * 5)
    values = np.array([0.5, -7.0, 7.0 + 1e-14])
    for turn in (values, values * [1, 1 + 1e-14, 1 - 1e-14]):
        under_test.start(Iterate(0, turn, turn, turn, turn, MADE_UP), extrapolated=False)
        (force,) = under_test.check(Iterate(1, turn, turn, turn, turn, MADE_UP))
        assert {force.residual.node, force.increment.node, force.correction.node} == {1}
        assert force.residual.value == pytest.approx(-7.0, rel=1e-12)


def test_average_flux_is_the_mean_over_element_dofs_of_the_field():
    under_test = checker()
    under_test.start(iterate(0, [0, 0, 0]), extrapolated=False)
    force, temperature = under_test.check(iterate(1, [0, 0, 0]))
    assert force.average_flux == pytest.approx(12.0 / 4)
    assert temperature.average_flux == pytest.approx(8.0 / 2)


def test_controls_by_field():
    """Residuals of 0.1: q = 3 and 4; a residual control of 0.05 for temperatures alone lets these pass."""
    under_test = checker(Controls(fields={"TEMPERATURE": FieldControls(r_n=0.05, c_n=1.0)}))
    under_test.start(iterate(0, [0, 0, 0]), extrapolated=False)
    force, temperature = under_test.check(iterate(1, [0.1, 0.1, 0.1]))
    assert force.verdict is Convergence.NOT_ACHIEVED
    assert temperature.verdict is Convergence.CONVERGED


def test_the_residual_of_the_start_serves_only_after_an_extrapolation():
    """Correction 0.2 of an increment 3, residual 0.01: the estimate 0.2 x 0.01/1 is below 0.03."""
    for extrapolated, verdict in ((True, Convergence.ACCEPTED_ESTIMATE), (False, Convergence.CORRECTION_TOO_LARGE)):
        under_test = checker()
        under_test.start(iterate(0, [1.0, 1.0, 1.0]), extrapolated=extrapolated)
        force, _ = under_test.check(iterate(1, [0.01, 0.01, 0.01]))
        assert force.verdict is verdict
        assert force.estimated_correction == (pytest.approx(0.002) if extrapolated else None)


def test_one_diverging_field_is_enough_to_give_up():
    under_test = checker(Controls(time=TimeControls(i_0=3)))
    under_test.start(iterate(0, [0, 0, 0]), extrapolated=False)
    for iteration, residual in enumerate((1.0, 2.0, 3.0), start=1):
        checks = under_test.check(iterate(iteration, [0.0, residual, 0.0]))
        cutback = under_test.find_cutback(iteration, checks)
        assert (cutback is not None) == (iteration == 3)
    assert cutback.reason == incrementation.DIVERGING
    under_test.start(iterate(0, [0, 0, 0]), extrapolated=False)
    assert under_test.find_cutback(1, under_test.check(iterate(1, [0.0, 1.0, 0.0]))) is None


def test_flux_histories_go_on_by_field():
    under_test = checker()
    under_test.start(iterate(0, [0, 0, 0]), extrapolated=False)
    under_test.check(iterate(1, [0, 0, 0]))
    under_test.converged()
    after = under_test.histories([FluxHistory()] * 5)
    assert (after[FORCE].total, after[TEMPERATURE].total) == (3.0, 4.0)
    assert after[1] == FluxHistory()
