# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*EXPANSION: free bodies expand without stress, held ones have the stress of theory; temperatures in UMAT."""

from pathlib import Path

import numpy as np
import pytest
from small_decks import body_lines

from uel.errors import DeckError

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
def test_a_free_body_expands_without_stress(run_deck, element_type, options):
    """By alpha dT in every direction; in plane strain by (1 + nu) alpha dT in the plane."""
    history = run_deck(deck(element_type, FREE[element_type], options=options)).history
    plane_strain = element_type.startswith("CPE4")
    strain = ALPHA * WARMER * (1 + NU if plane_strain else 1)
    nodes = CUBE if element_type.startswith("C3D8") else CUBE[:4, :2]
    # large displacements add up the logarithm
    large = bool(options)
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
def test_a_held_body_has_the_stress_of_theory(run_deck, element_type, factor):
    """-E alpha dT/(1 - 2 nu), and /(1 - nu) in plane stress, on the side x = 0 of area 1."""
    history = run_deck(deck(element_type, "ALL, 1, 3")).history
    stress = YOUNG * ALPHA * WARMER * factor
    left = [1, 4] if not element_type.startswith("C3D8") else [1, 4, 5, 8]
    assert sum(history[f"RF1[ALL:{k}]"][-1] for k in left) == pytest.approx(stress)
    # all of the elastic energy, of which no force of the outside does any work
    volume, directions = 1.1, 2 if element_type.startswith("CPS4") else 3
    assert history["ALLSE"][-1] == pytest.approx(0.5 * stress * directions * ALPHA * WARMER * volume)


def test_umat_gets_temperature_field_and_mechanical_strain(run_deck):
    """TEMP and PREDEF at the start of the second increment, their increments, and the mechanical strain."""
    material = "*USER MATERIAL, CONSTANTS=0\n*DEPVAR\n5"
    more = "*INITIAL CONDITIONS, TYPE=FIELD\nALL, 4."
    fields = "*TEMPERATURE\nALL, 70.\n*FIELD\nALL, 8."
    result = run_deck(deck("CPE4", "ALL, 1, 2", material=material, more=more, temperature=fields), UMAT)
    *_, statev = [result.field(f"SDV{k}") for k in range(1, 6)]
    found = [float(np.ravel(result.field(f"SDV{k}"))[0]) for k in range(1, 6)]
    assert found == pytest.approx([45.0, 25.0, 6.0, 2.0, -ALPHA * WARMER])
    assert statev is not None


def coupled(element_type, held, more="", **options):
    """The same with temperatures as unknowns, all of them prescribed."""
    text = deck(element_type, held, temperature="*BOUNDARY\nALL, 11, 11, 70.", **options)
    text = text.replace("*STATIC", "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE")
    return text.replace("*EXPANSION", f"*CONDUCTIVITY\n3.\n{more}*EXPANSION")


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", ["C3D8", "CPS4", "CPE4", "CAX4", "CPS4R"])
def test_elements_with_temperatures_expand_alike(run_deck, element_type, options):
    """Displacements and stresses of elements without them, which are given the same temperatures."""
    held = FREE[element_type]
    plain = run_deck(deck(element_type, held, options=options)).history
    warm = run_deck(coupled(element_type + "T", held, options=options)).history
    for name, values in plain.items():
        if name.startswith(("U", "RF")) and "11[" not in name:
            np.testing.assert_allclose(warm[name], values, rtol=1e-9, atol=1e-8, err_msg=name)


LAMINA = "*ELASTIC, TYPE=LAMINA\n1000., 100., 0.3, 50., 50., 40."
ANGLE = 30.0
ORIENTED = "*ORIENTATION, NAME=O\n{0}, {1}, 0., {2}, {0}, 0.\n3, 0.".format(
    *(f"{value:.17g}" for value in (np.cos(np.radians(ANGLE)), np.sin(np.radians(ANGLE)), -np.sin(np.radians(ANGLE))))
)
STRAINS = {"ORTHO": (1e-5, 4e-5, 7e-5), "ANISO": (1e-5, 4e-5, 7e-5, 3e-5, 0.0, 0.0)}


