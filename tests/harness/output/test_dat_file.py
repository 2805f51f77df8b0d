# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The data file. Layout of tables: those of the hoist of "Getting Started with Abaqus", section 2.3.8."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.errors import Source
from uel.model.mesh import Mesh
from uel.model.model import Equation, Model
from uel.model.nodal_variables import NodalIndex
from uel.model.properties import UserElement
from uel.model.records import IncrementDone, PointVariables, Record, Solution, StepStarted
from uel.model.steps import ElementRequest, NodeRequest
from uel.output.files.dat_file import DataFile
from uel.output.files.tables import element_tables, missing_variables, node_tables

Records = Callable[..., Iterator[Record]]
Requests = Callable[..., Model]


def lines(text: str) -> list[str]:
    return [line.rstrip() for line in text.splitlines()]


def test_a_table_of_nodes(model: Model) -> None:
    labels = np.array([101, 102, 103, 104, 105, 106, 107, 108])
    model = replace(model, mesh=Mesh(labels, model.mesh.coordinates, model.mesh.instances))
    displacement = np.array([0.0, 0.0, 7.3531e-4, -4.6698e-3, 1.4706e-3, 0.0, 1.4706e-3, -2.5472e-3, 0.0, -2.5472e-3])
    solution = Solution(np.repeat(np.arange(5), 2), np.tile([1, 2], 5), displacement, np.zeros(10), np.zeros(10))
    text = node_tables(NodeRequest("", np.arange(5), ("U",)), model, solution, NodalIndex(8, solution), nlgeom=False)
    assert lines(text) == [
        "",
        "",
        "   THE FOLLOWING TABLE IS PRINTED FOR ALL NODES",
        "",
        "       NODE FOOT-  U1             U2",
        "            NOTE",
        "",
        "        102      7.3531000E-04 -4.6698000E-03",
        "        103      1.4706000E-03  0.0000000E+00",
        "        104      1.4706000E-03 -2.5472000E-03",
        "        105      0.0000000E+00 -2.5472000E-03",
        "",
        " MAXIMUM         1.4706E-03   0.000",
        " AT NODE               103         101",
        "",
        " MINIMUM          0.000     -4.6698E-03",
        " AT NODE               101         102",
    ]


@pytest.mark.parametrize("rounding", [1 - 1e-14, 1, 1 + 1e-14])
def test_first_of_equal_extremes_is_named(model: Model, rounding: float) -> None:
    displacement = np.array([0.0, 1.0, -2.0, 1.0 * rounding, -2.0 * rounding])
    solution = Solution(np.arange(5), np.ones(5, dtype=int), displacement, np.zeros(5), np.zeros(5))
    text = node_tables(NodeRequest("", np.arange(5), ("U1",)), model, solution, NodalIndex(8, solution), nlgeom=False)
    labels = [line.split()[-1] for line in lines(text) if line.startswith(" AT NODE")]
    assert labels == [str(model.mesh.labels[1]), str(model.mesh.labels[2])]


@pytest.mark.parametrize(
    ("nlgeom", "rows"),
    [
        (False, ["3      2.0000000E+00  1.0000000E+00", "8      0.0000000E+00  2.0000000E+00"]),
        (True, ["3      2.0000000E+00  1.5000000E+00", "8      0.0000000E+00  3.0000000E+00"]),
    ],
)
def test_coordinates_are_those_of_the_moved_nodes_with_nlgeom(
    model: Model, records: Records, nlgeom: bool, rows: list[str]
) -> None:
    done = next(record for record in records(model, times=(0.5,)) if isinstance(record, IncrementDone))
    request, index = NodeRequest("", np.array([2, 7]), ("COORD",)), NodalIndex(8, done.solution)
    text = node_tables(request, model, done.solution, index, nlgeom=nlgeom)
    assert "       NODE FOOT-  COOR1          COOR2" in lines(text)
    assert [line.strip() for line in lines(text)[7:9]] == rows
    second = node_tables(replace(request, variables=("COOR2",)), model, done.solution, index, nlgeom=nlgeom)
    assert [line.split()[1] for line in lines(second)[7:9]] == [row.split()[2] for row in rows]


def test_nodes_of_no_element_are_left_out(with_requests: Requests, records: Records, tmp_path: Path) -> None:
    model = with_requests(node_print=(NodeRequest("", np.arange(8), ("COORD",)),))
    assert " NUMBER OF NODES IS 8 " in " ".join(describe(model, tmp_path).split())
    model = replace(model, groups=model.groups[1:])
    text = describe(model, tmp_path)
    assert " NUMBER OF NODES IS 4 " in " ".join(text.split())
    assert " ***NOTE: 4 NODES BELONG TO NO ELEMENT AND NO CONSTRAINT, LEFT OUT: 1 AND OTHERS\n" in text
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    index = NodalIndex(8, done.solution)
    table = node_tables(model.steps[0].output.node_print[0], model, done.solution, index, nlgeom=False)
    assert [line.split()[0] for line in lines(table) if line[:11].strip().isdigit()] == ["3", "4", "5", "6"]
    held = Equation(((0, 1, 1.0), (1, 1, -1.0), (6, 1, 1.0), (7, 1, 1.0)), Source("deck.inp", 9))
    assert "LEFT OUT" not in describe(replace(model, equations=(held,)), tmp_path)


