# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The head of steps other than static ones in .msg and .dat."""

import pytest

from uel.errors import Source
from uel.model.procedures import CoupledTemperatureDisplacement, Dynamic, HeatTransfer, Procedure, Visco
from uel.model.steps import Step
from uel.output.step_header import procedure, tolerances


def head(given: Procedure) -> str:
    step = Step(1, "Step-1", given, Source("deck.inp", 1))
    return procedure(step) + tolerances(step, ["force"])


@pytest.mark.parametrize(
    "given, lines",
    [
        (Visco(), ["V I S C O   A N A L Y S I S"]),
        (
            Dynamic(half_increment=1e4),
            [
                "D Y N A M I C   A N A L Y S I S",
                "NUMERICAL DAMPING CONTROL PARAMETER (ALPHA) IS      -5.000E-02",
                "HALF-INCREMENT SCALE FACTOR IS                       1.000E+04",
                "MAX. TIME INCREMENT INCREASE FACTOR ALLOWED                       1.250",
            ],
        ),
        (
            HeatTransfer(largest_change=5.0),
            [
                "T R A N S I E N T   H E A T   T R A N S F E R",
                "MAXIMUM TEMPERATURE CHANGE IN AN INCREMENT IS         5.00",
                "MAX. TIME INCREMENT INCREASE FACTOR ALLOWED                       2.000",
            ],
        ),
        (
            CoupledTemperatureDisplacement(steady=True),
            ["S T E A D Y   S T A T E   C O U P L E D   T E M P E R A T U R E"],
        ),
    ],
)
def test_what_the_head_says(given: Procedure, lines: list[str]) -> None:
    text = head(given)
    for line in lines:
        assert line in text
