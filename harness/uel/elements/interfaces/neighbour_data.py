# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties and nodes of self-contained interface elements against the solids beside them.

Those that own their solids have the formulation, the constants, the state of stress and the nodes of the solids a
second time. Nothing in Abaqus compares the two: with moduli ten times too small, tractions are halved without a word.
`uel run` knows both.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.elements.interfaces.initial_tractions import NAMES, PLANE_NAMES, InitialStresses, components
from uel.elements.interfaces.neighbour_plies import Ply, SolidFaces, plies_at, stress_axes
from uel.elements.interfaces.neighbour_solids import (
    FORMULATIONS,
    NONE,
    OBLIQUE,
    REDUCED,
    Finding,
    changed_nodes,
    constant_expansion,
    examine,
    formulation_of,
    group_starts,
    owns_solids,
    solids_of,
)
from uel.elements.interfaces.process_zone import tensor_of
from uel.elements.materials.library import global_compliance, rotated_compliance
from uel.errors import DeckError
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import ContinuumType, Tensor
from uel.model.face_directions import LEAST_DEGREES, degrees_between, face_directions
from uel.model.mesh import ElementGroup, full_name
from uel.model.model import Model
from uel.model.properties import SolidSection, UserProperty
from uel.usersub import Library
from uel.usersub.layout import element_layouts

TOLERANCE: Final = 0.01
"""Relative difference of moduli, and difference of Poisson's ratios, above which they are not the same: more than the
digits of a data sheet that two people keep."""

_CONSTANTS: Final = ("E1", "E2", "E3", "NU12", "NU13", "NU23", "G12", "G13", "G23")
_NEEDED: Final = {
    Tensor.PLANE_STRESS: ("E1", "E2", "NU12", "G12"),
    Tensor.PLANE_STRAIN: ("E1", "E2", "E3", "NU12", "NU13", "NU23", "G12"),
    Tensor.SOLID: _CONSTANTS,
}
"""Constants that an element uses, by the state of stress."""
_PLANES: Final = {Tensor.PLANE_STRESS: "plane stress", Tensor.PLANE_STRAIN: "plane strain"}
_SIDES: Final = (("BOTTOM", "below"), ("TOP", "above"))


def judge_neighbours(model: Model, library: Library) -> None:
    """Refuse self-contained interface elements that do not fit their solids, and warn of those that may not.

    Raises DeckError, whose notes have the other reasons.
    """
    if not library.is_own:
        return
    findings = [*examine(model, model.groups), *compare(model, model.groups)]
    wrong = [each for each in findings if each.wrong]
    if wrong:
        error = DeckError(wrong[0].source, wrong[0].message)
        for each in wrong[1:]:
            error.add_note(str(each))
        raise error
    for each in findings:
        library.warn(str(each))


def compare(model: Model, groups: Iterable[ElementGroup]) -> list[Finding]:
    """Compare properties and nodes of interface elements with those of their solids.

    Parameters
    ----------
    model
        The model.
    groups
        Those of its groups that are elements of the project; those that own no solids are left out.

    Returns
    -------
    list of Finding
        One of each kind for each group and side; empty where they agree.
    """
    found: list[Finding] = []
    for group in groups:
        if not owns_solids(group) or not isinstance(group.section, UserProperty):
            continue
        sides = solids_of(model, group)
        found += _along_normals(model, group)
        for side in (0, 1):
            found += _strangers(model, group, side, np.flatnonzero(sides[side] == NONE))
            for start, beside in zip(group_starts(model), model.groups, strict=True):
                rows = np.flatnonzero((sides[side] >= start) & (sides[side] < start + len(beside.labels)))
                if len(rows):
                    found += _Pair(model, group, side, rows, beside, sides[side][rows] - start).differences()
    return found


def _given(group: ElementGroup) -> dict[str, float]:
    """Return the properties by name; those that the deck leaves out are 0."""
    assert group.definition is not None and isinstance(group.section, UserProperty)
    return element_layouts()[group.definition.number].named(group.section)


