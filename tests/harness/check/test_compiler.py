# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the compiler knows of a user's file is told, with file and line; right code in an old style is left alone."""

import re
from pathlib import Path

import pytest

from uel.check.checks import CHECKS
from uel.check.examine import examine
from uel.check.finding import Verdict
from uel.check.isolated import examine_isolated
from uel.cli import main
from uel.errors import KernelError, UelError
from uel.usersub import suspicions
from uel.usersub.own_kernels import path_of_amalgam

TESTS = Path(__file__).parents[1]
TEMPLATE = Path(__file__).parents[3] / "harness" / "uel" / "project" / "template" / "my_uel.for"
ROUTINE = """\
      subroutine stiffness(props, n, d, y)
      implicit real*8(a-h,o-z)
      dimension props(1), d(3,3), b(3,3), w(4)
      parameter (ndim=2, zero=0.d0)
      young = props(1)
      {statement}
      d(1,1) = young*x*s*w(1)
      end

      subroutine fill(a, n, x, arr)
      implicit real*8(a-h,o-z)
      dimension a(n), arr(3)
      do i = 1, n
        a(i) = x + arr(i)
      end do
      end
"""
SET = "x = 1\n      s = 1\n      w = 1\n      "
FREE = ROUTINE.replace("      ", "")


PRODUCT = """\
module faces
  implicit none
contains
  pure function frame(nodes, bottom, top) result(slopes)
    integer, intent(in) :: nodes
    double precision, intent(in) :: bottom(3, nodes), top(3, nodes)
    double precision, parameter :: parent(2) = 0
    double precision :: slopes(3, 2)
    slopes = matmul(0.5d0*(bottom + top), slope(3, nodes, parent))
  end function
  pure function slope(dim, nodes, parent) result(s)
    integer, intent(in) :: dim, nodes
    double precision, intent(in) :: parent(2)
    double precision :: s(nodes, dim - 1)
    s = parent(1)
  end function
end module
"""

CONSTRUCTED = """\
module plies
  implicit none
  type ply
    double precision :: young
    double precision :: expansion(3) = 0
  end type
contains
  pure function plies_of(values) result(found)
    double precision, intent(in) :: values(:)
    type(ply) :: found(2)
    found = [ply(young=values(1), expansion=values([2, 3, 4])), ply(young=values(5), expansion=values([6, 7, 8]))]
  end function
  subroutine use_them(values, total)
    double precision, intent(in) :: values(:)
    double precision, intent(out) :: total
    type(ply) :: found(2)
    found = plies_of(values)
    total = found(1)%young + sum(found(2)%expansion)
  end subroutine
end module
"""


def told(tmp_path, statement, name="my_uel.for"):
    """Suspicions of a file with a statement, which is in line 6 or below, and the text."""
    file = tmp_path / name
    free = name.endswith(".f90")
    file.write_text((FREE if free else ROUTINE).format(statement=statement))
    return suspicions([file])


