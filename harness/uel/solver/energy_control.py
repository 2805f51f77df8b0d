# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Control by dissipated energy: traces snap-backs of structures that unload to the origin.

M. A. Gutierrez, "Energy release control for numerical simulations of failure in quasi-brittle solids", Communications
in Numerical Methods in Engineering 20 (2004) 19-29. A solid with damage unloads along its secant, so it stores half of
the work of the external forces F (reactions included) on its displacements u, and an increment dissipates

    tau = 1/2 (F_0 . du - dF . u_0),

exactly, if F and u vary linearly in it. (An elastic structure that stiffens would seem to dissipate negative energy:
this is for damage at small displacements.) An increment ends when a given tau is reached or when the load factor has
grown by a given amount, whichever comes first: without dissipation it is an increment of load, in a snap-back the
factor falls. Nobody has to guess the energy: tau is half the work that the largest forces so far do on that growth of
the factor.
"""

from __future__ import annotations

from uel.assembly import Constraints
from uel.model.arrays import FloatArray
from uel.solver.path import Directions, PathIncrement, PathIterate, Reaction

ELASTIC = 1e-3
"""Dissipation per unit of the load factor, over the work, below which a tangent counts as elastic."""


class Dissipation:
    """Control by dissipated energy. Call `start` before each increment.

    Parameters
    ----------
    constraints
        Of the step.
    """

    def __init__(self, constraints: Constraints) -> None:
        self._constraints = constraints
        self._work = 0.0

    def start(
        self,
        given: PathIncrement,
        external: FloatArray,
        reaction: FloatArray,
        *,
        size: float,
        left: float,
    ) -> None:
        """Start an increment.

        Parameters
        ----------
        given
            The increment.
        external, reaction
            (n,) external forces at its start, reactions included, and reactions.
        size
            Growth of the load factor at which it ends if nothing is dissipated; also the largest fall.
        left
            Remaining growth of the load factor.
        """
        self._given, self._external, self._reaction = given, external, reaction
        self._size, self._rise = size, min(size, left)

    def change(self, state: PathIterate, directions: Directions, reaction: Reaction) -> float:
        """Return the change of the load factor towards the target, linearised, within the limits of the increment."""
        v, u = directions.tangent, self._given.displacement
        work = float(self._external @ v)
        released = float((self._given.load_rate + reaction(v, 1.0)) @ u)
        if state.iteration == 0:
            self._work = max(self._work, abs(work))
        largest = self._rise - state.factor
        if abs(work - released) <= ELASTIC * (abs(work) + abs(released)):
            return largest
        c = directions.particular
        expected = self.dissipated(state) + 0.5 * float(self._external @ c - reaction(c, 0.0) @ u)
        change = (0.5 * self._work * self._size - expected) / (0.5 * (work - released))
        return min(max(change, -self._size - state.factor), largest)

    def dissipated(self, state: PathIterate) -> float:
        """Return the energy tau dissipated so far in the increment."""
        change = state.factor * self._given.load_rate + self._constraints.reactions(state.residual) - self._reaction
        return 0.5 * float(self._external @ state.increment - change @ self._given.displacement)
