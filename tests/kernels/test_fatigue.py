# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damage by cycles of a load: CF20 beside the bilinear law, in the standard and the consistent elements.

Expected values are closed forms of the law of Davila et al., NASA/TP-2020-220584, with its constants.
"""

import numpy as np
import pytest
from solid_pairs import OWNING, corners_of, geometry
from space import nodes_of, opened
from variants import STIFF, nodes_and_unit, rigid, variants

from uel.errors import KernelError
from uel.usersub.layout import element_layouts

CYCLES, LESS_IN_SHEAR = 1e7, 0.42
RIGID = rigid(5e4)
VARIANTS = variants(5e4, "U4 paper")
# friction and viscosity beside it
RUBBED = {"U4 rubbed": (4, RIGID | {"FRICTION": 0.3}), "U8 viscous": (8, RIGID | {"FRICTION": 0.3, "VISCOSITY": 0.1})}
# damage by the displacement jump, which is the separation in the standard elements
JUMP = ("U2", "U7")
ETA = 2.284
SHARES = (0.0, 0.5, 1.0)
"""Mode II in the energy; the stiffness is the same in both directions, so that it is the square of a sine."""


def endurance(ratio, shear=0.0, eps=0.2, eta=0.95):
    """E and b."""
    e = eps * (1 - LESS_IN_SHEAR * shear)
    limit = 2 * e / (e + 1 + ratio * (e - 1))
    return limit, -7 * eta / np.log10(limit)


def life(level, ratio, shear=0.0, more=0.0, **values):
    """Cycles at which a constant traction of this share of the strength is all that the softening line has left.

    The integral of (1 - D)**(b + m) dD from 0 to 1 - S; the rate is a (1 - D)**-m (S/(E (1 - D)))**b.
    """
    limit, exponent = endurance(ratio, shear, **values)
    return CYCLES * (limit / level) ** exponent * (1 - level ** (exponent + more + 1))


def law_of(shear):
    """Strength and fracture energy in a mode mix: quadratic criterion, Benzeggagh and Kenane."""
    strength = 1 / np.sqrt(shear / 60**2 + (1 - shear) / 30**2)
    return strength, 0.26 + (1.002 - 0.26) * shear**ETA


class Cycled:
    """An element whose points have one separation, in the direction of a mode mix."""

    def __init__(self, element, interface, variant, shear, **values):
        jtype, given = VARIANTS[variant]
        nodes, self.unit = nodes_and_unit(jtype, interface, shear)
        options = {"LAW": 2, "ETA": ETA, "FATIGUE": 1, "DAMAGEJUMP": 0.9, "LOADRATIO": 0.1}
        self.item = element(jtype, nodes, **options | given | values)
        rhs, _ = self.item.advance(1e-7 * self.unit, dtime=0.0)
        self.area = -(rhs @ self.unit) / self.traction
        self.gap = 0.0

    @property
    def traction(self):
        state = self.item.state
        return np.linalg.norm([state[name][0] for name in ("TN", "TS", "TT") if name in state])

    @property
    def spent(self):
        return self.item.state["SPENT"].max()

    @property
    def rate(self):
        return self.item.state["DDDN"].max()

    def hold(self, traction, cycles):
        """Let cycles pass under a traction; false if there is no equilibrium."""
        gap, force = self.gap, traction * self.area
        for _ in range(80):
            rhs, matrix = self.item.evaluate(gap * self.unit, dtime=cycles)
            excess, slope = -(rhs @ self.unit) - force, self.unit @ matrix @ self.unit
            if abs(excess) < 1e-11 * force:
                self.move(gap, cycles)
                return True
            if not slope > 0 or gap > 1:
                return False
            gap -= excess / slope
        return False

    def move(self, gap, cycles):
        """Let cycles pass at a separation."""
        self.item.advance(gap * self.unit, dtime=cycles)
        self.gap = gap


def lived(point, level, first, jump):
    """Cycles under a constant traction until the damage is 1 - S; the first step has `first` of them."""
    strength, _ = law_of(point.shear)
    assert point.hold(level * strength, 0.0)
    total, step = 0.0, first
    while point.spent < 1 - level - 1e-9:
        if not point.hold(level * strength, step):
            step *= 0.5
            if step < 1e-9 * total:
                break
            continue
        total += step
        step = min(jump, 1 - level - point.spent) / point.rate
    return total


@pytest.fixture
def cycled(element, interface):
    """Make an element under cycles: cycled(variant, share of mode II, NAME=value, ...)."""

    def make(variant, shear, **values):
        point = Cycled(element, interface, variant, shear, **values)
        point.shear = shear
        return point

    return make


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("ratio", [0.1, 0.5, -1.0])
@pytest.mark.parametrize("level", [0.55, 0.7, 0.9])
@pytest.mark.parametrize("variant", [name for name in VARIANTS if name != "U4 paper"])
def test_life_under_a_constant_traction(cycled, variant, level, ratio, shear):
    """Within 1 % in jumps of DAMAGEJUMP's default of 0.02, within 0.1 % in jumps of a quarter of it."""
    expected = life(level, ratio, shear)
    for jump, error in ((0.02, 0.01), (0.005, 0.001)):
        point = cycled(variant, shear, LOADRATIO=ratio)
        assert lived(point, level, 1e-6 * expected, jump) == pytest.approx(expected, rel=error)


