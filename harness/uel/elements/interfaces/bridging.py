# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The part of bridging fibres in a cohesive law, LAW 5."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray

BRIDGING: Final = 5
"""LAW with fibre bridging."""


def bridging_shares(values: Mapping[str, float]) -> FloatArray:
    """Return the shares of the bridging in the strengths and in the fracture energies.

    Parameters
    ----------
    values
        The properties of an interface element by name, with positive strengths and fracture energies.

    Returns
    -------
    (2, 2)
        Strength and fracture energy (rows) of modes I and II (columns); zeros without LAW 5.
    """
    if int(values["LAW"]) != BRIDGING:
        return np.zeros((2, 2))
    shares = np.empty((2, 2))
    names = (("SIGMABRIDGE", "TAUBRIDGE", "SIGMAMAX", "TAUMAX"), ("GIBRIDGE", "GIIBRIDGE", "GIC", "GIIC"))
    for row, (first, second, all_first, all_second) in enumerate(names):
        share = values.get(first, 0.0) / values[all_first]
        # 0 in mode II stands for the share of mode I
        shares[row] = share, values.get(second, 0.0) / values[all_second] or share
    return shares
