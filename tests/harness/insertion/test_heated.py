# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stabilised interfaces in bodies whose temperature changes, against theory and the uncut mesh."""

import numpy as np
import pytest
from solid_grids import grid, inserted

import uel
from uel.deck.reader import read_deck
from uel.errors import UelError
from uel.model.element_types import CONTINUUM
from uel.usersub.layout import element_layouts

KINDS = {
    **{
        "CPS4": "U4",
        "CPE4": "U4",
        "CPE4I": "U4",
        "CPS4R": "U4",
        "CPS8": "U6",
        "CPE8R": "U6",
        "CPS3": "U33",
        "CPE6": "U66",
    },
    **{"C3D8": "U8", "C3D8I": "U8", "C3D8R": "U8", "C3D20": "U12", "C3D20R": "U12", "C3D4": "U404", "C3D10": "U1010"},
}
EXPANSION = 2.0e-5
STRONG = ("SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9")
TRACTIONS = ("TN", "TT", "TS")


def deck(path, kind, boundary, *, temperatures, material=None, distort=0.2):
    """Two layers of solids with the sets LOW and HIGH."""
    dimension = CONTINUUM[kind].family.dimension
    mesh = grid(kind, (3, 2, 2)[-dimension:], (3.0, 2.0, 2.0)[-dimension:], distort, 1)
    low = mesh.cell[:, -1] == 0
    mesh.sets = {"LOW": low, "HIGH": ~low}
    ends = {f"{name}{side}": mesh.end(axis, side) for axis, name in enumerate("XYZ"[:dimension]) for side in (0, 1)}
    mesh.node_sets = {**ends, "CORNER": np.all([mesh.end(axis, 0) for axis in range(dimension)], axis=0)}
    heated = [f"{k + 1}, {value!r}" for k, value in enumerate(temperatures(mesh.nodes).tolist())]
    lines = [
        *mesh.lines(),
        *("*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1."),
        *("*MATERIAL, NAME=M", *(material or ["*ELASTIC", "1e4, 0.3", "*EXPANSION", f"{EXPANSION}"])),
        *("*INITIAL CONDITIONS, TYPE=TEMPERATURE", *(f"{k + 1}, 20.0" for k in range(len(mesh.nodes)))),
        *("*BOUNDARY", *boundary),
        *("*STEP", "*STATIC", "0.5, 1., 1e-5, 0.5", "*TEMPERATURE", *heated),
        *("*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"),
    ]
    path.write_text("\n".join(lines) + "\n")
    return mesh


def cut_and_run(folder, element, values=STRONG):
    """Displacements before and after the cut, and the largest and all tractions of the interface."""
    done = inserted(folder / "whole.inp", folder / "cut.inp", values, between=[("LOW", "HIGH")])
    assert list(done.kinds) == [element] and not done.warnings
    before = uel.run(folder / "whole.inp", output_dir=folder, quiet=True).field("U")
    result = uel.run(folder / "cut.inp", output_dir=folder, quiet=True)
    assert not [text for text in result.warnings if "temperature" in text or "FORMULATION" in text]
    rows = np.genfromtxt(folder / "cut_interface.csv", delimiter=",", names=True)
    last = rows[rows["time"] == rows["time"].max()]
    return before, result.field("U"), {name: last[name] for name in TRACTIONS if name in last.dtype.names}


def free(dimension):
    """Supports that do not hinder the expansion."""
    return ["X0, 1", "Y0, 2", *(["Z0, 3"] if dimension == 3 else [])]


@pytest.mark.parametrize(("kind", "element"), KINDS.items())
def test_a_free_body_has_no_tractions(tmp_path, kind, element):
    """130 degrees warmer: the nodes move by the expansion, and nothing pulls at the interface."""
    dimension = CONTINUUM[kind].family.dimension
    mesh = deck(tmp_path / "whole.inp", kind, free(dimension), temperatures=lambda x: np.full(len(x), 150.0))
    before, after, tractions = cut_and_run(tmp_path, element)
    # in plane strain the prevented expansion along the third axis adds nu of it
    strain = EXPANSION * 130.0 * (1.3 if kind.startswith("CPE") else 1.0)
    np.testing.assert_allclose(before[:, :dimension], strain * mesh.nodes, rtol=0, atol=1e-12)
    np.testing.assert_allclose(after[: len(before)], before, rtol=0, atol=1e-12)
    assert max(abs(values).max() for values in tractions.values()) < 1e-9