STANDARD = {2: 4, 5: 6, 7: 8, 11: 12, 13: 404, 14: 1010}
"""Types without solids, and types whose faces are theirs."""


@pytest.mark.parametrize("jtype", [*STANDARD, *OWNING])
def test_every_type_has_the_law(element, cycled, jtype):
    """The damage of all points of an element whose top moves as a whole, in mode I: that of U2, or of U4."""
    layouts = element_layouts()
    owner = layouts[STANDARD.get(jtype, jtype)]
    dim, rng = owner.dimension, np.random.default_rng(jtype)
    nodes = geometry(STANDARD.get(jtype, jtype), rng, flat=True)
    corners = nodes[list(owner.faces[0][: corners_of(owner)])]
    along = corners[1:] - corners[0]
    normal = np.array([-along[0, 1], along[0, 0]]) if dim == 2 else np.cross(along[0], along[1])
    normal /= np.linalg.norm(normal)
    top = np.arange(len(nodes)) >= owner.solids[0]
    values = {"LAW": 2, "ETA": ETA, "FATIGUE": 1, "LOADRATIO": 0.1, "DAMAGEJUMP": 0.9}
    if jtype in STANDARD:
        layout = layouts[jtype]
        chosen = np.zeros(layout.nodes, dtype=int)
        for own, given in zip(layout.faces, owner.faces, strict=True):
            chosen[list(own)] = given
        nodes, top, values, like = nodes[chosen], top[chosen], values | STIFF, "U2"
    else:
        values, like = values | RIGID, "U4 rigid"
    item, same = element(jtype, nodes, **values), cycled(like, 0.0)
    for gap, cycles in ((4e-4, 0.0), (4e-4, 300.0), (5e-4, 1000.0)):
        item.advance(gap * top[:, None] * normal, dtime=cycles)
        same.move(gap, cycles)
    assert same.spent > 0.01
    np.testing.assert_allclose(item.state["SPENT"], same.spent, rtol=1e-8)
    np.testing.assert_allclose(item.state["DDDN"], same.rate, rtol=1e-6)


@pytest.mark.parametrize("level", [0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99])
def test_table_of_lives(cycled, level):
    """The printed numbers of S-N lines at R = 0.1 in mode I, which closed form and integration have found elsewhere."""
    printed = {0.5: 6.712e4, 0.6: 4458, 0.7: 448.9, 0.8: 60.04, 0.9: 8.712, 0.95: 2.674, 0.99: 0.3833}[level]
    assert life(level, 0.1) == pytest.approx(printed, rel=2e-4)
    assert lived(cycled("U4 rigid", 0.0), level, 1e-6 * printed, 0.02) == pytest.approx(printed, rel=0.01)


def test_order_of_the_integration(cycled):
    """Damage after some cycles, from (1 - D)**(b + 1) = 1 - N a (b + 1) (S/E)**b, in 50, 100 and 1600 jumps."""
    level, cycles = 0.7, 300.0
    limit, exponent = endurance(0.1)
    expected = 1 - (1 - cycles / CYCLES * (level / limit) ** exponent) ** (1 / (exponent + 1))
    errors = []
    for count in (50, 100, 1600):
        point = cycled("U4 rigid", 0.0)
        point.hold(level * 30.0, 0.0)
        for _ in range(count):
            assert point.hold(level * 30.0, cycles / count)
        errors.append(abs(point.spent / expected - 1))
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert errors[2] < 1e-6


