# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that can be written flat, as a part, in a turned instance, or turned as a whole.

A body is a set of functions of a `Frame`, so that each point and vector passes through it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

import numpy as np
from reference_cells import patch_of

from uel.delamination.kernels import uel_property, user_element
from uel.model.element_types import (
    BEAM,
    CONTINUUM,
    CONTINUUM_SHELL,
    COUPLED,
    GENERALISED,
    HEAT,
    MEMBRANE,
    PIEZOELECTRIC,
    SHELL,
    BeamType,
    HeatType,
    SolidType,
    SurfaceType,
)

Lines = list[str]
Write = Callable[["Frame"], Lines]

AXIS: Final = np.array([0.6, 0.0, 0.8])
UP: Final = np.array([0.0, 0.0, 1.0])
ANGLE: Final = np.radians(37.0)
REFERENCE: Final = 1000
"""Label of the reference node of generalised plane strain."""


def rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    """Return the matrix (3, 3) of a rotation (O. Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


@dataclass(frozen=True)
class Frame:
    """The axes that a deck is written in.

    world  rotation (3, 3) of the whole model
    part   True where the body is a *PART with an *INSTANCE
    axis, angle  rotation of the *INSTANCE: the part is written turned back by it
    """

    world: np.ndarray = field(default_factory=lambda: np.eye(3))
    part: bool = False
    axis: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    angle: float = 0.0

    def vector(self, v: np.ndarray) -> np.ndarray:
        """Return a vector of the model."""
        return self.world @ v

    def own(self, x: np.ndarray) -> np.ndarray:
        """Return a point or vector in the axes of the part."""
        return rotation(self.axis, self.angle).T @ self.world @ x

    def set(self, name: str) -> str:
        """Name of a set of the body in the model."""
        return f"I.{name}" if self.part else name


@dataclass(frozen=True)
class Body:
    """A model of one kind of element, held on one side and loaded on the others.

    part      nodes, elements, sets, sections, orientations
    data      materials and initial conditions
    supports  *BOUNDARY of the model
    loads     lines of a step: of the frame
    vectors   variables of the history, each with components 1 to `dimension`
    scalars   variables of the history without direction
    procedure keyword and times of a step
    turns     axis of the rotations that the body allows; None for none
    linear    small displacements and linear materials
    nlgeom    its own step has NLGEOM
    large     supports NLGEOM
    mass      supports *FREQUENCY
    takes_temperature  has no temperatures of its own
    pressure  label of *DLOAD; empty for none
    joint     what joins its blocks, in the model
    """

    name: str
    part: Write
    data: Lines
    supports: Write
    loads: Write
    dimension: int
    vectors: tuple[str, ...] = ("U", "RF")
    scalars: tuple[str, ...] = ()
    procedure: str = "*STATIC\n1., 1."
    turns: np.ndarray | None = field(default_factory=lambda: AXIS)
    linear: bool = True
    nlgeom: bool = False
    large: bool = True
    mass: bool = True
    takes_temperature: bool = True
    pressure: str = ""
    joint: Write = lambda frame: []


def numbers(values: np.ndarray) -> str:
    """Fields of a data line that keep each bit."""
    return ", ".join(repr(float(v)) for v in values)


def wrapped(label: int, nodes: np.ndarray) -> Lines:
    """Data lines of an element, at most 12 fields each."""
    fields = [str(label), *(str(node + 1) for node in nodes)]
    rows = [fields[k : k + 12] for k in range(0, len(fields), 12)]
    return [", ".join(row) + ("," if row is not rows[-1] else "") for row in rows]


def padded(x: np.ndarray) -> np.ndarray:
    """Return points (n, 3) of points (n, dimension)."""
    return np.pad(x, ((0, 0), (0, 3 - x.shape[1])))


def mesh(frame: Frame, kind: str, nodes: np.ndarray, elements: np.ndarray, *, dimension: int) -> Lines:
    """Nodes of the set ALL, elements of the set BODY, and the sets LEFT and RIGHT of the ends along x."""
    placed = padded(nodes) @ frame_matrix(frame).T
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{k}, {numbers(x[:dimension])}" for k, x in enumerate(placed, 1)]
    lines.append(f"*ELEMENT, TYPE={kind}, ELSET=BODY")
    lines += [line for k, element in enumerate(elements, 1) for line in wrapped(k, element)]
    used = np.unique(elements)
    for name, end in (("LEFT", nodes[:, 0].min()), ("RIGHT", nodes[:, 0].max())):
        lines += [f"*NSET, NSET={name}", *(str(k + 1) for k in used if np.isclose(nodes[k, 0], end))]
    return lines


def frame_matrix(frame: Frame) -> np.ndarray:
    """Return the matrix (3, 3) that `Frame.own` multiplies by."""
    return np.column_stack([frame.own(e) for e in np.eye(3)])


def oriented(frame: Frame, axes: np.ndarray) -> Lines:
    """*ORIENTATION with these axes (rows), in the part."""
    return ["*ORIENTATION, NAME=AXES", numbers(np.concatenate([frame.own(axes[0]), frame.own(axes[1])]))]


def forces(frame: Frame, name: str, force: np.ndarray, dimension: int) -> Lines:
    """*CLOAD by the components of a vector."""
    turned = frame.vector(force)[:dimension]
    return ["*CLOAD", *(f"{frame.set(name)}, {k}, {float(f)!r}" for k, f in enumerate(turned, 1))]


ISOTROPIC = ["*ELASTIC", "1000., 0.3"]
# E1, E2, E3, nu12, nu13, nu23, G12, G13 / G23
ORTHOTROPIC = ["*ELASTIC, TYPE=ENGINEERING CONSTANTS", "9000., 700., 500., 0.3, 0.25, 0.4, 400., 300.", "200."]
LAMINA = ["*ELASTIC, TYPE=LAMINA", "9000., 700., 0.3, 400., 300., 200."]


def _anisotropic() -> Lines:
    square = np.random.default_rng(3).uniform(-1, 1, (6, 6))
    matrix = 600.0 * np.eye(6) + 80.0 * square @ square.T
    values = [matrix[i, j] for j in range(6) for i in range(j + 1)]
    return ["*ELASTIC, TYPE=ANISOTROPIC", *(numbers(np.array(values[k : k + 8])) for k in range(0, 21, 8))]


NEARLY_INCOMPRESSIBLE = ["*ELASTIC", "1000., 0.4999"]
PLASTIC = [*ISOTROPIC, "*PLASTIC", "12., 0.", "30., 0.1"]
NEO_HOOKE = ["*HYPERELASTIC, NEO HOOKE", "150., 0.004"]
MATERIALS: Final = {
    "isotropic": ISOTROPIC,
    "orthotropic": ORTHOTROPIC,
    "anisotropic": _anisotropic(),
    "lamina": LAMINA,
    "incompressible": NEARLY_INCOMPRESSIBLE,
    "plastic": PLASTIC,
    "neo-Hooke": NEO_HOOKE,
}
_NONLINEAR = ("plastic", "neo-Hooke")
_DIRECTED = ("orthotropic", "anisotropic", "lamina")
_AXES: Final = {
    2: np.array([[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]),
    3: rotation(np.array([2.0, -1.0, 2.0]) / 3, 0.7),
}
_FORCE = np.array([0.3, -0.2, 0.25])


def solid(name: str, kind: SolidType, material: str, *, temperature: bool = False) -> Body:
    """A distorted patch of one type of solid, held at its left, pulled at its right, under a pressure and gravity."""
    nodes, elements = patch_of(kind.family.cell)
    if kind.axisymmetric:
        nodes += np.array([1.0, 0.0])
    dimension = kind.dimension
    heat = isinstance(kind, HeatType)
    generalised, electrical = getattr(kind, "generalised", False), getattr(kind, "electrical", False)
    coupled = getattr(kind, "coupled", False)
    directed = material in _DIRECTED
    layered = isinstance(kind, SolidType) and kind.section == "SHELL SECTION"

    def part(frame: Frame) -> Lines:
        lines = mesh(frame, name, nodes, elements, dimension=dimension)
        axes = _AXES[3] if dimension == 3 and not layered else _AXES[2]
        lines += oriented(frame, axes) if directed else []
        lines += ["*NODE, NSET=REF", f"{REFERENCE}, 0.4, 0.3"] if generalised else []
        options = ", ORIENTATION=AXES" if directed else ""
        options += ", REF NODE=REF" if generalised else ""
        return [*lines, f"*{kind.section}, ELSET=BODY, MATERIAL=M{options}", "0.7"]

    data = ["*MATERIAL, NAME=M", *MATERIALS[material], "*DENSITY", "2."]
    data += ["*EXPANSION", "1e-3"] if temperature else []
    data += ["*CONDUCTIVITY", "2."] if coupled or heat else []
    data += ["*SPECIFIC HEAT", "1."] if heat else []
    data += ["*DIELECTRIC", "1."] if electrical else []

    def supports(frame: Frame) -> Lines:
        lines = ["*BOUNDARY"]
        lines += [f"{frame.set('LEFT')}, 1, {dimension}"] if not heat else []
        lines += [f"{frame.set('REF')}, 3, 5"] if generalised else []
        lines += [f"{frame.set('LEFT')}, 11, 11"] if heat or coupled else []
        lines += [f"{frame.set('LEFT')}, 9, 9"] if electrical else []
        return lines

    def loads(frame: Frame) -> Lines:
        if heat:
            return ["*CFLUX", f"{frame.set('RIGHT')}, 11, 3."]
        lines = forces(frame, "RIGHT", _FORCE, dimension)
        lines += ["*DLOAD", f"{frame.set('BODY')}, P1, 0.4"]
        if not kind.axisymmetric:
            down = frame.vector(np.array([0.6, -0.8, 0.0]))
            lines += [f"{frame.set('BODY')}, GRAV, 0.2, {numbers(down[:dimension])}"]
        lines += ["*TEMPERATURE", f"{frame.set('ALL')}, 5."] if temperature else []
        lines += ["*CFLUX", f"{frame.set('RIGHT')}, 11, 3."] if coupled else []
        return lines

    procedure = "*HEAT TRANSFER, STEADY STATE\n1., 1." if heat else "*STATIC\n1., 1."
    if coupled:
        procedure = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1."
    turns = AXIS if dimension == 3 else np.array([0.0, 0.0, 1.0])
    return Body(
        f"{name} {material}{' expansion' if temperature else ''}",
        part,
        data,
        supports,
        loads,
        dimension,
        vectors=() if heat else ("U", "RF"),
        scalars=(("NT11", "RFL11") if heat or coupled else ()) + (("EPOT",) if electrical else ()),
        procedure=procedure,
        turns=None if kind.axisymmetric or generalised else turns,
        linear=material not in _NONLINEAR,
        nlgeom=material == "neo-Hooke",
        large=not electrical,
        mass=not (heat or coupled or generalised),
        takes_temperature=not (heat or coupled or temperature),
        pressure="" if heat else "P1",
    )


def shell(name: str, kind: SurfaceType, material: str) -> Body:
    """A plate of shells, held at its left."""
    flat, elements = patch_of(kind.family.cell)
    nodes = padded(flat)
    directed = material in _DIRECTED

    def part(frame: Frame) -> Lines:
        lines = mesh(frame, name, nodes, elements, dimension=3)
        lines += oriented(frame, _AXES[2]) if directed else []
        options = ", ORIENTATION=AXES" if directed else ""
        return [*lines, f"*SHELL SECTION, ELSET=BODY, MATERIAL=M{options}", "0.1"]

    def loads(frame: Frame) -> Lines:
        lines = forces(frame, "RIGHT", np.array([3e-3, -2e-3, 3e-5]), 3)
        return [*lines, "*DLOAD", f"{frame.set('BODY')}, P, 1e-4"]

    return Body(
        f"{name} {material}",
        part,
        ["*MATERIAL, NAME=M", *MATERIALS[material], "*DENSITY", "2."],
        lambda frame: ["*BOUNDARY", f"{frame.set('LEFT')}, 1, 6"],
        loads,
        3,
        vectors=("U", "UR", "RF", "RM"),
        linear=material not in _NONLINEAR,
        pressure="P",
    )


_SKINNED: Final = {3: "C3D4", 4: "C3D8", 6: "C3D10", 8: "C3D20"}
"""Solids whose faces have these nodes."""


def membrane(name: str, kind: SurfaceType, material: str) -> Body:
    """A block with a membrane on its faces at the bottom."""
    base = solid(_SKINNED[kind.nodes], CONTINUUM[_SKINNED[kind.nodes]], "isotropic")
    family = CONTINUUM[_SKINNED[kind.nodes]].family
    nodes, elements = patch_of(family.cell)
    low = np.isclose(nodes[:, 2], 0.0)
    skin = np.array(
        [element[list(face)] for element in elements for face in family.faces if low[element[list(face)]].all()]
    )
    directed = material in _DIRECTED

    def part(frame: Frame) -> Lines:
        lines = [*base.part(frame), f"*ELEMENT, TYPE={name}, ELSET=SKIN"]
        lines += [line for k, element in enumerate(skin, 501) for line in wrapped(k, element)]
        lines += oriented(frame, _AXES[2]) if directed else []
        options = ", ORIENTATION=AXES" if directed else ""
        return [*lines, f"*MEMBRANE SECTION, ELSET=SKIN, MATERIAL=SKIN{options}", "0.1"]

    data = [
        *base.data,
        "*MATERIAL, NAME=SKIN",
        *MATERIALS[material],
        "*DENSITY",
        "2.",
    ]
    return replace(base, name=f"{name} {material}", part=part, data=data, linear=material not in _NONLINEAR)


def beam(name: str, kind: BeamType, profile: str, dimensions: str) -> Body:
    """A bent line of beams, held at one end."""
    count, step, space = 4, kind.nodes - 1, kind.dimension == 3
    along = np.linspace(0.0, 1.0, step * count + 1)
    nodes = np.column_stack([3.0 * along, 0.8 * along**2, 0.5 * along if space else 0.0 * along])
    elements = np.array([[step * k + j for j in range(kind.nodes)] for k in range(count)])
    pressure = "P1" if space else "P2"

    def part(frame: Frame) -> Lines:
        lines = mesh(frame, name, nodes, elements, dimension=kind.dimension)
        first = frame.own(np.array([0.2, 0.1, -1.0])) if space else np.array([0.0, 0.0, -1.0])
        return [*lines, f"*BEAM SECTION, ELSET=BODY, MATERIAL=M, SECTION={profile}", dimensions, numbers(first)]

    def loads(frame: Frame) -> Lines:
        lines = forces(frame, "RIGHT", np.array([0.03, -0.02, 0.025 if space else 0.0]), kind.dimension)
        return [*lines, "*DLOAD", f"{frame.set('BODY')}, {pressure}, 0.01"]

    return Body(
        f"{name} {profile}",
        part,
        ["*MATERIAL, NAME=M", *ISOTROPIC, "*DENSITY", "2."],
        lambda frame: ["*BOUNDARY", f"{frame.set('LEFT')}, 1, 6"],
        loads,
        kind.dimension,
        vectors=("U", "UR", "RF", "RM") if space else ("U", "RF"),
        scalars=() if space else ("UR3", "RM3"),
        turns=AXIS if space else UP,
        large=False,
        pressure=pressure,
    )


def truss(dimension: int) -> Body:
    """A triangle or a tetrahedron of trusses, held at its nodes at the left."""
    nodes = np.array([[0.0, 0, 0], [0, 1, 0], [1.0, 0.3, 0.2], [0, 0.4, 1.0]])[: dimension + 1]
    elements = np.array([[a, b] for a in range(len(nodes)) for b in range(a)])

    def part(frame: Frame) -> Lines:
        lines = mesh(frame, f"T{dimension}D2", nodes, elements, dimension=dimension)
        return [*lines, "*SOLID SECTION, ELSET=BODY, MATERIAL=M", "0.1"]

    return Body(
        f"T{dimension}D2 isotropic",
        part,
        ["*MATERIAL, NAME=M", *ISOTROPIC, "*DENSITY", "2."],
        lambda frame: ["*BOUNDARY", f"{frame.set('LEFT')}, 1, {dimension}"],
        lambda frame: forces(frame, "RIGHT", _FORCE, dimension),
        dimension,
        turns=AXIS if dimension == 3 else UP,
    )


def blocks(dimension: int, cells: tuple[int, int]) -> tuple[np.ndarray, list[list[list[int]]]]:
    """Return the nodes of two blocks, one on the other along y, and the elements of each, whose bottom comes first."""
    nodes: list[tuple[float, ...]] = []
    both: list[list[list[int]]] = []
    depths = (1.0, 0.0) if dimension == 3 else (0.0,)
    for low, count in zip((0.0, 1.0), cells, strict=True):
        number: dict[tuple[int, float, float], int] = {}
        for place in ((k, y, z) for y in (0.0, 1.0) for z in depths for k in range(count + 1)):
            number[place] = len(nodes)
            nodes.append((2.0 * place[0] / count, low + place[1], place[2])[:dimension])
        elements = []
        for k in range(count):
            if dimension == 2:
                element = [number[k, 0.0, 0.0], number[k + 1, 0.0, 0.0], number[k + 1, 1.0, 0.0], number[k, 1.0, 0.0]]
            else:
                around = ((k, 1.0), (k + 1, 1.0), (k + 1, 0.0), (k, 0.0))
                element = [number[i, y, z] for y in (0.0, 1.0) for i, z in around]
            elements.append(element)
        both.append(elements)
    return np.array(nodes), both


def joined(
    name: str,
    dimension: int,
    *,
    joint: Write = lambda frame: [],
    interface: Callable[[list[list[int]], list[list[int]]], Lines] | None = None,
    data: Sequence[str] = (),
    linear: bool = True,
    nlgeom: bool = False,
    damage: bool = False,
) -> Body:
    """Two blocks joined at y = 1, by `joint` in the model (surfaces LOW and UP), or by `interface` in the part.

    interface takes the elements below and above, which meet without sharing nodes
    damage    moved at the top until the interface softens, in place of forces
    """
    kind = {2: "CPE4", 3: "C3D8"}[dimension]
    nodes, (below, above) = blocks(dimension, (2, 2) if interface else (2, 3))
    faces = {2: ("S3", "S1"), 3: ("S2", "S1")}[dimension]
    ends = {"BOTTOM": 0.0, "TOP": 2.0}

    def part(frame: Frame) -> Lines:
        lines = mesh(frame, kind, nodes, np.array([*below, *above]), dimension=dimension)
        lines += ["*ELSET, ELSET=ELOW", "1, 2", "*ELSET, ELSET=EUP", "3, 4" if interface else "3, 4, 5"]
        for label, y in ends.items():
            lines += [f"*NSET, NSET={label}", *(str(k + 1) for k in np.flatnonzero(np.isclose(nodes[:, 1], y)))]
        lines += ["*SURFACE, NAME=LOW", f"ELOW, {faces[0]}", "*SURFACE, NAME=UP", f"EUP, {faces[1]}"]
        lines += interface(below, above) if interface else []
        return [*lines, "*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1."]

    def loads(frame: Frame) -> Lines:
        if not damage:
            return forces(frame, "TOP", np.array([0.5, 2.0, -0.4]), dimension)
        # beyond the onset of damage, before failure
        moved = frame.vector(np.array([0.002, 0.02, -0.004]))[:dimension]
        return ["*BOUNDARY", *(f"{frame.set('TOP')}, {k}, {k}, {float(u)!r}" for k, u in enumerate(moved, 1))]

    return Body(
        f"{name} {dimension}D",
        part,
        ["*MATERIAL, NAME=M", *ISOTROPIC, "*DENSITY", "2.", *data],
        lambda frame: ["*BOUNDARY", f"{frame.set('BOTTOM')}, 1, {dimension}"],
        loads,
        dimension,
        turns=AXIS if dimension == 3 else UP,
        linear=linear,
        nlgeom=nlgeom,
        joint=joint,
        pressure="P2",
    )


def _tie(frame: Frame) -> Lines:
    return ["*TIE, NAME=JOIN", f"{frame.set('UP')}, {frame.set('LOW')}"]


def _contact(*options: str) -> Write:
    def write(frame: Frame) -> Lines:
        pair = ", ".join(["*CONTACT PAIR, INTERACTION=JOIN", *options])
        return [pair, f"{frame.set('UP')}, {frame.set('LOW')}"]

    return write


_COHESION: Final = ["*SURFACE INTERACTION, NAME=JOIN", "1.", "*COHESIVE BEHAVIOR", "5e3, 3e3, 3e3"]
_TRACTION: Final = ["*MATERIAL, NAME=COHESION", "*ELASTIC, TYPE=TRACTION", "5e3, 3e3, 3e3"]
_DAMAGE: Final = [
    *_TRACTION,
    *("*DAMAGE INITIATION, CRITERION=QUADS", "1.5, 3., 3."),
    *("*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, POWER=2.", "1., 2., 2."),
]


def _cohesive(dimension: int) -> Callable[[list[list[int]], list[list[int]]], Lines]:
    def write(below: list[list[int]], above: list[list[int]]) -> Lines:
        kind = {2: "COH2D4", 3: "COH3D8"}[dimension]
        lines = [f"*ELEMENT, TYPE={kind}, ELSET=INTERFACE"]
        for k, (low, up) in enumerate(zip(below, above, strict=True), 11):
            face = [low[3], low[2], up[1], up[0]] if dimension == 2 else [*low[4:], *up[:4]]
            lines += wrapped(k, np.array(face))
        return [*lines, "*COHESIVE SECTION, ELSET=INTERFACE, MATERIAL=COHESION, RESPONSE=TRACTION SEPARATION", "1., 1."]

    return write


_INTERFACE: Final = {
    "THICKNESS": 1.0,
    "ALPHAN": 5e3,
    "ALPHAT": 3e3,
    "SIGMAMAX": 1.5,
    "TAUMAX": 3.0,
    "GIC": 1.0,
    "GIIC": 2.0,
}
_PLY: Final = {"E1": 1000.0, "E2": 1000.0, "E3": 1000.0, "NU12": 0.3, "NU13": 0.3, "NU23": 0.3}
_PLY_SHEAR: Final = {"G12": 1000.0 / 2.6, "G13": 1000.0 / 2.6, "G23": 1000.0 / 2.6}


def _user(jtype: int) -> Callable[[list[list[int]], list[list[int]]], Lines]:
    """Elements of the project between the blocks."""
    sides = {f"{name} {side}": v for side in ("BOTTOM", "TOP") for name, v in (_PLY | _PLY_SHEAR).items()}
    properties = _INTERFACE | sides | {"LAW": 2, "ETA": 2.0, "CLOSURE": 3, "PLANE": 1}
    if jtype in (4, 8):
        # zeros are the recommendation
        properties |= {"ALPHAN": 0.0, "ALPHAT": 0.0}

    def write(below: list[list[int]], above: list[list[int]]) -> Lines:
        lines = [*user_element(jtype), f"*ELEMENT, TYPE=U{jtype}, ELSET=INTERFACE"]
        for k, (low, up) in enumerate(zip(below, above, strict=True), 11):
            plane = len(low) == QUAD
            face = [low[3], low[2], up[1], up[0]] if plane else [*low[4:], *up[:4]]
            lines += wrapped(k, np.array(face if jtype in (2, 7) else [*low, *up]))
        return [*lines, *uel_property(jtype, "INTERFACE", properties)]

    return write


QUAD: Final = 4


def joints() -> Iterator[Body]:
    """Two blocks with each kind of joint."""
    for dimension in (2, 3):
        yield joined("*TIE", dimension, joint=_tie)
        built_in, *user = {2: ("COH2D4", 2, 4), 3: ("COH3D8", 7, 8)}[dimension]
        yield joined(f"{built_in} elastic", dimension, interface=_cohesive(dimension), data=_TRACTION)
        for nlgeom in (False, True):
            large = ", NLGEOM" if nlgeom else ""
            softening = partial(joined, dimension=dimension, linear=False, nlgeom=nlgeom, damage=True)
            yield softening(f"{built_in}{large}", interface=_cohesive(dimension), data=_DAMAGE)
            for jtype in user:
                yield softening(f"U{jtype}{large}", interface=_user(jtype))
            bonded = partial(joined, dimension=dimension, linear=False, nlgeom=nlgeom, data=_COHESION)
            for sliding in ("SMALL SLIDING", "TYPE=SURFACE TO SURFACE"):
                yield bonded(f"*COHESIVE BEHAVIOR, {sliding}{large}", joint=_contact(sliding))


def driven(name: str, dimension: int, joint: Write, *, nlgeom: bool = False) -> Body:
    """A patch of solids whose right end moves with a reference node, which forces and moments act on."""
    kind = {2: "CPE4", 3: "C3D8"}[dimension]
    base = solid(kind, CONTINUUM[kind], "isotropic")

    def part(frame: Frame) -> Lines:
        end = frame.own(np.array([1.2, 0.6, 0.4 if dimension == 3 else 0.0]))
        lines = [*base.part(frame), "*NODE, NSET=REF", f"900, {numbers(end[:dimension])}"]
        lines += ["*SURFACE, NAME=END, TYPE=NODE", "RIGHT"]
        return lines

    def loads(frame: Frame) -> Lines:
        force, moment = frame.vector(_FORCE), frame.vector(np.array([0.02, 0.03, -0.05]))
        ref = frame.set("REF")
        if dimension == 2:
            return ["*CLOAD", f"{ref}, 1, {float(force[0])!r}", f"{ref}, 2, {float(force[1])!r}", f"{ref}, 6, 0.05"]
        components = enumerate(np.concatenate([force, moment]), 1)
        return ["*CLOAD", *(f"{ref}, {k}, {float(f)!r}" for k, f in components)]

    title = f"{name}{', NLGEOM' if nlgeom else ''} {dimension}D"
    return replace(base, name=title, part=part, loads=loads, joint=joint, nlgeom=nlgeom, linear=not nlgeom, mass=False)


def _coupling(kind: str) -> Write:
    def write(frame: Frame) -> Lines:
        surface = f"SURFACE={frame.set('END')}"
        return [f"*COUPLING, CONSTRAINT NAME=C, REF NODE={frame.set('REF')}, {surface}", kind]

    return write


def _mpc(kind: str) -> Write:
    return lambda frame: ["*MPC", f"{kind}, {frame.set('RIGHT')}, {frame.set('REF')}"]


def _rigid(frame: Frame) -> Lines:
    return [f"*RIGID BODY, REF NODE={frame.set('REF')}, TIE NSET={frame.set('RIGHT')}"]


def constraints() -> Iterator[Body]:
    """A body whose end is driven by each kind of constraint."""
    kinds = {
        "*COUPLING, KINEMATIC": _coupling("*KINEMATIC"),
        "*COUPLING, DISTRIBUTING": _coupling("*DISTRIBUTING"),
        "*MPC, BEAM": _mpc("BEAM"),
        "*RIGID BODY": _rigid,
    }
    for dimension in (2, 3):
        for name, joint in kinds.items():
            for nlgeom in (False, True):
                yield driven(name, dimension, joint, nlgeom=nlgeom)


_PROFILES: Final = {
    2: (("RECT", "0.1, 0.2"), ("CIRC", "0.1")),
    3: (("RECT", "0.1, 0.2"), ("CIRC", "0.1"), ("PIPE", "0.1, 0.01"), ("BOX", "0.2, 0.3, 0.02, 0.02, 0.02, 0.02")),
}


def bodies() -> Iterator[Body]:
    """All bodies: each built-in type with each kind of material, and what joins two of them."""
    solids = CONTINUUM | COUPLED | PIEZOELECTRIC | GENERALISED | CONTINUUM_SHELL
    for name, kind in solids.items():
        for material in MATERIALS:
            # plane stress alone takes a lamina
            if material != "lamina" or name.startswith("CPS"):
                yield solid(name, kind, material)
        yield solid(name, kind, "orthotropic", temperature=True)
    for name, kind in HEAT.items():
        yield solid(name, kind, "isotropic")
    for name, kind in SHELL.items():
        for material in ("isotropic", "lamina", "plastic"):
            yield shell(name, kind, material)
    for name, kind in MEMBRANE.items():
        for material in ("isotropic", "lamina", "plastic"):
            yield membrane(name, kind, material)
    for name, kind in BEAM.items():
        for profile, dimensions in _PROFILES[kind.dimension]:
            yield beam(name, kind, profile, dimensions)
    yield from (truss(dimension) for dimension in (2, 3))
    yield from joints()
    yield from constraints()
