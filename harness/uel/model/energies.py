# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Energies of the whole model and of element sets, by Abaqus name: ALLSE, ALLPD, ALLWK, ETOTAL and others.

Elements add to ENERGY. `harness/uel/procedures/state.py` holds its sum over the elements, and adds up the external
work and the dissipation by *STATIC, STABILIZE.
"""

from __future__ import annotations

from typing import Final

from uel.model.arrays import FloatArray

ENERGIES: Final = (
    *("ALLAE", "ALLCD", "ALLDMD", "ALLIE", "ALLKE", "ALLPD", "ALLSD", "ALLSE", "ALLVD", "ALLWK", "ETOTAL"),
)
"""Energies of the whole model that a general step has."""

ELEMENT_ENERGIES: Final = ("ALLAE", "ALLCD", "ALLDMD", "ALLIE", "ALLKE", "ALLPD", "ALLSE", "ALLVD")
"""Energies that are sums over elements, which element sets have too."""

PLASTIC: Final = 3
"""Position in ENERGY of the dissipation by plasticity or, in some elements, by damage."""


def external_work(before: FloatArray, after: FloatArray, du: FloatArray, energy: FloatArray) -> float:
    """Return the external work of an increment, by the trapezoidal rule.

    Parameters
    ----------
    before, after
        (n,) external forces and reactions at its ends.
    du
        (n,) what moved, with signs that make a product with a force its work.
    energy
        (8,) sum of ENERGY over the elements; ENERGY(8) is the work of loads that they apply themselves, in this
        increment only.
    """
    return 0.5 * float((before + after) @ du) + float(energy[7])


def energies_of_elements(energy: FloatArray, damage: float) -> dict[str, float]:
    """Return energies by Abaqus name from a sum (8,) of ENERGY, and the dissipation by damage."""
    kinetic, elastic, creep, plastic, viscous, artificial, electrostatic = (float(e) for e in energy[:7])
    return {
        "ALLSE": elastic,
        "ALLPD": plastic,
        "ALLDMD": damage,
        "ALLCD": creep,
        "ALLVD": viscous,
        "ALLAE": artificial,
        "ALLKE": kinetic,
        "ALLIE": elastic + plastic + damage + creep + artificial + electrostatic,
    }


def energies_of_model(energy: FloatArray, damage: float, stabilization: float, work: float) -> dict[str, float]:
    """Return the energies of the whole model, summed as in Abaqus: ETOTAL is constant if they balance.

    Parameters
    ----------
    energy, damage
        Of all elements, as in `energies_of_elements`.
    stabilization
        Dissipation by *STATIC, STABILIZE: ALLSD.
    work
        External work: ALLWK.
    """
    energies = energies_of_elements(energy, damage)
    total = energies["ALLKE"] + energies["ALLIE"] + energies["ALLVD"] + stabilization - work
    return energies | {"ALLSD": stabilization, "ALLWK": work, "ETOTAL": total}