@pytest.mark.parametrize("shear", SHARES)
@pytest.mark.parametrize("variant", JUMP)
def test_constant_separation(cycled, variant, shear):
    """lambda*(N)**(b + 1) = lambda*(0)**(b + 1) + (lambda_f - lambda_0) lambda**b N/(E**b gamma)."""
    strength, energy = law_of(shear)
    onset, failure = strength / 1e6, 2 * energy / strength
    limit, exponent = endurance(0.1, shear)
    gap, cycles = 0.5 * failure, 2e3
    softened = (gap ** (exponent + 1) + (failure - onset) * (gap / limit) ** exponent * cycles / CYCLES) ** (
        1 / (exponent + 1)
    )
    point = cycled(variant, shear)
    point.move(gap, 0.0)
    for _ in range(200):
        point.move(gap, cycles / 200)
    assert point.spent == pytest.approx((softened - onset) / (failure - onset), rel=1e-3)


@pytest.mark.parametrize("more", [-0.5, 0.7])
@pytest.mark.parametrize("variant", ["U2", "U4 rigid"])
def test_exponent_endurance_and_brittleness(cycled, variant, more):
    values = {"ENDURANCE": 0.25, "BRITTLENESS": 0.8, "EXPONENT": more}
    expected = life(0.7, 0.1, more=more, eps=0.25, eta=0.8)
    assert lived(cycled(variant, 0.0, **values), 0.7, 1e-6 * expected, 0.01) == pytest.approx(expected, rel=0.003)


@pytest.mark.parametrize("stiffness", [1e5, 1e6, 1e8, 0.0])
def test_life_does_not_depend_on_the_stiffness(cycled, stiffness):
    point = cycled("U4 rigid", 0.0, ALPHAN=stiffness, ALPHAT=stiffness)
    assert lived(point, 0.6, 1e-3, 0.01) == pytest.approx(life(0.6, 0.1), rel=1e-3)


@pytest.mark.parametrize("variant", VARIANTS)
def test_nothing_happens_without_cycles(cycled, variant):
    """At R = 1, in no time, below the endurance limit, and before the step FATIGUE."""
    for values, gap in (({"LOADRATIO": 1.0}, 5e-4), ({}, 1e-5), ({"FATIGUE": 2}, 5e-4)):
        point = cycled(variant, 0.3, **values)
        point.move(gap, 0.0)
        before = point.item.state
        point.move(gap, 1e5)
        after = point.item.state
        for name in set(before) - {"CYCLES"}:
            np.testing.assert_array_equal(after[name], before[name], err_msg=name)
        assert (after["CYCLES"] == (1e5 if not values else 0.0)).all()


@pytest.mark.parametrize("variant", ["U2", "U4 rigid", "U7"])
def test_state_of_a_point(cycled, variant):
    """RELSEP is the share of the strength that the traction is, DDDN the closed form, CYCLES end with failure."""
    point = cycled(variant, 0.0)
    point.hold(18.0, 0.0)
    assert point.item.state["RELSEP"] == pytest.approx(0.6, rel=1e-9)
    assert (point.item.state["DDDN"] == 0).all()
    point.hold(18.0, 1000.0)
    state = point.item.state
    limit, exponent = endurance(0.1)
    damage = state["SPENT"][0]
    assert state["RELSEP"] == pytest.approx(0.6 / (1 - damage), rel=1e-9)
    assert state["DDDN"] == pytest.approx((0.6 / (1 - damage) / limit) ** exponent / CYCLES / (exponent + 1), rel=1e-9)
    point.move(0.1, 50.0)
    point.move(0.1, 70.0)
    state = point.item.state
    assert (state["SPENT"] == 1).all()
    assert (state["DDDN"] == 0).all()
    assert state["CYCLES"] == pytest.approx(1050.0)


@pytest.mark.parametrize("variant", VARIANTS)
def test_increments_ask_for_the_damage_they_may_add(cycled, variant):
    """PNEWDT aims at 0.9 of DAMAGEJUMP: below 1 beyond it, up to 1.5 without it."""
    asked = {}
    for jump in (0.0, 0.1):
        point = cycled(variant, 0.0, DAMAGEJUMP=jump)
        point.move(3e-3, 0.0)
        # the cycles of the whole damage, nearly, and of next to none
        for cycles in (1e5, 1e-4):
            point.item.evaluate(point.gap * point.unit, dtime=cycles)
            asked[jump, cycles] = point.item.report.pnewdt
    assert asked[0.0, 1e5] < asked[0.1, 1e5] < 1
    assert asked[0.0, 1e5] == pytest.approx(0.2 * asked[0.1, 1e5])
    assert asked[0.0, 1e-4] > 1e30


