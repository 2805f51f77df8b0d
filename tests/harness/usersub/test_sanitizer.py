# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""AddressSanitizer in debug builds: what the bounds of the compiler and the guards do not see has file and line."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from uel.running import sanitizer
from uel.running.isolation import supervise
from uel.running.sanitizer import NoSanitizerError, environment

FORTRAN = f"""\
      module store
      real*8 kept(10)
      end module

      include '{Path(__file__).parents[1] / "uel.inc"}'
      real*8, pointer :: one(:), other(:)
      real*8, allocatable :: h(:)
      dimension d(4), table(3)
      data table /1.d0, 2.d0, 3.d0/
      save table
      d = 0
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = -rhs(1,1)
      amatrx(1:2,1) = (/ 1, -1 /)
      amatrx(1:2,2) = (/ -1, 1 /)
      if (kinc /= 2) return
      k = jprops(2)
      total = 0
      allocate (h(k), one(k))
      h = 0
      one = 0
      select case (jprops(1))
      case (0)
        call add(props, nprops, total)
        call add(table, 3, total)
        call add(d, k, total)
        call add(h, k, total)
        call fill(svars, nsvars)
        call add(one, k, total)
        deallocate (one)
      case (1)
        total = props(k - 2)        ! property
      case (2)
        call add(table, k, total)
      case (3)
        call grow(k)
      case (4)
        call add(d, k + 1, total)
      case (5)
        call add(h, k + 1, total)
      case (6)
        call fill(svars, k)
      case (7)
        other => one
        deallocate (other)
        total = one(1)        ! freed
      case (8)
        call fill(h, k + 3)
      case (9)
        call add(energy, 9, total)
      case (11)
        call spend(k, total)
      case (10)
        rhs(1,1) = 5/(k - 4)        ! zero
      end select
      rhs(1,1) = rhs(1,1) + 1d-30*total
      end

      subroutine spend(k, total)
      include 'aba_param.inc'
      dimension w(k)
      w = 0
      call add(w, k + 1, total)
      end

      subroutine grow(k)
      use store
      include 'aba_param.inc'
      total = 0
      call add(kept, 7 + k, total)
      end

      subroutine add(x, n, total)
      include 'aba_param.inc'
      dimension x(*)
      total = total + x(n)        ! add
      end

      subroutine fill(x, n)
      include 'aba_param.inc'
      dimension x(*)
      do i = 1, n
        x(i) = 0        ! fill
      end do
      end
"""
C = """\
#include <stdlib.h>
#include <string.h>
static double table[3];
void uel_(double *rhs, double *amatrx, double *svars, double *energy, int *ndofel, int *nrhs, int *nsvars,
          double *props, int *nprops, double *coords, int *mcrd, int *nnode, double *u, double *du, double *v,
          double *a, int *jtype, double *time, double *dtime, int *kstep, int *kinc, int *jelem, double *params,
          int *ndload, int *jdltyp, double *adlmag, double *predef, int *npredf, int *lflags, int *mlvarx,
          double *ddlmag, int *mdload, double *pnewdt, int *jprops)
{
    double *room = malloc(4*sizeof *room), *values = table;
    rhs[0] = u[1] - u[0];
    rhs[1] = -rhs[0];
    amatrx[0] = amatrx[3] = 1;
    amatrx[1] = amatrx[2] = -1;
    switch (*kinc == 2 ? jprops[0] : 0) {
    case 1:
        rhs[0] += 1e-30*props[jprops[1] - 3];        // property
        break;
    case 2:
        values[jprops[1]] = 1;        // table
        break;
    case 5:
        room[jprops[1]] = 1;        // room
        rhs[0] += 1e-30*room[3];
        break;
    case 6:
        memset(svars, 0, (unsigned)jprops[1]*sizeof *svars);        // memset
        break;
    case 7:
        free(room);
        break;
    }
    free(room);        // twice
}
"""
SOURCES = {"my_uel.for": FORTRAN, "my_uel.c": C}
DECK = """\
*USER ELEMENT, TYPE=U1, NODES=2, I PROPERTIES=2, PROPERTIES=1, VARIABLES=2
1
*NODE
1, 0.
2, 1.
*ELEMENT, TYPE=U1, ELSET=ALL
7, 1, 2
*UEL PROPERTY, ELSET=ALL
3., {way}, 4
*STEP
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1
2, 1, 1, 1.
*END STEP
"""
CASES = [
    ("my_uel.for", 1, "property", "", "it reads outside PROPS: entry 2 of 1"),
    ("my_uel.for", 2, "add", "ADD", r"it reads outside the variable 'table' \(24 bytes\)"),
    ("my_uel.for", 3, "add", "ADD", r"it reads outside the variable 'kept' \(80 bytes\)"),
    ("my_uel.for", 4, "add", "ADD", r"it reads outside the variable 'd' \(32 bytes\)"),
    ("my_uel.for", 5, "add", "ADD", r"it reads outside an allocated array \(32 bytes\)"),
    ("my_uel.for", 6, "fill", "FILL", "it writes outside SVARS: entry 3 of 2"),
    ("my_uel.for", 7, "freed", "", "it reads memory that has been freed"),
    ("my_uel.for", 8, "fill", "FILL", r"it writes outside an allocated array \(32 bytes\)"),
    ("my_uel.for", 9, "add", "ADD", "it reads outside ENERGY: entry 9 of 8"),
    ("my_uel.for", 11, "add", "ADD", "it reads outside a local array"),
    ("my_uel.for", 10, "zero", "", "division of an integer by zero"),
    ("my_uel.c", 1, "property", "", "it reads outside PROPS: entry 2 of 1"),
    ("my_uel.c", 2, "table", "", r"it writes outside the variable 'table' \(24 bytes\)"),
    ("my_uel.c", 5, "room", "", r"it writes outside an allocated array \(32 bytes\)"),
    ("my_uel.c", 6, "memset", "", "it writes outside SVARS: entry 3 of 2"),
    ("my_uel.c", 7, "twice", "", "it frees memory twice"),
]
RUNS = """\
import json, sys
from uel.errors import UelError
from uel.running.job import run
from uel.running.options import RoutineOptions
said = {}
for name, way, debug in json.loads(sys.argv[1]):
    try:
        result = run(f"{way}.inp", name, routines=RoutineOptions(debug=debug))
        said[f"{name} {way} {debug}"] = " ".join(result.warnings)
    except UelError as error:
        said[f"{name} {way} {debug}"] = str(error)
print(json.dumps(said))
"""


