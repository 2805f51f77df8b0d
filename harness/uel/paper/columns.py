# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Small decks that show what the properties do: two blocks with one interface element between them (N, mm, MPa).

The nodes of one height move together (*EQUATION), so strain and separation are uniform: what a deck has to give follows
from the law and from the stiffness of the blocks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from uel.delamination.kernels import formulations, uel_property, user_element
from uel.delamination.keywords import element_block, keyword, node_block, node_set, number, table, text, wrapped
from uel.delamination.materials import TABLE_2, SolidPly
from uel.delamination.steps import Output
from uel.model.arrays import FloatArray, IntArray
from uel.usersub.layout import element_layouts

SIDE = 0.2
"""Edge of the blocks, and their width in the plane."""

INCREMENTS = 100

# table 1 in space, isotropic in the plane 2-3
PLY = SolidPly("PLY_0", (1.2e5, 1.05e4, 1.05e4), (0.3, 0.3, 0.51), (5.52e3, 5.52e3, 3.48e3))
# the same with its fibres along y, in the axes of the deck
TURNED = SolidPly("PLY_90", (1.05e4, 1.2e5, 1.05e4), (0.3 * 1.05e4 / 1.2e5, 0.51, 0.3), (5.52e3, 3.48e3, 5.52e3))

LAW = {
    "SIGMAMAX": TABLE_2.strength_normal,
    "TAUMAX": TABLE_2.strength_shear,
    "GIC": TABLE_2.toughness_1,
    "GIIC": TABLE_2.toughness_2,
}
STRONG = {"SIGMAMAX": 1.0e3, "TAUMAX": 1.0e3, "GIC": 1.0e3, "GIIC": 1.0e3}
FINITE = {"ALPHAN": 1.0e6, "ALPHAT": 1.0e6}
ELASTIC = (0.0, 0.01)
EXPANSION = (1.0e-6, 3.0e-5, 3.0e-5)
"""Of a ply along its axes, 1/K: fibres hardly expand."""
BRIDGING = {"SIGMABRIDGE": 3.0, "TAUBRIDGE": 6.0, "GIBRIDGE": 0.1, "GIIBRIDGE": 0.3}
SOFTENING = ((0.2, 1.0), (0.4, 0.5), (0.6, 0.3), (0.7, 0.2), (0.8, 0.1))
"""Separation over that at failure, and traction over the strength."""
TABLE = {
    f"{name}{k}": value
    for k, point in enumerate(SOFTENING, 1)
    for name, value in zip(("SEPARATION", "TRACTION"), point, strict=True)
}
FATIGUE = {"ENDURANCE": 0.25, "BRITTLENESS": 0.8, "EXPONENT": 0.5, "LOADRATIO": 0.1, "DAMAGEJUMP": 0.01}
WARM = {
    "TEMPERATURE1": -10.0,
    "TEMPERATURE2": 40.0,
    "STRENGTH2": 0.8,
    "TOUGHNESS2": 0.9,
    "TEMPERATURE3": 100.0,
    "STRENGTH3": 0.5,
    "TOUGHNESS3": 0.6,
}
FAST = {"RATEREFERENCE": 1e-3, "RATELIMIT": 1.0, "STRENGTHRATE": 0.1, "TOUGHNESSRATE": 0.15}
PAPER = FINITE | {"CLOSURE": 2, "BETAN": -2.0, "BETAT": -2.0}

_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
_RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
_CUBE = np.vstack([np.column_stack([_SQUARE, np.full(4, height)]) for height in (0.0, 1.0)])
_EDGES = [*_RING, *((a + 4, b + 4) for a, b in _RING), *((a, a + 4) for a in range(4))]
_BLOCKS = {
    **dict.fromkeys(("CPS4", "CPE4", "U1"), (_SQUARE, [], 4)),
    "CPS8": (_SQUARE, _RING, 6),
    **dict.fromkeys(("C3D8", "U9"), (_CUBE, [], 8)),
    "C3D20": (_CUBE, _EDGES, 12),
}
"""Corners of a block by its type, edges with a middle node, and the interface element that owns two of them."""
_TENSORS: dict[str, dict[str, str | int]] = {
    "U1": {"INTEGRATION": 4, "TENSOR": "PSTRAIN"},
    "U9": {"INTEGRATION": 8, "TENSOR": "THREED"},
}


