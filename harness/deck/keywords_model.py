# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword table, first half: model data."""

from __future__ import annotations

from harness.deck.keywords_cohesive import COHESIVE, DAMAGE
from harness.deck.keywords_constraint import CONSTRAINTS, DISCRETE
from harness.deck.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from harness.model.element_types import BUILT_IN

INPUT = Option("INPUT", Kind.FILE, "file that holds the data lines")
NAME = Option("NAME", Kind.NAME, "name", required=True)

STRUCTURE = (
    Keyword("HEADING", "Title of the job.", Where.ANY, (*ignored("SPARSE", "UNSYMM"),), "free text"),
    Keyword(
        "INCLUDE",
        "Read another file in this place: sought beside the deck, then beside the including file.",
        Where.ANY,
        (Option("INPUT", Kind.FILE, "file", required=True), *refused("PASSWORD")),
    ),
    Keyword(
        "PARAMETER",
        "Define parameters; <name> on any later line stands for the value.",
        Where.ANY,
        (*ignored("INDEPENDENT"), *refused("DEPENDENT", "TABLE")),
        "name = arithmetic expression in Python's spelling",
    ),
    Keyword("PART", "Begin a part.", Where.MODEL, (NAME,)),
    Keyword("END PART", "End a part.", Where.MODEL),
    Keyword("ASSEMBLY", "Begin the assembly.", Where.MODEL, (NAME,)),
    Keyword("END ASSEMBLY", "End the assembly.", Where.MODEL),
    Keyword(
        "INSTANCE",
        "Place a part in the assembly; may hold nodes, elements and sets of its own.",
        Where.MODEL,
        (NAME, Option("PART", Kind.NAME, "part", required=True), *refused("INSTANCE", "LIBRARY")),
        "translation; then two points of an axis and an angle in degrees (rotation follows translation)",
    ),
    Keyword("END INSTANCE", "End an instance.", Where.MODEL),
)

MESH = (
    Keyword(
        "NODE",
        "Define nodes by coordinates.",
        Where.MODEL,
        (
            Option("NSET", Kind.NAME, "set that takes the nodes"),
            one_of("SYSTEM", "R: rectangular", ("R",), refused=("C", "S")),
            INPUT,
        ),
        "node, x, y, z",
    ),
    Keyword(
        "SYSTEM",
        "Rectangular system in which the nodes that follow are given; without data lines the global one.",
        Where.MODEL,
        data="origin, point on the local x-axis; then a point of the local x-y plane",
    ),
    Keyword(
        "ELEMENT",
        "Define elements by their nodes.",
        Where.MODEL,
        (
            Option("TYPE", Kind.NAME, f"Un; or built in: {', '.join(BUILT_IN)}", required=True),
            Option("ELSET", Kind.NAME, "set that takes the elements"),
            INPUT,
            *refused("FILE", "OFFSET", "SOLID ELEMENT NUMBERING"),
        ),
        "element, nodes; continued on further lines where a line ends before the last node",
    ),
    Keyword(
        "NSET",
        "Define or extend a node set.",
        Where.MODEL,
        (
            Option("NSET", Kind.NAME, "set", required=True),
            Option("GENERATE", doc="data lines are first, last, increment"),
            Option("ELSET", Kind.NAME, "take the nodes of these elements"),
            Option("INSTANCE", Kind.NAME, "instance the labels belong to"),
            Option("UNSORTED", doc="keep the order, which counts in *EQUATION"),
            INPUT,
            *ignored("INTERNAL"),
        ),
        "nodes and node sets",
    ),
    Keyword(
        "ELSET",
        "Define or extend an element set.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "set", required=True),
            Option("GENERATE", doc="data lines are first, last, increment"),
            Option("INSTANCE", Kind.NAME, "instance the labels belong to"),
            INPUT,
            *ignored("INTERNAL", "UNSORTED"),
        ),
        "elements and element sets",
    ),
    Keyword(
        "NGEN",
        "Generate nodes on a line between two nodes.",
        Where.MODEL,
        (
            Option("NSET", Kind.NAME, "set that takes the nodes"),
            one_of("LINE", "shape of the line", ("S",), refused=("C", "P")),
            *refused("SYSTEM"),
        ),
        "first node, last node, increment",
    ),
    Keyword(
        "NFILL",
        "Fill the region between two node sets with lines of nodes.",
        Where.MODEL,
        (Option("NSET", Kind.NAME, "set that takes the nodes"), *refused("BIAS", "SINGULAR", "TWO STEP")),
        "first set, second set, number of intervals, increment of node numbers",
    ),
    Keyword(
        "NCOPY",
        "Copy a node set.",
        Where.MODEL,
        (
            Option("CHANGE NUMBER", Kind.INTEGER, "added to the node numbers", required=True),
            Option("OLD SET", Kind.NAME, "set to copy", required=True),
            Option("NEW SET", Kind.NAME, "set that takes the copies"),
            Option("SHIFT", doc="translate and rotate the copies", required=True),
            *refused("MULTIPLE", "POLE", "REFLECT"),
        ),
        "translation; then two points of an axis and an angle in degrees",
    ),
    Keyword(
        "ELGEN",
        "Generate elements from a master element, in rows, rows of rows and layers.",
        Where.MODEL,
        (Option("ELSET", Kind.NAME, "set that takes the elements"), *refused("ALL NODES")),
        "master element, then count, node increment, element increment of each direction",
    ),
    Keyword(
        "EQUATION",
        "Linear constraint between dofs; the first term is eliminated. A set stands for its nodes in order.",
        Where.MODEL,
        (INPUT,),
        "number of terms; then node or set, dof, coefficient of each term",
    ),
)

