# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The one-dimensional reference code for delamination under cycles against closed forms and other codes."""

from dataclasses import replace

import numpy as np
import pytest
from beam_on_cohesive_layer import (
    W_LOWER,
    W_UPPER,
    Arm,
    Layer,
    NoEquilibriumError,
    State,
    crack_length,
    cycle,
    load,
    reaction,
    release_rates,
)
from cyclic_cohesive_law import NORMAL, SHEAR, Cycles, Law
from scipy.integrate import cumulative_trapezoid, solve_ivp
from scipy.optimize import brentq
from specimens_under_cycles import bent, flexure, opened, steady_rate

# table of the closed form N_f = gamma (E/S)^b (1 - S^(b + 1)), by (R, B), with E and b of CF20's constants by hand
LIVES = {
    (0.1, 0.0): (0.35714, 14.872, (6.712e4, 4458, 448.9, 60.04, 8.712, 2.674, 0.3833)),
    (0.5, 0.0): (0.5, 22.091, (1.0e7, 1.782e5, 5913, 307.8, 20.94, 4.825, 0.5789)),
    (0.1, 1.0): (0.22577, 10.289, (2799, 427.7, 86.28, 20.45, 4.604, 1.668, 0.2663)),
    (0.1, 0.5): (0.29428, 12.518, (1.313e4, 1339, 193.0, 34.78, 6.356, 2.128, 0.3225)),
    (-1.0, 0.0): (0.2, 9.514, (1636, 287.5, 65.07, 16.92, 4.085, 1.520, 0.2470)),
}
SHARES = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99)
RIGID = Law()
# IM7/8552 and its two laws in CompDam's example: nasa/CompDam_DGD, examples/interlaminar/test_DCB_3D_fatigue.inp.
# The stiffness of sliding follows from that of opening as in its manual
TAPE = Arm(2.25, 146_671.0, 8_703.0, 5_164.0, 0.32)
QUASI_STATIC = Law((80.0, 99.0), (0.214, 0.59), 2.1, 2e5, 0.214 * 99.0**2 / (0.59 * 80.0**2))
BRIDGING = Law((0.8, 1.0), (0.140, 0.193), 3.0, 2e3, 0.140 * 1.0**2 / (0.193 * 0.8**2))


@pytest.mark.parametrize(("ratio", "mix"), LIVES)
def test_lives_at_constant_traction(ratio: float, mix: float) -> None:
    cycles = Cycles(ratio)
    limit, exponent, lives = LIVES[ratio, mix]
    assert cycles.limit(mix) == pytest.approx(limit, abs=0.5e-5)
    assert cycles.exponent(mix) == pytest.approx(exponent, abs=0.5e-3)
    for share, life in zip(SHARES, lives, strict=True):
        assert float(f"{cycles.life_at_traction(share, mix):.4g}") == life


@pytest.mark.parametrize("p_mod", [0.0, -1.5])
@pytest.mark.parametrize(("ratio", "mix"), LIVES)
def test_life_is_the_integral_of_the_rate(ratio: float, mix: float, p_mod: float) -> None:
    cycles = Cycles(ratio, p_mod=p_mod)
    # a share equal to the limit, as of R = 0.5, grows or not by rounding
    for share in np.maximum(SHARES, float(cycles.limit(mix)) * (1.0 + 1e-12)):
        # dN/dD is integrated: N over D has no singular end
        answer = solve_ivp(
            lambda damage, _, s=share: 1.0 / cycles.rate(damage, s / (1.0 - damage), mix),
            (0.0, 1.0 - share),
            [0.0],
            rtol=1e-10,
            atol=1e-12,
        )
        assert answer.y[0, -1] == pytest.approx(cycles.life_at_traction(share, mix), rel=1e-8)


def response(law: Law, w: np.ndarray, history: float, cycles: float):
    """Response of one point at a separation: of the p along a line that have it, the one with the right size."""
    betas = law.beta * np.array([1.0, law.ratio])
    direction = betas * w

    def excess(size: float) -> float:
        p = size * direction
        answer = law.respond(p[None], np.array([history]), cycles)
        return float((p - answer.tractions[0]) @ w / (betas * w @ w) - 1.0)

    p = brentq(excess, 0.5, 1e3, xtol=1e-14, rtol=1e-14) * direction
    return law.respond(p[None], np.array([history]), cycles)


