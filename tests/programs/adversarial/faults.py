# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Does `uel check` find the mistakes of faults.toml, and do the correct elements pass?

    python tests/programs/adversarial/faults.py [WORD ...]

tries the faults and correct elements whose names contain one of the words (default: all) and prints which checks fail.
The exit code is 1 if a correct element fails, or if more faults than MISSED are not found.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from rich.console import Console
from rich.table import Table

import harness.project
from harness.check.apart import examine_apart
from harness.check.finding import Verdict
from harness.errors import UelError

HERE: Final = Path(__file__).parent
ELEMENTS: Final = HERE / "elements"
HEAD: Final = HERE.parents[1] / "harness" / "uel.inc"

MISSED: Final = 2
"""How many of all faults may go unnoticed."""

CALL_LIMIT: Final = 20.0


@dataclass(frozen=True, slots=True)
class Fault:
    """A mistake: `old`, which occurs once in the source or the deck of an element, becomes `new`."""

    name: str
    element: str
    old: str
    new: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """The verdict of `uel check` on an element: the checks that fail, or why nothing could be checked."""

    failed: tuple[str, ...]
    refused: str = ""

    @property
    def found(self) -> bool:
        """Whether the checker reports the mistake."""
        return bool(self.failed or self.refused)

    def __str__(self) -> str:
        return self.refused or ", ".join(self.failed) or "passed"


def faults() -> list[Fault]:
    """All of faults.toml."""
    return [Fault(**row) for row in tomllib.loads((HERE / "faults.toml").read_text("utf-8"))["fault"]]


def elements() -> Iterator[str]:
    """Names of the correct elements."""
    yield "quad"
    yield from sorted(file.stem for file in ELEMENTS.glob("*.f"))


def written(element: str, folder: Path, fault: Fault | None = None) -> tuple[Path, Path]:
    """Source and deck of an element in a folder, with the mistake in them."""
    if element == "quad":
        harness.project.create(folder / "quad")
        source, deck = folder / "quad" / "quad.for", folder / "quad" / "quad.inp"
    else:
        source, deck = folder / f"{element}.f", folder / f"{element}.inp"
        shutil.copy(HEAD, folder)
        shutil.copy(ELEMENTS / deck.name, deck)
        text = (ELEMENTS / source.name).read_text("utf-8")
        source.write_text(text.replace("../../harness/uel.inc", HEAD.name), "utf-8")
    if fault is not None:
        texts = {file: file.read_text("utf-8") for file in (source, deck)}
        counts = [text.count(fault.old) for text in texts.values()]
        if sum(counts) != 1:
            raise ValueError(f"{fault.name}: '{fault.old}' stands {sum(counts)} times in {element}")
        file = source if counts[0] else deck
        file.write_text(texts[file].replace(fault.old, fault.new), "utf-8")
    return source, deck


def check(element: str, fault: Fault | None = None) -> Outcome:
    """What `uel check` says of an element, with a mistake or without."""
    with tempfile.TemporaryDirectory() as folder:
        source, deck = written(element, Path(folder), fault)
        try:
            outcome = examine_apart(deck, [source], call_limit=CALL_LIMIT)
        except UelError as error:
            return Outcome((), str(error).replace(folder, ""))
    findings = {name: found for report in outcome.types for name, found in report.findings.items()}
    return Outcome(tuple(name for name, found in findings.items() if found.verdict is Verdict.FAILED))


def main() -> int:
    """The command; returns its exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("words", nargs="*", metavar="WORD")
    words = parser.parse_args().words
    table = Table("element", "mistake", "found by")
    alarms = missed = 0
    for element in elements():
        right = not words or element in words
        if right:
            outcome = check(element)
            alarms += outcome.found
            table.add_row(element, "none", f"FALSE ALARM: {outcome}" if outcome.found else str(outcome))
        for fault in (fault for fault in faults() if fault.element == element):
            if right or any(word in fault.name for word in words):
                outcome = check(element, fault)
                missed += not outcome.found
                table.add_row(element, fault.name, str(outcome) if outcome.found else "NOT FOUND")
    Console(width=None if sys.stdout.isatty() else 160).print(table)
    print(f"false alarms: {alarms}; faults that are not found: {missed}")
    return int(alarms > 0 or missed > MISSED)


if __name__ == "__main__":
    sys.exit(main())
