# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties of the elements that are inserted: given by name, or those of the solids that an element owns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from harness.deck.error_report import Problems, nearest
from harness.deck.materials import read_materials
from harness.deck.orientations import read_orientations
from harness.delamination.blocks import Interface, traction_material, traction_section
from harness.delamination.kernels import uel_property, user_element
from harness.delamination.materials import Cohesive
from harness.errors import UsageError
from harness.insertion.assembly import Deck
from harness.insertion.connectivity import InterfaceType, known_types
from harness.model.arrays import FloatArray
from harness.model.element_types import BUILT_IN, ContinuumType, Tensor
from harness.model.properties import ElasticType, Material
from harness.usersub.layout import check_law_uses, element_layouts

_LAW = ("SIGMAMAX", "TAUMAX", "GIC", "GIIC")
_OF_ABAQUS = ("THICKNESS", "ALPHAN", "ALPHAT", *_LAW, "VISCOSITY", "ETA", "POWER")
_PARALLEL = 1e-4
"""Largest angle in radians between the third axis of a ply and the normal of the interface."""


def read_values(words: Sequence[str]) -> dict[str, float]:
    """Values by name from NAME=VALUE; an underscore stands for a blank. Raises UsageError."""
    values: dict[str, float] = {}
    for word in words:
        name, _, text = word.partition("=")
        name = " ".join(name.replace("_", " ").upper().split())
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise UsageError(f"{word}: expected NAME=VALUE with a number")
        if name in values:
            raise UsageError(f"{name} is given twice")
        values[name] = value
    return values


def names_of(kind: InterfaceType) -> tuple[str, ...]:
    """Names of the properties of a type."""
    if not kind.jtype:
        return tuple(name for name in _OF_ABAQUS if name != "THICKNESS" or kind.dimension == 2)
    layout = element_layouts()[kind.jtype]
    return tuple(item.name for item in (*layout.reals, *layout.integers))


def check_values(kind: InterfaceType, values: Mapping[str, float]) -> None:
    """UsageError for a name that the type does not have, a law that is not complete, or a value out of its range."""
    known = names_of(kind)
    for name in values:
        if name not in known:
            raise UsageError(f"{kind.name} has no property {name} (it has: {', '.join(known)}){nearest(name, known)}")
    needed = _LAW if kind.solid else ("ALPHAN", *_LAW)
    missing = [name for name in needed if name not in values]
    if missing:
        owners = ", ".join(each.name for each in known_types().values() if each.solid)
        why = f": a stiffness, which only {owners} can do without, between quads and bricks" * ("ALPHAN" in missing)
        raise UsageError(f"{kind.name} needs {', '.join(f'{name}=VALUE' for name in missing)}{why}")
    for name in (*needed, "THICKNESS"):
        if values.get(name, 1.0) <= 0.0 and not (kind.solid and name == "ALPHAN"):
            raise UsageError(f"{name}={values[name]:g}: expected a value above 0")
    if kind.jtype:
        check_law_uses(kind.jtype, values, _law_of(values))


def _law_of(given: Mapping[str, float]) -> int:
    """LAW, if it is not given: a mixed mode criterion with an exponent needs the law that has one."""
    return int(given.get("LAW", 2 if given.get("ETA") or given.get("POWER") else 1))


@dataclass(frozen=True, slots=True)
class Side:
    """What the solids of a section give an interface next to them.

    thickness  out of the plane; None if it is not known
    plane      0 plane stress, 1 plane strain; None in space
    constants  elastic constants by name (E1, NU12, G12, ...), with ANGLE; {} if they are not known
    why        why they are not known
    """

    thickness: float | None
    plane: int | None
    constants: Mapping[str, float]
    why: str