def _named(model: Model, group: ElementGroup, row: int) -> str:
    return f"{group.type} element {full_name(group.instance, int(group.labels[row]))}"


def _labels(model: Model, nodes: IntArray) -> str:
    return ", ".join(str(label) for label in model.mesh.labels[nodes])


def _is_continuum(group: ElementGroup) -> bool:
    if group.definition is None:
        return isinstance(group.built_in, ContinuumType)
    layout = element_layouts().get(group.definition.number)
    return layout is not None and not layout.faces[0]


def _normals(model: Model, group: ElementGroup, rows: IntArray) -> FloatArray:
    """Return the unit normals (m, 3) in the middles of the faces of elements in space, from below to above."""
    assert group.definition is not None
    layout = element_layouts()[group.definition.number]
    corners = [group.nodes[rows][:, np.array(face[: layout.corners])] for face in layout.faces]
    middle = model.mesh.coordinates[corners[0]] + model.mesh.coordinates[corners[1]]
    # half-way along the edges of a quadrilateral, along two edges of a triangle
    last = middle[:, -1] - middle[:, 0]
    along = middle[:, 1] - middle[:, 0] + (middle[:, 2] - middle[:, 3] if layout.corners == 4 else 0.0)
    across = last + (middle[:, 2] - middle[:, 1] if layout.corners == 4 else 0.0)
    return _unit(np.cross(along, across))


def _direction(given: dict[str, float]) -> FloatArray:
    """Return the direction (3,) from which the angles of the plies are measured; zero for x."""
    return np.array([given.get(f"DIRECTION{axis}", 0.0) for axis in (1, 2, 3)])


def _along_normals(model: Model, group: ElementGroup) -> Iterator[Finding]:
    """Report the first element whose normal is so close to its direction that it refuses it."""
    direction = _direction(_given(group))
    if not direction.any():
        return
    degrees = degrees_between(_normals(model, group, np.arange(len(group.labels))), direction)
    row = int(degrees.argmin())
    if degrees[row] < LEAST_DEGREES:
        text = f"DIRECTION1 to DIRECTION3 = {', '.join(f'{value:g}' for value in direction)}"
        text += f", {degrees[row]:.3g} degrees from its normal; expected at least {LEAST_DEGREES:g}"
        yield Finding(f"{_named(model, group, row)}: {text}", group.section.source, wrong=True)


def _strangers(model: Model, group: ElementGroup, side: int, rows: IntArray) -> Iterator[Finding]:
    """Report the first element whose nodes on a side are not those of the solid there."""
    solids = [beside for beside in model.groups if _is_continuum(beside)]
    if not len(rows) or not solids:
        return
    assert group.definition is not None
    row, layout = int(rows[0]), element_layouts()[group.definition.number]
    start = side * layout.solids[0]
    own = group.nodes[row, start : start + layout.solids[side]]
    face = group.nodes[row, list(layout.faces[side])]
    word, where = _SIDES[side]
    text = f"{_named(model, group, row)}: its nodes {start + 1} to {start + len(own)} are {_labels(model, own)}"
    shared = [np.isin(beside.nodes, face).sum(axis=1) for beside in solids]
    for beside, common in zip(solids, shared, strict=True):
        if (common == len(face)).any():
            solid = int((common == len(face)).argmax())
            other = f"{_named(model, beside, solid)} {where}, on its {word.lower()} face, has"
            nodes = _labels(model, beside.nodes[solid])
            yield Finding(f"{text}, but {other} {nodes}; expected the nodes of the solid", group.source, wrong=True)
            return
    # a face on no solid is that of a rigid body
    if any(common.any() for common in shared):
        yield Finding(f"{text}, but no solid has these nodes: the meshes do not fit", group.source, wrong=False)


