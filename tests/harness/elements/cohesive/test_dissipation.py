# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Energy that damage dissipates: the area under the curve of the law, however long the increments are."""

import itertools

import numpy as np
import pytest

from uel.model.properties import SectionControls

STIFFNESS, ONSET, TOUGHNESS = (1e4, 1e4, 1e4), (30.0, 60.0, 50.0), (0.26, 1.002, 0.8)
TABLE = (0.0, 0.2, 0.004, 0.7, 0.006, 0.7, 0.015, 1.0)
EVOLUTIONS = {
    "bk": ("ENERGY", "LINEAR", "BK", TOUGHNESS, 1.8),
    "power": ("ENERGY", "LINEAR", "POWER LAW", TOUGHNESS, 1.3),
    "energy": ("ENERGY", "LINEAR", "", (0.5,), 1.0),
    "exponential bk": ("ENERGY", "EXPONENTIAL", "BK", TOUGHNESS, 1.8),
    "displacement": ("DISPLACEMENT", "LINEAR", "", (0.02,), 1.0),
    "exponential displacement": ("DISPLACEMENT", "EXPONENTIAL", "", (0.02, 4.0), 1.0),
    "rising": ("DISPLACEMENT", "EXPONENTIAL", "", (0.02, -3.0), 1.0),
    "nearly linear": ("DISPLACEMENT", "EXPONENTIAL", "", (0.02, 1e-4), 1.0),
    "exponential of zero": ("DISPLACEMENT", "EXPONENTIAL", "", (0.02, 0.0), 1.0),
    "tabular": ("DISPLACEMENT", "TABULAR", "", TABLE, 1.0),
}
DIRECTIONS = [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (0.6, 0.8, 0.0), (0.48, 0.36, -0.8)]
FAR = 0.3
"""A separation beyond failure, by the exponential law up to 1e-15 of it."""


def curve(evolution, c, reached):
    """Effective displacements from 0 to `reached` and (1 - D) of a law with equal stiffnesses, along c, by the manual.

    Fine enough for the trapezoidal rule to have the area to 1e-7.
    """
    kind, softening, mixed, values, power = evolution
    c, k = np.array(c), STIFFNESS[0]
    onset = 1 / np.linalg.norm(k * c / ONSET)
    x = np.linspace(0, max(reached - onset, 0.0), 200_001)
    if kind == "ENERGY":
        energy = values[0]
        if mixed == "BK":
            energy += (values[1] - values[0]) * (c[1:] @ c[1:]) ** power
        elif mixed:
            energy = ((c**2 / TOUGHNESS) ** power).sum() ** (-1 / power)
        width, stored = 2 * energy / (k * onset) - onset, 0.5 * k * onset**2
    else:
        width = values[0]
    if softening == "TABULAR":
        left = 1 - np.interp(x, values[::2], values[1::2])
    elif softening == "EXPONENTIAL" and kind == "ENERGY":
        left = np.exp(-(((onset + x) / onset) ** 2 - 1) * stored / (energy - stored))
    else:
        alpha = values[1] if softening == "EXPONENTIAL" else 0.0
        of_width = np.minimum(x / width, 1.0)
        fraction = -np.expm1(-alpha * of_width) / -np.expm1(-alpha) if alpha else of_width
        left = onset / (onset + x) * (1 - fraction)
    return onset, onset + x, left


def dissipated(evolution, c, reached):
    """Work up to an effective displacement, less what is stored there."""
    onset, delta, left = curve(evolution, c, reached)
    traction = STIFFNESS[0] * left * delta
    return 0.5 * STIFFNESS[0] * onset**2 + np.trapezoid(traction, delta) - 0.5 * traction[-1] * delta[-1]