@pytest.mark.parametrize(
    ("kind", "element"), [(k, e) for k, e in KINDS.items() if k in ("CPS8", "C3D20", "C3D10", "CPE6")]
)
def test_a_gradient_bends_a_free_body_without_stress(tmp_path, kind, element):
    """A temperature that is linear in the height: elements with midside nodes bend without stress."""
    dimension = CONTINUUM[kind].family.dimension
    boundary = ["CORNER, 1, 3", "X0, 1"]
    if dimension == 3:
        boundary = ["CORNER, 1, 3", "X0, 1", "Y0, 2"]
    deck(tmp_path / "whole.inp", kind, boundary, temperatures=lambda x: 20.0 + 40.0 * x[:, -1], distort=0.0)
    before, after, tractions = cut_and_run(tmp_path, element)
    np.testing.assert_allclose(after[: len(before)], before, rtol=0, atol=1e-10 * abs(before).max())
    assert max(abs(values).max() for values in tractions.values()) < 1e-8


@pytest.mark.parametrize(("kind", "element"), KINDS.items())
def test_a_held_body_is_compressed(tmp_path, kind, element):
    """Held across the interface, free along it: -E alpha dT, in plane strain (1 + nu)/(1 - nu^2) times that."""
    dimension = CONTINUUM[kind].family.dimension
    last = "XYZ"[dimension - 1]
    boundary = [*free(dimension), f"{last}1, {dimension}"]
    deck(tmp_path / "whole.inp", kind, boundary, temperatures=lambda x: np.full(len(x), 70.0), distort=0.0)
    before, after, tractions = cut_and_run(tmp_path, element)
    expected = -1e4 * EXPANSION * 50.0 * (1.3 / (1.0 - 0.09) if kind.startswith("CPE") else 1.0)
    np.testing.assert_allclose(tractions["TN"], expected, rtol=1e-9)
    np.testing.assert_allclose(after[: len(before)], before, rtol=0, atol=1e-10 * abs(before).max())


def test_plies_expand_along_their_own_axes(tmp_path):
    """A free ply at 30 degrees, with the orthotropic expansion of carbon fibres: there are no tractions."""
    material = ["*ELASTIC, TYPE=ENGINEERING CONSTANTS", "138e3, 9e3, 9e3, 0.3, 0.3, 0.45, 5e3, 5e3", "3e3"]
    material += ["*EXPANSION, TYPE=ORTHO", "-1e-6, 2.8e-5, 3e-5"]
    warm = {"temperatures": lambda x: np.full(len(x), 150.0), "material": material, "distort": 0.0}
    mesh = deck(tmp_path / "whole.inp", "C3D8I", ["CORNER, 1, 3"], **warm)
    text = (tmp_path / "whole.inp").read_text().replace("MATERIAL=M\n1.", "MATERIAL=M, ORIENTATION=O")
    text = text.replace("*MATERIAL, NAME=M", "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, 30.\n*MATERIAL, NAME=M")
    # what is left of the rigid motions
    far = int(np.flatnonzero(mesh.end(0, 1) & mesh.end(1, 0) & mesh.end(2, 0))[0]) + 1
    across = int(np.flatnonzero(mesh.end(0, 0) & mesh.end(1, 1) & mesh.end(2, 0))[0]) + 1
    (tmp_path / "whole.inp").write_text(text.replace("CORNER, 1, 3", f"CORNER, 1, 3\n{far}, 2, 3\n{across}, 3"))
    before, after, tractions = cut_and_run(tmp_path, "U8")
    np.testing.assert_allclose(after[: len(before)], before, rtol=0, atol=1e-12)
    assert max(abs(values).max() for values in tractions.values()) < 1e-8


