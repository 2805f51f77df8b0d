# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.paris`: growth of delaminations under cycles over the energy release rate in mixed mode.

Two arms of the paper's composite are bent by end moments, so that the energy release rate is constant. The crack
settles at a constant rate, the slope of its length over the cycles once it has grown by START.

With EXPONENT 0 the rate is 10^(7 BRITTLENESS)/(10^7 (b + 1)) PHI (G/G_c)^(b/2) below the static limit, where PHI is a
length that depends on b and the specimen alone: the growth of the damage is a power b of the tractions, which a power
of G scales. A few runs give PHI, and then ENDURANCE and BRITTLENESS for any measured Paris lines.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from rich.console import Console
from scipy.optimize import least_squares

from uel.delamination.blocks import Interface
from uel.delamination.cycled import Cycles, end_moments, moments_deck
from uel.delamination.kernels import formulations
from uel.delamination.markdown import head, line
from uel.delamination.materials import TABLE_2
from uel.delamination.specimens import mesh_files
from uel.errors import IncrementsUsedUpError, UelError
from uel.fit.endurance import BRITTLENESS, CYCLES, DECADES, ENDURANCE
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.growth import growth
from uel.output.pictures.plots import COLOURS, STYLE
from uel.paper.cycled_specimens import ETA, RATIO, beam_mesh, exponent, specimen, toughness
from uel.paper.growth_measures import REST, START
from uel.paper.study.options import study_parser, write_tables
from uel.running.job import run

