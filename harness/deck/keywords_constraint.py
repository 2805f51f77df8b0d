# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table: springs and masses, surfaces, and constraints between nodes."""

from __future__ import annotations

from harness.deck.table import Keyword, Kind, Option, Support, Where, ignored, one_of, refused
from harness.model.element_types import HOURGLASS_CONTROLLED

_ELSET = Option("ELSET", Kind.NAME, "element set", required=True)
_REF_NODE = Option("REF NODE", Kind.NAME, "reference node, or set of one node", required=True)
_INPUT = Option("INPUT", Kind.FILE, "file that holds the data lines")

DISCRETE = (
    Keyword(
        "SPRING",
        "Stiffness of SPRING1, SPRING2 and SPRINGA.",
        Where.MODEL,
        (
            _ELSET,
            Option("NONLINEAR", doc="force and elongation in place of the stiffness; constant outside the table"),
            *refused("COMPLEX STIFFNESS", "DEPENDENCIES", "ORIENTATION", "RTOL"),
        ),
        "dof at the first node, dof at the second (SPRING2), blank for SPRINGA; then stiffness, or force, elongation",
    ),
    Keyword("MASS", "Point masses.", Where.MODEL, (_ELSET, *refused("ALPHA", "ORIENTATION", "TYPE")), "mass"),
    Keyword(
        "HOURGLASS STIFFNESS",
        f"Hourglass stiffness parameter r of {', '.join(HOURGLASS_CONTROLLED)} and those with temperatures, "
        "of the *SOLID SECTION before. With mean gradients B and volume V before any displacement the stiffness per "
        "squared hourglass displacement q is r V sum(B^2)/16 in the plane, in direction i of space 0.2357 r V "
        "sum(B_i^2); with NLGEOM F^T q takes the place of q, F the mean deformation gradient. Results of Abaqus R2018x "
        "and 2024 show it for square CPS4R, skewed CAX4RT and skewed C3D8RT; for CPE4R and skewed CPS4R it is inferred "
        "from CAX4RT.",
        Where.MODEL,
        data="stiffness parameter in place of 0.005 times the shear modulus; further entries are not read",
    ),
)

CONSTRAINTS = (
    Keyword(
        "SURFACE",
        "Define a surface, of which constraints use the nodes.",
        Where.MODEL,
        (
            Option("NAME", Kind.NAME, "name", required=True),
            one_of(
                "TYPE",
                "what it is made of; constraints use ELEMENT and NODE",
                (
                    *("ELEMENT", "NODE", "CUTTING SURFACE", "CYLINDER", "EULERIAN MATERIAL", "REVOLUTION", "SEGMENTS"),
                    *("USER", "XFEM"),
                ),
                default="ELEMENT",
            ),
            *ignored("INTERNAL", "DEFINITION", "TRIM", "FILLET RADIUS", "COMBINE", "CROP", "NO OFFSET", "NO THICK"),
        ),
        "set or element, face (S1, S2, ...); or node set or node",
    ),
    Keyword(
        "MPC",
        "Multi-point constraints; the first node is eliminated. Sets stand for their nodes in order.",
        Where.MODEL,
        (_INPUT, *refused("MODE", "USER")),
        "TIE, PIN or BEAM and two nodes; or LINEAR and three",
    ),
    Keyword(
        "COUPLING",
        "Couple the nodes of a surface to a reference node, as *KINEMATIC after it says.",
        Where.MODEL,
        (
            Option("CONSTRAINT NAME", Kind.NAME, "name", required=True),
            _REF_NODE,
            Option("SURFACE", Kind.NAME, "surface", required=True),
            *refused("ALPHA", "INFLUENCE RADIUS", "ORIENTATION"),
        ),
    ),
    Keyword("KINEMATIC", "Dofs that *COUPLING couples.", Where.MODEL, data="first dof, last dof; none: all"),
    Keyword(
        "KINEMATIC COUPLING",
        "Couple nodes to a reference node.",
        Where.MODEL,
        (_REF_NODE, *refused("ORIENTATION")),
        "node or set, first dof, last dof",
    ),
    Keyword(
        "RIGID BODY",
        "Nodes that move with a reference node.",
        Where.MODEL,
        (
            _REF_NODE,
            Option("ELSET", Kind.NAME, "elements that are rigid"),
            Option("PIN NSET", Kind.NAME, "nodes whose displacements follow"),
            Option("TIE NSET", Kind.NAME, "nodes whose displacements and rotations follow"),
            *ignored("ISOTHERMAL"),
            *refused("ANALYTICAL SURFACE", "POSITION"),
        ),
    ),
    Keyword(
        "TIE",
        "Tie surfaces with matching nodes: all dofs of the first one follow the second.",
        Where.MODEL,
        (
            Option("NAME", Kind.NAME, "name", required=True),
            Option("POSITION TOLERANCE", Kind.REAL, "largest distance of nodes that are tied"),
            Option("NO ROTATION", doc="rotations stay free"),
            *ignored("ADJUST", "CONSTRAINT RATIO", "NO THICKNESS", "TYPE"),
            *refused("CYCLIC SYMMETRY", "TIED NSET"),
        ),
        "first (secondary) surface, second (main) surface",
    ),
    Keyword(
        "SURFACE INTERACTION",
        "Begin a contact property. Nothing uses one, since contact is refused: it is listed and left out.",
        Where.MODEL,
        (Option("NAME", Kind.NAME, "name", required=True), *ignored("DEPVAR", "PAD THICKNESS", "PROPERTIES")),
        "not read",
    ),
    *(
        Keyword(name, "Contact property, after *SURFACE INTERACTION.", Where.ANY, support=Support.IGNORED)
        for name in ("FRICTION", "SURFACE BEHAVIOR", "CONTACT DAMPING", "GAP CONDUCTANCE", "GAP HEAT GENERATION")
    ),
)
