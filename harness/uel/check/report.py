# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Findings of the checks as a table and as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Final

from rich.console import Group
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from uel.check.examine import Examination, TypeReport
from uel.check.finding import Conclusion, Verdict
from uel.errors import UelError

_STYLES: Final = {Verdict.PASSED: "green", Verdict.FAILED: "bold red", Verdict.NOT_APPLICABLE: "dim"}


def table(outcome: Examination) -> Group:
    """Return a table with advice for each element type, the end of the run, and warnings about the deck."""
    parts: list[Table | Text] = []
    for report in outcome.types:
        title = f"{outcome.deck.name}: {report.type}, elements: {report.elements}, states: {report.states}"
        shown = Table("check", "verdict", title=escape(title), title_justify="left")
        # a long word, such as a path, continues on the next line
        shown.add_column("finding", overflow="fold")
        for name, finding in report.findings.items():
            shown.add_row(name, _cell(finding.verdict), Text(finding.message))
        parts.append(shown)
        parts += _advice(report)
        if report.unseen:
            parts.append(Text(report.unseen, "bold red"))
    if outcome.stopped:
        parts.append(Text(f"The run of the deck ended early: {outcome.stopped}"))
    parts += [Text(f"Warning: {warning}") for warning in outcome.warnings]
    return Group(*parts)


def _cell(verdict: Verdict) -> Text:
    return Text(verdict.upper() if verdict is Verdict.FAILED else verdict, _STYLES[verdict])


def _advice(report: TypeReport) -> list[Text]:
    return [
        Text(f"{report.type} {name}: {finding.advice}")
        for name, finding in report.findings.items()
        if finding.verdict is Verdict.FAILED
    ]


def as_json(outcome: Examination) -> str:
    """Return all findings as JSON."""
    data = {
        "deck": str(outcome.deck),
        "user": [str(file) for file in outcome.user],
        "increments": outcome.increments,
        "stopped": outcome.stopped,
        "warnings": outcome.warnings,
        "seed": outcome.seed,
        "conclusion": outcome.conclusion,
        "passed": outcome.passed,
        "types": [
            {**asdict(report), "conclusion": report.conclusion, "looked_at": report.looked_at}
            for report in outcome.types
        ],
    }
    return json.dumps(data, indent=2) + "\n"


def error_as_json(error: UelError) -> str:
    """Return the error that prevented the checks as JSON."""
    return json.dumps({"conclusion": Conclusion.NOTHING, "passed": False, "error": str(error)}, indent=2) + "\n"
