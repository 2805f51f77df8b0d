# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""States of *RESTART that are damaged in many ways: each ends with a message that names the file and the fault."""

import json
import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest

import uel
from uel.cli import main
from uel.errors import UelError
from uel.output.files.state_files import FORMAT, array_digest, folder_of, read_state

DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=M
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*PLASTIC
1., 0.
2., 0.01
*RESTART, WRITE
*STEP, NLGEOM
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
1, 1, 2
4, 1
*CLOAD
2, 1, 0.7
3, 1, 0.7
*END STEP
"""
DAMAGED = "is damaged, or is not a state of a job: "


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Folder of a job that is over."""
    folder = tmp_path_factory.mktemp("job")
    (folder / "old.inp").write_text(DECK)
    uel.run(folder / "old.inp", output_dir=folder)
    return folder


@pytest.fixture
def state(whole, tmp_path):
    """Path of a copy of its last state."""
    folder = folder_of(tmp_path / "old")
    shutil.copytree(folder_of(whole / "old"), folder)
    return folder / "step1_increment0002.npz"


def refused(state):
    """The message with which the state is refused."""
    with pytest.raises(UelError) as error:
        read_state(state.parent.with_name("old"))
    message = str(error.value)
    assert str(state) in message
    assert len(message) < 600
    return message


def members(path):
    with np.load(path) as file:
        return {name: file[name] for name in file.files}


def test_whole(state):
    kept = read_state(state.parent.with_name("old"))
    assert (kept.step, kept.increment, kept.file) == (1, 2, str(state))


@pytest.mark.parametrize("share", [0.0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999])
def test_cut_off(state, share):
    data = state.read_bytes()
    state.write_bytes(data[: int(share * len(data))])
    assert DAMAGED in refused(state)


@pytest.mark.parametrize("place", range(10))
@pytest.mark.parametrize("kind", ["zeros", "ones", "flipped"])
def test_bytes(state, place, kind):
    """Sixteen bytes somewhere. Names of files within the archive are there twice, of which only one is read."""
    whole = state.read_bytes()
    data = bytearray(whole)
    start = (2 * place + 1) * len(data) // 20
    before = bytes(data[start : start + 16])
    damage = {"zeros": bytes(16), "ones": b"\xff" * 16, "flipped": bytes(255 - b for b in before)}[kind]
    if damage == before:
        damage = b"\x5a" * 16
    data[start : start + 16] = damage
    state.write_bytes(data)
    check_refused_or_whole(state, whole)


def test_every_byte_that_counts(state):
    """One bit of a byte, at each of 300 places: refused, or a byte of the archive that says nothing."""
    data = state.read_bytes()
    for place in np.linspace(0, len(data) - 1, 300).astype(int).tolist():
        state.write_bytes(data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :])
        check_refused_or_whole(state, data)


def check_refused_or_whole(state, data):
    """The state is refused, or it is what its undamaged file (data) has."""
    try:
        kept = read_state(state.parent.with_name("old"))
    except UelError as error:
        assert str(state) in str(error)
    else:
        # the times of the archive and the like
        assert (kept.step, kept.increment) == (1, 2)
        np.testing.assert_array_equal(
            kept.analysis["state"]["displacement"], _state_of(data, state.parent / "whole")["displacement"]
        )


def _state_of(data, folder):
    path = folder_of(folder / "old") / "step1_increment0002.npz"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return read_state(folder / "old").analysis["state"]


def _first(arrays):
    """A number with more than one entry, and another one of its shape."""
    large = [name for name, array in arrays.items() if name.startswith("array") and array.size > 1]
    return next((a, b) for a in large for b in large if a < b and arrays[a].shape == arrays[b].shape)


def swap(arrays):
    a, b = _first(arrays)
    arrays[a], arrays[b] = arrays[b] + 1.0, arrays[a]


def value(number):
    def change(arrays):
        name = _first(arrays)[0]
        arrays[name] = arrays[name].astype(float)
        arrays[name].ravel()[0] = number

    return change


def array(make):
    def change(arrays):
        name = _first(arrays)[0]
        arrays[name] = make(arrays[name])

    return change


def tree(make):
    def change(arrays):
        arrays["tree"] = np.frombuffer(make(arrays["tree"].tobytes()), np.uint8)

    return change


