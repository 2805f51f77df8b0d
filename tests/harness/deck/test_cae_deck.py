# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A deck in the manner of Abaqus/CAE: parts, instances with translation and rotation, assembly sets."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from uel.model.model import Model
from uel.model.properties import SolidSection
from uel.model.restart import RestartWrite
from uel.model.steps import Boundary

Read = Callable[[str], Model]
CAE = Path(__file__).with_name("cae.inp").read_text()


@pytest.fixture
def model(read: Read) -> Model:
    return read(CAE)


def test_instances_are_placed(model: Model) -> None:
    """The second plate moves by 5 in x, then turns by 90 degrees about z through (5, 0, 0)."""
    assert [model.mesh.name(node) for node in (0, 4, 8)] == ["PLATE-1.1", "PLATE-2.1", "1"]
    assert_allclose(model.mesh.coordinates[4:8], [[5, 0, 0], [5, 2, 0], [4, 2, 0], [4, 0, 0]], atol=1e-15)
    assert_allclose(model.mesh.coordinates[8], [10, 0, 0])


def test_orientation_turns_with_its_instance(model: Model) -> None:
    first, second = model.groups[0].section, model.groups[1].section
    assert isinstance(first, SolidSection)
    assert isinstance(second, SolidSection)
    assert first.orientation is not None
    assert second.orientation is not None
    assert first.thickness == 20
    assert first.material.density == 7.8e-9
    assert_allclose(first.orientation.axes, np.eye(3))
    assert_allclose(second.orientation.axes, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-15)


def test_sets_of_one_name_in_different_scopes(model: Model) -> None:
    assert_array_equal(model.nsets["SET-1"], [0, 3, 5])
    assert_array_equal(model.nsets["PLATE-1.SET-1"], [0])
    assert_array_equal(model.nsets["PLATE-2.ALL"], [4, 5, 6, 7])
    assert_array_equal(model.elsets["SET-1"], [0])
    assert_array_equal(model.elsets["PLATE-2.SET-1"], [1])


def test_element_between_instances(model: Model) -> None:
    group = model.groups[2]
    assert (group.type, group.instance) == ("U7", "")
    assert_array_equal(group.nodes, [[2, 4]])


def test_references_in_steps(model: Model) -> None:
    def entries(boundaries: tuple[Boundary, ...]) -> list[tuple[list[int], int, float]]:
        return [(entry.nodes.tolist(), entry.dof, entry.magnitude) for entry in boundaries]

    assert entries(model.boundaries) == [([0], 1, 0), ([0], 2, 0)]
    assert entries(model.steps[0].boundaries) == [([0, 3, 5], 1, 0.5), ([7], 1, 0), ([7], 2, 0)]


def test_equation_over_a_set(model: Model) -> None:
    assert [equation.terms for equation in model.equations] == [
        ((0, 2, 1.0), (1, 2, -1.0)),
        ((3, 2, 1.0), (1, 2, -1.0)),
        ((5, 2, 1.0), (1, 2, -1.0)),
    ]


def test_step_and_ignored(model: Model) -> None:
    assert model.steps[0].nlgeom
    assert model.steps[0].output.field_frequency == 1
    assert "ALLIE" in model.steps[0].output.history_energies
    assert [name for name, _ in model.ignored] == ["PREPRINT"]
    assert model.steps[0].restart == RestartWrite(frequency=0)
