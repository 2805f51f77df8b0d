# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Row of the table: the results of a run of a case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uel.batch.engine import StoredRow
from uel.delamination.materials import TABLE_2
from uel.delamination.oscillation import error_index, oscillation_index, raw_index, total_variation
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.files.sta_file import StatusRow
from uel.paper.measures import dissipated
from uel.paper.study.cases import INCREMENTS, MeshedSpecimen, StudyCase
from uel.paper.study.reference import Profile

SNAP = 0.05
"""An increment in which the load falls by more than this part of the peak load holds a snap."""

STRENGTHS = {"TN": TABLE_2.strength_normal, "TT": TABLE_2.strength_shear}


@dataclass(frozen=True, slots=True)
class StudyRow(StoredRow):
    """Numbers of one row. If the run stopped early, they hold up to that point.

    reached      part of the final displacement
    stopped      why it stopped early; empty for a run that finished
    increments, iterations, cutbacks  including the iterations of abandoned attempts
    snaps        increments in which the load falls by more than `SNAP` of the peak load
    snap_iterations  iterations of these increments, among the above
    peak_load, peak_displacement, final_load  N, mm
    dissipation_error  energy dissipated by failed points over their toughness, minus 1
    balance_error    (work - stored - dissipated energy) over (work - stored energy), at the end
    index_n, index_t   largest oscillation index of the tractions over the bonded part and the process zone, at the
                       tenths of the displacement; NaN if the run ended at none of them
    error_n, error_t, raw_n, raw_t  the same for the error index and for the raw index
    variation_n, variation_t  total variation of the tractions (MPa) where that of the reference is largest
    real_n, real_t     that of the reference
    difference_n, difference_t  that of the traction minus that of the reference
    damage_variation   total variation of the damage over its largest value, where it is farthest from 1, which is a
                       steady fall to 0
    peak_n, peak_t     largest tension and shear traction (MPa)
    seconds            wall-clock time
    """

    reached: float
    stopped: str
    increments: int
    iterations: int
    cutbacks: int
    snaps: int
    snap_iterations: int
    peak_load: float
    peak_displacement: float
    final_load: float
    dissipation_error: float
    balance_error: float
    index_n: float
    index_t: float
    error_n: float
    error_t: float
    raw_n: float
    raw_t: float
    variation_n: float
    variation_t: float
    real_n: float
    real_t: float
    difference_n: float
    difference_t: float
    damage_variation: float
    peak_n: float
    peak_t: float
    seconds: float

    @property
    def finished(self) -> bool:
        """True if the run reached the final displacement."""
        return not self.stopped

    @property
    def iterations_per_increment(self) -> float:
        """Mean number of iterations of the increments without a snap."""
        return (self.iterations - self.snap_iterations) / max(self.increments - self.snaps, 1)


def measure(case: StudyCase, result: Result, stopped: str, seconds: float, real: list[Profile]) -> StudyRow:
    """Read the row of a case from the files of its run, and the profiles of its reference."""
    history = result.history
    kind = case.kind
    load, displacement = (kind.sign * history[f"{name}2[{kind.load}]"] for name in ("RF", "U"))
    peak = int(load.argmax())
    drops = -np.diff(load, prepend=0.0)
    snaps = {k + 1 for k in np.flatnonzero(drops > SNAP * load[peak]).tolist()}
    lost = float(history["ALLWK"][-1] - history["ALLSE"][-1])
    spent = float(dissipated(result)[-1])
    return StudyRow(
        reached=float(displacement[-1]) / case.displacement,
        stopped=stopped,
        increments=len(load),
        iterations=_iterations(result.status),
        cutbacks=sum(line.cutback for line in result.status),
        snaps=len(snaps),
        snap_iterations=_iterations([line for line in result.status if line.increment in snaps]),
        peak_load=float(load[peak]),
        peak_displacement=float(displacement[peak]),
        final_load=float(load[-1]),
        dissipation_error=dissipation_error(result.interface()),
        balance_error=(lost - spent) / lost if lost > 0.0 else 0.0,
        **_along_the_interface(result.interfaces(), real),
        seconds=seconds,
    )


