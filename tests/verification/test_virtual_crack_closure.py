# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Energy release rates along a front (`uel front`) against virtual crack closure on solids without a process zone."""

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.delamination import front_measures
from uel.delamination.blocks import Interface
from uel.delamination.keywords import node_block, node_set, table, text
from uel.delamination.materials import Cohesive, isotropic
from uel.delamination.mesh import crack_columns
from uel.delamination.plate_specimens import HALF, dcb_deck, enf_deck
from uel.delamination.plates import Laminate, TwoPlateMesh
from uel.output.pictures.front import fronts
from uel.running.job import run
from uel.solver.options import SolverOptions

LENGTH, WIDTH, HEIGHT, CRACK, SIZE = 40.0, 10.0, 1.0, 15.0, 0.1
STRENGTH, TOUGHNESS = 60.0, 2.0
METAL = isotropic("METAL", 70000.0, 0.3)
LAW = Cohesive(0.0, 0.0, STRENGTH, STRENGTH, TOUGHNESS, TOUGHNESS)
CONSISTENT = Interface("U8", LAW, law=2, eta=1.0, beta=-1.0, consistent=True)


TIED = Interface("COH3D8", LAW.with_stiffness(1.0e6), law=2, eta=1.0)
LONGER = 8
"""Columns of bricks by which the second sharp crack is longer."""


def laminate() -> Laminate:
    """One half of the width, with the edge of the crack at CRACK."""
    x = crack_columns(LENGTH, (CRACK - 0.5, CRACK + 1.5), SIZE, 1.5, (1.0, 2.0))
    y = np.round(0.5 * WIDTH * (1.0 - (1.0 - np.linspace(0.0, 1.0, 9)) ** 1.5), 6)
    z = np.linspace(0.0, HEIGHT, 3)
    bonded = np.broadcast_to(x[:-1] > CRACK - 1e-9, (len(y) - 1, len(x) - 1))
    return Laminate(TwoPlateMesh(x, y, z - HEIGHT, z, bonded), CONSISTENT, (METAL,) * 2, (METAL,) * 2)


def column(mesh: TwoPlateMesh) -> int:
    """Of the nodes at CRACK."""
    return int(np.argmin(np.abs(mesh.x - CRACK)))


def sharp(build: Callable[..., list[str]], clamped: bool, tip: int, folder: Path) -> tuple[float, np.ndarray]:
    """Compliance, and G_I, G_II, G_III (n, 3) at a load of 1 N across the width, of a crack with its tip at a column.

    The faces beyond the tip are tied; those at the tip by nodes of their own, whose reactions are the forces along the
    crack's edge. Each works on the opening one brick behind it. One interface element, where nothing opens, is left.
    """
    beam = laminate()
    mesh = beam.mesh
    last = len(mesh.x) - 1
    alone = np.zeros_like(mesh.bonded)
    alone[0, last - 2] = True
    beam = replace(beam, interface=TIED, mesh=replace(mesh, bonded=alone))
    lines = build("Sharp crack", beam, 0.1, (1.0, 1.0, 1.0, 1.0), part=HALF, every=1)
    bottom, top = mesh.labels[0][-1], mesh.labels[1][0]
    carriers = int(mesh.labels[1].max()) + 1 + np.arange(len(mesh.y))
    rows = []
    # clamped nodes, and those of the plane of symmetry along y, have boundary conditions
    for j, i, dof in itertools.product(range(len(mesh.y)), range(tip, last + (not clamped)), (1, 2, 3)):
        if j > 0 or dof != 2:
            carrier = [(int(carriers[j]), dof, -1.0)] if i == tip else []
            terms = [(int(top[j, i]), dof, 1.0), (int(bottom[j, i]), dof, -1.0), *carrier]
            rows += [str(len(terms)), *table([[value for term in terms for value in term]])]
    step = next(k for k, line in enumerate(lines) if line.startswith("*STEP"))
    places = np.column_stack([np.full(len(mesh.y), mesh.x[tip]), mesh.y, np.zeros(len(mesh.y))])
    lines[step:step] = [*node_block(carriers, places), *node_set("CARRIERS", carriers), "*EQUATION", *rows]
    lines.insert(1 + lines.index("*BOUNDARY"), "CARRIERS, 1, 3")
    output = lines.index("*ENERGY OUTPUT")
    lines[output:output] = ["*NODE OUTPUT, NSET=CARRIERS", "RF1, RF2, RF3"]
    (folder / "sharp.inp").write_text(text(lines))
    result = run(folder / "sharp.inp", output_dir=folder)
    u = result.mesh().point_data["U"]
    jump = u[top[:, tip - 1] - 1] - u[bottom[:, tip - 1] - 1]
    # none along y in the plane of symmetry
    last_row = {name: values[-1] for name, values in result.history.items()}
    force = np.array([[last_row.get(f"RF{dof}[CARRIERS:{node}]", 0.0) for dof in (1, 2, 3)] for node in carriers])
    load = front_measures.load(result)[-1]
    releases = 0.5 * (-force * jump)[:, [2, 0, 1]] / (SIZE * widths(mesh)[:, None])
    return front_measures.displacement(result)[-1] / load, releases / load**2


