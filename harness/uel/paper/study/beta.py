# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.beta`: what the stabilisation parameter beta costs, and what it brings.

The bulk's traction <sigma>.n of (18) is not in equilibrium with the traction of the interface; the gap beta g takes up
the difference. A small beta makes the interface compliant, and below the bound of the element unstable; a large one
makes <sigma>.n count for nothing, and the element the standard one with a penalty beta, which oscillates. The
consistent element with an infinite stiffness shows both: the load tells of the compliance, the oscillation index of the
tractions.

In the plane the specimens are those of the study. In space there is a double cantilever beam with one, two and four
bricks through an arm, as an engineer would mesh it.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.batch.engine import Store, StoredRow, complete
from uel.delamination.blocks import BY_EQUATION_21, Interface
from uel.delamination.markdown import head, line
from uel.delamination.materials import TABLE_2, SolidPly
from uel.delamination.mesh import crack_columns
from uel.delamination.plates import Laminate, two_plates
from uel.output import Result
from uel.paper.measures import cutbacks, iterations, load
from uel.paper.run_deck import run_deck
from uel.paper.study.cases import KINDS, LAYUPS, MESHES, deck_files, mesh_of
from uel.paper.study.options import study_parser, write_tables
from uel.paper.study.reference import Profile, restricted
from uel.paper.study.rows import at_tenths, oscillations, same_moments
from uel.paper.study.spatial import opened

BETAS = {
    "-1": -1.0,
    "(21)": BY_EQUATION_21,
    "2e4": 2.0e4,
    "2e5": 2.0e5,
    "2e6": 2.0e6,
    "2e8": 2.0e8,
}
"""BETAN = BETAT (N/mm^3) by name: local eigenvalues, equation (21), decades above the softening slope."""

CONSISTENT = Interface("U4", TABLE_2.with_stiffness(0.0))
"""Interface of the consistent element with an infinite stiffness."""

SPECIMENS = ("dcb025", "enf")
FACTOR = 2
"""The finer meshes have every quad cut into this number squared."""

MULTIPLES = {"-1": 0.0, "(21)": 1.0, "10 x (21)": 10.0, "100 x (21)": 100.0}
"""Multiples of the estimate of (21) in space."""

LAYERS, FINE_LAYERS = (1, 2, 4), 8
"""Bricks through an arm."""

LENGTH, WIDTH, HEIGHT, CRACK, GROWTH = 60.0, 4.0, 2.0, 20.0, 32.0
"""Dimensions in space: length, width, height of an arm, length of the crack, end of the short bricks (mm)."""

SIZE, ROWS = 0.5, 2
"""Length of the bricks there (mm), half of it on the finer mesh, and bricks across."""

# table 1 in space, isotropic in the plane 2-3; fibres along x, and along y
PLY_0 = SolidPly("PLY_0", (1.2e5, 1.05e4, 1.05e4), (0.3, 0.3, 0.51), (5.52e3, 5.52e3, 3.48e3))
PLY_90 = replace(PLY_0, name="PLY_90", angle=90.0)
PLATES = {"0/0": (PLY_0, PLY_0, 1.0), "0/90": (PLY_90, PLY_0, 2.2)}
"""Ply of the lower and of the upper arm, and the distance of the loaded edges at the end (mm)."""


@dataclass(frozen=True, slots=True)
class BetaCase:
    """A specimen of the study with the consistent element and an infinite stiffness.

    specimen, layup, mesh  as in the tables of the study: 'dcb025', '0/90', 'perturbed'
    beta                   a key of BETAS
    factor                 every quad is cut into factor x factor
    """

    specimen: str
    layup: str
    mesh: str
    beta: str
    factor: int = 1

    @property
    def name(self) -> str:
        """Name of the deck and of its folder."""
        finer = f"_{self.factor}" if self.factor > 1 else ""
        return f"{self.specimen}_{self.layup.replace('/', '-')}_{self.mesh}_beta_{self.beta.strip('()')}{finer}"

    @property
    def title(self) -> str:
        """Title of its table."""
        return f"{KINDS[self.specimen].title}, [{self.layup}], {self.mesh}"

    @property
    def reference(self) -> BetaCase:
        """Finer mesh that it is compared with."""
        return replace(self, beta="-1", factor=FACTOR)

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        kind = KINDS[self.specimen]
        interface = replace(CONSISTENT, beta=BETAS[self.beta])
        mesh = mesh_of(kind, self.mesh, self.factor)
        return deck_files(self.name, self.name, kind, self.layup, mesh, interface)


