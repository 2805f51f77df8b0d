# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The fall-back on springs that Newton's method does not solve; solutions by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import uel
from uel.errors import ConvergenceError, SingularMatrixError
from uel.model.amplitude import Amplitude, AmplitudeType
from uel.model.procedures import Static
from uel.model.records import SearchHelped
from uel.procedures.general.incrementation import DIVERGING, TOO_SLOW
from uel.procedures.general.largest_load import PASSED
from uel.solver import descent
from uel.solver.descent import GROWING, SINGULAR, UPHILL

STIFFNESS, PEAK, END = 10.0, 0.1, 1.0
DAMAGE = (1, 2, 6, (STIFFNESS, PEAK, END))
SOFTENING = STIFFNESS * PEAK / (END - PEAK)
STATIC = Static(0.1, 1.0, 1e-5, 0.1)


def pulled(bench, soft, static=STATIC, **options):
    """A spring in series with one that fails, pulled to 3.15 in ten increments: a snap, as soft < SOFTENING."""
    step = bench.step(static=static, boundaries=(bench.fix(0), bench.fix(2, 3.15)))
    return bench.run([(0, 1, 1, (soft, 0.0)), DAMAGE], [step], **options)


def expected_force(u, soft):
    """The spring is whole until its force is STIFFNESS PEAK = 1, then it snaps to none."""
    whole = u / (1 / soft + 1 / STIFFNESS)
    return whole if whole <= STIFFNESS * PEAK else 0.0


def test_newton_stops_at_a_snap_and_the_search_passes_it(bench):
    assert isinstance(pulled(bench, 0.5).error, ConvergenceError)
    result = pulled(bench, 0.5, fallback=True)
    assert result.error is None
    solutions = [(r.solution.displacement[2], r.solution.reaction[2]) for r in result.increments]
    for u, force in solutions:
        assert force == pytest.approx(expected_force(u, 0.5), abs=1e-6)
    (helped,) = result.of(SearchHelped)
    assert helped.reason == UPHILL
    assert helped.since <= helped.iterations


def test_largest_load_is_approached_in_quarters_of_an_increment(bench):
    """The peak is at u = 2.1, between 6 and 6.75 increments of 0.315: two quarters reach it, the third fails."""
    result = pulled(bench, 0.5, fallback=True)
    sizes = [record.time_increment for record in result.increments]
    assert sizes == pytest.approx([0.1] * 6 + [0.025] * 2 + [0.05] + [0.1] * 3)
    following = [record.next_increment for record in result.increments]
    assert following == pytest.approx([0.1] * 6 + [0.025] * 2 + [0.1] * 3 + [0.0])
    assert [(record.increment, record.attempt) for record in result.abandoned] == [(7, 1), (9, 1)]
    assert result.abandoned[0].reason == PASSED
    assert max(record.solution.reaction[2] for record in result.increments) == pytest.approx(2.0475 / 2.1)


def test_largest_load_in_fixed_increments_is_passed(bench):
    result = pulled(bench, 0.5, static=replace(STATIC, direct=True), fallback=True)
    assert (result.error, result.abandoned) == (None, [])
    assert len(result.increments) == 10


def test_singular_matrix_is_passed(bench):
    """A spring as soft as the other softens: the matrix of the node between them is exactly zero."""
    soft = 1.25
    damage = (1, 2, 6, (12.5, 0.1, 1.1))
    step = bench.step(static=STATIC, boundaries=(bench.fix(0), bench.fix(2, 3.15)))
    without = bench.run([(0, 1, 1, (soft, 0.0)), damage], [step])
    assert isinstance(without.error, ConvergenceError)
    assert "singular system matrix at node 2, dof 1" in str(without.error)
    assert {record.reason for record in without.abandoned} == {SINGULAR}
    result = bench.run([(0, 1, 1, (soft, 0.0)), damage], [step], fallback=True)
    assert result.error is None
    assert SINGULAR in [helped.reason for helped in result.of(SearchHelped)]
    assert result.last.reaction[2] == pytest.approx(0.0, abs=1e-6)


