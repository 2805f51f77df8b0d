# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contributors to the system of a model: elements, loads, contact, couplings."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Self

from uel.contact import ContactBlock
from uel.elements import (
    Contributor,
    DistributingBlock,
    ElementBlock,
    FollowerBlock,
    HeatLoadBlock,
    build_blocks,
    follower_blocks,
    heat_load_blocks,
)
from uel.model.model import Model
from uel.usersub import Library


@dataclass(frozen=True, slots=True)
class Contributors:
    """All contributors of a model; iteration yields them in the order of a pass.

    elements   blocks of the groups of elements, in the calling order of Abaqus
    followers  faces under follower loads
    heat       faces, volumes and nodes with heat loads
    contacts   contact pairs
    couplings  distributing couplings in large displacements, in one block; empty without them
    """

    elements: Sequence[ElementBlock]
    followers: Sequence[FollowerBlock] = ()
    heat: Sequence[HeatLoadBlock] = ()
    contacts: Sequence[ContactBlock] = ()
    couplings: Sequence[DistributingBlock] = ()

    @classmethod
    def of(
        cls, model: Model, library: Library, *, strict: bool = True, zeros: bool = False, linear: Collection[str] = ()
    ) -> Self:
        """Build the contributors of a model, and number their items; arguments and errors as in `build_blocks`."""
        contributors = cls(
            build_blocks(model, library, strict=strict, zeros=zeros, linear=linear),
            follower_blocks(model, library),
            tuple(heat_load_blocks(model, library)),
            [ContactBlock(model, pair) for pair in model.contacts],
            [DistributingBlock(model)] if model.couplings else [],
        )
        first = 0
        for contributor in contributors:
            contributor.first = first
            first += len(contributor.rows)
        return contributors

    def __iter__(self) -> Iterator[Contributor]:
        return chain(self.elements, self.others)

    @property
    def others(self) -> Iterator[Contributor]:
        """Contributors other than elements."""
        return chain(self.followers, self.heat, self.contacts, self.couplings)

    @property
    def shared(self) -> Sequence[ElementBlock]:
        """Contributors whose items are divided among the ranks; a job on several ranks has no others."""
        return (*self.elements, *self.followers, *self.heat)
