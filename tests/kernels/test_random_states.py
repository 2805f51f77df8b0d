# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AMATRX of every law in every interface element, at random states."""

import numpy as np
import pytest
from hypothesis import event
from hypothesis import strategies as st
from random_states import (
    CASES,
    COPIES,
    DTIME,
    IN_SPACE,
    INCREMENTS,
    SPACE_CASES,
    STATES,
    VARIANTS,
    Crowd,
    SpaceCrowd,
    options,
    properties,
    run_examples,
    separations,
)
from space import QUADRATIC

cases = pytest.mark.parametrize(("variant", "kind", "extra"), CASES + SPACE_CASES)


def differences(forces, reach):
    """Derivative at 0 by central differences of sixth order, and by one-sided ones of fifth order on both sides."""
    samples = {n: forces(n) for n in range(-reach, reach + 1)}
    found = []
    for signs in ((-3, -2, -1, 1, 2, 3), range(1, reach + 1), range(-reach, 0)):
        powers = np.array(signs, dtype=float)[None, :] ** np.arange(1, len(signs) + 1)[:, None]
        weights = np.linalg.solve(powers, [1.0, *np.zeros(len(signs) - 1)])
        found.append(sum(w * (samples[n] - samples[0]) for w, n in zip(weights, signs, strict=True)))
    return np.array(found)


def check_tangents(tools, variant, kind, extra, data):
    """AMATRX times a random direction against differences of RHS; number of states without a kink nearby."""
    jtype, closure = (VARIANTS | IN_SPACE)[variant]
    values = data.draw(properties(tools.reference, kind, closure, extra))
    seed = data.draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    given_values = options(rng, jtype, closure) | values
    if variant in IN_SPACE:
        crowd = SpaceCrowd(tools.element, rng, jtype, **given_values)
    else:
        crowd = Crowd(tools.element, tools.interface, jtype, **given_values)
    item, compared = crowd.item, 0
    # what multiplies rounded separations, and the rounded damage of the paper's closure
    stiffness = 0.0 if closure else max(values["ALPHAN"], values["ALPHAT"])
    stiffness += 0.0 if jtype in (2, 5, 7, 11) else 1e7
    stiffness += max(values.get("BETAN", 0.0), values.get("BETAT", 0.0))
    for increment in range(INCREMENTS):
        # with a history, a state without sliding lies between two kinks that look alike from both sides
        ends = separations(rng, values, 0.0 if increment else 1 / 6)
        sizes = np.linalg.norm(ends, axis=-1)
        noise = 0.1 * sizes.max(axis=1)[:, None, None] * rng.normal(size=(COPIES, crowd.nodes, crowd.dim))
        u = crowd.displacements(ends, noise)
        # small beside the separations of both ends and beside that at the onset
        step = 1e-4 * sizes.min(axis=1)[:, None, None]
        if jtype in (2, 5, 7, 11):
            onset = min(values["SIGMAMAX"], values["TAUMAX"]) / max(values["ALPHAN"], values["ALPHAT"])
            step = np.minimum(step, 0.01 * onset)
        along = step * crowd.direction(rng)
        slopes = differences(lambda n, u=u, along=along: crowd.call("evaluate", u + n * along, DTIME, request=5)[0], 5)
        before, (_, tangent) = item.state, crowd.call("advance", u, DTIME)
        expected = -np.einsum("kij,kj->ki", tangent, crowd.own(along))
        # of any side: in a pure mode the state itself is one where a curvature jumps
        missed = abs(slopes - expected).max(axis=2).min(axis=0)
        scale = step[:, 0, 0] * abs(tangent).max(axis=(1, 2))
        rounding = 30 * np.finfo(float).eps * abs(u).max(axis=(1, 2)) * stiffness
        bad = missed > 1e-7 * scale + rounding
        # where onset, failure, contact or the history put a kink within the steps, the two sides differ
        kink = abs(slopes[1] - slopes[2]).max(axis=1) > 0.01 * missed
        wrong = np.flatnonzero(bad & ~kink)
        assert not wrong.size, (seed, wrong, missed[wrong] / scale[wrong], values)
        compared += int((~bad).sum())
        for name in ("DMAX", "MAXN", "MAXT"):
            assert (item.state[name] >= before[name]).all(), (seed, name, values)
        assert (item.state["DAMAGE"] <= 1).all()
    event(f"{compared / STATES:.1f} of the states compared")
    return compared


@pytest.mark.sample(3)
@cases
def test_tangents(tools, variant, kind, extra):
    # a quadratic element in space takes as long as ten others
    examples = 1 if IN_SPACE.get(variant, (0, 0))[0] in QUADRATIC else 2
    assert sum(run_examples(check_tangents, examples, tools, variant, kind, extra, again=True)) > examples * STATES / 2


@pytest.mark.long
@cases
def test_tangents_at_length(tools, variant, kind, extra):
    # up to a third of the states is too near to a kink
    assert sum(run_examples(check_tangents, 3 * 10_000 // (2 * STATES) + 1, tools, variant, kind, extra)) >= 10_000
