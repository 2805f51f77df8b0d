# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Materials, orientations, sections and user element definitions, as the deck gives them."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from typing import ClassVar, Final, Literal

import numpy as np

from uel.errors import Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.damage import Damage
from uel.model.orientation_axes import LocalSystem
from uel.model.records import PointVariables


class ElasticType(StrEnum):
    """TYPE= of *ELASTIC."""

    ISOTROPIC = "ISOTROPIC"
    ENGINEERING_CONSTANTS = "ENGINEERING CONSTANTS"
    LAMINA = "LAMINA"
    ORTHOTROPIC = "ORTHOTROPIC"
    ANISOTROPIC = "ANISOTROPIC"
    TRACTION = "TRACTION"

    @property
    def constants(self) -> int:
        """Number of its constants."""
        return _CONSTANTS[self]


_CONSTANTS: Final = {
    ElasticType.ISOTROPIC: 2,
    ElasticType.ENGINEERING_CONSTANTS: 9,
    ElasticType.LAMINA: 6,
    ElasticType.ORTHOTROPIC: 9,
    ElasticType.ANISOTROPIC: 21,
    ElasticType.TRACTION: 3,
}


def isotropic_fault(young: float, poisson: float) -> str:
    """Describe the fault in the constants of an isotropic material, '' if there is none.

    A Poisson's ratio of 0.5 is an incompressible material, which trusses can have.
    """
    if young > 0 and -1 < poisson <= 0.5:
        return ""
    return f"E = {young:g}, nu = {poisson:g}: expected E > 0 and -1 < nu <= 0.5"


@dataclass(frozen=True, slots=True)
class Elastic:
    """*ELASTIC: constants in the order of the Abaqus data line of its type (E, nu; E1, E2, E3, nu12, ...).

    table  (k, constants, temperature and fields) where they depend on these; `constants` are those of the first row
    instantaneous  MODULI=INSTANTANEOUS, of a viscoelastic material
    """

    type: ElasticType
    constants: tuple[float, ...]
    source: Source
    table: FloatArray | None = None
    instantaneous: bool = False


@dataclass(frozen=True, slots=True)
class Plastic:
    """*PLASTIC with the Mises yield surface.

    table         (k, 2) yield stress, the size of the yield surface, and plastic strain
    backstresses  (n, 2) C and gamma of each backstress of kinematic and combined hardening; n = 0: isotropic hardening
    growth        Q and b of *CYCLIC HARDENING, PARAMETERS: the size grows by Q (1 - exp(-b plastic strain))
    combined      HARDENING=COMBINED
    user          HARDENING=USER: the constants of UHARD, which gives the yield stress; the table is empty
    """

    table: FloatArray
    source: Source
    backstresses: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    growth: tuple[float, float] = (0.0, 0.0)
    combined: bool = False
    user: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Viscoelastic:
    """*VISCOELASTIC, TIME=PRONY: terms (n, 3) g, k and tau."""

    terms: FloatArray
    source: Source


@dataclass(frozen=True, slots=True)
class Creep:
    """*CREEP: A, n and m of a power law; by_time: time hardening, else strain hardening; user: CREEP gives the law."""

    by_time: bool
    factor: float
    stress_power: float
    time_power: float
    source: Source
    user: bool = False


class CreepLaw(IntEnum):
    """Creep law of a network; values are those of fortran/host/materials/networks.f90."""

    POWER = 1
    HYPERBOLIC = 2
    BERGSTROM_BOYCE = 3
    USER = 4


SRATIO_ROUNDING: Final = 1e-9
"""Tolerance of a sum of stiffness ratios about one."""


@dataclass(frozen=True, slots=True)
class Network:
    """*VISCOELASTIC, NONLINEAR: a viscoelastic network.

    ratio      SRATIO
    constants  of the law, as the host has them: q0, n, m, a, rate; A, B, n; A, m, C, E
    user       PROPS of UCREEPNETWORK, of LAW=USER
    shift      PROPS of UTRSNETWORK, of *TRS
    """

    ratio: float
    law: CreepLaw
    constants: tuple[float, ...]
    source: Source
    user: FloatArray | None = None
    shift: FloatArray | None = None


