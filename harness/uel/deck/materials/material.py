# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*MATERIAL and its options."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import PER_LINE, Block, Row
from uel.deck.language.structure import Structure
from uel.deck.language.table import NAME, Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.materials.damage import OF_MATERIALS, extend_damage
from uel.deck.materials.diffusion import read_diffusivity, read_kappa
from uel.deck.materials.expansion import read_expansion
from uel.deck.materials.heat import read_by_temperature, read_latent_heat
from uel.deck.materials.hyperelastic import read_anisotropic, read_isotropic
from uel.deck.materials.piezoelectric import read_dielectric, read_piezoelectric
from uel.deck.materials.plastic import extend_plastic
from uel.deck.materials.user_constants import MOST_VARIABLES, read_constants
from uel.deck.materials.viscous import extend_shift, extend_viscoelastic, read_creep
from uel.deck.sections.user_elements import read_count
from uel.model.arrays import FloatArray
from uel.model.properties import Elastic, ElasticType, HybridFormulation, Material, UserMaterial, isotropic_fault

DEPENDENT = (ElasticType.ISOTROPIC, ElasticType.LAMINA, ElasticType.ENGINEERING_CONSTANTS)
"""Elastic types that may depend on temperature and fields."""
MOST_FIELDS = 1000
Reader = Callable[[Material, Block, Problems], Material]


def leave_out_unused(structure: Structure, problems: Problems) -> None:
    """Drop unused materials with errors, which have no effect in Abaqus either."""
    _list_unused(problems.settle(structure.materials), structure)
    left_out = {name for name, _ in structure.ignored}
    blocks: list[Block] = []
    dropped = False
    for block in structure.root:
        if block.name == "MATERIAL":
            dropped = _label(block.options.text("NAME")) in left_out
        elif block.name not in MATERIAL_OPTIONS:
            dropped = False
        if not dropped:
            blocks.append(block)
    structure.root = blocks


def _list_unused(names: Sequence[str], structure: Structure) -> None:
    listed = {name for name, _ in structure.ignored}
    for block in structure.root:
        if block.name == "MATERIAL" and (name := block.options.text("NAME")) in names and _label(name) not in listed:
            structure.ignored.append((_label(name), block.source))


def _label(material: str) -> str:
    """Return the name of a material in the list of ignored keywords."""
    return f"MATERIAL, NAME={material}"


def read_materials(blocks: list[Block], structure: Structure, problems: Problems) -> dict[str, Material]:
    """Read the materials.

    blocks: those of the model without contact properties. Errors of used materials go to `problems`; other materials
    with errors are listed in `structure.ignored`.
    """
    materials: dict[str, Material] = {}
    current: str | None = None
    for block in blocks:
        inside = current is not None and block.name in MATERIAL_OPTIONS
        with problems.gather_of(current) if inside and current else problems.gather():
            if block.name == "MATERIAL":
                current = block.options.text("NAME")
                materials[current] = Material(current, block.source)
            elif block.name in MATERIAL_OPTIONS:
                if current is None:
                    raise block.error("does not follow *MATERIAL")
                materials[current] = _READERS[block.name](materials[current], block, problems)
            else:
                current = None
    _list_unused(problems.settle(structure.materials), structure)
    return materials


def _sets(field: str, read: Callable[[Block], object]) -> Reader:
    """Return the reader of an option that sets one field of the material."""

    def extend(material: Material, block: Block, _: Problems) -> Material:
        values: dict[str, Any] = {field: read(block)}
        return replace(material, **values)

    return extend


def _extend_user(material: Material, block: Block, problems: Problems) -> Material:
    user = _read_user_material(block, problems)
    thermal = block.options.text("TYPE") == "THERMAL"
    return replace(material, user_thermal=user) if thermal else replace(material, user=user)


def _read_constant(block: Block, quantity: str) -> float:
    """Read the only positive number of a material option. Raises DeckError."""
    rows = list(block.rows())
    if len(rows) != 1 or len(rows[0]) != 1:
        raise block.dependent(f"needs one data line with the {quantity}")
    return rows[0].positive(0, quantity)


