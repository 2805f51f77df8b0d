# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements called by several threads: what one thread returns, to the bit, and its messages."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import uel
from uel.cli import main
from uel.errors import CallLimitError, KernelError, UsageError
from uel.paper.bricks import BRICKS, CONSISTENT, STABILISED_BRICKS, STANDARD, dcb_of_bricks

HEAD = Path(__file__).parent / "uel.inc"
SPRINGS = 700
SPRING = """\
      include '{head}'
      integer getnumthreads, get_thread_id
      double precision, allocatable :: room(:)
      f = u(2) - u(1)
      stiff = 1 + 0.1*mod(jelem, 7)
      svars(1) = svars(1) + f*(1 + f)
      {mistake}
      rhs(1,1) = stiff*f*(1 + f)
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = stiff*(1 + 2*f)
      amatrx(2,2) = amatrx(1,1)
      amatrx(1,2) = -amatrx(1,1)
      amatrx(2,1) = -amatrx(1,1)
      energy(2) = stiff*f**2
      end

      subroutine count_calls
      include 'SMAAspUserArrays.hdr'
      integer numbers(1)
      pointer (pn, numbers)
      pn = SMAIntArrayCreate(1, 1, 0)
      numbers(1) = numbers(1) + 1
      end

      subroutine enter(a, k, x)
      double precision a(*), x
      a(k) = x
      end
"""
WHERE = "if (jelem == 600 .and. kinc == 2 .and. lflags(3) == 1) "


@pytest.fixture
def chain(tmp_path):
    """Runs a chain of springs with a statement in the spring on a number of threads; .sta without its head."""

    def run_chain(statement: str, cpus: int, **options):
        folder = tmp_path / f"{cpus}"
        folder.mkdir()
        nodes = "".join(f"{k}, {k}.\n" for k in range(1, SPRINGS + 2))
        elements = "".join(f"{k}, {k}, {k + 1}\n" for k in range(1, SPRINGS + 1))
        (folder / "chain.inp").write_text(
            f"*NODE\n{nodes}*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, VARIABLES=2\n1\n"
            f"*ELEMENT, TYPE=U1, ELSET=ALL\n{elements}*UEL PROPERTY, ELSET=ALL\n"
            "*STEP\n*STATIC\n0.25, 1., 0.01, 0.25\n*BOUNDARY\n1, 1\n"
            f"{SPRINGS + 1}, 1, 1, 70.\n*OUTPUT, HISTORY\n*ENERGY OUTPUT\nALLSE\n*END STEP\n"
        )
        (folder / "spring.f").write_text(SPRING.format(head=HEAD, mistake=statement.replace("\n", "\n      ")))
        routines = uel.RoutineOptions(cpus=cpus, **{"thread_safe": ["u1"]} | options)
        return uel.run(folder / "chain.inp", folder / "spring.f", output_dir=folder, routines=routines)

    return run_chain


def files_of(result) -> list[str]:
    """What a run writes, without date and times of the processor."""
    texts = [result.file(end).read_text() for end in (".sta", ".msg", "_history.csv")]
    texts = [re.sub(r"\*\*\*NOTE: LINEAR SOLVER:(.+\n)+", "", text) for text in texts]
    return [re.sub(r"(DATE|Date) .*|TIME \(SEC\) = .*", "", text) for text in texts]


def test_same_bits_of_user_elements(chain):
    assert files_of(chain("continue", 1)) == files_of(chain("continue", 2)) == files_of(chain("continue", 5))


