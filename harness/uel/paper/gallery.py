# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A picture for each problem of abaqus_inputs, of its runs: `python -m uel.paper.gallery [PROBLEM ...]`."""

from __future__ import annotations

import argparse
import sys
import tempfile
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from uel.delamination.beams import BRANCH, growth
from uel.delamination.theory import dcb_curve, dcb_elastica
from uel.errors import FAILURES, tell_failure
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.pictures.growth import growth as cycled
from uel.output.pictures.jobs import PictureOptions, draw
from uel.output.pictures.plots import Curve, load_displacement, stacked
from uel.paper import elastica, literature, measures, space_beams
from uel.paper.bridging import TIP, TOTAL
from uel.paper.cycled_specimens import exponent, toughness
from uel.paper.decks import FOLDER
from uel.paper.growth_measures import REST, START
from uel.running.job import run
from uel.solver.options import SolverOptions

PICTURE: Final = "picture.png"
"""Name of the picture in the folder of a problem."""
_SIZE: Final = (960, 960)
"""Pixels of a picture, at most: twice what a page shows."""

Results = Sequence[Result]


@dataclass(frozen=True, slots=True)
class Example:
    """Picture of a problem: decks of its folder, and a function that draws their results into a file."""

    decks: tuple[str, ...]
    draw: Callable[[Results, Path], Path]


def fallback_of(folder: Path) -> bool:
    """Report whether the decks of a folder are run with `uel run --fallback`."""
    return bool(tomllib.loads((folder / "reference.toml").read_text("utf-8")).get("fallback", False))


def values_of(folder: Path, kind: str) -> list[Mapping[str, object]]:
    """Read the entries of reference.toml of a kind."""
    entries = tomllib.loads((folder / "reference.toml").read_text("utf-8"))["value"]
    return [entry for entry in entries if entry["kind"] == kind]


def _loads(reference: Callable[[Results], list[Curve]], moved: str, *names: str) -> Callable[[Results, Path], Path]:
    """Load over displacement of runs, by name, beside references; `moved` says what is displaced."""

    def drawn(results: Results, path: Path) -> Path:
        runs = [
            Curve(name, _from_origin(measures.displacement(result)), _from_origin(measures.load(result)))
            for name, result in zip(names or ("uel run",), results, strict=True)
        ]
        return load_displacement([*runs, *reference(results)], path, x_label=f"{moved} [mm]")

    return drawn


def _from_origin(values: FloatArray) -> FloatArray:
    return np.insert(values, 0, 0.0)


def _beam(problem: str) -> Callable[[Results], list[Curve]]:
    """Compute a specimen of the paper by beam theory, as far as it is compared, up to the end of the run."""

    def curve(results: Results) -> list[Curve]:
        x, y = growth(problem).between(0.0, BRANCH[problem][1]).with_origin()
        shown = x <= measures.final_displacement(results[0])
        return [Curve("beam theory", x[shown], y[shown], "reference")]

    return curve


def _other_codes(_: Results) -> list[Curve]:
    """Return peak and end of the beam that other codes have run."""
    value = {
        str(entry["quantity"]): float(str(entry["value"])) for entry in values_of(FOLDER / "dcb_ref", "other code")
    }
    x = [0.5 * value["peak_opening"], 5.0]
    return [Curve("two other codes", x, [value["peak_load"], value["final_load"]], "points")]


def _abaqus(_: Results) -> list[Curve]:
    """Return the published loads of Abaqus; the opening is the time."""
    entries = [entry for entry in values_of(FOLDER / "dcb_3d", "other code") if "at" in entry]
    x, y = ([float(str(entry[name])) for entry in entries] for name in ("at", "value"))
    return [Curve("Abaqus", x, y, "points")]


def _elastica(results: Results) -> list[Curve]:
    """Load in growth, from where the crack grows."""
    opening = 2.0 * measures.displacement(results[0])
    grown = opening[int(measures.load(results[0]).argmax()) :]
    bending = elastica.MODULUS * elastica.HEIGHT**3 / 12.0
    loads = [dcb_elastica(bending, elastica.TOUGHNESS, 1.0, value)[0] for value in grown]
    return [Curve("elastica", 0.5 * grown, loads, "reference")]


def _krueger_dcb(_: Results) -> list[Curve]:
    """Return the report's loads, of half of the width."""
    moved, loads = np.array(list(literature.DCB_CRITICAL.values())).T
    return [Curve("Krueger, virtual crack closure", 2.0 * moved, 0.5 * loads, "points")]


