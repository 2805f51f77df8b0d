# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*ENERGY OUTPUT of element sets, and of steps whose procedure lacks what is asked for."""

import numpy as np
import pytest

from uel.errors import DeckError
from uel.model.energies import ELEMENT_ENERGIES

YOUNG, FORCE = 1000.0, 10.0
BAR = """*NODE
1, 0., 0.
2, 1., 0.
3, 3., 0.
4, 0., 1.
5, 1., 1.
6, 3., 1.
*ELEMENT, TYPE=CPS4, ELSET=ALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*ELSET, ELSET=SHORT
1
*ELSET, ELSET=LONG
2
*NSET, NSET=LEFT
1, 4
*NSET, NSET=RIGHT
3, 6
*SOLID SECTION, ELSET=ALL, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DENSITY
2.
*BOUNDARY
LEFT, 1
1, 2
"""
STEP = "*STEP\n*STATIC\n1., 1.\n*CLOAD\nRIGHT, 1, 5.\n{}*END STEP\n"
OUTPUT = "*OUTPUT, HISTORY\n*ENERGY OUTPUT{}\n"


@pytest.fixture
def energies_and_warnings(run_deck):
    def energies_and_warnings(text):
        result = run_deck(text)
        return result.history, result.warnings

    return energies_and_warnings


def test_strain_energy_of_each_part(energies_and_warnings):
    """A bar in tension has the energy F^2 L/(2 E A); parts have it by their lengths."""
    lines = OUTPUT.format(", ELSET=SHORT\nALLSE, ALLIE") + "*ENERGY OUTPUT, ELSET=LONG\nALLSE\n*ENERGY OUTPUT\nALLSE\n"
    history, warnings = energies_and_warnings(BAR + STEP.format(lines))
    per_length = FORCE**2 / (2 * YOUNG)
    # linear elements hold a constant stress exactly
    assert history["ALLSE[SHORT]"][-1] == pytest.approx(per_length, rel=1e-12)
    assert history["ALLIE[SHORT]"][-1] == pytest.approx(per_length, rel=1e-12)
    assert history["ALLSE[LONG]"][-1] == pytest.approx(2 * per_length, rel=1e-12)
    assert history["ALLSE"][-1] == pytest.approx(3 * per_length, rel=1e-12)
    assert not warnings


def test_sets_without_variables_have_all_of_them(energies_and_warnings):
    history, _ = energies_and_warnings(BAR + STEP.format(OUTPUT.format(", ELSET=LONG")))
    assert [name for name in history if name.startswith("ALL")] == [f"{name}[LONG]" for name in ELEMENT_ENERGIES]


def test_kinetic_energy_of_each_part(energies_and_warnings):
    """Energy of a free flight: m v^2/2."""
    text = BAR[: BAR.index("*BOUNDARY")] + "*NSET, NSET=EACH, GENERATE\n1, 6\n"
    text += "*INITIAL CONDITIONS, TYPE=VELOCITY\nEACH, 1, 3.\n*STEP\n*DYNAMIC\n0.1, 0.1\n"
    history, _ = energies_and_warnings(
        text + OUTPUT.format(", ELSET=SHORT\nALLKE") + "*ENERGY OUTPUT, ELSET=LONG\nALLKE\n*END STEP\n"
    )
    assert history["ALLKE[SHORT]"][-1] == pytest.approx(2 * 1 * 3**2 / 2, rel=1e-9)
    assert history["ALLKE[LONG]"][-1] == pytest.approx(2 * 2 * 3**2 / 2, rel=1e-9)


def test_damage_is_no_plastic_dissipation(energies_and_warnings):
    """A layer that has failed has dissipated its fracture energy, the bar beside it nothing."""
    glue = "*NODE\n7, 3., 0.\n8, 3., 1.\n*ELEMENT, TYPE=COH2D4, ELSET=GLUE\n3, 6, 3, 7, 8\n"
    glue += "*COHESIVE SECTION, ELSET=GLUE, MATERIAL=G, RESPONSE=TRACTION SEPARATION\n1., 1.\n*MATERIAL, NAME=G\n"
    glue += "*ELASTIC, TYPE=TRACTION\n1e4, 1e4, 1e4\n*DAMAGE INITIATION, CRITERION=MAXS\n1., 1., 1.\n"
    glue += "*DAMAGE EVOLUTION, TYPE=ENERGY\n0.25\n"
    text = BAR.replace("*BOUNDARY\n", f"{glue}*BOUNDARY\n7, 1, 2\n8, 1, 2\n")
    step = "*STEP, INC=1000\n*STATIC\n0.01, 1., 1e-5, 0.01\n*BOUNDARY\nLEFT, 1, 1, -0.8\n"
    lines = (
        OUTPUT.format(", ELSET=GLUE\nALLDMD, ALLPD")
        + "*ENERGY OUTPUT, ELSET=LONG\nALLDMD, ALLPD\n*ENERGY OUTPUT\nALLDMD\n"
    )
    history, _ = energies_and_warnings(text + step + lines + "*END STEP\n")
    assert np.array_equal(history["ALLDMD[GLUE]"], history["ALLDMD"])
    assert history["ALLDMD[GLUE]"][-1] == pytest.approx(0.25, rel=1e-9)
    for name in ("ALLPD[GLUE]", "ALLDMD[LONG]", "ALLPD[LONG]"):
        # of the strain energy in the bar, up to 1e-3, rounding remains
        assert np.abs(history[name]).max() < 1e-15


