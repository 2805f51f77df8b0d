# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Specimens in space: meshes, equilibrium of the loads, and stiffness against beam theory."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.cli import main
from uel.deck import read_deck
from uel.delamination import plate_specimens as build
from uel.delamination.blocks import Interface
from uel.delamination.keywords import text
from uel.delamination.materials import Cohesive, SolidPly, isotropic
from uel.delamination.plates import Laminate, TwoPlateMesh, two_plates
from uel.delamination.theory import Arms, dcb_compliance, enf_compliance
from uel.output import Result
from uel.output.pictures.front import fronts
from uel.paper import space_beams
from uel.running.job import run
from uel.solver.options import SolverOptions

PLY = SolidPly("PLY_0", (1.2e5, 1.05e4, 1.05e4), (0.3, 0.3, 0.51), (5.52e3, 5.52e3, 3.48e3))
CROSS = replace(PLY, name="PLY_90", angle=90.0)
STRONG = Cohesive(0.0, 0.0, 1.0e3, 1.0e3, 1.0e3, 1.0e3)
"""Infinitely stiff, and never reached: the specimen stays elastic."""
INTERFACES = {
    "U8": Interface("U8", STRONG, law=2, eta=1.0, beta=-1.0, consistent=True),
    "U7": Interface("U7", STRONG.with_stiffness(1.0e6), law=2, eta=1.0),
    "COH3D8": Interface("COH3D8", STRONG.with_stiffness(1.0e6), law=2, eta=1.0),
}
HEIGHT, WIDTH, LENGTH, CRACK = 1.5, 2.0, 60.0, 30.0
LINEAR = (1.0, 1.0, 1.0, 1.0)


def beam(interface: Interface, plies: tuple[SolidPly, SolidPly] = (PLY, PLY), across: int = 1) -> Laminate:
    x, y = np.linspace(0.0, LENGTH, 81), np.linspace(0.0, WIDTH, across + 1)
    z = np.linspace(0.0, HEIGHT, 3)
    return Laminate(two_plates(x, y, z, CRACK), interface, (plies[0],) * 2, (plies[1],) * 2)


@pytest.fixture
def solved(tmp_path: Path) -> Callable[[list[str]], Result]:
    def solve(lines: list[str]) -> Result:
        (tmp_path / "specimen.inp").write_text(text(lines))
        return run(tmp_path / "specimen.inp", output_dir=tmp_path)

    return solve


def total(result: Result, variable: str, name: str) -> float:
    """Sum of a variable over a node set in the last increment."""
    found = [values[-1] for key, values in result.history.items() if key.startswith(f"{variable}[{name}")]
    assert found
    return float(np.sum(found))


def test_interface_elements_lie_between_their_bricks() -> None:
    mesh = beam(INTERFACES["U8"], across=3).mesh
    labels, points = mesh.nodes()
    assert labels.tolist() == list(range(1, len(labels) + 1))
    below, above = mesh.bricks(0, 1), mesh.bricks(1, 0)
    bonded = mesh.bonded.ravel()
    eight = mesh.interface("U8")
    assert (eight == np.hstack([below[bonded], above[bonded]])).all()
    assert (mesh.interface("U7") == np.hstack([below[bonded, 4:], above[bonded, :4]])).all()
    faces = points[mesh.interface("COH3D8") - 1]
    assert (faces[:, :4] == faces[:, 4:]).all()
    assert faces[..., 0].min() == CRACK
    # positive volumes, in total that of the specimen
    corners = points[np.concatenate([mesh.bricks(plate, layer) for plate in (0, 1) for layer in (0, 1)]) - 1]
    edges = corners[:, [1, 3, 4]] - corners[:, :1]
    volumes = np.linalg.det(edges)
    assert volumes.min() > 0.0
    assert volumes.sum() == pytest.approx(2.0 * HEIGHT * WIDTH * LENGTH, rel=1e-12)


def test_positions_of_two_plates() -> None:
    x, y, z = np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0]), np.array([0.0, 0.5, 2.0])
    mesh = two_plates(x, y, z, 1.0)
    assert mesh.positions.shape == (6, 2, 3, 3)
    assert mesh.positions[:3, 1, 2].tolist() == [[3.0, 2.0, -2.0], [3.0, 2.0, -0.5], [3.0, 2.0, 0.0]]
    assert mesh.positions[4, 1, 2].tolist() == [3.0, 2.0, 0.5]
    assert mesh.bonded.tolist() == [[False, True]]


def test_moved_nodes_turn_the_mesh_lines() -> None:
    mesh = beam(INTERFACES["U8"], across=3).mesh
    points, slope = mesh.positions, 0.2
    turned = replace(mesh, moved=points + slope * points[..., 1:2] * [1.0, 0.0, 0.0])
    labels, moved = turned.nodes()
    assert labels.tolist() == mesh.nodes()[0].tolist()
    assert np.allclose(moved - mesh.nodes()[1], np.outer(moved[:, 1], [slope, 0.0, 0.0]), atol=1e-15)


