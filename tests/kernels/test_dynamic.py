# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""RHS and AMATRX in *DYNAMIC: the weights of the operator of Hilber, Hughes and Taylor.

Abaqus Theory Guide, "Implicit dynamic analysis", and User Subroutines Reference Guide, UEL: with the static residual G,
at the end of the increment and at its start, RHS is -M A + (1 + alpha) G - alpha G_start; with LFLAGS(3) = 6 it is G.
"""

import numpy as np
import pytest
from random_states import COPIES, VARIANTS, Crowd, SpaceCrowd

ALPHA = -0.2
PARAMS = (ALPHA, 0.25 * (1 - ALPHA) ** 2, 0.5 - ALPHA)
QUAD = [[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]]
BRICK = [[0, 0, 0], [1, 0, 0.1], [1.1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 0.8, 1], [0, 1, 0.9]]
PLANE = {name: case for name, case in VARIANTS.items() if name != "U6 consistent"}
CASES = [*PLANE, "U7", "U8", "U10", "U11", "U12"]


class Solid:
    """U1 or U9, in the place of a crowd."""

    def __init__(self, element, jtype, formulation=0):
        self.item = element(
            jtype, QUAD if jtype == 1 else BRICK, **({"FORMULATION": formulation} if jtype == 9 else {})
        )

    def call(self, method, u, dtime, **options):
        return getattr(self.item, method)(u, dtime=dtime, **options)

    def own(self, u):
        return u


def crowd_of(name, element, interface):
    """Elements of a type, and two states of them, one after the other."""
    rng = np.random.default_rng(3)
    if name.startswith(("U1 ", "U9")):
        item = Solid(element, 1 if name == "U1 " else 9, int(name[3:] or 0))
        u = 1e-2 * rng.normal(size=(8, 2) if name == "U1 " else (8, 3))[: 4 if name == "U1 " else 8].ravel()
        return item, [0.6 * u, u]
    if name in PLANE:
        jtype, closure = PLANE[name]
        values = {"CLOSURE": 1, "BETAN": 5e4, "BETAT": 5e4} if closure else {}
        crowd = Crowd(element, interface, jtype, **values)
    else:
        crowd = SpaceCrowd(element, rng, int(name[1:]))
    ends = rng.normal(size=(COPIES, 2, 2)) * [0.005, 0.004]
    noise = 1e-3 * rng.normal(size=(COPIES, crowd.nodes, crowd.dim))
    return crowd, [crowd.displacements(f * ends, f * noise) for f in (0.6, 1.0)]


@pytest.mark.parametrize("finite", [0, 1], ids=["linear", "NLGEOM"])
@pytest.mark.parametrize("name", [*CASES, "U1 ", "U9 0", "U9 1", "U9 2"])
def test_forces_of_both_ends_have_their_weights(element, interface, name, finite):
    """A state that softens; the forces at the start are those of the tractions and stresses in SVARS."""
    crowd, (start, end) = crowd_of(name, element, interface)
    still = {"flags": (1, finite, 0, 0)}
    moving = {"flags": (11, finite, 0, 0), "params": PARAMS, "du": crowd.own(end) - crowd.own(start)}
    before = crowd.call("advance", start, 0.1, **still)[0]
    after, stiffness = crowd.call("evaluate", end, 0.1, **still)
    scale = abs(after).max()
    for procedure in (11, 12):
        moving["flags"] = (procedure, finite, 0, 0)
        for request, with_matrix in ((1, True), (5, False)):
            rhs, amatrx = crowd.call("evaluate", end, 0.1, request=request, **moving)
            np.testing.assert_allclose(rhs, (1 + ALPHA) * after - ALPHA * before, rtol=1e-9, atol=1e-9 * scale)
            expected = (1 + ALPHA) * stiffness if with_matrix else 0 * stiffness
            np.testing.assert_allclose(amatrx, expected, rtol=1e-12, atol=1e-12 * abs(stiffness).max())
        rhs, _ = crowd.call("evaluate", end, 0.1, request=6, **moving)
        np.testing.assert_array_equal(rhs, after)
    # PARAMS mean nothing in other procedures
    rhs, amatrx = crowd.call("evaluate", end, 0.1, **still, params=PARAMS, du=moving["du"])
    np.testing.assert_array_equal(rhs, after)
    np.testing.assert_array_equal(amatrx, stiffness)


@pytest.mark.parametrize("name", ["U2", "U4 consistent"])
def test_state_and_energies_are_those_of_a_static_step(element, interface, name):
    found = []
    for flags in ((1, 0, 0, 0), (11, 0, 0, 0)):
        crowd, (start, end) = crowd_of(name, element, interface)
        crowd.call("advance", start, 0.1)
        crowd.call("advance", end, 0.1, flags=flags, params=PARAMS, du=crowd.own(end) - crowd.own(start))
        found.append((crowd.item.block.state(0).svars, crowd.item.energy))
    np.testing.assert_array_equal(found[0][0], found[1][0])
    np.testing.assert_array_equal(found[0][1], found[1][1])