def describe(model: Model, folder: Path) -> str:
    DataFile(folder / "job.dat", model)
    return (folder / "job.dat").read_text()


def test_totals_where_asked_for(model: Model, records: Records) -> None:
    done = next(record for record in records(model, times=(1.0,)) if isinstance(record, IncrementDone))
    request = NodeRequest("BASE", np.array([0, 1]), ("RF2",), totals=True)
    text = node_tables(request, model, done.solution, NodalIndex(8, done.solution), nlgeom=False)
    assert lines(text)[-2:] == ["", " TOTAL           -2.000"]
    assert "   THE FOLLOWING TABLE IS PRINTED FOR NODES BELONGING TO NODE SET BASE" in lines(text)


def test_a_table_of_zeros_says_so(model: Model, records: Records) -> None:
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    request, index = NodeRequest("LOAD", np.array([6]), ("CF1",)), NodalIndex(8, done.solution)
    text = node_tables(request, model, done.solution, index, nlgeom=False)
    assert lines(text)[-1] == "          ALL VALUES IN THIS TABLE ARE ZERO"


def test_a_table_of_integration_points(model: Model, records: Records) -> None:
    """SVARS are 100 x element + position: S11 of point k of element 1 is 101 + 4 (k - 1)."""
    done = next(record for record in records(model, times=(1.0,)) if isinstance(record, IncrementDone))
    text = element_tables(ElementRequest("BULK", np.array([0, 1, 2]), ("S",)), model, done.solution)
    assert lines(text)[2:] == [
        "   THE FOLLOWING TABLE IS PRINTED FOR ELEMENTS WITH TYPE U1 AT THE INTEGRATION POINTS AND BELONGING TO "
        "ELEMENT SET BULK",
        "",
        "    ELEMENT  PT FOOT-       S11         S22         S12",
        "                NOTE",
        "",
        "           1   1          101.0       102.0       103.0",
        "           1   2          105.0       106.0       107.0",
        "           1   3          109.0       110.0       111.0",
        "           1   4          113.0       114.0       115.0",
        "           2   1          201.0       202.0       203.0",
        "           2   2          205.0       206.0       207.0",
        "           2   3          209.0       210.0       211.0",
        "           2   4          213.0       214.0       215.0",
        "",
        " MAXIMUM                 213.0       214.0       215.0",
        " ELEMENT                     2           2           2",
        "",
        " MINIMUM                 101.0       102.0       103.0",
        " ELEMENT                     1           1           1",
    ]


@pytest.mark.parametrize(
    ("variables", "heads"),
    [
        (("SDV3", "SDV4"), [["SDV3", "SDV4"]]),
        (("SDV",), [[f"SDV{k}" for k in range(1, 10)], [f"SDV{k}" for k in range(10, 15)]]),
        (("DAMAGE", "TN"), [["DAMAGE", "TN"]]),
        (("SDV3", "DAMAGE"), [["DAMAGE"], ["SDV3"]]),
        (("S",), []),
    ],
)
def test_variables_of_user_elements(
    model: Model, records: Records, variables: tuple[str, ...], heads: list[list[str]]
) -> None:
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    text = element_tables(ElementRequest("CZ", np.array([2]), variables), model, done.solution)
    assert [line.split()[3:] for line in lines(text) if "FOOT-" in line] == heads


def test_state_variables_of_built_in_elements_are_those_of_umat(model: Model, records: Records) -> None:
    """SVARS of a built-in element are the host's own."""
    done = next(record for record in records(model, times=(1.0,)) if isinstance(record, IncrementDone))
    built_in = replace(model, groups=(replace(model.groups[0], type="CPE4", definition=None), *model.groups[1:]))
    request = ElementRequest("BULK", np.array([0]), ("SDV",))
    assert not element_tables(request, built_in, done.solution)
    index = NodalIndex(8, done.solution)
    assert missing_variables(request, built_in, done.solution, index) == ["SDV"]
    named = replace(done.solution.elements[0], variables=PointVariables("continuum", ("S11", "SDV1", "SDV2", "X"), 4))
    solution = replace(done.solution, elements=(named, *done.solution.elements[1:]))
    text = element_tables(request, built_in, solution)
    assert "    ELEMENT  PT FOOT-       SDV1        SDV2" in lines(text)
    assert "           1   2          105.0       106.0" in lines(text)
    assert missing_variables(replace(request, variables=("SDV2", "SDV3")), built_in, solution, index) == ["SDV3"]


