# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*VISCO, *DYNAMIC, *HEAT TRANSFER, *COUPLED TEMPERATURE-DISPLACEMENT, and what belongs to them."""

import math

import pytest

from uel.errors import DeckError
from uel.model.procedures import (
    CoupledTemperatureDisplacement,
    Dynamic,
    HeatTransfer,
    Integrator,
    Stabilize,
    Static,
    Visco,
)

HEAD = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2
1, 2, 11
*ELEMENT, TYPE=U1, ELSET=E
1, 1, 2
*UEL PROPERTY, ELSET=E
"""


@pytest.fixture
def step(read):
    def step(lines, head="*STEP", model=""):
        return read(f"{HEAD}{model}{head}\n{lines}\n*END STEP\n").steps[0]

    return step


@pytest.mark.parametrize(
    "lines, expected, amplitude",
    [
        (
            "*STATIC, STABILIZE=1e-4, ALLSDTOL=0.1, CONTINUE=NO\n0.1, 2.",
            Static(0.1, 2.0, 2e-5, 2.0, stabilize=Stabilize(1e-4, 0.0, 0.1)),
            "RAMP",
        ),
        (
            "*STATIC, STABILIZE, FACTOR=3., ALLSDTOL\n0.1, 2.",
            Static(0.1, 2.0, 2e-5, 2.0, stabilize=Stabilize(2e-4, 3.0, 0.05)),
            "RAMP",
        ),
        ("*VISCO\n0.1, 2.", Visco(0.1, 2.0, 0.1, 0.1, direct=True), "STEP"),
        ("*VISCO, CETOL=1e-3\n0.1, 2.", Visco(0.1, 2.0, 2e-5, 2.0, tolerance=1e-3), "STEP"),
        ("*DYNAMIC\n0.01, 2.", Dynamic(0.01, 2.0, 2e-5, 0.02, half_increment=1e4), "STEP"),
        ("*DYNAMIC, NOHAF, DIRECT\n0.01, 2.", Dynamic(0.01, 2.0, 0.01, 0.01, True), "STEP"),
        ("*DYNAMIC, HAFTOL=3.\n0.01, 2.", Dynamic(0.01, 2.0, 2e-5, 0.02, half_increment=1e4, half_force=3.0), "STEP"),
        (
            "*DYNAMIC, ALPHA=0., INITIAL=NO\n0.01, 2.",
            Dynamic(0.01, 2.0, 2e-5, 0.02, False, None, 0.0, 0.25, 0.5, initial_acceleration=False, half_increment=1e4),
            "STEP",
        ),
        (
            "*DYNAMIC, APPLICATION=MODERATE DISSIPATION\n0.01, 2.",
            # the manual's table: alpha -0.41421, beta 0.5, gamma 0.91421
            Dynamic(0.01, 2.0, 2e-5, 0.2, False, None, -0.41421, 0.5, 0.91421, initial_acceleration=False),
            "STEP",
        ),
        (
            "*DYNAMIC, APPLICATION=QUASI-STATIC\n0.01, 2.",
            Dynamic(
                *(0.01, 2.0, 2e-5, 2.0, False, None, 0.0, 1.0, 1.0),
                integrator=Integrator.BACKWARD_EULER,
                initial_acceleration=False,
            ),
            "RAMP",
        ),
        ("*HEAT TRANSFER, STEADY STATE\n0.5, 1.", HeatTransfer(0.5, 1.0, 1e-5, 1.0, steady=True), "RAMP"),
        ("*HEAT TRANSFER\n0.5, 1.", HeatTransfer(0.5, 1.0, 0.5, 0.5, True), "STEP"),
        (
            "*HEAT TRANSFER, DELTMX=5., END=SS\n0.5, 1., 1e-3, 0.5, 0.1",
            HeatTransfer(0.5, 1.0, 1e-3, 0.5, largest_change=5.0, end_change=0.1),
            "STEP",
        ),
        (
            "*COUPLED TEMPERATURE-DISPLACEMENT, DELTMX=5.\n0.5, 1.",
            CoupledTemperatureDisplacement(0.5, 1.0, 1e-5, 1.0, largest_change=5.0),
            "STEP",
        ),
        (
            "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n0.5, 1.",
            CoupledTemperatureDisplacement(0.5, 1.0, 1e-5, 1.0, steady=True),
            "RAMP",
        ),
    ],
)
def test_procedures(step, lines, expected, amplitude):
    found = step(lines)
    assert found.amplitude == amplitude
    for name in expected.__dataclass_fields__:
        value, wanted = getattr(found.procedure, name), getattr(expected, name)
        assert value == (pytest.approx(wanted, rel=1e-4) if isinstance(wanted, float) else wanted), name


def test_amplitude_of_the_step_goes_before_that_of_the_procedure(step):
    assert step("*DYNAMIC\n0.01, 1.", "*STEP, AMPLITUDE=RAMP").amplitude == "RAMP"


@pytest.mark.parametrize(
    "lines, message",
    [
        ("*STATIC, STABILIZE, CONTINUE=YES", r"\*STATIC, CONTINUE=YES is not supported"),
        (
            "*STATIC\n*BOUNDARY, FIXED, TYPE=VELOCITY\n1, 1",
            r"\*BOUNDARY: FIXED holds the values at the start of the step, and",
        ),
        ("*DYNAMIC, ALPHA=-0.6\n0.01, 1.", r":10: \*DYNAMIC: ALPHA=-0.6 is outside -0.5 to 0"),
        ("*DYNAMIC, BETA=0.\n0.01, 1.", r"BETA=0 must be positive and GAMMA=0.55 at least 0.5"),
        ("*DYNAMIC, TIME INTEGRATOR=BWE, ALPHA=-0.1\n0.01, 1.", "ALPHA, BETA and GAMMA are for the integrators HHT"),
        ("*DYNAMIC, HAFTOL=-1\n0.01, 1.", "HAFTOL and HALFINC SCALE FACTOR must not be negative"),
        ("*DYNAMIC, EXPLICIT\n0.01, 1.", r"\*DYNAMIC: option EXPLICIT is not supported"),
        ("*HEAT TRANSFER, DELTMX=-1\n0.01, 1.", "DELTMX=-1 must not be negative"),
        ("*VISCO, CETOL=-1\n0.01, 1.", "CETOL=-1 must not be negative"),
        ("*HEAT TRANSFER, DELTMX=1, END=SS\n0.01, 1.", "END=SS needs a positive rate of temperature change"),
        ("*COUPLED TEMPERATURE-DISPLACEMENT, ELECTRICAL\n1., 1.", "option ELECTRICAL is not supported"),
        ("*STATIC\n1., 1.\n*DYNAMIC\n0.1, 1.", r":12: \*DYNAMIC: the step has a procedure already, at .*:10"),
    ],
)
def test_what_is_wrong_is_named(step, lines, message):
    with pytest.raises(DeckError, match=message):
        step(lines)


def test_extrapolation_from_velocities_needs_some(step):
    head = "*STEP, EXTRAPOLATION=VELOCITY PARABOLIC"
    assert step("*DYNAMIC\n0.01, 1.", head).extrapolation == "VELOCITY PARABOLIC"
    with pytest.raises(DeckError, match=r":9: .*VELOCITY PARABOLIC needs velocities"):
        step("*STATIC\n1., 1.", head)


def test_another_solution_technique_is_noted(step):
    (note,) = step("*STATIC\n1., 1.\n*SOLUTION TECHNIQUE, TYPE=QUASI-NEWTON, REFORM KERNEL=8").notes
    assert "TYPE=QUASI-NEWTON" in note and note.endswith("NEWTON'S METHOD WITH THE FULL MATRIX IS USED")


def test_initial_conditions(read):
    model = read(
        f"{HEAD}*INITIAL CONDITIONS, TYPE=VELOCITY\nALL, 2, 3.5\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\n2, 20.\n"
        "*STEP\n*DYNAMIC\n0.01, 1.\n*CFLUX\n2, , 4.\n*END STEP\n"
    )
    (velocity,), (temperature,), (flux,) = model.initial_velocities, model.initial_temperatures, model.steps[0].loads
    assert (velocity.nodes.tolist(), velocity.dof, velocity.value) == ([0, 1], 2, 3.5)
    assert (temperature.nodes.tolist(), temperature.dof, temperature.value) == ([1], 11, 20.0)
    assert (flux.nodes.tolist(), flux.dof, flux.magnitude) == ([1], 11, 4.0)


def test_initial_temperatures_of_further_dofs(read):
    model = read(f"{HEAD}*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 1., 2., 3.\n*STEP\n*STATIC\n*END STEP\n")
    assert [(entry.dof, entry.value) for entry in model.initial_temperatures] == [(11, 1.0), (12, 2.0), (13, 3.0)]


def test_initial_temperature_of_all_nodes(read):
    """As the public deck OlafHesebeck/UTRSNETWORK, simpletest.inp, has it."""
    option = "*INITIAL CONDITIONS, TYPE=TEMPERATURE, SECTION SPECIFICATION=UNIFORM"
    model = read(f"{HEAD}{option}\n, 20.\n*STEP\n*STATIC\n*END STEP\n")
    (found,) = model.initial_temperatures
    assert (found.nodes.tolist(), found.value) == (list(range(len(model.mesh.labels))), 20.0)
    with pytest.raises(DeckError, match="INITIAL CONDITIONS"):
        read(f"{HEAD}*INITIAL CONDITIONS, TYPE=TEMPERATURE\n, 20.\n*STEP\n*STATIC\n*END STEP\n")


@pytest.mark.parametrize(
    "lines, message",
    [
        ("*INITIAL CONDITIONS, TYPE=VELOCITY\n1, 11, 1.", r":10: \*INITIAL CONDITIONS: dof 11 has no velocity"),
        ("*INITIAL CONDITIONS, TYPE=RATIO\n1, 1.", r":9: \*INITIAL CONDITIONS, TYPE=RATIO is not supported"),
        ("*INITIAL CONDITIONS, TYPE=TEMPERATURE\n7, 1.", ":10: .*7"),
    ],
)
def test_wrong_initial_conditions_are_named(step, lines, message):
    with pytest.raises(DeckError, match=message):
        step("*STATIC\n1., 1.", model=lines + "\n")


def test_no_limit_is_no_number(step):
    assert math.isinf(step("*HEAT TRANSFER, STEADY STATE\n1., 1.").procedure.largest_change)
