# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface elements that are too long for the process zone: a warning when the first one fails.

The length of the zone, in each pure mode the smaller of that in a large body and that between slender arms,

    l_I  = m min(E_n G_Ic/s^2, (E_t G_Ic/s^2)^(1/4) h^(3/4)),
    l_II = m min(sqrt(E_n E_t) G_IIc/t^2, sqrt(E_t G_IIc/t^2 h)),    m = 1/2,

with the moduli of the plies across (E_n) and along the interface (E_t), strengths s and t, and the height h of the
thinner arm: Q. Yang and B. Cox, "Cohesive models for damage evolution in laminated composites", International Journal
of Fracture 133 (2005) 107-137, and P. W. Harper and S. R. Hallett, "Cohesive zone length in numerical simulations of
composite delamination", Engineering Fracture Mechanics 75 (2008) 4774-4792, who give m and ask for three elements. E_n
is the modulus of A. Turon and others, Engineering Fracture Mechanics 74 (2007) 1665-1682; that the moduli of the modes
have the ratio sqrt(E_t/E_n) follows from G. C. Sih, P. C. Paris and G. R. Irwin, International Journal of Fracture
Mechanics 1 (1965) 189-203. In mixed mode, 1/l is the mean of 1/l_I and 1/l_II with the energies that the failing point
has dissipated as weights, which has these limits; there is no formula of the literature for it. Where fibres bridge
(LAW 5), the zone is that of the tip alone, which is the shorter one: s, t and G_c less those of the bridging.

The project's elements with solids of their own know the moduli, but not the arms. They send a message themselves, in
Abaqus too, in the increment after the one in which a point fails (fortran/elements/process_zone.f90). The warning of
their groups waits until then, and is not given if they have spoken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.elements.families.user import TENSORS
from uel.elements.interfaces.bridging import bridging_shares
from uel.elements.materials.library import global_compliance
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import CohesiveType, ContinuumType, Tensor
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import CohesiveSection, ElasticType, SolidSection, UserProperty
from uel.model.records import IncrementDone
from uel.usersub import Library
from uel.usersub.layout import element_layouts

FACTOR: Final = 0.5
"""Factor m of Harper and Hallett."""
ELEMENTS: Final = 3
"""Number of elements that the process zone has to hold."""
FAILED: Final = 0.5
"""Part of the fracture energy from which on a point counts as failing: any law gives a bonded point less."""
_FLAT: Final = 0.999
"""Length of the mean of unit normals above which an interface counts as flat: within 3 degrees or so."""


TOLD: Final = "the process zone at most"
"""Words of the message that elements send themselves, once in a job (fortran/abaqus/long_elements.f90)."""


@dataclass(frozen=True, slots=True)
class _Law:
    """Strengths and fracture energies of modes I and II; speaks: the elements may send the message themselves.

    shares  (2, 2), of the bridging in them
    """

    strengths: tuple[float, float]
    energies: tuple[float, float]
    speaks: bool = False
    shares: FloatArray = field(default_factory=lambda: np.zeros((2, 2)))

    @property
    def tip(self) -> FloatArray:
        """Strengths and fracture energies (2, 2) without the bridging."""
        return np.array([self.strengths, self.energies]) * (1.0 - self.shares)

    @property
    def valid(self) -> bool:
        """Whether all are positive; elsewhere the elements themselves say what is wrong."""
        return bool(self.tip.min() > 0.0)


@dataclass(frozen=True, slots=True)
class _Long:
    """Elements of a group that are too long in one mode at least.

    rows, lengths, zones  (k,) in the group, (k,) and of both modes (2, k)
    law                   of the group
    """

    rows: IntArray
    lengths: FloatArray
    zones: FloatArray
    law: _Law

    def without(self, some: NDArray[np.bool_]) -> _Long:
        """Return the elements except some (k,)."""
        kept = ~some
        return _Long(self.rows[kept], self.lengths[kept], self.zones[:, kept], self.law)


