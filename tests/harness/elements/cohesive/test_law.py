# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Traction-separation response against the formulas of the Abaqus Analysis User's Guide.

Defining the constitutive response of cohesive elements using a traction-separation description.
"""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from uel.errors import KernelError, Source
from uel.model.damage import DamageEvolution
from uel.model.properties import SectionControls

STIFFNESS, ONSET, TOUGHNESS = (1e4, 1e4, 1e4), (30.0, 60.0, 50.0), (0.26, 1.002, 0.8)
ENERGY, DISPLACEMENT = "ENERGY", "DISPLACEMENT"
EVOLUTIONS = {
    "bk": (ENERGY, "LINEAR", "BK", TOUGHNESS, 1.8),
    "power": (ENERGY, "LINEAR", "POWER LAW", TOUGHNESS, 1.3),
    "root": (ENERGY, "LINEAR", "POWER LAW", TOUGHNESS, 0.8),
    "energy": (ENERGY, "LINEAR", "", (0.5,), 1.0),
    "displacement": (DISPLACEMENT, "LINEAR", "", (0.02,), 1.0),
    "exponential bk": (ENERGY, "EXPONENTIAL", "BK", TOUGHNESS, 1.8),
    "exponential power": (ENERGY, "EXPONENTIAL", "POWER LAW", TOUGHNESS, 1.3),
    "exponential displacement": (DISPLACEMENT, "EXPONENTIAL", "", (0.02, 4.0), 1.0),
    "exponential of zero": (DISPLACEMENT, "EXPONENTIAL", "", (0.02, 0.0), 1.0),
    "tabular": (DISPLACEMENT, "TABULAR", "", (0.0, 0.0, 0.004, 0.7, 0.015, 0.9), 1.0),
}
TYPES = ("COH2D4", "COH3D6", "COH3D8")
CRITERIA = ("MAXS", "QUADS", "MAXE", "QUADE")


def evolution_of(name):
    return DamageEvolution(*EVOLUTIONS[name], Source("test.inp", 7))


def directions(dimension):
    """Unit vectors of mode mixes, pure modes included."""
    angles = np.radians([0, 20, 45, 70, 90])
    plane = [np.array([np.cos(a), np.sin(a), 0.0]) for a in angles]
    if dimension == 2:
        return [c[:2] for c in plane]
    return [*plane, np.array([0.0, 0.0, 1.0]), np.array([0.5, -0.5, np.sqrt(0.5)])]


def fracture_energy(evolution, stiffness, c):
    """BK and power law at the mode mix of a separation along c."""
    if not evolution.mixed_mode:
        return evolution.values[0]
    energies = np.array(stiffness)[: len(c)] * c**2
    share = energies / energies.sum()
    if evolution.mixed_mode == "BK":
        g_n, g_s = evolution.values[:2]
        return g_n + (g_s - g_n) * share[1:].sum() ** evolution.power
    return ((share / evolution.values[: len(c)]) ** evolution.power).sum() ** (-1 / evolution.power)


def expected_damage(evolution, stiffness, c, distance):
    """D at a distance along c beyond the onset by QUADS, as the manual gives it."""
    stiff = np.array(stiffness)[: len(c)]
    onset = 1 / np.linalg.norm(stiff * c / np.array(ONSET)[: len(c)])
    traction = onset * np.linalg.norm(stiff * c)
    if evolution.type == ENERGY:
        energy = fracture_energy(evolution, stiffness, c)
        failure = 2 * energy / traction
    else:
        failure = onset + evolution.values[0]
    if evolution.softening == "TABULAR":
        damage = np.interp(distance - onset, evolution.values[::2], evolution.values[1::2])
    elif evolution.softening == "LINEAR":
        damage = failure * (distance - onset) / (distance * (failure - onset))
    elif evolution.type == DISPLACEMENT:
        alpha = evolution.values[1]
        x = (distance - onset) / (failure - onset)
        fraction = (1 - np.exp(-alpha * x)) / (1 - np.exp(-alpha)) if alpha else x
        damage = 1 - onset / distance * (1 - fraction)
    else:
        # dD/d delta = T_eff/(G - G_0) with T_eff = (1 - D) traction delta/onset, by a fine Runge-Kutta integration
        stored, damage = 0.5 * onset * traction, 0.0
        places = np.linspace(onset, distance, 201)
        for a, b in itertools.pairwise(places):
            h = b - a

            def slope(d, x):
                return (1 - d) * traction * x / onset / (energy - stored)

            k1 = slope(damage, a)
            k2 = slope(damage + h / 2 * k1, a + h / 2)
            k3 = slope(damage + h / 2 * k2, a + h / 2)
            damage += h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(damage + h * k3, b))
    return min(damage, 1.0)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("criterion", CRITERIA)
def test_onset(layer, element_type, criterion):
    """Damage begins where the criterion of the manual is met, whatever the direction."""
    stiffness, thickness = (1e4, 2e4, 1.5e4), 0.5
    for c in directions(2 if element_type == "COH2D4" else 3):
        item = layer(element_type, EVOLUTIONS["displacement"], criterion, stiffness=stiffness, thickness=thickness)
        n = item.dimension
        measure = np.abs(c) / thickness
        measure *= 1 / np.array(ONSET)[:n] * (np.array(stiffness)[:n] if criterion.endswith("S") else 1e4)
        f = np.sqrt((measure**2).sum()) if criterion.startswith("QUAD") else measure.max()
        item.move(0.999 * c / f)
        assert item.value("DAMAGE") == 0
        reached = 0.999 ** (2 if criterion.startswith("QUAD") else 1)
        assert item.value(f"{criterion}CRT") == pytest.approx(reached, rel=1e-11)
        item.move(1.001 * c / f)
        assert item.value("DAMAGE") > 0
        assert item.value(f"{criterion}CRT") == 1


@pytest.mark.parametrize(("element_type", "evolution"), [*itertools.product(TYPES, EVOLUTIONS)])
def test_damage_of_the_manual(layer, element_type, evolution):
    stiffness = (1e4, 2e4, 1.5e4)
    for c in directions(2 if element_type == "COH2D4" else 3):
        item = layer(element_type, EVOLUTIONS[evolution], stiffness=stiffness)
        for distance in (0.008, 0.012, 0.03):
            item.move(distance * c)
            expected = expected_damage(evolution_of(evolution), stiffness, c, distance)
            assert item.value("DAMAGE") == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("evolution", ["bk", "power", "exponential bk"])
def test_mode_mix_is_that_at_the_start_of_the_increment(layer, element_type, evolution):
    """That of the fracture energy; the onset is that of the present separation. A point at rest has the present one.

    harness/uel/procedures/fidelity.md has the evidence. In compression only shear counts.
    """
    law, stiffness = evolution_of(evolution), (1e4, 2e4, 2e4)
    dimension = 2 if element_type == "COH2D4" else 3
    found = layer(element_type, EVOLUTIONS[evolution], stiffness=stiffness)
    path = [(0.4, 0.001), (1.2, 0.006), (0.3, 0.009), (0.9, 0.02)]
    start, damage = None, 0.0
    for angle, distance in path:
        c = np.array([np.cos(angle), np.sin(angle), 0.0])[:dimension]
        mixed = without_mix(law, c if start is None else start, stiffness)
        if distance > 0.002:
            damage = max(damage, expected_damage(mixed, stiffness, c, distance))
        found.move(distance * c)
        assert found.value("DAMAGE") == pytest.approx(damage, rel=1e-5)
        start = c
    found.move(np.array([-1e-4, 1e-4, 0.0])[:dimension])
    c, shear = np.array([0.6, 0.8, 0.0])[:dimension], np.array([0.0, 1.0, 0.0])[:dimension]
    found.move(0.1 * c)
    assert found.value("DAMAGE") == pytest.approx(
        expected_damage(without_mix(law, shear, stiffness), stiffness, c, 0.1), rel=1e-5
    )


def without_mix(law, c, stiffness):
    """A law without mode mix, with the fracture energy at that of c."""
    return replace(law, mixed_mode="", values=(fracture_energy(law, stiffness, c),))


def test_fracture_energy_that_is_too_small_for_the_onset(layer):
    """Opened first, then sheared: 0.1 of mode I is less than 60^2/(2 1e4) at the onset by shear, whose own G holds."""
    evolution = (ENERGY, "LINEAR", "BK", (0.1, 1.0, 1.0), 1.8)
    law = DamageEvolution(*evolution, Source("test.inp", 7))
    found = layer("COH2D4", evolution)
    found.move(np.array([1e-3, 0.0]))
    found.move(np.array([0.0, 0.012]))
    assert found.value("DAMAGE") == pytest.approx(expected_damage(law, STIFFNESS, np.array([0.0, 1.0]), 0.012))


@pytest.mark.sample(2)
@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("evolution", [name for name, entries in EVOLUTIONS.items() if entries[0] == ENERGY])
def test_fracture_energy(layer, element_type, evolution):
    """The area under the curve is the fracture energy at the mode mix, by BK and by the power law."""
    for c in directions(2 if element_type == "COH2D4" else 3):
        item = layer(element_type, EVOLUTIONS[evolution])
        item.move(0.07 * c, steps=400)
        assert item.value("DAMAGE") == pytest.approx(1.0, abs=1e-9)
        energy = fracture_energy(evolution_of(evolution), STIFFNESS, c)
        assert item.dissipated == pytest.approx(energy, rel=2e-3)
        # the report has it as damage, not as plasticity
        assert item.report.energy[3] == 0


def test_area_with_unequal_stiffnesses(layer):
    """The effective traction at the onset is its size, of which the part along the separation does the work."""
    stiffness, c = (1e4, 4e4, 4e4), np.array([np.sqrt(0.5), np.sqrt(0.5)])
    item = layer(stiffness=stiffness)
    item.move(0.1 * c, steps=4000)
    traction = np.array(stiffness)[:2] * c
    along = traction @ c / np.linalg.norm(traction)
    energy = fracture_energy(evolution_of("bk"), stiffness, c)
    # beyond the onset the triangle has the height along*T_o, and so has the one before
    assert item.dissipated == pytest.approx(along * energy, rel=1e-3)
    assert along < 0.9


@pytest.mark.parametrize("viscosity", ["material", "controls"])
def test_viscosity(layer, viscosity):
    """The damage that acts follows by backward Euler; the energies add up to the work of the traction.

    The work is that of the trapezoidal rule, to 2 parts in 1e5 at these increments.
    """
    mu, dtime = 0.5, 0.2
    if viscosity == "material":
        item = layer(viscosity=mu)
    else:
        item = layer(viscosity=9.0, controls=SectionControls(viscosity=mu))
    evolution, c = evolution_of("bk"), np.array([0.8, 0.6])
    acting, work, before = 0.0, 0.0, np.zeros(2)
    steps = np.linspace(0.0, 0.02, 201)[1:]
    for distance in steps:
        traction = item.move(distance * c, dtime)
        largest = max(0.0, expected_damage(evolution, STIFFNESS, c, distance))
        acting = (mu * acting + dtime * largest) / (mu + dtime)
        work += 0.5 * (traction + before) @ c * (steps[1] - steps[0])
        before = traction
        assert item.value("DAMAGE") == pytest.approx(acting, rel=1e-9, abs=1e-12)
    assert item.value("DMAX") > item.value("DAMAGE")
    stored, creep = item.report.energy[[1, 2]] / item.area
    assert creep > 0
    assert creep == pytest.approx(item.value("DISSV"), rel=1e-12)
    assert item.dissipated == pytest.approx(item.value("DISSI") + item.value("DISSII"), rel=1e-12)
    assert stored + item.dissipated + creep == pytest.approx(work, rel=5e-5)


def test_initiation_alone(layer):
    """Without *DAMAGE EVOLUTION the criterion is reported, and goes beyond 1."""
    item = layer(evolution=None)
    np.testing.assert_allclose(item.move(np.array([0.006, 0.0])), [60, 0], rtol=1e-11, atol=1e-11)
    assert item.value("QUADSCRT") == pytest.approx(4)
    item.move(np.array([0.001, 0.0]))
    assert item.value("QUADSCRT") == pytest.approx(4)
    assert item.value("DAMAGE") == 0


def test_too_brittle_in_mixed_mode(layer):
    """A power law whose exponent is small dips below both pure modes, here under the elastic energy."""
    item = layer(evolution=EVOLUTIONS["root"], stiffness=(1.8e3, 1.8e3, 1.8e3))
    with pytest.raises(
        KernelError, match=r"element 101 .*the mode mix must exceed .*, and falls short by +3.9.E-02 at"
    ):
        item.move(np.array([0.02, 0.02]))


@pytest.mark.parametrize(("element_type", "evolution"), [*itertools.product(TYPES, EVOLUTIONS)])
@pytest.mark.parametrize("viscosity", [0.0, 0.7])
def test_tangent(layer, element_type, evolution, viscosity):
    """AMATRX against central differences of RHS from a damaged state on, every criterion, random separations."""
    rng = np.random.default_rng(5)
    seen = 0.0
    for criterion in CRITERIA:
        item = layer(element_type, EVOLUTIONS[evolution], criterion, stiffness=(1e4, 2e4, 1.5e4), viscosity=viscosity)
        n = item.dimension
        # a triangle has those of three of the corners of a quadrilateral
        points = len(item.pairs), 2 * n - 2
        item.move(6e-3 * rng.normal(size=(points[1], n))[: points[0]])
        for _ in range(3):
            u = item.displacements(9e-3 * rng.normal(size=(points[1], n))[: points[0]])
            item.evaluate(u)
            exact = item.matrix.toarray()
            h = 1e-9
            pairs = [(item.evaluate(u + step), item.evaluate(u - step)) for step in h * np.eye(len(u))]
            differences = np.array([(plus - minus) / (2 * h) for plus, minus in pairs]).T
            np.testing.assert_allclose(exact, -differences, atol=2e-5 * abs(exact).max())
            seen = max(seen, abs(exact - exact.T).max() / abs(exact).max())
    # there was damage whose derivative matters
    assert seen > 0.01
