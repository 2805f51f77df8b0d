# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sections for their element types: *SOLID SECTION, *COHESIVE SECTION, *SPRING and *MASS.

*UEL PROPERTY is in user_elements.py, *SHELL SECTION in shells.py, *MEMBRANE SECTION in membranes.py, *BEAM SECTION in
beams.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np

from uel.deck.error_report import Problems, look_up
from uel.deck.language.blocks import Block, Row
from uel.deck.language.definitions import named
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.sections.beams import BEAM_KEYWORDS, read_beam_section
from uel.deck.sections.membranes import MEMBRANE_KEYWORD, read_membrane_section
from uel.deck.sections.shells import MOST_POINTS, SHELL_KEYWORDS, read_shell_section
from uel.deck.sections.user_elements import LARGEST_DOF, ElementType, read_user_property
from uel.errors import DeckError
from uel.model.element_types import BEAM, DISCRETE, GENERALISED, LAYERED, DiscreteKind
from uel.model.properties import (
    CohesiveSection,
    CompositeSection,
    MassSection,
    Material,
    Orientation,
    RigidSection,
    Section,
    SectionControls,
    SolidLayer,
    SolidSection,
    SpringSection,
)


def make_section(
    block: Block,
    kind: ElementType,
    materials: Mapping[str, Material],
    orientations: Mapping[str, Orientation],
    controls: Mapping[str, SectionControls],
    problems: Problems,
) -> Section:
    """Make the section of a keyword for elements of a type. Raises DeckError if they do not match."""
    options = block.options
    elset = options.text("ELSET")
    alike = any({block.name, kind.section}.issubset(names) for names in (BEAM_KEYWORDS, SHELL_KEYWORDS))
    if block.name != kind.section and not alike:
        raise block.error(f"element set {elset} holds elements of type {kind.name}, which take *{kind.section}")
    if block.name in ("MASS", "RIGID BODY", "SPRING", "DASHPOT"):
        return _without_material(block, kind)
    if kind.name in BEAM:
        return read_beam_section(block, materials, BEAM[kind.name].dimension)
    if block.name in (*SHELL_KEYWORDS, MEMBRANE_KEYWORD):
        read = read_membrane_section if block.name == MEMBRANE_KEYWORD else read_shell_section
        return read(block, materials, orientations, _controls(block, controls))
    material = named(block, "MATERIAL", materials)
    if block.name == "COHESIVE SECTION":
        assert material is not None
        return _cohesive_section(block, material, controls)
    orientation = named(block, "ORIENTATION", orientations)
    if kind.definition:
        return read_user_property(block, kind.definition, material, orientation, problems)
    layers: tuple[SolidLayer, ...] = ()
    if _is_composite(block, kind):
        layers = _solid_layers(block, materials, orientations, orientation)
    return _solid_section(block, kind.name, material or layers, orientation, controls)


def _solid_section(
    block: Block,
    type: str,
    content: Material | tuple[SolidLayer, ...],
    orientation: Orientation | None,
    controls: Mapping[str, SectionControls],
) -> SolidSection | CompositeSection:
    """Make the section of solids from a material, or from layers. Raises DeckError."""
    elset, section_controls = block.options.text("ELSET"), _controls(block, controls)
    if isinstance(content, tuple):
        direction = int(block.options.text("STACK DIRECTION"))
        return CompositeSection(elset, content, direction, block.source, controls=section_controls)
    rows = list(block.rows())
    if type in GENERALISED:
        _check_planes(rows)
    thickness = _thickness(rows, 0, "thickness")
    return SolidSection(elset, content, orientation, thickness, block.source, controls=section_controls)


def _is_composite(block: Block, kind: ElementType) -> bool:
    """Return whether a solid section has layers. Raises DeckError unless it has either a material or layers."""
    composite = block.options.flag("COMPOSITE")
    if composite == block.options.has("MATERIAL"):
        raise block.error("expected either MATERIAL= or COMPOSITE, with the material of each layer on its line")
    if composite and kind.name not in LAYERED:
        types = ", ".join(LAYERED)
        raise block.error(f"COMPOSITE is not supported for elements of type {kind.name}; expected {types}")
    return composite


def _solid_layers(
    block: Block,
    materials: Mapping[str, Material],
    orientations: Mapping[str, Orientation],
    orientation: Orientation | None,
) -> tuple[SolidLayer, ...]:
    layers = [_solid_layer(block, row, materials, orientations, orientation) for row in block.rows()]
    if not layers:
        raise block.error("COMPOSITE needs a data line for each layer")
    if block.options.flag("SYMMETRIC"):
        layers += layers[::-1]
    return tuple(layers)


