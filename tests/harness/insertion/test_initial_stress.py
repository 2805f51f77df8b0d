# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stabilised interfaces in bodies with initial stress, against theory and the uncut mesh."""

import numpy as np
import pytest
from solid_grids import grid, inserted

import uel
from uel.errors import DeckError
from uel.model.element_types import CONTINUUM

KINDS = {"CPS4": "U4", "CPE4I": "U4", "CPS8R": "U6", "CPS3": "U33", "C3D8I": "U8", "C3D8R": "U8", "C3D10": "U1010"}
STRONG = ("SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9")
STRESS = {
    "PLANE STRESS": (4.0, -7.0, 2.5),
    "PLANE STRAIN": (4.0, -7.0, 0.0, 2.5),
    "SOLID": (4.0, 3.0, -7.0, 1.5, 2.5, -2.0),
}
"""In Abaqus' order: 11, 22, 12; 11, 22, 33, 12; 11, 22, 33, 12, 13, 23."""
ALONG_FACE = {2: {"TT": 2.5, "TN": -7.0}, 3: {"TS": 2.5, "TN": -7.0, "TT": -2.0}}
"""Traction on a face normal to the last axis, with s along x and t along y."""


def deck(path, kind, boundary, *, section="MATERIAL=M"):
    """Two layers of solids, with the sets LOW and HIGH, under a uniform initial stress that is released."""
    dimension = CONTINUUM[kind].family.dimension
    mesh = grid(kind, (3, 2, 2)[-dimension:], (3.0, 2.0, 2.0)[-dimension:])
    low = mesh.cell[:, -1] == 0
    mesh.sets = {"LOW": low, "HIGH": ~low, "FIRST": np.arange(len(low)) == 0}
    ends = {f"{name}{side}": mesh.end(axis, side) for axis, name in enumerate("XYZ"[:dimension]) for side in (0, 1)}
    corner = np.all([mesh.end(axis, 0) for axis in range(dimension)], axis=0)
    mesh.node_sets = {**ends, "CORNER": corner, "SKIN": np.any(list(ends.values()), axis=0)}
    # the far ends of the x and y axes through the corner
    for axis in range(dimension - 1):
        far = [mesh.end(other, int(other == axis)) for other in range(dimension)]
        mesh.node_sets[f"FAR{'XY'[axis]}"] = np.all(far, axis=0)
    state = "SOLID" if dimension == 3 else "PLANE STRESS" if kind.startswith("CPS") else "PLANE STRAIN"
    values = ", ".join(map(str, STRESS[state]))
    lines = [
        *mesh.lines(),
        *(f"*SOLID SECTION, ELSET=BODY, {section}", "1."),
        *("*MATERIAL, NAME=M", "*ELASTIC", "1e4, 0.3"),
        *("*INITIAL CONDITIONS, TYPE=STRESS", f"BODY, {values}"),
        *("*BOUNDARY", *boundary),
        *("*STEP", "*STATIC", "0.5, 1., 1e-5, 0.5", "*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"),
    ]
    path.write_text("\n".join(lines) + "\n")


def cut_and_run(folder, element):
    """Displacements before and after the cut, and the tractions at the end."""
    done = inserted(folder / "whole.inp", folder / "cut.inp", STRONG, between=[("LOW", "HIGH")])
    assert list(done.kinds) == [element] and not done.warnings
    before = uel.run(folder / "whole.inp", output_dir=folder, quiet=True).field("U")
    after = uel.run(folder / "cut.inp", output_dir=folder, quiet=True).field("U")
    rows = np.genfromtxt(folder / "cut_interface.csv", delimiter=",", names=True)
    return before, after[: len(before)], rows[rows["time"] == rows["time"].max()]


@pytest.mark.parametrize(("kind", "element"), KINDS.items())
def test_a_held_body_stays_at_rest(tmp_path, kind, element):
    """All nodes of the skin are held: nothing moves, and the bond carries the traction of the stress."""
    dimension = CONTINUUM[kind].family.dimension
    deck(tmp_path / "whole.inp", kind, ["SKIN, 1, 3"])
    before, after, rows = cut_and_run(tmp_path, element)
    assert abs(before).max() < 1e-12 and abs(after).max() < 1e-12
    for name, expected in ALONG_FACE[dimension].items():
        np.testing.assert_allclose(rows[name], expected, rtol=1e-7)


@pytest.mark.parametrize("section", ["MATERIAL=M", "MATERIAL=M, ORIENTATION=O"])
@pytest.mark.parametrize(("kind", "element"), KINDS.items())
def test_a_free_body_releases_its_stress(tmp_path, kind, element, section):
    """As the mesh without a cut: uniform strain, after which no traction is left; along oblique directions too."""
    dimension = CONTINUUM[kind].family.dimension
    supports = {2: ["CORNER, 1, 2", "FARX, 2"], 3: ["CORNER, 1, 3", "FARX, 2, 3", "FARY, 3"]}[dimension]
    deck(tmp_path / "whole.inp", kind, supports, section=section)
    if "O" in section:
        text = (tmp_path / "whole.inp").read_text()
        turned = "*ORIENTATION, NAME=O\n0.8, 0.6, 0., -0.6, 0.8, 0.\n*MATERIAL"
        (tmp_path / "whole.inp").write_text(text.replace("*MATERIAL", turned, 1))
    before, after, rows = cut_and_run(tmp_path, element)
    assert abs(before).max() > 1e-4
    np.testing.assert_allclose(after, before, rtol=0, atol=1e-9 * abs(before).max())
    for name in ALONG_FACE[dimension]:
        assert abs(rows[name]).max() < 1e-6


def test_another_traction_is_refused(tmp_path):
    """`uel run` compares the properties with the stress of the solids on both sides."""
    deck(tmp_path / "whole.inp", "C3D8I", ["SKIN, 1, 3"])
    inserted(tmp_path / "whole.inp", tmp_path / "cut.inp", STRONG, between=[("LOW", "HIGH")])
    text = (tmp_path / "cut.inp").read_text()
    (tmp_path / "cut.inp").write_text(text.replace("BODY, 4.0, 3.0, -7.0", "BODY, 4.0, 3.0, -6.0"))
    message = r"U8 element \d+: INITIALN = -7, but the C3D8I element \d+ below .* has -6 there by its initial stress"
    with pytest.raises(DeckError, match=message):
        uel.run(tmp_path / "cut.inp", output_dir=tmp_path, quiet=True)


def test_stresses_that_do_not_balance_are_refused(tmp_path):
    deck(tmp_path / "whole.inp", "CPS4", ["SKIN, 1, 3"])
    text = (tmp_path / "whole.inp").read_text()
    (tmp_path / "whole.inp").write_text(text.replace("BODY, 4.0, -7.0", "LOW, 4.0, -7.0"))
    message = (
        r"whole.inp:\d+: the initial stresses of elements \d+ and \d+ have the tractions \(2.5, -7, 0\) and \(0, 0, 0\)"
    )
    with pytest.raises(DeckError, match=message):
        inserted(tmp_path / "whole.inp", tmp_path / "cut.inp", STRONG, between=[("LOW", "HIGH")])
