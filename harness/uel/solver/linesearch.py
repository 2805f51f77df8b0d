# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Line searches: along a Newton correction, with *CONTROLS, PARAMETERS=LINE SEARCH, and downhill."""

from __future__ import annotations

import math
from collections.abc import Callable

from uel.model.controls import LineSearchControls


def search(
    component: Callable[[float], float], at_zero: float, at_one: float, controls: LineSearchControls
) -> tuple[float, tuple[float, ...]]:
    """Find a scale s of a correction c at which the residual along it, g(s) = c . r(u + s c), is small.

    Regula falsi (Illinois variant) between s = 0, where g > 0 for a correction that goes downhill, and a scale where
    g < 0. It ends with |g| <= f_s |g(0)|, or when a scale differs from the last by less than the fraction eta_s, or
    after N_ls evaluations.

    Parameters
    ----------
    component
        Evaluates g.
    at_zero, at_one
        g(0) and g(1), known already.
    controls
        N_ls, s_max, s_min, f_s, eta_s.

    Returns
    -------
    tuple[float, tuple[float, ...]]
        The scale with the smallest |g|, and all scales tried, 1 included.
    """
    best, smallest = 1.0, abs(at_one)
    tried = [1.0]
    lower, upper = (0.0, at_zero), (1.0, at_one)
    while at_zero > 0.0 and smallest > controls.f_s * at_zero and len(tried) <= controls.n_ls:
        # with g > 0 at both scales this extrapolates, up to s_max
        slope = (upper[1] - lower[1]) / (upper[0] - lower[0])
        scale = upper[0] - upper[1] / slope if slope < 0.0 else controls.s_max
        scale = min(max(scale, controls.s_min), controls.s_max)
        if abs(scale - tried[-1]) <= controls.eta_s * tried[-1]:
            break
        value = component(scale)
        tried.append(scale)
        if abs(value) < smallest:
            best, smallest = scale, abs(value)
        if value * upper[1] < 0.0:
            lower = upper
        elif lower[1] * upper[1] < 0.0:
            # the other end stays a second time: halve its value, or the bracket shrinks from one side only
            lower = lower[0], 0.5 * lower[1]
        else:
            lower = upper
        upper = scale, value
    return best, tuple(tried)


DOWN_TO = 0.25
"""|g| over g(0) at which a descent ends, the default of f_s."""

EXPANSION, LARGEST = 4.0, 64.0
"""Growth of the scale while it goes downhill, and its largest value."""

REFINEMENTS, CLOSEST = 5, 0.02
"""Largest number of evaluations inside a bracket, and relative change of the scale at which they end."""


def descend(component: Callable[[float], float | None], at_zero: float) -> tuple[float, tuple[float, ...]]:
    """Find a scale s of a downhill direction d at which g(s) = d . r(u + s d) is small.

    The scale grows fourfold from 1 on while g > 0.25 g(0); then regula falsi (Illinois variant) until |g| <= 0.25 g(0).

    Parameters
    ----------
    component
        Evaluates g; None if an element rejects the scale (PNEWDT < 1), which is then too large.
    at_zero
        g(0) > 0.

    Returns
    -------
    tuple[float, tuple[float, ...]]
        The scale with the smallest |g| < g(0), or without one the largest at which g > 0, or 0; and all scales tried.
    """
    best, smallest, downhill = 0.0, at_zero, 0.0
    lower, upper = (0.0, at_zero), (math.inf, 0.0)
    tried: list[float] = []
    scale, refinements, last = 1.0, 0, 0
    while True:
        value = component(scale)
        tried.append(scale)
        if value is not None and abs(value) < smallest:
            best, smallest = scale, abs(value)
        if smallest <= DOWN_TO * at_zero:
            break
        if value is None or value < 0.0:
            # an end that stays a second time: halve its value, or the bracket shrinks from the other side only
            lower = (lower[0], 0.5 * lower[1]) if last < 0 else lower
            upper, last = (scale, -math.inf if value is None else value), -1
        else:
            upper = (upper[0], 0.5 * upper[1]) if last > 0 else upper
            lower, downhill, last = (scale, value), scale, 1
        if math.isinf(upper[0]):
            following = EXPANSION * scale
        else:
            refinements += 1
            share = 0.5 if math.isinf(upper[1]) else lower[1] / (lower[1] - upper[1])
            following = lower[0] + share * (upper[0] - lower[0])
        if following > LARGEST or refinements > REFINEMENTS or abs(following - scale) <= CLOSEST * scale:
            break
        scale = following
    return best or downhill, tuple(tried)
