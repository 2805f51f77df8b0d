# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The files of a job, written from the records of a run, and the functions that read them back."""

from harness.output.interface import read_interface
from harness.output.job import JobOutput
from harness.output.results import Result

__all__ = ["JobOutput", "Result", "read_interface"]
