# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HYPERELASTIC with *EXPANSION and in coupled temperature-displacement elements.

The law sees F over the stretch of the free expansion (Abaqus Analysis User's Guide, Hyperelastic behavior of rubberlike
materials: the elastic volume ratio is J over that of the expansion).
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from differences import differences
from reference_cells import unit_cell
from small_decks import body_lines

from uel.elements import Flags
from uel.errors import DeckError, Source
from uel.model.element_types import COUPLED
from uel.model.mesh import ElementGroup
from uel.model.properties import (
    Expansion,
    Holzapfel,
    Hyperelastic,
    Material,
    Orientation,
    Potential,
    SolidSection,
    UserPotential,
)

SOURCE = Source("test.inp", 1)
ALPHA, WARMER, C10, D = 1e-3, 50.0, 0.7, 0.4
STRETCH = 1 + ALPHA * WARMER
CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1.2, 0), (1, 1), (0, 1))])
UHYPER = Path(__file__).with_name("potential.f90")
NEO_HOOKE = f"*HYPERELASTIC, NEO HOOKE\n{C10}, {D}"


def deck(element_type, held, *, law=NEO_HOOKE):
    """A quadrilateral or a hexahedron that warms by 50."""
    nodes = CUBE if element_type.startswith("C3D") else CUBE[:4, :2]
    lines = body_lines(element_type, nodes, [range(len(nodes))])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", law, "*EXPANSION", f"{ALPHA}"]
    coupled = element_type in COUPLED
    if coupled:
        lines += ["*CONDUCTIVITY", "1."]
    lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 20.", "*STEP, NLGEOM"]
    lines += ["*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE" if coupled else "*STATIC", "0.5, 1., 0.5, 0.5"]
    lines += ["*BOUNDARY", held.strip(), "ALL, 11, 11, 70." if coupled else "*TEMPERATURE\nALL, 70."]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF", "*ENERGY OUTPUT", "*OUTPUT, FIELD"]
    return "\n".join([*lines, "*ELEMENT OUTPUT", "S", "*END STEP"]) + "\n"


SOLIDS = ["C3D8", "C3D8R", "C3D8H", "C3D8T", "C3D8RT", "C3D4"]
ROUND = ["CAX4", "CAX4H", "CAX4T"]


