# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pages of the repository, which are also the manual: tutorials, commands, links and formulas."""

import argparse
import contextlib
import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

import guide
import numpy as np
import pytest

import uel
from uel.cli import build_parser, from_abaqus
from uel.cli import main as run_command

ROOT = Path(__file__).parents[2]
LISTED = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
PAGES = [Path(name) for name in LISTED.split() if (ROOT / name).exists()]
TUTORIALS = ("docs/dcb.md", "docs/install.md", "docs/plate.md", "docs/fatigue.md", "docs/results.md", "docs/batch.md")
GENERATED = "docs/generated/"
"""Written by `make docs`."""


@cache
def text_of(page: Path) -> str:
    return (ROOT / page).read_text("utf-8")


def without_blocks(text: str) -> str:
    """Text of a page without blocks of code."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"(?:(?<=\n\n)|\A)(?: {4}.*\n+)+", "", text)


def without_code(text: str) -> str:
    """Text of a page without blocks and spans of code."""
    return re.sub(r"`[^`]*`", "", without_blocks(text))


@pytest.fixture
def replayed(tmp_path, monkeypatch):
    """The text of a page with the outputs of its commands, run in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", guide.COLUMNS)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path.parent / "cache"))
    monkeypatch.setenv("MPLBACKEND", "Agg")
    # `python` is the one that runs the tests
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")

    def replay(page: str) -> str:
        guide.prepare(ROOT / page)
        return guide.replay(text_of(Path(page)))

    return replay


@pytest.mark.sample(2)
@pytest.mark.parametrize("page", TUTORIALS)
def test_tutorial_is_as_its_commands_say(page, replayed, assert_same):
    text = text_of(Path(page))
    assert text.count("```console") > 0
    assert_same(replayed(page), text)


@pytest.mark.long
def test_tutorial_of_the_fit(replayed, assert_same):
    """It finds what its curve was made with, which is compared, and the values of the page.

    Rounding may decide after how many steps the search ends, and where: the curve tells the strength to a tenth only,
    of which half is allowed.
    """
    page = "docs/fit.md"
    steps = re.compile(r"^.*: off by .*\n|(?<=converged )after \d+ runs", re.MULTILINE)
    found, text = (steps.sub("", page) for page in (replayed(page), text_of(Path(page))))
    assert_same(found, text, 5e-2)
    made_with = re.search(r"a\s+toughness\s+of\s+(\S+)\s+N/mm\s+and\s+a\s+strength\s+of\s+(\S+)\s+MPa", text)
    toughness, strength = map(float, made_with.groups())
    made_with = re.search(r"made\s+with\s+ENDURANCE\s+(\S+),\s+BRITTLENESS\s+(\S+),", text)
    endurance, brittleness = map(float, made_with.groups())
    true = {"GIC": toughness, "SIGMAMAX": strength, "ENDURANCE": endurance, "BRITTLENESS": brittleness}
    for name, value in true.items():
        intervals = re.findall(rf"^{name} = \S+ 95% between (\S+) and (\S+);", found, re.MULTILINE)
        # of the Paris line, and of the S-N points
        assert len(intervals) == 1 + (name in ("ENDURANCE", "BRITTLENESS"))
        assert all(float(low) < value < float(high) for low, high in intervals)
    deck = Path("dcb.inp").read_text()
    made = deck.replace("20., 0., 0., 30., 60., 0.26,", f"20., 0., 0., {strength}, 60., {toughness},")
    assert made != deck
    Path("made.inp").write_text(made)
    history = uel.run("made.inp", solver=uel.SolverOptions(fallback=True)).history
    x, y = np.loadtxt("measured.csv", delimiter=",", skiprows=1).T
    noise = y - np.interp(x, 2 * history["U2[LOAD]"], history["RF2[LOAD]"])
    assert np.std(noise) == pytest.approx(0.01 * history["RF2[LOAD]"].max(), rel=0.2)


def commands() -> list[tuple[Path, str]]:
    """Commands `uel` of code blocks, up to a pipe or a comment; what is left out is written as ..."""
    line = re.compile(r"^(?: {4,}|\$ )(?:\.venv/bin/)?(uel .*)$", re.MULTILINE)
    found = [(page, re.split(r" [|>#] ?|;", command)[0]) for page in PAGES for command in line.findall(text_of(page))]
    return [(page, command) for page, command in found if "..." not in command]


