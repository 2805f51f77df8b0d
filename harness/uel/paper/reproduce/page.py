# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page: the paper's statements, our figures, our numbers and the verdict, in one HTML file."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from math import isinf
from pathlib import Path

from uel.paper.reproduce.statements import JudgedStatement

CAPTIONS = {
    "1": "The two domains and the interface between them.",
    "2": "Traction (MPa) over separation (mm) of the bilinear law, at 1e4 N/mm³.",
    "3": "Horizontal patch: boundary conditions and meshes.",
    "4": "Normal traction along the horizontal interface.",
    "5": "Inclined patch: boundary conditions and meshes. Nodes move by 3 % of an element off the line.",
    "6": "Normal traction along the inclined interface, on straight, rounded and moved nodes.",
    "7": "Double cantilever beam.",
    "8": "Double cantilever beam: load over the displacement of each arm, all elements.",
    "9": "Double cantilever beam [0/0]: normal traction and damage (9).",
    "10": "Double cantilever beam [0/0], perturbed mesh, 1e8 N/mm³; below, close to the front.",
    "11": "Double cantilever beam [0/90]: normal traction and damage (9).",
    "12": "End-notched flexure.",
    "13": "End-notched flexure: load over the displacement at mid-span, all elements.",
    "14": "End-notched flexure [0/0]: tangential traction and damage (9).",
    "15": "End-notched flexure [0/0], perturbed mesh, 1e8 N/mm³; below, close to the front.",
    "16": "End-notched flexure [0/90]: tangential traction and damage (9).",
    "17": "Fixed-ratio mixed mode.",
    "18": "Fixed-ratio mixed mode: load over the displacement of the upper arm, all elements.",
    "19": "Fixed-ratio mixed mode [0/0]: both tractions.",
    "20": "Fixed-ratio mixed mode [0/90]: both tractions.",
}
SECTIONS = {
    "Model": ("1", "2"),
    "Patch tests": ("3", "4", "5", "6"),
    "Double cantilever beam": ("7", "8", "9", "10", "11"),
    "End-notched flexure": ("12", "13", "14", "15", "16"),
    "Fixed-ratio mixed mode": ("17", "18", "19", "20"),
}
STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 sans-serif; color: #222; max-width: 1100px; margin: 1.5em auto; padding: 0 1.5em; }
h1 { font-size: 1.6em; } h2 { border-bottom: 2px solid #ccc; margin-top: 2em; } h3 { margin: 1.2em 0 0.3em; }
figcaption { color: #555; font-size: 0.9em; }
figure { margin: 1em 0; } figure img { max-width: min(100%, 760px); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.88em; width: 100%; }
th, td { border-bottom: 1px solid #ddd; padding: 0.35em 0.5em; text-align: left; vertical-align: top; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.yes, .no { font-weight: bold; white-space: nowrap; } .yes { color: #0072B2; } .no { color: #B24500; }
.why { color: #555; font-size: 0.95em; } q { quotes: "\\201C" "\\201D"; }
@media print { figure { break-inside: avoid; } body { font-size: 11px; } }
"""


@dataclass(frozen=True, slots=True)
class Table:
    """A table with text about it and a picture above it, if there is one."""

    title: str
    text: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    picture: Path | None = None


@dataclass(frozen=True, slots=True)
class Content:
    """Content of the page.

    how       lines about how it was made
    figures   pictures by the paper's numbers
    verdicts  in the order of the paper
    tables    theory, sensitivity, runs
    """

    how: Sequence[str]
    figures: Mapping[str, Path]
    verdicts: Sequence[JudgedStatement]
    tables: Sequence[Table]


def write_page(content: Content, path: Path) -> Path:
    """Write the page; every picture is in it."""
    parts = [*_head(content.how), *_summary(content.verdicts)]
    for title, numbers in SECTIONS.items():
        shown = [number for number in numbers if number in content.figures]
        if shown:
            parts.append(f"<h2>{escape(title)}</h2>")
        for number in shown:
            parts += _figure(number, content)
    rest = [verdict for verdict in content.verdicts if not verdict.statement.figure]
    if rest:
        parts += ["<h2>Statements without a figure</h2>", *_verdict_table(rest)]
    for table in content.tables:
        parts += _table(table)
    parts.append("</body></html>")
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")
    return path


def _head(how: Sequence[str]) -> list[str]:
    return [
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>Reproduction of Ghosh, Duddu, Annavarapu</title><style>{STYLE}</style></head><body>",
        "<h1>A stabilized finite element method for delamination analysis of composites using cohesive elements</h1>",
        "<p>G. Ghosh, R. Duddu, C. Annavarapu. What the paper says, and what our decks and elements give.</p>",
        *(f"<p>{escape(line)}</p>" for line in how),
    ]


def _summary(verdicts: Sequence[JudgedStatement]) -> list[str]:
    good = sum(verdict.reproduced for verdict in verdicts)
    share = f" ({good / len(verdicts):.0%})" if verdicts else ""
    lines = [f"<p><b>{good} of {len(verdicts)} statements reproduced{share}.</b></p>"]
    failed = [verdict for verdict in verdicts if not verdict.reproduced]
    if failed:
        lines += ["<h3>Not reproduced</h3>", *_verdict_table(failed)]
    return lines


def _figure(number: str, content: Content) -> list[str]:
    verdicts = [verdict for verdict in content.verdicts if verdict.statement.figure == number]
    picture = _picture(content.figures[number], f"Figure {number}. {CAPTIONS[number]}")
    return [picture, *_verdict_table(verdicts)] if verdicts else [picture]


def _picture(path: Path, caption: str) -> str:
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    image = f'<img src="data:image/png;base64,{data}" alt="{escape(caption)}">'
    return f"<figure>{image}<figcaption>{escape(caption)}</figcaption></figure>"


def _verdict_table(verdicts: Iterable[JudgedStatement]) -> list[str]:
    lines = [
        '<div class="scroll"><table><tr><th>The paper</th><th>Our number</th><th></th>'
        "<th>Wanted</th><th>Verdict</th></tr>"
    ]
    for verdict in verdicts:
        statement = verdict.statement
        place = f"(section {escape(statement.section)}" + (f", figure {statement.figure})" if statement.figure else ")")
        style, word = ("yes", "✓ reproduced") if verdict.reproduced else ("no", "✗ not reproduced")
        also = "".join(f"<br>{escape(other.text)}: {number(value)}" for other, value in verdict.also)
        why = f'<tr><td colspan="5" class="why">{escape(verdict.why)}</td></tr>' if verdict.why else ""
        lines.append(
            f'<tr id="{escape(statement.id)}"><td><q>{escape(statement.quote)}</q> {place}</td>'
            f"<td>{escape(statement.number.text)}{also}</td><td class='number'>{number(verdict.value)}</td>"
            f"<td>{escape(statement.limits)}</td><td class='{style}'>{word}</td></tr>{why}"
        )
    return [*lines, "</table></div>"]


def number(value: float) -> str:
    """Format a number to four digits, or `none` for infinity: what was looked for did not occur."""
    return "none" if isinf(value) else f"{value:.4g}"


def _table(table: Table) -> list[str]:
    lines = [f"<h2>{escape(table.title)}</h2>", f"<p>{escape(table.text)}</p>"]
    body = ['<div class="scroll"><table><tr>', *(f"<th>{escape(word)}</th>" for word in table.head), "</tr>"]
    for row in table.rows:
        body.append("<tr>" + "".join(f"<td>{escape(word)}</td>" for word in row) + "</tr>")
    body.append("</table></div>")
    picture = [] if table.picture is None else [_picture(table.picture, table.title)]
    return [*lines, *picture, *body]
