# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Does `uel check` find the mistakes of faults.toml and unusual.toml, and do the correct elements pass?

    python tests/programs/adversarial/faults.py [--write] [WORD ...]

tries the faults and correct elements whose names contain one of the words (default: all) and prints which checks fail.
A fault of unusual.toml counts as found if the checks that fail give the right advice, too. --write puts the table of
all into faults.md. The exit code is 1 if a correct element fails, or if more faults of a file are not found than MISSED
allows.
"""

from __future__ import annotations

import argparse
import re
import shutil
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import uel.project
from uel.check.finding import Verdict
from uel.check.isolated import examine_isolated
from uel.errors import UelError

HERE: Final = Path(__file__).parent
ELEMENTS: Final = HERE / "elements"
HEAD: Final = HERE.parents[1] / "harness" / "uel.inc"

MISSED: Final = {"faults.toml": 2, "unusual.toml": 7}
"""How many of the faults of a file may go unnoticed."""

CALL_LIMIT: Final = 20.0

PAGE: Final = HERE / "faults.md"

HEADING: Final = """\
<!-- SPDX-FileCopyrightText: The uel-harness authors -->
<!-- SPDX-License-Identifier: BSD-3-Clause -->
# Seeded mistakes and what `uel check` says of them

Written by `python tests/programs/adversarial/faults.py --write`.

"""


@dataclass(frozen=True, slots=True)
class Fault:
    """A mistake: `old`, which occurs once in the source or the deck of an element, becomes `new`.

    file    that lists it
    advice  regular expression for what the failing checks have to say of it; '' for anything
    """

    file: str
    name: str
    element: str
    old: str
    new: str
    advice: str = ""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The verdict of `uel check` on an element: what failing checks say, by name, or why nothing could be checked."""

    failed: dict[str, str]
    refused: str = ""

    @property
    def found(self) -> bool:
        """Whether the checker reports a mistake."""
        return bool(self.failed or self.refused)

    def finds(self, fault: Fault) -> bool:
        """Whether the checker reports a mistake and says of it what the author needs to know."""
        said = "\n".join((self.refused, *self.failed.values()))
        return self.found and re.search(fault.advice, said) is not None

    def __str__(self) -> str:
        return self.refused or ", ".join(self.failed) or "passed"


def faults(*files: str) -> list[Fault]:
    """Faults of these files, or of all."""
    return [
        Fault(file, **row)
        for file in files or MISSED
        for row in tomllib.loads((HERE / file).read_text("utf-8"))["fault"]
    ]


def elements() -> Iterator[str]:
    """Names of the correct elements."""
    yield "quad"
    yield from sorted(file.stem for file in ELEMENTS.glob("*.f"))


def written(element: str, folder: Path, fault: Fault | None = None) -> tuple[Path, Path]:
    """Source and deck of an element in a folder, with the mistake in them."""
    if element == "quad":
        uel.project.create(folder / "quad")
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
            outcome = examine_isolated(deck, [source], call_limit=CALL_LIMIT)
        except UelError as error:
            return Outcome({}, str(error).replace(folder, ""))
    failed: dict[str, str] = {}
    for report in outcome.types:
        for name, found in report.findings.items():
            if found.verdict is Verdict.FAILED:
                failed[name] = f"{failed.get(name, '')}{found.message}\n{found.advice}\n"
    return Outcome(failed)


@dataclass(frozen=True, slots=True)
class _Row:
    """A row of the table: fault is None for a correct element."""

    element: str
    fault: Fault | None
    outcome: Outcome

    @property
    def right(self) -> bool:
        """The mistake is found, or the correct element passes."""
        return self.outcome.finds(self.fault) if self.fault else not self.outcome.found

    @property
    def words(self) -> tuple[str, str, str]:
        """Element, mistake and what was said of it."""
        if self.fault is None:
            return self.element, "none", f"{'' if self.right else 'FALSE ALARM: '}{self.outcome}"
        wrong = f"WRONG ADVICE: {self.outcome}" if self.outcome.found else "NOT FOUND"
        return self.element, self.fault.name, str(self.outcome) if self.right else wrong


def tried(words: list[str]) -> Iterator[_Row]:
    """Check the correct elements and the faults whose names contain one of the words; without words, all."""
    for element in elements():
        every = not words or element in words
        if every:
            yield _Row(element, None, check(element))
        for fault in (fault for fault in faults() if fault.element == element):
            if every or any(word in fault.name for word in words):
                yield _Row(element, fault, check(element, fault))


def figures(rows: list[_Row]) -> list[str]:
    """Sentences that count the correct elements that pass and the faults of each file that are found."""
    correct = [row for row in rows if row.fault is None]
    said = [f"correct elements that pass: {sum(row.right for row in correct)} of {len(correct)}"]
    for file in MISSED:
        mine = [row for row in rows if row.fault is not None and row.fault.file == file]
        if mine:
            said.append(f"faults of {file} that are found: {sum(row.right for row in mine)} of {len(mine)}")
    return said


def main() -> int:
    """The command; returns its exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("words", nargs="*", metavar="WORD")
    parser.add_argument("--write", action="store_true", help=f"write the table to {PAGE.name}")
    options = parser.parse_args()
    if options.write and options.words:
        parser.error("--write takes all faults")
    rows = []
    for row in tried(options.words):
        rows.append(row)
        print(": ".join(row.words), flush=True)
    print(*figures(rows), sep="\n")
    if options.write:
        PAGE.write_text(page(rows), "utf-8")
    missed = Counter(row.fault.file for row in rows if row.fault and not row.right)
    alarms = any(row.fault is None and not row.right for row in rows)
    return int(alarms or any(missed[file] > most for file, most in MISSED.items()))


def page(rows: list[_Row]) -> str:
    """The figures and the table in Markdown."""
    lines = [
        *(f"- {sentence}" for sentence in figures(rows)),
        "",
        "| element | mistake | checks that fail |",
        "|---|---|---|",
    ]
    lines += [f"| {' | '.join(row.words)} |" for row in rows]
    return HEADING + "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
