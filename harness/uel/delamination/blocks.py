# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword blocks of the decks: elements with their properties, and the step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from uel.delamination.kernels import uel_property, user_element
from uel.delamination.keywords import keyword, number, table, wrapped
from uel.delamination.materials import Cohesive, Ply
from uel.delamination.mesh import TwoArmMesh

BY_EQUATION_21 = -2.0
"""BETAN and BETAT that ask for equation (21), with (22) for the weights, as the paper has them."""


@dataclass(frozen=True, slots=True)
class Interface:
    """Interface elements of a deck.

    type       'U2' standard, 'U3' consistent or paper's with four nodes, 'U4' with eight, 'COH2D4' of Abaqus; in 3D
               'U7' standard, 'U8' consistent or paper's, 'COH3D8' of Abaqus
    cohesive   parameters of the law
    beta       stabilisation parameter beta_n = beta_tau (N/mm^3); 0: from the local eigenvalue problem, in U3 and
               U10 from equation (21), like BY_EQUATION_21
    weight     of the bulk stress below; 0 computes it by equation (22), with the estimate of beta
    viscosity  relaxation time of the damage, in step time
    sampling   of the bulk stress: 0 middle of the face, 1 face, 2 Gauss point
    consistent law evaluated at the separation (CLOSURE 3, in U3 and U10 1) instead of the displacement jump (CLOSURE 2)
    law        1 linear criterion (11), 2 criterion of Benzeggagh and Kenane with the exponent `eta`, or the power law
    power      exponent of the power law, where `eta` is 0; 0: 1, the linear criterion
    newton_cotes  integration points at the nodes instead of Gauss points
    secant     AMATRX without the derivative of the damage (TANGENT 1), equation (24)
    blend      weight of that matrix in AMATRX
    further    other properties by name

    COH2D4 and COH3D8 are built in: they have the law of `law` 1 or 2, integrate by Newton-Cotes, and ignore beta,
    weight, sampling, consistent, newton_cotes, secant and blend.
    """

    type: str
    cohesive: Cohesive
    beta: float = 0.0
    weight: float = 0.0
    viscosity: float = 0.0
    sampling: int = 0
    consistent: bool = True
    law: int = 1
    eta: float = 0.0
    power: float = 0.0
    newton_cotes: bool = False
    secant: bool = False
    blend: float = 0.0
    further: Mapping[str, float] = field(default_factory=dict, hash=False)

    @property
    def closure(self) -> int:
        """CLOSURE: the paper's 2, the complete form 3, and 1 in U3 and U10, which do not have it."""
        if not self.consistent:
            return 2
        return 1 if self.type in ("U3", "U10") else 3

    @property
    def built_in(self) -> bool:
        """True for an element of Abaqus."""
        return self.type.startswith("COH")

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return 8 if self.type == "U4" else 4


@dataclass(frozen=True, slots=True)
class Specimen:
    """The elements of a deck.

    name    prefix of the mesh files
    quads   'U1', or 'CPS4' for the built-in quads of plane stress
    width   thickness out of the plane (mm)
    bottom, top  plies of the two arms
    """

    name: str
    mesh: TwoArmMesh
    interface: Interface
    width: float
    bottom: Ply
    top: Ply
    quads: str = "U1"


def element_blocks(specimen: Specimen) -> list[str]:
    """Write *USER ELEMENT, *ELEMENT and the properties of quads and interface elements."""
    return [*_quad_elements(specimen), *_quad_properties(specimen), *_materials(specimen), *_interface(specimen)]


def _quad_elements(specimen: Specimen) -> list[str]:
    lines = ["** continuum: two arms of quads"]
    if specimen.quads == "U1":
        lines += user_element(1, INTEGRATION=4, TENSOR="PSTRESS")
    lines.append(keyword("ELEMENT", TYPE=specimen.quads, ELSET="QUADS", INPUT=f"{specimen.name}_quads.inp"))
    for name, first, last, _, _ in _quad_sets(specimen):
        mesh = specimen.mesh
        lines.append(keyword("ELSET", "GENERATE", ELSET=name))
        lines += table((row * mesh.stride + 1, row * mesh.stride + mesh.columns, 1) for row in range(first, last + 1))
    return lines


def _quad_sets(specimen: Specimen) -> list[tuple[str, int, int, int, Ply]]:
    """List the sets of quads: name, first and last row, the face along the interface (for U3), ply."""
    below, above = specimen.mesh.rows
    bottom, top = specimen.bottom, specimen.top
    if specimen.interface.type != "U3":
        return [("BOTTOM", 1, below, 0, bottom), ("TOP", below + 1, below + above, 0, top)]
    return [
        ("BOTTOM", 1, below - 1, 0, bottom),
        ("BOTTOM_FACE", below, below, 3, bottom),
        ("TOP_FACE", below + 1, below + 1, 1, top),
        ("TOP", below + 2, below + above, 0, top),
    ]


def _quad_properties(specimen: Specimen) -> list[str]:
    lines = []
    for name, _, _, face, ply in _quad_sets(specimen):
        if specimen.quads == "U1":
            values = {"THICKNESS": specimen.width, "PLANE": 0, "FACE": face}
            lines += uel_property(1, name, values, MATERIAL=ply.name)
        else:
            lines += [keyword("SOLID SECTION", ELSET=name, MATERIAL=ply.name), *wrapped([specimen.width])]
    return lines


def _materials(specimen: Specimen) -> list[str]:
    lines = ["** E1, E2, nu12, G12, G13, G23 (MPa)"]
    for ply in {ply.name: ply for ply in (specimen.bottom, specimen.top)}.values():
        lines += [keyword("MATERIAL", NAME=ply.name), "*ELASTIC, TYPE=LAMINA", *wrapped(ply.lamina)]
    return lines


