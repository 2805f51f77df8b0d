# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DCB-ref in Akantu, run by peers.py in an environment that has Akantu and scipy.

    python peer_akantu.py FOLDER INCREMENTS [search]

FOLDER has mesh.msh, without cohesive elements, and material.dat. A line for each increment: opening (mm), load on 1 mm
of width (N), number of iterations, seconds of the processor so far.

As it is shipped, Akantu ends where its Newton iteration fails. With `search`, a Newton iteration with a search along
its line and cutbacks is written around its forces and matrices, which reaches the end: SuperLU solves, in symmetric
mode with a minimum-degree ordering.
"""

import sys
import time

import akantu as aka
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

TIP, LENGTH, HEIGHT = 35.0, 150.0, 3.1
CORNER = 5.0
"""Displacement of a corner at the end (mm)."""

TOLERANCE = 1e-3
"""Of the residual, over the load."""

ITERATIONS = 20
"""After which an increment is halved twice; with 40 the run needs a tenth more in all."""


class Specimen:
    """The model, its loaded corners, and its unknowns."""

    def __init__(self, folder: str) -> None:
        aka.parseInput(f"{folder}/material.dat")
        # the model does not keep its mesh alive
        self.mesh = mesh = aka.Mesh(2)
        mesh.read(f"{folder}/mesh.msh")
        self.model = model = aka.SolidMechanicsModelCohesive(mesh)
        inserter = model.getElementInserter()
        inserter.setLimit(aka._x, TIP, LENGTH)
        inserter.setLimit(aka._y, HEIGHT / 2 - 1e-4, HEIGHT / 2 + 1e-4)
        model.initFull(_analysis_method=aka._static, _is_extrinsic=False)
        x, y = mesh.getNodes().T
        blocked, self.displacement = model.getBlockedDOFs(), model.getDisplacement()
        self.top, self.bottom = (np.flatnonzero((abs(x) < 1e-6) & (abs(y - height) < 1e-6)) for height in (HEIGHT, 0.0))
        blocked[abs(x - LENGTH) < 1e-6, :] = True
        blocked[self.top, 1] = blocked[self.bottom, 1] = True
        self.free = np.flatnonzero(~blocked.ravel())

    def pull(self, share: float) -> None:
        """Move the corners to this share of their displacement at the end."""
        self.displacement[self.top, 1] = CORNER * share
        self.displacement[self.bottom, 1] = -CORNER * share

    def load(self) -> float:
        """On the upper corner; Akantu's internal forces are those on the elements."""
        return -float(self.model.getInternalForce()[self.top, 1].sum())


class Searched:
    """Newton's method with a search along its line, around the forces and matrices of Akantu."""

    def __init__(self, specimen: Specimen) -> None:
        self.specimen = specimen
        # each evaluation adds to the largest openings: an iteration starts from those of the increment before
        interface = specimen.model.getMaterial("interface")
        self.openings = interface.getInternalReal("delta max")(aka._cohesive_2d_4)
        self.kept = self.openings.copy()

    def residual(self) -> np.ndarray:
        """Of all unknowns, for the present displacements."""
        self.openings[:] = self.kept
        self.specimen.model.assembleInternalForces()
        return -self.specimen.model.getInternalForce().ravel()

    def matrix(self) -> sp.csc_matrix:
        """Of all unknowns, after `residual`."""
        model = self.specimen.model
        model.assembleMatrix("K")
        return sp.csc_matrix(aka.AkantuSparseMatrix(model.getDOFManager().getMatrix("K")))

    def solve(self, rhs: np.ndarray, matrix: sp.csc_matrix) -> np.ndarray:
        """Of the free unknowns."""
        free = self.specimen.free
        factors = splu(
            matrix[free][:, free],
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        return factors.solve(rhs[free])

    def increment(self, share: float) -> tuple[bool, int]:
        """Whether it converges, and its iterations."""
        specimen, free = self.specimen, self.specimen.free
        u = specimen.displacement.reshape(-1)
        forces = self.residual()
        before, matrix = u.copy(), self.matrix()
        specimen.pull(share)
        step = self.solve(-forces - matrix @ (u - before), matrix)
        u[free] += step
        for iteration in range(1, ITERATIONS + 1):
            forces = self.residual()
            if np.linalg.norm(forces[free]) <= TOLERANCE * abs(specimen.load()):
                self.kept = self.openings.copy()
                specimen.model.beforeSolveStep()
                return True, iteration
            step = self.solve(-forces, self.matrix())
            self.search(u, step, forces)
        return False, ITERATIONS

    def search(self, u: np.ndarray, step: np.ndarray, forces: np.ndarray) -> None:
        """Move along the step to where at most half of the power of the residual is left."""
        free, start = self.specimen.free, u.copy()
        first = float(forces[free] @ step)

        def power(scale: float) -> float:
            u[free] = start[free] + scale * step
            return float(self.residual()[free] @ step)

        low, at_low, high, at_high = 0.0, first, 1.0, power(1.0)
        value = at_high
        for _ in range(8):
            if abs(value) <= abs(first) / 2 or at_low * at_high > 0:
                return
            scale = low + (high - low) * min(max(at_low / (at_low - at_high), 0.1), 0.9)
            value = power(scale)
            if value * first > 0:
                low, at_low = scale, value
            else:
                high, at_high = scale, value


def shipped(specimen: Specimen, increments: int) -> None:
    """Akantu's own solver."""
    solver = specimen.model.getNonLinearSolver()
    solver.set("max_iterations", 1000)
    solver.set("threshold", 1e-3)
    solver.set("convergence_type", aka.SolveConvergenceCriteria.residual)
    start = time.process_time()
    for k in range(1, increments + 1):
        specimen.pull(k / increments)
        specimen.model.solveStep()
        seconds = time.process_time() - start
        print(2 * CORNER * k / increments, specimen.load(), solver.getInt("nb_iterations"), seconds, flush=True)


def searched(specimen: Specimen, increments: int) -> None:
    """The search around it; a line counts the attempts before its increment as well."""
    solver, start = Searched(specimen), time.process_time()
    share, size, iterations = 0.0, 1.0 / increments, 0
    while share < 1.0 - 1e-9:
        before, size = specimen.displacement.copy(), min(size, 1.0 - share)
        converged, count = solver.increment(share + size)
        iterations += count
        if not converged:
            specimen.displacement[:] = before
            size /= 4.0
            continue
        share += size
        print(2 * CORNER * share, specimen.load(), iterations, time.process_time() - start, flush=True)
        iterations = 0
        if count < ITERATIONS / 2:
            size = min(1.5 * size, 1.0 / increments)


if __name__ == "__main__":
    (searched if "search" in sys.argv[3:] else shipped)(Specimen(sys.argv[1]), int(sys.argv[2]))
