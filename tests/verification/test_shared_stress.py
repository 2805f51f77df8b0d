# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Load over opening of a short double cantilever beam of U9 and U10: a strip of them as plane elements, and as U8."""

import numpy as np
import pytest

import uel
from uel.delamination.kernels import uel_property, user_element
from uel.delamination.keywords import element_block, keyword, node_block, node_set, text

COLUMNS, TIP = 12, 4  # elements along the beam, and those along the crack
LENGTH, HEIGHT, WIDTH = 6.0, 0.5, 0.3
YOUNG, NU, OPENING = 7.0e4, 0.3, 0.3
LAW = {"ALPHAN": 2e4, "ALPHAT": 2e4, "SIGMAMAX": 12.0, "TAUMAX": 16.0, "GIC": 0.3, "GIIC": 0.6, "LAW": 2, "ETA": 1.5}
EQUATION_21 = {"BETAN": -2.0, "BETAT": -2.0}
CLOSURES = {
    "paper": {"CLOSURE": 2, **EQUATION_21},
    "rigid": {"CLOSURE": 1, "ALPHAN": 0.0, "ALPHAT": 0.0, **EQUATION_21},
}
BETA = {"BETAN": 2e5, "BETAT": 2e5}
FIRST = 1 + 2 * COLUMNS  # number of the first interface element
OFFSETS = {"OFFSETBOTTOM": TIP - 2 * COLUMNS, "OFFSETTOP": TIP - COLUMNS}
PLIES = {
    f"{name}{axes} {side}": value
    for side in ("BOTTOM", "TOP")
    for name, value, members in (("E", YOUNG, "1 2 3"), ("NU", NU, "12 13 23"), ("G", YOUNG / 2 / (1 + NU), "12 13 23"))
    for axes in members.split()
}


def deck(kind, closure, nlgeom):
    """Two arms of one row of U1 (plane strain) or of U9 between walls, with U3, U10 or U8 between them."""
    plane = kind == 3
    across = 1 if plane else 2
    # by arm, face of the arm, width and length
    labels = np.arange(1, 1 + 4 * across * (COLUMNS + 1)).reshape(2, 2, across, COLUMNS + 1)
    x = np.linspace(0, LENGTH, COLUMNS + 1)
    heights = np.array([[-HEIGHT, 0.0], [0.0, HEIGHT]])
    places = [[a, b, c] for c in heights.ravel() for b in (0.0, WIDTH)[:across] for a in x]
    if plane:
        places = [[a, c] for a, _, c in places]
    layers = labels.reshape(4, across, COLUMNS + 1)
    low, high = layers[:, :, :-1], layers[:, :, 1:]
    # nodes of an element in one layer: along the beam, or counter-clockwise from above
    corners = [low[:, 0], high[:, 0]] if plane else [low[:, 0], high[:, 0], high[:, 1], low[:, 1]]
    faces = np.stack(corners, axis=-1)
    tops = faces[..., ::-1] if plane else faces
    arms = np.concatenate([np.concatenate([faces[k], tops[k + 1]], axis=1) for k in (0, 2)])
    bonded = [faces[0], tops[1], faces[2], tops[3]] if kind == 8 else [faces[1], tops[2]]
    interface = np.concatenate(bonded, axis=1)[TIP:]
    bulk, direction = (1, 2) if plane else (9, 3)
    options = {"INTEGRATION": 4, "TENSOR": "PSTRAIN"} if plane else {"INTEGRATION": 8, "TENSOR": "THREED"}
    values = {"THICKNESS": WIDTH, "PLANE": 1, **LAW, **OFFSETS, **(PLIES if kind == 8 else {}), **closure}
    lines = [
        "*HEADING",
        "double cantilever beam",
        *node_block(labels.ravel(), np.array(places)),
        *user_element(bulk, **options),
        *user_element(kind),
        *element_block(f"U{bulk}", "BELOW", arms[:COLUMNS], 1),
        *element_block(f"U{bulk}", "ABOVE", arms[COLUMNS:], 1 + COLUMNS),
        *element_block(f"U{kind}", "INTERFACE", interface, FIRST),
        *uel_property(bulk, "BELOW", values | {"FACE": 3 if plane else 2}, MATERIAL="METAL"),
        *uel_property(bulk, "ABOVE", values | {"FACE": 1}, MATERIAL="METAL"),
        *uel_property(kind, "INTERFACE", values),
        *node_set("CLAMPED", labels[..., -1].ravel()),
        *node_set("ALL", labels.ravel()),
        *node_set("TOP", labels[1, 1, :, 0]),
        *node_set("BOTTOM", labels[0, 0, :, 0]),
        "*MATERIAL, NAME=METAL",
        "*ELASTIC",
        f"{YOUNG}, {NU}",
        keyword("STEP", *(["NLGEOM"] if nlgeom else []), UNSYMM="YES", INC=100),
        "*STATIC",
        "0.05, 1., 1e-5, 0.05",
        # what U3 and U10 leave out of their matrices makes them converge linearly
        "*CONTROLS, PARAMETERS=TIME INCREMENTATION",
        "50, 60, , 100",
        "*CONTROLS, PARAMETERS=FIELD, FIELD=DISPLACEMENT",
        "1e-7, 1.",
        "*BOUNDARY",
        f"CLAMPED, 1, {direction}",
        *([] if plane else ["ALL, 2, 2"]),
        f"TOP, {direction}, {direction}, {OPENING / 2}",
        f"BOTTOM, {direction}, {direction}, {-OPENING / 2}",
        "*OUTPUT, HISTORY",
        "*NODE OUTPUT, NSET=TOP",
        f"RF{direction}",
        "*END STEP",
    ]
    return text(lines)


def curve(folder, kind, closure, *, nlgeom=False):
    """Opening over that of the end, and load, of each increment."""
    path = folder / f"u{kind}.inp"
    path.write_text(deck(kind, closure, nlgeom))
    result = uel.run(path, output_dir=folder)
    assert result.completed
    load = sum(values for name, values in result.history.items() if name.startswith("RF"))
    return np.array([line.total_time for line in result.status]), load


def compare(one, other, rtol):
    """Loads at the same openings; the curves have a peak and fall to less than 0.8 of it."""
    np.testing.assert_allclose(one[0], other[0], rtol=1e-12)
    np.testing.assert_allclose(one[1], other[1], atol=rtol * other[1].max())
    assert 2 < other[1].argmax() < len(other[1]) - 2
    assert other[1][-1] < 0.8 * other[1].max()


@pytest.mark.parametrize("nlgeom", [False, True], ids=["small", "NLGEOM"])
@pytest.mark.parametrize("closure", CLOSURES)
def test_strip_is_the_plane_specimen(tmp_path, closure, nlgeom):
    """U9 and U10 between walls that let nothing move across: U1 and U3 in plane strain. Beta is given: |D| of (21) in
    space, 3 lambda + 2 mu, is larger than that in the plane, 2 lambda + 2 mu."""
    given = CLOSURES[closure] | BETA
    plane = curve(tmp_path, 3, given, nlgeom=nlgeom)
    compare(curve(tmp_path, 10, given, nlgeom=nlgeom), plane, 1e-5)


@pytest.mark.parametrize("closure", CLOSURES)
def test_shared_stress_is_that_of_its_own_bricks(tmp_path, closure):
    """U10 as U8, between the same bricks, with (21) and (22)."""
    compare(curve(tmp_path, 10, CLOSURES[closure]), curve(tmp_path, 8, CLOSURES[closure]), 1e-5)
