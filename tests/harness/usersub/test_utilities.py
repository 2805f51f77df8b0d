# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The routines of Abaqus that a user's file calls."""

import ctypes
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uel.errors import UelError
from uel.usersub import _host

HOST = ctypes.CDLL(_host.__file__)
RNG = np.random.default_rng(7)
STRESS, STRAIN = 1, 2
TENSORS = [(3, 3), (3, 1), (2, 1)]


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def integers(*values):
    return [ctypes.byref(ctypes.c_int(v)) for v in values]


def matrix(s, lstr, ndi, nshr):
    """The tensor as Abaqus stores it (Conventions: 11, 22, 33, 12, 13, 23; engineering shear strain)."""
    m = np.zeros((3, 3))
    m[range(ndi), range(ndi)] = s[:ndi]
    for k, (i, j) in enumerate([(0, 1), (0, 2), (1, 2)][:nshr]):
        m[i, j] = m[j, i] = s[ndi + k] / lstr
    return m


@pytest.mark.parametrize("lstr", [STRESS, STRAIN])
@pytest.mark.parametrize("ndi, nshr", TENSORS)
def test_rotsig(lstr, ndi, nshr):
    s, rotated = RNG.normal(size=ndi + nshr), np.zeros(ndi + nshr)
    # a rotation about axis 3 keeps a plane tensor in its plane
    r = Rotation.random(rng=RNG).as_matrix() if nshr == 3 else Rotation.from_euler("z", 0.7).as_matrix()
    HOST.rotsig_(pointer(s), pointer(np.asfortranarray(r)), pointer(rotated), *integers(lstr, ndi, nshr))
    expected = r @ matrix(s, lstr, ndi, nshr) @ r.T
    np.testing.assert_allclose(matrix(rotated, lstr, ndi, nshr), expected, atol=1e-14)


@pytest.mark.parametrize("lstr", [STRESS, STRAIN])
@pytest.mark.parametrize("ndi, nshr", TENSORS)
@pytest.mark.parametrize("scale", [1.0, 1e-12, 1e9])
def test_principal_values_and_directions(lstr, ndi, nshr, scale):
    for _ in range(20):
        s, values, only_values = scale * RNG.normal(size=ndi + nshr), np.zeros(3), np.zeros(3)
        directions = np.zeros((3, 3), order="F")
        sizes = integers(lstr, ndi, nshr)
        HOST.sprind_(pointer(s), pointer(values), pointer(directions), *sizes)
        HOST.sprinc_(pointer(s), pointer(only_values), *sizes)
        tensor = matrix(s, lstr, ndi, nshr)
        np.testing.assert_allclose(np.sort(values), np.linalg.eigvalsh(tensor), atol=1e-14 * scale)
        np.testing.assert_array_equal(values, only_values)
        np.testing.assert_allclose(directions @ directions.T, np.eye(3), atol=1e-14)
        np.testing.assert_allclose(directions @ tensor @ directions.T, np.diag(values), atol=1e-14 * scale)


def test_principal_values_of_equal_stress():
    s, values, directions = np.array([2.0, 2, 2, 0, 0, 0]), np.zeros(3), np.zeros((3, 3), order="F")
    HOST.sprind_(pointer(s), pointer(values), pointer(directions), *integers(STRESS, 3, 3))
    assert values.tolist() == [2, 2, 2]
    np.testing.assert_array_equal(directions, np.eye(3))


