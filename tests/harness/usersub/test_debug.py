# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What fails in user code is told with file and line: where a signal ends it, and in a debug build."""

import re
from pathlib import Path

import pytest

from uel.cli import main
from uel.errors import CallLimitError, KernelError
from uel.running.job import run
from uel.running.options import RoutineOptions
from uel.usersub import trap
from uel.usersub.compilation.units import with_open_bounds

ARGUMENTS = (
    "rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,kstep,kinc,jelem,"
    "params,ndload,jdltyp,adlmag,predef,npredf,lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period"
)
FORTRAN = """
      d = 0
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = -rhs(1,1)
      amatrx(1:2,1) = (/ 1, -1 /)
      amatrx(1:2,2) = (/ -1, 1 /)
      if (kinc /= 2) return
      k = jprops(2)
      select case (jprops(1))
      case (1)
        d(k,1) = 1        ! overrun
        rhs(1,1) = rhs(1,1) + d(k,1)
      case (2)
        if (k > 4) unset = 1
        rhs(1,1) = rhs(1,1) + unset        ! unset
      case (3)
        rhs(1,1) = sqrt(-k - u(2)**2)        ! nan
      case (4)
        rhs(1,1) = rhs(1,1) + 5/(k - 4)        ! zero
      case (5)
        svars(100000000*k) = 1        ! segmentation
      case (6)
        do while (k >= 0)        ! endless
          k = mod(k + 1, 1000)        ! endless
          svars(1) = k        ! endless
        end do
      case (7)
        call add(u, rhs, 2)
      case (8)
        allocate (room(k))
        allocate (room(k))        ! twice
      end select
      end

      subroutine add(x, r, n)
      {declare}
      {dimension} x(1), r(n,1), w(n)
      do i = 1, n
        total = total + x(i)*w(i)        ! accumulator
      end do
      r(1,1) = r(1,1) + 1d-30*total
      end
"""
C = """\
#include <math.h>
void uel_(double *rhs, double *amatrx, double *svars, double *energy, int *ndofel, int *nrhs, int *nsvars,
          double *props, int *nprops, double *coords, int *mcrd, int *nnode, double *u, double *du, double *v,
          double *a, int *jtype, double *time, double *dtime, int *kstep, int *kinc, int *jelem, double *params,
          int *ndload, int *jdltyp, double *adlmag, double *predef, int *npredf, int *lflags, int *mlvarx,
          double *ddlmag, int *mdload, double *pnewdt, int *jprops)
{
    double d[3] = {0, 0, 0};
    int k = jprops[1];
    rhs[0] = u[1] - u[0];
    rhs[1] = -rhs[0];
    amatrx[0] = amatrx[3] = 1;
    amatrx[1] = amatrx[2] = -1;
    if (*kinc != 2) return;
    switch (jprops[0]) {
    case 1:
        d[k - 1] = 1;        // overrun
        rhs[0] += d[0];
        break;
    case 3:
        rhs[0] = sqrt(-k - u[1]*u[1]);        // nan
        break;
    case 4:
        rhs[0] += 5/(k - 4);        // zero
        break;
    case 5:
        svars[100000000*k] = 1;        // segmentation
        break;
    case 6:
        while (k >= 0) {        // endless
            k = (k + 1) % 1000;        // endless
            svars[0] = k;        // endless
        }
    }
}
"""


def fixed():
    head = f"      include '{Path(__file__).parents[1] / 'uel.inc'}'\n"
    declared = "      dimension d(3,3)\n      double precision, allocatable :: room(:)"
    return head + declared + FORTRAN.format(declare="include 'aba_param.inc'", dimension="dimension")


def free():
    head = (
        f"subroutine uel({ARGUMENTS})\nimplicit real*8(a-h,o-z)\n"
        "dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),svars(*),u(1),jprops(*),d(3,3)\nreal*8, allocatable :: room(:)"
    )
    return head + FORTRAN.format(declare="implicit real*8(a-h,o-z)", dimension="dimension").replace("!", " !")


SOURCES = {
    "my_uel.for": fixed(),
    "my_uel.f90": free(),
    "my_uel.c": C,
    "my_uel.cpp": C.replace("void", 'extern "C" void'),
}
DECK = """\
*USER ELEMENT, TYPE=U1, NODES=2, I PROPERTIES=2
1
*NODE
1, 0.
2, 1.
*ELEMENT, TYPE=U1, ELSET=ALL
7, 1, 2
*UEL PROPERTY, ELSET=ALL
{way}, 4
*STEP
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1
2, 1, 1, 1.
*END STEP
"""


@pytest.fixture
def fail(tmp_path):
    """Run a source with a mistake; returns the error and the lines that have the word."""

    def fail(name, way, word, **options):
        source, deck = tmp_path / name, tmp_path / "deck.inp"
        source.write_text(SOURCES[name])
        deck.write_text(DECK.format(way=way))
        with pytest.raises((KernelError, CallLimitError)) as caught:
            run(deck, source, output_dir=tmp_path, routines=RoutineOptions(call_limit=1.0, **options))
        lines = [k for k, row in enumerate(SOURCES[name].splitlines(), 1) if row.endswith((f"! {word}", f"// {word}"))]
        return caught.value, lines

    return fail


