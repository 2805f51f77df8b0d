# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Riks' method and energy control on springs whose equilibrium paths are known."""

import math

import numpy as np
import pytest

from uel.errors import ConvergenceError, DeckError, KernelError
from uel.model.amplitude import Amplitude, AmplitudeType
from uel.model.procedures import Riks, Static

# f = d (d - 1)(d - 2): limit points at d = 1 -+ 1/sqrt(3), f = +-2/(3 sqrt(3))
TRUSS = (0, 1, 7, (1.0, 1.0))
LIMIT = 2 / (3 * math.sqrt(3))
# force 1 at d = 0.1, none from d = 1 on
DAMAGE = (1, 2, 6, (10.0, 0.1, 1.0))


def force_of_truss(d):
    return d * (d - 1) * (d - 2)


def riks(length, largest, end):
    return Static(length, 1.0, 1e-5, largest, riks=end)


def factors(result):
    return np.array([record.load_factor for record in result.increments])


def displacements(result, node):
    return np.array([record.solution.displacement[node] for record in result.increments])


def test_snap_through_of_a_truss(bench):
    step = bench.step(
        static=riks(0.05, 0.1, Riks(largest_factor=1.2)), boundaries=(bench.fix(0),), loads=(bench.force(1, 0.5),)
    )
    result = bench.run([TRUSS], [step])
    assert result.error is None
    d, factor = displacements(result, 1), factors(result)
    assert 0.5 * factor == pytest.approx(force_of_truss(d), abs=2e-3)
    assert 0.5 * factor.max() >= 1.2 * 0.5
    # load rises to the limit, falls through zero to the other, and rises again
    before = factor[: int(np.argmin(factor))]
    assert 0.5 * before.max() == pytest.approx(LIMIT, rel=5e-3)
    assert 0.5 * factor.min() == pytest.approx(-LIMIT, rel=5e-3)
    # the first increment changes the load factor by its length; the step ends with the increment that crosses 1.2
    assert factor[0] == pytest.approx(0.05, rel=0.02)
    assert (factor[:-1] < 1.2).all()
    assert [r.solution.load[1] for r in result.increments] == pytest.approx(0.5 * factor)
    assert result.increments[-1].total_time == pytest.approx(0.05 * 1.5 + 0.1 * (len(d) - 1) + 0.025, abs=0.2)


def test_snap_back_under_a_prescribed_displacement(bench):
    """The truss behind a spring of stiffness 0.3: the end, at d + f/0.3, goes back while the truss goes on."""
    step = bench.step(
        static=riks(0.05, 0.05, Riks(node=2, dof=1, value=3.0)), boundaries=(bench.fix(0), bench.fix(2, 4.0))
    )
    result = bench.run([TRUSS, (1, 2, 1, (0.3, 0.0))], [step])
    assert result.error is None
    d, end = displacements(result, 1), displacements(result, 2)
    assert end == pytest.approx(4.0 * factors(result))
    assert end == pytest.approx(d + force_of_truss(d) / 0.3, abs=1e-2)
    assert (np.diff(d) > 0).all()
    assert end.max() > 3.0 > end[-2]
    turned = np.flatnonzero(np.diff(end) < 0)
    # u'(d) = 0 at 3 (d - 1)^2 = 0.7
    width = math.sqrt(0.7 / 3)
    assert d[turned[0]] == pytest.approx(1 - width, abs=0.06)
    assert d[turned[-1] + 1] == pytest.approx(1 + width, abs=0.06)


def test_the_load_of_a_step_starts_from_that_of_the_last(bench):
    first = bench.step(static=Static(1.0, 1.0), boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),))
    second = bench.step(2, static=riks(0.5, 0.5, Riks(largest_factor=1.0)), loads=(bench.force(1, 3.0),))
    result = bench.run([(0, 1, 1, (2.0, 0.0))], [first, second])
    assert [r.load_factor for r in result.increments] == pytest.approx([None, 0.5, 1.0])
    assert displacements(result, 1) == pytest.approx([0.5, 1.0, 1.5])


def test_without_an_end_the_increments_end_the_step(bench):
    step = bench.step(
        static=riks(0.1, 0.1, Riks()), increments=3, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),)
    )
    result = bench.run([(0, 1, 1, (2.0, 0.0))], [step])
    assert result.error is None
    assert factors(result) == pytest.approx([0.1, 0.2, 0.3])


def test_an_end_that_is_not_reached(bench):
    end = Riks(largest_factor=1.0)
    step = bench.step(
        static=riks(0.1, 0.1, end), increments=3, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),)
    )
    with pytest.raises(ConvergenceError, match="TOO MANY INCREMENTS"):
        raise bench.run([(0, 1, 1, (2.0, 0.0))], [step]).error


