# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Each check finds the mistakes it is for, and lets an element without mistakes pass."""

import json
import re
from pathlib import Path

import pytest

from uel.check.checks import CHECKS
from uel.check.examine import examine
from uel.check.finding import Verdict
from uel.cli import main
from uel.errors import UelError

QUAD = Path(__file__).parent / "quad.f"
DECKS = Path(__file__).parents[3] / "abaqus_inputs"

MISTAKES = [
    (1, "filled", r"AMATRX\(1,1\) was not filled, or was added to", "Set RHS and AMATRX to zero"),
    (2, "zero-modes", "has 5 zero modes, but there are 3 rigid-body motions", r"2 deformation\(s\) cost no energy"),
    (
        3,
        "rotation",
        "a small rigid rotation causes forces of 25.2 % .* its second-order terms",
        "shear takes both derivatives",
    ),
    (4, "tangent", r"(AMATRX\(\d,\d\)) is -([\d.]+), .* give \2; 64 of 64 .*: \1", "The sign is wrong"),
    (4, "zero-modes", "negative eigenvalue at rest", "check the sign of AMATRX"),
    (5, "tangent", "64 of 64 entries are wrong by up to 50 %", "AMATRX is 2 times what it should be"),
    (6, "tangent", r"AMATRX\(3,3\) is 0, .* 1 of 64 entries", "Differentiate RHS again for these entries"),
    (6, "zero-modes", "AMATRX resists a rigid-body motion with 35.9 %", "have to sum to zero over the nodes"),
    (7, "symmetry", r"AMATRX\(1,3\) is -1333.7, AMATRX\(3,1\) is -666.8", r"Add UNSYMM to .*patch.inp:11"),
    (
        8,
        "translation",
        r"RHS\(1\) changes by -\S+, \S+ % of .* moves by \S+ in direction 1",
        "differences of displacements",
    ),
    (9, "outside", r"writes outside SVARS: entry 14 of 12 \(VARIABLES=\)", "In Abaqus this overwrites other data"),
    (10, "undeclared", r"outside PROPS changes the result: RHS\(1\) is", r"has PROPERTIES=3 \(.*patch.inp:11\)"),
    (11, "repeat", r"the same call returns different .*: SVARS\(1\) is \d+, then", "Look for SAVE, COMMON, module"),
    (11, "order", r"SVARS\(1\) is \d+ in Abaqus' order", "something outlives a call"),
    (12, "run", r"RHS\(2\) is NaN or infinite \(step 1, increment 2", "Run the deck with `uel run`"),
    (13, "tangent", "14 of 64 entries", "AMATRX is transposed"),
    (14, "tangent", "16 of 64 entries", "is zero for the forces at dof 2 and the unknowns at dof 1"),
    (15, "tangent", "64 of 64 entries are wrong by up to 100 %", "AMATRX is zero: fill it"),
    (11, "threads", "write the same memory: CALLS of module CALLS_SO_FAR", "Make them local, without initial value"),
    (16, "threads", "element 1 and others write the same memory: COMMON /SCRATCH/", "Make them local"),
    (17, "no-time", r"called with DTIME = 0 and .* RHS\(1\) is NaN", "Divide by DTIME only if it is"),
    (18, "no-time", r"called with KINC = 0 and .* RHS\(1\) is NaN", "do not use KINC as an index"),
    (19, "rest", r"RHS\(1\) has a magnitude of 1 with U = 0, DU = 0 and no loads", "Forces at rest move the model"),
    (45, "shear", "shear stiffness in directions 1 and 2 is 0.5 times that of an isotropic", "with G = E/.2 . 2 nu."),
    (20, "patch", r"node 5, .* the forces of its 4 elements do not balance for u\d = x\d", "Check the Jacobian"),
    (21, "energy", r"ENERGY\(1\) to \(7\) grow by (.*), the work of the forces is", "A factor of 2 is a forgotten 1/2"),
    (22, "increments", "2 parts instead of 1, and by 6.9 % if it is made in 16 instead of 8", "a rate without DTIME"),
    (23, "pnewdt", "PNEWDT is 0.5 with DU = 0", "Set PNEWDT < 1 only because of what this increment has done"),
    (24, "pnewdt", "PNEWDT is -1", "PNEWDT multiplies DTIME"),
    (38, "repeat", r"the same call returns different .*: AMATRX\(1,1\) is", "for sums over iterations"),
    (39, "undeclared", r"outside SVARS changes the result: .* is NaN", r"has VARIABLES=12 \(.*patch.inp:11\)"),
    (40, "tangent", r"iteration 0: AMATRX\(\d,\d\) is 0, differences", r"zero if U is zero, .* a test for U = 0"),
    (42, "undeclared", r"outside JPROPS changes the result: RHS\(1\) is", r"has I PROPERTIES=1 \(.*patch.inp:11\)"),
    # what lies on the stack decides whether the run comes to its end
    (41, "locals", r"(of local variables change the result: .*|else element 1 .*)RHS\(1\) is", "-Wall -O2 names most"),
    (33, "inputs", "element 1, .*: DTIME is 0.5 before the call and 0.25 after it$", "passes DTIME in for information"),
    (
        34,
        "inputs",
        "entry 2 of PROPS is 0.3 before the call and 0 after it; also changed: COORDS",
        "change the copy",
    ),
]

