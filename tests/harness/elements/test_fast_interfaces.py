# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interfaces whose strengths and fracture energies depend on the rate of the separation, in jobs."""

from pathlib import Path

import numpy as np
import pytest
from test_process_zone import pulled

RATES = {"RATEREFERENCE": 1e-3, "RATELIMIT": 1.0, "STRENGTHRATE": 0.1, "TOUGHNESSRATE": 0.15}


@pytest.mark.parametrize("kind", ["U2", "U4"])
def test_two_threads_give_what_one_gives(kind: str, tmp_path: Path) -> None:
    """To the last digit: each point has a rate of its own, and shares it with no other."""
    runs = []
    for cpus in (1, 2):
        folder = tmp_path / str(cpus)
        folder.mkdir()
        runs.append(pulled(folder, kind, 0.1, 0.2, opening=0.02, columns=150, first=0.1, cpus=cpus, **RATES))
    one, two = (run.history for run in runs)
    assert one["ALLPD"][-1] > 0
    assert one.keys() == two.keys()
    for name, values in one.items():
        np.testing.assert_array_equal(two[name], values, err_msg=name)
