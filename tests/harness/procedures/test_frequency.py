# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*FREQUENCY: a pair of masses and springs, bars, a beam that is pulled; frequencies from vibration theory."""

from pathlib import Path

import numpy as np
import pytest
from vibrating import PAIR, bar

from uel.errors import DeckError

STEP = """*STEP{options}
*FREQUENCY{how}
{number}
{more}
*OUTPUT, FIELD
*OUTPUT, HISTORY, OP=ADD
*NODE OUTPUT, NSET=ALL
U1
*END STEP
"""
CYCLES = 2 * np.pi
# of k/m (2, -1; -1, 1): S. Timoshenko, Vibration Problems in Engineering, two masses in a row
SQUARES = 4.0 * (3 + np.array([-1, 1]) * np.sqrt(5)) / 2


@pytest.fixture
def extract_modes(run_deck):
    def extract_modes(model, number, *, how="", options="", more="", before="", after="", user=None):
        step = STEP.format(number=number, how=how, options=options, more=more)
        return run_deck(model + before + step + after, user)

    return extract_modes


@pytest.mark.parametrize("options", ["", ", PERTURBATION"])
def test_two_masses(extract_modes, options):
    history = extract_modes(PAIR, "2", options=options).history
    np.testing.assert_allclose(history["EIGVAL"], SQUARES)
    np.testing.assert_allclose(history["EIGFREQ"], np.sqrt(SQUARES) / CYCLES)
    # shapes with a largest displacement of one
    shapes = np.array([history["U1[ALL:2]"], history["U1[ALL:3]"]]).T
    golden = (np.sqrt(5) - 1) / 2
    np.testing.assert_allclose(shapes, [[golden, 1], [1, -golden]])
    np.testing.assert_allclose(history["GM"], 2 * (1 + golden**2))


@pytest.mark.parametrize("how", ["", ", NORMALIZATION=MASS"])
@pytest.mark.parametrize("masses", ["2., 2.", "2., 2.000000001", "2.000000001, 2."])
def test_sign_of_an_antisymmetric_shape(extract_modes, masses, how):
    """Two masses between walls: the first moves forwards, whatever rounding, here a mass, makes of its size."""
    between = PAIR.replace("3, 2.\n", "3, 2.\n4, 3.\n").replace("2, 2, 3\n", "2, 2, 3\n5, 3, 4\n")
    first, second = masses.split(", ")
    model = between.replace(
        "4, 3\n*MASS, ELSET=M\n2.",
        f"*MASS, ELSET=M\n{first}\n*ELEMENT, TYPE=MASS, ELSET=N\n4, 3\n*MASS, ELSET=N\n{second}",
    )
    history = extract_modes(model + "4, 1\n", "2", how=how).history
    size = 1.0 if not how else 0.5
    np.testing.assert_allclose([history["U1[ALL:2]"], history["U1[ALL:3]"]], [[size, size], [size, -size]], rtol=1e-6)


def test_normalized_by_mass(extract_modes):
    history = extract_modes(PAIR, "2", how=", NORMALIZATION=MASS").history
    np.testing.assert_allclose(history["GM"], 1)
    masses = 2 * (history["U1[ALL:2]"] ** 2 + history["U1[ALL:3]"] ** 2)
    np.testing.assert_allclose(masses, 1)


@pytest.mark.parametrize(("number", "found"), [(", , 0.3", [0]), ("5, 0.3", [1]), ("1", [0]), ("7", [0, 1])])
def test_number_and_range(extract_modes, number, found):
    np.testing.assert_allclose(extract_modes(PAIR, number).history["EIGVAL"], SQUARES[found])


@pytest.mark.parametrize("elements", [20, 400])
def test_a_bar_between_walls(extract_modes, elements):
    """Lumped masses: omega = 2 n c sin(k pi / 2 n), the discrete chain; by all eigenvalues and by the nearest ones."""
    model = bar(elements, more=f"1, 1\n{elements + 1}, 1\n")
    k = np.arange(1, 6)
    expected = 2 * elements * 2.0 * np.sin(k * np.pi / (2 * elements)) / CYCLES
    np.testing.assert_allclose(extract_modes(model, "5").history["EIGFREQ"], expected, rtol=1e-9)


@pytest.mark.parametrize("elements", [20, 400])
def test_a_free_bar_moves_as_a_whole(extract_modes, elements):
    history = extract_modes(bar(elements), "3").history
    k = np.arange(3)
    expected = 2 * elements * 2.0 * np.sin(k * np.pi / (2 * elements)) / CYCLES
    np.testing.assert_allclose(history["EIGFREQ"], expected, rtol=1e-7, atol=1e-4)


