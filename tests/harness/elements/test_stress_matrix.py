# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Initial stress matrix of built-in elements: the part that stresses have in the tangent of large displacements."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_cells import affine

from uel.elements import Flags, Request, build_blocks
from uel.model.element_types import CONTINUUM, GENERALISED, Tensor
from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.model.steps import InitialStress

KINDS = CONTINUUM | GENERALISED
TYPES = [name for name, kind in KINDS.items() if not kind.coupled]


STRESS = (3.0, -2.0, 1.0, 0.5, 0.4, 0.3)


@pytest.fixture
def element(solid_group, load, call):
    """Its block, the matrix of a request, and a random displacement."""

    def element(element_type, *, stressed=False):
        kind = KINDS[element_type]
        nodes, _ = affine(kind.family.cell)
        if kind.axisymmetric:
            nodes = nodes + np.array([2.0, 0.0])
        nodes = nodes + 0.03 * np.random.default_rng(1).standard_normal(nodes.shape)
        group = solid_group(element_type, np.arange(len(nodes))[None], 1.5)
        # behind them a reference node
        group = replace(group, section=replace(group.section, reference=len(nodes) if kind.generalised else -1))
        places = np.pad(np.vstack([nodes, nodes[:1] + 0.3]), ((0, 0), (0, 3 - nodes.shape[1])))
        mesh = Mesh(np.arange(len(places)) + 1, places, ("",) * len(places))
        count = 3 if kind.tensor is Tensor.PLANE_STRESS else len(kind.components)
        initial = InitialStress(np.array([0]), np.array(STRESS[:count]), True, group.source)
        model = Model(Path("test.inp"), "", mesh, (group,), (), initial_stresses=(initial,) if stressed else ())
        (block,) = build_blocks(model, load(None))
        n = len(block.unknowns)
        block.bind(np.arange(n, dtype=np.int32)[None], np.arange(n * n, dtype=np.int32).reshape(1, n, n))
        if stressed:
            block.initial.set_stress(np.array([0]), initial.values)
            block.begin_stressed(call, np.zeros(n), np.zeros(n))
        u = 1e-3 * np.random.default_rng(2).standard_normal(n)

        def evaluate(request, at, du, *, nlgeom):
            matrix = np.zeros(n * n)
            now = replace(call, flags=Flags(1, nlgeom, request))
            if request is Request.NORMAL:
                block.evaluate(now, at, du, np.zeros(n), matrix)
            else:
                block.stress_matrix(now, at, du, matrix)
            return matrix.reshape(n, n)

        return evaluate, u

    return element


@pytest.mark.parametrize("element_type", TYPES)
def test_stress_of_displacements(element, element_type):
    """In small displacements a perturbation has the matrix of the state that it leads to, a symmetric one."""
    evaluate, u = element(element_type)
    zero = np.zeros_like(u)
    added = evaluate(Request.ADDED_STRESS, zero, u, nlgeom=False)
    base = evaluate(Request.BASE_STRESS, u, zero, nlgeom=False)
    assert abs(added).max() > 0
    np.testing.assert_allclose(added, base, atol=1e-12 * abs(base).max())
    np.testing.assert_allclose(added, added.T, atol=1e-12 * abs(base).max())
    np.testing.assert_allclose(evaluate(Request.BASE_STRESS, zero, zero, nlgeom=False), 0, atol=1e-14)


@pytest.mark.parametrize("element_type", [name for name in TYPES if not KINDS[name].pressures])
def test_part_of_the_tangent(element, element_type):
    """What the tangent of NLGEOM in the shape without displacements gains by an initial stress.

    That of hybrid elements has the pressure times the change of the volume in place of a stress that turns.
    Incompatible modes follow the displacements as without the stress, which is exact to its first order: its ratio to E
    is 0.003.
    """
    (without, u), (stressed, _) = (element(element_type, stressed=given) for given in (False, True))
    tangents = [evaluate(Request.NORMAL, 0 * u, 0 * u, nlgeom=True) for evaluate in (without, stressed)]
    found = stressed(Request.BASE_STRESS, 0 * u, 0 * u, nlgeom=True)
    assert abs(found).max() > 0
    tolerance = 1e-12 * abs(tangents[0]).max()
    if KINDS[element_type].incompatible:
        tolerance = 3e-3 * abs(found).max()
    np.testing.assert_allclose(found, tangents[1] - tangents[0], rtol=0, atol=tolerance)