NAN = {1, 10, 12, 17, 18, 39, 41}
"""Mistakes that make NaN, or calculate with it."""

ALONE = [
    *((1, "filled"), (5, "tangent"), (9, "outside"), (10, "undeclared"), (16, "threads"), (17, "no-time")),
    *((18, "no-time"), (20, "patch"), (21, "energy"), (24, "pnewdt"), (33, "inputs"), (39, "undeclared")),
]
"""Mistakes that only one check is for."""


def test_element_without_mistakes_passes_all_checks(findings, patch):
    found = findings(patch())
    assert [name for name, finding in found.items() if finding.verdict != Verdict.PASSED] == ["requests", "loads"]
    assert list(found) == [check.name for check in CHECKS]


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "mistake, check, message, advice",
    [pytest.param(*row, marks=pytest.mark.nan if row[0] in NAN else ()) for row in MISTAKES],
)
def test_mistake_is_found(findings, patch, mistake, check, message, advice):
    finding = findings(patch(mistake))[check]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message
    assert re.search(advice, finding.advice), finding.advice


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "mistake, expected", [(1, {"filled"}), (5, {"tangent"}), (9, {"outside"}), (10, {"undeclared"})]
)
def test_one_mistake_does_not_fail_other_checks(findings, patch, mistake, expected):
    assert {name for name, finding in findings(patch(mistake)).items() if finding.verdict is Verdict.FAILED} == expected


def test_wrong_entries_are_listed(findings, patch):
    finding = findings(patch(6))["tangent"]
    assert finding.entries == ("AMATRX(3,3)",)
    assert finding.figure > finding.limit


COUPLED = """\
*NODE
1, 0.
*USER ELEMENT, TYPE=U1, NODES=1, UNSYMM
1, 11
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1
*UEL PROPERTY, ELSET=ALL
*STEP
*STATIC, DIRECT
1., 1.
*CLOAD
1, 1, 1.
*END STEP
"""
HALF = """\
      include '{folder}/uel.inc'
      rhs(1:2,1) = (/ -u(1) + 3*u(2), -2*u(2) /)
      amatrx = reshape((/ 1d0, 0d0, -1.5d0, 2d0 /), (/ 2, 2 /))
      end
"""


