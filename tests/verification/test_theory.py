# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Beam theory against hand-worked numbers and against itself."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.theory import (
    Arms,
    dcb_compliance,
    dcb_crack,
    dcb_curve,
    dcb_displacement,
    dcb_elastica,
    dcb_load,
    enf_load,
    frmm_load,
    mmb_mode_mix,
)

ARMS = Arms(width=20.0, height=1.55, e11=PLY_0.e1, e22=PLY_0.e2, g12=PLY_0.g12)
G_1, G_2 = TABLE_2.toughness_1, TABLE_2.toughness_2


def test_dcb_by_hand() -> None:
    # Gamma = 1.18 sqrt(1.2e5 1.05e4)/5.52e3 = 7.588; chi = sqrt(1.976 (3 - 2 0.7807)) = 1.686;
    # P = sqrt(20 7.4478e5 0.26)/(35 + 2.614) = 1967.9/37.614
    assert ARMS.chi == pytest.approx(1.686, abs=5e-4)
    assert ARMS.bending_stiffness == pytest.approx(7.4478e5, rel=1e-4)
    assert dcb_load(ARMS, 35.0, G_1) == pytest.approx(52.3, abs=0.05)


def test_mode_2_and_mixed_mode_by_hand() -> None:
    # 4 20 sqrt(1.55^3 1.2e5 1.002)/(3 (35 + 0.42 2.614)) = 53534/108.29
    assert enf_load(ARMS, 35.0, G_2) == pytest.approx(494.3, abs=0.5)
    # sqrt(20 7.4478e5/(37.614^2/1.04 + 3 36.098^2/16.032)) = sqrt(1.48956e7/(1360.4 + 243.8))
    assert frmm_load(ARMS, 35.0, G_1, G_2) == pytest.approx(96.4, abs=0.1)


def test_mode_mix_of_mixed_mode_bending() -> None:
    """The levers of NASA/CR-2012-217562, whose ratios are those of virtual crack closure in plane strain."""
    e1, e2 = 161000.0, 11380.0
    arms = Arms(width=25.4, height=2.25, e11=e1 / (1.0 - 0.32**2 * e2 / e1), e22=e2 / (1.0 - 0.45**2), g12=5200.0)
    for lever, mix in ((92.9, 0.2), (41.3, 0.5), (27.3, 0.8)):
        assert mmb_mode_mix(arms, 25.4, 50.4, lever) == pytest.approx(mix, abs=0.01)


def test_energy_release_rate_is_the_derivative_of_the_compliance() -> None:
    # Irwin-Kies: G_I = P^2/(2 B) d(2 Delta/P)/da
    step, load = 1e-3, dcb_load(ARMS, 50.0, G_1)
    slope = (dcb_compliance(ARMS, 50.0 + step) - dcb_compliance(ARMS, 50.0 - step)) / (2.0 * step)
    assert load**2 / (2.0 * ARMS.width) * 2.0 * slope == pytest.approx(G_1, rel=1e-8)


def test_dcb_curve_is_the_parametric_one() -> None:
    for crack in (35.0, 42.0, 60.0):
        end = dcb_displacement(ARMS, crack, G_1)
        assert dcb_curve(ARMS, 35.0, G_1, np.array([end]))[0] == pytest.approx(dcb_load(ARMS, crack, G_1), rel=1e-12)
    onset = dcb_displacement(ARMS, 35.0, G_1)
    half = dcb_curve(ARMS, 35.0, G_1, np.array([0.0, 0.5 * onset]))
    assert half == pytest.approx([0.0, 0.5 * dcb_load(ARMS, 35.0, G_1)], rel=1e-12)


def test_crack_from_compliance() -> None:
    assert dcb_crack(ARMS, dcb_compliance(ARMS, 47.0)) == pytest.approx(47.0, rel=1e-12)


def test_elastica_with_small_rotations() -> None:
    """P = sqrt(G B EI)/a and opening/2 = P a^3/(3 EI); with t0 = P a^2/(2 EI) the first neglected term is 0.4 t0^2."""
    bending, width = 7.4478e5, 20.0
    load, length = dcb_elastica(bending, G_1, width, 0.5)
    assert load == pytest.approx(np.sqrt(G_1 * width * bending) / length, rel=1e-3)
    assert pytest.approx(load * length**3 / (3 * bending), rel=1e-3) == 0.25


def test_elastica_by_integration_along_the_arm() -> None:
    """EI theta'' = -P cos(theta) from the clamped end, with the moment sqrt(G B EI), to the end without one."""
    bending, width, opening = 50000.0 * 0.4**3 / 12, 1.0, 9.0
    load, length = dcb_elastica(bending, 0.5, width, opening)
    start = [0.0, np.sqrt(0.5 * width / bending), 0.0]
    arm = solve_ivp(
        lambda _, y: [y[1], -load * np.cos(y[0]) / bending, np.sin(y[0])], (0.0, length), start, rtol=1e-10, atol=1e-12
    )
    angle, curvature, rise = arm.y[:, -1]
    assert curvature == pytest.approx(0.0, abs=1e-8)
    assert 2 * rise == pytest.approx(opening, rel=1e-8)
    assert 2 * load * np.sin(angle) == pytest.approx(0.5, rel=1e-8)
    # the value of abaqus_inputs/dcb_elastica
    assert (load, opening / length) == (pytest.approx(0.670777, rel=1e-6), pytest.approx(0.5026, rel=1e-4))
