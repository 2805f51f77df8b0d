# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Upright columns of continuum elements, and Euler's load."""

import numpy as np
from small_decks import body_lines

from uel.model.element_types import CONTINUUM

HIGH, WIDE, LONG, YOUNG = 1.0, 1.0, 20.0, 1e6


def column(element_type, *, nu=0.0, cells=(10, 1)):
    """An upright column held at its foot, x up, with the sets FOOT, HEAD and the surface TOP."""
    kind = CONTINUUM[element_type]
    d, (along, across) = kind.dimension, cells
    middle = kind.nodes in (8, 20) and kind.nodes != 2**d
    step = 1 if middle else 2
    shape = (2 * along + 1, 2 * across + 1) if d == 2 else (2 * along + 1, 2 * across + 1, 2 * across + 1)
    size = (LONG, HIGH, WIDE)
    points = np.stack(np.meshgrid(*(np.arange(0, n) for n in shape), indexing="ij"), axis=-1).reshape(-1, d)
    odd = np.count_nonzero(points % 2, axis=1)
    used = points[odd <= 1] if step == 1 else points[odd == 0]
    numbers = {tuple(point): k for k, point in enumerate(used.tolist())}
    local = np.array(CELLS[d])[: kind.nodes]
    elements = []
    for cell in np.ndindex(*[(n - 1) // 2 for n in shape]):
        elements.append([numbers[tuple((2 * np.array(cell) + at).tolist())] for at in local])
    nodes = used * np.array([size[k] / (shape[k] - 1) for k in range(d)])
    lines = body_lines(element_type, nodes, elements)
    foot = [str(k + 1) for k, x in enumerate(nodes) if x[0] == 0]
    centre = [str(k + 1) for k, x in enumerate(nodes) if x[0] == 0 and x[1] == 0]
    last = [str(k + 1) for k, cell in enumerate(np.ndindex(*[(n - 1) // 2 for n in shape])) if cell[0] == along - 1]
    lines += ["*NSET, NSET=FOOT", *foot, "*NSET, NSET=LINE", *centre]
    lines += ["*ELSET, ELSET=LAST", *last]
    controls = ", CONTROLS=C" if kind.hourglass_control else ""
    lines += ["*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED"] if controls else []
    thickness = [str(WIDE)] if d == 2 else []
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{controls}", *thickness, "*MATERIAL, NAME=M"]
    lines += [f"*ELASTIC\n{YOUNG}, {nu}", "*BOUNDARY", "FOOT, 1", "LINE, 2"]
    lines += ["FOOT, 3"] if d == 3 else []
    return "\n".join(lines) + "\n"


# local nodes in a cell of 3 x 3 (x 3) points, corners first
CELLS = {
    2: [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)],
    3: [
        *[(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)],
        *[(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)],
        *[(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)],
    ],
}
HEADS = {2: "S2", 3: "S4"}


def euler(modulus=YOUNG, shear=YOUNG / 2):
    """Pressure on a cantilever column with shear (S.P. Timoshenko, Theory of Elastic Stability, effect of shear)."""
    pure = np.pi**2 * modulus * HIGH**2 / 12 / (4 * LONG**2)
    return pure / (1 + 1.2 * pure / shear)


def head(element_type, load="*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 1., -1."):
    """A load on the head, which keeps its direction."""
    return f"*SURFACE, NAME=TOP\nLAST, {HEADS[CONTINUUM[element_type].dimension]}\n", load
