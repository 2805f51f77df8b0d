# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DCB-ref here, at the least that its iterations need, in Akantu and in PyFEM, in one run.

    python tests/programs/benchmarks/peers.py [--python PYTHON] [--pyfem FOLDER] [--environments FOLDER]

Akantu is installed from its wheel, which needs a Python that the wheel is for, PyFEM runs from a checkout of its
repository (github.com/jjcremmers/PyFEM). Each has an environment of its own; what cannot be installed is left out, with
the reason. Times are those of the processor, without reading the mesh and writing files.

Akantu has the same bilinear law; its Newton iteration ends where the crack begins to grow, so the increments up to
there are compared, and those to the end with a search that peer_akantu.py writes around its forces and matrices.
PyFEM's bilinear law ends as early; its runs to the end are with the potential of Xu and Needleman and isotropic quads,
for it has no orthotropic plane stress, and are ended when they have taken as long as the bound of its ratio allows.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import limit
import meshio
import numpy as np
from bench import DECK
from rich.console import Console
from rich.table import Table

from uel.deck import read_deck
from uel.model.arrays import IntArray
from uel.model.model import Model

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
INCREMENTS = 100
LEAST_RATIOS = {"Akantu with a search": 25.0, "PyFEM": 250.0}
"""Bounds of theirs over ours, of codes that reach the end."""

AKANTU_MATERIAL = """\
material elastic_orthotropic [
  name = arms
  rho = 1.
  n1 = [1., 0.]
  n2 = [0., 1.]
  E1 = 120000.
  E2 = 10500.
  nu12 = 0.3
  G12 = 5520.
]
material cohesive_bilinear [
  name = interface
  sigma_c = 30.
  G_c = 0.26
  delta_0 = 3e-5
  beta = 0.5
  kappa = 3.85
  penalty = 1e6
]
"""

PYFEM_PROBLEM = """\
input = "dcb.dat";
Quads = { type = "SmallStrainContinuum"; material = { type = "PlaneStress"; E = 120000.0; nu = 0.3; }; };
Interface = { type = "Interface"; material = { type = "XuNeedleman"; Tult = 30.0; Gc = 0.26; }; };
solver = { type = "NonlinearSolver"; maxCycle = 100; tol = 1e-3; iterMax = 30; };
outputModules = [];
"""


class Peer(NamedTuple):
    """A row of another code: opening (mm), load (N), iterations and seconds of the processor of each increment."""

    rows: list[tuple[float, float, int, float]]
    reason: str = ""
    """Why there are none."""


def elements(model: Model) -> tuple[IntArray, IntArray]:
    """Nodes of the quads and of the interface elements, from 0."""
    found = ([group.nodes for group in model.groups if group.type == name] for name in ("U1", "U2"))
    quads, interface = (np.vstack(each) for each in found)
    return quads, interface


def run_akantu(model: Model, folder: Path, environment: Path, python: str) -> dict[str, Peer]:
    """Install and run Akantu, as it is shipped and with a search around it."""
    names = {"Akantu": [], "Akantu with a search": ["search"]}
    if not (environment / "bin" / "python").exists():
        pip = [environment / "bin" / "pip", "install", "-q", "akantu", "scipy"]
        for command in ([python, "-m", "venv", environment], pip):
            try:
                installed = subprocess.run(command, capture_output=True, text=True, check=False)
            except OSError as error:
                return dict.fromkeys(names, Peer([], f"{python}: {error.strerror}"))
            if installed.returncode:
                return dict.fromkeys(names, Peer([], (installed.stderr.strip() or "not installed").splitlines()[-1]))
    quads, interface = elements(model)
    # the faces of the interface are one: Akantu puts its elements there
    same = np.arange(len(model.mesh.coordinates))
    same[interface[:, [3, 2]]] = interface[:, [0, 1]]
    used, cells = np.unique(same[quads], return_inverse=True)
    cells = cells.reshape(quads.shape)
    tags = [np.ones(len(cells), dtype=int)]
    mesh = meshio.Mesh(
        model.mesh.coordinates[used],
        [("quad", cells)],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"arms": np.array([1, 2])},
    )
    meshio.write(folder / "mesh.msh", mesh, file_format="gmsh22", binary=False)
    (folder / "material.dat").write_text(AKANTU_MATERIAL, encoding="utf-8")
    command = [environment / "bin" / "python", HERE / "peer_akantu.py", folder, str(INCREMENTS)]
    return {name: rows_of([*command, *words]) for name, words in names.items()}


