# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""LAW 5, fibre bridging, and LAW 6, a table: beside each other and LAW 2, the bound of beta, and messages."""

import numpy as np
import pytest

from uel.errors import KernelError

FLAT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
RIGID = {"ALPHAN": 0.0, "ALPHAT": 0.0, "CLOSURE": 1, "BETAN": 2e5, "BETAT": 1.5e5}
STRENGTH, ENERGY = 0.1, 0.4
"""Shares of the bridging."""
BRIDGING = {"LAW": 5, "ETA": 1.45, "SIGMABRIDGE": STRENGTH * 30.0, "GIBRIDGE": ENERGY * 0.26}
PATH = [(0.002, 0.004), (0.0, 0.001), (-0.01, 0.006), (0.03, 0.05), (0.004, 0.002), (0.2, 0.05), (0.3, 0.4)]


def same_path(one, two, displacements, rtol):
    """Both elements have the same forces, matrices and energies along a path."""
    for number, gap in enumerate(PATH):
        u = displacements(gap, number)
        for a, b in zip(one.advance(u), two.advance(u), strict=True):
            np.testing.assert_allclose(a, b, rtol=rtol, atol=rtol * abs(b).max())
        np.testing.assert_allclose(one.energy, two.energy, rtol=rtol, atol=1e-14)


def test_a_table_of_the_corners_of_the_bridging_is_the_bridging(element, interface):
    """With equal shares in both modes and an infinite stiffness: the lines end at q_k = energy/strength share.

    The corner is where the tip fails, at q_1/q_2 of the separation at failure, under r (1 - q_1/q_2) of the strength.
    """
    tip, bridge = (1 - ENERGY) / (1 - STRENGTH), ENERGY / STRENGTH
    corner = {"SEPARATION1": tip / bridge, "TRACTION1": STRENGTH * (1 - tip / bridge)}
    one = element(4, interface.eight, **RIGID, **BRIDGING)
    two = element(4, interface.eight, **RIGID, LAW=6, ETA=1.45, **corner)
    same_path(one, two, lambda gap, k: interface.displacements(8, gap, (1.1 * gap[0], gap[1]), k), 1e-10)


@pytest.mark.parametrize("stiffness", [{}, RIGID], ids=["finite", "infinite"])
def test_a_table_on_the_line_is_the_bilinear_law(element, interface, stiffness):
    """One point, (0.4, 0.6), and three."""
    points = {"SEPARATION1": 0.4, "TRACTION1": 0.6}
    more = {"SEPARATION1": 0.25, "TRACTION1": 0.75, "SEPARATION2": 0.5, "TRACTION2": 0.5}
    more |= {"SEPARATION3": 0.875, "TRACTION3": 0.125}
    for table in (points, more):
        one = element(4, interface.eight, **stiffness, LAW=6, ETA=1.45, **table)
        two = element(4, interface.eight, **stiffness, LAW=2, ETA=1.45)
        same_path(one, two, lambda gap, k: interface.displacements(8, gap, (1.1 * gap[0], gap[1]), k), 1e-10)


@pytest.mark.parametrize("axis", [0, 1], ids=["II", "I"])
def test_the_bridging_is_two_bilinear_elements_in_pure_modes(element, law, axis):
    """Two elements on the same nodes, with the stiffness, strength and fracture energy of the tip and of the bridging.

    On any path of one mode, also unloaded and turned round: the secants add up (Davila, Rose, Camanho, Int. J. of
    Fracture 158 (2009) 211).
    """
    whole = element(2, FLAT, **BRIDGING)
    shares = ((1 - STRENGTH, 1 - ENERGY), (STRENGTH, ENERGY))
    parts = []
    for strength, energy in shares:
        values = {name: strength * law[name] for name in ("ALPHAN", "ALPHAT", "SIGMAMAX", "TAUMAX")}
        values |= {name: energy * law[name] for name in ("GIC", "GIIC")}
        parts.append(element(2, FLAT, LAW=2, ETA=1.45, **values))
    for size in (0.001, 0.004, 0.0005, 0.008, 0.0, 0.03, 0.01, 0.06, 0.2):
        u = np.zeros((4, 2))
        u[2:, axis] = size
        rhs, matrix = whole.advance(u)
        several = [part.advance(u) for part in parts]
        np.testing.assert_allclose(rhs, sum(r for r, _ in several), atol=1e-11 * 60.0)
        # across the axis, the damage acts on the whole stiffness: only the one along it is a sum
        along = np.ix_(range(axis, 8, 2), range(axis, 8, 2))
        total = sum(m for _, m in several)
        np.testing.assert_allclose(matrix[along], total[along], rtol=1e-9, atol=1e-9 * abs(total).max())
        dissipated = sum(part.energy[3] for part in parts)
        assert whole.energy[3] == pytest.approx(dissipated, rel=1e-10, abs=1e-14)


