# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of meshes with interface elements inserted, compared with those of the uncut mesh and with theory."""

import re

import numpy as np
import pytest
from solid_grids import grid, inserted

import uel
from uel.deck.reader import read_deck
from uel.model.element_types import CONTINUUM

YOUNG, POISSON = 1.0e4, 0.3


def write(path, mesh, loads, poisson=POISSON, model=()):
    """A deck of one linear step."""
    lines = mesh.lines()
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {poisson}"]
    lines += [*model, "*STEP", "*STATIC", "1., 1.", *loads, "*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")
    return path


def displacements(deck, folder):
    """(nodes, 3), by label."""
    return uel.run(deck, output_dir=folder, quiet=True).field("U")


def block(kind, distort=0.2, seed=1):
    """Two layers of solids with the sets LOW and HIGH, the ends FIX and PULL, and the nodes of the interface."""
    dimension = CONTINUUM[kind].family.dimension
    mesh = grid(kind, (3, 2, 2)[-dimension:], (3.0, 2.0, 2.0)[-dimension:], distort, seed)
    low = mesh.cell[:, -1] == 0
    mesh.sets = {"LOW": low, "HIGH": ~low}
    mesh.node_sets = {"FIX": mesh.end(dimension - 1, 0), "PULL": mesh.end(dimension - 1, 1)}
    return mesh


def tied(deck, count):
    """Add to a deck an *MPC that holds each double on its node."""
    text = deck.read_text()
    lines = text.splitlines()
    first = lines.index("** nodes doubled by uel insert") + 2
    doubles = []
    for line in lines[first:]:
        if line.startswith("*"):
            break
        doubles.append([float(word) for word in line.split(",")])
    place = {tuple(point): label for label, *point in node_lines(lines, count)}
    ties = [f"TIE, {int(label)}, {place[tuple(point)]}" for label, *point in doubles]
    deck.write_text(text.replace("*STEP", "\n".join(["*MPC", *ties, "*STEP"]), 1))
    return [place[tuple(point)] for _, *point in doubles]


def node_lines(lines, count):
    start = next(k for k, line in enumerate(lines) if line.startswith("*NODE"))
    for line in lines[start + 1 : start + 1 + count]:
        label, *point = line.split(",")
        point = [float(word) for word in point]
        yield int(label), *point, *([0.0] * (3 - len(point)))


ELEMENTS = {
    **{"CPS4": ("U2", "U4", "COH2D4"), "CPS3": ("U2", "U33"), "CPS8": ("U5", "U6"), "CPS6": ("U5", "U66")},
    **{"CPS4R": ("U4",), "CPE4I": ("U4",), "CPS8R": ("U6",), "C3D8R": ("U8",), "C3D8I": ("U8",), "C3D20R": ("U12",)},
    **{"C3D8": ("U7", "U8", "COH3D8"), "C3D20": ("U11", "U12")},
    **{"C3D4": ("U13", "U404", "COH3D6"), "C3D10": ("U14", "U1010")},
}
OWNERS = ("U4", "U6", "U8", "U12", "U33", "U66", "U404", "U1010")
PAIRS = [(kind, element) for kind, elements in ELEMENTS.items() for element in elements]


def values_of(element):
    """Strengths that are not reached; a stiffness where one is needed."""
    strong = ["SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9"]
    return strong if element in OWNERS else [*strong, "ALPHAN=1e6"]


@pytest.mark.parametrize(("kind", "element"), [(k, e) for k, e in PAIRS if e.startswith("U")])
def test_elements_of_the_project_are_defined_with_unsymm(tmp_path, kind, element):
    """Their matrices are unsymmetric in mixed-mode softening (tests/kernels/test_symmetry.py)."""
    deck = write(tmp_path / "uncut.inp", block(kind), ["*BOUNDARY", "FIX, 1, 3"])
    inserted(deck, tmp_path / "cut.inp", values_of(element), between=[("LOW", "HIGH")], element=element)
    group = next(group for group in read_deck(tmp_path / "cut.inp").groups if group.type == element)
    assert group.definition.unsymmetric


@pytest.mark.parametrize(("kind", "element"), PAIRS)
def test_doubles_that_are_tied_give_the_result_of_the_uncut_mesh(tmp_path, kind, element):
    """With a rigid interface, here *MPC, TIE, the equations are those of the uncut mesh: only rounding differs."""
    mesh = block(kind)
    top = np.flatnonzero(mesh.node_sets["PULL"]) + 1
    loads = ["*BOUNDARY", "FIX, 1, 3", "*CLOAD", "PULL, 1, 1.", f"{top[0]}, 2, -0.5"]
    deck = write(tmp_path / "uncut.inp", mesh, loads)
    before = displacements(deck, tmp_path)
    cut = tmp_path / "cut.inp"
    done = inserted(deck, cut, values_of(element), between=[("LOW", "HIGH")], element=element)
    assert list(done.kinds) == [element]
    origins = tied(cut, len(mesh.nodes))
    after = displacements(cut, tmp_path)
    assert len(after) == len(before) + done.doubled
    scale = np.abs(before).max()
    assert np.abs(after[: len(before)] - before).max() < 1e-10 * scale
    assert np.abs(after[len(before) :] - before[np.array(origins) - 1]).max() < 1e-10 * scale


