# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Independent host for the kirigami rows of manifest.toml: `python tests/programs/public/kirigami.py FOLDER`.

It solves the boundary value problem of the public deck without the harness and without the user element, and prints
the expected values of those rows; the exit code is 1 if the manifest has others. FOLDER is that of table.py.

Model: planar kirigami with rhombic slits as a continuum of displacement u and slit angle t. With F = I + grad u, the
deformation A = diag(cos t - alpha sin t, cos t + beta sin t) of the mechanism, G = F inv(A) and J = det G, the energy
per undeformed area is

    W = c0 (G:G / J - 2) + c0 (J - 1)^2 + c1 t^2 + c2 |grad t|^2

A and W come from the lines of the user element that compute them, for the model of Zheng, Tobasco, Celli and
Plucinsky, arXiv:2206.00153, which its README names. Nothing else is taken from the element: forces are derivatives of
W by complex steps, the stiffness is the difference of forces, the shape functions come from their monomials.

The deck pulls one node, so the force depends on the mesh: this program uses the same mesh and the same 3 x 3 points. It
leaves out the built-in elements, with a Young's modulus of 1e-20. The deck leaves the pulled node free across the load,
which makes the first stiffness singular (rotation about the other node); here that node cannot move across, and its
reaction, zero by symmetry, is printed.
"""

from __future__ import annotations

import argparse
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

DOFS = {1: 0, 2: 1, 11: 2}
"""Position of a dof of the deck (u1, u2, slit angle) at its node."""
NODES = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], dtype=float)
"""Corners, then sides, of the eight-node element."""
POWERS = np.array([[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [2, 1], [1, 2]])
"""Exponents of its monomials."""
UNDEFORMED = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
"""F11, F12, F21, F22, t, t,1 and t,2 of a point before loading."""


@dataclass(frozen=True)
class Problem:
    """Mesh, properties (c0, c1, c2, alpha, beta) and the values of the dofs that have one, 3 dofs at each node."""

    coordinates: Array
    elements: Integers
    properties: Array
    prescribed: dict[int, float]
    sets: dict[str, Integers]

    def dofs(self, name: str, dof: int) -> Integers:
        """Dofs of that kind at the nodes of a set."""
        return 3 * self.sets[name] + DOFS[dof]


def blocks(deck: Path) -> Iterator[tuple[str, set[str], list[list[str]]]]:
    """Keyword, options and data lines, in lower case."""
    text = "\n".join(line for line in deck.read_text("utf-8").lower().splitlines() if not line.startswith("**"))
    for block in text.split("*")[1:]:
        head, *lines = block.splitlines()
        keyword, *options = head.split(",")
        rows = [[word.strip() for word in line.split(",") if word.strip()] for line in lines if line.strip()]
        yield keyword.strip(), {option.replace(" ", "").strip() for option in options}, rows


def read(deck: Path, element: str = "u1") -> Problem:
    """Nodes, elements of one type, sets, properties and boundary conditions of a deck without parts."""
    coordinates: dict[int, list[float]] = {}
    elements: list[list[int]] = []
    sets: dict[str, list[int]] = {}
    properties: list[float] = []
    conditions: list[list[str]] = []
    for keyword, options, rows in blocks(deck):
        if keyword == "node":
            coordinates |= {int(row[0]): [float(value) for value in row[1:3]] for row in rows}
        elif keyword == "element" and f"type={element}" in options:
            elements += [[int(label) for label in row[1:]] for row in rows]
        elif keyword == "nset":
            (name,) = (option.removeprefix("nset=") for option in options if option.startswith("nset="))
            numbers = [[int(word) for word in row] for row in rows]
            if "generate" in options:
                numbers = [list(range(first, last + 1, step)) for first, last, step in numbers]
            sets[name] = [number for row in numbers for number in row]
        elif keyword == "uel property":
            properties = [float(word) for row in rows for word in row]
        elif keyword == "boundary":
            conditions += rows
    labels = sorted({label for nodes in elements for label in nodes})
    place = {label: k for k, label in enumerate(labels)}
    found = {name: np.array([place[label] for label in set_ if label in place]) for name, set_ in sets.items()}
    prescribed = {
        3 * int(node) + DOFS[dof]: float(row[3]) if len(row) > 3 else 0.0
        for row in conditions
        for node in found[row[0]]
        for dof in range(int(row[1]), int(row[2]) + 1)
    }
    points = np.array([coordinates[label] for label in labels])
    nodes = np.array([[place[label] for label in row] for row in elements])
    return Problem(points, nodes, np.array(properties), prescribed, found)


def energy(state: NDArray[Any], properties: Array) -> NDArray[Any]:
    """W of points with F11, F12, F21, F22, t, t,1 and t,2 in the last direction of an array."""
    c0, c1, c2, alpha, beta = properties
    f11, f12, f21, f22, t, t1, t2 = np.moveaxis(state, -1, 0)
    a1, a2 = np.cos(t) - alpha * np.sin(t), np.cos(t) + beta * np.sin(t)
    g11, g12, g21, g22 = f11 / a1, f12 / a2, f21 / a1, f22 / a2
    j = g11 * g22 - g12 * g21
    distortion = (g11**2 + g12**2 + g21**2 + g22**2) / j - 2
    return np.asarray(c0 * (distortion + (j - 1) ** 2) + c1 * t**2 + c2 * (t1**2 + t2**2))


def stress(state: Array, properties: Array) -> Array:
    """Derivatives of W with respect to the seven numbers of a point, by complex steps: exact to rounding."""
    steps = 1e-30j * np.eye(7)
    return np.stack([energy(state + step, properties).imag / 1e-30 for step in steps], axis=-1)


def moduli(state: Array, properties: Array, step: float = 1e-6) -> Array:
    """Second derivatives of W, by central differences of the first."""
    columns = [stress(state + e, properties) - stress(state - e, properties) for e in step * np.eye(7)]
    return np.stack(columns, axis=-1) / (2 * step)


def shape(point: Array) -> tuple[Array, Array]:
    """Shape functions and their derivatives at a point of the parent square, from the monomials."""
    inverse = np.linalg.inv(np.prod(NODES[:, None, :] ** POWERS, axis=2))
    x, y = point
    p, q = POWERS.T
    slopes = np.array([p * x ** np.maximum(p - 1, 0) * y**q, q * x**p * y ** np.maximum(q - 1, 0)])
    return (x**p * y**q) @ inverse, slopes @ inverse


def operators(problem: Problem) -> tuple[Array, Array]:
    """Matrices (element, point, 7, 24) from the dofs of an element to the state of a point, and areas of the points."""
    abscissas, weights = np.polynomial.legendre.leggauss(3)
    corners = problem.coordinates[problem.elements]
    matrices = np.zeros((len(corners), 9, 7, 24))
    areas = np.zeros((len(corners), 9))
    for k, (i, j) in enumerate(np.ndindex(3, 3)):
        values, slopes = shape(np.array([abscissas[i], abscissas[j]]))
        jacobian = np.einsum("an,enb->eab", slopes, corners)
        gradient = np.linalg.solve(jacobian, np.broadcast_to(slopes, (len(corners), 2, 8)))
        matrices[:, k, 0:2, 0::3] = gradient
        matrices[:, k, 2:4, 1::3] = gradient
        matrices[:, k, 4, 2::3] = values
        matrices[:, k, 5:7, 2::3] = gradient
        areas[:, k] = weights[i] * weights[j] * np.linalg.det(jacobian)
    return matrices, areas


class Host:
    """Assembly and Newton's method for a problem."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._matrices, self._areas = operators(problem)
        self._dofs = (3 * problem.elements[:, :, None] + np.arange(3)).reshape(len(problem.elements), 24)
        self.count = 3 * len(problem.coordinates)

    def _states(self, values: Array) -> Array:
        return np.asarray(UNDEFORMED + np.einsum("epsd,ed->eps", self._matrices, values[self._dofs]))

    def energy(self, values: Array) -> float:
        """Total energy."""
        return float(np.sum(energy(self._states(values), self.problem.properties) * self._areas))

    def forces(self, values: Array) -> Array:
        """Its derivatives with respect to the dofs: the reactions where they are prescribed."""
        found = stress(self._states(values), self.problem.properties)
        forces = np.einsum("epsd,eps,ep->ed", self._matrices, found, self._areas, optimize=True)
        return np.bincount(self._dofs.ravel(), forces.ravel(), self.count).astype(float)

    def _stiffness(self, values: Array) -> Any:
        found = moduli(self._states(values), self.problem.properties) * self._areas[:, :, None, None]
        blocks = np.einsum("epsd,epsf->edf", self._matrices, found @ self._matrices, optimize=True)
        rows, columns = np.broadcast_arrays(self._dofs[:, :, None], self._dofs[:, None, :])
        return coo_array((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(self.count, self.count)).tocsc()

    def solve(self, prescribed: dict[int, float], steps: int = 6, tolerance: float = 1e-12) -> Array:
        """Dofs in equilibrium under prescribed values, which are reached in equal steps.

        The tolerance is on the largest force that is not in balance; RuntimeError if 20 iterations do not reach it.
        """
        dofs, goals = np.array(list(prescribed)), np.array(list(prescribed.values()))
        free = np.setdiff1d(np.arange(self.count), dofs)
        values: Array = np.zeros(self.count)
        for step in range(1, steps + 1):
            change = np.zeros(self.count)
            change[dofs] = goals * step / steps - values[dofs]
            for _ in range(20):
                stiffness, forces = self._stiffness(values), self.forces(values)
                change[free] = splu(stiffness[free][:, free]).solve(-(forces + stiffness @ change)[free])
                values = values + change
                change = np.zeros(self.count)
                if np.abs(self.forces(values)[free]).max() < tolerance:
                    break
            else:
                raise RuntimeError(f"no equilibrium at step {step} of {steps}")
        return values


def figures(deck: Path) -> dict[str, float]:
    """The expected values of the rows, by name, and the reaction that is zero by symmetry."""
    problem = read(deck)
    across = {int(dof): 0.0 for dof in problem.dofs("rightpt", 2)}
    host = Host(problem)
    values = host.solve(problem.prescribed | across)
    forces = host.forces(values)
    return {
        "kirigami": float(forces[problem.dofs("rightpt", 1)].sum()),
        "kirigami-angle": float(values[problem.dofs("all", 11)].min()),
        "reaction across": float(np.abs(forces[list(across)]).max()),
    }


def main() -> int:
    """Print the figures next to those of the manifest; returns 1 if they differ in the digits printed there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    manifest = tomllib.loads(Path(__file__).with_name("manifest.toml").read_text("utf-8"))
    rows = {row["name"]: row for row in manifest["row"]}
    row, good = rows["kirigami"], True
    for name, figure in figures(parser.parse_args().folder / row["folder"] / row["deck"]).items():
        expected = rows.get(name, {}).get("expected")
        good &= expected is None or abs(figure / expected - 1) < 1e-6
        print(name, f"{figure:.8g}", "" if expected is None else f"manifest: {expected:.8g}")
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
