# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HYPERELASTIC, by coefficients or by UHYPER, and *ANISOTROPIC HYPERELASTIC."""

from __future__ import annotations

from dataclasses import replace

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.materials.user_constants import read_constants
from uel.deck.sections.user_elements import read_count
from uel.model.properties import HIGHEST_ORDER, Holzapfel, Hyperelastic, Potential, UserPotential

MOST_FIBRES = 3
"""Preferred directions of a material."""

FIXED_ORDER = {Potential.ARRUDA_BOYCE: 1, Potential.MOONEY_RIVLIN: 1, Potential.NEO_HOOKE: 1, Potential.YEOH: 3}


def read_isotropic(block: Block, problems: Problems) -> Hyperelastic | UserPotential:
    """Read *HYPERELASTIC: the coefficients in the order of the data line, or the constants of UHYPER.
    Raises DeckError.
    """
    potentials = [potential for potential in Potential if block.options.flag(potential.value)]
    named = [*potentials, *(["USER"] if block.options.flag("USER") else [])]
    if len(named) > 1:
        raise block.error(f"{' and '.join(named)}: expected one strain energy potential")
    if named == ["USER"]:
        return _read_user(block, problems)
    if other := next((name for name in ("TYPE", "PROPERTIES") if block.options.has(name)), ""):
        raise block.error(f"{other}: expected with USER only")
    potential = potentials[0] if potentials else Potential.POLYNOMIAL
    order = block.options.integer("N", FIXED_ORDER.get(potential, 1))
    if order != FIXED_ORDER.get(potential, order):
        raise block.error(f"N={order}: {potential} has N={FIXED_ORDER[potential]}")
    if not 1 <= order <= HIGHEST_ORDER:
        raise block.error(f"N={order}: expected a number from 1 to {HIGHEST_ORDER}")
    count = _coefficients(potential, order)
    block.required_rows("the coefficients")
    values = [row.real(index, "coefficient", 0.0) for row, index in block.entries(problems.warn)]
    if len(values) > count + order + 1:
        raise block.dependent(f"{len(values)} values, but {potential}, N={order} has {count + order}")
    # missing entries are zero; a temperature after a single set of coefficients is ignored
    values += [0.0] * (count + order - len(values))
    return Hyperelastic(
        potential,
        order,
        tuple(values[:count]),
        tuple(values[count : count + order]),
        block.source,
        block.options.text("MODULI") == "INSTANTANEOUS",
    )


def read_anisotropic(block: Block, problems: Problems) -> Holzapfel | UserPotential:
    """Read *ANISOTROPIC HYPERELASTIC: its coefficients, or the constants of UANISOHYPER_INV. Raises DeckError."""
    directions = read_count(block, "LOCAL DIRECTIONS", 0, 0, MOST_FIBRES)
    by_user = block.options.flag("USER")
    if by_user == block.options.flag("HOLZAPFEL"):
        raise block.error("expected either HOLZAPFEL or USER")
    if by_user:
        if not block.options.has("FORMULATION"):
            raise block.error("USER needs FORMULATION=INVARIANT")
        return replace(_read_user(block, problems), directions=directions)
    if other := next((name for name in ("TYPE", "PROPERTIES", "FORMULATION") if block.options.has(name)), ""):
        raise block.error(f"{other}: expected with USER only")
    if not directions:
        raise block.error("HOLZAPFEL needs LOCAL DIRECTIONS, the number of fiber families")
    values = [row.real(index, "coefficient", 0.0) for row, index in block.entries(problems.warn)]
    if not 1 <= len(values) <= 6:
        raise block.dependent(f"{len(values)} values, expected C10, D, k1, k2, kappa")
    c10, d, k1, k2, kappa = (*values, 0.0, 0.0, 0.0, 0.0)[:5]
    for name, value in (("D", d), ("k1", k1), ("k2", k2)):
        if value < 0:
            raise block.error(f"{name} = {value:g} must not be negative")
    if c10 <= 0:
        raise block.error(f"C10 = {c10:g} must be positive")
    if not 0 <= kappa <= 1 / 3:
        raise block.error(f"kappa = {kappa:g} must be from 0 to 1/3")
    return Holzapfel((c10, d, k1, k2, kappa), directions, block.source)


