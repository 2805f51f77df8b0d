# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table as Markdown and csv, and the verdicts for a terminal."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict

from rich.table import Table

from uel.delamination.markdown import head, line
from uel.paper.study.cases import KINDS, OWN_LAW, StudyCase
from uel.paper.study.criteria import JudgedCriterion
from uel.paper.study.digests import ratios, variations, viscosity
from uel.paper.study.rows import StudyRow

SHOWN = 4
"""Number of failures of a criterion that are named; the rest is counted."""

INTRODUCTION = """\
<!-- SPDX-FileCopyrightText: The uel-harness authors -->
<!-- SPDX-License-Identifier: BSD-3-Clause -->
# Parameter study of the interface elements

Written by `python -m uel.paper.study`. HTA/6376C, plane stress, width 20 mm, strengths 30 and 60 MPa,
toughnesses 0.26 and 1.002 N/mm. Displacement in increments of 1 % at most, Abaqus' default tolerances and
cutbacks. Perturbed: the interface nodes are moved alternately up and down by 3 % of an element's length.

- **element**: standard (U2), the paper's (U4, CLOSURE 2), the consistent (U4, CLOSURE 3; inf is
  ALPHAN = ALPHAT = 0). **solution**: newton is Abaqus' own, fallback adds the search of `uel run --fallback`;
  viscous1e-4 is newton with a VISCOSITY of 1e-4 of the step time. No other row has viscosity.
- **iterations**: including those of abandoned attempts; **per increment** without snaps, increments in which the load
  falls by more than 5 % of the peak load.
- **dissipated**: energy that failed points have dissipated over their toughness, minus 1. **balance**: work minus
  stored minus dissipated energy, over work minus stored energy. A snap is one step of the trapezoidal rule, by which
  the work is summed. The paper's element misses it without snaps too: its damage is that of the displacement jump, and
  its traction works on more than that.
- **index** of t_n and t_tau: oscillation index over the bonded part and the process zone, the largest at the tenths of
  the displacement, against the tractions that really act, bumps included. **error index**: the same without
  cancelling. **raw**: against a smooth profile, so that on bumps real variation counts as oscillation.
  `uel.delamination.oscillation` defines the three. The tractions that really act are those of a rigid bond: one
  of 1e4 or 1e6 yields to the bumps, and has an index below 1 without an error. A dash: the run ended at none of these
  moments. If a structure snaps, a run may have snapped at a moment when its reference has not: then the index does not
  measure oscillation.
- **damage**: index of the damage, its total variation over its largest value; 1 if it falls steadily to 0, less if all
  of the interface is damaged. The consistent element writes its D, the others d of (9). Each rises with the other
  (`harness/uel/delamination/damage.py`), so that 1 means the same for all; above 1, compare elements of one kind.
"""

BUMPS = """
## What is real on an interface with bumps

Total variation (MPa) of the tractions of the loading mode at a stiffness of 1e8 N/mm^3, with the fall-back, at the
tenth of the displacement where the reference has the most. Real: the reference, the same interface on quads cut into
2 x 2 (frmm: 4 x 4), averaged over the share of each point (`harness/uel/paper/study/reference.py`). Difference:
total variation of the traction minus the reference's. `fortran/stabilised.md` says how far such references have
converged: that of frmm [0/0] has 487 MPa in shear, but 411 in the means over each facet, which converge faster.
"""

RATIOS = """
What bumps and stiffness add: index and error index, [0/0], on the perturbed mesh at 1e8 and above over the same
element's on the structured mesh at 1e6. A process zone slightly displaced from that on the finer mesh is an error
without oscillation, and so is a peak at the crack's tip that a coarse mesh does not resolve (dcb025): both differ with
the stiffness on structured meshes too.
"""

VISCOSITY = """
## What viscosity costs

The consistent element with an infinite stiffness. VISCOSITY is given in step time; changes are relative to the
fall-back without viscosity. Without viscosity and without the fall-back a run stops where the interface snaps. The law
is linear softening with the paper's criterion (LAW 1) or with that of Benzeggagh and Kenane (bk: LAW 2, exponent
1.45), exponential softening (LAW 3), or the PPR potential with its default shapes (LAW 4).
"""

