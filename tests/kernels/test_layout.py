# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables that the harness and the documentation read from the Fortran layout."""

from pathlib import Path

import pytest

from uel import usersub
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
    assert layout.variables(13) is None


def test_library_names_svars_of_these_elements_only(library, tmp_path):
    assert library.variables(2) == layout.variables(2)
    assert library.variables(13) is None
    other = tmp_path / "other.f"
    other.write_text("      subroutine uel(rhs)\n      real*8 rhs\n      end\n")
    stranger = usersub.load(other, job="other", output_dir=tmp_path)
    assert stranger.variables(2) is None
    stranger.close()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("integer, parameter, public :: p_a = 2\n@real_item(p_a, 'A', '1', positive)] !< a", "position 2 in row 1"),
        ("@", "not have the number of rows"),
    ],
)
def test_inconsistent_layout_is_refused(text, message):
    table = "type(real_item), parameter, public :: reals(1) = [ &\n"
    with pytest.raises(ValueError, match=message):
        layout._tables(text.replace("@", table))
