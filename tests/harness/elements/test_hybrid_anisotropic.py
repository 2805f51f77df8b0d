# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hybrid elements of anisotropic and of uneven elastic materials: their eliminated pressure.

The energy is stationary in the pressure, so that forces are its derivatives (fortran/host/elements/solid/hybrid.f90).
"""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from reference_cells import patch_of
from small_decks import body_lines

from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Flags, Predefined
from uel.model.element_types import BUILT_IN, HYBRID, ContinuumType

STEEP = np.radians(20.0)
AXES = {
    2: np.array([[np.cos(STEEP), np.sin(STEEP), 0.0], [-np.sin(STEEP), np.cos(STEEP), 0.0], [0.0, 0.0, 1.0]]),
    3: np.linalg.qr(np.array([[1.0, 0.4, 0.1], [-0.3, 1.0, 0.2], [0.1, -0.5, 1.0]]))[0].T,
}
CONSTANTS = (138.0, 10.5, 9.5, 0.3, 0.25, 0.45, 6.3, 5.3, 3.5)
ORTHOTROPIC = "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n" + ", ".join(map(str, CONSTANTS[:8])) + f"\n{CONSTANTS[8]}"
SINGLE = 2.0**-23
"""Field output has single precision."""
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
STATIC = [name for name, kind in HYBRID.items() if not (kind.coupled or kind.generalised)]


def stress_of(strain, axes):
    """Hooke's law of the orthotropic material, by a symmetric strain (3, 3)."""
    e1, e2, e3, nu12, nu13, nu23, *shear = CONSTANTS
    compliance = np.array([[1 / e1, -nu12 / e1, -nu13 / e1], [-nu12 / e1, 1 / e2, -nu23 / e2], [0, 0, 1 / e3]])
    compliance[2, :2] = compliance[:2, 2]
    local = axes @ strain @ axes.T
    stress = np.diag(np.linalg.solve(compliance, np.diag(local)))
    for (i, j), modulus in zip(PAIRS[3:], shear, strict=True):
        stress[i, j] = stress[j, i] = 2 * modulus * local[i, j]
    return axes.T @ stress @ axes


def body(element_type, material, orientation=None):
    """Deck of a distorted patch up to its steps, and its nodes."""
    kind = BUILT_IN[element_type]
    assert isinstance(kind, ContinuumType)
    nodes, elements = patch_of(kind.family.cell)
    if kind.axisymmetric:
        nodes[:, 0] += 1.0
    lines = body_lines(element_type, nodes, elements)
    reference = ""
    if kind.generalised:
        lines += ["*NODE, NSET=REF", "1000, 0.4, 0.3"]
        reference = ", REF NODE=REF"
    if orientation is not None:
        lines += ["*ORIENTATION, NAME=O", ", ".join(map(repr, map(float, orientation[:2].ravel())))]
        reference += ", ORIENTATION=O"
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{reference}", "1."]
    return [*lines, "*MATERIAL, NAME=M", material, *(["*CONDUCTIVITY\n1."] if kind.coupled else [])], nodes


@pytest.mark.parametrize("element_type", [name for name in STATIC if not HYBRID[name].axisymmetric])
def test_patch_of_an_orthotropic_material(run_deck, element_type):
    """The boundary has the displacements of a uniform strain; what is inside follows in one iteration, and the stress
    is that of Hooke's law."""
    kind = HYBRID[element_type]
    axes = AXES[kind.dimension]
    lines, nodes = body(element_type, ORTHOTROPIC, axes)
    gradient = 1e-3 * np.array([[1.0, 0.4, -0.3], [0.2, -0.7, 0.5], [0.1, 0.3, 0.6]])
    gradient[kind.dimension :] = gradient[:, kind.dimension :] = 0.0
    moved = nodes @ gradient[: kind.dimension, : kind.dimension].T
    outside = (np.isclose(nodes, nodes.min(axis=0)) | np.isclose(nodes, nodes.max(axis=0))).any(axis=1)
    lines += ["*STEP\n*STATIC\n1., 1.\n*CONTROLS, PARAMETERS=FIELD\n1e-9, 1e-9\n*BOUNDARY"]
    for k in np.flatnonzero(outside):
        lines += [f"{k + 1}, {d + 1}, {d + 1}, {float(value)!r}" for d, value in enumerate(moved[k])]
    lines += ["*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*END STEP\n"]
    result = run_deck(lines)
    assert result.status[-1].total_iterations == 1
    found = [[result.history[f"U{d + 1}[ALL:{k + 1}]"][-1] for d in range(kind.dimension)] for k in range(len(nodes))]
    # history output has nine digits
    np.testing.assert_allclose(found, moved, atol=1e-11)
    stress = stress_of((gradient + gradient.T) / 2, axes)
    # components are those of the directions of *ORIENTATION
    stress = axes @ stress @ axes.T
    for place, component in zip(PAIRS, kind.components, strict=False):
        np.testing.assert_allclose(result.field(f"S{component}"), stress[place], atol=2 * SINGLE * abs(stress).max())


CALL = Call(Flags(1), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)


@pytest.mark.parametrize("element_type", [name for name, kind in HYBRID.items() if not kind.coupled])
@pytest.mark.parametrize("even", [True, False])
def test_forces_are_derivatives_of_the_energy(load, tmp_path, element_type, even):
    """In small displacements: the matrix is symmetric, forces are its product, and the energy is half of their work.
    Where the temperature is uneven, the moduli of an isotropic material differ from point to point."""
    kind = BUILT_IN[element_type]
    if even:
        lines, _ = body(element_type, ORTHOTROPIC, AXES[kind.dimension])
    else:
        lines, _ = body(element_type, "*ELASTIC\n1., 0.3, 0.\n10., 0.45, 1.")
    deck = tmp_path / "patch.inp"
    deck.write_text("\n".join([*lines, "*STEP\n*STATIC\n*TEMPERATURE\nALL, 0.5\n*END STEP\n"]))
    model = read_deck(deck)
    system = system_of(model, load(None))
    random = np.random.default_rng(5)
    size = len(model.mesh.labels)
    temperatures = (random.uniform(0, 1, size) if not even else np.full(size, 0.5))[None]
    call = replace(CALL, predefined=Predefined(temperatures, temperatures, np.zeros(size)))
    u = random.standard_normal(len(system))
    evaluation = system.evaluate(call, u, u)
    matrix = sp.csr_array((evaluation.data, system.indices, system.indptr), shape=(u.size,) * 2).toarray()
    # rounding, with some hundred terms
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-12 * abs(matrix).max())
    np.testing.assert_allclose(matrix @ u, -evaluation.residual, rtol=0, atol=1e-12 * abs(matrix).max() * u.size)
    work = -evaluation.residual @ u
    # that of hourglass control is apart
    assert evaluation.energy[[1, 5]].sum() == pytest.approx(work / 2, rel=1e-11)