def _krueger_mmb(_: Results) -> list[Curve]:
    """Return the points where the report's cracks begin to grow, on a width of 1 mm."""
    moved, loads = np.array([value[1:] for value in literature.MMB_CRITICAL.values()]).T
    return [Curve("Krueger, virtual crack closure", moved, loads / literature.MMB_WIDTH, "points")]


def _circle(results: Results) -> list[Curve]:
    """Load of a quarter of two thin plates whose delamination grows."""
    end = measures.final_displacement(results[0])
    return [Curve("closed form, thin plates", [0.0, end], [0.25 * literature.circle_load()] * 2, "reference")]


def _space_beam(results: Results) -> list[Curve]:
    """Compute the load curve by corrected beam theory in plane strain."""
    opening = np.linspace(0.0, measures.final_displacement(results[0]), 200)
    loads = dcb_curve(space_beams.ARMS, space_beams.CRACK, space_beams.LAW.toughness_1, 0.5 * opening)
    return [Curve("beam theory", opening, loads, "reference")]


def _resistance(results: Results, path: Path) -> Path:
    """Draw the energy release rate over the growth of a crack, beside that of its tip and of the plateau."""
    whole = cycled(results[0])
    length = [0.0, float(whole.length[-1])]
    curves = [
        Curve(name, length, [value] * 2, "reference")
        for name, value in (("tip and plateau", TIP), ("tip and plateau", TOTAL))
    ]
    curves.append(Curve("uel front", whole.length, whole.release.sum(axis=1)))
    return stacked([curves], path, "Growth of the crack [mm]", ["Energy release rate [N/mm]"])


def _growths(results: Results, path: Path) -> Path:
    """Draw growth over the energy release rate: where it changes, and lines of b/2 from specimens under moments."""
    curves = []
    loads = {"mode I": "held apart", "mode II": "bent by a force"}
    for k, (name, load) in enumerate(loads.items()):
        limit = toughness(float(k))
        whole, moments = (cycled(result) for result in results[2 * k : 2 * k + 2])
        release, rate = whole.between(START, whole.length[-1] - REST).line
        steady = moments.between(START, np.inf)
        point = float(steady.release.sum(axis=1).mean()) / limit
        shown = np.linspace(0.28, 0.68, 50)
        line = np.log10(steady.rate) + 0.5 * exponent(float(k)) * np.log10(shown / point)
        curves += [
            Curve("exponent b/2", shown, line, "reference"),
            Curve(f"{name}, {load}", release / limit, np.log10(rate)),
            Curve(f"{name}, bent by moments", [point], [np.log10(steady.rate)], "points"),
        ]
    return stacked([curves], path, "$G/G_c$", ["$\\log_{10}$ of d$a$/d$N$ [mm/cycle]"])


def _tractions(*names: str, exact: float | None = None) -> Callable[[Results, Path], Path]:
    """Draw the normal traction along an interface of runs, by name, and the exact one (MPa) where there is one."""

    def drawn(results: Results, path: Path) -> Path:
        curves = []
        for name, result in zip(names, results, strict=True):
            profile = result.interface()
            order = np.argsort(profile["X"], kind="stable")
            curves.append(Curve(name, profile["X"][order], profile["TN"][order], "marked"))
        if exact is not None:
            curves.append(Curve("exact", [0.0, 1.0], [exact, exact], "reference"))
        return stacked([curves], path, "x [mm]", ["Normal traction [MPa]"])

    return drawn


def _forces(*names: str) -> Callable[[Results, Path], Path]:
    """Draw the force that does the work over its displacement, of runs by name."""

    def drawn(results: Results, path: Path) -> Path:
        found = [result.load_curve for result in results]
        curves = [
            Curve(name, _from_origin(curve.x), _from_origin(curve.y))
            for name, curve in zip(names, found, strict=True)
            if curve is not None
        ]
        return load_displacement(curves, path)

    return drawn


def _mesh(field: str) -> Callable[[Results, Path], Path]:
    """Draw the deformed mesh with a field."""
    return lambda results, path: draw("mesh", results, path, PictureOptions(field=field))


