# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Criteria for the consistent element, checked on the existing rows.

Rows of Newton's method alone and with the fall-back are judged separately; those with viscosity or another law are not
judged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from uel.delamination.materials import TABLE_2
from uel.paper.study.cases import KINDS, OWN_LAW, StudyCase
from uel.paper.study.rows import StudyRow, loading_mode

MEAN_ITERATIONS = {"dcb": 6.0, "enf": 3.0, "frmm": 3.0}
"""Iterations per increment. The coarse mesh of the double cantilever beam is not judged, here and by its index."""
CUTBACKS = 5
PEAK_SPREAD = 0.005
SHEAR_TOLERANCE = 0.01
DAMAGE_TOLERANCE = 0.0005
INDEX_RATIO = 1.1
STIFF = ("1e6", "1e8", "1e12", "inf")
STIFFEST = ("1e8", "1e12", "inf")

JUDGED = ("fallback", "newton")
"""Solutions."""

Rows = Mapping[StudyCase, StudyRow]


@dataclass(frozen=True, slots=True)
class JudgedCriterion:
    """Judgement on a criterion: the number of rows judged, and those that fail it, each with the reason."""

    criterion: str
    judged: int
    failures: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """True if nothing fails it."""
        return not self.failures


def check(rows: Rows) -> list[JudgedCriterion]:
    """Return all criteria for which there are rows, for each kind of solution."""
    verdicts = []
    for solution in JUDGED:
        chosen = {case: row for case, row in rows.items() if (case.solution, case.law) == (solution, OWN_LAW)}
        own = {case: row for case, row in chosen.items() if case.element == "consistent"}
        found = [
            _each("consistent element: every row finishes", own, _unfinished),
            _each(
                "consistent element: mean iterations per increment ENF, FRMM <= 3, DCB <= 6, snaps apart", own, _slow
            ),
            _each(f"consistent element: at most {CUTBACKS} cutbacks", own, _cut_back),
            _peak_loads(own),
            _each("consistent element: damage falls steadily in the rows of a pure mode", own, _unsteady_damage),
            _each(
                "consistent element: largest shear traction of the ENF [0/0] within 1 % of the strength", own, _shear
            ),
            _oscillation("consistent element: index on the perturbed mesh at 1e8 and above", own),
            _standard_fails(chosen),
        ]
        verdicts += [replace(v, criterion=f"{v.criterion} ({solution})") for v in found if v.judged]
    return verdicts


def _each(criterion: str, rows: Rows, failure: Callable[[StudyCase, StudyRow], str | None]) -> JudgedCriterion:
    """Judge by a function of one row: what is wrong, empty if nothing is, None if the row is not judged."""
    texts = {case: failure(case, row) for case, row in rows.items()}
    judged = {case: text for case, text in texts.items() if text is not None}
    return JudgedCriterion(
        criterion, len(judged), tuple(f"{case.name}: {text}" for case, text in judged.items() if text)
    )


def _unfinished(_: StudyCase, row: StudyRow) -> str:
    return "" if row.finished else f"{row.reached:.1%}, {row.stopped}"


def _slow(case: StudyCase, row: StudyRow) -> str | None:
    limit = MEAN_ITERATIONS.get(case.specimen)
    if limit is None or not row.finished:
        return None
    mean = row.iterations_per_increment
    return "" if mean <= limit else f"{mean:.2f}"


def _cut_back(_: StudyCase, row: StudyRow) -> str:
    return "" if row.cutbacks <= CUTBACKS else str(row.cutbacks)


def _unsteady_damage(case: StudyCase, row: StudyRow) -> str | None:
    if case.layup != "0/0" or case.specimen == "frmm":
        return None
    return "" if abs(row.damage_variation - 1.0) <= DAMAGE_TOLERANCE else f"{row.damage_variation:.4f}"


def _shear(case: StudyCase, row: StudyRow) -> str | None:
    if case.specimen != "enf" or case.layup != "0/0":
        return None
    strength = TABLE_2.strength_shear
    return "" if abs(row.peak_t / strength - 1.0) <= SHEAR_TOLERANCE else f"{row.peak_t:.2f} MPa of {strength:g}"


def _peak_loads(rows: Rows) -> JudgedCriterion:
    groups: dict[tuple[str, str, str], dict[str, float]] = {}
    for case, row in rows.items():
        if case.stiffness in STIFF and row.finished:
            groups.setdefault((case.specimen, case.layup, case.mesh), {})[case.stiffness] = row.peak_load
    failures = []
    compared = {group: peaks for group, peaks in groups.items() if len(peaks) > 1}
    for group, peaks in compared.items():
        spread = max(peaks.values()) / min(peaks.values()) - 1.0
        if spread > PEAK_SPREAD:
            found = ", ".join(f"{name} {peak:.2f}" for name, peak in peaks.items())
            failures.append(f"{' '.join(group)}: {spread:.2%} ({found})")
    criterion = f"consistent element: peak loads within {PEAK_SPREAD:.1%} over all stiffnesses from 1e6 on"
    return JudgedCriterion(criterion, len(compared), tuple(failures))


def index_ratios(case: StudyCase, rows: Rows, quantity: str = "index") -> dict[str, float] | None:
    """Return the `index` or `error` of a case over that of the structured mesh at 1e6, by traction of the loading mode.

    None if that row, or its index, is missing.
    """
    plain = rows.get(replace(case, stiffness="1e6", mesh="structured"))
    if plain is None or case not in rows:
        return None
    kind = KINDS[case.specimen]
    base = loading_mode(kind, plain, quantity)
    ratios = {name: index / base[name] for name, index in loading_mode(kind, rows[case], quantity).items()}
    return None if any(math.isnan(ratio) for ratio in ratios.values()) else ratios


def is_stiff_on_bumps(case: StudyCase) -> bool:
    """Report whether the row's index is compared with that of the structured mesh at 1e6."""
    return case.mesh == "perturbed" and case.stiffness in STIFFEST and case.layup == "0/0"


def _is_judged(case: StudyCase) -> bool:
    return is_stiff_on_bumps(case) and case.specimen in MEAN_ITERATIONS


def _oscillation(criterion: str, rows: Rows) -> JudgedCriterion:
    def failure(case: StudyCase, _: StudyRow) -> str | None:
        ratios = index_ratios(case, rows) if _is_judged(case) else None
        if ratios is None:
            return None
        return ", ".join(f"{name} {ratio:.3f}" for name, ratio in ratios.items() if ratio > INDEX_RATIO)

    return _each(f"{criterion} at most {INDEX_RATIO} of that on the structured one at 1e6, [0/0]", rows, failure)


def _standard_fails(rows: Rows) -> JudgedCriterion:
    """Judge that the criterion is not trivial: the standard element fails it."""
    own = {case: row for case, row in rows.items() if case.element == "standard"}

    def failure(case: StudyCase, _: StudyRow) -> str | None:
        ratios = index_ratios(case, own) if _is_judged(case) else None
        if ratios is None:
            return None
        return "" if max(ratios.values()) > INDEX_RATIO else ", ".join(f"{n} {r:.3f}" for n, r in ratios.items())

    return _each("standard element: fails the criterion of the index", own, failure)
