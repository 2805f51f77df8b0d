# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of a job: written from the records of a run, and read back."""

from uel.output.files.interface import read_interface
from uel.output.job import JobOutput
from uel.output.results import Result

__all__ = ["JobOutput", "Result", "read_interface"]
