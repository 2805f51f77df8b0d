# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A whole job: all files together, failed and killed runs, replaced files, time per increment."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.errors import ConvergenceError, UelError
from uel.model.model import Model
from uel.model.records import AttemptAbandoned, IncrementDone, Record, Warned
from uel.output import JobOutput, Result
from uel.output.verdict import write_verdict

Records = Callable[..., Iterator[Record]]
Requests = Callable[..., Model]


def write_records(model: Model, directory: Path, records: Iterator[Record], error: UelError | None = None) -> Result:
    output = JobOutput(model, "job", directory, quiet=True)
    for record in records:
        output.write(record)
    output.close(error)
    return Result(directory / "job")


def test_a_job_is_read_back(model: Model, records: Records, tmp_path: Path) -> None:
    result = write_records(model, tmp_path, records(model))
    assert result.completed
    assert [(row.increment, row.iterations, row.total_time) for row in result.status] == [
        (1, 2, 0.1),
        (2, 2, 0.25),
        (3, 2, 0.5),
        (4, 2, 1.0),
    ]
    assert result.history["U2[LOAD]"].tolist() == [0.2, 0.5, 1.0, 2.0]
    assert [(frame.step, frame.increment, frame.time) for frame in result.frames] == [
        (1, 1, 0.1),
        (1, 2, 0.25),
        (1, 3, 0.5),
        (1, 4, 1.0),
    ]
    assert result.field("U")[:, 1].tolist() == [0, 0, 1, 1, 1, 1, 2, 2]
    assert result.field("U", increment=3)[6].tolist() == [0, 1, 0]
    assert result.interface(increment=2)["TN"].tolist() == [276.0, 277.75]
    assert result.job == "job"


def test_a_failed_job_keeps_the_last_converged_increment(
    with_requests: Requests, records: Records, tmp_path: Path
) -> None:
    model = with_requests(field_frequency=10, history_frequency=10)
    stopped = [record for record in records(model) if not isinstance(record, IncrementDone) or record.increment < 3][
        :-3
    ]
    abandoned = AttemptAbandoned(1, 3, 1, 5, 0.25, 0.25, 0.25, 0.0, "THE SOLUTION APPEARS TO BE DIVERGING.")
    error = ConvergenceError("TOO MANY ATTEMPTS MADE FOR THIS INCREMENT")
    result = write_records(model, tmp_path, iter([*stopped, abandoned]), error)
    assert not result.completed
    assert [(row.increment, row.cutback) for row in result.status] == [(1, False), (2, False), (3, True)]
    assert result.history["increment"].tolist() == [2]
    assert [frame.increment for frame in result.frames] == [2]
    assert result.interface()["increment"].tolist() == [2, 2]
    message = result.file(".msg").read_text()
    assert " ***NOTE: THE SOLUTION APPEARS TO BE DIVERGING.\n" in message
    assert " ***ERROR: TOO MANY ATTEMPTS MADE FOR THIS INCREMENT\n" in message
    assert "COMPLETED\n" not in message
    assert " ***ERROR: TOO MANY ATTEMPTS MADE FOR THIS INCREMENT\n" in result.file(".dat").read_text()


@pytest.mark.parametrize(("frequency", "written"), [(1, [1, 2, 3, 4]), (2, [2, 4]), (3, [3, 4]), (9, [4]), (0, [])])
def test_field_and_history_frequency(
    with_requests: Requests, records: Records, tmp_path: Path, frequency: int, written: list[int]
) -> None:
    model = with_requests(field_frequency=frequency, history_frequency=frequency)
    result = write_records(model, tmp_path, records(model))
    assert [frame.increment for frame in result.frames] == written
    assert result.history["increment"].tolist() == written


def test_the_last_increment_of_a_step_that_ends_early_is_written_too(
    with_requests: Requests, records: Records, tmp_path: Path
) -> None:
    model = with_requests(field_frequency=2)
    result = write_records(model, tmp_path, records(model, times=(0.1, 0.2, 0.3)))
    assert [frame.increment for frame in result.frames] == [2, 3]


def test_several_steps(model: Model, records: Records, tmp_path: Path) -> None:
    second = replace(model.steps[0], number=2, output=replace(model.steps[0].output, history_nodes=()))
    model = replace(model, steps=(model.steps[0], second))
    both = [*records(model), *records(model, step=2, start=1.0, times=(0.5, 1.0))]
    result = write_records(model, tmp_path, iter(both))
    assert result.history["time"].tolist() == [0.1, 0.25, 0.5, 1.0, 1.5, 2.0]
    assert np.isnan(result.history["U2[LOAD]"]).tolist() == [False] * 4 + [True] * 2
    assert result.history["ALLSE"].tolist()[-2:] == [0.25, 1.0]
    assert result.field("U", increment=2, step=1)[6, 1] == 0.5
    assert result.field("U", increment=2)[6, 1] == 2.0
    assert result.interface(step=1)["step"].tolist() == [1, 1]
    assert [row.step_time for row in result.status][-2:] == [0.5, 1.0]


