# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel new`: a folder to start from, with a user element, its deck, its tests and their CI."""

from __future__ import annotations

import json
import re
from importlib import metadata
from pathlib import Path
from typing import Final

from uel.errors import UelError, UsageError

TEMPLATE: Final = Path(__file__).with_name("template")
PLACEHOLDER: Final = "my_uel"
"""Name of the template's element, in texts and names of files."""

_OURSELVES: Final = "THIS-PROGRAM"
"""Placeholder in the template for what `pip install` takes to install this program."""
_NAME = re.compile(r"[A-Za-z]\w{0,63}", re.ASCII)


def create(target: Path) -> list[Path]:
    """Write a project into a new folder.

    Parameters
    ----------
    target
        The folder. Its name is that of the element: letters, digits and underscores, a letter first, 64 at most.

    Returns
    -------
    list[Path]
        The files written.

    Raises
    ------
    UsageError
        An element cannot have the name.
    UelError
        The folder exists.
    """
    name = target.name
    if _NAME.fullmatch(name) is None:
        raise UsageError(f"'{name}' cannot be the name of an element: expected letters, digits and _, a letter first")
    if target.exists():
        raise UelError(f"{target} exists already")
    written = []
    for source in sorted(path for path in TEMPLATE.rglob("*") if path.is_file() and path.suffix != ".pyc"):
        file = target / str(source.relative_to(TEMPLATE)).replace(PLACEHOLDER, name)
        file.parent.mkdir(parents=True, exist_ok=True)
        # what users make of the template belongs to them
        lines = [line for line in source.read_text("utf-8").splitlines(keepends=True) if "SPDX-" not in line]
        text = "".join(lines).replace(PLACEHOLDER, name).replace(_OURSELVES, requirement())
        file.write_text(text, encoding="utf-8")
        written.append(file)
    return written


def requirement() -> str:
    """Return the pip requirement that installs this program again, from installers' record of its origin (PEP 610)."""
    try:
        installed = metadata.distribution("uel")
    except metadata.PackageNotFoundError:
        return "uel"
    record = json.loads(installed.read_text("direct_url.json") or "{}")
    if "url" not in record:
        return f"uel=={installed.version}"
    versioned = record.get("vcs_info")
    if versioned:
        return f"uel @ {versioned['vcs']}+{record['url']}@{versioned['commit_id']}"
    return f"uel @ {record['url']}"
