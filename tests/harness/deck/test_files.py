# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that cannot be read, and decks of several files."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from numpy.testing import assert_array_equal

from uel.deck import read_deck
from uel.errors import DeckError
from uel.model.model import Model
from uel.output import JobOutput

Read = Callable[[str], Model]
FLAT = Path(__file__).with_name("flat.inp").read_text()
NODES = FLAT[FLAT.index("1, 0., 0.\n") : FLAT.index("*ELEMENT, TYPE=U1")]


@pytest.mark.parametrize("content", [b"", b"\n\n", b"** only\n ** comments\n"])
def test_empty_file(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "empty.inp"
    path.write_bytes(content)
    with pytest.raises(DeckError, match=r"empty.inp:1: the deck is empty"):
        read_deck(path)


def test_binary_file(tmp_path: Path) -> None:
    path = tmp_path / "job.odb"
    path.write_bytes(b"*HEADING\n\x00\x01\x02")
    with pytest.raises(DeckError, match=r"job.odb:1: .*job.odb is a binary file, not a deck"):
        read_deck(path)


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(DeckError, match=r"none.inp: cannot read the file: No such file or directory"):
        read_deck(tmp_path / "none.inp")


def test_folder(tmp_path: Path) -> None:
    with pytest.raises(DeckError, match=r": cannot read the file: Is a directory"):
        read_deck(tmp_path)


def test_text_before_the_first_keyword(read: Read) -> None:
    with pytest.raises(DeckError, match=r"^deck.inp:2: data before the first keyword; a comment begins with \*\*$"):
        read("** comment\n1, 2, 3\n4, 5, 6\n" + FLAT)


@pytest.mark.parametrize(
    "include",
    [
        "*NODE, NSET=ALL\n*INCLUDE, INPUT=mesh/nodes.inc\n",
        "*NODE, NSET=ALL\n*INCLUDE, file=mesh/nodes.inc\n",
        "*NODE, NSET=ALL, INPUT=mesh/nodes.inc\n",
    ],
)
def test_data_lines_in_another_file(read: Read, include: str) -> None:
    Path("mesh").mkdir()
    Path("mesh/nodes.inc").write_text(NODES)
    model = read(FLAT.replace("*NODE, NSET=ALL\n" + NODES, include))
    assert_array_equal(model.mesh.coordinates, read(FLAT).mesh.coordinates)
    assert_array_equal(model.nsets["ALL"], range(8))


def test_include_of_an_include(read: Read) -> None:
    """Sought beside the deck, then beside the including file."""
    Path("mesh").mkdir()
    Path("mesh/mesh.inc").write_text("*NODE, NSET=ALL\n** the nodes\n*INCLUDE, INPUT=nodes.inc\n*NSET, NSET=X\n1\n")
    Path("mesh/nodes.inc").write_text(NODES)
    model = read(FLAT.replace("*NODE, NSET=ALL\n" + NODES, "*INCLUDE, INPUT=mesh/mesh.inc\n"))
    assert_array_equal(model.nsets["ALL"], range(8))
    assert_array_equal(model.nsets["X"], [0])


def test_include_is_sought_where_the_job_is_submitted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As Abaqus does; what only the folder of the deck has is read too, with a warning."""
    include = "*NODE, NSET=ALL\n*INCLUDE, INPUT=nodes.inc\n"
    deck = tmp_path / "decks" / "deck.inp"
    deck.parent.mkdir()
    deck.write_text(FLAT.replace("*NODE, NSET=ALL\n" + NODES, include))
    beside = deck.with_name("nodes.inc")
    beside.write_text(NODES)
    monkeypatch.chdir(deck.parent)
    model = read_deck(deck)
    assert (model.warnings, model.differences) == ((), ())

    monkeypatch.chdir(tmp_path)
    model = read_deck(deck)
    assert model.warnings == ()
    assert model.differences == (
        f"{deck}:12: Abaqus looks for nodes.inc only in the folder where the job is submitted, not beside the "
        f"deck: submit it in {deck.parent}",
    )
    output = JobOutput(model, "deck", tmp_path, quiet=True)
    output.close(None)
    # a run tells them
    assert output.warnings == list(model.differences)
    printed = " ".join((tmp_path / "deck.dat").read_text().split())
    assert "***WARNING: " in printed
    assert "Abaqus looks for nodes.inc only in the folder" in printed
    assert "WITH 1 WARNING MESSAGES ON THE DAT FILE AND 0 WARNING MESSAGES ON THE MSG FILE" in printed

    Path("nodes.inc").write_text(NODES.replace("3, 1., 1.", "3, 1., 1.5"))
    model = read_deck(deck)
    assert model.mesh.coordinates[2, 1] == 1.5
    assert model.differences == ()
    assert model.warnings == (f"{deck}:12: nodes.inc is that of the current folder, as in Abaqus, not {beside}",)

    beside.unlink()
    model = read_deck(deck)
    assert (model.warnings, model.differences) == ((), ())


def test_include_beside_the_including_file_alone(read: Read) -> None:
    Path("mesh").mkdir()
    Path("mesh/mesh.inc").write_text("*NODE, NSET=ALL\n*INCLUDE, INPUT=nodes.inc\n")
    Path("mesh/nodes.inc").write_text(NODES)
    model = read(FLAT.replace("*NODE, NSET=ALL\n" + NODES, "*INCLUDE, INPUT=mesh/mesh.inc\n"))
    assert model.differences == (
        "mesh/mesh.inc:2: Abaqus looks for nodes.inc only in the folder where the job is submitted, not beside "
        "the including file: name it as seen from the deck",
    )


def test_error_in_an_included_file(read: Read) -> None:
    Path("nodes.inc").write_text("** the nodes\n" + NODES.replace("3, 1., 1.", "3, 1., x"))
    with pytest.raises(DeckError, match=r"^nodes.inc:4: \*NODE: coordinate 2: 'x' is not a number"):
        read(FLAT.replace(NODES, "*INCLUDE, INPUT=nodes.inc\n"))


def test_error_after_an_included_file(read: Read) -> None:
    """Lines of one block that come from two files keep their places."""
    Path("nodes.inc").write_text(NODES)
    text = FLAT.replace(NODES, "*INCLUDE, INPUT=nodes.inc\n9, x, 0.\n")
    with pytest.raises(DeckError, match=r"^deck.inp:13: \*NODE: coordinate 1: 'x' is not a number"):
        read(text)


def test_binary_include(read: Read) -> None:
    Path("nodes.inc").write_bytes(b"1, 0., 0.\n\x00")
    with pytest.raises(DeckError, match=r"^deck.inp:12: nodes.inc is a binary file, not a deck"):
        read(FLAT.replace(NODES, "*INCLUDE, INPUT=nodes.inc\n"))


def test_include_loop(read: Read) -> None:
    Path("a.inc").write_text("** a\n*INCLUDE, INPUT=b.inc\n")
    Path("b.inc").write_text("*INCLUDE, INPUT=a.inc\n")
    with pytest.raises(DeckError, match=r"^b.inc:1: include loop: a.inc -> b.inc -> a.inc$"):
        read(FLAT.replace("*NODE, NSET", "*INCLUDE, INPUT=a.inc\n*NODE, NSET"))


def test_file_that_includes_itself(read: Read) -> None:
    with pytest.raises(DeckError, match=r"^deck.inp:65: include loop: deck.inp -> deck.inp$"):
        read(FLAT + "*INCLUDE, INPUT=deck.inp\n")


def test_file_name_that_no_system_takes(read: Read) -> None:
    with pytest.raises(DeckError, match=r"^deck.inp:65: cannot read x+ \.\.\. x+: File name too long$"):
        read(FLAT + f"*INCLUDE, INPUT={'x' * 5000}\n")


def test_files_that_include_each_other_again_and_again(read: Read) -> None:
    for level in range(9):
        Path(f"{level}.inc").write_text(f"*INCLUDE, INPUT={level + 1}.inc\n" * 10)
    Path("9.inc").write_text("** nothing\n")
    with pytest.raises(DeckError, match=r"^\d.inc:\d+: too many included files: 2000 of them are read"):
        read(FLAT + "*INCLUDE, INPUT=0.inc\n")


def test_files_deep_within_each_other(read: Read) -> None:
    for level in range(100):
        Path(f"{level}.inc").write_text(f"*INCLUDE, INPUT={level + 1}.inc\n")
    with pytest.raises(DeckError, match=r"^19.inc:1: too many included files: 20 within each other are read$"):
        read(FLAT + "*INCLUDE, INPUT=0.inc\n")


@pytest.mark.parametrize("name", ["/proc/self/status", "/proc/self/mem", "pipe"])
def test_include_of_what_only_looks_like_a_file(read: Read, name: str) -> None:
    """Reading it may wait for ever, as that of the kernel's messages does, or take all memory."""
    os.mkfifo("pipe")
    Path("link").symlink_to(name)
    with pytest.raises(DeckError, match=r"^deck.inp:65: cannot read link: not a file$"):
        read(FLAT + "*INCLUDE, INPUT=link\n")


@pytest.mark.sample(2)
@pytest.mark.parametrize(("command", "name"), [("run", "pipe.inp"), ("check", "pipe.inp"), ("run", "/dev/zero")])
def test_deck_that_is_no_file(tmp_path: Path, command: str, name: str) -> None:
    os.mkfifo(tmp_path / "pipe.inp")
    words = [sys.executable, "-m", "uel.cli", command, name, *(["--quiet"] if command == "run" else [])]
    result = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode in (1, 2)
    assert f"uel: {name}: cannot read the file: not a file" in result.stderr


def test_loop_of_links(read: Read) -> None:
    Path("loop").symlink_to("loop")
    with pytest.raises(DeckError, match=r"^deck.inp:65: cannot read loop: (Too many levels of symbolic links|.*loop)"):
        read(FLAT + "*INCLUDE, INPUT=loop\n")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-be"])
def test_utf16(read: Read, encoding: str) -> None:
    mark = "" if encoding == "utf-16" else "\ufeff"
    Path("nodes.inc").write_bytes((mark + NODES).encode(encoding))
    with pytest.raises(DeckError, match=r"^deck.inp:12: nodes.inc is UTF-16 text, which .*: save it as UTF-8"):
        read(FLAT.replace(NODES, "*INCLUDE, INPUT=nodes.inc\n"))


def test_include_of_a_device(read: Read) -> None:
    with pytest.raises(DeckError, match=r"^deck.inp:65: cannot read /dev/zero: not a file$"):
        read(FLAT + "*INCLUDE, INPUT=/dev/zero\n")


def test_parameters_reach_included_files(read: Read) -> None:
    Path("nodes.inc").write_text(NODES.replace("2, 1., 0.", "2, <width>, 0."))
    model = read(FLAT.replace(NODES, "*INCLUDE, INPUT=nodes.inc\n"))
    assert model.mesh.coordinates[1, 0] == 20
