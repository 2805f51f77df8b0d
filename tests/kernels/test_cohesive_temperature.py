# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Strengths and fracture energies that depend on the temperature."""

import numpy as np
import pytest
from space import nodes_of, opened
from variants import LAWS, variants

from uel.errors import KernelError

VARIANTS = variants(2e5)
TABLE = {
    "TEMPERATURE1": 20.0,
    "TEMPERATURE2": 80.0,
    "STRENGTH2": 0.7,
    "TOUGHNESS2": 1.4,
    "TEMPERATURE3": 120.0,
    "STRENGTH3": 0.4,
    "TOUGHNESS3": 1.1,
}
AT = {-50.0: (1.0, 1.0), 20.0: (1.0, 1.0), 50.0: (0.85, 1.2), 80.0: (0.7, 1.4), 100.0: (0.55, 1.25), 300.0: (0.4, 1.1)}
"""Factors by temperature: linear in between, constant outside."""
VALUES = {"SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.002}
BRIDGES = {"SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1}


def scaled(law, strength, toughness):
    """The properties of a law whose strengths and fracture energies are multiplied."""
    values = {**VALUES, **(BRIDGES if law == "bridging" else {})}
    return {name: value * (strength if name[0] in "ST" else toughness) for name, value in values.items()}


def displacements(jtype, interface, gap):
    """Displacements of an element whose faces are apart by a gap (shear, opening)."""
    if jtype in (7, 8):
        return np.ravel(opened(jtype, np.array([0.6 * gap[0], 0.8 * gap[0], gap[1]]), 0))
    nodes = 4 if jtype == 2 else 8
    u = np.zeros((nodes, 2))
    u[nodes // 2 :] = np.asarray(gap) @ interface.axes
    return u.ravel()


@pytest.fixture
def make(element, interface):
    """Make an element of a variant with a law: make(variant, law, NAME=value, ...)."""

    def made(variant, law, **values):
        jtype, given = VARIANTS[variant]
        nodes = nodes_of(jtype, "flat") if jtype in (7, 8) else interface.four if jtype == 2 else interface.eight
        return element(jtype, nodes, **LAWS[law] | given | values)

    return made


PATH = [(1e-5, 2e-5), (5e-4, 8e-4), (2e-3, 3e-3), (1e-3, 1e-3), (6e-3, 9e-3), (0.05, 0.1)]


@pytest.mark.parametrize("temperature", AT)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_law_at_a_temperature(make, interface, variant, law, temperature):
    """That of a deck with the values at this temperature, history and energies included."""
    item, same = make(variant, law, **TABLE), make(variant, law, **scaled(law, *AT[temperature]))
    for gap in PATH:
        u = displacements(VARIANTS[variant][0], interface, gap)
        fields = np.full((1, u.size), temperature)
        found, expected = item.advance(u, fields=fields), same.advance(u, fields=fields)
        for one, other in zip(found, expected, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * abs(other).max())
        np.testing.assert_allclose(item.energy, same.energy, rtol=1e-9, atol=1e-15)


def test_toughness_follows_strength_unless_it_is_given(make, interface):
    item = make("U2", "linear criterion", TEMPERATURE2=100.0, STRENGTH2=0.5)
    same = make("U2", "linear criterion", **scaled("linear criterion", 0.75, 0.75))
    u = displacements(2, interface, (2e-3, 3e-3))
    np.testing.assert_allclose(item.advance(u, fields=np.full((1, 8), 50.0))[0], same.advance(u)[0], rtol=1e-12)


@pytest.mark.parametrize("variant", ["U4 rigid", "U8 rigid"])
def test_beta_suffices_at_every_temperature(make, interface, variant):
    """An estimate is raised to what the steepest law of the table needs, whatever the temperature is at first."""
    brittle = {"GIC": 1e-3, "GIIC": 1.0, "BETAN": 0.0, "BETAT": 0.0, "TEMPERATURE2": 100.0, "STRENGTH2": 3.0}
    item = make(variant, "linear criterion", **brittle, TOUGHNESS2=1.0)
    item.advance(displacements(VARIANTS[variant][0], interface, (0.0, 0.0)))
    slope = (3 * 30.0) ** 2 / (2 * 1e-3)
    layout_own = item.block.state(0).svars[0, item.points * len(item.names) :]
    assert layout_own[0] == pytest.approx(2 * slope)


@pytest.mark.parametrize("variant", VARIANTS)
def test_tangent_at_a_temperature(make, interface, variant):
    item = make(variant, "Benzeggagh-Kenane", **TABLE)
    u = displacements(VARIANTS[variant][0], interface, (2e-3, 3e-3))
    fields = np.full((1, u.size), 60.0)
    item.advance(0.5 * u, fields=fields)
    _, matrix = item.evaluate(u, fields=fields)
    step = 1e-8
    rows = [
        (item.evaluate(u + step * side, fields=fields)[0] - item.evaluate(u - step * side, fields=fields)[0])
        for side in np.eye(u.size)
    ]
    np.testing.assert_allclose(-np.array(rows).T / (2 * step), matrix, atol=2e-6 * max(abs(matrix).max(), 1.0))


@pytest.mark.parametrize(
    "law, values, message",
    [
        (1, {"TEMPERATURE2": -1.0, "STRENGTH2": 0.5}, r"TEMPERATURE2 = -1.*: expected more than TEMPERATURE1"),
        (1, {"TEMPERATURE2": 50.0}, r"TEMPERATURE2 = 50.*, but no STRENGTH2: expected both"),
        (1, {"TOUGHNESS3": 0.5}, r"TOUGHNESS3 = 0.5.*, but no STRENGTH3: expected both"),
        (1, {"STRENGTH2": -0.5}, r"STRENGTH2 = -0.5.*expected zero or a positive value"),
        (1, {"TEMPERATURE3": 50.0, "STRENGTH3": 0.5}, r"STRENGTH3 = 0.5.*, but no STRENGTH2: expected it before"),
        (4, {"TEMPERATURE2": 50.0, "STRENGTH2": 0.5}, r"STRENGTH2 = 0.5.*, which LAW 4 does not have"),
    ],
)
@pytest.mark.parametrize("variant", ["U2", "U8 rigid"])
def test_messages(make, interface, variant, law, values, message):
    item = make(variant, "linear criterion", **values | {"LAW": law})
    with pytest.raises(KernelError, match=message):
        item.evaluate(displacements(VARIANTS[variant][0], interface, (0.0, 0.0)))
