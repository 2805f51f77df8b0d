# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""DCB-ref in PyFEM, run by peers.py in an environment that PyFEM can be imported from.

    python peer_pyfem.py FOLDER CORNER SECONDS

FOLDER has dcb.pro and dcb.dat, CORNER is the number of the node that is pulled; it ends after the increment in which it
has taken SECONDS. A line for each increment: opening (mm), load on 1 mm of width (N), number of iterations, seconds of
the processor so far. Output at nodes is left out: its list grows with the square of the number of elements, and hours
with it.
"""

import os
import sys
import time

from pyfem.elements.Element import Element
from pyfem.io.InputReader import InputRead
from pyfem.solvers.Solver import Solver

CORNER = 5.0
"""Displacement of a corner at the end, after 100 increments (mm)."""


def main(folder: str, corner: int, limit: float) -> None:
    """Run it."""
    os.chdir(folder)
    Element.appendNodalOutput = lambda *_: None
    properties, model = InputRead("dcb.pro")
    solver = Solver(properties, model)
    start, row = time.process_time(), model.dofs.getForType(corner, "v")
    while model.active and time.process_time() - start < limit:
        solver.run(properties, model)
        cycle, iterations = model.solverStatus.cycle, model.solverStatus.iiter
        print(
            CORNER / 50 * cycle, model.fint[row], iterations, time.process_time() - start, file=sys.stderr, flush=True
        )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))