@pytest.mark.parametrize(("kind", "element"), [(k, e) for k, e in PAIRS if e in OWNERS])
def test_an_infinitely_stiff_interface_passes_the_patch_test(tmp_path, kind, element):
    """A linear displacement field solves the equations of both meshes: jumps vanish, tractions are sigma.n."""
    mesh = block(kind)
    dimension = mesh.nodes.shape[1]
    field = 1e-3 * np.array([[1.0, 0.4, -0.2], [0.3, -0.5, 0.1], [0.2, 0.1, 0.6]])[:dimension, :dimension]
    outer = np.flatnonzero(np.any([mesh.end(axis, side) for axis in range(dimension) for side in (0, 1)], axis=0))
    loads = ["*BOUNDARY"]
    loads += [
        f"{k + 1}, {dof + 1}, {dof + 1}, {float(mesh.nodes[k] @ field[dof])!r}"
        for k in outer
        for dof in range(dimension)
    ]
    deck = write(tmp_path / "uncut.inp", mesh, loads)
    cut = tmp_path / "cut.inp"
    # every solid by itself
    done = inserted(deck, cut, values_of(element), inside=["BODY"])
    assert list(done.kinds) == [element]
    assert len(mesh.nodes) + done.doubled == mesh.elements.size
    before, after = displacements(deck, tmp_path), displacements(cut, tmp_path)
    scale = np.abs(before).max()
    assert np.allclose(before[:, :dimension], mesh.nodes @ field.T, rtol=0, atol=1e-10 * scale)
    assert np.abs(after[: len(before)] - before).max() < 1e-10 * scale


@pytest.mark.parametrize(
    ("kind", "element"), [(k, e) for k, e in PAIRS if e not in OWNERS and k not in ("C3D4", "C3D10")]
)
def test_an_interface_adds_its_compliance(tmp_path, kind, element):
    """Of a column under a stress s: s H/E of the solids (nu = 0), s/k of the interface."""
    mesh = block(kind, distort=0.0)
    dimension = mesh.nodes.shape[1]
    last, stress, stiffness = dimension, 7.0, 2.0e4
    hold = [f"{np.flatnonzero(mesh.node_sets['FIX'])[0] + 1}, 1, {dimension}", f"FIX, {last}, {last}"]
    if dimension == 3:
        corner = np.flatnonzero(mesh.node_sets["FIX"] & mesh.end(0, 1) & mesh.end(1, 0))[0] + 1
        hold.append(f"{corner}, 2, 2")
    top = "S3" if dimension == 2 else "S2"
    loads = ["*BOUNDARY", *hold, "*DSLOAD", f"TOP, P, {-stress}"]
    lines = ["*SURFACE, NAME=TOP", f"HIGH, {top}"]
    if kind in ("CPS3", "CPS6"):
        upper = mesh.sets["HIGH"] & (np.isin(mesh.elements, np.flatnonzero(mesh.node_sets["PULL"])).sum(axis=1) >= 2)
        mesh.sets["EDGE"] = upper
        lines = ["*SURFACE, NAME=TOP", "EDGE, S2"]
    deck = write(tmp_path / "uncut.inp", mesh, loads, 0.0, lines)
    cut = tmp_path / "cut.inp"
    inserted(
        deck, cut, ["SIGMAMAX=1e3", "TAUMAX=1e3", "GIC=1e3", "GIIC=1e3", f"ALPHAN={stiffness}"],
        between=[("LOW", "HIGH")], element=element,
    )  # fmt: skip
    after = displacements(cut, tmp_path)[: len(mesh.nodes), last - 1]
    expected = stress * 2.0 / YOUNG + stress / stiffness
    assert np.allclose(after[mesh.node_sets["PULL"]], expected, rtol=1e-10, atol=0)
    assert np.allclose(
        displacements(deck, tmp_path)[mesh.node_sets["PULL"], last - 1], stress * 2.0 / YOUNG, rtol=1e-10
    )


def test_triangles_that_fail_tell_their_length(tmp_path):
    """The shortest edge of a triangle: the faces of the grid have edges of 1, 1 and sqrt(2)."""
    mesh = block("C3D4", distort=0.0)
    deck = write(tmp_path / "uncut.inp", mesh, ["*BOUNDARY", "FIX, 1, 3", "PULL, 1, 2", "PULL, 3, 3, 0.5"])
    deck.write_text(deck.read_text().replace("1., 1.", "0.5, 1."))
    cut = tmp_path / "cut.inp"
    inserted(deck, cut, ["SIGMAMAX=1", "TAUMAX=1", "GIC=1e-4", "GIIC=1e-4"], between=[("LOW", "HIGH")])
    (warning,) = (text for text in uel.run(cut, output_dir=tmp_path, quiet=True).warnings if "process zone" in text)
    assert re.search(r"U404 element \d+: fails and is 1\.0+ long", warning)
