# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""One thread for the BLAS of numpy and scipy."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Run OpenBLAS on one thread: the same bits on any machine, and no waiting for other threads.

    Vectors and bands are too small to gain from more (2.7 ms per factorisation of 12,000 unknowns on one thread and on
    two), and where other processes hold the cores, a dot product of 0.01 ms has been seen to wait 10 ms. PARDISO and
    MUMPS keep the threads they are given.
    """
    with threadpool_limits(limits={"libopenblas": 1, "libscipy_openblas": 1}):
        yield