@dataclass(frozen=True, slots=True)
class _Pair:
    """Interface elements and the solids on one of their sides.

    rows, solids  positions in their groups, pairwise
    """

    model: Model
    group: ElementGroup
    side: int
    rows: IntArray
    beside: ElementGroup
    solids: IntArray

    def differences(self) -> Iterator[Finding]:
        """Report each kind of difference once."""
        given, section = _given(self.group), self.beside.section
        tensor = tensor_of(self.beside)
        if tensor in _PLANES and _PLANES[tensor] != list(_PLANES.values())[int(given["PLANE"])]:
            mine = list(_PLANES.values())[int(given["PLANE"])]
            yield self._finding(0, f"PLANE = {given['PLANE']:g}, {mine}", f"is in {_PLANES[tensor]}")
        thickness = section.thickness if isinstance(section, SolidSection) else None
        if isinstance(section, UserProperty) and _is_continuum(self.beside):
            thickness = _given(self.beside).get("THICKNESS")
        if tensor in _PLANES and thickness and abs(given["THICKNESS"] - thickness) > TOLERANCE * thickness:
            text = f"has a thickness of {thickness:g}"
            yield self._finding(0, f"THICKNESS = {given['THICKNESS']:g}", text, wrong=False)
        yield from self._formulation(given)
        yield from self._moduli(given)
        yield from self._initial_traction(given)

    def _formulation(self, given: dict[str, float]) -> Iterator[Finding]:
        """Compare the formulation: the stress of another one is not that of the solid, nor bounded by its energy."""
        kind = self.beside.built_in
        if isinstance(kind, ContinuumType):
            theirs = formulation_of(kind)
        else:
            theirs = int(_given(self.beside).get("FORMULATION", 0.0))
        name = f"FORMULATION {_SIDES[self.side][0]}"
        mine = int(given[name])
        if mine != theirs:
            text = f"has {FORMULATIONS[theirs]}; expected {theirs}"
            wrong = REDUCED in (mine, theirs)
            yield self._finding(0, f"{name} = {mine}, {FORMULATIONS[mine]}", text, wrong=wrong)

    def _moduli(self, given: dict[str, float]) -> Iterator[Finding]:
        """Compare elastic constants along the axes of the ply that an element has."""
        tensor = tensor_of(self.beside)
        if tensor is None:
            return
        axes = self._axes(np.radians(given[f"ANGLE {_SIDES[self.side][0]}"]), _direction(given))
        for ply in plies_at(self.model, self._faces(axes[:, 2]), tensor):
            part = replace(self, rows=self.rows[ply.rows], solids=self.solids[ply.rows])
            if ply.why:
                name = _named(self.model, self.group, int(part.rows[0]))
                solid = part._solid(0)
                message = f"{name}: its elastic constants are not compared with those of the {solid}: {ply.why}"
                yield Finding(message, self.group.section.source, wrong=False)
                continue
            found = part._constants_of(ply, axes[ply.rows], given, tensor)
            if found is not None:
                yield found
                return

    def _initial_traction(self, given: dict[str, float]) -> Iterator[Finding]:
        """Compare the traction of the initial stress of a solid."""
        start = group_starts(self.model)[next(k for k, each in enumerate(self.model.groups) if each is self.beside)]
        stresses = InitialStresses.of(self.model.initial_stresses, start + self.solids, tensor_of(self.beside))
        names = PLANE_NAMES if "PLANE" in given else NAMES
        mine = np.array([given[name] for name in names])
        if stresses.source is None and not mine.any():
            return
        normals = self._normals()
        try:
            axes = stress_axes(self.model, self._faces(normals))
        except ValueError as error:
            yield self._finding(0, "its initial traction is not known", f"has an initial stress, and {error}")
            return
        direction = None if "PLANE" in given else np.broadcast_to(_direction(given), normals.shape)
        theirs = components(stresses.tractions(axes, normals), normals, direction)
        size = max(abs(stresses.tensors).max(), abs(mine).max())
        apart = abs(theirs - mine) > TOLERANCE * size
        if apart.any():
            at = int(apart.any(axis=1).argmax())
            k = int(apart[at].argmax())
            text = f"has {theirs[at, k]:.6g} there by its initial stress"
            yield self._finding(at, f"{names[k]} = {mine[k]:g}", text)

    def _normals(self) -> FloatArray:
        """Return the unit normals (m, 3) of the elements, from below to above."""
        assert self.group.definition is not None
        layout = element_layouts()[self.group.definition.number]
        if layout.dimension == 3:
            return _normals(self.model, self.group, self.rows)
        ends = [self.model.mesh.coordinates[self.group.nodes[self.rows][:, list(face[:2])]] for face in layout.faces]
        along = ends[0][:, 1] - ends[0][:, 0] + ends[1][:, 1] - ends[1][:, 0]
        return _unit(np.stack([-along[:, 1], along[:, 0], 0.0 * along[:, 0]], axis=1))

    def _faces(self, normals: FloatArray) -> SolidFaces:
        """Return the faces of the solids at the elements."""
        assert self.group.definition is not None
        layout = element_layouts()[self.group.definition.number]
        corners = list(layout.faces[self.side][: layout.corners])
        outward = normals * (1.0 if self.side == 0 else -1.0)
        return SolidFaces(self.beside, self.solids, self.group.nodes[self.rows][:, corners], outward)

    def _constants_of(self, ply: Ply, axes: FloatArray, given: dict[str, float], solid: Tensor) -> Finding | None:
        """Compare the constants of elements, whose axes are (m, 3, 3), with those of a ply beside each of them."""
        material = ply.material
        compliance = global_compliance(material, None, solid)
        if compliance is None:
            return None
        turns = ply.axes @ np.swapaxes(axes, -1, -2)
        # those of faces of one direction differ by rounding
        _, one, numbers = np.unique(turns.round(6).reshape(-1, 9), axis=0, return_index=True, return_inverse=True)
        numbers = numbers.ravel()
        local = rotated_compliance(compliance, turns[one])
        word = _SIDES[self.side][0]
        angle = f"ANGLE {word} = {given[f'ANGLE {word}']:g}"
        plane = (Tensor.PLANE_STRESS, Tensor.PLANE_STRAIN)[int(given.get("PLANE", 0.0))]
        tensor = plane if "PLANE" in given else Tensor.SOLID
        straight = _straightened(local, tensor)
        constants, nearest = _constants(local), _constants(straight)
        for name in _NEEDED[tensor]:
            value, theirs = given[f"{name} {word}"], constants[name]
            apart = abs(value - nearest[name]) > TOLERANCE * (1.0 if name.startswith("NU") else nearest[name])
            if apart.any():
                at = int(np.flatnonzero(apart[numbers])[0])
                has = f"has {theirs[numbers[at]]:.6g} there (material {material.name})"
                return self._finding(at, f"{name} {word} = {value:g} at {angle}", has)
        different = self._expansion_of(ply, turns, given)
        if different is not None:
            return different
        turned = _is_turned(straight, tensor)
        if turned.any():
            at = int(np.flatnonzero(turned[numbers])[0])
            return self._finding(at, angle, f"has its material ({material.name}) along other axes")
        return None

    def _expansion_of(self, ply: Ply, turns: FloatArray, given: dict[str, float]) -> Finding | None:
        """Compare the expansion where temperatures change; turns: (m, 3, 3), from the element's axes to the ply's."""
        along = constant_expansion(ply.material)
        heated = np.isin(self.group.nodes[self.rows], changed_nodes(self.model)).any(axis=1)
        if along is None or not heated.any():
            return None
        word = _SIDES[self.side][0]
        theirs = np.einsum("mai,a->mi", turns**2, along)
        mine = np.array([given[f"EXPANSION{axis} {word}"] for axis in (1, 2, 3)])
        axes = 2 if given.get("PLANE") == 0.0 else 3
        apart = abs(theirs - mine)[:, :axes] > TOLERANCE * max(abs(along).max(), abs(mine).max())
        rows = np.flatnonzero(heated & apart.any(axis=1))
        if not len(rows):
            return None
        at = int(rows[0])
        axis = int(apart[at].argmax())
        has = f"has {theirs[at, axis]:.6g} there (material {ply.material.name}), and its temperature changes"
        return self._finding(at, f"EXPANSION{axis + 1} {word} = {mine[axis]:g}", has)

    def _axes(self, angle: float, direction: FloatArray) -> FloatArray:
        """Return the axes (m, 3, 3) of the plies of the elements, in rows, at an angle from s."""
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        assert self.group.definition is not None
        layout = element_layouts()[self.group.definition.number]
        if layout.dimension == 2:
            return np.broadcast_to(turn, (len(self.rows), 3, 3))
        normal = _normals(self.model, self.group, self.rows)
        return np.asarray(turn @ np.stack([*face_directions(normal, direction), normal], axis=1))

    def _finding(self, at: int, mine: str, theirs: str, *, wrong: bool = True) -> Finding:
        name = _named(self.model, self.group, int(self.rows[at]))
        message = f"{name}: {mine}, but the {self._solid(at)} {theirs}"
        return Finding(message, self.group.section.source, wrong)

    def _solid(self, at: int) -> str:
        """Return name, side and place of a solid."""
        name, where = _named(self.model, self.beside, int(self.solids[at])), _SIDES[self.side][1]
        return f"{name} {where} ({self.beside.section.source})"


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.linalg.norm(vectors, axis=1)
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0)[:, None])


