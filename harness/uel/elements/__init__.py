# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of like elements: Python sees blocks, never single elements."""

from uel.elements.block import ElementBlock
from uel.elements.build import build_blocks
from uel.elements.call import BlockReport, Call, CurrentPass, Distributed, Motion, Predefined
from uel.elements.contributor import Contributor
from uel.elements.distributing import DistributingBlock
from uel.elements.fields import FIELD_NAMES, REFERENCE, VOLUME, field_of
from uel.elements.lflags import Damping, Flags, Request
from uel.elements.loads.followers import FollowerBlock, follower_blocks
from uel.elements.loads.heat import HeatLoadBlock, heat_load_blocks
from uel.elements.rotations import PERMUTATION, rotation_matrices, spin_matrices

__all__ = [
    "FIELD_NAMES",
    "PERMUTATION",
    "REFERENCE",
    "VOLUME",
    "BlockReport",
    "Call",
    "Contributor",
    "CurrentPass",
    "Damping",
    "Distributed",
    "DistributingBlock",
    "ElementBlock",
    "Flags",
    "FollowerBlock",
    "HeatLoadBlock",
    "Motion",
    "Predefined",
    "Request",
    "build_blocks",
    "field_of",
    "follower_blocks",
    "heat_load_blocks",
    "rotation_matrices",
    "spin_matrices",
]
