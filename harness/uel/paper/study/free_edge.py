# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.free_edge`: interlaminar stresses at the free edge of a laminate, with one brick per ply.

The strip of R.B. Pipes and N.J. Pagano, Interlaminar stresses in composite laminates under uniform axial extension,
Journal of Composite Materials 4 (1970) 538: four plies of height h, width 16 h, stretched along x; cooled it is that of
A.S.D. Wang and F.W. Crossman, Edge effects on thermally induced stresses in composite laminates, the same journal 11
(1977) 300. Stresses do not depend on x: the mesh is one layer of bricks, whose nodes in front move as those behind
them, but for the elongation. By symmetry it is a quarter of the cross-section, 0 <= y <= 8 h from the middle to the
edge and 0 <= z <= 2 h from the middle plane up.

At the edge the stresses between the plies are singular. Compared are their means over EDGE, the height of a ply next to
the edge: of the tractions of the recommended elements between plies of one or more bricks, with an infinite stiffness;
of the stresses that *EL PRINT averages at the nodes where the plies share them; and of these on the finest mesh.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.delamination.keywords import element_block, keyword, node_block, node_set, table, text
from uel.delamination.markdown import head, line
from uel.delamination.mesh import graded_columns
from uel.delamination.solid_blocks import block
from uel.insertion.command import insert
from uel.insertion.selection import CutRequest
from uel.model.arrays import FloatArray
from uel.paper.study.options import study_parser, write_tables
from uel.paper.study.rates import MARK, NEVER, SETS, printed_stresses
from uel.running.job import run

HEIGHT, WIDTH = 1.0, 8.0
"""Height of a ply and half of the width (mm)."""
EDGE = HEIGHT
"""Distance from the edge over which stresses are averaged (mm)."""
MODULI, RATIO, SHEAR = (137.9e3, 14.48e3, 14.48e3), 0.21, 5.86e3
"""Pipes and Pagano: 20, 2.1 and 2.1, 0.85 million psi."""
EXPANSIONS = (0.36e-6, 28.8e-6, 28.8e-6)
"""Wang and Crossman: 0.2 and 16 millionths per degree Fahrenheit."""
LAYUPS = {"+-45": (-45.0, 45.0), "0/90": (90.0, 0.0)}
"""Angles of the inner and of the outer ply."""
STRAIN, COOLING = 1e-3, -100.0
LOADS = ("stretched", "cooled")
FINE = 12
"""Bricks per ply of the mesh that is compared with."""
BRICKS = (1, 2, 4)
KIND = "C3D8I"
STRESSES = ("TN", "TS", "TT")
"""Of the interface; s is x, t is y."""
SHOWN = {("+-45", load): ("TS",) for load in LOADS} | {("0/90", load): ("TN", "TT") for load in LOADS}
"""Stresses of a layup: in [+-45]s the others are small."""


