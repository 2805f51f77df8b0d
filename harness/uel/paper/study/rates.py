# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.paper.study.rates`: how fast the errors of a bonded interface vanish under refinement.

Pagano's strip [90/0], length 4 times the height, whose exact solution `pagano.py` has: the recommended elements between
the plies, with an infinite stiffness and without damage, and the same mesh whose plies share their nodes. Errors:

- energy norm of the error over that of the solution. The loads are the consistent ones of the exact pressure, so that
  the energy of the error is the difference of the energies (G. Strang, G.J. Fix, An Analysis of the Finite Element
  Method, 1973, section 1.6); with reduced integration, mean volume strain and incompatible modes it is no norm;
- displacements: root mean square over the nodes, over that of the exact ones;
- traction: root mean square over the elements of the vector at mid-face, over the largest exact one. Between shared
  nodes it is the stress that *EL PRINT recovers at the nodes, averaged over each ply and then over both; at mid-face
  the mean of both ends, or that of the node in the middle.

Distorted meshes have corners moved at random by up to a fifth of a cell, those of the interface along it.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.delamination.keywords import element_block, keyword, node_block, node_set, table, text
from uel.delamination.markdown import head, line
from uel.insertion.command import insert
from uel.insertion.selection import CutRequest
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import CONTINUUM
from uel.output import Result
from uel.paper.study.options import study_parser, write_tables
from uel.paper.study.pagano import Strip, StripPly
from uel.running.job import run

# N.J. Pagano's ply, in units of a thousandth of its modulus across the fibres
ALONG = StripPly((25e3, 1e3, 1e3), (0.25, 0.25, 0.25), 500.0)
ACROSS = StripPly((1e3, 1e3, 25e3), (0.25, 0.01, 0.01), 200.0)
STRIP = Strip(4.0, (0.5, 0.5), (ACROSS, ALONG))
SETS = ("LOWER", "UPPER")
KINDS = ("CPE4", "CPE4I", "CPE4R", "CPE8", "CPE8R", "CPE3", "CPE6")
ROWS = (4, 8, 16, 32)
"""Rows of cells over the height; the half of the strip that is meshed has twice as many columns."""
DISTORTION = 0.2
MARK = "\n## Tables\n"
"""Line of a page above its tables."""
NEVER = ("SIGMAMAX=1e9", "TAUMAX=1e9", "GIC=1e12", "GIIC=1e12")


@dataclass(frozen=True, slots=True)
class Errors:
    """Relative errors of a run: see the head of this file."""

    energy: float
    displacement: float
    traction: float


@dataclass(frozen=True, slots=True)
class HalfStrip:
    """Half of the strip, x from 0 to L/2.

    nodes     (n, 2) coordinates, labels from 1
    elements  (m, nodes of the type) places in `nodes`
    low       (m,) in the lower ply
    face, top (k, 2 or 3) nodes of the edges on the interface and on the upper face: both ends, and the middle
    """

    nodes: FloatArray
    elements: IntArray
    low: np.ndarray
    face: IntArray
    top: IntArray


