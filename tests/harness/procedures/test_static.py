# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Static steps on springs whose iterates are known."""

import numpy as np
import pytest

from uel.errors import ConvergenceError, KernelError, SingularMatrixError, Source
from uel.model.amplitude import Amplitude, AmplitudeType
from uel.model.controls import Controls, FieldControls, LineSearchControls, TimeControls
from uel.model.procedures import Static
from uel.model.records import AttemptStarted, Convergence, IterationDone, StepDone, StepStarted, Warned
from uel.procedures.general.extrapolation import Extrapolation

SOURCE = Source("springs.inp", 1)
LINEAR = (0, 1, 1, (2.0, 0.0))
DIVERGING = (0, 1, 4, (1.0, 0.25))


def test_linear_spring_takes_one_iteration(bench):
    result = bench.run([LINEAR], [bench.step(boundaries=(bench.fix(0), bench.fix(1, 0.5)))])
    assert result.error is None
    (checks,) = result.iterations()
    assert [check.verdict for check in checks] == [Convergence.LINEAR]
    assert result.last.displacement == pytest.approx([0.0, 0.5])
    assert result.last.reaction == pytest.approx([-1.0, 1.0])
    assert checks[0].average_flux == pytest.approx(1.0)
    assert result.of(StepDone) == [StepDone(1, 1, 0, 1)]
    assert result.of(StepStarted) == [StepStarted(1)]


def test_prescribed_value_reaches_free_nodes_in_the_first_iteration(bench):
    """Two equal springs in a row: the middle moves by half in the same solve that moves the end."""
    result = bench.run([LINEAR, (1, 2, 1, (2.0, 0.0))], [bench.step(boundaries=(bench.fix(0), bench.fix(2, 1.0)))])
    (checks,) = result.iterations()
    assert len(checks) == 1
    assert result.last.displacement == pytest.approx([0.0, 0.5, 1.0])
    assert checks[0].increment.value == pytest.approx(1.0)
    assert (checks[0].increment.node, checks[0].increment.dof) == (2, 1)


@pytest.mark.parametrize("sizes", ["equal", "growing"])
def test_matrix_is_taken_again_after_a_linear_increment(bench, sizes):
    """Newton's method on f = d + d^3/100 for one unknown, done here with the matrix that each solve is to take.

    It does not depend on the sizes of the increments.

    Residuals as in a public message file of Abaqus, of a cube that hardens: rounding after a new matrix, thousandths to
    millionths of the force after the old one, in turns.
    """
    period = 1.0 if sizes == "equal" else 2.0
    amplitude = Amplitude("LOAD", AmplitudeType.TABULAR, np.array([[0.0, 0.0], [2.0, 2.0]]), SOURCE)
    static = Static(0.1, period) if sizes == "growing" else Static(0.1, period, 0.1, 0.1, direct=True)
    loads = (bench.force(1, 1.0, amplitude),)
    result = bench.run([(0, 1, 1, (1.0, 0.01))], [bench.step(static=static, boundaries=(bench.fix(0),), loads=loads)])
    assert result.error is None
    ends = [done.step_time for done in result.increments]
    blocks = result.iterations()
    linear = [block[-1].verdict is Convergence.LINEAR for block in blocks]
    found = [abs(check.residual.value) for block in blocks for check in block]
    wanted = newton_with_old_matrices(ends, [len(block) for block in blocks], linear)
    assert found == pytest.approx(wanted, rel=1e-3, abs=1e-14)
    assert True in linear[:-1]
    if sizes == "equal":
        assert linear[:6] == [False, True, False, True, False, True]


def newton_with_old_matrices(ends, iterations, linear):
    """Residual of each iteration; the increments end at these forces and take so many iterations each."""
    residuals = []
    d = start = step = size = slope = 0.0
    for k, end in enumerate(ends):
        same = k > 0 and linear[k - 1]
        step = step * (end - start) / size if size else 0.0
        size = end - start
        for iteration in range(iterations[k]):
            now = d + step
            if iteration or not same:
                slope = 1 + 0.03 * now**2
            step += (end - now - 0.01 * now**3) / slope
            residuals.append(abs(end - d - step - 0.01 * (d + step) ** 3))
        d, start = d + step, end
    return residuals


