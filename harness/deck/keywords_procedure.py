# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table: *STEP and the procedures."""

from __future__ import annotations

from harness.deck.table import Keyword, Kind, Option, Where, ignored, refused

_TIMES = "initial increment, period (1), smallest increment, largest increment"
_DIRECT = Option("DIRECT", doc="fixed increments")
_HEAT = (
    Option("STEADY STATE", doc="no storage of heat: time is a scale for loads"),
    Option("DELTMX", Kind.REAL, "largest change of temperature in an increment; without it increments are fixed"),
)
_STABILIZE = (
    Option(
        "STABILIZE",
        Kind.REAL,
        "viscous forces on the masses of built-in elements; fraction of energy that they dissipate at first",
        bare="0.0002",
    ),
    Option("FACTOR", Kind.REAL, "damping factor in place of the fraction"),
    Option("ALLSDTOL", Kind.REAL, "largest ratio of ALLSD to ALLSE (0.05; 0 with FACTOR: no limit)", bare="0.05"),
    Option(
        "CONTINUE",
        Kind.CHOICE,
        "factors of the step before",
        default="NO",
        choices=("NO",),
        refused=("YES",),
        bare="YES",
    ),
)

PROCEDURE = (
    Keyword(
        "STEP",
        "Begin a step.",
        Where.ANY,
        (
            Option("NAME", Kind.NAME, "name"),
            Option("INC", Kind.INTEGER, "largest number of increments (100)"),
            Option("NLGEOM", Kind.SWITCH, "large displacements, from this step on"),
            Option(
                "EXTRAPOLATION",
                Kind.CHOICE,
                "first guess of an increment",
                default="LINEAR",
                choices=("LINEAR", "PARABOLIC", "VELOCITY PARABOLIC", "NO"),
            ),
            Option("UNSYMM", Kind.SWITCH, "unsymmetric matrix storage and solution"),
            Option(
                "AMPLITUDE",
                Kind.CHOICE,
                "default time variation; RAMP unless given, STEP in transient procedures",
                choices=("RAMP", "STEP"),
            ),
            *ignored("CONVERT SDI", "SOLVER"),
            Option(
                "PERTURBATION",
                doc="a linear step about the last state: *STATIC, and *FREQUENCY and *STEADY STATE DYNAMICS always",
            ),
            *refused("DSA", "SUBDIVIDE"),
        ),
        "title",
    ),
    Keyword("END STEP", "End a step.", Where.STEP),
    Keyword(
        "STATIC",
        "Static stress analysis.",
        Where.STEP,
        (
            Option("DIRECT", doc="fixed increments"),
            Option("RIKS", doc="the load factor is part of the solution; increments are arc lengths"),
            *_STABILIZE,
            *refused("ADIABATIC", "FULLY PLASTIC", "LONG TERM"),
        ),
        "initial increment, period (1), smallest increment, largest increment; with RIKS also the largest load "
        "proportionality factor, and a node, its dof and the displacement that ends the step",
    ),
    Keyword(
        "VISCO",
        "Static stress analysis on a real time scale.",
        Where.STEP,
        (
            _DIRECT,
            *ignored("CETOL"),
            *refused("CREEP", "FACTOR", "STABILIZE", "ALLSDTOL", "CONTINUE"),
        ),
        _TIMES,
    ),
    Keyword(
        "FREQUENCY",
        "Natural frequencies about the state at the end of the last general step.",
        Where.STEP,
        (
            Option(
                "EIGENSOLVER", Kind.CHOICE, "how", default="LANCZOS", choices=("LANCZOS",), refused=("SUBSPACE", "AMS")
            ),
            Option(
                "NORMALIZATION",
                Kind.CHOICE,
                "of the shapes: largest displacement, or generalized mass, of one",
                default="DISPLACEMENT",
                choices=("DISPLACEMENT", "MASS"),
            ),
            *ignored("ACOUSTIC COUPLING", "NUMBER INTERVAL", "SIM"),
            *refused(
                *("BIAS", "DAMPING PROJECTION", "NSET", "PROPERTY EVALUATION", "RESIDUAL MODES", "USER BOUNDARY"),
                *("INTERNAL MODES", "TOL"),
            ),
        ),
        "number of eigenvalues, lowest and highest frequency (cycles per time)",
    ),
    Keyword(
        "STEADY STATE DYNAMICS",
        "Response to harmonic loads, about the state at the end of the last general step.",
        Where.STEP,
        (
            Option("DIRECT", doc="by the matrices of the model, not by its modes", required=True),
            Option(
                "FREQUENCY SCALE",
                Kind.CHOICE,
                "of the points of a range",
                default="LOGARITHMIC",
                choices=("LOGARITHMIC", "LINEAR"),
            ),
            Option(
                "INTERVAL",
                Kind.CHOICE,
                "what the points divide",
                default="RANGE",
                choices=("RANGE",),
                refused=("EIGENFREQUENCY", "SPREAD"),
            ),
            Option("REAL ONLY", doc="leave damping out"),
            *ignored("FRICTION DAMPING"),
            *refused("SUBSPACE PROJECTION", "DAMPING CHANGE", "STIFFNESS CHANGE"),
        ),
        "lowest and highest frequency (cycles per time; 0: the lowest alone), number of points (20), bias (1)",
    ),
    Keyword(
        "DYNAMIC",
        "Dynamic analysis by implicit integration.",
        Where.STEP,
        (
            _DIRECT,
            Option(
                "APPLICATION",
                Kind.CHOICE,
                "sets the integrator and the largest increment: 1/100, 1/10 and all of the period",
                default="TRANSIENT FIDELITY",
                choices=("TRANSIENT FIDELITY", "MODERATE DISSIPATION", "QUASI-STATIC"),
            ),
            Option(
                "TIME INTEGRATOR",
                Kind.CHOICE,
                "Hilber, Hughes and Taylor with alpha -0.05 or -0.41421, or backward Euler",
                choices=("HHT-TF", "HHT-MD", "BWE"),
            ),
            Option("ALPHA", Kind.REAL, "-0.5 to 0: numerical damping"),
            Option("BETA", Kind.REAL, "of the integrator, (1 - alpha)^2/4"),
            Option("GAMMA", Kind.REAL, "of the integrator, 1/2 - alpha"),
            Option("INITIAL", Kind.SWITCH, "compute accelerations at the start; YES for transient fidelity"),
            Option("HAFTOL", Kind.REAL, "tolerance of the half-increment residual, a force"),
            Option("HALFINC SCALE FACTOR", Kind.REAL, "the same over the time average force (10000)"),
            Option("NOHAF", doc="no half-increment residual"),
            *ignored("IMPACT", "INCREMENTATION"),
            *refused("ADIABATIC", "EXPLICIT", "SUBSPACE", "SINGULAR MASS", "NONLINEAR MODE"),
        ),
        _TIMES,
    ),
    Keyword(
        "HEAT TRANSFER",
        "Uncoupled heat transfer, for user elements with dof 11 and up.",
        Where.STEP,
        (*_HEAT, Option("END", Kind.CHOICE, "end of a transient step", choices=("PERIOD", "SS")), *refused("MXDEM")),
        _TIMES + "; rate of temperature change that ends a step with END=SS",
    ),
    Keyword(
        "COUPLED TEMPERATURE-DISPLACEMENT",
        "Temperatures and displacements together, for user elements with dof 11 and up, CPE4T, C3D8T and so on.",
        Where.STEP,
        (
            *_HEAT,
            *_STABILIZE,
            Option("CREEP", Kind.CHOICE, "no material here creeps: accepted and without effect", choices=("NONE",)),
            *ignored("CETOL"),
            *refused("ELECTRICAL"),
        ),
        _TIMES,
    ),
    Keyword(
        "SOLUTION TECHNIQUE",
        "Newton's method with the full matrix, whatever is asked for: .msg says so.",
        Where.STEP,
        (
            Option(
                "TYPE",
                Kind.CHOICE,
                "technique",
                default="QUASI-NEWTON",
                choices=("QUASI-NEWTON", "SEPARATED", "UNSYMMETRIC"),
            ),
            *ignored("REFORM KERNEL"),
        ),
        "ignored",
    ),
)