def test_equations_tie_modes(extract_modes):
    """Both masses move together: 4 masses units on one spring."""
    model = PAIR.replace("*BOUNDARY", "*EQUATION\n2\n3, 1, 1., 2, 1, -1.\n*BOUNDARY")
    np.testing.assert_allclose(extract_modes(model, "1").history["EIGVAL"], 8 / 4)


def test_about_the_base_state(extract_modes):
    """A string under the tension T: omega^2 = 2 T / (L m) for one mass between two lengths L; nothing of it goes on."""
    string = PAIR.replace("4, 3\n", "")
    pull = "*STEP, NLGEOM\n*STATIC\n*BOUNDARY\n2, 1, 1, 0.25\n3, 1, 1, 0.5\n*END STEP\n"
    free = "*BOUNDARY, OP=NEW\nALL, 3\nALL, 1\n1, 2\n3, 2"
    stay = "*STEP\n*STATIC\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU1, U2\n*END STEP\n"
    history = extract_modes(string, "1", before=pull, more=free, after=stay).history
    tension, length = 8 * 0.25, 1.25
    assert history["EIGVAL"][-2] == pytest.approx(2 * tension / (length * 2))
    assert history["time"][-1] == pytest.approx(2)
    assert history["U1[ALL:3]"][-1] == pytest.approx(0.5)
    assert history["U2[ALL:2]"][-1] == 0


USER_ELEMENT = """*NODE, NSET=ALL
1, 0.
*USER ELEMENT, TYPE=U1, NODES=1, COORDINATES=1, VARIABLES=1
1
*ELEMENT, TYPE=U1, ELSET=E
1, 1
*UEL PROPERTY, ELSET=E
"""
UEL = f"""      INCLUDE '{Path(__file__).parents[1] / "uel.inc"}'
      WRITE(7,'(A,5I4)') 'FLAGS', LFLAGS(1:5)
      AMATRX = 0
      RHS(1,1) = -9*U(1)
      IF (LFLAGS(3) .EQ. 2 .AND. LFLAGS(4) .EQ. 1) AMATRX = 9
      IF (LFLAGS(3) .EQ. 4) AMATRX = 4
      END
"""


def test_user_elements_are_asked_for_stiffness_and_mass(extract_modes):
    result = extract_modes(USER_ELEMENT, "1", user=UEL)
    np.testing.assert_allclose(result.history["EIGVAL"], 9 / 4)
    lines = result.file(".msg").read_text().splitlines()
    flags = [line.split()[1:] for line in lines if line.startswith("FLAGS")]
    assert flags[-2:] == [["41", "0", "2", "1", "0"], ["41", "0", "4", "1", "0"]]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("*MASS, ELSET=M\n2.", "*MASS, ELSET=M\n0.", r"deck.inp:\d+: \*MASS|no element has mass"),
        ("*FREQUENCY\n2", "*FREQUENCY\n2, , , 4.", "a shift point and sizes of blocks are not supported"),
        ("*FREQUENCY\n2", "*FREQUENCY\n", r"\*FREQUENCY: needs a number of eigenvalues, or a highest frequency"),
        ("*FREQUENCY\n2", "*FREQUENCY\n2, 5., 4.", "the lowest frequency 5 is not below the highest, 4"),
        ("*FREQUENCY\n2", "*FREQUENCY, EIGENSOLVER=AMS\n2", "EIGENSOLVER=AMS is not supported"),
        ("8.", "-8.", "finds no eigenvalues: the base state is far from stable"),
    ],
)
def test_what_is_wrong_is_named(extract_modes, monkeypatch, old, new, message):
    monkeypatch.setattr(f"{__name__}.STEP", STEP.format(options="", how="", number=2, more="").replace(old, new))
    with pytest.raises(DeckError, match=message):
        extract_modes(PAIR.replace(old, new), "2")


def test_what_is_written(extract_modes):
    result = extract_modes(PAIR, "2", more="*NODE PRINT\nU1")
    assert [(row.step, row.increment, row.iterations) for row in result.status] == [(1, 1, 1)]
    np.testing.assert_allclose(result.field("U", increment=2)[:, 0], [0, 1, -(np.sqrt(5) - 1) / 2], rtol=1e-6)
    data = result.file(".dat").read_text()
    assert "       1          1.5279          1.2361         0.19673          2.7639\n" in data
    assert " MODE     2,  FREQUENCY (CYCLES/TIME)  0.515" in data
    assert "NATURAL   F R E Q U E N C I E S" in data.replace("N A T U R A L", "NATURAL")