@dataclass(frozen=True, slots=True)
class Column:
    """A deck.

    title   of the deck
    jtype   of the interface element
    block   type of the blocks
    values  properties of the interface element, and of the blocks where they are user elements, by name; others are 0
    moved   displacement of the top at the end along x and along the normal (mm); by default beyond failure
    turned  the lower block has its fibres along y
    heated  change of temperature during the step (K), in which the plies expand
    stress  initial stress of the blocks, in Abaqus' order (MPa)
    cycles  in a second step, under the displacement of the first
    temperature  of all nodes, which does not change
    """

    title: str
    jtype: int
    block: str = "CPS4"
    values: Mapping[str, float] = field(default_factory=dict)
    moved: tuple[float, float] = (0.0, 0.05)
    turned: bool = False
    heated: float = 0.0
    stress: tuple[float, ...] = ()
    cycles: float = 0.0
    temperature: float = 0.0

    @property
    def plies(self) -> tuple[SolidPly, SolidPly]:
        """Plies of the lower and the upper block, in the axes of the deck."""
        return TURNED if self.turned else PLY, PLY


COLUMNS = {
    "u4_zeros": Column("zeros: the recommended element", 4),
    "u4_paper": Column("the paper's law, beta by equation (21)", 4, values=PAPER),
    "u4_incomplete": Column("incomplete form", 4, values={"CLOSURE": 1}),
    "u4_cooled": Column(
        "cooled by 100 K",
        4,
        values={f"EXPANSION{k} {side}": value for side in ("BOTTOM", "TOP") for k, value in enumerate(EXPANSION, 1)},
        heated=-100.0,
    ),
    "u4_exponential": Column("exponential law", 4, values={"LAW": 3, "ETA": 2.0}, moved=(0.0, 0.08)),
    "u4_ppr": Column("PPR law", 4, values={"LAW": 4, "SHAPEN": 3.0, "SHAPET": 3.0}),
    "u4_bridging": Column("fibre bridging, half-way", 4, values={"LAW": 5, "ETA": 2.0, **BRIDGING}, moved=(0.0, 0.04)),
    "u4_table": Column("softening by a table, half-way", 4, values={"LAW": 6, **TABLE}, moved=(0.0, 0.012)),
    "u4_fatigue": Column(
        "held under cycles",
        4,
        values={"LAW": 2, "FATIGUE": 2, **FATIGUE},
        moved=(0.0, 6e-4),
        cycles=1e5,
    ),
    "u4_warm": Column("strengths and fracture energies at 60 degrees", 4, values={"LAW": 1, **WARM}, temperature=60.0),
    "u4_fast": Column("opened at 0.01 mm per unit of time", 4, values={"LAW": 1, **FAST}, moved=(0.0, 0.01)),
    "u4_secant": Column("secant matrix", 4, values={"LAW": 1, "TANGENT": 1}),
    "u4_blend": Column("share of the secant matrix", 4, values={"LAW": 1, "BLEND": 0.05}),
    "u4_paced": Column("increments that follow the viscosity", 4, values={"LAW": 1, "VISCOSITY": 3e-3, "PACING": 1}),
    "u4_given": Column("beta and gamma given", 4, values={"LAW": 1, "BETAN": 2e5, "BETAT": 1e5, "GAMMABOT": 0.3}),
    "u4_friction": Column(
        "pressed and slid", 4, values={"LAW": 1, "FRICTION": 0.3, "CLOSURE": 3}, moved=(0.08, -0.0005)
    ),
    "u4_cracked": Column("an initial crack, pressed and slid", 4, values={"CRACKED": 1}, moved=(0.08, -0.0005)),
    "u4_plane_strain": Column(
        "plane strain, fibres across the interface below",
        4,
        "CPE4",
        STRONG | {"PLANE": 1, "ANGLE BOTTOM": 90.0},
        ELASTIC,
        turned=True,
    ),
    "u3_zeros": Column("zeros: the paper's element", 3, "U1", FINITE | {"PLANE": 1}),
    "u5": Column("standard, eight-node quads", 5, "CPS8", FINITE | {"LAW": 1}),
    "u6_zeros": Column("zeros: the recommended element between eight-node quads", 6, "CPS8"),
    "u8_turned": Column(
        "slid, fibres across below", 8, "C3D8", STRONG | {"ANGLE BOTTOM": 90.0}, (0.01, 0.0), turned=True
    ),
    "u8_directed": Column(
        "the same, angles of the fibres from 45 degrees to x, by an oblique direction",
        8,
        "C3D8",
        STRONG | {"ANGLE BOTTOM": 45.0, "ANGLE TOP": -45.0, "DIRECTION1": 2.0, "DIRECTION2": 2.0, "DIRECTION3": 1.0},
        (0.01, 0.0),
        turned=True,
    ),
    "u8_prestressed": Column(
        "blocks with an initial stress, slid",
        8,
        "C3D8",
        STRONG | {"ANGLE BOTTOM": 90.0, "INITIALS": 2.0, "INITIALN": 3.0, "INITIALT": 1.0},
        (0.01, 0.0),
        turned=True,
        stress=(0.0, 0.0, 3.0, 0.0, 2.0, 1.0),
    ),
    **{
        f"u10_formulation{n}": Column(
            f"beside bricks U9, FORMULATION {n}",
            10,
            "U9",
            FINITE | STRONG | {"FORMULATION": n, "ANGLE": 90.0 * n},
            ELASTIC,
        )
        for n in range(3)
    },
    "u11": Column("standard, 20-node bricks", 11, "C3D20", FINITE | {"LAW": 1}),
    "u12_zeros": Column("zeros: the recommended element between 20-node bricks", 12, "C3D20"),
}
"""The decks by name."""


