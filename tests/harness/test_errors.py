# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Errors that come from another process of a batch."""

import pickle
from pathlib import Path

import pytest

from uel.errors import CompileError, DeckError, KernelError, SilentError, SingularMatrixError, Source, UsageError

PLACE = Source("deck.inp", 3)
ERRORS = [
    UsageError("no such file"),
    SilentError(2),
    DeckError(PLACE, "unknown keyword"),
    CompileError(Path("uel.f"), "line 3"),
    KernelError(7, "U4", "GIC = 0"),
    SingularMatrixError("12", 2, "unconstrained", PLACE),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_errors_reach_another_process(error):
    error.add_note("earlier warning: none")
    other = pickle.loads(pickle.dumps(error))
    assert type(other) is type(error)
    assert str(other) == str(error)
    assert vars(other) == vars(error)