def test_every_argument_has_a_meaning():
    """The page of the commands takes it from the parser."""
    parser = build_parser()
    (within,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    without = [
        (name, action.dest)
        for name, command in within.choices.items()
        for action in command._actions
        if not action.help
    ]
    assert without == []


def words_of(command: str) -> list[str]:
    """Words after `uel`; a variable of the shell is 1."""
    return [re.sub(r"\$\w+", "1", word) for word in shlex.split(command)[1:]]


@pytest.mark.parametrize(("page", "command"), commands())
def test_commands_of_all_pages_exist(page, command):
    """With these options: whoever copies a line gets no usage message."""
    words = words_of(command)
    parser = build_parser()
    if words[0] == "run":
        words[1:] = from_abaqus(parser, words[1:])
    elif words[0] == "law":
        words[1:] = sorted(words[1:], key=lambda word: word.startswith("-") or "=" not in word)
    parser.parse_args(words)


def spans(first: str) -> list[tuple[Path, str]]:
    """Commands within lines, whose first word may be given as a regular expression; the changelog may name old ones."""
    span = re.compile(rf"`(?:\.venv/bin/)?((?:{first}) [^`]+)`")
    pages = [page for page in PAGES if page.name != "CHANGELOG.md"]
    found = [(page, " ".join(words.split())) for page in pages for words in span.findall(without_blocks(text_of(page)))]
    return sorted(set(found), key=str)


def test_commands_within_lines_exist():
    """They may leave out arguments: each subcommand and each option is there."""
    parser = build_parser()
    (within,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    wrong = []
    for page, command in spans("uel"):
        first, *words = command.split()[1:]
        known = (
            within.choices[first]._option_string_actions if first in within.choices else parser._option_string_actions
        )
        options = [word.partition("=")[0] for word in words if re.match(r"--?[a-z]", word)]
        if (first not in within.choices and first not in known) or not set(options) <= set(known):
            wrong.append(f"{page}: {command}")
    assert len(spans("uel")) > 50
    assert wrong == []


def test_programs_and_targets_of_all_pages_exist():
    """Modules and programs of Python with these options, targets of make."""
    targets = re.search(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)[1].split()
    wrong = []
    for page, command in spans("python|make"):
        first, *words = command.split()
        if first == "make":
            good = words[0] in targets
        elif words[0] == "-m" and len(words) > 1:
            found = importlib.util.find_spec(words[1])
            good = found is not None and options_are_in(words[2:], Path(found.origin))
        elif words[0].endswith(".py"):
            good = (ROOT / words[0]).exists() and options_are_in(words[1:], ROOT / words[0])
        else:
            good = words[0] in ("-m", "-c")
        if not good:
            wrong.append(f"{page}: {command}")
    assert len(spans("python|make")) > 50
    assert wrong == []


def options_are_in(words: list[str], file: Path) -> bool:
    """Whether a program names these options; those of a package stand in one of its files."""
    files = file.parent.glob("*.py") if file.name == "__init__.py" else [file]
    text = "".join(found.read_text("utf-8") for found in files)
    return all(f'"{word}"' in text for word in words if word.startswith("--") and word != "--help")


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    """A folder with the files that pages take as examples."""
    folder = tmp_path_factory.mktemp("stage")
    with contextlib.chdir(folder):
        assert run_command(["new", "my_uel"]) == 0
        Path("decks").mkdir()
        for place in ("job.inp", "beam.inp", "decks/one.inp", "decks/two.inp"):
            shutil.copy("my_uel/my_uel.inp", place)
        shutil.copy("my_uel/my_uel.for", ".")
        for page in ("plate", "batch"):
            guide.write_files(ROOT / "docs" / f"{page}.md")
    return folder


ELSEWHERE = re.compile(r"abaqus_inputs/|uel reproduce|my_uel\.inp|plot my_uel|--oldjob|fit bridged\.inp")
"""Decks of the repository, `uel reproduce` and the fit of bridging run in tests/verification, a new project in
tests/harness/project, and restarts in tests/harness/test_restart.py."""


@pytest.mark.parametrize(
    "command",
    sorted({words for page, words in commands() if f"$ {words}" not in text_of(page) and not ELSEWHERE.search(words)}),
)
def test_examples_run(command, stage, monkeypatch):
    """What stands outside of tutorials, with stand-ins for the files."""
    monkeypatch.chdir(stage)
    assert run_command(words_of(command)) == 0


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
    build = [sys.executable, "-m", "sphinx", "--fail-on-warning", "-q", "-c", ROOT / "docs", ROOT, tmp_path]
    done = subprocess.run(build, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    pages = sorted(tmp_path.rglob("*.html"))
    assert len(pages) > len(PAGES)
    assert (tmp_path / "docs" / "theory.html").read_text().count(
        '<math xmlns="http://www.w3.org/1998/Math/MathML"'
    ) > 30
    for picture in ("dcb.png", "dcb_fit.png", "model_load.png", "model_mesh.png"):
        assert list(tmp_path.rglob(picture)) != []
    # a block of code that is a file has its name above it, which is a link to it
    plate = (tmp_path / "docs" / "plate.html").read_text()
    (deck,) = re.findall(r'href="\.\./(_downloads/\w+/laminate\.inp)"', plate)
    assert (tmp_path / deck).read_text() == re.search(
        r"^```abaqus laminate\.inp\n(.*?)^```$", text_of(Path("docs/plate.md")), re.MULTILINE | re.DOTALL
    )[1]
    verification = (tmp_path / "docs" / "generated" / "verification.html").read_text()
    pictures = re.findall(r'<img alt="([^"]+)"[^>]* src="\.\./\.\./_images/picture\w*\.png"', verification)
    assert len(pictures) == len(list((ROOT / "abaqus_inputs").glob("*/picture.png")))
    loaded = [re.findall(r'<(?:script|link|img)[^>]*(?:src|href)="(https?:[^"]*)"', page.read_text()) for page in pages]
    assert [address for addresses in loaded for address in addresses] == []
