# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Control by dissipated energy: traces snap-backs of structures that unload to the origin.

M. A. Gutierrez, "Energy release control for numerical simulations of failure in quasi-brittle solids", Communications
in Numerical Methods in Engineering 20 (2004) 19-29. A solid with damage unloads along its secant, so it stores half of
the work of the external forces F (reactions included) on its displacements u, and an increment dissipates

    tau = 1/2 (F_0 . du - dF . u_0),

exactly if F and u vary linearly in it. (An elastic structure that stiffens would seem to dissipate negative energy:
this is for damage at small displacements.) An increment ends when it has dissipated tau or when the load factor lam has
grown by its size, whichever comes first: without dissipation it is an increment of load, in a snap-back lam falls. The
user need not choose tau: it is half the work that the largest forces so far do on that growth of lam. Symbols are those
of `newton` and `path`.
"""

from __future__ import annotations

from uel.assembly import Constraints
from uel.model.arrays import FloatArray
from uel.solver.path import Directions, PathIncrement, PathIterate, Reaction

ELASTIC = 1e-3
"""Dissipation per unit of the load factor, over the work, below which a tangent counts as elastic."""


class Dissipation:
    """Control by dissipated energy; call `start` before each increment.

    Parameters
    ----------
    constraints
        Constraints of the step.
    """

    def __init__(self, constraints: Constraints) -> None:
        self._constraints = constraints
        self._work = 0.0

    def start(
        self,
        increment: PathIncrement,
        f_ext: FloatArray,
        reaction: FloatArray,
        *,
        size: float,
        left: float,
    ) -> None:
        """Start an increment.

        Parameters
        ----------
        increment
            Definition of the increment.
        f_ext, reaction
            (n,) external forces at its start, reactions included, and reactions.
        size
            Growth of lam at which the increment ends without dissipation; also the largest fall of lam.
        left
            Growth of lam up to the end of the step.
        """
        self._increment, self._f_ext, self._reaction = increment, f_ext, reaction
        self._size, self._rise = size, min(size, left)

    def change(self, state: PathIterate, directions: Directions, reaction: Reaction) -> float:
        """Return dlam towards the target, linearised, within the limits of the increment."""
        du_lam, du_r, u = directions.du_lam, directions.du_r, self._increment.u
        work = float(self._f_ext @ du_lam)
        released = float((self._increment.f_ref + reaction(du_lam, 1.0)) @ u)
        if state.iteration == 0:
            self._work = max(self._work, abs(work))
        largest = self._rise - state.lam
        if abs(work - released) <= ELASTIC * (abs(work) + abs(released)):
            return largest
        expected = self.dissipated(state) + 0.5 * float(self._f_ext @ du_r - reaction(du_r, 0.0) @ u)
        dlam = (0.5 * self._work * self._size - expected) / (0.5 * (work - released))
        return min(max(dlam, -self._size - state.lam), largest)

    def dissipated(self, state: PathIterate) -> float:
        """Return the energy tau dissipated so far in the increment."""
        df_ext = state.lam * self._increment.f_ref + self._constraints.reactions(state.r) - self._reaction
        return 0.5 * float(self._f_ext @ state.du - df_ext @ self._increment.u)
