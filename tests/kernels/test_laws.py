# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every cohesive law through the element: values, energies in every mode mix, limits, messages."""

from itertools import pairwise

import numpy as np
import pytest

from uel.errors import KernelError

FLAT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
BRIDGING = {"SIGMABRIDGE": 3.0, "TAUBRIDGE": 12.0, "GIBRIDGE": 0.08, "GIIBRIDGE": 0.5}
POINTS = ((0.1, 0.5), (0.4, 0.5), (0.5, 0.2))
TABLE = {f"{name}{k}": p[i] for k, p in enumerate(POINTS, 1) for i, name in enumerate(("SEPARATION", "TRACTION"))}
LAWS = {
    "bilinear": {"LAW": 1},
    "Benzeggagh-Kenane": {"LAW": 2, "ETA": 2.284},
    "Benzeggagh-Kenane, low exponent": {"LAW": 2, "ETA": 0.6},
    "power law": {"LAW": 2, "POWER": 1.7},
    "power law, low exponent": {"LAW": 2, "POWER": 0.7},
    "exponential": {"LAW": 3},
    "exponential, Benzeggagh-Kenane": {"LAW": 3, "ETA": 1.45},
    "exponential, power law": {"LAW": 3, "POWER": 2.0},
    "bridging": {"LAW": 5, **BRIDGING},
    "bridging, Benzeggagh-Kenane": {"LAW": 5, "ETA": 2.284, "SIGMABRIDGE": 3.0, "GIBRIDGE": 0.15},
    # in mode I the tip outlasts the bridging
    "bridging, power law": {"LAW": 5, "POWER": 1.7, **BRIDGING, "SIGMABRIDGE": 12.0},
    "plateau": {"LAW": 6, "SEPARATION1": 0.3, "TRACTION1": 1.0},
    "table": {"LAW": 6, "ETA": 1.45, **TABLE},
}
STIFFNESSES = {"compliant": {}, "alike": {"ALPHAN": 1e6, "ALPHAT": 1e6}, "unlike": {"ALPHAN": 1e8, "ALPHAT": 1e5}}
# separations from opening to sliding, either way
ANGLES = np.radians([0.0, 1e-3, 10.0, 35.0, 60.0, 85.0, 89.999, 90.0, -20.0, -90.0])


@pytest.fixture(params=LAWS, name="values")
def law_values(request, law):
    """Properties of one law."""
    return {**law, **LAWS[request.param]}


def edges_of(reference, values, ray):
    """Separations beyond the onset, in units of the decay of the exponential law, between which a curve is smooth."""
    if values["LAW"] == 3:
        return np.linspace(0, 40, 21)
    if values["LAW"] == 6:
        x, t = reference.polygon(values)
        return np.append(x / np.trapezoid(t, x), 1.1 / np.trapezoid(t, x))
    if values["LAW"] == 5:
        start, energy = reference.onset(values, ray), reference.toughness(values, ray)
        elastic = 0.5 * (values["ALPHAN"] * max(ray[1], 0.0) ** 2 + values["ALPHAT"] * ray[0] ** 2) * start**2
        share = reference.mode_mix(values, ray)
        r, m = (np.interp(share, [0, 1], pair) for pair in reference.bridging_shares(values))
        # a line ends where its area, half of height times separation, is its part
        ends = [(energy * q - elastic) / (energy - elastic) for q in ((1 - m) / (1 - r), m / r)]
        return 2.0 * np.array([0.0, *sorted(ends), 1.1 * max(ends)])
    return np.array([0.0, 2.0, 3.0])


def traction_of(item, g):
    """Traction (tau, n) of a flat element opened by g all along, without keeping the increment."""
    u = np.zeros((4, 2))
    u[2:] = g
    rhs, _ = item.evaluate(u)
    return -rhs.reshape(4, 2)[2:].sum(axis=0) / 2.0  # THICKNESS


def test_damage_is_that_of_the_formulas(element, reference, values):
    item = element(2, FLAT, **values)
    rng = np.random.default_rng(3)
    for angle in ANGLES:
        ray = np.array([np.sin(angle), np.cos(angle)])
        start = reference.onset(values, ray)
        # to ten times the separation at failure
        last = 10 * reference.toughness(values, ray) / values["SIGMAMAX"]
        for size in np.concatenate([[0.0, 0.999 * start, 1.001 * start], rng.uniform(0, 1, 10) ** 3 * last]):
            g = size * ray
            d = reference.damage_of_law(values, g)
            expected = reference.standard_traction(values, g, d)
            np.testing.assert_allclose(traction_of(item, g), expected, atol=1e-11 * values["TAUMAX"])


@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_area_under_the_curve_is_the_fracture_energy(element, reference, values, stiffness):
    """By Gauss quadrature, one call a point; the pieces between onset, failure or decay are smooth."""
    values = values | STIFFNESSES[stiffness]
    item = element(2, FLAT, **values)
    points, weights = np.polynomial.legendre.leggauss(12)
    for angle in ANGLES:
        ray = np.array([np.sin(angle), np.cos(angle)])
        start, energy = reference.onset(values, ray), reference.toughness(values, ray)
        strength = traction_of(item, start * ray) @ ray
        decay = energy / strength - start / 2
        edges = start + decay * edges_of(reference, values, ray)
        area = 0.5 * start * strength
        for left, right in pairwise(edges):
            sizes = 0.5 * (left + right) + 0.5 * (right - left) * points
            area += (
                0.5
                * (right - left)
                * sum(w * traction_of(item, size * ray) @ ray for w, size in zip(weights, sizes, strict=True))
            )
        assert area == pytest.approx(energy, rel=1e-10)


