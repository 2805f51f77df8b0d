# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write the Fortran module host_layout, the positions of the values of built-in elements in PROPS, JPROPS and SVARS.

The build calls it. It refuses entries of built_in.toml that it does not understand, so that what else reads the file
need not.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

from generate_layout import check_name, main

KEYS = ("begins", "svars", "props", "jprops")

HEAD = """\
! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Positions of the values of built-in elements in PROPS (p_), JPROPS (j_) and among the SVARS of a point (s_). Written
!> by generate_host_layout.py from built_in.toml: edit that, not this file.
module host_layout
  implicit none (type, external)
  private
  integer :: k
"""


def layout(text: str) -> str:
    """Text of the module, from that of built_in.toml. Raises ValueError with the entry that is wrong."""
    data = tomllib.loads(text)
    lines = [line for family in data for line in constants(family, data)]
    return "\n".join([HEAD, *lines, "end module host_layout"]) + "\n"


def constants(family: str, data: Mapping[str, Any]) -> Iterator[str]:
    """Lines of the constants of a family. Raises ValueError."""
    tables = data[family]
    for key in tables:
        check_name(family, key, KEYS)
    begins = tables.get("begins")
    if begins is not None:
        check_name(f"{family}: begins", begins, data)
    for kind in ("props", "jprops"):
        first = [] if begins is None else entries(begins, kind, data)
        own = entries(family, kind, data)[len(first) :]
        yield from positions(f"{kind[0]}_{family}", own, sum(size for _, size, _ in first))
    if "svars" in tables:
        yield from positions(f"s_{family}", [(name.lower(), 1, "") for name in tables["svars"]], 0)
        yield f"  integer, parameter, public :: {family}_values = {len(tables['svars'])}"


def entries(family: str, kind: str, data: Mapping[str, Any]) -> list[tuple[str, int, str]]:
    """Return name, size and meaning of each value in an array, those of `begins` first; size 0 stands for any.

    Raises ValueError.
    """
    begins = data[family].get("begins")
    found = [] if begins is None else entries(begins, kind, data)
    for name, entry in data[family].get(kind, {}).items():
        where, size, meaning = f"{family}.{kind}.{name}", 1, entry
        if any(name == other for other, _, _ in found):
            raise ValueError(f"{where}: '{begins}' has a value of this name")
        if found and not found[-1][1]:
            raise ValueError(f"{where}: '{found[-1][0]}' before it has any size")
        if not isinstance(entry, str):
            if entry.keys() != {"size", "meaning"}:
                raise ValueError(f"{where}: expected a meaning, or size and meaning")
            size, meaning = 0 if entry["size"] == "any" else int(entry["size"]), entry["meaning"]
        found.append((name, size, meaning))
    return found


def positions(prefix: str, values: list[tuple[str, int, str]], before: int) -> Iterator[str]:
    """Lines of the constants of values, which come after others."""
    for name, size, meaning in values:
        if meaning:
            yield f"  !> {meaning}"
        first, last = before + 1, before + size
        value = f"({size}) = [(k, k={first}, {last})]" if size > 1 else f" = {first}"
        yield f"  integer, parameter, public :: {prefix}_{name}{value}"
        before = last


if __name__ == "__main__":
    main(layout, __doc__)
