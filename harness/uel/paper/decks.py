# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""All decks of abaqus_inputs that are built: `python -m uel.paper.decks` writes them again."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from uel import data_files
from uel.delamination import specimens as build
from uel.delamination.blocks import BY_EQUATION_21, Interface
from uel.delamination.materials import TABLE_2
from uel.delamination.steps import LINEAR, Increments
from uel.paper.bricks import bricks_files, stabilised_bricks_files
from uel.paper.bridging import bridging_files
from uel.paper.columns import column_files
from uel.paper.comparator import comparator_files
from uel.paper.cook import cook_files
from uel.paper.cycled_specimens import fatigue_files
from uel.paper.elastica import elastica_files
from uel.paper.literature import literature_files
from uel.paper.peel import peel_files
from uel.paper.reproduce.cases import PROBLEMS, comparator_cases, longer_cases, paper_cases
from uel.paper.reproduce.patch_cases import inclined_cases
from uel.paper.space_beams import space_beam_files

FOLDER = data_files.FOLDER / "abaqus_inputs"
KINDS = {"U2": "standard", "U3": "paper's, four nodes", "U4": "paper's, eight nodes"}
SAMPLINGS = ("face", "gauss")
STIFFNESSES = {"1e6": 1.0e6, "1e8": 1.0e8}
# Relaxation time of the damage in step time, times the stiffness (N/mm^3). Where an element fails within one increment
# of duration t, its damage stays short of d by viscosity/t; that has to be small beside 1 - d, which in softening is
# of the order of the ratio of onset to final separation and so proportional to 1/stiffness.
VISCOSITY = 3.0

# U3 does not own the nodes its bulk stress depends on and converges linearly, but quickly: a few iterations more
STRICT = replace(LINEAR, residual=1e-11)
DCB_INCREMENTS = Increments(
    initial=0.01, smallest=1e-7, largest=0.01, limit=2000, discontinuous=True, line_search=5, attempts=12
)
# coarse elements fail with a jump in the load: longer line searches follow it more closely
DCB_REF_INCREMENTS = replace(DCB_INCREMENTS, line_search=10)


def patch_horizontal() -> dict[str, str]:
    """Write the square patch with a horizontal interface, section 4.1.1."""
    files: dict[str, str] = {}
    for shape, bump in (("flat", 0.0), ("perturbed", build.PATCH_BUMP)):
        mesh = build.patch_mesh(bump)
        files |= build.mesh_files(shape, mesh, (4, 8))
        for kind, name in KINDS.items():
            increments = STRICT if kind == "U3" else LINEAR
            title = f"Patch test, horizontal {shape} interface, [0/0], {name} ({kind})"
            paper = build.patch_specimen(shape, mesh, kind, 0.0 if kind == "U2" else build.PATCH_BETA)
            files[f"{shape}_{kind.lower()}.inp"] = build.patch_deck(title, paper, -0.1, increments, slide=False)
            if shape == "flat":
                deck = build.patch_deck(f"{title}, free to contract", paper, -0.1, increments, slide=True)
                files[f"free_{kind.lower()}.inp"] = deck
            elif kind != "U2":
                estimate = build.patch_specimen(shape, mesh, kind, BY_EQUATION_21)
                deck = build.patch_deck(f"{title}, beta by equation (21)", estimate, -0.1, increments, slide=False)
                files[f"{shape}_{kind.lower()}_beta21.inp"] = deck
    return files


def dcb() -> dict[str, str]:
    """Write the double cantilever beam of section 4.2, 3 mm each arm."""
    mesh = build.dcb_mesh()
    files = build.mesh_files("dcb", mesh, (4, 8))
    for kind, name in KINDS.items():
        for exponent, stiffness in STIFFNESSES.items():
            files[f"dcb_{kind.lower()}_{exponent}.inp"] = _dcb_deck(kind, name, exponent, stiffness, "U1")
    files["dcb_u4_1e8_cps4.inp"] = _dcb_deck("U4", KINDS["U4"], "1e8", 1.0e8, "CPS4")
    for sampling, place in enumerate(SAMPLINGS, start=1):
        name = f"{KINDS['U4']}, bulk stress at the {place} point"
        files[f"dcb_u4_1e8_{place}.inp"] = _dcb_deck("U4", name, "1e8", 1.0e8, "U1", sampling)
    return files


def _dcb_deck(kind: str, name: str, exponent: str, stiffness: float, quads: str, sampling: int = 0) -> str:
    cohesive = TABLE_2.with_stiffness(stiffness)
    interface = Interface(
        kind, cohesive, beta=BY_EQUATION_21, viscosity=VISCOSITY / stiffness, sampling=sampling, consistent=False
    )
    specimen = build.dcb_specimen("dcb", build.dcb_mesh(), interface, quads)
    title = f"Double cantilever beam, [0/0], {name} ({kind}), stiffness {exponent} N/mm^3, quads {quads}"
    return build.dcb_deck(title, specimen, 3.0, DCB_INCREMENTS, field_every=10)


def dcb_ref() -> dict[str, str]:
    """Write the double cantilever beam that other codes have run: uniform mesh, 5 mm each arm in 100 increments."""
    mesh = build.dcb_ref_mesh()
    interface = Interface("U2", TABLE_2.with_stiffness(1.0e6), viscosity=VISCOSITY / 1.0e6)
    specimen = build.dcb_specimen("dcb_ref", mesh, interface)
    title = "DCB-ref: double cantilever beam, 600 x 8 quads, standard elements, stiffness 1e6 N/mm^3"
    deck = build.dcb_deck(title, specimen, 5.0, DCB_REF_INCREMENTS, field_every=10)
    return build.mesh_files("dcb_ref", mesh, (4,)) | {"dcb_ref.inp": deck}


def patch_inclined() -> dict[str, str]:
    """Write the square patch with an inclined interface, section 4.1.2."""
    return {name: content for case in inclined_cases() for name, content in case.files().items()}


def paper(problem: str) -> dict[str, str]:
    """Write the runs of sections 4.2 to 4.4 as in `uel reproduce`: two layups, three stiffnesses, two meshes."""
    cases = paper_cases(problem) + comparator_cases(problem) + (longer_cases() if problem == "frmm" else [])
    return {name: content for case in cases for name, content in case.files().items()}


def all_files() -> dict[Path, str]:
    """Return every built file, by its path below abaqus_inputs."""
    problems = {"patch_horizontal": patch_horizontal, "dcb": dcb, "dcb_ref": dcb_ref, "quad_cook": cook_files}
    problems |= {
        "patch_inclined": patch_inclined,
        "cohesive": comparator_files,
        "properties": column_files,
        "dcb_3d": bricks_files,
        "dcb_3d_stabilised": stabilised_bricks_files,
        "space_beams": space_beam_files,
        "peel": peel_files,
        "bridging": bridging_files,
        "fatigue": fatigue_files,
        "dcb_elastica": elastica_files,
    }
    problems |= {f"paper_{name}": partial(paper, name) for name in PROBLEMS}
    problems |= literature_files()
    return {Path(folder, name): text for folder, problem in problems.items() for name, text in problem().items()}


def main(arguments: Sequence[str] | None = None) -> int:
    """Write all decks; returns the exit code."""
    parser = argparse.ArgumentParser(description="Write the decks of abaqus_inputs again.")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="in place of abaqus_inputs")
    folder = parser.parse_args(arguments).folder
    files = all_files()
    for path, text in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="ascii")
    print(f"{folder}: {len(files)} files")
    return 0


if __name__ == "__main__":
    sys.exit(main())
