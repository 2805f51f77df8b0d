# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""User files are compiled as Abaqus compiles them, and what the compiler says comes back readable."""

import shutil
import subprocess

import pytest
from user_database import database, note, said

from uel import usersub
from uel.errors import CompileError
from uel.usersub import suspicions


def test_fixed_form_has_132_columns(load):
    line = "      i = 1 +" + " " * 100 + "2 + 4"
    assert 72 < len(line) <= 132
    assert said(load(database(f"{line}\n{note('%I', 'i')}"))) == ["7"]


def test_preprocessor_runs(load):
    text = database("#define VALUE 5\n#ifdef VALUE\n" + note("%I", "VALUE") + "\n#endif")
    assert said(load(text)) == ["5"]


@pytest.mark.parametrize("directive", ["!DIR$ FREEFORM", "!DEC$ FREEFORM", "!dir$ freeform", "  !DEC$ FREEFORM"])
def test_free_form_by_directive(load, directive):
    text = f"{directive}\nsubroutine uexternaldb(lop)\ncall stdb_abqerr(1, &\n'free', (/0/), (/0d0/), (/' '/))\nend\n"
    assert said(load(text, "user.for")) == ["free"]


def test_free_form_by_name(load):
    text = "subroutine uexternaldb(lop)\ncall stdb_abqerr(1, 'free', (/0/), (/0d0/), (/' '/))\nend\n"
    assert said(load(text, "user.f90")) == ["free"]


@pytest.mark.parametrize(
    ("environment", "free"),
    [
        ("ask_delete=OFF\ncompile_fortran = ['ifort', '-c',\n  '-free', '%P']\n", True),
        ("compile_fortran = 'ifort /c /free %P'\n", True),
        ("fortCmd = 'gfortran'\ncompile_fortran = (fortCmd + ' -c -ffree-form ' +\n  '-I%I')\n", True),
        ("compile_fortran = ['ifort', '-c', '%P'] # without -free\n# compile_fortran='ifort -free'\n", False),
        ("compile_fortran = ['ifort', '-c', '%P']\nlink_sl = ['ld', '-free']\n", False),
    ],
)
def test_free_form_by_environment_file(load, tmp_path, environment, free):
    """abaqus_v6.env beside the file has the user's options of the compiler; a library is kept for either form."""
    text = "module one\nend module\nsubroutine uexternaldb(lop)\nuse one\n"
    text += "call stdb_abqerr(1, 'free', (/0/), (/0d0/), (/' '/))\nend\n"
    (tmp_path / "abaqus_v6.env").write_text(environment)
    if free:
        assert said(load(text)) == ["free"]
        (tmp_path / "abaqus_v6.env").unlink()
    with pytest.raises(CompileError, match="it looks like free form"):
        load(text)


@pytest.mark.parametrize("name", ["ABA_PARAM.INC", "aba_param.inc", "Aba_Param.Inc"])
def test_aba_param_in_any_case(load, name):
    text = database("      a = 1.5\n      iwhole = 2*a\n" + note("%I", "iwhole")).replace("aba_param.inc", name)
    assert said(load(text)) == ["3"]


def test_includes_are_found_beside_the_source_and_beside_the_deck(load, tmp_path):
    (tmp_path / "deck").mkdir()
    (tmp_path / "one.inc").write_text("      i = 1\n      include 'TWO.inc'\n")
    (tmp_path / "deck" / "Two.inc").write_text("      i = i + 2\n")
    text = database("      INCLUDE 'one.inc'\n" + note("%I", "i"))
    assert said(load(text, deck=tmp_path / "deck" / "job.inp")) == ["3"]


def test_includes_in_folders_of_another_case(load, tmp_path):
    """As on Windows, with its separators too."""
    (tmp_path / "Parts").mkdir()
    (tmp_path / "Parts" / "One.inc").write_text("      i = 1\n")
    (tmp_path / "two.inc").write_text("      i = i + 2\n")
    body = "      include 'parts/one.INC'\n      include './parts/../TWO.inc'\n"
    assert said(load(database(body + note("%I", "i")))) == ["3"]


