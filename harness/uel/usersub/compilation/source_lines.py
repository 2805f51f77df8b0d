# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Source lines of addresses in a user's library, which has line tables from -g."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

_LINE: Final = re.compile(r"^(?P<file>[^?].*?):(?P<line>\d+)(?: \(discriminator \d+\))?$")
_NAMED: Final = re.compile(r", [^,]+ line \d+")
_MODULE: Final = re.compile(r"^__\w+?_MOD_")


class _SymbolInfo(ctypes.Structure):
    """Dl_info of the dynamic linker."""

    _fields_ = (
        ("file", ctypes.c_char_p),
        ("base", ctypes.c_void_p),
        ("symbol", ctypes.c_char_p),
        ("address", ctypes.c_void_p),
    )


def names_line(message: str) -> bool:
    """Return whether a message has file and line of a mistake in user code."""
    return _NAMED.search(message) is not None


@dataclass(frozen=True, slots=True)
class SourceLine:
    """Routine in upper case, bare name of the file, line."""

    routine: str
    file: str
    line: int


def innermost(addresses: Sequence[int], loaded: str, library: Path) -> SourceLine | None:
    """Return the source line of the first address in a library, loaded from a copy; None if its line is not known."""
    offsets = _offsets(addresses, loaded)
    tool = shutil.which("addr2line")
    if not offsets or tool is None:
        return None
    command = [tool, "-e", str(library), "-f", "-i", *map(hex, offsets)]
    rows = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False).stdout.splitlines()
    for routine, where in zip(rows[::2], rows[1::2], strict=False):
        if match := _LINE.match(where):
            name = _MODULE.sub("", routine).removesuffix("_").upper()
            return SourceLine(name, Path(match["file"]).name, int(match["line"]))
    return None


def _offsets(addresses: Sequence[int], loaded: str) -> list[int]:
    """Return the addresses in a loaded library, relative to its beginning."""
    look_up = getattr(ctypes.CDLL(None), "dladdr", None)
    symbol = _SymbolInfo()
    offsets = []
    for address in addresses if look_up else ():
        assert look_up is not None
        if look_up(ctypes.c_void_p(address), ctypes.byref(symbol)) and (symbol.file or b"").decode() == loaded:
            offsets.append(address - symbol.base)
    return offsets
