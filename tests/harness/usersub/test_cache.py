# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compiled files are taken from the cache where nothing has changed that the compiler had read, and only there."""

import errno
import os
import pwd
import subprocess
import sys
from pathlib import Path

import pytest
from user_database import database, note, said

from uel import usersub
from uel.errors import CompileError
from uel.usersub.compilation import cache as store
from uel.usersub.compilation import compiler

VALUE = "      i = {}\n"
SCRIPT = """\
import os, sys
from pathlib import Path
from uel import usersub
library = usersub.load(Path("user.f"), job=f"job{os.getpid()}", output_dir=Path(sys.argv[1]))
library.external_database(0, 0, (0.0, 0.0), 0.0, 1, 0)
print([message.text for message in library.messages()])
library.close()
"""


@pytest.mark.parametrize(
    "include",
    ['#define F "x.inc"\n#include F\n', "#define F 'x.inc'\n      include F\n", '#define F "x.inc"\n      include F\n'],
)
def test_include_named_by_a_macro(load, tmp_path, include):
    text = database(include + note("%I", "i"))
    for value in ("1", "2"):
        (tmp_path / "x.inc").write_text(VALUE.format(value))
        assert said(load(text)) == [value]


def test_include_within_an_include_elsewhere(load, tmp_path):
    (tmp_path / "a $b #c").mkdir()
    (tmp_path / "a $b #c" / "one.inc").write_text('#include "two.inc"\n')
    text = database('#define F "a $b #c/one.inc"\n#include F\n' + note("%I", "i"))
    for value in ("1", "2"):
        (tmp_path / "a $b #c" / "two.inc").write_text(VALUE.format(value))
        assert said(load(text)) == [value]


def test_include_that_comes_before_the_one_read(load, tmp_path):
    text = database('#define F "x.inc"\n#include F\n' + note("%I", "i"))
    (tmp_path / "deck").mkdir()
    (tmp_path / "deck" / "x.inc").write_text(VALUE.format(1))
    assert said(load(text, deck=tmp_path / "deck" / "job.inp")) == ["1"]
    (tmp_path / "x.inc").write_text(VALUE.format(2))
    assert said(load(text, deck=tmp_path / "deck" / "job.inp")) == ["2"]


def test_include_of_another_deck(load, tmp_path):
    text = database('#define F "x.inc"\n#include F\n' + note("%I", "i"))
    for value in ("1", "2", "1"):
        folder = tmp_path / value
        folder.mkdir(exist_ok=True)
        (folder / "x.inc").write_text(VALUE.format(value))
        assert said(load(text, deck=folder / "job.inp")) == [value]


def test_module_file(load, tmp_path):
    text = database(note("%I", "i")).replace("include", "use numbers\n      include", 1)
    for value in ("1", "2"):
        (tmp_path / "numbers.f90").write_text(f"module numbers\ninteger, parameter :: i = {value}\nend module\n")
        subprocess.run(["gfortran", "-fsyntax-only", "numbers.f90"], cwd=tmp_path, check=True)
        assert said(load(text)) == [value]


def test_header_of_c(load, tmp_path):
    text = '#define F "x.h"\n#include F\n#include <aba_for_c.h>\nint values[VALUE];\nvoid FOR_NAME(umat)(void) {}\n'
    (tmp_path / "x.h").write_text("#define VALUE 1\n")
    first = load(text, "user.c").file
    assert load(text, "user.c").file == first
    (tmp_path / "x.h").write_text("#define VALUE 2\n")
    assert load(text, "user.c").file != first


def test_nothing_has_changed(load, tmp_path, monkeypatch):
    (tmp_path / "x.inc").write_text(VALUE.format(1))
    text = database('#define F "x.inc"\n#include F\n' + note("%I", "i"))
    load(text)
    monkeypatch.setattr(compiler, "_compile", lambda *_, **__: pytest.fail("compiled again"))
    assert said(load(text)) == ["1"]


def test_file_that_is_changed_while_it_is_compiled(load, tmp_path, monkeypatch):
    include, compile_ = tmp_path / "x.inc", compiler._compile
    text = database('#define F "x.inc"\n#include F\n' + note("%I", "i"))

    def slow(*arguments, **options):
        made = compile_(*arguments, **options)
        include.write_text(VALUE.format(2))
        later = include.stat().st_mtime + 10
        os.utime(include, (later, later))
        return made

    include.write_text(VALUE.format(1))
    monkeypatch.setattr(compiler, "_compile", slow)
    assert said(load(text)) == ["1"]
    monkeypatch.setattr(compiler, "_compile", compile_)
    assert said(load(text)) == ["2"]


def truncate(file):
    file.write_bytes(file.read_bytes()[:5000])


def make_folder(file):
    file.unlink()
    (file / "within").mkdir(parents=True)


def other_machine(file):
    """The byte that names it."""
    content = bytearray(file.read_bytes())
    content[18] ^= 0xFF
    file.write_bytes(content)


