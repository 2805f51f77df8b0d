# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*RESTART: a run that goes on from a kept state is the one that was never interrupted."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from bent_beams import COUPLING, HIGH, LENGTH
from bent_beams import beam as bent_beam
from bent_beams import step as bending
from contact_decks import plane, two_boxes
from contact_decks import step as contact_step
from small_decks import snapping

import uel
from uel.assembly.finite_couplings import KinematicCouplings
from uel.cli import main
from uel.errors import ConvergenceError, DeckError, SingularMatrixError, UelError, UsageError
from uel.model.records import StateKept
from uel.output.files.state_files import FORMAT, StateFiles, array_digest, folder_of, read_state

USER = Path(__file__).with_name("restart.f90")
DCB = Path(__file__).parents[2] / "abaqus_inputs" / "dcb" / "dcb_u4_1e6.inp"

EQUAL = 1e-12
"""Of the largest entry: the processor may add terms in another order where an array begins elsewhere in memory."""

NODES = "".join(f"{1 + k + 5 * row}, {k}., {row}.\n" for row in range(2) for k in range(5))
QUADS = "".join(f"{k}, {k}, {k + 1}, {k + 6}, {k + 5}\n" for k in range(1, 5))
SETS = "*NSET, NSET=LEFT\n1, 6\n*NSET, NSET=RIGHT\n5, 10\n*NSET, NSET=ALL, GENERATE\n1, 10\n"
OUTPUT = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=RIGHT\nU, RF\n*ENERGY OUTPUT\n*OUTPUT, FIELD, FREQUENCY=0\n"


def beam(element, material, steps, *, model=""):
    """Four quads in a row, held at the left."""
    return (
        f"*NODE\n{NODES}*ELEMENT, TYPE={element}, ELSET=BODY\n{QUADS}{SETS}{model}*RESTART, WRITE\n"
        f"*SURFACE, NAME=TOP\nBODY, S3\n*MATERIAL, NAME=M\n{material}" + "".join(f"{step}*END STEP\n" for step in steps)
    )


