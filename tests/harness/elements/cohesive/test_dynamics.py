# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cohesive elements in *DYNAMIC: two masses on a layer, against the operator of Hilber, Hughes and Taylor."""

import numpy as np
import pytest

import harness

STIFFNESS, AREA, MASS, VELOCITY, SIZE = 100.0, 4.0, 0.5, 0.6, 0.02
"""Per area, of the whole layer, of each node on it; velocity at the start; time increment."""
DECK = """*NODE
1, 0., 0.
2, 2., 0.
3, 2., 0.
4, 0., 0.
*NSET, NSET=TOP
3, 4
*ELEMENT, TYPE=COH2D4, ELSET=LAYER
1, 1, 2, 3, 4
*ELEMENT, TYPE=MASS, ELSET=MASSES
2, 3
3, 4
*MASS, ELSET=MASSES
{mass}
*COHESIVE SECTION, ELSET=LAYER, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION
1., 2.
*MATERIAL, NAME=GLUE
*ELASTIC, TYPE=TRACTION
{stiffness}, {stiffness}, {stiffness}
{damage}
*BOUNDARY
1, 1, 2
2, 1, 2
TOP, 1
*INITIAL CONDITIONS, TYPE=VELOCITY
TOP, 2, {velocity}
*STEP, INC=500{nlgeom}
*DYNAMIC, ALPHA={alpha}, DIRECT, NOHAF
{size}, {end}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=TOP
U2, V2
*ENERGY OUTPUT
ALLKE, ALLSE, ALLDMD, ETOTAL
*END STEP
"""


@pytest.fixture
def run(tmp_path):
    def run(alpha, count, *, size=SIZE, damage="", nlgeom=""):
        values = {"mass": MASS, "stiffness": STIFFNESS, "velocity": VELOCITY, "size": size, "end": count * size}
        text = DECK.format(alpha=alpha, damage=damage, nlgeom=nlgeom, **values)
        (tmp_path / "layer.inp").write_text(text.replace("\n\n", "\n"))
        return harness.run(tmp_path / "layer.inp", output_dir=tmp_path).history

    return run


@pytest.mark.parametrize("alpha", [0.0, -0.05, -0.3])
@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
def test_a_mass_on_a_layer(run, alpha, nlgeom):
    """M a_1 + (1 + alpha) K u_1 - alpha K u_0 = 0 with Newmark's formulas; nothing is damaged, compression included."""
    stiffness, count = STIFFNESS * AREA / 2, 40
    beta, gamma = (1 - alpha) ** 2 / 4, 0.5 - alpha
    u, v, a, expected = 0.0, VELOCITY, 0.0, []
    for _ in range(count):
        predicted = u + SIZE * v + SIZE**2 * (0.5 - beta) * a
        after = (alpha * stiffness * u - (1 + alpha) * stiffness * predicted) / (
            MASS + (1 + alpha) * stiffness * beta * SIZE**2
        )
        u, v, a = predicted + SIZE**2 * beta * after, v + SIZE * ((1 - gamma) * a + gamma * after), after
        expected.append((u, v))
    history = run(alpha, count, nlgeom=nlgeom)
    found = np.stack([history["U2[TOP:3]"], history["V2[TOP:3]"]], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-8)
    if alpha == 0.0:
        np.testing.assert_allclose(history["ETOTAL"], MASS * VELOCITY**2, rtol=1e-8)


def test_a_layer_that_breaks_takes_its_fracture_energy(run):
    """By the energy of the masses before: what flies off has the rest of it."""
    toughness = 0.02
    damage = f"*DAMAGE INITIATION, CRITERION=QUADS\n1., 1., 1.\n*DAMAGE EVOLUTION, TYPE=ENERGY\n{toughness}"
    history = run(0.0, 100, size=SIZE / 10, damage=damage)
    lost = history["ALLDMD"][-1]
    assert lost == pytest.approx(toughness * AREA, rel=0.01)
    assert history["ALLKE"][-1] == pytest.approx(MASS * VELOCITY**2 - lost, rel=0.01)
    np.testing.assert_allclose(np.diff(history["V2[TOP:3]"])[-3:], 0.0, atol=1e-12)
