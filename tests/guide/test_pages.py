# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pages of the repository, which are also the manual: tutorials, commands, links and formulas."""

import os
import re
import shlex
import subprocess
import sys
from functools import cache
from pathlib import Path

import guide
import pytest

from harness.cli import build_parser, from_abaqus

ROOT = Path(__file__).parents[2]
LISTED = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
PAGES = [Path(name) for name in LISTED.split() if (ROOT / name).exists()]
TUTORIALS = ("docs/dcb.md", "docs/install.md")
GENERATED = "docs/generated/"
"""Written by `make docs`."""


@cache
def text_of(page: Path) -> str:
    return (ROOT / page).read_text("utf-8")


def without_code(text: str) -> str:
    """Text of a page without blocks and spans of code."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"(?:(?<=\n\n)|\A)(?: {4}.*\n+)+", "", text)
    return re.sub(r"`[^`]*`", "", text)


@pytest.mark.parametrize("page", TUTORIALS)
def test_tutorial_is_as_its_commands_say(page, tmp_path, monkeypatch, assert_same):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", guide.COLUMNS)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path.parent / "cache"))
    monkeypatch.setenv("MPLBACKEND", "Agg")
    # `python` is the one that runs the tests
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    text = text_of(Path(page))
    assert text.count("```console") > 0
    assert_same(guide.replay(text), text)


def commands() -> list[tuple[Path, str]]:
    """Commands `uel` of code blocks, up to a pipe or a comment; what is left out is written as ..."""
    line = re.compile(r"^(?: {4,}|\$ )(?:\.venv/bin/)?(uel .*)$", re.MULTILINE)
    found = [(page, re.split(r" [|>#] ?|;", command)[0]) for page in PAGES for command in line.findall(text_of(page))]
    return [(page, command) for page, command in found if "..." not in command]


@pytest.mark.parametrize(("page", "command"), commands())
def test_commands_of_all_pages_exist(page, command):
    """With these options: whoever copies a line gets no usage message."""
    words = [re.sub(r"\$\w+", "1", word) for word in shlex.split(command)[1:]]
    parser = build_parser()
    if words[0] == "run":
        words[1:] = from_abaqus(parser, words[1:])
    elif words[0] == "law":
        words[1:] = sorted(words[1:], key=lambda word: word.startswith("-") or "=" not in word)
    parser.parse_args(words)


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_links_lead_somewhere(page):
    """To files of the repository, and to headings of pages."""
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code(text_of(page))):
        if re.match(r"\w+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (ROOT / page).parent / name if name else ROOT / page
        written = str(file.resolve().relative_to(ROOT)).startswith(GENERATED)
        assert written or file.exists(), f"{page}: {target}"
        if anchor:
            headings = re.findall(r"^#+ (.*)$", file.read_text("utf-8"), re.MULTILINE)
            slugs = {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
            assert anchor in slugs, f"{page}: {target}"


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_nothing_looks_like_a_tag_of_html(page):
    """`<sigma>` outside code vanishes in a browser."""
    tags = re.findall(r"<(?!br>|/?details>|/?summary>|!--)/?[A-Za-z][^>\n]*>", without_code(text_of(page)))
    assert tags == []


@pytest.mark.long
def test_site(tmp_path):
    """The whole manual, in which a warning is an error; a browser has to load nothing from elsewhere."""
    pytest.importorskip("sphinx")
    build = [sys.executable, "-m", "sphinx", "--fail-on-warning", "-q", "-c", "docs", ".", str(tmp_path)]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    pages = sorted(tmp_path.rglob("*.html"))
    assert len(pages) > len(PAGES)
    assert (tmp_path / "docs" / "theory.html").read_text().count(
        '<math xmlns="http://www.w3.org/1998/Math/MathML"'
    ) > 30
    assert list(tmp_path.rglob("dcb.png")) != []
    loaded = [re.findall(r'<(?:script|link|img)[^>]*(?:src|href)="(https?:[^"]*)"', page.read_text()) for page in pages]
    assert [address for addresses in loaded for address in addresses] == []
