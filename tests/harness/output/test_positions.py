# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*EL PRINT, POSITION=: tables laid out as in a public .dat file of Abaqus, of a plane strain patch test; values of
fields that vary in the elements."""

import re
from pathlib import Path

import numpy as np
import pytest
from reference_cells import CORNERS, nodes_of, shape_of

import uel
from uel.elements.extrapolation import at_centroid, at_nodes
from uel.model.element_types import CONTINUUM, COUPLED

PATCH = """*NODE, NSET=ALL
10, 0., 0.
20, 0.24, 0.
30, 0.24, 0.12
40, 0., 0.12
50, 0.1, 0.
60, 0.14, 0.12
*ELEMENT, TYPE={type}, ELSET=EALL
1, 10, 50, 60, 40
2, 50, 20, 30, 60
*ELSET, ELSET=FIRST
1
*SOLID SECTION, ELSET=EALL, MATERIAL=A
0.001
*MATERIAL, NAME=A
*ELASTIC
1.E6, 0.25
*STEP
*STATIC
1., 1.
*BOUNDARY
10, 1, 2
20, 1, 1, 0.24E-3
20, 2, 2, 0.12E-3
30, 1, 1, 0.3E-3
30, 2, 2, 0.24E-3
40, 1, 1, 0.06E-3
40, 2, 2, 0.12E-3
50, 1, 1, 0.1E-3
50, 2, 2, 0.05E-3
60, 1, 1, 0.2E-3
60, 2, 2, 0.19E-3
{request}
S
*END STEP
"""


@pytest.fixture
def table(run_deck, tmp_path):
    def table(request, type="CPE4"):
        run_deck(PATCH.format(type=type, request=request))
        text = (tmp_path / "deck.dat").read_text()
        assert text.count("THE FOLLOWING TABLE") == 1
        return [line.rstrip() for line in text[text.index("   THE FOLLOWING") :].splitlines()]

    return table


VALUES = "      1600.       1600.       800.0       400.0"


def test_a_table_at_the_nodes_of_the_elements(table):
    """Strains 1e-3, 1e-3, shear 1e-3 with E = 1e6, nu = 0.25: S11 = S22 = 1600, S33 = 800, S12 = 400."""
    found = table("*EL PRINT, POSITION=NODES")
    assert found[:13] == [
        "   THE FOLLOWING TABLE IS PRINTED FOR ALL ELEMENTS WITH TYPE CPE4 AT THE NODES",
        "",
        "    ELEMENT         ND   FOOT-   S11         S22         S33         S12",
        "                         NOTE",
        "",
        *(f"           1{node:11d}    {VALUES}" for node in (10, 50, 60, 40)),
        *(f"           2{node:11d}    {VALUES}" for node in (50, 20, 30, 60)),
    ]
    assert found[14] == " MAXIMUM            " + VALUES
    assert found[15].startswith(" ELEMENT                         ")
    assert found[15][33:34] in "12" and found[15][45:46] in "12"


def test_a_table_of_averages_at_the_nodes(table):
    found = table("*EL PRINT, POSITION=AVERAGED AT NODES")
    assert found[:11] == [
        "   THE FOLLOWING TABLE IS PRINTED FOR ALL ELEMENTS WITH TYPE CPE4 AVERAGED AT THE NODES",
        "",
        "       NODE  FOOT-   S11         S22         S33         S12",
        "             NOTE",
        "",
        *(f"{node:12d}  {VALUES}" for node in (10, 20, 30, 40, 50, 60)),
    ]
    assert found[12] == " MAXIMUM     " + VALUES
    assert re.fullmatch(r"  NODE {16}\d\d {10}\d\d {10}\d\d {10}\d\d", found[13])


@pytest.mark.parametrize("position", ["CENTROIDAL", "CENTROID"])
def test_a_table_at_the_centroid(table, position):
    found = table(f"*EL PRINT, ELSET=FIRST, POSITION={position}")
    assert found[:10] == [
        "   THE FOLLOWING TABLE IS PRINTED FOR ELEMENTS WITH TYPE CPE4 AT THE CENTROID OF THE ELEMENT AND BELONGING TO "
        "ELEMENT SET FIRST",
        "",
        "    ELEMENT  FOOT-   S11         S22         S33         S12",
        "             NOTE",
        "",
        f"           1  {VALUES}",
        "",
        f" MAXIMUM     {VALUES}",
        " ELEMENT                  1           1           1           1",
        "",
    ]


def test_elements_of_other_types_have_values_at_the_points_and_a_warning(tmp_path):
    deck = tmp_path / "user.inp"
    deck.write_text(
        "*NODE\n1, 0.\n2, 1.\n*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=1\n1\n"
        "*ELEMENT, TYPE=U1, ELSET=ALL\n1, 1, 2\n*UEL PROPERTY, ELSET=ALL\n1.\n"
        "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n*EL PRINT, POSITION=NODES\nSDV\n*END STEP\n"
    )
    spring = Path(__file__).parents[1] / "elements" / "spring.f"
    uel.run(deck, spring, output_dir=tmp_path)
    text = " ".join((tmp_path / "user.dat").read_text().split())
    assert "TABLE IS PRINTED FOR ALL ELEMENTS WITH TYPE U1 AT THE INTEGRATION POINTS" in text
    warning = "*EL PRINT, POSITION=NODES: ELEMENTS OF TYPE U1 HAVE VALUES AT THE INTEGRATION POINTS ONLY"
    assert warning in text


@pytest.mark.parametrize("type", sorted(CONTINUUM | COUPLED))
def test_a_field_that_the_points_resolve_is_exact_at_nodes_and_centroid(type):
    """Gauss points: 1, linear in each direction, or quadratic; in Abaqus' order, along the first direction first."""
    kind = (CONTINUUM | COUPLED)[type]
    shape = shape_of(kind.family.cell)
    triangle = np.array([[1, 1], [4, 1], [1, 4]]) / 6
    # degree in each direction, and the points
    near, far = (5 - 5**0.5) / 20, (5 + 3 * 5**0.5) / 20
    known = {
        ("triangle", 3): ([1, 1], triangle),
        ("tetra", 4): ([1, 1, 1], np.vstack([np.full(3, near), np.full((3, 3), near) + (far - near) * np.eye(3)])),
        ("wedge", 2): ([0, 0, 1], np.array([[1 / 3, 1 / 3, z] for z in (-(3**-0.5), 3**-0.5)])),
        ("wedge", 9): ([1, 1, 2], np.array([[*place, z] for z in (-(0.6**0.5), 0.0, 0.6**0.5) for place in triangle])),
    }
    if kind.points == 1:
        degrees, points = [0] * kind.dimension, CORNERS[shape].mean(axis=0, keepdims=True)
    elif (shape, kind.points) in known:
        degrees, points = known[shape, kind.points]
    else:
        along = round(kind.points ** (1 / kind.dimension))
        degrees, line = [along - 1] * kind.dimension, np.polynomial.legendre.leggauss(along)[0]
        grids = np.meshgrid(*[line] * kind.dimension, indexing="ij")
        points = np.stack([grid.ravel(order="F") for grid in grids], axis=1)

    def field(x):
        return 1.0 + sum((k + 2.0) * x[..., k] ** p for k, degree in enumerate(degrees) for p in range(1, degree + 1))

    def values(x):
        return np.broadcast_to(field(x), len(x))

    centre = CORNERS[shape].mean(axis=0, keepdims=True)
    np.testing.assert_allclose(at_nodes(type) @ values(points), values(nodes_of(kind.family.cell)), atol=1e-12)
    np.testing.assert_allclose(at_centroid(type) @ values(points), values(centre), atol=1e-12)
    np.testing.assert_allclose(at_nodes(type).sum(axis=1), 1.0, atol=1e-12)


