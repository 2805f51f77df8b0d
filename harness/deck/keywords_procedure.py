# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table: *INITIAL CONDITIONS."""

from __future__ import annotations

from harness.deck.table import Keyword, Kind, Option, Where, one_of, refused

INITIAL = (
    Keyword(
        "INITIAL CONDITIONS",
        "Values at the start of the analysis.",
        Where.MODEL,
        (
            one_of(
                "TYPE",
                "what is given; TEMPERATURE is for dof 11 and a predefined field",
                ("VELOCITY", "TEMPERATURE", "FIELD", "SOLUTION", "STRESS"),
                required=True,
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
            one_of(
                "UNBALANCED STRESS",
                "what of initial stresses is not in equilibrium takes effect in the course of the first step (RAMP, "
                "the default) or at once",
                ("RAMP", "STEP"),
            ),
            *refused("FILE", "REBAR", "SECTION POINTS"),
        ),
        "node or set, dof, velocity; or node or set, temperatures of dofs 11, 12, ...; or node or set, value of field; "
        "or element or set, state variables; or element or set, stress components of a built-in continuum element (11, "
        "22, 33, 12, 13, 23; 11, 22, 12 in plane stress), in the directions of *ORIENTATION",
    ),
)