@pytest.mark.parametrize("stiffness", [1e5, np.inf])
def test_damage_at_constant_separation(stiffness: float) -> None:
    law = replace(RIGID, stiffness=stiffness)
    limit, b = float(law.cycles.limit(0.0)), float(law.cycles.exponent(0.0))
    first, last = law.strengths[0] / stiffness, 2.0 * law.toughnesses[0] / law.strengths[0]
    separation, cycles = 0.004, 2e4
    # D starts at 0.3; lambda*^(b + 1) rises linearly in N
    start = first + 0.3 * (last - first)
    exact = (start ** (b + 1.0) + (last - first) * separation**b * cycles / (limit**b * 1e7)) ** (1.0 / (b + 1.0))
    errors = []
    for jumps in (50, 100):
        history = 0.3
        for _ in range(jumps):
            answer = response(law, np.array([separation, 0.0]), history, cycles / jumps)
            history = answer.history[0]
        errors.append(history - (exact - first) / (last - first))
        assert answer.tractions[0, NORMAL] == pytest.approx(
            law.strengths[0] * (1.0 - history) * separation / (first + history * (last - first)), rel=1e-9
        )
    assert exact > start + 0.1 * last
    # implicit jumps are of first order
    assert abs(errors[1]) < 5e-3
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("eta", [None, 2.73])
@pytest.mark.parametrize(("stiffness", "ratio"), [(np.inf, 1.0), (1e5, 1.0), (1e5, 0.6)])
@pytest.mark.parametrize("angle", [0.0, 0.5, 1.1, 0.5 * np.pi])
def test_static_law(angle: float, stiffness: float, ratio: float, eta: float | None) -> None:
    law = Law(eta=eta, stiffness=stiffness, ratio=ratio)
    betas = law.beta * np.array([1.0, ratio])
    path = np.array([np.cos(angle), np.sin(angle)])
    p = np.linspace(1e-6, 1.05, 4001)[:, None] * betas * path * 0.06
    answer = law.respond(p, np.zeros(len(p)), 0.0)
    w = (p - answer.tractions) / betas
    work = sum(np.trapezoid(answer.tractions[:, k], w[:, k]) for k in (NORMAL, SHEAR))
    mix = ratio * path[SHEAR] ** 2 / (path[NORMAL] ** 2 + ratio * path[SHEAR] ** 2)
    # of the grid the curve's corner misses a part
    assert answer.damage[-1] == 1.0
    assert work == pytest.approx(float(law.toughness(mix)), rel=2e-3)
    onset = np.linalg.norm(answer.tractions / law.strengths, axis=1).max()
    assert onset == pytest.approx(1.0, abs=2e-3)
    spent = cumulative_trapezoid(np.einsum("nk,nk->n", answer.tractions, path[None] + 0.0 * w), w @ path, initial=0.0)
    elastic = 0.5 * np.einsum("nk,nk->n", answer.tractions, w)
    # D is the share of the fracture energy that is neither stored nor left
    assert answer.damage == pytest.approx((spent - elastic) / work, abs=3e-3)


def test_tangent_of_the_law() -> None:
    rng = np.random.default_rng(3)
    law = replace(RIGID, stiffness=1e5, ratio=0.7)
    p = rng.normal(size=(300, 2)) * [60.0, 90.0]
    history = np.where(rng.random(300) < 0.3, 0.0, rng.random(300))
    for cycles in (0.0, 1e2, 1e5):
        answer = law.respond(p, history, cycles)
        for k in (NORMAL, SHEAR):
            step = np.zeros(2)
            step[k] = 1e-5
            ends = [law.respond(p + sign * step, history, cycles).tractions for sign in (1.0, -1.0)]
            assert answer.jacobian[:, :, k] == pytest.approx((ends[0] - ends[1]) / 2e-5, abs=2e-5)


def test_damage_only_grows_above_the_endurance_limit() -> None:
    limit, largest = float(RIGID.cycles.limit(0.0)), RIGID.strengths[NORMAL]
    p = np.array([[0.999 * limit * largest, 0.0], [1.01 * limit * largest, 0.0]])
    answer = RIGID.respond(p, np.zeros(2), 1e6)
    assert answer.damage[0] == 0.0
    assert answer.damage[1] > 0.0
    # no jump carries a point below the limit
    s = answer.tractions[:, NORMAL] / (largest * (1.0 - answer.damage))
    assert s[1] >= limit * (1.0 - 1e-12)
    overload = RIGID.respond(np.array([[150.0, 0.0]]), np.zeros(1), 0.0)
    assert 0.0 < overload.damage[0] < 1.0
    unloaded = RIGID.respond(np.array([[1.0, 0.0]]), overload.history, 1e6)
    assert unloaded.damage == pytest.approx(overload.damage, rel=1e-12)
    # with R near 1 the limit is the strength
    assert Cycles(0.999).limit(0.0) == pytest.approx(1.0, abs=3e-3)