SOLID = "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n"
ELASTIC = "*ELASTIC\n1000., 0.3\n"
DYNAMIC = beam(
    "CPE4R",
    ELASTIC + "*DENSITY\n1.\n",
    [
        f"*STEP\n*DYNAMIC, HAFTOL=50.\n0.05, 1.\n*BOUNDARY\nLEFT, 1, 2\n*CLOAD, AMPLITUDE=WAVE\nRIGHT, 2, 1.\n{OUTPUT}",
        f"*STEP\n*DYNAMIC, HAFTOL=50.\n0.05, 0.5\n*CLOAD, OP=NEW\n{OUTPUT}",
    ],
    model=SOLID + "*AMPLITUDE, NAME=WAVE, TIME=TOTAL TIME\n0., 0., 0.3, 1., 0.7, -1., 1., 0.\n",
)
RUBBER = beam(
    "CPE4H",
    "*HYPERELASTIC, NEO HOOKE\n100., 0.\n*DENSITY\n1.\n",
    [
        f"*STEP, NLGEOM\n*STATIC\n0.25, 1., 1e-5, 0.25\n*BOUNDARY\nLEFT, 1, 2\n*CLOAD\nRIGHT, 2, 1.\n{OUTPUT}",
        f"*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.05, 0.2\n*CLOAD, OP=NEW\n{OUTPUT}",
    ],
    model=SOLID,
)
HEAT = beam(
    "DC2D4",
    "*CONDUCTIVITY\n1.\n*SPECIFIC HEAT\n1.\n*DENSITY\n1.\n",
    [
        "*STEP, INC=50\n*HEAT TRANSFER, DELTMX=5., END=SS\n0.02, 2., 1e-6, 1., 0.5\n*BOUNDARY\nLEFT, 11, 11, 20.\n"
        "*SFILM\nTOP, F, 0., 0.4\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=RIGHT\nNT\n",
    ],
    model=SOLID + "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 5.\n",
)
UMAT = beam(
    "CPE4",
    "*USER MATERIAL, CONSTANTS=2\n1000., 30.\n*DEPVAR\n1\n",
    [
        "*STEP, NLGEOM, EXTRAPOLATION=PARABOLIC, INC=50\n*STATIC, STABILIZE\n0.1, 1.\n*BOUNDARY\nLEFT, 1, 2\n"
        f"*DSLOAD\nTOP, P, 1.\n{OUTPUT}"
    ],
    model="*ORIENTATION, NAME=TURNED\n1., 1., 0., -1., 1., 0.\n"
    "*SOLID SECTION, ELSET=BODY, MATERIAL=M, ORIENTATION=TURNED\n1.\n",
)
STEPS = beam(
    "CPS4R",
    ELASTIC,
    [
        "*STEP\n*STATIC\n0.25, 1., 1e-5, 0.25\n*BOUNDARY\nLEFT, 1, 2\n*BOUNDARY, TYPE=VELOCITY\nRIGHT, 1, 1, 0.01\n"
        f"*CLOAD\n8, 2, 0.5\n9, 2, 0.5\n*TEMPERATURE\nALL, 10.\n{OUTPUT}",
        f"*STEP\n*STATIC\n0.3, 1., 1e-5, 0.3\n*CLOAD, OP=NEW, AMPLITUDE=UP\n7, 2, 1.\n*DSLOAD\nTOP, P, 0.1\n{OUTPUT}",
        f"*STEP\n*STATIC\n0.5, 1., 1e-5, 0.5\n*BOUNDARY, OP=NEW\nLEFT, 1, 2\n{OUTPUT}",
    ],
    model=SOLID + "*AMPLITUDE, NAME=UP, TIME=TOTAL TIME\n0., 0., 3., 1.\n",
)
DELAMINATION = DCB.read_text().replace("*STEP", "*RESTART, WRITE\n*STEP", 1).replace("INPUT=", f"INPUT={DCB.parent}/")
DELAMINATION = re.sub(r"(\*STATIC.*\n).*", r"\g<1>0.03, 0.15", DELAMINATION)
FAST = DCB.parents[1] / "properties" / "u4_fast.inp"
FAST = FAST.read_text().replace("*STEP", "*RESTART, WRITE\n*STEP", 1).replace("FREQUENCY=100", "FREQUENCY=1")
FAST = re.sub(r"(\*STATIC.*\n).*", r"\g<1>0.03, 0.3, 1e-6, 0.03", FAST)
"""The rate of the separation, in an increment, needs the separation at its start."""
CONTACT = two_boxes(
    *plane(0.01, upper=3),
    [
        "*RESTART, WRITE",
        "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nUPPER_TOP, 1",
        contact_step("0.3, 1., 1e-5, 0.3", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.03", options=", NLGEOM").replace(
            "*OUTPUT, FIELD", ""
        ),
        contact_step("0.2, 1., 1e-5, 0.2", "*BOUNDARY\nUPPER_TOP, 1, 1, 0.05").replace("*OUTPUT, FIELD", ""),
    ],
    pair="SMALL SLIDING, TYPE=SURFACE TO SURFACE",
    behavior="*FRICTION\n0.3,",
)
SLIDING = two_boxes(
    *plane(0.01, upper=1, lower=8, width=4.0),
    [
        "*RESTART, WRITE",
        "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nUPPER_TOP, 1",
        contact_step("0.3, 1., 1e-5, 0.3", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.03", options=", NLGEOM").replace(
            "*OUTPUT, FIELD", ""
        ),
        contact_step("0.2, 1., 1e-5, 0.2", "*BOUNDARY\nUPPER_TOP, 1, 1, 2.").replace("*OUTPUT, FIELD", ""),
    ],
    pair="TYPE=NODE TO SURFACE",
    behavior="*FRICTION\n0.3,",
)
TURNING = "\n".join(
    [
        *bent_beam(
            reference=(LENGTH + 1.0, HIGH),
            constraint="*RESTART, WRITE\n" + COUPLING.replace("KINEMATIC", "DISTRIBUTING"),
        ),
        *bending("*CLOAD", "900, 2, 1.", increments=4),
        *bending("*BOUNDARY", "900, 6, 6, 1.", increments=4),
    ]
)
HELD = "\n".join(
    [
        "*NODE, NSET=ALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.",
        "5, 0.1, 0., 1.\n6, 1., 0., 1.1\n7, 1., 1.2, 1.\n8, 0., 1., 1.\n900, 0.4, 0.45, 0.1",
        "*NSET, NSET=END, GENERATE\n1, 4\n*NSET, NSET=TOP, GENERATE\n5, 8",
        "*ELEMENT, TYPE=C3D8, ELSET=BODY\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*SOLID SECTION, ELSET=BODY, MATERIAL=M",
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SURFACE, NAME=END, TYPE=NODE\nEND",
        "*COUPLING, CONSTRAINT NAME=C, REF NODE=900, SURFACE=END\n*KINEMATIC\n*RESTART, WRITE",
        "*BOUNDARY\n1, 3\n2, 3\n4, 3\n900, 1, 2",
        "*STEP, NLGEOM\n*STATIC\n0.1, 1., 1e-5, 0.1\n*BOUNDARY\n900, 6, 6, 2.2\n*CLOAD\nTOP, 1, 3.",
        "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU, RF\n*END STEP",
        "*STEP, NLGEOM\n*STATIC\n0.25, 1., 1e-5, 0.25\n*CLOAD\nTOP, 2, 7.\nTOP, 3, 2.",
        "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU, RF\n*END STEP\n",
    ]
)
"""Nodes of a face that turns with its reference node are held across.

They eliminate its rotations in another order in the second step than in the first.
"""
SPINNING = "\n".join(
    [
        *bent_beam(constraint="*RESTART, WRITE\n" + COUPLING),
        *bending("*CLOAD", "900, 6, 5.", how="*DYNAMIC, HAFTOL=100.", name="*STEP, NLGEOM, INC=100, AMPLITUDE=RAMP"),
    ]
).replace("*ELASTIC", "*DENSITY\n1.\n*ELASTIC")
DECKS = {
    **{"dynamic": DYNAMIC, "rubber": RUBBER, "heat": HEAT, "umat": UMAT, "steps": STEPS, "delamination": DELAMINATION},
    **{"contact": CONTACT, "sliding": SLIDING, "turning": TURNING, "held": HELD, "spinning": SPINNING},
    "fast": FAST,
    "surfaces": SLIDING.replace("NODE TO", "SURFACE TO"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(name, text):
    path = Path(f"{name}.inp")
    path.write_text(text)
    return path


def states(job):
    """Step and increment of the states of a job, in order."""
    found = (re.findall(r"\d+", path.name) for path in folder_of(Path(job)).glob("*.npz"))
    return sorted((int(step), int(increment)) for step, increment in found)


def rows(job):
    """Lines of .sta about attempts."""
    return [line for line in Path(f"{job}.sta").read_text().splitlines() if re.match(r"\s+\d+\s+\d+\s", line)]


def leaves(value, name=""):
    """Numbers, texts and arrays of a state, with their places."""
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(part, f"{name}/{key}")
    else:
        yield name, value


def assert_alike(first, second):
    """Two states agree in everything that a run goes on from."""
    one, other = dict(leaves(first)), dict(leaves(second))
    assert one.keys() == other.keys()
    for name, value in one.items():
        if isinstance(value, np.ndarray | float):
            size = np.abs(value).max(initial=0.0) if isinstance(value, np.ndarray) else abs(value)
            np.testing.assert_allclose(other[name], value, rtol=0, atol=EQUAL * size, err_msg=name)
        else:
            assert other[name] == value, name


def assert_goes_on(job, new, place):
    """A job that went on after `place` has the rest of the other's rows, history and states."""
    rest = [one for one in states(job) if one > place]
    assert states(new) == rest
    for step, increment in rest:
        kept = [read_state(Path(name), step, increment).analysis for name in (job, new)]
        assert_alike(*kept)
    all_rows, own = rows(job), rows(new)
    assert own == all_rows[len(all_rows) - len(own) :]
    history = [uel.output.Result(name).history for name in (job, new)]
    for name, values in history[1].items():
        whole = history[0][name]
        size = np.nanmax(np.abs(whole), initial=0.0)
        np.testing.assert_allclose(values, whole[len(whole) - len(values) :], rtol=0, atol=EQUAL * size, err_msg=name)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("name", "linear_solver"),
    [*((name, "auto") for name in DECKS), pytest.param("umat", "superlu", marks=pytest.mark.long)],
)
def test_restart_is_the_run_that_was_not_interrupted(folder, name, linear_solver):
    """From any of its states, with the deck of the job itself."""
    deck, user = written(name, DECKS[name]), USER if name == "umat" else None
    solver = uel.SolverOptions(linear_solver=linear_solver)
    uel.run(deck, user, job="whole", solver=solver)
    kept = states("whole")
    assert len(kept) > 4
    for number, place in enumerate([kept[0], kept[-2]] if name == "delamination" else kept[: -1 : 1 + len(kept) // 4]):
        # a job of which only the states up to this one are left
        new = f"again{number}"
        source = folder / f"part{number}_restart"
        source.mkdir()
        step, increment = place
        file = f"step{step}_increment{increment:04d}.npz"
        (source / file).write_bytes((folder_of(Path("whole")) / file).read_bytes())
        uel.run(deck, user, job=new, oldjob=f"part{number}", solver=solver)
        assert_goes_on("whole", new, place)


def test_restart_eliminates_what_the_run_did(folder, monkeypatch):
    """Rotations of a node that an earlier step has turned are eliminated anew, or results differ by rounding."""
    built = []
    choose = KinematicCouplings._choose

    def noted(arms, start):
        found = choose(arms, start)
        built.append(found.eliminated.tolist())
        return found

    monkeypatch.setattr(KinematicCouplings, "_choose", noted)
    deck = written("held", HELD)
    uel.run(deck, job="whole")
    first, second = built[0], built[-1]
    assert first != second
    built.clear()
    state = Path("whole_restart") / "step2_increment0002.npz"
    Path("part_restart").mkdir()
    (Path("part_restart") / state.name).write_bytes(state.read_bytes())
    uel.run(deck, job="again", oldjob="part")
    assert built == [second]


def test_run_that_is_killed_goes_on_with_one_command(folder):
    """kill -9 before an increment of the second step: the deck itself, with other user routines, ends the analysis."""
    deck = written("steps", STEPS)
    uel.run(deck, USER, job="whole")
    words = [sys.executable, "-m", "uel", "run", str(deck), "--user", str(USER), "--quiet"]
    killed = subprocess.run(
        words, env={**os.environ, "KILL_BEFORE": "2 3"}, capture_output=True, text=True, check=False
    )
    assert killed.returncode == 1
    assert "signal 9" in killed.stderr or "SIGKILL" in killed.stderr, killed.stderr
    assert states("steps")[-1] == (2, 2)
    assert main(["run", str(deck), "--oldjob", "steps", "--job", "steps-2", "--quiet"]) == 0
    assert_goes_on("whole", "steps-2", (2, 2))
    assert rows("steps") + rows("steps-2") == rows("whole")


def calls(job):
    """Arguments of UEXTERNALDB: LOP, LRESTART, KSTEP, KINC, TIME(1), TIME(2)."""
    found = re.findall(
        r"LOP (\d+) LRESTART (\d+) STEP (\d+) INC (\d+) TIME\s+(\S+)\s+(\S+)", Path(f"{job}.msg").read_text()
    )
    return [(*map(int, one[:4]), *map(float, one[4:])) for one in found]


def test_calls_of_uexternaldb(folder):
    """LRESTART where a state is written, 2 where it takes the place of another; LOP=4 in place of 0 at a restart."""
    steps = STEPS.replace("*RESTART, WRITE\n", "*RESTART, WRITE, FREQUENCY=3\n")
    steps = steps.replace("*STEP\n*STATIC\n0.3,", "*STEP\n*RESTART, WRITE, OVERLAY\n*STATIC\n0.3,")
    deck = written("steps", steps)
    uel.run(deck, USER)
    ends = [(step, increment, lrestart) for lop, lrestart, step, increment, *_ in calls("steps") if lop == 2]
    assert ends == [(1, 1, 0), (1, 2, 0), (1, 3, 1), (1, 4, 1), *((2, k, 2) for k in range(1, 5)), (3, 1, 2), (3, 2, 2)]
    assert states("steps") == [(1, 3), (1, 4), (2, 4), (3, 2)]
    read = written("again", "*RESTART, READ, STEP=1, INC=3\n")
    uel.run(read, USER, oldjob="steps")
    first, second, *_, before_last, last = calls("again")
    assert first == (4, 0, 1, 3, 0.75, 0.75)
    assert second[:4] == (1, 0, 1, 4)
    assert (before_last[0], last[0]) == (6, 3)
    assert 0 not in [call[0] for call in calls("again")]
    assert states("again") == [(1, 4)]


BAR = beam(
    "CPS4",
    "*ELASTIC\n1000., 0.\n",
    [f"*STEP\n*STATIC, DIRECT\n0.25, 1.\n*BOUNDARY\nLEFT, 1\n1, 2\n*CLOAD\nRIGHT, 1, 4.\n{OUTPUT}"],
    model=SOLID,
)
"""A bar of stiffness 1000/4 and two nodes with the same force at its end: u = 2 F / 250."""


def test_a_step_that_goes_on_says_where_its_matrix_is_singular(folder):
    """A spring that gives way at a force of 1, in increments that are fixed: the third has no stiffness."""
    step = "*STATIC, DIRECT\n0.25, 1.\n*CLOAD\n2, 1, 2.\n*RESTART, WRITE, FREQUENCY=1\n*END STEP\n"
    deck = written(
        "yields",
        "*NODE\n1, 0.\n2, 1.\n*ELEMENT, TYPE=SPRINGA, ELSET=S\n1, 1, 2\n*SPRING, ELSET=S, NONLINEAR\n\n"
        f"-1., -1.\n1., 1.\n1., 2.\n*BOUNDARY\n1, 1, 2\n2, 2, 2\n*RESTART, WRITE\n*STEP\n{step}",
    )
    message = r"yields\.inp:15: singular system matrix at node 2, dof 1"
    with pytest.raises(SingularMatrixError, match=message):
        uel.run(deck)
    read = written("again", "*RESTART, READ, STEP=1, INC=2\n")
    with pytest.raises(SingularMatrixError, match=message):
        uel.run(read, oldjob="yields")


@pytest.mark.parametrize(
    ("options", "times", "forces"),
    [
        # the rest of the step, then the new one; with END STEP the force stays what it was
        (", INC=2", [0.75, 1.0, 1.5, 2.0], [3.0, 4.0, 6.0, 8.0]),
        (", INC=2, END STEP", [1.0, 1.5], [5.0, 8.0]),
        ("", [1.5, 2.0], [6.0, 8.0]),
    ],
)
def test_restart_deck_adds_steps_sets_and_amplitudes(folder, options, times, forces):
    uel.run(written("bar", BAR))
    new = "*STEP\n*STATIC, DIRECT\n0.5, 1.\n*CLOAD\nOTHERS, 1, 8.\n" + OUTPUT + "*END STEP\n"
    uel.run(
        written("new", f"*HEADING\nmore load\n*RESTART, READ, STEP=1{options}\n*NSET, NSET=OTHERS\n5, 10\n{new}"),
        oldjob="bar",
    )
    history = uel.output.Result("new").history
    assert history["time"] == pytest.approx(times)
    assert history["U1[RIGHT:5]"] == pytest.approx(2 * np.array(forces) / 250)
    assert Path("new.dat").read_text().count("more load")
    # a restart of the restart: the set is from the second deck, the amplitude from the third
    third = f"*STEP\n*STATIC\n1., 1.\n*CLOAD, AMPLITUDE=HALF\nOTHERS, 1, 6.\n{OUTPUT}*END STEP\n"
    written("third", f"*RESTART, READ\n*AMPLITUDE, NAME=HALF\n0., 0.5, 1., 0.5\n{third}")
    assert main(["run", "job=third", "oldjob=new", "--quiet"]) == 0
    assert uel.output.Result("third").history["U1[RIGHT:5]"] == pytest.approx([2 * 3.0 / 250])


@pytest.mark.parametrize(
    ("request_", "kept"),
    [
        ("*RESTART, WRITE, FREQUENCY=0", []),
        ("*RESTART, WRITE, FREQUENCY=3", [3, 4]),
        ("*RESTART, WRITE, OVERLAY", [4]),
        ("*RESTART, WRITE, NUMBER INTERVAL=2, TIME MARKS=NO", [2, 4]),
        ("*RESTART, WRITE, NUMBER INTERVAL=3", [2, 3, 4]),
        ("*RESTART, WRITE, NUMBER INTERVAL=1, OVERLAY", [4]),
    ],
)
def test_which_increments_are_kept(folder, request_, kept):
    uel.run(written("bar", BAR.replace("*RESTART, WRITE", request_)))
    assert states("bar") == [(1, increment) for increment in kept]


def test_increments_do_not_end_at_time_marks(folder):
    result = uel.run(
        written("bar", BAR.replace("*RESTART, WRITE", "*RESTART, WRITE, NUMBER INTERVAL=3, TIME MARKS=YES"))
    )
    assert any(re.search("increments do not end at the times", warning) for warning in result.warnings)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("*RESTART", "expected READ or WRITE"),
        ("*RESTART, WRITE, FREQUENCY=-1", "FREQUENCY=-1 must not be negative"),
        ("*RESTART, WRITE, NUMBER INTERVAL=0", "NUMBER INTERVAL=0 must be positive"),
        ("*RESTART, WRITE, NUMBER INTERVAL=2, FREQUENCY=1", "FREQUENCY and NUMBER INTERVAL exclude each other"),
        ("*RESTART, READ, STEP=1", "the model is that of an earlier job, uel run --oldjob NAME"),
    ],
)
def test_wrong_options(folder, line, message):
    with pytest.raises(DeckError, match=rf"bar\.inp:\d+: .*{message}"):
        uel.run(written("bar", BAR.replace("*RESTART, WRITE", line)))


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("*RESTART, READ, STEP=0\n", DeckError, "STEP=0 must be positive"),
        ("*RESTART, READ, INC=2\n", DeckError, "INC needs STEP"),
        (
            "*RESTART, READ, STEP=1, INC=2\n*RESTART, READ, STEP=1, INC=1\n",
            DeckError,
            r"new\.inp:2: \*RESTART: \*RESTART, READ is there already, at .*new\.inp:1",
        ),
        ("*RESTART, READ, STEP=2\n", UelError, "bar_restart: no state of step 2"),
        ("*RESTART, READ, STEP=1, INC=9\n", UelError, "bar_restart: no state of step 1, increment 9"),
        ("*RESTART, READ\n", UsageError, "step 1, increment 4 is that of the end of the analysis: .* adds steps"),
        (
            "*RESTART, READ\n*NODE\n50, 1., 1.\n",
            DeckError,
            r"\*NODE: the model is that of the old job, .* adds only \*AMP",
        ),
        ("*HEADING\n", UsageError, r"has no \*RESTART, READ, and is not the deck of that job, which is .*bar\.inp"),
    ],
)
def test_decks_that_cannot_go_on(folder, text, error, message):
    uel.run(written("bar", BAR))
    with pytest.raises(error, match=message):
        uel.run(written("new", text), oldjob="bar")


