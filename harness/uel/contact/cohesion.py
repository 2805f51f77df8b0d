# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-based cohesive behaviour of points in contact at the start.

The tractions follow from clearance and slip since the start, by the law of cohesive elements of unit thickness. Closed
points have the contact force in place of the normal traction; friction acts in parallel, and its sticking stiffness
grows with the damage (Abaqus Analysis User's Guide, "Contact cohesive behavior").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uel.contact.kinematics import Slips
from uel.elements.families.cohesive import directions, law_properties
from uel.errors import DeckError
from uel.model.arrays import FloatArray
from uel.model.contact import Cohesion, ContactPair, SlidingPair
from uel.model.restart import Saved
from uel.usersub import _points

TRACTION, DAMAGE, DISSIPATED, VISCOUS, CRITERION = slice(3, 6), 6, slice(7, 10), 10, 12
"""Indices in the state of a point (`_points.POINT_REALS`)."""


@dataclass(frozen=True, slots=True)
class Bonding:
    """Response of the bonds of m points; zero without a bond.

    slips   slips since the start
    normal  (m,) attractive normal forces
    shear   (m, t) forces, in the components of the slips
    by      (m, 1 + t, 1 + t) derivatives of normal and shear by clearance and slip
    """

    slips: Slips
    normal: FloatArray
    shear: FloatArray
    by: FloatArray


class Bonds:
    """The bonds of a pair: committed and trial slips since the start (m, components) and states of the law."""

    def __init__(self, pair: ContactPair | SlidingPair, bonded: NDArray[np.bool_], components: int) -> None:
        """Prepare the bonds of the points in the mask (m,); components of the slips. Raises DeckError."""
        cohesion = pair.property.cohesion
        assert cohesion is not None
        self._pair, self._cohesion, self.bonded = pair, cohesion, bonded
        if components == 3 and not _isotropic(cohesion):
            raise DeckError(
                pair.source,
                f"*{pair.keyword}: the cohesive behavior of {pair.property.name} depends on the direction of shear, "
                "which is not supported in finite sliding in space; expected SMALL SLIDING, or the same values for "
                "both directions and CRITERION=QUADS or QUADU",
            )
        moduli, damage = directions(cohesion.stiffness, pair.dimension), cohesion.damage
        viscosity = damage.viscosity if damage else 0.0
        reals, integers = law_properties(moduli, damage, pair.dimension, 1.0, (viscosity, 1.0))
        self._law, self._shear = (reals, integers.astype(np.int32)), moduli[1]
        m = len(bonded)
        self.slip = self._slip_trial = np.zeros((m, components))
        self._state = self._state_trial = np.zeros((m, _points.POINT_REALS))
        self._stored = np.zeros(m)
        self._areas = np.ones(m)

    @property
    def damage(self) -> FloatArray:
        """Damage (m,) at the start of the increment; 1 without a bond."""
        return np.where(self.bonded, self._state[:, DAMAGE], 1.0)

    def respond(
        self, time: float, clearance: FloatArray, slips: Slips, areas: FloatArray, pulled: NDArray[np.bool_]
    ) -> Bonding:
        """Compute a trial response over the time increment.

        Parameters
        ----------
        time
            Of the increment.
        clearance, slips, areas
            Of the points.
        pulled
            (m,) whether the bond acts along the normal.
        """
        m, dimension = len(clearance), self._pair.dimension
        rows = np.flatnonzero(self.bonded)
        separations = np.zeros((m, 3))
        separations[:, 0] = np.where(pulled, clearance, 0.0)
        separations[:, 1:dimension] = np.einsum("mat,mt->ma", slips.axes, slips.value)
        states, tangents = self._state.copy(), np.zeros((m, 3, 3))
        states[rows], tangents[rows], brittle = _points.traction_separation(
            self._law, time, separations[rows], self._state[rows]
        )
        if brittle is not None:
            self._refuse(int(rows[brittle[0]]), brittle[1])
        self._slip_trial, self._state_trial, self._areas = slips.value, states, areas
        tractions = np.where(self.bonded[:, None], states[:, TRACTION], 0.0)
        self._stored = 0.5 * np.einsum("mi,mi->m", tractions, separations)
        tangents[~pulled, 0] = tangents[~pulled, :, 0] = 0.0
        frame = np.zeros((m, dimension, 1 + slips.axes.shape[2]))
        frame[:, 0, 0], frame[:, 1:, 1:] = 1.0, slips.axes
        by = np.einsum("mia,mij,mjb->mab", frame, tangents[:, :dimension, :dimension], frame)
        # rotation of the tangent plane, and of an isotropic shear traction with it
        across = np.eye(slips.axes.shape[2]) - np.einsum("mat,mas->mts", slips.axes, slips.axes)
        intact = np.where(self.bonded, 1.0 - states[:, DAMAGE], 0.0)
        by[:, 1:, 1:] += (self._shear * intact)[:, None, None] * across
        normal = areas * np.where(pulled, tractions[:, 0], 0.0)
        shear = areas[:, None] * np.einsum("mat,ma->mt", slips.axes, tractions[:, 1:dimension])
        return Bonding(slips, normal, shear, areas[:, None, None] * by)

    def _refuse(self, point: int, fault: float) -> None:
        damage = self._cohesion.damage
        assert damage is not None
        assert damage.evolution is not None
        raise DeckError(
            damage.evolution.source,
            f"*DAMAGE EVOLUTION: the fracture energy at the mode mix must exceed the elastic energy at the onset of "
            f"damage, and falls short by {fault:.2e} at point {point + 1} of contact pair {self._pair.name}",
        )

    @property
    def energies(self) -> tuple[FloatArray, float]:
        """Energies after a trial: ENERGY (8,) with the stored energy and the viscous dissipation,
        and the dissipation by damage.
        """
        state, energy = self._state_trial, np.zeros(8)
        energy[1], energy[2] = self._areas @ self._stored, self._areas @ state[:, VISCOUS]
        return energy, float(self._areas @ state[:, DISSIPATED].sum(axis=1))

    @property
    def output(self) -> dict[str, FloatArray]:
        """Variables (m,) by their names in Abaqus, NaN without a bond."""
        damage = self._cohesion.damage
        names = {} if damage is None else {"CSDMG": DAMAGE, f"CS{damage.criterion}CRT": CRITERION}
        return {name: np.where(self.bonded, self._state_trial[:, index], np.nan) for name, index in names.items()}

    def commit(self) -> None:
        """Commit the trial state at the end of a converged increment."""
        self.slip, self._state = self._slip_trial, self._state_trial

    def kept(self) -> Saved:
        """Return the committed state, not copied."""
        return {"bonded": self.bonded, "slip": self.slip, "state": self._state}

    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned."""
        self.bonded, self.slip, self._state = saved["bonded"], saved["slip"], saved["state"]
        self._slip_trial, self._state_trial = self.slip, self._state


def _isotropic(cohesion: Cohesion) -> bool:
    """Return whether the tractions are independent of the direction of the slip."""
    first, second = directions(cohesion.stiffness, 3)[1:]
    damage = cohesion.damage
    if damage is None or first != second:
        return first == second
    evolution = damage.evolution
    if damage.onset[1] != damage.onset[2] or damage.criterion not in ("QUADS", "QUADU"):
        return False
    if evolution is None or evolution.mixed_mode in ("", "BK"):
        return True
    return evolution.values[1] == evolution.values[2] and evolution.power == 1.0
