# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The version of the build is the newest one of the changelog, and both say whether it is released."""

import re
from datetime import date
from importlib.metadata import version
from pathlib import Path

CHANGELOG = Path(__file__).parents[1] / "CHANGELOG.md"
HEADING = re.compile(r"^## (\S+) \((\S+)\)$", re.MULTILINE)


def test_changelog_begins_with_this_version() -> None:
    newest, when = HEADING.findall(CHANGELOG.read_text())[0]
    release, _, development = version("uel").partition(".dev")
    assert newest == release
    assert (when == "unreleased") == bool(development)


def test_releases_have_a_date() -> None:
    """Only the newest version may be unreleased; dates fall towards the oldest."""
    sections = HEADING.findall(CHANGELOG.read_text())
    dates = [date.fromisoformat(when) for _, when in sections if when != "unreleased"]
    assert len(dates) >= len(sections) - 1
    assert dates == sorted(dates, reverse=True)
