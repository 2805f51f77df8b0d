# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Thickness, state of stress, formulation and constants of the solids at each face.

The axes of the plies of an element that owns its solids are given by an angle: in the plane from x, in space from the
direction s about the normal of the interface, the projection of a reference direction (`directions.py`). Where an
*ORIENTATION varies, as in curved laminates, the angle is that at the centre of each face, with one set of properties
per angle. Angles are modulo 180 degrees, since the materials are
orthotropic. In layered solids the layer at the interface counts.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uel.deck.contact.interactions import Interactions
from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.materials.material import read_materials
from uel.deck.mesh.flatten import Owner
from uel.deck.mesh.orientations import read_orientations
from uel.deck.sections.controls import read_section_controls
from uel.deck.sections.solids import make_section
from uel.deck.sections.user_elements import ElementType
from uel.elements.families.composite import turned_directions
from uel.elements.interfaces.neighbour_plies import STACK_FACES
from uel.elements.interfaces.neighbour_solids import OBLIQUE, constant_expansion, formulation_of
from uel.errors import DeckError, Source
from uel.insertion.assembly import Deck
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import BUILT_IN, ContinuumType, Tensor
from uel.model.face_directions import face_directions
from uel.model.orientation_axes import SystemKind, UndefinedDirectionsError
from uel.model.properties import CompositeSection, ElasticType, Material, Orientation, SolidLayer, SolidSection

PARALLEL = 1e-4
"""Angle (rad) between a material axis and the normal of the interface that is rounding."""
_DECIMALS = 4
"""Decimals of angles in degrees, the accuracy of coordinates with seven digits."""
_PLANES = {Tensor.PLANE_STRESS: 0, Tensor.PLANE_STRAIN: 1, Tensor.SOLID: None}
_NAMES = (
    *("E1", "E2", "E3", "NU12", "NU13", "NU23", "G12", "G13", "G23"),
    *("EXPANSION1", "EXPANSION2", "EXPANSION3"),
)


@dataclass(frozen=True, slots=True)
class Side:
    """Data of the solids on one side of an interface.

    thickness    out of the plane; None if unknown
    plane        0 plane stress, 1 plane strain; None in space
    constants    constants of the material by name (E1, NU12, G12, EXPANSION1, ...), with ANGLE; {} if unknown
    why          reason for unknown constants
    location     of the section in the deck, '' without one
    formulation  of the solids, a value of FORMULATION BOTTOM or TOP
    """

    thickness: float | None
    plane: int | None
    constants: Mapping[str, float]
    why: str
    location: str = ""
    formulation: int = 0


@dataclass(frozen=True, slots=True)
class Faces:
    """Faces of the solids on one side of an interface.

    numbers     (k,) numbers of the faces in `Solids`
    normals     (k, 3) unit normals of the interface, from below to above
    directions  (k, 3) reference directions for the angles of plies, zero for x
    above       whether the faces are those of the solids above
    """

    numbers: IntArray
    normals: FloatArray
    directions: FloatArray
    above: bool

    def take(self, rows: IntArray) -> Faces:
        """Select some of the faces."""
        return Faces(self.numbers[rows], self.normals[rows], self.directions[rows], self.above)


Three = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class _Moduli:
    """Moduli along the axes of a material, contraction ratios (12, 13, 23), shear moduli (12, 13, 23), expansion."""

    young: Three
    ratios: Three
    shear: Three
    expansion: Three

    @property
    def isotropic(self) -> bool:
        """Whether the material is isotropic."""
        e, nu, g = self.young[0], self.ratios[0], self.shear[0]
        alike = self.young == (e,) * 3 and self.ratios == (nu,) * 3 and self.shear == (g,) * 3
        alike = alike and self.expansion == (self.expansion[0],) * 3
        return alike and math.isclose(g, e / (2.0 * (1.0 + nu)), rel_tol=1e-12)

    def renamed(self, order: tuple[int, ...]) -> _Moduli:
        """Return the moduli with permuted axes: nu_ij = nu_ji E_i/E_j."""
        pairs = {(0, 1): 0, (0, 2): 1, (1, 2): 2}
        new = [(order[i], order[j]) for i, j in pairs]
        ratios = [
            self.ratios[pairs[i, j]] if i < j else self.ratios[pairs[j, i]] * self.young[i] / self.young[j]
            for i, j in new
        ]
        shear = [self.shear[pairs[min(i, j), max(i, j)]] for i, j in new]
        first, second, third = (self.young[axis] for axis in order)
        along, across, normal = (self.expansion[axis] for axis in order)
        return _Moduli(
            (first, second, third),
            (ratios[0], ratios[1], ratios[2]),
            (shear[0], shear[1], shear[2]),
            (along, across, normal),
        )

    def named(self, angle: float) -> dict[str, float]:
        """Return the properties by name."""
        values = (*self.young, *self.ratios, *self.shear, *self.expansion)
        return dict(zip(_NAMES, values, strict=True)) | {"ANGLE": angle}