def test_call_sequence(bench):
    """Passes as Abaqus makes them: mass, start of the increment, one after each solve; none after convergence."""
    result = bench.run(
        [(0, 1, 1, (1.0, 0.0))],
        [bench.step(static=Static(0.5, 1.0), boundaries=(bench.fix(0), bench.fix(1, 1.0)))],
        log=True,
    )
    assert result.error is None
    seen = []
    for line in result.printed:
        if line[0] == "DB":
            seen.append(("DB", int(line[1]), int(line[2]), int(line[3]), *map(float, line[4:])))
        else:
            lflags = tuple(map(int, line[1:6]))
            values = list(map(float, line[8:]))
            # U(2), DU(2), step time, total time, dtime, period
            seen.append((lflags, int(line[7]), values[1], values[3], *values[4:7], values[8]))
    assert seen == [
        ("DB", 0, 1, 0, 0.0, 0.0, 0.0),
        ("DB", 5, 1, 0, 0.0, 0.0, 0.0),
        ((1, 0, 4, 0, 0), 1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        ("DB", 1, 1, 1, 0.0, 0.0, 0.5),
        ((1, 0, 1, 0, 0), 1, 0.0, 0.0, 0.5, 0.5, 0.5, 1.0),
        ((1, 0, 1, 0, 0), 1, 0.5, 0.5, 0.5, 0.5, 0.5, 1.0),
        ("DB", 2, 1, 1, 0.5, 0.5, 0.5),
        ("DB", 1, 1, 2, 0.5, 0.5, 0.5),
        ((1, 0, 1, 0, 1), 2, 1.0, 0.5, 1.0, 1.0, 0.5, 1.0),
        ((1, 0, 1, 0, 0), 2, 1.0, 0.5, 1.0, 1.0, 0.5, 1.0),
        ("DB", 2, 1, 2, 1.0, 1.0, 0.5),
        ("DB", 6, 1, 2, 1.0, 1.0, 0.0),
        ("DB", 3, 1, 2, 1.0, 1.0, 0.0),
    ]


def test_newton_iterates_of_a_cubic_spring(bench):
    """f = d + d^3 = 2 from d = 0: d_(i+1) = (2 + 2 d_i^3)/(1 + 3 d_i^2)."""
    result = bench.run([(0, 1, 1, (1.0, 1.0))], [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(1, 2.0),))])
    (checks,) = result.iterations()
    d = 0.0
    for check in checks:
        following = (2 + 2 * d**3) / (1 + 3 * d**2)
        assert check.correction.value == pytest.approx(following - d)
        assert check.increment.value == pytest.approx(following)
        assert check.residual.value == pytest.approx(2 - following - following**3, abs=1e-12)
        assert check.average_flux == pytest.approx(following + following**3)
        d = following
    assert len(checks) == 5
    assert result.last.displacement[1] == pytest.approx(1.0, abs=1e-4)


def test_extrapolation_starts_the_next_increment_where_the_last_points(bench):
    """The residual of the extrapolated start takes part: iteration 1 of increment 2 is accepted by the estimate."""
    spring = (0, 1, 1, (1.0, 0.02))
    static = Static(0.5, 1.0)
    with_it = bench.run([spring], [bench.step(static=static, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))])
    without = bench.run(
        [spring],
        [bench.step(static=static, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),), extrapolation="NO")],
    )
    first, second = with_it.iterations()
    assert second[0].correction.value == pytest.approx(
        with_it.last.displacement[1] - 2 * with_it.increments[0].solution.displacement[1], rel=1e-3
    )
    assert first[0].verdict is Convergence.CORRECTION_TOO_LARGE
    assert second[0].verdict is Convergence.ACCEPTED_ESTIMATE
    assert second[0].estimated_correction is not None
    assert len(without.iterations()[1]) == 2


