# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heat transfer through rods: conductance G, heat capacity C at each of their ends."""

from pathlib import Path

import numpy as np
import pytest

from uel.model.controls import Controls, TimeControls
from uel.model.procedures import CoupledTemperatureDisplacement, HeatTransfer, Visco
from uel.model.records import Convergence
from uel.running.job import run

G, C = 2.0, 0.5
ROD = (0, 1, 1, (G, C, 0.0))


@pytest.fixture
def conduct(bench):
    bench.user, bench.dof = "rods.f", 11

    def conduct(*steps, rods=(ROD,), **options):
        result = bench.run(rods, steps, **options)
        if result.error is not None:
            raise result.error
        return result

    return conduct


def test_steady_state_is_linear_between_prescribed_temperatures(bench, conduct):
    ends = (bench.fix(0, 10.0, dof=11), bench.fix(2, 30.0, dof=11))
    result = conduct(
        bench.step(static=HeatTransfer(steady=True), boundaries=ends), rods=(ROD, (1, 2, 1, (2 * G, C, 0.0)))
    )
    # conductances in series: the same flux through both
    flux = 20.0 / (1 / G + 1 / (2 * G))
    assert result.last.displacement == pytest.approx([10.0, 10.0 + flux / G, 30.0])
    assert result.last.reaction == pytest.approx([-flux, 0.0, flux])
    ((check,),) = result.iterations()
    assert check.field == "temperature"
    assert check.verdict is Convergence.LINEAR


def test_transient_with_fixed_increments_is_backward_euler(bench, conduct):
    """One end held at 0, the other from 100: T_1 = T_0/(1 + G h/C)."""
    h = 0.05
    result = conduct(
        bench.step(static=HeatTransfer(h, 10 * h, h, h, True), boundaries=(bench.fix(0, dof=11),), amplitude="STEP"),
        temperatures=(bench.initial(1, 100.0, dof=11),),
    )
    temperature = [increment.solution.displacement[1] for increment in result.increments]
    assert temperature == pytest.approx(100.0 / (1 + G * h / C) ** np.arange(1, 11))


def test_flux_into_a_rod(bench, conduct):
    """*CFLUX Q into an end: T goes to Q/G."""
    static = HeatTransfer(0.1, 20.0, 1e-4, 20.0, largest_change=2.0)
    result = conduct(
        bench.step(static=static, boundaries=(bench.fix(0, dof=11),), loads=(bench.force(1, 8.0, dof=11),)),
    )
    assert result.last.displacement[1] == pytest.approx(8.0 / G, rel=0.05)
    assert result.last.load[1] == pytest.approx(8.0)


@pytest.mark.parametrize(("d_l", "at_least"), [(0.0, 4), (0.95, 2)])
def test_largest_change_of_temperature_sets_the_increment(bench, conduct, d_l, at_least):
    """Above DELTMX the increment is repeated with D_A DELTMX/dT of it; growth is D_G DELTMX/dT of the last one, at most
    D_M = 2, where the changes of the last I_T = 3 increments, which go with the size, are up to W_G DELTMX at this one.

    In a linear problem, as here, it is not used below D_L D_M.
    """
    h, deltmx = 0.1, 10.0
    static = HeatTransfer(h, 2.0, 1e-6, 2.0, largest_change=deltmx)
    result = conduct(
        bench.step(
            static=static,
            boundaries=(bench.fix(0, dof=11),),
            amplitude="STEP",
            increments=1000,
            controls=Controls(time=TimeControls(d_l=d_l)),
        ),
        temperatures=(bench.initial(1, 100.0, dof=11),),
    )
    change = 100.0 * (1 - 1 / (1 + G * h / C))
    first = result.abandoned[0]
    assert first.reason == "THE TEMPERATURE CHANGES BY MORE THAN DELTMX IN THE INCREMENT."
    assert first.next_increment == pytest.approx(0.85 * deltmx / change * h)
    temperatures = np.array([100.0, *(increment.solution.displacement[1] for increment in result.increments)])
    changes = -np.diff(temperatures)
    sizes = np.array([increment.time_increment for increment in result.increments])
    assert max(changes) <= deltmx
    grown = np.flatnonzero(np.diff(sizes[:-1]) > 0)
    assert len(grown) >= at_least
    assert min(sizes[grown + 1] / sizes[grown]) >= 2.0 * d_l
    for k in grown:
        last = slice(k - 2, k + 1)
        assert max(changes[last] * sizes[k] / sizes[last]) <= 0.75 * deltmx
        assert sizes[k + 1] / sizes[k] == pytest.approx(min(2.0, 0.8 * deltmx / changes[k]))