def _solid_layer(
    block: Block,
    row: Row,
    materials: Mapping[str, Material],
    orientations: Mapping[str, Orientation],
    of_section: Orientation | None,
) -> SolidLayer:
    # the fifth is the name of the layer
    row.at_most(5)
    thickness, points = row.positive(0, "thickness"), row.integer(1, "number of section points", 1)
    if not 1 <= points <= MOST_POINTS or points % 2 == 0:
        raise row.error(f"{points} section points: expected an odd number from 1 to {MOST_POINTS - 1}")
    material = look_up(materials, row.name(2, "material"), "material", row.source)
    if row.blank(3):
        return SolidLayer(thickness, points, material, of_section)
    try:
        angle = row.real(3, "orientation angle")
    except DeckError:
        of_layer = look_up(orientations, row.name(3, "orientation"), "orientation", row.source)
        return SolidLayer(thickness, points, material, of_layer)
    if of_section is None:
        raise row.error("an angle is measured from the ORIENTATION of the section, which is not given")
    return SolidLayer(thickness, points, material, of_section, angle)


def _without_material(block: Block, kind: ElementType) -> MassSection | RigidSection | SpringSection:
    elset = block.options.text("ELSET")
    if block.name == "RIGID BODY":
        return RigidSection(elset, block.source)
    return MassSection(elset, _mass(block), block.source) if block.name == "MASS" else _spring(block, kind)


def reference_node(block: Block, type: str, find: Callable[[str, str, Block], int]) -> int:
    """Return the index of the REF NODE of *SOLID SECTION, -1 for elements without.

    find: `FlatMesh.one_node` of the instance. Raises DeckError.
    """
    name = block.options.text("REF NODE")
    if name and type not in GENERALISED:
        message = f"REF NODE goes with elements in generalised plane strain ({', '.join(GENERALISED)})"
        raise block.error(f"{message}; element set {block.options.text('ELSET')} holds {type}")
    if not name:
        if type in GENERALISED:
            raise block.error(f"elements of type {type} need REF NODE")
        return -1
    return find(name, f"REF NODE={name}", block)


def _check_planes(rows: list[Row]) -> None:
    """Raise DeckError unless the bounding planes of generalised plane strain are parallel before any displacement."""
    for k, axis in enumerate("xy", start=1):
        if rows and rows[0].real(k, f"initial rotation about {axis}", 0.0):
            raise rows[0].error(f"an initial rotation of the bounding planes about {axis} is not supported; expected 0")


def _mass(block: Block) -> float:
    return block.required_rows("the mass")[0].not_negative(0, "mass")


def _spring(block: Block, kind: ElementType) -> SpringSection:
    """Read a line with the dofs, blank for SPRINGA and DASHPOTA, then the stiffness, or force and elongation.

    For dashpots: the damping coefficient, or force and velocity.
    """
    constant, variable = ("stiffness", "elongation") if block.name == "SPRING" else ("coefficient", "velocity")
    rows = list(block.all_rows())
    if len(rows) < 2:
        raise block.error(f"needs a line with dofs, blank for {block.name}A, and the {constant} on the next")
    # SPRINGA and DASHPOTA act along their line
    count = kind.nodes if DISCRETE[kind.name].kind in (DiscreteKind.SPRING, DiscreteKind.DASHPOT) else 0
    dofs = tuple(rows[0].integer(k, "dof") for k in range(count))
    if any(not 1 <= dof <= LARGEST_DOF for dof in dofs):
        raise rows[0].error(f"a dof is a number from 1 to {LARGEST_DOF}")
    table = [rows[1].real(0, constant)]
    if block.options.flag("NONLINEAR"):
        table = [row.real(k, quantity) for row in rows[1:] for k, quantity in enumerate(("force", variable))]
        if len(table) < 4 or any(later <= earlier for earlier, later in pairwise(table[1::2])):
            raise rows[1].error(f"NONLINEAR needs two or more lines of force and {variable}, which ascends")
    elif block.name == "DASHPOT":
        # dependence on frequency is not supported
        rows[1].at_most(1)
    return SpringSection(block.options.text("ELSET"), dofs, np.array(table), block.source)


def _thickness(rows: list[Row], index: int, quantity: str) -> float:
    """Read a field of the first data line; 1 if it is zero or missing. Raises DeckError if it is negative."""
    thickness = rows[0].real(index, quantity, 1.0) if rows else 1.0
    if thickness == 0:
        return 1.0
    if thickness < 0:
        raise rows[0].error(f"{quantity} {thickness:g} must be positive")
    return thickness


