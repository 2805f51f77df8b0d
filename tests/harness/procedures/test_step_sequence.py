# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The sequence of the steps: how it ends."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from uel.assembly import Contributors, System
from uel.errors import ConvergenceError
from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.procedures import run_steps


def test_error_before_the_first_step_begins_stays_itself(bench):
    def external_database(lop, *_):
        if lop == 5:
            raise ConvergenceError("no step has begun")

    mesh = Mesh(np.array([1]), np.zeros((1, 3)), ("",))
    model = Model(Path("empty.inp"), "", mesh, (), (bench.step(),))
    missing = dict.fromkeys(("sdvini", "sigini", "orient", "disp", "dload", "utemp", "ufield", "uamp"))
    user = SimpleNamespace(external_database=external_database, **missing)
    with pytest.raises(ConvergenceError, match="no step has begun"):
        list(run_steps(System(mesh, Contributors(())), model, user))
