# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every installed linear solver against dense algebra, singular matrices, and the automatic choice."""

import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse.linalg import splu

from uel.errors import SingularMatrixError, UelError
from uel.solver.linear import LinearSolver, available, choose, singular, superlu
from uel.solver.linear.choice import SOLVERS
from uel.solver.linear.linear_solver import Pattern
from uel.solver.linear.mumps import MumpsSolver
from uel.solver.linear.ordering import narrowest
from uel.solver.linear.pardiso import FACTORISE, SYMMETRIC, PardisoError, call

INSTALLED = [row.name for row in available() if row.installed]


def quad(width: float, height: float) -> np.ndarray:
    """(8, 8) stiffness of a four-node quad, plane stress, E = 1e5, nu = 0.3, thickness 1."""
    d = 1e5 / 0.91 * np.array([[1.0, 0.3, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 0.35]])
    stiffness = np.zeros((8, 8))
    for x in (-(3**-0.5), 3**-0.5):
        for y in (-(3**-0.5), 3**-0.5):
            dx = np.array([y - 1, 1 - y, 1 + y, -1 - y]) / (2 * width)
            dy = np.array([x - 1, -1 - x, 1 + x, 1 - x]) / (2 * height)
            b = np.zeros((3, 8))
            b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = dx, dy, dy, dx
            stiffness += b.T @ d @ b * width * height / 4
    return stiffness


def interface(stiffness: float, length: float) -> np.ndarray:
    """(8, 8) linear interface, nodes 1-2 below 4-3, two Gauss points."""
    result = np.zeros((8, 8))
    for x in (-(3**-0.5), 3**-0.5):
        n = np.array([(1 - x) / 2, (1 + x) / 2])
        jump = np.kron(np.concatenate([-n, n[::-1]]), np.eye(2))
        result += stiffness * length / 2 * jump.T @ jump
    return result


def beam(columns: int, rows: int, stiffness: float = 1e6, size: tuple[float, float] = (0.5, 0.4)):
    """Two bonded arms of quads: (matrix with all unknowns, (n, 3) coordinates). Node by node, dofs 1 and 2."""
    width, height = size
    node = np.arange(2 * (columns + 1) * (rows + 1)).reshape(2, columns + 1, rows + 1)
    quads = np.stack([node[:, :-1, :-1], node[:, 1:, :-1], node[:, 1:, 1:], node[:, :-1, 1:]], axis=-1).reshape(-1, 4)
    joint = np.stack([node[0, :-1, -1], node[0, 1:, -1], node[1, 1:, 0], node[1, :-1, 0]], axis=-1)
    arm, column, row = np.unravel_index(np.arange(node.size), node.shape)
    coordinates = np.column_stack([column * width, (row + arm * rows) * height, 0.0 * row])
    rows, columns_of, values = [], [], []
    for nodes, element in ((quads, quad(width, height)), (joint, interface(stiffness, width))):
        at = (2 * nodes[:, :, None] + np.arange(2)).reshape(-1, 8)
        rows.append(np.repeat(at, 8, axis=1).ravel())
        columns_of.append(np.tile(at, 8).ravel())
        values.append(np.broadcast_to(element, (len(at), 8, 8)).ravel())
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns_of))
    matrix = sparse.coo_array(entries, shape=(2 * node.size, 2 * node.size)).tocsr()  # keeps zeros in the pattern
    matrix.sort_indices()
    return matrix, np.repeat(coordinates, 2, axis=0)


def hold(matrix, coordinates, held: np.ndarray):
    """Matrix and coordinates without the held unknowns."""
    free = ~held
    reduced = sparse.csr_array(matrix[free][:, free])
    reduced.sort_indices()
    return reduced, coordinates[free]


def clamped(columns: int, rows: int, stiffness: float = 1e6):
    matrix, coordinates = beam(columns, rows, stiffness)
    return hold(matrix, coordinates, coordinates[:, 0] == coordinates[:, 0].max())


def solver_for(name: str, matrix, coordinates=None, **options):
    pattern = matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)
    return choose(name, *pattern, coordinates=coordinates, **options)


def test_multipliers_do_not_fill_the_factors():
    """Lagrange multipliers, whose diagonal is next to zero, in every second unknown of a bonded beam."""
    matrix, _ = clamped(40, 6)
    n, m = matrix.shape[0], matrix.shape[0] // 2
    links = sparse.csr_array(
        (np.tile([1.0, -1.0], m), np.repeat(np.arange(m), 2), np.arange(0, 2 * m + 1, 2)), shape=(m, n)
    )
    links.indices[1::2] = np.arange(m) + m
    saddle = sparse.csr_array(sparse.block_array([[matrix, links.T], [links, 1e-10 * sparse.eye_array(m)]]))
    saddle.sort_indices()
    rhs = np.random.default_rng(3).standard_normal(n + m)
    solver = solver_for("superlu", saddle)
    for _ in range(2):
        solver.factorise(saddle.data)
        solution = solver.solve(rhs)
        assert np.abs(saddle @ solution - rhs).max() < 1e-10 * (abs(saddle) @ np.abs(solution)).max()
    assert solver._lu.L.nnz + solver._lu.U.nnz < 10 * saddle.nnz


