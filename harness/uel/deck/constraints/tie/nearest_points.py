# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nearest points of the main surface of *TIE: weights of its nodes there, and the distances.

`harness/uel/contact/face_surface.py` projects onto the faces (`projection.py` beside it), as in contact.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from uel.contact import FaceSurface
from uel.deck.constraints.tie.faces import TiedFaces
from uel.deck.contact.sliding_surfaces import whole_pieces
from uel.model.arrays import FloatArray, IntArray

if TYPE_CHECKING:
    from scipy.spatial import cKDTree


def nearest_points(
    points: FloatArray, main: IntArray, faces: TiedFaces | None, coordinates: FloatArray, dimension: int
) -> tuple[sparse.csr_array, FloatArray]:
    """Return weights (m, n) of the nodes of the model at the points of the main surface nearest to `points`.

    On faces `harness/uel/contact/face_surface.py` chooses the face, with the closest point projection of
    `fortran/host/contact/faces.f90`.

    Parameters
    ----------
    points
        (m, 3) coordinates of the secondary nodes.
    main, faces
        Nodes and faces of the main surface; without faces the nearest node is the point.
    coordinates
        (n, 3) coordinates of all nodes.
    dimension
        3 in space, else 2.

    Returns
    -------
    weights, distances
        (m, n), and distances (m,) from the points.
    """
    m, n = len(points), len(coordinates)
    if faces is None:
        distance, index = _search_tree(coordinates[main]).query(points)
        entries = (np.ones(m), (np.arange(m), main[index]))
        return sparse.coo_array(entries, shape=(m, n)).tocsr(), np.asarray(distance)
    surface = FaceSurface(whole_pieces(faces.nodes), coordinates[:, :dimension])
    nodes, factors = surface.nearest(points[:, :dimension])
    rows = np.repeat(np.arange(m), nodes.shape[1])
    weights = sparse.coo_array((factors.ravel(), (rows, nodes.ravel())), shape=(m, n)).tocsr()
    weights.eliminate_zeros()
    return weights, np.asarray(np.linalg.norm(points - weights @ coordinates, axis=1))


def mean_spacing(points: FloatArray) -> float:
    """Return the mean distance to the nearest neighbour; 1 for a single point."""
    if len(points) == 1:
        return 1.0
    distance, _ = _search_tree(points).query(points, k=2)
    return float(distance[:, 1].mean())


def _search_tree(points: FloatArray) -> cKDTree:
    """Build a search tree of points (n, 3)."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (takes 0.2 s, and few decks have ties)

    return cKDTree(points)
