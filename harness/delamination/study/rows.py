# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run of a case gives: one row of the table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass

import numpy as np

from harness.delamination.materials import TABLE_2
from harness.delamination.oscillation import oscillation_index, total_variation
from harness.delamination.study.cases import Case, Kind
from harness.model.arrays import FloatArray
from harness.output import Result
from harness.output.status import StatusRow

SNAP = 0.05
"""An increment in which the load falls by more than this part of the peak load holds a snap."""

STRENGTHS = {"TN": TABLE_2.strength_normal, "TT": TABLE_2.strength_shear}


@dataclass(frozen=True, slots=True)
class Row:
    """Numbers of one row. All are those until the run stopped, where it did.

    reached      part of the final displacement
    stopped      why it went no further; empty for a run that finished
    increments, iterations, cutbacks  iterations of attempts given up included
    snaps        increments in which the load falls by more than `SNAP` of the peak load
    snap_iterations  iterations of these increments, among the above
    peak_load, peak_displacement, final_load  N, mm
    dissipation_error  energy dissipated by failed points over their toughness, less 1
    balance_error    (work - stored - dissipated energy) over (work - stored energy), at the end
    index_n, index_t   largest oscillation index of the tractions over the bonded part and the process zone
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
    damage_variation: float
    peak_n: float
    peak_t: float
    seconds: float

    @property
    def finished(self) -> bool:
        """Whether the run reached the final displacement."""
        return not self.stopped

    @property
    def iterations_per_increment(self) -> float:
        """Mean number of iterations of the increments without a snap."""
        return (self.iterations - self.snap_iterations) / max(self.increments - self.snaps, 1)

    def to_json(self) -> dict[str, object]:
        """Entries by name."""
        return asdict(self)

    @classmethod
    def from_json(cls, entries: Mapping[str, object]) -> Row:
        """Row of the entries that `to_json` gave."""
        return cls(**entries)  # type: ignore[arg-type]


def measure(case: Case, result: Result, stopped: str, seconds: float) -> Row:
    """Row of a case from the files of its run."""
    history = result.history
    kind = case.kind
    load, displacement = (kind.sign * history[f"{name}2[{kind.load}]"] for name in ("RF", "U"))
    peak = int(load.argmax())
    drops = -np.diff(load, prepend=0.0)
    snaps = {k + 1 for k in np.flatnonzero(drops > SNAP * load[peak]).tolist()}
    lost = float(history["ALLWK"][-1] - history["ALLSE"][-1])
    dissipated = float(history["ALLPD"][-1] + history["ALLVD"][-1])
    return Row(
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
        balance_error=(lost - dissipated) / lost if lost > 0.0 else 0.0,
        **_along_the_interface(result.interfaces()),
        seconds=seconds,
    )


def _iterations(lines: list[StatusRow]) -> int:
    return sum(line.total_iterations for line in lines)


def _along_the_interface(profiles: list[dict[str, FloatArray]]) -> dict[str, float]:
    chosen = at_tenths(profiles)
    variations = [damage_variation(profile["DAMAGE"]) for profile in chosen]
    bonded = [bonded_part(profile) for profile in chosen]
    return {
        "index_n": max(oscillation_index(profile["TN"], STRENGTHS["TN"]) for profile in bonded),
        "index_t": max(oscillation_index(profile["TT"], STRENGTHS["TT"]) for profile in bonded),
        "damage_variation": max(variations, key=lambda value: abs(value - 1.0)),
        "peak_n": max(float(profile["TN"].max()) for profile in chosen),
        "peak_t": max(float(np.abs(profile["TT"]).max()) for profile in chosen),
    }


def at_tenths(profiles: list[dict[str, FloatArray]]) -> list[dict[str, FloatArray]]:
    """The last profile in each tenth of the displacement: the same moments for all runs, however many increments."""
    tenths = {int(np.ceil(10.0 * profile["time"][0] - 1e-9)): profile for profile in profiles}
    return list(tenths.values())


def bonded_part(profile: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """The profile from the first point that has not failed: process zone and bonded part, failed islands included."""
    first = int(np.argmax(profile["DAMAGE"] < 1.0))
    return {name: column[first:] for name, column in profile.items()}


def damage_variation(damage: FloatArray) -> float:
    """Total variation of the damage (n,) along the interface, over its largest value; 1 without damage."""
    largest = float(damage.max())
    return total_variation(damage) / largest if largest > 0.0 else 1.0


def dissipation_error(profile: dict[str, FloatArray]) -> float:
    """Mean over the failed points of DISSI/G_Ic + DISSII/G_IIc, less 1; 0 where none has failed."""
    failed = profile["DAMAGE"] >= 1.0
    spent = profile["DISSI"] / TABLE_2.toughness_1 + profile["DISSII"] / TABLE_2.toughness_2
    return float(np.mean(spent[failed])) - 1.0 if failed.any() else 0.0


def loading_mode(kind: Kind, row: Row) -> dict[str, float]:
    """Oscillation index of each traction of the loading mode."""
    return {name: {"TN": row.index_n, "TT": row.index_t}[name] for name in kind.modes}