def widths(mesh: TwoPlateMesh) -> np.ndarray:
    """Parts of the width that belong to the nodes across it."""
    parts = np.diff(mesh.y)
    return 0.5 * (np.append(parts, 0.0) + np.append(0.0, parts))


def of_same_compliance(
    build: Callable[..., list[str]], clamped: bool, compliance: float, load: float, folder: Path
) -> np.ndarray:
    """G_I, G_II, G_III (n, 3) of the sharp crack of this compliance at this load, between those of two lengths."""
    tip = column(laminate().mesh)
    (short, first), (long, second) = (sharp(build, clamped, tip + more, folder) for more in (0, LONGER))
    share = (compliance - short) / (long - short)
    assert 0.0 < share < 1.0
    return load**2 * ((1.0 - share) * first + share * second)


@pytest.mark.parametrize(
    ("build", "clamped", "moved", "mode"),
    [(dcb_deck, True, 0.6, 0), pytest.param(enf_deck, False, 0.7, 1, marks=pytest.mark.long)],
    ids=["I", "II"],
)
def test_releases_along_a_front(
    build: Callable[..., list[str]], clamped: bool, moved: float, mode: int, tmp_path: Path
) -> None:
    """While the process zone forms, at the load and the compliance of a sharp crack with a straight front.

    Energy balance makes the means over the width the same, up to trapezoids on a zone of 7 to 14 bricks. From place to
    place the zone, 0.7 to 1.4 mm long, takes load from the middle towards the side, where a sharp crack has little.
    """
    lines = build("Process zone", laminate(), moved, (0.1, 1.0, 1.0e-6, 0.1), part=HALF, every=1)
    (tmp_path / "zone.inp").write_text(text(lines))
    result = run(tmp_path / "zone.inp", output_dir=tmp_path, solver=SolverOptions(fallback=True))
    load, displacement = (values(result)[-1] for values in (front_measures.load, front_measures.displacement))
    expected = of_same_compliance(build, clamped, displacement / load, load, tmp_path)
    (front,) = (front for front in fronts(result, 0.02) if front.time == 1.0)

    parts = widths(laminate().mesh)
    mean, sharp_mean = front.releases.mean(axis=0), parts @ expected / parts.sum()
    assert mean.sum() == pytest.approx(sharp_mean.sum(), rel=0.03)
    assert mean[mode] == pytest.approx(sharp_mean[mode], rel=0.03)

    y = front.coordinates[:, 1]
    middle = y < 0.25 * WIDTH
    at = np.stack([np.interp(y, laminate().mesh.y, values) for values in expected.T], axis=-1)
    assert front.releases[middle, mode] == pytest.approx(at[middle, mode], rel=0.08)
    others = [k for k in range(3) if k != mode]
    assert np.abs(front.releases[middle][:, others]).max() < 0.02 * mean[mode]
    if mode == 0:
        # it falls to the side, as anticlastic bending makes it
        assert front.releases[-1, 0] < 0.5 * front.releases[0, 0]
    else:
        # mode III where the crack meets the side; its part depends on the direction of the front, which the zone curves
        assert mean[2] == pytest.approx(sharp_mean[2], rel=0.3)
        assert front.releases[-1, 2] > 10.0 * front.releases[middle, 2].max()