NAN_LEFT = """\
      include '{folder}/uel.inc'
      call leave_nan
      call weigh(factor)
      rhs(1,1) = -(1 + factor)*u(1)
      amatrx = 1 + factor
      end
"""
WEIGH = """\
      subroutine weigh(factor)
      double precision factor,weight(9)
      call look_at(weight)
      factor = 1d-9*weight(9)
      end
"""
LEAVE_NAN = """\
void leave_nan_(void)
{
  volatile double left[400];
  for (int i = 0; i < 400; i++) left[i] = __builtin_nan("");
}
void look_at_(double *weight) { weight[0] = 1; }
"""


@pytest.mark.nan
def test_local_variable_without_a_value_that_ends_the_run(findings, tmp_path):
    """With zero in it all other checks are made. Files of their own keep the frames of the routines apart."""
    deck, user = tmp_path / "coupled.inp", [tmp_path / "uel.f", tmp_path / "weigh.f", tmp_path / "leave.c"]
    deck.write_text(COUPLED.replace(", UNSYMM\n1, 11", "\n1"))
    for file, text in zip(user, (NAN_LEFT.format(folder=QUAD.parents[1]), WEIGH, LEAVE_NAN), strict=True):
        file.write_text(text)
    found = findings(deck, user)
    passing = [name for name, finding in found.items() if finding.verdict is Verdict.PASSED]
    assert {"run", "filled", "repeat", "tangent"} < set(passing)
    assert found["locals"].verdict is Verdict.FAILED
    assert re.search(
        r"runs only if local variables .* are zero, .*; else element 1 .*RHS.1. is NaN", found["locals"].message
    )
    assert "-Wall -O2 names most" in found["locals"].advice


def test_dofs_of_wrong_entries(findings, tmp_path):
    deck, user = tmp_path / "coupled.inp", tmp_path / "coupled.f"
    deck.write_text(COUPLED)
    user.write_text(HALF.format(folder=QUAD.parents[1]))
    tangent = findings(deck, user)["tangent"]
    assert tangent.entries == ("AMATRX(1,2)",)
    assert tangent.advice.startswith("All are derivatives of RHS: of displacements by dof 11. Differentiate RHS again")


def test_unsymm_that_is_declared(findings, patch):
    symmetry = findings(patch(7, ("VARIABLES=12", "VARIABLES=12, UNSYMM")))["symmetry"]
    assert re.search("unsymmetric, as UNSYMM says: 34.3 %", symmetry.message)
    symmetry = findings(patch(0, ("VARIABLES=12", "VARIABLES=12, UNSYMM")))["symmetry"]
    assert re.search("UNSYMM is not needed at these states", symmetry.message)


def test_failure_that_another_one_explains(findings, patch):
    found = findings(patch(8))
    for name in ("rotation", "zero-modes"):
        assert found[name].message == "it tells nothing while 'translation' fails"


def test_patch_under_elements_for_plotting(findings, patch):
    overlay = (
        "*ELEMENT, TYPE=CPS4, ELSET=SHOWN\n11, 1, 2, 5, 4\n12, 2, 3, 6, 5\n"
        "*SOLID SECTION, ELSET=SHOWN, MATERIAL=SOFT\n1.\n*MATERIAL, NAME=SOFT\n*ELASTIC\n1e-9, 0.\n*STEP"
    )
    assert findings(patch(0, ("*STEP", overlay)))["patch"].message.startswith("forces balance at 1 nodes")


def test_element_that_never_returns_by_itself(findings, patch):
    tangent = findings(patch(28))["tangent"]
    assert tangent.verdict is Verdict.NOT_APPLICABLE
    assert re.search(r"no element returns from a call by itself: element \d .*: stopped the analysis", tangent.message)


@pytest.mark.parametrize(("name", "intended"), [("perturbed_u2", set()), ("perturbed_u4", {"energy"})])
def test_elements_of_the_project_pass(name, intended):
    """The paper's element damages by the jump, and passes on another traction: its forces do not do the law's work."""
    outcome = examine(DECKS / "patch_horizontal" / f"{name}.inp")
    bulk, interface = (report.findings for report in outcome.types)
    failed = {name for name, finding in (bulk | interface).items() if finding.verdict is Verdict.FAILED}
    assert failed == intended
    assert bulk["zero-modes"].message == "3 zero modes, the 3 rigid-body motions"
    assert re.search("nodes coincide", interface["zero-modes"].message)


