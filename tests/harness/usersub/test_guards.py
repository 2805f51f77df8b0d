# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What guards hold."""

from __future__ import annotations

import pytest

from uel.usersub.guards import ARRAYS, UNSET, guard_values, set_guard_values


def test_guards_hold_the_values_given_and_then_the_old_ones() -> None:
    before = set_guard_values({})
    with guard_values({UNSET: 3.5, ARRAYS[0]: 2.5}):
        within = set_guard_values({})
    assert (within[0], within[-1]) == (2.5, 3.5)
    assert within[1:-1].tobytes() == before[1:-1].tobytes()
    assert set_guard_values({}).tobytes() == before.tobytes()


def test_an_unknown_name_leaves_the_guards_alone() -> None:
    before = set_guard_values({})
    with pytest.raises(ValueError, match="not in list"):
        set_guard_values({UNSET: 3.5, "NOTHING": 1.0})
    assert set_guard_values({}).tobytes() == before.tobytes()
