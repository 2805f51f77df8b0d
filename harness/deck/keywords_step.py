# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table, second half: steps, prescribed values, loads and output requests."""

from __future__ import annotations

from harness.deck.keywords_procedure import INITIAL, PROCEDURE
from harness.deck.table import Keyword, Kind, Option, Support, Where, ignored, refused

OP = Option("OP", Kind.CHOICE, "NEW removes what earlier steps prescribed", default="MOD", choices=("MOD", "NEW"))
FREQUENCY = Option("FREQUENCY", Kind.INTEGER, "every k-th increment (1); 0 never")
AMPLITUDE = Option("AMPLITUDE", Kind.NAME, "amplitude; without it that of *STEP, but displacements always ramp")

HARMONIC = (
    Option("REAL", doc="real part of what is harmonic, in *STEADY STATE DYNAMICS; so is what says neither"),
    Option("IMAGINARY", doc="imaginary part of what is harmonic, in *STEADY STATE DYNAMICS"),
)

_LOAD = (
    OP,
    Option("AMPLITUDE", Kind.NAME, "amplitude; without it that of *STEP"),
    Option("INPUT", Kind.FILE, "file that holds the data lines"),
)

CONTROLS = (
    Keyword(
        "CONTROLS",
        "Solution controls; blank entries keep their value, later steps keep the controls. CONSTRAINTS is about hybrid "
        "elements, couplings and contact, of which there are none.",
        Where.STEP,
        (
            Option("ANALYSIS", Kind.CHOICE, "I_0 = 8, I_R = 10", choices=("DISCONTINUOUS",)),
            Option(
                "PARAMETERS",
                Kind.CHOICE,
                "what the data lines set",
                choices=("FIELD", "TIME INCREMENTATION", "LINE SEARCH", "CONSTRAINTS"),
            ),
            Option(
                "FIELD",
                Kind.CHOICE,
                "field the values are for; all fields unless given",
                default="GLOBAL",
                choices=(
                    *("GLOBAL", "DISPLACEMENT", "ROTATION", "TEMPERATURE", "PORE FLUID PRESSURE"),
                    *("ELECTRICAL POTENTIAL", "CONCENTRATION", "HYDROSTATIC FLUID PRESSURE", "MATERIAL FLOW"),
                    *("PRESSURE LAGRANGE MULTIPLIER", "VOLUMETRIC LAGRANGE MULTIPLIER"),
                ),
            ),
            Option("RESET", doc="all controls back to their defaults"),
            *refused("TYPE"),
        ),
        "the values of the manual's data lines",
    ),
)

PRESCRIBED = (
    Keyword(
        "BOUNDARY",
        "Prescribed values of dofs.",
        Where.ANY,
        (
            OP,
            AMPLITUDE,
            Option(
                "TYPE",
                Kind.CHOICE,
                "what is prescribed",
                choices=("DISPLACEMENT", "VELOCITY"),
                refused=("ACCELERATION",),
            ),
            Option("INPUT", Kind.FILE, "file that holds the data lines"),
            Option("USER", doc="DISP gives the values"),
            Option("FIXED", doc="values stay what they are at the start of the step"),
            *HARMONIC,
            *ignored("REGION TYPE"),
            *refused(
                *("BASE NAME", "LOAD CASE", "PHANTOM", "SCALE", "STEP", "SUBMODEL", "BLOCKING", "TIMESCALE"),
            ),
        ),
        "node or set, first dof, last dof, value; or node or set, XSYMM, YSYMM, ZSYMM, XASYMM, YASYMM, ZASYMM, "
        "PINNED or ENCASTRE",
    ),
    Keyword(
        "CLOAD",
        "Concentrated loads.",
        Where.STEP,
        (
            *_LOAD,
            *HARMONIC,
            *ignored("REGION TYPE"),
            *refused("CYCLIC MODE", "FOLLOWER", "LOAD CASE", "SUBMODEL"),
        ),
        "node or set, dof, value",
    ),
    Keyword(
        "CFLUX",
        "Concentrated heat fluxes; with *CLOAD in the same step both take the same OP.",
        Where.STEP,
        (
            *_LOAD,
            *ignored("REGION TYPE"),
        ),
        "node or set, dof (11), value",
    ),
)

