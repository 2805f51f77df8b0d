# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A warning where *USER ELEMENT of an interface element of the project lacks UNSYMM."""

import re

import pytest

from uel import run
from uel.delamination.kernels import uel_property, user_element

LAW = {"THICKNESS": 1.0, "ALPHAN": 1e5, "ALPHAT": 1e5, "SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.0}


def pulled(folder, *, unsymm=False, step="*STEP", procedure="*STATIC", **values):
    """U2 between two trusses, which pull it without damage."""
    definition = "\n".join(user_element(2))
    if not unsymm:
        definition = definition.replace(", UNSYMM", "")
    deck = folder / "deck.inp"
    deck.write_text(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 0.\n4, 0., 0.\n"
        f"{definition}\n*ELEMENT, TYPE=U2, ELSET=I\n1, 1, 2, 3, 4\n"
        + "\n".join(uel_property(2, "I", LAW | values))
        + "\n"
        f"{step}\n{procedure}\n1., 1.\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n3, 1, 2, 1e-5\n4, 1, 2, 1e-5\n*END STEP\n"
    )
    return deck


def warnings(folder, **options):
    return [each for each in run(pulled(folder, **options), output_dir=folder).warnings if "UNSYMM" in each]


def test_missing_unsymm_is_said_with_its_place(tmp_path):
    (found,) = warnings(tmp_path)
    expected = r"deck.inp:6: U2 has an unsymmetric matrix in mixed-mode softening, but \*USER ELEMENT has no UNSYMM"
    assert re.search(expected, found)
    assert warnings(tmp_path, unsymm=True) == []


@pytest.mark.parametrize(("step", "count"), [("*STEP", 0), ("*STEP, NLGEOM", 1)])
def test_secant_matrix_needs_none_with_small_displacements(tmp_path, step, count):
    assert len(warnings(tmp_path, TANGENT=1, step=step)) == count
