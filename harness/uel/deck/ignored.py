# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keywords that cannot change the solution: they are accepted and listed, but not read."""

from __future__ import annotations

from uel.deck.language.table import Keyword, Support, Where

_IGNORED = {
    "SOLVER CONTROLS": "Controls of the iterative linear solver.",
    "TIME POINTS": "Points in time, for output.",
    "PREPRINT": "What Abaqus echoes to .dat.",
    "PRINT": "What Abaqus writes to .msg.",
    "FILE FORMAT": "Format of the results file.",
    "FILE OUTPUT": "Results file.",
    "EL FILE": "Element variables in the results file.",
    "NODE FILE": "Nodal variables in the results file.",
    "ENERGY FILE": "Energies in the results file.",
    "CONTACT FILE": "Contact variables in the results file.",
    "CONTACT PRINT": "Contact variables in .dat.",
    "CONTACT OUTPUT": "Contact variables.",
    "ELEMENT OUTPUT": "Element variables; .vtu holds those of every element type that declares them.",
    "ELEMENT MATRIX OUTPUT": "Element matrices, in files of their own.",
    "ELEMENT OPERATOR OUTPUT": "Element matrices, in files of their own.",
    "INCREMENTATION OUTPUT": "Increment sizes as history output.",
    "INTEGRATED OUTPUT": "Totals over surfaces.",
    "INTEGRATED OUTPUT SECTION": "Surface of *INTEGRATED OUTPUT.",
    "MODAL OUTPUT": "Modal variables.",
    "RADIATION FILE": "Variables of cavities that radiate in the results file.",
    "RADIATION OUTPUT": "Variables of cavities that radiate.",
    "RADIATION PRINT": "Variables of cavities that radiate in .dat.",
    "SURFACE OUTPUT": "Surface variables.",
    "SECTION FILE": "Section forces in the results file.",
    "SECTION PRINT": "Section forces in .dat.",
    "FAIL STRESS": "Limits of the failure measures CFAILURE, which are output.",
    "FAIL STRAIN": "Limits of the failure measures CFAILURE, which are output.",
}

KEYWORDS = tuple(Keyword(name, doc, Where.ANY, support=Support.IGNORED) for name, doc in _IGNORED.items())
