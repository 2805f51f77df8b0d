# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The PPR law (LAW 4): the paper's potential, energies, history, and the closure in two unknowns.

Park, Paulino, Roesler, J. of the Mechanics and Physics of Solids 57 (2009) 891-908: intrinsic and extrinsic model.
"""

from itertools import pairwise

import numpy as np
import pytest

from uel.errors import KernelError

FLAT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
EDGE = np.array([[0.3, 0.1], [-0.1, 0.3]]) / np.sqrt(0.1)  # tangent of the edge and its normal
BETA = {"BETAN": 4.0e4, "BETAT": 6.0e4}


class Potential:
    """The paper's potential with its symbols: phi, shape, slope indicator (None: the extrinsic model); (tau, n)."""

    def __init__(self, phi, strength, shape, indicator=None):
        self.phi, self.shape = np.array(phi), np.array(shape)
        phi_t, phi_n = phi
        if indicator is None:
            self.rise = None
            self.final = self.shape * self.phi / strength
            constants = np.ones(2)
        else:
            lam, a = np.array(indicator), self.shape
            self.rise = m = a * (a - 1) * lam**2 / (1 - a * lam**2)
            q = a * lam * (1 - lam) ** (a - 1) * (a / m + 1) * (a / m * lam + 1) ** (m - 1)
            self.final = q * self.phi / strength
            constants = (a / m) ** m
        # energy constants
        if phi_t > phi_n:
            signs = np.array([-phi_t, 1.0])
        elif phi_t < phi_n:
            signs = np.array([1.0, -phi_n])
        else:
            signs = np.array([1.0, -phi_n])
        self.gamma = signs * constants
        self.excess = np.maximum(0.0, self.phi - self.phi[::-1])

    def factor(self, i, w):
        x = w / self.final[i]
        if self.rise is None:
            return self.gamma[i] * (1 - x) ** self.shape[i] + self.excess[i]
        a, m = self.shape[i], self.rise[i]
        return self.gamma[i] * (1 - x) ** a * (m / a + x) ** m + self.excess[i]

    def slope(self, i, w):
        x, a = w / self.final[i], self.shape[i]
        if self.rise is None:
            return -self.gamma[i] * a * (1 - x) ** (a - 1) / self.final[i]
        m = self.rise[i]
        powers = m * (1 - x) ** a * (m / a + x) ** (m - 1) - a * (1 - x) ** (a - 1) * (m / a + x) ** m
        return self.gamma[i] / self.final[i] * powers

    def energy(self, w):
        return self.phi.min() + self.factor(0, abs(w[0])) * self.factor(1, w[1])

    def traction(self, w):
        """(tau, n); zero from the final separations and their conjugates on."""
        found = np.zeros(2)
        for i in (0, 1):
            j, size = 1 - i, np.abs(w)
            if (size >= self.final).any():
                continue
            other = self.factor(j, size[j])
            # the conjugate final separation of j is where its factor vanishes
            if other * self.factor(j, 0.0) > 0:
                found[i] = self.slope(i, size[i]) * other
        return found * np.sign([w[0] or 1.0, 1.0])

    def stiffness(self):
        """Slopes of the curves at the origin: G_i times the second derivative of (1 - x)^a (1 + a x/m)^m."""
        a, m = self.shape, self.rise
        return self.phi * a * (a + m) / m / self.final**2


CASES = {
    # phi, strength, shape, slope indicator; (tau, n)
    "tougher in shear": ((1.002, 0.26), (60.0, 30.0), (2.0, 2.0), (0.02, 0.01)),
    "tougher in opening": ((0.2, 0.5), (30.0, 40.0), (3.0, 5.0), (0.1, 0.2)),
    "as tough": ((0.3, 0.3), (20.0, 30.0), (2.5, 4.0), (0.05, 0.3)),
    "plateau": ((0.4, 0.3), (25.0, 30.0), (1.6, 1.3), (0.05, 0.02)),
    "stiff": ((1.002, 0.26), (60.0, 30.0), (3.0, 2.2), (1e-4, 3e-5)),
}
EXTRINSIC = [name for name in CASES if name != "plateau"]


