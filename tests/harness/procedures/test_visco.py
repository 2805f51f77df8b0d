# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*VISCO with *VISCOELASTIC and *CREEP: jobs against closed forms, CETOL, energies, refusals."""

import numpy as np
import pytest
from reference_cells import unit_cell
from small_decks import body_lines

from uel.errors import DeckError

CUBE = unit_cell("hexahedron")[0]
E = 1000.0
PRONY = "*ELASTIC, MODULI=INSTANTANEOUS\n1000., 0.3\n*VISCOELASTIC, TIME=PRONY\n0.5, 0.5, 2."
NORTON = "*ELASTIC\n1000., 0.3\n*CREEP, LAW=TIME\n1e-6, 3., 0."
FREE = ["1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2", "2, 3", "3, 3", "4, 3"]
PULLED = [f"{node}, 1, 1, 0.01" for node in (2, 3, 6, 7)]


def deck(material, visco, *, element_type="C3D8", first=("*BOUNDARY", *PULLED), more="", nlgeom=""):
    """A unit cube, free to the sides, that is pulled in a static step and held in *VISCO."""
    lines = body_lines(element_type, CUBE, [range(8)])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", material, more]
    lines += [
        f"*STEP{nlgeom}",
        "*STATIC",
        "1., 1.",
        "*CONTROLS, PARAMETERS=FIELD",
        "1e-9, 1e-9",
        "*BOUNDARY",
        *FREE,
        *first,
    ]
    output = ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF", "*ENERGY OUTPUT", "*END STEP"]
    lines += [*output, f"*STEP{nlgeom}, INC=1000", visco, *output]
    return "\n".join(line for line in lines if line) + "\n"


def pulls(history):
    """Force of the face that is pulled."""
    return sum(history[f"RF1[ALL:{node}]"] for node in (2, 3, 6, 7))


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8I"])
def test_relaxation(run_deck, element_type):
    """With g = k Poisson's ratio is constant, and the modulus E (1/2 + exp(-t/tau)/2); what goes is dissipated."""
    history = run_deck(deck(PRONY, "*VISCO, CETOL=1e-4\n0.1, 6.", element_type=element_type)).history
    force = pulls(history)
    assert force[0] == pytest.approx(0.01 * E, rel=1e-9)
    assert force[-1] == pytest.approx(0.01 * E * (0.5 + 0.5 * np.exp(-3.0)), rel=1e-9)
    stored = 0.5 * E * 0.01**2 * np.array([1, 0.5 + 0.5 * np.exp(-6.0)])
    np.testing.assert_allclose(history["ALLSE"][[0, -1]], stored, rtol=1e-9)
    np.testing.assert_allclose(history["ALLCD"][[0, -1]], [0, stored[0] - stored[1]], rtol=1e-9, atol=1e-15)
    np.testing.assert_array_equal(history["ALLPD"], 0)


def test_norton(run_deck):
    """A constant stress: the creep strain is A stress^n t, beside that of the elasticity."""
    first = ["*CLOAD", *(f"{node}, 1, 5." for node in (2, 3, 6, 7))]
    history = run_deck(deck(NORTON, "*VISCO, CETOL=1.\n0.1, 2.", first=first)).history
    assert history["U1[ALL:2]"][-1] == pytest.approx(20 / E + 1e-6 * 20**3 * 2, rel=1e-8)
    assert history["U2[ALL:3]"][-1] == pytest.approx(-0.3 * 20 / E - 0.5e-6 * 20**3 * 2, rel=1e-8)
    # work of the constant load
    assert history["ALLCD"][-1] == pytest.approx(20 * 1e-6 * 20**3 * 2, rel=1e-8)


def test_tolerance(run_deck):
    """A smaller CETOL takes more increments, and comes closer to stress^(1 - n) = start^(1 - n) + (n - 1) A E t."""
    expected = (10.0**-2 + 2 * 1e-6 * E * 20) ** -0.5
    errors, counts = [], []
    for tolerance in ("1e-2", "1e-5"):
        history = run_deck(deck(NORTON, f"*VISCO, CETOL={tolerance}\n0.1, 20.")).history
        errors.append(abs(pulls(history)[-1] - expected))
        counts.append(len(history["time"]))
    assert counts[1] > 2 * counts[0]
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 0.02 * expected


def test_increments_are_fixed_without_a_tolerance(run_deck):
    history = run_deck(deck(NORTON, "*VISCO\n0.25, 1.")).history
    assert len(history["time"]) == 5


ERRORS = [
    (PRONY, {"more": "*PLASTIC\n1."}, r"\*VISCOELASTIC beside \*PLASTIC is not supported"),
    (NORTON, {"more": "*PLASTIC\n1."}, r"\*CREEP beside \*PLASTIC is not supported"),
    (PRONY, {"more": "*CREEP\n1., 2."}, r"\*VISCOELASTIC beside \*CREEP is not supported"),
    ("*CREEP\n1., 2.", {}, r"material M has no \*ELASTIC, \*HYPERELASTIC"),
    (
        PRONY,
        {"more": "*INITIAL CONDITIONS, TYPE=STRESS\nBODY, 1., 0., 0., 0., 0., 0."},
        r"TYPE=STRESS beside \*VISCOELASTIC is not supported .*\(material M",
    ),
]


@pytest.mark.parametrize(("material", "options", "message"), ERRORS)
def test_errors_of_decks(run_deck, material, options, message):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*" + message):
        run_deck(deck(material, "*VISCO\n1., 1.", **options))


def test_hybrid_elements_are_refused(run_deck):
    text = deck(PRONY, "*VISCO\n1., 1.", element_type="C3D8H")
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*VISCOELASTIC is not supported for elements of type C3D8H"):
        run_deck(text)


def test_coupled_elements_are_refused(run_deck):
    step = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1."
    text = deck(PRONY, step, element_type="C3D8T", more="*CONDUCTIVITY\n1.").replace("*STATIC\n1., 1.", step)
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*VISCOELASTIC is not supported for elements of type C3D8T"):
        run_deck(text)


def test_linear_perturbations_are_refused(run_deck):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*FREQUENCY is not supported for material M"):
        run_deck(deck(NORTON, "*FREQUENCY\n1", more="*DENSITY\n1."))
