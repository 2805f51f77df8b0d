# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Of equal values the first one is named, whatever the last bits are."""

import numpy as np
import pytest

from uel.check.examine import examine
from uel.check.tie_breaking import exceeds, first_largest, ranked

VALUES = np.array([1.0, 3.0, 2.0, 3.0, 2.0])


@pytest.mark.parametrize("seed", range(5))
def test_order_does_not_depend_on_the_last_bits(seed):
    noisy = VALUES * (1.0 + 1e-12 * np.random.default_rng(seed).uniform(-1.0, 1.0, len(VALUES)))
    assert first_largest(noisy) == 1
    assert ranked(noisy) == [1, 3, 2, 4, 0]
    assert not exceeds(float(noisy[3]), float(noisy[1]))
    assert exceeds(3.1, float(noisy[1]))


def test_first_of_a_matrix_and_of_zeros():
    assert first_largest(np.array([[0.0, 2.0], [2.0, 1.0]])) == 1
    assert first_largest(np.zeros(3)) == 0


@pytest.mark.long
def test_message_does_not_depend_on_the_last_bits_of_amatrx(patch, tmp_path):
    """A sign that is wrong makes all states and all largest entries equally bad; other bits name the same ones."""
    text = (tmp_path.__class__(__file__).parent / "quad.f").read_text()
    include = tmp_path.__class__(__file__).parents[1] / "uel.inc"
    messages = set()
    for number, factor in enumerate(("1d0", "(1 + 1d-13*jelem)", "(1 - 3d-13*i)")):
        user = tmp_path / f"quad{number}.f"
        wrong = f"do i = 1, 8\n        amatrx(i,:) = -{factor}*amatrx(i,:)\n      end do"
        user.write_text(text.replace("'../uel.inc'", f"'{include}'").replace("amatrx = -amatrx", wrong))
        (report,) = examine(patch(4), user).types
        messages.add(report.findings["tangent"].message)
    assert len(messages) == 1
