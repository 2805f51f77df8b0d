# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

import io
from collections.abc import Callable, Iterator

import pytest
from rich.console import Console

from harness.model.model import Model
from harness.model.records import AttemptAbandoned, Record
from harness.output.progress import ProgressDisplay

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


@pytest.mark.parametrize(("quiet", "terminal"), [(True, True), (False, False), (True, False)])
def test_nothing_is_shown_otherwise(model: Model, records: Records, quiet: bool, terminal: bool) -> None:
    assert shown(model, records(model), quiet=quiet, terminal=terminal) == ""