def _iterations(lines: list[StatusRow]) -> int:
    return sum(line.total_iterations for line in lines)


def _along_the_interface(profiles: list[Profile], real: list[Profile]) -> dict[str, float]:
    chosen = at_tenths(profiles)
    variations = [damage_variation(profile["DAMAGE"]) for profile in chosen]
    pairs = same_moments(chosen, real)
    return {
        **oscillations("TN", "n", chosen, pairs),
        **oscillations("TT", "t", chosen, pairs),
        "damage_variation": max(variations, key=lambda value: abs(value - 1.0)),
        "peak_n": max(float(profile["TN"].max()) for profile in chosen),
        "peak_t": max(float(np.abs(profile["TT"]).max()) for profile in chosen),
    }


def oscillations(
    traction: str, ending: str, chosen: list[Profile], pairs: list[tuple[Profile, Profile]]
) -> dict[str, float]:
    """Measure the oscillation of one traction for a row; the names of the measures end in `ending`."""
    scale = STRENGTHS[traction]
    indices, errors, variations = [], [], [(float("nan"),) * 3]
    for profile, real in pairs:
        computed, acting = bonded_part(profile)[traction], bonded_part(real)[traction]
        # where both are intact; where one has failed the two states differ, not their oscillations
        both = min(len(computed), len(acting))
        indices.append(oscillation_index(computed, acting, scale))
        errors.append(error_index(computed[-both:], acting[-both:], scale))
        difference = total_variation(computed[-both:] - acting[-both:])
        variations.append((total_variation(acting), total_variation(computed), difference))
    real_variation, variation, difference = max(variations[1:], default=variations[0])
    found = {
        "index": max(indices, default=float("nan")),
        "error": max(errors, default=float("nan")),
        "raw": max(raw_index(bonded_part(profile)[traction], scale) for profile in chosen),
        "variation": variation,
        "real": real_variation,
        "difference": difference,
    }
    return {f"{name}_{ending}": value for name, value in found.items()}


def same_moments(profiles: list[Profile], real: list[Profile]) -> list[tuple[Profile, Profile]]:
    """Return the profiles with those of the reference at the same moment, less than half an increment apart.

    If increments were cut back, a run writes at other moments; such a profile has no partner.
    """
    close = 0.5 * INCREMENTS.largest
    return [(profile, other) for profile in profiles for other in real if abs(_time(profile) - _time(other)) < close]


def _time(profile: Profile) -> float:
    return float(profile["time"][0])


def at_tenths(profiles: list[Profile]) -> list[Profile]:
    """Return the last profile in each tenth of the displacement: the same moments for all runs."""
    tenths = {int(np.ceil(10.0 * profile["time"][0] - 1e-9)): profile for profile in profiles}
    return list(tenths.values())


def bonded_part(profile: Profile) -> Profile:
    """Cut the profile at the first point that has not failed: process zone and bonded part, failed islands included."""
    first = int(np.argmax(profile["DAMAGE"] < 1.0))
    return {name: column[first:] for name, column in profile.items()}


def damage_variation(damage: FloatArray) -> float:
    """Return the total variation of the damage (n,) along the interface, over its largest value; 1 without damage."""
    largest = float(damage.max())
    return total_variation(damage) / largest if largest > 0.0 else 1.0


def dissipation_error(profile: Profile) -> float:
    """Return the mean over the failed points of DISSI/G_Ic + DISSII/G_IIc, minus 1; 0 if none has failed."""
    failed = profile["DAMAGE"] >= 1.0
    spent = profile["DISSI"] / TABLE_2.toughness_1 + profile["DISSII"] / TABLE_2.toughness_2
    return float(np.mean(spent[failed])) - 1.0 if failed.any() else 0.0


def loading_mode(kind: MeshedSpecimen, row: StudyRow, quantity: str) -> dict[str, float]:
    """Return `index`, `error` or `raw` of each traction of the loading mode."""
    return {name: float(getattr(row, f"{quantity}_{name[1].lower()}")) for name in kind.modes}
