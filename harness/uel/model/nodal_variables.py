# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodal variables by their Abaqus names: which component of which array of the solution they are.

A harmonic response has amplitudes, and phase angles in degrees by the same names after a P: U1 and PU1.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import (
    CONCENTRATION,
    DISPLACEMENTS,
    LAST_TEMPERATURE,
    POTENTIAL,
    ROTATIONS,
    TEMPERATURE,
    WARPING,
    dof_in_deck,
)
from uel.model.records import Solution

PHASE = "P"

# name of the component of each degree of freedom, by quantity; temperatures and the concentration follow
_NAMES: dict[str, dict[int, str]] = {
    "displacement": {1: "U1", 2: "U2", 3: "U3", 4: "UR1", 5: "UR2", 6: "UR3", 7: "WARP", 8: "POR", 9: "EPOT"},
    "reaction": {1: "RF1", 2: "RF2", 3: "RF3", 4: "RM1", 5: "RM2", 6: "RM3", 7: "RWM", 8: "RVF", 9: "RECUR"},
    "velocity": {1: "V1", 2: "V2", 3: "V3", 4: "VR1", 5: "VR2", 6: "VR3"},
    "acceleration": {1: "A1", 2: "A2", 3: "A3", 4: "AR1", 5: "AR2", 6: "AR3"},
    "load": {1: "CF1", 2: "CF2", 3: "CF3", 4: "CM1", 5: "CM2", 6: "CM3", 7: "CW", 8: "CVF", 9: "CECUR"},
}
for _dof in range(TEMPERATURE, LAST_TEMPERATURE + 1):
    _NAMES["displacement"][_dof] = f"NT{_dof}"
    _NAMES["reaction"][_dof] = f"RFL{_dof}"
    _NAMES["load"][_dof] = f"CFL{_dof}"
_NAMES["displacement"][CONCENTRATION] = "NNC11"

_CHARGES = {"RCHG": ("reaction", POTENTIAL), "CECHG": ("load", POTENTIAL)}
"""Charges of piezoelectric elements: minus the values of the array."""

COMPONENTS = {name: (quantity, dof) for quantity, names in _NAMES.items() for dof, name in names.items()} | _CHARGES
"""Array of `Solution` and dof of each component."""
_GROUPS = {
    "U": ("displacement", range(1, WARPING + 1)),
    "UT": ("displacement", DISPLACEMENTS),
    "UR": ("displacement", ROTATIONS),
    "NT": ("displacement", range(TEMPERATURE, LAST_TEMPERATURE + 1)),
    "NNC": ("displacement", (CONCENTRATION,)),
    "V": ("velocity", range(1, ROTATIONS[-1] + 1)),
    "VT": ("velocity", DISPLACEMENTS),
    "VR": ("velocity", ROTATIONS),
    "A": ("acceleration", range(1, ROTATIONS[-1] + 1)),
    "AT": ("acceleration", DISPLACEMENTS),
    "AR": ("acceleration", ROTATIONS),
    "RF": ("reaction", range(1, WARPING + 1)),
    "RT": ("reaction", DISPLACEMENTS),
    "RM": ("reaction", ROTATIONS),
    "RFL": ("reaction", range(TEMPERATURE, CONCENTRATION + 1)),
    "CF": ("load", range(1, WARPING + 1)),
    "CM": ("load", ROTATIONS),
    "CFL": ("load", range(TEMPERATURE, CONCENTRATION + 1)),
}


@dataclass(frozen=True, slots=True)
class Component:
    """One nodal component: its name, the array of `Solution` it is in, and its degree of freedom.

    phase  whether it is the phase angle
    sign   of what the array has: charges are minus the forces of potentials
    """

    name: str
    quantity: str
    dof: int
    phase: bool = False
    sign: int = 1

    def values(self, solution: Solution, positions: IntArray | slice = slice(None)) -> FloatArray:
        """Return values at some unknowns; of a harmonic response amplitudes,
        or phase angles in degrees from -180 to 180.
        """
        values: FloatArray = self.sign * getattr(solution, self.quantity)[positions]
        if solution.imaginary is None:
            return values
        harmonic = values + 1j * self.sign * getattr(solution.imaginary, self.quantity)[positions]
        part: FloatArray = np.angle(harmonic, deg=True) if self.phase else np.abs(harmonic)
        return part


class NodalIndex:
    """Index of the unknown of a node and dof in the arrays of a solution."""

    def __init__(self, nodes: int, solution: Solution) -> None:
        self._position = np.full((nodes, CONCENTRATION + 1), -1, dtype=np.int64)
        # not the unknowns of elements, and not along directions of *TRANSFORM
        of_nodes = np.flatnonzero((solution.node < nodes) & (solution.dof <= CONCENTRATION))
        self._position[solution.node[of_nodes], solution.dof[of_nodes]] = of_nodes

    def find(self, nodes: IntArray, dof: int) -> IntArray:
        """Return positions (len(nodes),), -1 for nodes without the dof."""
        positions: IntArray = self._position[nodes, dof]
        return positions

    def components(self, variables: Iterable[str], nodes: IntArray, *, harmonic: bool = False) -> list[Component]:
        """Return the requested components that any of the nodes has, in order and without repetition.

        Where the response is harmonic there are phase angles too.
        """
        present = np.flatnonzero((self._position[nodes] >= 0).any(axis=0))
        components: dict[str, Component] = {}
        for variable in variables:
            phase = harmonic and not _known(variable) and variable.startswith(PHASE)
            bare = variable.removeprefix(PHASE) if phase else variable
            quantity, dofs = _meant(bare)
            for dof in dofs:
                if dof in present:
                    name = PHASE * phase + (bare if bare in _CHARGES else _name(quantity, dof))
                    components.setdefault(name, Component(name, quantity, dof, phase, -1 if bare in _CHARGES else 1))
        return list(components.values())


def _name(quantity: str, dof: int) -> str:
    """Return the name of a component; fluxes are those of dof 11, of heat or of a concentration."""
    return _NAMES[quantity].get(dof) or _NAMES[quantity][dof_in_deck(dof)]


def _known(variable: str) -> bool:
    return variable in COMPONENTS or variable in _GROUPS


def _meant(variable: str) -> tuple[str, Iterable[int]]:
    """Return the array of `Solution` and the dofs of a variable; no dofs if it is unknown."""
    if variable in COMPONENTS:
        quantity, dof = COMPONENTS[variable]
        return quantity, ((dof,) if quantity == "displacement" or dof != TEMPERATURE else (dof, CONCENTRATION))
    return _GROUPS.get(variable, ("", ()))
