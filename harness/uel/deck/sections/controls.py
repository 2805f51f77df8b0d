# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SECTION CONTROLS: of cohesive elements, and of continuum elements with hourglass control."""

from __future__ import annotations

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.definitions import read_definitions
from uel.deck.language.table import NAME, Keyword, Kind, Option, Where, ignored, one_of
from uel.model.element_types import HOURGLASS_CONTROLLED
from uel.model.properties import SectionControls


def read_section_controls(blocks: list[Block], problems: Problems) -> dict[str, SectionControls]:
    """Read the section controls, by name."""
    return read_definitions(blocks, "SECTION CONTROLS", _read_controls, problems)


def _read_controls(block: Block) -> SectionControls:
    options = block.options
    degradation = options.real("MAX DEGRADATION", 1.0)
    if not 0 < degradation <= 1:
        raise block.error(f"MAX DEGRADATION={degradation:g}: expected a number above 0, up to 1")
    viscosity = options.real("VISCOSITY", 0.0) if options.has("VISCOSITY") else None
    if viscosity is not None and viscosity < 0:
        raise block.error(f"VISCOSITY={viscosity:g} must not be negative")
    deletion = options.flag("ELEMENT DELETION") or not options.has("ELEMENT DELETION")
    enhanced = options.text("HOURGLASS") == "ENHANCED" if options.has("HOURGLASS") else None
    row = next(block.rows(), None)
    # "any data given on the data line will be ignored" where it is enhanced (Abaqus Keywords Guide)
    factors = [1.0, 1.0]
    for k, name in enumerate(("", "rotational ")):
        if row is None or enhanced:
            break
        factors[k] = row.real(k, f"factor of the {name}hourglass stiffness", 1.0)
        if factors[k] <= 0:
            raise block.error(f"factor {factors[k]:g} of the {name}hourglass stiffness must be positive")
    return SectionControls(deletion, degradation, viscosity, enhanced, *factors)


KEYWORDS = (
    Keyword(
        "SECTION CONTROLS",
        "Deletion, largest damage and viscosity of cohesive elements; hourglass control of "
        f"{', '.join(HOURGLASS_CONTROLLED)} and those with temperatures. STIFFNESS is that of *HOURGLASS STIFFNESS. "
        "ENHANCED is the assumed strain stabilization of Belytschko and Bindeman (1991, 1993), with which rectangles "
        "and bricks bend exactly; that Abaqus has the same numbers is inferred from its manual, which names the "
        "method, and a warning says so. It needs *ELASTIC, TYPE=ISOTROPIC with constant values, *HYPERELASTIC, whose "
        "initial moduli it takes, or UMAT, of whose first DDSDDE it takes the isotropic part (not if it is "
        "incompressible). Axisymmetric elements have that of plane strain: the strain around the axis by hourglass "
        "displacements, of the order of the size over the radius, is left out. The hourglass modes of S4R have the "
        "stiffness of S4 with ENHANCED, those of SC8R always.",
        Where.MODEL,
        (
            NAME,
            Option("ELEMENT DELETION", Kind.SWITCH, "delete failed elements, unless they are in compression (YES)"),
            Option("MAX DEGRADATION", Kind.REAL, "largest damage (1)"),
            Option("VISCOSITY", Kind.REAL, "relaxation time of the damage (0)"),
            one_of(
                "HOURGLASS",
                "hourglass control; ENHANCED by default with *HYPERELASTIC by coefficients, else STIFFNESS",
                ("STIFFNESS", "ENHANCED"),
                refused=("COMBINED", "RELAX STIFFNESS", "VISCOUS"),
            ),
            *ignored("DISTORTION CONTROL", "KINEMATIC SPLIT", "LENGTH RATIO", "SECOND ORDER ACCURACY"),
        ),
        "factor of the hourglass stiffness with STIFFNESS (1), of that of rotations of S4R (1); others are not read",
    ),
)
