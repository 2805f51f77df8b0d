# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The bilinear cohesive law with fatigue CF20, at points, for `beam_on_cohesive_layer` (N, mm, MPa).

The law answers p = t + beta w, where t is the traction and w the separation. beta only regularises: the pair (t, w)
does not depend on it, and the law may be rigid until it is damaged.

Symbols: D share of the fracture energy that a point has dissipated, B share of mode II in the energy, s traction
over the static one at this D, E endurance limit over the strength, R load ratio, N cycles.

Sources: C. G. Davila, NASA/TP-2018-219838, and Davila et al., NASA/TP-2020-220584, for fatigue (CF20); P. P.
Camanho, C. G. Davila, NASA/TM-2002-211737, for the bilinear law; A. Turon et al., Mechanics of Materials 38 (2006)
1072, for the area under it in mixed mode.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
# complex for derivatives by the complex step
Numbers = NDArray[Any]

NORMAL, SHEAR = 0, 1
COMPLEX_STEP = 1e-30
# damage of a point in an increment: none, by the static curve, stopped by the endurance limit, by cycles, complete
UNCHANGED, STATIC, AT_LIMIT, GROWING, FAILED = range(5)


class Points(NamedTuple):
    """Values at points that D after an increment follows from: s/E = driving/(rigid + softening D).

    `start` is D at the start of the increment in the present mix, `static` D on the static curve, `lowest` D at which
    s = E. dD/dN = factor (s/E)^exponent.
    """

    driving: Numbers
    softness: Numbers
    softening: Numbers
    start: Numbers
    static: Numbers
    lowest: Numbers
    exponent: Numbers
    factor: Numbers


class Response(NamedTuple):
    """Tractions at points, their derivatives by p, history, damage, and its growth in the increment."""

    tractions: Reals
    jacobian: Reals
    history: Reals
    damage: Reals
    growth: Reals


@dataclass(frozen=True, slots=True)
class Cycles:
    """CF20: dD/dN = (1 - D)^(b - p) (s/E)^b/(gamma (p + 1)) for s >= E, with the load ratio R and p = b + p_mod."""

    ratio: float = 0.1
    gamma: float = 1e7
    endurance: float = 0.2
    brittleness: float = 0.95
    p_mod: float = 0.0

    def limit(self, mix: Numbers | float) -> Numbers:
        """Endurance limit E at this load ratio, over the static strength."""
        epsilon = self.endurance * (1.0 - 0.42 * np.asarray(mix))
        return np.asarray(2.0 * epsilon / (epsilon + 1.0 + self.ratio * (epsilon - 1.0)))

    def exponent(self, mix: Numbers | float) -> Numbers:
        """Exponent b."""
        return np.asarray(-7.0 * self.brittleness / np.log10(self.limit(mix)))

    def factor(self, damage: Numbers, exponent: Numbers) -> Numbers:
        """Return dD/dN at the endurance limit."""
        left = np.where(np.real(damage) < 1.0, 1.0 - damage, 1.0)
        return np.asarray(left ** (-self.p_mod) / (self.gamma * (exponent + self.p_mod + 1.0)))

    def rate(self, damage: float, s: float, mix: float) -> float:
        """Return dD/dN."""
        limit, b = self.limit(mix), self.exponent(mix)
        return float(self.factor(np.array(damage), b) * (s / limit) ** b) if s >= limit else 0.0

    def life_at_traction(self, share: float, mix: float = 0.0) -> float:
        """Cycles to failure at a constant `share` of the strength, by integration of the rate at s = share/(1 - D)."""
        b = float(self.exponent(mix))
        return float(self.gamma * (self.limit(mix) / share) ** b * (1.0 - share ** (b + self.p_mod + 1.0)))