@dataclass(frozen=True, slots=True)
class EdgeCase:
    """Strip of a layup under a load, with a number of bricks through each ply, half as wide next to the edge."""

    layup: str
    load: str
    bricks: int

    @property
    def name(self) -> str:
        """Name of the runs."""
        return f"edge_{self.layup.replace('/', '-').replace('+', '')}_{self.load}_{self.bricks}"

    @property
    def size(self) -> float:
        """Width of the bricks over EDGE, and their length along the strip (mm)."""
        return HEIGHT / (2 * self.bricks)

    def deck(self) -> str:
        """Write the deck of plies that share their nodes."""
        fine = np.linspace(WIDTH, WIDTH - 2 * EDGE, 4 * self.bricks + 1)
        y = np.concatenate([fine[:-1], graded_columns(WIDTH - 2 * EDGE, 0.0, self.size, 1.3, 1.0)])[::-1]
        z = np.linspace(0.0, 2 * HEIGHT, 2 * self.bricks + 1)
        grid = block(KIND, [np.array([0.0, self.size]), y, z])
        labels = np.arange(1, len(grid.nodes) + 1)
        lines = node_block(labels, grid.nodes)
        # front nodes follow those behind
        behind = labels.reshape(len(z), len(y), 2)[..., 0]
        reference = int(labels[-1]) + 1
        lines += ["*NODE, NSET=ELONGATION", f"{reference}, 0., {2 * WIDTH}, 0."]
        first = 1
        for k, (name, angle) in enumerate(zip(SETS, LAYUPS[self.layup], strict=True)):
            part = (grid.cell[:, 2] >= self.bricks) == bool(k)
            lines += element_block(KIND, name, labels[grid.elements[part]], first)
            lines += [keyword("SOLID SECTION", ELSET=name, MATERIAL="PLY", ORIENTATION=f"AXES_{name}")]
            c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
            lines += [keyword("ORIENTATION", NAME=f"AXES_{name}"), *table([[c, s, 0.0, -s, c, 0.0]])]
            first += int(part.sum())
        lines += node_set("ALL", labels) + node_set("MIDDLE", behind[:, 0]) + node_set("PLANE", behind[0])
        lines += node_set("BETWEEN", behind[self.bricks])
        lines += ["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=ENGINEERING CONSTANTS"]
        lines += table([[*MODULI, *[RATIO] * 3, SHEAR, SHEAR], [SHEAR]])
        lines += ["*EXPANSION, TYPE=ORTHO", *table([EXPANSIONS]), "*EQUATION"]
        for node in behind.ravel().tolist():
            lines += ["3", *table([(node + 1, 1, 1.0, node, 1, -1.0, reference, 1, -self.size)])]
            lines += [row for d in (2, 3) for row in ("2", *table([(node + 1, d, 1.0, node, d, -1.0)]))]
        lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 0.", "*BOUNDARY", "MIDDLE, 1, 2", "PLANE, 3"]
        lines += ["ELONGATION, 2, 3", "*STEP", "*STATIC"]
        if self.load == "stretched":
            lines += ["*BOUNDARY", f"ELONGATION, 1, 1, {STRAIN}"]
        else:
            lines += ["*TEMPERATURE", f"ALL, {COOLING}"]
        lines += ["*OUTPUT, FIELD", "*NODE OUTPUT", "U"]
        for name in SETS:
            lines += [keyword("EL PRINT", POSITION="AVERAGED AT NODES", ELSET=name), "S"]
        return text([*lines, "*END STEP"])


@dataclass(frozen=True, slots=True)
class Shared:
    """Stresses of plies that share their nodes, by the nodes behind.

    points   (n, 2) y and z of the nodes
    between  (n, 3) STRESSES, the means of the plies on both sides
    outer    (n, 2) sigma_xy and sigma_yy in the outer ply
    """

    points: FloatArray
    between: FloatArray
    outer: FloatArray

    def means(self) -> dict[str, float]:
        """Means of STRESSES (MPa) over EDGE, of those at the nodes between the plies."""
        y, z = self.points.T
        near = np.flatnonzero(np.isclose(z, HEIGHT) & (y > WIDTH - EDGE - 1e-9))
        near = near[np.argsort(y[near])]
        return dict(zip(STRESSES, (np.trapezoid(self.between[near], y[near], axis=0) / EDGE).tolist(), strict=True))

    def balanced_means(self) -> dict[str, float]:
        """Means of TS and TT (MPa) over EDGE that hold sigma_xy and sigma_yy across the outer ply there."""
        y, z = self.points.T
        across = np.flatnonzero(np.isclose(y, WIDTH - EDGE) & (z > HEIGHT - 1e-9))
        across = across[np.argsort(z[across])]
        forces = np.trapezoid(self.outer[across], z[across], axis=0)
        return dict(zip(STRESSES[1:], (-forces / EDGE).tolist(), strict=True))


