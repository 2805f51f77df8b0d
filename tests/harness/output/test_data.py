# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The data file. Layout of tables: those of the hoist of "Getting Started with Abaqus", section 2.3.8."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from harness.errors import Source
from harness.model.mesh import Mesh
from harness.model.model import Model
from harness.model.nodal import NodalIndex
from harness.model.properties import UserElement
from harness.model.records import IncrementDone, Record, Solution, StepStarted
from harness.model.steps import ElementRequest, NodeRequest
from harness.output.data import DataFile
from harness.output.tables import element_tables, node_tables

Records = Callable[..., Iterator[Record]]
Requests = Callable[..., Model]


def lines(text: str) -> list[str]:
    return [line.rstrip() for line in text.splitlines()]


def test_a_table_of_nodes(model: Model) -> None:
    labels = np.array([101, 102, 103, 104, 105, 106, 107, 108])
    model = replace(model, mesh=Mesh(labels, model.mesh.coordinates, model.mesh.instances))
    displacement = np.array([0.0, 0.0, 7.3531e-4, -4.6698e-3, 1.4706e-3, 0.0, 1.4706e-3, -2.5472e-3, 0.0, -2.5472e-3])
    solution = Solution(np.repeat(np.arange(5), 2), np.tile([1, 2], 5), displacement, np.zeros(10), np.zeros(10))
    text = node_tables(NodeRequest("", np.arange(5), ("U",)), model, solution, NodalIndex(8, solution))
    assert lines(text) == [
        "",
        "",
        "   THE FOLLOWING TABLE IS PRINTED FOR ALL NODES",
        "",
        "       NODE FOOT-   U1          U2",
        "            NOTE",
        "",
        "        102      7.3531E-04 -4.6698E-03",
        "        103      1.4706E-03   0.000",
        "        104      1.4706E-03 -2.5472E-03",
        "        105       0.000     -2.5472E-03",
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
    text = node_tables(NodeRequest("", np.arange(5), ("U1",)), model, solution, NodalIndex(8, solution))
    labels = [line.split()[-1] for line in lines(text) if line.startswith(" AT NODE")]
    assert labels == [str(model.mesh.labels[1]), str(model.mesh.labels[2])]


def test_totals_where_asked_for(model: Model, records: Records) -> None:
    done = next(record for record in records(model, times=(1.0,)) if isinstance(record, IncrementDone))
    request = NodeRequest("BASE", np.array([0, 1]), ("RF2",), totals=True)
    text = node_tables(request, model, done.solution, NodalIndex(8, done.solution))
    assert lines(text)[-2:] == ["", " TOTAL           -2.000"]
    assert "   THE FOLLOWING TABLE IS PRINTED FOR NODES BELONGING TO NODE SET BASE" in lines(text)


def test_a_table_of_zeros_says_so(model: Model, records: Records) -> None:
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    text = node_tables(NodeRequest("LOAD", np.array([6]), ("CF1",)), model, done.solution, NodalIndex(8, done.solution))
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
        "           1   1         101.0       102.0       103.0",
        "           1   2         105.0       106.0       107.0",
        "           1   3         109.0       110.0       111.0",
        "           1   4         113.0       114.0       115.0",
        "           2   1         201.0       202.0       203.0",
        "           2   2         205.0       206.0       207.0",
        "           2   3         209.0       210.0       211.0",
        "           2   4         213.0       214.0       215.0",
        "",
        " MAXIMUM                 213.0       214.0       215.0",
        " ELEMENT                        2           2           2",
        "",
        " MINIMUM                 101.0       102.0       103.0",
        " ELEMENT                        1           1           1",
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
    assert "ABAQUS SUPPORTS NO ELEMENT OUTPUT FOR USER ELEMENTS" in " ".join(text.split())
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
