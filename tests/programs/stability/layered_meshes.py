# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Random laminates of one kind of solid, cut between all layers by `uel insert`, and their assembled matrices."""

import numpy as np
from bonded_pairs import AT_REST
from random_pairs import random_ply
from solid_grids import grid, inserted

from uel import usersub
from uel.assembly.system import system_of
from uel.deck.reader import read_deck
from uel.model.element_types import BUILT_IN

LAYERS = 3
"""Solids between two interfaces, and between one and a free face."""

STRONG = ("SIGMAMAX=1", "TAUMAX=1", "GIC=1e25", "GIIC=1e25")


def matrix_of_laminate(name, rng, folder):
    """Dense matrix of a laminate at rest; rigid bonds and soft ones in turns.

    In the plane the inner nodes are moved at random; in space there are none, since plies have their axis 3 along the
    normal of the interface.
    """
    dim = BUILT_IN[name].family.dimension
    counts = (2, LAYERS) if dim == 2 else (2, 1, LAYERS)
    sizes = 10.0 ** rng.uniform(-1, 1, dim)
    mesh = grid(name, counts, sizes, 0.3, int(rng.integers(1 << 30)))
    mesh.sets = {f"LAYER_{k}": mesh.cell[:, -1] == k for k in range(LAYERS)}
    lines = mesh.lines()
    for layer in mesh.sets:
        ply = random_ply(rng, 10.0 ** rng.uniform(-1.5, 1.5))
        constants = [repr(float(value)) for each, value in ply.items() if each != "ANGLE"]
        lines += [
            *(f"*ORIENTATION, NAME={layer}", "1., 0., 0., 0., 1., 0.", f"3, {ply['ANGLE']!r}"),
            *(f"*MATERIAL, NAME={layer}", "*ELASTIC, TYPE=ENGINEERING CONSTANTS"),
            *(", ".join(constants[:8]), constants[8]),
            *(f"*SOLID SECTION, ELSET={layer}, MATERIAL={layer}, ORIENTATION={layer}", "1."),
        ]
    lines += ["*STEP", "*STATIC", "1., 1.", "*END STEP"]
    plain, cut = folder / "plain.inp", folder / "cut.inp"
    plain.write_text("\n".join(lines) + "\n")
    soft = () if rng.random() < 0.5 else ("ALPHAN=1e-6",)
    inserted(plain, cut, (*STRONG, *soft), plies=tuple(mesh.sets))
    model = read_deck(cut)
    library = usersub.load(None, job="laminate", output_dir=folder)
    try:
        system = system_of(model, library)
        rest = np.zeros(len(system))
        return system.matrix(system.evaluate(AT_REST, rest, rest).data).toarray()
    finally:
        library.close()
