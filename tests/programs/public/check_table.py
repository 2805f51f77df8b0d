# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What `uel check` finds in public user elements.

    python tests/programs/public/check_table.py FOLDER [-o FILE] [ROW ...]

FOLDER is that of table.py. Each row is checked once for each of its decks, for at most `--seconds` each.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from measure import Row, missing, rows

HEAD = """\
# What the checker finds in public user elements

`uel check` on codes that others wrote for Abaqus, with their decks, unmodified. Their files are not part of this
repository; `python tests/programs/public/check_table.py FOLDER -o harness/uel/check/public-uels.md` writes this page
from a folder of checkouts, by [the manifest](../../../tests/programs/public/manifest.toml). A finding is not always a
mistake: an approximate AMATRX can be deliberate, and an axisymmetric element resists translation. [This
page](README.md) describes each check.

| code | deck | type | passed | failed | cause, where somebody looked for it |
|---|---|---|---|---|---|
"""
UNCHECKED = "no elements of a type defined by *USER ELEMENT"
"""In the error of rows that only have a user material, which are left out."""

CAUSES = Path(__file__).with_name("causes.toml")


def chosen() -> dict[str, Row]:
    """Rows with user elements, one for each pair of sources and deck."""
    known = {name: row for name, row in rows().items() if row["sources"] and not {"only", "refused"} & row.keys()}
    unique = {(row["folder"], *row["sources"], row["deck"]): name for name, row in reversed(known.items())}
    return {name: row for name, row in known.items() if name in unique.values()}


def check(folder: Path, row: Row, seconds: float) -> dict[str, Any]:
    """The checker's findings, with `error` where there are none."""
    absent = missing(folder, row)
    if absent:
        return {"error": f"not in the folder: {absent[0]}"}
    root = folder.resolve() / row["folder"]
    with tempfile.TemporaryDirectory() as output:
        file = Path(output) / "findings.json"
        files = [str(root / name) for name in [*row["sources"], row["deck"]]]
        command = [sys.executable, "-m", "uel.cli", "check", *files, "--json", str(file)]
        try:
            # user routines may write into the current folder
            done = subprocess.run(command, cwd=output, capture_output=True, text=True, timeout=seconds, check=False)
        except subprocess.TimeoutExpired:
            return {"error": f"not finished after {seconds:g} s"}
        if not file.exists():
            return {"error": (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]}
        found: dict[str, Any] = json.loads(file.read_text("utf-8"))
        return found


def lines(row: Row, found: dict[str, Any], cause: str) -> str:
    """Rows of the table, one for each element type."""
    deck = row["deck"].rpartition("/")[2]
    if "error" in found:
        return f"| {row['code']} | {deck} | | | {escaped(found['error'])} | {cause} |\n"
    text = ""
    for report in found["types"]:
        findings = report["findings"]
        passed = sum(finding["verdict"] == "passed" for finding in findings.values())
        failed = [
            f"**{name}**: {escaped(finding['message'])}"
            for name, finding in findings.items()
            if finding["verdict"] == "failed"
        ]
        why = cause if failed else ""
        text += f"| {row['code']} | {deck} | {report['type']} | {passed} | {'<br>'.join(failed)} | {why} |\n"
    return text


def escaped(text: str) -> str:
    """Text for a cell, on one line."""
    shown = text if len(text) < 400 else f"{text[:397]}..."
    return " ".join(shown.split()).replace("|", "\\|")


def main() -> int:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("rows", nargs="*", help="names of rows (all with user elements)")
    parser.add_argument("-o", "--output", type=Path, help="file to write (print)")
    parser.add_argument("--results", type=Path, help="JSON file of findings: rows in it are not checked again")
    parser.add_argument("--seconds", type=float, default=120.0, help="time for one deck (120)")
    options = parser.parse_intermixed_args()
    known, causes = chosen(), tomllib.loads(CAUSES.read_text("utf-8"))
    kept = json.loads(options.results.read_text("utf-8")) if options.results and options.results.exists() else {}
    text = HEAD
    for name in options.rows or known:
        if name not in kept:
            kept[name] = check(options.folder, known[name], options.seconds)
        if options.results:
            options.results.write_text(json.dumps(kept, indent=1), encoding="utf-8")
        if UNCHECKED in kept[name].get("error", ""):
            continue
        row = lines(known[name], kept[name], causes.get(name, "")).replace(f"{options.folder.resolve()}/", "")
        print(name, row, file=sys.stderr)
        text += row
    if options.output:
        options.output.write_text(text, encoding="utf-8")
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
