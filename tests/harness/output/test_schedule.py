# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

from dataclasses import replace

from uel.errors import Source
from uel.model.procedures import Static
from uel.model.records import IncrementDone, Solution
from uel.model.steps import OutputRequests, Step
from uel.output.schedule import Schedule


def written(times: list[float], period: float = 1.0, step: int = 1, **requests: int) -> list[float]:
    """Step times of the increments that are written."""
    asked = Step(step, "", Static(period=period), Source("deck.inp", 1), output=OutputRequests(**requests))
    schedule = Schedule()
    solution: Solution = None  # type: ignore[assignment]
    records = [IncrementDone(step, k, 1, 1, time, time, 0.1, solution) for k, time in enumerate(times, 1)]
    return [record.step_time for record in records if schedule.due_field(asked, record, last=record is records[-1])]


def test_every_so_many_increments_and_the_last() -> None:
    assert written([0.1, 0.2, 0.3, 0.4, 0.5], field_frequency=2) == [0.2, 0.4, 0.5]
    assert written([0.1, 0.2], field_frequency=0) == []


def test_the_first_increment_that_gets_to_the_end_of_a_part() -> None:
    requests = {"field_frequency": 0, "field_intervals": 4}
    assert written([0.1, 0.25, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0], **requests) == [0.25, 0.6, 0.75, 1.0]
    # two parts in one increment; the last increment of a run that stops short
    assert written([0.1, 0.6, 0.7], **requests) == [0.6, 0.7]
    # a step of another length; what increments of a tenth add up to is short of 0.3 by round-off
    assert written([0.5, 1.0, 1.5, 2.0], period=2.0, **requests) == [0.5, 1.0, 1.5, 2.0]
    assert 0.1 * 3 != 0.3
    assert written([0.1, 0.2, 0.3 - 1e-16, 1.0], field_frequency=0, field_intervals=10) == [0.1, 0.2, 0.3 - 1e-16, 1.0]


def test_parts_and_increments_add_up() -> None:
    assert written([0.1, 0.2, 0.3, 0.5, 1.0], field_frequency=3, field_intervals=2) == [0.3, 0.5, 1.0]


def test_parts_of_every_step_are_counted_anew() -> None:
    output = OutputRequests(field_frequency=0, field_intervals=2)
    first = Step(1, "", Static(), Source("deck.inp", 1), output=output)
    solution: Solution = None  # type: ignore[assignment]
    done = IncrementDone(1, 1, 1, 1, 1.0, 1.0, 0.5, solution)
    schedule = Schedule()
    assert schedule.due_field(first, done, last=True)
    early = replace(done, step=2, step_time=0.25)
    assert not schedule.due_field(replace(first, number=2), early, last=False)
    assert schedule.due_field(replace(first, number=2), replace(early, increment=2, step_time=0.5), last=False)