_TITLES = {
    2: "standard elements",
    3: "elements with four nodes",
    4: "elements with eight nodes: those of the quad below, then those of the quad above",
}


def _interface(specimen: Specimen) -> list[str]:
    interface = specimen.interface
    mesh_file = f"{specimen.name}_interface{interface.nodes}.inp"
    elements = keyword("ELEMENT", TYPE=interface.type, ELSET="INTERFACE", INPUT=mesh_file)
    if interface.built_in:
        return ["** interface: cohesive elements of Abaqus", elements, *cohesive_section(interface, specimen.width)]
    jtype = int(interface.type[1:])
    variant = "" if jtype == 2 else "consistent " if interface.consistent else "paper's "
    return [
        f"** interface: {variant}{_TITLES[jtype]}",
        *user_element(jtype),
        elements,
        *uel_property(jtype, "INTERFACE", interface_values(specimen)),
    ]


def cohesive_section(interface: Interface, width: float | None = None) -> list[str]:
    """Write *COHESIVE SECTION of the set INTERFACE with its material; width: out of plane (mm), None in 3D."""
    return [*traction_section("INTERFACE", "INTERFACE", width), *traction_material("INTERFACE", interface)]


def traction_section(elset: str, material: str, width: float | None = None) -> list[str]:
    """Write *COHESIVE SECTION of an element set, with *SECTION CONTROLS named like its material."""
    section = {"CONTROLS": material, "ELSET": elset, "MATERIAL": material}
    return [
        "** constitutive thickness" + (", width" if width else ""),
        keyword("COHESIVE SECTION", **section, RESPONSE="TRACTION SEPARATION"),
        *wrapped([1.0, width] if width else [1.0]),
    ]


def traction_material(name: str, interface: Interface) -> list[str]:
    """Write *SECTION CONTROLS and *MATERIAL: the law of the user elements in Abaqus keywords.

    With these controls failed elements resist compression, like the user elements.
    """
    law = interface.cohesive
    mixed = ("BK", interface.eta) if interface.eta else ("POWER LAW", interface.power or 1.0)
    evolution = {"TYPE": "ENERGY", "SOFTENING": "LINEAR", "MIXED_MODE_BEHAVIOR": mixed[0], "POWER": number(mixed[1])}
    settings = {"NAME": name, "ELEMENT_DELETION": "NO", "MAX_DEGRADATION": "1."}
    if interface.viscosity:
        settings["VISCOSITY"] = number(interface.viscosity)
    return [
        keyword("SECTION CONTROLS", **settings),
        keyword("MATERIAL", NAME=name),
        "** normal, first and second shear direction: stiffness, strength, fracture energy",
        keyword("ELASTIC", TYPE="TRACTION"),
        *wrapped([law.stiffness_normal, law.stiffness_shear, law.stiffness_shear]),
        keyword("DAMAGE INITIATION", CRITERION="QUADS"),
        *wrapped([law.strength_normal, law.strength_shear, law.strength_shear]),
        keyword("DAMAGE EVOLUTION", **evolution),
        *wrapped([law.toughness_1, law.toughness_2, law.toughness_2]),
    ]


def bending_section(elset: str, material: str, modulus: float) -> list[str]:
    """Write a CPS4R section with exact bending, 1 mm wide; material with a modulus (MPa) and nu = 0."""
    return [
        "*SECTION CONTROLS, NAME=BENDING, HOURGLASS=ENHANCED",
        keyword("SOLID SECTION", ELSET=elset, MATERIAL=material, CONTROLS="BENDING"),
        "1.",
        keyword("MATERIAL", NAME=material),
        "*ELASTIC",
        f"{number(modulus)}, 0.",
    ]


def law_values(interface: Interface) -> dict[str, float]:
    """Return the properties of the interface elements that do not depend on the specimen, by name."""
    law = interface.cohesive
    return {
        "ALPHAN": law.stiffness_normal,
        "ALPHAT": law.stiffness_shear,
        "SIGMAMAX": law.strength_normal,
        "TAUMAX": law.strength_shear,
        "GIC": law.toughness_1,
        "GIIC": law.toughness_2,
        "VISCOSITY": interface.viscosity,
        "ETA": interface.eta,
        "POWER": interface.power,
        "BLEND": interface.blend,
        "BETAN": interface.beta,
        "BETAT": interface.beta,
        "GAMMABOT": interface.weight,
        "LAW": interface.law,
        "INTEGRATION": int(interface.newton_cotes),
        "TANGENT": int(interface.secant),
        "SAMPLING": interface.sampling,
        "CLOSURE": interface.closure,
        **interface.further,
    }


def interface_values(specimen: Specimen) -> dict[str, float]:
    """Return the properties of the interface elements by name."""
    below, above = specimen.mesh.offsets
    values = law_values(specimen.interface)
    values |= {"THICKNESS": specimen.width, "OFFSETBOTTOM": below, "OFFSETTOP": above, "PLANE": 0}
    for side, ply in (("BOTTOM", specimen.bottom), ("TOP", specimen.top)):
        named = zip(("E1", "E2", "NU12", "G12"), ply.in_plane, strict=True)
        values |= {f"{constant} {side}": value for constant, value in named}
        # plane stress needs no constants along the third axis; the ply's axes are those of the deck
        values |= {f"{constant} {side}": 0.0 for constant in ("E3", "NU13", "NU23", "ANGLE")}
    return values
