# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*GEOSTATIC: a layer of soil under its weight, with the initial stresses of *INITIAL CONDITIONS, GEOSTATIC."""

import numpy as np
import pytest
from columns import CELLS
from small_decks import body_lines

from uel.errors import DeckError
from uel.model.element_types import CONTINUUM

HEIGHT, LOWEST, DENSITY, GRAVITY, YOUNG, NU = 4.0, -1.0, 2.0, 9.81, 1e4, 0.25
WEIGHT = DENSITY * GRAVITY
LATERAL = 0.5, 0.7
CONSTRAINED = YOUNG * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
"""Modulus of a layer that cannot move sideways."""


def layer(element_type, *, stress=1.0, lateral=LATERAL):
    """Four elements on top of each other, the last direction upwards, nodes held but for their heights."""
    kind = CONTINUUM[element_type]
    d = kind.dimension
    quadratic = kind.nodes != 2**d
    numbers, nodes, elements = {}, [], []
    for k in range(4):
        element = []
        for at in np.array(CELLS[d])[: kind.nodes]:
            place = (*at[:-1].tolist(), int(at[-1]) + 2 * k)
            if place not in numbers:
                numbers[place] = len(nodes)
                nodes.append([*[1.0 + one / 2 for one in place[:-1]], LOWEST + HEIGHT * place[-1] / 8])
            element.append(numbers[place])
        elements.append(element)
    assert quadratic == (len(elements[0]) > 2**d)
    lines = body_lines(element_type, nodes, elements)
    bottom = [str(k + 1) for k, x in enumerate(nodes) if x[-1] == LOWEST]
    top = [str(k + 1) for k, x in enumerate(nodes) if x[-1] == LOWEST + HEIGHT]
    lines += ["*NSET, NSET=BOTTOM", ", ".join(bottom), "*NSET, NSET=TOP", ", ".join(top), "*ELSET, ELSET=LAST", "4"]
    lines += ["*SURFACE, NAME=TOP", f"LAST, S{3 if d == 2 else 2}", "*SOLID SECTION, ELSET=BODY, MATERIAL=M", ""]
    lines += ["*MATERIAL, NAME=M", f"*DENSITY\n{DENSITY}", f"*ELASTIC\n{YOUNG}, {NU}"]
    profile = f"{-stress * WEIGHT * HEIGHT}, {LOWEST}, 0., {LOWEST + HEIGHT}, {', '.join(map(str, lateral))}"
    lines += ["*INITIAL CONDITIONS, TYPE=STRESS, GEOSTATIC", f"BODY, {profile}"]
    lines += ["*BOUNDARY", f"ALL, 1, {d - 1}", f"BOTTOM, {d}"]
    down = "0., -1." if d == 2 else "0., 0., -1."
    lines += ["*STEP", "*GEOSTATIC", f"*DLOAD\nBODY, GRAV, {GRAVITY}, {down}"]
    output = "*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS\n*NODE OUTPUT\nU\n*END STEP"
    return [*lines, output], output, d


def expected_stress(dimension):
    """Components of the four elements, bottom up."""
    vertical = -WEIGHT * (HEIGHT - np.arange(0.5, 4.0))
    names = ("S11", "S22", "S33") if dimension == 3 else ("S11", "S33", "S22")
    return dict(zip(names, (LATERAL[0] * vertical, LATERAL[1] * vertical, vertical), strict=True))


@pytest.mark.parametrize("element_type", ["CPE4", "CPE4R", "CPE8", "CPE8R", "CAX4", "CAX8R", "C3D8", "C3D8R", "C3D20R"])
def test_stresses_in_equilibrium(run_deck, element_type):
    """Nothing moves, in one increment; a load in the next step moves the top by q H/M."""
    lines, output, d = layer(element_type)
    load = f"*STEP\n*STATIC\n1., 1.\n*DSLOAD\nTOP, P, 3.\n{output}"
    result = run_deck([*lines, load])
    assert [(row.step, row.increment) for row in result.status] == [(1, 1), (2, 1)]
    moved = 3 * HEIGHT / CONSTRAINED
    np.testing.assert_allclose(result.field("U", step=1), 0, atol=1e-11 * moved)
    for name, values in expected_stress(d).items():
        np.testing.assert_allclose(result.field(name, step=1), values, rtol=1e-10, err_msg=name)
    assert result.field("U", step=2)[:, d - 1].min() == pytest.approx(-moved, rel=1e-9)


def test_stresses_out_of_equilibrium(run_deck):
    """A tenth too little: the layer settles under the rest of the weight, rho g H^2/(2 M)."""
    lines, _, _ = layer("CPE8", stress=0.9)
    result = run_deck(lines)
    assert result.field("U")[:, 1].min() == pytest.approx(-0.1 * WEIGHT * HEIGHT**2 / (2 * CONSTRAINED), rel=1e-9)
    np.testing.assert_allclose(result.field("S22"), expected_stress(2)["S22"], rtol=1e-9)


def test_second_coefficient_is_the_first_if_it_is_left_out(run_deck):
    lines, _, _ = layer("CPE8", lateral=(0.5,))
    result = run_deck(lines)
    np.testing.assert_allclose(result.field("S33"), result.field("S11"))


@pytest.mark.parametrize(
    ("new", "message"),
    [
        ("*GEOSTATIC, UTOL=0.01", r"deck\.inp:\d+: .*UTOL"),
        ("*GEOSTATIC\n0.1, 1.", r"deck\.inp:\d+: \*GEOSTATIC takes no data lines"),
    ],
)
def test_what_is_not_supported(run_deck, new, message):
    lines, _, _ = layer("CPE4")
    lines[lines.index("*GEOSTATIC")] = new
    with pytest.raises(DeckError, match=message):
        run_deck(lines)