def properties(potential, strength):
    """Properties of LAW 4 for a potential."""
    alpha = potential.stiffness() if potential.rise is not None else np.zeros(2)
    values = {"LAW": 4, "ALPHAN": alpha[1], "ALPHAT": alpha[0], "SIGMAMAX": strength[1], "TAUMAX": strength[0]}
    values |= {"GIC": potential.phi[1], "GIIC": potential.phi[0]}
    return values | {"SHAPEN": potential.shape[1], "SHAPET": potential.shape[0]}


@pytest.fixture(params=CASES, name="case")
def case_fixture(request):
    """Potential and properties of an intrinsic model."""
    phi, strength, shape, indicator = CASES[request.param]
    potential = Potential(phi, strength, shape, indicator)
    return potential, properties(potential, strength)


@pytest.fixture(params=EXTRINSIC, name="extrinsic")
def extrinsic_fixture(request):
    """Potential and properties of an extrinsic model."""
    phi, strength, shape, _ = CASES[request.param]
    potential = Potential(phi, strength, shape)
    return potential, {**properties(potential, strength), "CLOSURE": 1, **BETA}


def opened(g):
    u = np.zeros((4, 2))
    u[2:] = g
    return u


def apart(*gap):
    """Displacements that part the quads of U4 by a gap (tau, n) without straining them: p = beta g."""
    u = np.zeros((8, 2))
    u[4:] = np.asarray(gap) @ EDGE
    return u


def traction_of(item, g):
    """Traction (tau, n) of a flat element opened by g all along, without keeping the increment."""
    return -item.evaluate(opened(g))[0].reshape(4, 2)[2:].sum(axis=0) / 2.0  # THICKNESS


def separations(potential, count, seed):
    """Up to beyond failure, many near the peaks."""
    rng = np.random.default_rng(seed)
    return 1.1 * potential.final * rng.uniform(0, 1, (count, 2)) ** rng.choice([1, 6], (count, 1)) * [1, 1]


def test_traction_is_the_gradient_of_the_papers_potential(element, case):
    potential, values = case
    item = element(2, FLAT, **values)
    for g in separations(potential, 60, 1):
        for sign in (1, -1):
            expected = potential.traction(g * [sign, 1])
            # (1 - d) alpha g, d rounded
            rounding = 1e-9 + 1e-15 * max(values["ALPHAN"], values["ALPHAT"]) * g.max()
            np.testing.assert_allclose(traction_of(item, g * [sign, 1]), expected, rtol=1e-9, atol=rounding)


def test_gradient_of_the_reference(case):
    """The tractions above are derivatives of the potential above."""
    potential, _ = case
    for g in potential.final * np.array([[0.1, 0.2], [0.02, 0.3], [0.3, 0.05]]):
        for i in (0, 1):
            step = 1e-6 * g[i] * np.eye(2)[i]
            difference = (potential.energy(g + step) - potential.energy(g - step)) / (2e-6 * g[i])
            assert potential.slope(i, g[i]) * potential.factor(1 - i, g[1 - i]) == pytest.approx(difference, rel=1e-6)


def test_peaks_are_the_strengths(element, case):
    potential, values = case
    item = element(2, FLAT, **values)
    lam = np.sqrt(potential.rise / (potential.shape * (potential.shape + potential.rise - 1)))
    for i, strength in enumerate((values["TAUMAX"], values["SIGMAMAX"])):
        peak = potential.final * lam * np.eye(2)[i]
        assert traction_of(item, peak)[i] == pytest.approx(strength, rel=1e-12)
        for factor in (0.98, 1.02):
            assert traction_of(item, factor * peak)[i] < strength


def work(potential, item, end, start=(0.0, 0.0)):
    """Of the traction along a straight path, by Gauss quadrature in pieces that are small at both of its ends."""
    points, weights = np.polynomial.legendre.leggauss(14)
    start, end = np.array(start), np.array(end)
    lam = np.sqrt(potential.rise / (potential.shape * (potential.shape + potential.rise - 1))).min()
    first, last = np.geomspace(1e-2 * lam**2, 0.5, 40), np.geomspace(1e-4, 0.5, 12)
    edges = np.concatenate([[0.0], first, 1.0 - last[-2::-1], [1.0]])
    total = 0.0
    for left, right in pairwise(edges):
        for point, weight in zip(points, weights, strict=True):
            s = 0.5 * (left + right) + 0.5 * (right - left) * point
            total += 0.5 * (right - left) * weight * traction_of(item, start + s * (end - start)) @ (end - start)
    return total