def test_averages_are_over_the_elements_of_the_set_at_a_node(run_deck, tmp_path):
    """Quads side by side, stretched by 1e-3 and by 0.24e-3 over 0.14."""
    quads = PATCH.format(type="CPS4", request="*EL PRINT, POSITION=AVERAGED AT NODES\nS11\n*EL PRINT, POSITION=NODES")
    held = (
        "*BOUNDARY\nALL, 2\n10, 1\n40, 1\n50, 1, 1, 0.1E-3\n60, 1, 1, 0.14E-3\n20, 1, 1, 0.34E-3\n30, 1, 1, 0.34E-3\n"
    )
    start, end = quads.index("*BOUNDARY"), quads.index("*EL PRINT")
    quads = quads[:start] + held + quads[end:]
    run_deck(quads.replace("1.E6, 0.25", "1.E6, 0.").replace("60, 0.14,", "60, 0.1,").replace("0.14E-3", "0.1E-3"))
    text = (tmp_path / "deck.dat").read_text()
    averages = text.split("AVERAGED AT THE NODES\n")[1].split("MAXIMUM")[0]
    found = {int(a): float(b) for a, b in re.findall(r"^ +(\d+) +(\S+) *$", averages, re.MULTILINE)}
    outer = 0.24e-3 / 0.14 * 1e6
    inner = (1000 + outer) / 2
    assert found == pytest.approx({10: 1000, 40: 1000, 20: outer, 30: outer, 50: inner, 60: inner}, rel=1e-3)


def test_what_is_not_there_is_named_once_in_a_step_of_one_increment(run_deck, tmp_path):
    run_deck(PATCH.format(type="CPE4", request="*EL PRINT\nSDV\n*EL PRINT"))
    text = (tmp_path / "deck.dat").read_text()
    assert text.count("SDV IS NOT AVAILABLE AND IS LEFT OUT") == 1
    assert "WITH      1 WARNING MESSAGES ON THE DAT FILE" in text
