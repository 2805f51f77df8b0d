# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Materials whose stresses depend on time: *VISCOELASTIC, with the networks of NONLINEAR and *TRS, and *CREEP."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Kind, Option, Where, one_of, refused
from uel.deck.materials.user_constants import read_constants
from uel.model.properties import SRATIO_ROUNDING, Creep, CreepLaw, Material, Network, Viscoelastic


def extend_viscoelastic(material: Material, block: Block, problems: Problems) -> Material:
    """Return the material with a Prony series, or with another network. Raises DeckError."""
    if block.options.flag("NONLINEAR"):
        return _extend_networks(material, block, problems)
    if other := next((name for name in ("LAW", "NETWORKID", "PROPERTIES", "SRATIO") if block.options.has(name)), ""):
        raise block.error(f"{other}: expected with NONLINEAR only")
    if not block.options.has("TIME"):
        raise block.error("expected TIME=PRONY or NONLINEAR")
    return replace(material, viscoelastic=_read_viscoelastic(block))


def _read_viscoelastic(block: Block) -> Viscoelastic:
    """Read a Prony series. Raises DeckError."""
    terms: list[tuple[float, float, float]] = []
    for row in block.required_rows("g, k and tau"):
        row.at_most(3)
        shear, bulk, time = row.real(0, "g", 0.0), row.real(1, "k", 0.0), row.real(2, "tau")
        if min(shear, bulk) < 0 or time <= 0:
            raise row.error(f"g = {shear:g}, k = {bulk:g}, tau = {time:g}: expected g >= 0, k >= 0 and tau > 0")
        terms.append((shear, bulk, time))
    if len(terms) > MOST_TERMS:
        raise block.error(f"{len(terms)} terms, expected at most {MOST_TERMS}")
    series = np.array(terms)
    for name, total in zip("gk", series.sum(axis=0), strict=False):
        if total >= 1:
            raise block.error(f"the sum of {name} is {total:g}, expected less than 1")
    return Viscoelastic(series, block.source)


def read_creep(block: Block) -> Creep:
    """Read a power law, or that of user subroutine CREEP. Raises DeckError."""
    if block.options.text("LAW") == "USER":
        if (row := block.only_row()) is not None:
            raise row.error("LAW=USER has no data line: CREEP gives the law")
        return Creep(False, 0.0, 0.0, 0.0, block.source, user=True)
    row = block.required_row("A, n and m")
    if len(row) > 3:
        raise row.dependent("expected only A, n and m")
    factor, power, of_time = row.real(0, "A"), row.real(1, "n"), row.real(2, "m", 0.0)
    if min(factor, power) <= 0 or not -1 < of_time <= 0:
        raise row.error(f"A = {factor:g}, n = {power:g}, m = {of_time:g}: expected A > 0, n > 0 and -1 < m <= 0")
    return Creep(block.options.text("LAW") == "TIME", factor, power, of_time, block.source)


def _extend_networks(material: Material, block: Block, problems: Problems) -> Material:
    """Return the material with another network. Raises DeckError."""
    for name in ("LAW", "NETWORKID", "SRATIO"):
        if not block.options.has(name):
            raise block.error(f"NONLINEAR needs {name}")
    number, ratio = block.options.integer("NETWORKID", 0), block.options.real("SRATIO", 0.0)
    law = _LAWS[block.options.text("LAW")]
    if number != len(material.networks) + 1:
        raise block.error(f"NETWORKID={number}: expected {len(material.networks) + 1}, networks in ascending order")
    if not 0 < ratio <= 1:
        raise block.error(f"SRATIO={ratio:g}: expected 0 < SRATIO <= 1")
    total = ratio + sum(network.ratio for network in material.networks)
    if total > 1 + SRATIO_ROUNDING:
        raise block.error(f"the sum of SRATIO is {total:g}, expected at most 1")
    if law is CreepLaw.USER:
        network = Network(ratio, law, (), block.source, user=read_constants(block, "PROPERTIES", problems))
    else:
        network = Network(ratio, law, _read_law(block), block.source)
    return replace(material, networks=(*material.networks, network))


def extend_shift(material: Material, block: Block, problems: Problems) -> Material:
    """Return the material with a reduced time in its last network. Raises DeckError."""
    if not material.networks:
        raise block.error("expected *VISCOELASTIC, NONLINEAR before it; other materials with it are not supported")
    *others, last = material.networks
    return replace(material, networks=(*others, replace(last, shift=read_constants(block, "PROPERTIES", problems))))


