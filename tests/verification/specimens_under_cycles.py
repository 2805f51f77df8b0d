# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Delamination specimens of `beam_on_cohesive_layer`, and their da/dN at a constant G (N, mm, MPa, width 1 mm)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from beam_on_cohesive_layer import (
    TURN_LOWER,
    TURN_UPPER,
    U_LOWER,
    U_UPPER,
    W_LOWER,
    W_UPPER,
    Arm,
    Layer,
    NoEquilibriumError,
    Specimen,
    cycle,
    load,
)
from cyclic_cohesive_law import Law, Reals

# growth (mm) after which da/dN of a bent specimen is steady to 0.1 %
SETTLING = 4.0


def bent(
    release: float,
    mix: float,
    law: Law,
    *,
    arm: Arm | None = None,
    size: float = 0.25,
    growth: float = 9.0,
    faces: bool = True,
) -> Specimen:
    """Specimen under moments at the ends of its arms: G = `release` (N/mm) and its mix do not depend on the crack.

    With M_I the opening and M_II the common moment of each arm, G_I = M_I^2/EI and G_II = 3 M_II^2/(4 EI). `growth`
    (mm) is how far the crack may grow.
    """
    arm = arm or Arm()
    opening = float(np.sqrt((1.0 - mix) * release * arm.bending))
    common = float(np.sqrt(4.0 / 3.0 * mix * release * arm.bending))
    # a crack of 2 mm, and behind the growth a length over which the tractions ahead of the front vanish
    x = np.arange(0.0, 2.0 + growth + 16.0 * arm.height + 0.5 * size, size)
    last = len(x) - 1
    return Specimen(
        x,
        (arm, arm),
        [law],
        crack=2.0,
        prescribed={(last, dof): 0.0 for dof in (U_LOWER, W_LOWER, TURN_LOWER)},
        # at the bonded end the stresses of one beam of both arms
        forces={
            (0, TURN_LOWER): opening - common,
            (0, TURN_UPPER): -opening - common,
            (last, TURN_UPPER): 0.25 * common,
            (last, U_UPPER): -1.5 * common / arm.height,
        },
        faces=faces,
    )


def opened(
    opening: float, crack: float, length: float, laws: Sequence[Law], arm: Arm, size: float, growth: float
) -> Specimen:
    """Double cantilever beam whose ends are `opening` (mm) apart; x from the loaded ends to the free ones."""
    x = graded(length, crack - 2.0 * size, crack + growth, size)
    # supports without reactions: the equal and opposite loads are in equilibrium
    supports = {(len(x) - 1, dof): 0.0 for dof in (U_LOWER, W_LOWER)}
    ends = {(0, W_LOWER): -0.5 * opening, (0, W_UPPER): 0.5 * opening}
    return Specimen(x, (arm, arm), laws, crack, supports | ends, {})


def flexure(
    force: float, lever: float, half_span: float, crack: float, law: Law, *, arm: Arm | None = None, size: float = 0.25
) -> Specimen:
    """Mixed-mode bending by a `force` (N/mm) at the end of a `lever` (mm), or end-notched flexure without one.

    The lever pulls the upper arm at its cracked end up by force lever/half_span, and presses on the middle of the
    span by the sum of both. The crack may grow to the middle.
    """
    arm = arm or Arm()
    x = graded(2.0 * half_span, crack - 2.0 * size, half_span + 4.0 * arm.height, size)
    middle, last = int(np.argmin(np.abs(x - half_span))), len(x) - 1
    pull = force * lever / half_span
    return Specimen(
        x,
        (arm, arm),
        [law],
        crack,
        prescribed={(0, U_LOWER): 0.0, (0, W_LOWER): 0.0, (last, W_LOWER): 0.0},
        forces={(0, W_UPPER): pull, (middle, W_UPPER): -(force + pull)},
    )


def graded(length: float, start: float, end: float, size: float) -> Reals:
    """Nodes at distances of `size` (mm) between start and end, and of up to 2 mm elsewhere."""
    fine = start + size * np.arange(round((end - start) / size) + 1)
    before = np.linspace(0.0, start, 2 + int(start / 2.0))
    after = np.linspace(fine[-1], length, 2 + int((length - fine[-1]) / 2.0))
    return np.concatenate([before[:-1], fine, after[1:]])


def steady_rate(
    share: float,
    mix: float = 0.0,
    law: Law | None = None,
    *,
    arm: Arm | None = None,
    size: float = 0.25,
    d_max: float = 0.02,
    faces: bool = True,
) -> float:
    """da/dN (mm/cycle) at G = `share` of the fracture energy in a `bent` specimen; 0 if the crack is arrested.

    NoEquilibriumError at or above the static strength.
    """
    law = law or Law()
    layer = Layer(
        bent(share * float(law.toughness(mix)), mix, law, arm=arm, size=size, growth=SETTLING + 3.0, faces=faces)
    )
    run = cycle(layer, load(layer), SETTLING + 3.0, d_max)
    if run.failed:
        raise NoEquilibriumError(f"the crack grows statically at {share:g} of the fracture energy")
    start = run.crack[0]
    return run.rate(start + SETTLING, start + SETTLING + 3.0) if run.crack[-1] >= start + SETTLING + 3.0 else 0.0
