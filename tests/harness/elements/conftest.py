# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Blocks for tests without a deck and without the assembly."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from material_point import COMPONENTS, MaterialPoint

from uel import usersub
from uel.elements import Call, Flags, Request, build_blocks
from uel.errors import Source
from uel.model.element_types import CONTINUUM
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import (
    Elastic,
    ElasticType,
    Material,
    SectionControls,
    SolidSection,
    UserElement,
    UserProperty,
)

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 7)


@pytest.fixture
def call():
    return Call(Flags(1), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)


@pytest.fixture
def load(tmp_path):
    """Load a file of this folder, a text as a file, or None, as the job's user routines."""

    def load(source):
        if source is None:
            file = None
        elif "\n" in source:
            file = tmp_path / "user.f"
            file.write_text(source)
        else:
            file = HERE / source
        return usersub.load(file, job="job", output_dir=tmp_path / "out")

    return load


@pytest.fixture
def user_group():
    """Group of user elements U1, numbered from 101."""

    def user_group(nodes, dofs, *, properties=(), integers=(), material=None, orientation=None, **definition):
        element = UserElement(
            1, nodes.shape[1], dofs, SOURCE, properties=len(properties), integer_properties=len(integers), **definition
        )
        reals, whole = np.array(properties, dtype=float), np.array(integers, dtype=np.int64)
        section = UserProperty("ALL", SOURCE, reals, whole, material, orientation)
        return ElementGroup("U1", 101 + np.arange(len(nodes)), nodes, "", section, element, SOURCE)

    return user_group


@pytest.fixture
def solid_group():
    """Group of built-in elements, numbered from 101; isotropic, E 1000, nu 0.3 unless given."""

    def solid_group(element_type, nodes, thickness, *, elastic=None, plastic=None, orientation=None):
        elastic = elastic or Elastic(ElasticType.ISOTROPIC, (1000.0, 0.3), SOURCE)
        material = Material("M", SOURCE, elastic, plastic)
        section = SolidSection("ALL", material, orientation, thickness, SOURCE)
        return ElementGroup(element_type, 101 + np.arange(len(nodes)), nodes, "", section, None, SOURCE)

    return solid_group


@pytest.fixture
def bound():
    """Block of one group, bound to node-major unknowns, and a zero CSR matrix with its pattern."""

    def bound(group, coordinates, library, steps=()):
        labels = np.arange(1, len(coordinates) + 1)
        mesh = Mesh(labels, coordinates, ("",) * len(labels))
        (block,) = build_blocks(Model(Path("test.inp"), "", mesh, (group,), steps), library)
        local, dof = np.array(block.unknowns).T
        per_node = dof.max()
        equations = (group.nodes[:, local] * per_node + dof - 1).astype(np.int32)
        rows, columns = np.broadcast_arrays(equations[:, :, None], equations[:, None, :])
        shape = (per_node * len(coordinates),) * 2
        matrix = sp.csr_array((np.ones(rows.size), (rows.ravel(), columns.ravel())), shape=shape)
        matrix.sum_duplicates()
        matrix.data[:] = np.arange(matrix.nnz)
        scatter = matrix[rows.ravel(), columns.ravel()].reshape(rows.shape).astype(np.int32)
        matrix.data[:] = 0
        block.bind(equations, scatter)
        return block, matrix

    return bound


@pytest.fixture
def material_point(load, user_group, bound, call):
    """A point of a material, in a user element of its own."""

    def material_point(material, tensor, *, orientation=None, integers=(1, 0), user="point.f", **definition):
        group = user_group(
            np.array([[0]]),
            tuple((0, dof + 1) for dof in range(len(COMPONENTS.get(tensor, range(3))))),
            integers=integers,
            material=material,
            orientation=orientation,
            tensor=tensor,
            **definition,
        )
        library = load(user)
        return MaterialPoint(library, *bound(group, np.zeros((1, 3)), library), call)

    return material_point


@pytest.fixture
def forces_of(solid_group, bound, load, call):
    """Force, tangent and energies of an element, or of some, by the displacements (nodes, directions)."""

    def forces_of(element_type, nodes, *, elements=None, young=1000.0, nu=0.3, nlgeom=False, **options):
        elastic = Elastic(ElasticType.ISOTROPIC, (young, nu), SOURCE)
        elements = np.arange(len(nodes))[None] if elements is None else elements
        group = solid_group(element_type, elements, 1.0, elastic=elastic)
        group = replace(group, section=replace(group.section, **options))
        block, matrix = bound(group, nodes, load(None))
        now = replace(call, flags=Flags(1, nlgeom))

        def evaluate(u):
            u = np.asarray(u, dtype=float)[:, : CONTINUUM[element_type].dimension]
            residual = np.zeros(u.size)
            matrix.data[:] = 0
            report = block.evaluate(now, u.ravel(), u.ravel(), residual, matrix.data)
            return -residual.reshape(u.shape), matrix.toarray(), report.energy

        return evaluate

    return forces_of


@pytest.fixture
def response(bound, load, call):
    """Force, tangent and energies of elements by their unknowns, node by node; their block is an attribute."""

    def response(group, nodes, *, nlgeom=False, user=None):
        block, matrix = bound(group, nodes, load(user))

        def evaluate(u, du=None, *, request=Request.NORMAL):
            u = np.asarray(u, dtype=float).ravel()
            residual = np.zeros(u.size)
            matrix.data[:] = 0
            now = replace(call, flags=Flags(1, nlgeom, request=request))
            report = block.evaluate(now, u, u if du is None else du, residual, matrix.data)
            return -residual, matrix.toarray(), report.energy

        evaluate.block = block
        return evaluate

    return response


@pytest.fixture
def control_of(forces_of):
    """Force and tangent of the hourglass control alone: total stiffness of a parameter, or enhanced (None)."""

    def control_of(element_type, nodes, parameter, **options):
        ways = [{"hourglass": r} for r in (1.0, 2.0)]
        ways += [{"controls": SectionControls(enhanced=True)} if parameter is None else {"hourglass": parameter}]
        solids = [forces_of(element_type, nodes, **way, **options) for way in ways]

        def evaluate(u):
            found = [solid(u)[:2] for solid in solids]
            # force and tangent are linear in the parameter: what they are with none
            return tuple(wanted - (2 * one - two) for one, two, wanted in zip(*found, strict=True))

        return evaluate

    return control_of
