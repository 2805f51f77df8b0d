# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table: what belongs to cohesive elements with traction-separation response."""

from __future__ import annotations

from harness.deck.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from harness.model.element_types import HOURGLASS_CONTROLLED

_CONTROLLED = ", ".join(HOURGLASS_CONTROLLED)

COHESIVE = (
    Keyword(
        "COHESIVE SECTION",
        "Section of cohesive elements.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "element set", required=True),
            Option("MATERIAL", Kind.NAME, "material", required=True),
            one_of("RESPONSE", "response", ("TRACTION SEPARATION",), required=True, refused=("CONTINUUM", "GASKET")),
            one_of(
                "THICKNESS",
                "constitutive thickness: of the data line or of the nodes",
                ("SPECIFIED", "GEOMETRY"),
                default="SPECIFIED",
            ),
            Option("CONTROLS", Kind.NAME, "section controls"),
            *refused("HALF", "ORIENTATION", "STACK DIRECTION", "SYMMETRIC"),
        ),
        "constitutive thickness (1), width out of the plane (1)",
    ),
    Keyword(
        "SECTION CONTROLS",
        f"Deletion, largest damage and viscosity of cohesive elements; hourglass control of {_CONTROLLED} "
        "and those with temperatures. STIFFNESS is that of *HOURGLASS STIFFNESS. ENHANCED is the assumed "
        "strain stabilization of Belytschko and Bindeman (1991, 1993), with which rectangles and bricks bend "
        "exactly; that Abaqus has the same numbers is inferred from its manual, which names the method, and a "
        "warning says so. It takes *ELASTIC, TYPE=ISOTROPIC that depends on nothing, and no axisymmetric elements.",
        Where.MODEL,
        (
            Option("NAME", Kind.NAME, "name", required=True),
            Option("ELEMENT DELETION", Kind.SWITCH, "delete failed elements, unless they are in compression (YES)"),
            Option("MAX DEGRADATION", Kind.REAL, "largest damage (1)"),
            Option("VISCOSITY", Kind.REAL, "relaxation time of the damage (0)"),
            one_of(
                "HOURGLASS",
                "hourglass control",
                ("STIFFNESS", "ENHANCED"),
                default="STIFFNESS",
                refused=("COMBINED", "RELAX STIFFNESS", "VISCOUS"),
            ),
            *ignored("DISTORTION CONTROL", "KINEMATIC SPLIT", "LENGTH RATIO", "SECOND ORDER ACCURACY"),
        ),
        "factor of the hourglass stiffness with STIFFNESS (1); factors of shells and of Abaqus/Explicit, not read",
    ),
)

DAMAGE = (
    Keyword(
        "DAMAGE INITIATION",
        "Onset of damage in a traction-separation response.",
        Where.MODEL,
        (
            one_of(
                "CRITERION",
                "criterion",
                ("MAXS", "QUADS", "MAXE", "QUADE"),
                required=True,
                refused=(
                    *(
                        "DUCTILE",
                        "FLD",
                        "FLSD",
                        "HASHIN",
                        "HASHIN-ROTEM",
                        "HYSTERESIS ENERGY",
                        "JOHNSON COOK",
                        "LARC05",
                    ),
                    *("MAXPE", "MAXPS", "MK", "MSFLD", "SHEAR", "USER"),
                ),
            ),
            *ignored("TOLERANCE"),
            *refused("ALPHA", "DEPENDENCIES", "NAME", "PROPERTIES"),
        ),
        "normal, first shear and second shear stress or strain at the onset",
    ),
    Keyword(
        "DAMAGE EVOLUTION",
        "Evolution of damage after its onset.",
        Where.MODEL,
        (
            one_of("TYPE", "what is given", ("DISPLACEMENT", "ENERGY"), required=True, refused=("HYSTERESIS ENERGY",)),
            one_of("SOFTENING", "softening", ("LINEAR", "EXPONENTIAL"), default="LINEAR", refused=("TABULAR",)),
            one_of("MIXED MODE BEHAVIOR", "fracture energy in mixed mode", ("BK", "POWER LAW"), refused=("TABULAR",)),
            one_of(
                "MODE MIX RATIO",
                "measure of the mode mix",
                ("ENERGY",),
                default="ENERGY",
                refused=("ACCUMULATED ENERGY", "TRACTION"),
            ),
            Option("POWER", Kind.REAL, "exponent of MIXED MODE BEHAVIOR"),
            *ignored("DEGRADATION"),
            *refused("DEPENDENCIES", "FAILURE INDEX"),
        ),
        "displacement from onset to failure, exponential law parameter; or fracture energy; or those of the normal, "
        "first shear and second shear mode",
    ),
    Keyword(
        "DAMAGE STABILIZATION",
        "Viscosity of the damage; that of the section controls goes first.",
        Where.MODEL,
        data="relaxation time of the damage",
    ),
)
