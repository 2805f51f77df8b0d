# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Positions of the values of built-in elements: the Fortran module and the arrays that Python fills agree."""

import re
from pathlib import Path

import numpy as np
import pytest

from uel.usersub import built_in

ROOT = Path(__file__).parents[2]
TABLE = (ROOT / "fortran/built_in.toml").read_text()
AREA = 'area = "cross-section"'
ORIGIN = 'origin = { size = 2, meaning = "position of the reference node" }'
HOURGLASS = 'hourglass = "hourglass stiffness parameter"\n[solid.jprops]'
DIRECTION = 'direction = { size = "any", meaning = "direction of a traction" }'


@pytest.fixture(scope="module")
def positions(program):
    """Values of the constants of the module."""
    text = program("generate_host_layout").layout(TABLE)
    found = re.findall(r":: (\w+)(?:\(\d+\))? = (?:\[\(k, k=)?(\d+)", text)
    assert max(map(len, text.splitlines())) <= 132
    return {name: int(value) for name, value in found}


def test_values_are_where_fortran_reads_them(positions):
    """Those of shells begin with what all shells have."""
    values = {"thickness": 0, "density": 1, "shear": [2, 3, 4], "slenderness": 5, "stiffness": np.arange(6, 42)}
    own = {"drilling": 42, "middle": 43, "hourglass": [44, 45], "points": [46, 47, 48]}
    np.testing.assert_array_equal(built_in.reals("shell", **own, **values), np.arange(49.0))
    assert positions["p_section_stiffness"] == 1 + 6
    assert positions["p_shell_hourglass"] == 1 + 44
    assert positions["p_shell_points"] == 1 + 46
    assert positions["j_shell_layers"] == 1 + built_in.position("shell", "layers", "jprops")
    assert positions["p_section_density"] == 1 + built_in.position("shell", "density")
    assert positions["s_truss_peeq"] == positions["truss_values"] == len(built_in.variables("truss"))


def test_values_of_a_family_come_after_those_with_which_it_begins(positions):
    """In PROPS and in JPROPS; by all names, or after an array of the other family."""
    reals = {"depth": 0, "density": 1, "hourglass": 2}
    integers = {"family": 0, "points": 1, "direct": 2, "enhanced": 3, "mass_points": 4, "modes": 5, "pressures": 6}
    first = built_in.reals("solid", **reals)
    np.testing.assert_array_equal(built_in.reals("generalised", first, origin=[3, 4]), np.arange(5.0))
    np.testing.assert_array_equal(built_in.reals("generalised", **reals, origin=[3, 4]), np.arange(5.0))
    assert positions["p_generalised_origin"] == 1 + 3
    own = {"heat_points": 7, "heat_family": 8}
    first = built_in.integers("solid", **integers)
    for filled in (built_in.integers("coupled", first, **own), built_in.integers("coupled", **integers, **own)):
        np.testing.assert_array_equal(filled, np.arange(9))
        assert filled.dtype == np.int64
    assert [positions[f"j_coupled_{name}"] for name in own] == [1 + value for value in own.values()]
    assert positions["j_composite_layers"] == 1 + built_in.position("composite", "layers", "jprops") == 8
    assert positions["j_solid_points"] == 1 + built_in.position("composite", "points", "jprops")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('begins = "section"', 'begins = "sections"', "shell: begins: 'sections', expected one of truss, mass, "),
        ('begins = "section"', 'starts = "section"', "shell: 'starts', expected one of begins, svars, props, jprops"),
        (DIRECTION, f'{DIRECTION}\nend = "last"', "face.props.end: 'direction' before it has any size"),
        (ORIGIN, f"density = 'again'\n{ORIGIN}", "generalised.props.density: 'solid' has a value of this name"),
        (HOURGLASS, f"{DIRECTION}\n[solid.jprops]", "generalised.props.origin: 'direction' before it has any size"),
        (AREA, "area = { size = 2 }", "truss.props.area: expected a meaning, or size and meaning"),
    ],
)
def test_wrong_entries_stop_the_build(program, old, new, message):
    assert old in TABLE
    with pytest.raises(ValueError, match=message):
        program("generate_host_layout").layout(TABLE.replace(old, new, 1))


def test_arrays_need_all_values():
    with pytest.raises(TypeError, match="props of truss: expected area, density"):
        built_in.reals("truss", area=1.0)
    with pytest.raises(ValueError, match="props of truss: area has 2 values, expected 1"):
        built_in.reals("truss", area=[1.0, 2.0], density=0.0)
    with pytest.raises(TypeError, match=r"props of generalised: expected origin$"):
        built_in.reals("generalised", np.zeros(3), depth=1.0, origin=[0.0, 0.0])
    with pytest.raises(ValueError, match="props of generalised: begins with 2 values, expected depth, density, hour"):
        built_in.reals("generalised", np.zeros(2), origin=[0.0, 0.0])