def _straightened(compliance: FloatArray, tensor: Tensor) -> FloatArray:
    """Turn (k, 6, 6) compliances by at most OBLIQUE degrees so that they couple extension and shear the least."""
    about = np.eye(3) if tensor is Tensor.SOLID else np.eye(3)[2:]
    angle = np.radians(OBLIQUE)
    more, less = (rotated_compliance(compliance[:, None], _rotation(sign * angle * about)) for sign in (1.0, -1.0))
    # couplings by a turn about each axis (k, axes, couplings), and those that there are (k, couplings)
    change = _couplings(0.5 * (more - less), compliance[:, None], tensor)
    there = _couplings(compliance, compliance, tensor)
    size = (change**2).sum(axis=-1)
    # a turn that changes nothing is none
    share = -np.einsum("kac,kc->ka", change, there) / np.where(size > 0.0, size, 1.0)
    share /= np.maximum(np.linalg.norm(share, axis=-1, keepdims=True), 1.0)
    return rotated_compliance(compliance, _rotation(angle * share @ about))


def _rotation(vectors: FloatArray) -> FloatArray:
    """Return the (..., 3, 3) rotations of small rotation vectors (..., 3)."""
    half = 0.5 * np.cross(np.eye(3), vectors[..., None, :])
    return np.asarray(np.linalg.solve(np.eye(3) - half, np.eye(3) + half))