@dataclass(frozen=True)
class Law:
    """Bilinear law. `eta` is the exponent of Benzeggagh and Kenane, or None for the linear criterion of energies.

    `stiffness` (N/mm^3) is that of opening before damage, and may be infinite; `ratio` times it is that of sliding.
    """

    strengths: tuple[float, float] = (30.0, 60.0)
    toughnesses: tuple[float, float] = (0.26, 1.002)
    eta: float | None = 2.73
    stiffness: float = np.inf
    ratio: float = 1.0
    cycles: Cycles | None = field(default_factory=Cycles)
    stabilisation: float = 8.0

    def toughness(self, mix: Numbers | float) -> Numbers:
        """Fracture energy (N/mm)."""
        first, second = self.toughnesses
        mix = np.asarray(mix)
        if self.eta is None:
            return np.asarray(1.0 / ((1.0 - mix) / first + mix / second))
        return np.asarray(first + (second - first) * mix**self.eta)

    def softness(self, mix: Numbers | float) -> Numbers:
        """Final separation over strength, with both along the separation (mm^3/N)."""
        normal, shear = self.strengths
        onset = (1.0 - np.asarray(mix)) / normal**2 + mix * self.ratio / shear**2
        return np.asarray(2.0 * self.toughness(mix) * onset)

    @cached_property
    def rigid(self) -> float:
        """Return p over traction before damage, 1 for a rigid layer."""
        return 1.0 + self.beta / self.stiffness

    @cached_property
    def beta(self) -> float:
        """Factor of the separation in p, `stabilisation` times the steepest softening of the law (N/mm^3)."""
        steepest = 1.0 / (self.softness(np.linspace(0.0, 1.0, 101)).min() - 1.0 / self.stiffness)
        if steepest <= 0.0:
            raise ValueError("the law fails before its strength: it needs a larger stiffness")
        return self.stabilisation * float(steepest)

    def direction(self, p: Numbers) -> tuple[Numbers, ...]:
        """Return (p over strength, softness, mix) of p with the components (normal, shear) last."""
        opening = np.where(p[..., NORMAL].real > 0.0, p[..., NORMAL], 1e-12)
        sliding = p[..., SHEAR]
        driving = np.sqrt((opening / self.strengths[NORMAL]) ** 2 + (sliding / self.strengths[SHEAR]) ** 2)
        energy = opening**2 + sliding**2 / self.ratio
        mix = sliding**2 / self.ratio / energy
        return driving, self.softness(mix), mix

    def damage(self, history: Reals, softness: Numbers) -> Numbers:
        """Return D in the present mix from the history, which is D at the same secant stiffness in mode I."""
        secant = history * float(self.softness(0.0))
        return np.asarray(secant / (secant + (1.0 - history) * softness))

    def history(self, damage: Reals, softness: Reals) -> Reals:
        """Return the inverse of `damage`."""
        secant = damage * softness
        return np.asarray(secant / (secant + (1.0 - damage) * float(self.softness(0.0))))

    def respond(self, p: Reals, history: Reals, cycles: float) -> Response:
        """Tractions at p (n, 2) after `cycles`, implicitly: dD/dN is that of s at the end of the jump.

        Its factor (1 - D)^(b - p), which is 1 by default, is taken at the start: so D has one value for each p.
        """
        points = self._points(p, history)
        base = np.clip(np.maximum(points.start, points.static), 0.0, 1.0)
        damage = base
        if self.cycles is not None and cycles > 0.0:
            # the equation is concave in D: from the left Newton's method never passes the root
            for _ in range(100):
                before, damage = damage, np.clip(self._newton(points, damage, cycles), damage, 1.0)
                if np.all(damage - before <= 1e-12):
                    break
        branch = np.where(points.static > points.start, STATIC, UNCHANGED)
        branch[damage > base] = GROWING
        branch[(damage > base) & (damage >= points.lowest)] = AT_LIMIT
        damage = np.where(branch == AT_LIMIT, points.lowest, damage)
        branch[damage >= 1.0] = FAILED
        damage = np.minimum(damage, 1.0)
        jacobian = np.empty((*p.shape, 2))
        for k in (NORMAL, SHEAR):
            moved = p.astype(complex)
            moved[:, k] += COMPLEX_STEP * 1j
            at = self._points(moved, history)
            # one step of Newton's method from the root follows it to first order
            choices = (at.start, at.static, at.lowest, self._newton(at, damage, cycles), np.ones(len(p)))
            jacobian[:, :, k] = self._tractions(moved, np.choose(branch, choices), at.softness).imag / COMPLEX_STEP
        after = np.maximum(history, self.history(damage, points.softness))
        return Response(self._tractions(p, damage, points.softness), jacobian, after, damage, damage - points.start)

    def _points(self, p: Numbers, history: Reals) -> Points:
        """Evaluate what damage follows from."""
        driving, softness, mix = self.direction(p)
        softening = self.beta * softness - self.rigid
        static = (driving - self.rigid) / softening
        start = self.damage(history, softness)
        if self.cycles is None:
            return Points(driving, softness, softening, start, static, start, start, start)
        limit, exponent = self.cycles.limit(mix), self.cycles.exponent(mix)
        lowest = (driving / limit - self.rigid) / softening
        factor = self.cycles.factor(start, exponent)
        return Points(driving / limit, softness, softening, start, static, lowest, exponent, factor)

    def _newton(self, points: Points, damage: Reals, cycles: float) -> Numbers:
        """Return D after a step of Newton's method in D = D at the start + cycles dD/dN."""
        if self.cycles is None or cycles <= 0.0:
            return points.start
        traction = self.rigid + points.softening * damage
        ratio = points.driving / traction
        growth = np.where(ratio.real >= 1.0, cycles * points.factor * ratio**points.exponent, 0.0)
        slope = 1.0 + points.exponent * growth * points.softening / traction
        return np.asarray(damage - (damage - points.start - growth) / slope)

    def _tractions(self, p: Numbers, damage: Numbers, softness: Numbers) -> Numbers:
        """Tractions at D; a closed layer keeps its normal stiffness."""
        share = (1.0 - damage) / ((1.0 - damage) * self.rigid + self.beta * softness * damage)
        normal = np.where(p[:, NORMAL].real >= 0.0, share, 1.0 / self.rigid)
        return np.asarray(p * np.stack([normal, share], axis=-1))