@dataclass(frozen=True, slots=True)
class SpaceCase:
    """The double cantilever beam in space; a key of PLATES, bricks through an arm, a key of MULTIPLES."""

    layup: str
    layers: int
    beta: str

    @property
    def name(self) -> str:
        """Name of the deck and of its folder."""
        return f"space_{self.layup.replace('/', '-')}_{self.layers}_{self.beta.replace(' x (21)', '').strip('()')}"

    @property
    def title(self) -> str:
        """Title of its table."""
        return f"double cantilever beam in space, [{self.layup}], {self.layers} through an arm"

    @property
    def reference(self) -> SpaceCase:
        """Finer mesh that it is compared with."""
        return SpaceCase(self.layup, FINE_LAYERS, "-1")

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp`."""
        lower, upper, opening = PLATES[self.layup]
        size = SIZE / 2 if self.layers == FINE_LAYERS else SIZE
        x = crack_columns(LENGTH, (CRACK, GROWTH), size, 1.2, (2.0, 2.0))
        y, z = np.linspace(0.0, WIDTH, ROWS + 1), np.linspace(0.0, HEIGHT, self.layers + 1)
        interface = replace(CONSISTENT, type="U8", beta=self._beta())
        laminate = Laminate(two_plates(x, y, z, CRACK), interface, (lower,) * self.layers, (upper,) * self.layers)
        return {f"{self.name}.inp": opened(self.name, laminate, opening, every=10)}

    def _beta(self) -> float:
        """Return BETAN = BETAT; by (21) and (22) of two bricks of like size and |D|, |D|/h."""
        if self.beta == "-1":
            return -1.0
        share = MULTIPLES[self.beta]
        return BY_EQUATION_21 if share == 1.0 else share * spectral_norm(PLY_0) * self.layers / HEIGHT


def spectral_norm(ply: SolidPly) -> float:
    """Return |D| of a ply in space (MPa)."""
    compliance = np.diag([1.0 / modulus for modulus in (*ply.moduli, *ply.shear)])
    for (i, j), ratio in zip(((0, 1), (0, 2), (1, 2)), ply.ratios, strict=True):
        compliance[i, j] = compliance[j, i] = -ratio / ply.moduli[i]
    return float(1.0 / np.linalg.eigvalsh(compliance)[0])


MARK = "<!-- tables of python -m uel.paper.study.beta -->\n"
"""Line of a page above its tables."""

Case = BetaCase | SpaceCase


@dataclass(frozen=True, slots=True)
class BetaRow(StoredRow):
    """Numbers of a run.

    stopped    why it stopped early; empty for a run that finished
    stiffness  load over displacement in the first increment (N/mm)
    peak, mean largest load, and the mean over the second half of the displacement (N)
    cutbacks, iterations
    index      largest oscillation index of the loading mode at the tenths of the displacement; NaN in space, and of a
               reference
    """

    stopped: str
    stiffness: float
    peak: float
    mean: float
    cutbacks: int
    iterations: int
    index: float


def run_case(case: Case, folder: Path) -> BetaRow:
    """Run a case with the fall-back; its reference has to have run in the same folder."""
    outcome = run_deck(case, folder, fallback=True)
    return measure(case, outcome.result, outcome.stopped, real_profiles(case, folder))


def real_profiles(case: Case, folder: Path) -> list[Profile]:
    """Read the profiles of a case's reference at the points of its own mesh; none in space, and for a reference."""
    reference = case.reference
    if isinstance(reference, SpaceCase) or case == reference:
        return []
    finer = Result(folder / reference.name / reference.name).interfaces()
    return [restricted(profile, reference.factor) for profile in finer]


def measure(case: Case, result: Result, stopped: str, real: list[Profile]) -> BetaRow:
    """Read the row of a case from the files of its run, and the profiles of its reference."""
    curve, time = load(result), result.history["time"]
    second = np.linspace(0.5, 1.0, 501) * time[-1]
    index = float("nan")
    if isinstance(case, BetaCase):
        chosen = at_tenths(result.interfaces())
        pairs = same_moments(chosen, real)
        index = max(oscillations(mode, "n", chosen, pairs)["index_n"] for mode in KINDS[case.specimen].modes)
    return BetaRow(
        stopped=stopped,
        stiffness=float(curve[0] / (time[0] * _displacement(case) / _period(case))),
        peak=float(curve.max()),
        mean=float(np.interp(second, time, curve).mean()),
        cutbacks=cutbacks(result),
        iterations=iterations(result),
        index=index,
    )


def _displacement(case: Case) -> float:
    """Return the displacement of the load at the end (mm)."""
    if isinstance(case, SpaceCase):
        return PLATES[case.layup][2]
    return KINDS[case.specimen].displacement[case.layup]


def _period(case: Case) -> float:
    """Return the step time."""
    return _displacement(case) if isinstance(case, SpaceCase) else 1.0


def all_cases() -> list[Case]:
    """List the rows of all tables, one table after the other."""
    plane = [
        BetaCase(specimen, layup, mesh, beta)
        for specimen in SPECIMENS
        for layup in LAYUPS
        for mesh in MESHES
        for beta in BETAS
    ]
    return [*plane, *(SpaceCase(layup, layers, beta) for layup in PLATES for layers in LAYERS for beta in MULTIPLES)]


def markdown(rows: Mapping[Case, BetaRow]) -> list[str]:
    """Write the tables of the page, each with its finer mesh in the last line; `rows` has the references too."""
    columns = ("beta", "stiffness (N/mm)", "peak (N)", "mean load (N)", "error", "index", "iterations", "cutbacks")
    tables: dict[str, list[Case]] = {}
    for case in rows:
        if case != case.reference:
            tables.setdefault(case.title, []).append(case)
    lines = []
    for title, cases in tables.items():
        finer = rows[cases[0].reference]
        lines += ["", f"### {title[0].upper()}{title[1:]}", "", *head(columns)]
        lines += [_line(case.beta, rows[case], finer) for case in cases]
        lines.append(_line("finer mesh", finer, finer))
    return lines[1:]


def _line(name: str, row: BetaRow, finer: BetaRow) -> str:
    mean, error = f"{row.mean:.2f}", f"{100.0 * (row.mean / finer.mean - 1.0):+z.1f} %"
    if row.stopped:
        # the mean is that of another part of the curve
        mean, error = "stopped", ""
    elif row is finer:
        error = ""
    index = "" if np.isnan(row.index) else f"{row.index:.3f}"
    spent = str(row.iterations), str(row.cutbacks)
    # a run that stops may do so before its peak, or diverge
    peak = "" if row.stopped else f"{row.peak:.2f}"
    return line([name, f"{row.stiffness:#.4g}", peak, mean, error, index, *spent])


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what is missing, print the tables; returns the exit code."""
    description = "Load and oscillation of the consistent element against the stabilisation parameter beta."
    parser = study_parser("uel.paper.study.beta", description, "study/beta", resumes=True)
    parser.add_argument("--page", type=Path, help="file whose tables are written again, those below its mark")
    options = parser.parse_args(arguments)
    cases = all_cases()
    rows: dict[Case, BetaRow] = {}
    for chosen in (list(dict.fromkeys(case.reference for case in cases)), cases):
        rows |= complete(
            chosen,
            row_store(options.output_dir),
            run_case,
            options.output_dir,
            workers=options.workers,
            console=Console(),
            describe=lambda row: row.stopped or f"mean load {row.mean:.2f} N, index {row.index:.3f}",
        )
    tables = "\n".join(markdown(rows)) + "\n"
    if options.page:
        write_tables(options.page, MARK, tables)
    else:
        print(tables, end="")
    return 0


def row_store(folder: Path) -> Store[BetaRow]:
    """Return the rows by the name of their case, in rows.json."""
    return Store(folder / "rows.json", BetaRow.from_json)


if __name__ == "__main__":
    sys.exit(main())