def test_what_sets_do_not_have(energies_and_warnings):
    history, warnings = energies_and_warnings(BAR + STEP.format(OUTPUT.format(", ELSET=LONG\nALLSE, ALLWK, ETOTAL")))
    assert [name for name in history if name.startswith(("ALL", "ET"))] == ["ALLSE[LONG]"]
    for name in ("ALLWK", "ETOTAL"):
        assert f"HISTORY OUTPUT OF {name} of element set LONG in step 1 IS NOT AVAILABLE" in " ".join(warnings)


def test_sets_have_none_in_linear_steps(energies_and_warnings):
    text = BAR + STEP.format(OUTPUT.format(", ELSET=LONG\nALLSE")).replace("*STEP", "*STEP, PERTURBATION")
    history, warnings = energies_and_warnings(text)
    assert "ALLSE[LONG]" not in history
    assert "ALLSE of element set LONG in step 1 IS NOT AVAILABLE" in " ".join(warnings)


def test_an_unknown_set_is_an_error(energies_and_warnings):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: unknown element set NONE"):
        energies_and_warnings(BAR + STEP.format(OUTPUT.format(", ELSET=NONE\nALLSE")))


def test_energies_of_each_set_are_told(energies_and_warnings):
    _, warnings = energies_and_warnings(BAR + STEP.format(OUTPUT.format(", PER ELEMENT SET\nALLSE")))
    assert "PER ELEMENT SET and PER SECTION are not supported; ELSET= is" in " ".join(warnings)


HARMONIC = "*STEP, PERTURBATION\n*STEADY STATE DYNAMICS, DIRECT\n0.1, 0.2, 2\n*CLOAD\nRIGHT, 1, 1.\n{}*END STEP\n"
MODES = "*STEP, PERTURBATION\n*FREQUENCY\n1\n{}*END STEP\n"
LINEAR = "*STEP, PERTURBATION\n*STATIC\n*CLOAD\nRIGHT, 1, 1.\n{}*END STEP\n"


@pytest.mark.parametrize(
    ("step", "lines", "message"),
    [
        (
            HARMONIC,
            OUTPUT.format("\nALLSE, ALLIE, ALLVD"),
            r"\*ENERGY OUTPUT: ALLIE, ALLVD not available in \*STEADY STATE DYNAMICS \(step at .*\), which has ALLSE,",
        ),
        (
            HARMONIC,
            OUTPUT.format(", VARIABLE=PRESELECT"),
            r"\*ENERGY OUTPUT: ALLAE, .*ETOTAL not available in \*STEADY",
        ),
        (HARMONIC, OUTPUT.format("\nALLSE, ALLKE") + "*ENERGY PRINT\n", ""),
        (
            MODES,
            "*ENERGY PRINT\n",
            r"\*ENERGY PRINT: nothing is printed in \*FREQUENCY \(step at .*\), which has EIGVAL",
        ),
        (
            LINEAR,
            OUTPUT.format("\nALLSE, ALLKE"),
            r"\*ENERGY OUTPUT: ALLKE not available in \*STATIC \(step at .*\), which has ALLSE, ALLWK; left out",
        ),
        (LINEAR, OUTPUT.format("\nALLSE, ALLWK"), ""),
        (HARMONIC, "", ""),
    ],
)
def test_columns_that_a_step_does_not_have_are_named(energies_and_warnings, step, lines, message):
    _, warnings = energies_and_warnings(BAR + step.format(lines))
    assert len(warnings) == bool(message)
    for warning in warnings:
        with pytest.raises(ValueError, match=message):
            raise ValueError(warning)


def test_later_steps_keep_or_drop_the_requests(energies_and_warnings):
    """*OUTPUT without OP=ADD drops those of earlier steps; a step without *OUTPUT keeps them."""
    first = STEP.format(OUTPUT.format(", ELSET=LONG\nALLSE"))
    kept, _ = energies_and_warnings(BAR + first + STEP.format(""))
    assert np.isfinite(kept["ALLSE[LONG]"]).tolist() == [True, True]
    dropped, _ = energies_and_warnings(BAR + first + STEP.format(OUTPUT.format("\nALLSE")))
    assert np.isfinite(dropped["ALLSE[LONG]"]).tolist() == [True, False]
