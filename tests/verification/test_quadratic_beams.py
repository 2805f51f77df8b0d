# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beams with the interfaces of quadratic elements in space, U11 and U12, against other elements."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from reference_cells import nodes_of

from uel.delamination.kernels import formulations, uel_property, user_element
from uel.delamination.keywords import element_block, node_block, node_set, text
from uel.model.arrays import FloatArray, IntArray
from uel.running.job import run
from uel.solver.options import SolverOptions

LENGTH, CRACK, HEIGHT = 30.0, 10.0, 2.0
"""Of the beam and of the crack, and height of an arm, mm."""

ELASTIC, STRENGTH, TOUGHNESS = (70000.0, 0.3), 30.0, 0.5
LAW = {"LAW": 2, "ETA": 1.0, "SIGMAMAX": STRENGTH, "TAUMAX": STRENGTH, "GIC": TOUGHNESS, "GIIC": TOUGHNESS}
ISOTROPIC = {"E": ELASTIC[0], "NU": ELASTIC[1], "G": ELASTIC[0] / (2.0 + 2.0 * ELASTIC[1])}
PLIES = {
    f"{name}{member} {side}": ISOTROPIC[name]
    for name, members in {"E": ("1", "2", "3"), "NU": ("12", "13", "23"), "G": ("12", "13", "23")}.items()
    for member in members
    for side in ("BOTTOM", "TOP")
}


@dataclass(frozen=True)
class Beam:
    """A double cantilever beam.

    arm        element type of the arms
    interface  element type Un of the interface
    counts     elements of an arm along, in space across, through its height
    width      mm
    values     properties of the interface elements besides law and plies
    plane      plane strain in space too
    """

    arm: str
    interface: int
    counts: tuple[int, ...]
    width: float
    values: Mapping[str, float]
    plane: bool = False


def deck(beam: Beam, opening: float, increment: float) -> str:
    """The deck: the right end clamped, the left ends of the outer faces pulled apart in equal increments."""
    dim, kind = len(beam.counts), f"U{beam.interface}"
    places, arms, interface, sets = mesh(beam)
    values = {"THICKNESS": beam.width, "PLANE": 1} | LAW | PLIES | formulations(beam.arm) | dict(beam.values)
    lines = [
        "*HEADING",
        f"Double cantilever beam of {beam.arm} and {kind}",
        *node_block(np.arange(1, 1 + len(places)), places),
        *element_block(beam.arm, "ARMS", arms, 1),
        *user_element(beam.interface),
        *element_block(kind, "INTERFACE", interface, 1 + len(arms)),
        *(line for name, labels in sets.items() for line in node_set(name, labels)),
        "*SOLID SECTION, ELSET=ARMS, MATERIAL=ARM",
        *([f"{beam.width}"] if dim == 2 else []),
        "*MATERIAL, NAME=ARM",
        "*ELASTIC",
        f"{ELASTIC[0]}, {ELASTIC[1]}",
        *uel_property(beam.interface, "INTERFACE", values),
        "*STEP, INC=1000, UNSYMM=YES",
        "*STATIC",
        f"{increment}, {opening}, 1.e-8, {increment}",
        "*BOUNDARY",
        f"CLAMPED, 1, {dim}",
        *(["ALL, 2, 2"] if dim == 3 and beam.plane else []),
        f"TOP, {dim}, {dim}, {opening / 2}",
        f"BOTTOM, {dim}, {dim}, {-opening / 2}",
        "*OUTPUT, HISTORY",
        "*NODE OUTPUT, NSET=TOP",
        f"U{dim}, RF{dim}",
        "*END STEP",
    ]
    return text(lines)


