# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the commands of the guide: `python tests/programs/guide/guide.py` prints it with their current outputs.

With `--write` it saves the guide with them.

Code blocks that name a file after their language are that file; `diff` blocks change it, `console` blocks are commands
after `$` with their output. A comment `continues PAGE` says that the files of another page are there, beside meshes of
the page's folder.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from uel.cli import main as uel

GUIDE = Path(__file__).parents[3] / "harness" / "uel" / "project" / "ten-minutes.md"
COLUMNS = "110"
_CONTINUES = re.compile(r"^<!-- continues (\S+) -->$", re.MULTILINE)
_BLOCK = re.compile(r"^```(?P<language>\w+)(?: (?P<file>\S+))?\n(?P<body>.*?)^```$", re.MULTILINE | re.DOTALL)


def continued(page: Path) -> list[Path]:
    """Pages whose files a page takes for granted."""
    return [page.parent / before for before in _CONTINUES.findall(page.read_text("utf-8"))]


def prepare(page: Path) -> None:
    """Put what a page takes for granted into the current folder: meshes that it names, and the files of other pages."""
    text = page.read_text("utf-8")
    for mesh in page.parent.glob("*.msh"):
        if mesh.name in text:
            shutil.copy(mesh, mesh.name)
    for before in continued(page):
        write_files(before)


def write_files(page: Path) -> None:
    """Write the files of a page, and what it takes for granted, into the current folder, without changes to them."""
    prepare(page)
    for block in _BLOCK.finditer(page.read_text("utf-8")):
        if block["file"] and block["language"] != "diff":
            Path(block["file"]).write_text(block["body"], encoding="utf-8")


def replay(text: str) -> str:
    """The guide with the outputs of its commands, run in the current folder, which is empty."""

    def act(block: re.Match[str]) -> str:
        language, file, body = block["language"], block["file"], block["body"]
        if language == "console":
            body = "".join(
                f"$ {command}\n{_output(command)}" for command in re.findall(r"^\$ (.*)$", body, re.MULTILINE)
            )
            return f"```console\n{body}```"
        if language == "diff":
            Path(file).write_text(_changed(Path(file).read_text("utf-8"), body), encoding="utf-8")
        elif file:
            Path(file).write_text(body, encoding="utf-8")
        return block[0]

    return _BLOCK.sub(act, text)


def _changed(text: str, diff: str) -> str:
    """The text with the lines after `-` replaced by those after `+`; lines after a blank stay, and say where."""
    lines = diff.splitlines(keepends=True)
    before = "".join(line[1:] for line in lines if line[0] != "+")
    after = "".join(line[1:] for line in lines if line[0] != "-")
    if text.count(before) != 1:
        raise ValueError(f"these lines are there {text.count(before)} times:\n{before}")
    return text.replace(before, after)


def _output(command: str) -> str:
    """What a command prints; `uel` runs in this process, which saves its start-up time."""
    first, _, rest = command.partition(" | ")
    printed = _run_uel(first) if first.startswith("uel ") else _run_shell(first)
    if rest:
        printed = _run_shell(rest, printed)
    return "".join(f"{line.rstrip()}\n" for line in printed.splitlines())


def _run_uel(command: str) -> str:
    stream = io.StringIO()
    with contextlib.redirect_stdout(stream), contextlib.redirect_stderr(stream):
        uel(shlex.split(command)[1:])
    return stream.getvalue()


def _run_shell(command: str, given: str = "") -> str:
    result = subprocess.run(["bash", "-c", command], input=given, capture_output=True, text=True, check=False)
    return result.stdout + result.stderr


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("guide", type=Path, nargs="?", default=GUIDE)
    parser.add_argument("--write", action="store_true", help="replace the outputs in the guide")
    options = parser.parse_args()
    os.environ["COLUMNS"] = COLUMNS
    guide = options.guide.resolve()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        prepare(guide)
        text = replay(guide.read_text("utf-8"))
    if options.write:
        guide.write_text(text, encoding="utf-8")
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