@pytest.mark.parametrize("name", ["{folder}/one.inc", "../../../one.inc", "../../../ONE.inc"])
def test_includes_are_left_as_they_are(load, tmp_path, monkeypatch, name):
    """Nothing is written outside the folder of the compilation: a run beside this one may read them."""
    (tmp_path / "one.inc").write_bytes(b"      i = 1\r\n")
    scratch = tmp_path / "scratch" / "folder"
    for folder in (tmp_path / "a" / "b" / "c", scratch):
        folder.mkdir(parents=True)
    monkeypatch.setattr("tempfile.tempdir", str(scratch))
    before = (tmp_path / "one.inc").stat().st_mtime_ns
    text = database(f"      include '{name.format(folder=tmp_path)}'\n" + note("%I", "i"))
    assert said(load(text, "a/b/c/user.f")) == ["1"]
    assert (tmp_path / "one.inc").read_bytes() == b"      i = 1\r\n"
    assert (tmp_path / "one.inc").stat().st_mtime_ns == before
    assert list(scratch.parent.iterdir()) == [scratch]


def test_absolute_name_of_a_header_is_not_made(load, tmp_path):
    name = tmp_path / "abaqus" / "aba_param.inc"
    with pytest.raises(CompileError, match=r"Cannot open included file '\S+/abaqus/aba_param.inc'"):
        load(database(note()).replace("aba_param.inc", str(name)))
    assert not name.parent.exists()


