# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the ranks ask of PETSc, without it; tests/harness/parallel solves with it."""

import sys

import numpy as np
from scipy import sparse
from small_decks import body_lines

from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Flags
from uel.solver.linear import petsc

BRICKS = np.array([[x, y, z] for x in (0.0, 2.0, 3.5) for y in (0.0, 1.0) for z in (0.0, 1.5)])
NODES = [[0, 4, 6, 2, 1, 5, 7, 3], [4, 8, 10, 6, 5, 9, 11, 7]]


def test_rigid_modes_take_no_force(tmp_path):
    lines = body_lines("C3D8", BRICKS, NODES)
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "*MATERIAL, NAME=M", "*ELASTIC", "200., 0.3"]
    lines += ["*STEP", "*STATIC", "1., 1.", "*END STEP", ""]
    deck = tmp_path / "bricks.inp"
    deck.write_text("\n".join(lines))
    model = read_deck(deck)
    library = usersub.load(None, job="bricks", output_dir=tmp_path, deck=deck)
    system = system_of(model, library)
    rest = np.zeros(len(system))
    data = system.evaluate(Call(Flags(1), 1, 1, 0.0, 0.0, 1.0, 1.0), rest, rest).data
    matrix = sparse.csr_array((data, system.indices, system.indptr))
    library.close()
    modes = petsc.rigid_modes(system.dofs.coordinates, system.dofs.dof)
    assert np.linalg.matrix_rank(modes) == modes.shape[1] == 6
    assert np.abs(matrix @ modes).max() < 1e-12 * np.abs(data).max()


def test_modes_of_rotations_and_of_other_dofs():
    places, dofs = np.repeat([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]], 4, axis=0), np.tile([2, 3, 6, 11], 2)
    modes = petsc.rigid_modes(places, dofs)
    # about axis 3, the nodes at 2 on both sides of the middle; by angle 1/2
    assert modes[:, 5].tolist() == [-1.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.5, 0.0]
    assert modes[:, 6].tolist() == [0.0, 0.0, 0.0, 1.0] * 2


def test_without_petsc4py(monkeypatch):
    monkeypatch.setitem(sys.modules, "petsc4py", None)
    # neither asks again what it knows
    petsc._loaded.cache_clear()
    assert petsc.obstacle.__wrapped__(2).startswith("petsc4py does not load: ")
