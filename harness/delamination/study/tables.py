# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table as Markdown and csv, and the verdicts for a terminal."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict

from rich.table import Table

from harness.delamination.study.cases import KINDS, Case
from harness.delamination.study.criteria import Verdict
from harness.delamination.study.rows import Row

SHOWN = 4
"""Failures of a criterion that a terminal shows."""

INTRODUCTION = """\
<!-- SPDX-FileCopyrightText: The uel-harness authors -->
<!-- SPDX-License-Identifier: BSD-3-Clause -->
# Parameter study of the interface elements

Written by `python -m harness.delamination.study`. HTA/6376C, plane stress, width 20 mm, strengths 30 and 60 MPa,
toughnesses 0.26 and 1.002 N/mm. Displacement in increments of 1 % at most, Abaqus' default tolerances and
cutbacks. Perturbed: the interface nodes lie 3 % of an element's length up and down in turns.

- **element**: standard (U2), the paper's stabilised one (U4), the consistent stabilised one (U4, CLOSURE 1; inf is
  ALPHAN = ALPHAT = 0). **solution**: newton is Abaqus' own, viscous the same with a VISCOSITY of 3e-4 of the step time,
  fallback adds the search of `uel run --fallback` to newton.
- **iterations**: those of attempts given up included; **per increment** without snaps, increments in which the load
  falls by more than 5 % of the peak load.
- **dissipated**: energy that failed points have dissipated over their toughness, less 1. **balance**: work less stored
  less dissipated energy, over work less stored energy.
- **index**: largest oscillation index of a traction over the bonded part and the process zone, at every tenth of the
  displacement (`harness/delamination/oscillation.py`); 1 without oscillations. Bumps make tractions vary in truth:
  see `python -m harness.delamination.study.refinement`.
- **TV damage**: total variation of the damage over its largest value; 1 where it falls steadily to 0.
"""

HEAD = (
    *("stiffness", "element", "mesh", "solution", "increments", "iterations", "per increment", "cutbacks"),
    *(
        "peak load (N)",
        "dissipated",
        "balance",
        "index t_n",
        "index t_tau",
        "TV damage",
        "max t_n",
        "max t_tau (MPa)",
        "end",
    ),
)


def csv_table(rows: Mapping[Case, Row]) -> str:
    """All rows with all their entries."""
    out = io.StringIO()
    lines = [asdict(case) | asdict(row) for case, row in rows.items()]
    writer = csv.DictWriter(out, list(lines[0]) if lines else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)
    return out.getvalue()


def markdown_tables(rows: Mapping[Case, Row], verdicts: Sequence[Verdict]) -> str:
    """A page: verdicts, then a table for each specimen and layup."""
    parts = [INTRODUCTION, "## Criteria\n", *_markdown_verdicts(verdicts)]
    groups: dict[tuple[str, str], list[str]] = {}
    for case, row in rows.items():
        groups.setdefault((case.specimen, case.layup), []).append(_line(_cells(case, row)))
    for (specimen, layup), lines in groups.items():
        kind = KINDS[specimen]
        parts.append(f"\n## {kind.title}, [{layup}], to {kind.displacement[layup]:g} mm\n")
        parts += [_line(HEAD), _line(["---"] * len(HEAD)), *lines]
    return "\n".join(parts) + "\n"


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cells(case: Case, row: Row) -> list[str]:
    return [
        *(case.stiffness, case.element, case.mesh, case.solution),
        *(str(row.increments), str(row.iterations), _mean(row), str(row.cutbacks)),
        *(f"{row.peak_load:.2f}", f"{row.dissipation_error:+.2%}", f"{row.balance_error:+.2%}"),
        *(f"{row.index_n:.3f}", f"{row.index_t:.3f}", f"{row.damage_variation:.4f}"),
        *(f"{row.peak_n:.2f}", f"{row.peak_t:.2f}"),
        "finished" if row.finished else f"{row.reached:.1%}: {row.stopped.split(' (')[0].lower()}",
    ]


def _mean(row: Row) -> str:
    mean = f"{row.iterations_per_increment:.2f}"
    return f"{mean} + {row.snap_iterations} in {row.snaps} snap" + "s" * (row.snaps > 1) if row.snaps else mean


def _markdown_verdicts(verdicts: Sequence[Verdict]) -> list[str]:
    lines = [_line(["criterion", "rows", "holds"]), _line(["---"] * 3)]
    for verdict in verdicts:
        failed = "; ".join(verdict.failures)
        lines.append(_line([verdict.criterion, str(verdict.judged), "yes" if verdict.holds else f"no: {failed}"]))
    return lines


def verdict_table(verdicts: Sequence[Verdict]) -> Table:
    """Verdicts for a terminal."""
    table = Table("criterion", "rows", "holds")
    table.add_column("fails", overflow="fold")
    for verdict in verdicts:
        more = len(verdict.failures) - SHOWN
        failed = [*verdict.failures[:SHOWN], *([f"and {more} more"] if more > 0 else [])]
        table.add_row(verdict.criterion, str(verdict.judged), "yes" if verdict.holds else "no", "\n".join(failed))
    return table
