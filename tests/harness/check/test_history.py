# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Check `history` of elements some of whose integration points change their state much later than others."""

import pytest

from uel.check.checks import CHECKS
from uel.check.examine import examine
from uel.check.finding import Verdict
from uel.delamination.kernels import uel_property
from uel.usersub.layout import element_layouts

PLY = {"E1": 138e3, "E2": 10.5e3, "E3": 10.5e3, "NU12": 0.3, "NU13": 0.3, "NU23": 0.45}
PLY |= {"G12": 6.3e3, "G13": 6.3e3, "G23": 3.5e3}
SQUARE = ("0., 0.", "1., 0.", "1., 1.", "0., 1.")
OTHERS = [each.name for each in CHECKS if each.name != "history"]


def bonded(**law):
    """Two cubes with U8 between them, pulled apart by a tenth of their size."""
    layout = element_layouts()[8]
    sides = {f"{name} {side}": value for name, value in PLY.items() for side in ("BOTTOM", "TOP")}
    places = [f"{corner}, {height}" for height in (0.0, 1.0, 1.0, 2.0) for corner in SQUARE]
    return "\n".join(
        [
            "*NODE",
            *(f"{number}, {place}" for number, place in enumerate(places, 1)),
            "*ELEMENT, TYPE=C3D8, ELSET=SOLIDS\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 9, 10, 11, 12, 13, 14, 15, 16",
            f"*USER ELEMENT, TYPE=U8, NODES={layout.nodes}, COORDINATES=3, UNSYMM, PROPERTIES={len(layout.reals)}, "
            f"I PROPERTIES={len(layout.integers)}, VARIABLES={layout.svars}",
            "1, 2, 3",
            "*ELEMENT, TYPE=U8, ELSET=INTERFACE",
            "3, " + ", ".join(map(str, range(1, 17))),
            *uel_property(8, "INTERFACE", {"LAW": 1} | law | sides),
            "*SOLID SECTION, ELSET=SOLIDS, MATERIAL=PLY",
            "*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=ENGINEERING CONSTANTS",
            "138000., 10500., 10500., 0.3, 0.3, 0.45, 6300., 6300.\n3500.",
            "*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3",
            "*STEP\n*STATIC\n1., 1.",
            "*BOUNDARY\n13, 3, 3, 0.1\n14, 3, 3, 0.1\n15, 3, 3, 0.1\n16, 3, 3, 0.1\n*END STEP\n",
        ]
    )


@pytest.mark.parametrize("toughness", [1e3, 1e5, 1e7])
def test_points_that_break_late(tmp_path, toughness):
    """Strengths of ten times E3, with which displacements of the size of the cubes damage some points alone."""
    deck = tmp_path / "bonded.inp"
    deck.write_text(bonded(SIGMAMAX=1e5, TAUMAX=1e5, GIC=toughness, GIIC=toughness))
    (report,) = examine(deck, skip=OTHERS).types
    finding = report.findings["history"]
    assert finding.verdict is Verdict.PASSED, finding.message
