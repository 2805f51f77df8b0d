# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The balance of energies of every law in every interface element, along random paths."""

import numpy as np
import pytest
from hypothesis import strategies as st
from random_states import (
    CASES,
    COPIES,
    PPR,
    VARIANTS,
    Crowd,
    one_library,
    properties,
    run,
    separations,
)

cases = pytest.mark.parametrize(("variant", "kind", "extra"), CASES)
ELASTIC, DAMAGE, VISCOUS = 1, 3, 4
QUAD = 1e5  # stiffness of the quads beside an interface over their size, in order of magnitude
WEIGHTS = {2: {0: [1, 1], 1: [1, 1]}, 3: {0: [5 / 9, 8 / 9, 5 / 9], 1: [1 / 3, 4 / 3, 1 / 3]}}

LEGS, PARTS = 4, (0.1, 0.3, 0.6, 1.0)


def walk(rng, values, alike):
    """Separations of both ends along a path: loading, unloading, turning, closing.

    The trapezoidal rule of the energies is exact to rounding if no increment leaps over the place where a component
    changes its sign: a closed interface is stiffer, and sliding back begins anew.
    """
    at = np.zeros((COPIES, 2, 2))
    for _ in range(LEGS):
        target = separations(rng, values)
        # both ends open or closed, and slid to the same side, so that so are the points between them
        target[:, 1] = target[:, 0] if alike else np.copysign(target[:, 1], target[:, 0])
        ways = np.stack([at, target], axis=1)
        crossing = (ways.min(axis=(1, 2)) < 0) & (ways.max(axis=(1, 2)) > 0)
        turn = np.where(crossing[:, None, :], 0.0, at)
        for corner in (turn, target):
            yield from (at + f * (corner - at) for f in PARTS)
            at = corner


class Balance:
    """Work of T on the separation of the law: by the trapezoidal rule, that of friction by backward Euler."""

    def __init__(self, crowd, values):
        rule = crowd.item.state["X"].shape[1]
        length = np.linalg.norm(np.diff(crowd.interface.edge, axis=0))
        self.area = 0.5 * length * 2.0 * np.array(WEIGHTS[rule][values.get("INTEGRATION", 0)])
        self.rubs = "FRICTION" in values
        self.rigid = values["ALPHAN"] == 0
        self.kind = values["LAW"]
        self.work = np.zeros(COPIES)
        # T = p - beta w is a difference of large numbers, and so is the stress of quads that move as a whole
        betas = np.array([values.get("BETAN", 0.0), values.get("BETAT", 0.0)])
        self.rounded_traction = 2 * np.finfo(float).eps * (betas + QUAD)
        self.rounding = np.zeros(COPIES)
        zero = np.zeros((COPIES, rule))
        self.old = dict.fromkeys(("SEPN", "SEPT", "WN", "WT", "TN", "TT", "DISSF", "DAMAGE", "MAXT"), zero)
        self.cohesive = self.doubt = zero

    def advance(self, state, names):
        """Work up to now; elements whose share of law and friction in T_tau is not known."""
        old, (normal, tangential) = self.old, names
        opened, slid = state[normal] - old[normal], state[tangential] - old[tangential]
        rubbed = state["DISSF"] - old["DISSF"]
        # a slip of nothing but rounding is none
        slips = abs(slid) > 1e-8 * (abs(state[tangential]) + abs(old[tangential]))
        friction = np.divide(rubbed, slid, out=np.zeros_like(slid), where=slips)
        # closing ends at a normal traction of nothing but rounding, of either sign
        reach = np.abs([state[normal], old[normal], state[tangential], old[tangential]]).sum(axis=0)
        pressed = state["TN"] < -1e-9 * abs(state["TT"]) - self.rounded_traction[0] * reach
        free = (not self.rubs) | (old["DAMAGE"] == 0) | ~pressed | slips
        cohesive = np.where(free, state["TT"] - friction, self.cohesive)
        # a short slip says little of its friction, whose error a long one after it multiplies
        spread = state["DISSF"] + abs(friction) * (abs(state[tangential]) + abs(old[tangential]))
        error = np.divide(4 * np.finfo(float).eps * spread, abs(slid), out=np.zeros_like(slid), where=slips)
        doubt = np.where(free, error, self.doubt)
        done = 0.5 * (old["TN"] + state["TN"]) * opened + 0.5 * (self.cohesive + cohesive) * slid + rubbed
        self.work = self.work + (done * self.area).sum(axis=1)
        separation = np.stack([abs(state[normal]).max(axis=1), abs(state[tangential]).max(axis=1)], axis=1)
        self.rounding += separation**2 @ self.rounded_traction * self.area.sum()
        self.rounding += 0.5 * ((self.doubt + doubt) * abs(slid) * self.area).sum(axis=1)
        # a rigid point that rubs at rest: what the law holds of T_tau is not in its state
        unknown = self.rigid & (self.kind == PPR) & (old["MAXT"] == 0) & (old["DAMAGE"] > 0)
        self.cohesive, self.doubt, self.old = cohesive, doubt, {name: state[name].copy() for name in old}
        return unknown.any(axis=1)


