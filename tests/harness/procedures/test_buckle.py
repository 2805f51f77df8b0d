# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*BUCKLE: bars with closed forms, Euler's columns of all continuum elements, a ring, plates; preloads and refusals."""

import re

import numpy as np
import pytest
from columns import YOUNG, column, euler, head
from small_decks import body_lines

from uel.errors import DeckError
from uel.solver import buckling

STEP = "*STEP\n*BUCKLE{how}\n{numbers}\n{loads}\n*OUTPUT, FIELD\n"
STEP += "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*END STEP\n"
LENGTH, SPRINGS = 2.0, (3.0, 5.0)
# an upright bar held at its foot, and at its head by springs along 1 and 2
BAR = f"""*NODE, NSET=ALL
1, 0., 0., 0.
2, 0., 0., {LENGTH}
*ELEMENT, TYPE=T3D2, ELSET=BAR
1, 1, 2
*SOLID SECTION, ELSET=BAR, MATERIAL=M
0.5
*MATERIAL, NAME=M
*ELASTIC
1e4
*ELEMENT, TYPE=SPRING1, ELSET=ALONG1
2, 2
*SPRING, ELSET=ALONG1
1
{SPRINGS[0]}
*ELEMENT, TYPE=SPRING1, ELSET=ALONG2
3, 2
*SPRING, ELSET=ALONG2
2
{SPRINGS[1]}
*BOUNDARY
1, 1, 3
"""


@pytest.fixture
def buckle(run_deck):
    def buckle(model, loads, *, numbers="2", how="", before="", name=None, step=STEP):
        return run_deck(model + before + step.format(how=how, numbers=numbers, loads=loads), name=name)

    return buckle


@pytest.mark.parametrize("how", ["", ", EIGENSOLVER=SUBSPACE", ", EIGENSOLVER=LANCZOS"])
def test_bar_between_springs(buckle, how):
    """It turns about its foot at P = k L, in the direction of each spring."""
    result = buckle(BAR, "*CLOAD\n2, 3, -1.", how=how)
    np.testing.assert_allclose(result.history["EIGVAL"], np.array(SPRINGS) * LENGTH)
    np.testing.assert_allclose(result.history["U1[ALL:2]"], [1, 0], atol=1e-12)
    np.testing.assert_allclose(result.history["U2[ALL:2]"], [0, 1], atol=1e-12)


def test_reversed_load(buckle):
    """Eigenvalues are negative, those of smallest magnitude first."""
    result = buckle(BAR, "*CLOAD\n2, 3, 2.")
    np.testing.assert_allclose(result.history["EIGVAL"], -np.array(SPRINGS) * LENGTH / 2)


@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
def test_preload(buckle, nlgeom):
    """A load in the step before shifts the eigenvalue by it; with NLGEOM the bar is shorter by P/(E A) too."""
    preload = f"*STEP{nlgeom}\n*STATIC\n1., 1.\n*CLOAD\n2, 3, -2.5\n*END STEP\n"
    found = buckle(BAR, "*CLOAD\n2, 3, -1.", before=preload).history["EIGVAL"][-2:]
    np.testing.assert_allclose(found, np.array(SPRINGS) * LENGTH - 2.5, rtol=2e-3 if nlgeom else 1e-12)


def test_prescribed_displacement(buckle):
    """The head is pushed by d: P = E A d/L."""
    found = buckle(BAR, "*BOUNDARY\n2, 3, 3, -1e-3", numbers="1").history["EIGVAL"]
    assert found == pytest.approx(SPRINGS[0] * LENGTH / (0.5e4 * 1e-3 / LENGTH))


@pytest.mark.parametrize(
    ("how", "numbers", "count"),
    [
        ("", "2, 8.", 1),
        (", EIGENSOLVER=LANCZOS", "2, 8.", 1),
        (", EIGENSOLVER=LANCZOS", "2, , 8.", 1),
        (", EIGENSOLVER=LANCZOS", "2, 1., 20.", 2),
        ("", "5, , 12, 50", 2),
    ],
)
def test_range_of_eigenvalues(buckle, how, numbers, count):
    assert len(buckle(BAR, "*CLOAD\n2, 3, -1.", how=how, numbers=numbers).history["EIGVAL"]) == count


