# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hybrid elements with a pressure that is an unknown, in all procedures; closed forms of incompressible bodies.

A thick-walled cylinder has one degree of freedom: u = q/r, with the kinetic energy 1/2 M q'^2 and the strain energy
1/2 K q^2 of a length, M = 2 pi rho ln(b/a), K = 4 pi mu (1/a^2 - 1/b^2); a pressure P inside is the force 2 pi P.
"""

from pathlib import Path

import numpy as np
import pytest
from hybrid_bodies import INNER, OUTER, cube, cylinder, radial

from uel.errors import DeckError

USER = Path(__file__).with_name("hybrid.f")
YOUNG, DENSITY, PRESSURE = 3.0, 2.0, 0.1
SHEAR = YOUNG / 3
MASS = 2 * np.pi * DENSITY * np.log(OUTER / INNER)
STIFFNESS = 4 * np.pi * SHEAR * (1 / INNER**2 - 1 / OUTER**2)
CIRCULAR = np.sqrt(STIFFNESS / MASS)
STATIC = 2 * np.pi * PRESSURE / STIFFNESS
ELASTIC = f"*ELASTIC\n{YOUNG}, 0.5\n*DENSITY\n{DENSITY}"
RUBBER = f"*HYPERELASTIC, NEO HOOKE\n{SHEAR / 2}, 0.\n*DENSITY\n{DENSITY}"
LOAD = ["*DLOAD", f"FIRST, P4, {PRESSURE}"]


@pytest.mark.parametrize("element_type", ["CAX4H", "CAX8H"])
def test_frequency(run_deck, element_type):
    """The other modes, if any, are those of locked shapes: u = q/r alone keeps the volume."""
    lines, _ = cylinder(element_type, ELASTIC, static="*FREQUENCY\n1", load=[])
    history = run_deck(lines).history
    assert np.sqrt(history["EIGVAL"][0]) == pytest.approx(CIRCULAR, rel=3e-3 if element_type == "CAX4H" else 3e-5)


def test_frequency_of_many_unknowns(run_deck):
    """More than are solved densely: the linear solver factorises what is indefinite."""
    lines, _ = cylinder("CAX8H", ELASTIC, static="*FREQUENCY\n1", load=[], count=60)
    assert np.sqrt(run_deck(lines).history["EIGVAL"][0]) == pytest.approx(CIRCULAR, rel=1e-6)


def test_perturbation(run_deck):
    """*STATIC in a step with PERTURBATION."""
    lines, nodes = cylinder("CAX8H", ELASTIC, step="*STEP, PERTURBATION", static="*STATIC", load=LOAD)
    result = run_deck(lines)
    r = nodes[:, 0]
    np.testing.assert_allclose(radial(result.history, nodes, "U"), STATIC / r, rtol=3e-5)


def test_steady_state(run_deck):
    """Amplitude P/(K - w^2 M)."""
    frequency = 0.3 * CIRCULAR / (2 * np.pi)
    static = f"*STEADY STATE DYNAMICS, DIRECT\n{frequency:.16g}"
    lines, nodes = cylinder("CAX8H", ELASTIC, static=static, load=LOAD)
    found = radial(run_deck(lines).history, nodes, "U")
    np.testing.assert_allclose(found, STATIC / (1 - 0.3**2) / nodes[:, 0], rtol=3e-5)


def pressures_of(result, frame):
    """Mean radii of the elements, and S22 there."""
    mesh = result.mesh(frame.increment)
    middles = [mesh.points[block.data].mean(axis=1)[:, 0] for block in mesh.cells]
    return np.concatenate(middles), result.field("S22", increment=frame.increment)


@pytest.mark.parametrize("options", ["", ", ALPHA=0."])
@pytest.mark.parametrize("material", ["elastic", "rubber"])
def test_dynamic(run_deck, material, options):
    """A sudden pressure: q = q_s (1 - cos wt), and in the material p = 2 mu q/b^2 - rho q'' ln(b/r) = S22.

    From the first increment on: initial accelerations keep the volume, and the pressure jumps. Means over the points of
    an element are within h^2/24 p'' of p in its middle, 0.2 % of the load. The rubber moves little: it is linear but
    for 0.1 %.
    """
    small = 1e-2 if material == "rubber" else 1.0
    law, name = (RUBBER, "*STEP, INC=100, NLGEOM") if material == "rubber" else (ELASTIC, "*STEP, INC=100")
    load = ["*DLOAD", f"FIRST, P4, {small * PRESSURE}"]
    lines, _ = cylinder("CAX8H", law, step=name, static=f"*DYNAMIC{options}, DIRECT\n0.02, 0.4", load=load)
    lines[lines.index("*OUTPUT, FIELD")] = "*OUTPUT, FIELD, FREQUENCY=1"
    result = run_deck(lines)
    q = small * STATIC * (1 - np.cos(CIRCULAR * result.history["time"]))
    np.testing.assert_allclose(result.history["U1[ALL:1]"], q / INNER, atol=2e-3 * small * STATIC)
    frames = [frame for frame in result.frames if frame.time > 0]
    assert len(frames) == 20
    for frame in frames:
        r, found = pressures_of(result, frame)
        phase = np.cos(CIRCULAR * frame.time)
        inertia = DENSITY * CIRCULAR**2 * phase * np.log(OUTER / r)
        expected = STATIC * (2 * SHEAR * (1 - phase) / OUTER**2 - inertia)
        np.testing.assert_allclose(found, small * expected, atol=3e-3 * small * PRESSURE)


def test_initial_velocities_of_an_incompressible_body(run_deck):
    """A ring that grows: r^2 = R^2 + c, r'' = c''/(2r) - c'^2/(4 r^3), and the stress across it begins with zero.

    Without forces on it c'' = c'^2 (1/a^2 - 1/b^2)/(4 ln(b/a)), and p = - rho times the integral of r'' from r to b.
    """
    speed, step = 1.0, "*STEP, NLGEOM"
    lines, nodes = cylinder("CAX8H", RUBBER, step=step, static="*DYNAMIC, DIRECT\n1e-5, 1e-5", load=[], count=24)
    velocities = [f"{k}, 1, {speed / x[0]}" for k, x in enumerate(nodes, start=1)]
    lines[lines.index(step) : lines.index(step)] = ["*INITIAL CONDITIONS, TYPE=VELOCITY", *velocities]
    result = run_deck(lines)
    r, found = pressures_of(result, result.frames[-1])
    rate = 2 * speed
    second = rate**2 * (1 / INNER**2 - 1 / OUTER**2) / (4 * np.log(OUTER / INNER))
    expected = -DENSITY * (second / 2 * np.log(OUTER / r) - rate**2 / 8 * (1 / r**2 - 1 / OUTER**2))
    np.testing.assert_allclose(found, expected, atol=5e-3 * abs(expected).max())


def test_half_increment_residual(run_deck):
    """The increments of *DYNAMIC, HAFTOL follow the closed form, as fixed ones do."""
    lines, _ = cylinder("CAX8H", ELASTIC, static=f"*DYNAMIC, HAFTOL={PRESSURE / 20}\n0.02, 1.", load=LOAD)
    result = run_deck(lines)
    time = result.history["time"]
    assert np.diff(time).max() > 0.02
    q = STATIC * (1 - np.cos(CIRCULAR * time))
    np.testing.assert_allclose(result.history["U1[ALL:1]"], q / INNER, atol=2e-2 * STATIC)


def test_visco(run_deck):
    """Elastic bodies have the response of *STATIC."""
    lines, nodes = cylinder("CAX8H", ELASTIC, static="*VISCO, CETOL=1e-3\n1., 1.", load=LOAD)
    np.testing.assert_allclose(radial(run_deck(lines).history, nodes, "U"), STATIC / nodes[:, 0], rtol=3e-5)


def test_arc_length_has_no_units(run_deck):
    """*STATIC, RIKS measures displacements alone: stiffer rubber takes the same path."""
    paths = []
    for name, stiff in (("soft", 1.0), ("stiff", 1024.0)):
        material = f"*HYPERELASTIC, NEO HOOKE\n{0.7 * stiff}, 0."
        lines = cube("C3D8H", material, (2.0,), static="*STATIC, RIKS\n0.1, 1., 1e-4, 0.25, 1.")
        paths.append(run_deck(lines, name=name).history)
    np.testing.assert_allclose(paths[0]["LPF"], paths[1]["LPF"], rtol=1e-9)
    assert paths[0]["LPF"][-1] >= 1.0
    assert paths[0]["U3[ALL:7]"][-1] == pytest.approx((1 + paths[0]["LPF"][-1]) ** -0.5 - 1, abs=1e-6)


def test_stabilized(run_deck):
    """Viscous forces are on the nodes: the volume is kept."""
    lines = cube("C3D8H", "*HYPERELASTIC, NEO HOOKE\n0.7, 0.", (1.5,), static="*STATIC, STABILIZE=1e-9\n0.1, 1.")
    assert run_deck(lines).history["U3[ALL:7]"][-1] == pytest.approx(1.5**-0.5 - 1, abs=1e-5)


@pytest.mark.parametrize(
    ("keyword", "user"),
    [("*ELASTIC\n3., 0.5", None), ("*USER MATERIAL, CONSTANTS=3, HYBRID FORMULATION=INCOMPRESSIBLE\n0.7, 0., 3", USER)],
)
def test_initial_stress_of_an_incompressible_material(run_deck, keyword, user):
    lines = cube("C3D8H", keyword, (1.1,))
    lines.insert(lines.index("*STEP, NLGEOM"), "*INITIAL CONDITIONS, TYPE=STRESS\nBODY, 1.")
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*TYPE=STRESS beside .* is not supported for .* C3D8H"):
        run_deck(lines, user)
