# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
import scipy.linalg  # noqa: F401 (brings its own OpenBLAS)
from threadpoolctl import threadpool_info, threadpool_limits

from uel.solver.threads import one_blas_thread


def openblas_threads() -> set[int]:
    return {library["num_threads"] for library in threadpool_info() if library["internal_api"] == "openblas"}


def test_one_thread_inside_and_as_before_outside() -> None:
    with threadpool_limits(2):
        before = openblas_threads()
        with one_blas_thread():
            assert openblas_threads() <= {1}
        assert openblas_threads() == before