@pytest.mark.parametrize("name", INSTALLED)
def test_solution_equals_dense_one_and_analysis_is_kept(name) -> None:
    matrix, coordinates = clamped(12, 2)
    rng = np.random.default_rng(3)
    solver = solver_for(name, matrix, coordinates)
    for _ in range(3):
        data = matrix.data * (1 + 0.1 * rng.normal(size=matrix.nnz))  # no longer symmetric
        rhs = rng.normal(size=matrix.shape[0])
        expected = np.linalg.solve(sparse.csr_array((data, matrix.indices, matrix.indptr)).toarray(), rhs)
        solver.factorise(data)
        scale = np.abs(expected).max()
        np.testing.assert_allclose(solver.solve(rhs), expected, rtol=0, atol=1e-9 * scale)
        np.testing.assert_allclose(solver.solve(2 * rhs), 2 * expected, rtol=0, atol=1e-9 * scale)


@pytest.mark.parametrize("name", INSTALLED)
def test_results_are_the_same_bit_by_bit(name) -> None:
    matrix, coordinates = clamped(20, 3)
    rhs = np.random.default_rng(5).normal(size=matrix.shape[0])
    solutions = []
    for _ in range(3):
        solver = solver_for(name, matrix, coordinates)
        solver.factorise(matrix.data)
        solutions.append(solver.solve(rhs))
    assert all(np.array_equal(solution, solutions[0]) for solution in solutions)


@pytest.mark.parametrize("name", INSTALLED)
def test_nothing_to_solve(name) -> None:
    solver = choose(name, np.zeros(1, dtype=np.int32), np.zeros(0, dtype=np.int32))
    solver.factorise(np.zeros(0))
    assert solver.solve(np.zeros(0)).shape == (0,)


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize("stiffness", [1e6, 1e12])
def test_stiff_interface_is_not_taken_for_singular(name, stiffness) -> None:
    """Tip of a bonded cantilever under unit forces, against a single beam of the same quads with shared nodes."""
    matrix, coordinates = clamped(40, 2, stiffness)
    tip = np.flatnonzero((coordinates[:, 0] == 0) & (coordinates[:, 1] == 0.8))[[1, 3]]
    rhs = np.zeros(matrix.shape[0])
    rhs[tip] = 0.5
    solver = solver_for(name, matrix, coordinates)
    solver.factorise(matrix.data)
    shared, places = monolithic(40, 4)
    at = np.flatnonzero((places[:, 0] == 0) & (places[:, 1] == 0.8))[1]
    compliance = np.linalg.inv(shared.toarray())[at, at]
    # the interface adds its own shear compliance at 1e6; at 1e12 rounding of 1e12 x eps against a stiffness of 40 N/mm
    assert solver.solve(rhs)[tip].mean() == pytest.approx(compliance, rel=2e-2 if stiffness == 1e6 else 1e-3)


def monolithic(columns: int, rows: int):
    """The same beam without an interface, its nodes shared."""
    node = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    quads = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], axis=-1).reshape(-1, 4)
    at = (2 * quads[:, :, None] + np.arange(2)).reshape(-1, 8)
    values = np.broadcast_to(quad(0.5, 0.4), (len(at), 8, 8)).ravel()
    matrix = sparse.coo_array((values, (np.repeat(at, 8, axis=1).ravel(), np.tile(at, 8).ravel()))).tocsr()
    column, row = np.unravel_index(np.arange(node.size), node.shape)
    coordinates = np.repeat(np.column_stack([column * 0.5, row * 0.4, 0.0 * row]), 2, axis=0)
    return hold(matrix, coordinates, coordinates[:, 0] == columns * 0.5)