CERTAIN = [
    (SET + "b(4,4) = 1.d0", "index 4 of dimension 1 of 'b' is above its upper bound of 3"),
    (SET + "b(1,0) = 1.d0", "index 0 of dimension 2 of 'b' is below its lower bound of 1"),
    ("s = 1\n      w = 1", "'x' is used before it has a value"),
    (SET + "young = yuong", "'yuong' is used before it has a value"),
    (SET + "call fill(b, 2, 3.0, w)", r"REAL\(4\) is passed for the argument 'x', which is REAL\(8\)"),
    (SET + "call fill(b, 2, 3, w)", r"INTEGER\(4\) is passed for the argument 'x', which is REAL\(8\)"),
    (SET + "call fill(b, 2, 3.d0)", "Missing actual argument for argument 'arr'"),
    (SET + "call fill(b, 2, 3.d0, 2.d0)", "a constant is passed for the argument 'arr', which is an array"),
    (SET + "call fill(b, 2, 3.d0, zero)", "a constant is passed for the argument 'arr', which is an array"),
    (SET + "call fill(b, 2, 3.d0, w, n)", "More actual than formal arguments in procedure call"),
    (SET + "young = young*(1/2)", r"Integer division truncated to constant '0'.*write 1.d0/3.d0"),
    (SET + "x = sqrt(young*(1/3))", r"Integer division truncated to constant '0'.*write 1.d0/3.d0"),
    (
        SET + "mass = 2\n      x = mass*young\n      mass = young*x",
        "'mass' is an integer by its first letter, and what it gets is cut off",
    ),
]
TOLD = [
    (SET + "call fill(b, 2, 3.d0, s)", "a single value is passed for the argument 'arr', which is an array"),
    (SET + "if (n > 1) q = props(n)\n      x = q", "'q' may be used uninitialized"),
    (SET + "x = w(7/2)", "Integer division truncated to constant '3'"),
    (SET + "k = 7/2", "Integer division truncated to constant '3'"),
    (
        SET + "nodes = 2\n      x = young - nodes\n      nodes = young*x",
        "'nodes' is an integer by its first letter, and what it gets is cut off",
    ),
    (SET + "x = young/sqrt(3.)", r"sqrt\(3\.\) is a single-precision constant, with 7 digits.*write sqrt\(3\.d0\)"),
    (SET + "x = young*x + 1./3.", r"1\./3\. is a single-precision constant, with 7 digits.*write 1\.d0/3\.d0"),
    (SET + "x = 0.577350269189626", r"0.577350269189626 is a single-precision constant.*write 0.577350269189626d0"),
    (SET + "if (n > 1) x = yuong", "'yuong' is declared nowhere and used once: misspelt for 'young'?"),
    (SET + "if (n > 1) yuong = 2", "'yuong' is declared nowhere and used once: misspelt for 'young'?"),
    (SET + "d(4,1) = 0", "index 4 of dimension 1 of 'd' is above its upper bound of 3"),
]


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["my_uel.for", "my_uel.f90"])
@pytest.mark.parametrize(
    ("statement", "sentence", "certain"), [*((*row, True) for row in CERTAIN), *((*row, False) for row in TOLD)]
)
def test_mistake_is_told_with_its_line(tmp_path, name, statement, sentence, certain):
    found = told(tmp_path, statement, name)
    matching = [one for one in found if re.search(sentence, str(one))]
    assert matching, found
    assert {one.certain for one in matching} == {certain}
    assert {one.certain for one in found} >= {certain}
    last = 6 + statement.count("\n")
    # a variable without a value is told where it is used
    assert {(one.file, one.line) for one in matching} <= {(name, last), (name, last + 1)}
    assert str(matching[0]).startswith(f"{name} line {matching[0].line}: ")


@pytest.mark.parametrize("name", ["my_uel.c", "my_uel.cpp"])
def test_mistakes_in_c(tmp_path, name):
    file = tmp_path / name
    file.write_text("double f(int n)\n{\n    double d[3] = {0}, x;\n    d[3] = n;\n    return d[0] + x;\n}\n")
    found = [(one.line, one.certain) for one in suspicions([file])]
    assert (5, True) in found
    file.write_text("double f(int n)\n{\n    double d[3] = {0}, x = 0;\n    d[0] = n;\n    return d[0] + x;\n}\n")
    assert suspicions([file]) == []


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "statement",
    [
        SET + "x = props(2)",
        SET + "if (ndim.eq.3) b(4,1) = 1",
        SET + "x = 0.5*young + 2. - 1.e-20",
        SET + "k = props(2)",
        SET + "goto 10\n   10 continue",
        SET + "call fill(b(1,2), 2, 3.d0, w(2))",
        SET + "ef = props(3)",
        SET + "n2 = n/2\n      x = n2",
        SET + "x = sqrt(4.) + 1./4. + sqrt(3.d0)",
        SET + "k = nint(young*x)\n      x = k*y",
    ],
)
def test_right_code_in_an_old_style(tmp_path, statement):
    assert told(tmp_path, statement) == []


@pytest.mark.parametrize("text", [PRODUCT, CONSTRUCTED])
def test_variables_of_the_compiler_are_not_the_users(tmp_path, text):
    """Bounds of an intermediate array, values of a constructor: gfortran 12 says that they have no value."""
    file = tmp_path / "source.f90"
    file.write_text(text)
    assert suspicions([file]) == []


@pytest.mark.long
def test_amalgam_is_beyond_suspicion():
    assert suspicions([path_of_amalgam()]) == []


@pytest.mark.parametrize("file", [TEMPLATE, *sorted(TESTS.glob("check/*.f"))], ids=lambda file: file.name)
def test_elements_of_the_project_are_certain_of_nothing(file):
    assert [one for one in suspicions([file], [TESTS]) if one.certain] == []


