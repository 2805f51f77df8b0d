# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Jobs on two ranks that do not complete: all ranks end, with one message."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from mpiexec import NEEDED, PETSC_NEEDED, run

from uel.errors import UsageError
from uel.output.files.sta_file import NOT_COMPLETED
from uel.parallel import Launch, launched, read_reason, remove_reason, without_launch, write_reason
from uel.parallel.mpi import begin
from uel.parallel.partition import owners_of

INPUTS = Path(__file__).parents[3] / "abaqus_inputs"
HEAD = Path(__file__).parents[1] / "uel.inc"
SPRINGS = 40
SPRING = """\
      include '{head}'
      f = u(2) - u(1)
      if (jelem .eq. {element} .and. kinc .eq. 2) then
        {mistake}
      end if
      rhs(1,1) = f
      rhs(2,1) = -f
      amatrx(1:2,1:2) = -1
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      end
"""
NODES = "".join(f"{k}, {k}.\n" for k in range(1, SPRINGS + 2))
ELEMENTS = "".join(f"{k}, {k}, {k + 1}\n" for k in range(1, SPRINGS + 1))
CHAIN = (
    f"*NODE\n{NODES}*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1\n1\n"
    f"*ELEMENT, TYPE=U1, ELSET=ALL\n{ELEMENTS}*UEL PROPERTY, ELSET=ALL\n"
    f"*STEP\n*STATIC\n0.5, 1., 0.1, 0.5\n*BOUNDARY\n1, 1\n{SPRINGS + 1}, 1, 1, 4.\n*END STEP\n"
)
KILL = "call execute_command_line('kill -9 $PPID')"


@pytest.fixture
def fails(tmp_path):
    """Runs a chain of springs of which one makes a mistake; returns exit code and what is on stderr."""

    def fails(mistake: str, element: int, options: Sequence[str] = ()) -> tuple[int, str]:
        (tmp_path / "chain.inp").write_text(CHAIN)
        (tmp_path / "spring.f").write_text(SPRING.format(head=HEAD, mistake=mistake, element=element))
        words = ["-m", "uel", "run", "chain.inp", "--user", "spring.f", "--quiet", *options]
        code, _, errors = run(2, words, tmp_path)
        return code, errors

    return fails


@NEEDED
@pytest.mark.parametrize(
    ("element", "options"),
    [(1, ()), (SPRINGS, ()), pytest.param(SPRINGS, ("--solver", "petsc"), marks=PETSC_NEEDED)],
    ids=["one end", "other end", "PETSc"],
)
def test_user_element_that_stops_the_analysis(fails, tmp_path, element, options):
    code, errors = fails("call xit", element, options)
    assert code == 1
    assert errors.count(f"element {element} (type U1): stopped the analysis (XIT)") == 1
    assert "chain ended after increment 1 of step 1" in errors
    assert (tmp_path / "chain.sta").read_text().splitlines()[-1] == NOT_COMPLETED


@NEEDED
@pytest.mark.parametrize("element", [1, pytest.param(SPRINGS, marks=pytest.mark.long)], ids=["one end", "other end"])
def test_rank_that_is_killed(fails, tmp_path, element):
    code, errors = fails(KILL, element)
    # 9 where mpiexec has killed the other rank first
    assert code != 0
    assert len(re.findall("killed, by a user or by the system", errors)) == 1
    assert f"in UEL for element {element}, step 1, increment 2" in errors
    assert (tmp_path / "chain.sta").read_text().splitlines()[-1] == NOT_COMPLETED
    assert list(tmp_path.glob("chain.lck")) == []


SPRING_OF_TESTS = Path(__file__).parents[1] / "procedures" / "springs.f"
LINEAR = CHAIN.replace("*STEP\n*STATIC\n0.5, 1., 0.1, 0.5", "*STEP, PERTURBATION\n*STATIC")
SINGULAR = CHAIN.replace(f"*BOUNDARY\n1, 1\n{SPRINGS + 1}, 1, 1, 4.", "*CLOAD\n1, 1, 1.")
PROPERTIES = "COORDINATES=1, PROPERTIES=2, I PROPERTIES=1\n1\n", "*UEL PROPERTY, ELSET=ALL\n1., 0., 0\n"


