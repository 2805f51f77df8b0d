# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact of two plates of bricks, with NLGEOM and friction, against their element loop: part of `make bench`.

Both take turns in one run. Measured is an increment of four passes with matrices, of which the first projects the
points onto the entire surface, as in a job: contact per point, and the element loop per brick. All points are closed
and slip. Judged is the median of the ratios; the number of points should not change it. Times are those of the
processor in this thread.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from bench import in_turns, judged
from rich.console import Console
from rich.table import Table

from uel import usersub
from uel.assembly import System, system_of
from uel.deck import read_deck
from uel.elements import Call, Contributor, CurrentPass, Flags
from uel.model.arrays import FloatArray
from uel.solver.threads import one_blas_thread

PASSES = 4
"""Passes in an increment."""

LOWER, UPPER = (0.0, 1.3, 0.5, 0.0), (0.1, 1.1, 1.0, 0.5)
"""Plates: ends along x and y, top, bottom."""


@dataclass(frozen=True)
class Kind:
    """Contact of one kind.

    options  of *CONTACT PAIR
    bound    largest ratio of its time per point to that of the element loop per brick
    """

    name: str
    options: str
    bound: float


KINDS = (
    Kind("nodes to a surface", "TYPE=NODE TO SURFACE", 1.25),
    Kind("nodes to a surface, small sliding", "SMALL SLIDING", 1.5),
    # 16 samples for each point
    Kind("surface to surface", "TYPE=SURFACE TO SURFACE", 6.0),
)


def plate(name: str, first: int, faces: int, ends: tuple[float, float, float, float], face: str) -> list[str]:
    """Keywords of a layer of faces x faces bricks, whose nodes and elements are numbered from `first`."""
    low, high, top, bottom = ends
    along = np.linspace(low, high, faces + 1)
    grid = first + np.arange(2 * (faces + 1) ** 2).reshape(2, faces + 1, faces + 1)
    nodes = [f"{grid[k, i, j]}, {x}, {y}, {z}" for k, z in enumerate((bottom, top)) for i, x in enumerate(along)
             for j, y in enumerate(along)]  # fmt: skip
    corners = [grid[:, :-1, :-1], grid[:, 1:, :-1], grid[:, 1:, 1:], grid[:, :-1, 1:]]
    bricks = np.concatenate([np.stack(corners, axis=-1)[0], np.stack(corners, axis=-1)[1]], axis=-1).reshape(-1, 8)
    elements = [", ".join(map(str, [first + k, *brick])) for k, brick in enumerate(bricks.tolist())]
    return [
        *("*NODE", *nodes, f"*ELEMENT, TYPE=C3D8, ELSET={name}", *elements),
        *(f"*SURFACE, NAME={name}_FACE", f"{name}, {face}", f"*SOLID SECTION, ELSET={name}, MATERIAL=M", ""),
    ]


def deck(kind: Kind, faces: int) -> str:
    """Two plates; the upper one is the secondary surface."""
    lines = [
        *("*HEADING", "contact of two plates"),
        *plate("LOWER", 1, round(1.2 * faces), LOWER, "S2"),
        *plate("UPPER", 1_000_001, faces, UPPER, "S1"),
        *("*MATERIAL, NAME=M", "*ELASTIC", "1000., 0.3", "*SURFACE INTERACTION, NAME=TOUCH", "*FRICTION", "0.3,"),
        *(f"*CONTACT PAIR, INTERACTION=TOUCH, {kind.options}", "UPPER_FACE, LOWER_FACE"),
        *("*STEP, NLGEOM", "*STATIC", "1., 1.", "*END STEP"),
    ]
    return "\n".join(lines) + "\n"


def motion(system: System, faces: int) -> FloatArray:
    """(n,) unknowns: the upper plate presses on the lower one and slides, with noise; multipliers are positive."""
    rng, dofs = np.random.default_rng(0), system.dofs
    move = np.array([0.3, 0.1, -0.02]) / faces
    of_nodes = dofs.of_nodes
    labels = dofs.mesh.labels[np.minimum(dofs.node, len(dofs.mesh.labels) - 1)]
    upper = of_nodes & (labels > 1_000_000)
    u = np.where(of_nodes, 0.003 / faces * rng.normal(size=len(dofs)), rng.uniform(0.5, 1.0, len(dofs)))
    u[upper] += move[dofs.dof[upper] - 1]
    return u


class Increment:
    """An increment over one contributor of a system, at its end and three times close to it."""

    def __init__(self, system: System, contributor: Contributor, end: FloatArray) -> None:
        self._system, self._contributor, self._end = system, contributor, end
        self._call, self._data = Call(Flags(1, nlgeom=True), 1, 1, 1.0, 1.0, 1.0, 1.0), np.zeros(len(system.indices))

    def run(self, iteration: int, u: FloatArray, du: FloatArray) -> None:
        """Make one pass."""
        system, call = self._system, replace(self._call, iteration=iteration)
        now = CurrentPass(call, u, du, np.zeros((1, len(u))), self._data)
        if not self._contributor.track(now):
            system._bind()
            self._data = np.zeros(len(system.indices))
            now = replace(now, data=self._data)
        self._contributor.contribute(now)

    def __call__(self) -> None:
        """Make all passes."""
        half = 0.5 * self._end
        self.run(0, half, np.zeros_like(half))
        for iteration in range(1, PASSES):
            u = (1.0 - 1e-4 * iteration) * self._end
            self.run(iteration, u, u - half)


def measure(kind: Kind, faces: int, repetitions: int) -> tuple[int, FloatArray]:
    """Number of points, and times (repetitions, 2) of a pass in us: contact per point, element loop per brick."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "plates.inp"
        path.write_text(deck(kind, faces), encoding="ascii")
        model = read_deck(path)
        library = usersub.load(None, job="contact", output_dir=Path(folder), deck=path)
        system = system_of(model, library)
        points, end = system.contributors.contacts[0], motion(system, faces)
        contact = Increment(system, points, end)
        # to where the increment begins
        contact.run(0, np.zeros_like(end), np.zeros_like(end))
        contact.run(1, 0.5 * end, 0.5 * end)
        points.commit()
        loops: list[Callable[[], None]] = [Increment(system, block, end) for block in system.blocks]

        def elements() -> None:
            for loop in loops:
                loop()

        contact()
        times = in_turns(contact, elements, repetitions=repetitions)
        library.close()
    counts = len(points.rows), sum(len(block.rows) for block in system.blocks)
    return counts[0], 1e3 * times / PASSES / counts


def main() -> int:
    """Run the benchmark; returns 1 if a ratio exceeds its bound."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, nargs="+", default=[18, 100], help="of the upper plate along x (18 100)")
    options = parser.parse_args()
    console, good = Console(width=120), True
    columns = ("contact", "points", "us per point and pass", "us per brick and pass", "ratio")
    table = Table(*columns, title="Contact and the element loop, NLGEOM and friction", title_justify="left")
    with one_blas_thread():
        for kind in KINDS:
            for faces in options.faces:
                points, times = measure(kind, faces, repetitions=max(3, 200 // faces))
                ratio, (point, brick) = float(np.median(times[:, 0] / times[:, 1])), np.median(times, axis=0)
                table.add_row(kind.name, str(points), f"{point:.1f}", f"{brick:.1f}", judged(ratio, kind.bound))
                good &= ratio <= kind.bound
    console.print(table)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
