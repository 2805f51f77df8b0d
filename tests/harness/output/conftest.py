# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A model made by hand: two continuum quads, one above the other, with an interface element between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.errors import Source
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.procedures import Static
from uel.model.properties import UserElement, UserProperty
from uel.model.records import (
    AttemptStarted,
    Convergence,
    ElementState,
    FieldCheck,
    IncrementDone,
    IterationDone,
    Largest,
    PointVariables,
    Record,
    Solution,
    StepDone,
    StepStarted,
)
from uel.model.steps import NodeRequest, OutputRequests, Step

SOURCE = Source("deck.inp", 1)
DECK = """\
*HEADING
two quads and an interface
*NODE
1, 0., 0.
"""
CONTINUUM = PointVariables("continuum", ("E11", "S11", "S22", "S12"), 4, outline=(0, 1, 2, 3))
INTERFACE = PointVariables("interface", ("X", "Y", "SEPN", "SEPT", "TN", "TT", "DAMAGE"), 2)
TIMES = (0.1, 0.25, 0.5, 1.0)


def quad(number: int, variables: int) -> UserElement:
    dofs = tuple((node, dof) for node in range(4) for dof in (1, 2))
    return UserElement(number, 4, dofs, SOURCE, coordinates=2, properties=3, variables=variables)


@pytest.fixture
def model(tmp_path: Path) -> Model:
    """Nodes 1-4 the lower quad, 5-8 the upper; 3 and 6, 4 and 5 coincide."""
    deck = tmp_path / "deck.inp"
    deck.write_text(DECK)
    corners = [(0, 0), (2, 0), (2, 1), (0, 1), (0, 1), (2, 1), (2, 2), (0, 2)]
    mesh = Mesh(np.arange(1, 9), np.array([(x, y, 0.0) for x, y in corners]), ("",) * 8)
    quads, interface = np.array([[0, 1, 2, 3], [4, 5, 6, 7]]), np.array([[3, 2, 5, 4]])
    groups = (
        ElementGroup("U1", np.array([1, 2]), quads, "", UserProperty("ALL", SOURCE), quad(1, 16), SOURCE),
        ElementGroup("U2", np.array([11]), interface, "", UserProperty("CZ", SOURCE), quad(2, 14), SOURCE),
    )
    requests = OutputRequests(
        history_nodes=(
            NodeRequest("LOAD", np.array([6]), ("U2", "RF2")),
            NodeRequest("BASE", np.array([0, 1]), ("RF",)),
        ),
        history_energies=("ALLSE", "ALLWK"),
    )
    step = Step(1, "Step-1", Static(0.1, 1.0, 1e-5, 1.0), SOURCE, output=requests, title="Opening")
    return Model(deck, "two quads and an interface", mesh, groups, (step,))


def solution(time: float) -> Solution:
    """U2 = y * time, RF2 = -+ time at the lower nodes; SVARS are 100 * element number + position, times the time."""
    node = np.repeat(np.arange(8), 2)
    dof = np.tile([1, 2], 8)
    height = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0])
    displacement = np.where(dof == 2, height[node] * time, 0.0)
    reaction = np.where((dof == 2) & (node < 2), -time, 0.0)
    continuum = (np.array([[100.0], [200.0]]) + np.arange(16)) * time
    interface = (np.array([[1100.0]]) + np.arange(14)) * time
    return Solution(
        node,
        dof,
        displacement,
        reaction,
        np.zeros(16),
        {"ALLSE": time**2, "ALLWK": 2 * time**2},
        (
            ElementState(0, continuum, np.zeros((2, 8)), CONTINUUM),
            ElementState(1, interface, np.zeros((1, 8)), INTERFACE),
        ),
    )


def check(verdict: Convergence = Convergence.CONVERGED) -> FieldCheck:
    return FieldCheck(
        "force", 12.2, 6.33, Largest(-749.0, 6, 1), Largest(-5.576e-3, 2, 2), Largest(9.15e-6, 3, 2), verdict
    )


def increments(
    model: Model, *, times: tuple[float, ...] = TIMES, step: int = 1, start: float = 0.0
) -> Iterator[Record]:
    """Records of a step that converges in two iterations in each increment."""
    yield StepStarted(step)
    before = 0.0
    for number, time in enumerate(times, 1):
        yield AttemptStarted(step, number, 1, before, start + before, time - before)
        yield IterationDone(1, (check(Convergence.NOT_ACHIEVED),))
        yield IterationDone(2, (check(),))
        yield IncrementDone(step, number, 1, 2, time, start + time, time - before, solution(time))
        before = time
    yield StepDone(step, len(times), 0, 2 * len(times))


@pytest.fixture
def records() -> Callable[..., Iterator[Record]]:
    return increments


@pytest.fixture
def with_requests(model: Model) -> Callable[..., Model]:
    """The model with other output requests in its step."""

    def changed(**requests: object) -> Model:
        step = model.steps[0]
        return replace(model, steps=(replace(step, output=replace(step.output, **requests)),))  # type: ignore[arg-type]

    return changed