def half_strip(kind: str, rows: int, distortion: float) -> HalfStrip:
    """Mesh half of the strip with elements of a type.

    Parameters
    ----------
    kind
        Plane continuum type.
    rows
        Rows of cells, an even number; each cell is a quad or two triangles.
    distortion
        Largest displacement of a corner over the size of a cell.
    """
    family = CONTINUUM[kind].family
    columns, size = 2 * rows, sum(STRIP.heights) / rows
    # places of corners are even, those of the middles of edges odd
    i, j = np.meshgrid(np.arange(2 * columns + 1), np.arange(2 * rows + 1))
    moved = np.random.default_rng(1).uniform(-distortion, distortion, (2, rows + 1, columns + 1))
    moved[0, :, [0, -1]] = 0.0
    moved[1, [0, rows // 2, -1]] = 0.0
    points = np.empty((2, 2 * rows + 1, 2 * columns + 1))
    points[:, ::2, ::2] = size * (np.stack([i, j])[:, ::2, ::2] / 2 + moved)
    points[:, ::2, 1::2] = (points[:, ::2, :-1:2] + points[:, ::2, 2::2]) / 2
    points[:, 1::2] = (points[:, :-1:2] + points[:, 2::2]) / 2
    # the edge between two triangles runs from the lower left to the upper right corner
    points[:, 1::2, 1::2] = (points[:, :-1:2, :-1:2] + points[:, 2::2, 2::2]) / 2
    label = j * (2 * columns + 1) + i
    corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
    cells = [corners] if family.corners == 4 else [[corners[k] for k in (0, 1, 2)], [corners[k] for k in (0, 2, 3)]]
    by_cell = []
    for cell in cells:
        middles = [((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in pairwise([*cell, cell[0]])]
        places = [*cell, *middles][: family.nodes]
        by_cell.append(
            np.stack([label[y : 2 * rows - 1 + y : 2, x : 2 * columns - 1 + x : 2] for x, y in places], axis=-1)
        )
    grid = np.stack(by_cell, axis=2)
    low = np.zeros(grid.shape[:-1], dtype=bool)
    low[: rows // 2] = True
    quadratic = family.nodes > family.corners
    face, top = (
        np.column_stack([label[row, :-1:2], label[row, 2::2], label[row, 1::2]][: 3 if quadratic else 2])
        for row in (rows, 2 * rows)
    )
    used, inverse = np.unique(grid, return_inverse=True)
    renumber = np.zeros(label.size, dtype=np.int64)
    renumber[used] = np.arange(len(used))
    nodes = points.reshape(2, -1).T[used]
    return HalfStrip(nodes, inverse.reshape(-1, family.nodes), low.ravel(), renumber[face], renumber[top])


def loads(mesh: HalfStrip) -> FloatArray:
    """Return the consistent forces (n,) of the pressure on the upper face."""
    forces = np.zeros(len(mesh.nodes))
    xi, weights = np.polynomial.legendre.leggauss(6)
    shapes = np.array([(1 - xi) / 2, (1 + xi) / 2])
    if mesh.top.shape[1] == 3:
        shapes = np.array([xi * (xi - 1) / 2, xi * (xi + 1) / 2, 1 - xi**2])
    ends = mesh.nodes[mesh.top[:, :2], 0]
    length = np.diff(ends, axis=1)
    x = ends[:, :1] + length * (1 + xi) / 2
    pressure = STRIP.load * np.sin(STRIP.wave * x) * weights * length / 2
    np.add.at(forces, mesh.top, pressure @ shapes.T)
    return forces


def deck(kind: str, mesh: HalfStrip) -> str:
    """Write the deck of plies that share their nodes."""
    labels = np.arange(1, len(mesh.nodes) + 1)
    lines = node_block(labels, mesh.nodes)
    first = 1
    for name, part in zip(SETS, (mesh.low, ~mesh.low), strict=True):
        lines += element_block(kind, name, labels[mesh.elements[part]], first)
        first += int(part.sum())
    x = mesh.nodes[:, 0]
    lines += node_set("SUPPORT", labels[x < 1e-9]) + node_set("MIDDLE", labels[x > x.max() - 1e-9])
    lines += node_set("FACE", labels[np.unique(mesh.face)])
    for name, ply in zip(SETS, STRIP.plies, strict=True):
        shears = [ply.shear, ply.shear, ply.shear]
        lines += [keyword("SOLID SECTION", ELSET=name, MATERIAL=name), "1.", keyword("MATERIAL", NAME=name)]
        lines += [keyword("ELASTIC", TYPE="ENGINEERING CONSTANTS")]
        lines += table([[*ply.moduli, *ply.ratios, *shears[:2]], shears[2:]])
    lines += ["*BOUNDARY", "SUPPORT, 2", "MIDDLE, 1", "*STEP", "*STATIC", "*CLOAD"]
    lines += [
        f"{label}, 2, {force!r}" for label, force in zip(labels.tolist(), loads(mesh).tolist(), strict=True) if force
    ]
    lines += ["*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*OUTPUT, HISTORY", "*ENERGY OUTPUT", "ALLSE, ALLWK"]
    for name in SETS:
        lines += [keyword("EL PRINT", POSITION="AVERAGED AT NODES", ELSET=name), "S"]
    return text([*lines, "*END STEP"])


def errors(kind: str, rows: int, distortion: float, folder: Path) -> tuple[Errors, Errors]:
    """Run a mesh with the recommended elements, and with shared nodes; returns the errors of both."""
    mesh = half_strip(kind, rows, distortion)
    name = f"{kind.lower()}_{rows}" + ("_distorted" if distortion else "")
    shared, cut = folder / f"{name}_shared.inp", folder / f"{name}.inp"
    folder.mkdir(parents=True, exist_ok=True)
    shared.write_text(deck(kind, mesh), encoding="ascii")
    content, _ = insert([shared], CutRequest(between=[SETS]), values=NEVER)
    cut.write_text(content, encoding="ascii")
    results = [run(path, output_dir=folder, quiet=True) for path in (cut, shared)]
    stresses = (_of_interface(mesh, results[0]), _recovered(mesh, results[1]))
    x = mesh.nodes[mesh.face[:, :2], 0].mean(axis=1)
    exact = STRIP.tractions(x, STRIP.heights[0])
    largest = np.abs(STRIP.amplitudes(STRIP.heights[0])[2:]).max()
    found = []
    for result, stress in zip(results, stresses, strict=True):
        u = result.field("U")[:, :2]
        # the nodes that insertion doubles follow those of the mesh
        places = result.mesh().points[:, :2]
        right = STRIP.displacements(places)
        energy = abs(1.0 - float(result.history["ALLWK"][-1]) / STRIP.work)
        found.append(
            Errors(
                float(np.sqrt(energy)),
                float(np.linalg.norm(u - right) / np.linalg.norm(right)),
                float(np.sqrt(np.mean(np.sum((stress - exact) ** 2, axis=1))) / largest),
            )
        )
    return found[0], found[1]


def _of_interface(mesh: HalfStrip, result: Result) -> FloatArray:
    """Tractions (k, 2) along and across at mid-face of the interface elements, from left to right."""
    profile = result.interface()
    points = len(profile["TT"]) // len(mesh.face)
    order = np.argsort(profile["X"])
    return np.column_stack([profile[name][order].reshape(-1, points).mean(axis=1) for name in ("TT", "TN")])


def _recovered(mesh: HalfStrip, result: Result) -> FloatArray:
    """Stresses (k, 2), shear and normal, that *EL PRINT averages at the nodes of the interface, at mid-face."""
    sums = np.zeros((len(mesh.nodes), 2))
    for ply in printed_stresses(result.file(".dat")):
        for node, stress in ply:
            sums[node - 1] += [stress["S12"] / 2, stress["S22"] / 2]
    at_nodes = sums[mesh.face]
    return at_nodes[:, 2] if mesh.face.shape[1] == 3 else at_nodes.mean(axis=1)


def printed_stresses(path: Path) -> list[list[tuple[int, dict[str, float]]]]:
    """Return the node and the stresses by name of the rows of each table of *EL PRINT in a .dat file."""
    names: list[str] = []
    tables: list[list[tuple[int, dict[str, float]]]] = []
    for row in path.read_text(encoding="utf-8").splitlines():
        words = row.split()
        if "S22" in words:
            names = words[words.index("S11") :]
            tables.append([])
        elif names and re.match(r"\s*\d+\s+-?\d", row) and len(words) > len(names):
            tables[-1].append((int(words[0]), dict(zip(names, map(float, words[-len(names) :]), strict=True))))
        elif row.startswith((" MAXIMUM", "1", " THE")):
            names = []
    return tables


def order(coarse: float, fine: float) -> float:
    """Return the order of convergence of an error on meshes of which the finer has elements of half the size."""
    return float(np.log2(coarse / fine))


def tables(found: Mapping[tuple[str, float], Sequence[tuple[Errors, Errors]]]) -> str:
    """Write the tables, regular meshes and distorted ones; by type and distortion: the errors for each of ROWS."""
    lines = []
    for distortion in (0.0, DISTORTION):
        lines += ["### Distorted meshes" if distortion else "### Regular meshes", ""]
        names = ("energy", "displacement", "traction")
        lines += head(["solid", "rows", *(word for name in names for word in (name, "shared nodes", "order"))])
        for kind in KINDS:
            pairs = found[kind, distortion]
            for k, (rows, pair) in enumerate(zip(ROWS, pairs, strict=True)):
                cells = []
                for name in names:
                    ours, shared = (getattr(item, name) for item in pair)
                    before = order(getattr(pairs[k - 1][0], name), ours) if k else None
                    cells += [f"{ours:.2e}", f"{shared:.2e}", "" if before is None else f"{before:.1f}"]
                lines.append(line([kind, rows, *cells]))
        lines.append("")
    return text(lines).rstrip() + "\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all meshes and print the tables; returns the exit code."""
    description = "Convergence of displacements, energy and tractions of bonded plies towards the exact solution."
    parser = study_parser("uel.paper.study.rates", description, "study/rates")
    parser.add_argument("--page", type=Path, help="file whose tables are written again, those below its mark")
    options = parser.parse_args(arguments)
    found = {
        (kind, distortion): [errors(kind, rows, distortion, options.output_dir) for rows in ROWS]
        for kind in KINDS
        for distortion in (0.0, DISTORTION)
    }
    content = tables(found)
    if options.page:
        write_tables(options.page, MARK, content)
    Console().print(content, soft_wrap=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