def test_energies_at_failure_in_every_mode_mix(element, reference, values):
    """What the element says it has dissipated, in increments, in the shares of the mode mix."""
    for angle in np.radians([0.0, 30.0, 70.0, 90.0]):
        ray = np.array([np.sin(angle), np.cos(angle)])
        item = element(2, FLAT, **values)
        energy = reference.toughness(values, ray)
        far = {3: 15, 5: 30, 6: 4}.get(values["LAW"], 3)
        reach = far * energy / (traction_of(item, reference.onset(values, ray) * ray) @ ray)
        for fraction in np.linspace(0, 1, 21)[1:] ** 2:
            u = np.zeros((4, 2))
            u[2:] = fraction * reach * ray
            item.advance(u)
        shares = np.array([values["ALPHAT"], values["ALPHAN"]]) * ray**2
        dissipated = [item.state["DISSII"][0], item.state["DISSI"][0]]
        # the exponential law never quite fails: exp(-15) is left
        tolerance = 1e-5 if values["LAW"] == 3 else 1e-10
        np.testing.assert_allclose(dissipated, energy * shares / shares.sum(), rtol=tolerance, atol=1e-12)
        assert item.energy[3] == pytest.approx(2.0 * sum(dissipated), rel=1e-12)


def test_power_law_with_exponent_one_is_the_papers_law(element, interface):
    """Linear energy criterion (11): same forces and matrix to the last bit."""
    for state in ("softening", "mixed", "failed"):
        u = interface.displacements(4, *interface.states[state], seed=3)
        one, two, default = (
            element(2, interface.four, **options).evaluate(u) for options in ({}, {"LAW": 2, "POWER": 1.0}, {"LAW": 2})
        )
        for other in (two, default):
            np.testing.assert_array_equal(other[0], one[0])
            np.testing.assert_array_equal(other[1], one[1])


def test_the_papers_law_takes_no_exponents(element, interface):
    u = interface.displacements(4, *interface.states["softening"], seed=3)
    given = element(2, interface.four, ETA=2.0, POWER=3.0).evaluate(u)
    for one, other in zip(element(2, interface.four).evaluate(u), given, strict=True):
        np.testing.assert_array_equal(one, other)


def test_stiff_exponential_law_is_that_of_wells_and_sluys(element, law):
    """t = strength exp(-strength w/G_c) in the pure modes; the energy up to the onset goes with 1/stiffness."""
    item = element(2, FLAT, LAW=3, ALPHAN=1e8, ALPHAT=1e8)
    for w in (1e-4, 3e-3, 0.02, 0.1):
        normal = traction_of(item, np.array([0.0, w]))[1]
        assert normal == pytest.approx(30.0 * np.exp(-30.0 * w / law["GIC"]), rel=5e-4)
        shear = traction_of(item, np.array([-w, 0.0]))[0]
        assert shear == pytest.approx(-60.0 * np.exp(-60.0 * w / law["GIIC"]), rel=5e-4)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"LAW": 2, "ETA": 0.4}, r"U2 element 42: PROPS\(8\) ETA = 0.4.*: expected zero or at least 0.5"),
        ({"LAW": 3, "POWER": -1.0}, r"PROPS\(9\) POWER = -1.*: expected zero or at least 0.5"),
        ({"LAW": 2, "GIC": 0.02}, r"PROPS\(6\) GIC = 2.0.*E-02.*too brittle.*more than 2.25.*E-02"),
        ({"LAW": 3, "GIIC": 0.05}, r"PROPS\(7\) GIIC = 5.0.*E-02.*too brittle.*more than 6.0.*E-02"),
        (
            {"LAW": 2, "ETA": 5.0, "ALPHAN": 1750.0, "ALPHAT": 2000.0},
            r"PROPS\(2\) ALPHAN = 1750.*too soft.* mode II has 56 per cent of the energy; expected more than 2492.9",
        ),
    ],
)
def test_messages(element, values, message):
    item = element(2, FLAT, label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(8))


@pytest.mark.parametrize("exponents", [{"ETA": 5.0}, {"POWER": 0.6}, {"ETA": 0.5}])
def test_brittleness_in_mixed_mode_is_found_where_it_is(element, reference, law, exponents):
    """The least stiffness without a vertical fall in any mode mix, to 0.1 %, from a fine scan of the formulas."""
    values = {**law, "GIC": 0.3, "GIIC": 0.9, **exponents, "LAW": 2}
    rays = [np.array([np.sin(a), np.cos(a)]) for a in np.linspace(0, np.pi / 2, 4001)]

    def brittle(alpha):
        at = values | {"ALPHAN": alpha, "ALPHAT": 1.2 * alpha}
        at_onset = [0.5 * (alpha * r[1] ** 2 + 1.2 * alpha * r[0] ** 2) * reference.onset(at, r) ** 2 for r in rays]
        return min(reference.toughness(at, r) - e for r, e in zip(rays, at_onset, strict=True)) <= 0

    low, high = 500.0, 2e5
    while high > 1.0001 * low:
        middle = np.sqrt(low * high)
        low, high = (middle, high) if brittle(middle) else (low, middle)
    element(2, FLAT, **values | {"ALPHAN": 1.001 * high, "ALPHAT": 1.2 * 1.001 * high}).evaluate(np.zeros(8))
    item = element(2, FLAT, **values | {"ALPHAN": 0.999 * low, "ALPHAT": 1.2 * 0.999 * low})
    with pytest.raises(KernelError, match=r"too (soft|brittle)"):
        item.evaluate(np.zeros(8))
