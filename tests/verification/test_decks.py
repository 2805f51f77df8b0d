# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The committed decks are the built ones, keep to the limits of Abaqus, and number their elements as U3 needs it."""

import re
from pathlib import Path

import numpy as np
import pytest

from uel.delamination import specimens
from uel.delamination.mesh import TwoArmMesh, crack_columns, graded_columns
from uel.paper import decks

COMMITTED = {path.relative_to(decks.FOLDER) for path in decks.FOLDER.rglob("*.inp")}
MESHES = {"patch": specimens.patch_mesh(0.003), "dcb": specimens.dcb_mesh(), "dcb_ref": specimens.dcb_ref_mesh()}


def test_committed_decks_are_the_built_ones(tmp_path: Path) -> None:
    assert decks.main(["--folder", str(tmp_path)]) == 0
    assert {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()} == COMMITTED
    for path in COMMITTED:
        assert_same_deck((decks.FOLDER / path).read_text(), (tmp_path / path).read_text(), path)


def assert_same_deck(committed: str, built: str, path: Path) -> None:
    """The texts are the same, but for the last digit of a coordinate.

    They have six decimals or more; where a coordinate lies between two of them, the processor decides.
    """
    if committed == built:
        return
    ours, theirs = committed.splitlines(), built.splitlines()
    assert len(ours) == len(theirs), path
    for number, (line, other) in enumerate(zip(ours, theirs, strict=True), 1):
        if line != other:
            place = f"{path}:{number}: {line!r}, built: {other!r}"
            words, others = ([word.strip() for word in text.split(",")] for text in (line, other))
            assert len(words) == len(others) and words[0] == others[0], place
            for word, new in zip(words[1:], others[1:], strict=True):
                decimals = max((len(text.rpartition(".")[2]) for text in (word, new) if "." in text), default=0)
                assert word == new or (decimals >= 6 and abs(float(word) - float(new)) < 1.5 * 10.0**-decimals), place


def test_decks_that_differ_are_told_apart() -> None:
    deck = "*NODE\n1, 0.500000, -2.123456\n*ELEMENT, TYPE=U1\n1, 2, 3\n"
    assert_same_deck(deck, deck.replace("123456", "123457"), Path("a.inp"))
    for old, new in (
        ("123456", "123458"),
        ("123456", "12346"),
        ("1, 2, 3", "1, 2, 4"),
        ("1, 0.5", "2, 0.5"),
        ("U1", "U2"),
    ):
        with pytest.raises(AssertionError, match=r"a.inp:\d"):
            assert_same_deck(deck, deck.replace(old, new), Path("a.inp"))
    with pytest.raises(AssertionError, match=r"a.inp"):
        assert_same_deck(deck, deck + "*STEP\n", Path("a.inp"))


@pytest.mark.parametrize("path", sorted(COMMITTED), ids=str)
def test_limits_of_abaqus(path: Path) -> None:
    lines = (decks.FOLDER / path).read_text().splitlines()
    assert max(map(len, lines)) <= 256
    for line in lines:
        if line.startswith("*") and not line.startswith("**"):
            assert all(len(name) <= 80 for name in re.findall(r"(?:ELSET|NSET|NAME|MATERIAL)=([^,]+)", line))
    # at most eight properties a line
    for start in (k for k, line in enumerate(lines) if line.startswith("*UEL PROPERTY")):
        assert lines[start + 1].count(",") < 8


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES.keys())
def test_interface_elements_lie_between_their_quads(mesh: TwoArmMesh) -> None:
    quads = {row[0]: row[1:] for block in ("lower", "upper") for row in mesh.quads(block).tolist()}
    below, above = mesh.offsets
    for four, eight in zip(mesh.interface4().tolist(), mesh.interface8().tolist(), strict=True):
        label, (left, right, right_top, left_top) = four[0], four[1:]
        assert eight[0] == label > max(quads)
        assert eight[1:] == quads[label + below] + quads[label + above]
        # counter-clockwise quads: the lower one's face 4-3 and the upper one's face 1-2 are the interface
        assert quads[label + below][2:] == [right, left]
        assert quads[label + above][:2] == [left_top, right_top]


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES.keys())
def test_quads_are_positive_and_interface_has_no_thickness(mesh: TwoArmMesh) -> None:
    labels, points = mesh.nodes()
    place = dict(zip(labels.tolist(), points, strict=True))
    corners = np.array(
        [[place[n] for n in row[1:]] for block in ("lower", "upper") for row in mesh.quads(block).tolist()]
    )
    a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert area.min() > 0.0
    size = np.ptp(points[:, 0]) * np.ptp(points[:, 1])
    assert area.sum() == pytest.approx(size, rel=1e-12)
    low, high = mesh.interface_lines
    assert all((place[m] == place[n]).all() for m, n in zip(low.tolist(), high.tolist(), strict=True))


def test_dcb_meshes_are_those_of_the_problem() -> None:
    dcb, ref = MESHES["dcb"], MESHES["dcb_ref"]
    assert len(ref.quads("lower")) + len(ref.quads("upper")) == 4800
    assert len(ref.interface4()) == 460
    for mesh in (dcb, ref):
        assert (mesh.x[0], mesh.x[-1], mesh.upper[-1]) == (0.0, 150.0, 3.1)
        assert mesh.x[mesh.first] == 35.0
    sizes = np.diff(dcb.x)
    assert np.allclose(sizes[(dcb.x[:-1] >= 34.9) & (dcb.x[1:] <= 61.0)], 0.125)
    assert sizes.min() > 0.124
    assert sizes.max() < 1.1
    ratio = sizes[1:] / sizes[:-1]
    assert 0.8 < ratio.min() < ratio.max() < 1.25


def test_perturbed_nodes_move_in_pairs() -> None:
    mesh = MESHES["patch"]
    labels, points = mesh.nodes()
    height = dict(zip(labels.tolist(), points[:, 1], strict=True))
    for line in mesh.interface_lines:
        assert [height[n] - 0.5 for n in line.tolist()] == pytest.approx([0.003, -0.003] * 5 + [0.003], abs=1e-15)
    assert height[mesh.line(1)[3]] == 0.0


def test_graded_columns() -> None:
    edges = graded_columns(2.0, 10.0, 0.1, 1.2, 1.0)
    assert (edges[0], edges[-1]) == (2.0, 10.0)
    # on any processor, whatever the sum of the columns is rounded to
    assert {graded_columns(2.0, end, 0.1, 1.2, 1.0)[-1] - end for end in np.linspace(3.0, 9.0, 101)} == {0.0}
    sizes = np.diff(edges)
    assert 0.1 < sizes[0] < 0.15
    assert sizes.max() < 1.3
    backwards = graded_columns(8.0, 0.0, 0.1, 1.2, 1.0)
    assert backwards == pytest.approx(10.0 - edges)
    both = crack_columns(20.0, (8.0, 10.0), 0.1, 1.2, (1.0, 2.0))
    assert np.diff(both).min() > 0.0
    assert np.sum(np.isclose(np.diff(both), 0.1)) == 20
    # nothing behind the fine columns
    assert crack_columns(10.0, (8.0, 10.0), 0.1, 1.2, (1.0, 1.0)) == pytest.approx(both[both < 10.05], abs=1e-6)
