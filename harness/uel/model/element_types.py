# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of built-in element types: the reader, sections, elements, surfaces, loads and output take them from here.

A type belongs to a family, which is a cell with its interpolation; faces belong to families too. A new continuum
element is a row of CONTINUUM and, where its family is new, a row of the families, with its functions and integration
points in fortran/host/elements/shape.f90, which knows families by their numbers.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import IntEnum, StrEnum
from typing import ClassVar, Final

from uel.model.dofs import POTENTIAL, TEMPERATURE

Face = tuple[int, ...]


class Formulation(StrEnum):
    """Element types that support the same: a column of the table in harness/uel/elements/support.py."""

    SOLID = "continuum elements"
    PLANE_STRESS = "continuum elements in plane stress"
    HYBRID = "hybrid elements"
    HYBRID_MODES = "hybrid elements with incompatible modes"
    COUPLED = "coupled elements"
    COUPLED_PLANE_STRESS = "coupled elements in plane stress"
    COUPLED_HYBRID = "hybrid coupled elements"
    GENERALISED = "elements in generalised plane strain"
    GENERALISED_HYBRID = "hybrid elements in generalised plane strain"
    PIEZOELECTRIC = "piezoelectric elements"
    LAYERED = "elements with layers"
    HEAT = "heat transfer elements"
    DIFFUSION = "heat transfer elements in *MASS DIFFUSION"
    COHESIVE = "cohesive elements"
    SHELL = "shells"
    CONTINUUM_SHELL = "continuum shells"
    MEMBRANE = "membranes"
    PLANE_BEAM = "beams in a plane"
    BEAM = "beams in space"
    TRUSS = "trusses"
    SPRING = "springs"
    DASHPOT = "dashpots"
    MASS = "masses"
    RIGID = "rigid elements"
    USER = "user elements"


PLANES: Final = (3, 4, 5)
"""Dofs of the reference node of generalised plane strain: change of the length of its fibre, rotations of planes."""


@dataclass(frozen=True, slots=True)
class Family:
    """A cell with its interpolation.

    Nodes have the order of Abaqus, which is also that of meshio: corners, then the middles of edges.

    number       in fortran/host/elements/shape.f90
    dimension    of the cell: 1 line, 2 face, 3 volume
    nodes        of which `corners` are corners
    full_points  integration points of the mass, and of loads on the cell where it is a face
    body_points  integration points of loads on the volume
    cell         its name in meshio, for field output
    faces        local nodes (from 0) of the faces S1, S2, ...: corners, then middles of edges
    """

    number: int
    dimension: int
    nodes: int
    corners: int
    full_points: int
    body_points: int
    cell: str
    faces: tuple[Face, ...] = ()

    def face_family(self, face: Face) -> Family:
        """Return the family of one of the faces."""
        return FAMILIES[self.dimension - 1, len(face)]

    @property
    def linear(self) -> Family:
        """The family of its corners alone."""
        return FAMILIES[self.dimension, self.corners]


def _faces(nodes: int, *faces: Face) -> tuple[Face, ...]:
    """Cut the faces of a quadratic cell to its first nodes: the faces of the linear cell."""
    return tuple(tuple(node for node in face if node < nodes) for face in faces)


_TRIANGLE: Final = ((0, 1, 3), (1, 2, 4), (2, 0, 5))
_QUADRILATERAL: Final = ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))
_TETRAHEDRON: Final = ((0, 1, 2, 4, 5, 6), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 2, 3, 6, 9, 7))
_WEDGE: Final = (
    (0, 1, 2, 6, 7, 8),
    (3, 5, 4, 11, 10, 9),
    (0, 3, 4, 1, 12, 9, 13, 6),
    (1, 4, 5, 2, 13, 10, 14, 7),
    (2, 5, 3, 0, 14, 11, 12, 8),
)
_HEXAHEDRON: Final = (
    (0, 1, 2, 3, 8, 9, 10, 11),
    (4, 5, 6, 7, 12, 13, 14, 15),
    (0, 1, 5, 4, 8, 17, 12, 16),
    (1, 2, 6, 5, 9, 18, 13, 17),
    (2, 3, 7, 6, 10, 19, 14, 18),
    (3, 0, 4, 7, 11, 16, 15, 19),
)

