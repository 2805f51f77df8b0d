# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method with a descent search for when it fails (`--fallback`).

Where elements soften, the tangent K is indefinite while one of them snaps. The Newton correction c then climbs
(c . r < 0, r the residual), or jumps across the solution and back for ever. The search goes downhill instead:

- d = c where c . r > 0, else d = -c: the correction points to a saddle, and this is the side of it on which the energy
  falls. If d is almost orthogonal to K_0^-1 r, or no scale lowers the residual along d, or K is singular,
  d = K_0^-1 r. After a step of a hundredth of c or less, which would repeat itself near a singular K, c is that of
  K + mu (K_0 - K); mu grows fourfold after each such step and falls after good ones;
- a scale s with |d . r(s)| <= 0.25 d . r(0): fourfold growth while the residual still points along d, since a step must
  be long where an element fails, then regula falsi.

It uses only the residual and the matrix, since a UEL returns nothing else.

**Convergence.** Let the element forces be the gradient of an energy that K_0, the matrix at the start of the analysis,
majorises, such as that of bilinear damage in one mode, where softening only lowers the stiffness. Then the energy falls
along d up to the first zero of d . r(s), the scale is within a fraction of that zero, and the angle between d and
K_0^-1 r is bounded away from 90 degrees. So each iteration lowers the energy by at least a fixed multiple of
r . K_0^-1 r (Zoutendijk's theorem), and the residual tends to zero if the energy is bounded below: always under
prescribed displacements; under loads, if the structure can carry them. In general the equilibrium is stable; after a
snap it is one of several that satisfy static equilibrium.

**Limits.** Scales are sampled: a step may pass over a first valley into a higher one, which costs iterations.
Mixed-mode damage, Nitsche terms and friction make K unsymmetric: there is no energy, d . r is only the work of the
residual, and the search is a heuristic. The iterates may circle an equilibrium: each step goes downhill, and the
forces work on a closed path. Where an iterate comes back to one of the last, the next one is the mean of those
between, which is near the equilibrium. An attempt ends after `ITERATIONS` and is then cut back as without the search.

**Rejected alternatives.** The mean wherever corrections sum up to little of their length, which a narrow valley does
too: 88,000 iterations instead of 6,000 until 98 % of enf_0_90_standard_1e8 of `abaqus_inputs/paper_enf`. Anderson
acceleration of d by the previous one, in the metric of K_0, if it points downhill: 1,696 iterations instead of 1,472,
and 7,167 passes over the elements instead of 6,514, on the row dcb_0-90_1e8_standard_structured_fallback of
`fortran/study.md`. A search that begins with the scale of the previous iteration: 17,552 iterations instead of 21,146
in 22 hard rows of the study, and 2 % more in the others, but enf_0_90_standard_1e8_perturbed of
`abaqus_inputs/paper_enf` stops at 97 %. No extrapolation into the increment after a search: 5,992 iterations instead
of 1,228 on the first row with perturbed nodes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from uel.assembly import Constraints, System
from uel.errors import SingularMatrixError
from uel.model.arrays import FloatArray
from uel.model.controls import LineSearchControls
from uel.solver.linesearch import descend
from uel.solver.newton import Factoriser, Increment, Iterate, Newton

ITERATIONS = 500
"""Iterations after which an attempt is abandoned: dozens of elements may fail in it, each in a few iterations."""

SMALLEST_COSINE = 1e-6
"""Smallest cosine between d and K_0^-1 r, in the metric of K_0; in delaminating beams it stays above 1e-4."""

NEGLIGIBLE = 1e-8
"""Difference of an extrapolation from the prescribed values, over these, that counts as rounding."""

ROUNDING = 1e-14
"""Rounding error of a residual over the sum of all element forces."""

SHORT, GOOD = 0.01, 0.5
"""Scale below which K_0 is blended into K, and scale from which on the share of K_0 falls."""

FIRST_SHARE, CHANGE = 0.01, 4.0
"""Share of K_0 after the first short step, and the factor of its changes."""

WINDOW, CIRCLING = 10, 0.01
"""Corrections looked back on, and the distance of two iterates, over the way between them, below which they circle."""

UPHILL = "THE CORRECTION WENT UPHILL"
GROWING = "THE RESIDUAL ALONG THE CORRECTION GREW"
SINGULAR = "THE MATRIX WAS SINGULAR"


class Majoriser:
    """K_0, the matrix of the first pass of the analysis; it is factorised when it is first used."""

    def __init__(self) -> None:
        self._data: FloatArray | None = None
        self._make: Callable[[], Factoriser] | None = None
        self._solver: Factoriser | None = None

    def use(self, system: System, constraints: Constraints, make: Callable[[], Factoriser]) -> None:
        """Set the constraints; make: returns a linear solver for their pattern."""
        self._system, self._constraints, self._make, self._solver = system, constraints, make, None

    def keep(self, data: FloatArray) -> None:
        """Copy K_0 (CSR values); calls after the first have no effect."""
        if self._data is None:
            self._data = data.copy()

    def blend(self, data: FloatArray, share: float) -> FloatArray:
        """Return K + share (K_0 - K), CSR values; K itself for a share of 0."""
        if not share:
            return data
        assert self._data is not None
        return (1.0 - share) * data + share * self._data

    def direction(self, reduced: FloatArray) -> FloatArray:
        """Return K_0^-1 r (n,) of a reduced residual. Raises SingularMatrixError."""
        assert self._data is not None and self._make is not None
        known = self._solver is not None
        if self._solver is None:
            self._solver = self._make()
        if self._constraints.arms or not known:
            self._solver.factorise(self._constraints.reduce(self._data))
        return self._constraints.expand(self._solver.solve(reduced), np.zeros(len(self._constraints.prescribed)))

    def norm(self, vector: FloatArray) -> float:
        """Return the square root of |v . K_0 v|."""
        assert self._data is not None
        return float(np.sqrt(abs(vector @ self._system.product(self._data, vector))))


class Descent(Newton):
    """Newton iterations that turn into the descent search when they fail, until the attempt ends.

    reason  reason why the search took over in this attempt, '' if it has not
    since   iteration in which it took over
    """

    def __init__(
        self,
        system: System,
        constraints: Constraints,
        solver: Factoriser,
        line_search: LineSearchControls,
        majoriser: Majoriser,
    ) -> None:
        super().__init__(system, constraints, solver, line_search)
        self._majoriser = majoriser
        self.reason = ""
        self.since = 0
        self._share = 0.0
        # du (n,) of the search since it began, or since the last mean
        self._visited: list[FloatArray] = []

    def take_over(self, iteration: int, reason: str) -> None:
        """Search from this iteration on; later calls in an attempt have no effect."""
        if not self.reason:
            self.since, self.reason = iteration, reason

    def _advance(self, increment: Increment, state: Iterate, ddu_p: FloatArray) -> Iterate:
        assert state.evaluation.data is not None
        if state.iteration == 0:
            self.reason, self._share, self._visited = "", 0.0, []
            self._majoriser.keep(state.evaluation.data)
        if np.abs(ddu_p).max(initial=0.0) > NEGLIGIBLE * np.abs(increment.du_p).max(initial=0.0):
            # the correction contains the prescribed values and must be applied in full
            return super()._advance(increment, state, ddu_p)
        iteration = state.iteration + 1
        if self.reason and (centre := self._centre(state.du)) is not None:
            return self._evaluate(increment.call, increment, iteration, centre, centre - state.du)
        try:
            data = self._majoriser.blend(state.evaluation.data, self._share)
            blended = replace(state, evaluation=replace(state.evaluation, data=data))
            ddu = self._correction(blended, np.zeros_like(ddu_p))
        except SingularMatrixError:
            self.take_over(iteration, SINGULAR)
            return self._descend(increment, state, ddu_p, self._majoriser.direction(state.r_q))
        slope, noise = float(ddu @ state.r), _noise(state, ddu)
        if slope < -noise:
            self.take_over(iteration, UPHILL)
        if self.reason:
            return self._descend(increment, state, ddu_p, self._downhill(state, ddu))
        new = self._apply(increment, state, ddu + self._lift(ddu_p), searchable=True)
        if new.evaluation.pnewdt < 1.0 or abs(float(self._constraints.project(ddu) @ new.r)) <= slope + noise:
            return new
        self.take_over(iteration, GROWING)
        self._restore(increment, state)
        return self._descend(increment, state, ddu_p, self._downhill(state, ddu))

    def _restore(self, increment: Increment, state: Iterate) -> None:
        """Update the constraints to a state, after trials."""
        at = increment.u + state.du
        self._constraints.update(at, state.r, state.du, increment.weight)

    def _lift(self, ddu_p: FloatArray) -> FloatArray:
        """Return the correction (n,) with ddu_p (n_p,) at the prescribed unknowns and zero at the free ones."""
        return self._constraints.expand(np.zeros(len(self._constraints.free)), ddu_p)

    def _downhill(self, state: Iterate, ddu: FloatArray) -> FloatArray:
        """Return the correction ddu, -ddu, or K_0^-1 r where ddu is almost orthogonal to that."""
        slope = float(ddu @ state.r)
        steepest = self._majoriser.direction(state.r_q)
        length = self._majoriser.norm(ddu) * self._majoriser.norm(steepest)
        if abs(slope) <= SMALLEST_COSINE * length:
            return steepest
        return ddu if slope > 0.0 else -ddu

    def _centre(self, du: FloatArray) -> FloatArray | None:
        """Return the mean (n,) of the iterates of a circle if they circle; None if they do not, or are too few."""
        self._visited.append(du)
        if len(self._visited) <= WINDOW:
            return None
        way = 0.0
        for k in range(WINDOW - 1, -1, -1):
            way += self._majoriser.norm(self._visited[k + 1] - self._visited[k])
            if not np.isfinite(way):
                break
            if k < WINDOW - 1 and self._majoriser.norm(self._visited[-1] - self._visited[k]) < CIRCLING * way:
                centre: FloatArray = np.mean(self._visited[k:-1], axis=0)
                self._visited = []
                return centre
        del self._visited[0]
        return None

    def _adapt(self, scale: float) -> None:
        """Blend more of K_0 into the matrix after a short step, less after a good one."""
        if scale < SHORT:
            self._share = min(max(FIRST_SHARE, CHANGE * self._share), 1.0)
        elif scale >= GOOD:
            self._share = self._share / CHANGE if self._share > FIRST_SHARE else 0.0

    def _descend(self, increment: Increment, state: Iterate, ddu_p: FloatArray, direction: FloatArray) -> Iterate:
        """Return the state at the scale of `descend` along a direction, or along K_0^-1 r if that scale is 0."""
        start = state.du + self._lift(ddu_p)

        def component(scale: float) -> float | None:
            evaluation, r = self._trial(increment, start + scale * direction)
            work = float(self._constraints.project(direction) @ r)
            return work if evaluation.pnewdt >= 1.0 else None

        scale, tried = descend(component, float(direction @ state.r))
        if scale == 0.0:
            self._restore(increment, state)
            direction = self._majoriser.direction(state.r_q)
            scale, more = descend(component, float(direction @ state.r))
            tried += more
        self._adapt(scale)
        end = start + (scale or tried[-1]) * direction
        new = self._evaluate(increment.call, increment, state.iteration + 1, end, end - state.du)
        return replace(new, line_search=tried)


def _noise(state: Iterate, ddu: FloatArray) -> float:
    """Return the work of the rounding errors of the residual on a correction ddu."""
    return ROUNDING * float(state.evaluation.flux.sum()) * float(np.abs(ddu).max(initial=0.0))