@pytest.mark.parametrize("exponent", [0.0, 0.6, -0.4])
@pytest.mark.parametrize("ratio", [1.0, 3.0])
@pytest.mark.parametrize("variant", [*VARIANTS, *RUBBED])
def test_tangent(element, interface, variant, ratio, exponent):
    """Against central differences, at random displacements after onset or before it, from 1e-5 to 1e4 cycles."""
    jtype, given = (VARIANTS | RUBBED)[variant]
    given = {**given, "EXPONENT": exponent}
    name = "ALPHAT" if given.get("ALPHAT") else "BETAT"
    given[name] *= ratio
    nodes = nodes_of(jtype, "flat") if jtype in (7, 8) else interface.four if jtype == 2 else interface.eight
    worst = np.zeros(2)
    for seed in range(12):
        rng = np.random.default_rng(seed)
        size = rng.uniform(0.2, 2.0) * 1e-3
        if jtype in (7, 8):
            u = np.asarray(opened(jtype, size * rng.uniform(0.2, 1.0, 3), seed, 2e-6))
        else:
            u = np.zeros(nodes.shape)
            u[len(nodes) // 2 :] = size * rng.uniform(0.2, 1.0, 2) @ interface.axes
            u += 2e-6 * rng.normal(size=u.shape)
        item = element(
            jtype, nodes, **{"LAW": 2, "ETA": ETA, "FATIGUE": 1, "LOADRATIO": 0.1, "DAMAGEJUMP": 0.9, **given}
        )
        for share in (0.95, 0.9):
            item.advance(share * u, dtime=0.0)
        u = (u * rng.uniform(0.8, 0.95) + 2e-6 * rng.normal(size=u.shape)).ravel()
        cycles = 10 ** rng.uniform(-5, 4)
        rhs, matrix = item.evaluate(u, dtime=cycles)
        step = 1e-9
        rows = [item.evaluate(u + step * side, dtime=cycles)[0] for side in np.eye(u.size)]
        others = [item.evaluate(u - step * side, dtime=cycles)[0] for side in np.eye(u.size)]
        differences = -(np.array(rows) - others).T / (2 * step)
        scale = max(abs(item.evaluate(u, dtime=0.0)[1]).max(), 1.0)
        worst = np.maximum(
            worst, [abs(differences - matrix).max() / scale, abs(rhs - item.evaluate(u, dtime=0.0)[0]).max()]
        )
    assert worst[0] < 2e-6
    assert worst[1] > 1e-3


def displacements(jtype, interface, gap, seed):
    """Displacements of an element with a separation (s, t, n), and random strains of its solids."""
    if jtype in (7, 8):
        return np.ravel(opened(jtype, np.asarray(gap), seed, 1e-5))
    nodes = 4 if jtype == 2 else 8
    u = 1e-5 * np.random.default_rng(seed).normal(size=(nodes, 2))
    u[nodes // 2 :] += np.array([gap[0], gap[2]]) @ interface.axes
    return u.ravel()


@pytest.fixture
def random_element(element, interface):
    """Make an element of a variant under cycles, in mixed mode, and its displacements at a separation."""

    def make(variant):
        jtype, given = (VARIANTS | RUBBED)[variant]
        nodes = nodes_of(jtype, "flat") if jtype in (7, 8) else interface.four if jtype == 2 else interface.eight
        values = {"LAW": 2, "ETA": ETA, "FATIGUE": 1, "LOADRATIO": 0.1, "DAMAGEJUMP": 0.9}
        return element(jtype, nodes, **values | given), lambda gap, seed: displacements(jtype, interface, gap, seed)

    return make


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("variant", [*VARIANTS, *RUBBED])
def test_damage_never_falls_on_a_random_path(random_element, variant, seed):
    """Nor does a dissipated energy. Shear reverses, faces close and rub, blocks of cycles alternate with none."""
    rng = np.random.default_rng(seed)
    item, at = random_element(variant)
    before = item.state
    for step in range(60):
        gap = 1.5e-3 * (1 + step / 30) * rng.normal(size=3)
        item.advance(at(gap, step), dtime=rng.choice([0.0, 10 ** rng.uniform(-3, 3)]))
        for name in ("DAMAGE", "DMAX", "SPENT", "DISSI", "DISSII", "DISSV", "DISSF", "CYCLES"):
            assert (item.state[name] >= before[name] * (1 - 1e-12)).all(), name
        # beyond failure it goes on growing, and with VISCOSITY an increment without duration keeps the damage
        if variant != "U8 viscous":
            assert (item.state["RELSEP"][item.state["SPENT"] < 1] <= 1 + 1e-9).all()
        before = item.state


@pytest.mark.parametrize("variant", [*JUMP, "U4 rigid", "U8 rigid"])
def test_energies_balance(random_element, variant):
    """Work by the trapezoidal rule, stored and dissipated energy, to rounding while faces are open and shear keeps on.

    The standard elements and the complete form: the others have no energy.
    """
    rng = np.random.default_rng(5)
    item, at = random_element(variant)
    u = at(np.full(3, 1e-4), 0)
    rhs, _ = item.advance(u, dtime=0.0)
    total, dissipated = 0.0, 0.0
    for step in range(80):
        gap = 1e-4 * (1 + step / 10) * rng.uniform(0.7, 1.0, 3)
        new, energy = at(gap, 0), item.energy.copy()
        new_rhs, _ = item.advance(new, dtime=10 ** rng.uniform(-2, 2))
        work = -0.5 * (rhs + new_rhs) @ (new - u)
        change = item.energy - energy
        assert work == pytest.approx(change[1] + change[3], abs=1e-9 * item.energy[1])
        total += abs(work)
        dissipated += change[3]
        u, rhs = new, new_rhs
    assert dissipated > 0.05 * total


@pytest.mark.parametrize("variant", VARIANTS)
def test_load_ratio_of_a_field_variable(cycled, variant):
    """Field variable 1 takes the place of LOADRATIO; 1 is a constant load."""
    grown = {}
    for field, ratio in ((None, 0.5), (0.5, 0.1), (None, 0.1), (1.0, 0.1)):
        point = cycled(variant, 0.0, LOADRATIO=ratio)
        fields = None if field is None else np.vstack([np.zeros(len(point.unit)), np.full(len(point.unit), field)])
        spent = []
        for cycles in (0.0, 100.0):
            point.item.advance(1e-3 * point.unit, dtime=cycles, fields=fields)
            spent.append(point.spent)
        grown[field, ratio] = spent[1] - spent[0]
    assert grown[0.5, 0.1] == grown[None, 0.5] < grown[None, 0.1]
    assert grown[1.0, 0.1] == 0


@pytest.mark.parametrize("variant", ["U2", "U8 rigid"])
@pytest.mark.parametrize("ratio", [1.5, -1.5])
def test_field_variables_that_are_no_load_ratio(cycled, variant, ratio):
    point = cycled(variant, 0.0)
    fields = np.full((2, len(point.unit)), ratio)
    with pytest.raises(KernelError, match=rf"load ratio since there is FATIGUE = 1, is {ratio}.*from -1 to 1"):
        point.item.advance(1e-3 * point.unit, fields=fields)
    # not before that step
    point = cycled(variant, 0.0, FATIGUE=2)
    point.item.advance(1e-3 * point.unit, fields=fields)


@pytest.mark.parametrize("variant", VARIANTS)
def test_steps_before_fatigue_have_no_cycles(cycled, variant):
    point = cycled(variant, 0.0, FATIGUE=3)
    point.move(1e-3, 0.0)
    before = point.spent
    point.item.advance(1e-3 * point.unit, dtime=100.0, step=2)
    assert point.spent == before
    point.item.advance(1e-3 * point.unit, dtime=100.0, step=3)
    assert point.spent > before


@pytest.mark.parametrize(
    "values, message",
    [
        ({"FATIGUE": -1}, r"JPROPS\(\d+\) FATIGUE = -1: expected zero or the number of a step"),
        ({"LAW": 3}, r"JPROPS\(\d+\) FATIGUE = 1, but LAW = 3, which has no fatigue: expected LAW = 1 or 2"),
        ({"ENDURANCE": 1.0}, r"PROPS\(\d+\) ENDURANCE = 1.*expected zero or a value between 0 and 1"),
        ({"BRITTLENESS": -1.0}, r"PROPS\(\d+\) BRITTLENESS = -1.*expected zero or a positive value"),
        ({"EXPONENT": -1.0}, r"PROPS\(\d+\) EXPONENT = -1.*expected a value above -1"),
        ({"LOADRATIO": 1.2}, r"PROPS\(\d+\) LOADRATIO = 1.2.*expected a value from -1 to 1"),
        ({"LOADRATIO": -1.2}, r"PROPS\(\d+\) LOADRATIO = -1.2.*expected a value from -1 to 1"),
        ({"DAMAGEJUMP": 1.0}, r"PROPS\(\d+\) DAMAGEJUMP = 1.*expected zero or a value between 0 and 1"),
    ],
)
@pytest.mark.parametrize("variant", ["U2", "U4 rigid", "U7", "U8 rigid"])
def test_messages(cycled, variant, values, message):
    with pytest.raises(KernelError, match=message):
        cycled(variant, 0.0, **values)
