# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Each check finds the mistakes it is for, and lets an element without mistakes pass."""

import json
import re
from pathlib import Path

import pytest

from harness.check.checks import CHECKS
from harness.check.examine import examine
from harness.check.finding import Verdict
from harness.cli import main
from harness.errors import UelError

QUAD = Path(__file__).parent / "quad.f"
DECKS = Path(__file__).parents[3] / "abaqus_inputs"

MISTAKES = [
    (1, "filled", r"AMATRX\(1,1\) was not filled, or was added to", "Set RHS and AMATRX to zero"),
    (2, "zero-modes", "AMATRX has 5 zero modes, rigid-body motions are 3", r"2 deformation\(s\) cost nothing"),
    (3, "rotation", "a rigid rotation makes forces: 25.2 % .* for linear kinematics", "shear takes both derivatives"),
    (4, "tangent", r"AMATRX\(7,7\) is -1169.75, differences of RHS give 1169.75; 64 of 64", "The sign is wrong"),
    (4, "zero-modes", "negative eigenvalue at rest", "look at the sign of AMATRX"),
    (
        5,
        "tangent",
        "64 of 64 entries are wrong by up to 50 %",
        "AMATRX is 2 times what it has to be",
    ),
    (6, "tangent", r"AMATRX\(3,3\) is 0, .* 1 of 64 entries", "Differentiate RHS again for these entries"),
    (6, "zero-modes", "AMATRX resists a rigid-body motion with 35.9 %", "have to sum up to zero over the nodes"),
    (7, "symmetry", r"AMATRX\(1,3\) is -1333.7, AMATRX\(3,1\) is -666.8", r"Give UNSYMM to .*patch.inp:11"),
    (8, "translation", r"RHS\(1\) changes by .* moves by 1.4\d+ in direction 1", "differences of displacements"),
    (9, "outside", r"writes outside SVARS: entry 14 of 12 \(VARIABLES=\)", "In Abaqus this overwrites other data"),
    (10, "undeclared", r"outside PROPS changes the result: RHS\(1\) is", r"has PROPERTIES=3 \(.*patch.inp:11\)"),
    (11, "repeat", r"the same call twice, .*: SVARS\(1\) is \d+, then \d+", "Look for SAVE, COMMON, module variables"),
    (11, "order", r"SVARS\(1\) is \d+ in Abaqus' order", "something outlives a call"),
    (12, "run", r"RHS\(2\) is NaN or infinite \(step 1, increment 2", "Run the deck with `uel run`"),
    (13, "tangent", "14 of 64 entries", "AMATRX is transposed"),
    (14, "tangent", "16 of 64 entries", "holds nothing for the forces at dof 2 and the unknowns at dof 1"),
    (15, "tangent", "64 of 64 entries are wrong by up to 100 %", "AMATRX is zero: fill it"),
]


def findings(deck, user=QUAD, **options):
    (report,) = examine(deck, user, **options).types
    return report.findings


def test_element_without_mistakes_passes_all_checks(patch):
    found = findings(patch())
    assert {name: finding.message for name, finding in found.items() if finding.verdict != Verdict.PASSED} == {}
    assert list(found) == [check.name for check in CHECKS]


@pytest.mark.parametrize("mistake, check, message, advice", MISTAKES)
def test_mistake_is_found(patch, mistake, check, message, advice):
    finding = findings(patch(mistake))[check]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message
    assert re.search(advice, finding.advice), finding.advice


@pytest.mark.parametrize(
    "mistake, expected", [(1, {"filled"}), (5, {"tangent"}), (9, {"outside"}), (10, {"undeclared"})]
)
def test_one_mistake_does_not_fail_other_checks(patch, mistake, expected):
    assert {name for name, finding in findings(patch(mistake)).items() if finding.verdict is Verdict.FAILED} == expected


def test_wrong_entries_are_listed(patch):
    finding = findings(patch(6))["tangent"]
    assert finding.entries == ("AMATRX(3,3)",)
    assert finding.figure > finding.limit


