# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Thread limit: one thread for the BLAS of numpy and scipy."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Final

from threadpoolctl import threadpool_limits


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Run OpenBLAS on one thread: the same bits on any machine, and no waiting for other threads.

    Vectors and bands are too small to gain from more (2.7 ms per factorisation of 12,000 unknowns on one thread and on
    two), and where other processes hold the cores, a dot product of 0.01 ms has been seen to wait 10 ms. MUMPS
    keeps the threads it is given, PARDISO takes one unless it is told otherwise.
    """
    with threadpool_limits(limits={"libopenblas": 1, "libscipy_openblas": 1}):
        yield


ONE_THREAD: Final[Mapping[str, str]] = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"
)
"""Variables with which a process uses one thread, in PARDISO and MUMPS too."""


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Let every process that begins in the block use one thread: where each core has a process, more only wait."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