def test_energies_of_the_model(with_requests: Requests, records: Records, tmp_path: Path) -> None:
    model = with_requests(energy_print=2)
    file = DataFile(tmp_path / "job.dat", model)
    for record in records(model):
        if isinstance(record, IncrementDone):
            file.increment(record, last=record.increment == 4)
    found = lines((tmp_path / "job.dat").read_text())
    assert found.count("                    E N E R G Y   O U T P U T") == 2
    assert [line for line in found if "STRAIN ENERGY" in line] == [
        "            RECOVERABLE STRAIN ENERGY                   6.250000E-02",
        "            RECOVERABLE STRAIN ENERGY                    1.00000",
    ]
    assert "            THE FOLLOWING TABLE IS PRINTED FOR THE WHOLE MODEL AT T =    1.00000" in found


def test_the_deck_is_echoed_with_line_numbers(model: Model, tmp_path: Path) -> None:
    DataFile(tmp_path / "job.dat", model)
    assert (
        "       1  *HEADING\n       2  two quads and an interface\n       3  *NODE\n"
        in (tmp_path / "job.dat").read_text()
    )


def test_what_was_read_is_described(model: Model, tmp_path: Path) -> None:
    source = Source("deck.inp", 3)
    definition = UserElement(7, 5, ((0, 1), (0, 2), (1, 1), (1, 2), (2, 11)), source, unsymmetric=True, variables=60)
    model = replace(
        model,
        groups=(replace(model.groups[0], type="U7", definition=definition),),
        ignored=(*(("RESTART", Source("deck.inp", line)) for line in (7, 9, 11, 13)), ("PREPRINT", source)),
        warnings=("deck.inp:12: *BOUNDARY names dof 3, which no element uses",),
    )
    DataFile(tmp_path / "job.dat", model)
    text = (tmp_path / "job.dat").read_text()
    assert "          NUMBER OF ELEMENTS IS                                     2\n" in text
    assert "     TYPE U7\n" in text
    assert "          NUMBER OF SOLUTION-DEPENDENT VARIABLES                   60\n" in text
    assert "          NODES 1 TO 2         DEGREES OF FREEDOM 1, 2\n" in text
    assert "          NODE 3               DEGREES OF FREEDOM 11\n" in text
    assert "          NODES 4 TO 5         DEGREES OF FREEDOM NONE\n" in text
    assert "UNSYMMETRIC" in text
    assert "ABAQUS DOES NOT SUPPORT ELEMENT OUTPUT FOR USER ELEMENTS" in " ".join(text.split())
    assert "          RESTART                  deck.inp:7, deck.inp:9, deck.inp:11 and 1 more\n" in text
    assert "          PREPRINT                 deck.inp:3\n" in text
    assert " ***WARNING: deck.inp:12: *BOUNDARY names dof 3, which no element uses\n" in text


def test_tables_are_printed_at_their_frequency(with_requests: Requests, records: Records, tmp_path: Path) -> None:
    model = with_requests(
        node_print=(NodeRequest("LOAD", np.array([6]), ("U2",), frequency=2),),
        element_print=(ElementRequest("CZ", np.array([2]), ("TN",), frequency=4),),
    )
    file = DataFile(tmp_path / "job.dat", model)
    for record in records(model):
        if isinstance(record, StepStarted):
            file.step_started(record)
        if isinstance(record, IncrementDone):
            file.increment(record, last=record.increment == 4)
    file.close(None)
    found = lines((tmp_path / "job.dat").read_text())
    assert [line.split()[1] for line in found if line.endswith(" SUMMARY")] == ["2", "4"]
    assert found.count("                                N O D E   O U T P U T") == 2
    assert found.count("                             E L E M E N T   O U T P U T") == 1
    assert " STEP TIME COMPLETED       0.250    ,  TOTAL TIME COMPLETED        0.250" in found
    assert "          THE ANALYSIS HAS BEEN COMPLETED" in found


def test_what_is_not_available_is_named_once_a_step(with_requests: Requests, records: Records, tmp_path: Path) -> None:
    model = with_requests(
        node_print=(NodeRequest("LOAD", np.array([6]), ("U2", "UR3")),),
        element_print=(ElementRequest("CZ", np.array([2]), ("S", "TN", "SDV15")),),
    )
    file = DataFile(tmp_path / "job.dat", model)
    for record in records(model):
        if isinstance(record, IncrementDone):
            file.increment(record, last=False)
    warnings = [line for line in lines((tmp_path / "job.dat").read_text()) if "***WARNING" in line]
    assert warnings == [
        " ***WARNING: *NODE PRINT, NSET=LOAD: UR3 IS NOT AVAILABLE AND IS LEFT OUT",
        " ***WARNING: *EL PRINT, ELSET=CZ: S IS NOT AVAILABLE AND IS LEFT OUT",
        " ***WARNING: *EL PRINT, ELSET=CZ: SDV15 IS NOT AVAILABLE AND IS LEFT OUT",
    ]
