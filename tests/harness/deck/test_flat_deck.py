# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A flat deck with user elements, as written by hand."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from uel.deck import read_deck
from uel.errors import DeckError
from uel.model.model import Model
from uel.model.properties import ElasticType, UserProperty

Read = Callable[[str], Model]
FLAT = Path(__file__).with_name("flat.inp").read_text()


@pytest.fixture
def model(read: Read) -> Model:
    return read(FLAT)


def test_mesh(model: Model) -> None:
    assert model.heading == "Two quads and an interface"
    assert_array_equal(model.mesh.labels, range(1, 9))
    assert_allclose(model.mesh.coordinates[6], [1, 2, 0])
    assert [group.type for group in model.groups] == ["U1", "U2"]
    assert_array_equal(model.groups[0].labels, [1, 2])
    assert_array_equal(model.groups[1].nodes, [[3, 2, 5, 4]])


def test_sets(model: Model) -> None:
    assert_array_equal(model.nsets["ALL"], range(8))
    assert_array_equal(model.nsets["BOTTOM"], [0, 1])
    assert_array_equal(model.nsets["TOP"], [6, 7])
    assert_array_equal(model.elsets["INTERFACE"], [2])


def test_user_elements(model: Model) -> None:
    continuum, interface = (group.definition for group in model.groups)
    assert continuum is not None
    assert interface is not None
    assert (continuum.number, continuum.integration, continuum.tensor) == (1, 4, "PSTRESS")
    assert continuum.dofs == ((0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2), (3, 1), (3, 2))
    assert (interface.properties, interface.integer_properties, interface.variables) == (3, 2, 16)
    assert interface.unsymmetric
    assert not continuum.unsymmetric


def test_properties(model: Model) -> None:
    continuum, interface = (group.section for group in model.groups)
    assert isinstance(continuum, UserProperty)
    assert isinstance(interface, UserProperty)
    assert_array_equal(continuum.values, [20])
    assert continuum.material is not None
    assert continuum.material.elastic is not None
    assert continuum.material.elastic.type is ElasticType.ISOTROPIC
    assert continuum.material.elastic.constants == (70000, 0.3)
    assert_array_equal(interface.values, [10, 1e6, 1e-3])
    assert_array_equal(interface.integers, [3, -4])


def test_boundaries_before_the_steps(model: Model) -> None:
    # PINNED holds dofs 1-3, of which these elements have two
    assert [(entry.dof, entry.magnitude) for entry in model.boundaries] == [(1, 0), (2, 0)]


def test_step(model: Model) -> None:
    (step,) = model.steps
    assert (step.number, step.name, step.title, step.increments) == (1, "LOAD", "pull", 500)
    assert not step.nlgeom
    procedure = step.procedure
    assert (procedure.initial, procedure.period, procedure.minimum, procedure.maximum) == (0.1, 1, 1e-8, 0.25)
    assert not procedure.direct
    assert [(entry.dof, entry.magnitude) for entry in step.boundaries] == [(2, 0.1), (1, 0)]
    assert step.boundaries[0].amplitude is not None
    assert step.boundaries[0].amplitude.value(0.25, 7.0) == 0.25
    assert str(step.boundaries[0].source) == "deck.inp:46"
    assert [(entry.nodes.tolist(), entry.dof, entry.magnitude) for entry in step.loads] == [([2], 1, 5)]
    assert not step.new_boundary


def test_output_requests(model: Model) -> None:
    output = model.steps[0].output
    assert output.field_frequency == 5
    assert [(request.nset, request.variables) for request in output.history_nodes] == [("TOP", ("U2", "RF2"))]
    assert output.history_energies == ("ALLSE", "ALLPD")
    assert [(request.nset, request.variables, request.totals) for request in output.node_print] == [
        ("TOP", ("U", "RF"), True)
    ]
    assert [(request.elements.tolist(), request.variables, request.frequency) for request in output.element_print] == [
        ([2], ("SDV",), 10)
    ]
    assert output.monitor == (6, 2)


def test_what_is_ignored_is_listed(model: Model) -> None:
    assert [(name, str(place)) for name, place in model.ignored] == [("PREPRINT", "deck.inp:63")]


CONTACT = "*SURFACE INTERACTION, NAME=TOUCH\n1.\n*FRICTION\n0.3,\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"


def test_contact_properties_that_nothing_uses(read: Read) -> None:
    text = FLAT.replace("*STEP", f"{CONTACT}*STEP", 1)
    line = FLAT[: FLAT.index("*STEP")].count("\n") + 1
    assert [(name, str(place)) for name, place in read(text).ignored[:3]] == [
        ("SURFACE INTERACTION", f"deck.inp:{line}"),
        ("FRICTION", f"deck.inp:{line + 2}"),
        ("SURFACE BEHAVIOR", f"deck.inp:{line + 4}"),
    ]
    # an option of a contact property is none of the material before it
    dense = text.replace("*FRICTION\n0.3,", "*DENSITY\n1.")
    with pytest.raises(DeckError, match=rf"deck.inp:{line + 2}: \*DENSITY: does not follow \*MATERIAL"):
        read(dense)


