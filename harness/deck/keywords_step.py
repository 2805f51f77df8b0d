# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table, second half: steps, prescribed values, loads and output requests."""

from __future__ import annotations

from harness.deck import controls, distributed, prescribed, procedures, steps
from harness.deck.keywords_procedure import INITIAL
from harness.deck.table import Keyword, Kind, Option, Support, Where, ignored, one_of, refused

FREQUENCY = Option("FREQUENCY", Kind.INTEGER, "every k-th increment (1); 0 never")

OUTPUT = (
    Keyword(
        "OUTPUT",
        "Begin output requests; without any, history and field output are those Abaqus preselects.",
        Where.STEP,
        (
            Option("FIELD", doc="field output, written to .vtu"),
            Option("HISTORY", doc="history output, written to .csv"),
            FREQUENCY,
            one_of("OP", "what becomes of earlier requests", ("NEW", "ADD", "REPLACE"), default="NEW"),
            Option("NUMBER INTERVAL", Kind.INTEGER, "number of output times in the step"),
            Option("TIME INTERVAL", Kind.REAL, "time between outputs"),
            Option("TIME MARKS", Kind.SWITCH, "whether increments end at the output times", default="YES"),
            one_of("VARIABLE", "default variables", ("ALL", "PRESELECT")),
            Option("TIME POINTS", Kind.NAME, "output times"),
            Option("SENSOR", doc="UAMP reads the variable, which is one component of one node, by NAME"),
            Option("NAME", Kind.NAME, "of a sensor"),
            *ignored("DIAGNOSTICS", "FILTER", "MODE LIST"),
        ),
    ),
    Keyword(
        "NODE OUTPUT",
        "Nodal variables of the *OUTPUT before.",
        Where.STEP,
        (
            Option("NSET", Kind.NAME, "node set"),
            one_of("VARIABLE", "default variables", ("ALL", "PRESELECT")),
            *ignored("EXTERIOR", "TRACER SET"),
        ),
        "variables",
    ),
    Keyword(
        "ENERGY OUTPUT",
        "Energies of the whole model, of the *OUTPUT, HISTORY before.",
        Where.STEP,
        (
            one_of("VARIABLE", "default variables", ("ALL", "PRESELECT")),
            *ignored("ELSET", "PER ELEMENT SET", "PER SECTION"),
        ),
        "variables",
    ),
    Keyword(
        "NODE PRINT",
        "Table of nodal variables in .dat.",
        Where.STEP,
        (
            Option("NSET", Kind.NAME, "node set"),
            FREQUENCY,
            Option("TOTALS", Kind.SWITCH, "print the sum of each column"),
            *ignored("GLOBAL", "MODE", "LAST MODE", "SUMMARY"),
        ),
        "variables, one table a line",
    ),
    Keyword(
        "EL PRINT",
        "Table of element variables in .dat.",
        Where.STEP,
        (
            Option("ELSET", Kind.NAME, "element set"),
            FREQUENCY,
            one_of(
                "POSITION",
                "where; values of built-in continuum elements are extrapolated, of others .dat has those at the "
                "points and warns",
                ("INTEGRATION POINTS", "CENTROIDAL", "CENTROID", "NODES", "AVERAGED AT NODES"),
                default="INTEGRATION POINTS",
            ),
            *ignored("DIRECTIONS", "LAST MODE", "LOCALDIR", "MODE", "REBAR", "SUMMARY", "TOTALS"),
        ),
        "variables, one table a line",
    ),
    Keyword(
        "ENERGY PRINT",
        "Table of the energies of the whole model in .dat.",
        Where.STEP,
        (FREQUENCY, *refused("ELSET")),
        "ignored, with a warning: all energies are printed",
    ),
    Keyword(
        "MONITOR",
        "Dof whose value .sta prints.",
        Where.STEP,
        (
            Option("NODE", Kind.NAME, "node, or set of one node", required=True),
            Option("DOF", Kind.INTEGER, "dof", required=True),
            *ignored("FREQUENCY"),
        ),
    ),
)

_IGNORED = {
    "SOLVER CONTROLS": "Controls of the iterative linear solver.",
    "TIME POINTS": "Points in time, for output.",
    "RESTART": "Restart files, which are not written.",
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
    "INCREMENTATION OUTPUT": "Increment sizes as history output.",
    "INTEGRATED OUTPUT": "Totals over surfaces.",
    "INTEGRATED OUTPUT SECTION": "Surface of *INTEGRATED OUTPUT.",
    "MODAL OUTPUT": "Modal variables.",
    "SURFACE OUTPUT": "Surface variables.",
    "SECTION FILE": "Section forces in the results file.",
    "SECTION PRINT": "Section forces in .dat.",
    "PHYSICAL CONSTANTS": "Absolute zero and the like: nothing that uses them is supported.",
}

STEP_KEYWORDS = (
    *steps.KEYWORDS,
    *procedures.KEYWORDS,
    *INITIAL,
    *controls.KEYWORDS,
    *prescribed.KEYWORDS,
    *distributed.KEYWORDS,
    *OUTPUT,
    *(Keyword(name, doc, Where.ANY, support=Support.IGNORED) for name, doc in _IGNORED.items()),
)