def _read_elastic(block: Block) -> Elastic:
    kind = ElasticType(block.options.text("TYPE"))
    count = kind.constants
    instantaneous = block.options.text("MODULI") == "INSTANTANEOUS"
    rows = block.required_rows()
    fields = read_count(block, "DEPENDENCIES", 0, 0, MOST_FIELDS)
    values = [value for row in rows for value in row.reals("elastic constant")]
    if fields or len(values) > count:
        table = _read_dependence(block, kind, count, fields)
        # a single row is constant
        return Elastic(
            kind, tuple(table[0, :count].tolist()), block.source, table if len(table) > 1 else None, instantaneous
        )
    # optional trailing constants: Poisson's ratio, transverse shear moduli of a lamina, Ett in the plane
    needed = {ElasticType.ISOTROPIC: 1, ElasticType.LAMINA: 4, ElasticType.TRACTION: 2}.get(kind, count)
    if len(values) < needed:
        raise rows[0].error(f"{len(values)} values, but {kind.value} takes {count}")
    values += [0.0] * (count - len(values))
    if kind is ElasticType.ISOTROPIC:
        _check_isotropic(rows[0], *values)
    return Elastic(kind, tuple(values), block.source, instantaneous=instantaneous)


def _check_isotropic(row: Row, young: float, poisson: float) -> None:
    if fault := isotropic_fault(young, poisson):
        raise row.error(fault)


def _read_dependence(block: Block, kind: ElasticType, count: int, fields: int) -> FloatArray:
    """Read rows of constants, temperature and fields, eight values to a line. Raises DeckError."""
    if kind not in DEPENDENT:
        names = ", ".join(sorted(DEPENDENT))
        raise block.error(f"dependence on temperature and fields is supported for {names}, not for {kind.value}")
    rows, width = list(block.rows()), count + 1 + fields
    lines = math.ceil(width / PER_LINE)
    if len(rows) % lines:
        raise block.error(f"{width} values take {lines} lines, found {len(rows)}")
    table: list[list[float]] = []
    for first in range(0, len(rows), lines):
        values: list[float] = []
        for number, row in enumerate(rows[first : first + lines]):
            here = min(PER_LINE, width - PER_LINE * number)
            row.at_most(here)
            values += row.reals("elastic constant") + [0.0] * (here - len(row))
        if kind is ElasticType.ISOTROPIC:
            _check_isotropic(rows[first], *values[:count])
        if any(values[count:] == earlier[count:] for earlier in table):
            raise rows[first].error("the temperature and fields are those of an earlier line")
        table.append(values)
    return np.array(table)


def _read_user_material(block: Block, problems: Problems) -> UserMaterial:
    constants = read_constants(block, "CONSTANTS", problems)
    hybrid = HybridFormulation[block.options.text("HYBRID FORMULATION")]
    return UserMaterial(constants, block.options.flag("UNSYMM"), block.source, hybrid)


def _read_count(block: Block) -> int:
    row = block.required_rows("the number of variables")[0]
    count = row.integer(0, "number of variables")
    if not 0 <= count <= MOST_VARIABLES:
        raise row.error(f"{count} variables: expected a number from 0 to {MOST_VARIABLES}")
    return count


