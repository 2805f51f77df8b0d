# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements in random order: those that look only at their arguments pass, all others are found."""

import re
from pathlib import Path

import numpy as np
import pytest

from uel.assembly import system_of
from uel.check.recording import Pass, opened, record
from uel.check.replay import abaqus_order, replay
from uel.check.shuffle import ORDERS, TypeVerdict, advice_on_order, shuffle
from uel.cli import main
from uel.errors import KernelError

PATCH = Path(__file__).parents[3] / "abaqus_inputs" / "patch_horizontal"
COUNTER = Path(__file__).parent / "counter.f"
SPRINGS = 8


@pytest.fixture
def chain(tmp_path):
    """A chain of springs, pulled in two increments; the number says where the counter of counter.f goes."""

    def chain(array):
        nodes = "".join(f"{k}, {k}.\n" for k in range(1, SPRINGS + 2))
        elements = "".join(f"{k}, {k}, {k + 1}\n" for k in range(1, SPRINGS + 1))
        deck = tmp_path / "chain.inp"
        deck.write_text(
            f"*NODE\n{nodes}*USER ELEMENT, TYPE=U7, NODES=2, COORDINATES=1, I PROPERTIES=1, VARIABLES=2, UNSYMM\n1\n"
            f"*ELEMENT, TYPE=U7, ELSET=ALL\n{elements}*UEL PROPERTY, ELSET=ALL\n{array}\n"
            f"*STEP\n*STATIC, DIRECT\n0.5, 1.\n*BOUNDARY\n1, 1\n{SPRINGS + 1}, 1, 1, 0.8\n*END STEP\n"
        )
        return deck

    return chain


@pytest.mark.parametrize("name", ["flat_u2", "flat_u4"])
def test_elements_that_depend_on_no_order(name):
    outcome = shuffle(PATCH / f"{name}.inp", increments=1)
    assert outcome.passed
    quads, interface = outcome.types
    passes = quads.calls // (100 * ORDERS)
    assert passes >= 2  # the first pass, and one after the solution
    assert (quads.calls, interface.calls) == (passes * 100 * ORDERS, passes * 10 * ORDERS)


def test_pressures_on_faces_are_no_elements(tmp_path):
    deck = tmp_path / "pressed.inp"
    deck.write_text(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE=CPE4, ELSET=BODY\n1, 1, 2, 3, 4\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
        "*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1, 2\n4, 1\n*DLOAD\nBODY, P2, 5.\n*END STEP\n"
    )
    outcome = shuffle(deck, increments=1)
    assert outcome.passed
    assert len(outcome.types) == 1


@pytest.mark.long
@pytest.mark.parametrize("element", ["u2", "u4"])
def test_double_cantilever_beam(element):
    outcome = shuffle(PATCH.parent / "dcb" / f"dcb_{element}_1e8.inp", increments=5)
    assert outcome.recording.increments == 5
    assert outcome.passed


def test_table_of_elements_that_depend_on_no_order(capsys):
    assert main(["check", str(PATCH / "perturbed_u4.inp"), "--shuffle"]) == 0
    printed = capsys.readouterr().out
    assert "perturbed_u4.inp: 3 random orders (seed 1)" in printed
    assert "increments: 1; calls of each element in each order: " in printed
    assert printed.count("the same in any order") == 2


