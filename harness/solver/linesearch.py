# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Line search along a Newton correction, as *CONTROLS, PARAMETERS=LINE SEARCH steers it."""

from __future__ import annotations

from collections.abc import Callable

from harness.model.steps import LineSearchControls


def search(
    component: Callable[[float], float], at_zero: float, at_one: float, controls: LineSearchControls
) -> tuple[float, tuple[float, ...]]:
    """Scale s of a correction c at which the component of the residual along it, g(s) = c . r(u + s c), is small.

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
        The best scale seen and all scales tried, 1 included.
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
            # the other end stays twice: halve its value, or the bracket shrinks from one side only
            lower = lower[0], 0.5 * lower[1]
        else:
            lower = upper
        upper = scale, value
    return best, tuple(tried)
