# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from uel.model.model import Model
from uel.model.records import ElementState, IncrementDone, PointVariables, Record
from uel.output.files.interface import InterfaceFile, read_interface

Records = Callable[..., Iterator[Record]]


def test_every_written_increment_can_be_asked_for(model: Model, records: Records, tmp_path: Path) -> None:
    path = tmp_path / "i.csv"
    file = InterfaceFile(path, model)
    for record in records(model):
        if isinstance(record, IncrementDone):
            file.write(record, last=False)
    file.close()
    profile = read_interface(path, 1, 2)
    assert list(profile) == [
        "step",
        "increment",
        "time",
        "element",
        "point",
        "X",
        "Y",
        "SEPN",
        "SEPT",
        "TN",
        "TT",
        "DAMAGE",
    ]
    assert profile["element"].tolist() == [11, 11]
    assert profile["point"].tolist() == [1, 2]
    assert profile["X"].tolist() == [275.0, 276.75]
    assert profile["DAMAGE"].tolist() == [276.5, 278.25]
    assert read_interface(path)["increment"].tolist() == [4, 4]


def test_element_types_that_keep_different_variables(model: Model, records: Records, tmp_path: Path) -> None:
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    more = ElementState(
        0,
        np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
        np.zeros((2, 8)),
        PointVariables("interface", ("X", "TN", "SN"), 1),
    )
    both = replace(done, solution=replace(done.solution, elements=(done.solution.elements[1], more)))
    InterfaceFile(tmp_path / "i.csv", model).write(both, last=True)
    profile = read_interface(tmp_path / "i.csv")
    assert profile["element"].tolist() == [11, 11, 1, 2]
    assert profile["TN"][2:].tolist() == [2.0, 5.0]
    assert profile["SN"][2:].tolist() == [3.0, 6.0]
    assert np.isnan(profile["SN"][:2]).all()
    assert np.isnan(profile["SEPN"][2:]).all()


def test_there_is_no_file_without_interfaces(model: Model, records: Records, tmp_path: Path) -> None:
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    bulk = replace(done, solution=replace(done.solution, elements=done.solution.elements[:1]))
    InterfaceFile(tmp_path / "i.csv", model).write(bulk, last=True)
    assert not (tmp_path / "i.csv").exists()


def test_an_unfinished_block_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "i.csv"
    path.write_text("step,increment,time,element,point,TN\n1,1,0.1,1,1,5.0\n1,1,0.1,1,2,6.0\n1,2,0.2,1,1,7.0\n1,2,0.")
    assert read_interface(path)["TN"].tolist() == [5.0, 6.0]
