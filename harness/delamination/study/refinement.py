# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m harness.delamination.study.refinement`: which part of a perturbed interface's tractions is real.

An interface with bumps carries tractions that vary along it in truth: a facet inclined by theta has the shear
(sigma_yy - sigma_xx) sin(theta) cos(theta) of the bending stress in the arms, and slip over bumps opens and closes
them. So the oscillation index of a perturbed mesh does not tell an element's error. Here the bumps stay and the quads
are cut into 2 x 2 and 4 x 4: what stays is real, what goes is numerical.

The problem is linear: an interface of finite stiffness that does not fail, under a unit displacement. The tractions are
taken from 2 mm beyond the crack's tip on, which refinement makes sharper, to 2 mm before the load or the clamp.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rich.console import Console
from rich.table import Table

from harness.delamination import specimens
from harness.delamination.blocks import Interface, Specimen
from harness.delamination.materials import TABLE_2
from harness.delamination.mesh import refined
from harness.delamination.oscillation import total_variation
from harness.delamination.steps import LINEAR
from harness.delamination.study.cases import ELEMENTS, KINDS, LAYUPS, MESHES
from harness.job import run

FACTORS = (1, 2, 4)
STIFFNESS = 1.0e8
# out of reach, and so tough that the softening slope stays below beta
INTACT = replace(
    TABLE_2.with_stiffness(STIFFNESS), strength_normal=1e6, strength_shear=1e6, toughness_1=1e10, toughness_2=1e10
)
# where the tractions are taken (mm)
STRETCHES = {"dcb": (37.0, 59.0), "enf": (37.0, 48.0), "frmm": (37.0, 48.0)}


def variations(specimen: str, layup: str, element: str, factor: int, folder: Path) -> dict[str, float]:
    """Total variation (MPa) of TN and TT along the perturbed interface at a displacement of 1 mm.

    Parameters
    ----------
    specimen, layup, element
        As in the rows of the study.
    factor
        Every quad is cut into factor x factor; the bumps are those of the mesh with 1.
    folder
        Gets the files of the run.
    """
    kind = KINDS[specimen]
    top, bottom = LAYUPS[layup]
    element_type, consistent = ELEMENTS[element]
    mesh = refined(kind.mesh(kind.size, MESHES["perturbed"] * kind.size), factor)
    interface = Interface(element_type, INTACT, consistent=consistent)
    deck = kind.deck("bumps", Specimen("mesh", mesh, interface, specimens.WIDTH, bottom, top), 1.0, LINEAR, 1)
    folder.mkdir(parents=True, exist_ok=True)
    nodes = 8 if element_type == "U4" else 4
    for name, content in (specimens.mesh_files("mesh", mesh, (nodes,)) | {"bumps.inp": deck}).items():
        (folder / name).write_text(content, encoding="ascii")
    profile = run(folder / "bumps.inp", output_dir=folder).interface()
    begin, end = STRETCHES[specimen]
    inside = (profile["X"] > begin) & (profile["X"] < end)
    return {name: total_variation(profile[name][inside]) for name in ("TN", "TT")}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all, print a table; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m harness.delamination.study.refinement",
        description="Refine meshes inside the bumps of an interface: what of its tractions stays is real.",
    )
    parser.add_argument("--output-dir", type=Path, default=Path("study/refinement"), help="folder of all files written")
    folder: Path = parser.parse_args(arguments).output_dir
    table = Table("specimen", "layup", "element", "traction", *(f"TV, h/{factor} (MPa)" for factor in FACTORS))
    for specimen in STRETCHES:
        for layup in LAYUPS:
            for element in ("standard", "consistent"):
                found = [variations(specimen, layup, element, factor, folder) for factor in FACTORS]
                for name in ("TN", "TT"):
                    table.add_row(specimen, layup, element, name, *(f"{values[name]:.2f}" for values in found))
    Console().print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
