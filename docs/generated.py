# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the manual takes from the program itself: the command, the gallery of verification, pictures of tutorials."""

import argparse
import contextlib
import os
import re
import shutil
import tempfile
import tomllib
import zipfile
from collections import Counter
from pathlib import Path

from guide import continued, prepare, replay
from pygments.lexer import RegexLexer
from pygments.token import Comment, Keyword, Number, Text
from sphinx.application import Sphinx
from support import support

from uel.cli import build_parser
from uel.paper.gallery import EXAMPLES, PICTURE

ROOT = Path(__file__).parents[1]
PAGES = Path(__file__).with_name("generated")
FILE = re.compile(r"^```(?P<language>\w+) (?P<file>[\w.]+)\n(?P<body>.*?)^```$", re.MULTILINE | re.DOTALL)
"""A block of code that is a file: see tests/programs/guide/guide.py."""


def commands() -> str:
    """Every command with its arguments and options, from the parser."""
    page = ["# The command", "`uel COMMAND --help` prints the same.", ""]
    parser = build_parser()
    within = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    for choice in within._choices_actions:
        command = within.choices[choice.dest]
        usage = re.sub(r"^ {7}", "", command.format_usage().removeprefix("usage: "), flags=re.MULTILINE)
        page += [f"## uel {choice.dest}", _sentence(command.description or choice.help or ""), f"```text\n{usage}```"]
        page += ["| argument | meaning |", "|---|---|"]
        for action in command._actions:
            if not isinstance(action, argparse._HelpAction):
                page.append(f"| {_named(action)} | {_cell(command, action)} |")
        page += ["", f"```text\n{command.epilog}\n```" if "\n" in (command.epilog or "") else command.epilog or "", ""]
    return _page(page)


def _named(action: argparse.Action) -> str:
    names = ", ".join(f"`{name}`" for name in action.option_strings)
    value = "" if action.nargs == 0 else action.metavar or ", ".join(action.choices or [action.dest])
    return f"{names} `{value}`".strip() if value else names


def _cell(command: argparse.ArgumentParser, action: argparse.Action) -> str:
    text = command._get_formatter()._expand_help(action) if action.help else ""
    return text.replace("|", "\\|").replace("*", "\\*").replace("<", "&lt;")


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def gallery() -> str:
    """Every problem of abaqus_inputs: its picture, against what it verifies, its decks and a command."""
    page = [
        "# Verification",
        "Each problem has a page in the form of a verification manual and decks that run in Abaqus unchanged. Its "
        "values are compared by the tests, each with a tolerance and its reason: *analytic* from theory, *other code* "
        "from a published result of another program, *paper figure* read from one, *regression* from this program "
        "itself, which detects changes and verifies nothing.",
        "",
        "The decks of a problem, with the files that they include, are in one archive; the command runs the one of the "
        "picture, or the first of several.",
        "",
        "````{container} gallery",
    ]
    pages = sorted((ROOT / "abaqus_inputs").glob("*/README.md"))
    for file in pages:
        text = file.read_text("utf-8")
        title, alt = (re.search(pattern, text, re.MULTILINE)[1] for pattern in (r"^# (.*)$", rf"^!\[(.*)\]\({PICTURE}"))
        reference = tomllib.loads(file.with_name("reference.toml").read_text("utf-8"))
        values = reference["value"]
        kinds = ", ".join(f"{count} {kind}" for kind, count in Counter(value["kind"] for value in values).items())
        decks = {deck for value in values for deck in value["decks"]}
        place = f"../../abaqus_inputs/{file.parent.name}"
        deck = f"{EXAMPLES[file.parent.name].decks[0]}.inp"
        options = " --fallback" if reference.get("fallback") else ""
        minutes = ", up to some minutes" if deck in reference.get("long", []) else ""
        counted = "1 deck" if len(decks) == 1 else f"{len(decks)} decks"
        page += [
            "```{container} problem",
            f"![{alt}]({place}/{PICTURE})",
            "",
            f"**[{title}]({place}/README.md)**",
            "",
            f"{kinds}; [{counted}]({_archive(file.parent)})",
            "",
            f"`uel run {deck}{options}`{minutes}",
            "```",
        ]
    page += ["````", "", "```{toctree}", ":hidden:"]
    page += [f"/{file.relative_to(ROOT).with_suffix('')}" for file in pages]
    return _page([*page, "/abaqus_inputs/benchmarks", "```"])