def check_energies(tools, variant, kind, extra, data):
    """Work = stored + dissipated, and no increment gains from damage, viscosity and friction together."""
    jtype, closure = VARIANTS[variant]
    values = data.draw(properties(tools.reference, kind, closure, extra))
    seed = data.draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    values["INTEGRATION"] = int(rng.integers(2))
    crowd = Crowd(tools.element, tools.interface, jtype, **values)
    item, balance = crowd.item, Balance(crowd, values)
    # the paper's closure has the damage at the displacement jump: that of the standard element, whatever the traction
    standard = None
    if not closure and jtype not in (2, 5):
        standard = Crowd(tools.element, tools.interface, 5 if jtype == 6 else 2, **values)
    names = ("WN", "WT") if closure else ("SEPN", "SEPT")
    # a point that fails at once works nothing
    before, largest = np.zeros(COPIES), np.full(COPIES, 1e-6 * balance.area.sum() * min(values["GIC"], values["GIIC"]))
    for ends in walk(rng, values, alike=jtype in (3, 4, 6)):
        rubbed = item.state["DISSF"]
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
            standard.call("advance", standard.displacements(ends, np.zeros((COPIES, standard.nodes, 2))), 0.1)
            expected = standard.item.energy[:, [DAMAGE, VISCOUS]]
            np.testing.assert_allclose(
                energy[:, [DAMAGE, VISCOUS]], expected, rtol=1e-9, atol=1e-12 * largest.max(), err_msg=str(where)
            )
        else:
            unknown = balance.advance(state, names)
            total = energy[:, [ELASTIC, DAMAGE, VISCOUS]].sum(axis=1)
            largest = np.maximum(largest, abs(balance.work))
            # the overstress of the consistent law is that of the end of the increment
            if not (closure and "VISCOSITY" in values):
                balance.work = np.where(unknown, total, balance.work)
                wrong = np.flatnonzero(abs(total - balance.work) > 1e-7 * largest + balance.rounding)
                assert not wrong.size, (seed, wrong, total[wrong], balance.work[wrong], values)
        # a damage that lags behind gives back what its overstress has stored
        lost = energy[:, DAMAGE] + energy[:, VISCOUS]
        largest = np.maximum(largest, np.maximum(energy[:, ELASTIC], lost))
        # the work of damage is of tractions with this rounding, too
        assert (lost >= before - 1e-10 * largest - balance.rounding).all(), where
        before = lost
        assert "VISCOSITY" in values or not energy[:, VISCOUS].any()
        assert (state["DISSF"] >= rubbed - 1e-12 * largest[:, None]).all(), where
        assert (state["DAMAGE"] <= 1).all()


@one_library
@cases
def test_energies(tools, variant, kind, extra):
    run(check_energies, 1, tools, variant, kind, extra, again=True)


@pytest.mark.long
@one_library
@cases
def test_energies_at_length(tools, variant, kind, extra):
    # 32 copies, 32 increments
    run(check_energies, 50, tools, variant, kind, extra)