@pytest.mark.parametrize("case", space_beams.CASES, ids=lambda case: case.name)
def test_a_generated_mesh_is_the_one_of_the_tables(case: space_beams.SpaceBeam, tmp_path: Path) -> None:
    models = []
    for generated in (True, False):
        lines = case.deck(generated).splitlines()
        (tmp_path / "beam.inp").write_text(text(lines))
        models.append((read_deck(tmp_path / "beam.inp"), len(lines)))
    (short, few), (long, many) = models
    assert 20 * few < many
    assert (short.mesh.labels == long.mesh.labels).all()
    assert short.mesh.coordinates == pytest.approx(long.mesh.coordinates, abs=1e-8)
    for group, other in zip(short.groups, long.groups, strict=True):
        assert (group.type, group.section.elset) == (other.type, other.section.elset)
        assert (group.labels == other.labels).all()
        assert (group.nodes == other.nodes).all()


@pytest.mark.parametrize("kind", INTERFACES)
def test_dcb_has_the_stiffness_of_beam_theory(kind: str, solved: Callable[[list[str]], Result]) -> None:
    """In plane strain across the width: Williams' crack length correction, a few per cent of a small correction."""
    result = solved(build.dcb_deck("DCB", beam(INTERFACES[kind]), 0.1, LINEAR, part=build.STRIP))
    constrained = PLY.moduli[0] / (1.0 - PLY.ratios[0] ** 2 * PLY.moduli[1] / PLY.moduli[0])
    arms = Arms(WIDTH, HEIGHT, constrained, PLY.moduli[2] / (1.0 - PLY.ratios[2] ** 2), PLY.shear[1])
    load = total(result, "RF3", "TOP")
    assert 0.1 / load == pytest.approx(dcb_compliance(arms, CRACK), rel=0.03)


@pytest.mark.parametrize("part", [build.WHOLE, build.STRIP])
def test_enf_has_the_stiffness_of_beam_theory(part: str, solved: Callable[[list[str]], Result]) -> None:
    """The crack reaches mid-span, its limit in the theory."""
    result = solved(build.enf_deck("ENF", beam(INTERFACES["U8"]), 0.1, LINEAR, part=part))
    arms = Arms(WIDTH, HEIGHT, PLY.moduli[0], PLY.moduli[1], PLY.shear[0])
    assert -0.1 / total(result, "RF3", "MIDSPAN") == pytest.approx(enf_compliance(arms, CRACK, 30.0), rel=0.03)


def test_the_lever_of_mixed_mode_bending_is_in_equilibrium(solved: Callable[[list[str]], Result]) -> None:
    """Supports carry the load: about the left one, P (L + c) = R 2 L. The lever's deflections are those of a line."""
    laminate, half, lever = beam(INTERFACES["U8"]), 24.0, 20.0
    lines = build.mmb_deck("MMB", laminate, 2.0 * half, lever, 0.2, LINEAR, part=build.STRIP)
    mark = lines.index("*NODE OUTPUT, NSET=LEVER")
    for name in ("LEFT", "RIGHT", "END", "MIDDLE"):
        lines[mark:mark] = [f"*NODE OUTPUT, NSET={name}", "U3, RF3"]
    top = laminate.mesh.labels[1]
    column = int(np.argmin(np.abs(laminate.mesh.x - half)))
    lines.insert(lines.index("*EQUATION"), f"*NSET, NSET=MIDDLE\n{top[-1, 0, column]},")
    result = solved(lines)
    load = -total(result, "RF3", "LEVER")
    assert load > 0.0
    left, right = total(result, "RF3", "LEFT"), total(result, "RF3", "RIGHT")
    assert left + right == pytest.approx(load, rel=1e-9)
    assert right * 2.0 * half == pytest.approx(load * (half + lever), rel=1e-9)
    end = total(result, "U3", "END") / 2.0
    middle = total(result, "U3", "MIDDLE")
    assert end > 0.0 > middle
    assert middle == pytest.approx((half * -0.2 + lever * end) / (half + lever), rel=1e-9)


def test_half_a_beam_carries_half_the_load(solved: Callable[[list[str]], Result]) -> None:
    """The half on one side of the symmetry plane, which has no stress across, is a beam of half the width."""
    laminate = beam(INTERFACES["U8"], (PLY, CROSS), across=4)
    whole = total(solved(build.dcb_deck("DCB", laminate, 0.1, LINEAR)), "RF3", "TOP")
    mesh = laminate.mesh
    part = replace(mesh, y=mesh.y[:3], bonded=mesh.bonded[:2])
    half = total(
        solved(build.dcb_deck("DCB", replace(laminate, mesh=part), 0.1, LINEAR, part=build.HALF)), "RF3", "TOP"
    )
    assert half == pytest.approx(0.5 * whole, rel=1e-8)