def test_monitored_dof_without_an_element(bench):
    step = bench.step(static=riks(0.1, 0.1, Riks(node=1, dof=2, value=1.0)), boundaries=(bench.fix(0),))
    with pytest.raises(DeckError, match="no element uses dof 2 of node 2, which is to end the step"):
        raise bench.run([TRUSS], [step]).error


@pytest.mark.parametrize("options", [{}, {"energy_control": True}])
def test_an_amplitude_is_refused(bench, options):
    curve = Amplitude("A", AmplitudeType.TABULAR, np.array([[0.0, 0.0], [1.0, 1.0]]), None)
    static = Static(0.1, 1.0) if options else riks(0.1, 0.1, Riks())
    step = bench.step(static=static, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0, curve),))
    with pytest.raises(DeckError, match=r"springs\.inp:2: an amplitude has no meaning"):
        raise bench.run([TRUSS], [step], **options).error


@pytest.mark.nan
def test_column_two_of_rhs_is_to_be_filled(bench):
    """JPROPS(1) = 2: the spring fills column 1 alone, which is enough wherever NRHS = 1."""
    load = {"boundaries": (bench.fix(0),), "loads": (bench.force(1, 1.0),)}
    assert bench.run([(0, 1, 1, (2.0, 0.0))], [bench.step(**load)], log=2).error is None
    step = bench.step(static=riks(0.1, 0.1, Riks()), increments=1, **load)
    with pytest.raises(KernelError, match=r"RHS\(1,2\) was not filled"):
        raise bench.run([(0, 1, 1, (2.0, 0.0))], [step], log=2).error


def test_loads_of_elements_take_part(bench):
    """The spring says its load grows by 0.01 in an increment of the factor of 0.01: a rate of 1, as that of *CLOAD.

    Its AMATRX and RHS hold no such load, so the predictor of increment 2 is twice as long as the path, and the factor
    follows from that of the normal plane.
    """
    step = bench.step(
        static=riks(0.1, 0.1, Riks()), increments=2, boundaries=(bench.fix(0),), loads=(bench.force(1, 1.0),)
    )
    plain = bench.run([(0, 1, 8, (2.0, 0.0, 0.0))], [step])
    loaded = bench.run([(0, 1, 8, (2.0, 0.0, 1e-3))], [step])
    corrections = [[check.correction.value for check in block] for block in loaded.iterations()]
    assert corrections[0] == pytest.approx([0.05])
    assert len(plain.iterations()[1]) == 1
    assert corrections[1][0] > 1.2 * plain.iterations()[1][0].correction.value
    assert displacements(loaded, 1) == pytest.approx(0.5 * factors(loaded), rel=5e-3)


def snap(bench, static, **options):
    """A spring of stiffness 0.5 in series with one that fails, pulled to 3.15."""
    step = bench.step(static=static, increments=500, boundaries=(bench.fix(0), bench.fix(2, 3.15)))
    return bench.run([(0, 1, 1, (0.5, 0.0)), DAMAGE], [step], **options)


def test_energy_control_traces_a_snap_back(bench):
    """Beyond the peak, f = (1 - d)/0.9, the end is at d + 2 f: it goes back from 2.1 to 1, and then on."""
    static = Static(0.02, 1.0, 1e-5, 0.02)
    assert isinstance(snap(bench, static).error, ConvergenceError)
    result = snap(bench, static, energy_control=True)
    assert result.error is None
    end, middle = displacements(result, 2), displacements(result, 1)
    force = np.array([record.solution.reaction[2] for record in result.increments])
    d = end - middle
    whole = d <= 0.1
    assert force[whole] == pytest.approx(10 * d[whole], abs=1e-6)
    assert force[~whole] == pytest.approx(np.clip((1 - d[~whole]) / 0.9, 0, None), abs=1e-3)
    assert force == pytest.approx(0.5 * middle, abs=1e-6)
    assert end.max() == pytest.approx(3.15)
    turned = np.flatnonzero(np.diff(end) < 0)
    assert end[turned[0]] == pytest.approx(2.1, abs=0.063)
    assert end[turned[-1] + 1] == pytest.approx(1.0, abs=0.05)
    # energy under the softening curve, 1/2 * 1 * 1: all of the external work, as nothing is stored at the end
    assert result.last.energies["ALLWK"] == pytest.approx(0.5, rel=0.02)
    # a snap-back of a third of the displacement at a hundredth or so an increment, and no attempt in vain
    assert len(turned) > 10
    assert result.abandoned == []


def test_energy_control_of_an_elastic_spring_is_load_control(bench):
    static = Static(0.3, 1.0, 1e-5, 0.3)
    step = bench.step(static=static, boundaries=(bench.fix(0),), loads=(bench.force(1, 2.0),))
    result = bench.run([(0, 1, 1, (4.0, 0.0))], [step], energy_control=True)
    assert factors(result) == pytest.approx([0.3, 0.6, 0.9, 1.0])
    assert displacements(result, 1)[-1] == pytest.approx(0.5)
