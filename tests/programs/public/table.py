# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Table of public user elements that run here unmodified.

    python tests/programs/public/table.py FOLDER [-o FILE] [ROW ...]

FOLDER holds a checkout of each public repository of manifest.toml, under the repository's name. Nothing of theirs is
in this repository.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import asdict
from pathlib import Path

from measure import Outcome, Row, missing, rows

MEASURE = Path(__file__).with_name("measure.py")
HEAD = """\
# Public user elements, unmodified

Codes that others wrote for Abaqus, with their decks, run by this harness as they are. Their files are not part of this
repository; `python tests/programs/public/table.py FOLDER -o harness/uel/usersub/public-uels.md` writes this page from a
folder of checkouts, by [the manifest](../../../tests/programs/public/manifest.toml). Grade of the expected value: **T**
theory, **A** real Abaqus, **M** the stored result of another code, **B** this harness' built-in element of the same
formulation in place of the user's, in a second run (which shows that the harness drives both alike), **Q** an
independent quick host: for small strains (plausibility only), or
[kirigami.py](../../../tests/programs/public/kirigami.py), which only uses the element's energy density.

"""
TABLE = """\
| code | deck | quantity | our figure | expected | grade | verdict |
|---|---|---|---|---|---|---|
"""

REASONS = {
    "unsupported": "something that is not supported",
    "solver": "a feature of another solver: Abaqus/Explicit, CalculiX",
    "deck": "a fault of the deck, or files that the repository does not have",
    "code": "a fault of the user's code, or a library or compiler it needs",
    "time": "no end within the time of the row",
    "unknown": "an end before the end of the deck, of which the cause is not known",
}
"""`reason` of a row of the manifest that does not run to its end, and what the page says of it."""


def summary(known: dict[str, Row], outcomes: dict[str, Outcome]) -> str:
    """How many decks run, and why the others do not."""
    stopped = Counter(known[name].get("reason", "unknown") for name, outcome in outcomes.items() if outcome.error)
    ran = len(outcomes) - stopped.total()
    repositories = len({known[name]["folder"] for name in outcomes})
    text = (
        f"Of {len(outcomes)} decks of {repositories} repositories {ran} run, to the end or as far as the table says.\n"
    )
    whole = len(outcomes) - sum(stopped[fault] for fault in ("solver", "deck", "code"))
    if whole:
        text += (
            f"Of those without a feature of another solver and without a fault of their own, {ran} of {whole} run,\n"
        )
        text += f"{100 * ran / whole:.0f} %. What stops the others:\n\n| what | decks |\n|---|---|\n"
    for reason, meaning in REASONS.items():
        text += f"| {meaning} | {stopped[reason]} |\n" if stopped[reason] else ""
    return text + "\n"


def run(folder: Path, row: Row) -> Outcome:
    """Outcome of a row that runs in its own process, for as long as the row allows."""
    absent = missing(folder, row)
    if absent:
        return Outcome(error=f"not in the folder: {absent[0]}")
    command = [sys.executable, str(MEASURE), str(folder.resolve()), row["name"]]
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    limit = float(row.get("seconds", 300))
    try:
        # user routines may write into the current folder
        with tempfile.TemporaryDirectory() as scratch:
            done = subprocess.run(
                command, cwd=scratch, capture_output=True, text=True, env=environment, timeout=limit, check=False
            )
    except subprocess.TimeoutExpired:
        return Outcome(error=f"not finished after {limit:g} s")
    if done.returncode:
        return Outcome(error=(done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1])
    return Outcome(**json.loads(done.stdout.splitlines()[-1]))


def verdict(row: Row, outcome: Outcome) -> tuple[bool, str]:
    """Whether the row is as expected, and the verdict."""
    shown = outcome.error if len(outcome.error) < 300 else f"{outcome.error[:297]}..."
    shown = shown.replace("|", "\\|")
    if "refused" in row:
        return row["refused"] in outcome.error, f"refused: {shown}" if outcome.error else "not refused"
    if outcome.error:
        return False, shown
    if row.get("only") == "read":
        return True, "read"
    done = f"{outcome.increments} increments, {outcome.cutbacks} cutbacks"
    expected = row.get("expected", outcome.expected)
    if expected is None:
        return True, f"completed ({done})"
    assert outcome.figure is not None
    if "status" in row:
        agrees = outcome.figure >= row["expected"]
        return agrees, f"{'agrees' if agrees else 'differs'} ({done})"
    deviation = abs(outcome.figure / expected - 1.0)
    agrees = deviation <= row["tolerance"]
    return agrees, f"{'agrees' if agrees else 'differs'}, {100 * deviation:.2g} % ({done})"


def line(row: Row, outcome: Outcome) -> str:
    """Row of the table."""
    figure = "" if outcome.figure is None else f"{outcome.figure:.5g}"
    value = row.get("expected", outcome.expected)
    expected = "" if value is None else f"{value:.5g}"
    deck = row["deck"].rpartition("/")[2]
    entries = row["code"], deck, row.get("text", "runs to the end"), figure, expected, row.get("grade", "")
    return f"| {' | '.join(entries)} | {verdict(row, outcome)[1]} |\n"


def main() -> int:
    """Write the table; returns 1 if a row is not as expected."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("rows", nargs="*", help="names of rows (all)")
    parser.add_argument("-o", "--output", type=Path, help="file to write (print)")
    parser.add_argument("--results", type=Path, help="JSON file of outcomes: rows in it are not run again")
    options = parser.parse_intermixed_args()
    known = rows()
    kept = json.loads(options.results.read_text("utf-8")) if options.results and options.results.exists() else {}
    text, good = "", True
    outcomes: dict[str, Outcome] = {}
    for name in options.rows or known:
        outcome = Outcome(**kept[name]) if name in kept else run(options.folder, known[name])
        kept[name] = asdict(outcome)
        outcomes[name] = outcome
        if options.results:
            options.results.write_text(json.dumps(kept, indent=1), encoding="utf-8")
        good &= verdict(known[name], outcome)[0]
        text += line(known[name], outcome).replace(f"{options.folder}/", "")
        print(name, *verdict(known[name], outcome), outcome.figure, file=sys.stderr)
    text = HEAD + summary(known, outcomes) + TABLE + text
    if options.output:
        options.output.write_text(text, encoding="utf-8")
    else:
        print(text)
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