def test_face_of_an_arm_moves_as_in_plane_elasticity() -> None:
    arm = Arm()
    for wave, tolerance in ((0.5, 1e-3), (1.0, 4e-3), (2.0, 0.02), (4.0, 1e-9), (6.0, 0.02)):
        # bending and shear, and tension with bending by an eccentric traction; then the face
        k = wave / arm.height
        beam = np.array(
            [
                1.0 / (arm.bending * k**4) + 1.2 * arm.slip / (arm.height * k**2),
                4.0 / (arm.e1 * arm.height * k**2),
            ]
        )
        face = arm.face_compliances / (1.0 + (k * arm.face_lengths) ** 2)
        assert (beam + face)[NORMAL] == pytest.approx(arm.face_motions(k)[NORMAL], rel=tolerance)
        # the shear of a face spreads more than one length can say
        assert (beam + face)[SHEAR] == pytest.approx(arm.face_motions(k)[SHEAR], rel=0.2)
        assert beam[SHEAR] < 0.9 * arm.face_motions(k)[SHEAR]
    # long waves: the expansion itself
    k = 0.4 / arm.height
    beam = 1.0 / (arm.bending * k**4) + 1.2 * arm.slip / (arm.height * k**2)
    assert arm.face_motions(k)[NORMAL] - beam == pytest.approx(arm.face_compliances[NORMAL], rel=0.01)


def test_compliance_of_a_bonded_cantilever_beam() -> None:
    # arms on a rigid layer that never opens: the rotation decays over the length l = sqrt(EI/kGA), the root turns by
    # P a l/EI
    arm, crack = Arm(), 35.0
    law = Law((1e5, 1e5), (1e5, 1e5), cycles=None)
    specimen = replace(opened(2.0, crack, 100.0, [law], arm, 0.125, 20.0), faces=False)
    layer = Layer(specimen)
    shear = 1.2 * arm.slip / arm.height
    decay = np.sqrt(arm.bending * shear)
    compliance = crack**3 / (3.0 * arm.bending) + crack * shear + crack**2 * decay / arm.bending
    force = reaction(layer, load(layer), (0, W_UPPER))
    assert force == pytest.approx(1.0 / compliance, rel=2e-4)


@pytest.mark.parametrize("mix", [0.0, 0.5, 1.0])
def test_energy_release_rate_of_moments(mix: float) -> None:
    # beam theory, see `bent`; the sum over the nodes is exact
    release = 0.5 * float(RIGID.toughness(mix))
    layer = Layer(bent(release, mix, RIGID, size=0.5))
    rates = release_rates(layer, load(layer))
    assert rates == pytest.approx([(1.0 - mix) * release, mix * release], rel=1e-8, abs=1e-12)


def test_static_growth_spends_the_fracture_energy() -> None:
    layer = Layer(opened(4.0, 35.0, 100.0, [replace(RIGID, cycles=None)], Arm(), 0.125, 15.0))
    state = load(layer, 80)
    assert crack_length(layer, state) > 40.0
    # G wavers by 0.2 % while the front passes from node to node; with 0.25 mm by 1.3 %, and a beam snaps back
    assert release_rates(layer, state)[0] == pytest.approx(0.26, rel=3e-3)


def paris_line(shares: tuple[float, ...], mix: float, **options) -> np.ndarray:
    return np.array([steady_rate(share, mix, size=0.5, d_max=0.05, **options) for share in shares])


@pytest.mark.parametrize(("ratio", "mix"), [(0.1, 0.0), (0.5, 0.0), (0.1, 0.5), (0.1, 1.0)])
def test_paris_exponent(ratio: float, mix: float) -> None:
    # for p = b the law is homogeneous in the traction, and G in its square; in mixed mode b varies with the mix along
    # the layer, around that of the whole
    tolerance = 3e-3 if 0.0 < mix < 1.0 else 1e-3
    shares = (0.4, 0.8)
    law = replace(RIGID, cycles=Cycles(ratio))
    rates = paris_line(shares, mix, law=law)
    exponent = np.log(rates[1] / rates[0]) / np.log(shares[1] / shares[0])
    assert exponent == pytest.approx(0.5 * float(law.cycles.exponent(mix)), rel=tolerance)


def test_threshold_and_static_limit() -> None:
    # all of a damaged length at s = E releases E^2 of the fracture energy
    threshold = float(RIGID.cycles.limit(0.0)) ** 2
    assert steady_rate(0.94 * threshold, size=0.5, d_max=0.05) == 0.0
    assert steady_rate(1.10 * threshold, size=0.5, d_max=0.05) > 0.0
    with pytest.raises(NoEquilibriumError):
        steady_rate(1.02, size=0.5, d_max=0.05)