def _read_user(block: Block, problems: Problems) -> UserPotential:
    incompressible = block.options.text("TYPE") != "COMPRESSIBLE"
    return UserPotential(read_constants(block, "PROPERTIES", problems), block.source, incompressible)


def _coefficients(potential: Potential, order: int) -> int:
    """Return the number of coefficients of the deviatoric part."""
    match potential:
        case Potential.POLYNOMIAL:
            return order * (order + 3) // 2
        case Potential.OGDEN:
            return 2 * order
        case Potential.ARRUDA_BOYCE | Potential.MOONEY_RIVLIN:
            return 2
        case _:
            return order


KEYWORDS = (
    Keyword(
        "HYPERELASTIC",
        "Isotropic hyperelasticity by coefficients or UHYPER, of plane strain, axisymmetric and solid elements "
        "in steps with NLGEOM; hybrid elements have neither temperatures nor incompatible modes with it. "
        "Incompressible materials, with D = 0 or USER without TYPE=COMPRESSIBLE, need hybrid elements; a term with"
        " a later D of zero is left out. One-point elements have *SECTION CONTROLS, HOURGLASS=ENHANCED by default;"
        " with USER they need *HOURGLASS STIFFNESS.",
        Where.MODEL,
        (
            Option("ARRUDA-BOYCE", doc="strain energy potential of Arruda and Boyce"),
            Option("MOONEY-RIVLIN", doc="polynomial with N=1"),
            Option("NEO HOOKE", doc="reduced polynomial with N=1"),
            Option("OGDEN", doc="strain energy potential of Ogden"),
            Option("POLYNOMIAL", doc="polynomial of both invariants, which is the default"),
            Option("REDUCED POLYNOMIAL", doc="polynomial of the first invariant"),
            Option("YEOH", doc="reduced polynomial with N=3"),
            Option("N", Kind.INTEGER, "order, 1 to 6 (1)"),
            Option("USER", doc="strain energy potential of UHYPER"),
            Option("TYPE", Kind.CHOICE, "of USER", choices=("COMPRESSIBLE", "INCOMPRESSIBLE")),
            Option("PROPERTIES", Kind.INTEGER, "number of constants of USER"),
            one_of(
                "MODULI",
                "which ones the coefficients give, with *VISCOELASTIC",
                ("LONG TERM", "INSTANTANEOUS"),
                default="LONG TERM",
            ),
            *refused("BETA", "MARLOW", "POISSON", "TEST DATA INPUT", "VAN DER WAALS"),
        ),
        "coefficients, then D, eight per line: mu, lambda_m, D (ARRUDA-BOYCE); mu1, alpha1, ... D1, ... (OGDEN); "
        "C10, C01, C20, C11, C02, ... D1, ... (POLYNOMIAL, MOONEY-RIVLIN); C10, C20, ... D1, ... (the others); "
        "constants (USER)",
    ),
    Keyword(
        "ANISOTROPIC HYPERELASTIC",
        "Hyperelasticity with preferred directions, those of LOCAL DIRECTIONS of the *ORIENTATION of the section or, "
        "without them, its axes; in the elements and steps of *HYPERELASTIC. UANISOHYPER_INV is called once in an "
        "iteration. Incompressible materials, with D = 0 or USER without TYPE=COMPRESSIBLE, need hybrid elements; "
        "one-point elements need *HOURGLASS STIFFNESS.",
        Where.MODEL,
        (
            Option("HOLZAPFEL", doc="strain energy potential of Holzapfel, Gasser and Ogden"),
            Option("USER", doc="strain energy potential of UANISOHYPER_INV"),
            Option("FORMULATION", Kind.CHOICE, "of USER", choices=("INVARIANT",), refused=("STRAIN",)),
            Option("LOCAL DIRECTIONS", Kind.INTEGER, "number of preferred directions, 0 to 3"),
            Option("TYPE", Kind.CHOICE, "of USER", choices=("COMPRESSIBLE", "INCOMPRESSIBLE")),
            Option("PROPERTIES", Kind.INTEGER, "number of constants of USER"),
            *ignored("MODULI"),
            *refused("DEPENDENCIES", "FUNG-ANISOTROPIC", "FUNG-ORTHOTROPIC"),
        ),
        "C10, D, k1, k2, kappa (HOLZAPFEL); constants (USER)",
    ),
)
