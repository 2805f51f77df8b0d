# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of Abaqus' elements, to tell one that is not supported from one that does not exist (Abaqus Elements Guide)."""

from __future__ import annotations

import re
from functools import cache
from typing import Final

_FORM: Final = "(R|I|M|V|S|HS)?(H|P|PH)?(T|E)?"
"""Reduced, incompatible, modified and so on; then hybrid, pore pressure; then temperature, piezoelectric."""

_FAMILIES: Final = (
    # continuum: in the plane, about an axis, with twist, with Fourier modes, in space, on cylinders, infinite
    rf"(CPE|CPS|CPEG|CAX|CGAX)[3468]{_FORM}",
    r"CAXA[48]R?H?P?[1-4]",
    rf"C3D(4|5|6|8|10|15|20|27){_FORM}",
    r"CCL(9|12|18|24)R?H?",
    r"CIN(PE[45]R?|PS[45]R?|AX[45]R?|3D(8|12R|18R))",
    r"Q3D(4|6|8|10|20)(R|M)?H?",
    r"E?C3D8RT?|WARP2D[34]|(PC|PD|FC)3D\d*",
    # heat, mass, electricity, magnetism, sound
    r"DCC?(1D[23]|2D[3468]|AX[23468]|3D(4|5|6|8|10|15|20))R?(D|E)?",
    r"EMC(2D[34]|3D[48])",
    r"AC(1D[23]|2D[3468]|AX[3468]|3D(4|5|6|8|10|15|20))R?|ACIN(2D[23]|AX[23]|3D[3468])",
    # structures: shells, membranes, surfaces, beams, pipes, trusses
    r"S(3|4|8)R?(5|S|SW|T)?|S9R5|STRI(3|65)|SC[68]RT?|SAX[12]T?|SAXA[12][1-4]|DS[3468]|DSAX[12]",
    r"(M3D[34689]|SFM3D[34689])R?|(M|MG|SFM|SFMG)AX[12]|(M|SFM)CL[69]",
    r"B(2[1-3]|3[1-3])(OS)?H?|PIPE[23][12]H?|ELBOW3(1B?|1C|2)|FRAME[23]D",
    r"T[23]D[23](H|T|E)?",
    # rigid, cohesive, gaskets, connectors and the like
    r"R2D2|R3D[34]|RAX2|RB[23]D2|MASS|ROTARYI|HEATCAP",
    r"(COH2D4|COHAX4|COH3D[68]|COD2D4|CODAX4|COD3D[68])P?",
    r"GK(2D2|3D[24689]|3D(12M|18)|PS[46]|PE[46]|AX[2-6])N?M?",
    r"CONN[23]D2|SPRING[12A]|DASHPOT[12A]|JOINTC|JOINT[23]D|DRAG[23]D|DCOUP[23]D|LS3S|LS6",
    r"GAP(UNI|UNIT|CYL|SPHER)|DGAP|ITS(UNI|CYL)|ITT[23]\d|ISL2[12]|IRS(2[12]A?|3|4|9|13)|ASI\d+[AD]?|PSI[23][46]",
)


@cache
def _name() -> re.Pattern[str]:
    """Return the pattern of all element names; compiled at a look-up, which most decks do not need."""
    return re.compile("|".join(_FAMILIES))


def is_abaqus_element(name: str) -> bool:
    """Return whether Abaqus has an element type of this name."""
    return _name().fullmatch(name.upper()) is not None
