# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""meshio with the dimension of wedges of 15 nodes, without which it neither reads nor writes them."""

from __future__ import annotations

import meshio
from meshio._mesh import topological_dimension

__all__ = ["meshio"]

# meshio 5.3.5 has the cell, but ends with a KeyError where it asks for its dimension
topological_dimension.setdefault("wedge15", 3)
