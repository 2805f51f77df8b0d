# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of *MATERIAL for piezoelectric elements: *PIEZOELECTRIC and *DIELECTRIC."""

from __future__ import annotations

import numpy as np

from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Where, one_of, refused
from uel.model.arrays import FloatArray
from uel.model.properties import Piezoelectric

_DIELECTRIC = {"ISO": 1, "ORTHO": 3, "ANISO": 6}
"""Constants of TYPE=."""


def read_piezoelectric(block: Block) -> Piezoelectric:
    """Read the piezoelectric coefficients (3, 6). Raises DeckError."""
    values = np.array(_read_constants(block, 18)).reshape(3, 6)
    return Piezoelectric(block.options.text("TYPE") == "E", values, block.source)


def read_dielectric(block: Block) -> FloatArray:
    """Read the dielectric matrix (3, 3). Raises DeckError unless it is positive definite."""
    kind = block.options.text("TYPE")
    values = _read_constants(block, _DIELECTRIC[kind])
    if kind == "ANISO":
        d11, d12, d22, d13, d23, d33 = values
        matrix = np.array([[d11, d12, d13], [d12, d22, d23], [d13, d23, d33]])
    else:
        matrix = np.diag(np.broadcast_to(values, 3))
    if np.linalg.eigvalsh(matrix)[0] <= 0:
        raise block.error("the dielectric matrix must be positive definite")
    return matrix


def _read_constants(block: Block, count: int) -> list[float]:
    """Read `count` constants, eight per line; missing trailing ones are zero. Raises DeckError."""
    values = [value for row in block.required_rows() for value in row.reals("constant")]
    if len(values) > count:
        message = f"{len(values)} values, expected {count}; dependence on temperature and fields is not supported"
        raise block.error(message)
    return values + [0.0] * (count - len(values))


KEYWORDS = (
    Keyword(
        "PIEZOELECTRIC",
        "Piezoelectric coupling of elements with an electrical potential (dof 9): CPE4E, C3D8E and so on, in *STATIC "
        "and linear steps with small displacements.",
        Where.MODEL,
        (
            one_of("TYPE", "stresses or (E) strains by the electrical field", ("S", "E"), default="S"),
            *refused("DEPENDENCIES"),
        ),
        "for the field along 1, 2 and 3 in turn the components 11, 22, 33, 12, 13, 23, of engineering strains with "
        "TYPE=E, eight per line",
    ),
    Keyword(
        "DIELECTRIC",
        "Permittivity at constant strain.",
        Where.MODEL,
        (
            one_of("TYPE", "symmetry", ("ISO", "ORTHO", "ANISO"), default="ISO"),
            *refused("DEPENDENCIES"),
        ),
        "D; or D11, D22, D33; or D11, D12, D22, D13, D23, D33",
    ),
)
