# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Random properties, states and paths of every law: AMATRX against differences of RHS, and the balance of energies.

The quick run takes a few hundred states or increments of each law and element, the long one 10,000.
"""

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, event, given, settings
from hypothesis import strategies as st

LAWS = {1: (), 2: ("ETA", "POWER"), 3: ("ETA", "POWER")}
ELEMENTS = {"standard": (2, {}), "stabilised": (4, {}), "consistent": (4, {"CLOSURE": 1})}
ELASTIC, DAMAGE, VISCOUS = 1, 3, 4

sampling = settings(deadline=None, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
cases = pytest.mark.parametrize(("variant", "kind"), [(v, k) for v in ELEMENTS for k in LAWS])


def positive(low, high):
    """Numbers spread evenly over the orders of magnitude."""
    return st.floats(np.log(low), np.log(high)).map(lambda x: float(np.exp(x)))


@st.composite
def properties(draw, kind):
    """A law that exists, of any brittleness."""
    values = {"LAW": kind, "SIGMAMAX": draw(positive(1.0, 100.0)), "GIC": draw(positive(0.01, 1.0))}
    values["TAUMAX"] = values["SIGMAMAX"] * draw(positive(0.3, 3.0))
    values["GIIC"] = values["GIC"] * draw(positive(0.2, 8.0))
    if exponent := draw(st.sampled_from(("", *LAWS[kind]))):
        values[exponent] = draw(st.floats(0.5, 5.0))
    # stiffnesses above the least ones of the pure modes, and of any mode mix
    normal, shear = values["SIGMAMAX"] ** 2 / values["GIC"] / 2, values["TAUMAX"] ** 2 / values["GIIC"] / 2
    mixed = max(values["SIGMAMAX"], values["TAUMAX"]) ** 2 / min(values["GIC"], values["GIIC"])
    alike = draw(st.booleans())
    values["ALPHAN"] = draw(positive(1.05, 1e4)) * (mixed if exponent else normal)
    values["ALPHAT"] = values["ALPHAN"] if alike else draw(positive(1.05, 1e4)) * (mixed if exponent else shear)
    if alike:
        assume(values["ALPHAT"] > 1.05 * shear)
    if draw(st.integers(0, 3)) == 0:
        values["VISCOSITY"] = draw(positive(1e-3, 10.0))
    return values


def reserve(values):
    """Least difference of the separations at failure and onset over the strength, per alpha_n, in any mode mix."""
    share = np.linspace(0.0, 1.0, 401)
    ratio = values["ALPHAT"] / values["ALPHAN"]
    power = values.get("POWER", 1.0)
    toughness = ((share / values["GIIC"]) ** power + ((1 - share) / values["GIC"]) ** power) ** (-1 / power)
    if "ETA" in values:
        toughness = values["GIC"] + (values["GIIC"] - values["GIC"]) * share ** values["ETA"]
    strength = share * ratio / values["TAUMAX"] ** 2 + (1 - share) / values["SIGMAMAX"] ** 2
    return (2 * toughness * strength).min() - 1 / values["ALPHAN"]


@st.composite
def consistent_properties(draw, kind):
    """A law and a beta above its softening; now and then rigid."""
    values = draw(properties(kind))
    room = reserve(values)
    assume(room > 0)
    steepest = (2.0 if kind == 3 else 1.0) / room
    ratio = values["ALPHAT"] / values["ALPHAN"]
    beta = draw(positive(2.1, 1e4)) * steepest
    values |= {"CLOSURE": 1, "BETAN": beta, "BETAT": beta * ratio}
    if ratio == 1.0 and draw(st.booleans()):
        values |= {"ALPHAN": 0.0, "ALPHAT": 0.0}
    return values


@st.composite
def separation(draw, values):
    """(tau, n) of any mode mix, between far below the onset and beyond failure; closed now and then."""
    strength = min(values["SIGMAMAX"], values["TAUMAX"])
    soft = 3.0 * max(values["GIC"], values["GIIC"]) / strength
    alpha = max(values["ALPHAN"], values["ALPHAT"])
    stiff = min(0.1 * strength / alpha if alpha else soft, 1e-3 * soft)
    size, angle = draw(positive(stiff, soft)), round(draw(st.floats(-np.pi / 2, np.pi / 2)), 6)
    if draw(st.integers(0, 5)) == 0:
        angle = 0.0
    g = size * np.array([np.sin(angle), np.cos(angle)])
    if draw(st.integers(0, 5)) == 0:
        g[1] = -g[1]
    return g


def displacements(interface, jtype, left, right, noise):
    """(nodes, 2) displacements with the given separations at both ends of the interface."""
    tau = (interface.edge[1] - interface.edge[0]) / np.linalg.norm(interface.edge[1] - interface.edge[0])
    axes = np.array([tau, [-tau[1], tau[0]]])
    bottom, top = ([0, 1], [3, 2]) if jtype == 2 else ([3, 2], [4, 5])
    u = noise[: 4 if jtype == 2 else 8].copy()
    u[top] = u[bottom] + np.array([left, right]) @ axes
    return u


def check_tangent(element, interface, variant, kind, data):
    """AMATRX times a random direction against differences of RHS, unless the state is too close to a kink to tell."""
    jtype, options = ELEMENTS[variant]
    values = data.draw(consistent_properties(kind) if options else properties(kind))
    item = element(jtype, interface.four if jtype == 2 else interface.eight, **values)
    draw = data.draw
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    seps = [draw(separation(values)) for _ in range(4)]
    noise = 0.1 * np.abs(seps[:2]).max() * rng.normal(size=(8, 2))
    if draw(st.booleans()):
        item.advance(displacements(interface, jtype, *seps[2:], noise), dtime=0.3)
    u = displacements(interface, jtype, *seps[:2], noise).ravel()
    # small beside the separations of both ends and beside that at the onset
    step = 1e-4 * min(np.linalg.norm(seps[0]), np.linalg.norm(seps[1]))
    if jtype == 2:
        step = min(step, 0.01 * min(values["SIGMAMAX"], values["TAUMAX"]) / max(values["ALPHAN"], values["ALPHAT"]))
    along = rng.normal(size=u.size)
    along /= np.linalg.norm(along)
    rhs, tangent = item.evaluate(u, dtime=0.3)

    def differences(signs):
        """Derivative of -RHS along `along` by samples on one side or both: of fifth or sixth order."""
        samples = np.array([rhs - item.evaluate(u + n * step * along, dtime=0.3)[0] for n in signs])
        powers = np.array(signs, dtype=float)[None, :] ** np.arange(1, len(signs) + 1)[:, None]
        return np.linalg.solve(powers, [1.0, *np.zeros(len(signs) - 1)]) @ samples / step

    stiffness = (
        max(values["ALPHAN"], values["ALPHAT"])
        if jtype == 2
        else 1.0e7 + max(values.get("BETAN", 0.0), values.get("BETAT", 0.0))
    )
    tolerance = 1e-7 * np.abs(tangent).max() + 10 * np.finfo(float).eps * np.abs(u).max() * stiffness / step
    missed = np.abs(differences((-3, -2, -1, 1, 2, 3)) - tangent @ along).max()
    if missed <= tolerance:
        return
    # where onset, failure, contact or the history put a kink within the steps, the two sides differ
    assert missed < 100 * np.abs(differences((1, 2, 3, 4, 5)) - differences((-5, -4, -3, -2, -1))).max(), (values, seps)
    event("kink")


@cases
@settings(sampling, max_examples=200)
@given(data=st.data())
def test_tangent(element, interface, variant, kind, data):
    check_tangent(element, interface, variant, kind, data)


@pytest.mark.long
@cases
@settings(sampling, max_examples=10_000)
@given(data=st.data())
def test_tangent_at_length(element, interface, variant, kind, data):
    check_tangent(element, interface, variant, kind, data)


LEGS, PARTS = 4, (0.1, 0.3, 0.6, 1.0)
INCREMENTS = LEGS * 2 * len(PARTS)


def walk(draw, values, alike):
    """Separations (left and right end) of a path: loading, unloading, turning, closing.

    The trapezoidal rule of the energies is exact to rounding if no increment leaps over the place where a component
    changes its sign: a closed interface is stiffer, and sliding back begins anew.
    """
    at = np.zeros((2, 2))
    for _ in range(LEGS):
        target = np.array([draw(separation(values))] * 2 if alike else [draw(separation(values)) for _ in range(2)])
        # both ends open or closed, and slid to the same side, so that so are the points between them
        target[1] = np.copysign(target[1], target[0])
        ways = np.vstack([at, target])
        turn = np.where((ways.min(axis=0) < 0) & (ways.max(axis=0) > 0), 0.0, at)
        for corner in (turn, target):
            yield from (at + f * (corner - at) for f in PARTS)
            at = corner


def check_energies(element, interface, variant, kind, data):
    """Work = stored + dissipated, and no increment without viscosity gains from the damage."""
    jtype, options = ELEMENTS[variant]
    values = data.draw(consistent_properties(kind) if options else properties(kind))
    item = element(jtype, interface.four if jtype == 2 else interface.eight, **values)
    standard = element(2, interface.four, **{k: v for k, v in values.items() if k not in ("CLOSURE", "BETAN", "BETAT")})
    names = ("WN", "WT") if options else ("SEPN", "SEPT")
    work, before, largest = 0.0, 0.0, 1e-300
    old = {name: np.zeros(2) for name in (*names, "TN", "TT")}
    for left, right in walk(data.draw, values, alike=jtype == 4):
        # quads moved as a whole have no stress, so that contact follows the separation
        rigid = displacements(interface, jtype, left, right, np.zeros((8, 2)))
        rigid[6:] = rigid[4:6]
        item.advance(rigid, dtime=0.1)
        new, energy = item.state, item.energy
        if variant == "stabilised":
            # damage at the displacement jump, whatever the traction of the stabilised weak form
            standard.advance(displacements(interface, 2, left, right, np.zeros((8, 2))), dtime=0.1)
            assert energy[DAMAGE] == pytest.approx(standard.energy[DAMAGE], rel=1e-9, abs=1e-12 * largest)
        else:
            area = 2.0 * np.linalg.norm(interface.edge[1] - interface.edge[0]) / 2
            for gap, traction in zip(names, ("TN", "TT"), strict=True):
                # the overstress of the consistent law is that of the end of the increment
                mean = 0.5 * (old[traction] + new[traction])
                work += area * float(np.sum(mean * (new[gap] - old[gap])))
            largest = max(largest, abs(work))
            if not (options and values.get("VISCOSITY")):
                assert energy[[ELASTIC, DAMAGE, VISCOUS]].sum() == pytest.approx(work, abs=1e-7 * largest)
            old = {name: new[name].copy() for name in old}
        # a damage that lags behind gives back what its overstress has stored
        lost = energy[DAMAGE] + energy[VISCOUS]
        largest = max(largest, energy[ELASTIC], lost)
        assert lost >= before - 1e-10 * largest
        before = lost
        assert energy[VISCOUS] == 0 or values.get("VISCOSITY")
        assert (new["DAMAGE"] <= 1).all()


@cases
@settings(sampling, max_examples=400 // INCREMENTS)
@given(data=st.data())
def test_energies(element, interface, variant, kind, data):
    check_energies(element, interface, variant, kind, data)


@pytest.mark.long
@cases
@settings(sampling, max_examples=10_000 // INCREMENTS + 1)
@given(data=st.data())
def test_energies_at_length(element, interface, variant, kind, data):
    check_energies(element, interface, variant, kind, data)
