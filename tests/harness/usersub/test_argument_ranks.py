# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A constant that is passed where a routine takes an array is told wherever the file is compiled."""

import pytest
from user_database import database, note, said

from uel import usersub
from uel.usersub import suspicions

FILL = "      subroutine fill(a, x)\n      implicit real*8(a-h,o-z)\n      dimension a(3), x(3)\n      a = x\n"
WARNING = (
    "user.f, line {line}: a constant is passed for the argument 'x', which is an array: {call} "
    "(the routine also reads the memory after it, which holds something else: pass an array)"
)


def text(call):
    """Of a file that calls FILL."""
    declarations = "      real*8 b(3)\n      parameter (zero=0.d0,one=1.d0)\n      b = 0\n      c = 0\n"
    return database(f"{declarations}      {call}\n      end\n{FILL}")


def line_of(call, whole):
    return next(number for number, row in enumerate(whole.splitlines(), 1) if call in row)


MENDED = "zero is passed for the argument 'x', which is an array; the copy passes an array of zeros"


@pytest.mark.parametrize("argument", ["0.d0", "zero"])
def test_zero_for_an_array_is_zeros_in_a_copy(load, argument):
    """As elements get the centre of their parent: call calcShape3DLinear(1,zero,1,sh0,dshxi)."""
    call = f"call fill(b,{argument})"
    whole = text(call).replace(call, f"b = 7\n      {call}\n{note('%I', 'count(b .eq. 0)')}")
    library = load(whole)
    (message,) = library.messages()
    assert message.text.endswith(f"user.f, line {line_of(call, whole)}: {MENDED}")
    assert said(library) == ["3"]


@pytest.mark.parametrize("argument", ["1.d0", "one", "-1.d0"])
def test_constant_for_an_array_is_a_warning(load, argument):
    """Each time the file is loaded: compiled, and taken from the cache."""
    call = f"call fill(b, {argument})"
    for _ in range(2):
        library = load(text(call))
        assert [m.text for m in library.messages()] == [WARNING.format(line=line_of(call, text(call)), call=call)]


@pytest.mark.parametrize("argument", ["b", "b(1)", "b(2)"])
def test_arrays_and_their_entries_are_not(load, argument):
    assert load(text(f"call fill(b, {argument})")).messages() == []


def test_variable_is_not(load):
    """What lies behind it may be meant, as in COMMON; `uel check` tells of it as worth a look."""
    assert load(text("call fill(b, c)")).messages() == []


def test_debug_build_says_it_too(tmp_path):
    call = "call fill(b, 1.d0)"
    file = tmp_path / "user.f"
    file.write_text(text(call))
    library = usersub.load(file, job="job", output_dir=tmp_path, debug=True)
    assert [m.text for m in library.messages()] == [WARNING.format(line=line_of(call, text(call)), call=call)]
    library.close()


def test_warning_before_an_error_does_not_keep_it_from_being_repaired(load, tmp_path):
    """Logicals compared with .eq. behind the call: gfortran tells of both in one output."""
    call = "call fill(b, 1.d0)"
    body = f"      real*8 b(3)\n      logical flag\n      flag = .true.\n      b = 0\n      {call}\n"
    body += f"      if (flag .eq. .true.) then\n{note('equal')}\n      end if\n      end\n{FILL}"
    library = load(database(body))
    assert [m.text.partition(", line")[0] for m in library.messages()] == [
        "an extension of Abaqus' compiler, written in standard Fortran in a copy: user.f",
        "user.f",
    ]
    assert said(library) == ["equal"]
    assert [one.certain for one in suspicions([tmp_path / "user.f"])] == [True]