def _controls(block: Block, controls: Mapping[str, SectionControls]) -> SectionControls:
    """Return the section controls that CONTROLS= names; defaults without it. Raises DeckError."""
    name = block.options.text("CONTROLS")
    return look_up(controls, name, "section controls", block.source) if name else SectionControls()


def _cohesive_section(block: Block, material: Material, controls: Mapping[str, SectionControls]) -> CohesiveSection:
    options, rows = block.options, list(block.rows())
    geometry = options.text("THICKNESS") == "GEOMETRY"
    return CohesiveSection(
        options.text("ELSET"),
        material,
        thickness=0.0 if geometry else _thickness(rows, 0, "constitutive thickness"),
        width=_thickness(rows, 1, "out-of-plane width"),
        controls=_controls(block, controls),
        source=block.source,
    )


_ELSET = Option("ELSET", Kind.NAME, "element set", required=True)
_MATERIAL = Option("MATERIAL", Kind.NAME, "material", required=True)
_ORIENTATION = Option("ORIENTATION", Kind.NAME, "orientation of the material")
_CONTROLS = Option("CONTROLS", Kind.NAME, "section controls")

KEYWORDS = (
    Keyword(
        "SOLID SECTION",
        "Section of built-in continuum and heat transfer elements. Axisymmetric ones (CAX, DCAX) ignore the thickness: "
        "forces, masses and energies are those of the whole circumference. Elements in generalised plane strain (CPEG) "
        "lie between two rigid planes: dof 3 of the reference node is the change of the length of its fibre, dofs 4 "
        "and 5 are the relative rotations of the planes about x and y. Loads on their edges act on the initial "
        "thickness.",
        Where.MODEL,
        (
            _ELSET,
            Option("MATERIAL", Kind.NAME, "material"),
            Option(
                "COMPOSITE", doc="a data line for each layer, the first at face S6, S3, S1 of stack direction 1, 2, 3"
            ),
            _ORIENTATION,
            _CONTROLS,
            one_of(
                "STACK DIRECTION",
                "direction of parent coordinates along which layers follow each other; nothing without COMPOSITE",
                ("1", "2", "3"),
                default="3",
                refused=("ORIENTATION",),
            ),
            Option("SYMMETRIC", doc="the layers again, in reverse"),
            Option("REF NODE", Kind.NAME, "reference node of CPEG elements, or a set with this node alone"),
            *ignored("LAYUP"),
            *refused("ORDER"),
        ),
        "thickness (1), of CPEG elements the length of the fibre through the reference node; there then rotations of "
        "the bounding planes about x and y before any displacement, which must be 0; COMPOSITE: thickness over that of "
        "the other layers, section points (1), material, angle in degrees from ORIENTATION or the name of another "
        "orientation, name",
    ),
    Keyword(
        "COHESIVE SECTION",
        "Section of cohesive elements.",
        Where.MODEL,
        (
            _ELSET,
            _MATERIAL,
            one_of("RESPONSE", "response", ("TRACTION SEPARATION",), required=True, refused=("CONTINUUM", "GASKET")),
            one_of(
                "THICKNESS",
                "constitutive thickness: of the data line or of the nodes",
                ("SPECIFIED", "GEOMETRY"),
                default="SPECIFIED",
            ),
            _CONTROLS,
            *refused("HALF", "ORIENTATION", "STACK DIRECTION", "SYMMETRIC"),
        ),
        "constitutive thickness (1), width out of the plane (1)",
    ),
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
    Keyword(
        "DASHPOT",
        "Viscous forces of DASHPOT1, DASHPOT2 and DASHPOTA: in *DYNAMIC by the velocities, in static steps by the "
        "increment of the elongation over that of the time, in *STEADY STATE DYNAMICS, DIRECT or SUBSPACE PROJECTION "
        "by the damping matrix; none in other linear steps.",
        Where.MODEL,
        (
            _ELSET,
            Option("NONLINEAR", doc="force and velocity in place of the coefficient; constant outside the table"),
            *refused("DEPENDENCIES", "ORIENTATION", "RTOL"),
        ),
        "dof at the first node, dof at the second (DASHPOT2), blank for DASHPOTA; then force per velocity, or force, "
        "velocity",
    ),
    Keyword("MASS", "Point masses.", Where.MODEL, (_ELSET, *refused("ALPHA", "ORIENTATION", "TYPE")), "mass"),
)
SECTION_KEYWORDS = {
    "UEL PROPERTY",
    "RIGID BODY",
    *SHELL_KEYWORDS,
    MEMBRANE_KEYWORD,
    *BEAM_KEYWORDS,
    *(keyword.name for keyword in KEYWORDS),
}