MARK = "<!-- written by python -m uel.paper.study.paris -->"
LEVELS = (0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
"""G/G_c."""
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Mode II in G."""
REFINED = 30.0
"""Length of the fine mesh from the tip on (mm)."""
USUAL_JUMP = 0.02
"""DAMAGEJUMP that 0 stands for."""
INCREMENTS = 900
"""Increments of the step of cycles at that jump, which ends with them: about 15 mm of growth."""
MIDDLE, COMPARED = 0.6, (0.0, 0.5, 1.0)
"""G/G_c and mode mixes for which other meshes and properties are compared."""
ENDURANCES = (0.1, 0.2, 0.35)
"""ENDURANCE of the runs that give PHI."""
FITTED = (0.4, 0.6, 0.8)
"""G/G_c at which measured and computed lines are compared."""


@dataclass(frozen=True, slots=True)
class Case:
    """Specimen with an energy release rate.

    level   G/G_c
    shear   share of mode II in G
    size    length of the elements along the crack's path (mm)
    kind    'U4' or 'U2'
    alpha   stiffness of the law (N/mm^3), 0 for infinite
    jump    DAMAGEJUMP
    beta    BETAN and BETAT, 0 for the estimate
    rows    quads over the height of an arm
    quads   their type
    endurance, brittleness  ENDURANCE and BRITTLENESS
    """

    level: float
    shear: float = 0.0
    size: float = 0.25
    kind: str = "U4"
    alpha: float = 0.0
    jump: float = USUAL_JUMP
    beta: float = 0.0
    rows: int = 4
    quads: str = "CPS4"
    endurance: float = ENDURANCE
    brittleness: float = BRITTLENESS

    @property
    def name(self) -> str:
        """Name of the run: the values that are not those of the default."""
        told = {"level": self.level, "shear": self.shear}
        told |= {f.name: getattr(self, f.name) for f in fields(self) if getattr(self, f.name) != f.default}
        return (
            "_".join(["paris", *(f"{name}{value}" for name, value in told.items())]).replace(".", "p").replace("+", "")
        )

    @property
    def toughness(self) -> float:
        """G_c in the mode mix (N/mm)."""
        return toughness(self.shear)

    def files(self) -> dict[str, str]:
        """Write the deck and its include files."""
        mesh = beam_mesh(REFINED, self.size, self.rows)
        fatigue = {"FATIGUE": 2.0, "LOADRATIO": RATIO, "DAMAGEJUMP": self.jump}
        fatigue |= {"ENDURANCE": self.endurance, "BRITTLENESS": self.brittleness, **formulations(self.quads)}
        law = replace(TABLE_2, stiffness_normal=self.alpha, stiffness_shear=self.alpha)
        interface = Interface(self.kind, law, beta=self.beta, law=2, eta=ETA, further=fatigue)
        beams = specimen(self.name, mesh, interface, self.quads)
        moments = end_moments(beams, self.level * self.toughness, self.shear)
        deck = moments_deck(
            "Arms bent by moments, under cycles",
            beams,
            moments,
            Cycles(1e12, round(INCREMENTS * USUAL_JUMP / self.jump)),
        )
        return {**mesh_files(self.name, mesh, (interface.nodes,)), f"{self.name}.inp": deck}


@dataclass(frozen=True, slots=True)
class Measured:
    """Growth (mm/cycle), means of the energy release rates I and II (N/mm), increments and iterations of a run."""

    rate: float
    release: tuple[float, float]
    increments: int
    iterations: int


def measure(case: Case, folder: Path) -> Measured:
    """Run a case, or read its files if it has run.

    Raises
    ------
    UelError
        The crack has not grown far enough.
    """
    deck = folder / f"{case.name}.inp"
    if not (folder / f"{case.name}.sta").exists():
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in case.files().items():
            (folder / name).write_text(content)
        with contextlib.suppress(IncrementsUsedUpError):
            run(deck, output_dir=folder)
    result = Result(folder / case.name)
    whole = growth(result)
    if whole.length[-1] < START + 2.0:
        raise UelError(f"{deck}: the crack has not grown by {START + 2.0:g} mm")
    steady = whole.between(START, REFINED - REST)
    one, two = steady.release.mean(axis=0)
    return Measured(steady.rate, (float(one), float(two)), result.counts.increments, result.counts.iterations)


def variations(shear: float) -> Iterator[tuple[str, Case]]:
    """Yield what should not matter, with the case at MIDDLE."""
    case = Case(MIDDLE, shear)
    for size in (0.5, 0.125):
        yield f"elements of {size:g} mm", replace(case, size=size)
    yield "twice the rows", replace(case, rows=8)
    for jump in (0.05, 0.005):
        yield f"DAMAGEJUMP {jump:g}", replace(case, jump=jump)
    yield "beta 1e6 N/mm³", replace(case, beta=1e6)
    for alpha in (1e6, 1e5):
        yield f"stiffness {alpha:.0e} N/mm³".replace("e+0", "e"), replace(case, alpha=alpha)
    for alpha in (1e6, 1e5):
        yield f"U2, stiffness {alpha:.0e} N/mm³".replace("e+0", "e"), replace(case, kind="U2", alpha=alpha)
    for rows in (8, 4, 2):
        yield f"CPS4I, {rows} rows", replace(case, quads="CPS4I", rows=rows)
    yield "CPS4I, 2 rows, beta 2e5 N/mm³", replace(case, quads="CPS4I", rows=2, beta=2e5)
    yield "CPS4, 2 rows", replace(case, rows=2)


def report(folder: Path) -> str:
    """Measure, and write the tables of the page."""
    grown = {(shear, level): measure(Case(level, shear), folder) for shear in SHARES for level in LEVELS}
    lines = ["", "Growth in mm/cycle:", "", *head(["G/G_c", *(f"B = {shear:g}" for shear in SHARES)])]
    lines += [line([f"{level:g}", *(f"{grown[shear, level].rate:.3e}" for shear in SHARES)]) for level in LEVELS]
    slopes = [
        np.polyfit(np.log(LEVELS), np.log([grown[shear, level].rate for level in LEVELS]), 1)[0] for shear in SHARES
    ]
    lines.append(line(["exponent", *(f"{slope:.3f}" for slope in slopes)]))
    lines.append(line(["b/2", *(f"{exponent(shear) / 2:.3f}" for shear in SHARES)]))
    lines += ["", f"At G/G_c = {MIDDLE:g}, over the growth above:", "", *head(["", *(f"B = {b:g}" for b in COMPARED)])]
    base = {shear: grown[shear, MIDDLE].rate for shear in COMPARED}
    rows: dict[str, list[str]] = {}
    for shear in COMPARED:
        for name, case in variations(shear):
            rows.setdefault(name, []).append(f"{measure(case, folder).rate / base[shear]:.3f}")
    lines += [line([name, *values]) for name, values in rows.items()]
    iterations, increments = (
        sum(getattr(growth, name) for growth in grown.values()) for name in ("iterations", "increments")
    )
    worst = max(
        abs(part / (share * level * Case(level, shear).toughness) - 1)
        for (shear, level), growth in grown.items()
        for part, share in zip(growth.release, (1 - shear, shear), strict=True)
        if share
    )
    lines += ["", f"The energy release rates of `uel front` are those of the moments to {worst:.1%}."]
    lines.append(f"An increment takes {iterations / increments:.2f} iterations.")
    (endurance, brittleness), computed = fit_lines(folder)
    lines += [
        "",
        f"Fitted to the measured lines: ENDURANCE {endurance:.3f}, BRITTLENESS {brittleness:.3f}.",
        "Computed over measured growth:",
    ]
    lines += ["", *head(["G/G_c", *(f"B = {shear:g}" for shear in SHARES)])]
    for k, level in enumerate(FITTED):
        wanted = [c * level**m for c, m in map(measured_line, SHARES)]
        lines.append(
            line([f"{level:g}", *(f"{10 ** computed[b][k] / w:.2f}" for b, w in zip(SHARES, wanted, strict=True))])
        )
    fitted = [exponent(shear, endurance, brittleness) / 2 for shear in SHARES]
    lines.append(line(["exponent b/2", *(f"{value:.2f}" for value in fitted)]))
    lines.append(line(["measured m", *(f"{measured_line(shear)[1]:.2f}" for shear in SHARES)]))
    checks = [measure(Case(MIDDLE, b, endurance=endurance, brittleness=brittleness), folder).rate for b in SHARES]
    said = [10 ** computed[shear][FITTED.index(MIDDLE)] for shear in SHARES]
    off = max(abs(a / b - 1) for a, b in zip(checks, said, strict=True))
    lines += [
        "",
        f"Runs with the fitted values are within {off:.1%} of the growth that PHI foretells at G/G_c = {MIDDLE:g}.",
    ]
    draw_lines(Path(__file__).parents[4] / "fortran" / "fatigue.png", grown, computed)
    return "\n".join(lines) + "\n"


def measured_line(shear: float) -> tuple[float, float]:
    """Return C (mm/cycle) and m of the measured da/dN = C (G/G_c)^m of the composite.

    L. Carreras et al., as used by J. Trabal et al., Engineering Fracture Mechanics 2022: C_I 3.08e-3, C_II 0.149, C_m
    458087, m_I 5.4, m_II 4.5, m_m 4.94.
    """
    one, two, mixed = 3.08e-3, 0.149, 458087.0
    c = (two / (one * mixed)) ** (shear**2) * mixed**shear * one
    return c, shear**2 * (4.5 - 5.4 - 4.94) + shear * 4.94 + 5.4


def lengths(shear: float, folder: Path) -> tuple[FloatArray, FloatArray]:
    """Measure b and log10 of PHI (mm) in a mode mix, for ENDURANCES."""
    cases = [Case(MIDDLE, shear, endurance=endurance) for endurance in ENDURANCES]
    powers = np.array([exponent(shear, case.endurance) for case in cases])
    rates = np.array([measure(case, folder).rate for case in cases])
    return powers, np.log10(rates * CYCLES * (powers + 1.0)) - DECADES * BRITTLENESS - 0.5 * powers * np.log10(MIDDLE)


def fit_lines(folder: Path) -> tuple[tuple[float, float], dict[float, FloatArray]]:
    """Fit ENDURANCE and BRITTLENESS to the measured lines; also log10 of the growth at FITTED by mode mix."""
    known = {shear: np.polyfit(*lengths(shear, folder), 2) for shear in SHARES}
    levels = np.log10(FITTED)

    def computed(values: FloatArray) -> dict[float, FloatArray]:
        growth = {}
        for shear, phi in known.items():
            power = exponent(shear, *values)
            growth[shear] = (
                DECADES * values[1] - np.log10(CYCLES * (power + 1.0)) + np.polyval(phi, power) + 0.5 * power * levels
            )
        return growth

    def misses(values: FloatArray) -> FloatArray:
        growth = computed(values)
        wanted = {shear: np.log10(c) + m * levels for shear in SHARES for c, m in [measured_line(shear)]}
        return np.concatenate([growth[shear] - wanted[shear] for shear in SHARES])

    found = least_squares(misses, np.array([ENDURANCE, BRITTLENESS]), bounds=([0.01, 0.1], [0.9, 3.0]))
    return (float(found.x[0]), float(found.x[1])), computed(found.x)


def draw_lines(
    path: Path,
    grown: Mapping[tuple[float, float], Measured],
    computed: Mapping[float, FloatArray],
) -> None:
    """Draw the growth with the default properties, and measured lines with those of the fit."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.2, 3.6), layout="constrained")
        FigureCanvasAgg(figure)
        left, right = figure.subplots(1, 2, sharey=True)
        for colour, shear in zip(COLOURS, SHARES, strict=False):
            left.loglog(
                LEVELS, [grown[shear, level].rate for level in LEVELS], "o-", color=colour, label=f"$B$ = {shear:g}"
            )
            c, m = measured_line(shear)
            ends = np.array([FITTED[0], FITTED[-1]])
            right.loglog(ends, c * ends**m, color=colour)
            right.loglog(FITTED, 10 ** computed[shear], "--", color=colour)
        left.set(title="Default properties", xlabel="$G/G_c$", ylabel="d$a$/d$N$ (mm/cycle)")
        right.set(title="Measured (lines) and fitted (dashes)", xlabel="$G/G_c$")
        for axes in (left, right):
            axes.set_xticks(LEVELS, [f"{level:g}" for level in LEVELS])
            axes.minorticks_off()
        left.legend()
        figure.savefig(path, dpi=150)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    options = study_parser("uel.paper.study.paris", __doc__.splitlines()[0], "paris").parse_args(arguments)
    page = Path(__file__).parents[4] / "fortran" / "fatigue.md"
    write_tables(page, MARK, report(options.output_dir))
    Console().print(f"{page}: written")
    return 0


if __name__ == "__main__":
    sys.exit(main())
