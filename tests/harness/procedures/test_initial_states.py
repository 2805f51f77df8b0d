# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS, TYPE=SOLUTION, by data lines and by SDVINI: springs and squares whose stiffness is a state."""

from pathlib import Path

import pytest

from uel import usersub
from uel.assembly import system_of
from uel.check.recording import record
from uel.check.replay import abaqus_order, replay
from uel.deck import read_deck
from uel.errors import DeckError, KernelError
from uel.model.records import IncrementDone
from uel.procedures import run_steps

USER = Path(__file__).with_name("initial.f")
SPRINGS = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 6., 0.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2, VARIABLES=2
1
*ELEMENT, TYPE=U1, ELSET=SPRINGS
1, 1, 2
{other}, 2, 3
*UEL PROPERTY, ELSET=SPRINGS
"""
SQUARE = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=SPRINGS
7, 1, 2, 3, 4
*SOLID SECTION, ELSET=SPRINGS, MATERIAL=M
1.
*MATERIAL, NAME=M
*USER MATERIAL, CONSTANTS=0
*DEPVAR
2
"""
STEP = """*STEP
*STATIC
1., 1.
*BOUNDARY
ALL, 1, 2
{end}, 1, 1, 0.5
*END STEP
"""
BY_SDVINI = "*INITIAL CONDITIONS, TYPE=SOLUTION, USER\n"


def deck(folder, conditions, model=SPRINGS, end=3, other=2):
    path = folder / "initial.inp"
    path.write_text(model.format(other=other) + conditions + STEP.format(end=end))
    return path


@pytest.fixture
def last_state(tmp_path):
    def last_state(*arguments, user=USER, **options):
        """The last record of a run."""
        path = deck(tmp_path, *arguments, **options)
        model = read_deck(path)
        library = usersub.load(user, job="job", output_dir=tmp_path, deck=path)
        try:
            system = system_of(model, library)
            *_, last = (r for r in run_steps(system, model, library) if isinstance(r, IncrementDone))
        finally:
            library.close()
        return last.solution

    return last_state


def test_states_by_data_lines(last_state):
    """The spring to node 3 has stiffness 8; a line of eight entries goes on in the next."""
    solution = last_state("*INITIAL CONDITIONS, TYPE=SOLUTION\nSPRINGS, 3., 4.\n2, 8.\n")
    assert solution.reaction[2] == pytest.approx(8.0 * 0.5)
    assert [state.svars.tolist() for state in solution.elements] == [[[3.0, 4.0], [8.0, 4.0]]]


def test_states_by_sdvini(last_state):
    """100 times the place of the middle: 4 for the second spring."""
    solution = last_state(BY_SDVINI)
    assert solution.reaction[2] == pytest.approx(400.0 * 0.5)
    assert solution.elements[0].svars.tolist() == [[100.0, 11.0], [400.0, 21.0]]


def test_sdvini_sets_statev_at_each_point(last_state):
    """Modulus 100 x in a square of side 1, whose corner moves; points in the order of Abaqus."""
    solution = last_state(BY_SDVINI, SQUARE, end=2)
    statev = solution.elements[0].svars.reshape(4, -1)[:, -2:]
    near, far = (0.5 - 0.5 / 3**0.5) * 100, (0.5 + 0.5 / 3**0.5) * 100
    assert statev[:, 0] == pytest.approx([near, far, near, far])
    assert statev[:, 1].tolist() == [71, 72, 73, 74]


def test_values_go_on_in_the_next_line(tmp_path):
    text = "*INITIAL CONDITIONS, TYPE=SOLUTION\nSPRINGS, 1., 2., 3., 4., 5., 6., 7.\n8., 9.\n2, 10.\n"
    first, second = read_deck(deck(tmp_path, text)).initial_solutions
    assert first.values.tolist() == [1, 2, 3, 4, 5, 6, 7, 8, 9]
    assert (second.elements.tolist(), second.values.tolist()) == ([1], [10.0])


def test_checks_begin_with_the_same_states(tmp_path):
    """The calls made again return what they returned in the run."""
    recording = record(deck(tmp_path, BY_SDVINI), [USER], 1)
    *_, (elements, results) = replay(recording, abaqus_order)
    svars = results.values[elements.starts[1] :][2 + 4 : 2 + 4 + 2]
    assert svars.tolist() == [400.0, 21.0]


@pytest.mark.parametrize(
    ("conditions", "message"),
    [
        ("*INITIAL CONDITIONS, TYPE=SOLUTION\n", r"initial.inp:\d+: \*INITIAL CONDITIONS: needs data lines, or USER"),
        ("*INITIAL CONDITIONS, TYPE=SOLUTION\nNONE, 1.\n", r"initial.inp:\d+: .*NONE"),
        (
            "*INITIAL CONDITIONS, TYPE=SOLUTION\n1, 1., 2., 3.\n",
            r"initial.inp:\d+: \*INITIAL CONDITIONS, TYPE=SOLUTION: 3 values, but elements of type U1 have 2",
        ),
        ("*INITIAL CONDITIONS, TYPE=VELOCITY, USER\n1, 1, 1.\n", "USER is for TYPE=SOLUTION"),
    ],
)
def test_what_is_wrong_is_named(last_state, conditions, message):
    with pytest.raises(DeckError, match=message):
        last_state(conditions)


def test_sdvini_is_needed(last_state, tmp_path):
    user = tmp_path / "uel.f"
    text = USER.read_text().split("      SUBROUTINE SDVINI")[0]
    user.write_text(text.replace("'../", f"'{USER.parents[1]}/"))
    with pytest.raises(DeckError, match=r"initial.inp:\d+: \*INITIAL CONDITIONS, USER needs SDVINI"):
        last_state(BY_SDVINI, user=user)


def test_sdvini_may_end_the_analysis(last_state):
    with pytest.raises(KernelError, match=r"element 66 \(type U1\): SDVINI stopped the analysis"):
        last_state(BY_SDVINI, other=66)
    message = r"element 67 \(type CPS4\): SDVINI at integration point 3 stopped the analysis"
    with pytest.raises(KernelError, match=message):
        last_state(BY_SDVINI, SQUARE.replace("\n7,", "\n67,"), end=2)
