# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Dynamic steps of an oscillator: a spring k with a mass m at its free end.

The average acceleration method turns the state (u, v/omega) by theta in each increment h, tan(theta/2) = omega h/2
(T.J.R. Hughes, The Finite Element Method, Prentice-Hall 1987, section 9.1): so its results are known to rounding.
"""

import numpy as np
import pytest

from uel.errors import ConvergenceError
from uel.model.procedures import Dynamic, Integrator, Static
from uel.procedures.general.dynamic import HALF_INCREMENT

K, M = 4.0, 0.25
OMEGA = np.sqrt(K / M)
SPRING = (0, 1, 1, (K, M, 0.0))
NO_DAMPING = {"alpha": 0.0, "beta": 0.25, "gamma": 0.5}


@pytest.fixture
def oscillate(bench):
    bench.user, bench.variables = "oscillators.f", 4

    def oscillate(*steps, spring=SPRING, **options):
        result = bench.run([spring], steps, boundaries=(bench.fix(0),), **options)
        if result.error is not None:
            raise result.error
        return result

    return oscillate


def fixed(size, count, **options):
    return Dynamic(size, size * count, size, size, True, **(NO_DAMPING | options))


def at_end(result, quantity):
    return np.array([getattr(increment.solution, quantity)[1] for increment in result.increments])


def energy(result, name):
    return np.array([increment.solution.energies[name] for increment in result.increments])


def test_free_vibration_turns_by_the_known_angle_and_keeps_its_energy(bench, oscillate):
    h, v0 = 0.1, 3.0
    result = oscillate(bench.step(static=fixed(h, 40)), velocities=(bench.initial(1, v0),))
    theta = 2 * np.arctan(OMEGA * h / 2)
    angle = theta * np.arange(1, 41)
    assert at_end(result, "displacement") == pytest.approx(v0 / OMEGA * np.sin(angle), abs=1e-12)
    assert at_end(result, "velocity") == pytest.approx(v0 * np.cos(angle), abs=1e-12)
    assert at_end(result, "acceleration") == pytest.approx(-v0 * OMEGA * np.sin(angle), abs=1e-11)
    assert energy(result, "ETOTAL") == pytest.approx(M * v0**2 / 2, rel=1e-12)
    assert energy(result, "ALLKE") == pytest.approx(M * v0**2 / 2 * np.cos(angle) ** 2, abs=1e-12)
    # a linear problem takes one iteration
    assert {increment.iterations for increment in result.increments} == {1}


def test_sudden_load_swings_to_twice_the_static_displacement(bench, oscillate):
    """u = P/k (1 - cos n theta): loads are there at once, and their work is that of the whole force."""
    h, p = 0.05, 2.0
    result = oscillate(bench.step(static=fixed(h, 60), loads=(bench.force(1, p),), amplitude="STEP"))
    angle = 2 * np.arctan(OMEGA * h / 2) * np.arange(1, 61)
    u = p / K * (1 - np.cos(angle))
    assert at_end(result, "displacement") == pytest.approx(u, abs=1e-12)
    assert energy(result, "ALLWK") == pytest.approx(p * u, abs=1e-12)
    assert energy(result, "ETOTAL") == pytest.approx(0.0, abs=1e-12)


def test_static_load_that_is_released(bench, oscillate):
    """A plucked spring: the static displacement, then a cosine about zero."""
    h, p = 0.1, 2.0
    result = oscillate(
        bench.step(1, loads=(bench.force(1, p),)),
        bench.step(2, static=fixed(h, 20), new_loads=True, amplitude="STEP"),
    )
    angle = 2 * np.arctan(OMEGA * h / 2) * np.arange(21)
    assert at_end(result, "displacement") == pytest.approx(p / K * np.cos(angle), abs=1e-12)


@pytest.mark.parametrize("alpha", [-0.05, -0.3])
def test_hilber_hughes_taylor_damps_as_its_amplification_matrix(bench, oscillate, alpha):
    """Powers of the amplification matrix of Hughes, section 9.3, for (u, h v, h^2 a)."""
    h, beta, gamma = 0.2, (1 - alpha) ** 2 / 4, 0.5 - alpha
    result = oscillate(
        bench.step(static=fixed(h, 30, alpha=alpha, beta=beta, gamma=gamma)), velocities=(bench.initial(1, 1.0),)
    )
    w = (OMEGA * h) ** 2
    after = np.array([[1, 0, -beta], [0, 1, -gamma], [(1 + alpha) * w, 0, 1]])
    before = np.array([[1, 1, 0.5 - beta], [0, 1, 1 - gamma], [alpha * w, 0, 0]])
    amplification = np.linalg.solve(after, before)
    state, u = np.array([0.0, h, 0.0]), []
    for _ in range(30):
        state = amplification @ state
        u.append(state[0])
    assert at_end(result, "displacement") == pytest.approx(u, abs=1e-12)
    assert energy(result, "ETOTAL")[-1] < M / 2


def test_default_operator_converges_with_the_square_of_the_increment(bench, oscillate):
    errors = []
    for count in (50, 100, 200):
        procedure = Dynamic(1.0 / count, 1.0, 1.0 / count, 1.0 / count, True)
        result = oscillate(bench.step(static=procedure, increments=count), velocities=(bench.initial(1, OMEGA),))
        errors.append(abs(at_end(result, "displacement")[-1] - np.sin(OMEGA)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.05)


def test_backward_euler(bench, oscillate):
    """u_1 = (u_0 + h v_0)/(1 + h^2 omega^2), v_1 = (u_1 - u_0)/h."""
    h = 0.1
    procedure = fixed(h, 10, alpha=0.0, beta=1.0, gamma=1.0, integrator=Integrator.BACKWARD_EULER)
    result = oscillate(bench.step(static=procedure), velocities=(bench.initial(1, 1.0),))
    u, v, expected = 0.0, 1.0, []
    for _ in range(10):
        new = (u + h * v) / (1 + (h * OMEGA) ** 2)
        u, v = new, (new - u) / h
        expected.append(u)
    assert at_end(result, "displacement") == pytest.approx(expected, abs=1e-13)


def test_large_swing_of_a_hardening_spring_keeps_its_energy_to_the_error_of_the_rule(bench, oscillate):
    """k u + c u^3: the trapezoidal rule leaves an error of the energy that falls with the square of the increment."""
    drift = []
    for count in (50, 100):
        procedure = fixed(1.0 / count, count)
        result = oscillate(
            bench.step(static=procedure), spring=(0, 1, 1, (K, M, 8.0)), velocities=(bench.initial(1, 4.0),)
        )
        drift.append(np.ptp(energy(result, "ETOTAL")))
    assert np.log2(drift[0] / drift[1]) == pytest.approx(2, abs=0.2)


def test_calls_of_a_dynamic_step(bench, oscillate):
    """Mass, initial acceleration, then passes of the first increment; each has V, A and PARAMS of the operator."""
    result = oscillate(
        bench.step(static=fixed(0.1, 1, half_increment=1e4)), velocities=(bench.initial(1, 1.0),), log=True
    )
    calls = [list(map(float, line[1:])) for line in result.printed if line[0] == "UEL"]
    assert [call[:3] for call in calls] == [[12, 0, 4], [12, 0, 6], [12, 0, 1], [12, 0, 1], [12, 0, 5]]
    u, du, v, a, time, dtime, *params = calls[3][7:]
    beta, h = 0.25, 0.1
    assert params == [0.0, 0.25, 0.5]
    assert (time, dtime, u) == (0.1, 0.1, du)
    assert a == pytest.approx((du - h) / (beta * h**2))
    assert v == pytest.approx(1.0 + h * a / 2)
    half = calls[4]
    # the cubic through the state at the start and the displacement at the end, at its middle
    assert half[7] == pytest.approx(du / 8 + 3 * h / 8)
    assert half[10] == pytest.approx(a / 2)
    assert half[11:13] == pytest.approx([0.05, 0.1])


def test_half_increment_residual_sets_the_increment(bench, oscillate):
    """At the first increment the spring is out of balance by M a/2 + K u_half in its middle, u as above."""
    h, tolerance = 0.1, 0.003
    procedure = Dynamic(h, 1.0, 1e-6, h, half_force=tolerance, **NO_DAMPING)
    result = oscillate(bench.step(static=procedure, increments=1000), velocities=(bench.initial(1, 1.0),))
    u = h / (1 + (OMEGA * h) ** 2 / 4)
    a = -(OMEGA**2) * u
    residual = abs(M * a / 2 + K * (u / 8 + 3 * h / 8))
    first = result.abandoned[0]
    assert first.reason == HALF_INCREMENT
    assert first.next_increment == pytest.approx(0.85 * tolerance / residual * h)
    assert result.increments[-1].step_time == pytest.approx(1.0)
    # one turn takes 2 pi/omega = 1.57: the increments that follow stay small against it
    assert max(increment.time_increment for increment in result.increments) < 0.1


def test_initial_accelerations_balance_the_load(bench, oscillate):
    result = oscillate(bench.step(static=fixed(1e-6, 1), loads=(bench.force(1, 2.0),), amplitude="STEP"), log=True)
    calls = [list(map(float, line[1:])) for line in result.printed if line[0] == "UEL"]
    # the prediction of the first increment without displacement, from a_0 = P/m: a = -(1/2 - beta) a_0/beta
    assert calls[2][10] == pytest.approx(-2.0 / M)
    assert at_end(result, "acceleration")[0] == pytest.approx(2.0 / M)


def test_no_initial_accelerations_where_they_are_not_asked_for(bench, oscillate):
    result = oscillate(bench.step(static=fixed(0.1, 1, initial_acceleration=False)), log=True)
    assert [line[3] for line in result.printed if line[0] == "UEL"] == ["4", "1", "1"]


def test_velocity_parabolic_extrapolation_starts_from_the_motion(bench, oscillate):
    h = 0.1
    result = oscillate(
        bench.step(static=fixed(h, 2), extrapolation="VELOCITY PARABOLIC"),
        velocities=(bench.initial(1, 1.0),),
        log=True,
    )
    first = next(line for line in result.printed if line[0] == "UEL" and line[3] == "1")
    assert float(first[8]) == pytest.approx(h)
    assert first[5] == "1"


def test_what_follows_a_dynamic_step_is_at_rest(bench, oscillate):
    result = oscillate(
        bench.step(1, static=fixed(0.1, 3)),
        bench.step(2, static=Static()),
        velocities=(bench.initial(1, 1.0),),
    )
    last = result.last
    assert not last.velocity.any() and not last.acceleration.any()


def test_fixed_increments_are_not_cut_back(bench):
    bench.user, bench.variables = "springs.f", 1
    result = bench.run(
        [(0, 1, 4, (1.0, 0.25))],
        [bench.step(static=fixed(1.0, 1, initial_acceleration=False), loads=(bench.force(1, 1.0),))],
        boundaries=(bench.fix(0),),
    )
    assert isinstance(result.error, ConvergenceError)
    assert "FIXED TIME INCREMENT IS TOO LARGE" in str(result.error)
