# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel new`: what it makes runs, is tested, and says nothing of the template."""

import json
import re
import subprocess
import sys
from importlib import metadata

import pytest

from uel.cli import main

NAMES = {
    "beam_x.for",
    "beam_x.inp",
    "test_beam_x.py",
    "pytest.ini",
    "requirements.txt",
    "README.md",
    ".gitignore",
    ".github/workflows/test.yml",
}


@pytest.fixture
def project(tmp_path, capsys):
    folder = tmp_path / "beam_x"
    assert main(["new", str(folder)]) == 0
    assert "uel run beam_x.inp --user beam_x.for; pytest" in capsys.readouterr().out
    return folder


def test_files(project):
    files = [path for path in project.rglob("*") if path.is_file()]
    assert {str(path.relative_to(project)) for path in files} == NAMES
    for path in files:
        text = path.read_text()
        assert "my_uel" not in text
        assert "SPDX" not in text
    assert max(map(len, (project / "beam_x.for").read_text().splitlines())) <= 72


def test_its_tests_pass_and_its_deck_runs(project):
    command = [sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider"]
    result = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    assert re.search(r"\b(\d\d) passed, \d skipped", result.stdout), result.stdout
    assert "test_beam_x.py" in result.stdout
    command = [sys.executable, "-m", "uel.cli", "run", "beam_x.inp", "--user", "beam_x.for"]
    result = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    assert "beam_x: completed" in result.stdout, result.stderr
    # the stresses, by the name that the deck gives them
    assert (
        main(["plot", str(project / "beam_x"), "--kind", "mesh", "--field", "S11", "-o", str(project / "s.png")]) == 0
    )
    assert (project / "s.png").exists()


@pytest.mark.parametrize(
    ("record", "expected"),
    [
        (None, f"uel=={metadata.version('uel')}"),
        ({"url": "file:///a/clone", "dir_info": {"editable": True}}, "uel @ file:///a/clone"),
        ({"url": "file:///a/uel.whl", "archive_info": {}}, "uel @ file:///a/uel.whl"),
        (
            {"url": "https://a.b/c.git", "vcs_info": {"vcs": "git", "commit_id": "0123abc"}},
            "uel @ git+https://a.b/c.git@0123abc",
        ),
    ],
    ids=["index", "folder", "wheel", "git"],
)
def test_requirement_is_what_was_installed(tmp_path, monkeypatch, record, expected):
    """No name that an index might not have: the records are those of PEP 610."""
    installed = type(metadata.distribution("uel"))
    text = None if record is None else json.dumps(record)
    read = installed.read_text
    monkeypatch.setattr(
        installed, "read_text", lambda self, name: text if name == "direct_url.json" else read(self, name)
    )
    assert main(["new", str(tmp_path / "beam_x")]) == 0
    assert expected in (tmp_path / "beam_x" / "requirements.txt").read_text().splitlines()


@pytest.mark.long
def test_its_tests_can_fail(project):
    """A wrong factor in forces and stiffness is seen by theory alone."""
    kernel = project / "beam_x.for"
    text = kernel.read_text()
    assert text.count("volume = area*props(3)") == 1
    kernel.write_text(text.replace("volume = area*props(3)", "volume = area"))
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    result = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    assert "test_patch" in result.stdout
    assert "1 failed" in result.stdout


@pytest.mark.parametrize("name", ["1st", "a-b", "a b", ".", "é"])
def test_name_that_is_none(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    assert main(["new", name]) == 2
    assert "cannot be the name of an element: expected letters, digits and _" in capsys.readouterr().err


def test_folder_that_exists(project, capsys):
    assert main(["new", str(project)]) == 1
    assert "beam_x exists already" in capsys.readouterr().err
