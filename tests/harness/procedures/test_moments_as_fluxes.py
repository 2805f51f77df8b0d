# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A cantilever of user beams: where there are moments alone, forces are measured with them."""

import re
from pathlib import Path

import pytest

HERE = Path(__file__).parent
LENGTH, EA, EI = 1000.0, 2.1e9, 1.75e12

DECK = """*NODE
{nodes}*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2, PROPERTIES=2
1, 2, 6
*ELEMENT, TYPE=U1, ELSET=ALL
{elements}*UEL PROPERTY, ELSET=ALL
{ea}, {ei}
*NSET, NSET=END
{end}
*STEP
*STATIC
0.25, 1., , 0.25
{controls}*BOUNDARY
1, 1, 2
1, 6
*CLOAD
{load}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U2, UR3
*END STEP
"""


@pytest.fixture
def bend(run_deck):
    def bend(load, count=40, controls=""):
        places = [LENGTH * k / count for k in range(count + 1)]
        deck = DECK.format(
            nodes="".join(f"{k}, {x!r}, 0.\n" for k, x in enumerate(places, 1)),
            elements="".join(f"{k}, {k}, {k + 1}\n" for k in range(1, count + 1)),
            ea=EA,
            ei=EI,
            end=count + 1,
            controls=controls,
            load=f"{count + 1}, {load}",
        )
        return run_deck(deck, HERE / "beam.f")

    return bend


def last(result, name):
    """Last value of a variable of the only node that has a history."""
    (values,) = (values for column, values in result.history.items() if column.startswith(f"{name}["))
    return values[-1]


def averages(result, field):
    """Average and time average flux of all checks of a field, and what stands behind them."""
    text = result.file(".msg").read_text()
    found = re.findall(rf"AVERAGE {field} +(\S+) +TIME AVG. {field} +(\S+) *(.*)", text)
    return [(float(average), float(mean), origin.strip()) for average, mean, origin in found]


@pytest.mark.parametrize("moment", [1.0, 1e6, 1e9, 1e12])
def test_a_pure_end_moment_is_linear_whatever_its_size(bend, moment):
    """Forces are the rounding errors of moments: they have nothing of their own to be measured with."""
    result = bend(f"6, {moment!r}")
    assert [line.total_iterations for line in result.status] == [1, 1, 1, 1]
    assert last(result, "UR3") == pytest.approx(moment * LENGTH / EI, rel=1e-6)
    assert last(result, "U2") == pytest.approx(moment * LENGTH**2 / (2 * EI), rel=1e-6)


@pytest.mark.parametrize(("controls", "ratio"), [("", 1.0), ("*CONTROLS, PARAMETERS=FIELD\n\n0.5\n", 0.5)])
def test_the_time_average_of_forces_is_that_of_moments_over_the_length(bend, controls, ratio):
    """Elements of length 25, a moment that grows in four equal parts: in the mean it is 1, 1.5, 2 and 2.5 parts."""
    part = 0.25e9
    result = bend("6, 1e9", controls=controls)
    forces, moments = averages(result, "FORCE"), averages(result, "MOMENT")
    assert [mean for _, mean, _ in moments] == pytest.approx([part, 1.5 * part, 2 * part, 2.5 * part], rel=1e-3)
    for (_, force, origin), (_, moment, own) in zip(forces, moments, strict=True):
        assert origin == "FROM MOMENT FIELD" and own == ""
        assert force == pytest.approx(ratio * moment / 25, rel=2e-3)


def test_forces_that_there_are_keep_their_own_time_average(bend):
    result = bend("2, 1000.")
    assert {origin for _, _, origin in averages(result, "FORCE")} == {""}
    assert {origin for _, _, origin in averages(result, "MOMENT")} == {""}
    # one end of each element has the force in direction 2, and so has the other: two of four
    assert averages(result, "FORCE")[0][1] == pytest.approx(125.0, rel=1e-3)


def test_moments_of_a_bar_that_is_pulled_are_measured_with_its_forces(bend):
    result = bend("1, 1000.")
    forces, moments = averages(result, "FORCE"), averages(result, "MOMENT")
    assert {origin for _, _, origin in moments} == {"FROM FORCE FIELD"}
    assert moments[0][1] == pytest.approx(25 * forces[0][1], rel=2e-3)


def test_a_time_average_of_the_deck_is_kept(bend):
    result = bend("6, 1e3", controls="*CONTROLS, PARAMETERS=FIELD, FIELD=DISPLACEMENT\n, , 7.\n")
    assert {(mean, origin) for _, mean, origin in averages(result, "FORCE")} == {(7.0, "")}
