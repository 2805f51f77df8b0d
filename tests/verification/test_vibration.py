# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of built-in elements in dynamic steps and with large displacements, against beam theory."""

import numpy as np
import pytest

import uel

LENGTH, HEIGHT, E, DENSITY = 20.0, 0.5, 1000.0, 3.0
INERTIA = HEIGHT**3 / 12


def beam(steps, *, count=10):
    """Deck of a cantilever of CPS8R elements, of width 1."""
    x = np.linspace(0, LENGTH, 2 * count + 1)
    lines = ["*NODE"]
    number = {}
    for i, a in enumerate(x.tolist()):
        for j in range(3):
            if i % 2 and j == 1:
                continue
            number[i, j] = len(number) + 1
            lines.append(f"{number[i, j]}, {a!r}, {j * HEIGHT / 2!r}")
    lines.append("*ELEMENT, TYPE=CPS8R, ELSET=BEAM")
    for k in range(count):
        i = 2 * k
        corners = [(i, 0), (i + 2, 0), (i + 2, 2), (i, 2), (i + 1, 0), (i + 2, 1), (i + 1, 2), (i, 1)]
        lines.append(", ".join(map(str, [k + 1, *(number[place] for place in corners)])))
    root = [number[0, j] for j in range(3)]
    lines += ["*NSET, NSET=ROOT", ", ".join(map(str, root)), "*NSET, NSET=TIP", f"{number[2 * count, 1]}"]
    lines += ["*SOLID SECTION, ELSET=BEAM, MATERIAL=M", "*MATERIAL, NAME=M", "*ELASTIC", f"{E}, 0."]
    lines += ["*DENSITY", f"{DENSITY}", "*BOUNDARY", "ROOT, 1, 2", steps, ""]
    return "\n".join(lines)


HISTORY = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=TIP\nU2, V2, A2\n*ENERGY OUTPUT\nALLKE, ALLIE, ALLWK, ETOTAL"


def test_period_and_energy_of_a_cantilever_let_go(tmp_path):
    """Bent by a force and let go: the period of its first mode, 2 pi L^2/1.8751^2 sqrt(rho A/(E I))."""
    period = 2 * np.pi * LENGTH**2 / 1.87510**2 * np.sqrt(DENSITY * HEIGHT / (E * INERTIA))
    size = float(period) / 64
    steps = (
        f"*STEP\n*STATIC\n*CLOAD\nTIP, 2, 1e-3\n{HISTORY}\n*END STEP\n"
        f"*STEP\n*DYNAMIC, ALPHA=0., DIRECT\n{size!r}, {64 * size!r}\n*CLOAD, OP=NEW\n{HISTORY}\n*END STEP"
    )
    (tmp_path / "beam.inp").write_text(beam(steps))
    history = uel.run(tmp_path / "beam.inp", output_dir=tmp_path).history
    u, time = history["U2[TIP]"][1:], history["time"][1:] - 1.0
    assert len(u) == 64
    static = 1e-3 * LENGTH**3 / (3 * E * INERTIA)
    assert history["U2[TIP]"][0] == pytest.approx(static, rel=0.005)
    # a quarter and three quarters of the period pass zero, the end is near the start
    crossings = time[:-1][u[:-1] * u[1:] < 0]
    assert crossings / period == pytest.approx([0.25, 0.75], abs=0.02)
    assert u[-1] == pytest.approx(static, rel=0.03)
    # without load and damping the energy stays that of the bent beam
    total = history["ALLKE"] + history["ALLIE"]
    assert total[1:] == pytest.approx(0.5e-3 * static, rel=0.005)
    assert np.ptp(total[1:]) < 1e-9 * total[1]
    # all of it is kinetic once in between
    assert history["ALLKE"].max() == pytest.approx(total[1], rel=0.05)


def test_large_bending_of_a_cantilever(tmp_path):
    """P L^2/(E I) = 1: the tip goes down by 0.30172 L and back by 0.05643 L (K.E. Bisshopp, D.C. Drucker, Quarterly of
    Applied Mathematics 3 (1945) 272; K. Mattiasson, Int. J. for Numerical Methods in Engineering 17 (1981) 145).
    """
    force = E * INERTIA / LENGTH**2
    steps = (
        f"*STEP, NLGEOM\n*STATIC\n0.1, 1., 1e-5, 0.1\n*CLOAD\nTIP, 2, {force!r}\n"
        "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=TIP\nU1, U2\n*END STEP"
    )
    (tmp_path / "bend.inp").write_text(beam(steps))
    history = uel.run(tmp_path / "bend.inp", output_dir=tmp_path).history
    assert history["U2[TIP]"][-1] / LENGTH == pytest.approx(0.30172, rel=0.01)
    assert -history["U1[TIP]"][-1] / LENGTH == pytest.approx(0.05643, rel=0.02)


def test_a_bar_of_hexahedra_in_a_dynamic_step(tmp_path):
    """A bar of C3D8R under a sudden end load swings to twice the static extension (nu = 0; one element: one mode)."""
    deck = """*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*NSET, NSET=ROOT
1, 4, 5, 8
*NSET, NSET=TIP
2, 3, 6, 7
*ELEMENT, TYPE=C3D8R, ELSET=BAR
1, 1, 2, 3, 4, 5, 6, 7, 8
*SOLID SECTION, ELSET=BAR, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DENSITY
2.
*BOUNDARY
ROOT, 1, 3
TIP, 2, 3
*STEP, INC=1000
*DYNAMIC, ALPHA=0., DIRECT
0.001, 0.2
*CLOAD
TIP, 1, 2.5
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=TIP
U1, A1
*END STEP
"""
    (tmp_path / "bar.inp").write_text(deck)
    history = uel.run(tmp_path / "bar.inp", output_dir=tmp_path).history
    # half of the mass 2 at the tip, stiffness E A/L = 1000, force 10
    angle = 2 * np.arctan(np.sqrt(1000.0) * 0.001 / 2) * np.arange(1, 201)
    column = next(name for name in history if name.startswith("U1[TIP"))
    assert history[column] == pytest.approx(0.01 * (1 - np.cos(angle)), abs=1e-9)
