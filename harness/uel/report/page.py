# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of a job: one HTML file that holds its pictures and needs no network."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Final

from uel.report.model_tables import Table
from uel.report.pictures import Picture

_LONGEST_DECK: Final = 3000
"""Lines of a deck that the page shows."""

_LONGEST_OPEN: Final = 150
"""Lines of a deck that is not folded."""

STYLE: Final = """
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 70rem; margin: 0 auto; padding: 1rem 1.2rem 4rem; }
h1 { font-size: 1.7rem; margin: 0.6rem 0 0; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 0.6rem; padding-bottom: 0.2rem; border-bottom: 2px solid #ccc; }
h3 { font-size: 1rem; margin: 1.2rem 0 0.3rem; }
p, ul { margin: 0.4rem 0; }
.heading { color: #555; }
.verdict { display: inline-block; padding: 0.1rem 0.7rem; border-radius: 1rem; color: #fff; font-size: 0.95rem; }
.completed { background: #0072B2; } .ended { background: #B24500; }
.facts { display: flex; flex-wrap: wrap; gap: 0.3rem 2rem; list-style: none; padding: 0; font-weight: 600; }
.warnings li { overflow-wrap: anywhere; margin: 0.3rem 0; }
.pictures { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 1.5rem; }
@media (max-width: 50rem) { .pictures { grid-template-columns: minmax(0, 1fr); } }
figure { margin: 0; } figure img { width: 100%; height: auto; } figure.wide { grid-column: 1 / -1; }
figcaption { color: #555; font-size: 0.9rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.92rem; }
th, td { border-bottom: 1px solid #ddd; padding: 0.25rem 0.9rem 0.25rem 0; text-align: left; vertical-align: top; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
th.number { text-align: right; }
pre { font: 0.8rem/1.4 ui-monospace, monospace; overflow-x: auto; background: #f6f6f6; padding: 0.8rem; }
pre span { color: #767676; user-select: none; } pre b { font-weight: normal; } pre b:target { background: #ffe9a8; }
a { color: #0072B2; }
@media print { details { display: none; } figure { break-inside: avoid; } }
"""

_NUMBER: Final = re.compile(r"-|[-+]?\d[\d.]*(e[-+]?\d+)?")
_PLACE: Final = re.compile(r"(?P<file>\S[^\n:]*\.\w+):(?P<line>\d+)")


@dataclass(frozen=True, slots=True)
class Content:
    """Content of the page.

    job, heading  name of the job, *HEADING of its deck
    completed     whether the analysis has completed
    facts         what one wants to know first
    errors, warnings  of the run
    notes         what is to be said about the page itself
    tables        of the model
    times         what took time, and how much
    deck, lines   path of the deck, None if unknown, and its text
    files         names of the files of the job
    """

    job: str
    heading: str
    completed: bool
    facts: Sequence[str]
    errors: Sequence[str]
    warnings: Sequence[str]
    notes: Sequence[str]
    tables: Sequence[Table]
    times: Sequence[tuple[str, str]]
    pictures: Sequence[Picture]
    deck: Path | None
    lines: Sequence[str]
    files: Sequence[str]


def write_page(content: Content, path: Path) -> Path:
    """Write the page; returns its path."""
    path.write_text("\n".join(_page(content)) + "\n", encoding="utf-8", errors="replace")
    return path


def _page(content: Content) -> Iterator[str]:
    title = escape(content.job)
    yield '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>"
    verdict = ("completed", "completed") if content.completed else ("ended", "not completed")
    yield f'<h1>{title} <span class="verdict {verdict[0]}">{verdict[1]}</span></h1>'
    if content.heading:
        yield f'<p class="heading">{escape(content.heading)}</p>'
    yield f'<ul class="facts">{"".join(f"<li>{escape(fact)}</li>" for fact in content.facts)}</ul>'
    for note in content.notes:
        yield f"<p>{escape(note)}</p>"
    yield from _remarks(content, "Errors", content.errors)
    yield from _remarks(content, "Warnings", content.warnings)
    if content.pictures:
        yield '<h2>Results</h2>\n<div class="pictures">'
        for picture in content.pictures:
            wide = ' class="wide"' if picture.address.startswith("data:image/png") else ""
            caption = escape(picture.caption)
            image = f'<img src="{picture.address}" alt="{caption}">'
            yield f"<figure{wide}>{image}<figcaption>{caption}</figcaption></figure>"
        yield "</div>"
    if content.tables:
        yield "<h2>Model</h2>"
        for table in content.tables:
            yield from _table(content, table)
    if content.times:
        yield "<h2>Where time went</h2>"
        yield from _rows(("", "processor time"), content.times)
    yield f"<h2>Files</h2>\n<p>{escape(', '.join(content.files))}</p>"
    yield from _deck(content)
    yield "</body>\n</html>"


def _remarks(content: Content, title: str, remarks: Sequence[str]) -> Iterator[str]:
    if remarks:
        items = "".join(f"<li>{_linked(content, remark)}</li>" for remark in remarks)
        yield f'<h2>{title} ({len(remarks)})</h2>\n<ul class="warnings">{items}</ul>'


def _linked(content: Content, text: str) -> str:
    """Link the lines of the deck that a text names."""
    parts: list[str] = []
    end = 0
    for match in _PLACE.finditer(text):
        line = int(match["line"])
        if content.deck is not None and Path(match["file"]).name == content.deck.name and _is_shown(content, line):
            parts += [escape(text[end : match.start()]), f'<a href="#L{line}">{escape(match[0])}</a>']
            end = match.end()
    return "".join([*parts, escape(text[end:])])


def _table(content: Content, table: Table) -> Iterator[str]:
    title = escape(table.title)
    if table.source is not None:
        title += f" <small>{_linked(content, f'{Path(table.source.file).name}:{table.source.line}')}</small>"
    yield f"<h3>{title}</h3>"
    yield from _rows(table.head, table.rows)


def _rows(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield a table in HTML; columns of numbers are set to the right."""
    right = [all(_NUMBER.fullmatch(row[k]) for row in rows) for k in range(len(head))]
    sides = [' class="number"' if is_number else "" for is_number in right]
    yield '<div class="scroll"><table>'
    yield "<tr>" + "".join(f"<th{side}>{escape(cell)}</th>" for side, cell in zip(sides, head, strict=True)) + "</tr>"
    for row in rows:
        yield (
            "<tr>" + "".join(f"<td{side}>{escape(cell)}</td>" for side, cell in zip(sides, row, strict=True)) + "</tr>"
        )
    yield "</table></div>"


def _deck(content: Content) -> Iterator[str]:
    """Yield the deck with the numbers of its lines; links open it."""
    if content.deck is None or not content.lines:
        return
    unfolded = " open" if len(content.lines) <= _LONGEST_OPEN else ""
    yield f"<h2>Deck</h2>\n<p>{escape(str(content.deck))}</p>\n<details{unfolded}><summary>its lines</summary><pre>"
    width = len(str(len(content.lines)))
    for number, line in enumerate(content.lines[:_LONGEST_DECK], 1):
        yield f'<b id="L{number}"><span>{number:>{width}}  </span>{escape(line)}</b>'
    if len(content.lines) > _LONGEST_DECK:
        yield f"... and {len(content.lines) - _LONGEST_DECK} more lines"
    yield "</pre></details>"


def _is_shown(content: Content, line: int) -> bool:
    return 1 <= line <= min(len(content.lines), _LONGEST_DECK)