def test_bonded_plates_of_a_circular_delamination(solved: Callable[[list[str]], Result]) -> None:
    """A clamped Kirchhoff plate under a force in the middle: w = P a^2/(16 pi D). A thin plate, a square mesh."""
    edges = np.linspace(0.0, 30.0, 31)
    centres = 0.5 * (edges[1:] + edges[:-1])
    bonded = np.hypot(*np.meshgrid(centres, centres, indexing="ij")) > 20.0
    z = np.linspace(0.0, 0.5, 2)
    metal = isotropic("METAL", 7.0e4, 0.3)
    laminate = Laminate(TwoPlateMesh(edges, edges, z - 0.5, z, bonded), INTERFACES["U8"], (metal,), (metal,))
    result = solved(build.circular_deck("Circle", laminate, 0.1, LINEAR))
    bending = 7.0e4 * 0.5**3 / (12.0 * (1.0 - 0.3**2))
    # a quarter of the load; the radius is known to half an element, and the rim gives way
    expected = 0.25 * 0.1 * 16.0 * np.pi * bending / 20.0**2
    assert total(result, "RF3", "TOP") == pytest.approx(expected, rel=0.08)


@pytest.mark.sample(3)
@pytest.mark.parametrize("kind", INTERFACES)
def test_the_front_releases_the_fracture_energy(kind: str, tmp_path: Path) -> None:
    """A crack that runs, on mesh lines at 20 degrees to its front: straight, in mode I, G = G_Ic on every place.

    The process zone is three elements long: trapezoids on it are a tenth off at the most.
    """
    toughness, size, width = 0.26, 0.5, 4.0
    x, y, z = np.linspace(0.0, 24.0, 49), np.linspace(0.0, width, 9), np.linspace(0.0, 1.0, 2)
    law = Cohesive(0.0, 0.0, 30.0, 30.0, toughness, toughness)
    stiffness = 0.0 if kind == "U8" else 1.0e5
    interface = replace(INTERFACES[kind], cohesive=law.with_stiffness(stiffness))
    mesh = two_plates(x, y, z, 8.0)
    slanted, inside = mesh.positions, np.clip(np.minimum(x - 2.0, 20.0 - x) / 4.0, 0.0, 1.0)
    slanted[..., 0] += np.tan(np.radians(20.0)) * (y[:, None] - 0.5 * width) * inside
    laminate = Laminate(replace(mesh, moved=slanted), interface, (PLY,), (PLY,))
    deck = tmp_path / f"{kind}.inp"
    static = (0.05, 1.0, 1.0e-6, 0.05)
    deck.write_text(text(build.dcb_deck("Slanted mesh", laminate, 0.25, static, part=build.STRIP)))
    result = run(deck, output_dir=tmp_path, solver=SolverOptions(fallback=True))
    last = [front for front in fronts(result) if front.time == result.frames[-1].time]
    assert len(last) == 1
    # it has left the first, slanted edge
    assert last[0].coordinates[:, 0].min() > 9.5
    assert np.ptp(last[0].coordinates[:, 0]) < size
    # across the specimen; a mesh line has 0.34
    assert abs(np.mean(last[0].ahead[:, 1])) < 0.1
    # the first and the last lines leave the surface on their way
    assert last[0].releases[:, 0] == pytest.approx(np.full(len(last[0].coordinates), toughness), rel=0.1)
    assert np.abs(last[0].releases[:, 1:]).max() < 0.02 * toughness
    # the command gives the same
    assert main(["front", str(tmp_path / kind)]) == 0
    rows = np.genfromtxt(tmp_path / f"{kind}_front.csv", delimiter=",", names=True)
    ends = rows[rows["time"] == last[0].time]
    assert ends["GI"] == pytest.approx(last[0].releases[:, 0], rel=1e-6)
    assert (tmp_path / f"{kind}_front.png").exists()


@pytest.mark.parametrize("kind", INTERFACES)
def test_a_sliding_front_releases_the_shear_toughness(kind: str, tmp_path: Path) -> None:
    """End-notched flexure beyond its peak: G_II = G_IIc, and nothing in the other modes."""
    toughness = 1.0
    x, z = np.linspace(0.0, LENGTH, 121), np.linspace(0.0, HEIGHT, 2)
    law = Cohesive(0.0, 0.0, 30.0, 60.0, 0.26, toughness)
    stiffness = 0.0 if kind == "U8" else 1.0e5
    interface = replace(INTERFACES[kind], cohesive=law.with_stiffness(stiffness), eta=2.0)
    bonded = np.broadcast_to(x[:-1] > 22.0 - 1e-9, (1, len(x) - 1))
    mesh = TwoPlateMesh(x, np.array([0.0, WIDTH]), z - HEIGHT, z, bonded)
    deck = tmp_path / "enf.inp"
    lines = build.enf_deck(
        "ENF", Laminate(mesh, interface, (PLY,), (PLY,)), 1.4, (0.05, 1.0, 1.0e-6, 0.05), part=build.STRIP, every=2
    )
    deck.write_text(text(lines))
    last = fronts(run(deck, output_dir=tmp_path, solver=SolverOptions(fallback=True)))[-1]
    assert last.coordinates[:, 0].min() > 26.0
    # the process zone is 14 elements long
    assert last.releases[:, 1] == pytest.approx(np.full(len(last.coordinates), toughness), rel=0.03)
    assert np.abs(last.releases[:, [0, 2]]).max() < 0.01 * toughness
