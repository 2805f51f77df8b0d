# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What every law dissipates in every interface element, along random paths."""

import numpy as np
import pytest
from hypothesis import strategies as st
from random_states import (
    CASES,
    COPIES,
    VARIANTS,
    Crowd,
    properties,
    run_examples,
    separations,
)

cases = pytest.mark.parametrize(("variant", "kind", "extra"), CASES)
DAMAGE, VISCOUS = 3, 4
WEIGHTS = {2: {0: [1, 1], 1: [1, 1]}, 3: {0: [5 / 9, 8 / 9, 5 / 9], 1: [1 / 3, 4 / 3, 1 / 3]}}

LEGS, PARTS = 4, (0.1, 0.3, 0.6, 1.0)


def walk(rng, values):
    """Separations of both ends along a path: loading, unloading, turning, closing, in increments of any size."""
    at = np.zeros((COPIES, 2, 2))
    for _ in range(LEGS):
        target = separations(rng, values)
        yield from (at + f * (target - at) for f in PARTS)
        at = target


def check_energies(tools, variant, kind, extra, data):
    """No increment dissipates a negative energy by any mechanism, in any component; ENERGY is the sum of the points."""
    jtype, closure = VARIANTS[variant]
    values = data.draw(properties(tools.reference, kind, closure, extra))
    seed = data.draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    values["INTEGRATION"] = int(rng.integers(2))
    crowd = Crowd(tools.element, tools.interface, jtype, **values)
    item = crowd.item
    rule = item.state["X"].shape[1]
    length = np.linalg.norm(np.diff(crowd.interface.edge, axis=0))
    area = 0.5 * length * 2.0 * np.array(WEIGHTS[rule][values["INTEGRATION"]])
    # the paper's closure has the damage at the displacement jump: that of the standard element, whatever the traction
    standard = None
    if not closure and jtype not in (2, 5):
        standard = Crowd(tools.element, tools.interface, 5 if jtype == 6 else 2, **values)
    mechanisms = ("DISSI", "DISSII", "DISSV", "DISSF")
    before = {name: item.state[name].copy() for name in mechanisms}
    least = min(values["GIC"], values["GIIC"])
    for ends in walk(rng, values):
        # quads moved as a whole have no stress, so that contact follows the separation
        u = np.zeros((COPIES, crowd.nodes, 2))
        if jtype in (3, 4, 6):
            u[:, crowd.nodes // 2 :] = (ends[:, 0] @ crowd.axes)[:, None]
        else:
            u = crowd.displacements(ends, u)
        crowd.call("advance", u, 0.1)
        state, energy = item.state, item.energy
        where = (seed, values)
        if standard is not None:
            # ends alike, as above: the standard element has no quads to move
            alike = np.broadcast_to(ends[:, :1], ends.shape)
            standard.call("advance", standard.displacements(alike, np.zeros((COPIES, standard.nodes, 2))), 0.1)
            expected = standard.item.energy[:, [DAMAGE, VISCOUS]]
            np.testing.assert_allclose(
                energy[:, [DAMAGE, VISCOUS]], expected, rtol=1e-9, atol=1e-12 * area.sum() * least, err_msg=str(where)
            )
        for name in mechanisms:
            # friction is a product of tractions and slips that rounding may turn
            rounding = 1e-12 * abs(state[name]).max() if name == "DISSF" else 0.0
            assert (state[name] >= before[name] - rounding).all(), (name, *where)
            before[name] = state[name].copy()
        total = state["DISSI"] + state["DISSII"] + state["DISSF"]
        np.testing.assert_allclose(energy[:, DAMAGE], total @ area, rtol=1e-12, atol=1e-300)
        np.testing.assert_allclose(energy[:, VISCOUS], state["DISSV"] @ area, rtol=1e-12, atol=1e-300)
        assert "VISCOSITY" in values or not energy[:, VISCOUS].any()
        assert (state["DAMAGE"] <= 1).all()
    # the overstress of a large viscosity leaves nothing for damage
    damaged = bool(item.state["DAMAGE"].any())
    assert damaged or "VISCOSITY" in values
    assert before["DISSI"].any() == before["DISSII"].any() == damaged


@cases
def test_energies(tools, variant, kind, extra):
    run_examples(check_energies, 1, tools, variant, kind, extra, again=True)


@pytest.mark.long
@cases
def test_energies_at_length(tools, variant, kind, extra):
    # 32 copies, 32 increments
    run_examples(check_energies, 50, tools, variant, kind, extra)