def random_law(rng, kind):
    """Properties of a law with shares or points that have little in common with each other, of any exponent."""
    values = {"LAW": kind, "SIGMAMAX": 30.0, "TAUMAX": rng.uniform(15.0, 90.0)}
    values |= {"GIC": 0.26, "GIIC": rng.uniform(0.1, 2.0)}
    values |= rng.choice([{}, {"ETA": rng.uniform(0.5, 4.0)}, {"POWER": rng.uniform(0.6, 3.0)}])
    if kind == 5:
        parts = {"SIGMABRIDGE": "SIGMAMAX", "TAUBRIDGE": "TAUMAX", "GIBRIDGE": "GIC", "GIIBRIDGE": "GIIC"}
        values |= {part: rng.uniform(0.03, 0.9) * values[total] for part, total in parts.items()}
    else:
        points = np.sort(rng.uniform(0.02, 0.98, (2, 3)))
        values |= {f"SEPARATION{k}": x for k, x in enumerate(points[0], 1)}
        values |= {f"TRACTION{k}": t for k, t in enumerate(points[1][::-1], 1)}
    alpha = 10 ** rng.uniform(4.2, 7.0)
    return values | {"ALPHAN": alpha, "ALPHAT": alpha * rng.uniform(0.5, 2.0)}


def jacobians(reference, values, b, rng, count=60):
    """Determinants of d(t/r + b w)/dw at random separations on the curve of a law, relative to b_n b_tau."""
    ratio = np.array([values["ALPHAT"] / values["ALPHAN"], 1.0])

    def trial(w):
        return (1 - reference.damage_of_law(values, w)) * values["ALPHAN"] * w + b * w

    assert ratio[1] == 1.0
    found = []
    for angle in rng.uniform(0.0, np.pi / 2, count):
        ray = np.array([np.sin(angle), np.cos(angle)])
        onset = reference.onset(values, ray)
        size = onset + reference.toughness(values, ray) / 30.0 * 10 ** rng.uniform(-3.0, 1.0)
        step = 1e-6 * size
        columns = [(trial(size * ray + step * e) - trial(size * ray - step * e)) / (2 * step) for e in np.eye(2)]
        found.append(np.linalg.det(np.array(columns)) / b.prod())
    return np.array(found)


