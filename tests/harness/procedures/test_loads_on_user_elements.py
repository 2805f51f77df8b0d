# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributed loads on user elements and predefined fields, as UEL gets them in whole jobs."""

from pathlib import Path

import numpy as np
import pytest

from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.errors import DeckError
from uel.model.records import IncrementDone
from uel.procedures import run_steps

USER = Path(__file__).with_name("conditions.f")
DECK = """\
*USER ELEMENT, TYPE=U1, NODES=2, VARIABLES=20
1
*NODE, NSET=ALL
1, 0.
2, 1.
3, 2.
4, 3.
5, 3.
*ELEMENT, TYPE=U1, ELSET=FIRST
1, 1, 2
*ELEMENT, TYPE=U1, ELSET=LAST
2, 2, 3
*UEL PROPERTY, ELSET=FIRST
*UEL PROPERTY, ELSET=LAST
*AMPLITUDE, NAME=LATE
0., 0., 0.5, 0., 1., 1.
*BOUNDARY
1, 1
{model}
*STEP
*STATIC, DIRECT
0.5, 1.
{first}
*END STEP
*STEP
*STATIC, DIRECT
0.5, 1.
{second}
*END STEP
"""


@pytest.fixture
def run_two_steps(tmp_path):
    """SVARS (increments, elements, 20) and U of node 3 after each of the four increments."""

    def run_two_steps(model="", first="", second=""):
        deck = tmp_path / "deck.inp"
        deck.write_text(DECK.format(model=model, first=first, second=second))
        read = read_deck(deck)
        library = usersub.load(USER, job="job", output_dir=tmp_path)
        system = system_of(read, library)
        done = [
            (np.vstack([e.svars for e in r.solution.elements]), r.solution.displacement[-1])
            for r in run_steps(system, read, library)
            if isinstance(r, IncrementDone)
        ]
        library.close()
        states, displacements = zip(*done, strict=True)
        return np.array(states), list(displacements)

    return run_two_steps


def test_loads_of_type_u_and_unu(run_two_steps):
    """A ramp to 3 on both elements, one that UEL defines, and one with an amplitude on the second; then OP=NEW."""
    svars, u = run_two_steps(
        first="*DLOAD\nFIRST, U2, 3.\nLAST, U2, 3.\n*DLOAD, AMPLITUDE=LATE\n2, U7, 8.\n2, U4NU",
        second="*DLOAD, OP=NEW\nLAST, U2, 5.",
    )
    first, last = svars[:, 0], svars[:, 1]
    assert first[:, 0].tolist() == [1, 1, 0, 0]
    assert first[:, 1].tolist() == [1, 1, 1, 1]
    assert last[:, 0].tolist() == [3, 3, 1, 1]
    assert last[:2, 1].tolist() == [3, 3]
    assert last[1, 2:5].tolist() == [-4, 2, 7]
    np.testing.assert_allclose(last[:2, 5:8], [[0, 1.5, 0], [0, 3, 8]])
    np.testing.assert_allclose(last[:2, 8:11], [[0, 1.5, 0], [0, 1.5, 8]])
    np.testing.assert_allclose(last[2:, 5], [4, 5])
    np.testing.assert_allclose(last[2:, 8], [1, 1])
    # springs of stiffness 1 in a row: the first carries both loads
    np.testing.assert_allclose(u, [1.5 + 2 * 1.5, 3 + 2 * 3, 2 * 4, 2 * 5])


def test_fields_vary_and_go_back_to_their_start(run_two_steps):
    """Temperature 20 at the start ramps to 50 and back; field 2 has an amplitude; field 1 stays at its start."""
    svars, _ = run_two_steps(
        model="*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*INITIAL CONDITIONS, TYPE=FIELD\n2, 7.",
        first="*TEMPERATURE\nALL, 50.\n*FIELD, VARIABLE=2, AMPLITUDE=LATE\n2, 3.",
        second="*TEMPERATURE, OP=NEW",
    )
    given = svars[:, 0]
    assert given[:, 11].tolist() == [3] * 4
    np.testing.assert_allclose(given[:, 12], [35, 50, 35, 20])
    np.testing.assert_allclose(given[:, 13], [15, 15, -15, -15])
    np.testing.assert_allclose(given[:, 14], [7] * 4)
    np.testing.assert_allclose(given[:2, 16], [0, 3])
    np.testing.assert_allclose(given[:2, 17], [0, 3])


def test_without_either_there_is_one_field_of_zeros(run_two_steps):
    svars, _ = run_two_steps()
    assert svars[:, :, 0].max() == 0
    assert svars[0, 0, 11:14].tolist() == [1, 0, 0]


@pytest.mark.parametrize(
    ("first", "message"),
    [
        ("*DLOAD\nFIRST, P2, 3.", r"deck.inp:24: \*DLOAD: load type P2 on elements of type U1, which are not built-in"),
        ("*DLOAD\nNOWHERE, U2, 3.", r"deck.inp:24: unknown element set NOWHERE"),
        ("*DLOAD\nFIRST", r"deck.inp:24: \*DLOAD: load type is missing"),
        ("*FIELD, VARIABLE=0\n1, 3.", r"deck.inp:23: \*FIELD: VARIABLE=0: expected a number from 1"),
        ("*TEMPERATURE, FILE=x", r"deck.inp:23: \*TEMPERATURE: option FILE is not supported"),
    ],
)
def test_messages(run_two_steps, first, message):
    with pytest.raises(DeckError, match=message):
        run_two_steps(first=first)


def test_load_on_a_built_in_element(tmp_path):
    text = DECK.format(model="", first="*DLOAD\n9, U2, 3.", second="")
    solid = "*ELEMENT, TYPE=CPE3, ELSET=SOLID\n9, 1, 2, 5\n*SOLID SECTION, ELSET=SOLID, MATERIAL=M\n"
    text = text.replace("*AMPLITUDE", f"{solid}*MATERIAL, NAME=M\n*ELASTIC\n1.\n*AMPLITUDE", 1)
    deck = tmp_path / "deck.inp"
    deck.write_text(text)
    with pytest.raises(DeckError, match=r"load type U2 on elements that are not user elements"):
        read_deck(deck)