def test_unsymm_that_is_declared(patch):
    symmetry = findings(patch(7, ("VARIABLES=12", "VARIABLES=12, UNSYMM")))["symmetry"]
    assert re.search("unsymmetric, as UNSYMM says: 34.3 %", symmetry.message)
    symmetry = findings(patch(0, ("VARIABLES=12", "VARIABLES=12, UNSYMM")))["symmetry"]
    assert re.search("UNSYMM is not needed at these states", symmetry.message)


def test_linear_kinematics_with_nlgeom(patch):
    rotation = findings(patch(0, ("*STEP", "*STEP, NLGEOM=YES")))["rotation"]
    assert rotation.verdict is Verdict.FAILED
    assert re.search("the step has NLGEOM, and a rotation by 30 degrees makes forces", rotation.message)
    assert re.search("run it without NLGEOM, or let it follow LFLAGS", rotation.advice)


@pytest.mark.parametrize("name", ["perturbed_u2", "perturbed_u4"])
def test_elements_of_the_project_pass(name):
    outcome = examine(DECKS / "patch_horizontal" / f"{name}.inp")
    assert outcome.passed
    bulk, interface = (report.findings for report in outcome.types)
    assert bulk["zero-modes"].message == "3 zero modes, the 3 rigid-body motions"
    assert re.search("nodes lie on each other", interface["zero-modes"].message)


def test_four_node_element_is_called_where_its_neighbours_have_been():
    bulk, interface = examine(DECKS / "patch_horizontal" / "flat_u3.inp").types
    failures = {name for name, finding in interface.findings.items() if finding.verdict is Verdict.FAILED}
    assert failures == {"order"}
    assert interface.states > 0
    assert re.search("ends the analysis at all displacements that are not", interface.findings["translation"].message)
    assert re.search("RHS has a kink, or no value", interface.findings["tangent"].message)
    assert bulk.findings["tangent"].verdict is Verdict.PASSED


def test_command_prints_a_table_and_advice(patch, capsys):
    assert main(["check", str(QUAD), str(patch(5))]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "patch.inp: U1, elements: 4, states: 16" in printed
    assert "U1 tangent: AMATRX is 2 times what it has to be" in printed


def test_command_writes_json(patch, tmp_path, capsys):
    file = tmp_path / "findings.json"
    assert main(["check", str(patch()), "--user", str(QUAD), "--json", str(file)]) == 0
    data = json.loads(file.read_text())
    (report,) = data["types"]
    assert data["passed"]
    assert data["increments"] == 2
    assert report["type"] == "U1"
    assert report["findings"]["tangent"]["verdict"] == "passed"
    assert report["findings"]["tangent"]["limit"] == 1e-5


def test_check_that_is_left_out(patch):
    assert "tangent" not in findings(patch(5), skip=["tangent"])
    with pytest.raises(UelError, match="no check is called 'tangents'; there are run, filled"):
        examine(patch(), QUAD, skip=["tangents"])


def test_run_that_ends_early_is_said(patch, capsys):
    assert main(["check", str(QUAD), str(patch(12))]) == 1
    assert re.search(r"The run of the deck ended early: element \d", capsys.readouterr().out)


@pytest.mark.parametrize(
    "words, message",
    [
        (["a.for"], r"expected one deck \(.inp\), found 0"),
        (["a.inp", "b.inp"], r"expected one deck \(.inp\), found 2"),
        (["a.inp", "a.for", "--user", "b.for"], "expected one file of user elements, found a.for, b.for"),
        ([str(DECKS / "quad_cook" / "cook_cps4.inp")], "no elements of a type defined by .USER ELEMENT"),
    ],
)
def test_nothing_can_be_checked(words, message, capsys):
    assert main(["check", *words]) == 2
    assert re.search(message, capsys.readouterr().err)


def test_element_that_fails_in_its_first_call(patch, capsys):
    assert main(["check", str(QUAD), str(patch(0, ("1000., 0.3, 2.", "1000., 1., 2.")))]) == 2
    assert re.search(r"element 1 \(type U1\): RHS\(1\) is NaN or infinite", capsys.readouterr().err)