def shared(case: EdgeCase, folder: Path) -> Shared:
    """Run plies that share their nodes."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{case.name}_shared.inp"
    path.write_text(case.deck(), encoding="ascii")
    result = run(path, output_dir=folder, quiet=True)
    points = result.mesh().points
    between, outer = np.zeros((len(points), 3)), np.zeros((len(points), 2))
    plies = printed_stresses(result.file(".dat"))
    for k, (ply, angle) in enumerate(zip(plies, np.radians(LAYUPS[case.layup]).tolist(), strict=True)):
        c, s = np.cos(angle), np.sin(angle)
        for node, found in ply:
            turned = found["S13"] * c - found["S23"] * s, found["S13"] * s + found["S23"] * c
            between[node - 1] += 0.5 * np.array([found["S33"], *turned])
            if k:
                shear = (found["S11"] - found["S22"]) * c * s + found["S12"] * (c * c - s * s)
                outer[node - 1] = shear, found["S11"] * s * s + found["S22"] * c * c + 2 * found["S12"] * c * s
    behind = points[:, 0] < 1e-9
    return Shared(points[behind, 1:], between[behind], outer[behind])


def cut(case: EdgeCase, folder: Path) -> dict[str, float]:
    """Run plies with the recommended elements between them; returns the means of their tractions (MPa) over EDGE."""
    return mean_tractions(profile_of(case, folder), EDGE)


def profile_of(case: EdgeCase, folder: Path) -> dict[str, FloatArray]:
    """Return the variables at the points of the recommended elements between the plies."""
    folder.mkdir(parents=True, exist_ok=True)
    whole, path = folder / f"{case.name}_shared.inp", folder / f"{case.name}.inp"
    whole.write_text(case.deck(), encoding="ascii")
    content, _ = insert([whole], CutRequest(between=[SETS]), values=NEVER)
    path.write_text(content, encoding="ascii")
    return run(path, output_dir=folder, quiet=True).interface()


def mean_tractions(profile: Mapping[str, FloatArray], edge: float) -> dict[str, float]:
    """Return the means over a distance from the edge (mm): both Gauss points across an element have half of it."""
    y, where = np.unique(profile["Y"].round(9), return_inverse=True)
    means = {name: np.bincount(where, profile[name]) / np.bincount(where) for name in STRESSES}
    # two points per element, at its middle -+ its width/(2 sqrt(3))
    width = np.repeat(np.diff(y)[::2] * np.sqrt(3.0), 2)
    near = y > WIDTH - edge
    return {name: float(np.sum((values * width / 2)[near]) / edge) for name, values in means.items()}


def laminate_means(layup: str, load: str) -> tuple[float, float]:
    """Return the means of TS and TT (MPa) over the whole half of the width, from classical laminate theory.

    The outer ply is in equilibrium: what the shear and the normal stress on its face in the middle, sigma_xy and
    sigma_y times h, pull, the face between the plies returns, far from the edge that of laminate theory.
    """
    ratio = RATIO * MODULI[1] / MODULI[0]
    plane = np.array([[MODULI[0], RATIO * MODULI[1], 0.0], [RATIO * MODULI[1], MODULI[1], 0.0], [0.0, 0.0, 0.0]])
    plane /= 1.0 - RATIO * ratio
    plane[2, 2] = SHEAR
    stiffness, expansion = [], []
    for angle in np.radians(LAYUPS[layup]):
        c, s = np.cos(angle), np.sin(angle)
        # engineering strains of the axes of the ply from those of x and y
        turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
        stiffness.append(turn.T @ plane @ turn)
        expansion.append(np.linalg.solve(turn, [*EXPANSIONS[:2], 0.0]) * COOLING * (load == "cooled"))
    whole = stiffness[0] + stiffness[1]
    forces = sum(q @ e for q, e in zip(stiffness, expansion, strict=True))
    if load == "cooled":
        strain = np.linalg.solve(whole, forces)
    else:
        strain = np.array([STRAIN, *np.linalg.solve(whole[1:, 1:], -whole[1:, 0] * STRAIN)])
    outer = stiffness[1] @ (strain - expansion[1])
    return float(-outer[2] * HEIGHT / WIDTH), float(-outer[1] * HEIGHT / WIDTH)


def finest(layup: str, load: str, folder: Path) -> dict[str, float]:
    """Return the means of the stresses (MPa) on the finest mesh, those of the shears by equilibrium."""
    found = shared(EdgeCase(layup, load, FINE), folder)
    return found.means() | found.balanced_means()


def tables(folder: Path) -> list[str]:
    """Run all and write the table."""
    titles = [f"{word}, {bricks}" for bricks in BRICKS for word in ("interface", "shared nodes")]
    lines = head(["laminate", "load", "stress", f"shared nodes, {FINE} (MPa)", *titles])
    for layup, load in product(LAYUPS, LOADS):
        exact = finest(layup, load, folder)
        cases = [EdgeCase(layup, load, bricks) for bricks in BRICKS]
        found = [means for case in cases for means in (cut(case, folder), shared(case, folder).means())]
        for name in SHOWN[layup, load]:
            cells = [f"{100 * (means[name] / exact[name] - 1):+.1f} %" for means in found]
            lines.append(line([f"[{layup}]s", load, name, f"{exact[name]:.3f}", *cells]))
    return lines


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all meshes and print the table; returns the exit code."""
    description = "Interlaminar stresses at the free edge of a laminate that is stretched or cooled."
    parser = study_parser("uel.paper.study.free_edge", description, "study/free_edge")
    parser.add_argument("--page", type=Path, help="file whose table is written again, that below its mark")
    options = parser.parse_args(arguments)
    content = text(tables(options.output_dir))
    if options.page:
        write_tables(options.page, MARK, content)
    Console().print(content, soft_wrap=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
