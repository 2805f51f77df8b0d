# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solids beside which elements that own them are wrong or doubtful: each reason, its place and its weight."""

import re

import numpy as np
import pytest

from uel.deck.reader import read_deck
from uel.delamination.kernels import uel_property, user_element
from uel.elements.interfaces.neighbour_solids import (
    Neighbours,
    States,
    examine,
    find_faults,
    formulation_of,
    owns_solids,
    solids_of,
    standard_type,
)
from uel.model.element_types import BUILT_IN
from uel.usersub.layout import element_layouts

ELASTIC = "*ELASTIC\n1e4, 0.3"
EXPANDING = f"{ELASTIC}\n*EXPANSION\n2e-5"
DEFINITION = "\n".join(user_element(4))
PROPERTIES = "\n".join(uel_property(4, "INTERFACE", {}))
HEATED = "*TEMPERATURE\n{upper}, 100."


def quads(kind="CPS4", material="", model="", step="", section=""):
    """Two quads with U4 between them: element 3, nodes 1 to 4 and 5 to 8."""
    return (
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0., 1.\n6, 1., 1.\n7, 1., 2.\n8, 0., 2.\n"
        f"9, 3., 0.\n*NSET, NSET=UPPER\n5, 6, 7, 8\n*NSET, NSET=AWAY\n9\n"
        f"*ELEMENT, TYPE={kind}, ELSET=LOW\n1, 1, 2, 3, 4\n*ELEMENT, TYPE={kind}, ELSET=HIGH\n2, 5, 6, 7, 8\n"
        f"{DEFINITION}\n"
        "*ELEMENT, TYPE=U4, ELSET=INTERFACE\n3, 1, 2, 3, 4, 5, 6, 7, 8\n"
        f"{PROPERTIES}\n"
        "*MATERIAL, NAME=PLAIN\n*ELASTIC\n1e4, 0.3\n"
        f"*MATERIAL, NAME=OTHER\n{material or ELASTIC}\n"
        f"*SOLID SECTION, ELSET=LOW, MATERIAL=PLAIN{section}\n1.\n"
        f"*SOLID SECTION, ELSET=HIGH, MATERIAL=OTHER{section}\n1.\n"
        f"{model}\n*STEP\n*STATIC\n1., 1.\n{step.format(upper='UPPER', away='AWAY')}\n*END STEP\n"
    )


def examined(folder, text):
    """Findings with their line of the deck."""
    path = folder / "deck.inp"
    path.write_text(re.sub(r"\n+", "\n", text))
    model = read_deck(path)
    lines = path.read_text().splitlines()
    return [(each, lines[each.source.line - 1]) for each in examine(model, model.groups)]


def test_elastic_solids_have_no_finding(tmp_path):
    assert examined(tmp_path, quads()) == []
    assert examined(tmp_path, quads("CPS4I")) == []


def test_expansion_that_changes_is_wrong_where_the_temperature_of_the_solid_does(tmp_path):
    warm = f"{ELASTIC}\n*EXPANSION\n2e-5, 0.\n3e-5, 100."
    assert examined(tmp_path, quads(material=EXPANDING, step=HEATED)) == []
    ((found, line),) = examined(tmp_path, quads(material=warm, step=HEATED))
    assert found.wrong and line == "UPPER, 100."
    assert re.match(
        r"U4 has one expansion along each axis of a ply, at all temperatures: material OTHER of the CPS4 beside it has "
        r"\*EXPANSION \(.*deck.inp:\d+\), which is another; take U2",
        found.message,
    )
    # an initial temperature alone strains nothing, nor does the same one again, nor that of other nodes
    initial = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nUPPER, 100."
    assert examined(tmp_path, quads(material=warm, model=initial)) == []
    assert examined(tmp_path, quads(material=warm, model=initial, step=HEATED)) == []
    assert examined(tmp_path, quads(material=warm, step="*TEMPERATURE\n{away}, 100.")) == []
    assert examined(tmp_path, quads(material=f"{ELASTIC}\n*EXPANSION\n0.", step=HEATED)) == []
    # no expansion, no strain
    assert examined(tmp_path, quads(step=HEATED)) == []
    # the same temperature through an amplitude is another one
    ramped = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nUPPER, 100.\n*AMPLITUDE, NAME=A\n0., 0., 1., 1."
    step = HEATED.replace("*TEMPERATURE", "*TEMPERATURE, AMPLITUDE=A")
    assert len(examined(tmp_path, quads(material=warm, model=ramped, step=step))) == 1