def mesh(beam: Beam) -> tuple[FloatArray, IntArray, IntArray, dict[str, IntArray]]:
    """Coordinates, labels of the nodes of the elements of arms and interface, and node sets."""
    dim = len(beam.counts)
    sizes = np.array([LENGTH, beam.width, HEIGHT] if dim == 3 else [LENGTH, HEIGHT])
    # half steps along each direction: corners at the even ones
    steps = np.array(list(np.ndindex(*(2 * count + 1 for count in beam.counts))))
    cell = nodes_of(_cell(beam.arm))
    steps = steps[(steps % 2).sum(axis=1) <= (1 if len(cell) > 2**dim else 0)]
    label = {(arm, *step): 1 + arm * len(steps) + i for arm in (0, 1) for i, step in enumerate(steps.tolist())}
    top_arm = steps / (2.0 * np.array(beam.counts)) * sizes
    places = np.vstack([top_arm - np.eye(dim)[-1] * HEIGHT, top_arm])
    first = np.array(list(np.ndindex(*beam.counts)))

    def nodes(arm: int, bases: IntArray, at: FloatArray) -> IntArray:
        return np.array([[label[arm, *node] for node in (2 * base + 1 + at).astype(int).tolist()] for base in bases])

    bonded = first[:, 0] >= CRACK / LENGTH * beam.counts[0]
    below, above = (first[bonded & (first[:, -1] == row)] for row in (beam.counts[-1] - 1, 0))
    if beam.interface in (5, 11):
        bottom, top = nodes(0, below, cell[cell[:, -1] == 1]), nodes(1, above, cell[cell[:, -1] == -1])
        corners = 2 ** (dim - 1)
        order = [1, 0] if dim == 2 else [0, 1, 2, 3]  # back along the edges in the plane
        interface = np.hstack([bottom[:, order], top[:, order], bottom[:, corners:], top[:, corners:]])
    else:
        interface = np.hstack([nodes(0, below, cell), nodes(1, above, cell)])
    tip, outer = places[:, 0] == 0, np.abs(places[:, -1]) == HEIGHT
    sets = {"ALL": np.full(len(places), True), "CLAMPED": places[:, 0] == LENGTH}
    sets |= {"BOTTOM": tip & outer & (places[:, -1] < 0), "TOP": tip & outer & (places[:, -1] > 0)}
    arms = np.vstack([nodes(arm, first, cell) for arm in (0, 1)])
    return places, arms, interface, {name: 1 + np.flatnonzero(where) for name, where in sets.items()}


def _cell(arm: str) -> str:
    """The cell of an element type."""
    return {"CPE8": "quad8", "CPE8R": "quad8", "C3D20": "hexahedron20", "C3D20R": "hexahedron20"}.get(arm, "hexahedron")


STIFF = {"ALPHAN": 1e5, "ALPHAT": 1e5}
GIVEN = {"CLOSURE": 1, "BETAN": 5e5, "BETAT": 2e5}
LOCAL = {"CLOSURE": 1, "BETAN": -1, "BETAT": -1}


def curve(folder: Path, beam: Beam) -> tuple[FloatArray, FloatArray]:
    """Opening and load per width by increment."""
    file = folder / f"{beam.arm}_u{beam.interface}.inp"
    file.write_text(deck(beam, opening=2.0, increment=0.05), encoding="ascii")
    history = run(file, output_dir=folder, solver=SolverOptions(fallback=True)).history
    opening, load = (
        [history[name] for name in history if name.startswith(variable) and "[TOP" in name] for variable in ("U", "RF")
    )
    return 2.0 * opening[0], np.sum(load, axis=0) / beam.width


@pytest.mark.parametrize(
    ("plane", "space", "integration", "values"),
    [
        (5, 11, "R", STIFF),
        (6, 12, "", GIVEN),
        pytest.param(5, 11, "", STIFF, marks=pytest.mark.long),
        pytest.param(6, 12, "R", GIVEN, marks=pytest.mark.long),
        pytest.param(6, 12, "", LOCAL, marks=pytest.mark.long),
        pytest.param(6, 12, "R", LOCAL, marks=pytest.mark.long),
    ],
)
def test_a_strip_is_the_beam_in_plane_strain(
    tmp_path: Path, plane: int, space: int, integration: str, values: Mapping[str, float]
) -> None:
    """The whole curve to 0.1 %; the beta of a brick is not that of a quad."""
    thin = curve(tmp_path, Beam(f"CPE8{integration}", plane, (30, 1), 0.5, values))
    strip = curve(tmp_path, Beam(f"C3D20{integration}", space, (30, 1, 1), 0.5, values, plane=True))
    np.testing.assert_array_equal(strip[0], thin[0])
    np.testing.assert_allclose(strip[1], thin[1], atol=1e-3 * thin[1].max())
    # past the peak
    assert thin[1][-1] < 0.6 * thin[1].max()


@pytest.mark.long
@pytest.mark.parametrize("arm", ["C3D20", "C3D20R"])
def test_a_wide_beam_agrees_with_incompatible_bricks(tmp_path: Path, arm: str) -> None:
    """U12 on elements of 1 mm, U8 between C3D8I on elements of half of that."""
    quadratic = curve(tmp_path, Beam(arm, 12, (30, 2, 1), 4.0, LOCAL))
    linear = curve(tmp_path, Beam("C3D8I", 8, (60, 4, 2), 4.0, LOCAL))
    np.testing.assert_array_equal(quadratic[0], linear[0])
    assert quadratic[1].max() == pytest.approx(linear[1].max(), rel=5e-3)
    assert quadratic[1][-1] == pytest.approx(linear[1][-1], rel=5e-3)