DISTRIBUTED = (
    Keyword(
        "DLOAD",
        "Distributed loads on elements.",
        Where.STEP,
        (
            *_LOAD,
            *HARMONIC,
            *refused(
                *("CONSTANT RESULTANT", "CYCLIC MODE", "FOLLOWER", "LOAD CASE", "ORIENTATION", "REF NODE"),
                "REGION TYPE",
            ),
        ),
        "element or set, Un or UnNU (user elements), Pn, BX, BY, BZ, BR (CAX) or GRAV (built-in continuum elements; "
        "with NU, as in P2NU, by DLOAD), magnitude; GRAV: direction",
    ),
    Keyword(
        "DSLOAD",
        "Distributed loads on surfaces of built-in continuum elements; with NLGEOM tractions that turn with them are "
        "refused. As those of *DLOAD they are nodal forces, which CF in the output holds too, but for pressures with "
        "NLGEOM, which act on the present surface.",
        Where.STEP,
        (
            *_LOAD,
            Option("FOLLOWER", Kind.SWITCH, "TRVEC and TRSHR turn with the surface (YES)"),
            *HARMONIC,
            *refused("CONSTANT RESULTANT", "CYCLIC MODE", "LOAD CASE", "ORIENTATION", "REF NODE"),
        ),
        "surface, P, TRVEC or TRSHR, magnitude; TRVEC, TRSHR: direction",
    ),
    Keyword(
        "TEMPERATURE",
        "Temperature as a predefined field.",
        Where.STEP,
        (*_LOAD, *refused("ABSOLUTE EXTERIOR TOLERANCE", "BSTEP", "DRIVING ELSETS", "ESTEP", "FILE", "USER")),
        "node or set, temperature",
    ),
    Keyword(
        "FIELD",
        "Predefined field variable.",
        Where.STEP,
        (Option("VARIABLE", Kind.INTEGER, "number of the field variable (1)"), *_LOAD, *refused("FILE", "USER")),
        "node or set, value",
    ),
)

OUTPUT = (
    Keyword(
        "OUTPUT",
        "Begin output requests; without any, history and field output are those Abaqus preselects.",
        Where.STEP,
        (
            Option("FIELD", doc="field output, written to .vtu"),
            Option("HISTORY", doc="history output, written to .csv"),
            FREQUENCY,
            Option(
                "OP", Kind.CHOICE, "what becomes of earlier requests", default="NEW", choices=("NEW", "ADD", "REPLACE")
            ),
            Option("NUMBER INTERVAL", Kind.INTEGER, "number of output times in the step"),
            Option("TIME INTERVAL", Kind.REAL, "time between outputs"),
            Option("TIME MARKS", Kind.SWITCH, "whether increments end at the output times", default="YES"),
            Option("VARIABLE", Kind.CHOICE, "default variables", choices=("ALL", "PRESELECT")),
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
            Option("VARIABLE", Kind.CHOICE, "default variables", choices=("ALL", "PRESELECT")),
            *ignored("EXTERIOR", "TRACER SET"),
        ),
        "variables",
    ),
    Keyword(
        "ENERGY OUTPUT",
        "Energies of the whole model, of the *OUTPUT, HISTORY before.",
        Where.STEP,
        (
            Option("VARIABLE", Kind.CHOICE, "default variables", choices=("ALL", "PRESELECT")),
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
            Option(
                "POSITION",
                Kind.CHOICE,
                "where; values of built-in continuum elements are extrapolated, of others .dat has those at the "
                "points and warns",
                default="INTEGRATION POINTS",
                choices=("INTEGRATION POINTS", "CENTROIDAL", "CENTROID", "NODES", "AVERAGED AT NODES"),
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
    *PROCEDURE,
    *INITIAL,
    *CONTROLS,
    *PRESCRIBED,
    *DISTRIBUTED,
    *OUTPUT,
    *(Keyword(name, doc, Where.ANY, support=Support.IGNORED) for name, doc in _IGNORED.items()),
)