@pytest.mark.parametrize(("evolution", "c"), [*itertools.product(EVOLUTIONS, DIRECTIONS)])
def test_from_intact_to_failed_in_one_increment(layer, evolution, c):
    """The area under the curve: the fracture energy of the mode mix, where that is given."""
    item = layer("COH3D8", EVOLUTIONS[evolution])
    item.move(FAR * np.array(c))
    assert item.value("DAMAGE") == pytest.approx(1.0, abs=1e-14)
    assert item.dissipated == pytest.approx(dissipated(EVOLUTIONS[evolution], c, FAR), rel=1e-6)
    if evolution == "bk":
        share = c[1] ** 2 + c[2] ** 2
        assert item.dissipated == pytest.approx(0.26 + (1.002 - 0.26) * share**1.8, rel=1e-12)
    # each mode has its part of the work
    modes = [item.value(name) for name in ("DISSI", "DISSII", "DISSIII")]
    np.testing.assert_allclose(modes, item.dissipated * np.array(c) ** 2, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(("evolution", "c"), [*itertools.product(EVOLUTIONS, [(1.0, 0.0), (0.6, 0.8)])])
def test_unloading_and_the_other_side(layer, evolution, c):
    """Up, back, on from there to the other side and back: what the largest separation has. Compression in mode I."""
    item, largest, spent = layer(evolution=EVOLUTIONS[evolution]), 0.0, 0.0
    for way in (0.005, 0.009, 0.002, 0.012, 0.013, 0.001):
        for side in ([1, 1], [1, -1] if c[1] else [-1, 1]):
            item.move(way * np.array(c) * side)
            largest = max(largest, way)
            assert item.dissipated >= spent
            spent = item.dissipated
            assert spent == pytest.approx(dissipated(EVOLUTIONS[evolution], (*c, 0.0), largest), rel=1e-6)


@pytest.mark.parametrize("evolution", ["energy", "displacement", "exponential displacement", "tabular"])
def test_direction_that_turns(layer, evolution):
    """Twice as many increments of a path that turns have a fourth of the error."""
    angles = np.linspace(0.2, 1.2, 2001)
    path = np.linspace(0.006, 0.015, 2001)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    found = {}
    for every in (1, 125, 250, 500):
        item, work, last, before = layer(evolution=EVOLUTIONS[evolution]), 0.0, np.zeros(2), np.zeros(2)
        item.move(path[0])
        start = item.dissipated
        last, before = item.state()[0, 4:6], path[0]
        first = 0.5 * last @ before
        for separation in path[every::every]:
            traction = item.move(separation)
            work += 0.5 * (traction + last) @ (separation - before)
            last, before = traction, separation
        found[every] = item.dissipated - start
    exact = found.pop(1)
    errors = [abs(value - exact) for value in found.values()]
    assert errors[2] < 0.02 * exact
    assert errors[0] < errors[1] / 3 < errors[2] / 9
    assert found[125] == pytest.approx(first + work - 0.5 * last @ before, rel=0.05)


def test_mode_mix_that_falls_at_the_start_of_an_increment(layer):
    """Opened after shear, whose fracture energy the increment still has, then with its own, at the same separation.

    The damage grows to that of the curve with the smaller energy at once, and dissipates dD/2 sum K g^2 of it.
    """
    item = layer(evolution=EVOLUTIONS["bk"])
    item.move(np.array([0.0, 0.006]))
    item.move(np.array([0.008, 0.0]))
    damage, spent = item.value("DAMAGE"), item.dissipated
    item.move(np.array([0.008, 0.0]))
    assert 0 < damage < item.value("DAMAGE") < 1
    expected = 0.5 * STIFFNESS[0] * 0.008**2 * (item.value("DAMAGE") - damage)
    assert item.dissipated - spent == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("evolution", EVOLUTIONS)
def test_viscosity(layer, evolution):
    """Torn in one increment and held: damage has the area under the curve, the overstress what was stored then."""
    mu, dtime, c = 3.0, 1.0, (0.6, 0.8, 0.0)
    item = layer(evolution=EVOLUTIONS[evolution], viscosity=mu)
    area = dissipated(EVOLUTIONS[evolution], c, FAR)
    item.move(FAR * np.array(c[:2]), dtime)
    assert item.value("DAMAGE") == pytest.approx(dtime / (mu + dtime))
    assert item.dissipated == pytest.approx(area, rel=1e-6)
    assert item.value("DISSV") == pytest.approx(0.0, abs=1e-9)
    stored = item.report.energy[1] / item.area
    assert stored == pytest.approx(0.5 * STIFFNESS[0] * FAR**2 * mu / (mu + dtime))
    item.move(FAR * np.array(c[:2]), 1e12)
    assert item.dissipated == pytest.approx(area, rel=1e-6)
    assert item.value("DISSV") == pytest.approx(stored, rel=1e-6)


@pytest.mark.parametrize("mu", [0.3, 3.0, 300.0])
def test_damage_never_gives_energy_back(layer, mu):
    """With a viscosity of any size; in the end the damage has dissipated the fracture energy of mode I."""
    item = layer(evolution=EVOLUTIONS["bk"], viscosity=mu)
    spent = np.zeros(2)
    for opening in (*np.linspace(0, 0.02, 21), *np.linspace(0.02, 0.001, 7), 0.03):
        item.move(np.array([opening, 0.0]), 0.2)
        now = np.array([item.dissipated, item.value("DISSV")])
        assert (now >= spent).all()
        spent = now
    item.move(np.array([0.03, 0.0]), 1e15)
    assert item.dissipated == pytest.approx(0.26, rel=1e-9)


def test_largest_degradation(layer):
    """MAX DEGRADATION ends the damage, and with it what is dissipated: up to D the triangle delta_o delta(D) D K/2."""
    item = layer(evolution=EVOLUTIONS["bk"], controls=SectionControls(degradation=0.7))
    item.move(np.array([FAR, 0.0]))
    onset, failure = 0.003, 2 * 0.26 / 30
    delta = onset * failure / (failure - 0.7 * (failure - onset))
    assert item.dissipated == pytest.approx(0.5 * STIFFNESS[0] * onset * delta * 0.7, rel=1e-12)