def test_old_jobs_that_cannot_be_taken_up(folder):
    deck = written(
        "bar", BAR.replace("*NODE", "*PARAMETER\nforce = 4.\n*NODE", 1).replace("RIGHT, 1, 4.", "RIGHT, 1, <force>")
    )
    again = {"oldjob": "bar", "job": "again"}
    with pytest.raises(UelError, match=r"bar: the job has kept no state; .* in bar_restart; a warning in bar\.dat"):
        uel.run(deck, **again)
    uel.run(deck, parameters={"force": 2.0})
    with pytest.raises(
        UsageError, match="--oldjob bar: the new job has the same name; give it another one, --job bar-2"
    ):
        uel.run(deck, oldjob="bar")
    with pytest.raises(UsageError, match="the deck goes on with the parameters of that job; give none"):
        uel.run(deck, parameters={"force": 3.0}, **again)
    text = deck.read_text()
    deck.write_text(text.replace("1000.", "999."))
    with pytest.raises(UelError, match=r"comes from .*bar\.inp, which, or a file that it includes, has changed since"):
        uel.run(deck, **again)
    read = written("new", "*RESTART, READ, STEP=1, INC=1\n")
    deck.unlink()
    with pytest.raises(UelError, match=r"comes from .*bar\.inp, which cannot be read: .*No such file"):
        uel.run(read, oldjob="bar")
    deck.write_text(text)
    uel.run(read, oldjob="bar")
    assert uel.output.Result("new").history["U1[RIGHT:5]"][-1] == pytest.approx(2 * 2.0 / 250)


