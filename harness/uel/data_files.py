# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Paths of the decks and of the manual's pages: in the repository, or where a wheel puts them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_PACKAGE: Final = Path(__file__).parent

_REPOSITORY: Final = _PACKAGE.parents[1]

FOLDER: Final = _REPOSITORY if (_REPOSITORY / "abaqus_inputs").is_dir() else _PACKAGE / "manual"
"""Folder that has `README.md`, `docs` and `abaqus_inputs`."""