def test_initial_temperatures_that_differ_in_a_solid_with_midside_nodes(tmp_path):
    deck(tmp_path / "whole.inp", "CPS8", free(2), temperatures=lambda x: np.full(len(x), 150.0))
    inserted(tmp_path / "whole.inp", tmp_path / "cut.inp", STRONG, between=[("LOW", "HIGH")])
    text = (tmp_path / "cut.inp").read_text().replace("TYPE=TEMPERATURE\n1, 20.0\n", "TYPE=TEMPERATURE\n1, 30.0\n")
    (tmp_path / "cut.inp").write_text(text)
    with pytest.raises(
        UelError, match=r"U6 element \d+: initial temperatures from 20.* to 30.* at the corners of one of"
    ):
        uel.run(tmp_path / "cut.inp", output_dir=tmp_path, quiet=True)


def arc(path):
    """A quarter of a tube of four plies C3D8 that shrink across their thickness alone, cooled by 150 degrees."""
    radius, height, plies, counts = 5.0, 0.5, 4, (24, 2, 4)
    places = np.array(
        [(i, j, k) for k in range(counts[2] + 1) for j in range(counts[1] + 1) for i in range(counts[0] + 1)]
    )
    angle, r = np.pi / 2 * places[:, 0] / counts[0], radius + height * places[:, 2]
    nodes = np.column_stack([r * np.sin(angle), r * np.cos(angle), places[:, 1]])
    number = {tuple(place): k for k, place in enumerate(places.tolist(), 1)}
    lines = ["*NODE, NSET=ALL", *(f"{k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(nodes, 1))]
    label = 0
    for ply in range(plies):
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET=PLY{ply}")
        for j in range(counts[1]):
            for i in range(counts[0]):
                label += 1
                corners = [(i, j, ply), (i + 1, j, ply), (i + 1, j, ply + 1), (i, j, ply + 1)]
                words = [number[c] for c in corners] + [number[a, b + 1, c] for a, b, c in corners]
                lines.append(", ".join(map(str, [label, *words])))
    lines += ["*NSET, NSET=SYM", *(str(number[0, j, k]) for j in range(3) for k in range(5))]
    lines += [f"*SOLID SECTION, ELSET=PLY{ply}, MATERIAL=M, ORIENTATION=CYL" for ply in range(plies)]
    lines += ["*ORIENTATION, NAME=CYL, SYSTEM=CYLINDRICAL", "0., 0., 0., 0., 0., 1."]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "10500., 0.3", "*EXPANSION, TYPE=ORTHO", "3e-5, 0., 0."]
    lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 170.", "*BOUNDARY", "SYM, 1", f"{number[0, 0, 0]}, 2, 3"]
    lines += [f"{number[0, 2, 0]}, 2", "*STEP", "*STATIC", "1., 1.", "*TEMPERATURE", "ALL, 20."]
    lines += ["*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")
    return number[24, 0, 0] - 1, number[24, 0, 4] - 1


def test_spring_in_is_that_of_the_uncut_laminate(tmp_path):
    """One brick through each ply: within 0.5 %; without expansion in the interfaces less than half of it is left."""
    inner, outer = arc(tmp_path / "whole.inp")
    done = inserted(tmp_path / "whole.inp", tmp_path / "cut.inp", STRONG, plies=())
    assert done.kinds == {"U8": 144}
    group = next(group for group in read_deck(tmp_path / "cut.inp").groups if group.type == "U8")
    # the radial axis of the material, 1, is axis 3 of the element; s is along the axis of the tube
    values = dict(zip((item.name for item in element_layouts()[8].reals), group.section.values.tolist(), strict=True))
    for side in ("BOTTOM", "TOP"):
        assert [values[f"EXPANSION{axis} {side}"] for axis in (1, 2, 3)] == [0.0, 0.0, 3e-5]
    assert [values[f"DIRECTION{axis}"] for axis in (1, 2, 3)] == [0.0, 0.0, 1.0]
    turns = []
    for name in ("whole", "cut"):
        u = uel.run(tmp_path / f"{name}.inp", output_dir=tmp_path, quiet=True).field("U")
        turns.append((u[outer, 1] - u[inner, 1]) / 2.0)
    assert turns[1] == pytest.approx(turns[0], rel=5e-3)
    # of a thin ring: alpha dT times the angle
    assert abs(turns[0]) == pytest.approx(150 * 3e-5 * np.pi / 2, rel=0.05)