@pytest.mark.parametrize(
    "change",
    [
        pytest.param(lambda text: text.replace("\n", "\r\n"), id="CRLF"),
        pytest.param(lambda text: text.replace("\n", "\r"), id="CR"),
        pytest.param(lambda text: text.replace(", ", ",\t "), id="tabs"),
        pytest.param(lambda text: text.lower(), id="lower case"),
        pytest.param(lambda text: text.upper(), id="upper case"),
        pytest.param(lambda text: text.replace("\n*", "\n  *"), id="blanks before keywords"),
        pytest.param(lambda text: text.replace("USER ELEMENT", "USERELEMENT"), id="no blanks in keywords"),
        pytest.param(lambda text: text.replace("*BOUNDARY", "*BOUND"), id="beginning of a keyword"),
        pytest.param(lambda text: text.replace("\n*NODE,", "\n\n\n*NODE,"), id="blank lines"),
        pytest.param(lambda text: text.replace("TYPE=U2", "TYPE = U2 "), id="blanks around ="),
        pytest.param(lambda text: text.replace("., 0.\n", "., 0.,\n"), id="trailing commas of nodes"),
        pytest.param(lambda text: text.replace("1, 2, 3, 4\n", "1, 2, 3, 4,\n"), id="trailing comma of an element"),
        pytest.param(lambda text: text.replace("1, 2, 3, 4\n", "1, 2,\n** comment\n3, 4\n"), id="long element"),
        pytest.param(lambda text: text.replace("COORDINATES=2, ", "COORDINATES=2,\n** comment\n "), id="long keyword"),
        pytest.param(lambda text: text.replace("*NODE, NSET=ALL\n", "*NODE, NSET=ALL,\n"), id="keyword ends in comma"),
        pytest.param(lambda text: text.replace("NSET=TOP", 'NSET="Top"'), id="quotes"),
        pytest.param(lambda text: text.replace("0.1, 1., 1.E-8", ".1, 1.0E0, 1.d-8"), id="numbers"),
        pytest.param(lambda text: text.replace("1.E6", "1E6.0"), id="exponent with a point"),
        pytest.param(lambda text: text.replace("GENERATE\n1, 2, 1", "GENERATE\n1, 2"), id="generate without increment"),
        pytest.param(lambda text: "\ufeff" + text, id="byte order mark"),
        pytest.param(lambda text: text.removesuffix("\n"), id="no newline at the end"),
    ],
)
def test_spellings_that_mean_the_same(read: Read, model: Model, change: Callable[[str], str]) -> None:
    other = read(change(FLAT))
    assert_array_equal(other.mesh.coordinates, model.mesh.coordinates)
    for group, reference in zip(other.groups, model.groups, strict=True):
        assert (group.type, group.labels.tolist()) == (reference.type, reference.labels.tolist())
        assert_array_equal(group.nodes, reference.nodes)
        assert isinstance(group.section, UserProperty)
        assert isinstance(reference.section, UserProperty)
        assert_array_equal(group.section.values, reference.section.values)
    assert other.steps[0].procedure == model.steps[0].procedure
    assert {name: nodes.tolist() for name, nodes in other.nsets.items()} == {
        name: nodes.tolist() for name, nodes in model.nsets.items()
    }
    assert other.steps[0].output.history_nodes[0].variables == ("U2", "RF2")


def test_elements_may_come_before_the_user_element(read: Read, model: Model) -> None:
    start, end = FLAT.index("*USER ELEMENT"), FLAT.index("*NODE, NSET=ALL")
    other = read(FLAT[:start] + FLAT[end:].replace("*MATERIAL", FLAT[start:end] + "*MATERIAL", 1))
    assert [group.definition and group.definition.dofs for group in other.groups] == [
        group.definition and group.definition.dofs for group in model.groups
    ]


def test_latin_1(tmp_path: Path) -> None:
    path = tmp_path / "latin.inp"
    path.write_bytes(FLAT.replace("interface\n", "Grenzfl\u00e4che\n", 1).encode("latin-1"))
    assert read_deck(path).heading == "Two quads and an Grenzfl\u00e4che"


def test_elements_are_called_in_ascending_order(read: Read) -> None:
    """Runs of one type and section; a new one wherever the ascending numbers change type or section."""
    text = FLAT.replace("101, 4, 3, 6, 5", "102, 4, 3, 6, 5").replace("2, 5, 6, 7, 8", "205, 5, 6, 7, 8")
    model = read(text)
    assert [(group.type, group.labels.tolist()) for group in model.groups] == [
        ("U1", [1]),
        ("U2", [102]),
        ("U1", [205]),
    ]
    assert_array_equal(model.elsets["BULK"], [0, 2])
    assert_array_equal(np.concatenate([group.labels for group in model.groups]), [1, 102, 205])
