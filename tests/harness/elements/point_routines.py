# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""USDFLD and UVARM around statements of a test, and what they ask of the host."""

from pathlib import Path
from textwrap import indent

HEAD_OF_USDFLD = Path(__file__).parents[1] / "usdfld.inc"
UVARM = """      SUBROUTINE UVARM(UVAR,DIRECT,T,TIME,DTIME,CMNAME,ORNAME,NUVARM,
     1 NOEL,NPT,LAYER,KSPT,KSTEP,KINC,NDI,NSHR,COORD,JMAC,JMATYP,
     2 MATLAYO,LACCFLA)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME,ORNAME
      CHARACTER*3 FLGRAY(15)
      DIMENSION UVAR(NUVARM),DIRECT(3,3),T(3,3),TIME(2),ARRAY(15),
     1 JARRAY(15),JMAC(*),JMATYP(*),COORD(*)
{}
      END
"""


def statements(lines: str) -> str:
    """Lines in the columns of fixed form."""
    return indent(lines, 6 * " ")


def usdfld(lines: str) -> str:
    """USDFLD with these statements."""
    return f"      INCLUDE '{HEAD_OF_USDFLD}'\n{statements(lines)}\n      END\n"


def uvarm(lines: str) -> str:
    """UVARM with these statements."""
    return UVARM.format(statements(lines))


def getvrm(name: str) -> str:
    """Call of GETVRM for a variable of the point."""
    return f"CALL GETVRM('{name}',ARRAY,JARRAY,FLGRAY,JRCD,JMAC,JMATYP,MATLAYO,LACCFLA)"