@pytest.mark.sample(3)
@pytest.mark.parametrize("mix", [0.0, 0.5, 1.0])
def test_rate_depends_neither_on_mesh_nor_jumps_nor_stiffness(mix: float) -> None:
    best = steady_rate(0.6, mix, d_max=0.05)
    # second order in size (4 % from 0.25 to 0.5 mm), first order in d_max
    assert steady_rate(0.6, mix, size=0.5, d_max=0.05) == pytest.approx(best, rel=0.06)
    assert steady_rate(0.6, mix, d_max=0.02) == pytest.approx(best, rel=0.025)
    assert steady_rate(0.6, mix, replace(RIGID, stiffness=1e5), d_max=0.05) == pytest.approx(best, rel=0.04)
    # the regularisation has no influence, but for the tolerance of the increments
    assert steady_rate(0.6, mix, replace(RIGID, stabilisation=30.0), d_max=0.05) == pytest.approx(best, rel=1e-5)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("share", "rate"), [(0.4, 3.709e-5), (0.6, 7.569e-4), (0.8, 6.424e-3)])
def test_rate_of_a_plane_stress_code(share: float, rate: float) -> None:
    # other code: an independent prototype with 2D elements, rigid interface, size 0.25 mm, dD_max 0.02
    assert steady_rate(share) == pytest.approx(rate, rel=0.03)


REGRESSION = [(0.0, 0.6, 7.447e-4), (0.5, 0.6, 2.378e-3), (1.0, 0.6, 1.2375e-2)]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("mix", "share", "rate"), REGRESSION)
def test_recorded_rates(mix: float, share: float, rate: float) -> None:
    # regression
    assert steady_rate(share, mix) == pytest.approx(rate, rel=1e-3)


def test_growth_rises_with_the_crack_in_flexure() -> None:
    # G grows with a^2, also along the damaged length: da/dN is that of a constant G but for terms of this length over
    # a, 12 % at most for ENF, where it is 5 mm, and 6 % for MMB
    arm, crack, half_span = Arm(), 30.0, 60.0
    cases = ((0.0, 1.0, 0.12), (0.8744 * half_span, 0.485, 0.06))
    for (lever, mix, tolerance), force in zip(cases, (15.8, 4.0), strict=True):
        layer = Layer(flexure(force, lever, half_span, crack, RIGID, arm=arm, size=0.5))
        run = cycle(layer, load(layer), 9.0, 0.05)
        at = 38.0
        release = np.array([np.interp(at, run.crack, run.release[:, k]) for k in (NORMAL, SHEAR)])
        assert release[SHEAR] / release.sum() == pytest.approx(mix, abs=0.01)
        share = release.sum() / float(RIGID.toughness(mix))
        assert run.rate(at - 0.5, at + 0.5) == pytest.approx(paris_line((share,), mix)[0], rel=tolerance)


def test_a_block_without_growth_changes_nothing() -> None:
    layer = Layer(bent(0.5 * 0.26, 0.0, RIGID, size=0.5))
    state = load(layer)
    run = cycle(layer, state, 5.0, cycles=0.0)
    assert isinstance(run.state, State)
    assert run.state is state
    later = cycle(layer, state, 1.0).state
    assert np.all(later.history >= state.history)


def two_laws() -> Layer:
    return Layer(opened(1.92, 50.8, 50.8 + 7.5 + 3.0 * 2.25, [QUASI_STATIC, BRIDGING], TAPE, 0.1, 9.0))


def test_static_load_of_two_laws() -> None:
    layer = two_laws()
    state = load(layer, 20)
    force = reaction(layer, state, (0, W_UPPER))
    assert force == pytest.approx(-reaction(layer, state, (0, W_LOWER)), rel=1e-9)
    # corrected beam theory, EI = 139,220 N mm^2 and chi h = 4.29 mm; the layer is softer than the theory's
    assert force == pytest.approx(2.397, rel=0.005)
    # other code: CompDam with continuum shells, test_DCB_3D_fatigue_expected.py
    assert force == pytest.approx(2.352, rel=0.02)


@pytest.mark.long
def test_growth_of_two_laws() -> None:
    layer = two_laws()
    run = cycle(layer, load(layer, 20), 7.5)
    # regression: both laws suffer fatigue, as in CompDam; with a lasting bridging tail growth is 28 times slower
    assert np.interp(58.0, run.crack, run.cycles) == pytest.approx(1.386e6, rel=0.01)