def tampered(job, change):
    """Change the tree, or an array, of the last state of a job, as if it had been written so."""
    path = max(folder_of(Path(job)).glob("*.npz"))
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    tree = json.loads(arrays["tree"].tobytes())
    change(tree, arrays)
    tree["digests"] = [array_digest(arrays[f"array{k}"]) for k in range(len(arrays) - 2)]
    arrays["tree"] = np.frombuffer(json.dumps(tree).encode(), np.uint8)
    arrays["check"] = np.array(array_digest(arrays["tree"]))
    np.savez(path, **arrays)
    return path


def test_states_of_another_version_or_model_and_damaged_ones(folder):
    deck = written("bar", BAR)
    uel.run(deck)

    def cut(tree, arrays):
        name = f"array{tree['analysis']['system']['blocks'][0]['svars']['array']}"
        arrays[name] = arrays[name][:, 1:]

    tampered("bar", cut)
    with pytest.raises(
        UelError,
        match=r"increment0004\.npz: the state of the old job is of another model: elements of type CPS4 differ",
    ):
        uel.run(written("new", f"*RESTART, READ\n*STEP\n*STATIC\n1., 1.\n{OUTPUT}*END STEP\n"), oldjob="bar")
    uel.run(deck)
    path = tampered("bar", lambda tree, _: tree.update(format=FORMAT + 1))
    with pytest.raises(
        UelError, match=f"has format {FORMAT + 1}; this version of uel reads format {FORMAT}: run the old"
    ):
        uel.run(deck, oldjob="bar", job="again")
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(UelError, match=r"increment0004\.npz is damaged, or is not a state of a job"):
        uel.run(deck, oldjob="bar", job="again")


