# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reduction against dense T^T K T, and the messages of over-constrained models."""

import numpy as np
import pytest

from uel.assembly import Constraints, System
from uel.errors import DeckError, Source
from uel.model.model import Equation


def equation(line: int, *terms: tuple[int, int, float]) -> Equation:
    return Equation(terms, Source("job.inp", line))


def dense_maps(constraints, system):
    """T and P column by column through expand."""
    zero_q, zero_p = np.zeros(len(constraints.free)), np.zeros(len(constraints.prescribed))
    t = [constraints.expand(row, zero_p) for row in np.eye(len(zero_q))]
    p = [constraints.expand(zero_q, row) for row in np.eye(len(zero_p))]
    n = len(system)
    return np.array(t).reshape(-1, n).T, np.array(p).reshape(-1, n).T


def check_reduction(system, constraints, call) -> None:
    rng = np.random.default_rng(2)
    evaluation = system.evaluate(call, rng.normal(size=len(system)), np.zeros(len(system)))
    full = system.matrix(evaluation.data).toarray()
    t, p = dense_maps(constraints, system)
    reduced = np.zeros((t.shape[1], t.shape[1]))
    rows = np.repeat(np.arange(len(reduced)), np.diff(constraints.reduced_indptr))
    for _ in range(2):
        reduced[rows, constraints.reduced_indices] = constraints.reduce(evaluation.data)
        np.testing.assert_allclose(reduced, t.T @ full @ t, rtol=0, atol=1e-12)
    keys = rows * len(reduced) + constraints.reduced_indices
    assert (np.diff(keys) > 0).all()
    vector = rng.normal(size=len(system))
    np.testing.assert_allclose(constraints.reduce_vector(vector), t.T @ vector, atol=1e-13)
    dp = rng.normal(size=p.shape[1])
    np.testing.assert_allclose(constraints.prescribed_residual(evaluation.data, dp), full @ p @ dp, atol=1e-12)
    reactions = constraints.reactions(vector)
    np.testing.assert_allclose(reactions[constraints.prescribed], -p.T @ vector, atol=1e-13)
    assert np.count_nonzero(reactions) == len(constraints.prescribed)


@pytest.mark.parametrize("prescribed", [[], [3, 0, 8], list(range(13))], ids=["none", "some", "all"])
def test_prescribed_unknowns(two_blocks, call, prescribed) -> None:
    system = System(*two_blocks)
    constraints = Constraints(system, np.array(prescribed, dtype=np.int64))
    t, p = dense_maps(constraints, system)
    assert np.array_equal(np.flatnonzero(p.T) % len(system), prescribed)
    assert t.sum() == len(system) - len(prescribed)
    check_reduction(system, constraints, call)


def test_equations_with_a_chain_and_a_prescribed_term(two_blocks, call) -> None:
    mesh, blocks = two_blocks
    equations = [
        equation(1, (0, 1, 2.0), (1, 1, -1.0), (1, 2, 3.0)),  # u0 = 0.5 u2 - 1.5 u3
        equation(2, (1, 2, -1.0), (7, 1, 1.0), (5, 1, 0.5), (5, 1, 0.5)),  # u3 = u13 + u10, u10 prescribed
    ]
    system = System(mesh, blocks, equations)
    prescribed = system.dofs.find(np.array([5, 4]), 1)
    constraints = Constraints(system, prescribed, equations)
    t, p = dense_maps(constraints, system)
    u = t @ np.arange(1.0, t.shape[1] + 1) + p @ [0.25, 4.0]
    assert u[10] == 0.25 and u[8] == 4.0
    assert u[3] == u[13] + 0.25
    assert u[0] == 0.5 * u[2] - 1.5 * u[3]
    check_reduction(system, constraints, call)


@pytest.mark.parametrize("seed", range(3))
def test_first_terms_that_are_prescribed(two_blocks, call, seed) -> None:
    """Equations of several unknowns each, all of whose first ones are given: others are eliminated, and all hold."""
    mesh, blocks = two_blocks
    rng = np.random.default_rng(seed)
    others = [(1, 1), (1, 2), (7, 1), (2, 1)]
    factors = rng.normal(size=(3, 4))
    factors[1] = 2.0 * factors[0] + [0.0, 1e-3, 1e-3, 0.0]  # the first pivot of one equation is hardly one of the next
    equations = [
        equation(k + 1, (first, 1, 1.0), *((node, dof, f) for (node, dof), f in zip(others, row, strict=True)))
        for k, (first, row) in enumerate(zip((5, 4, 0), factors.tolist(), strict=True))
    ]
    system = System(mesh, blocks, equations)
    prescribed = system.dofs.find(np.array([5, 4, 0]), 1)
    constraints = Constraints(system, prescribed, equations)
    assert len(constraints.free) == len(system) - 6
    values = rng.normal(size=3)
    u = constraints.expand(rng.normal(size=len(constraints.free)), values)
    assert u[prescribed].tolist() == values.tolist()
    for own in equations:
        terms = [f * u[system.dofs.find(node, dof)] for node, dof, f in own.terms]
        assert sum(terms) == pytest.approx(0.0, abs=1e-9 * np.abs(terms).max())
    check_reduction(system, constraints, call)


