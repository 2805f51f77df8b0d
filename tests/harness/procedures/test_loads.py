# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed values and loads over time, as "Prescribed conditions: overview" of the Abaqus manual has them."""

from dataclasses import dataclass

import numpy as np
import pytest

from uel.errors import Source
from uel.model.amplitude import Amplitude, AmplitudeType
from uel.model.procedures import Static
from uel.model.steps import Boundary, Load, Step
from uel.procedures.loads.nodal import Boundaries, Loads, fading_forces

SOURCE = Source("loads.inp", 3)
N = 4


@dataclass
class Dofs:
    """Four unknowns: dof `dof` of nodes 0 to 3."""

    dof: int = 1

    def __len__(self):
        return N

    def find(self, nodes, dof):
        return np.where(np.asarray(dof) == self.dof, nodes, -1)


def step(**options):
    return Step(1, "", Static(1.0, options.pop("period", 2.0)), SOURCE, **options)


def curve(*points, **options):
    return Amplitude("A", AmplitudeType.TABULAR, np.array(points, dtype=float), SOURCE, **options)


def boundary(node, value, amplitude=None, dof=1, **options):
    return Boundary(np.array([node]), dof, value, amplitude, SOURCE, **options)


def load(node, value, amplitude=None):
    return Load(np.array([node]), 1, value, amplitude, SOURCE)


def history(variation, unknown, start=0.0):
    """Values at step times 0, 1, 2."""
    return [variation.at(t, start + t)[unknown] for t in (0.0, 1.0, 2.0)]


def test_a_displacement_ramps_from_where_it_is():
    displacement = np.array([0.0, 3.0, 0.0, 0.0])
    conditions = Boundaries(Dofs(), ())
    variation = conditions.start_step(step(boundaries=(boundary(1, 7.0),)), displacement)
    assert conditions.unknowns.tolist() == [1]
    assert history(variation, 1) == pytest.approx([3.0, 5.0, 7.0])


def test_a_fixed_value_stays_what_it_is():
    variation = Boundaries(Dofs(), ()).start_step(
        step(boundaries=(boundary(1, 7.0, fixed=True),)), np.array([0.0, 3.0, 0.0, 0.0])
    )
    assert history(variation, 1) == [3.0, 3.0, 3.0]


@pytest.mark.parametrize(("dof", "values"), [(1, [0.0, 2.0, 4.0]), (11, [4.0, 4.0, 4.0])])
def test_amplitude_step_is_for_all_but_displacements(dof, values):
    """*BOUNDARY of the keyword manual: displacement and rotation components always ramp."""
    conditions = Boundaries(Dofs(dof), ())
    given = step(boundaries=(boundary(1, 4.0, dof=dof),), amplitude="STEP")
    assert history(conditions.start_step(given, np.zeros(N)), 1) == values


def test_amplitudes_scale_or_are_the_value():
    triangle = ((0, 0), (1, 1), (2, 0))
    entries = (boundary(0, 5.0, curve(*triangle)), boundary(1, 5.0, curve(*triangle, absolute=True)))
    variation = Boundaries(Dofs(), ()).start_step(step(boundaries=entries), np.ones(N))
    assert history(variation, 0) == [0.0, 5.0, 0.0]
    assert history(variation, 1) == [0.0, 1.0, 0.0]


def test_a_curve_in_total_time_goes_on_and_one_in_step_time_stays_at_its_end():
    line = ((0, 0), (10, 10))
    entries = (boundary(0, 1.0, curve(*line, total_time=True)), boundary(1, 1.0, curve(*line)))
    conditions = Boundaries(Dofs(), ())
    end = conditions.start_step(step(boundaries=entries), np.zeros(N)).at(2.0, 2.0)
    following = conditions.start_step(step(), end)
    assert history(following, 0, start=2.0) == [2.0, 3.0, 4.0]
    assert history(following, 1, start=2.0) == [2.0, 2.0, 2.0]


def test_a_velocity_is_integrated_from_where_the_dof_is_and_goes_on():
    """The integral of the triangle is t^2/2 up to 1 and 1/2 + (t - 1) - (t - 1)^2/2 from there on."""
    entries = (
        boundary(0, 3.0, velocity=True),
        boundary(1, 4.0, curve((0, 0), (1, 1), (2, 0)), velocity=True),
        boundary(2, 2.0, curve((0, 0), (4, 4), total_time=True), velocity=True),
    )
    conditions = Boundaries(Dofs(), ())
    variation = conditions.start_step(step(boundaries=entries), np.ones(N))
    assert history(variation, 0) == pytest.approx([1.0, 4.0, 7.0])
    assert history(variation, 1) == pytest.approx([1.0, 3.0, 5.0])
    assert history(variation, 2) == pytest.approx([1.0, 2.0, 5.0])
    following = conditions.start_step(step(boundaries=(boundary(1, 9.0),)), variation.at(2.0, 2.0), 2.0)
    assert history(following, 0, start=2.0) == pytest.approx([7.0, 10.0, 13.0])
    assert history(following, 1, start=2.0) == pytest.approx([5.0, 7.0, 9.0])
    assert history(following, 2, start=2.0) == pytest.approx([5.0, 10.0, 17.0])
    conditions.start_step(step(new_boundary=True), np.zeros(N), 4.0)
    assert not conditions.unknowns.size