class LongElements:
    """Observer of the interface elements that are longer than a third of the process zone.

    Parameters
    ----------
    model, library
        The deck and the user routines; without the project's own interface elements, and cohesive ones, and without an
        elastic material beside them, nothing is watched.
    """

    def __init__(self, model: Model, library: Library) -> None:
        self._model = model
        self._watched: dict[int, _Long] = {}
        self._waiting: list[str] = []
        plies: _Plies | None = None
        for index, group in enumerate(model.groups):
            law, faces = _law(group, library), _faces(group, library)
            if law is None or faces is None or not law.valid:
                continue
            plies = plies or _Plies(model)
            long = _long_elements(model, group, law, faces, plies)
            if len(long.rows):
                self._watched[index] = long

    def waiting(self, given: Sequence[str]) -> list[str]:
        """Return the warnings that have waited for elements to speak, none if `given`, those of the job so far, has
        their message.
        """
        waited, self._waiting = self._waiting, []
        return [] if any(TOLD in text for text in given) else waited

    def warnings(self, record: IncrementDone, given: Sequence[str]) -> list[str]:
        """Return the warnings after an increment: once for each group, when the first of its long elements fails, or
        one increment later; given: as in `waiting`.
        """
        found = self.waiting(given)
        for index, long in list(self._watched.items()):
            state = record.solution.elements[index]
            assert state.variables is not None  # of elements that we know
            names, points = state.variables.names, state.variables.points
            # those of the element as a whole come after those of its points
            values = state.svars[:, : points * len(names)].reshape(-1, points, len(names))[long.rows]
            worst = values[:, :, names.index("DAMAGE")].argmax(axis=1)
            values = values[np.arange(len(worst)), worst]
            first, *shear = (values[:, names.index(name)] for name in ("DISSI", "DISSII", "DISSIII") if name in names)
            second = np.sum(shear, axis=0)
            part = first / long.law.energies[0] + second / long.law.energies[1]
            # where the toughness of the mode mix is below both others, half of their sum may be all of it
            failed = (part > FAILED) | (values[:, names.index("DAMAGE")] >= 1.0)
            if not failed.any():
                continue
            mix = np.clip(second / np.where(first + second > 0.0, first + second, 1.0), 0.0, 1.0)
            mix = np.where(first + second > 0.0, mix, long.zones.argmin(axis=0))
            zones = 1.0 / ((1.0 - mix) / long.zones[0] + mix / long.zones[1])
            short = np.flatnonzero(failed & (ELEMENTS * long.lengths > zones))
            if len(short):
                k = int(short[0])
                del self._watched[index]
                texts = self._waiting if long.law.speaks else found
                texts.append(_message(self._model.groups[index], long, k, float(zones[k]), float(mix[k])))
            else:
                self._watched[index] = long.without(failed)
        return found


def _message(group: ElementGroup, long: _Long, k: int, zone: float, mix: float) -> str:
    return (
        f"{group.section.source}: element {group.labels[long.rows[k]]} (type {group.type}) fails and is "
        f"{long.lengths[k]:.3g} long, the process zone about {zone:.2g} ({mix:.0%} mode II): expected at least "
        f"{ELEMENTS} elements in it; with fewer the load comes out too high"
    )


def _law(group: ElementGroup, library: Library) -> _Law | None:
    """Return strengths and fracture energies of a group of interface elements; None for other elements."""
    section = group.section
    if isinstance(section, CohesiveSection):
        return _built_in_law(section)
    if group.definition is None or not isinstance(section, UserProperty) or not library.is_own:
        return None
    layout = element_layouts().get(group.definition.number)
    if layout is None or not layout.faces[0]:
        return None
    if len(section.values) < len(layout.reals) or group.definition.nodes < layout.nodes:
        # the elements themselves say what is missing
        return None
    values = layout.named(section)
    if values["CRACKED"]:
        # a crack that is there from the start does not fail
        return None
    law = _Law((values["SIGMAMAX"], values["TAUMAX"]), (values["GIC"], values["GIIC"]), speaks=bool(layout.own))
    return replace(law, shares=bridging_shares(values)) if law.valid else law


def _built_in_law(section: CohesiveSection) -> _Law | None:
    """Return the law of cohesive elements if the fracture energies and the strengths are known, else None."""
    damage = section.material.damage
    if damage is None or damage.evolution is None or damage.evolution.type != "ENERGY":
        return None
    if damage.criterion not in ("MAXS", "QUADS"):
        return None
    values = damage.evolution.values
    second = values[1] if damage.evolution.mixed_mode else values[0]
    return _Law((damage.onset[0], damage.onset[1]), (values[0], second))


def _faces(group: ElementGroup, library: Library) -> tuple[IntArray, IntArray] | None:
    """Return the local nodes of the corners of the bottom and the top face of interface elements."""
    kind = group.built_in
    if isinstance(kind, CohesiveType):
        corners, faces = kind.face.corners, (kind.bottom, kind.top)
    elif group.definition is not None and (known := library.variables(group.definition.number)) is not None:
        corners, faces = element_layouts()[group.definition.number].corners, (known.bottom, known.top)
    else:
        return None
    bottom, top = (np.array(face[:corners]) for face in faces)
    return bottom, top