def test_kill_while_a_state_is_written_leaves_the_one_before(folder, monkeypatch):
    files = StateFiles(Path("job"), ())
    files.write(StateKept(1, 1, True, {"finished": False, "values": np.arange(3.0)}))

    def killed(file, **arrays):
        file.write(b"PK")
        raise KeyboardInterrupt

    monkeypatch.setattr(np, "savez", killed)
    with pytest.raises(KeyboardInterrupt):
        files.write(StateKept(1, 2, True, {}))
    state = read_state(Path("job"))
    assert (state.step, state.increment) == (1, 1)
    assert state.analysis["values"].tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("old", "new", "options", "reason"),
    [
        ("*STATIC, DIRECT\n0.25, 1.", "*STATIC, RIKS\n0.25, 1., , , 1.", {}, "THE LOAD FACTOR IS PART OF THE SOLUTION"),
        ("", "", {"energy_control": True}, "THE LOAD FACTOR IS PART OF THE SOLUTION"),
        ("", "", {"fallback": True}, "THE SEARCH OF --FALLBACK .*; TO KEEP STATES, RUN WITHOUT IT"),
    ],
)
def test_steps_that_keep_no_states(folder, old, new, options, reason):
    """A warning says why: such a deck runs as it does without *RESTART."""
    text = BAR.replace("*CLOAD\nRIGHT, 1, 4.", "*BOUNDARY\nRIGHT, 1, 1, 0.1") if "energy_control" in options else BAR
    result = uel.run(written("bar", text.replace(old, new) if old else text), solver=uel.SolverOptions(**options))
    assert any(
        re.search(rf"\*RESTART, WRITE HAS NO EFFECT IN STEP 1: {reason}", text.upper()) for text in result.warnings
    )
    assert states("bar") == []


