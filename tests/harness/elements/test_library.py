# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The host's library of materials holds as many as a graded mesh has sections."""

import subprocess
import sys

PROGRAM = """
import numpy as np
from uel.usersub import _materials

for _ in range(20000):
    number = _materials.define_material(np.eye(3), np.eye(3), np.zeros(3), np.eye(3), (1.0, 0.0), np.zeros((1, 2)))
print(number)
"""


def test_many_materials():
    """In a process of its own: a copy of all of them on the stack ends it by a segmentation fault."""
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, "20000")
