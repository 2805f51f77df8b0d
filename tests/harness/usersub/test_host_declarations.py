# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The boundary to Fortran has one description: what Python is told of it follows from the declarations there."""

import runpy
from pathlib import Path

import pytest

from uel.usersub import _binding
from uel.usersub._extension import host

ROOT = Path(__file__).parents[3]


def test_types_of_the_host_are_those_of_its_declarations():
    """Else `python fortran/host/stub.py` has to be run, and mypy says which calls lack an argument."""
    written = runpy.run_path(str(ROOT / "fortran" / "host" / "stub.py"))["stub"]()
    assert (ROOT / "harness" / "uel" / "usersub" / "_host.pyi").read_text(encoding="utf-8") == written


def test_compiled_host_has_what_the_types_say():
    declared = (ROOT / "harness" / "uel" / "usersub" / "_host.pyi").read_text(encoding="utf-8").split("def ")[1:]
    compiled = {name for name in dir(host) if name.startswith("host_")}
    assert {text.partition("(")[0] for text in declared} == compiled


def test_an_argument_that_is_missing_is_an_error():
    with pytest.raises(TypeError, match=r"missing required argument 'address'"):
        host.host_evaluate()  # type: ignore[call-arg]


def test_elements_that_the_host_does_not_have():
    with pytest.raises(ValueError, match="the host has no elements called 'trusses'"):
        _binding.address_of("trusses")
