# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes outside arguments, and files and memory that calls keep: each mistake alone in a spring between two nodes."""

import re
from pathlib import Path

import pytest

from uel.check.checks import CHECKS
from uel.check.examine import examine
from uel.check.finding import Verdict

HEAD = Path(__file__).parents[1] / "uel.inc"
SPRING = """\
      include '{head}'
      double precision, allocatable :: room(:)
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      amatrx(1,2) = -1
      amatrx(2,1) = -1
      {mistake}
      end

      subroutine enter(a, k, x)
      double precision a(*), x
      a(k) = x
      end

      subroutine put(n, k, i)
      integer n(*)
      n(k) = i
      end
"""
DECK = """\
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, I PROPERTIES=1, VARIABLES=2
1
*NODE
1, 0.
2, 1.
*ELEMENT, TYPE=U1, ELSET=ALL
7, 1, 2
*UEL PROPERTY, ELSET=ALL
3
*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
1, 1
2, 1, 1, 0.1
*END STEP
"""
C_PARTS = """\
#include <stdlib.h>
void leak_(const int *bytes) { volatile char *p = malloc(*bytes); p[0] = 1; }
void once_(void) { static double *kept; if (!kept) kept = malloc(8000); kept[0] = 1; }
"""
ALL = ("run", "compiler", "resources", "outside", "undeclared", "no-time", "debug")


@pytest.fixture
def findings(tmp_path):
    """What the checks of memory find where this statement is in the spring."""

    def findings(mistake, *names):
        deck, user, parts = (tmp_path / name for name in ("spring.inp", "spring.f", "parts.c"))
        deck.write_text(DECK)
        user.write_text(SPRING.format(head=HEAD, mistake=mistake.replace("\n", "\n      ")))
        parts.write_text(C_PARTS)
        skip = [check.name for check in CHECKS if check.name not in (names or ALL)]
        (report,) = examine(deck, [user, parts], skip=skip).types
        return report.findings

    return findings


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("mistake", "check", "message"),
    [
        ("if (lflags(3) == 4) svars(3) = 0", "outside", r"outside SVARS: entry 3 of 2 .* with LFLAGS\(3\) = 4$"),
        ("if (lflags(3) == 5) call enter(energy, 9, 0d0)", "outside", r"ENERGY: entry 9 of 8 .* with LFLAGS\(3\) = 5$"),
        ("if (lflags(3) == 6) svars(0) = 0", "outside", r"outside SVARS: entry 0 of 2 .* with LFLAGS\(3\) = 6$"),
        ("if (kinc == 0) svars(3) = 0", "no-time", r"called with KINC = 0 and .* outside SVARS: entry 3 of 2"),
        ("if (kinc == 0) time(3) = 0", "no-time", "called with KINC = 0 and .*: writes outside TIME: entry 3"),
        # far behind an array is not the next one
        ("call enter(amatrx, 350, 1d0)", "outside", r"writes outside AMATRX: entry 350 of 4 \(2 x 2\)"),
        ("call enter(amatrx, 9000, 1d0)", "outside", r"writes outside AMATRX: entry 9000 of 4 \(2 x 2\)"),
        # the run that comes first survives this, too
        ("do k = 5, 20012\ncall enter(amatrx, k, 1d0)\nend do", "outside", r"outside AMATRX: entry 5 of 4 \(2 x 2\)"),
        # each of the entries that fill up a cache line
        *((f"call enter(amatrx, {k}, 1d0)", "outside", "outside (AMATRX|SVARS): entry") for k in range(20001, 20013)),
        ("call put(jprops, njprop + 1, 5)", "outside", "writes outside JPROPS: entry 2 of 1"),
        ("call put(jprops, 0, 5)", "outside", "writes outside JPROPS: entry 0 of 1"),
        ("call put(lflags, 8, 0)", "outside", "writes outside LFLAGS: entry 8 of 7"),
        ("call put(jdltyp, 3, 0)", "outside", "writes outside JDLTYP: entry 3"),
        ("call enter(adlmag, 3, 0d0)", "outside", "writes outside ADLMAG: entry 3"),
        ("call enter(ddlmag, 3, 0d0)", "outside", "writes outside DDLMAG: entry 3"),
        ("call enter(time, 3, 0d0)", "outside", "writes outside TIME: entry 3 of 2"),
        ("call enter(params, 4, 0d0)", "outside", "writes outside PARAMS: entry 4 of 3"),
        ("call enter(kstep, 1, 1d0)", "outside", "writes outside KSTEP: entry 2"),
        ("rhs(1,1) = rhs(1,1) + 0*time(3)", "undeclared", "outside TIME changes the result: .*is NaN"),
        ("if (lflags(8) == 7) rhs(1,1) = 0", "undeclared", "outside LFLAGS changes the result"),
        ("rhs(1,1) = rhs(1,1) + params(4)", "undeclared", "outside PARAMS changes the result"),
    ],
)
@pytest.mark.nan
def test_what_lies_outside_arguments(findings, mistake, check, message):
    finding = findings(mistake, check)[check]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message


@pytest.mark.parametrize(
    ("mistake", "message"),
    [
        (
            "open (newunit=k, status='scratch')",
            r"100 equal calls leave 100 files open, .*gfortrantmp.* among them",
        ),
        # 64 bytes and the 16 of malloc in each call, or 32 where it finds a piece too small to split, more or less what
        # else this process takes and frees
        ("call leak(64)", r"100 equal calls allocate [7-9]\d\d\d bytes that they do not free"),
        ("call leak(200000)", r"100 equal calls allocate \d+ bytes that they do not free"),
    ],
)
def test_what_calls_keep(findings, mistake, message):
    finding = findings(mistake, "resources")["resources"]
    assert finding.verdict is Verdict.FAILED
    assert re.search(message, finding.message), finding.message
    assert re.search("CLOSE what a call opens|DEALLOCATE", finding.advice)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "harmless",
    [
        "continue",
        "call once",
        "open (newunit=k, file='{0}')\nwrite (k, *) u\nclose (k)",
        "open (unit=88, file='{0}')\nwrite (88, *) u",
        "allocate (room(1000))\nroom = 1\ndeallocate (room)",
        # a NaN that is made and not used
        "if (sqrt(-1 - u(1)**2) > 0) svars(1) = 1",
    ],
)
@pytest.mark.nan
def test_what_is_right_passes(findings, tmp_path, harmless):
    found = findings(harmless.format(tmp_path / "all.txt"))
    wrong = {name: finding.message for name, finding in found.items() if finding.verdict is not Verdict.PASSED}
    assert not wrong