class Sections:
    """Sections of the solids of a deck."""

    def __init__(self, deck: Deck) -> None:
        self._problems = Problems()
        self._deck = deck
        root = deck.structure.root
        without = Interactions(root, self._problems).without_options(root)
        self._materials = read_materials(without, deck.structure, self._problems)
        self._orientations = read_orientations(deck.flat, self._problems)
        self._controls = read_section_controls(root, self._problems)
        self._problems.check()
        self._made: dict[tuple[int, str], SolidSection | CompositeSection | str] = {}
        self._oblique: dict[Source, str] = {}

    @property
    def warnings(self) -> list[str]:
        """Warnings about sections."""
        return list(self._oblique.values())

    def section(self, number: int, type: ElementType) -> SolidSection | CompositeSection | str:
        """Return the section of solids of a type, by its number in the deck; or the reason why it is unknown."""
        key = number, type.name
        if key not in self._made:
            self._made[key] = self._make(number, type)
        return self._made[key]

    def _make(self, number: int, type: ElementType) -> SolidSection | CompositeSection | str:
        owner, block = self._deck.section_blocks[number]
        if block.name != "SOLID SECTION" or not isinstance(BUILT_IN.get(type.name), ContinuumType):
            return f"those of *{block.name} ({block.source}) are not known"
        try:
            made = make_section(
                block, type, self._materials, self._orientations[owner.name], self._controls, self._problems
            )
        except DeckError as error:
            return str(error)
        assert isinstance(made, SolidSection | CompositeSection)
        return made

    def kinds(self, faces: IntArray) -> Iterator[tuple[int, ElementType, IntArray]]:
        """Yield section (-1: none), element type and rows of faces (k,) of each pair of these."""
        deck = self._deck
        numbers = deck.solids.element[faces]
        pairs = np.column_stack([deck.sections[numbers], deck.run_index[numbers]])
        unique_pairs, which = np.unique(pairs, axis=0, return_inverse=True)
        rows: dict[tuple[int, ElementType], list[IntArray]] = {}
        for index, (section, run) in enumerate(unique_pairs.tolist()):
            rows.setdefault((section, deck.runs[run].run.type), []).append(np.flatnonzero(which.ravel() == index))
        for (section, type), row_sets in rows.items():
            yield section, type, np.sort(np.concatenate(row_sets))

    def sides(self, faces: Faces) -> tuple[list[Side], IntArray]:
        """Return the distinct sides of faces, and the index (k,) of the side of each face."""
        unique_sides: list[Side] = []
        which = np.zeros(len(faces.numbers), dtype=np.int64)
        for section, type, rows in self.kinds(faces.numbers):
            kind = BUILT_IN.get(type.name)
            formulation = formulation_of(kind) if isinstance(kind, ContinuumType) else 0
            for side, inside in self._sides_of(section, type, faces.take(rows)):
                which[rows[inside]] = len(unique_sides)
                unique_sides.append(replace(side, formulation=formulation))
        return unique_sides, which

    def _sides_of(self, number: int, type: ElementType, faces: Faces) -> Iterator[tuple[Side, IntArray]]:
        """Yield the sides of the faces of solids of a section and a type, each with its rows."""
        kind = BUILT_IN.get(type.name)
        plane = _PLANES[kind.tensor] if isinstance(kind, ContinuumType) else None
        every = np.arange(len(faces.numbers))
        if number < 0:
            why = f"element {self.name(faces, 0)} has no section"
            yield Side(None, plane, {}, why), every
            return
        owner, block = self._deck.section_blocks[number]
        section = self.section(number, type)
        thickness = _thickness(block)
        if isinstance(section, str):
            yield Side(thickness, plane, {}, section, str(block.source)), every
            return
        location = f"(*SOLID SECTION at {block.source})"
        for layer, rows in self._layers(section, faces):
            if layer is None:
                why = f"the interface runs across the layers of element {self.name(faces, int(rows[0]))} {location}"
                yield Side(thickness, plane, {}, why, str(block.source)), rows
                continue
            try:
                for constants, inside in self._constants(owner, section, layer, faces.take(rows)):
                    yield Side(thickness, plane, constants, "", str(block.source)), rows[inside]
            except ValueError as error:
                yield Side(thickness, plane, {}, f"{error} {location}", str(block.source)), rows

    def stress_axes(self, number: int, section: SolidSection, faces: Faces) -> FloatArray:
        """Return the directions (k, 3, 3), in rows, in which solids have their initial stress. Raises DeckError."""
        owner, block = self._deck.section_blocks[number]
        try:
            return self._axes(owner, section, SolidLayer(1.0, 1, section.material, section.orientation), faces)
        except ValueError as error:
            raise block.error(str(error)) from None

    def name(self, faces: Faces, row: int) -> str:
        """Return the name of the solid of a face."""
        return self._deck.name(int(self._deck.solids.element[faces.numbers[row]]))

    def polar_axes(self, faces: Faces) -> FloatArray:
        """Return the axes (k, 3) of the cylinders along which the plies at faces have their directions.

        Zero where there is none: no cylindrical *ORIENTATION, isotropic or unknown constants.
        """
        found = np.zeros_like(faces.normals)
        for owner, _, layer, rows in self._plies(faces):
            orientation = layer.orientation
            if orientation is None or orientation.system is None:
                continue
            if orientation.system.kind is not SystemKind.CYLINDRICAL:
                continue
            # without the additional rotation axis 3 is that of the cylinder
            plain = replace(orientation, system=replace(orientation.system, angle=0.0))
            with contextlib.suppress(ValueError):  # said where the angles are needed
                found[rows] = self._local_axes(owner, plain, faces.take(rows))[:, 2]
        return found

    def plane_axes(self, faces: Faces) -> FloatArray:
        """Return an axis (k, 3), in the plane of the ply, of the material at each face.

        Zero where its directions vary, or are of no importance or unknown: isotropic or unknown constants.
        """
        found = np.zeros_like(faces.normals)
        for owner, section, layer, rows in self._plies(faces):
            if layer.orientation is not None and layer.orientation.system is not None:
                continue
            with contextlib.suppress(ValueError):
                axes = self._axes(owner, section, layer, faces.take(rows))
                across = np.abs(np.einsum("kad,kd->ka", axes, faces.normals[rows]))
                first = np.array([1, 0, 0])[across.argmax(axis=1)]
                found[rows] = np.take_along_axis(axes, first[:, None, None], axis=1)[:, 0]
        return found

    def stays(self, faces: Faces, directions: FloatArray) -> NDArray[np.bool_]:
        """Return the mask of faces whose direction (k, 3) is the same in all instances of their part."""
        deck = self._deck
        numbers = deck.positions[deck.solids.element[faces.numbers]]
        same = np.ones(len(numbers), dtype=np.bool_)
        for owner in deck.first.values():
            inside = (numbers >= owner.element_offset) & (numbers < owner.element_offset + len(owner.elements))
            for other in self._others(owner):
                moved = directions[inside] @ _turn(owner, other).T
                same[inside] &= np.linalg.norm(np.cross(directions[inside], moved), axis=1) < math.sin(PARALLEL)
        return same

    def _others(self, owner: Owner) -> Iterator[Owner]:
        """Yield the other instances of the part of an instance."""
        part = self._deck.part_of.get(owner.name)
        for other in self._deck.owners:
            if part is not None and other is not owner and self._deck.part_of.get(other.name) == part:
                yield other

    def _plies(self, faces: Faces) -> Iterator[tuple[Owner, SolidSection | CompositeSection, SolidLayer, IntArray]]:
        """Yield the anisotropic plies with known constants at faces, each with its rows."""
        for number, type, rows in self.kinds(faces.numbers):
            section = self.section(number, type) if number >= 0 else ""
            if isinstance(section, str):
                continue
            for layer, inside in self._layers(section, faces.take(rows)):
                if layer is not None and _has_directions(layer.material):
                    yield self._deck.section_blocks[number][0], section, layer, rows[inside]

    def _layers(
        self, section: SolidSection | CompositeSection, faces: Faces
    ) -> Iterator[tuple[SolidLayer | None, IntArray]]:
        """Yield the layer of a solid at each face, None where the face crosses the layers."""
        if isinstance(section, SolidSection):
            yield SolidLayer(1.0, 1, section.material, section.orientation), np.arange(len(faces.numbers))
            return
        first, last = STACK_FACES[section.direction]
        side = self._deck.solids.side[faces.numbers]
        for layer, rows in (
            (section.layers[0], side == first),
            (section.layers[-1], side == last),
            (None, (side != first) & (side != last)),
        ):
            if rows.any():
                yield layer, np.flatnonzero(rows)

    def _constants(
        self, owner: Owner, section: SolidSection | CompositeSection, layer: SolidLayer, faces: Faces
    ) -> Iterator[tuple[dict[str, float], IntArray]]:
        """Yield the elastic constants of a layer in the axes of its interface element, each with its rows.

        Raises ValueError if they are unknown.
        """
        moduli = _moduli(layer.material)
        if moduli.isotropic:
            yield moduli.named(0.0), np.arange(len(faces.numbers))
            return
        orders, angles = self._angles(owner, section, layer, faces)
        self._check_instances(owner, section, layer, faces, angles)
        unique_axes, which = np.unique(np.column_stack([orders, angles]), axis=0, return_inverse=True)
        for index, (*order, angle) in enumerate(unique_axes.tolist()):
            renamed = moduli.renamed(tuple(map(int, order)))
            yield renamed.named(angle + 0.0), np.flatnonzero(which.ravel() == index)

    def _check_instances(
        self,
        owner: Owner,
        section: SolidSection | CompositeSection,
        layer: SolidLayer,
        faces: Faces,
        angles: FloatArray,
    ) -> None:
        """Raise DeckError if the ply angles of the instances of a part differ."""
        deck = self._deck
        for other in self._others(owner):
            moved = replace(faces, normals=faces.normals @ _turn(owner, other).T)
            here = self._orientations[other.name]
            orientation = layer.orientation and here.get(layer.orientation.name, layer.orientation)
            placed = SolidLayer(layer.thickness, layer.points, layer.material, orientation, layer.angle)
            _, others = self._angles(other, section, placed, moved)
            difference = np.abs((others - angles + 90.0) % 180.0 - 90.0)
            if (difference > 10.0**-_DECIMALS * 2).any():
                row = int(np.argmax(difference))
                raise deck.structure.instances[other.name].head.error(
                    f"instance {other.name} is turned against {owner.name}, so the plies at element "
                    f"{self.name(faces, row)} have the angle {others[row]:g} in {other.name} and "
                    f"{angles[row]:g} in {owner.name}, for which a part has one *UEL PROPERTY: give each its own part"
                )

    def _angles(
        self, owner: Owner, section: SolidSection | CompositeSection, layer: SolidLayer, faces: Faces
    ) -> tuple[IntArray, FloatArray]:
        """Return the order (k, 3) of the material axes, the normal one last, and the angle (k,) of the first."""
        axes = self._axes(owner, section, layer, faces)
        if self._deck.solids.cells[0].family.dimension == 2:
            if np.any(np.abs(axes[:, 2, 2]) < math.cos(PARALLEL)):
                raise ValueError("the third axis of the orientation is not normal to the plane")
            return np.tile(np.arange(3), (len(axes), 1)), _half_turn(np.arctan2(axes[:, 0, 1], axes[:, 0, 0]))
        across = np.abs(np.einsum("kad,kd->ka", axes, faces.normals))
        third = across.argmax(axis=1)
        self._check_normal(across.max(axis=1), faces, section)
        orders = np.array([[1, 2, 0], [0, 2, 1], [0, 1, 2]])[third]
        first = np.take_along_axis(axes, orders[:, :1, None], axis=1)[:, 0]
        s, t = face_directions(faces.normals, faces.directions)
        return orders, _half_turn(np.arctan2(np.sum(first * t, axis=1), np.sum(first * s, axis=1)))

    def _check_normal(self, cosines: FloatArray, faces: Faces, section: SolidSection | CompositeSection) -> None:
        """Raise ValueError unless a material axis is normal to the interface."""
        tilt = np.degrees(np.arccos(np.minimum(cosines, 1.0)))
        row = int(tilt.argmax())
        where = f"at element {self.name(faces, row)} the closest one is {tilt[row]:.3g} degrees off"
        if tilt[row] > OBLIQUE:
            raise ValueError(f"no axis of the material is normal to the whole interface: {where}")
        if tilt[row] > math.degrees(PARALLEL):
            text = f"{section.source}: the axis across the ply is not quite normal to the interface: {where}"
            self._oblique.setdefault(section.source, text)

    def _axes(
        self, owner: Owner, section: SolidSection | CompositeSection, layer: SolidLayer, faces: Faces
    ) -> FloatArray:
        """Return the material axes (k, 3, 3), in rows, at the centres of faces of an instance."""
        deck, orientation = self._deck, layer.orientation
        shape = len(faces.numbers), 3, 3
        if orientation is None:
            return np.broadcast_to(np.eye(3), shape)
        if orientation.system is None:
            axes = np.broadcast_to(orientation.axes, shape)
        else:
            axes = self._local_axes(owner, orientation, faces)
        if layer.angle is None:
            return axes
        # stack direction: from the first layer to the last
        last = deck.solids.side[faces.numbers] == STACK_FACES[_direction_of(section)][1]
        outward = -faces.normals if faces.above else faces.normals
        upright = np.where(last[:, None], outward, -outward)
        try:
            return turned_directions(layer, axes[:, None], upright[:, None])[:, 0]
        except UndefinedDirectionsError as error:
            name = self.name(faces, error.row[0])
            raise ValueError(f"orientation {orientation.name}: {error}; it is not in element {name}") from None

    def _local_axes(self, owner: Owner, orientation: Orientation, faces: Faces) -> FloatArray:
        """Return the axes of an orientation that varies in space."""
        deck, system = self._deck, orientation.system
        assert system is not None
        if system.kind is SystemKind.USER:
            raise ValueError(f"orientation {orientation.name} is that of ORIENT")
        solids = deck.solids
        first = deck.first[deck.part_of.get(owner.name, "")]
        numbers = solids.element[faces.numbers]
        group = next(group for group in solids.cells if group.family.number == solids.families[numbers[0]])
        nodes = group.nodes[np.searchsorted(group.numbers, numbers)] - first.node_offset
        if system.nodes and max(system.nodes) > nodes.shape[1]:
            raise ValueError(f"orientation {orientation.name}: local node {max(system.nodes)} of {nodes.shape[1]}")
        points = deck.flat.mesh.coordinates
        corners = solids.nodes[faces.numbers, : int(solids.corners[faces.numbers[0]])] - first.node_offset
        middles = points[corners + owner.node_offset].mean(axis=1)[:, None]
        positions = deck.positions[numbers] - first.element_offset + owner.element_offset
        try:
            return system.axes(positions, points[nodes + owner.node_offset], middles)[:, 0]
        except UndefinedDirectionsError as error:
            name = self.name(faces, error.row[0])
            raise ValueError(f"orientation {orientation.name}: element {name}: {error}") from None


