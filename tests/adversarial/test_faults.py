# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every right element passes, and the mistakes are found: a sample in `make test`, all in `make test-all`."""

import pytest
from faults import MISSED, check, elements, faults

SAMPLE = 20
"""Each twentieth fault is tried in `make test`."""

QUICK = ("quad",)
"""Right elements that are tried in `make test`."""


@pytest.mark.parametrize(
    "element", [pytest.param(name, marks=[pytest.mark.long] * (name not in QUICK)) for name in elements()]
)
def test_right_element_passes(element):
    assert str(check(element)) == "passed"


@pytest.mark.parametrize("fault", faults()[::SAMPLE], ids=lambda fault: fault.name)
def test_fault_is_found(fault):
    assert check(fault.element, fault).found


@pytest.mark.long
@pytest.mark.parametrize(("file", "count"), [("faults.toml", 40), ("unusual.toml", 45)])
def test_nearly_all_faults_are_found(file, count):
    everything = faults(file)
    assert len(everything) == count
    missed = [fault.name for fault in everything if not check(fault.element, fault).finds(fault)]
    assert len(missed) <= MISSED[file], missed
