# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

import io
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from uel.model.modal import FrequencyRange
from uel.model.model import Model
from uel.model.perturbations import Frequency, StaticPerturbation, SteadyState
from uel.model.procedures import Procedure
from uel.model.records import AttemptAbandoned, IncrementDone, Record, Solution, StepStarted
from uel.output.progress import ProgressDisplay

Records = Callable[..., Iterator[Record]]


def shown(model: Model, records: Iterator[Record], *, quiet: bool, terminal: bool) -> str:
    stream = io.StringIO()
    display = ProgressDisplay(model, quiet=quiet, console=Console(file=stream, force_terminal=terminal, width=80))
    for record in records:
        display.write(record)
    display.close()
    return stream.getvalue()


def test_a_terminal_shows_the_state_of_the_step(model: Model, records: Records) -> None:
    """Residual 749 over its tolerance 5e-3 x 6.33 is 2.4e+04."""
    abandoned = AttemptAbandoned(1, 4, 1, 3, 0.5, 0.5, 0.5, 0.125, "")
    text = shown(model, iter([*records(model), abandoned]), quiet=False, terminal=True)
    assert "Step 1" in text
    assert "time 1/1" in text
    assert "inc 4 iter 2" in text
    assert "r/tol 2.4e+04" in text
    assert "cutbacks 1" in text


@pytest.mark.parametrize(
    ("procedure", "ends", "expected"),
    [
        (SteadyState(ranges=tuple(map(FrequencyRange, (5.0, 9.0, 2.0)))), (5.0, 9.0), "frequency 2/3"),
        (Frequency(number=4), (0.3,), "mode 1/4"),
        (StaticPerturbation(), (1e-36,), "increment 1/1"),
    ],
)
def test_linear_steps_take_no_time(model: Model, procedure: Procedure, ends: tuple[float, ...], expected: str) -> None:
    linear = replace(model, steps=(replace(model.steps[0], procedure=procedure),))
    solution = Solution(*(np.zeros(0, dtype=np.int64),) * 2, *(np.zeros(0),) * 3)
    records: list[Record] = [IncrementDone(1, k, 1, 1, end, end, 1e-36, solution) for k, end in enumerate(ends, 1)]
    assert expected in shown(linear, iter([StepStarted(1), *records]), quiet=False, terminal=True)


@pytest.mark.parametrize(("quiet", "terminal"), [(True, True), (False, False), (True, False)])
def test_nothing_is_shown_otherwise(model: Model, records: Records, quiet: bool, terminal: bool) -> None:
    assert shown(model, records(model), quiet=quiet, terminal=terminal) == ""
