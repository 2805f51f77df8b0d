# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What every built-in continuum element has to pass: a patch test in large displacements, and its mass.

The cases are the rows of the table of types, so that no new type is forgotten. Left out is what is refused:
piezoelectric elements with NLGEOM, and steps that need a mass for coupled elements and those in generalised plane
strain.
"""

import numpy as np
import pytest
import scipy.sparse as sp
from moving_element import turn
from reference_cells import patch_of
from small_decks import body_lines

from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Request
from uel.model.element_types import BUILT_IN, ContinuumType, Tensor

SOLIDS = {name: kind for name, kind in BUILT_IN.items() if type(kind) is ContinuumType}
YOUNG, POISSON, DENSITY, THICKNESS = 1000.0, 0.3, 2.0, 0.7
SINGLE = 2.0**-23
"""Field output has single precision."""
STRETCH = np.array([[1.10, 0.04, -0.03], [0.04, 0.93, 0.05], [-0.03, 0.05, 1.06]])
ANGLE = np.radians(50.0)


def body(element_type):
    """Deck of a distorted patch up to its steps, nodes, and which of them are at its boundary."""
    kind = SOLIDS[element_type]
    nodes, elements = patch_of(kind.family.cell)
    if kind.axisymmetric:
        nodes += [1.0, 0.0]
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    outside = np.flatnonzero((np.isclose(nodes, low) | np.isclose(nodes, high)).any(axis=1))
    lines = body_lines(element_type, nodes, elements)
    if kind.generalised:
        lines += ["*NODE, NSET=REF", "1000, 0.4, 0.3"]
    reference = ", REF NODE=REF" if kind.generalised else ""
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{reference}", f"{THICKNESS}"]
    lines += ["*MATERIAL, NAME=M", "*DENSITY", f"{DENSITY}", "*ELASTIC", f"{YOUNG}, {POISSON}"]
    lines += ["*CONDUCTIVITY\n1."] if kind.coupled else []
    lines += ["*DIELECTRIC\n1."] if kind.electrical else []
    return lines, nodes, outside


def stress_of(kind, strain):
    """Hooke's law: 11, 22, 33, 12, 13, 23, by a symmetric strain (3, 3)."""
    shear, lame = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    strain = strain.copy()
    if kind.tensor is Tensor.PLANE_STRESS:
        strain[2, 2] = -POISSON / (1 - POISSON) * (strain[0, 0] + strain[1, 1])
    return 2 * shear * strain + lame * np.trace(strain) * np.eye(3)


def gradients_of(kind):
    """A stretch from rest, and the same turned, twice; about an axis the stretch alone."""
    if kind.axisymmetric:
        return [np.diag([1.1, 0.93, 1.1])]
    stretch, rotation = STRETCH.copy(), np.eye(3)
    if kind.dimension == 2:
        stretch[2], stretch[:, 2] = [0, 0, 1], [0, 0, 1]
        rotation = turn(ANGLE)
    else:
        rotation = turn_about([0.6, 0.0, 0.8], ANGLE)
    return [stretch, rotation @ stretch, rotation @ rotation @ stretch]


def turn_about(axis, angle):
    """Rotation (O. Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


@pytest.mark.sample(4)
@pytest.mark.parametrize("element_type", [name for name, kind in SOLIDS.items() if not kind.electrical])
def test_patch_is_stretched_and_turned(run_deck, element_type):
    """NLGEOM: the boundary follows a stretch, then rotations of 50 degrees, in an increment each. What is inside
    follows, and the stress is uniform: that of the strain in the middle of the increment, turned with the body."""
    kind = SOLIDS[element_type]
    dim = kind.dimension
    lines, nodes, outside = body(element_type)
    gradients = gradients_of(kind)
    for gradient in gradients:
        moved = nodes @ (gradient[:dim, :dim] - np.eye(dim)).T
        lines += ["*STEP, NLGEOM=YES", "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE" if kind.coupled else "*STATIC"]
        lines += ["1., 1.", "*CONTROLS, PARAMETERS=FIELD", "1e-10, 1e-10", "*BOUNDARY"]
        lines += [f"{k + 1}, {d + 1}, {d + 1}, {float(moved[k, d])!r}" for k in outside for d in range(dim)]
        lines += ["1000, 3, 5"] if kind.generalised else []
        lines += ["ALL, 11, 11"] if kind.coupled else []
        lines += [
            "*OUTPUT, FIELD",
            "*ELEMENT OUTPUT",
            "S",
            "*OUTPUT, HISTORY",
            "*NODE OUTPUT, NSET=ALL",
            "U",
            "*END STEP",
        ]
    result = run_deck(lines)
    found = [[result.history[f"U{d + 1}[ALL:{k + 1}]"][-1] for d in range(dim)] for k in range(len(nodes))]
    np.testing.assert_allclose(found, moved, atol=1e-9)
    stretch = gradients[0]
    rotation = gradients[-1] @ np.linalg.inv(stretch)
    strain = (stretch - np.eye(3)) @ np.linalg.inv((stretch + np.eye(3)) / 2)
    expected = rotation @ stress_of(kind, strain) @ rotation.T
    for place, component in zip(((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)), kind.components, strict=False):
        np.testing.assert_allclose(result.field(f"S{component}"), expected[place], atol=SINGLE * abs(expected).max())


@pytest.mark.parametrize("element_type", [name for name, kind in SOLIDS.items() if kind.coupled is kind.generalised])
def test_mass_of_a_translation(load, call, tmp_path, element_type):
    """Density times volume along each direction, about an axis along it alone."""
    kind = SOLIDS[element_type]
    lines, nodes, _ = body(element_type)
    deck = tmp_path / "mass.inp"
    deck.write_text("\n".join([*lines, "*STEP\n*FREQUENCY\n1\n*END STEP\n"]))
    model = read_deck(deck)
    system = system_of(model, load(None))
    zero = np.zeros(len(system))
    evaluation = system.evaluate(call.asking(Request.MASS), zero, zero)
    mass = sp.csr_array((evaluation.data, system.indices, system.indptr), shape=(len(zero),) * 2)
    area = np.pi * (2.0**2 - 1.0**2) if kind.axisymmetric else 1.0
    volume = area * (THICKNESS if kind.dimension == 2 and not kind.axisymmetric else 1.0)
    for direction in (2,) if kind.axisymmetric else range(1, kind.dimension + 1):
        moves = zero.copy()
        moves[system.dofs.find(np.arange(len(nodes)), direction)] = 1.0
        assert moves @ mass @ moves == pytest.approx(DENSITY * volume, rel=1e-12)
