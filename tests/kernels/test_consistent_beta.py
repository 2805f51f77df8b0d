# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""How large beta must be for the consistent stabilised law to have one solution, in U4."""

import re

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from space import nodes_of as space_nodes
from space import opened

from uel.errors import KernelError
from uel.usersub.layout import element_layouts


def quadratic(corners):
    """(16, 2) nodes of U6 from those of U4."""
    return np.vstack([np.vstack([q, (q + np.roll(q, -1, axis=0)) / 2]) for q in (corners[:4], corners[4:])])


def rigid(alpha):
    """Properties of the consistent law with a stiffness, 0 for an infinite one."""
    return {"ALPHAN": alpha, "ALPHAT": alpha, "CLOSURE": 1}


@pytest.mark.parametrize("alpha", [2.0e4, 1.0e8, 0.0])
@pytest.mark.parametrize("mode", ["N", "T"])
def test_beta_must_exceed_the_softening_slope(element, interface, reference, law, alpha, mode):
    """Just above the slope of the steeper mode it goes, just below it is refused; sharp for equal betas."""
    slopes = reference.softening_slopes({**law, **rigid(alpha)})
    steepest = slopes.max()
    u = interface.displacements(8, *interface.states["softening"], seed=1)
    above = element(4, interface.eight, **rigid(alpha), BETAN=1.0001 * steepest, BETAT=1.0001 * steepest)
    assert np.isfinite(above.evaluate(u)[1]).all()
    # with different betas the smaller one must exceed the slope by 2 - b_min/b_max
    other = {"N": "T", "T": "N"}[mode]
    given = {f"BETA{mode}": 1.4999 * steepest, f"BETA{other}": 3.0 * steepest}
    position = {"N": 13, "T": 14}[mode]
    below = element(4, interface.eight, label=42, **rigid(alpha), **given)
    message = (
        rf"U4 element 42: PROPS\({position}\) BETA{mode}: beta = {str(1.4999 * steepest)[:3]}.*, too small for the "
        rf"consistent law.*expected more than {str(1.5 * steepest)[:3]}"
    )
    with pytest.raises(KernelError, match=message):
        below.evaluate(u)
    given[f"BETA{mode}"] = 1.51 * steepest
    element(4, interface.eight, **rigid(alpha), **given).evaluate(u)


def raised(slopes):
    """Beta that takes the place of an estimate below the slopes: twice the steepest, (tau, n)."""
    return np.full(2, 2.0 * slopes.max())


BRITTLE = {"SIGMAMAX": 30.0, "GIC": 1e-4, "GIIC": 1.0}
"""A law that fails within 7e-6 mm: its slope of 4.5e6 N/mm^3 is above the estimates of beta, 1e5 here."""


