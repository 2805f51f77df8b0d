# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Limits of threads for linear algebra."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Final

from threadpoolctl import threadpool_limits


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Run OpenBLAS on one thread, for the same bits on any machine, without waiting for other threads.

    Vectors and bands are too small to gain from more (2.7 ms per factorisation of 12,000 unknowns on one thread and on
    two), and while other processes occupy the cores, a dot product of 0.01 ms can take 10 ms. MUMPS keeps its
    threads; PARDISO uses one unless MKL_NUM_THREADS is set.
    """
    with threadpool_limits(limits={"libopenblas": 1, "libscipy_openblas": 1}):
        yield


ONE_THREAD: Final[Mapping[str, str]] = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"
)
"""Environment of a process with one thread, in PARDISO and MUMPS too."""


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Let processes started in the block use one thread each, for when every core has a process."""
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