def test_periodic_chain_pulled_by_a_reference_node(springs, call) -> None:
    """Springs 1, 2, 3 in a row, u_last - u_first = u_reference = 1.1: force 1.1/(1 + 1/2 + 1/3) = 0.6."""
    mesh, blocks = springs(5)
    (block,) = blocks.elements
    block.matrices, block.group = block.matrices[:3], block.group.take(np.arange(3))
    equations = [equation(9, (3, 1, 1.0), (0, 1, -1.0), (4, 1, -1.0))]
    system = System(mesh, blocks, equations)
    constraints = Constraints(system, system.dofs.find(np.array([0, 4]), 1), equations)
    zero = np.zeros(len(system))
    evaluation = system.evaluate(call, zero, zero)
    dp = np.array([0.0, 1.1])
    rows = np.repeat(np.arange(len(constraints.free)), np.diff(constraints.reduced_indptr))
    reduced = np.zeros((2, 2))
    reduced[rows, constraints.reduced_indices] = constraints.reduce(evaluation.data)
    rhs = constraints.reduce_vector(-constraints.prescribed_residual(evaluation.data, dp))
    du = constraints.expand(np.linalg.solve(reduced, rhs), dp)
    residual = system.evaluate(call, du, du).residual
    reactions = constraints.reactions(residual)
    assert reactions[4] == pytest.approx(0.6, rel=1e-14)
    assert reactions[0] == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose(du, [0.0, 0.6, 0.9, 1.1, 1.1], atol=1e-14)


def test_long_chain_of_equations(springs) -> None:
    mesh, blocks = springs(30)
    equations = [equation(k, (k, 1, 1.0), (k - 1, 1, -1.0)) for k in range(1, 30)]
    constraints = Constraints(System(mesh, blocks), np.zeros(0, dtype=np.int64), equations[::-1])
    assert constraints.free.tolist() == [0]
    assert constraints.expand(np.array([2.5]), np.zeros(0)).tolist() == [2.5] * 30


def test_matches_tells_when_to_build_again(springs) -> None:
    system = System(*springs(4))
    equations = [equation(1, (1, 1, 1.0), (2, 1, -1.0))]
    constraints = Constraints(system, np.array([3, 0]), equations)
    start = np.zeros(len(constraints.free) + len(constraints.prescribed) + len(equations))
    assert constraints.matches(np.array([3, 0]), equations, (), start)
    assert not constraints.matches(np.array([0]), equations, (), start)
    assert not constraints.matches(np.array([3, 0]), (), (), start)
    assert constraints.name_of(0) == ("30", 1)
    assert constraints.coordinates.tolist() == [[2.0, 0.0, 0.0]]


def test_prescribed_twice_is_the_callers_mistake(springs) -> None:
    with pytest.raises(ValueError, match="distinct"):
        Constraints(System(*springs(3)), np.array([1, 1]))
    with pytest.raises(ValueError, match="not negative"):
        Constraints(System(*springs(3)), np.array([-1]))


@pytest.mark.parametrize(
    ("equations", "message"),
    [
        (
            [equation(7, (1, 1, 1.0), (2, 1, -1.0)), equation(8, (1, 1, 1.0), (3, 1, -1.0))],
            r"job.inp:8: over-constrained: node 20, dof 1 .* of this constraint and of the one at job.inp:7",
        ),
        (
            [equation(7, (1, 1, 1.0), (2, 1, -1.0)), equation(8, (2, 1, 1.0), (1, 1, -2.0))],
            r"job.inp:7: over-constrained: node 20, dof 1 depends on itself through the constraint at job.inp:8",
        ),
        (
            [equation(7, (1, 1, 1.0), (2, 1, -1.0), (1, 1, -1.0))],
            r"job.inp:7: the coefficient of the first term, node 20, dof 1, is zero",
        ),
        ([equation(7, (1, 1, 1.0), (2, 2, -1.0))], r"job.inp:7: no element uses dof 2 of node 30"),
    ],
    ids=["twice", "cycle", "zero", "unused"],
)
def test_over_constrained_models_are_refused(springs, equations, message) -> None:
    system = System(*springs(4))
    with pytest.raises(DeckError, match=message):
        Constraints(system, np.array([0]), equations, {0: Source("job.inp", 3)})


def test_prescribed_values_that_constraints_give_too(springs) -> None:
    """They are no mistake while both are the same; what else the chain of constraints holds is found through it."""
    system = System(*springs(4))
    chain = [equation(7, (0, 1, 1.0), (1, 1, -1.0)), equation(8, (1, 1, 1.0), (2, 1, -2.0))]
    places = {0: Source("job.inp", 3)}
    constraints = Constraints(system, np.array([0]), chain, places)
    assert constraints.overconstraints == []
    assert constraints.free.tolist() == [3]
    assert constraints.expand(np.zeros(1), np.ones(1)).tolist() == [1.0, 1.0, 0.5, 0.0]
    constraints = Constraints(system, np.array([0, 2]), chain, places)
    assert constraints.overconstraints == [(0, Source("job.inp", 7))]
    assert constraints.free.tolist() == [3]
    constraints.refuse_contradictions(np.array([0.4, 0.4, 0.2, 0.0]), "step 1")
    message = (
        r"^job.inp:7: over-constrained: node 10, dof 1 is prescribed at job.inp:3, and .* they differ by 0.0099 of "
        r"their size \(step 1\)$"
    )
    with pytest.raises(DeckError, match=message):
        constraints.refuse_contradictions(np.array([0.408, 0.4, 0.2, 0.0]), "step 1")


@pytest.mark.parametrize(
    "equations",
    [
        [equation(7, (0, 1, 1.0), (0, 1, 1.0))],
        [equation(7, (0, 1, 1.0), (1, 1, -1.0)), equation(8, (0, 1, 2.0), (1, 1, -2.0))],
    ],
    ids=["alone", "twice"],
)
def test_constraints_of_prescribed_values_alone(springs, equations) -> None:
    constraints = Constraints(System(*springs(4)), np.array([0]), equations)
    constraints.refuse_contradictions(np.zeros(4), "step 1")
    if len(equations) == 1:
        with pytest.raises(DeckError, match=r"job.inp:7: over-constrained: node 10, dof 1 is prescribed, and"):
            constraints.refuse_contradictions(np.ones(4), "step 1")
