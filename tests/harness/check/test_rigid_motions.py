# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid-body motions of elements in the plane and in space."""

import re
from pathlib import Path

from uel.check.finding import Verdict

QUAD = Path(__file__).parent / "quad.f"


def test_linear_kinematics_with_nlgeom(findings, patch):
    rotation = findings(patch(0, ("*STEP", "*STEP, NLGEOM=YES")))["rotation"]
    assert rotation.verdict is Verdict.FAILED
    assert re.search("the step has NLGEOM, but a rotation by 30 degrees causes forces", rotation.message)
    assert re.search("run it without NLGEOM, or have it respond to LFLAGS", rotation.advice)


def test_rotation_that_the_material_does_not_bear(findings, patch):
    """30 degrees are a compression of 13 % to linear kinematics."""
    assert findings(patch(27))["rotation"].message.startswith("linear kinematics, forces unchanged to ")
    rotation = findings(patch(27, ("*STEP", "*STEP, NLGEOM=YES")))["rotation"]
    assert re.search("a rotation by 30 degrees ends the analysis; the kinematics are linear", rotation.message)
    assert rotation.figure is None


def test_rotation_that_is_right_to_the_first_order(findings, patch):
    for nlgeom in ("YES", "NO"):
        rotation = findings(patch(35, ("*STEP", f"*STEP, NLGEOM={nlgeom}")))["rotation"]
        assert re.search("by 30 degrees in one increment causes .* an infinitesimal one causes none", rotation.message)
        assert re.search(r"Use one that no rotation changes \(Green-Lagrange", rotation.advice)


BEAM = """\
*NODE
1, 0., 0.
2, 2., 0.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2, I PROPERTIES=1
1, 2, 3
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
*UEL PROPERTY, ELSET=ALL
{factor}
*STEP
*STATIC, DIRECT
1., 1.
*BOUNDARY
1, 1, 3
2, 1, 3, 0.01
*END STEP
"""


BAR = """\
*NODE
1, 0., 0., 0.
2, 1., 2., 2.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=3, I PROPERTIES=1
1, 2, 3
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
*UEL PROPERTY, ELSET=ALL
{mistake}
*STEP, NLGEOM
*STATIC, DIRECT
1., 1.
*BOUNDARY
1, 1, 3
2, 1, 3, 0.3
*END STEP
"""


def test_bar_in_space(findings, tmp_path):
    deck, user = tmp_path / "bar.inp", Path(__file__).parent / "bar.f"
    deck.write_text(BAR.format(mistake=0))
    found = findings(deck, user)
    assert not [name for name, finding in found.items() if finding.verdict is Verdict.FAILED]
    assert found["rotation"].message.startswith("a rotation by 30 degrees turns the forces with it")
    assert found["zero-modes"].message == "5 zero modes, the 5 rigid-body motions"
    deck.write_text(BAR.format(mistake=1))
    found = findings(deck, user)
    assert {name for name, finding in found.items() if finding.verdict is Verdict.FAILED} == {"rotation", "zero-modes"}


def test_rotation_as_a_dof_of_the_authors_choice(findings, tmp_path):
    deck, user = tmp_path / "beam.inp", Path(__file__).parent / "turning_beam.f"
    deck.write_text(BEAM.format(factor=1))
    found = findings(deck, user)
    assert found["rotation"].message.startswith("linear kinematics, forces unchanged to")
    assert found["zero-modes"].message == "3 zero modes, the 3 rigid-body motions"
    deck.write_text(BEAM.format(factor=0))
    found = findings(deck, user)
    assert re.search("a small rigid rotation causes forces of", found["rotation"].message)