@pytest.mark.parametrize("mode", ["LINEAR", "PARABOLIC"])
def test_an_increment_far_shorter_than_the_last_starts_without_extrapolation(mode):
    """D_E of *CONTROLS: after two cutbacks to a quarter, 1/16 of the last increment is below its default, 0.1."""
    under_test = Extrapolation(mode, TimeControls().d_e)
    for _ in range(2):
        under_test.converged(np.array([3.0]), 0.8)
    assert under_test.guess(0.2) == pytest.approx(0.75)
    assert under_test.guess(0.05) is None
    unlimited = Extrapolation(mode, 0.05)
    unlimited.converged(np.array([3.0]), 0.8)
    assert unlimited.guess(0.05) == pytest.approx(3.0 / 16)


def test_parabolic_extrapolation_is_exact_for_a_parabola(bench):
    """Displacements 1, 4, 9 at t = 1, 2, 3: from the third increment on the prescribed correction is zero."""
    times = np.arange(5.0)
    curve = Amplitude("A", AmplitudeType.TABULAR, np.column_stack([times, times**2]), None)
    static = Static(1.0, 4.0, 1e-5, 1.0)
    result = bench.run(
        [LINEAR],
        [bench.step(static=static, boundaries=(bench.fix(0), bench.fix(1, 1.0, curve)), extrapolation="PARABOLIC")],
    )
    corrections = [checks[0].correction.value for checks in result.iterations()]
    assert corrections == pytest.approx([1.0, 2.0, 0.0, 0.0])


def test_an_increment_says_what_comes_next(bench):
    static = Static(0.2, 1.0, 1e-5, 1.0)
    result = bench.run([LINEAR], [bench.step(static=static, boundaries=(bench.fix(0), bench.fix(1, 1.0)))])
    # growth by 1.5 from the second increment on, and what is left of the period
    assert [i.next_increment for i in result.increments] == pytest.approx([0.2, 0.3, 0.3, 0.0])


def test_pnewdt_abandons_right_after_the_solve(bench):
    """Increments above 0.3 are refused with PNEWDT = 0.5: 1, 0.5, 0.25, then growth until refused again."""
    spring = (0, 1, 2, (1.0, 0.0, 0.3, 0.5))
    result = bench.run([spring], [bench.step(boundaries=(bench.fix(0), bench.fix(1, 1.0)))])
    assert result.error is None
    sizes = [(a.attempt, a.time_increment, a.next_increment) for a in result.abandoned]
    assert sizes[:2] == [(1, 1.0, 0.5), (2, 0.5, 0.25)]
    assert "PNEWDT = 0.5" in result.abandoned[0].reason
    assert result.abandoned[0].iterations == 1
    first = result.records.index(result.abandoned[0])
    # no check block between the start of the attempt and its end
    assert isinstance(result.records[first - 1], AttemptStarted)
    assert result.increments[-1].step_time == 1.0
    assert result.last.displacement[1] == pytest.approx(1.0)


def test_cutback_restores_the_state_and_tries_a_quarter(bench):
    """A quarter of the stiffness triples the residual in each iteration: cut at I_0 = 4, back to the start."""
    result = bench.run([DIVERGING], [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))])
    assert isinstance(result.error, ConvergenceError)
    assert result.abandoned[0].iterations == 4
    assert "DIVERGING" in result.abandoned[0].reason
    residuals = [r.checks[0].residual.value for r in result.of(IterationDone)]
    assert residuals[:5] == pytest.approx([-3.0, 9.0, -27.0, 81.0, -0.75])
    assert [a.time_increment for a in result.abandoned] == pytest.approx([0.25**k for k in range(6)])
    assert result.increments == []


def test_too_many_attempts(bench):
    result = bench.run([DIVERGING], [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))])
    with pytest.raises(ConvergenceError, match=r"TOO MANY ATTEMPTS MADE FOR THIS INCREMENT \(step 1, increment 1"):
        raise result.error
    assert result.abandoned[-1].next_increment == 0.0
    assert result.printed[-1][:2] == ["DB", "3"]


def test_smallest_increment(bench):
    static = Static(1.0, 1.0, 0.1)
    result = bench.run(
        [DIVERGING], [bench.step(static=static, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))]
    )
    with pytest.raises(ConvergenceError, match="TIME INCREMENT REQUIRED IS LESS THAN THE MINIMUM SPECIFIED"):
        raise result.error
    assert len(result.abandoned) == 2


