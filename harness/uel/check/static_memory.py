# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Static variables of user routines: SAVE, COMMON, modules, initial values in declarations."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.usersub import Library

MOST: Final = 1 << 26
"""Bytes that are examined in all; larger variables are left out once they are used up."""

_SYMBOL: Final = re.compile(r"^([0-9a-f]+) ([0-9a-f]+) ([bBdDC]) (\S+)$", re.MULTILINE)
_ANY: Final = re.compile(r"^([0-9a-f]+) (?:[0-9a-f]+ )?[A-Za-z] (uel|uelmat)_$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Variable:
    """Static variable: name in the user's source, address and size."""

    name: str
    address: int
    size: int

    def bytes(self) -> NDArray[np.uint8]:
        """Copy the current bytes."""
        return np.frombuffer(ctypes.string_at(self.address, self.size), dtype=np.uint8)


def variables_of(library: Library) -> list[Variable] | None:
    """Return the variables of a loaded library; None if its symbols cannot be read (no nm, or it is stripped)."""
    nm = shutil.which("nm")
    if nm is None:
        return None
    command = [nm, "--print-size", "--defined-only", str(library.file)]
    text = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    addresses = {"uel": library.uel, "uelmat": library.uelmat}
    entry = next((match for match in _ANY.finditer(text) if addresses[match[2]]), None)
    if entry is None:
        return None
    base = (addresses[entry[2]] or 0) - int(entry[1], 16)
    symbols = [(int(match[1], 16), int(match[2], 16), match[4]) for match in _SYMBOL.finditer(text)]
    variables, total = [], 0
    for offset, size, symbol in sorted(symbols, key=lambda item: item[1]):
        total += size
        if total <= MOST:
            variables.append(Variable(readable(symbol), base + offset, size))
    return variables


def readable(symbol: str) -> str:
    """Return the name of a variable in the user's source from that of gfortran's symbol."""
    if match := re.fullmatch(r"__(\w+)_MOD_(\w+)", symbol):
        return f"{match[2].upper()} of module {match[1].upper()}"
    if match := re.fullmatch(r"(\w+?)\.\d+(?:\.\w+)*", symbol):
        return f"local variable {match[1].upper()}"
    if symbol == "__BLNK__":
        return "the blank COMMON"
    return f"COMMON /{symbol.removesuffix('_').upper()}/"
