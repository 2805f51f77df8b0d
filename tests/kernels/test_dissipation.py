# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Energy that damage dissipates in increments of any size: that of the law, and never negative."""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from space import nodes_of, opened

LAWS = {
    "linear criterion": {"LAW": 1},
    "Benzeggagh-Kenane": {"LAW": 2, "ETA": 2.284},
    "power law": {"LAW": 2, "POWER": 0.7},
    "exponential": {"LAW": 3, "ETA": 1.45},
    "PPR": {"LAW": 4, "SHAPEN": 2.5, "SHAPET": 4.0},
    "bridging": BRIDGING,
    "table": TABLE,
}
# one beta and one stiffness for all components: the separation of the law grows along a line with that of the element
CONSISTENT = {"CLOSURE": 1, "BETAN": 5e4, "BETAT": 5e4, "ALPHAN": 2e4, "ALPHAT": 2e4}
VARIANTS = {
    "U2": (2, {"ALPHAN": 2e4, "ALPHAT": 2e4}),
    "U4": (4, {}),
    "U4 consistent": (4, CONSISTENT),
    "U4 rigid": (4, CONSISTENT | {"ALPHAN": 0.0, "ALPHAT": 0.0}),
    "U7": (7, {"ALPHAN": 1e6, "ALPHAT": 1e6}),
    "U8 rigid": (8, CONSISTENT | {"ALPHAN": 0.0, "ALPHAT": 0.0}),
}
# with damage by the displacement jump
STRAIGHT = ("U2", "U4", "U7")
MODES = [0.0, 20.0, 55.0, 90.0]
COUNT = 1001


