# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""ENERGY and the dissipation in SVARS: balance with the work done, and the fracture energies."""

from itertools import pairwise

import numpy as np
import pytest

ELASTIC, DAMAGE, VISCOUS = 1, 3, 4


@pytest.mark.parametrize("viscosity", [0.0, 0.5])
def test_energies_sum_up_to_the_work(element, interface, viscosity):
    """Trapezoidal work of the nodal forces = stored + dissipated, on any path: to 0.5 %, for the trapezoidal rule errs
    in increments that hold an onset, a failure or a closing. `test_dissipation.py` has large ones."""
    item = element(2, interface.four, VISCOSITY=viscosity)
    rng = np.random.default_rng(4)
    corners = [np.zeros((4, 2))]
    for _ in range(4):
        corners += [interface.displacements(4, *rng.uniform((-0.01, 0), (0.01, 0.015), (2, 2)), 7) for _ in range(3)]
        corners += [interface.displacements(4, *rng.uniform(-0.01, 0, (2, 2)), 7)]
    path = [a + f * (b - a) for a, b in pairwise(corners) for f in np.linspace(0, 1, 31)[1:]]
    for work in item.follow(path):
        energy = item.energy
        assert energy[ELASTIC] + energy[DAMAGE] + energy[VISCOUS] == pytest.approx(work, rel=5e-3, abs=1e-4)
    assert energy[DAMAGE] > 0
    assert (energy[VISCOUS] > 0) == (viscosity > 0)
    assert set(np.flatnonzero(energy)) <= {ELASTIC, DAMAGE, VISCOUS}


def open_steadily(item, interface, direction, steps, **options):
    """Open both ends alike to twice the separation at failure; last state."""
    for fraction in np.linspace(0, 1, steps + 1)[1:]:
        gap = 0.07 * fraction * np.asarray(direction)
        u = np.zeros((4, 2))
        axes = np.array([[0.3, 0.1], [-0.1, 0.3]]) / np.sqrt(0.1)  # tangent of the edge and its normal
        u[2:] = gap @ axes
        item.advance(u, **options)
    return item.state


@pytest.mark.sample(2)
@pytest.mark.parametrize("viscosity", [0.0, 1e-4])
@pytest.mark.parametrize(("direction", "mode"), [((0.0, 1.0), "I"), ((1.0, 0.0), "II"), ((-1.0, 0.0), "II")])
def test_pure_modes_dissipate_the_fracture_energy(element, interface, law, direction, mode, viscosity):
    item = element(2, interface.four, VISCOSITY=viscosity)
    # with viscosity the trapezoidal rule errs at onset and failure, which 4000 increments resolve
    state = open_steadily(item, interface, direction, 4000 if viscosity else 7, dtime=1e-3)
    np.testing.assert_allclose(state[f"DISS{mode}"], law[f"G{mode}C"], rtol=1e-3 if viscosity else 1e-12)
    np.testing.assert_allclose(state["DISSI" if mode == "II" else "DISSII"], 0, atol=1e-14)
    length, thickness = np.linalg.norm(np.diff(interface.edge, axis=0)), law["THICKNESS"]
    assert item.energy[DAMAGE] == pytest.approx(law[f"G{mode}C"] * length * thickness, rel=1e-3)
    assert item.energy[ELASTIC] == pytest.approx(0, abs=1e-12)


def test_mixed_mode_dissipates_to_the_linear_criterion(element, interface, law):
    """G_I/G_Ic + G_II/G_IIc = 1 along a straight path, the criterion behind equation (11)."""
    state = open_steadily(element(2, interface.four), interface, (0.6, 0.8), 7)
    np.testing.assert_array_equal(state["DAMAGE"], 1)
    np.testing.assert_allclose(state["DISSI"] / law["GIC"] + state["DISSII"] / law["GIIC"], 1, rtol=1e-12)
    assert (state["DISSII"] > 0.1).all()


def test_compression_dissipates_nothing(element, interface):
    item = element(2, interface.four)
    for gap in (-0.001, -0.01, -0.002, -0.02):
        item.advance(interface.displacements(4, (0.0, gap), (0.0, gap), 0))
    np.testing.assert_array_equal(item.state["DAMAGE"], 0)
    assert item.energy[DAMAGE] == 0


def test_stabilised_element_dissipates_the_fracture_energy(element, interface, law):
    """Damage at the displacement jump: the law itself dissipates G_c, whatever the stabilisation."""
    item = element(4, interface.eight)
    axes = np.array([[0.3, 0.1], [-0.1, 0.3]]) / np.sqrt(0.1)
    for gap in np.linspace(0, 0.03, 8)[1:]:
        u = np.zeros((8, 2))
        u[4:] = gap * axes[1]
        item.advance(u)
    np.testing.assert_allclose(item.state["DISSI"], law["GIC"], rtol=1e-12)


def test_strain_energy_of_the_quad(element):
    """u.K u/2, however many increments it takes."""
    coordinates = [[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]]
    item = element(1, coordinates)
    rng = np.random.default_rng(2)
    for _ in range(3):
        u = 1e-3 * rng.normal(size=8)
        _, stiffness = item.advance(u)
        assert item.energy[ELASTIC] == pytest.approx(0.5 * u @ stiffness @ u, rel=1e-11)
