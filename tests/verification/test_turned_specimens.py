# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whole specimens with NLGEOM that are turned as rigid bodies by 180 degrees while their crack grows."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uel.delamination.blocks import Interface, cohesive_section, law_values
from uel.delamination.kernels import uel_property, user_element
from uel.delamination.keywords import element_block, keyword, node_block, node_set, number, text, wrapped
from uel.delamination.materials import Cohesive, isotropic
from uel.delamination.plates import Laminate, TwoPlateMesh, mesh_blocks, property_blocks
from uel.output import Result
from uel.running.job import run
from uel.solver.options import SolverOptions

LENGTH, WIDTH, HEIGHT, CRACK, SIZE = 10.0, 0.5, 1.0, 3.2, 0.4
METAL = isotropic("METAL", 200.0, 0.3)
STRENGTH, TOUGHNESS = 2.0, 0.3
LAW = Cohesive(0.0, 0.0, STRENGTH, STRENGTH, TOUGHNESS, TOUGHNESS)
CONSISTENT = {"law": 2, "eta": 1.0, "beta": -1.0, "consistent": True}
INTERFACES = {
    **{kind: Interface(kind, LAW, **CONSISTENT) for kind in ("U4", "U8")},
    **{kind: Interface(kind, LAW.with_stiffness(100.0), law=2, eta=1.0) for kind in ("COH2D4", "COH3D8", "U2", "U7")},
}
OPENING, INCREMENTS, DEGREES = 0.9, 50, 180.0
"""Of each arm (mm). The chord of an increment's arc strains a trial state by 0.002 to 0.004; stiffer arms would have
stresses beyond the strength in it."""

Specimen = tuple[list[str], np.ndarray, list[np.ndarray]]
"""Mesh and properties; places of the nodes (n, dim); labels that are held, pulled up, pulled down."""
Build = Callable[[str, str], Specimen]


def turns(dim: int, degrees: float, times: np.ndarray) -> np.ndarray:
    """Rotations at these times (n, dim, dim), in space about an axis that is no direction of anything."""
    axis = np.array([0.6, -0.48, 0.64]) if dim == 3 else np.array([0.0, 0.0, 1.0])
    return Rotation.from_rotvec(np.radians(degrees) * times[:, None] * axis).as_matrix()[:, :dim, :dim]


def columns() -> np.ndarray:
    return np.linspace(0.0, LENGTH, round(LENGTH / SIZE) + 1)


def in_the_plane(quads: str, kind: str) -> Specimen:
    """In plane strain."""
    x, interface = columns(), INTERFACES[kind]
    y = np.array([-HEIGHT, 0.0, 0.0, HEIGHT])
    labels = 1 + np.arange(4 * len(x)).reshape(4, len(x))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    arms = [np.stack([a[:-1], a[1:], b[1:], b[:-1]], axis=-1) for a, b in (labels[:2], labels[2:])]
    bonded = x[:-1] > CRACK - 1e-9
    below, above = (arm[bonded] for arm in arms)
    faces = np.hstack([below, above]) if kind == "U4" else np.hstack([below[:, [3, 2]], above[:, [1, 0]]])
    lines = [*node_block(labels.ravel(), places), *element_block(quads, "ARMS", np.concatenate(arms), 1)]
    number_of = len(arms[0]) + len(arms[1])
    if interface.built_in:
        properties = cohesive_section(interface, WIDTH)
    else:
        lines += user_element(int(kind[1:]))
        plies = {f"{name} {side}": v for name, v in METAL.constants.items() for side in ("BOTTOM", "TOP")}
        given = law_values(interface) | plies | {"THICKNESS": WIDTH, "PLANE": 1}
        properties = uel_property(int(kind[1:]), "INTERFACE", given)
    lines += element_block(kind, "INTERFACE", faces, 1 + number_of)
    lines += ["*SOLID SECTION, ELSET=ARMS, MATERIAL=METAL", number(WIDTH), "*MATERIAL, NAME=METAL", "*ELASTIC"]
    lines += [*wrapped([METAL.moduli[0], METAL.ratios[0]]), *properties]
    return lines, places, [labels[:, -1], labels[-1, :1], labels[0, :1]]


def in_space(bricks: str, kind: str) -> Specimen:
    """With free sides."""
    x, z = columns(), np.array([0.0, HEIGHT])
    bonded = (x[:-1] > CRACK - 1e-9)[None]
    mesh = TwoPlateMesh(x, np.array([0.0, WIDTH]), z - HEIGHT, z, bonded)
    laminate = Laminate(mesh, INTERFACES[kind], (METAL,), (METAL,), bricks)
    bottom, top = mesh.labels
    held = np.concatenate([bottom[..., -1].ravel(), top[..., -1].ravel()])
    return [*mesh_blocks(laminate), *property_blocks(laminate)], mesh.nodes()[1], [held, top[-1, :, 0], bottom[0, :, 0]]