def _direction_of(section: SolidSection | CompositeSection) -> int:
    assert isinstance(section, CompositeSection)  # angles are those of layers
    return section.direction


def _thickness(block: Block) -> float | None:
    """Return the out-of-plane thickness of a section keyword, None without one."""
    if block.name != "SOLID SECTION":
        return None
    row = next(block.rows(), None)
    return (row.real(0, "thickness", 1.0) if row else 1.0) or 1.0


def _turn(owner: Owner, other: Owner) -> FloatArray:
    """Return the rotation (3, 3) from an instance to another one of its part."""
    return other.placement.turn(np.eye(3)).T @ owner.placement.turn(np.eye(3))


def _has_directions(material: Material) -> bool:
    """Return whether the constants of a material are known, and differ from direction to direction."""
    try:
        return not _moduli(material).isotropic
    except ValueError:
        return False


def _moduli(material: Material) -> _Moduli:
    """Return the moduli of a material. Raises ValueError if they are unknown."""
    elastic = material.elastic
    if elastic is None:
        raise ValueError(f"material {material.name} has no *ELASTIC")
    if elastic.table is not None:
        raise ValueError(f"material {material.name} depends on temperature or fields")
    # one that takes more than three constants matters only where temperatures change: `find_faults` refuses it there
    along = constant_expansion(material)
    expansion = (0.0, 0.0, 0.0) if along is None else (float(along[0]), float(along[1]), float(along[2]))
    match elastic.type:
        case ElasticType.ISOTROPIC:
            young, ratio = elastic.constants[:2]
            return _Moduli((young,) * 3, (ratio,) * 3, (young / (2.0 * (1.0 + ratio)),) * 3, expansion)
        case ElasticType.LAMINA:
            e1, e2, nu12, *g = elastic.constants
            # plane stress does not use the constants along the third axis
            return _Moduli((e1, e2, 0.0), (nu12, 0.0, 0.0), (g[0], g[1], g[2]), expansion)
        case ElasticType.ENGINEERING_CONSTANTS:
            c = elastic.constants
            return _Moduli((c[0], c[1], c[2]), (c[3], c[4], c[5]), (c[6], c[7], c[8]), expansion)
        case _:
            raise ValueError(f"material {material.name} has *ELASTIC, TYPE={elastic.type.value}")


def _half_turn(radians: FloatArray) -> FloatArray:
    """Reduce angles to degrees above -90 and up to 90, modulo 180 degrees."""
    degrees = np.round(np.degrees(radians), _DECIMALS)
    return np.asarray(np.round(90.0 - (90.0 - degrees) % 180.0, _DECIMALS))