def line_of(name, word):
    (line,) = [k for k, row in enumerate(SOURCES[name].splitlines(), 1) if row.endswith((f"! {word}", f"// {word}"))]
    return line


@pytest.fixture(scope="module")
def variables():
    try:
        return environment()
    except NoSanitizerError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def said(variables, tmp_path_factory):
    """What runs in one process end with: all mistakes, and right elements after each."""
    folder = tmp_path_factory.mktemp("sanitizer")
    for name, text in SOURCES.items():
        (folder / name).write_text(text)
    for way in range(12):
        (folder / f"{way}.inp").write_text(DECK.format(way=way))
    runs = [run for name, way, *_ in CASES for run in ((name, way, True), ("my_uel.for", 0, True))]
    runs += [("my_uel.c", 0, True), ("my_uel.for", 6, False), ("my_uel.for", 1, False)]
    words = [sys.executable, "-c", RUNS, json.dumps(runs)]
    ended = subprocess.run(words, cwd=folder, env=variables, capture_output=True, text=True, check=False, timeout=300)
    assert not ended.stderr
    return json.loads(ended.stdout)


@pytest.mark.parametrize(("name", "way", "word", "routine", "message"), CASES)
def test_finding_has_routine_file_and_line(said, name, way, word, routine, message):
    inside = rf" \({routine}\)" if routine else ""
    expected = rf"in UEL, {name} line {line_of(name, word)}{inside}: {message} \(step 1, increment 2, iteration 0\)$"
    assert re.search(expected, said[f"{name} {way} True"]), said


@pytest.mark.parametrize("name", SOURCES)
def test_right_element_raises_no_alarm(said, name):
    """Nor after calls that were left from within, whose stack was fenced."""
    assert said[f"{name} 0 True"] == ""