def with_properties(deck: str) -> str:
    """A chain of springs of springs.f."""
    deck = deck.replace("COORDINATES=1\n1\n", PROPERTIES[0])
    return deck.replace("*UEL PROPERTY, ELSET=ALL\n", PROPERTIES[1])


MISTAKES = {
    "unknown keyword": ("*NODDE\n", {}, r"unknown_keyword.inp:1: unknown keyword \*NODDE"),
    "stress of neighbours": (
        INPUTS / "dcb" / "dcb_u3_1e8.inp",
        {"user": None},
        "mpiexec -n 2: elements of type U1 .* in memory that ranks do not share; run in one process",
    ),
    "linear step": (
        with_properties(LINEAR),
        {},
        r"linear_step.inp:\d+: step 1 is a linear perturbation step, which does not run on 2 ranks",
    ),
    "solver": (with_properties(CHAIN), {"solver": {"linear_solver": "none"}}, "unknown linear solver 'none'"),
    "free body": (with_properties(SINGULAR), {}, r"free_body.inp:\d+: singular system matrix at node \d+, dof 1"),
}


@pytest.fixture(scope="module")
def messages(tmp_path_factory):
    """What runs of mistakes on two ranks end with, by their names."""
    folder = tmp_path_factory.mktemp("mistakes")
    jobs = []
    for name, (deck, options, _) in MISTAKES.items():
        file = deck if isinstance(deck, Path) else folder / f"{name.replace(' ', '_')}.inp"
        if not isinstance(deck, Path):
            file.write_text(deck)
        jobs.append({"deck": str(file), "user": str(SPRING_OF_TESTS), "output_dir": "out", **options})
    (folder / "jobs.json").write_text(json.dumps(jobs))
    code, output, errors = run(2, [Path(__file__).with_name("on_ranks.py"), "jobs.json"], folder)
    assert (errors, code) == ("", 0)
    return dict(zip(MISTAKES, map(json.loads, output.splitlines()), strict=True))


@NEEDED
@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_are_told_once(messages, name):
    assert re.search(MISTAKES[name][2], messages[name])


@NEEDED
def test_command_tells_a_mistake_once(tmp_path):
    (tmp_path / "wrong.inp").write_text("*NODDE\n")
    code, output, errors = run(2, ["-m", "uel", "run", "wrong.inp"], tmp_path)
    assert (code, output) == (1, "")
    assert errors == "uel: wrong.inp:1: unknown keyword *NODDE; did you mean NODE?\n"


@NEEDED
def test_wrong_usage_is_told_once(tmp_path):
    code, _, errors = run(2, ["-m", "uel", "run", "deck.inp", "--sover", "band"], tmp_path)
    assert code == 2
    assert errors.count("unrecognized arguments: --sover band") == 1


def test_word_of_a_rank(tmp_path):
    stem = tmp_path / "job"
    assert read_reason(stem, "1a2b") == ""
    write_reason(stem, "1a2b", "the first reason")
    write_reason(stem, "1a2b", "another one")
    assert read_reason(stem, "1a2b") == "the first reason"
    assert read_reason(stem, "") == ""
    remove_reason(stem, "1a2b")
    assert list(tmp_path.iterdir()) == []


def test_who_was_launched(monkeypatch):
    for name in ("PMI_RANK", "PMI_SIZE", "PMI_FD", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"):
        monkeypatch.delenv(name, raising=False)
    assert launched() == Launch(0, 1, ())
    assert without_launch() == dict(os.environ)
    monkeypatch.setenv("PMI_RANK", "3")
    monkeypatch.setenv("PMI_SIZE", "8")
    monkeypatch.setenv("PMI_FD", "9")
    assert launched() == Launch(3, 8, (9,))
    assert os.environ.items() - without_launch().items() == {("PMI_RANK", "3"), ("PMI_SIZE", "8")}


def test_without_mpi4py(monkeypatch):
    monkeypatch.setitem(sys.modules, "mpi4py", None)
    with pytest.raises(UsageError, match=r"mpiexec has started 2 ranks, which need mpi4py .*; pip install .\[mpi\]"):
        begin(Launch(0, 2))


def test_without_pymetis(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymetis", None)
    with pytest.raises(UsageError, match=r"a job on 2 ranks needs pymetis; pip install .\[mpi\]"):
        owners_of([np.arange(12).reshape(3, 4)], 2)
