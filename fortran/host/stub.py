# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write `harness/uel/usersub/_host.pyi`, the types of what Python calls: `python fortran/host/stub.py`.

They follow from the declarations of the procedures, as f2py's own parser reads them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any, Final

from numpy.f2py import crackfortran

HERE: Final = Path(__file__).parent
STUB: Final = HERE.parents[1] / "harness" / "uel" / "usersub" / "_host.pyi"
SOURCES: Final = (
    "entry/elements.f90",
    "entry/materials.f90",
    "entry/points.f90",
    "entry/shape.f90",
    "entry/watch.f90",
    "entry/bare_loop.f90",
    "entry/linear_elements.f90",
    "entry/scatter_map.f90",
    "entry/contact.f90",
)
"""As in meson.build."""

SCALARS: Final = {("integer", "i4"): "int", ("integer", "i8"): "int", ("real", "dp"): "float", ("character", ""): "str"}
ENTRIES: Final = {"i4": "np.int32", "i8": "np.int64", "dp": "np.float64", "": "np.bytes_"}
HEAD: Final = """\
# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
# Written by fortran/host/stub.py.
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

"""


def stub() -> str:
    """Text of the stub file."""
    # the parser tells of each module that it does not look into
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        blocks = crackfortran.crackfortran([str(HERE / name) for name in SOURCES])
    return HEAD + "\n".join(_signature(block) for block in blocks) + "\n"


def _signature(block: dict[str, Any]) -> str:
    """Of a procedure: sizes that follow from the shape of an array that is passed are no arguments."""
    variables: dict[str, dict[str, Any]] = {name: block["vars"][name] for name in block["args"]}
    passed = [variable for variable in variables.values() if "out" not in variable["intent"]]
    sizes = {size for variable in passed for size in variable.get("dimension", ())}
    taken, returned = [], []
    for name, variable in variables.items():
        if "out" in variable["intent"]:
            returned.append(_returned(variable))
        elif name not in sizes:
            taken.append(f"{name}: {_taken(variable)}")
    result = ("None", *returned)[-1] if len(returned) < 2 else f"tuple[{', '.join(returned)}]"
    line = f"def {block['name']}({', '.join(taken)}) -> {result}: ..."
    return line if len(line) <= 120 else "\n".join(_broken(block["name"], taken, result))


def _broken(name: str, taken: list[str], result: str) -> Iterator[str]:
    """Break a signature that is too long for a line as the formatter does."""
    yield f"def {name}("
    together = f"    {', '.join(taken)}"
    yield from [together] if len(together) <= 120 else [f"    {argument}," for argument in taken]
    yield f") -> {result}: ..."


def _kind(variable: dict[str, Any]) -> str:
    return str(variable.get("kindselector", {}).get("kind", ""))


def _scalar(variable: dict[str, Any]) -> str:
    return SCALARS[variable["typespec"], _kind(variable)]


def _taken(variable: dict[str, Any]) -> str:
    """Type of an argument. Numbers of a fixed count may come as a tuple, names of a job as bytes."""
    if "dimension" not in variable:
        return _scalar(variable).replace("str", "str | bytes")
    array = f"NDArray[{ENTRIES[_kind(variable)]}]"
    fixed = len(variable["dimension"]) == 1 and variable["dimension"][0].isdigit()
    return f"Sequence[{_scalar(variable)}] | {array}" if fixed and "inout" not in variable["intent"] else array


def _returned(variable: dict[str, Any]) -> str:
    if "dimension" in variable:
        return f"NDArray[{ENTRIES[_kind(variable)]}]"
    return _scalar(variable).replace("str", "bytes")


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