class Sections:
    """Thickness, state of stress and elastic constants of the sections of a deck."""

    def __init__(self, deck: Deck) -> None:
        problems = Problems()
        self._deck = deck
        self._materials = read_materials(deck.structure.root, problems)
        self._orientations = read_orientations(deck.flat, problems)
        problems.check()

    def side(self, section: int, solid: int, normals: FloatArray) -> Side:
        """What a section gives.

        Parameters
        ----------
        section
            Its number, -1 for none.
        solid
            A solid that has it.
        normals
            (faces, 3) unit normals of the interface there.
        """
        kind = BUILT_IN.get(self._deck.run_of(solid)[0].run.type.name)
        plane = _PLANES[kind.tensor] if isinstance(kind, ContinuumType) else None
        if section < 0:
            return Side(None, plane, {}, f"element {self._deck.name(solid)} has no section")
        owner, block = self._deck.section_blocks[section]
        if block.name != "SOLID SECTION" or not isinstance(kind, ContinuumType):
            return Side(None, plane, {}, f"those of *{block.name} ({block.source}) are not known")
        row = next(block.rows(), None)
        thickness = (row.real(0, "thickness", 1.0) if row else 1.0) or 1.0
        name, why = block.options.text("ORIENTATION"), f"(*SOLID SECTION at {block.source})"
        orientation = self._orientations[owner.name].get(name)
        if name and orientation is None:
            return Side(thickness, plane, {}, f"unknown orientation {name} {why}")
        if orientation is not None and orientation.system is not None:
            return Side(thickness, plane, {}, f"orientation {name} differs from point to point {why}")
        axes = np.eye(3) if orientation is None else orientation.axes
        try:
            material = self._materials.get(block.options.text("MATERIAL"))
            return Side(thickness, plane, _constants(material, kind.dimension, axes, normals), "")
        except ValueError as error:
            return Side(thickness, plane, {}, f"{error} {why}")


_PLANES = {Tensor.PLANE_STRESS: 0, Tensor.PLANE_STRAIN: 1, Tensor.SOLID: None}


def _constants(material: Material | None, dimension: int, axes: FloatArray, normals: FloatArray) -> dict[str, float]:
    """Elastic constants in the axes of an element that owns the solid; ValueError says why they are not known."""
    elastic = material.elastic if material else None
    if material is None or elastic is None:
        raise ValueError("the section's material has no *ELASTIC")
    if elastic.table is not None:
        raise ValueError(f"material {material.name} depends on temperature or fields")
    match elastic.type:
        case ElasticType.ISOTROPIC:
            young, ratio = elastic.constants[:2]
            moduli, ratios, shear = (young,) * 3, (ratio,) * 3, (young / (2.0 * (1.0 + ratio)),) * 3
            # its axes do not matter
            axes, normals = np.eye(3), np.eye(3)[2:]
        case ElasticType.LAMINA:
            e1, e2, nu12, *g = elastic.constants
            # plane stress has no use for the constants along the third axis
            moduli, ratios, shear = (e1, e2, 0.0), (nu12, 0.0, 0.0), (g[0], g[1], g[2])
        case ElasticType.ENGINEERING_CONSTANTS:
            c = elastic.constants
            moduli, ratios, shear = (c[0], c[1], c[2]), (c[3], c[4], c[5]), (c[6], c[7], c[8])
        case _:
            raise ValueError(f"material {material.name} has *ELASTIC, TYPE={elastic.type.value}")
    if dimension == 3:
        order, angle = _ply(axes, normals)
        moduli, ratios, shear = _renamed(order, moduli, ratios, shear)
    elif abs(axes[2, 2]) < 1.0 - _PARALLEL:
        raise ValueError("the third axis of the orientation is not normal to the plane")
    else:
        angle = math.degrees(math.atan2(axes[0, 1], axes[0, 0]))
    values = (*moduli, *ratios, *shear, angle)
    return dict(zip(_NAMES, values, strict=True))


_NAMES = ("E1", "E2", "E3", "NU12", "NU13", "NU23", "G12", "G13", "G23", "ANGLE")
Three = tuple[float, float, float]


def _along(normal: FloatArray) -> FloatArray:
    """Axes s, t, n at a face: s is the projection of x, or of z where x is within 0.1 degrees of n."""
    beside = np.array([1.0, 0.0, 0.0])
    if abs(normal[0]) > math.cos(math.radians(0.1)):
        beside = np.array([0.0, 0.0, 1.0])
    s = beside - (beside @ normal) * normal
    s /= np.linalg.norm(s)
    return np.stack([s, np.cross(normal, s), normal])


