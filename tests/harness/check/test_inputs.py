# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every argument that is passed in only is watched, and no other."""

from pathlib import Path

import pytest

from uel.check.checks import CHECKS
from uel.check.examine import examine
from uel.usersub.input_watch import NAMES

USER = Path(__file__).parent / "all_inputs.f"
OUTPUTS = {"RHS", "AMATRX", "SVARS", "ENERGY", "PNEWDT"}
DECK = """\
*NODE
1, 0., 0.
2, 1., 0.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2, PROPERTIES=2, I PROPERTIES=2
1
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
*UEL PROPERTY, ELSET=ALL
1., 2., {all}, 3
*STEP
*STATIC, DIRECT
1., 1.
*BOUNDARY
1, 1
2, 1
*END STEP
"""


@pytest.mark.parametrize("all, expected", [(0, set()), (1, set(NAMES) - OUTPUTS - {"MATERIALLIB"})])
def test_arguments_that_are_watched(tmp_path, all, expected):
    deck = tmp_path / "all.inp"
    deck.write_text(DECK.format(all=all))
    others = [check.name for check in CHECKS if check.name != "inputs"]
    (report,) = examine(deck, USER, skip=others).types
    assert set(report.findings["inputs"].entries) == expected