@pytest.mark.nan
def test_ordinary_build_in_the_same_process_is_as_anywhere(said):
    assert re.search(r"writes outside SVARS.*the run goes on", said["my_uel.for 6 False"])
    assert re.search(r"reads outside PROPS.*the run goes on", said["my_uel.for 1 False"])


@pytest.fixture
def files(tmp_path):
    """Source and deck of an element with a mistake that an ordinary run and the bounds of the compiler do not see."""
    source, deck = tmp_path / "my_uel.for", tmp_path / "deck.inp"
    source.write_text(FORTRAN)
    deck.write_text(DECK.format(way=2))
    return source, deck


@pytest.mark.long
def test_commands(variables, files, tmp_path):
    source, deck = files
    expected = f"in UEL, my_uel.for line {line_of('my_uel.for', 'add')} (ADD): it reads outside the variable 'table'"
    command = [sys.executable, "-m", "uel.cli"]
    run = [*command, "run", str(deck), "--user", str(source), "--debug", "--quiet", "--output-dir", str(tmp_path)]
    ended = subprocess.run(run, capture_output=True, text=True, check=False, timeout=300)
    assert ended.returncode == 1
    assert expected in ended.stderr
    check = [*command, "check", str(deck), str(source), "--json", str(tmp_path / "found.json")]
    assert subprocess.run(check, capture_output=True, check=False, timeout=300).returncode == 1
    (kind,) = json.loads((tmp_path / "found.json").read_text())["types"]
    assert kind["findings"]["debug"]["verdict"] == "failed"
    assert expected in kind["findings"]["debug"]["message"]


@pytest.fixture
def compiler(tmp_path, monkeypatch):
    """A compiler that names this file as its library."""

    def name(library):
        program = tmp_path / "compiler"
        program.write_text(f"#!/bin/sh\necho {library}\n")
        program.chmod(0o755)
        monkeypatch.setattr(sanitizer, "_COMPILERS", (str(program),))

    return name


def test_run_without_the_library(compiler, files, tmp_path, capfd):
    """The bounds of the compiler are looked at nevertheless."""
    source, deck = files
    deck.write_text(DECK.format(way=0))
    compiler("libasan.so")  # what gcc says where it has none
    words = ["run", str(deck), "--user", str(source), "--debug", "--quiet", "--output-dir", str(tmp_path)]
    assert supervise(words, tmp_path / "deck", 60.0, sanitized=True) == 0
    (line,) = capfd.readouterr().err.splitlines()
    assert re.match(
        r"uel: without AddressSanitizer, which detects reads and writes outside arrays of unknown size .*: "
        r"compiler has no libasan \(apt install gcc, dnf install libasan\)$",
        line,
    )


def test_library_that_is_none(compiler, tmp_path):
    library = tmp_path / "libasan.so"
    library.write_bytes(b"\x7fELF and no more")
    compiler(library)
    with pytest.raises(NoSanitizerError, match=r"it does not start here \(.*libasan.so"):
        environment()


def test_script_of_the_linker_names_the_library(variables, compiler, tmp_path):
    real = variables["LD_PRELOAD"].partition(":")[0]
    script = tmp_path / "libasan.so"
    script.write_text(f"INPUT ( {real} )\n")
    compiler(script)
    assert environment()["LD_PRELOAD"].partition(":")[0] == real


def test_processes_of_the_run_do_not_have_it(monkeypatch):
    monkeypatch.setenv("LD_PRELOAD", "/usr/lib/libasan.so.8:/usr/lib/mine.so")
    sanitizer.stop_preloading()
    assert sanitizer.os.environ["LD_PRELOAD"] == "/usr/lib/mine.so"
    sanitizer.stop_preloading()
    assert sanitizer.os.environ["LD_PRELOAD"] == "/usr/lib/mine.so"
    monkeypatch.setenv("LD_PRELOAD", "/usr/lib/libasan.so.8")
    sanitizer.stop_preloading()
    assert "LD_PRELOAD" not in sanitizer.os.environ