def test_area_in_the_pure_modes_is_the_fracture_energy(element, case):
    potential, values = case
    item = element(2, FLAT, **values)
    for i, (name, alpha) in enumerate((("GIIC", "ALPHAT"), ("GIC", "ALPHAN"))):
        area = work(potential, item, potential.final * np.eye(2)[i])
        # a plateau falls like a root at its end, which Gauss' rule resolves to 1e-6; (1 - d) alpha g, d rounded
        rounding = 1e-15 * values[alpha] * potential.final[i] ** 2
        assert area == pytest.approx(values[name], rel=1e-6 if potential.shape[i] < 2 else 1e-9, abs=rounding)


def test_work_in_mixed_mode_is_the_potential(element, case):
    """Along straight paths up to where the first factor of the potential vanishes; one call a point, no history."""
    potential, values = case
    item = element(2, FLAT, **values)
    for angle in np.radians([10.0, 35.0, 60.0, 85.0]):
        ray = potential.final * [np.sin(angle), np.cos(angle)]
        sizes = np.linspace(0, 1, 400)[1:-1]
        rounding = 1e-15 * max(values["ALPHAN"], values["ALPHAT"]) * (ray @ ray)
        inside = [s for s in sizes if all(potential.traction(s * ray) > 0)]
        for end in (0.3 * inside[-1], inside[-1]):
            expected = potential.energy(end * ray)
            assert work(potential, item, end * ray) == pytest.approx(expected, rel=1e-8, abs=rounding)


def test_energies_in_the_element(element, case):
    """Pure modes dissipate their fracture energies, and along any path nothing is gained."""
    potential, values = case
    for i, name in enumerate(("II", "I")):
        item = element(2, FLAT, **values)
        for fraction in np.linspace(0, 1, 21)[1:] ** 3:
            item.advance(opened(1.01 * fraction * potential.final * np.eye(2)[i]))
        np.testing.assert_allclose(item.state[f"DISS{name}"], values[f"G{name}C"], rtol=1e-11)
        np.testing.assert_array_equal(item.state["DAMAGE"], 1)
        assert item.energy[1] == 0


def test_unloading_is_secant_and_heals_nothing(element, case):
    """A component keeps the secant at the largest separations of both, whatever the other does meanwhile."""
    potential, values = case
    item = element(2, FLAT, **values)
    largest = potential.final * [0.15, 0.1]
    item.advance(opened(largest))
    secant = traction_of(item, largest) / largest
    damage, lost = item.state["DAMAGE"], item.energy[3]
    for fraction in ((0.5, 0.5), (0.1, 0.9), (-0.7, 0.3), (0.9, 0.0), (-1.0, 1.0)):
        g = fraction * largest
        np.testing.assert_allclose(traction_of(item, g), secant * g, rtol=1e-12, atol=1e-12)
        item.advance(opened(g))
        np.testing.assert_array_equal(item.state["DAMAGE"], damage)
        assert item.energy[3] == lost
    for other in (largest * [1.0, 1.2], largest * [-1.3, 1.0]):
        item.advance(opened(other))
        np.testing.assert_allclose(item.state["MAXN"], max(largest[1], other[1]), rtol=1e-15)
        largest = np.maximum(largest, abs(other))
    np.testing.assert_allclose(traction_of(item, largest), potential.traction(largest), rtol=1e-9, atol=1e-10)


def test_closed_point(element, case):
    """The undamaged normal stiffness; the shear keeps what the opening has left of it."""
    potential, values = case
    item = element(2, FLAT, **values)
    item.advance(opened(potential.final * [0.0, 0.2]))
    g = potential.final * [0.05, -0.1]
    expected = potential.traction(potential.final * [0.05, 0.2])[0]
    np.testing.assert_allclose(traction_of(item, g), [expected, values["ALPHAN"] * g[1]], rtol=1e-9)