def test_four_node_element_is_refused(capsys):
    assert main(["check", str(PATCH / "flat_u3.inp"), "--shuffle"]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    message = (
        r"type U3\): stopped the analysis: .*OFFSET(BOTTOM|TOP) = -\d+: bulk element \d+ has not been evaluated before"
    )
    assert re.search(message, printed)
    assert "give those elements lower numbers" in printed
    assert "U4 is the same element without this dependence" in printed
    assert re.search(r"U1 │ 100 │ \d+ │ the same in any", printed)


@pytest.mark.parametrize(("name", "other"), [("U3", "U4"), ("U10", "U8"), ("U7", "")])
@pytest.mark.parametrize("ours", [True, False])
def test_advice_names_the_element_with_its_own_solids(name, other, ours):
    verdict = TypeVerdict(name, 1, refusal=KernelError(1, name, "stopped the analysis"))
    advice = advice_on_order(verdict, ours=ours)
    assert advice.startswith(f"{name}: it depends on what calls of other elements leave")
    assert ("is the same element without" in advice) == bool(ours and other)
    assert not (ours and other) or f"{other} is the same element" in advice


@pytest.mark.parametrize(
    "array, entry", [(1, "RHS(2)"), (2, "AMATRX(1,2)"), (3, "SVARS(2)"), (4, "ENERGY(2)"), (5, "PNEWDT")]
)
def test_hidden_counter_is_found_in_every_array(chain, array, entry):
    outcome = shuffle(chain(array), [COUNTER], increments=1)
    (springs,) = outcome.types
    assert not outcome.passed
    assert f"step 1, increment 1: {entry} is " in springs.first
    assert len(springs.different) == SPRINGS


@pytest.mark.parametrize("array, first", [(0, ""), (7, "RHS(1,2) is ")])
def test_arc_length_method(chain, array, first):
    """NRHS is 2: column 2 of RHS is compared too."""
    deck = chain(array)
    text = deck.read_text().replace("*STATIC, DIRECT\n0.5, 1.", "*STATIC, RIKS\n0.5, 1., , , 1.")
    deck.write_text(text.replace(f"{SPRINGS + 1}, 1, 1, 0.8", f"*CLOAD\n{SPRINGS + 1}, 1, 0.1"))
    (springs,) = shuffle(deck, [COUNTER]).types
    assert springs.calls > 0
    assert springs.passed == (array == 0)
    assert first in springs.first


def test_values_of_the_first_difference(chain):
    """The mass pass counts SPRINGS calls; element k is then the k-th one in Abaqus' order."""
    (springs,) = shuffle(chain(3), [COUNTER], increments=1).types
    found = re.fullmatch(r"element (\d+), .* is (\d+) in Abaqus' order, (\d+) in random order 1", springs.first)
    element, expected, other = map(int, found.groups())
    assert expected == SPRINGS + element
    assert other != expected


def test_hidden_counter_on_the_command_line(chain, capsys):
    words = ["check", str(chain(1)), "--user", str(COUNTER), "--shuffle", "--seed", "5"]
    assert main(words) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "(seed 5)" in printed
    assert "U7: something outlives a call and is not in SVARS: look for SAVE, COMMON, module variables" in printed


def test_user_element_that_ends_the_analysis(chain, capsys):
    assert main(["check", str(chain(6)), "--user", str(COUNTER), "--shuffle"]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert re.search(r"element [2-8] \(type U7\): stopped the analysis \(XIT\) without a message", printed)
    assert "U4 is the same" not in printed


def test_element_without_the_fault_passes(chain):
    assert shuffle(chain(0), [COUNTER]).passed


def test_run_that_fails_to_converge_is_checked_up_to_there(chain, capsys):
    deck = chain(0)
    deck.write_text(deck.read_text().replace("*STEP", "*STEP, INC=1"))
    assert main(["check", str(deck), "--user", str(COUNTER), "--shuffle"]) == 0
    assert "The run ended early: TOO MANY INCREMENTS" in capsys.readouterr().out


def test_run_without_convergence_has_not_passed(chain, tmp_path, capsys):
    """INC= of the deck is the author's own choice; an increment that diverges is none."""
    deck, user = chain(0), tmp_path / "diverges.f"
    last = f"{SPRINGS + 1}, 1, "
    deck.write_text(deck.read_text().replace(f"{last}1, 0.8", f"*CLOAD\n{last}0.8"))
    text = COUNTER.read_text().replace("../uel.inc", str(COUNTER.parents[1] / "uel.inc"))
    user.write_text(text.replace("      end\n", "      amatrx = 0.1d0*amatrx\n      end\n"))
    assert main(["check", str(deck), "--user", str(user), "--shuffle"]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "The run ended early: " in printed
    assert "the same in any order" in printed


def test_deck_that_does_not_run_in_the_order_of_abaqus(tmp_path, capsys):
    for path in PATCH.glob("flat_*.inp"):
        (tmp_path / path.name).write_text(path.read_text().replace("30., 60., 0.26", "-30., 60., 0.26"))
    assert main(["check", str(tmp_path / "flat_u2.inp"), "--shuffle"]) == 2
    assert "SIGMAMAX" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--increments", "--seed"])
def test_numbers_below_one(option, capsys):
    with pytest.raises(SystemExit):
        main(["check", "any.inp", "--shuffle", option, "0"])
    assert "expected a whole number of 1 or more, found '0'" in " ".join(capsys.readouterr().err.split())


def test_replay_makes_the_calls_of_the_run():
    """The sum of what single elements return in a replay is what the system assembles from the same pass."""
    recording = record(PATCH / "flat_u4.inp", (), 1)
    replayed = list(replay(recording, abaqus_order))
    assert [results.made for _, results in replayed] == [e for e in recording.events if isinstance(e, Pass)]
    elements, last = replayed[-1]
    numbers = [row for equations in recording.equations for row in equations]
    sums = np.zeros(last.made.u.size)
    for start, row in zip(elements.starts, numbers, strict=False):
        np.add.at(sums, row, last.values[start : start + len(row)])
    with opened(recording.model, ()) as library:
        system = system_of(recording.model, library)
        assembled = system.evaluate(last.made.call, last.made.u, last.made.du)
    np.testing.assert_allclose(sums, assembled.residual, rtol=0, atol=1e-9 * np.abs(assembled.residual).max())
    assert np.abs(assembled.residual).max() > 1


def test_replay_goes_on_from_the_committed_state(chain):
    """SVARS(1) adds up the elongations of the increments: 0.8 of the chain in the end, the same in every spring."""
    *_, (elements, last) = replay(record(chain(0), [COUNTER], 2), np.random.default_rng(1).permutation)
    first_of_svars = 2 + 4
    elongations = last.values[elements.starts[:-1] + first_of_svars]
    np.testing.assert_allclose(elongations, 0.8 / SPRINGS, rtol=1e-12)
