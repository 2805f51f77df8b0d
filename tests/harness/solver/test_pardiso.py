# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""PARDISO in the tests of all linear solvers, in a process of its own: in the environment other tests would take it."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from mpiexec import OWN

FOUND = list((OWN / "lib").glob("libmkl_rt.so*"))


@pytest.mark.skipif(not FOUND, reason="oneMKL is not installed: make ranks")
def test_linear_solvers_with_pardiso(tmp_path) -> None:
    path = os.pathsep.join(filter(None, (os.environ.get("PYTHONPATH"), str(OWN / "fast"))))
    variables = os.environ | {"PYTHONPATH": path, "PYPARDISO_MKL_RT": str(FOUND[0])}
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "pardiso"]
    result = subprocess.run(
        [sys.executable, *words, f"--basetemp={tmp_path}", str(Path(__file__).with_name("test_linear.py"))],
        env=variables,
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stdout
    passed = re.search(r"(\d+) passed, \d+ deselected", result.stdout)
    # more than those that need no PARDISO
    assert passed and int(passed[1]) > 10, result.stdout