def test_check(tmp_path):
    """A wrong index in a file that has a UEL fails the check; a suspicion does not."""
    spring = (TESTS / "check" / "bar.f").read_text()
    assert spring
    deck, user = tmp_path / "spring.inp", tmp_path / "spring.f"
    deck.write_text(DECK)
    skip = [check.name for check in CHECKS if check.name != "compiler"]
    for statement, verdict, message in (
        (
            "w(5) = 1",
            Verdict.FAILED,
            r"^spring.f line 3: index 5 of dimension 1 of 'w' is above its upper bound of 4: w.5",
        ),
        ("w(1) = 0.1", Verdict.PASSED, r"worth a look:\nspring.f line 3: 0.1 is a single-precision constant"),
        ("w(1) = 1", Verdict.PASSED, "^no warnings$"),
    ):
        user.write_text(SPRING.format(head=TESTS / "uel.inc", statement=statement))
        (report,) = examine(deck, user, skip=skip).types
        finding = report.findings["compiler"]
        assert finding.verdict is verdict
        assert re.search(message, finding.message), finding.message
        assert ("wrong whenever they are executed" in finding.advice) == (verdict is Verdict.FAILED)


SPRING = """\
      include '{head}'
      dimension w(4)
      {statement}
      rhs(1,1) = -(u(1) + 0*w(1))
      amatrx(1,1) = 1
      end
"""
DECK = """\
*USER ELEMENT, TYPE=U1, NODES=1, COORDINATES=1
1
*NODE
1, 0.
*ELEMENT, TYPE=U1, ELSET=ALL
7, 1
*UEL PROPERTY, ELSET=ALL
*STEP
*STATIC, DIRECT
0.5, 1.
*CLOAD
1, 1, 1.
*END STEP
"""
UNSET = """\
      include '{head}'
      dimension w(3)
      w(1) = 1
      k = 3
      if (ndofel > 5) w(2:3) = 0
      do i = 1, k
        {statement}
      end do
      rhs(1,1) = -u(1)*(1 + 1d-30*s)
      amatrx(1,1) = 1
      end
"""


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("s = s + w(1)", "spring.f line 7: floating-point exception"),
        ("if (i == 1) s = w(i + ndofel)", "spring.f line 9: floating-point exception"),
        ("w(i + ndofel) = 1", r"spring.f line 7: index '4' of dimension 1 of array 'w' above upper bound of 3"),
    ],
)
@pytest.mark.nan
def test_debug_check_names_the_line(tmp_path, statement, message):
    deck, user = tmp_path / "spring.inp", tmp_path / "spring.f"
    deck.write_text(DECK)
    user.write_text(
        UNSET.format(head=TESTS / "uel.inc", statement=statement).replace("s)", "s)" if "s =" in statement else "w(1))")
    )
    skip = [check.name for check in CHECKS if check.name != "debug"]
    (report,) = examine(deck, user, skip=skip).types
    finding = report.findings["debug"]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message
    if "s =" in statement:
        assert "a local variable is used before it has a value" in finding.message


@pytest.mark.nan
def test_first_call_that_fails_has_the_warnings_before_it(tmp_path, capsys):
    """A constant for an array is what gfortran warns of; the NaN that the routine makes of it says nothing of that."""
    deck, user = tmp_path / "spring.inp", tmp_path / "spring.f"
    deck.write_text(DECK)
    text = SPRING.format(head=TESTS / "uel.inc", statement="call clear(w,1.d0,4)\n      w(1) = sqrt(-1 - u(1)**2)")
    user.write_text(text + "      subroutine clear(x,y,n)\n      real*8 x(n),y(n)\n      x=0\n      end\n")
    assert main(["check", str(user), str(deck)]) == 2
    said = capsys.readouterr().err
    assert re.search(r"RHS\(1\) is NaN", said)
    warning = r"earlier warning: spring.f, line 3: a constant is passed for the argument 'y', which is an array"
    assert re.search(warning, said)
    with pytest.raises(UelError) as error:
        examine_isolated(deck, [user])
    assert re.match(warning, error.value.__notes__[0])


@pytest.mark.nan
def test_first_call_that_fails_has_its_line(tmp_path):
    deck, user = tmp_path / "spring.inp", tmp_path / "spring.f"
    deck.write_text(DECK)
    user.write_text(SPRING.format(head=TESTS / "uel.inc", statement="w(1) = sqrt(-1 - u(1)**2)"))
    with pytest.raises(KernelError, match=r"RHS\(1\) is NaN .* in UEL, spring.f line 3: floating-point exception"):
        examine(deck, user)
