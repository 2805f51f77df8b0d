# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.refinement`: which part of a perturbed interface's tractions is real.

An interface with bumps carries tractions that really vary along it: a facet inclined by theta has the shear
(sigma_yy - sigma_xx) sin(theta) cos(theta) of the bending stress in the arms, and slip over bumps opens and closes
them. Here the bumps stay and the quads are cut into 2 x 2 and 4 x 4: what stays is real, what goes is numerical. All
tractions are averaged over the share of each point of the coarsest mesh, as the references of the study are.

- Bonded: a linear problem, an interface of finite stiffness that does not fail, under a displacement of 1 mm. The
  tractions are taken from 2 mm beyond the crack's tip on, which refinement makes sharper, to 2 mm before the load or
  the clamp. Between plies of the same direction the interface is a line inside a homogeneous body, whose stress does
  not depend on the line: the stress on a straight interface, turned into each facet, is what acts there, without
  stabilisation or cohesive stiffness.
- Failing: rows of the study, with the fall-back. The standard and the consistent element should arrive at the same
  tractions at 1e6 N/mm^3. That is less than the plies have at the scale of the bumps, E times wave number: such a bond
  yields to the bumps, and carries less of them than a rigid one.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.mesh import TwoArmMesh
from uel.delamination.oscillation import total_variation
from uel.delamination.steps import LINEAR
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.run_deck import run_deck
from uel.paper.study.cases import KINDS, LAYUPS, deck_files, interface_of, mesh_of
from uel.paper.study.options import study_parser
from uel.paper.study.reference import Profile, restricted
from uel.paper.study.rows import at_tenths, bonded_part

FACTORS = (1, 2, 4)
STIFFNESS = 1.0e8
# out of reach, and so tough that the softening slope stays below beta
INTACT = replace(
    TABLE_2.with_stiffness(STIFFNESS), strength_normal=1e6, strength_shear=1e6, toughness_1=1e10, toughness_2=1e10
)
# where the tractions are taken (mm)
STRETCHES = {"dcb": (37.0, 59.0), "enf": (37.0, 48.0), "frmm": (37.0, 48.0)}
# half of the displacement: the process zone of the mixed-mode specimen has formed and runs
FAILING = {"frmm": 0.5}
TRACTIONS = ("TN", "TT")


@dataclass(frozen=True, slots=True)
class Bonded:
    """Linear problem of a specimen whose interface holds; entries as in the rows of the study, and the refinement."""

    specimen: str
    layup: str
    element: str
    mesh: str
    factor: int

    @property
    def name(self) -> str:
        """Name of the run."""
        return f"bonded_{self.specimen}_{self.layup.replace('/', '-')}_{self.element}_{self.mesh}_{self.factor}"

    @property
    def refined_mesh(self) -> TwoArmMesh:
        """Mesh with every quad cut into factor x factor."""
        return mesh_of(KINDS[self.specimen], self.mesh, self.factor)

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        kind, interface = KINDS[self.specimen], replace(interface_of(self.element, "1e8"), cohesive=INTACT)
        mesh = self.refined_mesh
        return deck_files(self.name, "bumps", kind, self.layup, mesh, interface, displacement=1.0, increments=LINEAR)


@dataclass(frozen=True, slots=True)
class Failing:
    """Row of the study on its perturbed mesh, [0/0], with the quads cut into factor x factor."""

    specimen: str
    stiffness: str
    element: str
    factor: int

    @property
    def name(self) -> str:
        """Name of the run."""
        return f"failing_{self.specimen}_{self.stiffness}_{self.element}_{self.factor}"

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        kind, interface = KINDS[self.specimen], interface_of(self.element, self.stiffness)
        mesh = mesh_of(kind, "perturbed", self.factor)
        return deck_files(self.name, "bumps", kind, "0/0", mesh, interface)


def bonded(problem: Bonded, folder: Path) -> dict[str, FloatArray]:
    """Return TN and TT (MPa) of a bonded interface at the points of the coarsest mesh, on the specimen's stretch."""
    result = run_deck(problem, folder, fallback=False).result
    return _stretch(problem.specimen, restricted(result.interface(), problem.factor))


