# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Close the files of a run that could not do so itself."""

from __future__ import annotations

from pathlib import Path

from harness.output.status import COMPLETED, NOT_COMPLETED
from harness.output.wording import remark


def close_broken(stem: Path, reason: str) -> None:
    """Say in STEM.sta and STEM.msg that the analysis was not completed, and why; files that are not there stay away."""
    status, message = (stem.with_name(stem.name + ending) for ending in (".sta", ".msg"))
    if not status.exists():
        return
    lines = status.read_text("utf-8", errors="replace").splitlines()
    if COMPLETED in lines or NOT_COMPLETED in lines:
        return
    with status.open("a", encoding="utf-8") as file:
        file.write(f"{' ' * 26}\n{NOT_COMPLETED}\n")
    with message.open("a", encoding="utf-8") as file:
        file.write(remark("ERROR", reason))
