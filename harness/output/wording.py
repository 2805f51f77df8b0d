# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Words of the message file for the fields of an analysis, and the layout of its notes and warnings."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass

from harness.model.model import Model


@dataclass(frozen=True, slots=True)
class FieldWords:
    """What Abaqus calls the flux of a field and the quantity conjugate to it; `dofs` belong to the field."""

    flux: str
    quantity: str
    dofs: range


FIELDS = {
    "force": FieldWords("FORCE", "DISP.", range(1, 4)),
    "moment": FieldWords("MOMENT", "ROTATION", range(4, 8)),
    "pore": FieldWords("VOL. FLUX", "P. PRESS.", range(8, 9)),
    "electrical": FieldWords("CURRENT", "ELEC.POT.", range(9, 10)),
    "temperature": FieldWords("HEAT FLUX", "TEMP.", range(11, 31)),
}


def fields_of(model: Model) -> list[str]:
    """Fields that the elements of a model have; built-in elements have displacements only."""
    dofs: set[int] = set()
    for group in model.groups:
        dofs |= {1} if group.definition is None else {dof for _, dof in group.definition.dofs}
    return [name for name, words in FIELDS.items() if dofs & set(words.dofs)]


def remark(kind: str, text: str) -> str:
    """A note, warning or error (`kind` NOTE, WARNING, ERROR) with lines as long as Abaqus', continued under the text.

    Notes and warnings of Abaqus are in upper case; names and paths are left as they are.
    """
    head = f" ***{kind}: "
    lines = textwrap.wrap(text, 80 - len(head), break_long_words=False, break_on_hyphens=False) or [""]
    return "\n".join([head + lines[0], *(" " * len(head) + line for line in lines[1:])]) + "\n"
