# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Forces that count as zero beside the time average force of Abaqus' first increment: .msg says so."""

import pytest

from uel.running import job

DECK = """\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPE4, ELSET=ALL
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=ALL, MATERIAL=SOFT
1.
*MATERIAL, NAME=SOFT
*ELASTIC
{modulus}, 0.3
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP, NLGEOM
*STATIC
1., 1.
{controls}
*CLOAD
2, 2, {force}
3, 2, {force}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U2
*END STEP
"""
NOTE = "THE AVERAGE FORCE FLUX"
CONTROLS = "*CONTROLS, PARAMETERS=FIELD, FIELD=DISPLACEMENT\n, , 1e-9"


def run_chain(tmp_path, modulus, controls=""):
    """Displacement, and whether the message file has the note."""
    tmp_path.mkdir(exist_ok=True)
    text = DECK.format(modulus=modulus, force=0.02 * modulus, controls=controls)
    (tmp_path / "job.inp").write_text(text.replace("*ELEMENT", "*NSET, NSET=END\n3\n*ELEMENT", 1))
    result = job.run(tmp_path / "job.inp", output_dir=tmp_path)
    message = " ".join((tmp_path / "job.msg").read_text().split())
    return result.history["U2[END]"][-1], message


def test_forces_that_count_as_zero(tmp_path):
    exact, said = run_chain(tmp_path / "usual", 1.0)
    assert NOTE not in said
    coarse, said = run_chain(tmp_path / "small", 1e-8)
    assert said.count(NOTE) == 1
    assert "COUNTS AS ZERO BESIDE 0.01, WHICH IS TAKEN FOR ITS TIME AVERAGE UNTIL A LARGER ONE IS SEEN" in said
    assert "OTHER UNITS, OR AN INITIAL TIME AVERAGE FLUX (*CONTROLS, PARAMETERS=FIELD), MAKE RESULTS ACCURATE" in said
    # the linear solution
    assert abs(coarse / exact - 1) > 1e-2


def test_initial_time_average_flux_that_is_given(tmp_path):
    exact, _ = run_chain(tmp_path / "usual", 1.0)
    given, said = run_chain(tmp_path / "given", 1e-8, CONTROLS)
    assert NOTE not in said
    assert given == pytest.approx(exact, rel=1e-3)
