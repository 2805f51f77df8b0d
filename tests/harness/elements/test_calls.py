# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""LFLAGS of the calls that a user element gets, as the table of harness/uel/usersub/calls.md says."""

from itertools import groupby
from pathlib import Path

import pytest

import uel

PAGE = Path(uel.__file__).parent / "usersub" / "calls.md"
DECK = """*NODE
1, 0.
2, 1.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1
{dof}
*ELEMENT, TYPE=U1, ELSET=E
1, 1, 2
*UEL PROPERTY, ELSET=E
*BOUNDARY
1, {dof}
*STEP, INC=1{options}
{procedure}
{data}
*CLOAD
2, {dof}, 1.
*END STEP
"""
UEL = f"""      include '{Path(__file__).parents[1] / "uel.inc"}'
      write(7,'(a,6i4)') 'FLAGS', lflags(1:5), kinc
      stiffness = 10
      mass = 1
      if (lflags(3) .eq. 4 .or. lflags(3) .eq. 6) stiffness = 0
      if (lflags(1) .lt. 11 .or. lflags(1) .gt. 12) mass = 0
      if (lflags(3) .eq. 4 .or. lflags(3) .eq. 6) mass = 1
      do i = 1, ndofel
        amatrx(i,i) = stiffness + mass
        amatrx(3-i,i) = -stiffness
        rhs(i,1:nrhs) = 0
        rhs(i,1) = -10*(u(i) - u(3-i)) - mass*a(i)
      end do
      end
"""


def rows():
    for line in PAGE.read_text().splitlines():
        if line.startswith("| `"):
            step, code, requests, linear = (cell.strip() for cell in line.strip("|").split("|"))
            yield step, code, [int(word) for word in requests.split(",")], linear


@pytest.mark.parametrize(("step", "code", "requests", "linear"), list(rows()), ids=[row[0] for row in rows()])
def test_calls_of_a_step(tmp_path, step, code, requests, linear):
    procedure = step.split("`")[1]
    deck = DECK.format(
        dof=11 if "HEAT" in step else 1,
        options=", PERTURBATION" if "PERTURBATION" in step else "",
        procedure=procedure,
        data="1"
        if step in ("`*FREQUENCY`", "`*STEADY STATE DYNAMICS, DIRECT`")
        else ""
        if "PERTURBATION" in step or "GEOSTATIC" in step
        else "1., 1.",
    )
    (tmp_path / "calls.inp").write_text(deck)
    (tmp_path / "calls.f").write_text(UEL)
    try:
        result = uel.run(tmp_path / "calls.inp", tmp_path / "calls.f", output_dir=tmp_path)
    except uel.errors.ConvergenceError:
        assert "RIKS" in step  # has no end of its own
        result = None
    lines = (tmp_path / "calls.msg").read_text().splitlines()
    flags = [[int(word) for word in line.split()[1:]] for line in lines if line.startswith("FLAGS")]
    assert {str(row[0]) for row in flags} == {code}
    assert [request for request, _ in groupby(row[2] for row in flags)] == requests
    assert {str(row[3]) for row in flags[1:]} == {linear}
    assert flags[0][1:] == [0, 4, 0, 0, 1]
    assert result is None or result.completed
