# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of like elements: Python sees blocks, never single elements."""

from harness.elements.block import ElementBlock
from harness.elements.build import build_blocks
from harness.elements.call import BlockReport, Call, Distributed, Motion, Predefined
from harness.elements.contact import ContactBlock, contact_blocks
from harness.elements.contact_sliding import FiniteSliding, normals_of
from harness.elements.contact_surface import FaceSurface, monomials
from harness.elements.contact_surfaces import FACING, SurfaceSliding
from harness.elements.distributing import DistributingBlock, distributing_blocks
from harness.elements.fields import COUPLED, FIELD_NAMES, MULTIPLIER, PRESSURE, REFERENCE, VOLUME, field_of
from harness.elements.followers import FollowerBlock
from harness.elements.heat_loads import HeatLoadBlock
from harness.elements.lflags import Damping, Flags, Request
from harness.elements.rigid_surface import RigidSurface
from harness.elements.rotations import PERMUTATION, rotation_matrices, spin_matrices

__all__ = [
    "COUPLED",
    "FACING",
    "FIELD_NAMES",
    "MULTIPLIER",
    "PERMUTATION",
    "PRESSURE",
    "REFERENCE",
    "VOLUME",
    "BlockReport",
    "Call",
    "ContactBlock",
    "Damping",
    "Distributed",
    "DistributingBlock",
    "ElementBlock",
    "FaceSurface",
    "FiniteSliding",
    "Flags",
    "FollowerBlock",
    "HeatLoadBlock",
    "Motion",
    "Predefined",
    "Request",
    "RigidSurface",
    "SurfaceSliding",
    "build_blocks",
    "contact_blocks",
    "distributing_blocks",
    "field_of",
    "monomials",
    "normals_of",
    "rotation_matrices",
    "spin_matrices",
]