def _read_law(block: Block) -> tuple[float, ...]:
    """Read the constants of the law as the host orders them: q0, n, m, a, rate; A, B, n; A, m, C, E.
    Raises DeckError.
    """
    law = block.options.text("LAW")
    names = {
        "BERGSTROM-BOYCE": ("A", "m", "C", "E"),
        "HYPERB": ("A", "B", "n"),
        "POWER LAW": ("q0", "n", "m", "a", "rate"),
        "STRAIN": ("A", "n", "m"),
    }[law]
    row = block.required_row(", ".join(names))
    if len(row) > len(names):
        raise row.dependent(f"expected only {', '.join(names)}")
    values = tuple(row.real(k, name, 0.0) for k, name in enumerate(names))
    _check_law(row, law, dict(zip(names, values, strict=True)))
    if law == "STRAIN":
        factor, power, hardening = values
        return float(factor ** (-1 / power)), power, hardening, 0.0, 1.0
    return values


def _check_law(row: Row, law: str, c: dict[str, float]) -> None:
    constants = ", ".join(f"{name} = {value:g}" for name, value in c.items())
    match law:
        case "BERGSTROM-BOYCE":
            bounds = "A > 0, m > 0, -1 <= C <= 0, and E > 0 with C < 0"
            good = min(c["A"], c["m"]) > 0 and -1 <= c["C"] <= 0 <= c["E"] and (c["E"] > 0 or c["C"] == 0)
        case "HYPERB":
            bounds, good = "A > 0, B > 0 and n > 0", min(c.values()) > 0
        case "POWER LAW":
            bounds = "q0 > 0, n > 0, -1 < m <= 0, a >= 0 and rate > 0"
            good = min(c["q0"], c["n"], c["rate"]) > 0 and -1 < c["m"] <= 0 <= c["a"]
        case _:
            bounds, good = "A > 0, n > 0 and -1 < m <= 0", min(c["A"], c["n"]) > 0 and -1 < c["m"] <= 0
    if not good:
        raise row.error(f"{constants}: expected {bounds}")


_LAWS = {
    **{"BERGSTROM-BOYCE": CreepLaw.BERGSTROM_BOYCE, "HYPERB": CreepLaw.HYPERBOLIC, "POWER LAW": CreepLaw.POWER},
    **{"STRAIN": CreepLaw.POWER, "USER": CreepLaw.USER},
}

MOST_TERMS = 20
"""Largest number of terms; fortran/host/materials/library.f90 has room for them."""

KEYWORDS = (
    Keyword(
        "VISCOELASTIC",
        "Isotropic viscoelasticity beside *ELASTIC in continuum elements without temperatures, and UELMAT; with "
        "NONLINEAR a network of the parallel rheological framework beside *HYPERELASTIC by coefficients, in its "
        "elements and steps. Stresses relax in *VISCO and *DYNAMIC; *STATIC takes the instantaneous moduli.",
        Where.MODEL,
        (
            one_of(
                "TIME",
                "Prony series",
                ("PRONY",),
                refused=("CREEP TEST DATA", "FREQUENCY DATA", "RELAXATION TEST DATA"),
            ),
            one_of("TYPE", "symmetry", ("ISOTROPIC",), default="ISOTROPIC", refused=("TRACTION",)),
            Option("NONLINEAR", doc="a network"),
            Option("NETWORKID", Kind.INTEGER, "number of the network, ascending from 1"),
            Option("SRATIO", Kind.REAL, "stiffness ratio of the network; what is left to 1 is elastic"),
            one_of("LAW", "creep law of the network; USER: UCREEPNETWORK", tuple(_LAWS)),
            Option("PROPERTIES", Kind.INTEGER, "number of constants of UCREEPNETWORK"),
            *refused("DEPENDENCIES", "ERRTOL", "FREQUENCY", "NMAX", "PRELOAD"),
        ),
        "g, k, tau (PRONY); A, n, m (STRAIN); A, B, n (HYPERB); A, m, C, E (BERGSTROM-BOYCE); q0, n, m, a, rate (POWER "
        "LAW); constants (USER)",
    ),
    Keyword(
        "CREEP",
        "Creep by a power law of the Mises stress, or by the law of CREEP, beside *ELASTIC in continuum elements "
        "without temperatures, and UELMAT; in *VISCO only. Integration is implicit.",
        Where.MODEL,
        (
            one_of(
                "LAW",
                "strain or time hardening, or user subroutine CREEP",
                ("STRAIN", "TIME", "USER"),
                default="STRAIN",
                refused=("ANAND", "DARVEAUX", "DOUBLE POWER", "HYPERB", "POWER LAW", "TIME POWER LAW"),
            ),
            one_of("TIME", "of LAW=TIME: the total time", ("TOTAL",), default="TOTAL", refused=("CREEP",)),
            *refused("DEPENDENCIES"),
        ),
        "A, n, m; none of LAW=USER",
    ),
    Keyword(
        "TRS",
        "Reduced time of the network of the *VISCOELASTIC, NONLINEAR before it, by UTRSNETWORK.",
        Where.MODEL,
        (
            one_of(
                "DEFINITION",
                "shift function",
                ("USER",),
                required=True,
                refused=("ARRHENIUS", "TABULAR", "WLF"),
            ),
            Option("PROPERTIES", Kind.INTEGER, "number of constants of UTRSNETWORK"),
        ),
        "constants, eight per line; missing values are zero",
    ),
)