DAMAGE = {
    "cut off": truncate,
    "of another machine": other_machine,
    "empty": lambda file: file.write_bytes(b""),
    "garbage": lambda file: file.write_bytes(b"\x7fELF\xff\xfe{" * 999),
    "a folder": make_folder,
    "missing": lambda file: file.unlink(),
    "a link to itself": lambda file: (file.unlink(), file.symlink_to(file.name)),
    "another object": lambda file: file.write_text("[]"),
    "without its parts": lambda file: file.write_text('{"modules": "", "read": 1}'),
    "deep": lambda file: file.write_text("[" * 100_000),
}


@pytest.mark.sample(4)
@pytest.mark.parametrize("damage", DAMAGE)
@pytest.mark.parametrize("suffix", [".so", ".json"])
def test_damaged_entry(load, cache, suffix, damage):
    load(database(note()))
    (file,) = cache.glob(f"*{suffix}")
    DAMAGE[damage](file)
    assert said(load(database(note()))) == ["here"]


def run_isolated(folder, **environment):
    """Whether a process of its own loads the file in the folder, with this environment; returns it running."""
    there = {key: value for key, value in os.environ.items() if key not in ("HOME", "XDG_CACHE_HOME")} | environment
    command = [sys.executable, "-c", SCRIPT, str(folder)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, cwd=folder, env=there, text=True, **pipes)


def good(process):
    output, errors = process.communicate()
    assert (process.returncode, output, errors) == (0, "['here']\n", "")


# root could make any other folder
@pytest.mark.parametrize("home", ["/proc/nowhere", "/dev/null", ""])
@pytest.mark.parametrize("cache", [{}, {"XDG_CACHE_HOME": "/dev/null"}])
def test_no_cache_leaves_nothing_behind(tmp_path, home, cache):
    (tmp_path / "user.f").write_text(database(note()))
    (tmp_path / "scratch").mkdir()
    good(run_isolated(tmp_path, TMPDIR=str(tmp_path / "scratch"), HOME=home, **cache))
    assert list((tmp_path / "scratch").iterdir()) == []
    assert {file.name for file in tmp_path.iterdir()} == {"user.f", "scratch"}


def test_nobody_without_a_home(load, monkeypatch):
    """As in a container whose user is not in the list of users."""
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.delenv("HOME", raising=False)
    monkeypatch.setattr(pwd, "getpwuid", {}.__getitem__)
    assert store.cache_folder() is None
    assert said(load(database(note()))) == ["here"]


def test_ten_processes_at_once(tmp_path):
    (tmp_path / "user.f").write_text(database(note()))
    processes = [run_isolated(tmp_path, XDG_CACHE_HOME=str(tmp_path / "cache")) for _ in range(10)]
    for process in processes:
        good(process)
    left = sorted(file.suffix for file in (tmp_path / "cache" / "uel" / "compiled").iterdir())
    assert set(left) == {".json", ".so"}
    assert left.count(".json") == left.count(".so")


def test_full_disk(load, cache, monkeypatch):
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "replace", full)
    assert said(load(database(note()))) == ["here"]
    assert list(cache.iterdir()) == []


def test_folder_that_others_can_write(load, cache):
    load(database(note()))
    for mode in (0o777, 0o770):
        cache.chmod(mode)
        assert store.cache_folder() is None
        assert said(load(database(note()))) == ["here"]
    cache.chmod(0o700)
    assert len(list(cache.glob("*.so"))) == 1


def test_folder_around_it_may_be_open(load, cache):
    """As one that is made with an open umask: what is in it is looked at itself."""
    cache.parent.mkdir(parents=True)
    cache.parent.chmod(0o775)
    load(database(note()))
    assert len(list(cache.glob("*.so"))) == 1


def test_folder_of_someone_else(load, cache, monkeypatch):
    other = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: other)
    assert said(load(database(note()))) == ["here"]
    assert list(cache.iterdir()) == []


def test_folder_of_the_cache_is_private(load, cache):
    before = os.umask(0)
    try:
        load(database(note()))
    finally:
        os.umask(before)
    assert cache.stat().st_mode & 0o777 == 0o700


def test_rule_of_make():
    text = "0.o 0.o: user.f \\\n /a\\ b/x.inc \\\n  c$$d/\\#e.inc y.inc\n"
    assert store.dependencies(text) == ["user.f", "/a b/x.inc", "c$d/#e.inc", "y.inc"]


@pytest.mark.parametrize("line", ["      include 'pipe.inc'", '#include "pipe.inc"'])
def test_include_of_a_pipe(load, tmp_path, line):
    os.mkfifo(tmp_path / "pipe.inc")
    with pytest.raises(CompileError, match=r"user.f: includes pipe.inc, which is not a file"):
        load(database(line))


def test_pipe_for_a_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.f")
    with pytest.raises(CompileError, match=r"pipe.f: not a file$"):
        usersub.load(tmp_path / "pipe.f", job="job", output_dir=tmp_path)


def test_window_into_the_kernel(tmp_path):
    (tmp_path / "status.f").symlink_to("/proc/self/status")
    with pytest.raises(CompileError, match=r"status.f: cannot be read: not a file$"):
        usersub.load(tmp_path / "status.f", job="job", output_dir=tmp_path)
