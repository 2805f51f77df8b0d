# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command where the system does not help it: a message, the exit code that is due, files that can be read."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from kills import write_deck
from readable import complaints

from uel.output import Result
from uel.output.files.sta_file import NOT_COMPLETED
from uel.usersub.own_kernels import path_of_kernels

UEL = f"{shlex.quote(sys.executable)} -m uel.cli"
BEAM = Path(__file__).parents[2] / "abaqus_inputs" / "dcb" / "dcb_u4_1e8.inp"
SPRING = Path(__file__).parents[1] / "harness" / "usersub" / "spring.c"
SPRING_DECK = (
    "*NODE\n1, 0.\n2, 1.\n*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=1\n1\n"
    "*ELEMENT, TYPE=U1, ELSET=ALL\n1, 1, 2\n*UEL PROPERTY, ELSET=ALL\n1.\n"
    "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n*END STEP\n"
)


def shell(folder: Path, line: str, **environment: str | None) -> subprocess.CompletedProcess[str]:
    """Run a line of the shell; an environment variable that is None is not there."""
    variables = {**os.environ, **environment}
    given = {name: value for name, value in variables.items() if value is not None}
    command = ["bash", "-c", f'uel() {{ {UEL} "$@"; }}; {line}']
    result = subprocess.run(command, cwd=folder, env=given, capture_output=True, text=True, check=False, timeout=300)
    assert "Traceback" not in result.stderr, result.stderr
    assert "Exception ignored" not in result.stderr, result.stderr
    return result


@pytest.fixture
def pulled(tmp_path: Path) -> str:
    """Words of `uel` for a run of a spring with a user file."""
    (tmp_path / "pulled.inp").write_text(SPRING_DECK)
    return f"run pulled.inp --user {shlex.quote(str(SPRING))}"


def completed(folder: Path, name: str = "pulled") -> bool:
    assert complaints(folder / name, outputs_each=False) == []
    return Result(folder / name).completed


def test_file_that_may_not_grow(tmp_path: Path) -> None:
    """As on a full disk: one file takes no more, with all others written to their end."""
    # the library of user routines, which the run copies, has to fit; with run-time checks it is as large as the largest
    # file of the beam in a hundred increments
    most = path_of_kernels().stat().st_size // 1024 + 50
    decks = shutil.copytree(BEAM.parent, tmp_path / "decks")
    deck = decks / BEAM.name
    text = deck.read_text()
    deck.write_text(text.replace("\n0.01, 1., 1e-07, 0.01\n", "\n0.005, 1., 1e-07, 0.005\n"))
    assert deck.read_text() != text
    result = shell(tmp_path, f"ulimit -f {most}; uel run {shlex.quote(str(deck))} --quiet")
    assert result.returncode == 1
    first, warning, second = result.stderr.splitlines()
    assert first == f"uel: {BEAM.stem}_interface.csv: File too large"
    assert warning.startswith("uel: earlier warning: ")
    assert re.fullmatch(
        rf"uel: {BEAM.stem} ended after increment \d+ of step 1 .*; what was written is readable", second
    )
    assert (tmp_path / f"{BEAM.stem}.sta").read_text().splitlines()[-1] == NOT_COMPLETED
    assert "File too large" in (tmp_path / f"{BEAM.stem}.msg").read_text()
    assert complaints(tmp_path / BEAM.stem, outputs_each=False) == []


@pytest.mark.long
def test_full_disk(tmp_path: Path) -> None:
    small = tmp_path / "small"
    small.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", small], check=False).returncode:
        pytest.skip("a small disk takes the rights of root")
    try:
        result = shell(tmp_path, f"uel run {shlex.quote(str(BEAM))} --quiet --output-dir small")
        assert result.returncode == 1
        assert "No space left on device" in result.stderr
        assert (small / f"{BEAM.stem}.sta").read_text().splitlines()[-1] == NOT_COMPLETED
        assert complaints(small / BEAM.stem, outputs_each=False) == []
    finally:
        subprocess.run(["umount", small], check=True)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("folder", "message"),
    [
        ("file", "uel: file: File exists"),
        ("file/within", "uel: file/within: Not a directory"),
        ("/proc/within", "uel: /proc/within: No such file or directory"),
    ],
)
def test_folder_that_takes_no_files(tmp_path: Path, pulled: str, folder: str, message: str) -> None:
    (tmp_path / "file").touch()
    result = shell(tmp_path, f"uel {pulled} --output-dir {folder}")
    assert (result.returncode, result.stderr, result.stdout) == (1, f"{message}\n", "")