# number, dimension, nodes, corners, full_points, body_points, cell, faces
LINE2: Final = Family(1, 1, 2, 2, 2, 2, "line")
LINE3: Final = Family(2, 1, 3, 2, 3, 3, "line3")
TRI3: Final = Family(3, 2, 3, 3, 1, 1, "triangle", _faces(3, *_TRIANGLE))
TRI6: Final = Family(4, 2, 6, 3, 6, 3, "triangle6", _TRIANGLE)
QUAD4: Final = Family(5, 2, 4, 4, 4, 4, "quad", _faces(4, *_QUADRILATERAL))
QUAD8: Final = Family(6, 2, 8, 4, 9, 9, "quad8", _QUADRILATERAL)
TET4: Final = Family(7, 3, 4, 4, 1, 1, "tetra", _faces(4, *_TETRAHEDRON))
HEX8: Final = Family(8, 3, 8, 8, 8, 8, "hexahedron", _faces(8, *_HEXAHEDRON))
HEX20: Final = Family(9, 3, 20, 8, 27, 27, "hexahedron20", _HEXAHEDRON)
TET10: Final = Family(10, 3, 10, 4, 15, 15, "tetra10", _TETRAHEDRON)
WEDGE6: Final = Family(11, 3, 6, 6, 6, 6, "wedge", _faces(6, *_WEDGE))
WEDGE15: Final = Family(12, 3, 15, 6, 18, 18, "wedge15", _WEDGE)

FAMILIES: Final = {
    (family.dimension, family.nodes): family
    for family in (LINE2, LINE3, TRI3, TRI6, QUAD4, QUAD8, TET4, HEX8, HEX20, TET10, WEDGE6, WEDGE15)
}
"""Families by the dimension of the cell and its nodes."""


class Tensor(IntEnum):
    """State of stress, by its number of components.

    These are 11 in a truss or beam, 11, 12 in a beam with torsion, 11, 22, 12 in plane stress, 11, 22, 33, 12 in plane
    strain, and 11, 22, 33, 12, 13, 23 in space.
    """

    UNIAXIAL = 1
    TORSION = 2
    PLANE_STRESS = 3
    PLANE_STRAIN = 4
    SOLID = 6


Direction = tuple[float, float, float]
_PLANE_FORCES: Final[dict[str, Direction]] = {"BX": (1.0, 0.0, 0.0), "BY": (0.0, 1.0, 0.0)}
_AXISYMMETRIC_FORCES: Final[dict[str, Direction]] = {"BR": (1.0, 0.0, 0.0), "BZ": (0.0, 1.0, 0.0)}
_SPACE_FORCES: Final[dict[str, Direction]] = _PLANE_FORCES | {"BZ": (0.0, 0.0, 1.0)}
BODY_FORCES: Final = ("BX", "BY", "BZ", "BR")
"""Labels of body forces in *DLOAD."""


@dataclass(frozen=True, slots=True)
class SolidType:
    """An element that fills an area or a volume, with *SOLID SECTION.

    points        integration points
    axisymmetric  direction 1 is the radius, 2 the axis
    """

    section: ClassVar = "SOLID SECTION"

    name: str
    family: Family
    points: int
    axisymmetric: bool = field(default=False, kw_only=True)

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return self.family.nodes

    @property
    def corners(self) -> int:
        """Corner nodes, those that are not midside nodes; they come first."""
        return self.family.corners

    @property
    def dimension(self) -> int:
        """Dimension: 2 or 3."""
        return self.family.dimension

    @property
    def direct(self) -> int:
        """Direct strains by the displacements: 2 in the plane, 3 in space and where there is one around the axis."""
        return 3 if self.axisymmetric else self.dimension

    @property
    def body_points(self) -> int:
        """Integration points of loads on the volume."""
        return self._over_radius(self.family.body_points)

    def _over_radius(self, points: int) -> int:
        # one point would not tell the corners of a triangle about an axis apart, which have different radii
        return 3 if self.axisymmetric and self.family is TRI3 else points


