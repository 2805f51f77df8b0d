# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Chains of springs, compiled from springs.f, and their runs."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from uel import usersub
from uel.assembly import system_of
from uel.errors import Source
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Equation, Model
from uel.model.procedures import Static
from uel.model.properties import UserElement, UserProperty
from uel.model.records import AttemptAbandoned, IncrementDone, IterationDone
from uel.model.steps import Boundary, InitialValue, Load, Step
from uel.procedures import run_steps
from uel.solver.options import SolverOptions

HERE = Path(__file__).parent


def source(line=1):
    return Source("springs.inp", line)


def fix(node, value=0.0, amplitude=None, dof=1):
    """*BOUNDARY of one node (from 0)."""
    return Boundary(np.array([node]), dof, value, amplitude, source(node + 1))


def force(node, value, amplitude=None, dof=1):
    """*CLOAD of one node (from 0)."""
    return Load(np.array([node]), dof, value, amplitude, source(node + 1))


def step(number=1, static=None, **options):
    return Step(number, f"Step-{number}", static or Static(), source(100 * number), **options)


def initial(node, value, dof=1):
    """*INITIAL CONDITIONS of one node (from 0)."""
    return InitialValue(np.array([node]), dof, value, source(60))


def equation(*terms):
    """*EQUATION of (node from 0, coefficient) terms in dof 1."""
    return Equation(tuple((node, 1, coefficient) for node, coefficient in terms), source(50))


@dataclass
class Run:
    """Records of a run, the error that ended it, and what the springs printed."""

    records: list
    error: Exception | None
    printed: list

    def of(self, kind):
        return [record for record in self.records if isinstance(record, kind)]

    @property
    def increments(self):
        return self.of(IncrementDone)

    @property
    def abandoned(self):
        return self.of(AttemptAbandoned)

    @property
    def last(self):
        return self.increments[-1].solution

    def iterations(self):
        """Checks of the one field, increment by increment of converged attempts."""
        blocks, current = [], []
        for record in self.records:
            if isinstance(record, IterationDone):
                current.append(record.checks[0])
            elif isinstance(record, IncrementDone):
                blocks.append(current)
                current = []
            elif isinstance(record, AttemptAbandoned):
                current = []
        return blocks


class Bench:
    """Builds steps and runs springs, or other two-node elements of one unknown per node, through them."""

    fix, force, step = staticmethod(fix), staticmethod(force), staticmethod(step)
    equation, initial = staticmethod(equation), staticmethod(initial)

    def __init__(self, folder, user="springs.f", variables=1, dof=1):
        self.folder, self.user, self.variables, self.dof = folder, user, variables, dof

    def run(self, springs, steps, *, boundaries=(), equations=(), velocities=(), temperatures=(), log=False, **options):
        """springs: (node, node, type, properties) each; the nodes are numbered from 0 here. options: of the solver."""
        nodes = 1 + max(max(spring[:2]) for spring in springs)
        mesh = Mesh(np.arange(1, nodes + 1), np.zeros((nodes, 3)), ("",) * nodes)
        groups = tuple(group(k + 1, *spring, log, self.variables, self.dof) for k, spring in enumerate(springs))
        model = Model(
            Path("springs.inp"),
            "",
            mesh,
            groups,
            tuple(steps),
            boundaries=tuple(boundaries),
            equations=tuple(equations),
            initial_velocities=tuple(velocities),
            initial_temperatures=tuple(temperatures),
        )
        library = usersub.load(HERE / self.user, job="job", output_dir=self.folder)
        records, error = [], None
        try:
            system = system_of(model, library)
            for record in run_steps(system, model, library, SolverOptions(**options)):
                records.append(record)
        except Exception as caught:
            error = caught
        printed = [line.split() for message in library.messages() for line in message.text.splitlines()]
        library.close()
        return Run(records, error, printed)


@pytest.fixture
def bench(tmp_path):
    return Bench(tmp_path)


def group(label, first, second, jtype, properties, log, variables, dof):
    definition = UserElement(
        jtype,
        2,
        ((0, dof), (1, dof)),
        source(),
        properties=len(properties),
        integer_properties=1,
        variables=variables,
        unsymmetric=True,
    )
    section = UserProperty("ALL", source(), np.array(properties, dtype=float), np.array([int(log)], dtype=np.int64))
    return ElementGroup(f"U{jtype}", np.array([label]), np.array([[first, second]]), "", section, definition, source())