@pytest.mark.parametrize("ndi, nshr", TENSORS)
def test_invariants(ndi, nshr):
    s, mean, mises = RNG.normal(size=ndi + nshr), np.zeros(1), np.zeros(1)
    HOST.sinv_(pointer(s), pointer(mean), pointer(mises), *integers(ndi, nshr))
    a, b, c = np.linalg.eigvalsh(matrix(s, STRESS, ndi, nshr))
    assert mean[0] == pytest.approx((a + b + c) / 3)
    assert mises[0] == pytest.approx(math.sqrt(((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2) / 2))


TENSOR = "      dimension s(6), ps(3), an(3,3)"
PROGRAM = """
      subroutine uexternaldb(lop,lrestart,time,dtime,kstep,kinc)
      include 'ABA_PARAM.INC'
{header}
      dimension time(2)
      character*256 text
      character*8 word
{declarations}
      word = ' '
{body}
      end
"""
SAY = "      call stdb_abqerr(1,'{form}',(/{integers}/),(/{reals}/),word)\n"


def program(body, *, header="", declarations=""):
    if header:
        header = f"#include <{header}>"
    return PROGRAM.format(header=header, declarations=declarations, body=body)


def say(form, integers="0", reals="0.d0"):
    return SAY.format(form=form, integers=integers, reals=reals)


def said(library, lop=0):
    library.external_database(lop, 0, (0.0, 0.0), 0.0, 0, 0)
    return [m.text for m in library.messages() if m.kind == "note"]


def test_names_of_the_job(load, tmp_path):
    body = (
        "      call getjobname(text,k)\n      word = text(1:k)\n"
        + say("%S %I", "k")
        + "      call getoutdir(text,k)\n      open(8,file=text(1:k)//'/made.txt')\n      close(8)\n"
    )
    assert said(load(program(body))) == ["job 3"]
    assert (tmp_path / "out" / "made.txt").exists()


@pytest.mark.parametrize(("declarations", "variable"), [("", "text"), ("      character*600 wide", "wide")])
def test_output_folder_with_a_long_name(load, tmp_path, declarations, variable):
    """CHARACTER*256 takes a part of it, with one warning; a longer variable takes all."""
    folder = tmp_path / "/".join(["d" * 150, "e" * 150])
    size = len(str(folder.resolve()))
    body = f"      call getoutdir({variable},k)\n" + say("%I", "k")
    loaded = load(program(body, declarations=declarations), output_dir=folder)
    notes, warnings = [], []
    for _ in range(2):
        loaded.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
        messages = loaded.messages()
        notes += [m.text for m in messages if m.kind == "note"]
        warnings += [m.text for m in messages if m.kind == "warning"]
    assert notes == [str(size if declarations else 256)] * 2
    told = f"GETOUTDIR: the name of the output directory has {size} characters, but the variable holds 256 "
    assert [text.startswith(told) for text in warnings] == ([] if declarations else [True])


def test_environment_variable(load, monkeypatch):
    monkeypatch.setenv("UEL_TEST", "value")
    assert said(load(program("      call getenvvar('UEL_TEST',text,k)\n      word = text\n" + say("%S %I", "k")))) == [
        "value 5"
    ]


@pytest.mark.nan
@pytest.mark.parametrize("routine", ["sprinc(s,ps,1,3,3)", "sprind(s,ps,an,1,3,3)"])
@pytest.mark.parametrize("value", ["sqrt(s(2)-1)", "1/s(2)"])
def test_tensors_without_principal_values_are_warned_of(load, routine, value):
    library = load(program(f"      s = 0\n      s(1) = {value}\n      call {routine}\n", declarations=TENSOR))
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    (message,) = library.messages()
    assert message.kind == "warning"
    assert message.text == "in UEXTERNALDB: a tensor has no principal values, since it contains NaN or infinity"


@pytest.mark.parametrize("header", ["", "SMAAspUserSubroutines.hdr", "SMAAspUserUtilities.hdr"])
def test_threads_and_processes(load, header):
    declarations = "" if header else "      integer getnumthreads, get_thread_id"
    body = (
        "      call getnumcpus(n)\n      call getrank(k)\n      call MutexInit(1)\n      call MutexLock(1)\n"
        "      call MutexUnlock(1)\n" + say("%I %I %I %I", "n,k,getNumThreads(),get_thread_id()")
    )
    assert said(load(program(body, header=header, declarations=declarations))) == ["1 0 1 0"]


SHARED = """      integer numbers(5)
      real*4 single(4)
      real*8 double(6)
      pointer(pn, numbers)
      pointer(ps, single)
      pointer(pd, double)"""


@pytest.mark.parametrize("local", ["", "Local"])
def test_shared_arrays_last_from_call_to_call(load, local):
    body = (
        """
      if (lop == 0) then
        pn = SMAIntArrayCreate(7,5,-1)
        ps = SMAFloatArrayCreate(7,4,0.5)
        pd = SMAFloatArrayCreate(8,6,0.25d0)
        numbers(2) = 3
        single(4) = 1.5
        double(6) = 2.5d0
      else
        pn = SMAIntArrayAccess(7)
        ps = SMAFloatArrayAccess(7)
        pd = SMAFloatArrayAccess(8)
      end if
      i = SMAIntArraySize(7)
      j = SMAFloatArraySize(7)
      k = SMAFloatArraySize(8)
"""
        + say("%I %I %I %I", "sum(numbers),i,j,k")
        + say("%R %R", reals="dble(sum(single)),sum(double)")
    )
    text = program(body, header="SMAAspUserSubroutines.hdr", declarations=SHARED)
    library = load(text.replace("SMAInt", f"SMA{local}Int").replace("SMAFloat", f"SMA{local}Float"))
    expected = ["-1 5 4 6", "3.00000 3.75000"]
    assert said(library, 0) == expected
    assert said(library, 1) == expected


def test_shared_arrays_grow_and_keep_what_they_hold(load):
    body = (
        """
      pn = SMAIntArrayCreate(1,2,4)
      pn = SMAIntArrayCreate(1,5,6)
"""
        + say("%I %I", "sum(numbers),SMAIntArraySize(1)")
        + "      call SMAIntArrayDelete(1)\n      pn = SMAIntArrayAccess(1)\n"
    )
    library = load(program(body, header="SMAAspUserArrays.hdr", declarations=SHARED))
    with pytest.raises(
        UelError, match=r"stopped the analysis: smaIntArrayAccess\(1\): there is no array with this number"
    ):
        said(library)
    assert next(m.text for m in library.messages()) == "26 5"


def test_shared_arrays_of_one_job_are_not_there_in_the_next(load):
    create = "      pn = SMAIntArrayCreate(3,2,4)\n"
    access = "      pn = SMAIntArrayAccess(3)\n"
    said(load(program(create, header="SMAAspUserArrays.hdr", declarations=SHARED)))
    with pytest.raises(UelError, match="there is no array with this number"):
        said(load(program(access, header="SMAAspUserArrays.hdr", declarations=SHARED)))


def test_prints_to_units_6_and_7_become_messages(load, tmp_path):
    body = """
      write(6,*) 'to the data file', lop
      write(*,*) 'so does this'
      write(7,'(a)') 'to the message file'
"""
    library = load(program(body))
    for lop in (0, 3):
        library.external_database(lop, 0, (0.0, 0.0), 0.0, 0, 0)
        dat, msg = library.messages()
        assert (dat.file, dat.kind, msg.file, msg.kind) == (".dat", "print", ".msg", "print")
        assert dat.text.split() == f"to the data file {lop} so does this".split()
        assert msg.text == "to the message file\n"
    library.close()
    assert list((tmp_path / "out").iterdir()) == []


def test_prints_that_memory_does_not_hold_stay_on_disk(load, tmp_path, monkeypatch):
    monkeypatch.setattr("uel.usersub.messages.MOST", 30)
    library = load(program("      do k = 1, 4\n        write(7,'(a)') 'a line of twenty '\n      end do\n"))
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    warning, text = library.messages()
    assert "stays in job.unit7" in warning.text
    assert text.text == "a line of twenty \na line of tw"
    library.close()
    assert (tmp_path / "out" / "job.unit7").read_text() == 4 * "a line of twenty \n"


def test_untaken_prints_stay_on_disk(load, tmp_path):
    library = load(program("      write(7,'(a)') 'nobody reads this'\n"))
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    library.close()
    assert (tmp_path / "out" / "job.unit7").read_text() == "nobody reads this\n"


def test_external_database_arguments(load):
    body = say("%I %I %I %I", "lop,lrestart,kstep,kinc") + say("%R %R %R", reals="time(1),time(2),dtime")
    library = load(program(body))
    library.external_database(2, 0, (0.5, 1.5), 0.25, 3, 4)
    assert [m.text for m in library.messages()] == ["2 0 3 4", "0.500000 1.50000 0.250000"]


@pytest.mark.parametrize(
    "statement, reason",
    [
        ("call xit", r"stopped the analysis \(XIT\) without a message"),
        ("call xexit", r"stopped the analysis \(XIT\) without a message"),
        ("call stdb_abqerr(-3,'no license to %S',0,0.d0,'delamin.')", "stopped the analysis: no license to delamin."),
        ("stop", "stopped the analysis: STOP"),
        ("error stop 'broken'", "stopped the analysis: ERROR STOP 'broken'"),
        ("call exit(3)", "stopped the analysis: CALL EXIT 3"),
    ],
)
def test_ends_of_the_analysis(load, statement, reason):
    library = load(program(f"      {statement}"))
    with pytest.raises(UelError, match=rf"user.f: UEXTERNALDB \(LOP=5\) {reason}"):
        library.external_database(5, 0, (0.0, 0.0), 0.0, 1, 0)


def test_nothing_happens_without_an_external_database(load):
    library = load("      subroutine uel(a)\n      end\n")
    assert library.uexternaldb is None
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)


def test_variables_are_known_for_the_projects_kernels_only(load):
    assert load("      subroutine uel(a)\n      end\n").variables(1) is None