@pytest.mark.parametrize("kind", STRAINS)
@pytest.mark.parametrize(
    ("element_type", "warm", "options"),
    [("CPS4", deck, ""), ("CPS4", deck, ", NLGEOM"), ("CPS4T", coupled, ""), ("CPS4T", coupled, ", NLGEOM")],
)
def test_a_free_ply_expands_along_its_directions(run_deck, kind, element_type, warm, options):
    """Strains are those of the table, turned by 30 degrees; there is no stress."""
    text = warm(element_type, FREE["CPS4"], material=LAMINA, options=options)
    text = text.replace(f"*EXPANSION\n{ALPHA}", f"*EXPANSION, TYPE={kind}\n{', '.join(map(str, STRAINS[kind]))}")
    text = text.replace("MATERIAL=M", "MATERIAL=M, ORIENTATION=O").replace(
        "*SOLID SECTION", f"{ORIENTED}\n*SOLID SECTION"
    )
    history = run_deck(text).history
    a1, a2, _, a12 = (*STRAINS[kind], 0.0)[:4]
    c, s = np.cos(np.radians(ANGLE)), np.sin(np.radians(ANGLE))
    axes = np.array([[c, s], [-s, c]])
    strain = WARMER * axes.T @ np.array([[a1, a12 / 2], [a12 / 2, a2]]) @ axes
    # held at node 1, and node 2 along y: the strain, and a rotation that keeps the side between them on the x axis
    gradient = strain + strain[0, 1] * np.array([[0, 1], [-1, 0]])
    moved = np.array([nodal(history, f"U{dof}", 4) for dof in (1, 2)]).T
    # with NLGEOM to the second order of the largest strain in the plane
    second = (WARMER * a2) ** 2 if options else 0.0
    np.testing.assert_allclose(moved, CUBE[:4, :2] @ gradient.T, rtol=1e-10, atol=second + 1e-15)
    np.testing.assert_allclose(nodal(history, "RF1", 4), 0.0, atol=1e-9)


def test_coefficients_by_temperature(run_deck):
    """a(T) (T - zero) - a(T0) (T0 - zero) of the Analysis User's Guide; a is linear between 0 and 100."""
    table = "*EXPANSION, ZERO=-10.\n1e-5, 0.\n3e-5, 100."
    for text in (deck("CPS4", FREE["CPS4"]), coupled("CPS4T", FREE["CPS4"])):
        moved = nodal(run_deck(text.replace(f"*EXPANSION\n{ALPHA}", table)).history, "U1", 4)
        strain = 2.4e-5 * 80.0 - 1.4e-5 * 30.0
        np.testing.assert_allclose(moved, strain * CUBE[:4, 0], rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize(("element_type", "even"), [("CPS4", True), ("CPS4T", True), ("CPS4I", False)])
def test_thermal_strain_of_the_mean_in_elements_with_straight_edges(run_deck, element_type, even):
    """A held square that is warmer at x = 1: the stress of the mean of its nodes pushes alike at x = 0 and 1."""
    lines = body_lines(element_type, np.array([[0, 0], [1, 0], [1, 1], [0, 1]]), [range(4)])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", ELASTIC, "*CONDUCTIVITY", "3."]
    lines += ["*EXPANSION", f"{ALPHA}", "*STEP"]
    if element_type.endswith("T"):
        lines += ["*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE", "1., 1.", "*BOUNDARY"]
        lines += ["1, 11", "4, 11", "2, 11, 11, 100.", "3, 11, 11, 100."]
    else:
        lines += ["*STATIC", "1., 1.", "*TEMPERATURE", "2, 100.", "3, 100."]
    lines += ["*BOUNDARY", "ALL, 1, 2", "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "RF", "*END STEP"]
    history = run_deck(lines).history
    along, across = (nodal(history, f"RF{dof}", 4) for dof in (1, 2))
    stress = YOUNG * ALPHA * 50.0 / (1 - NU)
    np.testing.assert_allclose(along, 0.5 * stress * np.array([1, -1, -1, 1]), rtol=1e-9)
    expected = 0.5 * stress * np.array([1, 1, -1, -1])
    if even:
        np.testing.assert_allclose(across, expected, rtol=1e-9)
    else:
        assert np.abs(across - expected).max() > 0.1 * stress


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            "*EXPANSION\n1e-5, 20.\n2e-5, 20.",
            r"deck.inp:\d+: \*EXPANSION: temperature 20 is not above that of the line before, 20",
        ),
        ("*EXPANSION", "needs a data line with the expansion coefficients"),
        ("*EXPANSION, TYPE=ORTHO\n1e-5, 2e-5", "expansion coefficient"),
        ("*EXPANSION\n1e-5, 20., 3.", "expected at most 2"),
        ("*EXPANSION, USER", "option USER is not supported"),
    ],
)
def test_what_is_wrong_is_named(run_deck, given, message):
    with pytest.raises(DeckError, match=message):
        run_deck(deck("CPE4", "ALL, 1, 2").replace(f"*EXPANSION\n{ALPHA}", given))
