# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DCB-ref in Akantu as it is shipped, run by peers.py in an environment that has Akantu.

    python peer_akantu.py FOLDER INCREMENTS

FOLDER has mesh.msh, without cohesive elements, and material.dat. A line for each increment: opening (mm), load on 1 mm
of width (N), number of iterations, seconds of the processor so far. It ends where Akantu's Newton iteration fails.
"""

import sys
import time

import akantu as aka
import numpy as np

TIP, LENGTH, HEIGHT = 35.0, 150.0, 3.1
CORNER = 5.0
"""Displacement of a corner at the end (mm)."""


def main(folder: str, increments: int) -> None:
    """Run it."""
    aka.parseInput(f"{folder}/material.dat")
    mesh = aka.Mesh(2)
    mesh.read(f"{folder}/mesh.msh")
    model = aka.SolidMechanicsModelCohesive(mesh)
    inserter = model.getElementInserter()
    inserter.setLimit(aka._x, TIP, LENGTH)
    inserter.setLimit(aka._y, HEIGHT / 2 - 1e-4, HEIGHT / 2 + 1e-4)
    model.initFull(_analysis_method=aka._static, _is_extrinsic=False)
    x, y = mesh.getNodes().T
    blocked, displacement = model.getBlockedDOFs(), model.getDisplacement()
    top, bottom = (np.flatnonzero((abs(x) < 1e-6) & (abs(y - height) < 1e-6)) for height in (HEIGHT, 0.0))
    blocked[abs(x - LENGTH) < 1e-6, :] = True
    blocked[top, 1] = blocked[bottom, 1] = True
    solver = model.getNonLinearSolver()
    solver.set("max_iterations", 1000)
    solver.set("threshold", 1e-3)
    solver.set("convergence_type", aka.SolveConvergenceCriteria.residual)
    start = time.process_time()
    for k in range(1, increments + 1):
        displacement[top, 1] = CORNER * k / increments
        displacement[bottom, 1] = -CORNER * k / increments
        model.solveStep()
        load = -float(model.getInternalForce()[top, 1].sum())
        print(
            2 * CORNER * k / increments, load, solver.getInt("nb_iterations"), time.process_time() - start, flush=True
        )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
