# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STATIC, STABILIZE of a bar: stiffness E A/L = 200, artificial mass A L/2 = 1 at its free end, force 10 t."""

import numpy as np
import pytest

from uel.errors import DeckError
from uel.procedures.general.stabilized import NOTHING_DAMPED

K, M, H = 200.0, 1.0, 0.1
DECK = """*NODE
1, 0., 0.
2, 1., 0.
*NSET, NSET=END
2
*ELEMENT, TYPE=T2D2, ELSET=BAR
1, 1, 2
*SOLID SECTION, ELSET=BAR, MATERIAL=M
2.
*MATERIAL, NAME=M
*ELASTIC
100.
*BOUNDARY
1, 1, 2
2, 2
*STEP
*STATIC, DIRECT%s
0.1, 1.
*CLOAD
2, 1, 10.
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U1
*ENERGY OUTPUT
*END STEP
"""


@pytest.fixture
def run_bar(run_deck):
    def run_bar(options, deck=DECK):
        result = run_deck(deck % options)
        return result.history, result.file(".msg").read_text()

    return run_bar


def damped(factors):
    """u of each increment: (c M/h + K) u_1 = P_1 + c M/h u_0."""
    u, found = 0.0, []
    for k, factor in enumerate(factors, start=1):
        viscous = factor * M / H
        u = (10 * H * k + viscous * u) / (viscous + K)
        found.append(u)
    return np.array(found)


def test_given_factor(run_bar):
    history, message = run_bar(", STABILIZE, FACTOR=5.")
    u = damped([5.0] * 10)
    assert history["U1[END]"] == pytest.approx(u)
    assert "THE DAMPING FACTOR IS 5" in message
    flow = 5.0 * M * np.diff([0, *u]) / H
    force = np.concatenate([[0], flow])
    assert history["ALLSD"] == pytest.approx(np.cumsum((force[1:] + force[:-1]) / 2 * np.diff([0, *u])))
    assert history["ETOTAL"] == pytest.approx(0.0, abs=1e-10)


def test_a_step_with_temperatures_is_damped_alike(run_bar):
    deck = DECK.replace("*STATIC, DIRECT%s", "*COUPLED TEMPERATURE-DISPLACEMENT%s").replace(
        "*STEP", "*STEP, AMPLITUDE=RAMP"
    )
    history, message = run_bar(", STABILIZE, FACTOR=5., CREEP=NONE", deck)
    assert history["U1[END]"] == pytest.approx(damped([5.0] * 10))
    assert "THE DAMPING FACTOR IS 5" in message
    history, _ = run_bar(", STABILIZE", deck)
    assert history["U1[END]"] == pytest.approx(damped([0.0] + [2e-4 * K / 2 * H / M] * 9))


def test_factor_from_the_energy_of_the_first_increment(run_bar):
    """u_1 = P_1/K, energy K u_1^2/2; c M u_1^2/h is 2e-4 of it. Nothing else is damped before."""
    history, _ = run_bar(", STABILIZE")
    factor = 2e-4 * K / 2 * H / M
    assert history["U1[END]"] == pytest.approx(damped([0.0] + [factor] * 9))


def test_factor_falls_where_too_much_is_dissipated(run_bar):
    history, message = run_bar(", STABILIZE, FACTOR=50., ALLSDTOL=0.01")
    assert history["ALLSD"][-1] / history["ALLSE"][-1] < 0.5 * history["ALLSD"][0] / history["ALLSE"][0]
    assert message.count("FROM THE NEXT INCREMENT ON") > 2


def test_without_masses_it_says_so(run_bar):
    spring = DECK.replace("*ELEMENT, TYPE=T2D2", "*ELEMENT, TYPE=SPRINGA")
    spring = spring.replace("*SOLID SECTION, ELSET=BAR, MATERIAL=M\n2.\n", "*SPRING, ELSET=BAR\n\n200.\n")
    history, message = run_bar(", STABILIZE", spring)
    assert NOTHING_DAMPED in " ".join(message.split())
    assert history["U1[END]"][-1] == pytest.approx(10 / K)


@pytest.mark.parametrize(
    "options, message",
    [
        (", FACTOR=1.", r":17: \*STATIC: FACTOR needs STABILIZE"),
        (", STABILIZE=-1.", "STABILIZE must be positive, FACTOR and ALLSDTOL not negative"),
        (", STABILIZE, RIKS", "RIKS and STABILIZE exclude each other"),
        (", STABILIZE, CONTINUE=YES", "CONTINUE=YES is not supported"),
    ],
)
def test_options_that_are_wrong(run_bar, options, message):
    with pytest.raises(DeckError, match=message):
        run_bar(options)
