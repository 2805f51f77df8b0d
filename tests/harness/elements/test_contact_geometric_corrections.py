# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Geometric corrections of contact: faces that approximate circles, cones, spheres and tori."""

import numpy as np
import pytest
from contact_decks import YOUNG, Box, step, two_boxes

from uel.contact import SurfaceSliding
from uel.contact.geometric_corrections import corrections
from uel.deck import read_deck
from uel.deck.contact.sliding_surfaces import make_pieces
from uel.model.contact import Rounded

INNER, MIDDLE, OUTER = 1.0, 2.0, 3.0


def rings(inner, outer, overlap):
    """Quarters of rings, with these numbers of elements along them, that overlap."""
    found = []
    for name, first, low, high, count in (
        ("LOWER", 1, INNER, MIDDLE, inner),
        ("UPPER", 1001, MIDDLE - overlap, OUTER, outer),
    ):
        ring = Box(name, "CPS4", (0, low), (np.pi / 2, high), (count, 10), first=first)
        angle, radius = ring.nodes.T
        ring.nodes = np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=1)
        found.append(ring)
    return found


SMOOTHING = "*SURFACE SMOOTHING, NAME=ROUND\nUPPER_LOW, LOWER_HIGH, CIRCUMFERENTIAL, 0., 0."
CORRECTED = "TYPE=SURFACE TO SURFACE, GEOMETRIC CORRECTION=ROUND"
HELD = "*BOUNDARY\nLOWER_LEFT, 1\nUPPER_LEFT, 1\nLOWER_RIGHT, 2\nUPPER_RIGHT, 2"


def test_shrink_fit(run_deck):
    """The pressure of two rings is uniform, by Lame's formula (Shigley's Mechanical Engineering Design, press fits).

    Facets stand off the circle by up to 0.0096, many times the overlap: without corrections they hardly touch.
    """
    overlap = 0.002
    wanted = YOUNG * overlap / MIDDLE * (OUTER**2 - MIDDLE**2) * (MIDDLE**2 - INNER**2)
    wanted /= 2 * MIDDLE**2 * (OUTER**2 - INNER**2)
    pressures = []
    for pair in (CORRECTED, "TYPE=SURFACE TO SURFACE"):
        result = run_deck(two_boxes(*rings(8, 11, overlap), [HELD, step("1., 1.")], pair=pair, model=SMOOTHING))
        pressure = result.field("CPRESS")
        pressures.append(pressure[np.isfinite(pressure)])
    np.testing.assert_allclose(pressures[0], wanted, rtol=0.05)
    assert pressures[1].mean() < 0.5 * wanted


def test_clearances_of_concentric_circles(tmp_path):
    """None, but for a hundredth of what the facets leave."""
    found = []
    for pair in (CORRECTED, "TYPE=SURFACE TO SURFACE"):
        (tmp_path / "deck.inp").write_text(
            two_boxes(*rings(8, 11, 0.0), [HELD, step("1., 1.")], pair=pair, model=SMOOTHING)
        )
        model = read_deck(tmp_path / "deck.inp")
        found.append(np.abs(SurfaceSliding(model.contacts[0], model.mesh.coordinates).start()).max())
    assert found[0] < 0.01 * found[1]


def test_triangles_and_quadrilaterals_of_one_surface(tmp_path):
    nodes = [(x, y, z) for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    nodes += [(x, y, z) for z in (0.0, 1.0) for x, y in ((2, 0), (3, 0), (2, 1))]
    lines = ["*NODE", *(f"{k}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(nodes, 1))]
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8", "*ELEMENT, TYPE=C3D6, ELSET=E"]
    lines += ["2, 9, 10, 11, 12, 13, 14", "*SURFACE, NAME=TOP\nE, S2", "*SOLID SECTION, ELSET=E, MATERIAL=M", ""]
    lines += ["*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3", "*SURFACE SMOOTHING, NAME=R\nTOP, , SPHERICAL, 0., 0., 0."]
    (tmp_path / "deck.inp").write_text("\n".join([*lines, "*STEP\n*STATIC\n*END STEP\n"]))
    assert len(read_deck(tmp_path / "deck.inp").groups) == 2


@pytest.mark.parametrize("kind", ["cone", "sphere", "torus"])
def test_correction_of_a_face(kind):
    """Of a quadrilateral whose corners are on the surface: how far the middle is inside, by the closed form.

    The corners are at angles of -t and t about an axis, and those of their meridian likewise.
    """
    t, radius, tube = 0.1, 3.0, 0.5
    angle, other = np.array([-t, t, t, -t]), np.array([-t, -t, t, t])
    if kind == "cone":
        distance, height = radius + 2.0 * other, other
        inside = radius * (1.0 - np.cos(t))
    elif kind == "sphere":
        distance, height = radius * np.cos(other), radius * np.sin(other)
        inside = radius * (1.0 - np.cos(t) ** 2)
    else:
        distance, height = radius + tube * np.cos(other), tube * np.sin(other)
        inside = tube - (np.cos(t) * (radius + tube * np.cos(t)) - radius)
    corners = np.stack([distance * np.cos(angle), distance * np.sin(angle), height], axis=1)
    normal = (
        np.array([1.0, 0.0, -2.0 * np.cos(t)]) / np.hypot(1.0, 2.0 * np.cos(t))
        if kind == "cone"
        else np.array([1.0, 0.0, 0.0])
    )
    away, axis = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 0.0 if kind == "sphere" else 1.0])
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn[0] *= np.linalg.det(turn)
    centre = np.array([1.0, 2.0, 3.0])
    pieces = make_pieces([np.array([[0, 1, 2, 3]])], corners @ turn.T + centre, 0.0, 0.0)
    shape = Rounded(np.array([0]), centre, turn @ axis, radius if kind == "torus" else None)
    place = np.array([0]), np.zeros((1, 2))
    found = corrections([shape], pieces, corners @ turn.T + centre, place)
    assert found[0] == pytest.approx(inside * (normal @ away), rel=1e-9)
    # corners are where they belong
    ends = np.zeros(4, dtype=int), np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    np.testing.assert_allclose(corrections([shape], pieces, corners @ turn.T + centre, ends), 0.0, atol=1e-14)
    assert corrections([], pieces, corners, place)[0] == 0.0