ARM, OPENING = "Displacement of an arm", "Opening"
EXAMPLES: Final[Mapping[str, Example]] = {
    "bridging": Example(("dcb",), _resistance),
    "circle": Example(("circle",), _loads(_circle, OPENING)),
    "cohesive": Example(("frmm_coh2d4", "frmm_u2", "frmm_u4"), _tractions("COH2D4", "U2, standard", "U4, consistent")),
    "dcb": Example(("dcb_u4_1e8",), _loads(_beam("dcb"), ARM)),
    "dcb_3d": Example(("dcb_3d",), _loads(_abaqus, OPENING)),
    "dcb_3d_stabilised": Example(
        ("dcb_3d_u8_infinite", "dcb_3d_u8_fine"), _loads(lambda _: [], OPENING, "elements of 0.5 mm", "of 0.25 mm")
    ),
    "dcb_elastica": Example(("dcb_elastica_u4",), _loads(_elastica, ARM)),
    "dcb_ref": Example(("dcb_ref",), _loads(_other_codes, ARM)),
    "fatigue": Example(("dcb", "moments_opened", "enf", "moments_slid"), _growths),
    "krueger_dcb": Example(("krueger_dcb",), _loads(_krueger_dcb, OPENING)),
    "krueger_mmb": Example(
        ("mmb_20", "mmb_50", "mmb_80"),
        _loads(_krueger_mmb, "Displacement of the lever", *(f"mode II {share} %" for share in (20, 50, 80))),
    ),
    "paper_dcb": Example(("dcb_0_0_consistent_1e6",), _mesh("SPENT")),
    "paper_enf": Example(("enf_0_0_consistent_1e6",), _loads(_beam("enf"), "Deflection at mid-span")),
    "paper_frmm": Example(("frmm_0_0_consistent_1e6",), _loads(_beam("frmm"), "Displacement of the upper arm")),
    "patch_horizontal": Example(("perturbed_u2", "perturbed_u4"), _tractions("U2, standard", "U4, paper's")),
    "patch_inclined": Example(
        ("inclined_0_0_standard_decimals7", "inclined_0_0_consistent_decimals7"),
        _tractions("U2, standard", "U4, consistent", exact=-1.896),
    ),
    "peel": Example(("peel_u4",), _mesh("SPENT")),
    "properties": Example(("u4_zeros", "u4_exponential", "u4_ppr"), _forces("bilinear", "exponential", "PPR")),
    "quad_cook": Example(("cook_u1",), _mesh("U2")),
    "space_beams": Example(("dcb_0_0_turned",), _loads(_space_beam, OPENING)),
}
"""Pictures by folder of abaqus_inputs."""


def write(problem: str, target: Path) -> None:
    """Run the decks of a problem and draw them.

    Parameters
    ----------
    problem
        One of EXAMPLES.
    target
        The picture, .png.
    """
    example, folder = EXAMPLES[problem], FOLDER / problem
    with tempfile.TemporaryDirectory() as jobs:
        solver = SolverOptions(fallback=fallback_of(folder))
        results = [run(folder / f"{deck}.inp", output_dir=jobs, solver=solver, quiet=True) for deck in example.decks]
        draw_results(problem, results, target)


def draw_results(problem: str, results: Results, target: Path) -> None:
    """Draw what the decks of a problem gave, in few colours and pixels: the pictures are in the repository."""
    EXAMPLES[problem].draw(results, target)
    with Image.open(target) as picture:
        picture.thumbnail(_SIZE)
        smaller = picture.convert("RGB").quantize(256)
    smaller.save(target, optimize=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Draw problems; returns the exit code."""
    parser = argparse.ArgumentParser(
        description=f"Run decks of the problems of abaqus_inputs and draw them, each into {PICTURE} of its folder.",
        epilog="Exit code: 0 all are drawn; 1 a run has not completed, and the last lines say why; 2 wrong usage.",
    )
    parser.add_argument("problems", nargs="*", metavar="PROBLEM", help=f"of {', '.join(EXAMPLES)} (all)")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="with a folder for each problem (abaqus_inputs)")
    options = parser.parse_args(arguments)
    for problem in options.problems:
        if problem not in EXAMPLES:
            parser.error(f"no problem {problem}; expected some of {', '.join(EXAMPLES)}")
    try:
        for problem in options.problems or EXAMPLES:
            target = options.folder / problem / PICTURE
            target.parent.mkdir(parents=True, exist_ok=True)
            write(problem, target)
            print(f"written: {target}", flush=True)
    except FAILURES as error:
        tell_failure(error)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
