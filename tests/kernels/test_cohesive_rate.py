# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Strengths and fracture energies that depend on the rate of the separation, (1 + rate/RATEREFERENCE)**m.

Expected values are closed forms of the bilinear law; `test_random_states.py` has the tangents of every law in every
element, `test_random_energies.py` the dissipated energies.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from variants import ALPHA, LAWS, nodes_and_unit, variants

from uel.errors import KernelError

BETA = 5e4
VARIANTS = variants(BETA, "U4 paper", "U11", "U12 rigid")
JUMP = ("U2", "U4 paper", "U7", "U11")
"""Their damage is that of the displacement jump, whose rate a test can choose."""
CONSISTENT = tuple(variant for variant in VARIANTS if variant not in JUMP)
VALUES = {"SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.002}
BRIDGES = {"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1}
RATES = {"RATEREFERENCE": 0.02, "RATELIMIT": 100.0, "STRENGTHRATE": 0.1, "TOUGHNESSRATE": 0.15}
ETA = 2.284
SHARES = (0.0, 0.4, 1.0)
"""Mode II in the energy; both stiffnesses are the same, so that it is the square of a sine."""


def factors(rate):
    """Factors of the strengths and of the fracture energies."""
    base = 1 + np.minimum(rate, RATES["RATELIMIT"]) / RATES["RATEREFERENCE"]
    return base ** RATES["STRENGTHRATE"], base ** RATES["TOUGHNESSRATE"]


def line_at(rate, shear, variant):
    """Traction at a separation of zero, and slope, of the softening line; quadratic criterion, Benzeggagh-Kenane."""
    strength, toughness = factors(rate)
    strength = strength / np.sqrt(shear / 60**2 + (1 - shear) / 30**2)
    toughness = toughness * (0.26 + (1.002 - 0.26) * shear**ETA)
    onset = 0.0 if "rigid" in variant else strength / ALPHA
    failure = 2 * toughness / strength
    slope = strength / (failure - onset)
    return slope * failure, slope


def envelope(separation, rate, shear, variant):
    """Traction of a separation that has grown at a rate, without history."""
    top, slope = line_at(rate, shear, variant)
    softening = np.maximum(0.0, top - slope * separation)
    return softening if "rigid" in variant else np.minimum(softening, ALPHA * separation)


class Opened:
    """An element whose points have one separation, in the direction of a mode mix."""

    def __init__(self, element, interface, variant, shear=0.0, **values):
        jtype, given = VARIANTS[variant]
        nodes, self.unit = nodes_and_unit(jtype, interface, shear)
        self.item = element(jtype, nodes, **{"LAW": 2, "ETA": ETA} | given | RATES | values)
        self.jump = variant in JUMP
        self.work = self.force = 0.0
        self.last = 0.0, 0.0

    def advance(self, gap, dtime):
        """A converged increment; returns the force along the gap."""
        rhs, _ = self.item.advance(gap * self.unit, dtime=dtime)
        self.force = -(rhs @ self.unit)
        now = self.traction, self.size("W")
        self.work += 0.5 * (now[0] + self.last[0]) * (now[1] - self.last[1])
        self.last = now
        return self.force

    def size(self, letter):
        """Pair of the traction T or the separation W, at the first point."""
        state = self.item.state
        return float(np.linalg.norm([state[letter + name][0] for name in "NST" if letter + name in state]))

    @property
    def traction(self):
        """Size of the traction of the law; with the paper's closure that of the element is another one."""
        if self.item.state["SN"][0] < 1 and self.jump:
            return ALPHA * (1 - self.item.state["DAMAGE"][0]) * self.size("W")
        return self.size("T")

    @property
    def gained(self):
        """Stored and dissipated energy of the law less its work."""
        return 0.5 * np.prod(self.last) + self.dissipated - self.work

    @property
    def dissipated(self):
        """Energy dissipated at the first point."""
        return float((self.item.state["DISSI"] + self.item.state["DISSII"])[0])


@pytest.fixture
def make(element, interface):
    """Make an element of a variant in a mode mix: make(variant, shear, NAME=value, ...)."""

    def made(*arguments, **values):
        return Opened(element, interface, *arguments, **values)

    return made


# --- the law


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", VARIANTS)
def test_traction_is_that_of_the_rate_of_the_increment(make, variant, shear):
    """Increments of many durations; a point that is loaded has the closed form at its separation and its rate."""
    item, seen = make(variant, shear), []
    rng = np.random.default_rng(7)
    gap = last = 0.0
    for _ in range(60):
        gap += rng.uniform(1e-4, 4e-4)
        duration = 10 ** rng.uniform(-4, 1)
        damage = item.item.state["DAMAGE"][0]
        item.advance(gap, duration)
        separation, grown = item.size("W"), item.item.state["DAMAGE"][0] > damage
        if grown:
            rate = max(0.0, separation - last) / duration
            expected = envelope(separation, rate, shear, variant)
            assert item.traction == pytest.approx(expected, rel=1e-9, abs=1e-9)
            seen.append(rate / RATES["RATEREFERENCE"])
        last = separation
    assert len(seen) > 20
    assert min(seen) < 0.1
    assert max(seen) > 10


@pytest.mark.parametrize("speed", [1e-7, 0.02, 0.6, 1e4])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", JUMP)
def test_law_at_a_constant_rate(make, variant, law, speed):
    """A deck with the values at this rate gives the same, history and energies included; to failure in mixed mode."""
    strength, toughness = factors(speed)
    values = {**VALUES, **(BRIDGES if law == "bridging" else {})}
    scaled = {name: value * (strength if name[0] in "ST" else toughness) for name, value in values.items()}
    none = dict.fromkeys(RATES, 0.0)
    item, same = make(variant, 0.4, **LAWS[law]), make(variant, 0.4, **LAWS[law] | scaled | none)
    gaps = np.concatenate([np.linspace(0, 0.02, 9)[1:], np.linspace(0.025, 0.2, 7), [0.1]])
    for before, gap in zip([0.0, *gaps[:-1]], gaps, strict=True):
        for one in (item, same):
            one.advance(gap, abs(gap - before) / speed)
        for name, expected in same.item.state.items():
            np.testing.assert_allclose(item.item.state[name], expected, rtol=1e-9, atol=1e-12, err_msg=name)
        np.testing.assert_allclose(item.item.energy, same.item.energy, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize("variant", VARIANTS)
def test_slow_separations_have_the_law_without(make, variant):
    """The factors are 1 + m rate/RATEREFERENCE then."""
    item, same = make(variant, 0.4), make(variant, 0.4, **dict.fromkeys(RATES, 0.0))
    for gap in np.linspace(0, 0.05, 30)[1:]:
        force, expected = (one.advance(gap, 1e10) for one in (item, same))
        assert force == pytest.approx(expected, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("variant", VARIANTS)
def test_temperature_and_rate(make, variant):
    """Their factors multiply."""
    table = {"TEMPERATURE1": 20.0, "TEMPERATURE2": 80.0, "STRENGTH2": 0.6, "TOUGHNESS2": 0.8}
    halfway = {"SIGMAMAX": 24.0, "TAUMAX": 48.0, "GIC": 0.9 * 0.26, "GIIC": 0.9 * 1.002}
    item, same = make(variant, 0.4, **table), make(variant, 0.4, **halfway)
    fields = np.full((1, item.unit.size), 50.0)
    for gap in np.linspace(0, 0.02, 12)[1:]:
        found = item.item.advance(gap * item.unit, dtime=1e-3, fields=fields)
        for one, other in zip(found, same.item.advance(gap * same.unit, dtime=1e-3), strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * abs(other).max())
        np.testing.assert_allclose(item.item.energy, same.item.energy, rtol=1e-9, atol=1e-15)


def test_toughness_follows_strength_unless_it_is_given(make):
    item, same = make("U2", TOUGHNESSRATE=0.0), make("U2", TOUGHNESSRATE=0.1)
    assert item.advance(0.01, 0.1) == same.advance(0.01, 0.1)


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", CONSISTENT)
def test_constant_rate_of_the_jump(make, variant, shear):
    """T = top - k w and T + beta w = beta g have one with a constant w' = g'/(1 - k/beta), which others approach."""
    item, speed = make(variant, shear), 0.5

    def excess(rate):
        return rate * (1 - line_at(rate, shear, variant)[1] / BETA) - speed

    rate = brentq(excess, speed, 2 * speed, xtol=1e-15, rtol=1e-14)
    top, slope = line_at(rate, shear, variant)
    for gap in np.linspace(0, 0.012, 101)[1:]:
        item.advance(gap, 0.012 / 100 / speed)
    assert item.traction == pytest.approx((top - slope * 0.012) / (1 - slope / BETA), rel=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_traction_never_falls_with_the_rate(make, law):
    """From rest and from a softened state, up to failure, with the least TOUGHNESSRATE that the law permits."""
    least = 0.1
    if LAWS[law]["LAW"] in (3, 6):
        with pytest.raises(KernelError, match=r"TOUGHNESSRATE = .*would fall with the rate; expected at least"):
            make("U2", 0.4, **LAWS[law] | {"TOUGHNESSRATE": 0.1, "ALPHAN": 2e4, "ALPHAT": 2e4}).advance(1e-5, 1.0)
        # 1/(ALPHA 2 G/strength**2) at RATELIMIT, least in mode II
        exponent = 0.11
        brittle = 60**2 / (2 * 1.002 * 2e4) * 5001 ** (0.2 - exponent)
        least = max(exponent, 0.1 * (1 + brittle) + 1e-6)
    for first in (0.0, 0.004):
        item = make("U2", 0.4, **LAWS[law] | {"TOUGHNESSRATE": least, "ALPHAN": 2e4, "ALPHAT": 2e4})
        if first:
            item.advance(first, 1.0)
        for gap in first + np.geomspace(1e-5, 0.3, 40):
            speeds = np.geomspace(1e-6, 1e4, 60)
            forces = [-(item.item.evaluate(gap * item.unit, dtime=(gap - first) / v)[0] @ item.unit) for v in speeds]
            assert (np.diff(forces) >= -1e-12 * max(forces)).all()


# --- increments


def accelerated(share, last):
    """A gap that is opened faster and faster."""
    return last * share**2


@pytest.mark.parametrize("variant", ["U2", "U4 paper", "U4 rigid", "U4 incomplete", "U8 rigid"])
def test_first_order_in_the_increment(make, variant):
    """Backward Euler, with a rate that changes.

    The reference is the closed form at the rate of the jump, or T + beta w = beta g as a differential equation of w.
    """
    last, time = 0.012, 0.05
    if variant in JUMP:
        expected = envelope(last, 2 * last / time, 0.0, variant)
    else:

        def excess(rate, moment, w):
            top, slope = line_at(rate, 0.0, variant)
            return top - slope * w - BETA * (accelerated(moment / time, last) - w)

        def speed(moment, w):
            # at the onset, and by rounding
            if excess(0.0, moment, w[0]) >= 0:
                return 0.0
            return brentq(excess, 0.0, 1e3, args=(moment, w[0]), xtol=1e-14, rtol=1e-13)

        first = 0.0 if "rigid" in variant else 30 / ALPHA
        onset = time * np.sqrt((first + 30 / BETA) / last)
        exact = {"method": "LSODA", "rtol": 1e-10, "atol": 1e-14, "max_step": time / 2000}
        solution = solve_ivp(speed, (onset, time), [first], **exact)
        expected = BETA * (last - solution.y[0, -1])
    errors = []
    for count in (10, 100, 1000):
        item = make(variant)
        for share in np.linspace(0, 1, count + 1)[1:]:
            item.advance(accelerated(share, last), time / count)
        errors.append(abs(item.traction - expected))
    order = np.log10(np.array(errors[:-1]) / errors[1:])
    assert errors[0] > 1e-3 * expected
    assert order == pytest.approx([1.0, 1.0], abs=0.1)


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("count", [60, 600])
@pytest.mark.parametrize("variant", [variant for variant in VARIANTS if variant != "U4 paper"])
def test_block_in_series(make, variant, count, shear):
    """A spring pulls the interface at a constant speed, in increments that soften it by more than the spring holds.

    The line of the law, of slope k, and the spring c have a solution of one rate, u'/(1 - k/c). Newton's method begins
    each increment where the last one ended, and finds it in a few iterations; the load does not oscillate.
    """
    item, speed, per_area = make(variant, shear), 0.5, 26458.0
    # of the interface with the springs beta
    if variant in CONSISTENT:
        per_area = 1 / (1 / per_area + 1 / BETA)

    def excess(rate):
        return rate * (1 - line_at(rate, shear, variant)[1] / per_area) - speed

    rate = brentq(excess, speed, 2 * speed, xtol=1e-15, rtol=1e-14)
    top, slope = line_at(rate, shear, variant)
    probe = make(variant, shear).advance(1e-6, 1e9)
    area = probe / (1e-6 * {True: BETA, False: ALPHA}["rigid" in variant])
    if variant in CONSISTENT and "rigid" not in variant:
        area = probe / (1e-6 * ALPHA * BETA / (ALPHA + BETA))
    spring = 26458.0 * area
    gap, last, loads, counts = 0.0, 0.6 * top / slope, [], []
    for pulled in np.linspace(0, last, count + 1)[1:]:
        for iteration in range(1, 30):
            rhs, matrix = item.item.evaluate(gap * item.unit, dtime=last / count / speed)
            residual = spring * (pulled - gap) + rhs @ item.unit
            if iteration > 1 and abs(residual) < 1e-10 * spring * last:
                break
            gap += residual / (spring + item.unit @ matrix @ item.unit)
        loads.append(item.advance(gap, last / count / speed) / area)
        counts.append(iteration)
    peak = int(np.argmax(loads))
    assert max(counts) < 9
    assert (np.diff(loads[: peak + 1]) > 0).all()
    assert (np.diff(loads[peak:]) < 0).all()
    assert loads[-1] == pytest.approx((top - slope * last) / (1 - slope / per_area), rel=1e-8)


# --- energies


@pytest.mark.parametrize("count", [1, 2, 7, 100])
@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", JUMP)
def test_fracture_energy_of_a_constant_rate(make, variant, shear, count):
    """From rest to failure, whatever the increments."""
    item, speed = make(variant, shear), 3.0
    for gap in np.linspace(0, 0.1, count + 1)[1:]:
        item.advance(gap, 0.1 / count / speed)
    state = item.item.state
    expected = factors(speed)[1] * (0.26 + (1.002 - 0.26) * shear**ETA)
    assert item.dissipated == pytest.approx(expected, rel=1e-10)
    assert state["DISSII"][0] == pytest.approx(shear * expected, rel=1e-10, abs=1e-15)
    assert state["SPENT"][0] == state["DAMAGE"][0] == 1.0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("slower", [False, True])
@pytest.mark.parametrize("variant", VARIANTS)
def test_energies_are_the_work(make, variant, law, slower):
    """The error is of second order in the increment, while the rate rises from zero or falls to zero."""
    last, errors = 0.014, []
    for count in (50, 100, 200):
        item = make(variant, 0.4, **LAWS[law])
        for share in np.linspace(0, 1, count + 1)[1:]:
            item.advance(last * (1 - (1 - share) ** 2 if slower else share**2), 0.01 / count)
            if share <= 0.1:
                # the trapezoidal rule of the work misses the onset within an increment
                before = item.gained
        errors.append(abs(item.gained - before) / item.work)
    assert item.dissipated > 0.3 * item.work
    assert errors[0] < 4e-3
    assert errors[2] < 0.15 * errors[0] or errors[2] < 1e-5


def stopped(make, variant, shear, last, duration):
    """A point that was fast up to 0.006 goes on to a last separation; half of the traction that it loses times 0.006.

    Returns the element, that energy, and what it dissipates in the last increment.
    """
    item, gap = make(variant, shear), 0.006
    for share in np.linspace(0, 1, 20)[1:]:
        item.advance(share * gap, 1e-4)
    lost, before = 0.5 * (item.traction - envelope(gap, 0.0, shear, variant)) * gap, item.dissipated
    item.advance(last, duration)
    return item, lost, item.dissipated - before


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", JUMP)
def test_a_stop(make, variant, shear):
    """The traction falls to that of slow separations."""
    item, lost, dissipated = stopped(make, variant, shear, 0.006, 1e-4)
    assert item.traction == pytest.approx(envelope(0.006, 0.0, shear, variant), rel=1e-10)
    assert dissipated == pytest.approx(lost, rel=1e-9)


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", JUMP)
def test_a_stop_before_failure(make, variant, shear):
    """In one increment: what it loses, and what slow separations dissipate from there."""
    item, lost, dissipated = stopped(make, variant, shear, 0.1, 1e12)
    top, slope = line_at(0.0, shear, variant)
    slow = top - slope * 0.006
    assert item.item.state["DAMAGE"][0] == 1.0
    assert dissipated == pytest.approx(lost + 0.5 * slow * top / slope, rel=1e-9)


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", JUMP)
def test_unloading_dissipates_nothing(make, variant, shear):
    """A point goes back along its secant, and up again until it meets the envelope; to failure, in one increment."""
    item, speed = make(variant, shear), 3.0
    for share in np.linspace(0, 1, 20)[1:]:
        item.advance(share * 0.006, 0.006 / 19 / speed)
    loaded, secant = item.dissipated, item.traction / 0.006
    item.advance(0.002, 1e-4)
    assert item.dissipated == loaded
    assert item.traction == pytest.approx(0.002 * secant, rel=1e-12)
    item.advance(0.1, 0.098 / speed)
    toughness = factors(speed)[1] * (0.26 + (1.002 - 0.26) * shear**ETA)
    assert item.dissipated == pytest.approx(toughness, rel=1e-10)


# --- the rest of the element


@pytest.mark.parametrize("variant", VARIANTS)
def test_without_time_there_is_no_rate(make, variant):
    """A linear step, and an increment of no duration, keep the damage: AMATRX is that of the secant."""
    item = make(variant, 0.4)
    for gap in (0.002, 0.006):
        item.advance(gap, 1e-3)
    damage = item.item.state["DAMAGE"].copy()
    rhs, linear = item.item.evaluate(0.006 * item.unit, du=0 * item.unit, flags=(1, 0, 1, 0), dtime=1.0)
    _, still = item.item.evaluate(0.006 * item.unit, dtime=0.0)
    assert not rhs.any()
    np.testing.assert_array_equal(linear, still)
    secant = item.force / 0.006
    assert item.unit @ linear @ item.unit == pytest.approx(secant, rel=1e-9)
    item.advance(0.03, 0.0)
    np.testing.assert_array_equal(item.item.state["DAMAGE"], damage)


@pytest.mark.parametrize("variant", ["U4 rigid", "U8 rigid", "U4 incomplete"])
def test_beta_suffices_at_every_rate(make, variant):
    """An estimate is raised to twice the slope at RATELIMIT, a value of the deck is refused."""
    brittle = {"GIC": 1e-3, "GIIC": 1.0, "LAW": 1}
    item = make(variant, **brittle, BETAN=0.0, BETAT=0.0)
    item.advance(0.0, 1.0)
    own = item.item.block.state(0).svars[0, item.item.points * len(item.item.names) :]
    strength, toughness = factors(RATES["RATELIMIT"])
    elastic = 0.0 if "rigid" in variant else 1 / ALPHA
    slope = 1 / (2e-3 * toughness / (30 * strength) ** 2 - elastic)
    assert own[0] == pytest.approx(2 * slope)
    item = make(variant, **brittle, BETAN=0.99 * slope, BETAT=0.99 * slope)
    with pytest.raises(KernelError, match=r"does not exceed the softening slope"):
        item.advance(0.0, 1.0)


def test_a_law_must_exist_at_every_rate(make):
    """GIC exceeds strength**2/(2 ALPHAN) of slow separations, but not that of fast ones, by 5001^(2 0.1 - 0.15).

    The message has the value of the deck.
    """
    item = make("U2", LAW=1, GIC=1.1 * 30**2 / 2e6)
    with pytest.raises(KernelError, match=r"GIC = 4.95\d*E-04.*too brittle.*expected more than 6.889"):
        item.advance(1e-6, 1.0)


@pytest.mark.parametrize(
    "values, message",
    [
        ({"RATEREFERENCE": 0.0}, r"RATELIMIT = .*, but no RATEREFERENCE: expected both"),
        ({"RATEREFERENCE": -1.0}, r"RATEREFERENCE = -1.*expected zero or a positive value"),
        ({"RATELIMIT": 0.0}, r"RATELIMIT = .*: expected more than RATEREFERENCE"),
        ({"RATELIMIT": 0.01}, r"RATELIMIT = .*: expected more than RATEREFERENCE"),
        (
            {"STRENGTHRATE": 0.0, "TOUGHNESSRATE": 0.0},
            r"RATEREFERENCE = .*, but neither STRENGTHRATE nor TOUGHNESSRATE: expected one of them",
        ),
        ({"TOUGHNESSRATE": 0.05}, r"TOUGHNESSRATE = .*expected zero or at least STRENGTHRATE, below which"),
        ({"LAW": 4}, r"RATEREFERENCE = .*, which LAW 4 does not have: expected LAW 1, 2, 3, 5 or 6, or zero"),
        ({"FATIGUE": 1}, r"RATEREFERENCE = .*, but FATIGUE, whose time is the number of cycles"),
    ],
)
@pytest.mark.parametrize("variant", ["U2", "U8 rigid"])
def test_messages(make, variant, values, message):
    item = make(variant, **{"ETA": 0.0} | values)
    with pytest.raises(KernelError, match=message):
        item.advance(0.0, 1.0)


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("slowly", [False, True])
def test_viscosity_keeps_its_part_of_the_energy(make, variant, shear, slowly):
    """Damage that lags is not one whose rate has fallen: it dissipates what the law does, the overstress the rest.

    With exponents of next to nothing, at a constant speed and where it falls, as without a rate.
    """
    found = []
    for rates in ({"STRENGTHRATE": 1e-9, "TOUGHNESSRATE": 1e-9}, dict.fromkeys(RATES, 0.0)):
        item = make(variant, shear, VISCOSITY=0.01, **rates)
        for count, share in enumerate(np.linspace(0, 1, 101)[1:]):
            item.advance(0.06 * share, 10.0 / 100 if slowly and count > 50 else 1.0 / 100)
        state = item.item.state
        assert state["DISSV"][0] > 0
        found.append([item.dissipated, state["DISSV"][0], state["DAMAGE"][0]])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-6)
