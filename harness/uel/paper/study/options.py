# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of the commands of the studies, and the tables that they write into pages."""

from __future__ import annotations

import argparse
import os
from pathlib import Path


def study_parser(module: str, description: str, folder: str, *, resumes: bool = False) -> argparse.ArgumentParser:
    """Read the options of `python -m MODULE`: folder of its files and, if an interrupted study resumes, processes."""
    parser = argparse.ArgumentParser(
        prog=f"python -m {module}",
        description=description,
        epilog="An interrupted study resumes where it stopped." if resumes else None,
    )
    parser.add_argument("--output-dir", type=Path, default=Path(folder), help=f"folder of all files written ({folder})")
    if resumes:
        parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes (one for each core)")
    return parser


def write_tables(page: Path, mark: str, content: str) -> None:
    """Replace what stands below a mark on a page."""
    above, mark, _ = page.read_text("utf-8").partition(mark)
    page.write_text(f"{above}{mark}\n{content}", encoding="utf-8")
