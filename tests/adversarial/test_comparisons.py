# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Forms of a deck that must give the same result do: the program over some bodies, and the differences that it sees."""

import subprocess
import sys
from dataclasses import replace

import bodies
import comparisons
import mpiexec
import numpy as np
import pytest

BODIES = {body.name: body for body in bodies.bodies()}
FEWEST = 2000
"""Comparisons that the program makes, of all bodies."""


def differing(rows):
    return [str(row) for row in rows if row.verdict == "differs"]


@pytest.mark.sample(60)
@pytest.mark.parametrize("name", list(BODIES))
def test_forms_of_a_body_give_the_same_result(name, tmp_path):
    rows = [*comparisons.compare(BODIES[name], tmp_path), *comparisons.compare_matrices(BODIES[name], tmp_path)]
    assert rows
    assert differing(rows) == []


def test_a_body_of_each_kind(tmp_path):
    """Comparisons are made, and hold, of solids, heat, shells, beams, joints, user elements and constraints."""
    names = ("C3D8H orthotropic", "DC2D4 isotropic", "S4 lamina", "B31 RECT", "*TIE 3D", "U4 2D", "*MPC, BEAM 3D")
    for name in names:
        rows = list(comparisons.compare(BODIES[name], tmp_path))
        assert len(rows) >= 6, (name, rows)
        assert {row.verdict for row in rows} == {"equal"}, [str(row) for row in rows]


@mpiexec.NEEDED
def test_two_ranks(tmp_path):
    """Elements of a body are on both ranks, with the directions that beams have of their own."""
    chosen = [BODIES[name] for name in ("C3D8 orthotropic", "S4R lamina", "B31 RECT", "U4 2D", "*TIE 3D")]
    rows = list(comparisons.compare_ranks(chosen, tmp_path))
    assert [row.verdict for row in rows] == ["equal"] * len(chosen), [str(row) for row in rows]


def test_number_of_comparisons():
    """Every body has its forms, and the program makes at least 2,000 comparisons."""
    modal = [len([*comparisons.modal_variants(body)][1:]) for body in BODIES.values()]
    forms = [len([*comparisons.variants(body)]) + count for body, count in zip(BODIES.values(), modal, strict=True)]
    assert min(forms) >= 4
    assert sum(forms) >= FEWEST


def test_a_turned_body_is_another_deck():
    """The forms are not the same text, or their comparison would say nothing."""
    body = BODIES["C3D8 orthotropic"]
    texts = [comparisons.text(body, variant) for variant in comparisons.variants(body)]
    assert len(set(texts)) == len(texts)


def test_differences_are_seen(tmp_path):
    """A load that is not turned with the body, and a load that is not zero."""
    body = BODIES["CPS4 isotropic"]
    same = comparisons.Frame()
    wrong = replace(body, loads=lambda frame: body.loads(same))
    rows = {row.variant: row for row in comparisons.compare(wrong, tmp_path)}
    assert rows["turned"].verdict == "differs"
    assert rows["as a part"].refused or rows["as a part"].verdict == "differs"
    expected = comparisons.run(body, comparisons.Variant("as it is"), tmp_path)
    loaded = comparisons.Variant("not zero", zero=lambda body, frame: ["*CLOAD", "RIGHT, 1, 1e-6"])
    found = comparisons.run(body, loaded, tmp_path)
    assert comparisons.difference(expected, found) > comparisons.ROUNDING
    assert comparisons.difference(expected, expected) == 0.0


def test_verdicts():
    """A NaN is a difference, and a reason holds for its bodies alone."""
    assert comparisons.Row("CPS4 isotropic", "turned", np.nan, 1.0).verdict == "differs"
    assert comparisons.Row("CPS4 isotropic", "turned", 2.0, 1.0).verdict == "differs"
    assert comparisons.Row("C3D8R isotropic", "turned", 2.0, 1.0).verdict == "explained"
    assert comparisons.Row("C3D8R isotropic", "as a part", 2.0, 1.0).verdict == "differs"
    assert comparisons.Row("CPS4 isotropic", "turned", refused="why").verdict == "refused"


@pytest.mark.long
def test_command():
    command = [sys.executable, comparisons.__file__, "T2D2"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    assert result.stdout.endswith(" equal\n")
