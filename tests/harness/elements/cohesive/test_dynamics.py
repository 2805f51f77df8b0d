# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cohesive elements in *DYNAMIC: two masses on a layer, against the operator of Hilber, Hughes and Taylor."""

from dataclasses import replace

import numpy as np
import pytest

from uel.elements import Request

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
{mass}
*COHESIVE SECTION, ELSET=LAYER, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION, THICKNESS=SPECIFIED
{thickness}, 2.
*MATERIAL, NAME=GLUE
*ELASTIC, TYPE=TRACTION
{modulus}, {modulus}, {modulus}
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
MASSES = f"*ELEMENT, TYPE=MASS, ELSET=MASSES\n2, 3\n3, 4\n*MASS, ELSET=MASSES\n{MASS}"


@pytest.fixture
def run_layer(run_deck):
    def run_layer(alpha, count, *, size=SIZE, damage="", nlgeom="", mass=MASSES, thickness=1.0):
        values = {"modulus": STIFFNESS * thickness, "velocity": VELOCITY, "size": size, "end": count * size}
        values |= {"mass": mass, "thickness": thickness}
        text = DECK.format(alpha=alpha, damage=damage, nlgeom=nlgeom, **values)
        return run_deck(text.replace("\n\n", "\n")).history

    return run_layer


@pytest.mark.parametrize("alpha", [0.0, -0.05, -0.3])
@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
@pytest.mark.parametrize("own", [0.0, 1.0, 0.5])
def test_a_mass_on_a_layer(run_layer, alpha, nlgeom, own):
    """The mass of nodes, or that of the layer of this constitutive thickness: half of it, as the other half is held.

    M a_1 + (1 + alpha) K u_1 - alpha K u_0 = 0 with Newmark's formulas; nothing is damaged, compression included."""
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
    given = {"nlgeom": nlgeom}
    if own:
        # both nodes on top have a quarter of density times thickness times area each
        given |= {"damage": f"*DENSITY\n{4 * MASS / (AREA * own)}", "mass": "", "thickness": own}
    history = run_layer(alpha, count, **given)
    found = np.stack([history["U2[TOP:3]"], history["V2[TOP:3]"]], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-8)
    if alpha == 0.0:
        np.testing.assert_allclose(history["ETOTAL"], MASS * VELOCITY**2, rtol=1e-8)


def test_a_layer_that_breaks_takes_its_fracture_energy(run_layer):
    """By the energy of the masses before: what flies off has the rest of it."""
    toughness = 0.02
    damage = f"*DAMAGE INITIATION, CRITERION=QUADS\n1., 1., 1.\n*DAMAGE EVOLUTION, TYPE=ENERGY\n{toughness}"
    history = run_layer(0.0, 100, size=SIZE / 10, damage=damage)
    lost = history["ALLDMD"][-1]
    assert lost == pytest.approx(toughness * AREA, rel=0.01)
    assert history["ALLKE"][-1] == pytest.approx(MASS * VELOCITY**2 - lost, rel=0.01)
    np.testing.assert_allclose(np.diff(history["V2[TOP:3]"])[-3:], 0.0, atol=1e-12)


@pytest.mark.parametrize("element_type", ["COH2D4", "COH3D6", "COH3D8"])
@pytest.mark.parametrize(("thickness", "gap"), [(1.0, 0.0), (0.25, 0.0), (0.0, 0.3)])
def test_mass_matrix(layer, element_type, thickness, gap):
    """Density times constitutive thickness per area, that between the faces where it is that of the nodes.

    By equal halves at the nodes of both faces (Analysis User's Guide, Defining the constitutive response of cohesive
    elements using a traction-separation description: "the density represents mass per unit area", for the thickness 1).
    """
    density = 7.0
    made = layer(element_type, thickness=thickness, gap=gap, density=density)
    made.call = replace(made.call.asking(Request.MASS))
    made.evaluate(np.zeros(made.coordinates.size))
    mass = made.matrix.toarray()
    each = density * (thickness or gap) * made.area / len(made.coordinates)
    np.testing.assert_allclose(mass, each * np.eye(len(mass)), atol=1e-12 * each)