_READERS: dict[str, Reader] = {
    "ELASTIC": _sets("elastic", _read_elastic),
    "HYPERELASTIC": lambda m, block, problems: replace(m, hyperelastic=read_isotropic(block, problems)),
    "ANISOTROPIC HYPERELASTIC": lambda m, block, problems: replace(m, hyperelastic=read_anisotropic(block, problems)),
    **dict.fromkeys(
        ("PLASTIC", "CYCLIC HARDENING"),
        lambda m, block, problems: replace(m, plastic=extend_plastic(m.plastic, block, problems)),
    ),
    **{"VISCOELASTIC": extend_viscoelastic, "CREEP": _sets("creep", read_creep), "TRS": extend_shift},
    "USER MATERIAL": _extend_user,
    "USER DEFINED FIELD": _sets("user_field", attrgetter("source")),
    "DENSITY": _sets("density", partial(_read_constant, quantity="density")),
    "DEPVAR": _sets("state_variables", _read_count),
    "USER OUTPUT VARIABLES": _sets("output_variables", _read_count),
    "CONDUCTIVITY": _sets("conductivity", partial(read_by_temperature, quantity="conductivity")),
    "SPECIFIC HEAT": _sets("specific_heat", partial(read_by_temperature, quantity="specific heat")),
    "LATENT HEAT": _sets("latent_heat", read_latent_heat),
    "HEAT GENERATION": _sets("heat_generation", attrgetter("source")),
    "DIFFUSIVITY": _sets("diffusivity", read_diffusivity),
    "SOLUBILITY": _sets("solubility", partial(read_by_temperature, quantity="solubility")),
    "KAPPA": lambda m, block, _: replace(m, diffusivity=read_kappa(block, m.diffusivity)),
    "PIEZOELECTRIC": _sets("piezoelectric", read_piezoelectric),
    "DIELECTRIC": _sets("dielectric", read_dielectric),
    "EXPANSION": _sets("expansion", read_expansion),
    **dict.fromkeys(
        ("DAMAGE INITIATION", "DAMAGE EVOLUTION", "DAMAGE STABILIZATION"),
        lambda m, block, _: replace(m, damage=extend_damage(m.damage, block, OF_MATERIALS)),
    ),
}
"""Reader of each option: returns the material extended by it. Raises DeckError."""

MATERIAL_OPTIONS = frozenset(_READERS)

_OPTIONS = (
    Keyword(
        "ELASTIC",
        "Linear elasticity; a Poisson's ratio of 0.5 needs hybrid elements.",
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
            one_of(
                "MODULI",
                "which ones the constants give, with *VISCOELASTIC",
                ("LONG TERM", "INSTANTANEOUS"),
                default="LONG TERM",
            ),
            *refused("COMPRESSION FACTOR"),
        ),
        "constants in the order of the type; those of continuum elements, trusses, shells and beams may depend on "
        "temperature and fields, which follow, eight values per line",
    ),
    Keyword(
        "USER MATERIAL",
        "Material of UMAT, or of UMATHT, which conducts and stores heat; one material may have both. RPL, DRPLDT, "
        "DRPLDE and DDSDDT of UMAT count in coupled temperature-displacement elements.",
        Where.MODEL,
        (
            Option("CONSTANTS", Kind.INTEGER, "number of constants", required=True),
            Option("UNSYMM", doc="DDSDDE, or the matrix of UMATHT, is unsymmetric"),
            one_of("TYPE", "what the user routine gives", ("MECHANICAL", "THERMAL"), default="MECHANICAL"),
            one_of(
                "HYBRID FORMULATION",
                "what hybrid elements take from UMAT",
                tuple(HybridFormulation.__members__),
                default="INCREMENTAL",
            ),
        ),
        "constants, eight per line; missing values are zero",
    ),
    Keyword(
        "DEPVAR",
        "Number of state variables (STATEV) of a material point.",
        Where.MODEL,
        (*ignored("DELETE"),),
        "number of variables; then number, name, description of variables, which are not read",
    ),
    Keyword(
        "USER DEFINED FIELD",
        "USDFLD gives the field variables of continuum elements (those with temperatures too), trusses, shells, "
        "membranes and beams.",
        Where.MODEL,
    ),
    Keyword(
        "USER OUTPUT VARIABLES",
        "Number of variables that UVARM gives at a material point.",
        Where.MODEL,
        data="number of variables",
    ),
    Keyword(
        "DENSITY",
        "Mass density. The mass per area of cohesive elements is density times constitutive thickness, which is 1 by "
        "default.",
        Where.MODEL,
        refused("DEPENDENCIES", "PORE FLUID"),
        "density",
    ),
)

KEYWORDS = (
    Keyword(
        "MATERIAL",
        "Begin a material. One that no section names may hold what is not supported: it is listed and has no effect.",
        Where.MODEL,
        (NAME, *refused("RTOL", "SRATE FACTOR", "STRAIN RATE REGULARIZATION")),
    ),
    *_OPTIONS,
)
