# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What Abaqus' compiler takes and gfortran does not compiles in a copy, where it has one meaning."""

import pytest
from user_database import database, note, said

from uel.errors import CompileError


def test_logicals_compared_with_eq_compile_in_a_copy(load, tmp_path):
    """As Abaqus' compiler takes them; in an included file too; the user's files stay as they are."""
    included = "      if (flag .eq. .true.) then\n" + note("equal") + "\n      end if\n"
    (tmp_path / "part.inc").write_text(included)
    body = "      logical flag\n      flag = .true.\n      include 'part.inc'\n"
    text = database(body + "      if ((flag == .false.)) " + note("never").strip() + "\n")
    library = load(text)
    assert [m.text for m in library.messages()] == [
        "an extension of Abaqus' compiler, written in standard Fortran in a copy: "
        f"{file}: logicals compared with {operator}; the copy has .eqv. or .neqv."
        for file, operator in (("part.inc, line 1", ".eq."), ("user.f, line 8", "=="))
    ]
    assert said(library) == ["equal"]
    assert (tmp_path / "user.f").read_text() == text


def test_real_array_bound_compiles_in_a_copy(load):
    """As Abaqus' compiler takes it, which makes an integer of it; other names on the line stay."""
    body = "      call work(2)\n      end\n      subroutine work(n)\n      real*8, parameter :: most=2, tiny=1d-9\n"
    library = load(database(body + "      real*8 a(n,most), b(n)\n      a = tiny\n" + note("bound")))
    assert [m.text for m in library.messages()] == [
        "an extension of Abaqus' compiler, written in standard Fortran in a copy: "
        "user.f, line 9: a real number as an array bound; the copy has int() of it"
    ]
    assert said(library) == ["bound"]


def test_real_array_bound_of_an_argument_compiles_in_a_copy(load):
    """int(2.9 + 1) and int(max(2.9, 1) x 2) entries: user materials take sizes from PROPS."""
    body = "      real*8 props(2)\n      props(1) = 2.9d0\n      call work(props)\n      end\n"
    body += "      subroutine work(props)\n      real*8 props(2)\n"
    body += "      integer a(props(1)+1), b(max(props(1),1.d0)*2)\n      a = 0\n      b = 0\n"
    library = load(database(f"{body}      n = 10*size(a) + size(b)\n{note('%I', 'n')}"))
    assert any("a real number as an array bound" in m.text for m in library.messages())
    assert said(library) == ["35"]


@pytest.mark.parametrize(
    ("constants", "declaration"),
    [
        ("      parameter (three=3.d0, two=2)", "real*8 a(three*two), b(2)"),
        ("      parameter three=3.d0", "real*8 a(2*three), b(0:1)"),
        ("      double precision three\n      parameter (three=3)", "dimension a(three,2), b(-1:two)"),
        ("      parameter (n=3)", "double precision a(2.d0*n), b(2.0)"),
        ("      parameter (n=3)", "real(kind=8), dimension(n*2.) :: a, b"),
    ],
)
def test_array_bounds_of_real_constants_in_any_form(load, constants, declaration):
    """Expressions, numbers, and constants of implicit type; size(a) is 6."""
    body = f"{constants}\n      parameter (two=2)\n" if "two" not in constants else f"{constants}\n"
    body = f"      call work\n      end\n      subroutine work\n      include 'aba_param.inc'\n{body}"
    library = load(database(f"{body}      {declaration}\n      a = 0\n      b = 0\n{note('%I', 'size(a)')}"))
    assert any("a real number as an array bound" in m.text for m in library.messages())
    assert said(library) == ["6"]


@pytest.mark.parametrize("implicit", ["      implicit none\n", "      include 'aba_param.inc'\n"])
def test_constants_without_parentheses_have_the_types_of_their_values(load, implicit):
    """Intel Fortran Developer Guide, "Alternative Syntax for the PARAMETER Statement": first letters do not count."""
    body = f"      call work\n      end\n      subroutine work\n{implicit}"
    body += "      parameter nu=0.25d0, three=3, half=0.5 ! ratio\n"
    text = database(body + note("%I %I", "nint(1/nu), three/2, nint(1/half)").replace("%I %I", "%I %I %I"))
    library = load(text)
    (message,) = library.messages()
    assert "user.f, line 9: PARAMETER without parentheses, whose names have the types of their" in message.text
    assert said(library) == ["4 1 2"]


