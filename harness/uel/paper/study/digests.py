# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Short tables from the rows: what is real on an interface with bumps, what bumps add, what viscosity costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from uel.delamination.markdown import head, line
from uel.paper.study.cases import ELEMENTS, VISCOSITIES, StudyCase
from uel.paper.study.criteria import index_ratios, is_stiff_on_bumps
from uel.paper.study.rows import StudyRow

STIFFNESS = "1e8"
TRACTIONS = {"TN": ("n", "normal"), "TT": ("t", "tangential")}

Rows = Mapping[StudyCase, StudyRow]


def variations(rows: Rows) -> list[str]:
    """Compare the total variations of the loading mode's tractions: reference, each element, and the difference."""
    lines = []
    for case in rows:
        # one line for the three elements
        if (case.stiffness, case.solution, case.element) != (STIFFNESS, "fallback", "consistent"):
            continue
        for traction in case.kind.modes:
            ending, word = TRACTIONS[traction]
            cells = [f"{case.specimen} [{case.layup}]", case.mesh, word]
            cells.append(_number(rows[case], f"real_{ending}"))
            for element in ELEMENTS:
                row = rows.get(replace(case, element=element))
                cells += [_number(row, f"variation_{ending}"), _number(row, f"difference_{ending}")]
            lines.append(line(cells))
    if not lines:
        return []
    columns = [column for element in ELEMENTS for column in (element, "difference")]
    return [*head(["specimen", "mesh", "traction", "real", *columns]), *lines]


def _number(row: StudyRow | None, name: str) -> str:
    return "" if row is None else f"{getattr(row, name):.0f}".replace("nan", "-")


def ratios(rows: Rows) -> list[str]:
    """Compare index and error index on the perturbed mesh at 1e8 and above to those on the structured one at 1e6."""
    found: dict[tuple[str, str], dict[tuple[str, str], list[float]]] = {}
    for case in rows:
        if case.solution != "fallback" or not is_stiff_on_bumps(case):
            continue
        for quantity in ("index", "error"):
            for traction, ratio in (index_ratios(case, rows, quantity) or {}).items():
                of_specimen = found.setdefault((case.specimen, TRACTIONS[traction][1]), {})
                of_specimen.setdefault((quantity, case.element), []).append(ratio)
    if not found:
        return []
    pairs = [(quantity, element) for quantity in ("index", "error") for element in ELEMENTS]
    lines = [line([*place, *(_range(by_pair.get(pair, [])) for pair in pairs)]) for place, by_pair in found.items()]
    return [*head(["specimen", "traction", *(f"{quantity}, {element}" for quantity, element in pairs)]), *lines]


def _range(values: Sequence[float]) -> str:
    if not values:
        return ""
    ends = [f"{end(values):.3f}" for end in (min, max)]
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def viscosity(rows: Rows) -> list[str]:
    """Compare, at infinite stiffness, plain Newton, the fall-back and the viscosities, loads over the fall-back's."""
    lines = []
    for case in rows:
        exact = rows[case]
        viscous = {name: rows.get(replace(case, solution=name)) for name in VISCOSITIES}
        if case.solution != "fallback" or case.stiffness != "inf" or not any(viscous.values()):
            continue
        for name, row in {"0": rows.get(replace(case, solution="newton")), "0, fall-back": exact, **viscous}.items():
            if row is not None:
                cells = [f"{case.specimen} [{case.layup}]", case.mesh, case.law, name.removeprefix("viscous")]
                lines.append(line([*cells, *_cost(row, exact)]))
    if not lines:
        return []
    columns = ("increments", "iterations", "cutbacks", "peak load (N)", "change", "load at the end (N)", "change")
    return [*head(["specimen", "mesh", "law", "viscosity", *columns]), *lines]


def _cost(row: StudyRow, exact: StudyRow) -> list[str]:
    counts = [str(row.increments), str(row.iterations), str(row.cutbacks)]
    if not row.finished:
        return [*counts, f"stops at {row.reached:.1%}", "", "", ""]
    loads = ((row.peak_load, exact.peak_load), (row.final_load, exact.final_load))
    return [*counts, *(cell for load, base in loads for cell in (f"{load:.2f}", f"{load / base - 1.0:+.1%}"))]