def test_a_step_may_end_at_the_steady_state(bench, conduct):
    """END=SS: when the temperature changes by less than the rate that is given."""
    h = 0.5
    static = HeatTransfer(h, 1000.0, h, h, True, end_change=1.0)
    result = conduct(
        bench.step(static=static, boundaries=(bench.fix(0, dof=11),), amplitude="STEP", increments=1000),
        temperatures=(bench.initial(1, 100.0, dof=11),),
    )
    factor = 1 / (1 + G * h / C)
    rates = 100.0 * factor ** np.arange(50) * (1 - factor) / h
    assert len(result.increments) == 1 + np.argmax(rates < 1.0)


def test_temperature_dependent_conductance_converges_quadratically(bench, conduct):
    """Steady, conductance G + b T: the flux is G dT + b (T_1^2 - T_0^2)/2 by Kirchhoff's transformation."""
    ends = (bench.fix(0, 0.0, dof=11), bench.fix(1, 10.0, dof=11))
    result = conduct(bench.step(static=HeatTransfer(steady=True), boundaries=ends), rods=((0, 1, 1, (G, C, 0.1)),))
    assert result.last.reaction[1] == pytest.approx(G * 10 + 0.1 * 100 / 2)


@pytest.mark.parametrize(
    "procedure, flag",
    [
        (HeatTransfer(steady=True), 31),
        (HeatTransfer(largest_change=1e9), 32),
        (HeatTransfer(direct=True), 33),
        (CoupledTemperatureDisplacement(steady=True), 71),
        (CoupledTemperatureDisplacement(largest_change=1e9), 72),
        (CoupledTemperatureDisplacement(direct=True), 73),
        (Visco(), 21),
    ],
)
def test_elements_are_told_the_procedure(bench, conduct, procedure, flag):
    result = conduct(bench.step(static=procedure, boundaries=(bench.fix(0, dof=11),)), log=True)
    assert {line[1] for line in result.printed if line[0] == "UEL"} == {str(flag)}


COUPLED_SPRING = """\
*NODE
1, 0.
*USER ELEMENT, TYPE=U1, NODES=1
1, 11
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1
*UEL PROPERTY, ELSET=ALL
*STEP, INC=1
{procedure}
1., 1.
*CLOAD
1, 1, 1.
*CFLUX
1, 11, 1.
*END STEP
"""
THERMAL_FORCE = """\
      include '{folder}/uel.inc'
      rhs(1:2,1) = (/ -u(1) + u(2), -2*u(2) /)
      amatrx = reshape((/ 1d0, 0d0, -1d0, 2d0 /), (/ 2, 2 /))
      end
"""


@pytest.mark.parametrize(
    "procedure, linear", [("*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE", True), ("*STATIC", False)]
)
def test_coupled_steps_take_unsymmetric_matrices_as_they_are(tmp_path, procedure, linear):
    """Abaqus 2023 does so, and says so in its message file; elsewhere UNSYMM is needed for it."""
    deck, user = tmp_path / "spring.inp", tmp_path / "spring.f"
    deck.write_text(COUPLED_SPRING.format(procedure=procedure))
    user.write_text(THERMAL_FORCE.format(folder=Path(__file__).parents[1]))
    result = run(deck, user, output_dir=tmp_path)
    assert (result.status[-1].iterations == 1) is linear
    assert ("UNSYMMETRIC MATRIX STORAGE" in result.file(".msg").read_text()) is linear
