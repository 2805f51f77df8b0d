# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Materials whose stresses depend on time: *VISCOELASTIC and *CREEP."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.deck.blocks import Block
from harness.deck.table import Keyword, Where, one_of, refused
from harness.model.properties import Creep, Material, Viscoelastic


def extend_viscous(material: Material, block: Block) -> Material:
    """The material with what the keyword says of it. Raises DeckError."""
    if block.name == "CREEP":
        return replace(material, creep=_read_creep(block))
    return replace(material, viscoelastic=_read_viscoelastic(block))


def _read_viscoelastic(block: Block) -> Viscoelastic:
    """A Prony series."""
    terms: list[tuple[float, float, float]] = []
    for row in block.rows():
        row.at_most(3)
        shear, bulk, time = row.real(0, "g", 0.0), row.real(1, "k", 0.0), row.real(2, "tau")
        if min(shear, bulk) < 0 or time <= 0:
            raise row.error(f"g = {shear:g}, k = {bulk:g}, tau = {time:g}: expected g >= 0, k >= 0 and tau > 0")
        terms.append((shear, bulk, time))
    if not terms:
        raise block.error("needs a data line with g, k and tau")
    if len(terms) > MOST_TERMS:
        raise block.error(f"{len(terms)} terms, expected at most {MOST_TERMS}")
    series = np.array(terms)
    for name, total in zip("gk", series.sum(axis=0), strict=False):
        if total >= 1:
            raise block.error(f"the sum of {name} is {total:g}, expected less than 1")
    return Viscoelastic(series, block.source)


def _read_creep(block: Block) -> Creep:
    """A power law."""
    row = block.only_row()
    if row is None:
        raise block.error("needs a data line with A, n and m")
    if len(row) > 3:
        raise row.error("expected only A, n and m; dependence on temperature is not supported")
    factor, power, of_time = row.real(0, "A"), row.real(1, "n"), row.real(2, "m", 0.0)
    if min(factor, power) <= 0 or not -1 < of_time <= 0:
        raise row.error(f"A = {factor:g}, n = {power:g}, m = {of_time:g}: expected A > 0, n > 0 and -1 < m <= 0")
    return Creep(block.options.text("LAW") == "TIME", factor, power, of_time, block.source)


MOST_TERMS = 20
"""Largest number of terms; fortran/host/host_materials.f90 has room for them."""

KEYWORDS = (
    Keyword(
        "VISCOELASTIC",
        "Isotropic viscoelasticity beside *ELASTIC in continuum elements without temperatures, and UELMAT. Stresses "
        "relax in *VISCO and *DYNAMIC; *STATIC takes the instantaneous moduli.",
        Where.MODEL,
        (
            one_of(
                "TIME",
                "Prony series",
                ("PRONY",),
                required=True,
                refused=("CREEP TEST DATA", "FREQUENCY DATA", "RELAXATION TEST DATA"),
            ),
            one_of("TYPE", "symmetry", ("ISOTROPIC",), default="ISOTROPIC", refused=("TRACTION",)),
            *refused("ERRTOL", "FREQUENCY", "LAW", "NETWORKID", "NMAX", "NONLINEAR", "PRELOAD", "PROPERTIES", "SRATIO"),
        ),
        "g, k, tau",
    ),
    Keyword(
        "CREEP",
        "Creep by a power law of the Mises stress beside *ELASTIC in continuum elements without temperatures, and "
        "UELMAT; in *VISCO only. Integration is implicit.",
        Where.MODEL,
        (
            one_of(
                "LAW",
                "strain or time hardening",
                ("STRAIN", "TIME"),
                default="STRAIN",
                refused=("ANAND", "DARVEAUX", "DOUBLE POWER", "HYPERB", "POWER LAW", "TIME POWER LAW", "USER"),
            ),
            one_of("TIME", "of LAW=TIME: the total time", ("TOTAL",), default="TOTAL", refused=("CREEP",)),
            *refused("DEPENDENCIES"),
        ),
        "A, n, m",
    ),
)