HEAD = (
    *("stiffness", "element", "mesh", "solution", "increments", "iterations", "per increment", "cutbacks"),
    *("peak load (N)", "dissipated", "balance", "index t_n", "index t_tau", "error index t_n", "error index t_tau"),
    *("raw t_n", "raw t_tau", "damage", "max t_n", "max t_tau (MPa)", "end"),
)


def csv_table(rows: Mapping[StudyCase, StudyRow]) -> str:
    """Return all rows with all their entries."""
    out = io.StringIO()
    lines = [asdict(case) | asdict(row) for case, row in rows.items()]
    writer = csv.DictWriter(out, list(lines[0]) if lines else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)
    return out.getvalue()


def markdown_tables(rows: Mapping[StudyCase, StudyRow], verdicts: Sequence[JudgedCriterion]) -> str:
    """Write a page: verdicts, the digests, then a table for each specimen and layup."""
    parts = [INTRODUCTION, "## Criteria\n", *_markdown_verdicts(verdicts)]
    for text, digest in ((BUMPS, variations(rows)), (RATIOS, ratios(rows)), (VISCOSITY, viscosity(rows))):
        if digest:
            parts += [text, *digest]
    groups: dict[tuple[str, str], list[str]] = {}
    for case, row in rows.items():
        if case.law != OWN_LAW:
            continue
        groups.setdefault((case.specimen, case.layup), []).append(line(_cells(case, row)))
    for (specimen, layup), lines in groups.items():
        kind = KINDS[specimen]
        parts.append(f"\n## {specimen}: {kind.title}, [{layup}], to {kind.displacement[layup]:g} mm\n")
        parts += [*head(HEAD), *lines]
    return "\n".join(parts) + "\n"


def _cells(case: StudyCase, row: StudyRow) -> list[str]:
    return [
        *(case.stiffness, case.element, case.mesh, case.solution),
        *(str(row.increments), str(row.iterations), _mean(row), str(row.cutbacks)),
        *(f"{row.peak_load:.2f}", f"{row.dissipation_error:+.2%}", f"{row.balance_error:+.2%}"),
        *(
            f"{value:.3f}".replace("nan", "-")
            for value in (row.index_n, row.index_t, row.error_n, row.error_t, row.raw_n, row.raw_t)
        ),
        f"{row.damage_variation:.4f}",
        *(f"{row.peak_n:.2f}", f"{row.peak_t:.2f}"),
        "finished" if row.finished else f"{row.reached:.1%}: {row.stopped.split(' (')[0].lower()}",
    ]


def _mean(row: StudyRow) -> str:
    mean = f"{row.iterations_per_increment:.2f}"
    return f"{mean} + {row.snap_iterations} in {row.snaps} snap" + "s" * (row.snaps > 1) if row.snaps else mean


def _markdown_verdicts(verdicts: Sequence[JudgedCriterion]) -> list[str]:
    lines = head(["criterion", "rows", "holds"])
    for verdict in verdicts:
        failed = "; ".join(_named(verdict))
        lines.append(line([verdict.criterion, str(verdict.judged), "yes" if verdict.holds else f"no: {failed}"]))
    return lines


def _named(verdict: JudgedCriterion) -> list[str]:
    more = len(verdict.failures) - SHOWN
    return [*verdict.failures[:SHOWN], *([f"and {more} more"] if more > 0 else [])]


def verdict_table(verdicts: Sequence[JudgedCriterion]) -> Table:
    """Return the verdicts for a terminal."""
    table = Table("criterion", "rows", "holds")
    table.add_column("fails", overflow="fold")
    for verdict in verdicts:
        holds = "yes" if verdict.holds else "no"
        table.add_row(verdict.criterion, str(verdict.judged), holds, "\n".join(_named(verdict)))
    return table
