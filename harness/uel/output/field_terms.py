# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Terms of the message file for the fields of an analysis."""

from __future__ import annotations

from dataclasses import dataclass

from uel.model.model import CONCENTRATION, Model


@dataclass(frozen=True, slots=True)
class FieldTerms:
    """Abaqus' terms for the flux of a field and the quantity conjugate to it; `dofs` belong to the field."""

    flux: str
    quantity: str
    dofs: range


FIELDS = {
    "force": FieldTerms("FORCE", "DISP.", range(1, 4)),
    "moment": FieldTerms("MOMENT", "ROTATION", range(4, 8)),
    "pore": FieldTerms("VOL. FLUX", "P. PRESS.", range(8, 9)),
    "electrical": FieldTerms("CURRENT", "ELEC.POT.", range(9, 10)),
    "temperature": FieldTerms("HEAT FLUX", "TEMP.", range(11, 31)),
    "concentration": FieldTerms("CONC. FLUX", "CONC.", range(CONCENTRATION, CONCENTRATION + 1)),
}


def fields_of(model: Model) -> list[str]:
    """Return the fields of a model's elements; built-in elements have displacements, or concentrations, only."""
    if model.diffusive:
        return ["concentration"]
    dofs: set[int] = set()
    for group in model.groups:
        dofs |= {1} if group.definition is None else {dof for _, dof in group.definition.dofs}
    return [name for name, words in FIELDS.items() if dofs & set(words.dofs)]