def column_files() -> dict[str, str]:
    """Write the decks."""
    return {f"{name}.inp": text(_deck(column)) for name, column in COLUMNS.items()}


def normal_stiffness(column: Column) -> float:
    """Load over displacement of the bonded column along the normal (N/mm), with no compliance of the interface."""
    return _in_series([_moduli(ply, column.block)[0] for ply in column.plies])


def shear_stiffness(column: Column) -> float:
    """Return the shear stiffness of a column along x, as `normal_stiffness` along the normal."""
    return _in_series([_moduli(ply, column.block)[1] for ply in column.plies])


def _in_series(moduli: list[float]) -> float:
    """Return the stiffness of two blocks in series."""
    return SIDE**2 / sum(SIDE / modulus for modulus in moduli)


def _moduli(ply: SolidPly, block: str) -> tuple[float, float]:
    """Return stress over strain along the normal and in shear, with no strain in any other direction of the model."""
    compliance = np.diag([1.0 / modulus for modulus in ply.moduli])
    for (i, j), ratio in zip(((0, 1), (0, 2), (1, 2)), ply.ratios, strict=True):
        compliance[i, j] = compliance[j, i] = -ratio / ply.moduli[i]
    plane_stress = block.startswith("CPS")
    size = 2 if plane_stress else 3
    stiffness = np.linalg.inv(compliance[:size, :size])
    in_space = len(_BLOCKS[block][0]) == 8
    return float(stiffness[2, 2] if in_space else stiffness[1, 1]), ply.shear[1] if in_space else ply.shear[0]


def _deck(column: Column) -> list[str]:
    corners, edges, owner = _BLOCKS[column.block]
    places = np.vstack([corners, *(corners[list(edge)].mean(axis=0) for edge in edges)])
    dim, count = corners.shape[1], len(places)
    up = np.eye(dim)[-1]
    places = SIDE * np.vstack([places - up, places])
    labels = np.arange(1, 2 * count + 1)
    lines = ["*HEADING", f"Two blocks {column.block} and one interface element U{column.jtype}: {column.title}"]
    lines.append("** written by python -m uel.paper.decks; units N, mm, MPa")
    lines += node_block(labels, places)
    lines += node_set("BASE", labels[places[:, -1] == -SIDE]) + node_set("TOP", labels[places[:, -1] == SIDE])
    lines += node_set("ALL", labels) if column.heated or column.temperature else []
    lines += _blocks(column, labels.reshape(2, count))
    lines += _interface(column, labels, owner)
    lines += [
        "** the nodes of one height move together",
        *_tied(labels.reshape(2, count), places.reshape(2, count, dim)),
    ]
    moved = [column.moved[0], *[0.0] * (dim - 2), column.moved[1]]
    step = 1.0 / INCREMENTS
    output = Output(f"FREQUENCY={INCREMENTS}", stresses=False, history={"TOP": "U, RF"}, energies="ALLSE, ALLPD, ALLWK")
    return [
        *lines,
        *(
            ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", f"ALL, {number(column.temperature)}"]
            if column.temperature
            else []
        ),
        *(["*INITIAL CONDITIONS, TYPE=STRESS"] if column.stress else []),
        *(", ".join([name, *map(number, column.stress)]) for name in ("BELOW", "ABOVE") if column.stress),
        *["*BOUNDARY", f"BASE, 1, {dim}"],
        *[keyword("STEP", INC=10 * INCREMENTS, UNSYMM="YES"), "*STATIC", *table([(step, 1.0, 1e-6, step)])],
        *["*BOUNDARY", *(f"TOP, {i}, {i}, {number(value)}" for i, value in enumerate(moved, start=1))],
        *(["*TEMPERATURE", f"ALL, {number(column.heated)}"] if column.heated else []),
        *output.lines(),
        "*END STEP",
        *(_cycles(column.cycles, output) if column.cycles else []),
    ]


