# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which element forces are terms of the average flux, against what Abaqus prints of a cube pulled along one axis."""

import pytest

from uel.assembly import system_of
from uel.deck import read_deck
from uel.model.controls import FieldControls
from uel.model.records import IterationDone
from uel.procedures import run_steps
from uel.procedures.general.average_flux import FluxHistory
from uel.usersub import load

DECK = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=CUBE
1, 1, 2, 3, 4, 5, 6, 7, 8
*SOLID SECTION, ELSET=CUBE, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
4., 0.3
*BOUNDARY
1, 1, 3
2, 2, 3
4, 1
4, 3
3, 3
5, 1, 2
6, 2
8, 1
*STEP
*STATIC
0.25, 1., , 0.25
*BOUNDARY
5, 3, 3, 4.
6, 3, 3, 4.
7, 3, 3, 4.
8, 3, 3, 4.
*END STEP
"""


def test_zeros_are_terms_in_the_first_increment_alone(tmp_path):
    """Forces of one, two, three, four in one of three directions.

    Abaqus 2023 prints 175, 1050, 1575 and 2100 for such a cube: the second is six times
    the first, the third nine times.
    """
    deck = tmp_path / "cube.inp"
    deck.write_text(DECK)
    model = read_deck(deck)
    library = load(None, job="cube", output_dir=tmp_path)
    system = system_of(model, library)
    records = list(run_steps(system, model, library))
    library.close()
    averages = [record.checks[0].average_flux for record in records if isinstance(record, IterationDone)]
    assert averages == pytest.approx([175 / 525, 1050 / 525, 1575 / 525, 2100 / 525])


def test_floor_is_the_criterion_beside_the_largest_force():
    controls = FieldControls(eps_l=1e-3)
    history = FluxHistory()
    assert history.floor(controls) == -1.0
    history = history.converged(2.0, controls, 20.0).converged(4.0, controls, 40.0)
    assert history.floor(controls) == pytest.approx(3e-2)
    assert history.next_step(controls).floor(controls) == -1.0


def test_zeros_are_terms_until_the_largest_force_is_a_tenth_of_its_average():
    """Two public message files of a cube with heat fluxes, at one and at four of its eight nodes.

    The first increment has a peak. Abaqus prints averages of all eight up to increments 14 and 21, then those of the
    others alone; the largest one over its time average up to then is this, rounded as the fluxes are printed.
    """
    for first, last, nodes, before in ((0.0398, 0.000323, 1, 14), (0.0397, 0.0002176, 4, 21)):
        history, found = FluxHistory(), []
        for number in range(1, before + 3):
            peak = first if number == 1 else last * (1 + 0.002 * (before + 1 - number))
            found.append(history.leaves_out(peak))
            history = history.converged(peak * nodes / 8, FieldControls(), peak)
        assert found == [False] * before + [True] * 2


NODES = DECK[: DECK.index("*ELEMENT")]

HEATED = """\
*NSET, NSET=ALL, GENERATE
1, 8, 1
*ELEMENT, TYPE={type}, ELSET=BODY
{element}
*SOLID SECTION, ELSET=BODY, MATERIAL=M
*MATERIAL, NAME=M
*CONDUCTIVITY
0.5
*PHYSICAL CONSTANTS, ABSOLUTE ZERO=-273.15, STEFAN BOLTZMANN=5.67E-8
*STEP
*HEAT TRANSFER, STEADY STATE
1., 1.
*BOUNDARY
ALL, 11, 11, 30.
{loads}
*END STEP
"""


@pytest.mark.parametrize(
    ("kind", "nodes", "loads", "heat", "terms"),
    [
        # the faces 1 of the cube and the square are 1 in size
        ("DC3D8", 8, "*FILM\n1, F1, 10., 3.", 60.0, 8),
        ("DC3D8", 8, "*DFLUX\n1, S1, 7.", 7.0, 8),
        ("DC3D8", 8, "*DFLUX\n1, BF, 7.", 7.0, 8),
        ("DC3D8", 8, "*RADIATE\n1, R1, 0., 1.", 5.67e-8 * (303.15**4 - 273.15**4), 8),
        ("DC3D8", 8, "*FILM\n1, F1, 10., 3.\n*DFLUX\n1, S1, 7.\n1, S2, 1.", 68.0, 24),
        ("DC2D4", 4, "*FILM\n1, F1, 10., 3.", 60.0, 4),
        ("DC3D8", 8, "*CFILM\n1, 2., 10., 3.", 120.0, 1),
    ],
)
def test_a_heat_load_is_as_many_terms_as_an_element(tmp_path, kind, nodes, loads, heat, terms):
    """All temperatures are 30, so that loads alone have heat fluxes: their sum over the terms of element and loads.

    Public jobs of Abaqus (avias8/Abaqus, Job-1 and Job-3, 2021) print 1.28 and 1.92 where 80 of 400 DC3D8 radiate 4897
    and 7380: over 8 terms of each element and each load. HeatTransfer.msg there has 128, 94.3 and 94.0 with three kinds
    of loads, Amirisfahani/ThermalAbaqus 289 and 286 with films on DC3D20. That of a node is one term by inference.
    """
    element = "1, " + ", ".join(map(str, range(1, nodes + 1)))
    deck = tmp_path / "heat.inp"
    deck.write_text(NODES + HEATED.format(type=kind, element=element, loads=loads))
    model = read_deck(deck)
    library = load(None, job="heat", output_dir=tmp_path)
    system = system_of(model, library)
    *_, checks = (record.checks for record in run_steps(system, model, library) if isinstance(record, IterationDone))
    library.close()
    assert checks[0].average_flux == pytest.approx(heat / (nodes + terms), rel=1e-9)


@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", ["S4R", "S4"])
@pytest.mark.parametrize("loads", ["*DLOAD\n1, P, 5.", "*SURFACE, NAME=TOP\n1, SPOS\n*DSLOAD\nTOP, P, 5."])
def test_a_pressure_on_a_shell_is_eight_times_the_terms_of_its_forces(tmp_path, nlgeom, element_type, loads):
    """A clamped shell, on which the pressure alone has forces: its sum over 12 + 96; moments have no such terms.

    Public jobs of Abaqus 6.14 print averages of 5.448E-03 for 3461 S4R with 1048 pressures (leal26/leafy_wingy) and
    3.972E+03 for 600 with 80 (jrHoss/Abaqus-Scrypting): 96 terms each; the forces of the elements alone would make
    1.862E-02 and 8.2E+03. Averages of moments are those of the elements. Why it is eight times is not known.
    """
    data, _, surface = loads.rpartition("*DSLOAD")
    before, step = (data, "*DSLOAD" + surface) if data else ("", loads)
    lines = [NODES.strip(), "*NSET, NSET=ALL, GENERATE", "1, 4, 1", f"*ELEMENT, TYPE={element_type}, ELSET=BODY"]
    lines += [
        "1, 1, 2, 3, 4",
        "*SHELL SECTION, ELSET=BODY, MATERIAL=M",
        "0.1",
        "*MATERIAL, NAME=M",
        "*ELASTIC",
        "4., 0.3",
    ]
    lines += [before.strip()] if before else []
    lines += [f"*STEP{nlgeom}", "*STATIC", "*BOUNDARY", "ALL, 1, 6", step, "*END STEP", ""]
    deck = tmp_path / "shell.inp"
    deck.write_text("\n".join(lines))
    model = read_deck(deck)
    library = load(None, job="shell", output_dir=tmp_path)
    system = system_of(model, library)
    *_, checks = (record.checks for record in run_steps(system, model, library) if isinstance(record, IterationDone))
    library.close()
    assert checks[0].average_flux == pytest.approx(5.0 / (12 + 96), rel=1e-9)
    assert checks[1].average_flux == 0.0