@pytest.mark.parametrize(
    ("options", "end_step", "message"),
    [
        ({"fallback": True}, ", END STEP", "--fallback: its search compares .* go on from --oldjob bar without it"),
        ({"fallback": True}, "", "--fallback: its search compares .* or run the whole analysis with it"),
        ({"energy_control": True}, "", "step 1 of --oldjob bar goes on as it began, in time; expected .* END STEP"),
    ],
)
def test_options_that_a_restart_does_not_take(folder, options, end_step, message):
    uel.run(written("bar", BAR))
    more = f"*STEP\n*STATIC, DIRECT\n0.5, 1.\n*CLOAD\nRIGHT, 1, 8.\n{OUTPUT}*END STEP\n"
    with pytest.raises(UsageError, match=message):
        uel.run(
            written("more", f"*RESTART, READ, STEP=1, INC=2{end_step}\n{more}"),
            oldjob="bar",
            solver=uel.SolverOptions(**options),
        )


def test_advice_where_a_restart_does_not_converge(folder):
    """Neither of the two options that the step of the state does not take."""
    deck = snapping(folder, "*RESTART, WRITE\n*STATIC, DIRECT\n0.1, 1.\n")
    springs = Path(__file__).parent / "procedures" / "springs.f"
    with pytest.raises(ConvergenceError) as first:
        uel.run(deck, springs)
    assert "what may help: --fallback, " in first.value.__notes__[-1]
    with pytest.raises(ConvergenceError) as second:
        uel.run(deck, springs, oldjob="snap", job="again")
    assert re.match(r"what may help: \*STATIC without DIRECT.*; VISCOSITY", second.value.__notes__[-1])


def test_restart_on_several_ranks_is_refused(folder):
    class Two:
        size, rank = 2, 0

    with pytest.raises(UsageError, match="--oldjob bar: a restart does not run on 2 ranks; run it in one process"):
        uel.run(Path("bar.inp"), oldjob="bar", ranks=Two())