class Potential(StrEnum):
    """Strain energy potential of *HYPERELASTIC."""

    ARRUDA_BOYCE = "ARRUDA-BOYCE"
    MOONEY_RIVLIN = "MOONEY-RIVLIN"
    NEO_HOOKE = "NEO HOOKE"
    OGDEN = "OGDEN"
    POLYNOMIAL = "POLYNOMIAL"
    REDUCED_POLYNOMIAL = "REDUCED POLYNOMIAL"
    YEOH = "YEOH"


HIGHEST_ORDER: Final = 6
"""Largest N of *HYPERELASTIC, coefficients given directly (Abaqus Keywords Guide; host/materials/hyperelastic.f90)."""


@dataclass(frozen=True, slots=True)
class Hyperelastic:
    """*HYPERELASTIC by coefficients.

    order         N; 1, 1 and 3 of Mooney-Rivlin, neo-Hooke and Yeoh
    coefficients  of the change of shape, in the order of the data line; mu and lambda_m of Arruda-Boyce
    compliances   D, one per order, but one of Arruda-Boyce
    instantaneous MODULI=INSTANTANEOUS, beside networks
    """

    potential: Potential
    order: int
    coefficients: tuple[float, ...]
    compliances: tuple[float, ...]
    source: Source
    instantaneous: bool = False
    keyword: ClassVar[str] = "HYPERELASTIC"


@dataclass(frozen=True, slots=True)
class UserPotential:
    """*HYPERELASTIC, USER: constants are the PROPS of UHYPER; incompressible unless TYPE=COMPRESSIBLE.

    directions  of *ANISOTROPIC HYPERELASTIC, USER, which calls UANISOHYPER_INV; None of *HYPERELASTIC
    """

    constants: FloatArray
    source: Source
    incompressible: bool = False
    directions: int | None = None

    @property
    def routine(self) -> str:
        """Routine that gives the energy."""
        return "UHYPER" if self.directions is None else "UANISOHYPER_INV"

    @property
    def keyword(self) -> str:
        """Keyword of the deck."""
        return "HYPERELASTIC" if self.directions is None else "ANISOTROPIC HYPERELASTIC"


@dataclass(frozen=True, slots=True)
class Holzapfel:
    """*ANISOTROPIC HYPERELASTIC, HOLZAPFEL: coefficients C10, D, k1, k2, kappa; number of directions."""

    coefficients: tuple[float, float, float, float, float]
    directions: int
    source: Source
    keyword: ClassVar[str] = "ANISOTROPIC HYPERELASTIC"


class HybridFormulation(IntEnum):
    """Formulation of UMAT that hybrid elements expect; values are those of fortran/host/routines/umat.f90."""

    INCREMENTAL = 0
    TOTAL = 1
    INCOMPRESSIBLE = 2


@dataclass(frozen=True, slots=True)
class UserMaterial:
    """*USER MATERIAL: constants are the PROPS of UMAT or UMATHT; hybrid is HYBRID FORMULATION."""

    constants: FloatArray
    unsymmetric: bool
    source: Source
    hybrid: HybridFormulation = HybridFormulation.INCREMENTAL


@dataclass(frozen=True, slots=True)
class Piezoelectric:
    """*PIEZOELECTRIC.

    by_strain  TYPE=E: strains by the electrical field; else minus the stresses
    values     (3, 6) for each direction of the field 11, 22, 33, 12, 13, 23; strains are engineering strains
    """

    by_strain: bool
    values: FloatArray
    source: Source


@dataclass(frozen=True, slots=True)
class Expansion:
    """*EXPANSION.

    table  (k, 7) temperature, ascending, and coefficients of 11, 22, 33, 12, 13, 23, the latter of engineering strains
    zero   temperature without thermal strain, which counts where coefficients depend on it
    """

    table: FloatArray
    zero: float
    source: Source

    @property
    def isotropic(self) -> bool:
        """Whether it is the same in all directions."""
        return bool((self.table[:, 1:4] == self.table[:, 1:2]).all()) and not self.table[:, 4:].any()


@dataclass(frozen=True, slots=True)
class Diffusivity:
    """*DIFFUSIVITY, with the *KAPPA that follow.

    tensors   (k, 3, 3) D in the directions of the material
    points    (k, 2) concentration and temperature of each
    fick      LAW=FICK, else GENERAL
    isotropic whether D is a multiple of the unit matrix
    soret, pressure  (k, 3) kappa_s and kappa_p, concentration, temperature; k = 0: none
    """

    tensors: FloatArray
    points: FloatArray
    fick: bool
    isotropic: bool
    source: Source
    soret: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    pressure: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))