def test_direct_ends_at_the_first_cutback(bench):
    static = Static(1.0, 1.0, direct=True)
    result = bench.run(
        [DIVERGING], [bench.step(static=static, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))]
    )
    with pytest.raises(ConvergenceError, match="FIXED TIME INCREMENT IS TOO LARGE"):
        raise result.error
    assert len(result.abandoned) == 1


def test_number_of_increments_is_limited(bench):
    result = bench.run(
        [LINEAR],
        [bench.step(static=Static(0.1, 1.0, 1e-5, 0.1), increments=3, boundaries=(bench.fix(0), bench.fix(1, 1.0)))],
    )
    with pytest.raises(ConvergenceError, match=r"TOO MANY INCREMENTS NEEDED TO COMPLETE THE STEP \(step 1, INC=3\)"):
        raise result.error
    assert len(result.increments) == 3


def test_direct_passes_lflags_of_fixed_increments(bench):
    result = bench.run(
        [LINEAR],
        [bench.step(static=Static(direct=True), nlgeom=True, boundaries=(bench.fix(0), bench.fix(1, 1.0)))],
        log=True,
    )
    assert {tuple(line[1:3]) for line in result.printed if line[0] == "UEL"} == {("2", "1")}


ROOT = (0, 1, 3, (1.0,))


def pull_and_release(bench, **options):
    return (
        bench.step(1, boundaries=(bench.fix(0), bench.fix(1, 1.0))),
        bench.step(2, boundaries=(bench.fix(0),), new_boundary=True, amplitude="STEP", **options),
    )


def test_newton_cycles_without_line_search(bench):
    """f = sqrt(d), no load: from d = 1 full corrections jump between 1 and -1."""
    result = bench.run([ROOT], pull_and_release(bench))
    assert isinstance(result.error, ConvergenceError)
    assert result.abandoned[0].iterations == 4
    assert "DIVERGING" in result.abandoned[0].reason


def test_line_search_ends_the_cycle(bench):
    """Regula falsi between g(0) = 2 and g(1) = -2 gives the scale 1/2, which is the solution d = 0."""
    controls = Controls(line_search=LineSearchControls(n_ls=4))
    result = bench.run([ROOT], pull_and_release(bench, controls=controls))
    assert result.error is None
    searched = [r for r in result.records if getattr(r, "line_search", ())]
    assert searched[0].line_search == pytest.approx((1.0, 0.5))
    assert result.last.displacement[1] == pytest.approx(0.0, abs=1e-9)


def test_released_reaction_fades_over_the_step(bench):
    """Abaqus applies the reaction of a released dof as a load that ramps to zero (static steps ramp by default)."""
    result = bench.run(
        [LINEAR],
        [
            bench.step(1, boundaries=(bench.fix(0), bench.fix(1, 1.0))),
            bench.step(2, Static(0.25, 1.0, 1e-5, 0.25), boundaries=(bench.fix(0),), new_boundary=True),
        ],
    )
    u = [increment.solution.displacement[1] for increment in result.increments]
    assert u == pytest.approx([1.0, 0.75, 0.5, 0.25, 0.0], abs=1e-12)
    assert result.last.reaction == pytest.approx([0.0, 0.0], abs=1e-12)
    # all work that went in comes out again
    assert result.last.energies["ALLWK"] == pytest.approx(0.0, abs=1e-12)


def test_op_new_and_mod_of_loads(bench):
    springs = [(0, 1, 1, (1.0, 0.0)), (0, 2, 1, (1.0, 0.0))]
    result = bench.run(
        springs,
        [
            bench.step(1, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0), bench.force(2, 2.0))),
            bench.step(2, loads=(bench.force(1, 3.0),)),
            bench.step(3, loads=(bench.force(1, 5.0),), new_loads=True),
        ],
    )
    ends = [increment.solution.displacement[1:] for increment in result.increments]
    assert np.allclose(ends, [[1.0, 2.0], [3.0, 2.0], [5.0, 0.0]], atol=1e-12)
    assert [increment.solution.load[1:].tolist() for increment in result.increments] == [[1, 2], [3, 2], [5, 0]]
    assert [increment.total_time for increment in result.increments] == [1.0, 2.0, 3.0]


