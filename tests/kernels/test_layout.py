# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables that the harness and the documentation read from the Fortran layout."""

import re
from pathlib import Path

import numpy as np
import pytest

import uel
from uel import usersub
from uel.delamination.kernels import state_labels, uel_property
from uel.usersub import layout

ROOT = Path(__file__).parents[2]


def test_tables_of_the_documentation_are_current():
    assert (ROOT / "fortran/README.md").read_text().endswith(layout.markdown().rstrip() + "\n")


def test_user_element_lines_of_the_documentation_are_current():
    text = (ROOT / "fortran/README.md").read_text()
    for jtype, item in layout.element_layouts().items():
        line = next(line for line in text.splitlines() if f"TYPE=U{jtype}," in line)
        for option in (
            f"NODES={item.nodes},",
            f" PROPERTIES={len(item.reals)},",
            f"I PROPERTIES={len(item.integers)},",
            f"VARIABLES={item.svars}",
        ):
            assert option in line
        assert ("UNSYMM" in line) == item.unsymmetric


def test_the_deck_of_the_documentation_dissipates_its_fracture_energy(tmp_path):
    """G_Ic of 0.26 N/mm times the area of 0.125 mm x 1 mm: both points fail in mode I."""
    deck = re.search(r"^```abaqus pulled.inp\n(.*?)^```$", (ROOT / "fortran/README.md").read_text(), re.M | re.S)
    (tmp_path / "pulled.inp").write_text(deck[1])
    result = uel.run(tmp_path / "pulled.inp", output_dir=tmp_path)
    assert result.history["ALLPD"][-1] == pytest.approx(0.0325, rel=1e-9)