def _ply(axes: FloatArray, normals: FloatArray) -> tuple[list[int], float]:
    """Which of the axes is the third one of a ply along the faces, after the others, and the angle of the first."""
    third = int(np.argmax(np.abs(axes @ normals[0])))
    if np.any(np.abs(normals @ axes[third]) < math.cos(_PARALLEL)):
        raise ValueError("no axis of the material is normal to the whole interface")
    order = [axis for axis in range(3) if axis != third] + [third]
    s, t, _ = _along(normals[0])
    return order, round(math.degrees(math.atan2(axes[order[0]] @ t, axes[order[0]] @ s)), 9) + 0.0


def _renamed(order: list[int], moduli: Three, ratios: Three, shear: Three) -> tuple[Three, Three, Three]:
    """Constants with the axes in another order: nu_ij is nu_ji E_i/E_j."""
    pairs = {(0, 1): 0, (0, 2): 1, (1, 2): 2}
    new = [(order[i], order[j]) for i, j in pairs]
    renamed = [ratios[pairs[i, j]] if i < j else ratios[pairs[j, i]] * moduli[i] / moduli[j] for i, j in new]
    sheared = [shear[pairs[min(i, j), max(i, j)]] for i, j in new]
    first, second, third = (moduli[axis] for axis in order)
    return (first, second, third), (renamed[0], renamed[1], renamed[2]), (sheared[0], sheared[1], sheared[2])


def element_values(kind: InterfaceType, given: Mapping[str, float], below: Side, above: Side) -> dict[str, float]:
    """Properties of an element: given ones, then those of its solids. Raises UsageError."""
    known = names_of(kind)
    values = ({"LAW": float(_law_of(given))} if "LAW" in known else {}) | dict(given)
    if given.get("ALPHAN") and not given.get("ALPHAT"):
        values["ALPHAT"] = given["ALPHAN"]
    if "THICKNESS" in known and "THICKNESS" not in values:
        if None in (below.thickness, above.thickness) or below.thickness != above.thickness:
            raise UsageError(f"{kind.name} needs THICKNESS=VALUE: the sections on its sides give no common one")
        values["THICKNESS"] = below.thickness or 1.0
    if "PLANE" in known and "PLANE" not in values:
        if below.plane is None or below.plane != above.plane:
            raise UsageError(f"{kind.name} needs PLANE=0 (plane stress) or 1 (plane strain): its sides do not say it")
        values["PLANE"] = below.plane
    if kind.solid:
        for word, side in (("BOTTOM", below), ("TOP", above)):
            values = {f"{name} {word}": value for name, value in side.constants.items()} | values
            missing = [name for name in known if name.endswith(f" {word}") and name not in values]
            # those that may be left out are zero
            missing = [name for name in missing if name.split()[0] in ("E1", "E2", "G12")]
            if missing:
                words = ", ".join(f"{name.replace(' ', '_')}=VALUE" for name in missing)
                raise UsageError(
                    f"{kind.name} owns the solids on both sides and needs their elastic constants: {side.why}; give "
                    f"{words} and the others of {word}, or the section a material with *ELASTIC"
                )
    return {name: value for name, value in values.items() if name in known}


def property_lines(kind: InterfaceType, elset: str, material: str, values: Mapping[str, float]) -> list[str]:
    """The keyword that gives elements of a set their properties, with their names as comments."""
    if kind.jtype:
        return uel_property(kind.jtype, elset, values)
    return traction_section(elset, material, values.get("THICKNESS"))


def definition_lines(kind: InterfaceType) -> list[str]:
    """*USER ELEMENT of a type of the project; nothing for those of Abaqus."""
    if not kind.jtype:
        return []
    return user_element(kind.jtype)


def material_lines(kind: InterfaceType, name: str, values: Mapping[str, float]) -> list[str]:
    """Material and section controls of elements of Abaqus, which belong to no part; nothing for the project's own."""
    if kind.jtype:
        return []
    stiffness = values["ALPHAN"]
    law = Cohesive(stiffness, values["ALPHAT"], *(values[each] for each in _LAW))
    numbers = (values.get(each, 0.0) for each in ("VISCOSITY", "ETA", "POWER"))
    viscosity, eta, power = numbers
    return traction_material(name, Interface(kind.name, law, viscosity=viscosity, eta=eta, power=power))