def _couplings(compliance: FloatArray, of: FloatArray, tensor: Tensor) -> FloatArray:
    """Return the (..., c) couplings of extension and shear, and of shears, in proportion to the diagonal of others."""
    count = 6 if tensor is Tensor.SOLID else 4
    size = np.sqrt(np.einsum("...ii->...i", of))
    rows, columns = np.triu_indices(count, 1)
    shear = columns > 2
    rows, columns = rows[shear], columns[shear]
    return np.asarray(compliance[..., rows, columns] / (size[..., rows] * size[..., columns]))


def _is_turned(compliance: FloatArray, tensor: Tensor) -> NDArray[np.bool_]:
    """Return whether (k, 6, 6) compliances couple extension with shear, or one shear with another."""
    return np.asarray((abs(_couplings(compliance, compliance, tensor)) > TOLERANCE).any(axis=-1))


def _constants(compliance: FloatArray) -> dict[str, FloatArray]:
    """Return engineering constants (k,) by name from compliances (k, 6, 6)."""
    first, second, third = (compliance[:, i, i] for i in range(3))
    values = (
        *(1.0 / first, 1.0 / second, 1.0 / third),
        *(-compliance[:, 0, 1] / first, -compliance[:, 0, 2] / first, -compliance[:, 1, 2] / second),
        *(1.0 / compliance[:, i, i] for i in (3, 4, 5)),
    )
    return dict(zip(_CONSTANTS, values, strict=True))
