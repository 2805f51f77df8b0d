# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts that nothing holds: they do no harm where no force acts on them, and end the run where one does."""

import numpy as np
import pytest
from scipy import sparse

import uel
from uel.errors import SingularMatrixError
from uel.procedures.general.unconstrained import UnconstrainedSolver
from uel.solver.linear import choose

YOUNG, PULL = 1000.0, 3.0
# a unit square pinned in one corner, which may turn about it, in balance under forces in its corners
SQUARE = f"""*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=BODY
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=BODY, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
{YOUNG}
"""
BESIDE = """*NODE
11, 5., 0.
12, 6., 0.
13, 6., 1.
*ELEMENT, TYPE=CPS3, ELSET=BODY
2, 11, 12, 13
"""
# a horizontal bar, which has no stiffness across
BAR = f"""*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
*ELEMENT, TYPE=T2D2, ELSET=BAR
1, 1, 2
*SOLID SECTION, ELSET=BAR, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
{YOUNG}
"""
ALONG = """*STEP
*STATIC
1., 1.
*BOUNDARY
1, 1, 2
*CLOAD
2, 1, {pull}
2, 2, {across}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""
STEP = """*STEP
*STATIC
1., 1.
*BOUNDARY
1, 1, 2
*CLOAD
2, 1, {pull}
3, 1, {pull}
4, 1, -{pull}
{more}*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U
*END STEP
"""


@pytest.fixture
def pull(run_deck):
    def pull(deck, more=""):
        result = run_deck(deck + STEP.format(pull=PULL, more=more))
        return result.history, " ".join(result.file(".msg").read_text().split())

    return pull


@pytest.mark.parametrize("deck", [SQUARE, SQUARE + BESIDE], ids=["free to turn", "and a part beside it"])
def test_what_no_force_moves_does_no_harm(pull, deck):
    history, message = pull(deck)
    moved = np.array([[history[f"U{dof}[ALL:{node}]"][-1] for dof in (1, 2)] for node in (1, 2, 3, 4)])
    # the stress of two forces on a unit side; nu = 0; the square may have turned
    stretch, turn = 2 * PULL / YOUNG, moved[1, 1]
    expected = np.array([[0, 0], [stretch, turn], [stretch - turn, turn], [-turn, 0]])
    np.testing.assert_allclose(moved, expected, atol=1e-6 * stretch)
    assert abs(turn) < stretch
    assert "WARNING: SINGULAR SYSTEM MATRIX AT NODE" in message.upper()
    assert "NO FORCE ACTS ON THE FREE PART, WHICH GETS SMALL DISPLACEMENTS" in message


@pytest.mark.parametrize("more", ["2, 2, 0.01\n", "13, 1, 0.01\n"], ids=["turned", "pushed"])
def test_a_force_on_what_moves_freely_is_an_error(pull, more):
    with pytest.raises(
        SingularMatrixError, match=r"deck.inp:\d+: singular system matrix at node \d+, dof [12]: .* unconstrained"
    ):
        pull(SQUARE + BESIDE, more)


BRICK = """*NODE, NSET=ALL
1, 0., -1., -1.
2, 1., -1., -1.
3, 1., 1., -1.
4, 0., 1., -1.
5, 0., -1., 1.
6, 1., -1., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*SOLID SECTION, ELSET=E, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*NSET, NSET=L
1, 4, 5, 8
*NSET, NSET=R
2, 3, 6, 7
*STEP, INC=200%s
*STATIC, DIRECT
0.01, 1.
*BOUNDARY
L, 1, 1
R, 1, 1, 0.01
1, 2, 3
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=R
U, RF
*RESTART, WRITE, FREQUENCY=50
*END STEP
"""


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize("linear_solver", ["superlu", "band"])
def test_many_increments_of_a_body_free_to_turn(tmp_path, options, linear_solver):
    """A brick is pulled and free to turn about the way of the pull: increments that the extrapolation has solved leave
    rounding alone, and the run goes on, with one warning. So does a restart. The force is that of uniaxial stress.
    """
    (tmp_path / "deck.inp").write_text(BRICK % options)
    solver = uel.SolverOptions(linear_solver=linear_solver)
    result = uel.run(tmp_path / "deck.inp", output_dir=tmp_path, solver=solver)
    assert len(result.status) == 100
    stretch = 1.01
    # of NLGEOM: E ln(l) l^(-2 nu) (logarithmic strain, Cauchy stress)
    force = 4 * 1000 * (np.log(stretch) * stretch**-0.6 if options else 0.01)
    total = sum(values[-1] for name, values in result.history.items() if name.startswith("RF1["))
    assert total == pytest.approx(force, rel=1e-6)
    assert (tmp_path / "deck.msg").read_text().count("***WARNING") == 1
    largest = max(np.abs(values).max() for name, values in result.history.items() if name.startswith("U"))
    assert largest < 0.02
    (tmp_path / "deck_restart" / "step1_increment0100.npz").unlink()
    again = uel.run(tmp_path / "deck.inp", output_dir=tmp_path, solver=solver, job="again", oldjob=tmp_path / "deck")
    assert again.completed


def test_an_unknown_without_any_stiffness_stays(run_deck, tmp_path):
    """Its displacement is exactly zero, and the others are those of the bar: F L/(E A)."""
    history = run_deck(BAR + ALONG.format(pull=PULL, across=0.0)).history
    assert history["U2[ALL:2]"][-1] == 0.0
    np.testing.assert_allclose(history["U1[ALL:2]"][-1], PULL * 2.0 / YOUNG, rtol=1e-14)
    assert "NO FORCE ACTS ON THE FREE PART" in " ".join((tmp_path / "deck.msg").read_text().split())


def test_a_force_on_an_unknown_without_any_stiffness_is_an_error(run_deck):
    with pytest.raises(
        SingularMatrixError, match=r"deck.inp:\d+: singular system matrix at node 2, dof 2: .* unconstrained"
    ):
        run_deck(BAR + ALONG.format(pull=PULL, across=1.0))


def test_a_soft_part_beside_what_moves_freely():
    """Two springs in a row, the one that is held a million times softer, beside a spring with two free ends."""
    soft = 1e-6
    matrix = sparse.csr_array([[1 + soft, -1, 0, 0], [-1, 1, 0, 0], [0, 0, 1, -1], [0, 0, -1, 1]])
    solver = UnconstrainedSolver(choose("superlu", matrix.indptr, matrix.indices))
    solver.factorise(matrix.data)
    found = solver.solve(np.array([0.0, 3.0, 0.0, 0.0]))
    np.testing.assert_allclose(found, [3.0 / soft, 3.0 / soft + 3.0, 0.0, 0.0], rtol=1e-6)
    with pytest.raises(SingularMatrixError, match="singular system matrix"):
        solver.solve(np.array([0.0, 3.0, 1e-3, 1e-3]))