@pytest.mark.parametrize("path", [((1.0, 0.4),), ((0.2, 1.0),), ((1.0, 0.0), (1.0, 1.0)), ((0.05, 1.0), (-1.0, 1.0))])
def test_extrinsic_law_is_recovered(element, extrinsic, path):
    """T + beta w = p, and T is the paper's traction at w where w has begun, at most that where it has not."""
    potential, values = extrinsic
    item = element(4, interface_of(element), **values)
    beta, at, begun = np.array([values["BETAT"], values["BETAN"]]), np.zeros(2), 0
    for corner in path:
        target = 1.1 * np.array(corner) * (potential.final + [values["TAUMAX"], values["SIGMAMAX"]] / beta)
        for fraction in np.linspace(0, 1, 81)[1:]:
            gap = at + fraction * (target - at)
            item.advance(apart(*gap))
            w = np.array([item.state["WT"][0], item.state["WN"][0]])
            found = np.array([item.state["TT"][0], item.state["TN"][0]])
            np.testing.assert_allclose(found + beta * w, beta * gap, rtol=1e-9, atol=1e-10)
            most = potential.traction(w) * np.sign([gap[0] or 1, 1])
            largest = np.array([item.state["MAXT"][0], item.state["MAXN"][0]])
            if (abs(w) < largest * (1 - 1e-12)).any():
                # the other one keeps its history
                assert (abs(found) <= abs(potential.traction(w)) + 1e-9).all()
                continue
            grown = w != 0
            begun += grown.sum()
            np.testing.assert_allclose(abs(found[grown]), abs(most[grown]), rtol=1e-8, atol=1e-8)
            assert (abs(found[~grown]) <= abs(most[~grown]) + 1e-9).all()
        at = target
    assert begun > 20
    np.testing.assert_array_equal(item.state["DAMAGE"], 1)


def interface_of(element):
    """The eight nodes of the battery's interface."""
    edge = np.array([[0.1, 0.2], [1.0, 0.5]])
    return np.array([[0.2, -0.7], [1.2, -0.4], edge[1], edge[0], edge[0], edge[1], [0.9, 1.4], [-0.1, 1.2]])


def test_infinite_stiffness_is_the_limit(element, extrinsic):
    """The potentials differ by the order of the slope indicator, that is of sqrt(strength^2/(G alpha))."""
    potential, values = extrinsic
    path = [(0.1, 0.1), (0.4, 0.5), (0.6, -0.2), (0.5, 0.6), (0.1, 0.1), (-0.7, 0.2)]
    for alpha in (1e8, 1e12):
        atol = 5 * np.sqrt(max(values["SIGMAMAX"] ** 2 / values["GIC"], values["TAUMAX"] ** 2 / values["GIIC"]) / alpha)
        stiff = element(4, interface_of(element), **{**values, "ALPHAN": alpha, "ALPHAT": alpha})
        limit = element(4, interface_of(element), **values)
        for step in path:
            forces, expected = (item.advance(apart(*(potential.final * step)))[0] for item in (stiff, limit))
            np.testing.assert_allclose(forces, expected, atol=atol * (abs(expected).max() + 1.0))
            np.testing.assert_allclose(stiff.state["DAMAGE"], limit.state["DAMAGE"], atol=atol)


@pytest.mark.parametrize("alpha", [1.0e5, 1.0e12, 0.0])
@pytest.mark.parametrize("ratio", [1.0, 0.2, 7.0])
def test_one_solution_above_the_demanded_beta(element, alpha, ratio):
    """In one increment or in many the same, in every mode mix, with a beta just as large as demanded."""
    values = {"LAW": 4, "CLOSURE": 1, "ALPHAN": alpha, "ALPHAT": alpha, "SHAPEN": 2.0, "SHAPET": 3.0}
    low, high = 1.0, 1e9
    while high / low > 1.01:
        beta = np.sqrt(low * high)
        try:
            element(4, interface_of(element), **values, BETAN=beta, BETAT=ratio * beta).evaluate(np.zeros(16))
        except KernelError:
            low = beta
        else:
            high = beta
    values |= {"BETAN": high, "BETAT": ratio * high}
    for degrees in np.linspace(0, 90, 5):
        direction = np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
        loading, damage = element(4, interface_of(element), **values), []
        for gap in np.linspace(0, 0.08, 41)[1:]:
            once = element(4, interface_of(element), **values)
            once.advance(apart(*(gap * direction)))
            loading.advance(apart(*(gap * direction)))
            np.testing.assert_allclose(once.state["TT"], loading.state["TT"], rtol=1e-8, atol=1e-8)
            np.testing.assert_allclose(once.state["TN"], loading.state["TN"], rtol=1e-8, atol=1e-8)
            damage.append(loading.state["DAMAGE"][0])
        assert (np.diff(damage) >= 0).all() and damage[-1] == 1