@pytest.mark.parametrize(
    "deck",
    [
        pytest.param(lambda: dcb_of_bricks("C3D8I", CONSISTENT, STABILISED_BRICKS), id="U8"),
        pytest.param(lambda: dcb_of_bricks("C3D8", replace(STANDARD, type="COH3D8"), (60, 4, 2)), id="COH3D8"),
        pytest.param(
            lambda: dcb_of_bricks("C3D8", STANDARD, (60, 4, 2)).replace("*STEP", "*STEP, NLGEOM", 1),
            id="U7",
            marks=pytest.mark.long,
        ),
    ],
)
def test_same_bits_in_space(tmp_path, deck):
    file = tmp_path / "dcb.inp"
    file.write_text(re.sub(r"(\*STATIC\n.*?), 2\.5,", r"\1, 0.4,", deck()))
    results = [
        uel.run(file, job=f"on{cpus}", output_dir=tmp_path, routines=uel.RoutineOptions(cpus=cpus)) for cpus in (1, 2)
    ]
    one, two = (
        [text.replace(f"on{k}", "job") for text in files_of(each)] for k, each in zip((1, 2), results, strict=True)
    )
    assert one == two
    fields = [np.loadtxt(each.file("_interface.csv"), delimiter=",", skiprows=1, dtype=str) for each in results]
    np.testing.assert_array_equal(*fields)


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("call xit", "element 600 .*XIT"),
        ("i = 5/int(svars(2))\nstiff = stiff + i", "element 600 .*division of an integer by zero"),
        ("svars(900000000) = 1", "element 600 .*segmentation fault"),
        pytest.param("stiff = stiff/(f - f)", r"element 600 .*(NaN|infin)", marks=pytest.mark.nan),
        ("stop 'here'", "element 600 .*STOP 'here'"),
    ],
)
def test_failure_is_that_of_one_thread(chain, statement, message):
    told = []
    for cpus in (1, 2):
        with pytest.raises(KernelError, match=message) as raised:
            chain(f"{WHERE}then\n{statement}\nend if", cpus)
        told.append(str(raised.value))
    assert told[0] == told[1]


def test_call_that_does_not_return(chain):
    with pytest.raises(CallLimitError, match=r"element 600 .*did not return within 1 s"):
        chain(f"{WHERE}then\ndo while (f < 1d30)\nsvars(2) = svars(2) + 1\nend do\nend if", 2, call_limit=1.0)


@pytest.mark.parametrize(
    "statement",
    [
        f"{WHERE}call stdb_abqerr(-1, 'spring %I is long', jelem, f, ' ')",
        f"{WHERE}pnewdt = max(0.5d0, dtime/0.1)",
        f"{WHERE}call enter(svars, 3, 1d0)",
        "if (jelem == 1) call mutexinit(1)\ncall mutexlock(1)\ncall mutexunlock(1)",
        "i = get_thread_id()\nif (i < 0 .or. i >= 5) call xit",
    ],
)
def test_what_one_thread_does(chain, statement):
    assert files_of(chain(statement, 1)) == files_of(chain(statement, 5))


def test_shared_arrays_need_one_thread(chain):
    one, two = (chain("call count_calls", cpus) for cpus in (1, 2))
    assert files_of(one)[0] == files_of(two)[0]
    assert any("called by one thread from now on" in warning for warning in two.warnings)


def test_number_of_threads(chain):
    chain("if (getnumthreads() /= 3) call xit", 3)


def test_undeclared_element_is_called_by_one_thread(chain):
    result = chain("i = get_thread_id()\nif (i > 0) call xit", 2, thread_safe=[])
    message = (
        r"elements of type U1 are called by one thread; --thread-safe U1 lets 2 threads call them, if .* 'threads'"
    )
    assert any(re.search(message, warning) for warning in result.warnings)


def test_threads_give_up(chain):
    result = chain("if (jelem == 9) call stdb_abqerr(1, 'here', i, f, ' ')", 2)
    assert any(re.search("called by one thread from now on: in 5 passes", warning) for warning in result.warnings)


def test_stress_that_elements_share(tmp_path):
    deck = Path(__file__).parents[2] / "abaqus_inputs" / "dcb" / "dcb_u3_1e8.inp"
    with pytest.raises(UsageError, match=r"--cpus 2: elements of type U[13] .* in memory that all threads share; run"):
        uel.run(deck, output_dir=tmp_path, routines=uel.RoutineOptions(cpus=2))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--cpus", "0"], "--cpus 0: expected a number from 1 to 64"),
        (["--cpus", "2", "--debug"], r"--cpus 2: run-time checks \(--debug\) need one thread"),
        (["--cpus", "2", "--thread-safe", "U5"], "--thread-safe U5: the deck does not call it; it calls "),
    ],
)
def test_wrong_usage(tmp_path, capfd, words, message):
    deck = tmp_path / "dcb.inp"
    deck.write_text(dcb_of_bricks("C3D8", STANDARD, BRICKS))
    assert main(["run", str(deck), "--output-dir", str(tmp_path), *words]) == 2
    assert re.search(message, capfd.readouterr().err)


def test_abaqus_spelling(tmp_path):
    deck = tmp_path / "dcb.inp"
    deck.write_text(re.sub(r"(\*STATIC\n.*?), 2\.5,", r"\1, 0.1,", dcb_of_bricks("C3D8", STANDARD, BRICKS)))
    assert main(["run", f"input={deck}", "job=two", "cpus=2", "--quiet", f"--output-dir={tmp_path}"]) == 0