def test_module_files_of_the_current_folder_are_not_taken(load, tmp_path, monkeypatch):
    """They are there where a user has compiled the file before."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "one.mod").write_text("of another compiler")
    text = "      module one\n      integer :: i = 7\n      end module\n" + database(note("%I", "i"))
    assert said(load(text.replace("include", "use one\n      include", 1))) == ["7"]


def test_saved_data_last_for_a_job(load):
    body = "      common /block/ j\n      save i\n      data i /0/\n      i = i + 1\n      j = j + 10\n"
    text = database(body + note("%I", "i") + "\n" + note("%I", "j"))
    library = load(text)
    assert said(library) == ["1", "10"]
    assert said(library) == ["2", "20"]
    assert said(load(text)) == ["1", "10"]


def test_assignment_gives_an_allocatable_its_shape(load):
    """As the Fortran standard has it: a string and arrays that have no memory, or another shape."""
    declared = "      character(len=:), allocatable :: s\n      integer, allocatable :: ids(:), k(:)\n"
    body = declared + "      s = 'C3D8'\n      ids = [(i, i = 1, 5)]\n      allocate(k(3))\n      k = [1, 2]\n"
    notes = [note("%I", value) for value in ("len(s)", "sum(ids)", "size(k)")]
    assert said(load(database(body + "\n".join(notes)))) == ["4", "15", "2"]


def test_compiled_once(load, cache, tmp_path):
    text = database(note())
    load(text)
    (first,) = cache.glob("*.so")
    written = first.stat().st_mtime_ns
    load(text)
    assert [f.stat().st_mtime_ns for f in cache.glob("*.so")] == [written]
    load(database(note("other")))
    assert len(list(cache.glob("*.so"))) == 2


def test_changed_include_compiles_again(load, tmp_path):
    text = database("      include 'value.inc'\n" + note("%I", "i"))
    (tmp_path / "value.inc").write_text("      i = 1\n")
    assert said(load(text)) == ["1"]
    (tmp_path / "value.inc").write_text("      i = 2\n")
    assert said(load(text)) == ["2"]


def test_several_files_in_order(tmp_path):
    (tmp_path / "a.f90").write_text("module shared\ninteger :: i = 5\nend module\n")
    (tmp_path / "b.f").write_text(database(note("%I", "i")).replace("include", "use shared\n      include", 1))
    files = [tmp_path / "a.f90", tmp_path / "b.f"]
    assert said(usersub.load(files, job="job", output_dir=tmp_path)) == ["5"]


def test_shared_library(load, tmp_path, cache):
    load(database(note()))
    shutil.copy(next(cache.glob("*.so")), tmp_path / "user.so")
    assert said(usersub.load(tmp_path / "user.so", job="job", output_dir=tmp_path)) == ["here"]


def test_first_error_with_its_line_and_column(load):
    text = database("      i = 1\n      x = = 2\n      y = = 3\n")
    with pytest.raises(CompileError) as caught:
        load(text, "wrong.f")
    message = str(caught.value)
    assert "wrong.f: does not compile: Invalid character in name (wrong.f, line 6, column" in message
    assert "x = = 2" in message
    assert "y = = 3" not in message
    code, mark = message.splitlines()[-2:]
    # gfortran points just behind the second equals sign
    assert mark.index("1") == code.rindex("=") + 1


def test_what_gfortran_refuses_is_shown(load):
    """.eqv. binds less than .and.: this comparison has no single meaning."""
    body = "      logical a, b\n      a = .true.\n      b = .true.\n      if (a .eq. .true. .and. b) a = b\n"
    with pytest.raises(CompileError, match=r"Logicals must be .* \(user.f, line 8(?s:.*)Hint: Abaqus' compiler"):
        load(database(body))


def test_missing_include(load):
    with pytest.raises(CompileError, match=r"Cannot open included file 'nowhere.inc' \(user.f, line 5"):
        load(database("      include 'nowhere.inc'"))


def test_unresolved_routine(load):
    with pytest.raises(CompileError, match="refers to MYSTERY, which neither the file nor Abaqus"):
        load(database("      call mystery(1)"))


def test_unresolved_routine_of_several_files(tmp_path):
    (tmp_path / "a.f").write_text(database("      call nowhere"))
    (tmp_path / "b.f").write_text("      subroutine somewhere\n      end\n")
    with pytest.raises(CompileError, match=r"a.f and 1 more: refers to NOWHERE, which neither"):
        usersub.load([tmp_path / "a.f", tmp_path / "b.f"], job="job", output_dir=tmp_path)


def test_missing_file(tmp_path):
    with pytest.raises(CompileError, match=r"none\.f: no such file"):
        usersub.load(tmp_path / "none.f", job="job", output_dir=tmp_path)


def test_wrong_kind_of_file(load):
    expected = ".f, .for, .f90, .c, .cpp, .cc, .cxx or .so"
    with pytest.raises(CompileError, match=rf"user.txt: not a file of user routines: expected {expected}"):
        load("int main;", "user.txt")


def test_shared_library_with_another_file(tmp_path):
    for name in ("a.so", "b.f"):
        (tmp_path / name).touch()
    with pytest.raises(CompileError, match="a shared library cannot be combined with other files"):
        usersub.load([tmp_path / "a.so", tmp_path / "b.f"], job="job", output_dir=tmp_path)


def test_not_a_library(tmp_path):
    (tmp_path / "a.so").write_text("no library")
    with pytest.raises(CompileError, match=r"a\.so: cannot be loaded: .*file too short"):
        usersub.load(tmp_path / "a.so", job="job", output_dir=tmp_path)


@pytest.mark.parametrize(
    ("name", "compiler", "package"),
    [("user.f", "gfortran", "gfortran"), ("user.c", "gcc", "gcc"), ("user.cpp", "g[+]+", "g[+]+")],
)
def test_missing_compiler(load, monkeypatch, name, compiler, package):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(
        CompileError, match=rf"compiling it needs {compiler}, which is not installed \(apt install {package}"
    ):
        load("", name)


def test_cache_that_cannot_be_written(load, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null")
    assert said(load(database(note()))) == ["here"]


def test_entry_points_are_named(load):
    assert load(database("") + "      subroutine umat(a)\n      end\n").entry_points == ("UEXTERNALDB", "UMAT")


def test_lapack(load):
    body = """
      dimension a(2,2),b(2),ip(2)
      a(1,1) = 2
      a(2,2) = 4
      a(1,2) = 0
      a(2,1) = 0
      b(1) = 6
      b(2) = 20
      call DGESV(2,1,a,2,ip,b,2,info)
      call stdb_abqerr(1,'%R %R %I',(/info/),b,(/'        '/))"""
    assert said(load(database(body))) == ["3.00000 5.00000 0"]


def test_automatic_arrays_are_on_the_stack(load, cache):
    """As with Abaqus' compiler: on the heap a write behind one ends the process, often much later."""
    body = "      call work(lop)\n      end\n"
    body += "      subroutine work(n)\n      integer n\n      real*8 a(n+1,n+1)\n      call use(a)\n"
    load(database(body) + "      subroutine use(a)\n      real*8 a(*)\n      a(1) = 1\n      end\n")
    (library,) = cache.glob("*.so")
    symbols = subprocess.run(["nm", "-D", str(library)], capture_output=True, text=True, check=True).stdout
    assert "work_" in symbols
    assert "malloc" not in symbols


