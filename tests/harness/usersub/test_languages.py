# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User routines in C and C++, which follow Fortran's calling convention: lower case, an underscore, references."""

import shutil
from pathlib import Path

import pytest

from uel import usersub
from uel.errors import CompileError, DeckError
from uel.running.job import run

HERE = Path(__file__).parent
NOTE = """
extern {linkage} void stdb_abqerr_(const int *, const char *, const int *, const double *, const char *, long, long);
{extern} void {name}(const int *lop, const int *lrestart, const double *time)
{{
    const int one = 1, number = {value};
    stdb_abqerr_(&one, "%I", &number, time, " ", 2, 8);
}}
"""


def note(value="7", *, name="uexternaldb_", extern=""):
    return NOTE.format(value=value, name=name, extern=extern, linkage=extern.removeprefix("extern"))


def said(library):
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    return [message.text for message in library.messages()]


def test_c(load):
    assert said(load(note(), "user.c")) == ["7"]


@pytest.mark.parametrize("suffix", [".cpp", ".cc", ".cxx", ".CPP"])
def test_cpp_with_its_library(load, suffix):
    text = "#include <vector>\n" + note("(int)std::vector<int>(4).size()", extern='extern "C"')
    assert said(load(text, f"user{suffix}")) == ["4"]


@pytest.mark.parametrize("header", ["aba_for_c.h", "omi_for_c.h"])
@pytest.mark.parametrize("name", ["FOR_NAME(uexternaldb)", "FOR_NAME(uexternaldb, UEXTERNALDB)"])
def test_name_by_the_macro_of_abaqus(load, header, name):
    assert said(load(f"#include <{header}>\n" + note(name=name), "user.c")) == ["7"]


def test_header_beside_the_source(load, tmp_path):
    (tmp_path / "value.h").write_text("#define VALUE 3\n")
    text = '#include "value.h"\n' + note("VALUE")
    assert said(load(text, "user.c")) == ["3"]
    (tmp_path / "value.h").write_text("#define VALUE 4\n")
    assert said(load(text, "user.c")) == ["4"]


def test_three_languages_together(tmp_path):
    """UEXTERNALDB in Fortran calls C, which calls C++."""
    (tmp_path / "a.f").write_text(
        "      subroutine uexternaldb(lop)\n      call half(8,i)\n"
        "      call stdb_abqerr(1,'%I',(/i/),(/0.d0/),(/'        '/))\n      end\n"
    )
    (tmp_path / "b.c").write_text("int twice(int);\nvoid half_(const int *n, int *i) { *i = twice(*n) / 4; }\n")
    (tmp_path / "c.cpp").write_text(
        '#include <string>\nextern "C" int twice(int n) { return std::string(2 * n, 0).size(); }\n'
    )
    files = [tmp_path / name for name in ("a.f", "b.c", "c.cpp")]
    assert said(usersub.load(files, job="job", output_dir=tmp_path)) == ["4"]


def test_c_needs_no_fortran_compiler(load, monkeypatch):
    which = shutil.which
    monkeypatch.setattr(shutil, "which", lambda name: None if name == "gfortran" else which(name))
    assert said(load(note(), "user.c")) == ["7"]


def test_lapack_in_c(load):
    text = """
extern void dgesv_(const int *, const int *, double *, const int *, int *, double *, const int *, int *);
static int solution(void)
{
    int n = 2, one = 1, pivots[2], info;
    double a[4] = {2, 0, 0, 4}, b[2] = {6, 20};
    dgesv_(&n, &one, a, &n, pivots, b, &n, &info);
    return (int)(b[0] + 10 * b[1] + 0.5);
}
"""
    assert said(load(text + note("solution()"), "user.c")) == ["53"]


@pytest.mark.parametrize("name", ["wrong.c", "wrong.cpp"])
def test_first_error_with_its_line_and_column(load, name):
    with pytest.raises(CompileError) as caught:
        load("int one(void)\n{\n    int i = 1\n    return i;\n}\nint two = nothing;\n", name)
    message = str(caught.value)
    assert f"{name}: does not compile: expected ',' or ';' before 'return' ({name}, line " in message
    assert "int i = 1" in message or "return i" in message
    assert "nothing" not in message


def test_missing_header(load):
    with pytest.raises(CompileError, match=r"nowhere.h: No such file or directory \(user.c, line 1, column 10\)"):
        load('#include "nowhere.h"\n', "user.c")


def test_routine_in_two_files(tmp_path):
    for name in ("a.c", "b.c"):
        (tmp_path / name).write_text("void uel_(void) {}\n")
    with pytest.raises(CompileError, match=r"UEL is defined twice, in a.c and in b.c"):
        usersub.load([tmp_path / "a.c", tmp_path / "b.c"], job="job", output_dir=tmp_path)


def test_unresolved_routine(load):
    with pytest.raises(CompileError, match="refers to MYSTERY, which neither the file nor Abaqus"):
        load("void mystery_(int);\nvoid uexternaldb_(void) { mystery_(1); }\n", "user.c")


@pytest.fixture
def deck(tmp_path):
    """A spring of stiffness 5, pulled by 0.1."""
    path = tmp_path / "pulled.inp"
    path.write_text(
        "*NODE\n1, 0.\n2, 1.\n*NSET, NSET=END\n2\n*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=1\n1\n"
        "*ELEMENT, TYPE=U1, ELSET=ALL\n1, 1, 2\n*UEL PROPERTY, ELSET=ALL\n5.\n*STEP\n*STATIC\n1., 1.\n"
        "*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=END\nRF1\n*END STEP\n"
    )
    return path


@pytest.mark.parametrize("name", ["spring.c", "spring.cpp"])
def test_element_runs(tmp_path, deck, name):
    file = tmp_path / name
    file.write_text((HERE / "spring.c").read_text())
    result = run(deck, file, output_dir=tmp_path)
    assert result.history["RF1[END]"][-1] == pytest.approx(0.5)


@pytest.mark.parametrize("name", ["user.c", "user.cpp"])
def test_name_without_underscore(tmp_path, deck, name):
    file = tmp_path / name
    file.write_text("void uel(double *rhs) {}\n")
    with pytest.raises(DeckError, match=rf"need UEL; .*{name} has no user routine \(in C its name is uel_ or FOR_NAME"):
        run(deck, file, output_dir=tmp_path)
