# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*EXPANSION: free bodies expand without stress, held ones have the stress of theory; temperatures in UMAT."""

from pathlib import Path

import numpy as np
import pytest
from small_decks import body_lines

import harness
from harness.errors import DeckError

YOUNG, NU, ALPHA, WARMER = 1000.0, 0.25, 2e-5, 50.0
CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1.2, 0), (1, 1), (0, 1))])
ELASTIC = f"*ELASTIC\n{YOUNG}, {NU}"
UMAT = Path(__file__).with_name("thermal.f")


def deck(element_type, held, *, material=ELASTIC, options="", more="", temperature="*TEMPERATURE\nALL, 70.\n"):
    """A quadrilateral or a hexahedron that warms from 20 to 70 in two increments."""
    nodes = CUBE if element_type.startswith("C3D") else CUBE[:4, :2]
    lines = body_lines(element_type, nodes, [range(len(nodes))])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", material, "*EXPANSION", f"{ALPHA}"]
    lines += [
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE",
        "ALL, 20.",
        more,
        f"*STEP{options}",
        "*STATIC",
        "0.5, 1., 0.5, 0.5",
    ]
    lines += ["*BOUNDARY", held, temperature.strip(), "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF"]
    lines += ["*ENERGY OUTPUT", "*OUTPUT, FIELD", "*ELEMENT OUTPUT", "SDV", "*END STEP", ""]
    return "\n".join(line for line in lines if line) + "\n"


@pytest.fixture
def run(tmp_path):
    def run(text, user=None):
        (tmp_path / "warm.inp").write_text(text)
        return harness.run(tmp_path / "warm.inp", user, output_dir=tmp_path)

    return run


def nodal(history, name, nodes):
    return np.array([history[f"{name}[ALL:{k}]"][-1] for k in range(1, nodes + 1)])


FREE = {
    "C3D8": "1, 1, 3\n2, 2, 3\n4, 3\n",
    "CPS4": "1, 1, 2\n2, 2\n",
    "CPE4": "1, 1, 2\n2, 2\n",
    "CAX4": "1, 1, 2\n2, 2\n",
    "CAX4R": "1, 1, 2\n2, 2\n",
    "CPS4R": "1, 1, 2\n2, 2\n",
    "C3D8I": "1, 1, 3\n2, 2, 3\n4, 3\n",
    "CPS4I": "1, 1, 2\n2, 2\n",
    "CPE4I": "1, 1, 2\n2, 2\n",
}


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", FREE)
def test_a_free_body_expands_without_stress(run, element_type, options):
    """By alpha dT in every direction; in plane strain by (1 + nu) alpha dT in the plane."""
    history = run(deck(element_type, FREE[element_type], options=options)).history
    plane_strain = element_type.startswith("CPE4")
    strain = ALPHA * WARMER * (1 + NU if plane_strain else 1)
    nodes = CUBE if element_type.startswith("C3D8") else CUBE[:4, :2]
    # large displacements add up the logarithm, but strains beside incompatible modes are small ones
    large = bool(options) and not element_type.endswith("I")
    strain = np.expm1(strain) if large else strain
    for dof in range(nodes.shape[1]):
        moved = nodal(history, f"U{dof + 1}", len(nodes))
        np.testing.assert_allclose(moved, strain * nodes[:, dof], rtol=2e-6, atol=1e-15)
        np.testing.assert_allclose(nodal(history, f"RF{dof + 1}", len(nodes)), 0.0, atol=1e-9)
    # in plane strain the stress through the thickness stores energy, with NLGEOM in the present volume
    volume = 1.1 * (1 + strain) ** 2 if large else 1.1
    stored = 0.5 * YOUNG * (ALPHA * WARMER) ** 2 * volume if plane_strain else 0.0
    assert history["ALLSE"][-1] == pytest.approx(stored, rel=1e-4, abs=1e-15)


@pytest.mark.parametrize(
    ("element_type", "factor"),
    [
        *[(name, 1 / (1 - 2 * NU)) for name in ("C3D8", "C3D8I", "CPE4", "CPE4I")],
        *[(name, 1 / (1 - NU)) for name in ("CPS4", "CPS4I")],
    ],
)
def test_a_held_body_has_the_stress_of_theory(run, element_type, factor):
    """-E alpha dT/(1 - 2 nu), and /(1 - nu) in plane stress, on the side x = 0 of area 1."""
    history = run(deck(element_type, "ALL, 1, 3")).history
    stress = YOUNG * ALPHA * WARMER * factor
    left = [1, 4] if not element_type.startswith("C3D8") else [1, 4, 5, 8]
    assert sum(history[f"RF1[ALL:{k}]"][-1] for k in left) == pytest.approx(stress)
    # all of the elastic energy, of which no force of the outside does any work
    volume, directions = 1.1, 2 if element_type.startswith("CPS4") else 3
    assert history["ALLSE"][-1] == pytest.approx(0.5 * stress * directions * ALPHA * WARMER * volume)


def test_umat_gets_temperature_field_and_mechanical_strain(run):
    """TEMP and PREDEF at the start of the second increment, their increments, and the mechanical strain."""
    material = "*USER MATERIAL, CONSTANTS=0\n*DEPVAR\n5"
    more = "*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4."
    fields = "*TEMPERATURE\nALL, 70.\n*FIELD\nALL, 8."
    result = run(deck("CPE4", "ALL, 1, 2", material=material, more=more, temperature=fields), UMAT)
    *_, statev = [result.field(f"SDV{k}") for k in range(1, 6)]
    found = [float(np.ravel(result.field(f"SDV{k}"))[0]) for k in range(1, 6)]
    assert found == pytest.approx([45.0, 25.0, 6.0, 2.0, -ALPHA * WARMER])
    assert statev is not None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            deck("CPE4", "ALL, 1, 2").replace("TYPE=CPE4", "TYPE=CPE4T"),
            r"warm.inp:\d+: \*EXPANSION \(material M\) is not supported for elements of type CPE4T",
        ),
        (deck("CPE4", "ALL, 1, 2").replace("*EXPANSION", "*EXPANSION, ZERO=20."), "option ZERO is not supported"),
        (
            deck("CPE4", "ALL, 1, 2").replace(f"{ALPHA}", "1e-5, 20."),
            "needs one data line with the expansion coefficient",
        ),
    ],
)
def test_what_is_wrong_is_named(run, text, message):
    with pytest.raises(DeckError, match=message):
        run(text)