def test_singular_matrix_of_a_guess_is_a_cutback(bench):
    """The springs are extrapolated to 1.8, where both are as soft, but only get to 1.0: the peak is at 1.1."""
    slow = Amplitude("A", AmplitudeType.TABULAR, np.array([[0.0, 0.0], [0.5, 0.9], [1.0, 1.0]]), None)
    pull = (bench.fix(0), bench.fix(2, 1.0, slow))
    springs = [(0, 1, 1, (1.25, 0.0)), (1, 2, 6, (12.5, 0.1, 1.1))]
    result = bench.run(springs, [bench.step(static=Static(0.5, 1.0, 1e-5, 0.5), boundaries=pull)])
    assert result.error is None
    assert [record.reason for record in result.abandoned] == [SINGULAR] * 2
    assert result.last.reaction[2] == pytest.approx(1.25 / 1.1)
    fixed = bench.run(springs, [bench.step(static=Static(0.5, 1.0, direct=True), boundaries=pull)])
    assert isinstance(fixed.error, SingularMatrixError)


def test_slow_convergence_is_hastened(bench):
    """AMATRX eight times too stiff: the error falls by 7/8 in an iteration, until the search lengthens the steps."""
    step = bench.step(static=Static(1.0, 1.0), boundaries=(bench.fix(0),), loads=(bench.force(1, 0.5),))
    spring = (0, 1, 4, (1.0, 8.0))
    assert bench.run([spring], [step]).abandoned[0].reason == TOO_SLOW
    result = bench.run([spring], [step], fallback=True)
    assert (result.error, result.abandoned) == (None, [])
    (helped,) = result.of(SearchHelped)
    assert (helped.since, helped.reason) == (9, TOO_SLOW)
    assert helped.iterations < 13
    assert result.last.displacement[1] == pytest.approx(0.5, rel=1e-2)


def test_diverging_attempt_goes_on_with_the_search(bench):
    """AMATRX a quarter of the stiffness: each correction is four times too long, and the first reason is that."""
    step = bench.step(static=Static(1.0, 1.0), boundaries=(bench.fix(0),), loads=(bench.force(1, 0.5),))
    spring = (0, 1, 4, (1.0, 0.25))
    assert bench.run([spring], [step]).abandoned[0].reason == DIVERGING
    result = bench.run([spring], [step], fallback=True)
    assert (result.error, result.abandoned) == (None, [])
    (helped,) = result.of(SearchHelped)
    assert helped.reason == GROWING
    assert result.last.displacement[1] == pytest.approx(0.5)


def test_direction_across_the_residual_is_replaced(bench, monkeypatch):
    """Two nodes on springs to the ground, after one iteration with c . r = r1^2/K1 + r2^2/K2 = 0.

    Node 1: u = 0.2 on the softening branch, where its force is 0.8 SOFTENING; r1 = 2 - 0.8 SOFTENING, K1 = -1.
    Node 2: f = k d + q d^3, u = 1, r2 = -q, K2 = k + 3 q.
    """
    k1 = SOFTENING - 1.0
    r1, q = 2.0 - 0.8 * SOFTENING, 6.0
    k2 = q**2 / r1**2 - 3 * q
    directions = []
    original = descent.Majoriser.direction

    def watched(self, reduced):
        directions.append(reduced.copy())
        return original(self, reduced)

    monkeypatch.setattr(descent.Majoriser, "direction", watched)
    springs = [(0, 1, 6, (STIFFNESS, PEAK, END)), (0, 1, 1, (k1, 0.0)), (0, 2, 1, (k2, q))]
    loads = (bench.force(1, 0.2 * (STIFFNESS + k1)), bench.force(2, k2))
    result = bench.run(springs, [bench.step(boundaries=(bench.fix(0),), loads=loads)], fallback=True)
    assert result.error is None
    assert np.abs(directions[0]) == pytest.approx([r1, q])
    # node 1 ends on its elastic spring alone, node 2 where k2 d + q d^3 = k2
    d1, d2 = result.last.displacement[1:]
    assert k1 * d1 == pytest.approx(0.2 * (STIFFNESS + k1), rel=1e-2)
    assert k2 * d2 + q * d2**3 == pytest.approx(k2, rel=1e-2)


