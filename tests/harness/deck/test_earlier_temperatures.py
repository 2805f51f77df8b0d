# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS, FILE: temperatures of an earlier heat transfer job, which strain a body by *EXPANSION."""

import numpy as np
import pytest

from uel.deck import read_deck
from uel.errors import DeckError
from uel.output.earlier_jobs import EarlierJobs

MESH = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE={type}, ELSET=BODY
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=BODY, MATERIAL=M
1.
*MATERIAL, NAME=M
"""
HEAT = MESH.format(type="DC2D4") + (
    "*CONDUCTIVITY\n3.\n*STEP\n*HEAT TRANSFER, STEADY STATE\n0.5, 1.\n*BOUNDARY\n1, 11, 11, 10.\n4, 11, 11, 10.\n"
    "2, 11, 11, 30.\n3, 11, 11, 30.\n*OUTPUT, FIELD\n*END STEP\n"
)
BODY = MESH.format(type="CPS4") + "*ELASTIC\n100., 0.\n*EXPANSION\n1e-3\n"
HELD = "*BOUNDARY\n1, 1, 2\n2, 2\n4, 1\n"
COOLED = """*STEP
*STATIC
*TEMPERATURE
ALL, 0.
*OUTPUT, FIELD
*OUTPUT, HISTORY, OP=ADD
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""


@pytest.mark.parametrize(
    ("which", "mean"), [("heat", 20.0), ("heat.odb", 20.0), ("heat, STEP=1", 20.0), ("heat, STEP=1, INC=1", 10.0)]
)
def test_a_body_that_cools_from_the_temperatures_of_a_job(run_deck, which, mean):
    """The strain is the coefficient times what the temperature has fallen: half of it in the first increment."""
    run_deck(HEAT.replace("10.\n", "20.\n").replace("30.\n", "20.\n"), name="heat")
    initial = f"*INITIAL CONDITIONS, TYPE=TEMPERATURE, FILE={which}\n"
    result = run_deck(BODY + initial + HELD + COOLED, name="body")
    assert result.history["U1[ALL:2]"][-1] == pytest.approx(-1e-3 * mean)


def test_temperatures_are_also_a_field(run_deck, tmp_path):
    run_deck(HEAT, name="heat")
    path = tmp_path / "body.inp"
    path.write_text(BODY + "*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=2, FILE=heat\n" + HELD + COOLED)
    model = read_deck(path, earlier=EarlierJobs([tmp_path]))
    found = np.zeros(4)
    for entry in model.initial_fields:
        assert entry.dof == 2
        found[entry.nodes] = entry.value
    np.testing.assert_allclose(found, [10, 30, 30, 10], rtol=1e-6)
    assert read_deck(path).initial_fields == ()


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("TYPE=TEMPERATURE, FILE=cold", r"body.inp:\d+: \*INITIAL CONDITIONS: FILE=cold: no results of a job cold in"),
        ("TYPE=TEMPERATURE, FILE=heat, STEP=4", "FILE=heat: "),
        ("TYPE=TEMPERATURE, FILE=heat\n1, 3.", "FILE: values are those of that job; expected no data lines"),
        ("TYPE=TEMPERATURE, FILE=still", "FILE=still: the job has no temperatures"),
        ("TYPE=VELOCITY, FILE=heat", "FILE is for TYPE=TEMPERATURE and TYPE=FIELD"),
        ("TYPE=STRESS, FILE=heat", "FILE is for TYPE=TEMPERATURE and TYPE=FIELD"),
        ("TYPE=SOLUTION, FILE=heat", "FILE is for TYPE=TEMPERATURE and TYPE=FIELD"),
        ("TYPE=TEMPERATURE, FILE=heat, INTERPOLATE", "option INTERPOLATE is not supported"),
    ],
)
def test_what_is_wrong_is_named(run_deck, line, message):
    run_deck(HEAT, name="heat")
    run_deck(BODY + HELD + COOLED.replace("*TEMPERATURE\nALL, 0.\n", ""), name="still")
    with pytest.raises(DeckError, match=message):
        run_deck(BODY + f"*INITIAL CONDITIONS, {line}\n" + HELD + COOLED, name="body")