def run_pyfem(
    model: Model, folder: Path, checkout: Path | None, environment: Path, python: str, seconds: float
) -> Peer:
    """Run PyFEM from a checkout for so many seconds."""
    if checkout is None:
        return Peer([], "--pyfem FOLDER is not given")
    if not (checkout / "pyfem").is_dir():
        return Peer([], f"{checkout} has no folder pyfem")
    if not (environment / "bin" / "python").exists():
        packages = ["numpy", "scipy", "h5py", "meshio", "matplotlib"]
        subprocess.run([python, "-m", "venv", environment], check=True)
        subprocess.run([environment / "bin" / "pip", "install", "-q", *packages], check=True)
    quads, interface = elements(model)
    top, bottom = (int(model.nsets[name][0]) for name in ("LOAD_TOP", "LOAD_BOTTOM"))
    # PyFEM numbers both faces of an interface element in the same direction
    groups = {"Quads": quads, "Interface": interface[:, [0, 1, 3, 2]]}
    cells = [(name, nodes) for name, group in groups.items() for nodes in group]
    held = [f"{dof}[{node}] = 0.0;" for node in model.nsets["RIGHT"] for dof in "uv"]
    lines = [
        "<Nodes>",
        *(f"{k} {x:.17g} {y:.17g};" for k, (x, y) in enumerate(model.mesh.coordinates[:, :2])),
        "</Nodes>",
        "<Elements>",
        *(f"{k} '{name}' {' '.join(map(str, nodes))};" for k, (name, nodes) in enumerate(cells)),
        "</Elements>",
        "<NodeConstraints>",
        *held,
        f"v[{top}] = 0.05;",
        f"v[{bottom}] = -0.05;",
        "</NodeConstraints>",
        "<ExternalForces>",
        "</ExternalForces>",
    ]
    (folder / "dcb.dat").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "dcb.pro").write_text(PYFEM_PROBLEM, encoding="utf-8")
    command = [environment / "bin" / "python", HERE / "peer_pyfem.py", folder, str(top), str(seconds)]
    return rows_of(command, PYTHONPATH=str(checkout.resolve()))


def rows_of(command: list[str | Path], **variables: str) -> Peer:
    """The lines of four numbers that a program prints before it ends, in whatever way it ends."""
    threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    environment = {**os.environ, **threads, **variables}
    ended = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    rows = []
    for line in (ended.stdout + ended.stderr).splitlines():
        words = line.split()
        try:
            opening, load, iterations, seconds = map(float, words)
        except ValueError:
            continue
        rows.append((opening, load, int(iterations), seconds))
    said = ended.stderr.strip().splitlines()
    return Peer(rows, "" if rows else (said[-1] if said else f"it ended with {ended.returncode}"))


def main() -> int:
    """Run the benchmark; returns 1 if a ratio is below its bound."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--python", default="python3.11", help="Python of the environments (%(default)s)")
    parser.add_argument("--pyfem", type=Path, metavar="FOLDER", help="checkout of PyFEM; without it PyFEM is left out")
    parser.add_argument(
        "--environments", type=Path, default=ROOT / "build" / "peers", metavar="FOLDER", help="where they are kept"
    )
    options = parser.parse_args()
    console = Console(width=120)
    model, width = read_deck(DECK), 20.0
    ours = limit.run()
    table = Table("", "increments", "iterations", "peak (N)", "end (N)", "seconds", "here", "ratio", title="DCB-ref")
    seconds, least = float(ours.seconds.sum()), limit.ITERATIONS * ours.least / 1e3
    peak, end = f"{ours.loads.max():.2f}", f"{ours.loads[-1]:.2f}"
    table.add_row("here", str(len(ours.loads)), str(sum(ours.iterations)), peak, end, f"{seconds:.2f}", "", "")
    good = seconds <= limit.LARGEST_RATIO * least
    table.add_row(
        "least",
        "",
        str(limit.ITERATIONS),
        "",
        "",
        f"{least:.2f}",
        f"{seconds:.2f}",
        f"{least / seconds:.2f} (at least {1 / limit.LARGEST_RATIO:g})",
    )
    with tempfile.TemporaryDirectory() as temporary:
        folder, homes = Path(temporary), options.environments
        peers = {
            **run_akantu(model, folder, homes / "akantu", options.python),
            "PyFEM": run_pyfem(
                model, folder, options.pyfem, homes / "pyfem", options.python, LEAST_RATIOS["PyFEM"] * seconds
            ),
        }
    for name, peer in peers.items():
        if not peer.rows:
            console.print(f"{name} is left out: {peer.reason}", soft_wrap=True)
            continue
        opening, loads = peer.rows[-1][0], width * np.array([load for _, load, *_ in peer.rows])
        mine = float(ours.seconds[ours.openings <= opening + 1e-9].sum())
        ratio, bound = peer.rows[-1][3] / mine, LEAST_RATIOS.get(name)
        good &= bound is None or ratio >= bound
        table.add_row(
            f"{name} to {opening:.3g} mm",
            str(len(peer.rows)),
            str(sum(iterations for *_, iterations, _ in peer.rows)),
            f"{loads.max():.2f}",
            f"{loads[-1]:.2f}",
            f"{peer.rows[-1][3]:.2f}",
            f"{mine:.2f}",
            f"{ratio:.1f}" + ("" if bound is None else f" (at least {bound:g})"),
        )
    console.print(table)
    console.print("seconds: of the processor; here: ours to the same opening; ratio: theirs over ours")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
