# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface elements of the project whose *USER ELEMENT lacks UNSYMM: Abaqus takes the symmetric part of AMATRX."""

from __future__ import annotations

from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import UserProperty
from uel.usersub import Library
from uel.usersub.layout import ElementLayout, element_layouts


def warn_of_missing_unsymm(model: Model, library: Library) -> None:
    """Warn of each *USER ELEMENT of the project that lacks UNSYMM."""
    if not library.is_own or all(step.procedure.unsymmetric for step in model.steps):
        return
    large = any(step.nlgeom for step in model.steps)
    warned = set()
    for group in model.groups:
        definition = group.definition
        layout = element_layouts().get(definition.number) if definition is not None else None
        if definition is None or layout is None or not layout.unsymmetric or definition.unsymmetric:
            continue
        if definition.source not in warned and (large or not _is_secant(group, layout)):
            warned.add(definition.source)
            library.warn(
                f"{definition.source}: {group.type} has an unsymmetric matrix in mixed-mode softening, but *USER "
                "ELEMENT has no UNSYMM: the symmetric part stands for it, and many more iterations are needed; add "
                "UNSYMM"
            )


def _is_secant(group: ElementGroup, layout: ElementLayout) -> bool:
    """Return whether the elements are standard ones with TANGENT 1,
    whose matrix is symmetric for small displacements.
    """
    if layout.own or not isinstance(group.section, UserProperty):
        return False
    names = [item.name for item in layout.integers]
    position = names.index("TANGENT")
    if "OFFSETBOTTOM" in names or len(group.section.integers) <= position:
        return False
    return bool(group.section.integers[position] == 1)
