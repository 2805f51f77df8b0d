# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a property of 0 stands for, and beta and gamma that an element computes once."""

import numpy as np
import pytest
from neighbours import Sandwich
from reference_cells import SQUARE_EDGES, with_middles
from space import nodes_of

from uel.usersub.layout import element_layouts

ZEROS = {"LAW": 0, "CLOSURE": 0, "BETAN": 0.0, "BETAT": 0.0, "ALPHAN": 0.0, "ALPHAT": 0.0}
CONSISTENT = {"LAW": 1, "CLOSURE": 3, "BETAN": -1.0, "BETAT": -1.0, "ALPHAN": 0.0, "ALPHAT": 0.0}
PAPER = {"LAW": 1, "CLOSURE": 2, "BETAN": -2.0, "BETAT": -2.0}
OWN = [item.name for item in element_layouts()[4].own]


def nodes(jtype, interface):
    """Nodes of a self-contained element."""
    if jtype in (4, 6):
        corners = interface.eight
        return corners if jtype == 4 else np.vstack([with_middles(half, SQUARE_EDGES) for half in np.split(corners, 2)])
    return nodes_of(jtype, "sloping")


def path(size):
    """Displacements of increments that open and slide, so that the elements are damaged."""
    away = np.zeros(size)
    away[size // 2 :] = np.random.default_rng(5).uniform(0.5, 1.0, size // 2)
    return [share * away for share in (0.0005, 0.003, 0.006)]


def responses(item, size):
    """RHS, AMATRX and SVARS along the path."""
    for u in path(size):
        rhs, matrix = item.advance(u, dtime=0.1)
        yield rhs, matrix, np.array(list(item.state.values()))


def assert_same(one, other, size):
    """To the bit, along the path; returns the last SVARS."""
    for found, expected in zip(responses(one, size), responses(other, size), strict=True):
        for mine, theirs in zip(found, expected, strict=True):
            np.testing.assert_array_equal(mine, theirs)
    return one.state


@pytest.mark.parametrize("jtype", [4, 6, 8, 12])
def test_zeros_are_the_consistent_element(element, interface, jtype):
    places = nodes(jtype, interface)
    zeros, consistent = (element(jtype, places, **values) for values in (ZEROS, CONSISTENT))
    assert assert_same(zeros, consistent, zeros.n)["DAMAGE"].max() > 0.1


@pytest.mark.parametrize("jtype", [3, 10])
def test_zeros_beside_quads_and_bricks_are_the_papers(element, interface, jtype):
    places = interface.eight if jtype == 3 else nodes_of(8, "flat")
    zeros = {"LAW": 0, "CLOSURE": 0, "BETAN": 0.0, "BETAT": 0.0}
    one, two = (Sandwich(element, jtype, places, **values) for values in (zeros, PAPER))
    assert assert_same(one, two, places.size)["DAMAGE"].max() > 0.1


@pytest.mark.parametrize("jtype", [2, 5, 7, 11])
def test_the_law_of_zero_is_bilinear(element, interface, jtype):
    places = {2: interface.four, 5: np.insert(interface.four, [4, 4], interface.four[:2].mean(axis=0), axis=0)}
    places |= {kind: nodes_of(kind, "flat") for kind in (7, 11)}
    one, two = (element(jtype, places[jtype], LAW=law) for law in (0, 1))
    assert_same(one, two, one.n)


@pytest.mark.parametrize("given", [{}, {"GAMMABOT": 0.3}, {"BETAT": 3e5}], ids=str)
@pytest.mark.parametrize("jtype", [4, 6, 8, 12])
def test_beta_and_gamma_are_computed_once(element, interface, jtype, given):
    """An element whose SVARS are cleared of them computes them again."""
    places = nodes(jtype, interface)
    values = {"ALPHAN": 1e6, "ALPHAT": 1e6, "CLOSURE": 1, "BETAN": -1.0, **given}
    once, always = element(jtype, places, **values), element(jtype, places, **values)
    for kept, again in zip(responses(once, once.n), responses(always, once.n), strict=True):
        for mine, theirs in zip(kept, again, strict=True):
            np.testing.assert_array_equal(mine, theirs)
        always.block._arrays.svars[0, -len(OWN) :] = 0.0
    own = dict(zip(OWN, once.block.state(0).svars[0, -len(OWN) :], strict=True))
    # S = beta/(alpha + beta) before damage
    fresh = element(jtype, places, **values)
    fresh.advance(np.zeros(fresh.n))
    for mode in "NT":
        assert fresh.state[f"S{mode}"][0] == pytest.approx(own[f"BETA{mode}"] / (1e6 + own[f"BETA{mode}"]), rel=1e-12)
        assert own[f"GAMMA{mode}"] == given.get("GAMMABOT", own[f"GAMMA{mode}"])
    # what it has kept is what acts
    u = path(once.n)[0]
    before = fresh.evaluate(u)[0]
    fresh.block._arrays.svars[0, OWN.index("BETAN") - len(OWN)] *= 2.0
    assert abs(fresh.evaluate(u)[0] - before).max() > 1e-3 * abs(before).max()


def test_given_beta_goes_before_what_is_kept(element, interface):
    item = element(4, interface.eight, CLOSURE=1, BETAN=2e5, BETAT=3e5)
    item.advance(np.zeros(16))
    own = dict(zip(OWN, item.block.state(0).svars[0, -len(OWN) :], strict=True))
    assert (own["BETAN"], own["BETAT"]) == (2e5, 3e5)
    u = path(16)[0]
    before = item.evaluate(u)[0]
    item.block._arrays.svars[0, -len(OWN) :] *= 0.5
    np.testing.assert_array_equal(item.evaluate(u)[0], before)