def test_initial_stress_that_varies_is_wrong(tmp_path):
    assert examined(tmp_path, quads(model="*INITIAL CONDITIONS, TYPE=STRESS\n2, 0., 5., 0.")) == []
    by_user = "*INITIAL CONDITIONS, TYPE=STRESS, USER"
    ((found, line),) = examined(tmp_path, quads(model=by_user))
    assert found.wrong and line == by_user
    message = "U4 takes an initial stress by components, and that of the CPS4 beside it varies; take U2"
    assert found.message.startswith(message)


@pytest.mark.parametrize(
    ("material", "line", "message", "wrong"),
    [
        (f"{ELASTIC}\n*PLASTIC\n10., 0.", "*PLASTIC", r"\*PLASTIC of material OTHER .* once it yields; take U2", False),
        (f"{ELASTIC}\n*CREEP\n1e-9, 2., 0.", "*CREEP", r"\*CREEP of material OTHER .*takes it as elastic", True),
        (
            f"{ELASTIC}\n*VISCOELASTIC, TIME=PRONY\n0.5, 0.5, 1.",
            "*VISCOELASTIC, TIME=PRONY",
            r"\*VISCOELASTIC of material OTHER .*takes it as elastic",
            True,
        ),
        (
            "*USER MATERIAL, CONSTANTS=1\n1.",
            "*USER MATERIAL, CONSTANTS=1",
            r"\*USER MATERIAL of material OTHER .*moduli of its properties",
            False,
        ),
        (
            "*ELASTIC, DEPENDENCIES=0\n1e4, 0.3, 0.\n2e4, 0.3, 100.",
            "*ELASTIC, DEPENDENCIES=0",
            r"\*ELASTIC of material OTHER .*the same moduli throughout",
            False,
        ),
    ],
)
def test_materials_that_are_not_elastic(tmp_path, material, line, message, wrong):
    ((found, where),) = examined(tmp_path, quads(material=material))
    assert re.search(message, found.message)
    assert found.wrong is wrong and where == line


def test_hyperelastic_material(tmp_path):
    text = quads("CPE4", "*HYPERELASTIC, NEO HOOKE\n80., 1e-3")
    ((found, line),) = examined(tmp_path, text)
    assert re.search(r"\*HYPERELASTIC of material OTHER .*linear elastic", found.message)
    assert not found.wrong and line == "*HYPERELASTIC, NEO HOOKE"


@pytest.mark.parametrize(
    ("kind", "formulation"),
    [
        *(("CPS4", 0), ("CPS4I", 1), ("CPS4R", 3), ("CPE4", 2), ("CPE4I", 1), ("CPE4R", 3), ("CPS8", 0), ("CPS8R", 3)),
        *(("C3D8", 2), ("C3D8I", 1), ("C3D8R", 3), ("C3D20", 0), ("C3D20R", 3), ("C3D8H", 2), ("CPS3", 0), ("CPE6", 0)),
        *(("C3D4", 0), ("C3D6", 0), ("C3D10", 0), ("C3D15", 0)),
    ],
)
def test_formulations_of_built_in_elements(kind, formulation):
    assert formulation_of(BUILT_IN[kind]) == formulation


def test_other_elements(tmp_path):
    found = examined(tmp_path, quads("CPEG4", section=", REF NODE=9"))
    assert [each.wrong for each, _ in found] == [True, True]
    assert re.match(r"CPEG4 beside U4 \(element 1\) strains normal to the plane", found[0][0].message)