def deck(lines: list[str], places: np.ndarray, sets: list[np.ndarray], degrees: float, increments: int) -> str:
    """Opened in the frame that turns: every component of the nodes that are moved has an amplitude of its own."""
    dim, times = places.shape[1], np.linspace(0.0, 1.0, increments + 1)
    rotations = turns(dim, degrees, times)
    boundary, centre = [], places.mean(axis=0)
    lines = ["*HEADING", "Double cantilever beam that is turned", *lines, *node_set("TOP", sets[1])]
    for labels, opening in zip(sets, (0.0, OPENING, -OPENING), strict=True):
        pulled = np.zeros((len(times), dim))
        pulled[:, -1] = opening * times
        for label in labels.tolist():
            place = places[label - 1]
            moved = np.einsum("nij,nj->ni", rotations, place - centre + pulled) + centre - place
            for axis, values in enumerate(moved.T, 1):
                name = f"N{label}_{axis}"
                lines += [keyword("AMPLITUDE", NAME=name), *wrapped(np.column_stack([times, values]).ravel().tolist())]
                boundary += [keyword("BOUNDARY", AMPLITUDE=name), f"{label}, {axis}, {axis}, 1."]
    lines += ["*STEP, NLGEOM, UNSYMM=YES, INC=100", "*STATIC, DIRECT", f"{number(1.0 / increments)}, 1.", *boundary]
    lines += ["*CONTROLS, PARAMETERS=FIELD", "1e-7, , , , , , , 1e-7"]
    lines += ["*OUTPUT, HISTORY, FREQUENCY=1", "*NODE OUTPUT, NSET=TOP", ", ".join(f"RF{k + 1}" for k in range(dim))]
    lines += ["*ENERGY OUTPUT", "ALLIE, ALLPD, ALLDMD, ALLWK", "*END STEP"]
    return text(lines)


def loads(result: Result, degrees: float, dim: int) -> np.ndarray:
    """Reaction of TOP (n, dim) in the frame that turns."""
    history = result.history
    force = np.stack(
        [
            np.sum([history[name] for name in history if name.startswith((f"RF{k}[TOP]", f"RF{k}[TOP:"))], axis=0)
            for k in range(1, dim + 1)
        ],
        axis=-1,
    )
    # from the axes of the deck to those that turn
    return np.einsum("nji,nj->ni", turns(dim, degrees, history["time"]), force)


def deviation(specimen: Specimen, folder: Path, increments: int = INCREMENTS) -> float:
    """Largest difference of the load in the frame that turns from that of the specimen at rest, over the latter."""
    found, spent = [], []
    for degrees in (0.0, DEGREES):
        path = folder / f"turned_{degrees:.0f}.inp"
        path.write_text(deck(*specimen, degrees, increments))
        result = run(path, output_dir=folder, solver=SolverOptions(fallback=True))
        assert result.completed
        found.append(loads(result, degrees, specimen[1].shape[1])[-1 :: -(increments // INCREMENTS)])
        spent.append(result.history["ALLPD"][-1] + result.history["ALLDMD"][-1])
    still, turned = found
    # the crack has grown: more has been dissipated than an element takes
    assert min(spent) > TOUGHNESS * WIDTH * SIZE
    return float(np.abs(turned - still).max() / np.abs(still).max())


def hyperelastic(lines: list[str]) -> list[str]:
    """The same lines with a neo-Hookean material, which has the moduli of METAL at small strains."""
    place = lines.index("*ELASTIC")
    bulk = METAL.moduli[0] / (3.0 * (1.0 - 2.0 * METAL.ratios[0]))
    law = ["*HYPERELASTIC, NEO HOOKE", f"{METAL.shear[0] / 2.0}, {2.0 / bulk}"]
    return [*lines[:place], *law, *lines[place + 2 :]]


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("build", "solid", "kind"),
    [
        (in_the_plane, "CPE4I", "U4"),
        (in_the_plane, "CPE4I", "U2"),
        (in_the_plane, "CPE4I", "COH2D4"),
        (in_space, "C3D8I", "U8"),
        pytest.param(in_space, "C3D8I", "U7", marks=pytest.mark.long),
        pytest.param(in_space, "C3D8I", "COH3D8", marks=pytest.mark.long),
    ],
)
def test_a_specimen_that_turns_while_it_is_loaded(build: Build, solid: str, kind: str, tmp_path: Path) -> None:
    """A hyperelastic material knows no path: what differs is the tolerance of the residual, 1e-7 of the mean force."""
    lines, places, sets = build(solid, kind)
    assert deviation((hyperelastic(lines), places, sets), tmp_path) < 1e-6


@pytest.mark.parametrize("solid", ["CPE4", "CPE4I"])
def test_stress_that_is_integrated_over_the_increments(solid: str, tmp_path: Path) -> None:
    """With *ELASTIC the stress turns by Hughes and Winget's rule, and that of the increment's strain is added.

    That strain has the directions of the middle of the increment, half a rotation behind: 1.8 degrees or 3 % of the
    stress at the most, and half as much in increments of half the size.
    """
    specimen = in_the_plane(solid, "U2")
    coarse, fine = (deviation(specimen, tmp_path, count) for count in (INCREMENTS, 2 * INCREMENTS))
    assert coarse < np.radians(DEGREES / INCREMENTS / 2.0)
    assert fine == pytest.approx(0.5 * coarse, rel=0.2)