def _archive(folder: Path) -> str:
    """Name of an archive with the decks of a folder, which has the name of the folder."""
    name = f"{folder.name}.zip"
    with zipfile.ZipFile(PAGES / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for deck in sorted(folder.glob("*.inp")):
            # the same bytes at each build
            archive.writestr(zipfile.ZipInfo(f"{folder.name}/{deck.name}"), deck.read_bytes(), zipfile.ZIP_DEFLATED)
    return name


def _page(lines: list[str]) -> str:
    return "\n".join(lines) + "\n"


def write(*_: object) -> None:
    """Write the pages, where that changes them, and the pictures."""
    PAGES.mkdir(exist_ok=True)
    for tutorial in sorted(ROOT.glob("docs/*.md")):
        draw(tutorial)
    for name, text in {"commands": commands(), "support": support(), "verification": gallery()}.items():
        file = PAGES / f"{name}.md"
        if not file.exists() or file.read_text("utf-8") != text:
            file.write_text(text, encoding="utf-8")


def draw(page: Path) -> None:
    """Follow a tutorial, unless it has been since it was changed, and keep those of its pictures that it shows."""
    text = page.read_text("utf-8")
    pictures = [PAGES / name for name in re.findall(r"!\[[^]]*\]\(generated/([\w.]+)\)", text)]
    changed = max(file.stat().st_mtime for file in [page, *continued(page)])
    if "```console" not in text or all(file.exists() and file.stat().st_mtime > changed for file in pictures):
        return
    os.environ["MPLBACKEND"] = "Agg"
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        prepare(page)
        replay(text)
        for picture in pictures:
            shutil.copyfile(next(Path().rglob(picture.name)), picture)


def name_files(_app: Sphinx, name: str, source: list[str]) -> None:
    """Blocks of code that are a file get its name above them, where it is linked to the file itself.

    Readers of the repository see the name in the source of the page alone; those of the site would not see it at all.
    """

    def named(block: re.Match[str]) -> str:
        language, file = block["language"], block["file"]
        caption = f"{file}, changed"
        if language != "diff":
            kept = PAGES / Path(name).name / file
            kept.parent.mkdir(exist_ok=True)
            kept.write_text(block["body"], encoding="utf-8")
            caption = f"{{download}}`{file} </{kept.relative_to(ROOT)}>`"
        return f"```{{code-block}} {language}\n:caption: {caption}\n\n{block['body']}```"

    source[0] = FILE.sub(named, source[0])


class DeckLexer(RegexLexer):
    """Colours of an input deck."""

    name = "Abaqus"
    aliases = ("abaqus",)
    flags = re.MULTILINE
    tokens = {  # noqa: RUF012 (pygments' interface)
        "root": [
            (r"^\*\*.*$", Comment),
            (r"^\*[^,\n]+", Keyword),
            (r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\b", Number),
            (r"\w+|[\s\S]", Text),
        ]
    }


def escape(_app: Sphinx, _what: str, _name: str, _object: object, _options: object, lines: list[str]) -> None:
    """Escape keywords in a docstring, such as *STEP, which begin no emphasis."""
    lines[:] = [re.sub(r"(?<![*\w])\*(?=[A-Z])", r"\\*", line) for line in lines]


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before they are read."""
    app.connect("builder-inited", write)
    app.connect("source-read", name_files)
    app.connect("autodoc-process-docstring", escape)
    app.add_lexer("abaqus", DeckLexer)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