def test_where_newtons_method_does_the_fallback_changes_nothing(bench):
    step = bench.step(static=Static(0.25, 1.0), boundaries=(bench.fix(0),), loads=(bench.force(1, 2.0),))
    spring = (0, 1, 1, (1.0, 1.0))
    plain, with_it = bench.run([spring], [step]), bench.run([spring], [step], fallback=True)
    assert plain.iterations() == with_it.iterations()
    assert with_it.of(SearchHelped) == []


def test_search_without_end_is_cut_back(bench, monkeypatch):
    """Nothing carries the load: no equilibrium, and the error is that of a run without the fall-back."""
    monkeypatch.setattr("uel.procedures.general.increments.ITERATIONS", 20)
    step = bench.step(static=Static(1.0, 1.0), boundaries=(bench.fix(0),), loads=(bench.force(1, 3.0),))
    result = bench.run([(0, 1, 6, (STIFFNESS, PEAK, END))], [step], fallback=True)
    assert "HAS NOT CONVERGED" in result.abandoned[0].reason
    with pytest.raises(ConvergenceError, match="TOO MANY ATTEMPTS"):
        raise result.error


LEVER = """*NODE
1, 0., 0.
2, 0., 1.
3, 0., 4.
4, 1., 4.
9, 0., 0.
*NSET, NSET=END
4
*NSET, NSET=ARMS
2, 3
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2, PROPERTIES=2, I PROPERTIES=1
1
*USER ELEMENT, TYPE=U6, NODES=2, COORDINATES=2, PROPERTIES=3, I PROPERTIES=1
1
*ELEMENT, TYPE=U6, ELSET=FAILING
1, 1, 2
*ELEMENT, TYPE=U1, ELSET=SOFT
2, 3, 4
*ELEMENT, TYPE=MASS, ELSET=MASSES
3, 2
4, 3
*MASS, ELSET=MASSES
1.
*UEL PROPERTY, ELSET=SOFT
0.1, 0., 0
*UEL PROPERTY, ELSET=FAILING
10., 0.1, 0.5, 0
*SURFACE, NAME=ARMS, TYPE=NODE
ARMS
*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=ARMS
*KINEMATIC
*BOUNDARY
1, 1
9, 1, 2
*STEP, NLGEOM, INC=500
*STATIC
0.1, 1., 1e-5, 0.1
*BOUNDARY
4, 1, 1, 3.4
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U1, RF1
*END STEP
"""


def test_a_snap_through_a_coupling_that_turns(tmp_path):
    """A lever turns about its reference node by t: a failing spring holds it at 1, a soft one pulls at 4.

    Moments: f(s) = 4 k (u - 4 s) with s = -sin t, the force f and the stiffness k = 0.1. It is whole up to s = 0.1,
    u = 2.9, and then snaps to s = u/4, a turn by 46 degrees at least: 16 k is less than its softening, 2.5.
    """
    deck, springs = tmp_path / "lever.inp", Path(__file__).parent / "springs.f"
    deck.write_text(LEVER)
    with pytest.raises(ConvergenceError):
        uel.run(deck, user=springs, output_dir=tmp_path)
    result = uel.run(deck, user=springs, output_dir=tmp_path, solver=uel.SolverOptions(fallback=True))
    u, force = (result.history[f"{name}[END]"] for name in ("U1", "RF1"))
    whole = u / (1 / 0.1 + 16 / 10)
    np.testing.assert_allclose(force, np.where(u < 2.9, whole, 0), atol=1e-4)
    assert u[-1] == pytest.approx(3.4)
    assert "EQUILIBRIUM FOUND WITH THE DESCENT SEARCH" in (tmp_path / "lever.msg").read_text()