@pytest.mark.parametrize("estimate", [0.0, -1.0, -2.0])
def test_an_estimate_of_beta_is_raised_to_twice_the_softening_slope(
    element, interface, reference, library, law, estimate
):
    """And the element says so, once in a job; it has the tractions of one with that beta in the deck."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    library.messages()
    expected = raised(reference.softening_slopes({**law, **rigid(0.0), **BRITTLE}))
    values = {**rigid(0.0), **BRITTLE, "BETAN": estimate, "BETAT": estimate, "GAMMABOT": 0.5}
    u = interface.displacements(8, *interface.states["elastic"], seed=1)
    items = [element(4, interface.eight, label=label, **values) for label in (42, 43)]
    found = [item.advance(u) for item in items]
    (message,) = library.messages()
    assert re.search(
        r"U4 element 42: PROPS\(13\) BETAN: the estimate of beta is .*, too small for the softening slope of the law; "
        rf"raised to {expected[1] / 1e6:.3f}.*E\+06.*Told once in a job",
        message.text,
    )
    assert message.kind == "warning"
    given = element(4, interface.eight, **values | {"BETAN": expected[1], "BETAT": expected[0]})
    for one in found:
        for a, b in zip(one, given.advance(u), strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-12 * abs(b).max())
    # SVARS keep it, and the next increment does not ask again
    layout = element_layouts()[4]
    first = layout.points * len(layout.variables)
    assert items[0].block.state(0).svars[0, first : first + 2].tolist() == pytest.approx(
        expected[::-1].tolist(), rel=1e-12
    )
    items[0].advance(1.1 * u)
    assert not any("beta" in message.text for message in library.messages())
    # another job says it again
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    element(4, interface.eight, **values).evaluate(u)
    assert len(library.messages()) == 1


@pytest.mark.parametrize(("given", "other"), [("N", "T"), ("T", "N")])
@pytest.mark.parametrize("ratio", [1.0, 0.4])
@pytest.mark.parametrize(("times", "expected"), [(1.05, 1.05), (1.6, 1.6), (3.0, 2.0)])
def test_an_estimate_beside_a_beta_of_the_deck(
    element, interface, reference, law, given, other, ratio, times, expected
):
    """Raised to the b = beta/ratio of the deck where that exceeds the slope, at most to twice the slope.

    With one b for both components b > k is the condition (fortran/laws.md); a larger b beside it would demand more.
    """
    stiffness = {"ALPHAN": 1e8, "ALPHAT": ratio * 1e8, "CLOSURE": 1}
    ratios = {"N": 1.0, "T": ratio}
    slope = (reference.softening_slopes({**law, **stiffness, **BRITTLE}) / [ratio, 1.0]).max()
    values = {**stiffness, **BRITTLE, "GAMMABOT": 0.5, f"BETA{given}": times * slope * ratios[given]}
    u = interface.displacements(8, *interface.states["softening"], seed=1)
    found = element(4, interface.eight, **values, **{f"BETA{other}": 0.0}).advance(u)
    wanted = element(4, interface.eight, **values, **{f"BETA{other}": expected * slope * ratios[other]}).advance(u)
    for a, b in zip(found, wanted, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-12 * abs(b).max())


@pytest.mark.parametrize(("given", "other"), [("N", "T"), ("T", "N")])
def test_a_beta_of_the_deck_below_the_slope_is_refused(element, interface, reference, law, given, other):
    """It, and not the estimate beside it, is named."""
    slope = reference.softening_slopes({**law, **rigid(0.0), **BRITTLE}).max()
    item = element(4, interface.eight, label=42, **rigid(0.0), **BRITTLE, **{f"BETA{given}": 0.95 * slope})
    with pytest.raises(KernelError, match=rf"U4 element 42: PROPS\(\d+\) BETA{given}: beta = .*, too small for the"):
        item.evaluate(np.zeros(16))


@pytest.mark.parametrize("kind", [2, 3, 4, 5, 6])
@pytest.mark.parametrize("jtype", [4, 6, 8, 12])
def test_raised_beta_suits_every_law(element, interface, library, jtype, kind):
    """With coarse meshes, and stiffnesses that differ: the element goes on to failure."""
    scale = 1e3  # size of the solids
    nodes = {4: interface.eight, 6: quadratic(interface.eight)}.get(jtype)
    nodes = space_nodes(jtype, "flat") if nodes is None else nodes
    values = {"LAW": kind, "ALPHAN": 1e7, "ALPHAT": 1e6, "CLOSURE": 1, "BETAN": 0.0, "BETAT": 0.0}
    values |= {"SHAPEN": 3.0} if kind == 4 else {"ETA": 2.0, **{5: BRIDGING, 6: TABLE}.get(kind, {})}
    library.messages()
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    item = element(jtype, scale * nodes, **values)
    if jtype in (8, 12):
        unit = opened(jtype, np.array([0.5, 0.0, 1.0]), 0).ravel()
    else:
        unit = np.zeros(nodes.shape)
        unit[len(nodes) // 2 :] = np.array([0.5, 1.0]) @ interface.axes
        unit = unit.ravel()
    for gap in (1e-3, 5e-3, 0.02, 1.0):
        assert np.isfinite(item.advance(gap * unit)[0]).all()
    assert (item.state["DAMAGE"] > 0.99).all()
    assert "too small for the softening slope" in library.messages()[0].text


@pytest.mark.parametrize("ratio", [1.0, 0.2, 7.0])
def test_one_solution_above_the_demanded_beta(element, interface, reference, law, ratio):
    """In every mode mix, the traction falls continuously to failure: no jump between two solutions.

    beta_tau/beta_n is `ratio`, both just as large as demanded.
    """
    slopes = reference.softening_slopes({**law, **rigid(0.0)})
    least = slopes.max() * (2 - min(ratio, 1 / ratio)) * 1.02
    beta = {"BETAN": least * max(1.0, 1 / ratio), "BETAT": least * max(1.0, ratio)}
    for degrees in np.linspace(0, 90, 10):
        direction = np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
        loading = element(4, interface.eight, **rigid(0.0), **beta)
        damage = []
        for gap in np.linspace(0, 0.04, 101)[1:]:
            once = element(4, interface.eight, **rigid(0.0), **beta)
            once.advance(interface.apart(*(gap * direction)))
            loading.advance(interface.apart(*(gap * direction)))
            # in one increment or in many: the same
            np.testing.assert_allclose(once.state["DAMAGE"], loading.state["DAMAGE"], rtol=1e-9, atol=1e-12)
            damage.append(loading.state["DAMAGE"][0])
        assert (np.diff(damage) >= 0).all() and damage[-1] == 1