@pytest.mark.sample(3)
@pytest.mark.parametrize("home", [None, "/nonexistent", "/proc"])
def test_no_home(tmp_path: Path, pulled: str, home: str | None) -> None:
    assert shell(tmp_path, f"uel {pulled}", HOME=home, XDG_CACHE_HOME=None).returncode == 0
    assert completed(tmp_path)


@pytest.mark.sample(3)
@pytest.mark.parametrize("redirected", [">&-", "<&- >&- 2>&-", "> /dev/full", "2> /dev/full", "| head -c 0"])
def test_run_whose_output_goes_nowhere(tmp_path: Path, pulled: str, redirected: str) -> None:
    """The exit code says whether the analysis has completed, and nothing gets into its files."""
    assert shell(tmp_path, f"set -o pipefail; uel {pulled} {redirected}").returncode == 0
    assert completed(tmp_path)
    assert (tmp_path / "pulled.sta").read_text().count("completed") == 0
    (tmp_path / "pulled.inp").write_text("*NODDE\n")
    assert shell(tmp_path, f"set -o pipefail; uel {pulled} {redirected}").returncode == 1


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("line", "code", "message"),
    [
        ("uel solvers > /dev/full", 1, "uel: standard output: No space left on device\n"),
        ("uel solvers >&-", 0, ""),
        ("uel solvers | head -n 1; exit ${PIPESTATUS[1]}", 0, ""),
        ("uel law --angles 0 --increments 4 | head -n 1; exit ${PIPESTATUS[1]}", 0, ""),
    ],
)
def test_other_commands_whose_output_goes_nowhere(tmp_path: Path, line: str, code: int, message: str) -> None:
    result = shell(tmp_path, line)
    assert (result.returncode, result.stderr) == (code, message)


def test_plain_terminal_and_no_locale(tmp_path: Path, pulled: str) -> None:
    plain = {"TERM": "dumb", "LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    assert shell(tmp_path, f"uel {pulled} --job zäh", **plain).returncode == 0
    assert completed(tmp_path, "zäh")


def test_current_folder_that_is_gone(tmp_path: Path, pulled: str) -> None:
    (tmp_path / "gone").mkdir()
    within = "cd gone; rmdir ../gone"
    result = shell(tmp_path, f"{within}; uel run {tmp_path}/pulled.inp --user {SPRING}")
    assert (result.returncode, result.stderr) == (1, "uel: pulled.lck: No such file or directory\n")
    (tmp_path / "gone").mkdir()
    result = shell(tmp_path, f"{within}; uel run {tmp_path}/pulled.inp --user {SPRING} --output-dir {tmp_path}/here")
    assert result.returncode == 0
    assert completed(tmp_path / "here")


@pytest.mark.sample(2)
@pytest.mark.parametrize("length", [245, 300])
def test_long_names(tmp_path: Path, pulled: str, length: int) -> None:
    """A name that some of the files still have room for, and one for none."""
    result = shell(tmp_path, f"uel {pulled} --job {'n' * length}")
    assert result.returncode == 1
    assert result.stderr.endswith(": File name too long\n")
    if length < 250:
        assert (tmp_path / f"{'n' * length}.sta").read_text().splitlines()[-1] == NOT_COMPLETED


def test_strange_names(tmp_path: Path) -> None:
    folder, job = "a folder\n'of' mine", 'the "first" & <only>\njob\'s'
    write_deck(tmp_path)
    words = f"--output-dir {shlex.quote(folder)} --job {shlex.quote(job)}"
    assert shell(tmp_path, f"uel run pressed.inp --quiet {words}").returncode == 0
    assert complaints(tmp_path / folder / job) == []
    root = ElementTree.parse(tmp_path / folder / f"{job}.pvd").getroot()
    assert {(tmp_path / folder / entry.attrib["file"]).is_file() for entry in root.iter("DataSet")} == {True}