def test_spring_along_its_line(buckle):
    """SPRINGA in place of the bar."""
    stiff = BAR.replace("TYPE=T3D2", "TYPE=SPRINGA").replace("*SOLID SECTION, ELSET=BAR, MATERIAL=M\n0.5\n", "")
    stiff = stiff.replace("*MATERIAL, NAME=M\n*ELASTIC\n1e4\n", "*SPRING, ELSET=BAR\n\n1e4\n")
    found = buckle(stiff, "*CLOAD\n2, 3, -1.").history["EIGVAL"]
    np.testing.assert_allclose(found, np.array(SPRINGS) * LENGTH)


def test_table_of_eigenvalues(buckle, tmp_path):
    result = buckle(BAR, "*CLOAD\n2, 3, -1.\n*NODE PRINT\nU")
    text = (tmp_path / "deck.dat").read_text()
    assert 'BUCKLING LOAD ESTIMATE = ("DEAD" LOADS) + EIGENVALUE * ("LIVE" LOADS).' in text
    table = text.split("MODE NO      EIGENVALUE")[1].split("\n\n")[1]
    assert [line.split() for line in table.splitlines()] == [["1", "6"], ["2", "10"]]
    np.testing.assert_allclose([frame.time for frame in result.frames if frame.increment], [6.0, 10.0])
    np.testing.assert_allclose(result.field("U", increment=2)[1], [0, 1, 0], atol=1e-12)
    assert re.search(r"MODE     2,  EIGENVALUE +10.0", text)


@pytest.mark.parametrize(
    ("element_type", "error"),
    [
        *((name, 2e-3) for name in ("CPS8", "CPS8R", "CPE8", "CPE8R", "CPE8H", "C3D20", "C3D20R", "C3D20RH")),
        *((name, 1e-2) for name in ("CPS4I", "CPE4I", "C3D8I")),
    ],
)
def test_columns(buckle, element_type, error):
    """First order has chords in place of the line of bending, and so an error of (pi h/2 L)^2/12."""
    # a single row of C3D20R has modes without energy
    cells = (6, 2) if "20R" in element_type else (10, 1)
    top, load = head(element_type)
    found = buckle(column(element_type, cells=cells) + top, load, numbers="1").history["EIGVAL"]
    assert found[0] == pytest.approx(euler(), rel=error)


def test_columns_with_hourglass_control(buckle):
    top, load = head("CPE4R")
    found = buckle(column("CPE4R", cells=(60, 4)) + top, load, numbers="1").history["EIGVAL"]
    assert found[0] == pytest.approx(euler(), rel=5e-3)


@pytest.mark.parametrize(("element_type", "nu"), [("CPE8", 0.3), ("CPE8H", 0.3), ("CPE8RH", 0.5)])
def test_plate_strip(buckle, element_type, nu):
    """Cylindrical bending of a plate: E/(1 - nu^2); with nu = 0.5 the pressure is an unknown."""
    top, load = head(element_type)
    found = buckle(column(element_type, nu=nu) + top, load, numbers="1").history["EIGVAL"]
    assert found[0] == pytest.approx(euler(YOUNG / (1 - nu**2), YOUNG / (2 * (1 + nu))), rel=2e-3)


@pytest.mark.parametrize(("element_type", "nu"), [("CPS8R", 0.3), ("CPE8RH", 0.5)])
def test_iteration_of_large_models(buckle, monkeypatch, element_type, nu):
    """It finds what the dense solution of small ones does, with pressures as unknowns too."""
    top, load = head(element_type)
    dense = buckle(column(element_type, nu=nu) + top, load, numbers="4")
    monkeypatch.setattr(buckling, "DENSE", 0)
    sparse = buckle(column(element_type, nu=nu) + top, load, numbers="4")
    np.testing.assert_allclose(sparse.history["EIGVAL"], dense.history["EIGVAL"], rtol=1e-7)
    np.testing.assert_allclose(sparse.history["U2[ALL:9]"], dense.history["U2[ALL:9]"], atol=1e-6)