def test_two_sets_of_the_documentation_are_one_of_the_law_with_bridging(tmp_path):
    """3 MPa up to 0.2/3 mm are left of 0.26 N/mm: under the traction t, 0.26 - t/30 are dissipated, on 0.125 mm^2."""
    page = (ROOT / "fortran/laws.md").read_text()
    deck = re.search(r"^```abaqus two_sets.inp\n(.*?)^```$", page, re.M | re.S)[1]
    (tmp_path / "two_sets.inp").write_text(deck)
    law = {"ALPHAN": 1e6, "ALPHAT": 1e6, "SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.0, "LAW": 5}
    lines = uel_property(2, "TIP", law | {"THICKNESS": 1.0, "SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1})
    one = re.sub(r"\*ELEMENT, TYPE=U2, ELSET=BRIDGES\n.*\n", "", deck)
    one = re.sub(
        r"\*UEL PROPERTY, ELSET=TIP\n(?:.*\n)*?\*BOUNDARY\n", "\n".join([*lines, "*BOUNDARY", ""]), one, count=1
    )
    (tmp_path / "one_set.inp").write_text(one)
    two, one = (uel.run(tmp_path / f"{name}.inp", output_dir=tmp_path) for name in ("two_sets", "one_set"))
    for result in (two, one):
        force = sum(result.history[f"RF2[TOP:{node}]"][-1] for node in (7, 8))
        assert result.history["ALLPD"][-1] == pytest.approx(0.26 * 0.125 - force / 30.0, rel=1e-9)
        assert force == pytest.approx(0.1507, abs=5e-5)
    for name, values in two.history.items():
        np.testing.assert_allclose(one.history[name], values, rtol=1e-9, atol=1e-12, err_msg=name)


def test_names_of_svars():
    continuum = layout.variables(1)
    assert continuum.names == ("E11", "E22", "E33", "E12", "S11", "S22", "S33", "S12")
    assert (continuum.kind, continuum.points, continuum.outline) == ("continuum", 4, (0, 1, 2, 3))
    eight = layout.variables(4)
    assert {"X", "Y", "SEPN", "SEPT", "TN", "TT", "DAMAGE", "DISSI", "DISSII", "SN", "ST"} < set(eight.names)
    assert (eight.kind, eight.points, eight.bottom, eight.top) == ("interface", 2, (3, 2), (4, 5))
    assert (layout.variables(2).bottom, layout.variables(2).top) == ((0, 1), (3, 2))
    brick = layout.variables(9)
    assert brick.names[:6] == ("E11", "E22", "E33", "E12", "E13", "E23") and brick.names[6] == "S11"
    assert (brick.kind, brick.points, brick.outline) == ("continuum", 8, ())
    ten = layout.variables(10)
    assert (ten.kind, ten.points, ten.bottom, ten.top) == ("interface", 4, (0, 1, 2, 3), (4, 5, 6, 7))
    assert (layout.variables(11).points, layout.variables(11).top) == (9, (4, 5, 6, 7, 12, 13, 14, 15))
    assert layout.variables(12).bottom == (4, 5, 6, 7, 12, 13, 14, 15)
    assert layout.variables(12).top == (20, 21, 22, 23, 28, 29, 30, 31)
    assert layout.variables(15) is None
    assert layout.variables(34).bottom == (2, 1) and layout.variables(34).top == (3, 4)


@pytest.mark.parametrize("jtype", [2, 3, 4, 5, 6])
def test_labels_of_the_variables_that_decks_print(jtype):
    """The decks of specimens take those of U2 for every interface element in the plane."""
    labels = state_labels(2, "SEPN", "TN", "DAMAGE")
    assert [layout.variables(jtype).names[int(label.removeprefix("SDV")) - 1] for label in labels] == [
        "SEPN",
        "TN",
        "DAMAGE",
    ]


def test_library_names_svars_of_these_elements_only(library, tmp_path):
    assert library.variables(2) == layout.variables(2)
    assert library.variables(15) is None
    other = tmp_path / "other.f"
    other.write_text("      subroutine uel(rhs)\n      real*8 rhs\n      end\n")
    stranger = usersub.load(other, job="other", output_dir=tmp_path)
    assert stranger.variables(2) is None
    stranger.close()


ETA = 'name = "ETA"\nelements = "interfaces"\nunit = "1"\nrange = "exponent"\n'


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (ETA, ETA.replace("unit", "unity"), "reals ETA: no unit"),
        (ETA, f"{ETA}zero = 'none'\n", "reals ETA: 'zero', expected one of default, elements, laws, "),
        (ETA, ETA.replace("interfaces", "bars"), "reals ETA: elements: 'bars', expected one of continuum, standard, "),
        (ETA, ETA.replace('"exponent"', '"any"'), "reals ETA: range: 'any', expected one of positive, "),
        (ETA, ETA.replace("ETA", "BLEND"), "p_blend: two entries have this name in Fortran; give"),
        ("laws = [4]", "laws = [7]", "reals SHAPEN: laws: '7', expected one of 1, 2, 3, 4, 5, 6"),
        ('"next_to_solids", "with_solids"]', '"interfaces"]', "sets.stabilised: 'interfaces', expected one of"),
        ('variables = "brick"', 'variables = "bricks"', "families.continuum_3d: variables: 'bricks', expected one of"),
        ('type = "U12"', 'type = "U11"', "elements U11: expected U and a number above 11, the types in the order"),
        (
            "solids = [3, 3]",
            "solids = [3, 4]",
            r"elements U33: expected solids = \[nodes below, nodes above\], together 6,",
        ),
        ('family = "continuum"', 'family = "quad"', "elements U1: family: 'quad', expected one of continuum, "),
        ('{ name = "E11", unit = "1", ', '{ name = "E11", ', "variables.continuum E11: no unit"),
    ],
)
def test_wrong_entries_stop_the_build(program, old, new, message):
    text = (ROOT / "fortran/properties.toml").read_text()
    assert old in text
    with pytest.raises(ValueError, match=message):
        program("generate_layout").layout(text.replace(old, new, 1))


def test_generator_names_its_file(program, tmp_path, monkeypatch):
    file = tmp_path / "properties.toml"
    file.write_text("[ranges\n")
    monkeypatch.setattr("sys.argv", ["generate_layout.py", "-o", str(tmp_path / "layout.f90"), str(file)])
    with pytest.raises(SystemExit, match=r"properties.toml: .*line 1"):
        module = program("generate_layout")
        module.main(module.layout, module.__doc__)
    assert not (tmp_path / "layout.f90").exists()


def test_generated_lines_are_within_those_of_the_standard(program):
    """132 columns: a longer meaning is a comment that gfortran and fortitude would cut or refuse."""
    text = program("generate_layout").layout((ROOT / "fortran/properties.toml").read_text())
    assert max(map(len, text.splitlines())) <= 132