def test_elements_with_unknowns_or_shapes_of_their_own(tmp_path):
    found = examined(tmp_path, quads("CPE4H"))
    assert [each.wrong for each, _ in found] == [False, False]
    assert re.match(
        r"CPE4H beside U4 \(element 1\) has a pressure of its own, .* may differ; take U2", found[0][0].message
    )
    group = read_deck(tmp_path / "deck.inp").groups[0]
    modified = Neighbours(66, "CPS6M", group.section, "1", group.source, np.array([0]), np.arange(6)[None])
    (finding,) = find_faults(modified, States())
    assert finding.wrong
    assert re.match(r"CPS6M beside U66 \(element 1\) has an interpolation of its own, .*; take U5", finding.message)


def test_each_finding_once(tmp_path):
    """Both quads have the material: the finding is of the material, not of each."""
    changing = f"{ELASTIC}\n*EXPANSION\n2e-5, 0.\n3e-5, 100."
    text = quads(material=changing, step="*TEMPERATURE\n1, 9.\n{upper}, 9.")
    text = text.replace("ELSET=LOW, MATERIAL=PLAIN", "ELSET=LOW, MATERIAL=OTHER")
    assert len(examined(tmp_path, text)) == 2  # two places that give a temperature
    assert len(examined(tmp_path, text.replace("1, 9.\n", "").replace("UPPER, 9.", "UPPER, 9.\n1, 0."))) == 1


def test_solids_are_those_with_the_nodes_of_a_side(tmp_path):
    path = tmp_path / "deck.inp"
    # the nodes of a side may run another way round than those of the solid
    path.write_text(quads().replace("3, 1, 2, 3, 4, 5, 6, 7, 8", "3, 3, 4, 1, 2, 5, 6, 7, 8"))
    model = read_deck(path)
    group = next(group for group in model.groups if group.type == "U4")
    assert [side.tolist() for side in solids_of(model, group)] == [[0], [1]]
    path.write_text(quads().replace("3, 1, 2, 3, 4, 5, 6, 7, 8", "3, 1, 2, 3, 9, 5, 6, 7, 8"))
    model = read_deck(path)
    group = next(group for group in model.groups if group.type == "U4")
    assert [side.tolist() for side in solids_of(model, group)] == [[-1], [1]]


def test_standard_elements_take_the_place_of_those_that_own_their_solids():
    own = [jtype for jtype, layout in element_layouts().items() if layout.own]
    assert own[:4] == [4, 6, 8, 12]
    standard = {4: 2, 6: 5, 8: 7, 12: 11, 34: 2, 68: 5, 406: 13, 608: 7, 1015: 14, 2015: 11}
    assert {jtype: standard_type(jtype) for jtype in standard} == standard


@pytest.mark.parametrize(
    ("definition", "nodes", "owns"),
    [
        (DEFINITION, "1, 2, 3, 4, 5, 6, 7, 8", True),
        (DEFINITION.replace("NODES=8", "NODES=4"), "4, 3, 5, 6", False),  # refused when it is called
        ("\n".join(user_element(2)), "4, 3, 5, 6", False),
        (DEFINITION.replace("U4", "U99"), "1, 2, 3, 4, 5, 6, 7, 8", False),
    ],
)
def test_elements_that_own_solids_have_their_type_and_their_nodes(tmp_path, definition, nodes, owns):
    kind = re.search(r"TYPE=(U\d+)", definition)[1]
    text = quads().replace(DEFINITION, definition).replace("TYPE=U4", f"TYPE={kind}")
    if kind == "U2":
        text = text.replace(PROPERTIES, "\n".join(uel_property(2, "INTERFACE", {})))
    path = tmp_path / "deck.inp"
    path.write_text(text.replace("3, 1, 2, 3, 4, 5, 6, 7, 8", f"3, {nodes}").replace("\n\n", "\n"))
    assert [owns_solids(group) for group in read_deck(path).groups if group.type == kind] == [owns]
    assert not any(owns_solids(group) for group in read_deck(path).groups if group.type != kind)