CONTINUED = "      subroutine uexternaldb(lop, &\n        lrestart)\n      integer :: lop\n      lop = 1\n      end\n"
HINTS = {
    "an Intel module": ("      use ifport\n      end\n", "user.f", "it belongs to Intel's compiler: use Fortran's own"),
    "MKL as a module": (
        "      use lapack95\n      end\n",
        "user.f",
        "it belongs to Intel's MKL: LAPACK and BLAS are linked",
    ),
    "MKL as an include": (
        "      include 'mkl.fi'\n      end\n",
        "user.f",
        "it belongs to Intel's MKL: LAPACK and BLAS are",
    ),
    "Abaqus/Explicit": (
        "      subroutine vuel\n      include 'vaba_param.inc'\n      end\n",
        "user.f",
        "it belongs to Abaqus/Explicit, whose VUEL, VUMAT and other routines",
    ),
    "a function that is not declared": (
        database("      a = mean(3d0)") + "      real*8 function mean(x)\n      real*8 x\n      mean = x\n      end\n",
        "user.f",
        "it is not declared where it is called, so its first letter gives it a type",
    ),
    "a header of C++": (
        "#include <nowhere/Dense>\n",
        "user.cpp",
        "name its folder in the environment variable CPATH",
    ),
    "a missing module": (
        "      use tensors\n      end\n",
        "user.f",
        "none of the files defines the module tensors: give the file",
    ),
    "a module further down": (
        "      subroutine uel\n      use tensors\n      end\n      module tensors\n      end\n",
        "user.f",
        "the module tensors is further down: move it to the top",
    ),
    "integer for logical": (database("      if (lop) i = 1"), "user.f", "write the comparison out, such as i /= 0"),
    "a subroutine in an expression": (
        "      subroutine uel(x)\n      x = s3(x)\n      end\n      subroutine s3(y)\n      y = 2*y\n      end\n",
        "user.f",
        "a subroutine has no value to use in an expression: CALL it",
    ),
    "a subroutine of a module in an expression": (
        "      module m\n      contains\n      subroutine s3(y)\n      y = 2*y\n      end subroutine\n"
        "      end module\n"
        "      subroutine uel(x)\n      use m\n      x = s3(x)\n      end\n",
        "user.f",
        "a subroutine has no value to use in an expression: CALL it",
    ),
    "a subroutine that is called too": (
        "      subroutine uel(x)\n      call s3(x)\n      x = s3(x)\n      end\n",
        "user.f",
        "a subroutine has no value to use in an expression: CALL it",
    ),
    "fixed form in .f90": (
        "      subroutine uexternaldb(lop,\n     1 lrestart)\n      end\n",
        "user.f90",
        "it looks like fixed form: call it .for",
    ),
    "free form in .for": (
        "subroutine uexternaldb(lop, &\n  lrestart)\ninteger :: lop\nlop = 1\nend subroutine\n",
        "user.for",
        "it looks like free form: call it .f90, or begin it with !DIR[$] FREEFORM",
    ),
    # nothing of it begins in the columns of labels
    "continued as in free form": (
        CONTINUED,
        "user.for",
        "it looks like free form: call it .f90, or begin it with !DIR[$] FREEFORM",
    ),
}


@pytest.mark.parametrize("case", HINTS)
def test_hint(load, case):
    text, name, hint = HINTS[case]
    with pytest.raises(CompileError, match=rf"\({name}, line (?s:.*)\nHint: {hint}"):
        load(text, name)


def test_fixed_form_gets_no_hint_at_free_form(load):
    with pytest.raises(CompileError) as caught:
        load(database("      x = = 2"))
    assert "Hint" not in str(caught.value)


def test_hint_at_the_order_of_files(tmp_path):
    (tmp_path / "a.f").write_text("      subroutine uel\n      use tensors\n      end\n")
    (tmp_path / "b.f90").write_text("module tensors ! second order\nend module\n")
    files = [tmp_path / "a.f", tmp_path / "b.f90"]
    with pytest.raises(CompileError, match=r"Hint: b.f90 defines the module tensors: give it before a.f\."):
        usersub.load(files, job="job", output_dir=tmp_path)


def test_include_by_its_full_path_is_not_written_for_warnings(tmp_path):
    included, user = tmp_path / "common.inc", tmp_path / "user.f"
    included.write_text("      implicit real*8(a-h,o-z)\n")
    user.write_text(f"      subroutine uexternaldb(lop)\n      include '{included}'\n      end\n")
    before = included.stat().st_mtime_ns
    assert suspicions([user]) == []
    assert included.stat().st_mtime_ns == before