@pytest.mark.parametrize("line", ["parameter zero=0.d0", "parameter (nu=3)", "real*8 nu\n      parameter nu=3"])
def test_constants_whose_types_are_plain_stay(load, line):
    assert not load(database(f"      {line}")).messages()


def test_constants_that_go_on_in_the_next_line_are_shown(load):
    body = "      call work\n      end\n      subroutine work\n      implicit none\n"
    with pytest.raises(CompileError, match=r"has no IMPLICIT type \(user.f, line 9"):
        load(database(body + "      parameter zero=0.d0\n     1 , one=1.d0"))


def test_name_that_is_imported_and_defined_compiles_in_a_copy(load):
    """As Abaqus' compiler takes it: in the routine its own name is meant."""
    modules = "      module one\n      contains\n      subroutine twice(i)\n      i = 2*i\n"
    modules += "      end subroutine\n      end module\n"
    modules += "      module two\n      contains\n      recursive subroutine twice(i)\n      use one\n"
    modules += "      i = i + 1\n      if (i .lt. 9) call twice(i)\n      end subroutine\n      end module\n"
    text = database("      i = 6\n      call twice(i)\n" + note("%I", "i"))
    library = load(modules + text.replace("include", "use two\n      include", 1))
    (message,) = library.messages()
    assert "user.f, line 10: twice of module one has the name of the program unit that uses it" in message.text
    assert said(library) == ["9"]


def test_function_that_calls_itself_without_a_result_compiles_in_a_copy(load):
    """As Abaqus' compiler takes it: with arguments its name is a call."""
    function = "      recursive integer function kfac(n) ! factorial\n      if (n .lt. 2) then\n      kfac = 1\n"
    function += "      else\n      kfac = n\n      kfac = kfac*kfac (n - 1)\n      end if\n      end function kfac\n"
    library = load(database("      i = kfac(5)\n" + note("%I", "i")) + function)
    (message,) = library.messages()
    assert "user.f, line 13: the function kfac calls itself and has no RESULT" in message.text
    assert said(library) == ["120"]


def test_sign_of_two_kinds_compiles_in_a_copy(load):
    """As Abaqus' compiler takes it."""
    body = "      x = -2d0\n      i = nint(sign(1.0, x*max(x,1d0))) + 4*nint(sign (sqrt(4.0),-x))\n"
    library = load(database(body + note("%I", "i")))
    notes = [m.text for m in library.messages()]
    assert len(notes) == 2
    assert all("user.f, line 6: SIGN of two kinds of numbers; the copy has one kind" in text for text in notes)
    assert said(library) == ["7"]


def test_directives_in_capitals_compile_in_a_copy(load):
    """Abaqus' preprocessor takes them; the header of Abaqus has its name in capitals as well."""
    body = "#INCLUDE <SMAASPUSERSUBROUTINES.HDR>\n#DEFINE MOST 6\n#IFDEF MOST\n      i = MOST\n#ELSE\n"
    library = load(database(body + "      i = 7\n#ENDIF\n" + note("%I", "i")))
    notes = [m.text for m in library.messages()]
    assert len(notes) == 5
    assert any(text.endswith("user.f, line 5: #INCLUDE in capitals; the copy has #include") for text in notes)
    assert said(library) == ["6"]


def test_include_with_single_quotes_compiles_in_a_copy(load, tmp_path):
    """Public codes that run in Abaqus have it."""
    (tmp_path / "six.inc").write_text("      i = 6\n")
    library = load(database("# include 'six.inc'\n" + note("%I", "i")))
    (message,) = library.messages()
    assert message.text.endswith("user.f, line 5: #include with single quotes; the copy has double ones")
    assert said(library) == ["6"]


def test_sign_of_two_kinds_over_two_lines_is_shown(load):
    with pytest.raises(CompileError, match=r"must be the same type and kind as 'a' \(user.f, line 7"):
        load(database("      x = -2d0\n      y = sign(1.0,\n     1 x)"))


def test_function_that_calls_itself_with_a_long_head_is_shown(load):
    function = "      recursive integer function kfac(\n     1 n)\n      kfac = n*kfac(n - 1)\n      end\n"
    with pytest.raises(CompileError, match=r"Use an explicit RESULT variable .*\(user.f, line 9"):
        load(database("      i = kfac(5)") + function)
