# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""PROPS, JPROPS and SVARS of built-in elements by the names of fortran/built_in.toml, which the build checks."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uel.model.arrays import FloatArray, IntArray
from uel.usersub.own_kernels import path_of_built_in


def reals(family: str, first: FloatArray | None = None, /, **values: ArrayLike) -> FloatArray:
    """Return PROPS of a family of elements from all of its values.

    first: PROPS of the family with which it begins, in place of their values.
    """
    return np.concatenate(_parts(family, "props", first, values), dtype=np.float64)


def integers(family: str, first: IntArray | None = None, /, **values: ArrayLike) -> IntArray:
    """Return JPROPS of a family of elements from all of its values.

    first: JPROPS of the family with which it begins, in place of their values.
    """
    return np.concatenate(_parts(family, "jprops", first, values), dtype=np.int64, casting="unsafe")


def variables(family: str) -> tuple[str, ...]:
    """Return the names of the SVARS of a point."""
    return tuple(_tables()[family]["svars"])


def position(family: str, name: str, kind: str = "props") -> int:
    """Return the position, from 0, of a value in PROPS or JPROPS (kind jprops)."""
    sizes = _sizes(family, kind)
    return sum(int(sizes[before]) for before in list(sizes)[: list(sizes).index(name)])


def _parts(
    family: str, kind: str, first: np.ndarray[Any, Any] | None, values: dict[str, ArrayLike]
) -> list[np.ndarray[Any, Any]]:
    sizes, start = _sizes(family, kind), []
    if first is not None:
        begins = _sizes_of_first(family, kind)
        if len(first) != sum(map(int, begins.values())):
            raise ValueError(f"{kind} of {family}: begins with {len(first)} values, expected {', '.join(begins)}")
        sizes, start = {name: sizes[name] for name in sizes if name not in begins}, [first]
    if values.keys() != sizes.keys():
        raise TypeError(f"{kind} of {family}: expected {', '.join(sizes)}")
    parts = [np.ravel(values[name]) for name in sizes]
    for name, part in zip(sizes, parts, strict=True):
        if sizes[name] not in ("any", len(part)):
            raise ValueError(f"{kind} of {family}: {name} has {len(part)} values, expected {sizes[name]}")
    return [*start, *parts]


@cache
def _sizes(family: str, kind: str) -> dict[str, int | str]:
    """Return the number of values of each name of a family, in the order of the array."""
    entries = _tables()[family].get(kind, {}).items()
    own = {name: 1 if isinstance(entry, str) else entry["size"] for name, entry in entries}
    return _sizes_of_first(family, kind) | own


def _sizes_of_first(family: str, kind: str) -> dict[str, int | str]:
    """Return those of the family with which a family begins, empty without one."""
    begins = _tables()[family].get("begins")
    return {} if begins is None else _sizes(begins, kind)


@cache
def _tables() -> dict[str, Any]:
    return tomllib.loads(path_of_built_in().read_text(encoding="utf-8"))
