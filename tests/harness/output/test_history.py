# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.model.records import IncrementDone, Record
from uel.model.steps import NodeRequest
from uel.output.files.history import HistoryFile, read_history

Records = Callable[..., Iterator[Record]]
Requests = Callable[..., Model]


def write(model: Model, path: Path, records: Iterator[Record]) -> HistoryFile:
    file = HistoryFile(path, model)
    for record in records:
        if isinstance(record, IncrementDone):
            file.write(record, last=False)
    file.close()
    return file


@pytest.mark.parametrize(
    ("request_", "columns"),
    [
        (NodeRequest("LOAD", np.array([6]), ("U2", "RF2")), ["U2[LOAD]", "RF2[LOAD]"]),
        (NodeRequest("LOAD", np.array([6]), ("U",)), ["U1[LOAD]", "U2[LOAD]"]),
        (NodeRequest("TOP", np.array([6, 7]), ("RF2",)), ["RF2[TOP:7]", "RF2[TOP:8]"]),
        (NodeRequest("", np.array([0, 1]), ("CF1",)), ["CF1[1]", "CF1[2]"]),
        (NodeRequest("LOAD", np.array([6]), ("U", "U2")), ["U1[LOAD]", "U2[LOAD]"]),
    ],
)
def test_columns(
    with_requests: Requests, records: Records, tmp_path: Path, request_: NodeRequest, columns: list[str]
) -> None:
    model = with_requests(history_nodes=(request_,), history_energies=("ALLSE",))
    write(model, tmp_path / "h.csv", records(model))
    assert list(read_history(tmp_path / "h.csv")) == ["step", "increment", "time", *columns, "ALLSE"]


def test_nodes_of_an_instance_carry_its_name(with_requests: Requests, records: Records, tmp_path: Path) -> None:
    model = with_requests(history_nodes=(NodeRequest("TOP", np.array([6, 7]), ("RF2",)),), history_energies=())
    model = replace(model, mesh=Mesh(model.mesh.labels, model.mesh.coordinates, ("PART-1",) * 8))
    write(model, tmp_path / "h.csv", records(model))
    assert list(read_history(tmp_path / "h.csv"))[3:] == ["RF2[TOP:PART-1.7]", "RF2[TOP:PART-1.8]"]


def test_values_are_kept_to_the_last_digit(model: Model, records: Records, tmp_path: Path) -> None:
    write(model, tmp_path / "h.csv", records(model, times=(0.1, 1 / 3)))
    history = read_history(tmp_path / "h.csv")
    assert history["time"].tolist() == [0.1, 1 / 3]
    assert history["U2[LOAD]"].tolist() == [2 * 0.1, 2 * (1 / 3)]
    assert history["ALLSE"].tolist() == [0.1**2, (1 / 3) ** 2]


def test_what_the_model_does_not_have_is_left_out_and_named(
    with_requests: Requests, records: Records, tmp_path: Path
) -> None:
    model = with_requests(
        history_nodes=(NodeRequest("LOAD", np.array([6]), ("U2", "UR3", "S11")),), history_energies=("ALLSE", "ALLXX")
    )
    file = write(model, tmp_path / "h.csv", records(model))
    assert list(read_history(tmp_path / "h.csv"))[3:] == ["U2[LOAD]", "ALLSE"]
    assert file.unavailable == ["UR3 of LOAD", "S11 of LOAD", "ALLXX of step 1"]


def test_an_unfinished_row_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "h.csv"
    path.write_text("step,increment,time,ALLSE\n1,1,0.1,2.5\n1,2,0.2,2")
    assert {name: column.tolist() for name, column in read_history(path).items()} == {
        "step": [1],
        "increment": [1],
        "time": [0.1],
        "ALLSE": [2.5],
    }


def test_a_job_that_was_stopped_before_its_first_increment_has_an_empty_history(tmp_path: Path) -> None:
    (tmp_path / "h.csv").write_text("")
    assert {name: len(column) for name, column in read_history(tmp_path / "h.csv").items()} == {
        "step": 0,
        "increment": 0,
        "time": 0,
    }