PROPERTIES = (
    Keyword(
        "USER ELEMENT",
        "Introduce a user element type.",
        Where.MODEL,
        (
            Option("TYPE", Kind.NAME, "Un, 0 < n < 10000", required=True),
            Option("NODES", Kind.INTEGER, "nodes per element", required=True),
            Option("COORDINATES", Kind.INTEGER, "largest coordinate used (1)"),
            Option("PROPERTIES", Kind.INTEGER, "number of real properties (0)"),
            Option("I PROPERTIES", Kind.INTEGER, "number of integer properties (0)"),
            Option("VARIABLES", Kind.INTEGER, "number of solution-dependent variables (1)"),
            Option("UNSYMM", doc="the matrix is unsymmetric"),
            Option("INTEGRATION", Kind.INTEGER, "material points, with UELMAT"),
            one_of("TENSOR", "tensors, with UELMAT", ("THREED", "TWOD", "PSTRAIN", "PSTRESS")),
            *refused("LINEAR", "FILE", "OLD ELEMENT", "STEP"),
        ),
        "dofs at the first node; then node position, dofs from that node on",
    ),
    Keyword(
        "UEL PROPERTY",
        "Properties of user elements; with MATERIAL=, UELMAT is called.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "element set", required=True),
            Option("MATERIAL", Kind.NAME, "material for MATERIAL_LIB_MECH"),
            Option("ORIENTATION", Kind.NAME, "orientation of the material"),
            *refused("ALPHA", "BETA"),
        ),
        "real properties, then integer properties, eight to a line; what a line leaves out is zero",
    ),
    Keyword(
        "SOLID SECTION",
        "Section of built-in continuum elements. Axisymmetric ones (CAX) take no notice of the thickness: forces, "
        "masses and energies are those of the whole circumference.",
        Where.MODEL,
        (
            Option("ELSET", Kind.NAME, "element set", required=True),
            Option("MATERIAL", Kind.NAME, "material", required=True),
            Option("ORIENTATION", Kind.NAME, "orientation of the material"),
            Option("CONTROLS", Kind.NAME, "section controls"),
            *refused("COMPOSITE", "LAYUP", "ORDER", "REF NODE", "STACK DIRECTION", "SYMMETRIC"),
        ),
        "thickness (1)",
    ),
    *COHESIVE,
    Keyword(
        "MATERIAL",
        "Begin a material.",
        Where.MODEL,
        (NAME, *refused("RTOL", "SRATE FACTOR", "STRAIN RATE REGULARIZATION")),
    ),
    Keyword(
        "ELASTIC",
        "Linear elasticity.",
        Where.MODEL,
        (
            one_of(
                "TYPE",
                "symmetry",
                ("ISOTROPIC", "ENGINEERING CONSTANTS", "LAMINA", "ORTHOTROPIC", "ANISOTROPIC", "TRACTION"),
                default="ISOTROPIC",
                refused=("COUPLED TRACTION", "SHEAR", "SHORT FIBER", "BILAMINA"),
            ),
            Option("DEPENDENCIES", Kind.INTEGER, "number of field variables"),
            *ignored("MODULI"),
            *refused("COMPRESSION FACTOR"),
        ),
        "constants in the order of the type; those of continuum elements may depend on temperature and fields, "
        "which follow, eight values to a line",
    ),
    Keyword(
        "PLASTIC",
        "Mises plasticity with isotropic hardening.",
        Where.MODEL,
        (
            one_of(
                "HARDENING",
                "hardening",
                ("ISOTROPIC",),
                default="ISOTROPIC",
                refused=("KINEMATIC", "COMBINED", "JOHNSON COOK", "USER"),
            ),
            *refused("DATA TYPE", "DEPENDENCIES", "NUMBER BACKSTRESSES", "PROPERTIES", "RATE", "SCALESTRESS"),
        ),
        "yield stress, plastic strain",
    ),
    Keyword(
        "USER MATERIAL",
        "Material of UMAT. RPL, DRPLDT, DRPLDE and DDSDDT count in coupled temperature-displacement elements.",
        Where.MODEL,
        (
            Option("CONSTANTS", Kind.INTEGER, "number of constants", required=True),
            Option("UNSYMM", doc="DDSDDE is unsymmetric"),
            one_of("TYPE", "what the user routine gives", ("MECHANICAL",), refused=("THERMAL",)),
            *refused("HYBRID FORMULATION"),
        ),
        "constants, eight to a line; what a line leaves out is zero",
    ),
    Keyword(
        "DEPVAR",
        "Number of state variables (STATEV) of a material point.",
        Where.MODEL,
        (*ignored("DELETE"),),
        "number of variables; then number, name, description of variables, which are not read",
    ),
    Keyword("USER DEFINED FIELD", "USDFLD gives the field variables of continuum elements.", Where.MODEL),
    Keyword(
        "USER OUTPUT VARIABLES",
        "Number of variables that UVARM gives at a material point.",
        Where.MODEL,
        data="number of variables",
    ),
    *DAMAGE,
    Keyword("DENSITY", "Mass density.", Where.MODEL, refused("DEPENDENCIES", "PORE FLUID"), "density"),
    Keyword(
        "CONDUCTIVITY",
        "Thermal conductivity.",
        Where.MODEL,
        (one_of("TYPE", "symmetry", ("ISO",), refused=("ORTHO", "ANISO")), *refused("DEPENDENCIES", "PORE FLUID")),
        "conductivity",
    ),
    Keyword(
        "EXPANSION",
        "Thermal expansion from the initial temperature on (*INITIAL CONDITIONS, *TEMPERATURE), of continuum elements "
        "without temperatures of their own.",
        Where.MODEL,
        (
            one_of("TYPE", "symmetry", ("ISO",), refused=("ORTHO", "ANISO")),
            *refused("DEPENDENCIES", "FIELD", "PORE FLUID", "USER", "ZERO"),
        ),
        "expansion coefficient",
    ),
    Keyword("SPECIFIC HEAT", "Specific heat.", Where.MODEL, refused("DEPENDENCIES", "PORE FLUID"), "specific heat"),
    Keyword(
        "ORIENTATION",
        "Local rectangular axes from three points, with an additional rotation.",
        Where.MODEL,
        (
            NAME,
            one_of("DEFINITION", "how the points are given", ("COORDINATES",), refused=("NODES", "OFFSET TO NODES")),
            one_of(
                "SYSTEM",
                "kind of axes",
                ("RECTANGULAR",),
                refused=("CYLINDRICAL", "SPHERICAL", "USER", "Z RECTANGULAR"),
            ),
            *refused("LOCAL DIRECTIONS"),
        ),
        "a (on the 1-axis), b (in the 1-2 plane), c (origin); then axis number and angle in degrees",
    ),
    Keyword(
        "AMPLITUDE",
        "Factor of loads and prescribed values over time.",
        Where.ANY,
        (
            NAME,
            one_of(
                "DEFINITION",
                "kind of curve",
                ("TABULAR", "EQUALLY SPACED", "SMOOTH STEP", "PERIODIC", "DECAY", "USER"),
                default="TABULAR",
                refused=(
                    *("ACTUATOR", "BUBBLE", "FILM", "MODULATED", "PSD DEFINITION", "RAMP"),
                    *("SOLUTION DEPENDENT", "SPECTRUM"),
                ),
            ),
            one_of("TIME", "which time", ("STEP TIME", "TOTAL TIME"), default="STEP TIME", refused=("NORMALIZED",)),
            one_of("VALUE", "what the values are", ("RELATIVE", "ABSOLUTE"), default="RELATIVE"),
            Option("INPUT", Kind.FILE, "file that holds the data lines"),
            Option("PROPERTIES", Kind.INTEGER, "number of properties that UAMP gets (0), with DEFINITION=USER"),
            Option("VARIABLES", Kind.INTEGER, "number of state variables of UAMP (1), with DEFINITION=USER"),
            Option("FIXED INTERVAL", Kind.REAL, "time between values, with DEFINITION=EQUALLY SPACED"),
            Option("BEGIN", Kind.REAL, "time of the first value (0), with DEFINITION=EQUALLY SPACED"),
            *refused("SMOOTH", "SHIFTX", "SHIFTY", "SCALEX", "SCALEY"),
        ),
        "TABULAR, SMOOTH STEP: time, value pairs; PERIODIC: number of terms, omega, t0, A0; A1, B1, A2, B2 and so on; "
        "DECAY: A0, A, t0, td; EQUALLY SPACED: values; USER: properties",
    ),
)

MODEL_KEYWORDS = (*STRUCTURE, *MESH, *PROPERTIES, *DISCRETE, *CONSTRAINTS)
