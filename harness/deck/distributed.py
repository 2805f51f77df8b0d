# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DLOAD on user elements, *TEMPERATURE and *FIELD."""

from __future__ import annotations

import re

import numpy as np

from harness.deck.blocks import Block
from harness.deck.initial import field_number
from harness.deck.prescribed import Prescription
from harness.deck.table import unquote
from harness.model.steps import DistributedLoad, Load

_USER_LOAD = re.compile(r"U([1-9]\d{0,3})(NU)?")


def read_distributed(block: Block, prescription: Prescription) -> list[DistributedLoad]:
    """Entries of one *DLOAD."""
    amplitude = prescription.amplitude(block)
    found = []
    for row in block.rows():
        row.at_most(3)
        elements = prescription.flat.elements(row.name(0, "element or element set"), row.source)
        label = unquote(row.text(1, "load type"))
        match = _USER_LOAD.fullmatch(label)
        if match is None:
            raise row.error(f"load type {label} is not supported (supported: Un and UnNU, on user elements)")
        built_in = prescription.built_in[elements]
        if built_in.any():
            raise row.error(f"load type {label} on elements that are not user elements ({np.count_nonzero(built_in)})")
        kind = -int(match[1]) if match[2] else int(match[1])
        found.append(DistributedLoad(elements, kind, row.real(2, "magnitude", 0.0), amplitude, row.source))
    return found


def read_fields(block: Block, prescription: Prescription) -> list[Load]:
    """Entries of one *TEMPERATURE or *FIELD; their dof is the number of the field, 0 for temperature."""
    amplitude = prescription.amplitude(block)
    number = field_number(block) if block.name == "FIELD" else 0
    found = []
    for row in block.rows():
        row.at_most(2)
        nodes = prescription.flat.nodes(row.name(0, "node or node set"), row.source)
        found.append(Load(nodes, number, row.real(1, "value", 0.0), amplitude, row.source))
    return found