@dataclass(frozen=True, slots=True)
class Material:
    """*MATERIAL; state_variables is *DEPVAR, output_variables *USER OUTPUT VARIABLES.

    conductivity, specific_heat  (k, 2) value and temperature, ascending; k = 0: not given
    latent_heat  (k, 3) heat per mass, solidus and liquidus temperature
    diffusivity  None without it
    solubility   (k, 2) value and temperature; k = 0: not given
    heat_generation  place of *HEAT GENERATION, None without it
    user, user_thermal  *USER MATERIAL, TYPE=MECHANICAL and TYPE=THERMAL
    user_field   place of *USER DEFINED FIELD, None without it
    piezoelectric  None without it
    dielectric   (3, 3) *DIELECTRIC at constant strain, None without it
    """

    name: str
    source: Source
    elastic: Elastic | None = None
    plastic: Plastic | None = None
    hyperelastic: Hyperelastic | Holzapfel | UserPotential | None = None
    viscoelastic: Viscoelastic | None = None
    creep: Creep | None = None
    networks: tuple[Network, ...] = ()
    damage: Damage | None = None
    density: float = 0.0
    conductivity: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    specific_heat: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    latent_heat: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    diffusivity: Diffusivity | None = None
    solubility: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    heat_generation: Source | None = None
    expansion: Expansion | None = None
    user: UserMaterial | None = None
    user_thermal: UserMaterial | None = None
    user_field: Source | None = None
    piezoelectric: Piezoelectric | None = None
    dielectric: FloatArray | None = None
    state_variables: int = 0
    output_variables: int = 0

    @property
    def viscous(self) -> Viscoelastic | Creep | Network | None:
        """Source of the time dependence of stresses, None if they do not depend on time."""
        return self.viscoelastic or self.creep or next(iter(self.networks), None)

    @property
    def equilibrium(self) -> float:
        """Stiffness ratio of the network that does not creep."""
        return 1 - sum(network.ratio for network in self.networks)


@dataclass(frozen=True, slots=True)
class Orientation:
    """*ORIENTATION: rows of `axes` (3, 3) are the local 1, 2 and 3 directions in global components.

    system  gives them where they are not the same everywhere, with the global ones in `axes`
    normal  1, 2 or 3, the direction closest to the normal of a shell; the next one is projected onto it
    local   (m, 3) unit vectors of LOCAL DIRECTIONS in these directions
    """

    name: str
    axes: FloatArray
    source: Source
    system: LocalSystem | None = None
    normal: int = 1
    local: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))


@dataclass(frozen=True, slots=True)
class SectionControls:
    """*SECTION CONTROLS: of cohesive elements

    deletion     ELEMENT DELETION=
    degradation  MAX DEGRADATION=
    viscosity    VISCOSITY=, time; None if not given

    and of continuum elements with one integration point

    enhanced     HOURGLASS=ENHANCED, else STIFFNESS; None if not given
    hourglass    factor of the hourglass stiffness
    hourglass_rotation  that of the rotations of shells
    """

    deletion: bool = True
    degradation: float = 1.0
    viscosity: float | None = None
    enhanced: bool | None = None
    hourglass: float = 1.0
    hourglass_rotation: float = 1.0


@dataclass(frozen=True, slots=True)
class SolidSection:
    """*SOLID SECTION of built-in continuum and heat transfer elements.

    Thickness 1, default hourglass stiffness (0) unless given. The reference node of generalised plane strain is an
    index into the nodes of the model, -1 in other elements; there the thickness is the length of its fibre.
    """

    elset: str
    material: Material
    orientation: Orientation | None
    thickness: float
    source: Source
    hourglass: float = 0.0
    controls: SectionControls = SectionControls()
    reference: int = -1


@dataclass(frozen=True, slots=True)
class SolidLayer:
    """A layer of a solid.

    thickness    over that of the other layers
    points       section points across it
    orientation  of its material; None: the global directions
    angle        of its direction from that of the orientation, about the normal of the layer, degrees; None: the
                 directions of the orientation, whether they are along the layer or not
    """

    thickness: float
    points: int
    material: Material
    orientation: Orientation | None
    angle: float | None = None