@dataclass(frozen=True, slots=True)
class HeatType(SolidType):
    """A heat transfer element: temperatures at all nodes, and no displacements."""

    formulation: ClassVar = Formulation.HEAT

    @property
    def components(self) -> tuple[str, ...]:
        """Components of the heat flux in the output."""
        return ("1", "2", "3")[: self.dimension]

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return (TEMPERATURE,)


@dataclass(frozen=True, slots=True)
class ContinuumType(SolidType):
    """A continuum element; axisymmetric ones have the stresses of plane strain, with 33 around the axis.

    points        integration points of the stiffness
    coupled       with temperatures at the corners
    incompatible  with incompatible modes
    pressures     functions of the pressure of hybrid elements: 1 of a constant one, 1 + dimension of a linear one
    modified      Abaqus has the modified interpolation there, which is not published; here it is the quadratic one
    electrical    piezoelectric, with an electrical potential at all nodes
    generalised   in generalised plane strain, with the dofs PLANES of the reference node of the section
    """

    tensor: Tensor
    coupled: bool = False
    incompatible: bool = False
    pressures: int = 0
    modified: bool = False
    electrical: bool = False
    generalised: bool = False

    @property
    def formulation(self) -> Formulation:
        """Its column of the table of formulations."""
        plane, hybrid = self.tensor is Tensor.PLANE_STRESS, self.pressures > 0
        if self.electrical:
            return Formulation.PIEZOELECTRIC
        if self.generalised:
            return Formulation.GENERALISED_HYBRID if hybrid else Formulation.GENERALISED
        if self.coupled:
            kinds = Formulation.COUPLED_PLANE_STRESS, Formulation.COUPLED_HYBRID, Formulation.COUPLED
        else:
            of_hybrid = Formulation.HYBRID_MODES if self.incompatible else Formulation.HYBRID
            kinds = Formulation.PLANE_STRESS, of_hybrid, Formulation.SOLID
        return kinds[0] if plane else kinds[1] if hybrid else kinds[2]

    @property
    def components(self) -> tuple[str, ...]:
        """Components of stress and strain in the output."""
        return ("11", "22", "33", "12", "13", "23")[: 2 * self.dimension]

    @property
    def body_forces(self) -> dict[str, Direction]:
        """Directions of the body forces of *DLOAD."""
        if self.dimension == 3:
            return _SPACE_FORCES
        return _AXISYMMETRIC_FORCES if self.axisymmetric else _PLANE_FORCES

    @property
    def hourglass_control(self) -> bool:
        """Whether displacements other than rigid ones leave the only point without strain."""
        return self.points == 1 and self.family in (QUAD4, HEX8)

    @property
    def layered(self) -> bool:
        """Whether it may have layers (*SOLID SECTION, COMPOSITE): bricks of displacements alone."""
        return self.family in (HEX8, HEX20) and not (self.coupled or self.electrical or self.pressures)

    @property
    def modes(self) -> int:
        """Incompatible modes: one of each displacement along each direction, and those of the volume.

        A linear pressure in space does not resist those of the volume, which change no shape.
        """
        if not self.incompatible:
            return 0
        of_volume = {Tensor.PLANE_STRESS: 0, Tensor.PLANE_STRAIN: 1, Tensor.SOLID: 0 if self.pressures else 4}
        return self.dimension**2 + of_volume[self.tensor]

    @property
    def mass_points(self) -> int:
        """Integration points of the mass."""
        return self._over_radius(self.family.full_points)

    @property
    def thermal_points(self) -> int:
        """Integration points of conduction and heat capacity: those of the stiffness, or enough for the corners."""
        return max(self.points, self._over_radius(self.family.linear.full_points))

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        displacements = tuple(range(1, self.dimension + 1))
        if self.electrical:
            return (*displacements, POTENTIAL)
        return (*displacements, TEMPERATURE) if self.coupled and node < self.corners else displacements