@pytest.mark.parametrize("spread", [1.0, 0.5, 0.1])
@pytest.mark.parametrize("kind", [5, 6])
def test_beta_above_its_bound_gives_one_separation(element, interface, reference, kind, spread):
    """Steepest slope in any mode mix times 2 - b_min/b_max: t + beta w has no fold, and a lower beta is refused.

    A search over stiffness, strengths, energies, exponents, shares and points, for b_min/b_max from 0.02 to 0.7, found
    no law that needs more than 1 + 0.54 (1 - b_min/b_max).
    """
    rng = np.random.default_rng(2)
    laws = folded = 0
    while laws < 30:
        values = random_law(rng, kind)
        ratio = values["ALPHAT"] / values["ALPHAN"]
        slope = reference.steepest(values, ratio)
        if not np.isfinite(slope):
            continue
        laws += 1
        pair = np.array([1.0, 1.0 / spread])[:: rng.choice([1, -1])]
        for factor in (0.998, 1.002):
            b = factor * slope * (2 - spread) * pair
            item = element(4, interface.eight, CLOSURE=1, BETAN=b[1], BETAT=ratio * b[0], **values)
            if factor < 1:
                with pytest.raises(KernelError, match="too small for the consistent law"):
                    item.evaluate(np.zeros(16))
            else:
                item.evaluate(np.zeros(16))
        assert (jacobians(reference, values, b, rng) > 0).all(), values
        # what the check looks for
        folded += (jacobians(reference, values, 0.3 * slope * pair, rng) < 0).any()
    assert folded > 5


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, r"U2 element 42: PROPS\(14\) SIGMABRIDGE = 0.*: with LAW 5 the bridging is a part.*below SIGMAMAX"),
        ({"SIGMABRIDGE": 30.0}, r"PROPS\(14\) SIGMABRIDGE = 30.0.*a part of the total; expected .* below SIGMAMAX"),
        ({"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1, "TAUBRIDGE": 70.0}, r"PROPS\(15\) TAUBRIDGE = 70.0.* below TAUMAX"),
        ({"SIGMABRIDGE": 3.0}, r"PROPS\(16\) GIBRIDGE = 0.*a part of the total; expected a positive value below GIC"),
        ({"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.26}, r"PROPS\(16\) GIBRIDGE = 0.26.*; expected .* below GIC"),
        ({"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1, "GIIBRIDGE": 2.0}, r"PROPS\(17\) GIIBRIDGE = 2.0.* below GIIC"),
        ({"SIGMABRIDGE": -3.0}, r"PROPS\(14\) SIGMABRIDGE = -3.*: expected zero or a positive value"),
        # 3 MPa times half of the length at the onset, 30 MPa/2e4 N/mm^3
        (
            {"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.002},
            r"PROPS\(16\) GIBRIDGE = 2.0.*E-03, too small .* more than 2.25.*E-03",
        ),
        # 27 MPa times the same are left for the tip
        (
            {"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.25},
            r"PROPS\(16\) GIBRIDGE = 0.25.*, leaves too little .* less than 0.239",
        ),
        (
            {"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1, "GIIBRIDGE": 0.95},
            r"PROPS\(17\) GIIBRIDGE = 0.95.*, leaves too little .*expected less than 0.948",
        ),
        (
            {"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1, "ETA": 5.0, "ALPHAN": 2560.0, "ALPHAT": 2926.0},
            r"PROPS\(2\) ALPHAN = 2560.*too soft .* of one of the two lines.* mode II has 56 per cent",
        ),
    ],
)
def test_messages_of_the_bridging(element, values, message):
    item = element(2, FLAT, label=42, LAW=5, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(8))


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ((), r"U2 element 42: PROPS\(18\) SEPARATION1 = 0.*: LAW 6 requires a point.*expected a value between"),
        ((0.5, 0.5, 0.4, 0.2), r"PROPS\(20\) SEPARATION2 = 0.4.*: the separations of LAW 6 increase.*more than 0.5"),
        ((0.5, 0.5, 0.5, 0.2), r"PROPS\(20\) SEPARATION2 = 0.5.*expected more than 0.5"),
        ((0.0, 0.5), r"PROPS\(18\) SEPARATION1 = 0.*expected more than 0"),
        ((0.5, 0.5, 0.7, 0.6), r"PROPS\(21\) TRACTION2 = 0.6.*: the tractions .* do not increase.* value up to 0.5"),
        ((0.5, 0.0), r"PROPS\(19\) TRACTION1 = 0.*do not vanish before failure; expected a positive value up to 1"),
        ((0.5, 0.5, 0.0, 0.0, 0.7, 0.2), r"PROPS\(22\) SEPARATION3 = 0.7.*: the point before it is not used"),
        ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.7, 0.2), r"PROPS\(26\) SEPARATION5 = 0.7.*: the point before it"),
        ((1.0, 0.5), r"PROPS\(18\) SEPARATION1 = 1.*: expected zero or a value between 0 and 1"),
        ((0.5, 1.5), r"PROPS\(19\) TRACTION1 = 1.5.*: expected a value from 0 to 1"),
    ],
)
def test_messages_of_the_table(element, points, message):
    names = [f"{name}{k}" for k in range(1, 6) for name in ("SEPARATION", "TRACTION")]
    item = element(2, FLAT, label=42, LAW=6, **dict(zip(names, points, strict=False)))
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(8))


def test_a_table_that_is_too_brittle_is_refused_as_a_bilinear_law_is(element):
    item = element(2, FLAT, LAW=6, SEPARATION1=0.5, TRACTION1=0.5, GIC=0.02)
    with pytest.raises(KernelError, match=r"GIC = 2.0.*E-02.*too brittle.*more than 2.25.*E-02"):
        item.evaluate(np.zeros(8))
