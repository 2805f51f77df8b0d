# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TEMPERATURE, USER and *FIELD, USER: what UTEMP and UFIELD give, and what elements get."""

from pathlib import Path

import numpy as np
import pytest

from uel.errors import DeckError, UelError

HERE = Path(__file__).parent
DECK = """\
*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPE4, ELSET=BODY
7, 1, 2, 3, 4
*SOLID SECTION, ELSET=BODY, MATERIAL=M
*MATERIAL, NAME=M
*USER MATERIAL, CONSTANTS=1
1000.
*DEPVAR
5
*BOUNDARY
ALL, 1, 2
*INITIAL CONDITIONS, TYPE=TEMPERATURE
ALL, 3.
*STEP, AMPLITUDE=STEP
{procedure}
0.25, 0.5, 0.25, 0.25
{given}
*END STEP
*STEP, AMPLITUDE=STEP
{procedure}
0.25, 0.5, 0.25, 0.25
{then}
*END STEP
"""
BOTH = "*TEMPERATURE, USER\nALL, 5.\n*FIELD, USER, VARIABLE=1\nALL, 6."
ROUTINES = (HERE / "predefines.f").read_text() + (HERE / "thermal.f").read_text()
PROCEDURES = ["*STATIC", "*VISCO", "*DYNAMIC, NOHAF"]


@pytest.fixture
def run_square(run_deck):
    def run_square(given=BOTH, then="", *, procedure="*STATIC", routines=ROUTINES):
        text = DECK.format(given=given, then=then or "**", procedure=procedure)
        if "DYNAMIC" in procedure:
            text = text.replace("*USER MATERIAL", "*DENSITY\n1.\n*USER MATERIAL")
        return run_deck(text, routines.replace("'../umat.inc'", f"'{HERE.parent / 'umat.inc'}'"))

    return run_square


@pytest.mark.parametrize("procedure", ["*STATIC", "*DYNAMIC"])
def test_umat_gets_the_fields_of_the_increment(run_square, procedure):
    """At the start of the fourth increment, and their change; the mean of x is 1."""
    result = run_square(procedure=procedure)
    temperature = 5 + 1 + 10 * np.array([0.75, 1.0])
    field = 6 + 1 + 10 * np.array([0.75, 1.0]) + 100 * temperature
    expected = [temperature[0], np.diff(temperature)[0], field[0], np.diff(field)[0]]
    found = [result.field(f"SDV{k}")[0] for k in range(1, 5)]
    np.testing.assert_allclose(found, expected)


def test_the_first_increment_starts_from_the_initial_temperature(run_square):
    result = run_square(then="*TEMPERATURE, OP=NEW\nALL, 3.")
    start = [result.field(f"SDV{k}", increment=1, step=1)[0] for k in (1, 2)]
    np.testing.assert_allclose(start, [3.0, 5 + 1 + 2.5 - 3])
    # the second step no longer has UTEMP, nor UFIELD
    end = [result.field(f"SDV{k}")[0] for k in range(1, 5)]
    np.testing.assert_allclose(end, [3.0, 0.0, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("procedure", PROCEDURES)
def test_what_utemp_and_ufield_are_given(run_square, tmp_path, procedure):
    """At the last node, for the second increment of the second step."""
    run_square(procedure=procedure)
    lines = [line.split() for line in (tmp_path / "deck.dat").read_text().splitlines()]
    utemp, ufield = (
        [float(x) for x in [n for n in lines if n and n[0] == name][-1][1:]] for name in ("UTEMP", "UFIELD")
    )
    # TEMP or FIELD, TIME, COORDS
    assert utemp[:6] == pytest.approx([5.0, 0.5, 1.0, 0.0, 1.0, 0.0])
    assert ufield[:6] == pytest.approx([6.0, 0.5, 1.0, 0.0, 1.0, 0.0])
    assert utemp[6:] == [1, 2, 2, 4]  # NSECPT, KSTEP, KINC, NODE
    assert ufield[6:8] == pytest.approx([15.0, 2.5])  # TEMP, DTEMP
    assert ufield[8:] == [1, 1, 2, 2, 4, 1]  # KFIELD, NSECPT, KSTEP, KINC, NODE, NFIELD


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            "*TEMPERATURE, USER\nALL, 5.",
            r"deck.inp:\d+: \*TEMPERATURE, USER needs UTEMP, which the job does not have",
        ),
        ("*FIELD, USER\nALL, 5.", r"deck.inp:\d+: \*FIELD, USER needs UFIELD, which the job does not have"),
    ],
)
def test_a_job_without_the_routine_is_refused(run_square, given, message):
    with pytest.raises(DeckError, match=message):
        run_square(given, routines=(HERE / "thermal.f").read_text())


@pytest.mark.parametrize(("keyword", "routine"), [("TEMPERATURE", "UTEMP"), ("FIELD", "UFIELD")])
def test_xit(run_square, keyword, routine):
    with pytest.raises(UelError, match=rf"{routine} stopped the analysis .* \(node 1, step 1\)"):
        run_square(f"*{keyword}, USER\nALL, 666.")
