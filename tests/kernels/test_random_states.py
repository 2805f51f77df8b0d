# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AMATRX, energies and irreversibility of the interface elements in random states of random laws."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

RANDOM = settings(
    max_examples=6000, deadline=None, database=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
LAWS = {"bilinear": 1}
VARIANTS = {"standard": (2, 0), "paper's closure": (4, 0), "consistent closure": (4, 1)}
unit = st.floats(-1.0, 1.0)


def geometric(low, high):
    """Positive numbers, even in their logarithm."""
    return st.floats(np.log(low), np.log(high)).map(lambda x: float(np.exp(x)))


@st.composite
def properties(draw, closure):
    """A law that is not too brittle, any stiffness, and options of the element."""
    strength = {"SIGMAMAX": draw(geometric(5, 200)), "TAUMAX": draw(geometric(5, 200))}
    rigid = closure == 1 and draw(st.integers(0, 4)) == 0
    alpha = 0.0 if rigid else draw(geometric(1e4, 1e12 if closure else 1e6))
    ratio = draw(st.sampled_from([1.0, 0.4, 3.0]))
    values = {**strength, "ALPHAN": alpha, "ALPHAT": ratio * alpha}
    for toughness, maximum, stiffness in (("GIC", "SIGMAMAX", "ALPHAN"), ("GIIC", "TAUMAX", "ALPHAT")):
        elastic = strength[maximum] ** 2 / (2 * values[stiffness]) if alpha else 0.0
        # the failure at 0.003 to 0.3 mm, so that beta exceeds the slope of softening
        values[toughness] = 1.2 * elastic + 0.5 * strength[maximum] * draw(geometric(0.01, 0.3))
    values["VISCOSITY"] = draw(st.sampled_from([0.0, 0.0, 0.05, 1.0]))
    if closure == 1:
        values |= {"CLOSURE": 1, "FRICTION": draw(st.sampled_from([0.0, 0.3]))}
    return values


@st.composite
def options(draw, jtype):
    """Integration, and what the stabilised element has besides."""
    values = {"INTEGRATION": draw(st.integers(0, 1))}
    if jtype == 4:
        values |= {"SAMPLING": draw(st.integers(0, 2)), "PLANE": draw(st.integers(0, 1))}
        values |= {"ANGLE BOTTOM": draw(st.sampled_from([0.0, 30.0])), "ANGLE TOP": draw(st.sampled_from([0.0, -55.0]))}
        if draw(st.booleans()):
            values |= {"BETAN": draw(geometric(1e5, 1e6)), "BETAT": draw(geometric(1e5, 1e6)), "GAMMABOT": 0.3}
    return values


@st.composite
def paths(draw):
    """Two to four increments: separations (tau, n) of both ends in units of the separation at failure; time."""
    count = draw(st.integers(2, 4))
    step = st.tuples(unit, st.floats(-0.3, 1.0), unit, st.floats(-0.3, 1.0), geometric(1e-2, 1.2), geometric(1e-3, 1.0))
    return [draw(step) for _ in range(count)]


def displacements(interface, nodes, step, length, seed):
    """Displacements with about the separations of a step at both ends, and strains that go with them.

    Never just those of the step: zero is a kink.
    """
    scale = length * step[4]
    rng = np.random.default_rng(seed)
    ends = scale * (np.array(step[:4]).reshape(2, 2) + 0.01 * rng.normal(size=(2, 2)))
    u = interface.displacements(nodes, *ends, seed)
    if nodes == 8:
        # the nodes away from the interface
        u[[0, 1, 6, 7]] += 0.05 * scale * rng.normal(size=(4, 2))
    return u


def derivative(forces, step):
    """Derivative of forces(x) at 0 by central differences of sixth order, and how far the middle is from smooth."""
    values = {n: forces(n * step) for n in range(-3, 4)}
    terms = ((45, 1), (-9, 2), (1, 3))
    slope = sum(w * (values[n] - values[-n]) for w, n in terms) / (60 * step)
    return slope, abs(values[1] - 2 * values[0] + values[-1]).max() / step


@pytest.mark.long
@pytest.mark.parametrize("library", ["library"], indirect=True)
@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_random_states(element, interface, kind, variant):
    """Tangent along a random direction against differences; damage and what friction dissipates never fall.

    A state within reach of a kink (onset, failure, reloading, closing, sliding) is passed over: there, differences over
    two steps do not agree with each other.
    """
    jtype, closure = VARIANTS[variant]
    coordinates = interface.four if jtype == 2 else interface.eight
    compared = 0

    @RANDOM
    @given(values=properties(closure), chosen=options(jtype), path=paths(), seed=st.integers(0, 10**6))
    def check(values, chosen, path, seed):
        nonlocal compared
        item = element(jtype, coordinates, LAW=LAWS[kind], **values, **chosen)
        length = 2 * min(values["GIC"] / values["SIGMAMAX"], values["GIIC"] / values["TAUMAX"])
        direction = np.random.default_rng(seed).normal(size=2 * len(coordinates))
        for number, step in enumerate(path):
            u = displacements(interface, len(coordinates), step, length, seed + number).ravel()

            def forces(x, u=u, dtime=step[5]):
                return item.evaluate(u + x * direction, dtime=dtime)[0]

            (coarse, _), (fine, kink) = (derivative(forces, x * length) for x in (3e-4, 1e-4))
            before, (_, tangent) = item.state, item.advance(u, dtime=step[5])
            scale = abs(tangent).max() * abs(direction).max()
            if abs(coarse - fine).max() <= 1e-8 * scale and kink <= 2e-3 * scale:
                assert abs(fine + tangent @ direction).max() <= 1e-7 * scale
                compared += 1
            for name in ("DMAX", "DISSF"):
                assert (item.state[name] >= before[name]).all()
            assert (item.state["DAMAGE"] <= 1).all()

    check()
    assert compared >= 10_000