@dataclass(frozen=True, slots=True)
class CompositeSection:
    """*SOLID SECTION, COMPOSITE: layers that follow each other along a direction of parent coordinates, 1, 2 or 3.

    hourglass  *HOURGLASS STIFFNESS; 0: not given
    """

    elset: str
    layers: tuple[SolidLayer, ...]
    direction: int
    source: Source
    hourglass: float = 0.0
    controls: SectionControls = SectionControls()

    @property
    def sections(self) -> int:
        """Section points of an integration point."""
        return sum(layer.points for layer in self.layers)


@dataclass(frozen=True, slots=True)
class CohesiveSection:
    """*COHESIVE SECTION with RESPONSE=TRACTION SEPARATION.

    thickness  initial constitutive thickness; 0 for that of the nodes (THICKNESS=GEOMETRY)
    width      out of the plane
    """

    elset: str
    material: Material
    thickness: float
    width: float
    controls: SectionControls
    source: Source


@dataclass(frozen=True, slots=True)
class ShellLayer:
    """A layer of a shell: points through its thickness; angle of its direction 1 from the section's, degrees."""

    thickness: float
    points: int
    material: Material
    angle: float = 0.0


@dataclass(frozen=True, slots=True)
class ShellSection:
    """*SHELL SECTION.

    layers       from the side SNEG to SPOS
    offset       from the middle surface to the nodes, along the normal, over the thickness
    gauss        whether section points are those of Gauss, else of Simpson
    shear        K11, K22 and K12 of *TRANSVERSE SHEAR STIFFNESS; none: those of the elastic layers
    slenderness  its factor; None: the default
    hourglass, hourglass_rotation  *HOURGLASS STIFFNESS; 0: not given
    drilling     its factor of the drilling stiffness

    Of continuum shells:
    stack        parent coordinate from SNEG to SPOS, 1 to 3; None: STACK DIRECTION=ORIENTATION
    poisson      POISSON; None: the default
    modulus      THICKNESS MODULUS; 0: not given
    """

    elset: str
    layers: tuple[ShellLayer, ...]
    orientation: Orientation | None
    offset: float
    gauss: bool
    source: Source
    controls: SectionControls = SectionControls()
    shear: tuple[float, ...] = ()
    slenderness: float | None = None
    hourglass: float = 0.0
    hourglass_rotation: float = 0.0
    drilling: float = 1.0
    stack: int | None = 3
    poisson: float | Literal["ELASTIC"] | None = None
    modulus: float = 0.0

    @property
    def thickness(self) -> float:
        """Thickness of all layers."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def mass(self) -> float:
        """Mass per area."""
        return sum(layer.thickness * layer.material.density for layer in self.layers)

    @property
    def density(self) -> float:
        """Mean density of the layers."""
        return self.mass / self.thickness


@dataclass(frozen=True, slots=True)
class MembraneSection:
    """*MEMBRANE SECTION.

    poisson    by which the thickness changes with large strains
    hourglass  *HOURGLASS STIFFNESS; 0: not given
    """

    elset: str
    material: Material
    orientation: Orientation | None
    thickness: float
    poisson: float
    source: Source
    controls: SectionControls = SectionControls()
    hourglass: float = 0.0

    @property
    def mass(self) -> float:
        """Mass per area."""
        return self.thickness * self.material.density


@dataclass(frozen=True, slots=True)
class BeamSection:
    """*BEAM SECTION or *BEAM GENERAL SECTION.

    profile        RECT, CIRC, PIPE, BOX, I or GENERAL
    dimensions     of the profile, as on the data line; GENERAL: A, I11, I12, I22, J
    young          Young's modulus; 0 with *USER MATERIAL
    shear_modulus  for torsion, and by default for transverse shear; 0 with *USER MATERIAL
    density        per volume; 0: not given
    n1             approximate local direction 1
    material       None where the section has the moduli itself
    isotropic      ROTARY INERTIA=ISOTROPIC
    poisson        POISSON=, by which the area would change with large strains
    shear          K23 and K13 of *TRANSVERSE SHEAR STIFFNESS; none: those of the profile
    slenderness    its slenderness compensation factor; None: the default
    """

    elset: str
    profile: str
    dimensions: tuple[float, ...]
    young: float
    shear_modulus: float
    density: float
    source: Source
    n1: tuple[float, float, float] = (0.0, 0.0, -1.0)
    material: Material | None = None
    isotropic: bool = False
    poisson: float = 0.0
    shear: tuple[float, ...] = ()
    slenderness: float | None = None

    @property
    def integrated(self) -> bool:
        """Whether stresses at section points make the forces of the section, which is otherwise linear elastic."""
        material = self.material
        if material is None:
            return False
        depends = material.elastic is None or material.elastic.table is not None or material.user_field is not None
        # points whose UVAR are asked for are called
        depends = depends or bool(material.output_variables)
        return depends or material.plastic is not None or material.expansion is not None


@dataclass(frozen=True, slots=True)
class SpringSection:
    """*SPRING or *DASHPOT.

    dofs   dof at each node of SPRING1 and SPRING2, DASHPOT1 and DASHPOT2; none for SPRINGA and DASHPOTA
    table  stiffness or damping coefficient alone, or force and elongation, or its rate, in turn
    """

    elset: str
    dofs: tuple[int, ...]
    table: FloatArray
    source: Source


@dataclass(frozen=True, slots=True)
class MassSection:
    """*MASS of point masses."""

    elset: str
    mass: float
    source: Source


@dataclass(frozen=True, slots=True)
class RigidSection:
    """*RIGID BODY of rigid elements."""

    elset: str
    source: Source


@dataclass(frozen=True, slots=True)
class NodalSection:
    """Section of nodes that a load enters: it has no properties, and no element set."""

    source: Source
    elset: str = ""


@dataclass(frozen=True, slots=True)
class ElementNames:
    """Names that a deck gives in comments, all of a kind or none; a unit may follow a name: 'E [MPa]'.

    properties  of the real properties
    integers    of the integer properties
    variables   of the SVARS of an integration point, '' for one without a name; points follow each other
    """

    properties: tuple[str, ...] = ()
    integers: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class UserElement:
    """*USER ELEMENT, TYPE=Un.

    number             n of Un, the JTYPE of the call
    nodes              nodes per element (NODES=)
    coordinates        largest coordinate used (COORDINATES=, 1)
    properties         number of real properties (PROPERTIES=, 0)
    integer_properties number of integer properties (I PROPERTIES=, 0)
    variables          number of SVARS (VARIABLES=, 1)
    unsymmetric        UNSYMM given
    integration        INTEGRATION=, number of material points for UELMAT; 0 if not given
    tensor             TENSOR=, '' if not given
    dofs               (local node from 0, dof) of each element unknown, in the order of U and RHS
    names              of its properties and variables, as far as the deck gives them
    """

    number: int
    nodes: int
    dofs: tuple[tuple[int, int], ...]
    source: Source
    coordinates: int = 1
    properties: int = 0
    integer_properties: int = 0
    variables: int = 1
    unsymmetric: bool = False
    integration: int = 0
    tensor: str = ""
    names: ElementNames = ElementNames()

    @property
    def point_variables(self) -> PointVariables | None:
        """Meaning of the SVARS by the names that the deck gives; None without names."""
        names = self.names.variables
        return PointVariables("user", names, self.variables // len(names)) if names else None


@dataclass(frozen=True, slots=True)
class UserProperty:
    """*UEL PROPERTY: PROPS and JPROPS of an element set; with a material, UELMAT is called instead of UEL."""

    elset: str
    source: Source
    values: FloatArray = field(default_factory=lambda: np.zeros(0))
    integers: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    material: Material | None = None
    orientation: Orientation | None = None


Section = (
    SolidSection
    | CompositeSection
    | CohesiveSection
    | ShellSection
    | MembraneSection
    | BeamSection
    | SpringSection
    | MassSection
    | RigidSection
    | NodalSection
    | UserProperty
)


def materials_of(section: Section) -> tuple[Material, ...]:
    """Return the materials of a section: one for each layer."""
    if isinstance(section, ShellSection | CompositeSection):
        return tuple(layer.material for layer in section.layers)
    material: Material | None = getattr(section, "material", None)
    return () if material is None else (material,)
