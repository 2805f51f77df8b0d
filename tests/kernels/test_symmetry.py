# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which matrices are unsymmetric: those of the elements whose *USER ELEMENT has UNSYMM, and when."""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from space import bottom_of, top_of

from uel.usersub.layout import element_layouts

EDGE = np.array([[0.0, 0.0], [1.0, 0.1]])
FACE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [1.1, 0.9, 0.2], [0.0, 1.0, 0.1]])
MIDDLES = 0.5 * (FACE + np.roll(FACE, -1, axis=0))
PLANES = {
    2: EDGE[[0, 1, 1, 0]],
    5: np.vstack([EDGE[[0, 1, 1, 0]], *[EDGE.mean(axis=0)] * 2]),
    7: np.vstack([FACE, FACE]),
    11: np.vstack([FACE, FACE, MIDDLES, MIDDLES]),
}
"""Nodes of the standard elements, which are closed."""
SHEAR = {2: (0.004, 0.003), 3: (0.004, 0.003, 0.003)}
"""A separation in mixed mode at which the law softens."""
LAWS = [{"LAW": 1}, {"LAW": 2, "ETA": 2.0}, {"LAW": 3, "ETA": 2.0}, BRIDGING, TABLE]
ELASTIC = 0.05
"""Part of it, at which the law is elastic."""


def asymmetry(element, jtype, part, *, nlgeom=False, **values):
    """Largest difference of the triangles of AMATRX, over its largest entry."""
    nodes = PLANES[jtype]
    u = np.zeros_like(nodes)
    u[top_of(jtype)] = part * np.array(SHEAR[nodes.shape[1]])
    # of each node its own
    u[top_of(jtype)] *= 1.0 + 0.1 * np.arange(len(top_of(jtype)))[:, None]
    _, matrix = element(jtype, nodes, **values).evaluate(u, flags=(1, int(nlgeom), 0, 0))
    assert matrix.any()
    return np.abs(matrix - matrix.T).max() / np.abs(matrix).max()


def test_faces_are_where_the_layout_has_them():
    for jtype, nodes in PLANES.items():
        np.testing.assert_array_equal(nodes[bottom_of(jtype)], nodes[top_of(jtype)])


@pytest.mark.parametrize("jtype", PLANES)
@pytest.mark.parametrize("values", LAWS, ids=lambda values: f"LAW {values['LAW']}")
def test_softening_in_mixed_mode(element, jtype, values):
    assert asymmetry(element, jtype, 1.0, **values) > 0.1
    # without the derivative of the damage, and before damage, it is symmetric: rounding remains
    assert asymmetry(element, jtype, 1.0, **values, TANGENT=1) < 1e-14
    assert asymmetry(element, jtype, ELASTIC, **values) < 1e-14
    # with NLGEOM the forces are derivatives of the same energy
    assert asymmetry(element, jtype, 1.0, nlgeom=True, **values, TANGENT=1) < 1e-14


def test_ppr_has_a_potential_as_long_as_both_separations_grow(element):
    assert asymmetry(element, 2, 1.0, LAW=4) < 1e-14
    item = element(2, PLANES[2], LAW=4)
    top = top_of(2)
    u = np.zeros((4, 2))
    u[top] = SHEAR[2]
    item.advance(u)
    # sliding back while opening further
    u[top] = 0.5 * SHEAR[2][0], 1.1 * SHEAR[2][1]
    matrix = item.evaluate(u)[1]
    assert np.abs(matrix - matrix.T).max() > 0.1 * np.abs(matrix).max()


def test_unsymmetric_types_are_the_interface_elements():
    layouts = element_layouts()
    assert [jtype for jtype in layouts if not layouts[jtype].unsymmetric] == [1, 9]