class Point:
    """An element, or copies of it, whose points all have one separation (tau, n), in space with shear at 30 degrees."""

    def __init__(self, element, interface, variant, copies=None, **values):
        self.jtype, given = VARIANTS[variant]
        if self.jtype in (7, 8):
            nodes, axes = nodes_of(self.jtype, "flat"), np.array([[np.cos(np.pi / 6), np.sin(np.pi / 6), 0], [0, 0, 1]])
            unit = np.array([opened(self.jtype, axis, 0) for axis in axes])
        else:
            nodes = interface.four if self.jtype == 2 else interface.eight
            unit = np.zeros((2, *nodes.shape))
            unit[:, len(nodes) // 2 :] = interface.axes[:, None]
        self.unit = unit.reshape(2, -1)
        self.shear = ("S", "T") if self.jtype in (7, 8) else ("T",)
        self.item = element(self.jtype, nodes, copies=copies, **given | values)

    def advance(self, gap, **options):
        """Go to a separation, or to one of each copy."""
        self.item.advance(np.asarray(gap) @ self.unit, **options)
        return self.item.state

    @property
    def dissipated(self):
        """(II, I) of the first point."""
        state = self.item.state
        return np.array([state["DISSII"].flat[0], state["DISSI"].flat[0]])

    def pair(self, letter):
        """|tau| and n of W or T at the first point of each copy."""
        values = self.item.state
        slid = np.linalg.norm([values[f"{letter}{i}"][:, 0] for i in self.shear], axis=0)
        return np.column_stack([slid, values[f"{letter}N"][:, 0]])


def turns(law, variant):
    """Whether the two separations of a law do not grow along a line with that of the element."""
    return law == "PPR" and variant not in STRAIGHT


@pytest.mark.sample(3)
@pytest.mark.parametrize("degrees", MODES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", [name for name in VARIANTS if name != "U4"])
def test_one_increment_dissipates_what_the_law_does(element, interface, variant, law, degrees):
    """Work of the tractions along a straight path less the stored energy t w/2, from none to half-way and to failure.

    The curves have kinks at onset and failure, where the trapezoidal rule on 1000 intervals is off by less than the
    strength times an interval. The traction of U4 with the paper's closure is not that of its law. In mixed mode the
    separations of the PPR law in the consistent elements do not grow on a straight line, which the increment takes: a
    twentieth of the energy.
    """
    values = LAWS[law]
    ray = np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
    for reach in (0.008, 0.07):
        many = Point(element, interface, variant, COUNT, **values)
        many.advance(np.linspace(0.0, reach, COUNT)[:, None] * ray)
        w, t = many.pair("W"), many.pair("T")
        work = (0.5 * (t[1:] + t[:-1]) * np.diff(w, axis=0)).sum(axis=0) - 0.5 * (t * w)[-1]
        once = Point(element, interface, variant, **values)
        once.advance(reach * ray)
        tolerance = 60.0 * reach / COUNT + (work.sum() / 20 if turns(law, variant) else 0.0)
        assert once.dissipated.sum() == pytest.approx(work.sum(), abs=tolerance)
        # the two energies of the PPR law are those of eight steps, their sum is exact
        if law != "PPR":
            np.testing.assert_allclose(once.dissipated, work, atol=tolerance)
        assert once.dissipated.sum() > 0.03


@pytest.mark.sample(3)
@pytest.mark.parametrize("degrees", MODES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_increments_add_up_whatever_their_size(element, interface, variant, law, degrees):
    """In one increment or in many, over onset and failure, after unloading, and from the other side."""
    ray = np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
    other = ray * [-1.0, 1.0]
    paths = [[0.07], [1e-4, 3e-3, 8e-3, 0.02, 0.07], [5e-3, 0.0, 1e-3, 0.012, 4e-3, 0.07]]
    found = []
    for path in paths:
        for turn in (False, True):
            point = Point(element, interface, variant, **LAWS[law])
            for k, size in enumerate(path):
                point.advance(size * (other if turn and k % 2 else ray))
            found.append(point.dissipated)
    if law == "PPR":
        # as above, in mixed mode
        total = np.sum(found, axis=1)
        np.testing.assert_allclose(total, total[0], rtol=1 / 20 if degrees % 90 and turns(law, variant) else 1e-9)
    else:
        np.testing.assert_allclose(found, np.tile(found[0], (len(found), 1)), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("law", ["linear criterion", "PPR"])
def test_shear_that_reverses_and_grows(element, interface, law, variant):
    """0.01, 0.015, -0.02, 0.025, -0.03, 0.034 mm: each increment grows beyond all before on the other side. Every
    increment dissipates, G_IIc in all once the point has failed, beyond 2 G_IIc/TAUMAX = 0.0334 mm (exponent 2)."""
    values = {"LAW": 1} if law == "linear criterion" else {"LAW": 4, "ALPHAN": 1e8, "ALPHAT": 1e8}
    if "rigid" in variant:
        values |= {"ALPHAN": 0.0, "ALPHAT": 0.0}
    point = Point(element, interface, variant, **values)
    before = 0.0
    for size in (0.01, 0.015, -0.02, 0.025, -0.03, 0.05):
        point.advance((size, 0.0))
        assert point.dissipated[0] > before
        before = point.dissipated[0]
    assert (point.item.state["DAMAGE"] == 1).all()
    assert point.dissipated == pytest.approx([1.002, 0.0], rel=1e-12, abs=1e-12)
    assert point.item.energy[3] > 0


@pytest.mark.sample(2)
@pytest.mark.parametrize(("viscosity", "pacing"), [(0.0, 0), (0.3, 0), (0.3, 1)])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_no_increment_dissipates_a_negative_energy(element, interface, variant, law, viscosity, pacing):
    """In no component, on a path that opens, closes, slides to both sides, in large increments."""
    rng = np.random.default_rng(11)
    friction = {"FRICTION": 0.4} if "consistent" in variant or "rigid" in variant else {}
    point = Point(element, interface, variant, 64, **LAWS[law], **friction, VISCOSITY=viscosity, PACING=pacing)
    before = dict.fromkeys(("DISSI", "DISSII", "DISSV", "DISSF"), 0.0)
    for _ in range(12):
        gaps = rng.normal(size=(64, 2)) * 10 ** rng.uniform(-4, -1.3, (64, 1))
        state = point.advance(gaps, dtime=0.1)
        for name, least in before.items():
            assert (state[name] >= least).all(), name
        before = {name: state[name].copy() for name in before}
    assert (before["DISSI"] > 0).any() and (before["DISSII"] > 0).any()
    assert (before["DISSV"] > 0).any() == (viscosity > 0)
    assert (before["DISSF"] > 0).any() == bool(friction)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", ["U2", "U4 consistent", "U7"])
def test_paths_that_turn_balance_as_increments_shrink(element, interface, variant, law):
    """Stored and dissipated energy against the work of the tractions by the trapezoidal rule: both have errors of
    second order, so that ten times as many increments leave a fiftieth at most, a hundredth but for kinks."""
    errors = []
    for count in (40, 400):
        point = Point(element, interface, variant, **LAWS[law])
        names = ("N", "S", "T") if point.jtype == 7 else ("N", "T")
        old, work = {f"{a}{b}": 0.0 for a in "WT" for b in names}, 0.0
        for s in np.linspace(0.0, 1.0, count + 1)[1:]:
            angle = 1.4 * s
            state = point.advance(0.02 * s * np.array([np.sin(angle), np.cos(angle)]))
            new = {name: state[name].flat[0] for name in old}
            work += sum(0.5 * (old[f"T{b}"] + new[f"T{b}"]) * (new[f"W{b}"] - old[f"W{b}"]) for b in names)
            old = new
        stored = 0.5 * sum(old[f"T{b}"] * old[f"W{b}"] for b in names)
        errors.append(abs(stored + point.dissipated.sum() - work) / work)
    assert errors[0] < 5e-2
    assert errors[1] < max(errors[0] / 20, 1e-4)


def parabola(shear, opening, count):
    """Separations that slide in proportion to time and open with its square."""
    s = np.linspace(0.0, 1.0, count + 1)[1:, None]
    return s * [shear, 0.0] + s**2 * [0.0, opening]


@pytest.mark.parametrize("law", [name for name in LAWS if name != "PPR"])
@pytest.mark.parametrize(
    ("variant", "stiffness"),
    [("U2", 2e4), ("U4 consistent", 1e5 / 7.0), ("U4 rigid", 5e4), ("U8 rigid", 5e4)],
)
def test_few_increments_from_sliding_to_opening(element, interface, variant, stiffness, law):
    """As in front of a crack, whose points slide at onset and open at failure: nothing tells an increment its path.

    Its guess is wrong by less than a tenth of the energy in two increments, and by half of that at most in four.
    """
    found = {}
    for count in (2, 4, 400):
        point = Point(element, interface, variant, **LAWS[law])
        start = np.array([0.9 * 60.0 / stiffness, 0.0])
        point.advance(start)
        assert point.item.state["DAMAGE"].max() == 0.0
        for gap in parabola(0.02, 0.05, count):
            point.advance(start + gap)
        assert point.item.state["DAMAGE"].min() > 0.9
        found[count] = point.dissipated
    two, four = (np.abs(found[count] - found[400]).max() / found[400].sum() for count in (2, 4))
    assert two < 0.1
    assert four < 0.5 * two


def test_viscosity_dissipates_the_fracture_energy_and_more(element, interface, law):
    """With time to spare the share of the overstress vanishes; that of damage is G_Ic but for the trapezoidal rule at
    onset and failure, 30 MPa times half an increment of 2.5e-5 mm each."""
    excess = []
    for time in (1e3, 1e1, 1e-1):
        point = Point(element, interface, "U2", **LAWS["linear criterion"], VISCOSITY=0.1)
        for gap in np.linspace(0.0, 0.05, 2001)[1:]:
            point.advance((0.0, gap), dtime=time / 2000)
        for _ in range(60):
            point.advance((0.0, 0.05), dtime=0.1)
        assert point.dissipated[1] == pytest.approx(law["GIC"], abs=2 * 30 * 1.25e-5)
        excess.append(point.item.state["DISSV"][0])
    assert 0 <= excess[0] < excess[1] < excess[2]


def fracture_energies(law, degrees, ratio):
    """Return (II, I) dissipated at failure along directions, by definition of each criterion; ratio: ALPHAT/ALPHAN."""
    slid, opened = ratio * np.sin(np.radians(degrees)) ** 2, np.cos(np.radians(degrees)) ** 2
    share = slid / (slid + opened)
    mix = np.column_stack([share, 1.0 - share])
    toughness = np.array([1.002, 0.26])
    if "ETA" in LAWS[law]:
        total = toughness[1] + (toughness[0] - toughness[1]) * share ** LAWS[law]["ETA"]
    else:
        power = LAWS[law].get("POWER", 1.0)
        total = ((mix / toughness) ** power).sum(axis=1) ** (-1.0 / power)
    return mix * total[:, None]


ANGLES = np.random.default_rng(5).uniform(0.0, 90.0, 10)


@pytest.mark.sample(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", ["U2", "U4", "U4 consistent", "U4 rigid", "U8 rigid"])
def test_failure_dissipates_the_toughness_of_the_mode_mix(element, interface, law, variant):
    """In 1, 2, 7 and 1000 increments, at ten mode mixes, to rounding.

    Rounding: a damage near 1 has the remaining stiffness with an absolute error of 1e-16, of which 1000 increments add
    up; the exponential law is followed until its traction has fallen by exp(-60). The PPR law has no closed form. Its
    sum is as exact while there is a potential, and beyond to 1e-9 by quadrature.
    """
    if turns(law, variant):
        pytest.skip("no straight path of the separations")
    rays = np.column_stack([np.sin(np.radians(ANGLES)), np.cos(np.radians(ANGLES))])
    # the local solve knows K to the rounding of K + beta, which the long tail of the exponential law shows
    tail = 1e-11 if law == "exponential" and variant in ("U4 consistent", "U4 rigid", "U8 rigid") else 0.0
    sums = []
    for count in (1, 2, 7, 1000):
        point = Point(element, interface, variant, len(ANGLES), **LAWS[law])
        for reach in np.linspace(0.0, 1.2 if law == "exponential" else 0.2, count + 1)[1:]:
            point.advance(reach * rays)
        sums.append(np.column_stack([point.item.state[name][:, 0] for name in ("DISSII", "DISSI")]))
        np.testing.assert_allclose(point.item.state["SPENT"], 1.0, rtol=0, atol=tail or 1e-15)
    if law == "PPR":
        totals = np.sum(sums, axis=2)
        np.testing.assert_allclose(totals, np.tile(totals[-1], (4, 1)), rtol=1e-9)
    else:
        # the default of tests/kernels/conftest.py, in U4
        expected = fracture_energies(law, ANGLES, 1.5 if variant == "U4" else 1.0)
        np.testing.assert_allclose(sums, np.tile(expected, (4, 1, 1)), rtol=max(tail, 1e-12), atol=1e-14)


@pytest.mark.sample(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", ["U2", "U4", "U4 consistent", "U8 rigid"])
def test_spent_is_the_dissipated_share_in_every_mode_mix(element, interface, law, variant):
    """Along straight paths; it keeps its value while the point is unloaded, reversed or closed, and is 1 at failure."""
    if turns(law, variant):
        pytest.skip("no straight path of the separations")
    rays = np.column_stack([np.sin(np.radians(ANGLES)), np.cos(np.radians(ANGLES))])
    whole = Point(element, interface, variant, len(ANGLES), **LAWS[law])
    state = whole.advance(1.2 * rays)
    total = (state["DISSI"] + state["DISSII"])[:, 0]
    point = Point(element, interface, variant, len(ANGLES), **LAWS[law])
    before = np.zeros(len(ANGLES))
    for reach in (2e-4, 2e-3, 5e-3, 0.01, 0.02):
        state = point.advance(reach * rays)
        spent = state["SPENT"][:, 0]
        dissipated = (state["DISSI"] + state["DISSII"])[:, 0]
        np.testing.assert_allclose(spent, dissipated / total, rtol=1e-8 if law == "PPR" else 1e-11, atol=1e-14)
        assert (spent >= before).all()
        before = spent
        # and back on the path, whose continuation is straight
        for back in (-0.4 * reach * rays * [1.0, 0.0], -0.1 * reach * rays, 0.5 * reach * rays):
            np.testing.assert_array_equal(point.advance(back)["SPENT"][:, 0], spent)
    assert (before > 0.1).all() and (before < 1.0).any()


@pytest.mark.parametrize(("mode", "damage"), [(0, 0.8), (1, 0.5)])
def test_spent_is_one_half_at_half_of_the_energy(element, interface, mode, damage):
    """60/60 MPa, 0.3/1.2 N/mm, rigid up to the onset: half-way to failure half of the energy is left in either mode.
    DAMAGE is k/(K + k) with k = 60**2/0.6 = 6000 of mode I, and K = 1500 half-way in mode II."""
    values = {"SIGMAMAX": 60.0, "TAUMAX": 60.0, "GIC": 0.3, "GIIC": 1.2}
    half = (1.2, 0.3)[mode] / 60.0
    point = Point(element, interface, "U4 rigid", **values)
    state = point.advance((half + 30.0 / 5e4) * np.eye(2)[mode])
    np.testing.assert_allclose(state["SPENT"], 0.5, rtol=1e-12)
    np.testing.assert_allclose(state["DAMAGE"], damage, rtol=1e-12)


def switched(element, interface, first, **values):
    """Dissipation of a point that softens in one mode to DAMAGE 0.5, is unloaded, and fails in the other mode.

    values as properties, without stiffness; K is then k of mode I, from which the separation follows.
    """
    strength, energy = np.array([values["TAUMAX"], values["SIGMAMAX"]]), np.array([values["GIIC"], values["GIC"]])
    slopes = strength**2 / (2.0 * energy)
    separation = strength[first] / (slopes[1] + slopes[first])
    point = Point(element, interface, "U4 rigid", **values)
    point.advance((separation + slopes[1] * separation / 5e4) * np.eye(2)[first])
    np.testing.assert_allclose(point.item.state["DAMAGE"], 0.5, rtol=1e-12)
    point.advance((0.0, 0.0))
    for reach in (0.005, 0.02, 0.2):
        point.advance(reach * np.eye(2)[1 - first])
    assert (point.item.state["SPENT"] == 1).all()
    return point.dissipated


@pytest.mark.parametrize(("first", "total"), [(1, 0.2052), (0, 0.8948)])
def test_a_switch_of_the_mode_half_way(element, interface, first, total):
    """15/90 MPa, 0.3/0.8 N/mm: less than G_Ic in the order I, II, and more than G_IIc in the order II, I. A mode that
    has softened to the secant K has dissipated G k/(K + k) with its own k = strength**2/(2 G), 375 and 5062.5."""
    values = {"SIGMAMAX": 15.0, "TAUMAX": 90.0, "GIC": 0.3, "GIIC": 0.8}
    slopes, energy = np.array([5062.5, 375.0]), np.array([0.8, 0.3])
    shares = slopes / (375.0 + slopes)
    expected = np.where(np.arange(2) == first, shares, 1.0 - shares) * energy
    found = switched(element, interface, first, **values)
    np.testing.assert_allclose(found, expected, rtol=1e-11)
    assert found.sum() == pytest.approx(total, abs=5e-5)


@pytest.mark.parametrize("first", [0, 1])
def test_a_switch_of_the_mode_with_equal_strength_over_root_of_toughness(element, interface, first):
    """Turon, Camanho, Costa, Renart, Composite Structures 92 (2010) 1857: TAUMAX = SIGMAMAX sqrt(GIIC/GIC), for equal
    stiffnesses. Half of either toughness is dissipated, whatever the order."""
    values = {"SIGMAMAX": 15.0, "TAUMAX": 15.0 * np.sqrt(0.8 / 0.3), "GIC": 0.3, "GIIC": 0.8}
    np.testing.assert_allclose(switched(element, interface, first, **values), [0.4, 0.15], rtol=1e-11)


@pytest.mark.parametrize("variant", ["U2", "U4 consistent", "U4 rigid", "U7"])
def test_any_path_fails_at_a_criterion_of_one_with_such_strengths(element, interface, variant):
    """DISSI/GIC + DISSII/GIIC is then a function of the stiffness that is left, for LAW 1: SPENT, and 1 at failure."""
    values = {"TAUMAX": 30.0 * np.sqrt(1.002 / 0.26)}
    point = Point(element, interface, variant, 16, **values)
    rng = np.random.default_rng(8)
    for size in np.geomspace(1e-4, 0.2, 30):
        state = point.advance(size * rng.uniform([-1.0, 0.0], 1.0, (16, 2)))
        criterion = state["DISSI"] / 0.26 + state["DISSII"] / 1.002
        np.testing.assert_allclose(criterion, state["SPENT"], rtol=1e-10, atol=1e-13)
    assert (state["SPENT"] > 0.99).any()


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_spent_never_falls_and_is_one_at_failure_alone(element, interface, variant, law):
    """On random paths that turn: from 0 to 1 with the damage, and 1 where that is 1."""
    rng = np.random.default_rng(3)
    point = Point(element, interface, variant, 64, **LAWS[law])
    before = np.zeros(64)
    for _ in range(12):
        state = point.advance(rng.normal(size=(64, 2)) * 10 ** rng.uniform(-4, -1.3, (64, 1)))
        spent, damage = state["SPENT"][:, 0], state["DAMAGE"][:, 0]
        assert (spent >= before).all() and (spent <= 1).all()
        assert (spent[damage == 1] == 1).all()
        assert ((spent > 0) == (damage > 0)).all()
        if law != "exponential":
            assert (spent[damage < 1] < 1).all()
        before = spent
    assert (before == 1).any() or law == "exponential"
