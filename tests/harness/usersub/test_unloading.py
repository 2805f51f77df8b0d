# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Routines of jobs that have ended do not stay in the process, which can map some ten thousand files at most."""

import sys
from pathlib import Path

import pytest

from uel import usersub


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_routines_of_ended_jobs_are_unloaded(tmp_path):
    def maps():
        return Path("/proc/self/maps").read_text().count("/kernels.so")

    def load():
        return usersub.load(None, job="job", output_dir=tmp_path)

    before = maps()
    one, other = load(), load()
    assert maps() > before
    assert one.is_own
    for library in (one, other, one):
        library.close()
    assert maps() == before
    # what was read at the start stays known
    assert one.is_own
