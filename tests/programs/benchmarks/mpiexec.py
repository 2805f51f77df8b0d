# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Where the tests find MPI: in the environment, or in `.ranks` of it, which `make ranks` fills.

The packages of the extra `mpi` are not in the environment itself: oneMKL among them would change what other tests see.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from importlib.metadata import distributions
from importlib.util import find_spec
from pathlib import Path

import pytest

OWN = Path(sys.prefix) / ".ranks"
HERE = Path(sys.prefix) if find_spec("mpi4py") else OWN
MPIEXEC = HERE / "bin" / "mpiexec"
NEEDED = pytest.mark.skipif(not MPIEXEC.exists(), reason="mpi4py and mpich are not installed")


def installed(name: str) -> bool:
    """Whether the ranks find a distribution."""
    return any(distributions(name=name, path=[*sys.path, *map(str, (OWN / "lib").glob("python*/site-packages"))]))


PETSC_NEEDED = pytest.mark.skipif(not installed("petsc4py"), reason="petsc4py is not installed")


def variables() -> dict[str, str]:
    """Environment of `mpiexec`; processes that wait give up the core, and no thread of BLAS is added to the ranks."""
    found = dict(os.environ) | {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    if HERE == OWN:
        site = next((OWN / "lib").glob("python*/site-packages"))
        found["PYTHONPATH"] = os.pathsep.join(filter(None, (str(site), found.get("PYTHONPATH"))))
        found["MPI4PY_LIBMPI"] = str(OWN / "lib" / "libmpi.so.12")
    return found


def start(ranks: int, words: Sequence[object], folder: Path) -> subprocess.Popen[str]:
    """Start Python with these words on so many ranks, in a folder."""
    command = [str(MPIEXEC), "-n", str(ranks), sys.executable, *map(str, words)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, cwd=folder, env=variables(), **pipes)


def run(ranks: int, words: Sequence[object], folder: Path) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of Python with these words on so many ranks."""
    process = start(ranks, words, folder)
    output, errors = process.communicate()
    return process.returncode, output, errors
