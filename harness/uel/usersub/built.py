# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Where the build leaves the project's own kernels."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path


def path_of_amalgam() -> Path:
    """The kernels as one fixed-form file for Abaqus."""
    return _packaged("delamination.for")


def path_of_kernels() -> Path:
    """The kernels as a shared library of user routines."""
    return _packaged("kernels.so")


def path_of_layout() -> Path:
    """The Fortran module that names every property and state variable of the kernels."""
    return _packaged("layout.f90")


def _packaged(name: str) -> Path:
    return Path(str(files("uel.usersub").joinpath(name)))
