# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""How large beta must be for the consistent stabilised law to have one solution, in U4."""

import numpy as np
import pytest

from harness.errors import KernelError


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
    position = {"N": 14, "T": 15}[mode]
    below = element(4, interface.eight, label=42, **rigid(alpha), **given)
    message = (
        rf"U4 element 42: PROPS\({position}\) BETA{mode}: beta = {str(1.4999 * steepest)[:3]}.*, too small for the "
        rf"consistent law.*expected more than {str(1.5 * steepest)[:3]}"
    )
    with pytest.raises(KernelError, match=message):
        below.evaluate(u)
    given[f"BETA{mode}"] = 1.51 * steepest
    element(4, interface.eight, **rigid(alpha), **given).evaluate(u)


def test_computed_beta_is_checked_too(element, interface):
    """Equation (21) gives 1e5 N/mm^3 here; a law that fails within 1e-6 mm is steeper."""
    brittle = {"SIGMAMAX": 30.0, "GIC": 1e-4, "GIIC": 1.0}
    item = element(4, interface.eight, label=42, **rigid(0.0), **brittle)
    with pytest.raises(KernelError, match=r"PROPS\(14\) BETAN: beta = .* refine the mesh"):
        item.evaluate(np.zeros(16))


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