INITIAL = (
    Keyword(
        "INITIAL CONDITIONS",
        "Values at the start of the analysis.",
        Where.MODEL,
        (
            Option(
                "TYPE",
                Kind.CHOICE,
                "what is given; TEMPERATURE is for dof 11 and a predefined field",
                required=True,
                choices=("VELOCITY", "TEMPERATURE", "FIELD", "SOLUTION", "STRESS"),
                refused=(
                    *("ACOUSTIC STATIC PRESSURE", "CONCENTRATION", "HARDENING", "PLASTIC STRAIN"),
                    *("PORE PRESSURE", "RATIO", "REF COORDINATE", "ROTATING VELOCITY", "SATURATION"),
                    "SPECIFIC ENERGY",
                ),
            ),
            Option("INPUT", Kind.FILE, "file that holds the data lines"),
            Option("VARIABLE", Kind.INTEGER, "number of the field variable (1)"),
            Option("USER", doc="state variables by SDVINI, with TYPE=SOLUTION"),
            Option("GEOSTATIC", doc="stresses by elevation: refused, with TYPE=STRESS"),
            Option(
                "UNBALANCED STRESS",
                Kind.CHOICE,
                "what of initial stresses is not in equilibrium takes effect in the course of the first step (RAMP, "
                "the default) or at once",
                choices=("RAMP", "STEP"),
            ),
            *refused("FILE", "REBAR", "SECTION POINTS"),
        ),
        "node or set, dof, velocity; or node or set, temperatures of dofs 11, 12, ...; or node or set, value of field; "
        "or element or set, state variables; or element or set, stress components of a built-in continuum element (11, "
        "22, 33, 12, 13, 23; 11, 22, 12 in plane stress), in the directions of *ORIENTATION",
    ),
)