@dataclass(frozen=True, slots=True)
class ContinuumShellType(ContinuumType):
    """A continuum shell: a solid with the section of a shell, whose section points are in plane stress.

    points        integration points of its surface
    """

    section: ClassVar = "SHELL SECTION"
    formulation: ClassVar = Formulation.CONTINUUM_SHELL

    @property
    def surface(self) -> Family:
        """The family of its surface: its faces at the bottom and the top are alike."""
        return FAMILIES[2, self.nodes // 2]

    @property
    def layered(self) -> bool:
        """Whether *SOLID SECTION, COMPOSITE may give it layers: they are those of *SHELL SECTION."""
        return False


@dataclass(frozen=True, slots=True)
class CohesiveType:
    """A cohesive element between two faces of a family.

    bottom, top  local nodes of the faces, from 0; opposite ones have the same place
    """

    section: ClassVar = "COHESIVE SECTION"
    formulation: ClassVar = Formulation.COHESIVE

    name: str
    face: Family
    bottom: Face
    top: Face

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return 2 * self.face.nodes

    @property
    def dimension(self) -> int:
        """Dimension: 2 or 3."""
        return self.face.dimension + 1

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return tuple(range(1, self.dimension + 1))


@dataclass(frozen=True, slots=True)
class SurfaceType:
    """A surface in space.

    family  of the surface
    points  integration points of the surface
    """

    name: str
    family: Family
    points: int

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return self.family.nodes

    @property
    def corners(self) -> int:
        """Corner nodes; they come first."""
        return self.family.corners

    @property
    def full_points(self) -> int:
        """Points of full integration: of the mass and of loads."""
        return max(self.family.full_points, self.nodes)

    @property
    def dimension(self) -> int:
        """Dimension: 3."""
        return 3

    @property
    def body_forces(self) -> dict[str, Direction]:
        """Directions of the body forces of *DLOAD."""
        return _SPACE_FORCES

    @property
    def sides(self) -> dict[str, Face]:
        """Local nodes of its sides, from 0: the normal by their order points outward."""
        nodes = tuple(range(self.nodes))
        back = range(self.corners)[::-1]
        middles = [self.corners + (k - 1) % self.corners for k in back] if self.nodes > self.corners else []
        return {"SPOS": nodes, "SNEG": (*back, *middles)}

    @property
    def edges(self) -> dict[str, Face]:
        """Local nodes of the edges that loads act on, from 0."""
        return {}

    @property
    def hourglass_control(self) -> bool:
        """Whether displacements other than rigid ones leave the only point without strain."""
        return self.points == 1 and self.family is QUAD4


@dataclass(frozen=True, slots=True)
class ShellType(SurfaceType):
    """A conventional shell: displacements and rotations at each node."""

    section: ClassVar = "SHELL SECTION"
    formulation: ClassVar = Formulation.SHELL

    @property
    def edges(self) -> dict[str, Face]:
        """Local nodes of its edges, from 0."""
        return {f"E{k}": edge for k, edge in enumerate(self.family.faces, 1)}

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return (1, 2, 3, 4, 5, 6)


@dataclass(frozen=True, slots=True)
class MembraneType(SurfaceType):
    """A membrane: a surface in plane stress, with displacements at each node."""

    section: ClassVar = "MEMBRANE SECTION"
    formulation: ClassVar = Formulation.MEMBRANE

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return (1, 2, 3)


@dataclass(frozen=True, slots=True)
class BeamType:
    """A Timoshenko beam: displacements and rotations at each node; its nodes follow each other along the axis.

    family     of its axis
    points     integration points along the axis
    dimension  2 in a plane, 3 in space
    """

    section: ClassVar = "BEAM SECTION"

    name: str
    family: Family
    points: int
    dimension: int

    @property
    def formulation(self) -> Formulation:
        """Its column of the table of formulations."""
        return Formulation.BEAM if self.dimension == 3 else Formulation.PLANE_BEAM

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return self.family.nodes

    @property
    def order(self) -> tuple[int, ...]:
        """Local nodes in the order of the family, whose middle comes last."""
        return (0, 1) if self.nodes == 2 else (0, 2, 1)

    @property
    def body_forces(self) -> dict[str, Direction]:
        """Directions of the body forces of *DLOAD."""
        return _SPACE_FORCES if self.dimension == 3 else _PLANE_FORCES

    @property
    def line_forces(self) -> dict[str, Direction]:
        """Directions of the forces per length of *DLOAD, in global components."""
        return {label.replace("B", "P"): direction for label, direction in self.body_forces.items()}

    @property
    def local_forces(self) -> dict[str, Direction]:
        """Directions of the forces per length of *DLOAD along the local directions, in components along t, 1, 2."""
        along = {"P1": (0.0, 1.0, 0.0), "P2": (0.0, 0.0, 1.0)}
        return along if self.dimension == 3 else {"P2": along["P2"]}

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return (1, 2, 3, 4, 5, 6) if self.dimension == 3 else (1, 2, 6)


@dataclass(frozen=True, slots=True)
class RigidType:
    """A rigid element, which is there for its surface: its nodes move with the reference node of a *RIGID BODY.

    family        of its surface
    dimension     displacements of a node: 2 or 3
    axisymmetric  direction 1 is the radius, 2 the axis
    """

    section: ClassVar = "RIGID BODY"
    formulation: ClassVar = Formulation.RIGID

    name: str
    family: Family
    dimension: int
    axisymmetric: bool = False

    @property
    def nodes(self) -> int:
        """Nodes per element."""
        return self.family.nodes

    @property
    def sides(self) -> dict[str, Face]:
        """Local nodes of its sides, from 0: the normal by their order points outward.

        In the plane that is the right of the way along them. The positive normal is on the left of the way from node 1
        to 2 (Abaqus Analysis User's Guide, Rigid elements).
        """
        nodes = tuple(range(self.nodes))
        ways = {"SPOS": nodes, "SNEG": nodes[::-1]}
        return ways if self.dimension == 3 else dict(zip(("SNEG", "SPOS"), ways.values(), strict=True))

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return tuple(range(1, self.dimension + 1))


class DiscreteKind(IntEnum):
    """Kind of a discrete element; values but that of trusses are JTYPE of fortran/host/elements/beam/discrete.f90."""

    TRUSS = 1
    AXIAL_SPRING = 2
    SPRING = 3
    MASS = 4
    FACE = 5
    AXIAL_DASHPOT = 6
    DASHPOT = 7


@dataclass(frozen=True, slots=True)
class DiscreteType:
    """A truss, spring, dashpot or mass.

    Its nodes have the displacements 1 to `dimension`, those of springs and dashpots one dof of these.

    section  keyword that gives its properties
    """

    name: str
    kind: DiscreteKind
    nodes: int
    dimension: int
    section: str

    @property
    def formulation(self) -> Formulation:
        """Its column of the table of formulations."""
        return _DISCRETE[self.kind]

    def dofs(self, node: int) -> tuple[int, ...]:
        """Return the dofs of a local node, from 0."""
        del node
        return tuple(range(1, self.dimension + 1))


_DISCRETE: Final = {
    DiscreteKind.TRUSS: Formulation.TRUSS,
    DiscreteKind.AXIAL_SPRING: Formulation.SPRING,
    DiscreteKind.SPRING: Formulation.SPRING,
    DiscreteKind.MASS: Formulation.MASS,
    DiscreteKind.AXIAL_DASHPOT: Formulation.DASHPOT,
    DiscreteKind.DASHPOT: Formulation.DASHPOT,
}

BuiltInType = ContinuumType | HeatType | CohesiveType | ShellType | MembraneType | BeamType | RigidType | DiscreteType

_PLANE: Final = {"3": (TRI3, 1), "4": (QUAD4, 4), "4R": (QUAD4, 1), "6": (TRI6, 3), "8": (QUAD8, 9), "8R": (QUAD8, 4)}
_SPACE: Final = {
    **{"4": (TET4, 1), "6": (WEDGE6, 2), "8": (HEX8, 8), "8R": (HEX8, 1)},
    **{"10": (TET10, 4), "15": (WEDGE15, 9), "20": (HEX20, 27), "20R": (HEX20, 8)},
}
_CONSTANT: Final = ("CPE3", "CPE4", "CPE4R", "CAX3", "CAX4", "CAX4R", "C3D4", "C3D6", "C3D8", "C3D8R", "C3D10")
_LINEAR: Final = ("CPE6", "CPE8", "CPE8R", "CAX6", "CAX8", "CAX8R", "C3D15", "C3D20", "C3D20R")
_UNCOUPLED: Final = (
    *("CPS4I", "CPE4I", "C3D8I", "CPS6", "CPE6", "CAX6", "C3D15"),
    *("CPE3H", "CPE6H", "CAX3H", "CAX6H", "C3D4H", "C3D15H"),
)
"""Types without a counterpart with temperatures, in Abaqus or here."""

_SOLIDS: Final = {
    kind.name: kind
    for kind in (
        *(ContinuumType(f"CPS{name}", *row, Tensor.PLANE_STRESS) for name, row in _PLANE.items()),
        *(ContinuumType(f"CPE{name}", *row, Tensor.PLANE_STRAIN) for name, row in _PLANE.items()),
        *(ContinuumType(f"CAX{name}", *row, Tensor.PLANE_STRAIN, axisymmetric=True) for name, row in _PLANE.items()),
        *(ContinuumType(f"C3D{name}", *row, Tensor.SOLID) for name, row in _SPACE.items()),
        ContinuumType("CPS4I", QUAD4, 4, Tensor.PLANE_STRESS, incompatible=True),
        ContinuumType("CPE4I", QUAD4, 4, Tensor.PLANE_STRAIN, incompatible=True),
        ContinuumType("C3D8I", HEX8, 8, Tensor.SOLID, incompatible=True),
    )
}
HYBRID: Final = {
    f"{name}H": replace(kind, name=f"{name}H", pressures=1 if name in _CONSTANT else 1 + kind.dimension)
    for name, kind in _SOLIDS.items()
    if name in (*_CONSTANT, *_LINEAR)
}
"""Hybrid elements by their names, with the pressures of Abaqus' element library; that of C3D4H is linear in Abaqus."""

HYBRID_MODES: Final = {
    f"{name}H": replace(_SOLIDS[name], name=f"{name}H", pressures=1 + _SOLIDS[name].dimension)
    for name in ("CPE4I", "C3D8I")
}
"""Hybrid elements with incompatible modes by their names."""

_QUADRATIC_TRIANGLES: Final = ("CPS6", "CPE6", "CAX6", "C3D10")
MODIFIED: Final = {
    name: replace(kind, name=name, modified=True)
    for plain in _QUADRATIC_TRIANGLES
    for suffix, kinds in (("", _SOLIDS), ("H", HYBRID))
    if (kind := kinds.get(f"{plain}{suffix}"))
    for name in (f"{plain}M{suffix}",)
}
"""Modified elements by their names."""

CONTINUUM: Final = _SOLIDS | HYBRID | HYBRID_MODES | MODIFIED
"""Continuum elements by their names."""

LAYERED: Final = tuple(name for name, kind in CONTINUUM.items() if kind.layered)
"""Names of those that may have layers."""

COUPLED: Final = {
    f"{name}T": replace(kind, name=f"{name}T", coupled=True)
    for name, kind in (_SOLIDS | HYBRID).items()
    if name not in _UNCOUPLED
}
"""Solids and hybrid elements with temperatures at their corners."""

GENERALISED: Final = {
    name: replace(kind, name=name, generalised=True)
    for kind in (*_SOLIDS.values(), *HYBRID.values(), *MODIFIED.values())
    if kind.name.startswith("CPE") and not kind.incompatible
    for name in (kind.name.replace("CPE", "CPEG"),)
}
"""Elements in generalised plane strain by their names."""

PIEZOELECTRIC: Final = {
    f"{name}E": replace(kind, name=f"{name}E", electrical=True)
    for name, kind in _SOLIDS.items()
    if not (kind.hourglass_control or kind.incompatible)
}
"""Solids with an electrical potential at all nodes."""

_HEAT: Final = {"2D": ("3", "4", "6", "8"), "AX": ("3", "4", "6", "8"), "3D": ("4", "6", "8", "10", "15", "20")}
HEAT: Final = {
    f"DC{place}{nodes}": HeatType(f"DC{place}{nodes}", kind.family, kind.thermal_points, axisymmetric=kind.axisymmetric)
    for place, names in _HEAT.items()
    for nodes in names
    for kind in (CONTINUUM[f"C{place.replace('2D', 'PE')}{nodes}"],)
}
"""Heat transfer elements by their names."""

COHESIVE: Final = {
    "COH2D4": CohesiveType("COH2D4", LINE2, (0, 1), (3, 2)),
    "COH3D6": CohesiveType("COH3D6", TRI3, (0, 1, 2), (3, 4, 5)),
    "COH3D8": CohesiveType("COH3D8", QUAD4, (0, 1, 2, 3), (4, 5, 6, 7)),
}
"""Cohesive elements by their names."""

SHELL: Final = {
    kind.name: kind
    for kind in (
        ShellType("S3", TRI3, 1),
        ShellType("S3R", TRI3, 1),
        ShellType("S4", QUAD4, 4),
        ShellType("S4R", QUAD4, 1),
        ShellType("S8R", QUAD8, 4),
    )
}
"""Conventional shells by their names."""

CONTINUUM_SHELL: Final = {
    kind.name: kind
    for kind in (
        ContinuumShellType("SC6R", WEDGE6, 1, Tensor.SOLID),
        ContinuumShellType("SC8R", HEX8, 1, Tensor.SOLID),
    )
}
"""Continuum shells by their names."""

MEMBRANE: Final = {
    kind.name: kind
    for kind in (
        MembraneType("M3D3", TRI3, 1),
        MembraneType("M3D4", QUAD4, 4),
        MembraneType("M3D4R", QUAD4, 1),
        MembraneType("M3D6", TRI6, 3),
        MembraneType("M3D8", QUAD8, 9),
        MembraneType("M3D8R", QUAD8, 4),
    )
}
"""Membranes by their names."""

_BEAMS: Final = (
    BeamType("B21", LINE2, 1, 2),
    BeamType("B22", LINE3, 2, 2),
    BeamType("B31", LINE2, 1, 3),
    BeamType("B32", LINE3, 2, 3),
)
BEAM: Final = {kind.name: kind for beam in _BEAMS for kind in (beam, replace(beam, name=f"{beam.name}H"))}
"""Beams by their names; linear elastic hybrid ones are the same."""

RIGID: Final = {
    kind.name: kind
    for kind in (
        RigidType("R2D2", LINE2, 2),
        RigidType("RAX2", LINE2, 2, axisymmetric=True),
        RigidType("R3D3", TRI3, 3),
        RigidType("R3D4", QUAD4, 3),
    )
}
"""Rigid elements by their names."""

DISCRETE: Final = {
    kind.name: kind
    for kind in (
        DiscreteType("T2D2", DiscreteKind.TRUSS, 2, 2, "SOLID SECTION"),
        DiscreteType("T3D2", DiscreteKind.TRUSS, 2, 3, "SOLID SECTION"),
        DiscreteType("SPRING1", DiscreteKind.SPRING, 1, 3, "SPRING"),
        DiscreteType("SPRING2", DiscreteKind.SPRING, 2, 3, "SPRING"),
        DiscreteType("SPRINGA", DiscreteKind.AXIAL_SPRING, 2, 3, "SPRING"),
        DiscreteType("DASHPOT1", DiscreteKind.DASHPOT, 1, 3, "DASHPOT"),
        DiscreteType("DASHPOT2", DiscreteKind.DASHPOT, 2, 3, "DASHPOT"),
        DiscreteType("DASHPOTA", DiscreteKind.AXIAL_DASHPOT, 2, 3, "DASHPOT"),
        DiscreteType("MASS", DiscreteKind.MASS, 1, 3, "MASS"),
    )
}
"""Trusses, springs, dashpots and masses by their names."""

BUILT_IN: Final[dict[str, BuiltInType]] = {
    **(CONTINUUM | COUPLED | PIEZOELECTRIC | GENERALISED),
    **HEAT,
    **COHESIVE,
    **SHELL,
    **CONTINUUM_SHELL,
    **MEMBRANE,
    **BEAM,
    **RIGID,
    **DISCRETE,
}
"""All built-in elements by their names."""

HOURGLASS_CONTROLLED: Final = tuple(name for name, kind in (CONTINUUM | GENERALISED).items() if kind.hourglass_control)
"""Names of elements with hourglass control."""