def _cycles(count: float, output: Output) -> list[str]:
    """Write a step in which time is the number of cycles; the element chooses the increments."""
    head = [keyword("STEP", INC=10 * INCREMENTS, UNSYMM="YES"), "*STATIC", *table([(1.0, count, 1e-6, count)])]
    return [*head, *output.lines(), "*END STEP"]


def _blocks(column: Column, labels: IntArray) -> list[str]:
    """Write the blocks, elements 1 and 2, with their materials; U1 and U9 keep the stress of the interface's face."""
    lines = user_element(int(column.block[1:]), **_TENSORS[column.block]) if column.block in _TENSORS else []
    faces = {"U1": (3, 1), "U9": (2, 1)}.get(column.block, (0, 0))
    sides = zip(("BELOW", "ABOVE"), labels, column.plies, faces, strict=True)
    for first, (name, nodes, ply, face) in enumerate(sides, start=1):
        lines += element_block(column.block, name, nodes[None], first)
        if column.block in _TENSORS:
            values = {"THICKNESS": SIDE, **column.values, "FACE": face if column.jtype in (3, 10) else 0}
            lines += uel_property(int(column.block[1:]), name, values, MATERIAL=ply.name)
        else:
            lines.append(keyword("SOLID SECTION", ELSET=name, MATERIAL=ply.name))
            lines += [number(SIDE)] if column.block.startswith("CP") else []
    for ply in dict.fromkeys(column.plies):
        lines += [keyword("MATERIAL", NAME=ply.name)]
        if column.block.startswith("CPS"):
            lines += ["*ELASTIC, TYPE=LAMINA", *wrapped([*ply.moduli[:2], ply.ratios[0], *ply.shear])]
        else:
            lines += ["*ELASTIC, TYPE=ENGINEERING CONSTANTS", *wrapped([*ply.moduli, *ply.ratios, *ply.shear])]
        lines += ["*EXPANSION, TYPE=ORTHO", *wrapped(list(EXPANSION))] if column.heated else []
    return lines


def _interface(column: Column, labels: IntArray, owner: int) -> list[str]:
    """Write the interface element, number 3."""
    layouts = element_layouts()
    nodes = labels
    if column.jtype != owner:
        nodes = np.zeros(layouts[column.jtype].nodes, dtype=int)
        for own, given in zip(layouts[column.jtype].faces, layouts[owner].faces, strict=True):
            nodes[list(own)] = labels[list(given)]
    values: dict[str, float] = {**LAW, "THICKNESS": SIDE, "OFFSETBOTTOM": -2, "OFFSETTOP": -1, **column.values}
    for side in ("BOTTOM", "TOP"):
        # the ply in its own axes, which ANGLE turns
        values |= {f"{name} {side}": value for name, value in PLY.constants.items()}
    values |= formulations(column.block) if column.block not in _TENSORS else {}
    lines = user_element(column.jtype)
    lines += element_block(f"U{column.jtype}", "INTERFACE", nodes[None], 3)
    return [*lines, *uel_property(column.jtype, "INTERFACE", values)]


def _tied(labels: IntArray, places: FloatArray) -> list[str]:
    """Write *EQUATION between the nodes of a block that have one height, but for the outer faces."""
    lines = []
    for block, points in zip(labels, places, strict=True):
        heights = points[:, -1]
        for height in np.unique(heights)[np.abs(np.unique(heights)) < SIDE]:
            first, *others = block[heights == height].tolist()
            for other in others:
                for dof in range(1, points.shape[1] + 1):
                    lines += ["*EQUATION", "2", f"{other}, {dof}, 1., {first}, {dof}, -1."]
    return lines
