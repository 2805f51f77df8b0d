# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel --version`, `uel doctor` on installations with this and that missing, and completion in a shell."""

import re
import subprocess
import sys
import tempfile
from importlib import metadata

import pytest

from uel import doctor
from uel.cli import main

COMPILERS = ("gfortran", "gcc", "g++")


@pytest.fixture
def examined(capsys, tmp_path, monkeypatch):
    """Exit code of `uel doctor`, its findings by the name of the part as (state, rest), and the last line."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

    def examine() -> tuple[int, dict[str, tuple[str, str]], str]:
        code = main(["doctor"])
        text = capsys.readouterr().out
        *lines, last = re.sub(r"\n {8}-> ", " -> ", text).splitlines()
        rows = [re.fullmatch(r"(\w+) +(.+?): (.*)", line) for line in lines]
        assert None not in rows, text
        return code, {row[2]: (row[1], row[3]) for row in rows if row}, last

    return examine


def test_version(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out == f"uel {metadata.version('uel')}\n"


def test_version_without_an_installation(capsys, monkeypatch):
    monkeypatch.setattr(doctor, "DISTRIBUTION", "no-such-distribution")
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out == "uel (not installed as a package)\n"


def test_all_that_the_tests_need_works(examined, tmp_path):
    """Each compiler works at every call, and leaves nothing in the cache."""
    for _ in range(2):
        code, rows, last = examined()
        assert code == 0
        assert last == "nothing is broken; what is absent is optional"
        for part in ("uel", "numpy", "meshio", "the project's elements", "linear solver superlu", *COMPILERS):
            assert rows[part][0] == "ok", rows[part]
        assert all(rows[compiler][1].endswith("compiles, and the result loads") for compiler in COMPILERS)
    assert rows["cache of compiled files"] == ("ok", str(tmp_path / "cache" / "uel" / "compiled"))
    assert list((tmp_path / "cache" / "uel" / "compiled").iterdir()) == []


def test_without_compilers(examined, tmp_path, monkeypatch):
    """The project's elements need none, so nothing is broken."""
    monkeypatch.setenv("PATH", str(tmp_path))
    code, rows, _ = examined()
    assert code == 0
    assert rows["gfortran"] == (
        "absent",
        "not found; --user with .f, .for, .f90 needs it -> apt install gfortran, dnf install gcc-gfortran",
    )
    assert [rows[compiler][0] for compiler in COMPILERS] == ["absent"] * 3
    assert rows["AddressSanitizer"][0] == "absent"
    assert "gfortran has no libasan" in rows["AddressSanitizer"][1]
    assert rows["the project's elements"][0] == "ok"


def test_compiler_that_does_not_work(examined, tmp_path, monkeypatch):
    program = tmp_path / "gfortran"
    program.write_text(
        '#!/bin/sh\n[ "$1" = -dumpfullversion ] && echo 9.9.9 && exit 0\necho "Error: no disk" >&2\nexit 1\n'
    )
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    code, rows, last = examined()
    assert code == 1
    assert last == "broken: gfortran"
    state, text = rows["gfortran"]
    assert state == "broken"
    assert re.match(rf"9\.9\.9 \({program}\): two lines do not compile or load: .*no disk.* -> apt install", text)


def test_package_that_is_missing(examined, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    code, rows, last = examined()
    assert code == 1
    assert last == "broken: meshio"
    assert rows["meshio"][1].endswith("-> pip install --force-reinstall meshio")


def test_host_that_is_missing(examined, monkeypatch):
    monkeypatch.setitem(sys.modules, "uel.usersub", None)
    code, rows, last = examined()
    assert code == 1
    assert last == "broken: compiled host"
    assert rows["compiled host"][1].endswith("-> " + doctor.AGAIN)


NO_RUNTIME = """
import sys
from importlib.abc import MetaPathFinder

class Finder(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "uel.usersub._host":
            raise ImportError("libgfortran.so.5: cannot open shared object file: No such file or directory")

sys.meta_path.insert(0, Finder())
from uel.cli import main
sys.exit(main(sys.argv[1:]))
"""


def test_without_the_libraries_of_fortran(tmp_path):
    """As on a system without any compiler: told what to install, also by what needs the host."""
    missing = "the compiled host does not load: libgfortran.so.5: cannot open shared object file"
    (tmp_path / "deck.inp").write_text("*HEADING\n")
    for words, code, told in (
        (["doctor"], 1, "-> apt install libgfortran5 libgomp1, dnf install libgfortran libgomp"),
        (["run", "deck.inp"], 1, f"uel: {missing}"),
        (["solvers"], 0, "superlu"),
    ):
        command = [sys.executable, "-c", NO_RUNTIME, *words]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == code, done
        assert told in done.stdout + done.stderr
        assert "Traceback" not in done.stderr


def test_program_that_is_not_installed(examined, monkeypatch):
    monkeypatch.setattr(doctor, "DISTRIBUTION", "no-such-distribution")
    code, rows, last = examined()
    assert code == 1
    assert last == "broken: uel"
    assert rows["uel"][1].startswith("not installed as a package; Python ")


def test_no_folder_for_temporary_files(examined, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "none"))
    code, rows, _ = examined()
    assert code == 1
    assert rows["the project's elements"][0] == "broken"
    assert "-> set TMPDIR to a folder that can be written" in rows["the project's elements"][1]


def test_cache_that_others_can_write(examined, tmp_path):
    folder = tmp_path / "cache" / "uel" / "compiled"
    folder.mkdir(parents=True)
    folder.chmod(0o777)
    code, rows, _ = examined()
    assert code == 0
    assert rows["cache of compiled files"] == (
        "absent",
        "none (cannot be written, or others can write there): each run compiles again "
        "-> set XDG_CACHE_HOME to a folder of your own",
    )


def test_optional_packages(examined, monkeypatch):
    """Those of the metadata, each with the extra that has it."""
    lines = ["numpy>=2.0", "no-such-package>=1 ; extra == 'more'", 'pypardiso; extra == "fast"']
    monkeypatch.setattr(metadata, "requires", lambda _: lines)
    code, rows, _ = examined()
    assert code == 0
    assert rows["no-such-package"] == (
        "absent",
        "not installed; the extra [more] has it -> pip install no-such-package",
    )
    assert "pypardiso" not in rows
    assert "linear solver pardiso" in rows


@pytest.mark.parametrize(
    ("words", "expected"),
    [(["doc"], {"doctor"}), (["run", "--fall"], {"--fallback"}), (["run", "--control", ""], {"load", "energy"})],
)
def test_completion_in_bash(capsys, tmp_path, words, expected):
    assert main(["completion", "bash"]) == 0
    (tmp_path / "uel").write_text(capsys.readouterr().out)
    typed = " ".join(f"'{word}'" for word in ("uel", *words))
    program = f"source ./uel; COMP_WORDS=({typed}); COMP_CWORD={len(words)}; _shtab_uel; echo ${{COMPREPLY[@]}}"
    done = subprocess.run(["bash", "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == expected


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_completion_of_other_shells_has_every_command(capsys, shell):
    assert main(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert all(re.search(rf"\b{command}\b", text) for command in ("run", "batch", "doctor", "completion"))


def test_completion_without_its_package(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["completion", "bash"]) == 1
    assert capsys.readouterr().err == "uel: completion needs the package shtab (pip install shtab)\n"