class _Plies:
    """The elastic materials at the nodes of a model, in global axes."""

    def __init__(self, model: Model) -> None:
        count = len(model.mesh.coordinates)
        self._compliances: list[FloatArray] = []
        # the material of a node; the faces of an interface have nodes of their own, so that it is unique there
        self._owner = np.full(count, -1)
        for group in model.groups:
            compliance = compliance_of(group)
            if compliance is not None:
                self._owner[group.nodes] = len(self._compliances)
                self._compliances.append(compliance)
        self.nodes = np.flatnonzero(self._owner >= 0)

    def modulus(self, nodes: IntArray, directions: FloatArray) -> FloatArray:
        """Return Young's modulus at nodes (m,) along unit vectors (m, 3); infinite without a known material."""
        x, y, z = directions.T
        stress = np.column_stack([x * x, y * y, z * z, x * y, x * z, y * z])
        found = np.full(len(nodes), np.inf)
        for number, compliance in enumerate(self._compliances):
            here = self._owner[nodes] == number
            strain = np.einsum("mi,ij,mj->m", stress[here], compliance, stress[here])
            # a face without length has no direction
            found[here] = np.divide(1.0, strain, out=np.full(len(strain), np.inf), where=strain > 0.0)
        return found


def tensor_of(group: ElementGroup) -> Tensor | None:
    """Return the state of stress of continuum elements, built in or with UELMAT; None of others."""
    if group.definition is not None:
        return TENSORS.get(group.definition.tensor.upper())
    return group.built_in.tensor if isinstance(group.built_in, ContinuumType) else None


def compliance_of(group: ElementGroup) -> FloatArray | None:
    """Return the compliance (6, 6) of continuum elements; None if it is not known, or differs from point to point."""
    section, tensor = group.section, tensor_of(group)
    if not isinstance(section, SolidSection | UserProperty):
        return None
    # in space UELMAT may have directions of its own, as the project's brick has in each element
    turns = isinstance(section, UserProperty) and tensor is Tensor.SOLID
    material, orientation = section.material, section.orientation
    if material is None or tensor is None:
        return None
    if turns or (orientation is not None and orientation.system is not None):
        if material.elastic is None or material.elastic.type is not ElasticType.ISOTROPIC:
            return None
        orientation = None
    return global_compliance(material, orientation, tensor)


def _long_elements(
    model: Model, group: ElementGroup, law: _Law, faces: tuple[IntArray, IntArray], plies: _Plies
) -> _Long:
    place, nodes = model.mesh.coordinates, [group.nodes[:, face] for face in faces]
    middle = 0.5 * (place[nodes[0]] + place[nodes[1]])
    # the crack may go any way: the shortest edge is what a mesh is refined to
    edges = np.roll(middle, -1, axis=1) - middle
    lengths = np.linalg.norm(edges, axis=2)
    shortest = lengths.argmin(axis=1)
    rows = np.arange(len(group.labels))
    along, length = edges[rows, shortest], lengths[rows, shortest]
    along, normal = _unit(along), _normals(middle)
    sides = [side[:, 0] for side in nodes]
    across, axial = (np.minimum(*(plies.modulus(side, direction) for side in sides)) for direction in (normal, along))
    height = _arm_height(place[plies.nodes], middle.reshape(-1, 3), normal)
    zones = _zones(law, across, axial, height)
    zone = zones.min(axis=0)
    found = np.flatnonzero(np.isfinite(zone) & (ELEMENTS * length > zone))
    return _Long(found, length[found], zones[:, found], law)


def _normals(middle: FloatArray) -> FloatArray:
    """Return unit normals (m, 3) of faces whose corners are `middle` (m, corners, 3)."""
    if middle.shape[1] == 2:
        x, y, _ = (middle[:, 1] - middle[:, 0]).T
        normal = np.column_stack([-y, x, np.zeros(len(x))])
    else:
        # the diagonals of a quadrilateral, two edges of a triangle
        normal = np.cross(middle[:, 2] - middle[:, 0], middle[:, -1] - middle[:, 1])
    return _unit(normal)


def _unit(vectors: FloatArray) -> FloatArray:
    """Return vectors (m, 3) scaled to length 1; those of length 0 stay zero."""
    length = np.linalg.norm(vectors, axis=1)
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0)[:, None])


def _arm_height(inside: FloatArray, middle: FloatArray, normal: FloatArray) -> float:
    """Return the height of the thinner body beside a flat interface; infinite if it is not flat, or is at an edge."""
    mean = normal.mean(axis=0)
    if not len(inside) or not np.linalg.norm(mean) > _FLAT:
        return np.inf
    heights, level = inside @ mean, float(np.mean(middle @ mean))
    height = min(float(heights.max()) - level, level - float(heights.min()))
    return height if height > 0.0 else np.inf


def _zones(law: _Law, across: FloatArray, axial: FloatArray, height: float) -> FloatArray:
    """Compute the lengths of the process zones of modes I and II (2, m)."""
    strengths, energies = law.tip
    first, second = energies / strengths**2
    mode_1 = np.minimum(across * first, (axial * first) ** 0.25 * height**0.75)
    mode_2 = np.minimum(np.sqrt(across * axial) * second, np.sqrt(axial * second * height))
    return FACTOR * np.array([mode_1, mode_2])