def test_beta_must_exceed_slope_and_coupling(element):
    """(beta_n - s_n) (beta_tau - s_tau) > o^2, where t + beta w of the rigid law is no longer monotone at w = 0."""
    values = {"LAW": 4, "CLOSURE": 1, "ALPHAN": 0.0, "ALPHAT": 0.0}
    # steepest slopes strength^2/(2 G) for SHAPE 2, coupling sigma tau/min(G): exact where both are rigid
    slopes, coupling = np.array([60.0**2 / 2 / 1.002, 30.0**2 / 2 / 0.26]), 30.0 * 60.0 / 0.26
    for name, other, i in (("BETAN", "BETAT", 1), ("BETAT", "BETAN", 0)):
        least = slopes[i] + coupling**2 / (9e4 - slopes[1 - i])
        element(4, interface_of(element), **values, **{name: 1.0001 * least, other: 9e4}).evaluate(np.zeros(16))
        item = element(4, interface_of(element), label=42, **values, **{name: 0.9999 * least, other: 9e4})
        # either of the two is too small beside the other
        with pytest.raises(KernelError, match=r"U4 element 42: PROPS\(13\) BETAN: beta = .*, too small for the c"):
            item.evaluate(np.zeros(16))
    # the last bound, of beta_tau
    item = element(4, interface_of(element), **values, BETAN=9e4, BETAT=1e3)
    with pytest.raises(KernelError, match=rf"PROPS\(14\) BETAT: beta = 1000.*expected more than {str(least)[:4]}"):
        item.evaluate(np.zeros(16))


@pytest.mark.parametrize("alpha", np.geomspace(5.0, 1e6, 40))
def test_steepest_slope_at_the_end_is_not_rounding(element, reference, alpha):
    """With exponent 2 it is at the very end, where traction and rest of the separation both vanish."""
    mode = {"SIGMAMAX": 1.0, "GIC": 1.0, "TAUMAX": 1.0, "GIIC": 1.0, "ALPHAN": alpha, "ALPHAT": alpha}
    # a coupling of 1, alike in both directions: beta - slope > 1
    least = reference.ppr_slope(1.0, 1.0, alpha, 2.0) / 1.01 + 1.0
    values = {"LAW": 4, "CLOSURE": 1, **mode}
    above, below = (
        element(4, interface_of(element), **values, BETAN=f * least, BETAT=f * least) for f in (1.001, 0.98)
    )
    above.evaluate(np.zeros(16))
    with pytest.raises(KernelError, match="BETAN"):
        below.evaluate(np.zeros(16))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"SHAPEN": 1.0}, r"U4 element 42: PROPS\(10\) SHAPEN = 1.*: expected zero or more than 1"),
        ({"SHAPET": -2.0}, r"PROPS\(11\) SHAPET = -2.*: expected zero or more than 1"),
        (
            {"SHAPET": 1.9, "CLOSURE": 1},
            r"PROPS\(11\) SHAPET = 1.9.*with the consistent law, expected zero or at least 2; below 2, the law falls",
        ),
        # with SHAPE 2 the secant falls from the origin on if G alpha/strength^2 > 2 a/q^2 = 1.689, q at m = a
        ({"ALPHAN": 5800.0}, r"PROPS\(6\) GIC = 0.26.*, too small for its stiffness.*expected more than 0.26185"),
        ({"ALPHAT": 6000.0}, r"PROPS\(7\) GIIC = 1.002.*, too small for its stiffness.*expected more than 1.01"),
        ({"LAW": 7}, r"JPROPS\(1\) LAW = 7: expected 0 to 6"),
    ],
)
def test_messages(element, values, message):
    item = element(4, interface_of(element), label=42, **{"LAW": 4, **values})
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(16))
