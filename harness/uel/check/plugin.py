# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pytest plugin: `pytest --uel my_uel.for --deck job.inp` makes each check of each element type a test.

Every pytest in the environment loads it, so the checks are imported where a deck is.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from uel.check.finding import Finding, Verdict, failed
from uel.errors import UelError

if TYPE_CHECKING:
    from uel.check.examine import TypeReport


class CheckFailedError(Exception):
    """A check failed; the message has the finding and what to change."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options to pytest."""
    group = parser.getgroup("uel", "checks of Abaqus user elements")
    group.addoption("--deck", action="append", default=[], metavar="DECK.inp", help="check the user elements of a deck")
    group.addoption("--uel", action="append", default=[], metavar="FILE", help="user routines of --deck")
    group.addoption("--uel-increments", type=int, default=3, metavar="K", help="increments of --deck to run (3)")
    limit = "time limit of one call of a user routine (60)"
    group.addoption("--uel-call-limit", type=float, metavar="SECONDS", help=limit)


def pytest_configure(config: pytest.Config) -> None:
    """Collect the decks, after the files named on the command line or in testpaths; without any, only the decks."""
    decks = config.getoption("--deck")
    if config.getoption("--uel") and not decks:
        raise pytest.UsageError("--uel needs a deck with the elements: --deck job.inp")
    if decks:
        sources = pytest.Config.ArgsSource
        named = config.args if config.args_source in (sources.ARGS, sources.TESTPATHS) else []
        config.args = [*named, *decks]


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect a deck of --deck."""
    if file_path in [Path(deck).resolve() for deck in parent.config.getoption("--deck")]:
        return UelDeck.from_parent(parent, path=file_path)
    return None


class UelDeck(pytest.File):
    """A deck, with the checks of its user elements."""

    def collect(self) -> Iterator[pytest.Item]:
        """Run the checks: only the deck tells which element types there are."""
        from uel.check.isolated import CALL_LIMIT, examine_isolated  # noqa: PLC0415 (takes a second)

        config = self.config
        try:
            users = [Path(user) for user in config.getoption("--uel")]
            option = config.getoption("--uel-call-limit")
            limit = CALL_LIMIT if option is None else option
            outcome = examine_isolated(
                self.path, users, increments=config.getoption("--uel-increments"), call_limit=limit
            )
        except UelError as error:
            raise self.CollectError(str(error)) from None
        for report in outcome.types:
            for name, finding in report.findings.items():
                yield UelCheck.from_parent(self, name=f"{report.type}-{name}", report=report, finding=finding)
            if report.unseen:
                # if all tests were skipped, pytest would pass
                idle = failed(report.unseen, "To pass, a deck has to load each type of element.")
                yield UelCheck.from_parent(self, name=f"{report.type}-looked-at", report=report, finding=idle)


class UelCheck(pytest.Item):
    """Test item: a check of an element type."""

    def __init__(self, *, report: TypeReport, finding: Finding, **options: object) -> None:
        super().__init__(**options)  # type: ignore[arg-type]
        self._report = report
        self._finding = finding

    def runtest(self) -> None:
        """Pass, skip or fail as the finding says."""
        finding = self._finding
        if finding.verdict is Verdict.NOT_APPLICABLE:
            pytest.skip(finding.message)
        if finding.verdict is Verdict.FAILED:
            raise CheckFailedError(f"{finding.message}\n{finding.advice}")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: object = None) -> str:
        """Return the finding without a traceback."""
        return str(excinfo.value)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the head of a failure."""
        return self.path, None, f"{self.path.name}: {self.name}, elements: {self._report.elements}"