def test_mod_replaces_the_same_dof_and_keeps_the_others():
    conditions = Boundaries(Dofs(), (boundary(0, 0.0),))
    end = conditions.start_step(step(boundaries=(boundary(1, 1.0), boundary(2, 2.0))), np.zeros(N)).at(2.0, 2.0)
    variation = conditions.start_step(step(boundaries=(boundary(1, 5.0),)), end)
    assert conditions.unknowns.tolist() == [0, 1, 2]
    assert history(variation, 1) == [1.0, 3.0, 5.0]
    assert history(variation, 2) == [2.0, 2.0, 2.0]


def test_new_removes_all_that_is_not_given_anew():
    conditions = Boundaries(Dofs(), (boundary(0, 0.0),))
    conditions.start_step(step(boundaries=(boundary(1, 1.0),)), np.zeros(N))
    conditions.start_step(step(boundaries=(boundary(2, 1.0),), new_boundary=True), np.zeros(N))
    assert conditions.unknowns.tolist() == [2]


def test_a_value_given_anew_leaves_its_curve():
    conditions = Boundaries(Dofs(), ())
    line = curve((0, 0), (10, 10), total_time=True)
    end = conditions.start_step(step(boundaries=(boundary(0, 1.0, line),)), np.zeros(N)).at(2.0, 2.0)
    assert history(conditions.start_step(step(boundaries=(boundary(0, 4.0),)), end), 0, start=2.0) == [2.0, 3.0, 4.0]


def test_loads_of_one_step_add_up():
    """Overlapping concentrated forces superpose."""
    variation = Loads(Dofs()).start_step(step(loads=(load(0, 1.0), load(0, 3.0))), 0.0)
    assert history(variation, 0) == [0.0, 2.0, 4.0]


def test_load_given_at_once():
    variation = Loads(Dofs()).start_step(step(loads=(load(0, 1.0),), amplitude="STEP"), 0.0)
    assert history(variation, 0) == [1.0, 1.0, 1.0]


@pytest.mark.parametrize(
    ("options", "kept", "replaced"),
    [
        ({}, [2.0, 2.0, 2.0], [1.0, 3.0, 5.0]),
        ({"new_loads": True}, [2.0, 1.0, 0.0], [1.0, 3.0, 5.0]),
        ({"new_loads": True, "amplitude": "STEP"}, [0.0, 0.0, 0.0], [5.0, 5.0, 5.0]),
    ],
)
def test_loads_of_the_previous_step(options, kept, replaced):
    loads = Loads(Dofs())
    loads.start_step(step(loads=(load(0, 1.0), load(1, 2.0))), 0.0)
    variation = loads.start_step(step(loads=(load(0, 5.0),), **options), 2.0)
    assert history(variation, 1, start=2.0) == kept
    assert history(variation, 0, start=2.0) == replaced


def test_curves_of_loads_go_on_in_total_time_only():
    line = ((0, 0), (10, 10))
    loads = Loads(Dofs())
    loads.start_step(
        step(loads=(load(0, 1.0, curve(*line, total_time=True)), load(0, 3.0), load(1, 1.0, curve(*line)))), 0.0
    )
    variation = loads.start_step(step(), 2.0)
    assert history(variation, 0, start=2.0) == pytest.approx([5.0, 6.0, 7.0])
    assert history(variation, 1, start=2.0) == pytest.approx([2.0, 2.0, 2.0])


def test_reactions_of_released_dofs_fade():
    reaction = np.array([1.0, -2.0, 0.0, 0.0])
    none = np.zeros(4)
    variation = fading_forces(reaction, np.array([0]), step(), none)
    assert history(variation, 0) == [0.0, 0.0, 0.0]
    assert history(variation, 1) == [-2.0, -1.0, 0.0]
    assert history(fading_forces(reaction, np.array([0]), step(amplitude="STEP"), none), 1) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("amplitude", ["RAMP", "STEP"])
def test_forces_of_initial_stresses_fade_over_the_step(amplitude):
    """Also where the dof is prescribed, and whatever the amplitude of the loads is."""
    none, forces = np.zeros(4), np.array([4.0, -2.0, 0.0, 0.0])
    variation = fading_forces(none, np.array([0]), step(amplitude=amplitude), forces)
    assert history(variation, 0) == [4.0, 2.0, 0.0]
    assert history(variation, 1) == [-2.0, -1.0, 0.0]
