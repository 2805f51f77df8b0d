# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""End-notched flexure and fixed-ratio mixed-mode specimens: meshes, and first increments against beam theory."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from uel.delamination import flexure
from uel.delamination.blocks import BY_EQUATION_21, Interface, Specimen
from uel.delamination.materials import PLY_0, PLY_90, TABLE_2
from uel.delamination.mesh import TwoArmMesh, refined
from uel.delamination.specimens import ARMS, CRACK, WIDTH, mesh_files
from uel.delamination.steps import LINEAR
from uel.delamination.theory import enf_compliance, enf_load, frmm_compliance, frmm_load
from uel.output import Result
from uel.running.job import run


def test_meshes_are_those_of_the_problems() -> None:
    enf, frmm = flexure.enf_mesh(), flexure.frmm_mesh()
    assert (enf.x[0], enf.x[-1], enf.x[enf.first], enf.upper[-1]) == (0.0, 100.0, 35.0, 3.1)
    assert np.allclose(np.diff(enf.x), 0.25)
    assert (frmm.x[0], frmm.x[-1], frmm.x[frmm.first], frmm.upper[-1]) == (0.0, 50.0, 35.0, 3.1)
    assert np.allclose(np.diff(frmm.x[frmm.x >= 33.5]), 0.125)
    assert np.diff(frmm.x).max() < 0.6


@pytest.mark.parametrize("build", [flexure.enf_mesh, flexure.frmm_mesh])
def test_perturbed_interface_moves_up_and_down_in_turns(build: Callable[[float, float], TwoArmMesh]) -> None:
    mesh = build(0.25, 0.0075)
    assert np.abs(mesh.bumps).tolist() == [0.0075] * len(mesh.x)
    assert np.all(mesh.bumps[1:] == -mesh.bumps[:-1])


def solve(folder: Path, name: str, mesh: TwoArmMesh, displacement: float, bottom: str = "0") -> Result:
    """One elastic increment of the stabilised element."""
    plies = {"0": PLY_0, "90": PLY_90}
    # as stiff as a bond: no compliance of the interface beside that of the beams
    specimen = Specimen(
        name,
        mesh,
        Interface("U4", TABLE_2.with_stiffness(1e8), BY_EQUATION_21, consistent=False),
        WIDTH,
        plies[bottom],
        PLY_0,
    )
    deck = {"enf": flexure.enf_deck, "frmm": flexure.frmm_deck}[name](name, specimen, displacement, LINEAR, 1)
    for file, content in (mesh_files(name, mesh, (8,)) | {f"{name}.inp": deck}).items():
        (folder / file).write_text(content, encoding="ascii")
    return run(folder / f"{name}.inp", output_dir=folder)


def test_enf_is_as_stiff_as_a_beam(tmp_path: Path) -> None:
    result = solve(tmp_path, "enf", flexure.enf_mesh(1.0), 0.01)
    load = -result.history["RF2[MIDSPAN]"][-1]
    # quads in bending are some percent too stiff where they are 2.6 times as long as high
    assert load * enf_compliance(ARMS, CRACK, 50.0) == pytest.approx(0.01, rel=0.03)


def test_enf_arms_stay_together_along_the_crack(tmp_path: Path) -> None:
    # nothing but the tie above the support keeps the faces apart: the gap it leaves is small, in [0/90] too
    for bottom in ("0", "90"):
        mesh = flexure.enf_mesh(0.5)
        result = solve(tmp_path, "enf", mesh, 0.01, bottom)
        labels = mesh.nodes()[0].tolist()
        low, high = (line[: mesh.first + 1].tolist() for line in mesh.interface_lines)
        deflection = result.field("U")[:, 1]
        gap = np.array(
            [deflection[labels.index(b)] - deflection[labels.index(a)] for a, b in zip(low, high, strict=True)]
        )
        assert gap[0] == pytest.approx(0.0, abs=1e-15)
        assert np.abs(gap).max() < 0.02 * 0.01


def test_frmm_is_as_stiff_as_a_beam(tmp_path: Path) -> None:
    result = solve(tmp_path, "frmm", flexure.frmm_mesh(), 0.01)
    load = result.history["RF2[LOAD_TOP]"][-1]
    assert load * frmm_compliance(ARMS, CRACK, 50.0) == pytest.approx(0.01, rel=0.03)


def test_energy_release_rates_are_the_derivatives_of_the_compliances() -> None:
    # Irwin-Kies: G = P^2/(2 B) dC/da at the load at which the crack grows; G = G_c for equal toughnesses
    step, crack, toughness = 1e-3, 40.0, 0.7
    slope = (enf_compliance(ARMS, crack + step, 50.0) - enf_compliance(ARMS, crack - step, 50.0)) / (2.0 * step)
    assert enf_load(ARMS, crack, toughness) ** 2 * slope / (2.0 * WIDTH) == pytest.approx(toughness, rel=1e-8)
    slope = (frmm_compliance(ARMS, crack + step, 50.0) - frmm_compliance(ARMS, crack - step, 50.0)) / (2.0 * step)
    load = frmm_load(ARMS, crack, toughness, toughness)
    assert load**2 * slope / (2.0 * WIDTH) == pytest.approx(toughness, rel=1e-8)


def test_refinement_keeps_the_shape_of_the_interface() -> None:
    mesh = flexure.frmm_mesh(0.25, 0.0075)
    fine = refined(mesh, 4)
    assert fine.rows == (16, 16)
    assert fine.columns == 4 * mesh.columns
    assert fine.x[fine.first] == mesh.x[mesh.first] == CRACK
    # the old nodes are where they were, the new ones on the straight lines between them
    assert fine.x[::4] == pytest.approx(mesh.x, abs=1e-9)
    assert fine.bumps[::4] == pytest.approx(mesh.bumps, abs=1e-15)
    assert np.interp(fine.x, mesh.x, mesh.bumps) == pytest.approx(fine.bumps, abs=1e-9)
    assert (fine.lower[::4] == mesh.lower).all()
    assert fine.upper[0] == fine.lower[-1]