@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", ["CPS8R", "C3D8I"])
def test_preloaded_column(buckle, element_type, nlgeom):
    """Dead and live load together are the buckling load; with NLGEOM to the order of the strain, 5e-4."""
    top, load = head(element_type)
    whole = buckle(column(element_type) + top, load, numbers="1").history["EIGVAL"][0]
    part = load.replace("TRVEC, 1.", f"TRVEC, {0.6 * whole}")
    before = f"*STEP{nlgeom}\n*STATIC\n1., 1.\n{part}\n*END STEP\n"
    found = buckle(column(element_type) + top, load, numbers="1", before=before).history["EIGVAL"][-1]
    assert found == pytest.approx(0.4 * whole, rel=3e-3 if nlgeom else 1e-7)


def test_preload_above_the_buckling_load(buckle, monkeypatch):
    top, load = head("CPS8R")
    for dense in (buckling.DENSE, 0):
        monkeypatch.setattr(buckling, "DENSE", dense)
        before = f"*STEP\n*STATIC\n1., 1.\n{load.replace('TRVEC, 1.', f'TRVEC, {1.2 * euler()}')}\n*END STEP\n"
        message = r"deck\.inp:\d+: \*BUCKLE finds no eigenvalues: the base state is not stable"
        with pytest.raises(DeckError, match=message):
            buckle(column("CPS8R") + top, load, numbers="1", before=before)


RING, THIN = 10.0, 0.2


@pytest.mark.parametrize("surface", [True, False])
def test_ring_under_pressure(buckle, surface):
    """3 E I/R^3 for a pressure that stays normal to the ring (4 for one that does not turn).

    (S.P. Timoshenko, Theory of Elastic Stability, rings.) The pressure acts at R + t/2, which is the
    same: the area inside a parallel curve of a middle line that keeps its length changes as that inside the line does.
    """
    cells = 12
    angle = np.linspace(0, np.pi / 2, 2 * cells + 1)
    nodes, numbers = [], {}
    for k, one in enumerate(angle):
        for row, r in enumerate((RING - THIN / 2, RING, RING + THIN / 2)):
            if k % 2 == 0 or row != 1:
                numbers[k, row] = len(nodes)
                nodes.append([r * np.cos(one), r * np.sin(one)])
    places = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]
    elements = [[numbers[2 * c + k, row] for k, row in places] for c in range(cells)]
    lines = [*body_lines("CPE8R", nodes, elements), "*SURFACE, NAME=OUT", "BODY, S2"]
    for name, end in (("X", 0), ("Y", 2 * cells)):
        lines += [f"*NSET, NSET={name}", ", ".join(str(numbers[end, row] + 1) for row in range(3))]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "", "*MATERIAL, NAME=M", f"*ELASTIC\n{YOUNG}, 0."]
    lines += ["*BOUNDARY", "X, 2", "Y, 1", ""]
    load = "*DSLOAD\nOUT, P, 1." if surface else "*DLOAD\nBODY, P2, 0.4\nBODY, P2, 0.6"
    result = buckle("\n".join(lines), load, numbers="1")
    found = result.history["EIGVAL"]
    assert found[0] == pytest.approx(3 * YOUNG * THIN**3 / 12 / RING**3, rel=1e-3)
    assert not result.warnings


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("*BUCKLE\n2", "*BUCKLE", r"deck\.inp:\d+: \*BUCKLE: needs a data line with the number of eigenvalues"),
        ("*BUCKLE\n2", "*BUCKLE\n0", r"number of eigenvalues 0 must be positive"),
        ("*BUCKLE\n2", "*BUCKLE, EIGENSOLVER=LANCZOS\n2, 3., 1.", r"lowest eigenvalue 3 is not below the highest, 1"),
        ("*BUCKLE\n2", "*BUCKLE, EIGENSOLVER=AMS\n2", r"EIGENSOLVER=AMS"),
        ("*CLOAD\n2, 3, -1.", "", r"deck\.inp:\d+: \*BUCKLE: the loads of the step cause no stress"),
        ("*CLOAD\n2, 3, -1.", "*BOUNDARY, LOAD CASE=2\n2, 1", r"LOAD CASE"),
        ("*CLOAD\n", "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*CLOAD, AMPLITUDE=A\n", "amplitude has no meaning in a step"),
    ],
)
def test_what_is_wrong_is_named(buckle, old, new, message):
    changed = STEP.format(how="", numbers="2", loads="*CLOAD\n2, 3, -1.").replace(old, new)
    with pytest.raises(DeckError, match=message):
        buckle(BAR, "", step=changed.replace("{", "{{").replace("}", "}}"))


