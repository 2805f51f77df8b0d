# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Terms of the message file for the fields of an analysis."""

from __future__ import annotations

from dataclasses import dataclass

from uel.elements import FIELD_NAMES, field_of
from uel.model.dofs import DISPLACEMENTS
from uel.model.model import Model


@dataclass(frozen=True, slots=True)
class FieldTerms:
    """Abaqus' terms for the flux of a field and the quantity conjugate to it."""

    flux: str
    quantity: str


FIELDS = {
    "force": FieldTerms("FORCE", "DISP."),
    "moment": FieldTerms("MOMENT", "ROTATION"),
    "pore": FieldTerms("VOL. FLUX", "P. PRESS."),
    "electrical": FieldTerms("CURRENT", "ELEC.POT."),
    "temperature": FieldTerms("HEAT FLUX", "TEMP."),
    "concentration": FieldTerms("CONC. FLUX", "CONC."),
}


def fields_of(model: Model) -> list[str]:
    """Return the fields of a model's elements; built-in elements have displacements, or concentrations, only."""
    if model.diffusive:
        return ["concentration"]
    found: set[str] = set()
    for group in model.groups:
        dofs = DISPLACEMENTS if group.definition is None else [dof for _, dof in group.definition.dofs]
        found |= {FIELD_NAMES[field_of(dof)] for dof in dofs}
    return [name for name in FIELDS if name in found]