def test_four_node_element_is_called_where_its_neighbours_have_been():
    bulk, interface = examine(DECKS / "patch_horizontal" / "flat_u3.inp").types
    failures = {name for name, finding in interface.findings.items() if finding.verdict is Verdict.FAILED}
    assert failures == {"order"}
    assert interface.states > 0
    assert re.search(
        "ends the analysis at all displacements other than those of the run", interface.findings["translation"].message
    )
    assert re.search("RHS has a kink, or no value", interface.findings["tangent"].message)
    assert bulk.findings["tangent"].verdict is Verdict.PASSED


def test_command_prints_a_table_and_advice(patch, capsys):
    assert main(["check", str(QUAD), str(patch(5))]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "patch.inp: U1, elements: 4, states: 16" in printed
    assert "U1 tangent: AMATRX is 2 times what it should be" in printed


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


def test_check_that_is_left_out(findings, patch):
    assert "tangent" not in findings(patch(5), skip=["tangent"])
    with pytest.raises(
        UelError, match=r"unknown check 'tangents'; expected one of run, values, compiler, .*, tangent, symm"
    ):
        examine(patch(), QUAD, skip=["tangents"])


def test_run_that_ends_early_is_said(patch, capsys):
    assert main(["check", str(QUAD), str(patch(12))]) == 1
    assert re.search(r"The run of the deck ended early: element \d", capsys.readouterr().out)


@pytest.mark.parametrize(
    "words, message",
    [
        (["a.for"], r"expected one deck \(.inp\), found 0"),
        (["a.inp", "b.inp"], r"expected one deck \(.inp\), found 2"),
        ([str(DECKS / "quad_cook" / "cook_cps4.inp")], "no elements of a type defined by .USER ELEMENT"),
    ],
)
def test_nothing_can_be_checked(words, message, capsys):
    assert main(["check", *words]) == 2
    assert re.search(message, capsys.readouterr().err)


def test_unsymmetric_matrix_in_a_coupled_step(findings, tmp_path):
    """There Abaqus takes AMATRX as it is."""
    deck, user = tmp_path / "coupled.inp", tmp_path / "coupled.f"
    user.write_text(HALF.format(folder=QUAD.parents[1]).replace("-1.5d0", "-3d0"))
    text = COUPLED.replace(", UNSYMM", "")
    deck.write_text(text)
    assert findings(deck, user)["symmetry"].verdict is Verdict.FAILED
    deck.write_text(text.replace("*STATIC, DIRECT", "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE"))
    symmetry = findings(deck, user)["symmetry"]
    assert symmetry.verdict is Verdict.PASSED
    assert re.search("which coupled temperature steps use as it is: 100 %", symmetry.message)


def test_warnings_about_the_deck(patch, tmp_path, capsys):
    deck = patch(0, ("1000., 0.3, 2., 0\n", "1000., 0.3, 2., 0, 1.\n"))
    assert main(["check", str(QUAD), str(deck), "--json", str(tmp_path / "found.json")]) == 0
    assert "Warning: " in capsys.readouterr().out
    (warning,) = json.loads((tmp_path / "found.json").read_text())["warnings"]
    assert re.search(r"patch.inp:18: .UEL PROPERTY: 5 values where U1 takes 4 .* not passed to it", warning)


@pytest.mark.nan
def test_element_that_fails_in_its_first_call(patch, capsys):
    assert main(["check", str(QUAD), str(patch(0, ("1000., 0.3, 2.", "1000., 1., 2.")))]) == 2
    assert re.search(r"element 1 \(type U1\): RHS\(1\) is NaN or infinite", capsys.readouterr().err)