def unconstrained(case: str, stiffness: float):
    matrix, coordinates = beam(60, 2, stiffness)
    dof = np.arange(len(coordinates)) % 2
    end = coordinates[:, 0] == coordinates[:, 0].max()
    held = {
        "nothing held": np.zeros(len(dof), dtype=bool),
        "free along 1": (end | (coordinates[:, 0] == 0)) & (dof == 1),
        "free along 2": end & (dof == 0),
        "free to turn": end & (coordinates[:, 1] == 0),
    }[case]
    return (*hold(matrix, coordinates, held), np.flatnonzero(~held))


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize("stiffness", [1e6, 1e12])
@pytest.mark.parametrize(
    ("case", "dofs"),
    [("nothing held", (1, 2)), ("free along 1", (1,)), ("free along 2", (2,)), ("free to turn", (2,))],
)
def test_body_that_is_not_held_is_named(name, stiffness, case, dofs) -> None:
    matrix, coordinates, free = unconstrained(case, stiffness)
    solver = solver_for(name, matrix, coordinates, name_of=lambda k: (str(free[k] // 2 + 1), int(free[k]) % 2 + 1))
    with pytest.raises(
        SingularMatrixError, match=r"singular system matrix at node \d+, dof \d: .* unconstrained"
    ) as raised:
        solver.factorise(matrix.data)
    assert raised.value.dof in dofs


@pytest.mark.parametrize("name", INSTALLED)
def test_part_that_comes_loose_later_is_named(name) -> None:
    """The interface fails altogether: the upper arm, which hangs on it alone, floats."""
    sound, coordinates = beam(10, 2, 1e6)
    loose, _ = beam(10, 2, 0.0)
    lower = np.arange(len(coordinates)) < len(coordinates) // 2
    held = lower & (coordinates[:, 0] == 0)
    matrix, places = hold(sound, coordinates, held)
    later, _ = hold(loose, coordinates, held)
    free = np.flatnonzero(~held)
    solver = solver_for(name, matrix, places, name_of=lambda k: (str(free[k] // 2), int(free[k]) % 2 + 1))
    solver.factorise(matrix.data)
    rhs = np.ones(matrix.shape[0])
    assert np.isfinite(solver.solve(rhs)).all()
    with pytest.raises(SingularMatrixError, match="unconstrained") as raised:
        solver.factorise(later.data)
        solver.solve(rhs)
    assert int(raised.value.node) >= len(coordinates) // 4


@pytest.mark.parametrize("name", INSTALLED)
def test_unknown_without_stiffness_is_named(name) -> None:
    matrix, coordinates = clamped(6, 1)
    data = matrix.data.copy()
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    data[(rows == 9) | (matrix.indices == 9)] = 0.0
    solver = solver_for(name, matrix, coordinates, name_of=lambda k: (f"PART-1.{k}", 2))
    with pytest.raises(SingularMatrixError, match=r"at node PART-1\.9, dof 2"):
        solver.factorise(data)


def bricks(n: int, kind: str):
    """n x n x n eight-node elements with four unknowns a node, the first of which nothing holds.

    'definite'; 'multipliers': the fourth unknowns have no diagonal entries; 'unsymmetric': so is the element matrix.
    """
    rng = np.random.default_rng(1)
    node = np.arange((n + 1) ** 3).reshape((n + 1,) * 3)
    corners = [node[i : n + i, j : n + j, k : n + k].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    at = (4 * np.stack(corners, axis=1)[:, :, None] + np.arange(4)).reshape(-1, 32)
    half = rng.standard_normal((32, 32))
    element = half @ half.T / 32
    if kind == "multipliers":
        element[3::4, 3::4] = 0.0
    elif kind == "unsymmetric":
        element += rng.standard_normal((32, 32))
    free = np.zeros(32)
    free[::4] = 8**-0.5
    without = np.eye(32) - np.outer(free, free)
    element = without @ element @ without
    places = np.repeat(at, 32, axis=1).ravel(), np.tile(at, 32).ravel()
    values = np.broadcast_to(element, (len(at), 32, 32)).ravel()
    matrix = sparse.coo_array((values, places), shape=(4 * node.size,) * 2).tocsr()
    matrix.sort_indices()
    return matrix


def test_examination_fills_no_more_where_pivots_leave_the_diagonal(monkeypatch) -> None:
    """Lagrange multipliers and unsymmetric elements in three dimensions, where fill is time: minutes of a deck."""
    fill = []

    def counted(*given, **options):
        factors = splu(*given, **options)
        fill.append(factors.nnz)
        return factors

    monkeypatch.setattr(singular, "splu", counted)
    for kind in ("definite", "multipliers", "unsymmetric"):
        unknown = singular.free_unknown(bricks(10, kind))
        assert unknown is not None
        assert unknown % 4 == 0
    assert max(fill) < 1.5 * fill[0]


def test_nan_is_not_called_singular() -> None:
    """A diverging iteration is the nonlinear solver's business."""
    matrix, coordinates = clamped(4, 1)
    solver = solver_for("band", matrix, coordinates)
    solver.factorise(np.full(matrix.nnz, np.nan))
    assert np.isnan(solver.solve(np.ones(matrix.shape[0]))).any()


def test_numbering_along_the_beam_is_narrower_than_cuthill_mckee() -> None:
    matrix, coordinates = clamped(40, 4)
    indptr, indices = matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)
    nodes = np.random.default_rng(0).permutation(matrix.shape[0] // 2)
    shuffle = (2 * nodes[:, None] + np.arange(2)).ravel()
    mixed = sparse.csr_array(matrix[shuffle][:, shuffle])
    mixed.sort_indices()
    ordering = narrowest(Pattern(mixed.indptr, mixed.indices, coordinates[shuffle]))
    assert ordering.method == "sorted along direction 1"
    # a column of 10 nodes, and an entry reaches one node beyond the next column: 2 (10 + 1) + 1
    assert ordering.width == 23
    assert sorted(ordering.position) == list(range(matrix.shape[0]))
    without = narrowest(Pattern(indptr, indices))
    assert without.method == "reverse Cuthill-McKee"
    assert without.width > 23


def test_auto_takes_the_band_solver_on_a_beam() -> None:
    matrix, coordinates = clamped(100, 4)
    solver = solver_for("auto", matrix, coordinates)
    assert solver.name == "band"
    assert solver.reason == f"half bandwidth 23 of {matrix.shape[0]} unknowns, sorted along direction 1"


def test_auto_takes_a_sparse_solver_on_a_square() -> None:
    matrix, coordinates = clamped(100, 50)
    solver = solver_for("auto", matrix, coordinates)
    assert solver.name == next(name for name in INSTALLED if name != "band")
    assert "too wide" in solver.reason


def test_auto_takes_a_sparse_solver_where_the_band_would_fill_the_memory(monkeypatch) -> None:
    from uel.solver.linear import choice  # noqa: PLC0415

    matrix, coordinates = clamped(100, 4)
    storage = 8 * matrix.shape[0] * (3 * 23 + 1)
    monkeypatch.setattr(choice, "LARGEST_BAND", storage)
    assert solver_for("auto", matrix, coordinates).name == "band"
    monkeypatch.setattr(choice, "LARGEST_BAND", storage - 1)
    assert solver_for("auto", matrix, coordinates).name != "band"


@pytest.mark.parametrize(("only", "slow", "advised"), [("superlu", 1, True), ("superlu", 10**9, False)])
def test_slow_solver_advises_a_faster_one(run_deck, monkeypatch, only, slow, advised) -> None:
    """A warning of the run, which the terminal shows too."""
    from uel.output.outcome import ending  # noqa: PLC0415
    from uel.solver.linear import choice  # noqa: PLC0415

    monkeypatch.setattr(choice, "SLOW", slow)
    monkeypatch.setattr(choice, "_obstacle", lambda solver: "" if solver.name == only else "not installed")
    monkeypatch.setattr(choice, "_band_is_quicker", lambda *_: False)
    nodes = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    text = "*NODE\n" + "".join(f"{k}, {x}., {y}., {z}.\n" for k, (x, y, z) in enumerate(nodes, start=1))
    text += "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 4, 3, 5, 6, 8, 7\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n3, 3\n"
    result = run_deck(f"{text}*CLOAD\n8, 1, 1.\n5, 1, -1.\n*END STEP\n")
    advice = "pardiso takes a third of the time of superlu for 18 unknowns: pip install pypardiso"
    assert (advice in result.warnings) == advised
    assert (f"warning: {advice}" in ending(result)) == advised


def test_named_solver_is_taken_and_unknown_names_are_refused() -> None:
    matrix, coordinates = clamped(4, 1)
    assert solver_for("superlu", matrix, coordinates).name == "superlu"
    with pytest.raises(
        UelError, match="unknown linear solver 'lapack'; expected one of auto, band, pardiso, mumps, superlu"
    ):
        solver_for("lapack", matrix, coordinates)


class DenseSolver(LinearSolver):
    """LAPACK's general solver: what CONTRIBUTING says of adding a linear solver, done once."""

    name = "dense"

    def _factorise(self, data):
        self._factors = lu_factor(self.pattern.matrix(data).toarray())
        return float(np.abs(np.diag(self._factors[0])).min())

    def _solve(self, rhs):
        return lu_solve(self._factors, rhs)


def test_solver_of_its_own_takes_one_entry(monkeypatch) -> None:
    monkeypatch.setitem(SOLVERS, DenseSolver.name, DenseSolver)
    matrix, coordinates = clamped(4, 1)
    rhs = np.linspace(-1.0, 2.0, matrix.shape[0])
    solver = solver_for("dense", matrix, coordinates)
    solver.factorise(matrix.data)
    np.testing.assert_allclose(solver.solve(rhs), np.linalg.solve(matrix.toarray(), rhs), rtol=1e-9)
    row = available()[-1]
    assert (row.name, row.installed) == ("dense", True)
    assert row.note == "auto, wider models without pardiso and mumps and superlu"
    with pytest.raises(UelError, match="expected one of auto, band, pardiso, mumps, superlu, dense"):
        solver_for("lapack", matrix, coordinates)


SIZES = [(400, 2), (300, 4)]
"""Columns and rows of beams of which a few columns are a small part."""


def softened(matrix, coordinates, columns: tuple[float, float], *, kind: str = "unsymmetric"):
    """Values of the matrix, changed where both unknowns have an abscissa in an interval, and the changed entries."""
    inside = (coordinates[:, 0] >= columns[0]) & (coordinates[:, 0] <= columns[1])
    row = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    changed = inside[row] & inside[matrix.indices]
    values = matrix.data.copy()
    if kind == "unsymmetric":
        values[changed] *= 1 + 0.2 * np.random.default_rng(8).random(np.count_nonzero(changed))
    elif kind == "indefinite":
        values[changed] *= -1.5
    else:
        values[changed] *= 0.5
    return values


def backward_error(matrix, data, solution, rhs) -> float:
    """Largest residual over the sum of the terms of its row (Oettli and Prager)."""
    changed = sparse.csr_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)
    return float((np.abs(rhs - changed @ solution) / (abs(changed) @ np.abs(solution) + np.abs(rhs))).max())


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("kind", ["symmetric", "unsymmetric", "indefinite"])
def test_matrix_that_changes_in_a_few_columns(name, size, kind) -> None:
    """A zone moves along a beam, jumps to either end and back, and grows over the whole beam."""
    matrix, coordinates = clamped(*size)
    rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
    solver = solver_for(name, matrix, coordinates)
    solver.factorise(matrix.data)
    length = 0.5 * size[0]
    zones = [(0.5 * length + k, 0.5 * length + k + 2) for k in range(8)]
    zones += [(0.0, 2.0), (length - 2.0, length), (0.3 * length, 0.3 * length + 1.0), (0.0, length), (5.0, 7.0)]
    for zone in zones:
        data = softened(matrix, coordinates, zone, kind=kind)
        solver.factorise(data)
        # rounding of an elimination in blocks; the norms of the parts of a beam are alike
        assert backward_error(matrix, data, solver.solve(rhs), rhs) < 1e-10
    assert solver.effort.factorisations == 1 + len(zones)
    assert solver.effort.refused == 0
    if name in ("band", "pardiso"):
        assert solver.effort.in_part >= 8


@pytest.mark.parametrize("size", SIZES)
def test_cut_band_equals_the_whole_one(size) -> None:
    """To rounding: the condition number of the beam is 1e8, and its solutions are compared, not their residuals."""
    matrix, coordinates = clamped(*size)
    rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
    cut, whole = solver_for("band", matrix, coordinates), solver_for("band", matrix, coordinates)
    cut.factorise(matrix.data)
    for middle in np.linspace(0.0, 0.5 * size[0], 12):
        data = softened(matrix, coordinates, (middle - 1.0, middle + 1.0))
        cut.factorise(data)
        assert cut._cut is not None
        whole._regular = False
        whole.factorise(data)
        assert whole._cut is None
        expected = whole.solve(rhs)
        np.testing.assert_allclose(cut.solve(rhs), expected, rtol=0, atol=1e-7 * np.abs(expected).max())


def test_cut_stays_while_the_changes_do() -> None:
    matrix, coordinates = clamped(400, 2)
    solver = solver_for("band", matrix, coordinates)
    solver.factorise(matrix.data)
    cuts = []
    for start in (100.0, 100.5, 101.0, 180.0):
        solver.factorise(softened(matrix, coordinates, (start, start + 1.0)))
        cuts.append(solver._cut)
    assert cuts[0] is cuts[1] is cuts[2]
    # the one back to the intact state at 101 and on to the softened one at 180 is too wide to be cut out
    assert cuts[3] is not cuts[2]


def test_band_whose_end_is_singular_is_not_cut() -> None:
    """A chain without diagonal entries: regular if its length is even, singular if it is odd."""
    n = 400
    rows = [[j for j in (i - 1, i, i + 1) if 0 <= j < n] for i in range(n)]
    indptr = np.concatenate([[0], np.cumsum([len(row) for row in rows])]).astype(np.int32)
    indices = np.concatenate(rows).astype(np.int32)
    data = np.where(np.repeat(np.arange(n), np.diff(indptr)) == indices, 0.0, 1.0)
    solver = choose("band", indptr, indices, coordinates=np.column_stack([np.arange(n), np.zeros((n, 2))]))
    solver.factorise(data)
    rhs = np.random.default_rng(0).normal(size=n)
    # a margin of 10 unknowns: with the first of these the left end has 189
    for place in (200, 201, 202):
        changed = data.copy()
        changed[indptr[place]] = 2.0
        solver.factorise(changed)
        full = sparse.csr_array((changed, indices, indptr), shape=(n, n))
        np.testing.assert_allclose(full @ solver.solve(rhs), rhs, atol=1e-10)
    assert (solver.effort.factorisations, solver.effort.in_part) == (4, 0)


class Inaccurate(LinearSolver):
    """Takes the old factors for good where the matrix changes."""

    name = "inaccurate"

    def _factorise(self, data):
        self._factors = lu_factor(self.pattern.matrix(data).toarray())
        return float(np.abs(np.diag(self._factors[0])).min())

    def _update(self, data, changed):
        self.effort.in_part += 1
        self._unverified = True
        return self._pivot

    def _solve(self, rhs):
        return lu_solve(self._factors, rhs)


def test_factors_that_are_not_accurate_are_refused() -> None:
    """And from then on every matrix is factorised in full."""
    matrix, _ = clamped(6, 1)
    rhs = np.linspace(-1.0, 2.0, matrix.shape[0])
    solver = Inaccurate(Pattern(matrix.indptr, matrix.indices))
    for factor in (1.0, 1.0 + 1e-8, 3.0):
        data = matrix.data.copy()
        data[:20] *= factor
        solver.factorise(data)
        assert backward_error(matrix, data, solver.solve(rhs), rhs) < 1e-13
    assert (solver.effort.refused, solver.effort.in_part, solver.effort.factorisations) == (1, 1, 3)


@pytest.fixture
def kept_factors(monkeypatch):
    """SuperLU with the factors of a beam, which it keeps though the beam is small: (solver, matrix, coordinates)."""
    monkeypatch.setattr(superlu, "FILL_PER_ITERATION", 1)
    monkeypatch.setattr(superlu, "LARGEST_SHARE", 0.3)
    matrix, coordinates = clamped(60, 3)
    solver = solver_for("superlu", matrix, coordinates)
    solver.factorise(matrix.data)
    return solver, matrix, coordinates


def test_last_factors_precondition_gmres(kept_factors) -> None:
    solver, matrix, coordinates = kept_factors
    rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
    factors = solver._lu
    for zone, kind in (((10.0, 11.0), "symmetric"), ((11.0, 12.0), "unsymmetric"), ((0.0, 1.0), "unsymmetric")):
        data = softened(matrix, coordinates, zone, kind=kind)
        solver.factorise(data)
        for _ in range(2):
            assert backward_error(matrix, data, solver.solve(rhs), rhs) < 1e-10
        assert solver._lu is factors
    assert (solver.effort.factorisations, solver.effort.in_part, solver.effort.refused) == (4, 3, 0)


def test_matrix_with_many_changes_is_factorised_at_once(kept_factors) -> None:
    solver, matrix, coordinates = kept_factors
    data = softened(matrix, coordinates, (0.0, 30.0))
    solver.factorise(data)
    rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
    assert backward_error(matrix, data, solver.solve(rhs), rhs) < 1e-10
    assert (solver.effort.in_part, solver.effort.refused) == (0, 0)


def test_gmres_that_does_not_converge_ends_in_a_factorisation(kept_factors) -> None:
    """The changes have more than eight eigenvalues far from each other."""
    solver, matrix, coordinates = kept_factors
    solver._most = superlu.FEWEST
    rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
    data = softened(matrix, coordinates, (8.0, 11.0))
    inside = data != matrix.data
    data[inside] *= np.random.default_rng(1).uniform(0.1, 10.0, np.count_nonzero(inside))
    solver.factorise(data)
    assert backward_error(matrix, data, solver.solve(rhs), rhs) < 1e-10
    assert (solver.effort.in_part, solver.effort.refused) == (1, 1)


def test_matrix_that_turns_singular_under_gmres_is_named(kept_factors) -> None:
    """An unknown loses all of its stiffness."""
    solver, matrix, _ = kept_factors
    row = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    data = np.where((row == 9) | (matrix.indices == 9), 0.0, matrix.data)
    solver.factorise(data)
    assert solver.effort.in_part == 1
    with pytest.raises(SingularMatrixError, match=r"of unknown 9, dof 0"):
        solver.solve(np.ones(matrix.shape[0]))


def test_symmetry_to_rounding() -> None:
    matrix, _ = clamped(12, 2)
    pattern = Pattern(matrix.indptr, matrix.indices)
    assert pattern.is_symmetric(matrix.data)
    entry = int(np.flatnonzero(pattern.rows != pattern.indices)[7])
    size = np.sqrt(np.prod(matrix.diagonal()[[pattern.rows[entry], pattern.indices[entry]]]))
    for difference, symmetric in ((1e-15, True), (1e-12, False)):
        data = matrix.data.copy()
        data[entry] += difference * size
        assert pattern.is_symmetric(data) == symmetric
        assert pattern.is_symmetric(data, np.array([entry])) == symmetric
        assert pattern.is_symmetric(data, np.array([pattern.transposed[entry]])) == symmetric
        assert pattern.is_symmetric(data, np.array([1000, 1001]))


def takes_symmetric(solver) -> bool:
    """Whether a solver takes its matrices as symmetric ones now."""
    return bool(solver._symmetric if solver.name == "mumps" else solver._type is SYMMETRIC)


@pytest.mark.parametrize("name", [name for name in ("pardiso", "mumps") if name in INSTALLED])
def test_symmetric_solver_never_takes_an_unsymmetric_matrix(name) -> None:
    """Whether all of it turns unsymmetric, or one entry in the upper or in the lower triangle."""
    for change in ("all", "upper", "lower"):
        matrix, coordinates = clamped(100, 4)
        pattern = Pattern(matrix.indptr, matrix.indices)
        rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
        solver = solver_for(name, matrix, coordinates)
        solver.factorise(matrix.data)
        solver.solve(rhs)
        assert takes_symmetric(solver)
        data = matrix.data.copy()
        if change == "all":
            data *= 1 + 0.1 * np.random.default_rng(3).random(matrix.nnz)
        else:
            above = pattern.indices > pattern.rows
            data[np.flatnonzero(above if change == "upper" else above[pattern.transposed])[50]] += 1e-6 * data.max()
        solver.factorise(data)
        assert not takes_symmetric(solver)
        assert backward_error(matrix, data, solver.solve(rhs), rhs) < 1e-10
        # a symmetric one after it does not change the solver back: the analysis would be repeated
        solver.factorise(matrix.data)
        assert not takes_symmetric(solver)
        assert backward_error(matrix, matrix.data, solver.solve(rhs), rhs) < 1e-10


def test_pardiso_without_memory_is_no_singular_matrix() -> None:
    """-2 is oneMKL's error where memory is not to be had, -4 that of a zero pivot."""
    matrix, _ = clamped(4, 2)
    pattern = Pattern(matrix.indptr, matrix.indices)
    handle = SimpleNamespace(mtype=11, pt=np.zeros(64, dtype=np.int64), iparm=np.zeros(64, dtype=np.int32))
    handle.perm = np.zeros(0, dtype=np.int32)
    for code, error in ((-2, MemoryError), (-4, PardisoError)):
        handle._mkl_pardiso = lambda *words, code=code: setattr(words[-1], "value", code)
        with pytest.raises(error):
            call(handle, FACTORISE, pattern, matrix.data, np.zeros(pattern.size))


@pytest.mark.parametrize(("code", "error"), [(-13, MemoryError), (-10, SingularMatrixError)])
def test_mumps_without_memory_is_no_singular_matrix(code, error, monkeypatch) -> None:
    """INFOG(1) is -13 where memory is not to be had, -10 of a singular matrix; the next matrix is taken as usual."""

    class FakeError(RuntimeError):
        def __init__(self) -> None:
            self.error = code

    class Context:
        wrong = True

        def set_matrix(self, matrix, *, symmetric) -> None:
            self.data = (sparse.triu(matrix) if symmetric else matrix.tocoo()).data

        def analyze(self) -> None:
            pass

        def factor(self, *, reuse_analysis) -> None:
            assert reuse_analysis
            if Context.wrong:
                raise FakeError

        def solve(self, rhs):
            return rhs

    monkeypatch.setitem(sys.modules, "mumps", SimpleNamespace(Context=Context, MUMPSError=FakeError))
    matrix, _ = clamped(4, 2)
    solver = MumpsSolver(Pattern(matrix.indptr, matrix.indices))
    with pytest.raises(error):
        solver.factorise(matrix.data)
    if error is SingularMatrixError:
        solver.factorise(np.full_like(matrix.data, np.nan))
        assert np.isnan(solver.solve(np.ones(matrix.shape[0]))).all()
    Context.wrong = False
    solver.factorise(matrix.data)
    assert solver.solve(np.ones(matrix.shape[0])).tolist() == [1.0] * matrix.shape[0]


CUBE = """\
import numpy as np
from scipy import sparse
from uel.solver.linear import choose
one = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(24, 24))
eye = sparse.eye_array(24)
cube = sum(sparse.kron(sparse.kron(a, b), c) for a, b, c in ((one, eye, eye), (eye, one, eye), (eye, eye, one)))
matrix = sparse.csr_array(cube)
matrix.sort_indices()
rhs = np.random.default_rng(4).normal(size=matrix.shape[0])
for unsymmetric in (0.0, 1e-3):
    data = matrix.data * (1.0 + unsymmetric * np.random.default_rng(3).random(matrix.nnz))
    solver = choose("pardiso", matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32))
    for scale in (1.0, 0.5, 1.0):
        changed = data.copy()
        changed[0] *= scale
        solver.factorise(changed)
        x = solver.solve(rhs)
        found = sparse.csr_array((changed, matrix.indices, matrix.indptr)) @ x
        assert np.abs(found - rhs).max() < 1e-10 * np.abs(rhs).max()
    print(solver.effort.in_part)
"""


@pytest.mark.skipif("pardiso" not in INSTALLED, reason="pypardiso is not installed")
@pytest.mark.parametrize(("threads", "in_part"), [("", 2), ("1", 2), ("2", 0)])
def test_threads_of_mkl(threads: str, in_part: int) -> None:
    """Beside the OpenMP of the host the renewable factorisation ends the process, or its factors are wrong."""
    variables = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    variables |= {"MKL_NUM_THREADS": threads} if threads else {}
    words = [sys.executable, "-c", CUBE]
    result = subprocess.run(words, env=variables, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stdout.split()) == (0, [str(in_part)] * 2), result.stderr


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize("rate", [1e5, 1e3])
def test_saddle_point(name, rate) -> None:
    """Zeros on the diagonal, where pivots have to leave it; then one of the changes that a few entries make."""
    matrix, coordinates = clamped(30, 3)
    n = matrix.shape[0]
    links = sparse.coo_array((np.tile([rate, -rate], 10), (np.repeat(np.arange(10), 2), np.arange(40, 60))), (10, n))
    saddle = sparse.csr_array(sparse.block_array([[matrix, links.T], [links, None]]))
    # the diagonal is in the pattern, as in an assembled system
    saddle = sparse.csr_array(saddle + sparse.diags_array(np.where(np.arange(n + 10) < n, 0.0, 1.0)))
    saddle.sort_indices()
    data = saddle.data.copy()
    row = np.repeat(np.arange(n + 10), np.diff(saddle.indptr))
    data[(row == saddle.indices) & (row >= n)] = 0.0
    rhs = np.random.default_rng(4).normal(size=n + 10)
    solver = solver_for(name, saddle, np.vstack([coordinates, coordinates[40:50]]))
    solver.factorise(data)
    assert backward_error(saddle, data, solver.solve(rhs), rhs) < 1e-10
    data[:20] *= 1.1
    solver.factorise(data)
    assert backward_error(saddle, data, solver.solve(rhs), rhs) < 1e-10


@pytest.mark.filterwarnings("ignore::scipy.linalg.LinAlgWarning")
def test_the_same_matrix_is_factorised_once(monkeypatch) -> None:
    """An elastic model has it in every increment."""
    counted = []
    ordinary = DenseSolver._factorise
    monkeypatch.setattr(DenseSolver, "_factorise", lambda self, data: counted.append(1) or ordinary(self, data))
    matrix = sparse.csr_array(np.array([[4.0, 1.0], [1.0, 3.0]]))
    solver = DenseSolver(Pattern(matrix.indptr, matrix.indices))
    for factor, count in ((1.0, 1), (1.0, 1), (2.0, 2), (1.0, 3)):
        solver.factorise(factor * matrix.data)
        assert len(counted) == count
        np.testing.assert_allclose(factor * matrix @ solver.solve(np.array([1.0, 2.0])), [1.0, 2.0], rtol=1e-14)
    # what a caller writes into the array is a new matrix, unless it writes the same values
    values = matrix.data.copy()
    solver.factorise(values)
    values *= 1.0
    solver.factorise(values)
    assert len(counted) == 3
    values *= 2.0
    solver.factorise(values)
    assert len(counted) == 4
    np.testing.assert_allclose(2.0 * matrix @ solver.solve(np.array([1.0, 2.0])), [1.0, 2.0], rtol=1e-14)
    with pytest.raises(SingularMatrixError):
        solver.factorise(0.0 * values)
    with pytest.raises(SingularMatrixError):
        solver.factorise(0.0 * values)


def test_solver_that_is_not_installed_is_refused(monkeypatch) -> None:
    from uel.solver.linear import choice  # noqa: PLC0415

    monkeypatch.setattr(
        choice, "_obstacle", lambda solver: f"{solver.distribution} is not installed" * (solver.name == "mumps")
    )
    matrix, coordinates = clamped(4, 1)
    with pytest.raises(UelError, match="linear solver 'mumps' cannot be used: python-mumps is not installed"):
        solver_for("mumps", matrix, coordinates)
    row = next(row for row in choice.available() if row.name == "mumps")
    assert not row.installed and "python-mumps is not installed" in row.note


def test_table_of_solvers() -> None:
    rows = {row.name: row for row in available()}
    assert list(rows) == ["band", "pardiso", "mumps", "superlu"]
    assert rows["band"].installed and rows["superlu"].installed
    assert rows["band"].version == rows["superlu"].version != ""