CHANGES = {
    "two arrays swapped": (swap, "array.* is not what was written"),
    "NaN": (value(np.nan), "array.* is not what was written"),
    "infinity": (value(np.inf), "array.* is not what was written"),
    "another number": (value(3.25), "array.* is not what was written"),
    "another shape": (array(lambda a: a[..., :-1]), "array.* is not what was written"),
    "turned": (array(lambda a: a.reshape(-1, 1)), "array.* is not what was written"),
    "empty": (array(lambda a: a[:0]), "array.* is not what was written"),
    "a scalar": (array(lambda a: np.array(1.0)), "array.* is not what was written"),
    "single precision": (array(lambda a: a.astype(np.float32)), "array.* is not what was written"),
    "another byte order": (array(lambda a: a.astype(a.dtype.newbyteorder())), "array.* is not what was written"),
    "text": (array(lambda a: np.array(["a"])), "array.* is not what was written"),
    "objects": (array(lambda a: np.array([None])), "."),
    "an array missing": (lambda arrays: arrays.pop("array1"), "array1 is missing"),
    "an array more": (lambda arrays: arrays.update(array99=np.ones(2)), "array99 does not belong to it"),
    "another name": (lambda arrays: arrays.update(x=arrays.pop("array1")), "array1 is missing"),
    "no tree": (lambda arrays: arrays.pop("tree"), "tree"),
    "no check": (lambda arrays: arrays.pop("check"), "the check of its tree is missing"),
    "another check": (lambda arrays: arrays.update(check=np.array("0")), "its tree is not what was written"),
    "tree of a list": (tree(lambda text: b"[1, 2]"), "its tree is none of a state"),
    "empty tree": (tree(lambda text: b""), "."),
    "tree that is no JSON": (tree(lambda text: text[:-2]), "."),
    "tree that is no text": (tree(lambda text: b"\xff\xfe" + text), "."),
    "tree without a part": (tree(lambda text: text.replace(b'"finished"', b'"begun"')), "its tree is not what was"),
    "another step": (tree(lambda text: text.replace(b'"step": 1', b'"step": 2', 1)), "its tree is not what was"),
    "another time": (tree(lambda text: text.replace(b'"step_time": 1.0', b'"step_time": 0.5')), "its tree is not what"),
    "another array": (tree(lambda text: text.replace(b'"array": 1}', b'"array": 2}', 1)), "its tree is not what was"),
    "no array": (tree(lambda text: text.replace(b'"array": 1}', b'"array": 999}', 1)), "its tree is not what was"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_contents(state, name):
    """An archive that is whole, with other contents."""
    change, message = CHANGES[name]
    arrays = members(state)
    before = {key: (array.dtype, array.shape, array.tobytes()) for key, array in arrays.items()}
    change(arrays)
    assert before != {key: (array.dtype, array.shape, array.tobytes()) for key, array in arrays.items()}
    np.savez(state, allow_pickle=True, **arrays)
    with pytest.raises(UelError, match=rf"step1_increment0002\.npz {DAMAGED}.*{message}"):
        read_state(state.parent.with_name("old"))


@pytest.mark.parametrize("version", [0, 1, FORMAT + 1, "2"])
def test_version(state, version):
    """As an older or newer uel writes it, with or without a check."""
    for checked in (False, True):
        arrays = members(state)
        found = json.loads(arrays["tree"].tobytes()) | {"format": version}
        arrays["tree"] = np.frombuffer(json.dumps(found).encode(), np.uint8)
        arrays["check"] = np.array(array_digest(arrays["tree"]))
        if not checked:
            del arrays["check"]
        np.savez(state, **arrays)
        message = refused(state)
        assert f"has format {version}; this version of uel reads format {FORMAT}: run the old job again" in message


def test_file_of_another_increment(state):
    shutil.copy(state.with_name("step1_increment0001.npz"), state)
    assert "is the state of step 1, increment 1: it has been renamed" in refused(state)


@pytest.mark.parametrize("kind", ["folder", "text", "another archive", "empty archive"])
def test_other_files(state, kind):
    state.unlink()
    if kind == "folder":
        state.mkdir()
    elif kind == "text":
        state.write_text("*HEADING\n")
    else:
        with zipfile.ZipFile(state, "w") as archive:
            if kind == "another archive":
                archive.writestr("a.txt", "text")
    assert DAMAGED in refused(state)


def test_command(whole, state, capsys):
    """The user sees one line, and no traceback."""
    state.write_bytes(state.read_bytes()[:-50])
    shutil.copy(whole / "old.inp", state.parent.with_name("old.inp"))
    words = ["run", str(whole / "old.inp"), "--oldjob", str(state.parent.with_name("old")), "--job", "new"]
    assert main([*words, "--output-dir", str(state.parent)]) != 0
    error = capsys.readouterr().err
    assert DAMAGED in error
    assert "Traceback" not in error


def test_numbers_that_are_not_finite(whole, state):
    """A state that was written so."""
    arrays = members(state)
    found = json.loads(arrays["tree"].tobytes())
    name = f"array{found['analysis']['state']['displacement']['array']}"
    arrays[name] = np.full_like(arrays[name], np.nan)
    found["digests"][int(name[5:])] = array_digest(arrays[name])
    arrays["tree"] = np.frombuffer(json.dumps(found).encode(), np.uint8)
    arrays["check"] = np.array(array_digest(arrays["tree"]))
    np.savez(state, **arrays)
    more = whole / "more.inp"
    more.write_text("*RESTART, READ\n*STEP\n*STATIC\n1., 1.\n*END STEP\n")
    message = r"step1_increment0002\.npz: the state of the old job holds numbers that are not finite: displacement"
    with pytest.raises(UelError, match=message):
        uel.run(more, output_dir=state.parent, oldjob=Path(state.parent.with_name("old")))
