# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Paths of the project's kernels and of their tables."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path


def path_of_amalgam() -> Path:
    """Return the path of the kernels as one fixed-form file for Abaqus."""
    return _packaged("delamination.for")


def path_of_kernels() -> Path:
    """Return the path of the kernels as a shared library of user routines."""
    return _packaged("kernels.so")


def path_of_properties() -> Path:
    """Return the file that defines every property, state variable and element type of the kernels."""
    return _packaged("properties.toml")


def path_of_built_in() -> Path:
    """Return the file that defines the properties and state variables of built-in elements."""
    return _packaged("built_in.toml")


def _packaged(name: str) -> Path:
    return Path(str(files("uel.usersub").joinpath(name)))
