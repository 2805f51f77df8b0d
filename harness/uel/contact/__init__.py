# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact: blocks of contact points, their motion over the surfaces, bonds and friction."""

from uel.contact.block import ContactBlock
from uel.contact.face_surface import FaceSurface
from uel.contact.finite_sliding import FiniteSliding, normals_of
from uel.contact.nodal_fields import nodal_fields
from uel.contact.rigid_surface import RigidSurface
from uel.contact.shape_functions import monomials
from uel.contact.surface_finite_sliding import FACING, SurfaceSliding, square_samples, triangle_samples

__all__ = [
    "FACING",
    "ContactBlock",
    "FaceSurface",
    "FiniteSliding",
    "RigidSurface",
    "SurfaceSliding",
    "monomials",
    "nodal_fields",
    "normals_of",
    "square_samples",
    "triangle_samples",
]
