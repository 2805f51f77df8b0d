# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Construction of the blocks of a model, with the checks that need no call of an element."""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.support import FORMULATIONS, check_support, elements_of, formulation_of
from uel.errors import DeckError, all_of, unsupported
from uel.model.element_types import BUILT_IN
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.usersub import Library


def build_blocks(
    model: Model, library: Library, *, strict: bool = True, zeros: bool = False, linear: Collection[str] = ()
) -> list[ElementBlock]:
    """Build the blocks of all elements of a model.

    Parameters
    ----------
    model
        The whole deck.
    library
        The loaded user routines.
    strict
        A write of a user element outside an array is an error, otherwise a warning.
    zeros
        An entry of RHS or AMATRX that a user element does not set gives a warning and is zero, otherwise it is an
        error.
    linear
        Types of user elements that the user says are linear.

    Returns
    -------
    list[ElementBlock]
        One per group of the model, in the same order.

    Raises
    ------
    DeckError
        Names every group that cannot be built.
    """
    building = Building(model, library, strict, zeros, linear)
    blocks: list[ElementBlock] = []
    errors: dict[str, DeckError] = {}
    for group in model.groups:
        try:
            blocks.append(_block_of(building, group))
        except DeckError as error:
            errors.setdefault(str(error), error)
        except MemoryError:
            raise _too_large(group) from None
    if errors:
        raise all_of(list(errors.values()))
    return blocks


def _too_large(group: ElementGroup) -> DeckError:
    user = group.definition
    source, cause = (user.source, f" (VARIABLES={user.variables})") if user else (group.source, "")
    return DeckError(source, f"not enough memory for {len(group.labels)} elements of type {group.type}{cause}")


def _block_of(building: Building, group: ElementGroup) -> ElementBlock:
    formulation = formulation_of(building.model, group)
    if formulation is None:
        near = get_close_matches(group.type.upper(), BUILT_IN, n=1)
        raise unsupported(
            group.source, f"element type {group.type}", instead=f"did you mean {near[0]}?" if near else ""
        )
    support, kind = FORMULATIONS[formulation], group.built_in
    if not isinstance(group.section, support.section):
        keyword = kind.section if kind is not None else "UEL PROPERTY"
        raise DeckError(group.section.source, f"{elements_of(group)} need *{keyword}")
    check_support(building.model, group, support)
    if kind is not None and group.nodes.shape[1] != kind.nodes:
        message = f"elements of type {group.type} have {kind.nodes} nodes, found {group.nodes.shape[1]}"
        raise DeckError(group.source, message)
    return support.build(building, group)