@pytest.mark.parametrize("element_type", [*SOLIDS[:-1], *ROUND])
def test_a_free_body_expands_without_stress(run_deck, element_type):
    """By the stretch of the expansion in every direction."""
    solid = element_type.startswith("C3D")
    result = run_deck(deck(element_type, "1, 1, 3\n2, 2, 3\n4, 3" if solid else "1, 1, 2\n2, 2\n4, 1"))
    nodes = CUBE if solid else CUBE[:4, :2]
    for dof in range(nodes.shape[1]):
        moved = [result.history[f"U{dof + 1}[ALL:{k + 1}]"][-1] for k in range(len(nodes))]
        np.testing.assert_allclose(moved, (STRETCH - 1) * nodes[:, dof], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(result.field("S11"), 0.0, atol=1e-7)


@pytest.mark.parametrize("element_type", [*SOLIDS, "CPE4", "CPE4H", "CPE4T"])
def test_a_held_body_has_the_pressure_of_its_law(run_deck, element_type):
    """U = (J - 1)^2 / D, of the volume before the expansion, at J = 1 over the change of volume of the expansion."""
    nodes = CUBE[[0, 1, 3, 4]] if element_type == "C3D4" else CUBE
    text = deck(element_type, "ALL, 1, 3")
    if element_type == "C3D4":
        text = text.replace(
            "\n".join(body_lines("C3D4", CUBE, [range(8)])), "\n".join(body_lines("C3D4", nodes, [range(4)]))
        )
    result = run_deck(text)
    j = STRETCH**-3
    for component in ("S11", "S22", "S33"):
        np.testing.assert_allclose(result.field(component), 2 / D * (j - 1) * j, rtol=1e-7)
    volume = 1.2 / 6 if element_type == "C3D4" else 1.1
    assert result.history["ALLSE"][-1] == pytest.approx((j - 1) ** 2 / D * volume, rel=1e-7)


def test_uhyper_is_the_law_of_the_deck(run_deck):
    """While a warm block is pulled: forces in a coupled step."""
    user = f"*HYPERELASTIC, USER, TYPE=COMPRESSIBLE, PROPERTIES=5\n{C10}, 0., {D}, 0., 0."
    held = "1, 1, 3\n4, 1\n5, 1\n8, 1\n2, 2, 3\n4, 3\n2, 1, 1, 0.3\n3, 1, 1, 0.4\n6, 1, 1, 0.5\n7, 1, 1, 0.2"
    expected = run_deck(deck("C3D8T", held)).history
    found = run_deck(deck("C3D8T", held, law=user), UHYPER).history
    largest = max(abs(expected[f"RF1[ALL:{k}]"][-1]) for k in (1, 4, 5, 8))
    assert largest > 0.1
    for name, values in expected.items():
        if name.startswith("RF") and "RFL" not in name:
            np.testing.assert_allclose(found[name], values, rtol=1e-9, atol=1e-9 * largest, err_msg=name)


@pytest.mark.parametrize(
    ("law", "what"),
    [
        (NEO_HOOKE, r"\*HYPERELASTIC"),
        (f"*HYPERELASTIC\n{C10}, 0., 0.", r"\*HYPERELASTIC with D1 = 0"),
    ],
)
def test_hybrid_elements_with_temperatures_have_no_pressure_of_their_own(run_deck, law, what):
    message = rf"deck\.inp:\d+: {what} is not supported for elements of type C3D8HT \(material M"
    with pytest.raises(DeckError, match=message):
        run_deck(deck("C3D8HT", "1, 1, 3", law=law))


LAWS = {
    "coefficients": Hyperelastic(Potential.MOONEY_RIVLIN, 1, (0.5, 0.2), (D,), SOURCE),
    "fibres": Holzapfel((0.5, D, 0.3, 0.2, 0.1), 2, SOURCE),
    "UHYPER": UserPotential(np.array([0.5, 0.2, D, 0.05, 0.02]), SOURCE),
}
TANGENTS = [*((name, "coefficients") for name in ("CPE4T", "CPE4RT", "CPE8T", "CAX4T", "C3D8RT", "C3D4T", "C3D20RT"))]
TANGENTS += [("C3D8T", name) for name in LAWS]


@pytest.mark.parametrize(("element_type", "law"), TANGENTS)
def test_tangent_is_the_derivative_of_the_residual(load, bound, call, element_type, law):
    """Of a distorted element that is strained and warm; what heat changes by as the shape does is left out.

    C3D8RT is strained alike everywhere, for its tangent is that of the hourglass control without hourglass forces.
    """
    kind = COUPLED[element_type]
    random = np.random.default_rng(5)
    nodes = unit_cell(kind.family.cell)[0]
    nodes = nodes + 0.05 * random.uniform(-1, 1, nodes.shape) + 0.1
    expansion = Expansion(
        np.array([[0.0, 0.02, 0.02, 0.02, 0.0, 0.0, 0.0], [4.0, *[0.05] * 3, 0.0, 0.0, 0.0]]), 0.0, SOURCE
    )
    heat = {"conductivity": np.array([[3.0, 0.0]]), "specific_heat": np.array([[0.7, 0.0]]), "density": 2.0}
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0] if law == "fibres" else np.eye(3)
    orientation = Orientation("O", axes, SOURCE, local=np.eye(3)[:2])
    material = Material("M", SOURCE, hyperelastic=LAWS[law], expansion=expansion, **heat)
    section = SolidSection("ALL", material, orientation, 0.5, SOURCE, hourglass=1.0)
    group = ElementGroup(element_type, np.array([101]), np.arange(kind.nodes)[None], "", section, None, SOURCE)
    block, matrix = bound(group, nodes, load("potential.f90"))
    call = replace(call, flags=Flags(72, nlgeom=True), unsymmetric=True)
    used = np.array([11 * node + dof - 1 for node, dof in block.unknowns])
    thermal = np.array([dof for _, dof in block.unknowns]) == 11
    u, n = np.zeros(matrix.shape[0]), matrix.shape[0]
    u[used] = random.uniform(-0.1, 0.1, len(used))
    if element_type == "C3D8RT":
        u[used[~thermal]] = (nodes @ random.uniform(-0.1, 0.1, (3, 3))).ravel()
    u[used[thermal]] += 2.0
    du = 0.3 * u
    block.evaluate(call, u, du, np.zeros(n), matrix.data)
    found = matrix.toarray()[np.ix_(used, used)]
    difference = differences(block, call, u, du, used, 1e-5)
    rows = np.ones((len(used), len(used)), dtype=bool)
    rows[np.ix_(thermal, ~thermal)] = False
    np.testing.assert_allclose(found[rows], difference[rows], atol=1e-7 * abs(found[rows]).max())
    assert abs(found[np.ix_(~thermal, thermal)]).max() > 1e-3
