# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HYPERELASTIC, USER: UHYPER against the built-in potential, its arguments, its mistakes."""

from pathlib import Path

import numpy as np
import pytest
from differences import check_energy
from moving_element import CUBE, NODES, SQUARE, MovingElement
from small_decks import body_lines

from uel.errors import DeckError, KernelError, Source
from uel.model.mesh import ElementGroup
from uel.model.properties import Hyperelastic, Material, Potential, SolidSection, UserPotential

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
C, B, D = 0.5, 0.2, 0.4
MOONEY = Hyperelastic(Potential.MOONEY_RIVLIN, 1, (C, B), (D,), SOURCE)


@pytest.fixture
def element(bound, load, call):
    def element(one, element_type):
        nodes = NODES.get(element_type, SQUARE)
        if element_type.startswith("CAX"):
            nodes = nodes + np.array([1.0, 0, 0])
        section = SolidSection("ALL", Material("RUBBER", SOURCE, hyperelastic=one), None, 1.0, SOURCE)
        group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        return MovingElement(*bound(group, nodes, load("potential.f90")), nodes, call)

    return element


def by_user(*constants):
    return UserPotential(np.array(constants), SOURCE)


@pytest.mark.parametrize("element_type", ["C3D8", "C3D10", "CPE4", "CAX4", "CPE3"])
def test_it_gives_what_the_built_in_potential_gives(element, element_type):
    """UI1 and UI2 of the first two invariants and of J, energies."""
    user, built_in = element(by_user(C, B, D, 0, 0), element_type), element(MOONEY, element_type)
    u = 0.06 * np.random.default_rng(3).standard_normal(user.u.size)
    (forces, report), (wanted, other) = user.evaluate(u), built_in.evaluate(u)
    tangent, expected = user.matrix.toarray(), built_in.matrix.toarray()
    np.testing.assert_allclose(forces, wanted, atol=1e-12 * abs(wanted).max())
    np.testing.assert_allclose(tangent, expected, atol=1e-12 * abs(expected).max())
    np.testing.assert_allclose(report.energy, other.energy, rtol=1e-12)


@pytest.mark.parametrize("element_type", ["C3D8", "C3D10", "CPE4", "CAX4"])
def test_mixed_derivatives(element, element_type):
    """An energy that does not split: forces are its derivatives, and the tangent theirs."""
    solid = element(by_user(C, B, D, 0.3, -0.2), element_type)
    check_energy(solid)


def deck(keyword, *, element_type="C3D8", more="", section="", step="*STEP, NLGEOM", loads=""):
    """A unit cube in four increments."""
    lines = body_lines(element_type, CUBE, [range(8)])
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER{section}", "*MATERIAL, NAME=RUBBER", keyword, more, step]
    lines += ["*STATIC, DIRECT", "0.25, 1.", "*BOUNDARY", "1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2"]
    lines += ["2, 3", "3, 3", "4, 3", *(f"{node}, 1, 1, 0.4" for node in (2, 3, 6, 7)), loads]
    lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "SDV, S", "*END STEP"]
    return "\n".join(line for line in lines if line) + "\n"


RUBBER = "*HYPERELASTIC, USER, TYPE=COMPRESSIBLE, PROPERTIES=5\n0.5, 0.2, 0.4, 0., 0."


def test_arguments(run_deck):
    """STATEV of the last increment begins with that of the one before; TEMP and FIELDV at the end, FIELDVINC."""
    initial = "*INITIAL CONDITIONS, TYPE="
    more = f"*DEPVAR\n9\n{initial}TEMPERATURE\nALL, 20.\n{initial}FIELD, VARIABLE=1\nALL, 1."
    loads = "*TEMPERATURE\nALL, 60.\n*FIELD, VARIABLE=1\nALL, 3."
    result = run_deck(deck(RUBBER, more=more, loads=loads), HERE / "potential.f90")
    assert result.completed
    increments = len(result.status)
    assert increments == 4
    found = np.array([result.field(f"SDV{k}")[0] for k in range(1, 10)])
    # one call of each converged increment is kept
    np.testing.assert_allclose(found, [increments, 60, 1, 0, 1, 5, 3, 0.5, 1], rtol=1e-12)


def test_a_pulled_cube(run_deck):
    """As with the built-in potential."""
    user = run_deck(deck(RUBBER), HERE / "potential.f90").field("S11")
    built_in = run_deck(deck("*HYPERELASTIC, MOONEY-RIVLIN\n0.5, 0.2, 0.4"), HERE / "potential.f90").field("S11")
    assert built_in[0] > 0.5
    np.testing.assert_allclose(user, built_in, rtol=1e-9)


@pytest.mark.parametrize(
    ("keyword", "options", "message"),
    [
        ("*HYPERELASTIC, USER", {}, "USER without TYPE=COMPRESSIBLE is not supported .*; supported: hybrid elements"),
        ("*HYPERELASTIC, USER, YEOH", {}, "YEOH and USER: expected one strain energy potential"),
        ("*HYPERELASTIC, YEOH, PROPERTIES=2\n1.", {}, "PROPERTIES: expected with USER only"),
        ("*HYPERELASTIC, YEOH, TYPE=COMPRESSIBLE\n1.", {}, "TYPE: expected with USER only"),
        (RUBBER.replace("=5", "=3"), {}, "5 values, but PROPERTIES=3; dependence on temperature is not supported"),
        (RUBBER.replace("=5", "=-1"), {}, "PROPERTIES=-1: expected a number from 0"),
        (
            RUBBER,
            {
                "element_type": "C3D8R",
                "section": ", CONTROLS=C",
                "more": "*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED",
            },
            "HOURGLASS=ENHANCED is not supported for material RUBBER",
        ),
        (RUBBER, {"step": "*STEP"}, "supported with NLGEOM"),
    ],
)
def test_errors_of_decks(run_deck, keyword, options, message):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*" + message):
        run_deck(deck(keyword, **options), HERE / "potential.f90")


def test_a_file_without_it(run_deck):
    with pytest.raises(DeckError, match=r"\*HYPERELASTIC, USER: material RUBBER needs UHYPER; .* has UMAT"):
        run_deck(deck(RUBBER), HERE / "points.f")


def wrong(way):
    return RUBBER.replace("=5", "=6") + f", {way}"


def test_it_ends_the_analysis(run_deck):
    with pytest.raises(
        KernelError, match=r"element 1 \(type C3D8\): UHYPER at integration point 1 stopped the analysis"
    ):
        run_deck(deck(wrong(1)), HERE / "potential.f90")


@pytest.mark.parametrize(
    ("way", "text"),
    [
        (2, "element 1: UHYPER writes outside UI1: entry 4 of 3 (3) at integration point 1"),
        pytest.param(3, "element 1: UHYPER sets an entry of U to NaN or infinity, entry 1,", marks=pytest.mark.nan),
    ],
)
def test_its_mistakes_are_told(run_deck, way, text):
    result = run_deck(deck(wrong(way)), HERE / "potential.f90")
    assert any(text in " ".join(warning.split()) for warning in result.warnings), result.warnings