def test_an_earlier_job_is_replaced(model: Model, with_requests: Requests, records: Records, tmp_path: Path) -> None:
    write_records(model, tmp_path, records(model))
    result = write_records(with_requests(field_frequency=0), tmp_path, records(model, times=(1.0,)))
    assert len(result.status) == 1
    assert result.frames == []
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "deck.inp",
        "job.dat",
        "job.msg",
        "job.sta",
        "job_history.csv",
    ]


def test_texts_of_user_routines_go_to_their_file(model: Model, tmp_path: Path) -> None:
    output = JobOutput(model, "job", tmp_path, quiet=True)
    output.user_text(".msg", "print", " GAUSS POINT 3")
    output.user_text(".dat", "warning", "Negative modulus")
    output.write(Warned("the increment is small"))
    output.close(None)
    assert " GAUSS POINT 3\n" in (tmp_path / "job.msg").read_text()
    assert " ***WARNING: the increment is small\n" in (tmp_path / "job.msg").read_text()
    data = (tmp_path / "job.dat").read_text()
    assert " ***WARNING: Negative modulus\n" in data
    assert "WITH      1 WARNING MESSAGES" in data


def test_what_was_not_written_is_named(model: Model, records: Records, tmp_path: Path) -> None:
    with pytest.raises(UelError, match=r"nothing\.sta: no such job"):
        Result(tmp_path / "nothing")
    result = write_records(model, tmp_path, records(model))
    with pytest.raises(UelError, match=r"job\.inp\.sta: no such job; did you mean \S*/job\?$"):
        Result(tmp_path / "job.inp")
    with pytest.raises(UelError, match=r"job\.pvd: no field 'MISES'; available fields: .*RF.*S11"):
        result.field("MISES")
    with pytest.raises(UelError, match=r"job\.pvd: no field output of increment 7"):
        result.field("U", increment=7)
    with pytest.raises(UelError, match=r"job\.pvd: no field output of step 2$"):
        result.field("U", step=2)
    with pytest.raises(UelError, match=r"_interface\.csv: no interface profile of step 1, increment 9"):
        result.interface(increment=9, step=1)
    result.file("_interface.csv").unlink()
    result.file(".pvd").unlink()
    with pytest.raises(UelError, match=r"job\.pvd: no field output; .* the deck has \*OUTPUT, FIELD"):
        result.field("U")
    with pytest.raises(UelError, match=r"_interface\.csv: no such file; .* cohesive elements, .* \*OUTPUT, FIELD"):
        result.interface()


KILLED = """
import itertools, pickle, sys
from pathlib import Path
from dataclasses import replace
from uel.model.records import IncrementDone
from uel.output import JobOutput
model, records = pickle.load(sys.stdin.buffer)
output = JobOutput(model, "job", Path(sys.argv[1]), quiet=True)
output.write(records[0])
attempt, first, second, done = records[1:5]
for k in itertools.count(1):
    for record in (replace(attempt, increment=k), first, second, replace(done, increment=k, step_time=k, total_time=k)):
        output.write(record)
    if k == 3:
        print("running", flush=True)
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize("seconds", [0.0, 0.031, 0.047, 0.083])
def test_a_killed_job_is_readable_up_to_its_last_increment(
    model: Model, records: Records, tmp_path: Path, seconds: float
) -> None:
    """kill -9 at any moment; a period that is never reached keeps the job running."""
    import pickle  # noqa: PLC0415

    model = replace(model, steps=(replace(model.steps[0], procedure=replace(model.steps[0].procedure, period=1e9)),))
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert process.stdin and process.stdout
    process.stdin.write(pickle.dumps((model, list(records(model)))))
    process.stdin.close()
    assert process.stdout.readline() == b"running\n"
    time.sleep(seconds)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    result = Result(tmp_path / "job")
    last = len(result.status)
    assert last >= 3
    assert [row.increment for row in result.status] == list(range(1, last + 1))
    assert not result.completed
    # an increment is named in .sta after all else of it is written, so the other files may be one ahead
    for increments in (
        [int(k) for k in result.history["increment"]],
        [frame.increment for frame in result.frames],
    ):
        assert increments[:last] == list(range(1, last + 1))
        assert len(increments) <= last + 1
    for increment in (1, last):
        assert result.field("U", increment).shape == (8, 3)
        assert result.interface(increment)["point"].tolist() == [1, 2]
    assert result.file(".msg").read_text().count("ITERATION SUMMARY FOR THE INCREMENT") >= last
    # the system may end a write where a page of the file ends; who watches a job cuts off what is left of its last line
    write_verdict(tmp_path / "job", "KILLED")
    for ending in (".sta", ".msg", ".dat", "_history.csv", "_interface.csv"):
        assert result.file(ending).read_text().endswith("\n")
    assert [row.increment for row in Result(tmp_path / "job").status] == list(range(1, last + 1))