def turned(specimen: str, folder: Path) -> dict[str, FloatArray]:
    """Return TN and TT (MPa) on facets of the perturbed [0/0] mesh from the stress along a straight bond."""
    problem = Bonded(specimen, "0/0", "consistent", "structured", 2)
    outcome = run_deck(problem, folder, fallback=False, fields=True)
    profile = restricted(outcome.result.interface(), problem.factor)
    strain = _strain_along(outcome.result, problem.refined_mesh)
    stress = (PLY_0.e1 * strain + PLY_0.nu12 * profile["TN"], profile["TN"], profile["TT"])
    coarse = mesh_of(KINDS[specimen], "perturbed")
    angle = np.arctan(np.diff(coarse.bumps) / np.diff(coarse.x))[coarse.first :]
    normal, tangential = on_facets(stress, np.repeat(angle, 2))
    return _stretch(specimen, profile | {"TN": normal, "TT": tangential})


def on_facets(stress: tuple[FloatArray, FloatArray, FloatArray], angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return t_n, t_tau (n,) on facets inclined by `angle` (n,) from sigma_xx, sigma_yy, sigma_xy, each (n,)."""
    xx, yy, xy = stress
    sin, cos = np.sin(angle), np.cos(angle)
    return xx * sin**2 + yy * cos**2 - 2.0 * xy * sin * cos, (yy - xx) * sin * cos + xy * (cos**2 - sin**2)


def _strain_along(result: Result, mesh: TwoArmMesh) -> FloatArray:
    """Return epsilon_xx of every interface element, the mean of its two sides."""
    labels = mesh.nodes()[0]
    places = [np.searchsorted(labels, line[mesh.first :]) for line in mesh.interface_lines]
    displacement = result.field("U")[:, 0]
    mean = 0.5 * sum(displacement[place] for place in places)
    return np.asarray(np.diff(mean) / np.diff(mesh.x[mesh.first :]))


def _stretch(specimen: str, profile: Profile) -> dict[str, FloatArray]:
    begin, end = STRETCHES[specimen]
    inside = (profile["X"] > begin) & (profile["X"] < end)
    return {name: profile[name][inside] for name in TRACTIONS}


def failing(problem: Failing, folder: Path) -> dict[str, FloatArray]:
    """Return TN and TT (MPa) of a failing interface at the coarsest mesh's points that hold, in mid-run."""
    profiles = at_tenths(run_deck(problem, folder, fallback=True).result.interfaces())
    moment = FAILING[problem.specimen]
    profile = min(profiles, key=lambda profile: abs(float(profile["time"][0]) - moment))
    return bonded_part(restricted(profile, problem.factor))


def facet_means(values: FloatArray) -> FloatArray:
    """Average over facets (n,) values at their two points, (2 n,), or (2 n + 1,) from the second of a facet on."""
    return np.asarray(values[len(values) % 2 :].reshape(-1, 2).mean(axis=1))


def _variation(values: FloatArray) -> str:
    return f"{total_variation(values):.2f} ({total_variation(facet_means(values)):.2f})"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all, print the tables; returns the exit code."""
    description = "Refine meshes inside the bumps of an interface: what of its tractions stays is real."
    parser = study_parser("uel.paper.study.refinement", description, "study/refinement")
    folder: Path = parser.parse_args(arguments).output_dir
    console = Console()
    variations = tuple(f"TV, h/{factor} (MPa)" for factor in FACTORS)
    table = Table("specimen", "layup", "element", "traction", *variations, "turned", title="bonded (per facet)")
    for specimen in STRETCHES:
        for layup in LAYUPS:
            exact = turned(specimen, folder) if layup == "0/0" else None
            for element in ("standard", "consistent"):
                found = [bonded(Bonded(specimen, layup, element, "perturbed", factor), folder) for factor in FACTORS]
                for name in TRACTIONS:
                    last = "" if exact is None else _variation(exact[name])
                    cells = [_variation(values[name]) for values in found]
                    table.add_row(specimen, layup, element, name, *cells, last)
    console.print(table)
    table = Table("specimen", "element", "stiffness", "traction", *variations, title="failing (per facet)")
    for specimen in FAILING:
        for element, stiffness in (("standard", "1e6"), ("consistent", "1e6"), ("consistent", "inf")):
            found = [failing(Failing(specimen, stiffness, element, factor), folder) for factor in FACTORS]
            for name in TRACTIONS:
                table.add_row(specimen, element, stiffness, name, *(_variation(values[name]) for values in found))
    console.print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
