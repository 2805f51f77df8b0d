# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of Abaqus' keywords, to tell one that is not supported from one that does not exist."""

from pathlib import Path

_TEXT = Path(__file__).with_suffix(".txt").read_text(encoding="utf-8")
_OTHERS, MATERIAL_KEYWORDS = (frozenset(part.splitlines()) for part in _TEXT.split("\n", 1)[1].split("\n\n"))
ABAQUS_KEYWORDS = _OTHERS | MATERIAL_KEYWORDS
"""All keywords. MATERIAL_KEYWORDS may follow *MATERIAL."""