def test_boundaries_before_the_first_step_go_on(bench):
    result = bench.run(
        [LINEAR],
        [bench.step(1, loads=(bench.force(1, 1.0),)), bench.step(2, loads=(bench.force(1, 4.0),))],
        boundaries=(bench.fix(0),),
    )
    assert result.last.displacement == pytest.approx([0.0, 2.0])


def test_equation_carries_force_to_its_other_terms(bench):
    """u3 = u2, spring 0-2 (stiffness 2) and force 1 on node 3 (index 2) that has a spring of its own (stiffness 3)."""
    result = bench.run(
        [(0, 1, 1, (2.0, 0.0)), (0, 2, 1, (3.0, 0.0))],
        [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(2, 1.0),))],
        equations=[bench.equation((2, 1.0), (1, -1.0))],
    )
    assert result.last.displacement == pytest.approx([0.0, 0.2, 0.2])
    assert result.last.reaction == pytest.approx([-1.0, 0.0, 0.0])
    (checks,) = result.iterations()
    assert len(checks) == 1


def test_energies(bench):
    """Work equals stored energy: 1/2 k u^2 of a linear spring, whatever the increments."""
    result = bench.run(
        [LINEAR], [bench.step(static=Static(0.3, 1.0, 1e-5, 0.3), boundaries=(bench.fix(0), bench.fix(1, 0.5)))]
    )
    energies = result.last.energies
    assert energies["ALLSE"] == pytest.approx(0.25)
    assert energies["ALLWK"] == pytest.approx(0.25)
    assert energies["ALLIE"] == pytest.approx(0.25)
    assert energies["ETOTAL"] == pytest.approx(0.0, abs=1e-15)


def test_state_variables_are_those_of_the_last_checked_pass(bench):
    result = bench.run([(0, 1, 1, (1.0, 1.0))], [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(1, 2.0),))])
    (state,) = result.last.elements
    assert state.svars[0, 0] == result.last.displacement[1]


def test_entries_without_an_unknown_are_warned_of(bench):
    result = bench.run(
        [LINEAR],
        [
            bench.step(
                boundaries=(bench.fix(0), bench.fix(1, 1.0), bench.fix(1, dof=2)), loads=(bench.force(0, 1.0, dof=3),)
            )
        ],
    )
    warnings = [record.message for record in result.of(Warned)]
    assert warnings == [
        "springs.inp:2: *BOUNDARY has no effect: no element uses dof 2 of node 2",
        "springs.inp:1: *CLOAD has no effect: no element uses dof 3 of node 1",
    ]


def test_controls_are_obeyed(bench):
    """R_n = 1, C_n = 10 accept the first iterate of the cubic spring; I_A = 0 allows no cutback."""
    cubic = [(0, 1, 1, (1.0, 1.0))]
    loose = Controls(fields={"DISPLACEMENT": FieldControls(r_n=10.0, c_n=10.0)})
    result = bench.run(cubic, [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(1, 2.0),), controls=loose)])
    assert result.increments[0].iterations == 1
    strict = Controls(time=TimeControls(i_a=0))
    result = bench.run(
        [DIVERGING], [bench.step(boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),), controls=strict)]
    )
    assert len(result.abandoned) == 1


@pytest.mark.nan
def test_a_kernel_error_ends_the_run_after_what_came_before(bench):
    static = Static(0.25, 1.0, 1e-5, 0.25)
    result = bench.run(
        [(0, 1, 5, (1.0, 0.0, 0.6))], [bench.step(static=static, boundaries=(bench.fix(0), bench.fix(1, 1.0)))]
    )
    with pytest.raises(KernelError, match=r"element 1 \(type U5\): RHS\(1\) is NaN"):
        raise result.error
    assert [increment.step_time for increment in result.increments] == [0.25, 0.5]
    assert result.abandoned == []


def test_a_body_that_is_not_held(bench):
    result = bench.run([LINEAR], [bench.step(loads=(bench.force(1, 1.0),))])
    with pytest.raises(SingularMatrixError, match="dof 1"):
        raise result.error