INVALID = (
    r"floating-point exception: the result is not a number \(0/0, the square root of a negative number\), "
    "or an uninitialised variable"
)
SIGNALS = [
    (4, "zero", "division of an integer by zero"),
    (5, "segmentation", "segmentation fault: it reads or writes an invalid address"),
    (6, "endless", "the call did not return"),
]


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", SOURCES)
@pytest.mark.parametrize(("way", "word", "message"), [*SIGNALS, (3, "nan", INVALID)])
@pytest.mark.nan
def test_debug_run_names_the_line(fail, name, way, word, message):
    error, lines = fail(name, way, word, debug=True)
    found = re.search(rf"in UEL, {name} line (\d+): {message}", str(error))
    assert found, error
    assert int(found[1]) in lines


@pytest.mark.parametrize("name", ["my_uel.for", "my_uel.f90"])
@pytest.mark.parametrize(
    ("way", "word", "message"),
    [
        (1, "overrun", "index '4' of dimension 1 of array 'd' above upper bound of 3"),
        (2, "unset", f"{INVALID} is used"),
        (8, "twice", "attempting to allocate already allocated variable 'room'"),
    ],
)
def test_debug_run_of_fortran(fail, name, way, word, message):
    error, (line,) = fail(name, way, word, debug=True)
    assert re.search(rf"in UEL, {name} line {line}: {message}", str(error)), error


@pytest.mark.parametrize("name", ["my_uel.for", "my_uel.f90"])
def test_accumulator_without_a_start_value_in_a_routine(fail, name):
    """Arrays declared with a bound of 1 are of any size, as they were in Fortran 66."""
    error, (line,) = fail(name, 7, "accumulator", debug=True)
    assert re.search(rf"in UEL, {name} line {line} \(ADD\): {INVALID}", str(error)), error


@pytest.mark.parametrize("name", ["my_uel.c", "my_uel.cpp"])
def test_overrun_in_c(fail, name):
    error, (line,) = fail(name, 1, "overrun", debug=True)
    assert re.search(rf"in UEL, {name} line {line}: illegal instruction: an index outside an array", str(error)), error


@pytest.mark.parametrize("name", ["my_uel.for", "my_uel.f90", "my_uel.c"])
@pytest.mark.parametrize(("way", "word", "message"), SIGNALS[:2])
def test_ordinary_run_names_the_line_of_a_signal(fail, name, way, word, message):
    error, (line,) = fail(name, way, word)
    assert re.search(rf"in UEL, {name} line {line}: {message}", str(error)), error
    assert not any("--debug" in note for note in error.__notes__)


def test_error_of_the_fortran_library_ends_the_call_in_an_ordinary_run(fail):
    error, (line,) = fail("my_uel.for", 8, "twice")
    assert f"in UEL, my_uel.for line {line}: attempting to allocate already allocated" in str(error)


@pytest.mark.nan
def test_ordinary_run_says_how_to_see_the_line(fail):
    error, _ = fail("my_uel.for", 3, "nan")
    assert "line" not in str(error)
    assert "run again with --debug to see file and line" in error.__notes__


@pytest.mark.nan
def test_array_of_bound_one_that_is_used_as_a_whole(fail, monkeypatch):
    """It cannot be opened, and others of the file are."""
    text = SOURCES["my_uel.for"].replace("      do i = 1, n\n", "      y = y + 1\n      do i = 1, n\n")
    text = text.replace("add(x, r, n)", "add(x, r, n, y)").replace("(u, rhs, 2)", "(u, rhs, 2, d)")
    monkeypatch.setitem(SOURCES, "my_uel.for", text.replace("w(n)\n", "w(n),y(2,1)\n"))
    error, (line,) = fail("my_uel.for", 7, "accumulator", debug=True)
    assert re.search(rf"in UEL, my_uel.for line {line} \(ADD\): {INVALID}", str(error)), error


@pytest.mark.nan
def test_command(tmp_path, capsys):
    source, deck = tmp_path / "my_uel.for", tmp_path / "deck.inp"
    source.write_text(SOURCES["my_uel.for"])
    deck.write_text(DECK.format(way=3))
    words = ["run", str(deck), "--user", str(source), "--output-dir", str(tmp_path), "--quiet"]
    assert main(words) == 1
    assert "uel: run again with --debug to see file and line" in capsys.readouterr().err
    assert main([*words, "--debug"]) == 1
    said = capsys.readouterr().err
    assert re.search(r"in UEL, my_uel.for line \d+: floating-point exception", said)
    assert "run again" not in said


def test_traps_are_off_after_a_debug_run(fail):
    before = trap(False)
    fail("my_uel.for", 1, "overrun", debug=True)
    assert not trap(before)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (
            "      subroutine f(a,b)\n      dimension a(1),c(1)\n",
            "      subroutine f(a,b)\n      dimension a(*),c(1)\n",
        ),
        (
            "      subroutine f(a,\n     1 b)\n      real*8 a(3,1),\n     1 b ( 1 )\n      a(1,1) = b(1)\n",
            "      subroutine f(a,\n     1 b)\n      real*8 a(3,*),\n     1 b ( * )\n      a(1,1) = b(1)\n",
        ),
        (
            "c     dimension a(1)\n      function f(a)\n      a(1) = 1\n",
            "c     dimension a(1)\n      function f(a)\n      a(1) = 1\n",
        ),
    ],
)
def test_bounds_of_one_are_open(given, expected):
    assert with_open_bounds(given, free=False) == expected