@pytest.mark.parametrize(
    ("element_type", "material", "reason"),
    [
        ("C3D8T", "*CONDUCTIVITY\n1.\n*SPECIFIC HEAT\n1.\n*DENSITY\n1.", "they have displacements and temperatures"),
        ("U1", "", "no call asks them for their initial stress matrix"),
    ],
)
def test_elements_without_an_initial_stress_matrix(buckle, element_type, material, reason):
    nodes = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    count = {"C3D8T": 8}.get(element_type, 4)
    lines = ["*USER ELEMENT, TYPE=U1, NODES=4, COORDINATES=3", "1, 2, 3"] if element_type == "U1" else []
    lines += body_lines(element_type, nodes[:count], [range(count)])
    section = {"U1": "*UEL PROPERTY, ELSET=BODY"}
    lines += [section.get(element_type, "*SOLID SECTION, ELSET=BODY, MATERIAL=M")]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC\n1., 0.", *([material] if material else []), ""]
    message = rf"deck\.inp:\d+: \*BUCKLE is not supported for .*{element_type}.*: {reason}"
    with pytest.raises(DeckError, match=message):
        buckle("\n".join(lines), "*CLOAD\n2, 1, -1.")


def test_shear_that_follows_its_face(buckle):
    top, _ = head("CPS8")
    with pytest.raises(DeckError, match=r"load type TRSHR follows the surface: its load stiffness is not supported"):
        buckle(column("CPS8") + top, "*DSLOAD\nTOP, TRSHR, 1., 0., 1.")


def test_pressure_on_a_face_with_a_free_edge(buckle):
    """It has no potential: its load stiffness is not symmetric."""
    top, _ = head("CPS8R")
    result = buckle(column("CPS8R") + top, "*DSLOAD\nTOP, P, 1.", numbers="1")
    (warning,) = result.warnings
    assert "LOAD STIFFNESS OF PRESSURES IS NOT SYMMETRIC" in warning


CASES = "*BOUNDARY, OP=NEW, LOAD CASE=1\n1, 1, 3\n*BOUNDARY, OP=NEW, LOAD CASE=2\n{}\n*CLOAD\n2, 3, -1."


def test_supports_of_the_modes_are_those_of_the_loads(buckle):
    """Abaqus/CAE writes both load cases, which hold the same dofs."""
    result = buckle(BAR, CASES.format("1, 1, 2\n1, 3"))
    np.testing.assert_allclose(result.history["EIGVAL"], np.array(SPRINGS) * LENGTH)


@pytest.mark.parametrize(
    ("loads", "message"),
    [
        (CASES.format("1, 1, 2"), "LOAD CASE=2 holds other dofs than LOAD CASE=1: modes with supports of their own"),
        (CASES.format("1, 1, 3").replace("CASE=2", "CASE=3"), "LOAD CASE=3: expected 1 or 2"),
    ],
)
def test_other_supports_of_the_modes(buckle, loads, message):
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: \*BOUNDARY: {message}"):
        buckle(BAR, loads)


def test_load_cases_of_other_steps(buckle):
    static = "*STEP\n*STATIC\n{loads}\n*END STEP\n"
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*BOUNDARY: LOAD CASE is for \*BUCKLE"):
        buckle(BAR, "*BOUNDARY, LOAD CASE=1\n1, 1", step=static)
